"""Checks that each STL file is a closed surface without branches, oriented outward, that fits a
printer.
"""

from __future__ import annotations

import numpy as np
import trimesh

from checks.files import Made
from checks.finding import Row

# Size of the bed of small printers, mm.
LARGEST = 180.0


def is_closed(mesh: trimesh.Trimesh) -> bool:
    """Whether each edge belongs to exactly two triangles, which use it in opposite directions."""
    directed = np.concatenate([mesh.faces[:, [0, 1]], mesh.faces[:, [1, 2]], mesh.faces[:, [2, 0]]])
    forward = {tuple(edge) for edge in directed.tolist()}
    return len(forward) == len(directed) and all((b, a) in forward for a, b in forward)


def thinnest_triangle(mesh: trimesh.Trimesh) -> float:
    """The smallest area of a triangle, mm²."""
    return float(mesh.area_faces.min())


def check(made: Made) -> list[Row]:
    """A row for each part and property."""
    rows = []
    for name, mesh in made.meshes.items():
        bodies = mesh.body_count
        rows.append(
            Row("closed, two triangles at each edge", name, f"{len(mesh.faces)} triangles", "closed", is_closed(mesh))
        )
        rows.append(Row("one body", name, str(bodies), "1", bodies == 1))
        rows.append(Row("turned outward", name, f"{mesh.volume:.1f} mm3", "> 0", bool(mesh.volume > 0.0)))
        size = " x ".join(f"{side:.1f}" for side in mesh.extents)
        rows.append(Row("size", name, f"{size} mm", f"<= {LARGEST:g} mm", bool(mesh.extents.max() <= LARGEST)))
    rows += _levels(made)
    return rows


def _levels(made: Made) -> list[Row]:
    """Checks that parts reach exactly the levels of the geometry."""
    board, levels = made.geometry.board, made.figures["levels_mm"]
    rim = made.geometry.shell.height if made.geometry.shell else levels["rim"]
    expected = {
        "port-plate": (board.top_z, 0.0),
        "shell": (levels["lid_inside"], rim),
        "lid": (levels["lid_bottom"], board.bottom_z),
        "mould-cover": (levels["parting"], levels["cover"]),
    }
    rows = []
    for name, (low, high) in expected.items():
        found = made.meshes[name].bounds[:, 2]
        holds = bool(abs(found[0] - low) < 1e-3 and abs(found[1] - high) < 1e-3)
        rows.append(Row("levels", name, f"z {found[0]:.3f} to {found[1]:.3f} mm", f"{low:.3f} to {high:.3f} mm", holds))
    return rows
