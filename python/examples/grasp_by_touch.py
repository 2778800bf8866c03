"""Two fingers with a PhysTac each lift objects of unknown weight and shape, by touch alone.

    python grasp_by_touch.py [--objects 20] [--seed 1] [--json]
        [--plot grasps.png] [--picture scene.png]

The inputs of a finger are the readings of its eight barometers and the distance by which it was
moved. The fingers press lightly and rise in small steps. While the object still stands, the gel is
sheared, and the difference between the readings of the lower and the upper row grows. When the
difference stops growing, the object hangs. Its weight is estimated from the difference, and the
fingers hold it with the force that friction needs and a margin of a third, as far as the estimate
is right. For comparison, a gripper without touch lifts every object with one force.
"""

import argparse
import json
from typing import Any, NamedTuple

import mujoco
import numpy as np
import numpy.typing as npt

from twintac import Body, Coupling, FastGel, Sensor, SensorBatch, SensorVariation, Shape
from twintac.mujoco import TouchSensors, add_sensor

Array = npt.NDArray[np.float64]

FRICTION, GRAVITY_M_PER_S2 = 0.8, 9.81
FIRST_N = 0.17  # a light touch
MARGIN = 1.35  # a factor on the force that friction needs
FIXED_N = 3.0  # of the gripper without touch; it lifts the heaviest object
FIRST_RISE_MM, LIFT_MM = 0.03, 20.0
# Load that a step should add to the gel: a constant, and a fraction of the load that the gel
# carries.
RISE_N, RISE_PART = 0.025, 0.12
APART_M = 0.06  # from the middle to each finger
FRAMES = 12  # number of averaged frames, at 55 Hz
# The lower row minus the upper row: the difference between the rows.
PARTING = np.repeat([1.0, -1.0], 4)
# Noise and resolution of readings on the emulated bench.
SENSOR = SensorVariation(noise_deviation_kpa=0.015, quantum_kpa=0.01, rate_hz=55.0)


class Thing(NamedTuple):
    """An object. `size_m` is the size of a MuJoCo geom, from half of the width between the fingers
    to half of the height.
    """

    kind: str
    size_m: tuple[float, ...]
    mass_kg: float


def draw(number: int, rng: np.random.Generator) -> Thing:
    mass_kg = float(np.exp(rng.uniform(np.log(0.02), np.log(0.3))))
    height_m, half_m = rng.uniform(0.022, 0.03), rng.uniform(0.011, 0.018)
    if number % 3 == 0:
        return Thing("box", (half_m, rng.uniform(0.005, 0.008), height_m), mass_kg)
    if number % 3 == 1:
        return Thing("ball", (rng.uniform(0.014, 0.024),), mass_kg)
    return Thing("cylinder", (half_m, height_m), mass_kg)


def features(readings_kpa: Array) -> Array:
    """Products of readings, divided by the sum of the readings, and by the sum to the power of 3/2,
    `[n, 72]`.
    """
    total_kpa = np.maximum(readings_kpa.sum(1, keepdims=True), 0.2)
    i, j = np.triu_indices(readings_kpa.shape[1])
    products = readings_kpa[:, i] * readings_kpa[:, j] / total_kpa
    return np.concatenate([products, products / np.sqrt(total_kpa)], axis=1)


