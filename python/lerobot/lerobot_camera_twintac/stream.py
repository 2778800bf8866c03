"""The newest frame of a sensor, read by a background thread."""

import logging
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass

from twintac import Reader, Reading

from lerobot_camera_twintac.sidecar import Sidecar

__all__ = ["FrameStream"]

_logger = logging.getLogger(__name__)

STALE_S = 0.5
"""Age above which a frame does not count as new, s."""

_CLOSING_S = 5.0


@dataclass(eq=False)
class _Frame:
    reading: Reading
    arrived_s: float  # on the clock of `time.monotonic`
    unix_time_s: float
    pictures: int = 0

    @property
    def age_s(self) -> float:
        return time.monotonic() - self.arrived_s


class FrameStream:
    """Reads all frames of a sensor, keeps the newest one, and writes each into the sidecar, if
    there is one.

    The stream owns the reader and the sidecar, and closes both. All methods may be called from
    several threads.

    The methods that return a frame raise `RuntimeError` once the reading has stopped by itself:
    after a failure or silence of the sensor, at the end of a log, and if the sidecar cannot be
    written.

    Args:
        reader: the reader.
        sidecar: the sidecar, or `None`.
        name: beginning of the messages of errors.
    """

    def __init__(self, reader: Reader, sidecar: Sidecar | None, name: str) -> None:
        self._reader, self._sidecar, self._name = reader, sidecar, name
        self._changed = threading.Condition()
        self._newest: _Frame | None = None
        self._consumed: _Frame | None = None
        self._failure: Exception | None = None
        self._is_closing = False
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)
        self._thread.start()

    def wait_for_first(self, timeout_s: float) -> None:
        """Waits until there is a frame, and does not take it.

        Args:
            timeout_s: longest wait, s.

        Raises:
            TimeoutError: if no frame arrives in time.
        """
        with self._changed:
            self._wait(lambda _: True, timeout_s)

    def wait_for_next(self, timeout_s: float) -> Reading:
        """Waits for the next frame that arrives after the call.

        Args:
            timeout_s: longest wait, s.

        Returns:
            The frame.

        Raises:
            TimeoutError: if no frame arrives in time.
        """
        called_s = time.monotonic()
        return self._wait_and_take(lambda frame: frame.arrived_s >= called_s, timeout_s)

    def wait_for_unseen(self, timeout_s: float) -> Reading:
        """The newest frame, if this method has not returned it before and it is not older than 0.5
        s; else waits for the next one.

        Args:
            timeout_s: longest wait, s.

        Returns:
            The frame.

        Raises:
            TimeoutError: if no frame arrives in time.
        """
        return self._wait_and_take(lambda frame: frame is not self._consumed and frame.age_s <= STALE_S, timeout_s)

    def latest(self, max_age_s: float) -> Reading:
        """The newest frame, without waiting.

        Args:
            max_age_s: largest age of the frame, s.

        Returns:
            The frame.

        Raises:
            TimeoutError: if the frame is older.
            RuntimeError: if there is no frame yet.
        """
        with self._changed:
            self._check()
            if self._newest is None:
                raise RuntimeError(f"{self._name} has given no frame yet: call connect() with warmup=True, which waits for the first one")
            if (age_s := self._newest.age_s) > max_age_s:
                raise TimeoutError(f"{self._name}: the newest frame is {1e3 * age_s:.0f} ms old, more than {1e3 * max_age_s:g} ms: the sensor is slower than that, or hangs")
            return self._take(self._newest)

    def close(self) -> None:
        """Stops reading. The sidecar then has all frames."""
        with self._changed:
            self._is_closing = True
        self._reader.close()
        self._thread.join(_CLOSING_S)
        if self._thread.is_alive():
            _logger.warning("%s: the reading did not end within %g s", self._name, _CLOSING_S)

    def _wait_and_take(self, is_wanted: Callable[[_Frame], bool], timeout_s: float) -> Reading:
        with self._changed:
            self._consumed = self._wait(is_wanted, timeout_s)
            return self._take(self._consumed)

    def _wait(self, is_wanted: Callable[[_Frame], bool], timeout_s: float) -> _Frame:
        """Waits until the newest frame is a wanted one. Returns it. The caller holds the lock."""
        self._changed.wait_for(lambda: self._failure or self._is_closing or (self._newest and is_wanted(self._newest)), timeout_s)
        self._check()
        frame = self._newest
        if frame is None or not is_wanted(frame):
            age = f"the newest is {1e3 * frame.age_s:.0f} ms old" if frame else "none has come yet"
            raise TimeoutError(f"{self._name}: no new frame within {1e3 * timeout_s:g} ms; {age}")
        return frame

    def _check(self) -> None:
        if self._failure:
            raise RuntimeError(f"{self._name} has stopped: {self._failure}; remove the cause, then call disconnect() and connect()") from self._failure
        if self._is_closing:
            raise RuntimeError(f"{self._name} is being disconnected")

    @staticmethod
    def _take(frame: _Frame) -> Reading:
        frame.pictures += 1
        return frame.reading

    def _run(self) -> None:
        """Reads until the end. A frame is written when the next one has arrived: no more pictures
        are taken of it then.
        """
        failure: Exception = EOFError("the log has no more frames")
        try:
            for reading in self._reader:
                frame = _Frame(reading, time.monotonic(), time.time())
                with self._changed:
                    previous, self._newest = self._newest, frame
                    self._changed.notify_all()
                self._write(previous)
        except Exception as error:  # any error is passed on to the methods that return frames
            failure = error
        with self._changed:
            if not self._is_closing:
                self._failure = failure
            self._changed.notify_all()
        self._finish()

    def _finish(self) -> None:
        try:
            self._write(self._newest)
            if self._sidecar:
                self._sidecar.close()
        except OSError as error:
            _logger.error("%s: the last frame is missing in the sidecar: %s", self._name, error)
        self._reader.close()

    def _write(self, frame: _Frame | None) -> None:
        if not self._sidecar or not frame:
            return
        try:
            self._sidecar.write(frame.reading, frame.unix_time_s, frame.pictures)
        except OSError as error:
            raise OSError(f"the sidecar {self._sidecar.path} cannot be written: {error}") from error
