#!/usr/bin/env bash
# Checks the layout of all sources with clang-format. Ends with 77 (skipped) where that is missing.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
if ! command -v clang-format > /dev/null; then
  echo "clang-format is not installed: layout not checked"
  exit 77
fi
find include src render tests bench -name '*.[ch]pp' -print0 |
  xargs -0 clang-format --style=file --dry-run -Werror
