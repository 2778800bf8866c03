"""The shell: a frame around the sides of gel and board, put over them from above. The lid closes it
at the bottom.
"""

from __future__ import annotations

from build123d import Part

from mechanics import fits
from mechanics.layout import Layout, Rectangle
from mechanics.screws import M2
from mechanics.sketch import FAR, box, plate_footprint, rod, rounded_box, screw_hole

# Clearance beside the connector, so that a plug's housing passes.
PLUG_GAP = 1.0


def shell(layout: Layout) -> Part:
    """Walls of the described height at the described gap.

    Ears over the board's ends contain the heads of the screws.
    """
    frame = rounded_box(layout.outer, layout.corner, layout.parts_z, layout.rim_z, chamfers=(False, True))
    frame -= plate_footprint(layout, fits.FIT, layout.parts_z - 1.0, 0.0)
    frame -= box(layout.opening, -1.0, layout.rim_z + 1.0)
    for screw in layout.sensor_screws:
        frame -= screw_hole(screw) + rod(screw.at, M2.head_radius + fits.HOLE_FIT, screw.seat_z, FAR)
    return frame - cable_exit(layout)


def cable_exit(layout: Layout) -> Part:
    """A slot in front of the connector, open towards the lid."""
    connector, toward = layout.board.connector, layout.board.opens_toward
    half = [size / 2 + PLUG_GAP for size in connector.size[:2]]
    x0, y0 = connector.center[0] - half[0], connector.center[1] - half[1]
    slot = Rectangle(x0, y0, x0 + 2 * half[0], y0 + 2 * half[1])
    outside = layout.outer.grown(1.0)
    if toward[0]:
        slot = (
            Rectangle(slot.x0, slot.y0, outside.x1, slot.y1)
            if toward[0] > 0
            else Rectangle(outside.x0, slot.y0, slot.x1, slot.y1)
        )
    else:
        slot = (
            Rectangle(slot.x0, slot.y0, slot.x1, outside.y1)
            if toward[1] > 0
            else Rectangle(slot.x0, outside.y0, slot.x1, slot.y1)
        )
    return box(slot, layout.parts_z - 1.0, layout.board.bottom_z)
