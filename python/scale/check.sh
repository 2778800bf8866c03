#!/usr/bin/env bash
# Data sets on more than one machine: by Ray and by HyperQueue, with workers that are killed; and by the package `lerobot`, if the Python has it (8 GB).
set -euo pipefail
python=$(realpath --no-symlinks "${1:?usage: python/scale/check.sh VENV/bin/python}")
cd "$(dirname "$0")" # where `twintac` is the installed one
export CARGO_TARGET_DIR="$PWD/../../target" # what the workspace has built is not built again
"$python" -m pip install --quiet --disable-pip-version-check '..[ray]' hyperqueue pandas pyarrow pytest
"$python" -m pytest --quiet -rs .
