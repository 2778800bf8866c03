"""The basic solids of all parts, made with build123d."""

from __future__ import annotations

import math

from build123d import (
    Axis,
    Cone,
    Cylinder,
    Kind,
    Part,
    Plane,
    Pos,
    RectangleRounded,
    RegularPolygon,
    Rot,
    Wire,
    chamfer,
    extrude,
    make_face,
    offset,
)
from build123d import Box as _Box
from build123d import Rectangle as RectangleFace

from mechanics import fits
from mechanics.geometry import Point
from mechanics.layout import Fastener, Layout, Rectangle

# Half length of cuts that go through everything.
FAR = 200.0


def box(r: Rectangle, z0: float, z1: float) -> Part:
    """A block."""
    x, y = r.center
    return Pos(x, y, (z0 + z1) / 2) * _Box(r.x1 - r.x0, r.y1 - r.y0, z1 - z0)


def rounded_box(
    r: Rectangle, radius: float, z0: float, z1: float, chamfers: tuple[bool, bool] = (False, False)
) -> Part:
    """A block with round upright edges, and chamfers at the bottom or the top on request."""
    x, y = r.center
    solid = extrude(Plane.XY.offset(z0) * Pos(x, y) * RectangleRounded(r.x1 - r.x0, r.y1 - r.y0, radius), z1 - z0)
    for is_wanted, which in zip(chamfers, (0, -1), strict=True):
        if is_wanted:
            solid = chamfer(solid.edges().group_by(Axis.Z)[which], fits.CHAMFER)
    return solid


def prism(corners: tuple[Point, ...] | list[Point], z0: float, z1: float) -> Part:
    """An extruded polygon."""
    face = make_face(Wire.make_polygon([(x, y, z0) for x, y in corners], close=True))
    return extrude(face, z1 - z0, dir=(0, 0, 1))


def plate_footprint(layout: Layout, by: float, z0: float, z1: float) -> Part:
    """The outline of board and port plate, grown by a clearance and extruded."""
    face = make_face(Wire.make_polygon([(x, y, 0.0) for x, y in layout.board.outline], close=True))
    for patch in layout.plate_patches:
        x, y = patch.center
        face = face + Pos(x, y) * RectangleFace(patch.x1 - patch.x0, patch.y1 - patch.y0)
    if by > 0.0:
        face = offset(face, by, kind=Kind.INTERSECTION)
    return extrude(Pos(0.0, 0.0, z0) * face, z1 - z0, dir=(0, 0, 1))


def rod(at: Point, radius: float, z0: float, z1: float) -> Part:
    """An upright cylinder."""
    return Pos(at[0], at[1], (z0 + z1) / 2) * Cylinder(radius, z1 - z0)


def cone(at: Point, radius0: float, radius1: float, z0: float, z1: float) -> Part:
    """An upright cone with radii at its lower and its upper end."""
    return Pos(at[0], at[1], (z0 + z1) / 2) * Cone(radius0, radius1, z1 - z0)


def hexagon(at: Point, flats: float, z0: float, z1: float) -> Part:
    """An upright hexagonal prism with flats towards ±x, so that walls at the ends of parts stay
    thick.
    """
    profile = Pos(at[0], at[1]) * Rot(0, 0, 30) * RegularPolygon(flats / math.sqrt(3.0), 6)
    return extrude(Plane.XY.offset(z0) * profile, z1 - z0)


def nut_trap(fastener: Fastener, bottom_z: float) -> Part:
    """A cavity for a nut, open downward."""
    return hexagon(fastener.at, fastener.screw.nut_flats + fits.FIT, bottom_z - 1.0, fastener.nut_top_z)


def screw_hole(fastener: Fastener) -> Part:
    """A clearance hole through everything."""
    return rod(fastener.at, fastener.screw.hole_radius, -FAR, FAR)


__all__ = ["FAR", "box", "cone", "hexagon", "nut_trap", "plate_footprint", "prism", "rod", "rounded_box", "screw_hole"]
