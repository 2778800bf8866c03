"""Conversion of readings to pictures of grey levels, and back."""

from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import numpy.typing as npt
from twintac import PressureMap, Reading, Sensor

__all__ = ["MapPicture", "PressureScale", "TaxelPicture"]

NO_READING_LEVEL: Final = 0
"""Grey level of a taxel without a reading."""
LOWEST_LEVEL: Final = 16
"""Grey level of the lowest pressure. No pressure has a level between it and `NO_READING_LEVEL`, so
that both stay distinct in a lossy video.
"""
ZERO_LEVEL: Final = 95
"""Grey level of 0 kPa."""
FULL_SCALE_LEVEL: Final = 255
"""Grey level of the full scale."""

_Floats = npt.NDArray[np.float64]
_Levels = npt.NDArray[np.uint8]


@dataclass(frozen=True)
class PressureScale:
    """The scale between pressure and grey level: `pressure = (level - 95) * full_scale_kpa / 160`.

    Level 255 is `full_scale_kpa`, level 95 is 0 kPa, level 16 is `lowest_kpa`; level 0 means that
    there is no reading.
    """

    full_scale_kpa: float

    @property
    def kpa_per_level(self) -> float:
        """Pressure of one grey level, kPa. The error of an uncompressed picture is at most half of
        it.
        """
        return self.full_scale_kpa / (FULL_SCALE_LEVEL - ZERO_LEVEL)

    @property
    def lowest_kpa(self) -> float:
        """The lowest pressure that a picture shows, kPa; negative."""
        return (LOWEST_LEVEL - ZERO_LEVEL) * self.kpa_per_level

    def levels(self, pressure_kpa: npt.ArrayLike) -> _Levels:
        """Converts pressures to grey levels.

        Args:
            pressure_kpa: pressures, kPa, of any shape. Pressures beyond the scale get the level at
                its end, NaN gets level 0.

        Returns:
            The levels, of the same shape.
        """
        pressures = np.asarray(pressure_kpa, dtype=np.float64)
        exact = np.clip(np.rint(pressures / self.kpa_per_level) + ZERO_LEVEL, LOWEST_LEVEL, FULL_SCALE_LEVEL)
        return np.where(np.isnan(pressures), NO_READING_LEVEL, exact).astype(np.uint8)

    def pressure_kpa(self, levels: npt.ArrayLike) -> _Floats:
        """Converts grey levels to pressures.

        Args:
            levels: levels from 0 to 255, also fractions, of any shape.

        Returns:
            The pressures, kPa, of the same shape; NaN where there is no reading.
        """
        exact = np.asarray(levels, dtype=np.float64)
        is_missing = exact < (NO_READING_LEVEL + LOWEST_LEVEL) / 2
        return np.where(is_missing, np.nan, (exact - ZERO_LEVEL) * self.kpa_per_level)

    def clips(self, pressure_kpa: npt.ArrayLike) -> bool:
        """Whether one of the pressures, kPa, is beyond the scale."""
        pressures = np.asarray(pressure_kpa, dtype=np.float64)
        return bool(np.any((pressures > self.full_scale_kpa) | (pressures < self.lowest_kpa)))


class TaxelPicture:
    """A picture in which each pixel shows the reading of the nearest taxel.

    It shows the bounding box of the gel from above, scaled to the picture's size: x to the right, y
    upwards.

    Args:
        sensor: the sensor.
        scale: the scale of the grey levels.
        width: width, pixels.
        height: height, pixels.

    Raises:
        ValueError: for a picture so small that a taxel has no pixel.
    """

    def __init__(self, sensor: Sensor, scale: PressureScale, width: int, height: int) -> None:
        self.scale = scale
        (x_low, y_low, _), (x_high, y_high, _) = sensor.bounds_mm
        x_mm = x_low + (np.arange(width) + 0.5) / width * (x_high - x_low)
        y_mm = y_high - (np.arange(height) + 0.5) / height * (y_high - y_low)
        taxels_mm = sensor.taxel_positions_mm
        square_mm2 = (x_mm[None, :, None] - taxels_mm[:, 0]) ** 2 + (y_mm[:, None, None] - taxels_mm[:, 1]) ** 2
        self.nearest: npt.NDArray[np.intp] = square_mm2.argmin(axis=2)
        """Index of the nearest taxel; `[height, width]`."""
        for number, taxel in enumerate(sensor.taxels):
            if not np.any(self.nearest == number):
                raise ValueError(f"twintac camera: taxel {taxel} has no pixel in a picture of {width} × {height}; give a larger width and height, or picture: map")
        self._n_taxels = len(sensor.taxels)

    def draw(self, reading: Reading) -> _Levels:
        """Draws the readings of a frame.

        Args:
            reading: the frame.

        Returns:
            The picture, red = green = blue; `[height, width, 3]`.
        """
        return _grey(self.scale.levels(reading.readings_kpa)[self.nearest])

    def readings_kpa(self, picture: npt.NDArray[Any]) -> _Floats:
        """Converts a picture to readings. A reading is the median of the taxel's pixels, which is
        also valid in a compressed video.

        Args:
            picture: levels from 0 to 255, `[height, width, 3]`.

        Returns:
            The readings, kPa, `[n_taxels]`; NaN where there is no reading.

        Raises:
            ValueError: for another shape.
        """
        shape = (*self.nearest.shape, 3)
        if picture.shape != shape:
            raise ValueError(f"twintac picture: its shape is {picture.shape}; give one of {shape}: height, width, channels")
        grey = picture.mean(axis=2)
        return self.scale.pressure_kpa([np.median(grey[self.nearest == taxel]) for taxel in range(self._n_taxels)])


class MapPicture:
    """A picture of `twintac.PressureMap`: pressure interpolated between the taxels, in the same
    frame as `TaxelPicture`.
    """

    def __init__(self, sensor: Sensor, scale: PressureScale, width: int, height: int) -> None:
        self.scale = scale
        self._sensor, self._width, self._height = sensor, width, height

    def draw(self, reading: Reading) -> _Levels:
        """Draws the readings of a frame.

        Args:
            reading: the frame.

        Returns:
            The picture, red = green = blue; `[height, width, 3]`.
        """
        levels = self.scale.levels(PressureMap(self._sensor, reading.readings_kpa, reading.provenance).pressure_kpa[::-1])
        n_rows, n_columns = levels.shape
        rows = (np.arange(self._height) * 2 + 1) * n_rows // (2 * self._height)
        columns = (np.arange(self._width) * 2 + 1) * n_columns // (2 * self._width)
        return _grey(levels[np.ix_(rows, columns)])


PICTURES: Final[dict[str, type[TaxelPicture] | type[MapPicture]]] = {"taxels": TaxelPicture, "map": MapPicture}
"""The pictures, by their names in a configuration."""


def _grey(levels: _Levels) -> _Levels:
    return np.repeat(levels[:, :, None], 3, axis=2)
