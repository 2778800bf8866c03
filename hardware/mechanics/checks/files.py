"""Reads a folder that make.py wrote."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import trimesh

from mechanics.geometry import Geometry, GeometryError, load


@dataclass(frozen=True)
class Made:
    """Geometry, figures, and the triangles of each part."""

    geometry: Geometry
    figures: dict[str, Any]
    meshes: dict[str, trimesh.Trimesh]

    def used_in(self, assembly: str) -> list[str]:
        """Names of the parts of an assembly."""
        return [part["name"] for part in self.figures["parts"] if assembly in part["used_in"]]


def read(folder: Path) -> Made:
    """Reads a folder. Raises `GeometryError` if a file is missing or cannot be read."""
    geometry = load(folder / "geometry.json")
    try:
        figures = json.loads((folder / "mechanics.json").read_text(encoding="utf-8"))
        names = [part["name"] for part in figures["parts"]]
    except (OSError, ValueError, KeyError) as error:
        raise GeometryError(f"{folder}: no mechanics.json of make.py: {error}: run make.py without --only") from error
    return Made(geometry, figures, {name: read_stl(folder / f"{name}.stl") for name in names})


def read_stl(path: Path) -> trimesh.Trimesh:
    """The triangles of an STL file, with equal corners merged."""
    try:
        loaded = trimesh.load_mesh(path, process=False)
    except (OSError, ValueError) as error:
        raise GeometryError(f"{path}: can't be read as STL: {error}") from error
    mesh = trimesh.Trimesh(np.asarray(loaded.vertices), np.asarray(loaded.faces), process=False)
    mesh.merge_vertices()
    return mesh
