"""The port plate.

Its thickness is the height of a chip, so that the gel stands on a plane. Chips stand in its holes,
and silicone grips it.
"""

from __future__ import annotations

import math

from build123d import Part

from mechanics import fits
from mechanics.geometry import Point
from mechanics.layout import Layout
from mechanics.screws import M2
from mechanics.sketch import FAR, cone, plate_footprint, rod, rounded_box

ROUNDING = 0.5


def anchors(layout: Layout) -> list[Point]:
    """Locations at which silicone flows through the plate and grips it, as many as there is room
    for.

    Corners come first, then the short edges, the long ones and the inside, because a gel peels off
    from its corners.
    """
    rim = layout.gel.grown(-fits.ANCHOR_INSET)
    nx, ny = (round(2.0 * length) for length in (rim.x1 - rim.x0, rim.y1 - rim.y0))
    along_x = [rim.x0 + (rim.x1 - rim.x0) * i / nx for i in range(nx + 1)]
    along_y = [rim.y0 + (rim.y1 - rim.y0) * i / ny for i in range(ny + 1)]
    places = [(x, y) for y in (rim.y0, rim.y1) for x in (rim.x0, rim.x1)]
    places += [(x, y) for x in (rim.x0, rim.x1) for y in along_y]
    places += [(x, y) for y in (rim.y0, rim.y1) for x in along_x]
    places += [(x, y) for y in along_y for x in along_x]
    keep_off = fits.ANCHOR_BOTTOM_RADIUS + fits.MIN_WALL - 1e-9
    edge = layout.board_box.grown(-keep_off)
    found: list[Point] = []
    for place in places:
        is_free = all(hole.distance(place) >= keep_off for hole in layout.chip_holes) and edge.distance(place) == 0.0
        if is_free and all(math.dist(place, other) >= fits.ANCHOR_PITCH for other in found):
            found.append(place)
    return found


def port_plate(layout: Layout) -> Part:
    """The plate between board and gel."""
    low = layout.board.top_z
    plate = plate_footprint(layout, 0.0, low, 0.0)
    holes = [rounded_box(hole, ROUNDING, low - 1.0, 1.0) for hole in layout.chip_holes]
    holes += [cone(at, fits.ANCHOR_BOTTOM_RADIUS, fits.ANCHOR_TOP_RADIUS, low, 0.0) for at in anchors(layout)]
    holes += [rod(at, M2.hole_radius, -FAR, FAR) for at in layout.board.holes]
    return plate - holes


def potting_volume(layout: Layout) -> float:
    """Volume of the silicone below z = 0, mm³: around the chips and in the anchors.

    The recess in a chip's cap is unknown and not included.
    """
    height = -layout.board.top_z
    body_x, body_y = layout.geometry.chip.body
    hole = layout.chip_holes[0]
    around = (hole.x1 - hole.x0) * (hole.y1 - hole.y0) - (4.0 - math.pi) * ROUNDING**2 - body_x * body_y
    a, b = fits.ANCHOR_BOTTOM_RADIUS, fits.ANCHOR_TOP_RADIUS
    anchor = math.pi * height * (a * a + a * b + b * b) / 3.0
    return len(layout.geometry.taxels) * around * height + len(anchors(layout)) * anchor
