"""Tests that LeRobot finds the plugin by its name, and that its command line knows the plugin's
types.
"""

import importlib.metadata
import subprocess
import sys
from dataclasses import dataclass
from typing import Any

import draccus
import pytest
import stand_in
from lerobot.cameras import CameraConfig, make_cameras_from_configs
from lerobot.robots import RobotConfig, make_robot_from_config
from lerobot.scripts.lerobot_record import RecordConfig
from lerobot.utils.import_utils import register_third_party_plugins

from lerobot_camera_twintac import TwintacCamera, TwintacCameraConfig, TwintacRobot

OTHERS = ["--teleop.type=stand_in", "--dataset.repo_id=twintac/test", "--dataset.single_task=press"]

SEEN_BEFORE_AND_AFTER = """
from lerobot.cameras import CameraConfig
from lerobot.robots import RobotConfig
from lerobot.utils.import_utils import register_third_party_plugins
known = lambda: ("twintac" in CameraConfig.get_known_choices(), "twintac_robot" in RobotConfig.get_known_choices())
before = known()
register_third_party_plugins()
print(before, known())
"""


@dataclass
class RobotAlone:
    """The common part of the configurations of LeRobot's commands."""

    robot: RobotConfig


def parsed(*arguments: str) -> Any:
    """The configuration that `lerobot-record` makes of its arguments."""
    return draccus.parse(RecordConfig, args=[*arguments, *OTHERS], exit_on_error=False)


def parsed_alone(*arguments: str) -> Any:
    """The same for a command that has only a robot, whose arguments are read earlier."""
    return draccus.parse(RobotAlone, args=arguments, exit_on_error=False)


def test_lerobot_finds_it_by_its_name_alone() -> None:
    assert importlib.metadata.distribution("lerobot_camera_twintac").metadata["Name"] == "lerobot_camera_twintac"
    ran = subprocess.run([sys.executable, "-c", SEEN_BEFORE_AND_AFTER], capture_output=True, text=True, check=False)
    assert ran.stdout.splitlines()[-1:] == ["(False, False) (True, True)"], ran.stderr


def test_a_camera_of_a_robot_is_chosen_by_its_type() -> None:
    register_third_party_plugins()
    cameras = "{touch: {type: twintac, lab: true, fps: 30, width: 34, height: 18, full_scale_kpa: 20.0}}"
    config = parsed("--robot.type=stand_in", f"--robot.cameras={cameras}").robot
    assert isinstance(config, stand_in.StandInConfig)
    assert config.cameras["touch"] == TwintacCameraConfig(lab=True, fps=30, width=34, height=18, full_scale_kpa=20.0)
    camera = make_cameras_from_configs(config.cameras)["touch"]
    assert isinstance(camera, TwintacCamera) and (camera.width, camera.height, camera.fps) == (34, 18, 30)
    assert not camera.is_connected


def test_a_stock_robot_takes_the_camera() -> None:
    from lerobot.robots.so_follower import SO101FollowerConfig

    cameras = "{touch: {type: twintac, bus: /dev/i2c-1, counts_per_pa: 4}}"
    config = parsed_alone("--robot.type=so101_follower", "--robot.port=/dev/ttyACM0", f"--robot.cameras={cameras}").robot
    assert isinstance(config, SO101FollowerConfig)
    assert config.cameras == {"touch": TwintacCameraConfig(bus="/dev/i2c-1", counts_per_pa=4)}


def test_the_robot_wraps_another_one() -> None:
    robot = "{type: stand_in, cameras: {touch: {type: twintac, lab: true}}}"
    config = parsed("--robot.type=twintac_robot", f"--robot.robot={robot}").robot
    make_robot_from_config(config)
    made = make_robot_from_config(config)  # the configuration is unchanged
    assert isinstance(made, TwintacRobot)
    assert made.observation_features == {"joint.pos": float, "touch": (64, 96, 3), **{f"touch.t{taxel}_kpa": float for taxel in range(8)}}
    assert made.action_features == {"joint.pos": float}


def test_a_configuration_is_written_and_read_again() -> None:
    config = TwintacCameraConfig(udp="0.0.0.0:9000", line="board.toml", sidecar="runs/touch")
    assert draccus.decode(CameraConfig, draccus.encode(config)) == config


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ("", "exactly one source of lab, bus, serial, udp, replay; found none"),
        ("lab: true, bus: /dev/i2c-1", "exactly one source of lab, bus, serial, udp, replay; found lab and bus"),
        ("serial: /dev/ttyACM0", "serial needs line"),
        ("lab: true, line: board.toml", "line is for serial and udp, not for lab"),
        ("lab: true, counts_per_pa: 4", "counts_per_pa is for bus, not for lab"),
        ("lab: true, picture: photo", "picture is 'photo'; give one of taxels, map"),
        ("lab: true, full_scale_kpa: 0.0", "full_scale_kpa is 0.0"),
        ("lab: true, width: 0", "width is 0"),
    ],
)
def test_a_wrong_configuration_is_one_clear_error(fields: str, message: str) -> None:
    camera = f"{{type: twintac, {fields}}}" if fields else "{type: twintac}"
    config = parsed_alone("--robot.type=stand_in", f"--robot.cameras={{touch: {camera}}}").robot
    with pytest.raises(ValueError, match=f"camera touch .*{message}"):
        make_cameras_from_configs(config.cameras)


@pytest.mark.parametrize(
    ("robot", "message"),
    [
        ("{type: stand_in}", "the robot stand_in has no camera of type twintac; its cameras: none"),
        ("{type: no_such_robot}", "the configuration of robot is wrong.*no_such_robot"),
        ("{port: /dev/ttyACM0}", "give the configuration of a robot with its type"),
    ],
)
def test_a_wrong_robot_inside_is_one_clear_error(robot: str, message: str) -> None:
    config = parsed_alone("--robot.type=twintac_robot", f"--robot.robot={robot}").robot
    with pytest.raises(ValueError, match=message):
        make_robot_from_config(config)
