"""Screws and nuts, mm (ISO 4032 nuts, ISO 4762 and ISO 7045 heads, ISO 10642 countersunk heads)."""

from __future__ import annotations

from dataclasses import dataclass

from mechanics.geometry import GeometryError


@dataclass(frozen=True)
class Screw:
    """Sizes of a thread, mm: clearance hole, largest head, width across flats and height of the
    nut, available lengths.
    """

    name: str
    hole_radius: float
    head_radius: float
    head_height: float
    nut_flats: float
    nut_height: float
    lengths: tuple[float, ...]

    def length(self, least: float, most: float) -> float:
        """The shortest available length from `least`, which passes through the nut, to `most`,
        where an obstacle begins.
        """
        for length in self.lengths:
            if least <= length <= most:
                return length
        raise GeometryError(
            f"no {self.name} screw on sale is {least:.1f} to {most:.1f} mm long:"
            " change the board's thickness or the lid's (PLATE)"
        )


M2 = Screw("M2", 1.1, 2.0, 1.6, 4.0, 1.6, (6, 8, 10, 12, 14, 16, 18, 20, 25))
M3 = Screw("M3", 1.7, 2.75, 3.0, 5.5, 2.4, (6, 8, 10, 12, 16, 20, 25, 30, 35, 40, 45, 50, 60))
M6 = Screw("M6", 3.3, 5.0, 6.0, 10.0, 5.2, (12, 16, 20, 25))

# Countersunk M3: largest radius of the head and its height (ISO 10642: 6.72 mm across the sharp
# cone, 90°).
M3_SUNK_RADIUS, M3_SUNK_HEIGHT = 3.4, 1.7
