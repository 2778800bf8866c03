"""An emulated microcontroller with the taxels of a PhysTac, which sends frames, for tests."""

import os
import pty
import socket
import threading
import time
import tty
from pathlib import Path
from types import TracebackType

N_TAXELS = 8
RATE_HZ = 100.0
LINE = 'form = "text"\nfields = ["sequence", "time", "pressure * 8"]\ntime.unit = "ms"\npressure.unit = "kPa"\n'

_UNTOUCHED_KPA = 100.0


class Board:
    """Sends frames of text from a thread, as datagrams and to a serial port, while it is used in a
    `with` block.

    - `line`: the line description.
    - `address`: destination of the datagrams.
    - `port`: the serial port.
    - `readings_kpa`: readings of the next frames above untouched taxels; NaN for a taxel without a
      reading. `[8]`
    - `is_sending`: whether frames are sent.
    """

    def __init__(self, folder: Path) -> None:
        self.line = folder / "board.toml"
        self.line.write_text(LINE)
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
            free.bind(("127.0.0.1", 0))
            self._to: tuple[str, int] = free.getsockname()
        self.address = f"127.0.0.1:{self._to[1]}"
        self._writing, reading = pty.openpty()
        tty.setraw(reading)
        os.set_blocking(self._writing, False)
        self.port = os.ttyname(reading)
        self._reading = reading
        self.readings_kpa = [0.0] * N_TAXELS
        self.is_sending = True
        self._is_over = False
        self._thread = threading.Thread(target=self._send)

    def __enter__(self) -> "Board":
        self._thread.start()
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self._is_over = True
        self._thread.join()
        os.close(self._writing)
        os.close(self._reading)

    def touch(self, readings_kpa: list[float]) -> None:
        """Changes the readings of frames, and waits until frames with these readings have been
        sent.
        """
        self.readings_kpa = readings_kpa
        time.sleep(10.0 / RATE_HZ)

    def _send(self) -> None:
        begun_s = time.monotonic()
        sequence = 0
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as datagrams:
            while not self._is_over:
                time.sleep(max(0.0, begun_s + sequence / RATE_HZ - time.monotonic()))
                sequence += 1
                if self.is_sending:
                    numbers = [_UNTOUCHED_KPA + reading_kpa for reading_kpa in self.readings_kpa]
                    time_ms = 1e3 * (time.monotonic() - begun_s)
                    frame = f"{sequence},{time_ms:.3f},{','.join(map(str, numbers))}\n".encode()
                    datagrams.sendto(frame, self._to)
                    try:
                        os.write(self._writing, frame)
                    except BlockingIOError:
                        pass  # the port has no listener
