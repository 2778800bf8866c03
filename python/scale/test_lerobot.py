"""Tests that the public package `lerobot` loads the data sets, and that a sample is the recording's
frame.
"""

from pathlib import Path

import numpy as np
import pytest

from twintac import Dataset, Recording

datasets = pytest.importorskip("lerobot.datasets.lerobot_dataset")


def test_a_sample_is_the_frame_of_the_recording(tmp_path: Path) -> None:
    recording = Recording.load(Dataset(n_presses=12, fast=True).make(tmp_path / "data")["parquet"])
    recording.save_lerobot(tmp_path / "lerobot")
    loaded = datasets.LeRobotDataset("twintac/phystac", root=tmp_path / "lerobot")
    columns = recording.columns()
    assert (loaded.num_episodes, loaded.num_frames, loaded.fps) == (12, len(columns["time_s"]), 55)
    poses = [f"{axis}_mm" for axis in "xyz"] + ["qx", "qy", "qz", "qw"]
    for frame in (0, 57, loaded.num_frames - 1):
        sample = loaded[frame]
        for name, of_recording in (
            ("observation.state", poses),
            ("observation.tactile", [f"{taxel}_kpa" for taxel in recording.taxels]),
            ("tactile_valid", [f"{taxel}_valid" for taxel in recording.taxels]),
        ):
            expected = np.array([columns[column][frame] for column in of_recording])
            found = sample[name].numpy()
            np.testing.assert_array_equal(found, expected.astype(found.dtype))
        assert sample["observation.force"].item() == np.float32(columns["force_n"][frame])
        assert sample["episode_index"].item() == columns["press_index"][frame]
        assert sample["task"] == f"press the sensor with the indenter {columns['indenter'][frame]}"
    np.testing.assert_allclose(
        loaded.meta.stats["observation.force"]["max"], columns["force_n"].max(), rtol=1e-6
    )
    few = datasets.LeRobotDataset("twintac/phystac", root=tmp_path / "lerobot", episodes=[3, 7])
    assert few.num_frames == np.isin(columns["press_index"], [3, 7]).sum()
    steps = {"observation.tactile": [-2 / 55, -1 / 55, 0.0]}
    windows = datasets.LeRobotDataset("twintac/phystac", root=tmp_path / "lerobot", delta_timestamps=steps)
    window = windows[100]["observation.tactile"].numpy()
    rows = np.array([[columns[f"{taxel}_kpa"][frame] for taxel in recording.taxels] for frame in (98, 99, 100)])
    np.testing.assert_array_equal(window, rows.astype(np.float32))
