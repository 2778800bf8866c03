"""Steps a thousand imperfect sensors under a thousand balls, each ball a little deeper in each
step.
"""

import numpy as np

from twintac import Body, FastGel, SensorBatch, SensorVariation, Shape

N_SENSORS = 1024

variation = SensorVariation(gain_deviation=0.05, noise_deviation_kpa=0.02, dead_chance=0.01)
ball = Body(Shape.sphere(radius_mm=6.0))
sensors = SensorBatch(FastGel.phystac(), [ball], N_SENSORS, variation=variation, seed=1)
place_mm = np.zeros((N_SENSORS, 3))
place_mm[:, 0] = np.linspace(-10.0, 10.0, N_SENSORS)
for depth_mm in np.linspace(0.0, 2.0, 100):
    place_mm[:, 2] = 8.5 - depth_mm
    readings_kpa, wrench = sensors.step(0.01, place_mm)
print(f"the first sensor reads {readings_kpa[0].round(2)} kPa, {sensors.provenance}")
