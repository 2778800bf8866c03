"""A plate between the lid and the flange of a robot, ISO 9409-1-50-4-M6: four M6 on 50 mm, centring
31.5 mm, pin 6 mm.

The sizes of the flange have not been compared with the text of the standard or with a robot:
measure your flange first.
"""

from __future__ import annotations

import math

from build123d import Part

from mechanics import fits
from mechanics.geometry import Point
from mechanics.layout import Fastener, Layout
from mechanics.screws import M6
from mechanics.sketch import FAR, cone, nut_trap, rod

RADIUS = 31.5
THICKNESS = 10.0
PITCH_RADIUS = 25.0
CENTRING_RADIUS, CENTRING_HEIGHT = 15.75, 3.0
PIN_RADIUS, PIN_DEPTH = 3.0, 6.5
# Thickness of the material that holds the nuts of the lid's screws.
FLOOR = 4.0


def flange_screws(layout: Layout) -> tuple[Fastener, ...]:
    """The screws from the lid into the plate."""
    return layout.mount_screws(THICKNESS, FLOOR)


def bolts_at(layout: Layout) -> list[Point]:
    """Locations of the M6 bolts: at 45°, so that the long side of the sensor lies between them."""
    x, y = layout.outer.center
    reach = PITCH_RADIUS / math.sqrt(2.0)
    return [(x + sx * reach, y + sy * reach) for sy in (-1, 1) for sx in (-1, 1)]


def flange_plate(layout: Layout) -> Part:
    """A disc with recessed bolt heads: the bolts are tightened before the sensor is mounted."""
    at, top = layout.outer.center, layout.lid_z
    low = top - THICKNESS
    disc = rod(at, RADIUS, low + fits.CHAMFER, top) + cone(at, RADIUS - fits.CHAMFER, RADIUS, low, low + fits.CHAMFER)
    boss = CENTRING_RADIUS - fits.FIT / 2
    end = low - CENTRING_HEIGHT
    disc += rod(at, boss, end + fits.CHAMFER, low + 1.0) + cone(at, boss - fits.CHAMFER, boss, end, end + fits.CHAMFER)
    for bolt in bolts_at(layout):
        head = rod(bolt, M6.head_radius + fits.HOLE_FIT, top - M6.head_height - 0.5, FAR)
        disc -= rod(bolt, M6.hole_radius, -FAR, FAR) + head
    disc -= rod((at[0] + PITCH_RADIUS, at[1]), PIN_RADIUS + fits.FIT / 2, low - 1.0, low + PIN_DEPTH)
    for screw in flange_screws(layout):
        disc -= rod(screw.at, screw.screw.hole_radius, -FAR, FAR) + nut_trap(screw, low - CENTRING_HEIGHT)
    return disc
