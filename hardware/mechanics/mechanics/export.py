"""Writes STEP and STL files of a part, and JSON files. A file is written completely or not at all.
The same part gives the same bytes.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

from build123d import Part, export_step

from mechanics.triangles import stl_bytes, triangles

# STEP requires a time; it is always the same one.
TIMESTAMP = "1970-01-01T00:00:00"


def write_whole(path: Path, write: Callable[[Path], object]) -> None:
    """Writes under a temporary name in the same folder, and renames the file."""
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_name(f".{path.name}.tmp")
    try:
        write(partial)
        os.replace(partial, path)
    finally:
        partial.unlink(missing_ok=True)


def write_part(part: Part, name: str, folder: Path) -> list[Path]:
    """Writes NAME.step and NAME.stl. The STEP file is exact, the STL within `STL_DEFLECTION`."""
    solids = part.solids()
    if len(solids) != 1 or not part.is_valid:
        raise RuntimeError(
            f"{name}: expected one valid solid, found {len(solids)}: the sizes of geometry.json do not fit together"
        )
    solid = solids[0]
    solid.label = name
    step, stl = folder / f"{name}.step", folder / f"{name}.stl"
    write_whole(stl, lambda path: path.write_bytes(stl_bytes(*triangles(solid))))
    write_whole(step, lambda path: export_step(solid, path, timestamp=TIMESTAMP))
    return [step, stl]


def write_json(value: Any, path: Path) -> None:
    """Writes a JSON file with sorted keys."""
    text = json.dumps(value, indent=1, sort_keys=True) + "\n"
    write_whole(path, lambda partial: partial.write_text(text, encoding="utf-8"))
