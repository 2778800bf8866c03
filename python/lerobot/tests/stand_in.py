"""A robot with one joint and its leader, for tests: LeRobot finds and uses them like any other
robot.
"""

from dataclasses import dataclass, field
from typing import Any

from lerobot.cameras import CameraConfig, make_cameras_from_configs
from lerobot.robots import Robot, RobotConfig
from lerobot.teleoperators import Teleoperator, TeleoperatorConfig


@RobotConfig.register_subclass("stand_in")
@dataclass(kw_only=True)
class StandInConfig(RobotConfig):
    """Configuration of a robot with cameras."""

    cameras: dict[str, CameraConfig] = field(default_factory=dict)


class StandIn(Robot):
    """A robot whose joint is always at its commanded position."""

    config_class = StandInConfig
    name = "stand_in"
    is_connected = False
    is_calibrated = True

    def __init__(self, config: StandInConfig) -> None:
        super().__init__(config)
        self.config = config
        self.cameras = make_cameras_from_configs(config.cameras)
        self.position = 0.0

    @property
    def observation_features(self) -> dict[str, Any]:
        pictures = {name: (camera.height, camera.width, 3) for name, camera in self.config.cameras.items()}
        return {"joint.pos": float, **pictures}

    @property
    def action_features(self) -> dict[str, Any]:
        return {"joint.pos": float}

    def connect(self, calibrate: bool = True) -> None:
        for camera in self.cameras.values():
            camera.connect()
        self.is_connected = True

    def calibrate(self) -> None:
        pass

    def configure(self) -> None:
        pass

    def get_observation(self) -> dict[str, Any]:
        return {"joint.pos": self.position, **{name: camera.read_latest() for name, camera in self.cameras.items()}}

    def send_action(self, action: dict[str, Any]) -> dict[str, Any]:
        self.position = action["joint.pos"]
        return action

    def disconnect(self) -> None:
        for camera in self.cameras.values():
            camera.disconnect()
        self.is_connected = False


@TeleoperatorConfig.register_subclass("stand_in")
@dataclass(kw_only=True)
class StandInLeaderConfig(TeleoperatorConfig):
    """Configuration of a leader."""


class StandInLeader(Teleoperator):
    """A leader whose position increases by one with each action."""

    config_class = StandInLeaderConfig
    name = "stand_in"
    is_connected = False
    is_calibrated = True
    position = 0.0

    @property
    def action_features(self) -> dict[str, Any]:
        return {"joint.pos": float}

    @property
    def feedback_features(self) -> dict[str, Any]:
        return {}

    def connect(self, calibrate: bool = True) -> None:
        self.is_connected = True

    def calibrate(self) -> None:
        pass

    def configure(self) -> None:
        pass

    def get_action(self) -> dict[str, Any]:
        self.position += 1.0
        return {"joint.pos": self.position}

    def send_feedback(self, feedback: dict[str, Any]) -> None:
        pass

    def disconnect(self) -> None:
        self.is_connected = False
