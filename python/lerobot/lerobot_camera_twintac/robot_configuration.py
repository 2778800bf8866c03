"""Configuration of the robot."""

from copy import deepcopy
from dataclasses import dataclass
from typing import Any

import draccus
from lerobot.robots import RobotConfig

__all__ = ["TwintacRobotConfig"]

MISSING = ("error", "nan")


@RobotConfig.register_subclass("twintac_robot")
@dataclass(kw_only=True)
class TwintacRobotConfig(RobotConfig):
    """Any robot of LeRobot, with the exact readings of its `twintac` cameras as numbers in `observation.state`.

    - `robot`: configuration of the robot with the cameras: a `RobotConfig`, or its fields as a dictionary such as `{type: so101_follower, port: /dev/ttyACM0, cameras: …}`.
    - `pictures`: whether observations also have the pictures of those cameras.
    - `if_missing`: what a taxel without a reading does: `error` raises an error, `nan` gives NaN. Statistics and training cannot use NaN.

    What is wrong with it is said when a robot is made of it (`inner`): LeRobot's command line hides the errors of a configuration's constructor.
    """

    robot: Any
    pictures: bool = True
    if_missing: str = "error"

    def inner(self) -> RobotConfig:
        """The configuration of the robot with the cameras. Raises `ValueError` for a robot that LeRobot does not know, or whose fields are wrong."""
        if self.if_missing not in MISSING:
            raise ValueError(f"twintac_robot: if_missing is {self.if_missing!r}; give one of {', '.join(MISSING)}")
        if isinstance(self.robot, RobotConfig):
            return self.robot
        if not isinstance(self.robot, dict) or "type" not in self.robot:
            raise ValueError(f"twintac_robot: robot is {self.robot!r}; give the configuration of a robot with its type, such as {{type: so101_follower, port: /dev/ttyACM0}}")
        try:
            return draccus.decode(RobotConfig, deepcopy(self.robot))  # which takes the types out of what it decodes
        except Exception as error:
            raise ValueError(f"twintac_robot: the configuration of robot is wrong: {error}") from error
