"""Tests of the frames of the emulated sensor, as they arrive."""

import os
import signal
import threading
import time
from pathlib import Path

import numpy as np
import pytest

from twintac import Error, Reader, Sensor


def test_frames_come_one_after_the_other() -> None:
    with Reader.emulated(Sensor.phystac()) as reader:
        assert (reader.provenance, reader.taxels) == ("emulated", Sensor.phystac().taxels)
        first, second = reader.read(), reader.read()
        assert second.sequence > first.sequence and second.time_s > first.time_s
        for reading in (first, second):
            assert reading.readings_kpa.shape == reading.temperatures_c.shape == (8,)
            assert reading.is_valid.all() and reading.faults == [None] * 8
            assert np.all(np.abs(reading.readings_kpa) < 200.0)
            assert np.all((reading.temperatures_c > 0.0) & (reading.temperatures_c < 60.0))
            assert reading.provenance == "emulated"


def test_a_closed_reader_gives_nothing_more() -> None:
    reader = Reader.emulated(Sensor.phystac())
    n_frames = 0
    for _ in reader:
        n_frames += 1
        if n_frames == 3:
            reader.close()
    assert n_frames == 3
    reader.close()
    with pytest.raises(Error, match="closed"):
        reader.read()


def test_other_threads_run_while_frames_are_waited_for() -> None:
    turns = 0
    with Reader.emulated(Sensor.phystac()) as reader:
        until_s = time.monotonic() + 0.5
        worker = threading.Thread(target=lambda: [reader.read() for _ in range(40)])
        worker.start()
        while worker.is_alive() and time.monotonic() < until_s:
            time.sleep(0.002)
            turns += 1
        worker.join()
    assert turns > 20


def test_closing_lets_go_of_what_waits_for_frames() -> None:
    reader = Reader.emulated(Sensor.phystac())
    n_frames: list[int] = []
    worker = threading.Thread(target=lambda: n_frames.append(sum(1 for _ in reader)))
    worker.start()
    time.sleep(0.2)
    start_s = time.monotonic()
    reader.close()
    worker.join(5.0)
    assert not worker.is_alive() and time.monotonic() - start_s < 3.0
    assert n_frames[0] > 0


def test_ctrl_c_ends_the_reading() -> None:
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt), Reader.emulated(Sensor.phystac()) as reader:
            threading.Timer(0.2, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
            for _ in reader:
                pass
    finally:
        signal.signal(signal.SIGINT, before)


def test_a_bus_that_is_not_there_is_named() -> None:
    with pytest.raises(Error, match="/dev/i2c-nowhere"):
        Reader.open("/dev/i2c-nowhere", Sensor.phystac())


TEMPERATURE = """
sensor = "phystac"
provenance = "emulated"
taxels = [
"""


def test_zeros_are_compensated_for_temperature(tmp_path: Path) -> None:
    file = tmp_path / "temperature.toml"
    taxels = [f'{{ name = "{name}", kpa_per_k = 0.3, between_c = [20.0, 30.0], remaining_kpa = 0.01 }},' for name in Sensor.phystac().taxels]
    with Reader.emulated(Sensor.phystac()) as reader:
        assert abs(reader.warmer_k() or 0.0) < 1.0
        file.write_text(TEMPERATURE + "\n".join(taxels) + "\n]\n", encoding="utf-8")
        reader.compensate(file)
        assert np.all(np.abs(reader.read().readings_kpa) < 200.0)
        file.write_text(TEMPERATURE + "\n".join(taxels[1:]) + "\n]\n", encoding="utf-8")
        with pytest.raises(Error, match="no taxel `t0`"):
            reader.compensate(file)
        with pytest.raises(Error, match="nowhere"):
            reader.compensate("nowhere.toml")
    with pytest.raises(Error, match="closed"):
        reader.compensate(file)
