"""The mould's two halves: walls around the gel's upright sides, divided from corner to corner.

Each half has one long and one short wall and is removed diagonally. So no wall slides along the
gel, and neither draft nor force is needed.
"""

from __future__ import annotations

from build123d import Part

from mechanics import fits
from mechanics.layout import Layout, Rectangle
from mechanics.parts.gel import gel
from mechanics.screws import M2
from mechanics.sketch import FAR, box, cone, prism, rod, rounded_box, screw_hole

# Round corners for a cable tie around both halves; the groove fits ties up to 3.6 mm wide.
CORNER = 6.0
TIE_WIDTH, TIE_DEPTH = 4.2, 1.2
# A pin on each half, on which the cover sits.
PIN_RADIUS, PIN_HEIGHT = 2.0, 2.0


def pins_at(layout: Layout) -> tuple[tuple[float, float], tuple[float, float]]:
    """Locations of the pins: at the middles of the long walls, that of half A first."""
    x = layout.gel.center[0]
    return ((x, layout.clamp_y[0]), (x, layout.clamp_y[1]))


def _walls(layout: Layout) -> Part:
    walls = rounded_box(layout.mould_box, CORNER, 0.0, layout.parting_z)
    middle = layout.parting_z / 2
    around = layout.mould_box.grown(-TIE_DEPTH)
    groove = box(layout.mould_box.grown(1.0), middle - TIE_WIDTH / 2, middle + TIE_WIDTH / 2)
    walls -= groove - rounded_box(around, CORNER - TIE_DEPTH, middle - TIE_WIDTH, middle + TIE_WIDTH)
    walls -= gel(layout.geometry.gel)
    for screw in layout.casting_screws:
        walls -= screw_hole(screw) + rod(screw.at, M2.head_radius + 2 * fits.HOLE_FIT, screw.seat_z, FAR)
    for screw in layout.clamp_screws:
        walls -= screw_hole(screw)
    for at in pins_at(layout):
        top = layout.parting_z + PIN_HEIGHT
        walls += rod(at, PIN_RADIUS, layout.parting_z - 1.0, top - 0.6) + cone(
            at, PIN_RADIUS, PIN_RADIUS - 0.6, top - 0.6, top
        )
    return walls


def _lower_left(layout: Layout) -> Part:
    """Everything below the seam, which leaves the gel's corners at 45°."""
    r, far = layout.gel, FAR
    a, b = (r.x0, r.y1), (r.x1, r.y0)
    corners = [a, (a[0] - far, a[1] + far), (a[0] - far, b[1] - far), (b[0] + far, b[1] - far), b]
    return prism(corners, -1.0, layout.parting_z + PIN_HEIGHT + 1.0)


def mould_half_a(layout: Layout) -> Part:
    """The walls at low x and low y."""
    return _walls(layout) & _lower_left(layout)


def mould_half_b(layout: Layout) -> Part:
    """The walls at high x and high y."""
    return _walls(layout) - _lower_left(layout)


def footprint(layout: Layout) -> Rectangle:
    """Outline of the mould."""
    return layout.mould_box