class Meaning:
    """Estimates, from the readings of a sensor, the force on a finger, and the growth of the
    difference between the rows for each newton of shear. This growth is about 2.4 kPa under objects
    that are straight along the shear, and 10 kPa under a ball, which moves away from one row. The
    estimates are trained on 6000 sensors that are pressed by boxes, balls and lying cylinders,
    sheared, and sheared a little more.
    """

    def __init__(self, rng: np.random.Generator) -> None:
        shapes, rests = [], []  # a rest: the body's frame where it touches the middle of the gel
        for radius_mm in rng.uniform(10.0, 26.0, 30):
            shapes += [Shape.box((rng.uniform(8.0, 18.0), rng.uniform(40.0, 64.0), 20.0), 0.0), Shape.sphere(radius_mm), Shape.cylinder(radius_mm, 60.0, 0.0)]
            rests += [(0, 0, 0, 0, 0, 0, 1), (0, 0, 0, 0, 0, 0, 1), (0, -30, radius_mm, -np.sqrt(0.5), 0, 0, np.sqrt(0.5))]
        sensor, n = Sensor.phystac(), 6000
        shape = rng.integers(len(shapes), size=n)
        depth_mm = 0.1 + 2.5 * rng.random(n) ** 2
        poses = np.array(rests)[shape]
        poses[:, :2] += rng.uniform(-1.0, 1.0, (n, 2))
        poses[:, 2] += sensor.bounds_mm[1, 2] - depth_mm
        sensors = SensorBatch(FastGel.phystac(), [Body(shape) for shape in shapes], n, coupling=Coupling(sensor, friction=FRICTION))
        sensors.step(1.0, poses, shape, touch_id=shape)
        poses[:, 1] -= rng.uniform(0.0, 0.6, n) * np.sqrt(depth_mm)
        readings_kpa, wrench = (values.astype(float) for values in sensors.step(1.0, poses, shape, touch_id=shape))
        poses[:, 1] -= 0.05
        after_kpa, after = (values.astype(float) for values in sensors.step(1.0, poses, shape, touch_id=shape))
        sticks = (wrench[:, 2] < -0.05) & (after[:, 1] > 0.9 * FRICTION * wrench[:, 2])
        readings_kpa, force_n, parting = readings_kpa[sticks], -wrench[sticks, 2], (after_kpa - readings_kpa)[sticks] @ PARTING
        # Least squares of the relative error, with weak regularization.
        weight = 1.0 / (0.05 + force_n)
        rows = features(readings_kpa) * weight[:, None]
        self.force = np.linalg.solve(rows.T @ rows + 1e-3 * np.eye(rows.shape[1]), rows.T @ (force_n * weight))
        self.known, self.known_kpa_per_n = self.contact(readings_kpa, parting / 0.05), parting / (wrench - after)[sticks, 1]

    def force_n(self, readings_kpa: Array) -> Array:
        return np.maximum(features(readings_kpa) @ self.force, 0.03)

    def contact(self, readings_kpa: Array, kpa_per_mm: Array) -> Array:
        """Features that distinguish a ball from straight objects: the force, the growth of the
        difference between the rows for each mm of shear, and the fraction of the inner columns in
        all readings, `[n, 3]`.
        """
        inner = readings_kpa[:, [1, 2, 5, 6]].sum(1) / np.maximum(readings_kpa.sum(1), 0.2)
        return np.column_stack([np.log(self.force_n(readings_kpa)), np.log(np.maximum(kpa_per_mm, 0.1)), 8.0 * inner])

    def kpa_per_n(self, readings_kpa: Array, kpa_per_mm: float) -> float:
        """The median over the 25 nearest training contacts, for both fingers."""
        apart = self.contact(readings_kpa, np.full(2, kpa_per_mm))[:, None] - self.known
        nearest = np.argsort((apart**2).sum(-1), axis=1)[:, :25]
        return float(np.median(self.known_kpa_per_n[nearest]))


def scene(thing: Thing) -> mujoco.MjModel:
    geom = {"box": "box", "ball": "sphere", "cylinder": "cylinder"}[thing.kind]
    size, half_height_m = " ".join(map(str, thing.size_m)), thing.size_m[-1]
    fingers = [
        f"""<body name="{name}" pos="{-inward * APART_M} 0 0"><joint name="{name}" type="slide" axis="{inward} 0 0" damping="20"/>
            <geom type="box" size="0.003 0.018 0.0425" pos="{-inward * 0.003} 0 0.0325" contype="0" conaffinity="0" mass="0.1"/></body>"""
        for name, inward in (("left", 1), ("right", -1))
    ]
    spec = mujoco.MjSpec.from_string(f"""
      <mujoco>
        <option timestep="0.001" integrator="implicitfast"/>
        <visual><headlight ambient="0.4 0.4 0.4"/></visual>
        <worldbody>
          <light pos="0 -0.3 0.5" dir="0 0.6 -1" diffuse="1 1 1"/>
          <geom type="plane" size="1 1 0.1" solref="0.004 1" solimp="0.99 0.999 0.0001"/>
          <body name="thing" pos="0 0 {half_height_m + 1e-4}"><freejoint/><geom type="{geom}" size="{size}" mass="{thing.mass_kg}" rgba="0.9 0.6 0.3 1"/></body>
          <body name="wrist" pos="0 0 {half_height_m}">
            <joint name="lift" type="slide" axis="0 0 1" damping="400"/>
            <geom type="box" size="0.08 0.012 0.005" pos="0 0 0.08" contype="0" conaffinity="0" mass="0.5"/>
            {"".join(fingers)}
          </body>
        </worldbody>
        <actuator><position joint="left" kp="4000"/><position joint="right" kp="4000"/><position joint="lift" kp="100000"/></actuator>
      </mujoco>""")
    # The gels face each other, with x along the fingers' width and y up.
    add_sensor(spec, Sensor.phystac(), body="left", name="left", quaternion=(0.5, 0.5, 0.5, 0.5))
    add_sensor(spec, Sensor.phystac(), body="right", name="right", quaternion=(0.5, -0.5, -0.5, 0.5))
    return spec.compile()


