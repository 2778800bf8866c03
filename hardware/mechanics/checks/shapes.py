"""Signed distances to the described indenters, mm: the definitions of the crate `shape`, for many
points at once.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]


def distance(shape: Mapping[str, Any], points: Array) -> Array:
    """Signed distances, mm, negative inside; exact outside and near the surface."""
    kind = shape["kind"]
    if kind == "sphere":
        radius = shape["radius_mm"]
        return np.asarray(np.linalg.norm(points - [0.0, 0.0, radius], axis=1) - radius)
    height, edge = (shape["size_mm"][2] if kind == "box" else shape["height_mm"]), shape["edge_radius_mm"]
    if kind == "wedge":
        tangent = math.tan(shape["angle_rad"] / 2)
        half = (height - 2 * edge) * tangent
        corners = [(0.0, edge), (half, height - edge), (-half, height - edge)]
        profile = _convex(corners, points[:, [0, 2]])
        return np.asarray(_extruded(profile, np.abs(points[:, 1]) - (shape["length_mm"] / 2 - edge)) - edge)
    profile = _profile(shape, kind, edge, points[:, :2])
    return np.asarray(_extruded(profile, np.abs(points[:, 2] - height / 2) - (height / 2 - edge)) - edge)


def _profile(shape: Mapping[str, Any], kind: str, edge: float, at: Array) -> Array:
    radius = np.hypot(at[:, 0], at[:, 1])
    if kind == "cylinder":
        return np.asarray(radius - (shape["radius_mm"] - edge))
    if kind == "ring":
        return np.asarray(
            np.maximum(radius - (shape["outer_radius_mm"] - edge), shape["inner_radius_mm"] + edge - radius)
        )
    if kind == "box":
        half = [side / 2 - edge for side in shape["size_mm"][:2]]
        return _convex([(-half[0], -half[1]), (half[0], -half[1]), (half[0], half[1]), (-half[0], half[1])], at)
    if kind == "triangle":
        reach = 2 * (shape["side_mm"] / (2 * math.sqrt(3)) - edge)
        turns = [2 * math.pi * third / 3 for third in range(3)]
        return _convex([(reach * math.cos(turn), reach * math.sin(turn)) for turn in turns], at)
    if kind == "x":
        return _cross(shape["length_mm"] / 2 - edge, shape["width_mm"] / 2 - edge, 2 * edge, at)
    raise ValueError(f"no distance is known for the shape `{kind}`")


def _cross(half_length: float, half_width: float, hollow: float, at: Array) -> Array:
    """Crossed bars along the diagonals, with rounded inner corners."""
    hollow = min(hollow, half_length - half_width)
    c = math.sqrt(0.5)
    folded = np.sort(np.abs(at @ np.array([[c, c], [-c, c]])), axis=1)[:, ::-1]
    center = half_width + hollow
    beyond = folded - [half_length, half_width]
    side = np.where(folded[:, 0] < center, hollow - np.linalg.norm(folded - center, axis=1), beyond[:, 1])
    outside = np.linalg.norm(beyond, axis=1)
    return np.asarray(np.where((beyond > 0).all(axis=1), outside, np.maximum(side, beyond[:, 0])))


def _convex(corners: list[tuple[float, float]], at: Array) -> Array:
    """Signed distance to a convex polygon with counterclockwise corners."""
    lines, nearest = np.full(len(at), -np.inf), np.full(len(at), np.inf)
    for index, start in enumerate(corners):
        a = np.array(start)
        edge = np.array(corners[(index + 1) % len(corners)]) - a
        normal = np.array([edge[1], -edge[0]]) / np.linalg.norm(edge)
        away = at - a
        lines = np.maximum(lines, away @ normal)
        along = np.clip(away @ edge / (edge @ edge), 0.0, 1.0)
        nearest = np.minimum(nearest, np.linalg.norm(away - along[:, None] * edge, axis=1))
    return np.where(lines <= 0.0, lines, nearest)


def _extruded(profile: Array, level: Array) -> Array:
    """Signed distance to the intersection of an endless profile and a slab."""
    return np.where((profile > 0) & (level > 0), np.hypot(profile, level), np.maximum(profile, level))
