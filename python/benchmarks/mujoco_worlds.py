"""Measures how many steps of MuJoCo a second are made with touch sensors, and without: writes
docs/benchmarks/mujoco.json and mujoco.md.

pip install './python[mujoco]'
python python/benchmarks/mujoco_worlds.py
"""

import json
import os
import platform
import time
from pathlib import Path
from typing import Any

import mujoco
import mujoco.batch
import numpy as np

from twintac import Sensor
from twintac.mujoco import TouchSensors, add_sensor

ROOT = Path(__file__).parents[2]
COMMAND = "python python/benchmarks/mujoco_worlds.py"
N_THREADS = 2
N_WARM_UP, N_STEPS = 200, 600
# Two boards that close on an object, along z.
GRIPPER = """
<mujoco><option timestep="0.001" gravity="0 0 0"/><worldbody>
  <body name="below" pos="0 0 -0.0135"/>
  <body name="above" pos="0 0 0.0145"><joint name="close" type="slide" axis="0 0 1" damping="5"/>
    <geom type="box" size="0.017 0.009 0.001" mass="0.1" contype="0" conaffinity="0"/></body>
  {arm}
  <body name="object"><freejoint/><geom name="object" {object} mass="0.02"/></body>
</worldbody><actuator><motor joint="close"/></actuator></mujoco>"""
# Links that touch nothing, as a robot has many.
ARM = "".join(
    f'<body pos="0.1 0 0.1"><joint axis="0 1 0" damping="1" stiffness="10"/><geom type="capsule" size="0.02 0.05" pos="0 0 {0.05 + 0.1 * part}"/>'
    for part in range(10)
) + 10 * "</body>"
BALL, BOX = 'type="sphere" size="0.006"', 'type="box" size="0.006 0.006 0.006"'
# What is between the fingers, what is beside them, and the number of worlds.
SCENES = {
    "ball between two fingers": (BALL, "", 64),
    "box between two fingers": (BOX, "", 64),
    "ball between two fingers, beside ten links": (BALL, ARM, 64),
    "ball between two fingers, many worlds": (BALL, "", 512),
}


class Timed:
    """Worlds of a scene whose steps are timed one by one."""

    def __init__(self, scene: tuple[str, str, int], has_touch: bool) -> None:
        thing, arm, self.n_worlds = scene
        spec = mujoco.MjSpec.from_string(GRIPPER.format(object=thing, arm=arm))
        add_sensor(spec, Sensor.phystac(), body="below", name="lower")
        add_sensor(spec, Sensor.phystac(), body="above", name="upper", quaternion=(1.0, 0.0, 0.0, 0.0))
        model = spec.compile()
        self.batch = mujoco.batch.Batch(model, self.n_worlds, nthread=N_THREADS, persistent=True)
        self.batch.bind("ctrl")[:] = -1.0
        self.batch.forward(stage=mujoco.mjtStage.mjSTAGE_VEL)
        self.touch = TouchSensors(model, ["lower", "upper"], n_worlds=self.n_worlds, n_threads=N_THREADS) if has_touch else None
        self.rates: list[float] = []

    def step(self, counts: bool) -> None:
        """Makes one step of all worlds; `counts` says whether its rate counts."""
        started = time.perf_counter()
        if self.touch is not None:
            self.touch.update(self.batch)
        self.batch.step(stage=mujoco.mjtStage.mjSTAGE_VEL)
        if counts:
            self.rates.append(self.n_worlds / (time.perf_counter() - started))


def measured() -> list[dict[str, Any]]:
    """The rates of all scenes. Scenes take turns, so that other load of the machine affects all
    alike.
    """
    pairs = [(name, Timed(scene, True), Timed(scene, False)) for name, scene in SCENES.items()]
    for step in range(N_WARM_UP + N_STEPS):
        for _, *timed in pairs:
            for one in timed:
                one.step(step >= N_WARM_UP)
    found = []
    for name, touched, bare in pairs:
        assert touched.touch is not None
        carried_n = -touched.touch.wrench[:, :, 2]
        found.append(
            {
                "scene": name,
                "worlds": touched.n_worlds,
                "with_touch_steps_per_s": float(np.median(touched.rates)),
                "without_touch_steps_per_s": float(np.median(bare.rates)),
                "carried_n": [float(carried_n.min()), float(carried_n.max())],
            }
        )
    return found


def page(results: dict[str, Any]) -> str:
    """The results as a Markdown page."""
    machine = results["machine"]
    rows = [
        f"| {one['scene']} | {one['worlds']} | {one['with_touch_steps_per_s']:,.0f} | {one['without_touch_steps_per_s']:,.0f} "
        f"| {one['without_touch_steps_per_s'] / one['with_touch_steps_per_s']:.1f} | {one['carried_n'][0]:.2f} to {one['carried_n'][1]:.2f} |"
        for one in results["scenes"]
    ]
    return "\n".join(
        [
            "# MuJoCo with touch",
            "",
            f"Made by `{COMMAND}` on {machine['processor']}, {machine['processors']} processors, with MuJoCo {mujoco.__version__} (simulated data). Load average at the end: {machine['load_average']:.1f}.",
            "",
            f"Worlds of a `mujoco.batch.Batch` on {N_THREADS} threads, steps of 1 ms. Two fingers with a PhysTac each close on an object with 1 N. Without touch, the same worlds are stepped without sensors, and the object touches nothing. All take turns in one run; of {N_STEPS} steps each, the median counts. A step is a step of one world.",
            "",
            "| scene | worlds | steps a second with touch | without | ratio | load of the gels at the end, N |",
            "|---|---:|---:|---:|---:|---:|",
            *rows,
            "",
        ]
    )


def main() -> None:
    """Measures everything, and writes the results."""
    cpu = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")), platform.processor())
    results = {
        "command": COMMAND,
        "provenance": "simulated",
        "threads": N_THREADS,
        "scenes": measured(),
        "machine": {"processor": cpu, "processors": os.cpu_count(), "load_average": os.getloadavg()[0]},
    }
    folder = ROOT / "docs/benchmarks"
    (folder / "mujoco.json").write_text(json.dumps(results, indent=2) + "\n")
    (folder / "mujoco.md").write_text(page(results))
    print(page(results))


if __name__ == "__main__":
    main()