class Gripper:
    """Two fingers on a wrist that lifts them."""

    def __init__(self, thing: Thing, seed: int) -> None:
        self.model = scene(thing)
        self.data = mujoco.MjData(self.model)
        self.touch = TouchSensors(self.model, ["left", "right"], variation=SENSOR, friction=FRICTION, seed=seed)
        gap_m = APART_M - 1e-3 * float(Sensor.phystac().bounds_mm[1, 2]) - thing.size_m[0]
        self.closed_mm, self.risen_mm = 1e3 * gap_m - 1.0, 0.0
        # The true mean force of the fingers, now and at most, for the evaluation only.
        self.true_n, self.most_n = 0.0, 0.0
        self.data.joint("left").qpos[0] = self.data.joint("right").qpos[0] = 1e-3 * self.closed_mm
        self.step(0.1)

    def step(self, seconds: float, rise_mm: float = 0.0) -> Array:
        """Makes steps for a time. The wrist rises evenly in the first half of it. Returns the mean
        of each sensor's last readings, kPa, `[2, 8]`.
        """
        readings_kpa, n_steps = [], round(seconds / self.model.opt.timestep)
        for number in range(n_steps):
            self.risen_mm += 2.0 * rise_mm / n_steps if 2 * number < n_steps else 0.0
            mujoco.mj_step1(self.model, self.data)
            self.touch.update(self.data)
            self.data.ctrl[:] = 1e-3 * np.array([self.closed_mm, self.closed_mm, self.risen_mm])
            mujoco.mj_step2(self.model, self.data)
            if number % 18 == 17:
                readings_kpa.append(self.touch.readings_kpa[0].astype(float))
                self.true_n = float(-self.touch.wrench[0, :, 2].mean())
                self.most_n = max(self.most_n, self.true_n)
        return np.asarray(np.mean(readings_kpa[-FRAMES:], axis=0))

    def lift(self) -> bool:
        """Rises, and returns whether the object was lifted."""
        before_m = float(self.data.body("thing").xpos[2])
        self.step(4.0, LIFT_MM)
        return float(self.data.body("thing").xpos[2]) - before_m > 0.9e-3 * LIFT_MM

    def draw(self, path: str) -> None:
        from matplotlib.image import imsave

        camera = mujoco.MjvCamera()
        camera.lookat[:], camera.distance, camera.azimuth, camera.elevation = (0.0, 0.0, 0.055), 0.26, 70.0, -15.0
        with mujoco.Renderer(self.model, 480, 640) as renderer:
            renderer.update_scene(self.data, camera)
            imsave(path, renderer.render())


def grip(gripper: Gripper, meaning: Meaning, wanted_n: float) -> Array:
    """Closes or opens the fingers until the estimated force is the wanted one; returns the
    readings.
    """
    readings_kpa = gripper.step(0.25)
    for _ in range(30):
        force_n = float(meaning.force_n(readings_kpa).mean())
        if abs(force_n / wanted_n - 1.0) < 0.04:
            break
        # The divisor is the largest stiffness of a gel, N/mm.
        gripper.closed_mm += float(np.clip(0.8 * (wanted_n - force_n) / (1.0 + force_n), -0.2, 0.2))
        readings_kpa = gripper.step(0.25)
    return readings_kpa


def lift_by_touch(gripper: Gripper, meaning: Meaning) -> bool:
    while gripper.step(0.04).max(axis=1).min() < 0.15:
        gripper.closed_mm += 0.03
    readings_kpa = grip(gripper, meaning, FIRST_N)
    # Growth of the difference between the rows in each step in which the object stands, kPa/mm.
    stood: list[float] = []
    parted_kpa, carried_n, rise_mm, n_hung = 0.0, 0.0, FIRST_RISE_MM, 0
    while n_hung < 2 and gripper.risen_mm < LIFT_MM:
        before_kpa = readings_kpa
        readings_kpa = gripper.step(0.4, rise_mm)
        parting = float(((readings_kpa - before_kpa) @ PARTING).mean())
        parted_kpa += parting
        stands = len(stood) < 3 or parting > 0.5 * rise_mm * np.median(stood[-5:])
        stood += [parting / rise_mm] if stands else []
        n_hung = 0 if stands else n_hung + 1
        kpa_per_mm = max(float(np.median(stood[-5:])), 0.1)
        kpa_per_n = meaning.kpa_per_n(readings_kpa, kpa_per_mm)
        carried_n = max(parted_kpa / kpa_per_n, 0.0)
        next_n = RISE_N + RISE_PART * carried_n
        rise_mm = next_n * kpa_per_n / kpa_per_mm
        wanted_n = max(FIRST_N, MARGIN * (carried_n + 0.7 * next_n) / FRICTION)
        if stands and wanted_n > 1.05 * meaning.force_n(readings_kpa).mean():
            readings_kpa = grip(gripper, meaning, wanted_n)
    grip(gripper, meaning, max(FIRST_N, MARGIN * carried_n / FRICTION))
    return gripper.lift()


