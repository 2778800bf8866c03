#!/usr/bin/env python3
"""Draws pictures of a folder that make.py wrote, without a display.

The pictures show the parts, a section, an exploded view, and each step of building.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from checks.files import read
from mechanics.geometry import GeometryError
from pictures.views import VIEWS


def main() -> int:
    """Returns the exit code. 0: drawn; 2: the folder cannot be read, or a picture is unknown."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path, help="folder that make.py wrote")
    parser.add_argument("--out", type=Path, help="folder for the pictures (default: the same)")
    parser.add_argument("--only", metavar="PICTURES", help="names of pictures, separated by commas")
    parser.add_argument("--prefix", default="", help="what names of files begin with, such as `fingertip-`")
    arguments = parser.parse_args()
    try:
        chosen = arguments.only.split(",") if arguments.only else list(VIEWS)
        for name in chosen:
            if name not in VIEWS:
                raise GeometryError(f"--only: there is no picture `{name}`; pictures are {', '.join(VIEWS)}")
        made = read(arguments.folder)
        for name in chosen:
            path = (arguments.out or arguments.folder) / f"{arguments.prefix}{name}.png"
            VIEWS[name](made, path)
            print(f"{path}: {path.stat().st_size // 1000} kB", file=sys.stderr)
    except GeometryError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
