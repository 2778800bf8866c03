"""Tests of the file with every frame."""

import csv
import math
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from board import RATE_HZ, Board

from lerobot_camera_twintac import TwintacCamera, TwintacCameraConfig

READS_FOREVER = """
import sys
from lerobot_camera_twintac import TwintacCamera, TwintacCameraConfig
with TwintacCamera(TwintacCameraConfig(udp=sys.argv[1], line=sys.argv[2], sidecar=sys.argv[3])) as camera:
    for number in range(10**9):
        camera.read()
        if number == 50:
            print(camera.reading.sequence, flush=True)
"""


def config(board: Board, folder: Path) -> TwintacCameraConfig:
    return TwintacCameraConfig(udp=board.address, line=str(board.line), sidecar=str(folder))


def rows(path: Path) -> list[dict[str, str]]:
    """The rows of a file. Each row has all columns."""
    with path.open(newline="") as file:
        found = list(csv.DictReader(file))
    assert all(None not in row and None not in row.values() for row in found)
    return found


def test_every_frame_is_kept_with_its_time_and_its_exact_readings(board: Board, tmp_path: Path) -> None:
    taken = []
    started_s = time.time()
    with TwintacCamera(config(board, tmp_path / "touch")) as camera:
        board.touch([0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, math.nan])
        for _ in range(10):
            camera.read_latest()
            assert camera.reading is not None
            taken.append(camera.reading)
            time.sleep(0.03)
        assert camera.sidecar == tmp_path / "touch/frames-0001.csv"
    found = rows(camera.sidecar)
    sequences = [int(row["sequence"]) for row in found]
    assert sequences == list(range(sequences[0], sequences[0] + len(found)))  # no frame is left out
    assert len(found) > 0.3 * RATE_HZ * 0.8  # the sensor's own rate, not the robot's
    by_number = {int(row["sequence"]): row for row in found}
    for reading in taken:
        row = by_number[reading.sequence]
        assert (float(row["time_s"]), row["provenance"]) == (reading.time_s, "real")
        assert [float(row[f"t{taxel}_kpa"]) for taxel in range(7)] == reading.readings_kpa[:7].tolist()
        assert row["t7_kpa"] == "" and row["t7_fault"] == reading.faults[7] != ""
        assert started_s < float(row["unix_time_s"]) < time.time()
    observed = [int(row["sequence"]) for row in found for _ in range(int(row["pictures"]))]
    assert observed == [reading.sequence for reading in taken]


def test_each_connection_has_a_file_of_its_own(board: Board, tmp_path: Path) -> None:
    camera = TwintacCamera(config(board, tmp_path / "touch"))
    for number in (1, 2):
        with camera:
            camera.read()
        assert camera.sidecar == tmp_path / f"touch/frames-000{number}.csv"
    assert all(len(rows(path)) > 0 for path in tmp_path.glob("touch/*.csv"))


def test_a_killed_program_loses_no_row(board: Board, tmp_path: Path) -> None:
    command = [sys.executable, "-c", READS_FOREVER, board.address, str(board.line), str(tmp_path / "touch")]
    program = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert program.stdout
    seen = int(program.stdout.readline())
    program.send_signal(signal.SIGKILL)
    program.wait()
    program.stdout.close()
    found = rows(tmp_path / "touch/frames-0001.csv")
    sequences = [int(row["sequence"]) for row in found]
    assert sequences == list(range(sequences[0], sequences[0] + len(found)))
    assert sequences[-1] >= seen - 1 and len(found) >= 50  # only the newest frame may be missing


def test_a_folder_that_cannot_be_is_an_error_and_frees_the_source(board: Board, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(ConnectionError, match="cannot be connected: .*file"):
        TwintacCamera(config(board, tmp_path / "file")).connect()
    with TwintacCamera(config(board, tmp_path / "touch")) as camera:
        camera.read()


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full, a disk that is full")
def test_a_full_disk_stops_the_reading_with_an_error(board: Board, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    opened = Path.open

    def open_full(path: Path, mode: str = "r", **options: object) -> object:
        is_sidecar = path.name.startswith("frames-")
        return opened(Path("/dev/full"), "w", **options) if is_sidecar else opened(path, mode, **options)  # type: ignore[call-overload]

    camera = TwintacCamera(config(board, tmp_path / "touch"))
    monkeypatch.setattr(Path, "open", open_full)
    with pytest.raises(ConnectionError, match="No space left on device"):
        camera.connect()
    assert not camera.is_connected
