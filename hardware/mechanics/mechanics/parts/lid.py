"""The lid: the bottom plate, with the nuts of the screws that hold shell, port plate and board."""

from __future__ import annotations

import math

from build123d import Part

from mechanics import fits
from mechanics.layout import Layout
from mechanics.screws import M2, M3, M3_SUNK_HEIGHT, M3_SUNK_RADIUS
from mechanics.sketch import cone, nut_trap, plate_footprint, rod, rounded_box, screw_hole


def lid(layout: Layout) -> Part:
    """A plate with a post below each ear of the board, and two countersunk holes for the screws of
    a mount.
    """
    plate = rounded_box(layout.outer, layout.corner, layout.lid_z, layout.parts_z, chamfers=(True, False))
    inside = plate_footprint(layout, 0.0, layout.parts_z, layout.board.bottom_z)
    # The corners of the trap reach beyond the post, so they have their own wall above.
    corner = (M2.nut_flats + fits.FIT) / math.sqrt(3.0)
    for screw in layout.sensor_screws:
        post = rod(screw.at, M2.hole_radius + fits.MIN_WALL, layout.parts_z - 0.5, layout.board.bottom_z)
        collar = rod(screw.at, corner + 0.1, screw.nut_top_z, screw.nut_top_z + fits.MIN_WALL)
        plate += (post + collar) & inside
    for screw in layout.sensor_screws:
        plate -= screw_hole(screw) + nut_trap(screw, layout.lid_z)
    for at in layout.mount_points:
        seat = layout.sunk_z
        head = cone(at, M3.hole_radius, M3_SUNK_RADIUS, seat - M3_SUNK_HEIGHT, seat) + rod(
            at, M3_SUNK_RADIUS, seat, layout.parts_z + 1.0
        )
        plate -= [rod(at, M3.hole_radius, layout.lid_z - 1.0, seat), head]
    return plate
