#!/usr/bin/env python3
"""Makes a sensor's mechanics from its geometry.json: STEP and STL files of each part, and
mechanics.json.
"""

from __future__ import annotations

import argparse
import shutil
import sys
from pathlib import Path

from mechanics.catalog import entries
from mechanics.export import write_json, write_part, write_whole
from mechanics.geometry import GeometryError, load
from mechanics.layout import Layout
from mechanics.manifest import manifest


def main() -> int:
    """Returns the exit code. 0: made; 2: the geometry cannot be built, for the printed reason."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("geometry", type=Path, help="geometry.json of a variant")
    parser.add_argument("--out", type=Path, required=True, help="folder to write to")
    parser.add_argument(
        "--only", metavar="PART", help="makes one part alone, such as `shell`; mechanics.json is not written then"
    )
    arguments = parser.parse_args()
    try:
        layout = Layout(load(arguments.geometry))
        made = entries(layout)
        chosen = [entry for entry in made if arguments.only in (None, entry.name)]
        if not chosen:
            names = ", ".join(entry.name for entry in made)
            raise GeometryError(f"--only: there is no part `{arguments.only}`; parts are {names}")
        for entry in chosen:
            write_part(entry.make(layout), entry.name, arguments.out)
            print(f"{entry.name}: STEP, STL", file=sys.stderr)
        if arguments.only is None:
            write_whole(arguments.out / "geometry.json", lambda path: shutil.copyfile(arguments.geometry, path))
            write_json(manifest(layout, made), arguments.out / "mechanics.json")
    except (GeometryError, RuntimeError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
