#!/usr/bin/env bash
# Builds the package, installs it into the virtual environment of a Python, and checks it: types, stubs against the library, sources, tests, the book.
set -euo pipefail
python=$(realpath --no-symlinks "${1:?usage: python/check.sh VENV/bin/python}")
cd "$(dirname "$0")/tests" # where `twintac` is the installed one
export CARGO_TARGET_DIR="$PWD/../../target" # what the workspace has built is not built again
"$python" -m pip install --quiet --disable-pip-version-check '..[docs,test]'
"$python" -m mypy --config-file ../pyproject.toml ../twintac/mujoco
"$python" -m mypy --config-file ../pyproject.toml ../examples ../benchmarks ../../docs/hooks.py .
echo 'twintac\.gymnasium\.sb3' > ../../target/not-imported # where Stable-Baselines3 is not installed
"$python" -m mypy.stubtest twintac --mypy-config-file ../pyproject.toml --allowlist ../../target/not-imported --ignore-unused-allowlist
PYO3_PYTHON=$python cargo clippy --manifest-path ../Cargo.toml --release --quiet -- --deny warnings
"$python" -m pytest --quiet
(cd ../.. && NO_MKDOCS_2_WARNING=1 "$python" -m mkdocs build --strict --quiet) # target/site
