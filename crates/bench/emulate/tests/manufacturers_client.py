"""The manufacturer's own client (PyPI: xarm-python-sdk) against a robot on the loopback.

Arguments: the TCP ports for commands and for normal, rich and development reports. The last printed
line has the observations as JSON.
"""

import json
import math
import sys
import time

from xarm.core.config.x_config import XCONF
from xarm.x3.report import ReportDataStructure

commands, normal, rich, development = map(int, sys.argv[1:5])
# Ports are constants of the client. It takes a report port for a command port if its number is the
# next higher one.
XCONF.SocketConf.TCP_CONTROL_PORT = commands
XCONF.SocketConf.TCP_REPORT_NORM_PORT = normal
XCONF.SocketConf.TCP_REPORT_RICH_PORT = rich
XCONF.SocketConf.TCP_REPORT_REAL_PORT = development

# The client derives the content of a report from its usual port.
USUAL_PORTS = {normal: 30001, rich: 30002, development: 30003}
create = ReportDataStructure.create
ReportDataStructure.create = lambda port, **settings: create(USUAL_PORTS[port], **settings)

from xarm.wrapper import XArmAPI  # noqa: E402

arm = XArmAPI("127.0.0.1", is_radian=True)
seen = {"codes": {}}


def note(name, code):
    """The client's return code: 0 is success."""
    seen["codes"].setdefault(name, code)


def wait_for(condition, within_s=2.0):
    """Waits until a condition is true. Returns whether it became true in time."""
    until = time.monotonic() + within_s
    while not condition() and time.monotonic() < until:
        time.sleep(0.01)
    return bool(condition())


code, seen["version"] = arm.get_version()
note("get_version", code)
seen["version_number"] = list(arm.version_number)
code, seen["serial_number"] = arm.get_robot_sn()
note("get_robot_sn", code)
seen["state_at_first"] = arm.get_state()[1]

note("motion_enable", arm.motion_enable(enable=True))
note("set_mode", arm.set_mode(0))
note("set_state", arm.set_state(0))
seen["is_ready"] = wait_for(lambda: arm.state == 2)

code, first = arm.get_position(is_radian=True)
note("get_position", code)
seen["first"] = first
code, _ = arm.get_servo_angle()
note("get_servo_angle", code)
code, seen["axis_angle"] = arm.get_position_aa(is_radian=True)
note("get_position_aa", code)

note("set_position", arm.set_position(z=first[2] - 20.0, speed=100, wait=True, timeout=5))
code, seen["lowered"] = arm.get_position(is_radian=True)

note("set_mode 1", arm.set_mode(1))
note("set_state 0", arm.set_state(0))
time.sleep(0.1)
pose = list(seen["lowered"])
for step in range(50):
    pose[2] -= 0.2
    note("set_servo_cartesian", arm.set_servo_cartesian(pose, is_radian=True))
    time.sleep(0.004)
time.sleep(0.3)
code, seen["followed"] = arm.get_position(is_radian=True)
seen["reported"] = list(arm.position) if wait_for(lambda: abs(arm.position[2] - pose[2]) < 0.1) else None
seen["mode"] = arm.mode

pose[2] -= 50.0
seen["code_of_a_jump"] = arm.set_servo_cartesian(pose, is_radian=True)
code, seen["errors"] = arm.get_err_warn_code()
note("get_err_warn_code", code)
seen["is_error_reported"] = wait_for(lambda: arm.error_code == 24)
note("clean_error", arm.clean_error())
note("motion_enable again", arm.motion_enable(enable=True))
note("set_mode again", arm.set_mode(0))
note("set_state again", arm.set_state(0))
seen["is_ready_again"] = wait_for(lambda: arm.state == 2 and arm.error_code == 0)
arm.disconnect()
assert all(math.isfinite(number) for number in seen["followed"])
print(json.dumps(seen))
