"""A CSV file with every frame of a sensor."""

import csv
import math
from itertools import count
from pathlib import Path
from typing import TextIO

from twintac import Reading

__all__ = ["Sidecar"]


class Sidecar:
    """A CSV file with a row for each frame of one connection, at the sensor's own rate. Missing
    values are empty.

    - `sequence`, `time_s`, `provenance`: as in `twintac.Reading`.
    - `unix_time_s`: when the frame arrived at this computer, s since 1970 (UTC).
    - `pictures`: how many pictures the robot took of the frame. The sum of the column is the number
      of the robot's observations.
    - `<taxel>_kpa`, `<taxel>_temperature_c`, `<taxel>_fault`: the reading with all its digits; the
      temperature; the cause of a missing reading.

    The file is `frames-0001.csv` in `folder`, or the next free number: no file is overwritten. Each
    row is passed to the operating system at once, so that the rows of a killed program are kept.

    Args:
        folder: the folder.
        taxels: names of the taxels.

    Raises:
        OSError: for a folder that cannot be written.
    """

    def __init__(self, folder: Path, taxels: list[str]) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        self._file = _next_file(folder)
        self.path = Path(self._file.name)
        self._rows = csv.writer(self._file, lineterminator="\n")
        of_taxels = [f"{taxel}_{what}" for what in ("kpa", "temperature_c", "fault") for taxel in taxels]
        self._rows.writerow(["sequence", "time_s", "unix_time_s", "provenance", "pictures", *of_taxels])

    def write(self, reading: Reading, unix_time_s: float, pictures: int) -> None:
        """Adds a row.

        Args:
            reading: the frame.
            unix_time_s: when the frame arrived, s since 1970 (UTC).
            pictures: number of pictures of the frame.

        Raises:
            OSError: if the file cannot be written, for example on a full disk.
        """
        row = [reading.sequence, reading.time_s, unix_time_s, reading.provenance, pictures]
        numbers = [*reading.readings_kpa.tolist(), *reading.temperatures_c.tolist()]
        self._rows.writerow([*row, *("" if math.isnan(number) else number for number in numbers), *(fault or "" for fault in reading.faults)])

    def close(self) -> None:
        """Closes the file. A second call does nothing."""
        self._file.close()


def _next_file(folder: Path) -> TextIO:
    """Creates the first file whose name is free."""
    for number in count(1):
        try:
            return folder.joinpath(f"frames-{number:04}.csv").open("x", newline="", buffering=1, encoding="utf-8")
        except FileExistsError:
            continue
    raise AssertionError("numbers do not end")
