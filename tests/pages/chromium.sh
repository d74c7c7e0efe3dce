# Sourced: headless Chromium for tests of pages. Ends the test with 77 (skipped) where it is not installed.
chromium=$(command -v chromium || command -v chromium-browser || command -v google-chrome || true)
if [[ -z $chromium ]]; then
  echo "Chromium is not installed: pages not opened"
  exit 77
fi

# dump <page> <virtual milliseconds>: the page as its scripts have left it. Needs the directory $work.
dump() {
  "$chromium" --headless --no-sandbox --disable-gpu --disable-quic --no-first-run \
    --disable-background-networking --disable-component-update --disable-sync \
    --user-data-dir="$work/profile" --virtual-time-budget="$2" --dump-dom "file://$1" 2> /dev/null
}
