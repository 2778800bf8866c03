"""Volumes and weights of a cast."""

from __future__ import annotations

from dataclasses import dataclass

from mechanics.geometry import GeometryError

# What stays in cup, syringe and fill hole, and what is weighed too much: mixed is so many times what the mould holds.
RESERVE = 2.0
# Less can't be weighed in two equal parts well: a kitchen scale shows 0.1 g.
LEAST_G = 10.0
# Mixed before the cast, to see whether it sets on board and prints.
TEST_POUR_G = 5.0


def density_of(value: float) -> float:
    """A density, g/cm³. Raises `GeometryError` where no silicone has it."""
    if not 0.8 <= value <= 1.6:
        raise GeometryError(f"--density: expected g/cm3 between 0.8 and 1.6, found {value}")
    return value


@dataclass(frozen=True)
class Recipe:
    """A cast of two parts in equal weights."""

    gel_mm3: float
    potting_mm3: float
    density_g_per_cm3: float

    @property
    def gel_g(self) -> float:
        """Weight of the gel, g."""
        return self.gel_mm3 / 1000.0 * self.density_g_per_cm3

    @property
    def potting_g(self) -> float:
        """Weight of what fills holes around the chips and anchors, g."""
        return self.potting_mm3 / 1000.0 * self.density_g_per_cm3

    @property
    def mixed_g(self) -> float:
        """What is mixed, g: all that is needed and the reserve, rounded up to whole grams that halve."""
        needed = max(RESERVE * (self.gel_g + self.potting_g), LEAST_G)
        return 2.0 * float(-int(-needed // 2.0))

    @property
    def each_g(self) -> float:
        """Weight of part A, and of part B, g."""
        return self.mixed_g / 2.0
