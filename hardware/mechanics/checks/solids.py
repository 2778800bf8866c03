"""Solids from triangles, for Boolean operations, and the bodies that geometry.json and
mechanics.json describe.
"""

from __future__ import annotations

from typing import Any

import manifold3d
import numpy as np
import trimesh

from checks.files import Made
from mechanics.geometry import Part

SEGMENTS = 48


def solid(mesh: trimesh.Trimesh) -> manifold3d.Manifold:
    """A mesh as a solid. Raises `ValueError` if it is not closed and consistent."""
    made = manifold3d.Manifold(
        manifold3d.Mesh(np.asarray(mesh.vertices, dtype=np.float32), np.asarray(mesh.faces, dtype=np.uint32))
    )
    if made.status() != manifold3d.Error.NoError:
        raise ValueError(f"not a solid: {made.status()}")
    return made


def box(low: tuple[float, float, float], high: tuple[float, float, float]) -> manifold3d.Manifold:
    """A block between two corners."""
    size = tuple(b - a for a, b in zip(low, high, strict=True))
    return manifold3d.Manifold.cube(size).translate(low)


def rod(at: list[float], radius: float, z0: float, z1: float, segments: int = SEGMENTS) -> manifold3d.Manifold:
    """An upright cylinder, as an inscribed prism."""
    return manifold3d.Manifold.cylinder(z1 - z0, radius, radius, segments).translate((at[0], at[1], z0))


def board_bodies(made: Made) -> dict[str, manifold3d.Manifold]:
    """Board, chips, and the parts below the board."""
    board, chip = made.geometry.board, made.geometry.chip
    outline = manifold3d.CrossSection([list(board.outline)], manifold3d.FillRule.NonZero)
    plate = manifold3d.Manifold.extrude(outline, board.thickness).translate((0.0, 0.0, board.bottom_z))
    for hole in board.holes:
        plate = plate - rod(list(hole), board.drill / 2, board.bottom_z - 1.0, board.top_z + 1.0)
    bodies = {"board": plate}
    for taxel in made.geometry.taxels:
        x, y = taxel.at
        half_x, half_y = chip.body[0] / 2, chip.body[1] / 2
        bodies[f"chip {taxel.name}"] = box((x - half_x, y - half_y, board.top_z), (x + half_x, y + half_y, 0.0))
    for part in (*board.parts, board.connector):
        bodies[f"part {part.reference}"] = _below(part, board.bottom_z)
    return bodies


def _below(part: Part, bottom_z: float) -> manifold3d.Manifold:
    (x, y), (width, depth, height) = part.center, part.size
    return box((x - width / 2, y - depth / 2, bottom_z - height), (x + width / 2, y + depth / 2, bottom_z))


def screw_body(screw: dict[str, Any]) -> manifold3d.Manifold:
    """A screw with head and nut."""
    at, seat, radius = screw["at_mm"], screw["seat_z_mm"], float(screw["thread"][1:]) / 2
    body = rod(at, radius, seat - screw["length_mm"], seat)
    if screw["is_sunk"]:
        depth = screw["head_radius_mm"] - radius
        cone = manifold3d.Manifold.cylinder(depth, radius, screw["head_radius_mm"], SEGMENTS)
        body += cone.translate((at[0], at[1], seat - depth))
    else:
        body += rod(at, screw["head_radius_mm"], seat, seat + screw["head_height_mm"])
    top, flats = screw["nut_top_z_mm"], screw["nut_flats_mm"]
    nut = manifold3d.Manifold.cylinder(screw["nut_height_mm"], flats / 3**0.5, flats / 3**0.5, 6)
    return body + nut.rotate((0.0, 0.0, 30.0)).translate((at[0], at[1], top - screw["nut_height_mm"]))
