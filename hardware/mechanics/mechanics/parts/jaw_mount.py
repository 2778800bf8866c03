"""A mount for the fixed jaw of the SO-101 gripper, held by straps.

The jaw was measured in its project's file (`Wrist_Roll_Follower_SO101.stl`,
TheRobotStudio/SO-ARM100, fda892c). It has two inner planes: one near the tip, 1.7 mm higher, 19.6
mm long and 21.6 mm wide, and one that is 34.2 mm long. The jaw's holes, and its width below the
lower plane, were not measured. Therefore the mount straddles the jaw near the tip only, and is held
by straps instead of screws. It has not been tried on a gripper.
"""

from __future__ import annotations

from build123d import Part

from mechanics import fits
from mechanics.layout import Fastener, Layout, Rectangle
from mechanics.sketch import box, nut_trap, rod, rounded_box

TIP_LENGTH, BASE_LENGTH, STEP = 19.6, 34.2, 1.7
JAW_WIDTH = 21.6
THICKNESS = 5.0
# Thickness of the material that holds the nuts of the lid's screws.
FLOOR = 2.0
CHEEK_WALL, CHEEK_HEIGHT = 2.4, 6.0
# Size of the slots for cable ties or hook-and-loop straps.
SLOT_LENGTH, SLOT_WIDTH = 6.0, 2.0


def jaw_screws(layout: Layout) -> tuple[Fastener, ...]:
    """The screws from the lid into the mount."""
    return layout.mount_screws(THICKNESS, FLOOR)


def jaw_mount(layout: Layout) -> Part:
    """A plate below the lid; the jaw's tip is at +x."""
    x, y = layout.outer.center
    top = layout.lid_z
    under = top - THICKNESS
    tip = x + (TIP_LENGTH + BASE_LENGTH) / 2
    step, back = tip - TIP_LENGTH, tip - TIP_LENGTH - BASE_LENGTH
    inner = JAW_WIDTH / 2 + fits.HOLE_FIT
    cheek = inner + CHEEK_WALL
    half = cheek + SLOT_WIDTH + 2 * fits.MIN_WALL
    mount = rounded_box(Rectangle(back, y - half, tip, y + half), 3.0, under, top)
    mount += box(Rectangle(back + 3.0, y - inner, step, y + inner), under - STEP, under + 1.0)
    for side in (-1, 1):
        low, high = sorted((y + side * inner, y + side * cheek))
        mount += box(Rectangle(step + 1.0, low, tip - 3.0, high), under - CHEEK_HEIGHT, under + 1.0)
        middle = y + side * (cheek + fits.MIN_WALL / 2 + SLOT_WIDTH / 2)
        for at in (step + TIP_LENGTH / 2, back + 10.0):
            slot = Rectangle(
                at - SLOT_LENGTH / 2, middle - SLOT_WIDTH / 2, at + SLOT_LENGTH / 2, middle + SLOT_WIDTH / 2
            )
            mount -= box(slot, under - 1.0, top + 1.0)
    for screw in jaw_screws(layout):
        mount -= rod(screw.at, screw.screw.hole_radius, under - 20.0, top + 1.0) + nut_trap(screw, under - STEP)
    return mount
