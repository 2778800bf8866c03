"""A file with every frame of a sensor."""

import csv
import math
from itertools import count
from pathlib import Path
from typing import TextIO

from twintac import Reading

__all__ = ["Sidecar"]


class Sidecar:
    """A CSV file with a row for each frame of one connection, at the sensor's own rate. What is missing is empty.

    - `sequence`, `time_s`, `provenance`: as in `twintac.Reading`.
    - `unix_time_s`: when the frame arrived at this computer, s since 1970 (UTC).
    - `pictures`: how many pictures the robot took of the frame. The sum of the column counts the robot's observations.
    - `<taxel>_kpa`, `<taxel>_temperature_c`, `<taxel>_fault`: the reading, all its digits; the temperature; why there is no reading.

    The file is `frames-0001.csv` in `folder`, or the next number that is free: no file is written over. Each row goes to the operating system at once: the rows of a
    program that is killed are kept.

    Raises `OSError` for a folder that cannot be written.
    """

    def __init__(self, folder: Path, taxels: list[str]) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        self._file = _next_file(folder)
        self.path = Path(self._file.name)
        self._rows = csv.writer(self._file, lineterminator="\n")
        of_taxels = [f"{taxel}_{what}" for what in ("kpa", "temperature_c", "fault") for taxel in taxels]
        self._rows.writerow(["sequence", "time_s", "unix_time_s", "provenance", "pictures", *of_taxels])

    def write(self, reading: Reading, unix_time_s: float, pictures: int) -> None:
        """Adds a row. Raises `OSError` if the file cannot be written, as on a disk that is full."""
        row = [reading.sequence, reading.time_s, unix_time_s, reading.provenance, pictures]
        numbers = [*reading.readings_kpa.tolist(), *reading.temperatures_c.tolist()]
        self._rows.writerow([*row, *("" if math.isnan(number) else number for number in numbers), *(fault or "" for fault in reading.faults)])

    def close(self) -> None:
        """Closes the file. Closing it again does nothing."""
        self._file.close()


def _next_file(folder: Path) -> TextIO:
    """Makes the first file that is not there yet."""
    for number in count(1):
        try:
            return folder.joinpath(f"frames-{number:04}.csv").open("x", newline="", buffering=1, encoding="utf-8")
        except FileExistsError:
            continue
    raise AssertionError("numbers do not end")
