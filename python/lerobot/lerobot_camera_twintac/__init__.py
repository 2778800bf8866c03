"""TwinTac's barometric touch sensors in LeRobot.

LeRobot imports this package by its name and then knows two types:

- the camera `twintac`: one sensor; its pictures show the readings as grey levels;
- the robot `twintac_robot`: any other robot, with the exact readings of its `twintac` cameras in
  `observation.state`.

Pressures are in kPa above the readings of the untouched taxels, times in s.
"""

from lerobot_camera_twintac.camera import TwintacCamera
from lerobot_camera_twintac.configuration import TwintacCameraConfig
from lerobot_camera_twintac.picture import MapPicture, PressureScale, TaxelPicture
from lerobot_camera_twintac.robot import TwintacRobot
from lerobot_camera_twintac.robot_configuration import TwintacRobotConfig

__all__ = [
    "MapPicture",
    "PressureScale",
    "TaxelPicture",
    "TwintacCamera",
    "TwintacCameraConfig",
    "TwintacRobot",
    "TwintacRobotConfig",
]
