"""Tests that a data set by HyperQueue whose workers are killed has the same bytes as one by a
single process.

The package `hyperqueue` runs its server and its workers in one process, so all of them are killed
at once; the same command then continues.
"""

import contextlib
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from twintac import Dataset

pytest.importorskip("hyperqueue")

N_SHARDS = 24  # many are missing when the third is made
N_PRESSES = 2400
OPTIONS = ["--presses", str(N_PRESSES), "--fast"]
PROGRAM = Path(__file__).with_name("hyperqueue_dataset.py")


def start(folder: Path) -> "subprocess.Popen[bytes]":
    words = [sys.executable, str(PROGRAM), str(folder), str(N_SHARDS), *OPTIONS]
    return subprocess.Popen(words, start_new_session=True)


def children(parent: int) -> list[int]:
    """Child processes of a process."""
    found = []
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            status = (folder / "stat").read_text()
        except OSError:
            continue  # it has ended
        if int(status.rsplit(")", 1)[1].split()[1]) == parent:
            number = int(folder.name)
            found += [number, *children(number)]
    return found


def test_workers_that_are_killed_cost_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = tmp_path / "by-hyperqueue"
    running = start(folder)
    until = time.monotonic() + 60
    tasks: list[int] = []
    while time.monotonic() < until:
        tasks = children(running.pid)  # there is none between two tasks
        if tasks and len(list(folder.glob("shard-*.json"))) >= 3:
            break
        time.sleep(0.01)
    for process in (running.pid, *tasks):
        # a task may end before its turn, or with its worker
        with contextlib.suppress(ProcessLookupError):
            os.kill(process, signal.SIGKILL)
    running.wait()
    n_made = len(list(folder.glob("shard-*.json")))
    assert tasks and 3 <= n_made < N_SHARDS, "workers and tasks were killed in the middle"
    assert start(folder).wait(timeout=120) == 0
    merged = Dataset.merge(folder)
    whole = Dataset(n_presses=N_PRESSES, fast=True).make(tmp_path / "whole")
    assert Path(merged["merged"]).read_bytes() == Path(whole["parquet"]).read_bytes()
    with capsys.disabled():
        print(f"\nHyperQueue: killed after {n_made} of {N_SHARDS} shards; merged {whole['parquet_sha256']}")
