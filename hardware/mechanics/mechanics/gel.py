"""The gel's form: heights of its top, as the crates `shape` and `description` define them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from mechanics.geometry import Gel, GeometryError

Ends = tuple[float, float]


def fall_curvature(ends: Ends, crown_at: float, drop: Ends) -> Ends:
    """Curvatures of a dome's descent along one axis, 1/mm, towards low and high coordinates.

    A curvature is 0 if the crown is above the edge.
    """
    reaches = (crown_at - ends[0], ends[1] - crown_at)
    low, high = (fall / reach**2 if reach > 0.0 else 0.0 for fall, reach in zip(drop, reaches, strict=True))
    return (low, high)


def ends(solid: Mapping[str, Any], name: str) -> Ends:
    """A field of two numbers. Raises `GeometryError` for anything else."""
    found = solid.get(name)
    if not isinstance(found, (list, tuple)) or len(found) != 2:
        raise GeometryError(f"gel.solid.{name}: expected two numbers, found {found!r}")
    return (float(found[0]), float(found[1]))


def edge_radius(gel: Gel) -> float:
    """Rounding of a block's top edges, mm."""
    return float(gel.solid.get("edge_radius_mm", 0.0))


def top_height(gel: Gel, x: float, y: float) -> float:
    """Height of the gel's top at a location within its footprint, mm."""
    solid = gel.solid
    if kind(gel) == "block":
        radius = edge_radius(gel)
        center = ((gel.low[0] + gel.high[0]) / 2, (gel.low[1] + gel.high[1]) / 2)
        over = max(abs(x - center[0]) - gel.size[0] / 2, abs(y - center[1]) - gel.size[1] / 2)
        into = max(over + radius, 0.0)
        return gel.high[2] - radius + math.sqrt(max(radius**2 - into**2, 0.0))
    height = float(solid["crown_mm"])
    for axis, at in (("x", x), ("y", y)):
        crown = ends(solid, "crown_at_mm")[0 if axis == "x" else 1]
        low, high = fall_curvature(ends(solid, f"{axis}_mm"), crown, ends(solid, f"drop_{axis}_mm"))
        height -= (high if at > crown else low) * (at - crown) ** 2
    return height


def edge_height(gel: Gel) -> float:
    """Height of the lowest point of the top's rim, mm: below it all sides are upright."""
    corners = [(x, y) for x in (gel.low[0], gel.high[0]) for y in (gel.low[1], gel.high[1])]
    return min(top_height(gel, x, y) for x, y in corners)


def kind(gel: Gel) -> str:
    """The kind of the gel, `block` or `dome`. Raises `GeometryError` for anything else."""
    found = gel.solid.get("kind")
    if found not in ("block", "dome"):
        raise GeometryError(f"gel.solid.kind: only `block` and `dome` have a mould, found {found!r}")
    return str(found)
