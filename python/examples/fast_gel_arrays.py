"""Evaluates the surrogate of PhysTac's gel as a function of arrays: a ball and a cube on each of a
thousand sensors.
"""

import numpy as np

from twintac import FastGel, arrays

gel = arrays.load(FastGel.phystac())
shapes = arrays.stack([arrays.ball(5.0), arrays.box((8.0, 8.0, 8.0), edge_radius_mm=0.5)])
random = np.random.default_rng(1)
position_mm = random.uniform([-12.0, -6.0, 6.5], [12.0, 6.0, 9.5], (1000, 2, 3))
reading = arrays.read(gel, shapes, position_mm)
for number in range(3):
    force_n, largest_kpa = -reading.wrench[number, 2], reading.pressure_kpa[number].max()
    print(f"sensor {number}: gaps {reading.gap_mm[number].round(2)} mm, {force_n:.2f} N, {largest_kpa:.2f} kPa at most")
print(f"{len(reading.wrench)} sensors of {reading.pressure_kpa.shape[-1]} taxels, simulated")
