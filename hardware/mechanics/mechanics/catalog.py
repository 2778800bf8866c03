"""The parts of a sensor: their names, their assemblies, and how they are printed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from build123d import Part

from mechanics.geometry import Indenter
from mechanics.layout import Layout
from mechanics.parts.casting_jig import casting_jig
from mechanics.parts.flange_plate import flange_plate
from mechanics.parts.gel import gel
from mechanics.parts.indenter import indenter
from mechanics.parts.jaw_mount import jaw_mount
from mechanics.parts.lid import lid
from mechanics.parts.mould_cover import mould_cover
from mechanics.parts.mould_halves import mould_half_a, mould_half_b
from mechanics.parts.port_plate import port_plate
from mechanics.parts.shell import shell


@dataclass(frozen=True)
class Entry:
    """A part: the name of its files, the function that makes it, the assemblies that contain it,
    and the face that lies on the printer's bed.
    """

    name: str
    make: Callable[[Layout], Part]
    used_in: tuple[str, ...]
    print_with: str


# Assemblies: sets of parts that are checked against each other and shown together.
SENSOR, CASTING, FLANGE, JAW = "sensor", "casting", "flange", "jaw"
GEL = "gel"


def _gel(layout: Layout) -> Part:
    return gel(layout.geometry.gel)


PARTS = (
    Entry(
        "port-plate", port_plate, (SENSOR, CASTING, FLANGE, JAW), "upper face on the bed: it is what the gel stands on"
    ),
    Entry("shell", shell, (SENSOR, FLANGE, JAW), "upper face on the bed"),
    Entry("lid", lid, (SENSOR, FLANGE, JAW), "lower face on the bed; the nut traps' roofs are bridges"),
    Entry("mould-half-a", mould_half_a, (CASTING,), "lower face on the bed"),
    Entry("mould-half-b", mould_half_b, (CASTING,), "lower face on the bed"),
    Entry("mould-cover", mould_cover, (CASTING,), "flat gel: lower face on the bed; dome: upper face on the bed"),
    Entry("casting-jig", casting_jig, (CASTING,), "lower face on the bed; the nut traps' roofs are bridges"),
    Entry(
        "flange-plate", flange_plate, (FLANGE,), "upper face on the bed; the floors above the bolts' bores are bridges"
    ),
    Entry("jaw-mount", jaw_mount, (JAW,), "upper face on the bed"),
)


def entries(layout: Layout) -> list[Entry]:
    """All parts of a variant: printed parts, the gel's form for pictures and checks, indenters."""
    made = [*PARTS, Entry(GEL, _gel, (SENSOR, CASTING, FLANGE, JAW), "not printed: the form that is cast")]
    for each in layout.geometry.indenters:
        made.append(
            Entry(f"indenter-{each.name}", _maker(each), (), "the shank's end on the bed, with supports, 0.1 mm layers")
        )
    return made


def _maker(each: Indenter) -> Callable[[Layout], Part]:
    return lambda _: indenter(each)
