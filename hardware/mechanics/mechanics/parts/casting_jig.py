"""The casting jig: a bed for the board with its parts below. Port plate and mould are screwed to
it.
"""

from __future__ import annotations

from build123d import Part

from mechanics import fits
from mechanics.geometry import Part as BoardPart
from mechanics.layout import Layout, Rectangle
from mechanics.parts.mould_halves import CORNER
from mechanics.sketch import FAR, box, nut_trap, plate_footprint, rounded_box, screw_hole

# The jig's rim is lower than the port plate's face: the screws press the mould on the plate, not on
# the jig.
BELOW_PLATE = 0.5
# Width of the slots beside the board, for fingers.
FINGER_WIDTH = 16.0
# Width of the ledge on which the board lies.
LEDGE = 1.5


def _room(part: BoardPart) -> Rectangle:
    half_x, half_y = part.size[0] / 2 + 1.0, part.size[1] / 2 + 1.0
    x, y = part.center
    return Rectangle(x - half_x, y - half_y, x + half_x, y + half_y)


def casting_jig(layout: Layout) -> Part:
    """Makes the jig."""
    top = -BELOW_PLATE
    jig = rounded_box(layout.mould_box, CORNER, layout.jig_z, top, chamfers=(True, False))
    jig -= plate_footprint(layout, fits.FIT, layout.board.bottom_z, top + 1.0)
    inner = layout.board_box.grown(-LEDGE)
    # The board's ears lie on the jig; the board's parts are between them.
    ears = [hole[0] for hole in layout.board.holes]
    middle = layout.gel.center[0]
    x0 = max([x for x in ears if x < middle], default=inner.x0) + 3.0
    x1 = min([x for x in ears if x > middle], default=inner.x1) - 3.0
    jig -= box(Rectangle(max(x0, inner.x0), inner.y0, min(x1, inner.x1), inner.y1), layout.parts_z, FAR)
    for part in (*layout.board.parts, layout.board.connector):
        jig -= box(_room(part), layout.parts_z, FAR)
    center = layout.board_box.center[0]
    slot = Rectangle(
        center - FINGER_WIDTH / 2, layout.mould_box.y0 - 1.0, center + FINGER_WIDTH / 2, layout.mould_box.y1 + 1.0
    )
    jig -= box(slot, layout.board.bottom_z, FAR)
    for screw in (*layout.casting_screws, *layout.clamp_screws):
        jig -= screw_hole(screw) + nut_trap(screw, layout.jig_z)
    return jig
