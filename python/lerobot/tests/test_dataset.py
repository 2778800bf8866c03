"""Tests of touch in data sets that LeRobot records and loads."""

import csv
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from board import Board
from lerobot.datasets.lerobot_dataset import LeRobotDataset
from lerobot.robots import make_robot_from_config
from lerobot.scripts.lerobot_record import DatasetRecordConfig, RecordConfig, record
from stand_in import StandInConfig, StandInLeaderConfig

from lerobot_camera_twintac import PressureScale, TaxelPicture, TwintacCameraConfig, TwintacRobot, TwintacRobotConfig
from twintac import Sensor

FPS = 20
SECONDS = 2
NAMES = ["joint.pos", *(f"touch.t{taxel}_kpa" for taxel in range(8))]


def picture_of(sample: dict[str, Any]) -> npt.NDArray[np.float64]:
    """The picture of a sample, levels 0 to 255; `[height, width, channels]`."""
    pixels: npt.NDArray[np.float64] = 255.0 * sample["observation.images.touch"].permute(1, 2, 0).numpy()
    return pixels


def observed_kpa(sidecar: Path) -> npt.NDArray[np.float64]:
    """Readings of the frames of which pictures were taken, in order; `[n_pictures, 8]`, kPa."""
    with sidecar.open(newline="") as file:
        rows = [row for row in csv.DictReader(file) for _ in range(int(row["pictures"]))]
    return np.array([[float(row[f"t{taxel}_kpa"]) for taxel in range(8)] for row in rows])


def test_what_lerobot_records_is_what_the_sensor_read(tmp_path: Path) -> None:
    camera = TwintacCameraConfig(lab=True, full_scale_kpa=16.0, sidecar=str(tmp_path / "touch"))
    robot = TwintacRobotConfig(robot=StandInConfig(cameras={"touch": camera}))
    root = tmp_path / "data"
    wanted = DatasetRecordConfig(
        repo_id="twintac/test", single_task="press", root=root, fps=FPS, episode_time_s=SECONDS, reset_time_s=0, num_episodes=1, push_to_hub=False
    )
    record(RecordConfig(robot=robot, teleop=StandInLeaderConfig(), dataset=wanted, play_sounds=False))

    data = LeRobotDataset("twintac/test", root=root, video_backend="pyav")
    assert data.fps == FPS and data.features["observation.state"]["names"] == NAMES
    assert data.features["observation.images.touch"]["dtype"] == "video"
    assert 0.5 * FPS * SECONDS <= len(data) <= FPS * SECONDS + 1
    samples = [data[frame] for frame in range(len(data))]
    state = np.array([sample["observation.state"].numpy() for sample in samples])
    np.testing.assert_array_equal(state[:, 0], np.arange(len(data)))
    exact_kpa = observed_kpa(tmp_path / "touch/frames-0001.csv")
    # each observation, in order
    np.testing.assert_array_equal(state[:, 1:], exact_kpa.astype(np.float32))
    assert len(np.unique(exact_kpa, axis=0)) > len(data) / 2
    picture = TaxelPicture(Sensor.phystac(), PressureScale(16.0), width=96, height=64)
    seen_kpa = np.array([picture.readings_kpa(picture_of(sample)) for sample in samples])
    # the video is lossy
    assert np.abs(seen_kpa - exact_kpa).max() <= 4.0 * picture.scale.kpa_per_level


def test_pictures_without_compression_are_within_half_a_grey_level(tmp_path: Path, board: Board) -> None:
    fields = {"udp": board.address, "line": str(board.line), "full_scale_kpa": 16.0}
    robot = make_robot_from_config(TwintacRobotConfig(robot={"type": "stand_in", "cameras": {"touch": {"type": "twintac", **fields}}}))
    features = {
        "observation.images.touch": {"dtype": "image", "shape": (64, 96, 3), "names": ["height", "width", "channels"]},
        "observation.tactile": {"dtype": "float32", "shape": (8,), "names": NAMES[1:]},
    }
    data = LeRobotDataset.create("twintac/test", FPS, features, root=tmp_path / "data", use_videos=False)
    robot.connect()
    for step in range(10):
        board.touch([0.123 * step + taxel for taxel in range(8)])
        observation = robot.get_observation()
        tactile = np.array([observation[name] for name in NAMES[1:]], dtype=np.float32)
        data.add_frame({"observation.images.touch": observation["touch"], "observation.tactile": tactile, "task": "press"})
    robot.disconnect()
    data.save_episode()
    data.finalize()

    again = LeRobotDataset("twintac/test", root=tmp_path / "data")
    picture = TaxelPicture(Sensor.phystac(), PressureScale(16.0), width=96, height=64)
    for step in range(10):
        sample = again[step]
        exact_kpa = sample["observation.tactile"].numpy()
        np.testing.assert_allclose(exact_kpa, [0.123 * step + taxel for taxel in range(8)], atol=1e-4)
        assert np.abs(picture.readings_kpa(picture_of(sample)) - exact_kpa).max() <= picture.scale.kpa_per_level * 0.5001


def robot_over_udp(board: Board, **fields: Any) -> TwintacRobot:
    camera = {"type": "twintac", "udp": board.address, "line": str(board.line)}
    robot = make_robot_from_config(TwintacRobotConfig(robot={"type": "stand_in", "cameras": {"touch": camera}}, **fields))
    assert isinstance(robot, TwintacRobot)
    return robot


def test_observations_can_go_without_pictures(board: Board) -> None:
    with robot_over_udp(board, pictures=False) as robot:
        assert list(robot.get_observation()) == list(robot.observation_features) == NAMES
        assert robot.cameras == {}
        assert robot.send_action({"joint.pos": 3.0}) == {"joint.pos": 3.0}
        assert robot.get_observation()["joint.pos"] == 3.0


def test_a_taxel_without_a_reading_is_an_error_or_nan(board: Board) -> None:
    broken = [1.0, float("nan"), *([2.0] * 6)]
    with robot_over_udp(board) as robot:
        board.touch(broken)
        with pytest.raises(RuntimeError, match=r"taxel t1 of touch has no reading \(.+\); repair it, or set if_missing: nan"):
            robot.get_observation()
        board.touch([0.0] * 8)
    with robot_over_udp(board, if_missing="nan") as robot:
        board.touch(broken)
        observation = robot.get_observation()
    np.testing.assert_allclose([observation[name] for name in NAMES[1:]], broken, atol=1e-9)
    with pytest.raises(ValueError, match="if_missing is 'zero'; give one of error, nan"):
        make_robot_from_config(TwintacRobotConfig(robot=StandInConfig(), if_missing="zero"))
