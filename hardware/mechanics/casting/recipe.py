"""Volumes and weights for casting a sensor."""

from __future__ import annotations

from dataclasses import dataclass

from mechanics.geometry import GeometryError

# The ratio of the mixed silicone to that in the mould: some stays in the cup, the syringe and the
# fill hole, and some is weighed in excess.
RESERVE = 2.0
# A smaller amount cannot be weighed well in two equal parts: a kitchen scale shows 0.1 g.
LEAST_G = 10.0
# Amount that is mixed before the cast, to test that it cures on the board and the prints.
TEST_POUR_G = 5.0


def density_of(value: float) -> float:
    """A density, g/cm³. Raises `GeometryError` if no silicone has such a density."""
    if not 0.8 <= value <= 1.6:
        raise GeometryError(f"--density: expected g/cm3 between 0.8 and 1.6, found {value}")
    return value


@dataclass(frozen=True)
class Recipe:
    """Amounts for a cast, mixed from two parts of equal weight."""

    gel_mm3: float
    potting_mm3: float
    density_g_per_cm3: float

    @property
    def gel_g(self) -> float:
        """Weight of the gel, g."""
        return self.gel_mm3 / 1000.0 * self.density_g_per_cm3

    @property
    def potting_g(self) -> float:
        """Weight of the silicone in the holes around the chips and in the anchors, g."""
        return self.potting_mm3 / 1000.0 * self.density_g_per_cm3

    @property
    def mixed_g(self) -> float:
        """Weight of the mixed silicone, g: the needed amount with the reserve, rounded up to an
        even number of grams.
        """
        needed = max(RESERVE * (self.gel_g + self.potting_g), LEAST_G)
        return 2.0 * float(-int(-needed // 2.0))

    @property
    def each_g(self) -> float:
        """Weight of part A, and of part B, g."""
        return self.mixed_g / 2.0
