"""Checks that walls are thick enough to print.

Method: from points spread evenly over the surface (always the same points), a ray goes inward along
the normal. If it leaves through a face whose normal differs from the ray by at most 30°, its length
is the thickness of a wall; else it met a corner or a cone, which does not count. Walls that are
thinner than the distance of the points, about half a millimetre, can be missed at their narrowest
location.
"""

from __future__ import annotations

import math

import numpy as np
import trimesh

from checks.files import Made
from checks.finding import Row
from checks.rays import Surface

POINTS = 4000
OPPOSITE = math.cos(math.radians(30.0))
# Depth of the rays' start points below the surface, mm.
BELOW = 1e-4


def thickness(mesh: trimesh.Trimesh) -> tuple[float, tuple[float, float, float]]:
    """The thinnest wall that was found, mm, and its location."""
    random = np.random.default_rng(0)
    points, faces = trimesh.sample.sample_surface(mesh, POINTS, seed=random)
    surface = Surface(mesh)
    reach = float(np.linalg.norm(mesh.extents))
    least, where = math.inf, (math.nan, math.nan, math.nan)
    for point, face in zip(np.asarray(points), np.asarray(faces), strict=True):
        inward = -mesh.face_normals[face]
        hit = surface.first_hit(point + BELOW * inward, inward, reach)
        if hit and hit[0] + BELOW < least and mesh.face_normals[hit[1]] @ inward >= OPPOSITE:
            least, where = hit[0] + BELOW, (float(point[0]), float(point[1]), float(point[2]))
    return least, where


def check(made: Made) -> list[Row]:
    """A row for each print."""
    rows = []
    for name, mesh in made.meshes.items():
        if name == "gel":
            continue
        allowed = made.figures["min_wall_mm"]
        if name == "port-plate":  # as thick as a chip is high, whatever that is
            allowed = min(allowed, made.geometry.chip.height)
        least, where = thickness(mesh)
        place = ", ".join(f"{at:.1f}" for at in where)
        rows.append(
            Row("thinnest wall", name, f"{least:.2f} mm at {place}", f">= {allowed:g} mm", least >= allowed - 0.01)
        )
    return rows
