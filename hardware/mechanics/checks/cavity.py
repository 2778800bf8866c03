"""Checks that the mould holds the gel: the cavity has the gel's volume, and the gel's file has the
described form.

Method: the mould's parts are subtracted from a block that is a millimetre larger than the gel on
each side except the bottom. The rest is the cavity with its channels. The volume of the channels
above the described top, within the circles of fill hole and vents, is integrated and subtracted. A
wall that is missing or misplaced changes the volume. z = 0 closes the cavity: there is the port
plate.
"""

from __future__ import annotations

import math

import numpy as np

from checks.files import Made
from checks.finding import Row
from checks.solids import box, solid
from mechanics.gel import top_height

AROUND = 1.0
# Allowed relative difference of volumes, and allowed distance of the form, mm.
VOLUME, FORM = 5e-3, 0.05


def channel_volume(made: Made, top: float) -> float:
    """Volume above the gel's top, up to a height, within fill hole and vents, mm³."""
    total = 0.0
    steps = 60
    for channel in made.figures["channels"]:
        radius = channel["radius_mm"]
        for i in range(steps):
            for j in range(steps):
                x, y = ((2 * (k + 0.5) / steps - 1.0) * radius for k in (i, j))
                if math.hypot(x, y) <= radius:
                    at = (channel["at_mm"][0] + x, channel["at_mm"][1] + y)
                    total += (top - top_height(made.geometry.gel, *at)) * (2 * radius / steps) ** 2
    return total


def cavity_volume(made: Made) -> float:
    """Volume of the mould's cavity, mm³."""
    gel = made.geometry.gel
    top = gel.high[2] + AROUND
    space = box((gel.low[0] - AROUND, gel.low[1] - AROUND, 0.0), (gel.high[0] + AROUND, gel.high[1] + AROUND, top))
    for name in ("mould-half-a", "mould-half-b", "mould-cover"):
        space = space - solid(made.meshes[name])
    return float(space.volume()) - channel_volume(made, top)


def form_error(made: Made) -> float:
    """Largest vertical distance between the gel's file and the described top, mm, at points of the
    file's upper faces.
    """
    mesh, gel = made.meshes["gel"], made.geometry.gel
    upper = mesh.face_normals[:, 2] > 0.5
    corners = mesh.triangles[upper]
    weights = np.array([[1 / 3, 1 / 3, 1 / 3], [0.8, 0.1, 0.1], [0.1, 0.8, 0.1], [0.1, 0.1, 0.8], [0.5, 0.5, 0.0]])
    points = np.einsum("wk,tkc->twc", weights, corners).reshape(-1, 3)
    return float(max(abs(z - top_height(gel, x, y)) for x, y, z in points.tolist()))


def check(made: Made) -> list[Row]:
    """Checks the volumes of the cavity and of the gel's file, and the form of the gel."""
    expected = made.geometry.gel.volume_mm3
    rows = []
    for name, volume in (("mould", cavity_volume(made)), ("gel", float(made.meshes["gel"].volume))):
        off = volume / expected - 1.0
        rows.append(
            Row(
                "volume as the gel's",
                name,
                f"{volume:.1f} mm3, {100 * off:+.3f} %",
                f"{expected:.1f} mm3 +- 0.5 %",
                abs(off) <= VOLUME,
            )
        )
    error = form_error(made)
    rows.append(Row("form of the top", "gel", f"{error:.4f} mm off", f"<= {FORM} mm", error <= FORM))
    return rows
