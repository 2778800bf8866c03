#!/usr/bin/env bash
# Builds the package, installs it into the virtual environment of a Python, and checks it: size, types, stubs against the library, sources, tests, the book.
set -euo pipefail
python=$(realpath --no-symlinks "${1:?usage: python/check.sh VENV/bin/python}")
cd "$(dirname "$0")/tests" # where `twintac` is the installed one
export CARGO_TARGET_DIR="$PWD/../../target" # what the workspace has built is not built again
wheels=$(mktemp --directory)
trap 'rm -r "$wheels"' EXIT
pip=("$python" -m pip --quiet --disable-pip-version-check)
"${pip[@]}" wheel --no-deps --wheel-dir "$wheels" ..
wheel=$(echo "$wheels"/twintac-*.whl)
bytes=$(stat --format %s "$wheel")
echo "$(basename "$wheel"): $bytes bytes"
((bytes < 30000000)) || { echo 'the wheel has 30 MB or more' >&2; exit 1; }
"${pip[@]}" install --force-reinstall --no-deps "$wheel"
"${pip[@]}" install "$wheel[docs,test]"
"$python" -m mypy --config-file ../pyproject.toml ../twintac/arrays ../twintac/mujoco ../twintac/simulators ../twintac/widget.py
"$python" -m mypy --config-file ../pyproject.toml ../examples ../benchmarks ../../docs/hooks.py ../../docs/studies.py .
# Where Stable-Baselines3 or a simulator is not installed; and a class whose base, of untyped ipywidgets, has a metaclass of its own.
printf '%s\n' 'twintac\.gymnasium\.sb3' 'twintac\.simulators\.(_gels|genesis|isaaclab|maniskill|mjlab|mjx|mujoco_warp|newton)' 'twintac\.simulators\._warp\..*' 'twintac\.widget\.GelWidget' > ../../target/not-as-typed
"$python" -m mypy.stubtest twintac --mypy-config-file ../pyproject.toml --allowlist ../../target/not-as-typed --ignore-unused-allowlist
"$python" -m pytest --quiet -n 2 --dist loadfile # the tests of a file share what takes long to make
(cd ../.. && NO_MKDOCS_2_WARNING=1 "$python" -m mkdocs build --strict --quiet) # target/site
