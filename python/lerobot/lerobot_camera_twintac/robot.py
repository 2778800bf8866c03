"""The robot: another robot, with exact readings in its state."""

import math
from typing import Any

from lerobot.robots import Robot, make_robot_from_config
from twintac import Reading

from lerobot_camera_twintac.camera import TwintacCamera
from lerobot_camera_twintac.robot_configuration import TwintacRobotConfig

__all__ = ["TwintacRobot"]


class TwintacRobot(Robot):
    """Any robot of LeRobot, with the exact readings of its `twintac` cameras as numbers in
    `observation.state`.

    Observations have a number `<camera>.<taxel>_kpa` for each taxel, after the numbers of the
    robot. It is of the same frame as the camera's picture. Everything else is as in the robot.

    Args:
        config: the configuration.

    Raises:
        ValueError: for a wrong configuration, for a robot without a `twintac` camera, and for a
            robot whose observations give a camera another name.
    """

    config_class = TwintacRobotConfig
    name = "twintac_robot"

    def __init__(self, config: TwintacRobotConfig) -> None:
        super().__init__(config)
        self.config = config
        self.robot: Robot = make_robot_from_config(config.inner())
        """The robot with the cameras."""
        cameras = getattr(self.robot, "cameras", {})
        self.touch: dict[str, TwintacCamera] = {name: camera for name, camera in cameras.items() if isinstance(camera, TwintacCamera)}
        """The `twintac` cameras, by name."""
        if not self.touch:
            raise ValueError(f"twintac_robot: the robot {self.robot.name} has no camera of type twintac; its cameras: {', '.join(cameras) or 'none'}")
        for name in self.touch:
            if name not in self.robot.observation_features:
                raise ValueError(f"twintac_robot: the robot {self.robot.name} does not show its camera {name} under that name: robots that rename cameras, as those of two arms, cannot be used")

    @property
    def cameras(self) -> dict[str, Any]:
        """The cameras with pictures in the observations, by name."""
        return {name: camera for name, camera in self.robot.cameras.items() if self._is_shown(name)}

    @property
    def observation_features(self) -> dict[str, Any]:
        """Types and shapes of the values in observations, by name."""
        readings = {key: float for name, camera in self.touch.items() for key in _keys(name, camera)}
        return {name: feature for name, feature in self.robot.observation_features.items() if self._is_shown(name)} | readings

    @property
    def action_features(self) -> dict[str, Any]:
        """Types of the values in actions, by name: those of the robot."""
        return dict(self.robot.action_features)

    @property
    def is_connected(self) -> bool:
        """Whether the robot is connected."""
        return bool(self.robot.is_connected)

    @property
    def is_calibrated(self) -> bool:
        """Whether the robot is calibrated."""
        return bool(self.robot.is_calibrated)

    def connect(self, calibrate: bool = True) -> None:
        """Connects the robot and its cameras. Nothing may touch the sensors during the call.

        Args:
            calibrate: passed on to the robot.
        """
        self.robot.connect(calibrate)

    def calibrate(self) -> None:
        """Calibrates the robot."""
        self.robot.calibrate()

    def configure(self) -> None:
        """Configures the robot."""
        self.robot.configure()

    def get_observation(self) -> dict[str, Any]:
        """The robot's observation, with the readings, kPa.

        Returns:
            The observation.

        Raises:
            RuntimeError: for a taxel without a reading, unless `if_missing` is `nan`, and if the
                robot took no picture of a camera.
        """
        for camera in self.touch.values():
            camera.reading = None  # an older reading is not used again
        observation = {name: value for name, value in self.robot.get_observation().items() if self._is_shown(name)}
        for name, camera in self.touch.items():
            reading = camera.reading
            if reading is None:
                raise RuntimeError(f"twintac_robot: the robot {self.robot.name} took no picture of its camera {name} for its observation")
            observation.update(zip(_keys(name, camera), self._readings_kpa(name, camera, reading), strict=True))
        return observation

    def send_action(self, action: dict[str, Any]) -> dict[str, Any]:
        """Sends an action to the robot.

        Args:
            action: the action.

        Returns:
            The action that was sent.
        """
        return dict(self.robot.send_action(action))

    def disconnect(self) -> None:
        """Disconnects the robot and its cameras."""
        self.robot.disconnect()

    def _is_shown(self, name: str) -> bool:
        return self.config.pictures or name not in self.touch

    def _readings_kpa(self, name: str, camera: TwintacCamera, reading: Reading) -> list[float]:
        readings_kpa: list[float] = reading.readings_kpa.tolist()
        for taxel, reading_kpa, fault in zip(camera.sensor.taxels, readings_kpa, reading.faults, strict=True):
            if math.isnan(reading_kpa) and self.config.if_missing == "error":
                raise RuntimeError(f"twintac_robot: taxel {taxel} of {name} has no reading ({fault or 'unknown cause'}); repair it, or set if_missing: nan, which records NaN")
        return readings_kpa


def _keys(name: str, camera: TwintacCamera) -> list[str]:
    return [f"{name}.{taxel}_kpa" for taxel in camera.sensor.taxels]
