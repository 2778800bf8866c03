"""The content of mechanics.json: the parts that make.py made, with the numbers for checks,
pictures, guide and casting sheet.
"""

from __future__ import annotations

from typing import Any

from mechanics import fits
from mechanics.catalog import Entry
from mechanics.layout import Fastener, Layout
from mechanics.parts.flange_plate import flange_screws
from mechanics.parts.indenter import exact_to
from mechanics.parts.jaw_mount import jaw_screws
from mechanics.parts.port_plate import anchors, potting_volume


def _screws(screws: tuple[Fastener, ...]) -> list[dict[str, Any]]:
    return [
        {
            "thread": screw.screw.name,
            "length_mm": screw.length,
            "at_mm": [round(v, 6) for v in screw.at],
            "seat_z_mm": round(screw.seat_z, 6),
            "nut_top_z_mm": round(screw.nut_top_z, 6),
            "nut_flats_mm": screw.screw.nut_flats,
            "nut_height_mm": screw.screw.nut_height,
            "head_radius_mm": screw.screw.head_radius,
            "head_height_mm": screw.screw.head_height,
            "is_sunk": screw.is_sunk,
        }
        for screw in screws
    ]


def manifest(layout: Layout, made: list[Entry]) -> dict[str, Any]:
    """The numbers, mm and mm³."""
    geometry = layout.geometry
    channels = [{"at_mm": list(layout.fill_at), "radius_mm": fits.FILL_RADIUS}]
    channels += [{"at_mm": list(at), "radius_mm": fits.VENT_RADIUS} for at in layout.vents_at]
    return {
        "variant": geometry.variant,
        "parts": [{"name": e.name, "used_in": list(e.used_in), "print_with": e.print_with} for e in made],
        "screws": {
            "sensor": _screws(layout.sensor_screws),
            "casting": _screws((*layout.casting_screws, *layout.clamp_screws)),
            "flange": _screws(flange_screws(layout)),
            "jaw": _screws(jaw_screws(layout)),
        },
        "levels_mm": {
            "rim": layout.rim_z,
            "parting": layout.parting_z,
            "cover": layout.cover_z,
            "board_bottom": layout.board.bottom_z,
            "lid_inside": layout.parts_z,
            "lid_bottom": layout.lid_z,
            "jig_bottom": layout.jig_z,
        },
        "outer_mm": [layout.outer.x0, layout.outer.y0, layout.outer.x1, layout.outer.y1],
        "gap_mm": layout.gap,
        "min_wall_mm": fits.MIN_WALL,
        "channels": channels,
        "anchors_at_mm": [list(at) for at in anchors(layout)],
        "gel_volume_mm3": geometry.gel.volume_mm3,
        "potting_volume_mm3": round(potting_volume(layout), 3),
        "indenters": [{"name": e.name, "exact_to_mm": round(exact_to(e), 6)} for e in geometry.indenters],
    }
