#!/usr/bin/env bash
# RO-Crates of a run, an analysis and a check: their requirements by rules.py, and the validator of the npm package
# ro-crate where npm can install it.
#   run.sh LILYTANK SOURCES        ends with 77 (skipped) without python3
set -euo pipefail
lilytank=$(realpath "$1") here=$(realpath "$2")/tests/crate
python=/usr/bin/python3
if [[ ! -x $python ]]; then
  echo "skipped: python3 is not installed"
  exit 77
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
cp "$here/../support/pair.rules" .
"$lilytank" run - --set run.duration=60 --set module.count=4 --set output.rate=5 --out run --quiet < /dev/null > out
"$lilytank" analyze run --msd-only --out analysis > out 2>&1
"$lilytank" check pair.rules --measure run/resolved.toml --worlds 8 --lattice 0 --out check --quiet > out
license=https://creativecommons.org/licenses/by/4.0/
for dir in run analysis check; do "$lilytank" export "$dir" --format ro-crate --license "$license" --quiet; done
"$python" "$here/rules.py" run analysis check
"$python" "$here/rules.py" --refuses run

if ! command -v npm > /dev/null ||
   ! timeout 120 npm install --silent --prefix npm ro-crate@3.7.2 > log 2>&1; then
  echo "npm cannot install ro-crate: its validator has not seen the crates"
  exit 0
fi
# Contexts come from the package instead of the network. A crate without licence must be refused.
cat > validate.js << 'END'
const context = require("ro-crate/lib/context.json"), fs = require("fs");
globalThis.fetch = async () => ({ok: true, json: async () => context});
const {Validator} = require("ro-crate/lib/validator");

async function errors(dir) {
  const validator = new Validator();
  validator.parseJSON(fs.readFileSync(dir + "/ro-crate-metadata.json", "utf8"));
  await validator.crate.resolveContext();
  if (!await validator.validate()) throw new Error(dir + " is not validated");
  validator.checkFiles(Object.fromEntries(fs.readdirSync(dir).map(name => [name, {exists: true, isDir: false}])));
  return validator.results.filter(one => one.status === "error");
}

async function main() {
  for (const dir of ["run", "analysis", "check"]) {
    const found = await errors(dir);
    if (found.length) throw new Error(dir + ": " + JSON.stringify(found, null, 1));
  }
  const unlicensed = (await errors("unlicensed")).map(one => one.id);
  if (unlicensed.join() !== "licenseRequired") throw new Error("without licence: " + unlicensed);
  console.log("npm's validator accepts the crates");
}
main();
END
cp -r run unlicensed
"$lilytank" export unlicensed --format ro-crate --force --quiet
NODE_PATH=npm/node_modules node validate.js
