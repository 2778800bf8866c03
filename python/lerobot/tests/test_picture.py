"""Tests of the scale between pressure and grey level, and of the taxels' positions in pictures."""

import numpy as np
import pytest

from lerobot_camera_twintac import PressureScale, TaxelPicture
from twintac import Sensor


@pytest.mark.parametrize("full_scale_kpa", [0.5, 40.0, 1000.0])
def test_the_scale_is_inverted_within_half_a_grey_level(full_scale_kpa: float) -> None:
    scale = PressureScale(full_scale_kpa)
    pressures = np.linspace(scale.lowest_kpa, full_scale_kpa, 10001)
    assert np.abs(scale.pressure_kpa(scale.levels(pressures)) - pressures).max() <= scale.kpa_per_level * 0.5000001
    assert not scale.clips(pressures)


def test_every_level_is_a_pressure_and_back() -> None:
    scale = PressureScale(40.0)
    levels = np.arange(16, 256)
    np.testing.assert_array_equal(scale.levels(scale.pressure_kpa(levels)), levels)
    assert scale.kpa_per_level == 0.25
    np.testing.assert_array_equal(scale.pressure_kpa([16, 95, 255]), [-19.75, 0.0, 40.0])


def test_no_reading_is_level_0_and_stays_apart_from_the_lowest() -> None:
    scale = PressureScale(40.0)
    np.testing.assert_array_equal(scale.levels([np.nan, -1e9, 1e9]), [0, 16, 255])
    np.testing.assert_array_equal(np.isnan(scale.pressure_kpa([0, 5, 11, 16])), [True, True, False, False])
    assert scale.clips([0.0, 40.1]) and scale.clips([-19.8]) and not scale.clips([np.nan, 40.0])


def test_taxels_stand_in_the_picture_as_on_the_gel() -> None:
    sensor = Sensor.phystac()
    picture = TaxelPicture(sensor, PressureScale(40.0), width=34, height=18)  # a pixel is 1 mm
    for number, (x_mm, y_mm, _) in enumerate(sensor.taxel_positions_mm):
        assert picture.nearest[round(9 - y_mm), round(17 + x_mm)] == number


def test_a_picture_of_another_shape_is_an_error() -> None:
    picture = TaxelPicture(Sensor.phystac(), PressureScale(40.0), width=34, height=18)
    with pytest.raises(ValueError, match=r"its shape is \(3, 18, 34\); give one of \(18, 34, 3\): height, width, channels"):
        picture.readings_kpa(np.zeros((3, 18, 34)))
