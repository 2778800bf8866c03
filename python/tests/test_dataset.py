"""Tests of data sets of simulated presses, their shards, and recordings in LeRobot's format."""

import json
import sys
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas
import pyarrow.parquet  # type: ignore[import-untyped]
import pytest
from conftest import run_command

import twintac
from twintac import Dataset, Recording
from twintac.ray import make_dataset, make_shard


def fast(n_presses: int = 12) -> Dataset:
    return Dataset(n_presses=n_presses, seed=5, fast=True)


def test_shards_merge_to_what_one_process_makes(tmp_path: Path) -> None:
    steps: list[tuple[str, int, int, str]] = []
    whole = fast().make(tmp_path / "whole", progress=lambda *step: steps.append(step))
    assert ("pressing", 12, 12, "") in steps
    assert whole["provenance"] == "simulated" and not whole["was_kept"] and len(whole["presses"]) == 12
    for shard in (3, 1, 2):
        fast().make(tmp_path / "parts", shard, 3)
    assert fast().make(tmp_path / "parts", 2, 3)["was_kept"]
    merged = Dataset.merge(tmp_path / "parts")
    assert Path(merged["merged"]).read_bytes() == Path(whole["parquet"]).read_bytes()
    assert Dataset.check(tmp_path / "parts")["rows"] == whole["rows"]
    words = ("dataset", "--fast", "--presses", 12, "--seed", 5, "--out", tmp_path / "by-command")
    assert run_command(*words).returncode == 0
    assert (tmp_path / "by-command/dataset.toml").read_text(encoding="utf-8") == fast().identity


def test_a_shard_is_a_recording(tmp_path: Path) -> None:
    made = fast().make(tmp_path, 1, 2)
    recording = Recording.load(made["parquet"])
    assert recording.provenance == "simulated" and recording.presses == made["presses"]
    table = pandas.read_parquet(made["parquet"])
    assert len(table) == made["rows"]
    assert set(table.provenance) == {"simulated"}
    assert table.groupby("press", sort=False).force_n.max().min() > 0


def test_a_twin_reads(trained: Path, tmp_path: Path) -> None:
    model = twintac.Run.open(trained).model_folder
    dataset = Dataset(twin=model, n_presses=4)
    whole = dataset.make(tmp_path / "whole")
    for shard in (1, 2):
        dataset.make(tmp_path / "parts", shard, 2)
    merged = Dataset.merge(tmp_path / "parts")
    assert Path(merged["merged"]).read_bytes() == Path(whole["parquet"]).read_bytes()
    recording = Recording.load(whole["parquet"])
    assert recording.taxels == twintac.Twin.load(model).sensor.taxels
    readings = np.stack([recording.columns()[f"{taxel}_kpa"] for taxel in recording.taxels])
    assert readings.max() > 0.1


def test_what_is_wrong_is_an_error(tmp_path: Path) -> None:
    for raised, words in (
        (lambda: Dataset(fast=True, indenters=["thumb"]), "thumb"),
        (lambda: Dataset(protocol="none.toml"), "none.toml"),
        (lambda: fast().make(tmp_path, 3, 2), "no shard 3/2"),
        (lambda: Dataset.check(tmp_path / "none"), "is not a data set"),
    ):
        with pytest.raises(twintac.Error, match=words):
            raised()
    assert not any(tmp_path.iterdir())


