"""Presses a ball into PhysTac's gel and moves it sideways, frame by frame, as a robot or a physics
engine would.
"""

from twintac import Gel, Pose, Sensor

gel = Gel(Sensor.phystac(), {"max_path_nodes": 4000})
touch = gel.touch("sphere-25", Pose((-2.0, 0.0, 0.0)))
x_mm, y_mm, z_mm = touch.position_mm
deep, aside = Pose((x_mm, y_mm, z_mm - 1.0)), Pose((x_mm + 3.0, y_mm, z_mm - 1.0))
state = gel.state("sphere-25", [deep, aside])
for pose in (touch, deep, aside):
    readings_kpa = state.step(0.1, pose)
    print(f"{state.force_n.round(2)} N, {readings_kpa.round(2)} kPa, {state.provenance}")
