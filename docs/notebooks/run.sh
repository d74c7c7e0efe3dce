#!/usr/bin/env bash
# Executes the notebooks in place. Needs jupyter-nbconvert, python3-ipykernel and python3-matplotlib of Debian 12, and the
# package lilytank: installed, or PYTHONPATH=build/python.
#   run.sh [NOTEBOOK...]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
(($#)) || set -- *.ipynb
PYTHONWARNINGS=ignore PYDEVD_DISABLE_FILE_VALIDATION=1 jupyter nbconvert --to notebook --execute --inplace --ExecutePreprocessor.timeout=3600 "$@"