def test_a_task_writes_what_a_process_does(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("fsspec")
    options: dict[str, Any] = {"n_presses": 12, "seed": 5, "fast": True}
    url = (tmp_path / "by-tasks").as_uri()
    manifests = [make_shard(url, shard, 3, **options) for shard in (2, 1, 3)]
    assert make_shard(url, 2, 3, **options) == manifests[0]
    whole = fast().make(tmp_path / "whole")
    merged = Dataset.merge(tmp_path / "by-tasks")
    assert Path(merged["merged"]).read_bytes() == Path(whole["parquet"]).read_bytes()
    with pytest.raises(twintac.Error, match="other settings"):
        make_shard(url, 2, 3, **{**options, "seed": 6})
    monkeypatch.setitem(sys.modules, "ray", None)
    with pytest.raises(ImportError, match=r"pip install ray fsspec"):
        make_dataset(tmp_path / "by-ray", 3, **options)


def lerobot_columns(n_taxels: int) -> dict[str, tuple[str, int]]:
    """Type and length of the columns that LeRobot 3.0 requires, and of the additional ones."""
    return {
        "observation.state": ("float", 7),
        "observation.tactile": ("float", n_taxels),
        "observation.force": ("float", 1),
        "action": ("float", 7),
        "tactile_valid": ("bool", n_taxels),
        "timestamp": ("float", 1),
        "frame_index": ("int64", 1),
        "episode_index": ("int64", 1),
        "index": ("int64", 1),
        "task_index": ("int64", 1),
    }


def test_a_recording_is_written_as_lerobot_reads_it(tmp_path: Path) -> None:
    recording = Recording.load(fast().make(tmp_path / "data")["parquet"])
    folder = tmp_path / "lerobot"
    written = recording.save_lerobot(folder, how_made="By a test.")
    columns = recording.columns()
    n_frames = len(columns["time_s"])
    assert written == {"episodes": 12, "frames": n_frames, "tasks": 7, "fps": 55, "resampled_from_hz": None}

    info = json.loads((folder / "meta/info.json").read_text(encoding="utf-8"))
    assert info["codebase_version"] == "v3.0" and info["fps"] == 55
    assert (info["total_episodes"], info["total_frames"], info["splits"]) == (12, n_frames, {"train": "0:12"})

    frames = pyarrow.parquet.read_table(folder / "data/chunk-000/file-000.parquet")
    expected = lerobot_columns(len(recording.taxels))
    assert frames.column_names == list(expected) and set(info["features"]) == set(expected)
    for name, (kind, length) in expected.items():
        found = frames.schema.field(name).type
        assert str(found) == (kind if length == 1 else f"list<element: {kind}>")
        assert info["features"][name]["shape"] == [length]
    tactile = np.array(frames["observation.tactile"].to_pylist(), dtype=np.float32)
    of_taxels = np.stack([columns[f"{taxel}_kpa"] for taxel in recording.taxels], axis=1)
    np.testing.assert_array_equal(tactile, of_taxels.astype(np.float32))
    np.testing.assert_array_equal(frames["observation.force"], columns["force_n"].astype(np.float32))
    np.testing.assert_array_equal(frames["index"], np.arange(n_frames))
    np.testing.assert_array_equal(frames["episode_index"], columns["press_index"])
    state = np.array(frames["observation.state"].to_pylist())
    action = np.array(frames["action"].to_pylist())
    first_s = np.flatnonzero(np.asarray(frames["frame_index"]) == 0)
    last = np.append(first_s[1:], n_frames) - 1
    np.testing.assert_array_equal(np.delete(action, last, 0), np.delete(state, first_s, 0))

    tasks = pandas.read_parquet(folder / "meta/tasks.parquet")
    assert list(tasks.columns) == ["task_index"] and tasks.index[0] == "press the sensor with the indenter sphere-25"
    of_frames = tasks.index[np.asarray(frames["task_index"])].str.removeprefix("press the sensor with the indenter ")
    assert list(of_frames) == list(columns["indenter"])
    check_episodes(folder, tactile, first_s, last)

    card = (folder / "README.md").read_text(encoding="utf-8")
    assert "`simulated`" in card and "By a test." in card and "Licence: to be filled in" in card
    with pytest.raises(twintac.Error, match="there already"):
        recording.save_lerobot(folder)


def check_episodes(
    folder: Path, tactile: npt.NDArray[np.float32], first: npt.NDArray[np.intp], last: npt.NDArray[np.intp]
) -> None:
    """The table of episodes says where their frames are, and its statistics are those of NumPy."""
    episodes = pandas.read_parquet(folder / "meta/episodes/chunk-000/file-000.parquet")
    assert list(episodes["dataset_from_index"]) == list(first)
    assert list(episodes["dataset_to_index"]) == list(last + 1)
    assert list(episodes["length"]) == list(last + 1 - first)
    for name in ("data/chunk_index", "data/file_index", "meta/episodes/chunk_index", "meta/episodes/file_index"):
        assert set(episodes[name]) == {0}
    stats = json.loads((folder / "meta/stats.json").read_text(encoding="utf-8"))["observation.tactile"]
    quantiles = {f"q{100 * part:02.0f}": part for part in (0.01, 0.1, 0.5, 0.9, 0.99)}
    exact = tactile.astype(float)
    for name, expected in {
        "min": exact.min(0),
        "max": exact.max(0),
        "mean": exact.mean(0),
        "std": exact.std(0),
        **{name: np.quantile(exact, part, axis=0) for name, part in quantiles.items()},
    }.items():
        np.testing.assert_allclose(stats[name], expected, rtol=1e-5, atol=1e-6)
    assert stats["count"] == [len(tactile)]
    second = exact[first[1] : last[1] + 1]
    of_second = episodes["stats/observation.tactile/mean"][1]
    np.testing.assert_allclose(of_second, second.mean(0), rtol=1e-5, atol=1e-6)


def test_the_command_says_how_it_was_made(tmp_path: Path) -> None:
    fast().make(tmp_path / "data")
    Dataset.merge(tmp_path / "data")
    ran = run_command("export", tmp_path / "data/presses.parquet", "--lerobot", tmp_path / "lerobot", "--json")
    assert ran.returncode == 0, ran.stderr
    assert json.loads(ran.stdout)["episodes"] == 12
    assert 'readings = "ports"' in (tmp_path / "lerobot/README.md").read_text(encoding="utf-8")
    again = run_command("export", tmp_path / "data/presses.parquet", "--lerobot", tmp_path / "lerobot")
    assert again.returncode == 2 and "there already" in again.stderr
