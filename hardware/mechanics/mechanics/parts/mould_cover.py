"""The mould's cover: the form of the gel's top, with a fill hole for a syringe and vents."""

from __future__ import annotations

from build123d import Part

from mechanics import fits
from mechanics.layout import Layout
from mechanics.parts.gel import gel
from mechanics.parts.mould_halves import CORNER, PIN_HEIGHT, PIN_RADIUS, pins_at
from mechanics.sketch import cone, rod, rounded_box, screw_hole


def mould_cover(layout: Layout) -> Part:
    """The cover on the halves.

    It is lifted straight up. It needs no draft: the gel's sides are upright there, and silicone is
    soft.
    """
    low, top = layout.parting_z, layout.cover_z
    cover = rounded_box(layout.mould_box, CORNER, low, top, chamfers=(False, True))
    cover -= gel(layout.geometry.gel)
    for screw in layout.clamp_screws:
        cover -= screw_hole(screw)
    for at in pins_at(layout):
        cover -= rod(at, PIN_RADIUS + fits.FIT / 2, low - 1.0, low + PIN_HEIGHT + 0.5)
    at = layout.fill_at
    cover -= rod(at, fits.FILL_RADIUS, low - 1.0, top + 1.0)
    cover -= cone(at, fits.FILL_RADIUS, fits.FILL_CONE_RADIUS, top - fits.FILL_CONE_HEIGHT, top)
    for vent in layout.vents_at:
        cover -= rod(vent, fits.VENT_RADIUS, low - 1.0, top + 1.0)
    return cover
