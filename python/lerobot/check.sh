#!/usr/bin/env bash
# Checks the plugin for LeRobot with the package `lerobot` itself: types, and tests. Where the Python has no `lerobot` (8 GB with PyTorch), it says that it is skipped.
set -euo pipefail
python=$(realpath --no-symlinks "${1:?usage: python/lerobot/check.sh VENV/bin/python}")
cd "$(dirname "$0")/tests" # where `lerobot_camera_twintac` is the installed one
if ! "$python" -c 'import importlib.util, sys; sys.exit(importlib.util.find_spec("lerobot") is None)'; then
  echo "python/lerobot: skipped, the package lerobot is not installed: $python -m pip install lerobot"
  exit 0
fi
"$python" -c 'import twintac' # python/check.sh builds and installs it
pip=("$python" -m pip --quiet --disable-pip-version-check)
"${pip[@]}" install --force-reinstall --no-deps ..
"${pip[@]}" install mypy pytest
"$python" -m mypy --config-file ../pyproject.toml ../lerobot_camera_twintac .
"$python" -m pytest --quiet -rs .
