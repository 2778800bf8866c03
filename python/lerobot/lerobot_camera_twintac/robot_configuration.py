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
    """Any robot of LeRobot, with the exact readings of its `twintac` cameras as numbers in
    `observation.state`.

    - `robot`: configuration of the robot with the cameras: a `RobotConfig`, or its fields as a
      dictionary such as `{type: so101_follower, port: /dev/ttyACM0, cameras: …}`.
    - `pictures`: whether observations also have the pictures of those cameras.
    - `if_missing`: the reaction to a taxel without a reading: `error` raises an error, `nan` gives
      NaN. Statistics and training cannot use NaN.

    Errors are raised when a robot is made of the configuration (`inner`), because LeRobot's command
    line hides the errors of a configuration's constructor.
    """

    robot: Any
    pictures: bool = True
    if_missing: str = "error"

    def inner(self) -> RobotConfig:
        """The configuration of the robot with the cameras.

        Returns:
            The configuration.

        Raises:
            ValueError: for an unknown `if_missing`, for a robot that LeRobot does not know, and for
                wrong fields.
        """
        if self.if_missing not in MISSING:
            raise ValueError(f"twintac_robot: if_missing is {self.if_missing!r}; give one of {', '.join(MISSING)}")
        if isinstance(self.robot, RobotConfig):
            return self.robot
        if not isinstance(self.robot, dict) or "type" not in self.robot:
            raise ValueError(f"twintac_robot: robot is {self.robot!r}; give the configuration of a robot with its type, such as {{type: so101_follower, port: /dev/ttyACM0}}")
        try:
            # `decode` removes the types from its argument, so it gets a copy.
            return draccus.decode(RobotConfig, deepcopy(self.robot))
        except Exception as error:
            raise ValueError(f"twintac_robot: the configuration of robot is wrong: {error}") from error
