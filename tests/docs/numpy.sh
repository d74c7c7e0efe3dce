#!/usr/bin/env bash
# The NumPy reader of docs/run.md against the CSV trajectory of the same run. Skipped (77) without NumPy.
#   numpy.sh LILYTANK SOURCES
set -euo pipefail
lilytank=$(realpath "$1")
cd "$2"
python=/usr/bin/python3
if ! "$python" -c 'import numpy' 2> /dev/null; then
  echo "skipped: python3-numpy is not installed"
  exit 77
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
perl -0777 -ne 'print $1 if /^```python\n(import numpy.*?)^```/ms' docs/run.md > "$work/reader.py"
for format in binary csv; do
  "$lilytank" run scenarios/chain5.toml --set run.duration=60 --set output.trajectory=$format --set output.rate=5 \
    --out "$work/$format" --quiet > /dev/null
done
PYTHONPATH=$work "$python" - "$work" << 'EOF'
import sys
import numpy as np
from reader import read_trajectory

work = sys.argv[1]
time, bodies = read_trajectory(work + "/binary/trajectory.bin")
rows = np.genfromtxt(work + "/csv/trajectory.csv", delimiter=",", names=True)
assert rows.size == bodies.size, (rows.size, bodies.shape)
assert np.allclose(rows["time"].reshape(bodies.shape)[:, 0], time, rtol=0, atol=1e-6)
for name in ("x", "y", "theta"):
    assert np.allclose(rows[name].reshape(bodies.shape), bodies[name], rtol=0, atol=1e-6), name
for name in ("label", "last", "latched", "bonded", "complete"):
    assert np.array_equal(rows[name].reshape(bodies.shape), bodies[name]), name
# A file that is cut within a frame ends with the frame before.
with open(work + "/binary/trajectory.bin", "rb") as file:
    whole = file.read()
with open(work + "/cut.bin", "wb") as file:
    file.write(whole[:-1])
assert len(read_trajectory(work + "/cut.bin")[0]) == len(time) - 1
print(f"numpy: {len(time)} frames of {bodies.shape[1]} bodies agree with the CSV trajectory")
EOF
