"""Sensors and readers of a configuration."""

import sys
from pathlib import Path
from typing import Any

from twintac import Reader, Sensor

from lerobot_camera_twintac.configuration import TwintacCameraConfig

__all__ = ["find_sources", "load_sensor", "open_reader"]


def load_sensor(config: TwintacCameraConfig) -> Sensor:
    """Loads the sensor description of a configuration; PhysTac if it names no file.

    Args:
        config: the configuration.

    Returns:
        The sensor.

    Raises:
        twintac.Error: with file, line and field, for a description that is wrong or cannot be read.
    """
    return Sensor.load(config.sensor) if config.sensor else Sensor.phystac()


def open_reader(config: TwintacCameraConfig, sensor: Sensor) -> Reader:
    """Starts to read the sensor at the source of a configuration. Nothing may touch the sensor
    during the call: the first frames are the tare.

    Args:
        config: the configuration.
        sensor: the sensor.

    Returns:
        The reader.

    Raises:
        twintac.Error: for a source that cannot be opened, a sensor that gives no frame there, and a
            wrong file of temperatures.
    """
    reader = _opened(config, sensor)
    if config.temperature:
        try:
            reader.compensate(config.temperature)
        except BaseException:
            reader.close()
            raise
    return reader


def _opened(config: TwintacCameraConfig, sensor: Sensor) -> Reader:
    if config.bus:
        return Reader.open(config.bus, sensor, counts_per_pa=config.counts_per_pa)
    if config.serial and config.line:
        return Reader.serial(config.serial, config.line, sensor)
    if config.udp and config.line:
        return Reader.udp(config.udp, config.line, sensor)
    if config.replay:
        return Reader.replay(config.replay, sensor)
    return Reader.emulated(sensor)


def find_sources() -> list[dict[str, Any]]:
    """The possible sources of frames on this computer: the emulated sensor, and on Linux the I²C
    buses and serial ports. Nothing is opened, so a sensor need not be connected to them.

    Returns:
        A dictionary for each source, with its field of the configuration.
    """
    found: list[dict[str, Any]] = [{"type": "twintac", "name": "emulated sensor", "id": "lab", "lab": True}]
    if sys.platform == "linux":
        for source, kind, pattern in (("bus", "I²C bus", "i2c-*"), ("serial", "serial port", "ttyACM*"), ("serial", "serial port", "ttyUSB*")):
            paths = sorted(str(path) for path in Path("/dev").glob(pattern))
            found += [{"type": "twintac", "name": f"{kind} {path}", "id": path, source: path} for path in paths]
    return found
