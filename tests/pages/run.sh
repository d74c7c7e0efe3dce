#!/usr/bin/env bash
# Opens a report of each kind in headless Chromium at two widths, and fails where something is wider than the
# page, a picture has no alternative text, or a script stands in it. Figures as SVG must be well-formed, have
# their texts as text, and look like the PNG.
#   run.sh LILYTANK SOURCES        ends with 77 (skipped) where Chromium is not installed
set -euo pipefail
lilytank=$(realpath "$1") sources=$(realpath "$2")
source "$(dirname "${BASH_SOURCE[0]}")/chromium.sh"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
faults=0

# title_of <page>: its title, which scripts have set.
title_of() {
  dump "$1" 5000 |
    grep -o '<title>[^<]*</title>' | sed 's/<[^>]*>//g'
}

# measure <report> <width>: one line of what a frame of that width shows.
measure() {
  {
    echo '<!doctype html><meta charset="utf-8"><body><script>'
    echo "addEventListener('error',e=>document.title+=' error '+e.message);"
    printf 'const page=atob("%s");\n' "$(base64 -w0 "$1")"
    cat << JS
const bytes=Uint8Array.from(page,c=>c.charCodeAt(0));
const f=document.createElement('iframe');
f.style='width:$2px;height:900px;border:0';
f.onload=()=>{
  const d=f.contentDocument,over=d.documentElement.scrollWidth-$2;
  d.querySelectorAll('details').forEach(e=>e.open=true);
  const open=d.documentElement.scrollWidth-$2;
  const bare=[...d.querySelectorAll('figure>svg,img')].filter(e=>!(e.getAttribute('aria-label')||e.alt)).length;
  document.title='over '+Math.max(0,over,open)+' bare '+bare+' scripts '+d.scripts.length+
    ' cards '+d.querySelectorAll('.card p').length+' pictures '+d.querySelectorAll('figure>svg').length;
};
f.srcdoc=new TextDecoder().decode(bytes);
document.body.append(f);
JS
    echo '</script>'
  } > "$work/frame.html"
  title_of "$work/frame.html"
}

# look <name> <report>
look() {
  local width seen
  for width in 390 1280; do
    seen=$(measure "$2" "$width")
    printf '%-12s %5s px  %s\n' "$1" "$width" "$seen"
    [[ $seen == 'over 0 bare 0 scripts 0 cards 1 pictures '[1-9]* ]] || faults=$((faults + 1))
  done
}

# alike <figure, without ending> <text in it>: differing pixels in 1000, from one line or edge to another.
alike() {
  local seen
  {
    echo '<!doctype html><meta charset="utf-8"><body><script>'
    printf 'const svg=new TextDecoder().decode(Uint8Array.from(atob("%s"),c=>c.charCodeAt(0)));\n' \
      "$(base64 -w0 "$1.svg")"
    printf 'const png="data:image/png;base64,%s",text="%s";\n' "$(base64 -w0 "$1.png")" "$2"
    cat << 'JS'
const d=new DOMParser().parseFromString(svg,'image/svg+xml');
const live=[...d.querySelectorAll('text')].some(e=>e.textContent===text);
const seen=url=>new Promise((done,fail)=>{
  const image=new Image();
  image.onload=()=>done(image),image.onerror=fail,image.src=url;
});
const pixels=(image,w,h)=>{
  const c=document.createElement('canvas');
  c.width=w,c.height=h;
  const at=c.getContext('2d');
  at.drawImage(image,0,0,w,h);
  return at.getImageData(0,0,w,h).data;
};
(async()=>{
  const drawn=await seen(png),w=drawn.width,h=drawn.height;
  const a=pixels(drawn,w,h),b=pixels(await seen('data:image/svg+xml,'+encodeURIComponent(svg)),w,h);
  let differ=0;
  for(let i=0;i<a.length;i+=4)
    differ+=Math.abs(a[i]-b[i])+Math.abs(a[i+1]-b[i+1])+Math.abs(a[i+2]-b[i+2])>192;
  document.title='faults '+d.querySelectorAll('parsererror').length+' text '+live+
    ' differ '+Math.round(4000*differ/a.length);
})();
JS
    echo '</script>'
  } > "$work/alike.html"
  seen=$(title_of "$work/alike.html")
  printf '%-21s  %s\n' "$1" "$seen"
  [[ $seen =~ ^'faults 0 text true differ '[0-4]$ ]] || faults=$((faults + 1))
}

cd "$work"
"$lilytank" prove "$sources/tests/data/proofs/seed16" --out benchmark > /dev/null 2>&1
look benchmark benchmark/report.html

cp "$sources"/scenarios/experiments/real/{gliders.toml,airtrack_*.csv} .
"$lilytank" diagnose gliders.toml --budget 1 --quiet --out diagnosis > /dev/null 2>&1
look diagnosis diagnosis/report.html

"$lilytank" calibrate "$sources/scenarios/experiments/tank.toml" --simulations 40 --replicates 20 --comparisons 2 \
  --flow-draws 0 --flow scenario --quiet --out calibration > /dev/null 2>&1
look calibration calibration/report.html

printf '[study]\nname = "chains"\nscenario = "%s"\nreplicates = 2\n' "$sources/scenarios/chain5.toml" > study.toml
"$lilytank" study study.toml --set run.duration='10 min' --quiet --out study > /dev/null 2>&1
look study study/report.html

"$lilytank" analyze "$sources/scenarios/experiments/lily_1.csv.gz" --longest-lag 3 --resamples 40 \
  --out analysis > /dev/null 2>&1
look analysis analysis/report.html

"$lilytank" flow "$sources/scenarios/experiments/tank.toml" --out flow > /dev/null 2>&1
look flow flow/report.html

"$lilytank" optimize "$sources/scenarios/optimize/chain5.toml" --set run.duration='2 min' --no-compare \
  --quiet --out optimum > /dev/null 2>&1
look optimum optimum/report.html

"$lilytank" run "$sources/scenarios/chain5.toml" --set run.duration='2 min' --video --quiet --out run > /dev/null 2>&1
look run run/report.html
alike run/yield 'time (s)'
alike flow/flow_smooth 'x (cm)'

((faults == 0)) || echo "$faults pages are not as they should be"
exit $((faults > 0))
