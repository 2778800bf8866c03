#!/usr/bin/env python3
"""Checks a folder that make.py wrote. Prints a table and writes check.json to the folder; the exit
code is 1 if a check fails.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from checks import cavity, files, indenters, interference, meshes, walls
from checks.finding import Row, table
from mechanics.export import write_json
from mechanics.geometry import GeometryError


def run(folder: Path) -> list[Row]:
    """Makes all checks. Checks that need solids are left out if a surface is not closed."""
    made = files.read(folder)
    rows = meshes.check(made)
    if all(row.holds for row in rows if row.check.startswith(("closed", "turned"))):
        for each in (cavity, interference, walls, indenters):
            rows += each.check(made)
    else:
        rows.append(Row("the other checks", "all", "left out", "surfaces are closed", False))
    return rows


def main() -> int:
    """Returns the exit code. 0: no check fails; 1: a check fails; 2: the folder cannot be read."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path, help="folder that make.py wrote")
    arguments = parser.parse_args()
    try:
        rows = run(arguments.folder)
    except GeometryError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    write_json([row.as_json() for row in rows], arguments.folder / "check.json")
    findings = sum(not row.holds for row in rows)
    print(table(rows))
    print(f"{len(rows)} checks, {findings} findings")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
