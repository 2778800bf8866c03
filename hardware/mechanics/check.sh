#!/usr/bin/env bash
# Makes and checks the mechanics of the three variants, and runs the tests. Usage: check.sh VENV, a folder for the packages; it is made if it is absent.
set -euo pipefail
cd "$(dirname "$0")"
venv=${1:?usage: check.sh VENV}
if [ ! -x "$venv/bin/python" ]; then
  python3 -m venv "$venv"
fi
python="$venv/bin/python"
"$python" -m pip install --quiet --disable-pip-version-check -r requirements.txt
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
"$python" -m mypy make.py check.py render.py sheet.py tests/*.py
for variant in phystac phystac-ms5837 fingertip; do
  echo "$variant"
  "$python" make.py "tests/$variant.geometry.json" --out "$out/$variant" 2> "$out/log" || { cat "$out/log"; exit 1; }
  "$python" check.py "$out/$variant" > "$out/log" || { cat "$out/log"; exit 1; }
  tail -1 "$out/log"
done
# Pictures need an OpenGL that draws without a display (EGL or OSMesa); where there is none, that is said and skipped.
if "$python" -c 'import pyvista; p = pyvista.Plotter(off_screen=True); p.add_mesh(pyvista.Sphere()); p.screenshot()' > /dev/null 2>&1; then
  "$python" sheet.py "$out/phystac-ms5837" 2> "$out/log" || { cat "$out/log"; exit 1; }
  "$python" render.py "$out/phystac-ms5837" 2> "$out/log" || { cat "$out/log"; exit 1; }
  echo "pictures and casting sheet drawn"
else
  echo "note: no OpenGL here that draws without a display; pictures and casting sheet are skipped"
fi
"$python" -m pytest -q tests
