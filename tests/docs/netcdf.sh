#!/usr/bin/env bash
# `lilytank export` read back by xarray and by ncdump's library for Python, against the files that were exported.
# Skipped (77) without these libraries.
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
perl -0777 -ne 'print $1 if /^```python\n(import numpy.*?)^```/ms' docs/run.md > "$work/reader.py"
PYTHONPATH=$work "$python" - "$work" << 'END'
import sys
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
print(f"{len(time)} frames")
END
