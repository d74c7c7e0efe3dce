#!/usr/bin/env bash
# `lilytank export` read back by xarray and by ncdump's library for Python, against the files that were exported; the
# RO-Crate of the run. Skipped (77) without these libraries.
#   netcdf.sh LILYTANK SOURCES
set -euo pipefail
lilytank=$(realpath "$1")
cd "$2"
python=/usr/bin/python3
if ! "$python" -c 'import xarray, netCDF4' 2> /dev/null; then
  echo "skipped: python3-xarray or python3-netcdf4 is not installed"
  exit 77
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$lilytank" run scenarios/chain5.toml --set run.duration=300 --set output.rate=5 --out "$work/run" --quiet > /dev/null
"$lilytank" export "$work/run" --quiet
"$lilytank" export "$work/run" --out "$work/again.nc" --quiet
cmp "$work/run/results.nc" "$work/again.nc"
"$lilytank" export "$work/run" --format ro-crate --license https://creativecommons.org/licenses/by/4.0/ --quiet
perl -0777 -ne 'print $1 if /^```python\n(import numpy.*?)^```/ms' docs/run.md > "$work/reader.py"
PYTHONPATH=$work "$python" - "$work" << 'END'
import hashlib, json, sys
import numpy as np
import pandas as pd
import xarray as xr
from reader import read_trajectory

run = sys.argv[1] + "/run"
time, bodies = read_trajectory(run + "/trajectory.bin")
poses = xr.open_dataset(run + "/results.nc", group="trajectory")
assert np.array_equal(poses.time, time) and poses.x.dims == ("frame", "body") and poses.x.units == "m"
for name in ("x", "y", "theta", "label", "last", "latched", "bonded", "complete"):
    assert np.array_equal(poses[name], bodies[name]), name
for table in ("events", "metrics", "rules", "species"):
    rows = pd.read_csv(f"{run}/{table}.csv")
    stored = xr.open_dataset(run + "/results.nc", group=table).to_dataframe()
    assert list(stored.columns) == list(rows.columns), table
    for column in rows:
        ours, theirs = stored[column], rows[column]
        if ours.dtype == object:
            theirs = theirs.fillna("").astype(str)
            assert [str(a) for a in ours] == list(theirs), (table, column)
        else:
            assert np.array_equal(ours, theirs, equal_nan=True), (table, column)

with open(run + "/ro-crate-metadata.json") as file:
    graph = json.load(file)["@graph"]
entities = {entity["@id"]: entity for entity in graph}
assert len(entities) == len(graph)

def references(value):
    if isinstance(value, dict):
        yield from ([value["@id"]] if set(value) == {"@id"} else [])
        for part in value.values():
            yield from references(part)
    elif isinstance(value, list):
        for part in value:
            yield from references(part)

for entity in graph:
    for name in references({k: v for k, v in entity.items() if k != "@id"}):
        assert name in entities or name.startswith("https://w3id.org/ro/crate/"), name
root, action = entities["./"], entities["#run"]
assert {"name", "description", "datePublished", "license"} <= set(root)
assert action["@type"] == "CreateAction" and entities[action["instrument"]["@id"]]["softwareVersion"]
assert action["object"] == [{"@id": "resolved.toml"}]
for part in root["hasPart"]:
    with open(run + "/" + part["@id"], "rb") as file:
        assert hashlib.sha256(file.read()).hexdigest() == entities[part["@id"]]["sha256"], part
print(f"{len(time)} frames, {len(entities)} entities of the crate")
END
