"""A ball that slides over a flat pad, measured by MuJoCo's sensor plugin `touch_grid` with 4 x 2
cells.

The argument is a JSON object: the numbers of scenes, threads and steps. Prints a JSON object: the
version, and the duration of each step, s.
"""

import json
import sys
import time

import mujoco
import numpy as np
from mujoco import batch

XML = """
<mujoco>
  <extension><plugin plugin="mujoco.sensor.touch_grid"/></extension>
  <option timestep="0.01" gravity="0 0 0"/>
  <worldbody>
    <body name="ball" mocap="true" pos="0 0 0.01"><geom type="sphere" size="0.006"/></body>
    <body pos="0 0 -0.004">
      <joint type="slide" axis="0 0 1" stiffness="2000" damping="20"/>
      <geom type="box" size="0.015 0.010 0.004" mass="0.01"/>
      <site name="pad" pos="0 0 -0.02" euler="180 0 0"/>
    </body>
  </worldbody>
  <sensor>
    <plugin plugin="mujoco.sensor.touch_grid" objtype="site" objname="pad">
      <config key="size" value="4 2"/>
      <config key="fov" value="35 25"/>
      <config key="gamma" value="0"/>
      <config key="nchannel" value="1"/>
    </plugin>
  </sensor>
</mujoco>
"""


def main():
    asked = json.loads(sys.argv[1])
    model = mujoco.MjModel.from_xml_string(XML)
    scenes = batch.Batch(model, asked["n_scenes"], asked["n_threads"])
    ball_m, cells = scenes.bind("mocap_pos"), scenes.bind("sensordata")
    numbers = np.arange(asked["n_scenes"])
    seconds, touched = [], []
    for step in range(asked["n_warm_up"] + asked["n_steps"]):
        phase = 0.02 * step + 0.1 * numbers
        ball_m[:, 0, 0] = 0.008 * np.sin(phase)
        ball_m[:, 0, 1] = 0.005 * np.sin(1.3 * phase)
        ball_m[:, 0, 2] = 0.006 - 0.001 * (1.0 + 0.5 * np.sin(0.7 * phase))
        started = time.perf_counter()
        scenes.step()
        if step >= asked["n_warm_up"]:
            seconds.append(time.perf_counter() - started)
            touched.append(np.count_nonzero(cells, axis=1))
    touched = np.array(touched)
    found = {
        "version": mujoco.__version__,
        "n_cells": cells.shape[1],
        "touched": float(np.mean(touched > 0)),
        "cells_touched": float(np.mean(touched[touched > 0])),
        "seconds": seconds,
    }
    print(json.dumps(found))


if __name__ == "__main__":
    main()
