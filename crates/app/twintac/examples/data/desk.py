"""Writes desk-readings.csv and desk-robot.csv: the presses of presses.csv, in the form in which two
programs on one desk would have logged them, each with its own clock.

python3 crates/app/twintac/examples/data/desk.py
"""

import csv
from itertools import groupby
from pathlib import Path

DATA = Path(__file__).parent
ROBOT_STEP_S = 0.02
TAXELS = range(8)
BEGINS_S = 3.0  # on the microcontroller's clock

# Offset of the robot's clock when the microcontroller's clock is at 0, s, and the ratio of their
# rates.
ROBOT_AHEAD_S = 1.12
ROBOT_RATE = 1.003

with (DATA / "presses.csv").open() as file:
    presses = [list(rows) for _, rows in groupby(csv.DictReader(file), lambda row: row["press"])]

readings = ["PhysTac bridge 1.2", "8 barometers found"]
readings.append("ms;" + ";".join(f"p{taxel}" for taxel in TAXELS))
robot = ["t,x,y,z,fz,press"]
for rows in presses:
    times_s = [float(row["time_s"]) for row in rows]

    def at(name: str, time_s: float) -> float:
        """The value of a column at a time, linear between its rows."""
        after = min(max(1, sum(t < time_s for t in times_s)), len(rows) - 1)
        first, second = times_s[after - 1], times_s[after]
        values = [float(rows[index][name]) for index in (after - 1, after)]
        return values[0] + (time_s - first) / (second - first) * (values[1] - values[0])

    for time_s, row in zip(times_s, rows):
        pressures_hpa = (f"{10 * float(row[f't{taxel}_kpa']):.1f}" for taxel in TAXELS)
        line = f"{1000 * (BEGINS_S + time_s):.0f};" + ";".join(pressures_hpa) + ";"
        readings.append(line.replace(".", ","))
    steps = int((times_s[-1] - times_s[0]) / ROBOT_STEP_S)
    for time_s in (times_s[0] + ROBOT_STEP_S * step for step in range(steps + 1)):
        x, y, z = (at(name, time_s) for name in ("x_mm", "y_mm", "height_mm"))
        clock_s = ROBOT_AHEAD_S + ROBOT_RATE * (BEGINS_S + time_s)
        robot.append(f"{clock_s:.4f},{x:.3f},{y:.3f},{z:.3f},{at('force_n', time_s):.3f},{rows[0]['press']}")

# A line that the microcontroller did not finish.
readings.append(readings[-1][:31])
(DATA / "desk-readings.csv").write_text("\n".join(readings))
(DATA / "desk-robot.csv").write_text("\n".join(robot) + "\n")
