"""Indenters: the shapes of the description, on a shank of 8 mm with a hole for an M4 thread.

A shape is exact up to the height `exact_to`; above it the shank or its collar joins. The frame is
that of the shape: z = 0 is the point of first touch, and the shape is above it.
"""

from __future__ import annotations

import math

from build123d import Axis, Kind, Part, Pos, Rot, Sphere, Wire, extrude, fillet, make_face, offset

from mechanics.geometry import GeometryError, Indenter
from mechanics.layout import Rectangle
from mechanics.sketch import box, cone, prism, rod

SHANK_RADIUS, SHANK_LENGTH = 4.0, 20.0
# The hole is tapped to M4, or used with a self-cutting screw.
THREAD_RADIUS, THREAD_DEPTH = 1.65, 12.0
CENTER = (0.0, 0.0)
KINDS = ("sphere", "cylinder", "box", "x", "ring", "triangle", "wedge")


def indenter(of: Indenter) -> Part:
    """Makes an indenter: shape, collar, shank."""
    solid, height, collar = _shape(of)
    joint = height - float(of.shape.get("edge_radius_mm", 0.0))
    if of.shape["kind"] == "sphere":
        joint = height / 2
    if collar > SHANK_RADIUS:
        solid += rod(CENTER, collar, joint, height + 1.0)
        solid += cone(CENTER, collar, SHANK_RADIUS, height + 1.0, height + 1.0 + collar - SHANK_RADIUS)
    end = height + SHANK_LENGTH
    solid += rod(CENTER, SHANK_RADIUS, joint, end - 0.5) + cone(
        CENTER, SHANK_RADIUS, SHANK_RADIUS - 0.5, end - 0.5, end
    )
    return solid - rod(CENTER, THREAD_RADIUS, end - THREAD_DEPTH, end + 1.0)


def exact_to(of: Indenter) -> float:
    """Height up to which the printed form is the described one, mm."""
    if of.shape["kind"] == "sphere":
        radius = _length(of, "radius_mm")
        return radius + math.sqrt(max(radius**2 - SHANK_RADIUS**2, 0.0)) - 0.1
    return (
        _length(of, "height_mm" if of.shape["kind"] != "box" else "size_mm")
        - float(of.shape.get("edge_radius_mm", 0.0))
        - 0.05
    )


def _length(of: Indenter, name: str) -> float:
    found = of.shape.get(name)
    if name == "size_mm" and isinstance(found, (list, tuple)) and len(found) == 3:
        found = found[2]
    if not isinstance(found, (int, float)) or found < 0.0:
        raise GeometryError(f"indenters `{of.name}`: shape.{name}: expected a length, found {found!r}")
    return float(found)


def _shape(of: Indenter) -> tuple[Part, float, float]:
    """The described solid, its height, and the radius of a collar that carries the shank."""
    kind = of.shape.get("kind")
    if kind not in KINDS:
        raise GeometryError(
            f"indenters `{of.name}`: shape.kind: `{kind}` has no STEP: print its own file, or leave it out"
        )
    if kind == "sphere":
        radius = _length(of, "radius_mm")
        return Pos(0.0, 0.0, radius) * Sphere(radius), 2 * radius, 0.0
    height, edge = _length(of, "size_mm" if kind == "box" else "height_mm"), _length(of, "edge_radius_mm")
    if kind == "cylinder":
        return _rounded(rod(CENTER, _length(of, "radius_mm"), 0.0, height), edge), height, 0.0
    if kind == "box":
        half_x, half_y = (float(side) / 2 for side in of.shape["size_mm"][:2])
        return _rounded(box(Rectangle(-half_x, -half_y, half_x, half_y), 0.0, height), edge), height, 0.0
    if kind == "ring":
        outer = _length(of, "outer_radius_mm")
        tube = rod(CENTER, outer, 0.0, height) - rod(CENTER, _length(of, "inner_radius_mm"), -1.0, height + 1.0)
        return _rounded(tube, edge), height, outer - edge
    if kind == "triangle":
        reach = _length(of, "side_mm") / math.sqrt(3.0)
        turns = (0.0, 2.0 * math.pi / 3.0, 4.0 * math.pi / 3.0)
        return (
            _rounded(prism([(reach * math.cos(a), reach * math.sin(a)) for a in turns], 0.0, height), edge),
            height,
            0.0,
        )
    if kind == "wedge":
        return _wedge(of, height, edge), height, 0.0
    return _cross(of, height, edge), height, 0.0


def _rounded(sharp: Part, edge: float) -> Part:
    """The solid with all edges rounded. If all edges are convex, it equals a smaller solid that is
    grown by a ball.
    """
    return fillet(sharp.edges(), edge) if edge > 0.0 else sharp


def _wedge(of: Indenter, height: float, edge: float) -> Part:
    """A roof that lies along y.

    The profile, grown by the edges' radius, has sharp corners here, which are then rounded.
    """
    tangent = math.tan(_length(of, "angle_rad") / 2.0)
    top = height - edge
    half = (top - edge) * tangent
    corners = [(0.0, 0.0, edge), (half, 0.0, top), (-half, 0.0, top)]
    profile = make_face(Wire.make_polygon(corners, close=True))
    if edge > 0.0:
        profile = offset(profile, edge, kind=Kind.INTERSECTION)
    length = _length(of, "length_mm")
    solid = extrude(profile, length / 2, both=True, dir=(0, 1, 0))
    return _rounded(solid, edge)


def _cross(of: Indenter, height: float, edge: float) -> Part:
    """Two crossed bars along the diagonals; the inner corners have the radius of the edges, as far
    as there is room.
    """
    half_length, half_width = _length(of, "length_mm") / 2, _length(of, "width_mm") / 2
    bars = box(Rectangle(-half_length, -half_width, half_length, half_width), 0.0, height)
    bars += box(Rectangle(-half_width, -half_length, half_width, half_length), 0.0, height)
    if edge > 0.0:
        hollow = min(2.0 * edge, half_length - half_width) - edge
        upright = bars.edges().filter_by(Axis.Z)
        inner = [
            e
            for e in upright
            if abs(abs(e.center().X) - half_width) < 1e-6 and abs(abs(e.center().Y) - half_width) < 1e-6
        ]
        if hollow > 0.0:
            bars = fillet(inner, hollow)
        bars = _round_convex(bars, edge, half_length)
    return Rot(0.0, 0.0, 45.0) * bars


def _round_convex(bars: Part, edge: float, half_length: float) -> Part:
    """Rounds the rims and the bars' outer corners, but not the inner corners."""
    rims = [*bars.edges().group_by(Axis.Z)[0], *bars.edges().group_by(Axis.Z)[-1]]
    outer = [
        e for e in bars.edges().filter_by(Axis.Z) if max(abs(e.center().X), abs(e.center().Y)) > half_length - 1e-6
    ]
    return fillet([*rims, *outer], edge)
