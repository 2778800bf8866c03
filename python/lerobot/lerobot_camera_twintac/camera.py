"""The camera: pictures of a sensor's readings."""

import logging
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from lerobot.cameras import Camera
from lerobot.utils.errors import DeviceAlreadyConnectedError, DeviceNotConnectedError
from twintac import Reader, Reading, Sensor

from lerobot_camera_twintac.configuration import TwintacCameraConfig
from lerobot_camera_twintac.picture import PICTURES, MapPicture, PressureScale, TaxelPicture
from lerobot_camera_twintac.sidecar import Sidecar
from lerobot_camera_twintac.source import find_sources, load_sensor, open_reader
from lerobot_camera_twintac.stream import FrameStream

__all__ = ["TwintacCamera"]

_logger = logging.getLogger(__name__)

_PATIENCE_S = 5.0  # the reader itself gives up on a silent sensor after 3 s

Picture = npt.NDArray[np.uint8]


class TwintacCamera(Camera):
    """A TwinTac sensor as a camera of LeRobot. Pictures are RGB with red = green = blue;
    `[height, width, 3]`, uint8.

    A background thread reads the sensor at the sensor's own rate. `read`, `async_read` and
    `read_latest` draw the newest frame. They raise `DeviceNotConnectedError` before `connect` and
    after `disconnect`, and `RuntimeError` with the cause once the sensor has stopped by itself. A
    sensor that has stopped stays connected, so that the robot can be disconnected as usual.

    Args:
        config: the configuration.

    Raises:
        ValueError: for a wrong configuration, and for a picture that is too small for the taxels.
        twintac.Error: for a wrong sensor description.
    """

    def __init__(self, config: TwintacCameraConfig) -> None:
        # This is set first, because the base class reads `is_connected` when it is deleted.
        self._stream: FrameStream | None = None
        config.check()
        super().__init__(config)
        self.config = config
        self.sensor: Sensor = load_sensor(config)
        """The sensor of the description."""
        self.scale = PressureScale(config.full_scale_kpa)
        """The scale between pressure and grey level."""
        self.picture: TaxelPicture | MapPicture = PICTURES[config.picture](self.sensor, self.scale, config.width or 0, config.height or 0)
        """Draws the readings; a `TaxelPicture` also converts pictures to readings."""
        self.reading: Reading | None = None
        """The frame of the last picture, with its exact readings; `None` before the first picture
        of a connection.
        """
        self.sidecar: Path | None = None
        """The file with all frames of the last connection, if the configuration asks for one."""
        self._has_clipped = False

    def __str__(self) -> str:
        return f"twintac camera ({self.config.source} {self._address})".replace(" )", ")")

    @property
    def is_connected(self) -> bool:
        """Whether the camera is connected: from `connect` to `disconnect`."""
        return self._stream is not None

    @property
    def provenance(self) -> str | None:
        """Provenance of the last picture's readings: `"real"` or `"emulated"`; `None` before the
        first picture.
        """
        return self.reading.provenance if self.reading else None

    @staticmethod
    def find_cameras() -> list[dict[str, Any]]:
        """The possible sources of frames on this computer, each with its field of the
        configuration. Nothing is opened, so a sensor need not be connected to them.
        """
        return find_sources()

    def connect(self, warmup: bool = True) -> None:
        """Starts to read the sensor. Nothing may touch the sensor during the call: the first frames
        are the tare.

        Args:
            warmup: if true, waits for the first frame.

        Raises:
            DeviceAlreadyConnectedError: if the camera is connected.
            ConnectionError: with the cause, for a source or a sidecar that cannot be opened, and
                for a sensor that gives no frame.
        """
        if self._stream:
            raise DeviceAlreadyConnectedError(f"{self} is connected already: call disconnect() first")
        self.reading, self.sidecar, self._has_clipped = None, None, False
        try:
            reader = open_reader(self.config, self.sensor)
            stream = FrameStream(reader, self._open_sidecar(reader), str(self))
        except (OSError, ValueError) as error:
            raise ConnectionError(f"{self} cannot be connected: {error}") from error
        try:
            if warmup:
                stream.wait_for_first(_PATIENCE_S)
        except (RuntimeError, TimeoutError) as error:
            stream.close()
            raise ConnectionError(f"{self} cannot be connected: {error}") from error
        except BaseException:  # Ctrl-C
            stream.close()
            raise
        self._stream = stream
        for note in reader.notes:
            _logger.warning("%s: %s", self, note)
        if (self.fps or 0) > self.sensor.rate_hz:
            _logger.warning("%s: the robot asks for %s pictures a second, the sensor is described with %g Hz: pictures may repeat", self, self.fps, self.sensor.rate_hz)
        _logger.info("%s connected: %s readings, %g kPa for a grey level, level 95 is 0 kPa", self, reader.provenance, self.scale.kpa_per_level)

    def read(self) -> Picture:
        """Waits for the next frame that arrives after the call, and draws it.

        Returns:
            The picture.

        Raises:
            TimeoutError: if no frame arrives within 5 s.
        """
        return self._draw(self._connected().wait_for_next(_PATIENCE_S))

    def async_read(self, timeout_ms: float = 200) -> Picture:
        """Draws the newest frame that `read` and `async_read` have not drawn yet; waits for it if
        necessary.

        Args:
            timeout_ms: longest wait, ms.

        Returns:
            The picture.

        Raises:
            TimeoutError: if no frame arrives in time.
        """
        return self._draw(self._connected().wait_for_unseen(timeout_ms / 1e3))

    def read_latest(self, max_age_ms: int = 500) -> Picture:
        """Draws the newest frame, without waiting.

        Args:
            max_age_ms: largest age of the frame, ms.

        Returns:
            The picture.

        Raises:
            TimeoutError: if the frame is older.
            RuntimeError: if there is no frame yet.
        """
        return self._draw(self._connected().latest(max_age_ms / 1e3))

    def disconnect(self) -> None:
        """Stops reading, and completes the sidecar.

        Raises:
            DeviceNotConnectedError: if the camera is not connected.
        """
        stream, self._stream = self._connected(), None
        stream.close()
        _logger.info("%s disconnected", self)

    def _connected(self) -> FrameStream:
        if self._stream is None:
            raise DeviceNotConnectedError(f"{self} is not connected: call connect() first")
        return self._stream

    def _open_sidecar(self, reader: Reader) -> Sidecar | None:
        if not self.config.sidecar:
            return None
        try:
            sidecar = Sidecar(Path(self.config.sidecar), reader.taxels)
        except OSError:
            reader.close()
            raise
        self.sidecar = sidecar.path
        return sidecar

    def _draw(self, reading: Reading) -> Picture:
        self.reading = reading
        if not self._has_clipped and self.scale.clips(reading.readings_kpa):
            self._has_clipped = True
            _logger.warning(
                "%s: a reading is beyond the scale, %g to %g kPa, and clipped in the picture: give a larger full_scale_kpa",
                self, self.scale.lowest_kpa, self.scale.full_scale_kpa,
            )
        return self.picture.draw(reading)

    @property
    def _address(self) -> str:
        given = getattr(self.config, self.config.source)
        return given if isinstance(given, str) else ""
