"""Tests that long calls let other threads run, report progress, and end on Ctrl-C."""

import os
import signal
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from conftest import DATA

from twintac import Body, FastGel, Gel, Pose, Press, PressPath, Run, Sensor, Shape

FINE = {"edges_per_height": 12.0, "edges_per_contact_radius": 12.0, "max_nodes": 60_000}
SHORT = {"simulate": {"edges_per_height": 4.0, "edges_per_contact_radius": 4.0}, "train": {"epochs": 10}}


def turns_while(work: Callable[[], object]) -> tuple[int, float]:
    """How often this thread ran while another one worked, and the duration, s."""
    worker = threading.Thread(target=work)
    n_turns, started = 0, time.monotonic()
    worker.start()
    while worker.is_alive():
        time.sleep(0.002)
        n_turns += 1
    return n_turns, time.monotonic() - started


def test_a_press_lets_other_threads_run() -> None:
    gel = Gel(Sensor.phystac())
    n_turns, seconds = turns_while(lambda: gel.press(Press("sphere-25")))
    assert n_turns > 20 * seconds > 2.0


def test_a_batch_lets_other_threads_run() -> None:
    batch = FastGel.phystac().batch([Body(Shape.sphere(6.0))], n_threads=1)
    places = np.tile([0.0, 0.0, 7.5], (60_000, 1))
    n_turns, seconds = turns_while(lambda: batch.read(places))
    assert n_turns > 20 * seconds > 2.0


@pytest.fixture(autouse=True)
def hears_ctrl_c() -> Iterator[None]:
    """Makes Ctrl-C effective: a program that was started in the background may ignore it."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def interrupt() -> None:
    os.kill(os.getpid(), signal.SIGINT)


def test_ctrl_c_ends_a_press_at_once() -> None:
    gel = Gel(Sensor.phystac(), FINE)
    threading.Timer(0.3, interrupt).start()
    started = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        gel.press(Press("sphere-25", depth_mm=3.0))
    assert time.monotonic() - started < 1.5


def start(folder: Path) -> Run:
    run = Run.start(folder, Sensor.phystac(), "presses.csv", settings=SHORT)
    run.import_csv(DATA / "import.toml", DATA / "presses.csv")
    return run


def test_ctrl_c_stops_a_run_which_then_goes_on_to_the_same_end(tmp_path: Path) -> None:
    run = start(tmp_path / "stopped")
    is_under_way = threading.Event()

    def interrupt_soon() -> None:
        is_under_way.wait()
        interrupt()

    threading.Thread(target=interrupt_soon).start()
    with pytest.raises(KeyboardInterrupt):
        run.finish(progress=lambda work, done, total, state: is_under_way.set() if done == 2 else None)
    assert not run.report_path.exists()
    assert not (tmp_path / "stopped/simulation").exists()

    metrics = Run.open(tmp_path / "stopped").finish(progress=False)
    assert metrics == start(tmp_path / "other").finish(progress=False)


def test_progress_counts_up_to_its_end(tmp_path: Path) -> None:
    steps: list[tuple[str, int, int, str]] = []
    start(tmp_path).finish(progress=lambda *step: steps.append(step))
    works = {work for work, *_ in steps}
    assert {"simulating", "training"} <= works
    for work in works:
        last = [(done, total) for own, done, total, _ in steps if own == work][-1]
        assert last[0] == last[1] > 0


def test_an_exception_of_who_follows_stops_the_run(tmp_path: Path) -> None:
    def refuse(work: str, done: int, total: int, state: str) -> None:
        raise LookupError(work)

    with pytest.raises(LookupError):
        start(tmp_path).finish(progress=refuse)
    assert not (tmp_path / "report.html").exists()


def test_ctrl_c_ends_a_step_of_a_gel_which_is_made_all_the_same() -> None:
    gel = Gel(Sensor.phystac())
    x_mm, y_mm, z_mm = gel.touch("sphere-25", Pose((0.0, 0.0, 0.0))).position_mm
    deep = Pose((x_mm, y_mm, z_mm - 3.0))
    state = gel.state("sphere-25", [deep])
    threading.Timer(0.3, interrupt).start()
    started = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        state.step(0.1, deep)
    waited_s = time.monotonic() - started
    assert state.gel_from_indenter == deep  # this waits for the step
    assert waited_s < 0.5 * (time.monotonic() - started)


def test_ctrl_c_ends_a_path_before_its_next_frame() -> None:
    poses = [[0.0, 0.0, -0.01 * frame] for frame in range(200)]
    path = PressPath("sphere-25", np.arange(200.0), poses, zero="touch")
    threading.Timer(0.5, interrupt).start()
    started = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        Gel(Sensor.phystac()).follow(path)
    assert time.monotonic() - started < 10.0
