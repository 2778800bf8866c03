#!/usr/bin/env python3
"""Writes the casting sheet of a folder that make.py wrote.

The sheet is one page with weights, times and the order of work.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

from casting.page import write_page
from casting.recipe import Recipe, density_of
from checks.files import read
from mechanics.export import write_whole
from mechanics.geometry import GeometryError
from pictures.views import VIEWS


def main() -> int:
    """Returns the exit code. 0: written; 2: the folder cannot be read, or a number is unusable."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path, help="folder that make.py wrote")
    parser.add_argument("--out", type=Path, help="the PDF file (default: casting-sheet.pdf in the folder)")
    parser.add_argument(
        "--density",
        type=float,
        default=1.07,
        help="of the silicone, g/cm3 (default: %(default)s; read your product's sheet)",
    )
    arguments = parser.parse_args()
    try:
        made = read(arguments.folder)
        recipe = Recipe(
            made.figures["gel_volume_mm3"], made.figures["potting_volume_mm3"], density_of(arguments.density)
        )
        with tempfile.TemporaryDirectory() as folder:
            picture = Path(folder) / "fill.png"
            VIEWS["step-4-fill"](made, picture)
            write_whole(
                arguments.out or arguments.folder / "casting-sheet.pdf",
                lambda path: write_page(made, recipe, picture, path),
            )
    except GeometryError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
