"""Checks that printed indenters have the described form, up to where the shank joins.

Method: the signed distance of the description is evaluated at points of the file's surface. In the
other direction, points near the described surface are moved onto it along the gradient, and their
distances from the file's surface are measured. The largest distance counts.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import trimesh

from checks.files import Made
from checks.finding import Row
from checks.rays import Surface
from checks.shapes import Array, distance

POINTS = 3000
ALLOWED = 0.05


def described_points(shape: Mapping[str, Any], low: Array, high: Array) -> Array:
    """Points of the described surface within a box."""
    random = np.random.default_rng(1)
    points = low + (high - low) * random.random((4 * POINTS, 3))
    for _ in range(4):
        steps = 1e-5 * np.eye(3)
        gradient = np.column_stack([(distance(shape, points + s) - distance(shape, points - s)) / 2e-5 for s in steps])
        points = points - distance(shape, points)[:, None] * gradient
    is_near = np.abs(distance(shape, points)) < 1e-3
    return np.asarray(points[is_near])


def form_error(mesh: trimesh.Trimesh, shape: Mapping[str, Any], exact_to: float) -> float:
    """Largest distance between the file and the described shape below a height, mm."""
    random = np.random.default_rng(0)
    sampled = np.asarray(trimesh.sample.sample_surface(mesh, 3 * POINTS, seed=random)[0])
    sampled = sampled[sampled[:, 2] <= exact_to]
    if not len(sampled):
        return float("inf")
    of_file = float(np.abs(distance(shape, sampled)).max())
    margin = 0.2 * mesh.extents.max()
    low, high = mesh.bounds[0] - margin, np.append(mesh.bounds[1][:2] + margin, exact_to)
    points = described_points(shape, low, high)
    points = points[points[:, 2] <= exact_to]
    surface = Surface(mesh)
    of_shape = max(surface.distance(point) for point in points[:POINTS])
    return max(of_file, of_shape)


def check(made: Made) -> list[Row]:
    """A row for each indenter."""
    exact = {each["name"]: each["exact_to_mm"] for each in made.figures["indenters"]}
    rows = []
    for indenter in made.geometry.indenters:
        error = form_error(made.meshes[f"indenter-{indenter.name}"], indenter.shape, exact[indenter.name])
        found = f"{error:.4f} mm off, up to z = {exact[indenter.name]:.2f} mm"
        rows.append(Row("described form", f"indenter-{indenter.name}", found, f"<= {ALLOWED} mm", error <= ALLOWED))
    return rows
