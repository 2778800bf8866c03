"""What notebooks show of a gel."""

from __future__ import annotations

from importlib import import_module

from twintac import Error, Sensor


def gel(sensor: Sensor) -> None:
    """Displays the gel of a sensor with sliders to press it, or else a drawing of the sensor."""
    display = import_module("IPython.display").display
    try:
        shown = import_module("twintac.widget").GelWidget(sensor)
    except (ModuleNotFoundError, Error):
        shown = sensor
    display(shown)