def lift_without_touch(gripper: Gripper) -> bool:
    while gripper.true_n < FIXED_N:
        gripper.closed_mm += 0.02
        gripper.step(0.04)
    return gripper.lift()


def plot(grasps: list[dict[str, Any]], path: str) -> None:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7, 4.5), layout="tight")
    axes = figure.add_subplot(xscale="log", yscale="log", xlabel="force of each finger that friction needs, N", ylabel="force of each finger, N")
    axes.plot([0.1, 2.0], [0.1, 2.0], "k-", label="what friction needs")
    axes.plot([0.1, 2.0], [0.2, 4.0], "k--", label="twice as much")
    for grasp in grasps:
        style = {"box": "C0s", "ball": "C1o", "cylinder": "C2^"}[grasp["kind"]] if grasp["lifted"] else "rx"
        axes.plot(grasp["needed_n"], grasp["held_n"], style, label=f"{grasp['kind']}, by touch" if grasp["lifted"] else "dropped, by touch")
        axes.plot(grasp["needed_n"], grasp["held_without_touch_n"], "+", color="gray", label="one force for all")
    named = dict(zip(*reversed(axes.get_legend_handles_labels())))
    axes.legend(named.values(), named.keys())
    axes.set_title("Objects that hang, simulated")
    figure.savefig(path, dpi=130)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--objects", type=int, default=20, help="how many to lift (default: 20)")
    parser.add_argument("--seed", type=int, default=1, help="of all that is random (default: 1)")
    parser.add_argument("--json", action="store_true", help="print all as JSON")
    parser.add_argument("--plot", metavar="FILE", help="draw the forces; needs matplotlib")
    parser.add_argument("--picture", metavar="FILE", help="draw the last object as it hangs; needs matplotlib, and OpenGL as MUJOCO_GL names it")
    asked = parser.parse_args()
    meaning, rng = Meaning(np.random.default_rng(asked.seed)), np.random.default_rng(asked.seed)
    grasps: list[dict[str, Any]] = []
    for number in range(asked.objects):
        thing = draw(number, rng)
        # force of each finger below which the object would slip
        needed_n = 0.5 * thing.mass_kg * GRAVITY_M_PER_S2 / FRICTION
        touching, blind = Gripper(thing, asked.seed + number), Gripper(thing, asked.seed + number)
        found: dict[str, Any] = dict(kind=thing.kind, mass_g=round(1e3 * thing.mass_kg, 1), needed_n=round(needed_n, 3))
        found |= dict(lifted=lift_by_touch(touching, meaning), held_n=round(touching.true_n, 3), most_n=round(touching.most_n, 3))
        found |= dict(lifted_without_touch=lift_without_touch(blind), held_without_touch_n=round(blind.true_n, 3))
        grasps.append(found)
        if not asked.json:
            end = "lifted" if found["lifted"] else "dropped"
            part, blind_part = touching.true_n / needed_n, blind.true_n / needed_n
            print(f"{thing.kind:<9}{1e3 * thing.mass_kg:6.1f} g: {end}, held with {part:.2f} of the force needed; without touch {blind_part:5.2f}", flush=True)
    if asked.plot:
        plot(grasps, asked.plot)
    if asked.picture:
        touching.draw(asked.picture)
    if asked.json:
        print(json.dumps({"provenance": "simulated", "seed": asked.seed, "grasps": grasps}, indent=1))
    else:
        parts = [found["held_n"] / found["needed_n"] for found in grasps]
        lifted = sum(found["lifted"] for found in grasps)
        print(f"{lifted} of {len(grasps)} lifted by touch, with {min(parts):.2f} to {max(parts):.2f} of the force needed, simulated")


if __name__ == "__main__":
    main()
