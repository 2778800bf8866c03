"""Configuration of the camera."""

import math
from dataclasses import dataclass

from lerobot.cameras import CameraConfig

from lerobot_camera_twintac.picture import PICTURES

__all__ = ["TwintacCameraConfig"]

SOURCES = ("lab", "bus", "serial", "udp", "replay")
"""Fields for the source of frames. Exactly one of them is set."""

_WITH_LINE = ("serial", "udp")


@CameraConfig.register_subclass("twintac")
@dataclass(kw_only=True)
class TwintacCameraConfig(CameraConfig):
    """One TwinTac sensor as a camera of LeRobot. The sources have the names of the options of
    `twintac stream`.

    - `lab`: the emulated sensor, if true. Its readings are `emulated`.
    - `bus`: I²C bus, such as `/dev/i2c-1`.
    - `serial`: serial port, such as `/dev/ttyACM0`; needs `line`.
    - `udp`: address of this computer at which frames arrive as datagrams, such as `0.0.0.0:9000`;
      needs `line`.
    - `replay`: a log (MCAP), played at its own pace.
    - `line`: line description (TOML), which says how to read frames from the serial line or from
      datagrams.
    - `sensor`: sensor description (TOML); PhysTac unless given.
    - `counts_per_pa`: scale of the barometers on `bus`, confirmed by a person who knows the parts;
      the description's unless given.
    - `temperature`: file (TOML) about the drift of the zeros with temperature, made by
      `twintac characterize`: the drift is subtracted from the readings.
    - `picture`: `taxels` (each pixel shows the nearest taxel) or `map` (pressure interpolated
      between the taxels).
    - `full_scale_kpa`: pressure of grey level 255, kPa. One grey level is `full_scale_kpa / 160`.
    - `sidecar`: folder; each connection writes all its frames into a new CSV file there. No file
      unless given.
    - `fps`: pictures a second that the robot will take, Hz. The sensor runs at its own rate.
    - `width`, `height`: size of the picture, pixels.

    Errors are raised when a camera is made of the configuration (`check`), because LeRobot's
    command line hides the errors of a configuration's constructor.
    """

    fps: int | None = 30
    width: int | None = 96
    height: int | None = 64
    lab: bool = False
    bus: str | None = None
    serial: str | None = None
    udp: str | None = None
    replay: str | None = None
    line: str | None = None
    sensor: str | None = None
    counts_per_pa: int | None = None
    temperature: str | None = None
    picture: str = "taxels"
    full_scale_kpa: float = 40.0
    sidecar: str | None = None

    def check(self) -> None:
        """Checks the configuration.

        Raises:
            ValueError: for no source or several, for a missing or superfluous `line` or
                `counts_per_pa`, for an unknown `picture`, and for numbers that are not positive.
        """
        given = [name for name in SOURCES if getattr(self, name)]
        if len(given) != 1:
            found = " and ".join(given) or "none"
            raise ValueError(f"twintac camera: give exactly one source of {', '.join(SOURCES)}; found {found}")
        if self.source in _WITH_LINE and not self.line:
            raise ValueError(f"twintac camera: {self.source} needs line, the file (TOML) that says how frames stand on the line")
        if self.source not in _WITH_LINE and self.line:
            raise ValueError(f"twintac camera: line is for {' and '.join(_WITH_LINE)}, not for {self.source}: leave it out")
        if self.source != "bus" and self.counts_per_pa is not None:
            raise ValueError(f"twintac camera: counts_per_pa is for bus, not for {self.source}: leave it out")
        if self.picture not in PICTURES:
            raise ValueError(f"twintac camera: picture is {self.picture!r}; give one of {', '.join(PICTURES)}")
        for name in ("fps", "width", "height"):
            number = getattr(self, name)
            if number is None or number < 1:
                raise ValueError(f"twintac camera: {name} is {number}; give a whole number from 1")
        if not (math.isfinite(self.full_scale_kpa) and self.full_scale_kpa > 0.0):
            raise ValueError(f"twintac camera: full_scale_kpa is {self.full_scale_kpa}; give a pressure above 0 kPa")

    @property
    def source(self) -> str:
        """Name of the field that is the source of frames."""
        return next(name for name in SOURCES if getattr(self, name))
