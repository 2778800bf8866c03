"""Two fingers with a PhysTac each lift objects of unknown weight and shape, by touch alone.

    python grasp_by_touch.py [--objects 20] [--seed 1] [--plot grasps.png]

What a finger knows is what its eight barometers read, and how far it has been moved. It presses lightly and is raised in small steps while the object still
stands. As long as the object does, the gel is sheared by as much as the finger rises, and the readings of the upper and the lower row part. Where they stop parting,
the object hangs: by then the gel carries its weight, and the fingers hold it with what friction needs and a half more. Beside it stands a gripper
without touch, which takes every object with one force.
"""

import argparse
from dataclasses import dataclass

import mujoco
import numpy as np
import numpy.typing as npt

from twintac import Body, Coupling, FastGel, Imperfection, Sensor, SensorBatch, Shape
from twintac.mujoco import TouchSensors, add_sensor

Array = npt.NDArray[np.float64]

FRICTION = 0.8
GRAVITY_M_PER_S2 = 9.81
FIRST_N = 0.19  # a light touch
MARGIN = 1.45  # of what friction needs
FIXED_N = 3.0  # of the gripper without touch: lifts the heaviest
RISE_MM = 0.1  # of a step
LIFT_MM = 20.0
APART_M = 0.06  # from the middle to each finger
FRAMES = 12  # that are averaged, at 55 Hz
# Noise and steps of readings as they were found on the emulated bench.
SENSOR = Imperfection(noise_deviation_kpa=0.015, quantum_kpa=0.01, rate_hz=55.0)


@dataclass(frozen=True)
class Thing:
    """An object: a MuJoCo geom, half its width between the fingers and half its height, m."""

    kind: str
    geom: str
    half_m: float
    half_height_m: float
    mass_kg: float

    @property
    def needed_n(self) -> float:
        """The force of each finger below which it would slip, N."""
        return 0.5 * self.mass_kg * GRAVITY_M_PER_S2 / FRICTION


def draw(number: int, rng: np.random.Generator) -> Thing:
    mass_kg = float(np.exp(rng.uniform(np.log(0.02), np.log(0.3))))
    height_m, half_m = rng.uniform(0.022, 0.03), rng.uniform(0.011, 0.018)
    kind = ("box", "ball", "cylinder")[number % 3]
    if kind == "box":
        size = f"{half_m} {rng.uniform(0.005, 0.008)} {height_m}"
        return Thing(kind, f'type="box" size="{size}"', half_m, height_m, mass_kg)
    if kind == "ball":
        half_m = rng.uniform(0.014, 0.024)
        return Thing(kind, f'type="sphere" size="{half_m}"', half_m, half_m, mass_kg)
    return Thing(kind, f'type="cylinder" size="{half_m} {height_m}"', half_m, height_m, mass_kg)


# --- what readings mean, learned from the fast gel ---


def features(readings_kpa: Array) -> Array:
    """Readings, their products over their sum, and roots of them. `[n, n_features]`"""
    total_kpa = np.maximum(readings_kpa.sum(1, keepdims=True), 0.2)
    i, j = np.triu_indices(readings_kpa.shape[1])
    products = readings_kpa[:, i] * readings_kpa[:, j] / total_kpa
    parts = readings_kpa / total_kpa
    return np.concatenate([readings_kpa, products, np.sqrt(total_kpa) * np.column_stack([parts, parts[:, i] * parts[:, j]])], axis=1)


class Meaning:
    """The force on a finger, N, and how stiff its gel is against shear, N/mm, from what its sensor reads."""

    def __init__(self, seed: int) -> None:
        rng = np.random.default_rng(seed)
        readings_kpa, force_n, stiffness_n_per_mm = lessons(4000, rng)
        known = features(readings_kpa)
        self.force = fit(known, force_n)
        self.stiffness = fit(known, stiffness_n_per_mm)

    def force_n(self, readings_kpa: Array) -> float:
        return max(float((features(readings_kpa[None]) @ self.force)[0]), 0.0)

    def stiffness_n_per_mm(self, readings_kpa: Array) -> float:
        return float(np.clip((features(readings_kpa[None]) @ self.stiffness)[0], 0.05, 2.0))


def fit(known: Array, wanted: Array) -> Array:
    """Least squares of the relative error, with a light pull to zero."""
    weight = 1.0 / (0.05 + wanted)
    rows = known * weight[:, None]
    square = rows.T @ rows + 1e-3 * np.eye(known.shape[1])
    return np.linalg.solve(square, rows.T @ (wanted * weight)).astype(float)


def lessons(n: int, rng: np.random.Generator) -> tuple[Array, Array, Array]:
    """Sensors that are pressed by boxes, balls and lying cylinders at random, and sheared a little."""
    sensor = Sensor.phystac()
    top_mm = sensor.bounds_mm[1, 2]
    shapes, turns, origins_mm = [], [], []
    for number in range(90):
        radius_mm = rng.uniform(10.0, 26.0)
        if number % 3 == 0:
            shapes.append(Shape.box((rng.uniform(8.0, 18.0), rng.uniform(40.0, 64.0), 20.0), 0.0))
            turns.append((0.0, 0.0, 0.0, 1.0))
            origins_mm.append((0.0, 0.0))
        elif number % 3 == 1:
            shapes.append(Shape.sphere(radius_mm))
            turns.append((0.0, 0.0, 0.0, 1.0))
            origins_mm.append((0.0, 0.0))
        else:
            shapes.append(Shape.cylinder(radius_mm, 60.0, 0.0))
            turns.append((-np.sqrt(0.5), 0.0, 0.0, np.sqrt(0.5)))
            origins_mm.append((-30.0, radius_mm))
    shape = rng.integers(len(shapes), size=n)
    depth_mm = 0.1 + 2.5 * rng.random(n) ** 2
    poses = np.zeros((n, 7))
    poses[:, 3:] = np.array(turns)[shape]
    poses[:, 0] = rng.uniform(-4.0, 4.0, n)
    poses[:, 1] = rng.uniform(-2.0, 2.0, n) + np.array(origins_mm)[shape, 0]
    poses[:, 2] = top_mm - depth_mm + np.array(origins_mm)[shape, 1]
    coupling = Coupling(sensor, friction=FRICTION)
    sensors = SensorBatch(FastGel.phystac(), [Body(shape) for shape in shapes], n, coupling=coupling)
    _, pressed = sensors.step(1.0, poses, shape)
    poses[:, 1] -= 0.03
    _, nudged = sensors.step(1.0, poses, shape)
    stiffness_n_per_mm = (pressed[:, 1] - nudged[:, 1]).astype(float) / 0.03
    poses[:, 1] -= rng.uniform(0.0, 0.6, n) * np.sqrt(depth_mm)
    readings_kpa, sheared = sensors.step(1.0, poses, shape)
    touching = sheared[:, 2] < -0.05
    return readings_kpa[touching].astype(float), -sheared[touching, 2].astype(float), stiffness_n_per_mm[touching]


# --- the bench ---


class Gripper:
    """Two fingers on a wrist that lifts them."""

    def __init__(self, thing: Thing, seed: int) -> None:
        self.model = scene(thing)
        self.data = mujoco.MjData(self.model)
        self.touch = TouchSensors(self.model, ["left", "right"], imperfection=SENSOR, friction=FRICTION, seed=seed)
        gap_m = APART_M - 1e-3 * float(Sensor.phystac().bounds_mm[1, 2]) - thing.half_m
        self.closed_mm, self.risen_mm = 1e3 * gap_m - 1.0, 0.0
        self.most_n = 0.0
        for finger in ("left", "right"):
            self.data.joint(finger).qpos[0] = 1e-3 * self.closed_mm
        self.step(0.1)
        self.start_m = self.height_m

    def step(self, seconds: float) -> Array:
        """Goes on for a while; returns the mean of each sensor's last readings, kPa, `[2, 8]`."""
        readings_kpa = []
        for number in range(round(seconds / self.model.opt.timestep)):
            mujoco.mj_step1(self.model, self.data)
            self.touch.update(self.data)
            self.data.ctrl[:] = 1e-3 * np.array([self.closed_mm, self.closed_mm, self.risen_mm])
            mujoco.mj_step2(self.model, self.data)
            if number % 18 == 17:
                readings_kpa.append(self.touch.readings_kpa[0].astype(float))
                self.most_n = max(self.most_n, self.true_n)
        mean: Array = np.mean(readings_kpa[-FRAMES:], axis=0)
        return mean

    def lift(self) -> None:
        for _ in range(100):
            self.risen_mm += LIFT_MM / 100
            self.step(0.02)

    @property
    def height_m(self) -> float:
        return float(self.data.body("thing").xpos[2])

    @property
    def true_n(self) -> float:
        """The mean force of the fingers, which only the judge knows, N."""
        return float(-self.touch.wrench[0, :, 2].mean())

    @property
    def is_lifted(self) -> bool:
        return self.height_m - self.start_m > 0.9e-3 * LIFT_MM


def scene(thing: Thing) -> mujoco.MjModel:
    spec = mujoco.MjSpec.from_string(f"""
        <mujoco>
          <option timestep="0.001" integrator="implicitfast"/>
          <visual><global offwidth="800" offheight="600"/></visual>
          <worldbody>
            <light pos="0 -0.3 0.5"/>
            <geom type="plane" size="0.3 0.3 0.1"/>
            <body name="thing" pos="0 0 {thing.half_height_m + 1e-4}"><freejoint/><geom {thing.geom} mass="{thing.mass_kg}" rgba="0.9 0.6 0.3 1"/></body>
            <body name="wrist" pos="0 0 {thing.half_height_m}">
              <joint name="lift" type="slide" axis="0 0 1" damping="50"/>
              <geom type="box" size="0.08 0.012 0.005" pos="0 0 0.08" contype="0" conaffinity="0" mass="0.5"/>
              <body name="left" pos="{-APART_M} 0 0">
                <joint name="left" type="slide" axis="1 0 0" damping="20"/>
                <geom type="box" size="0.003 0.018 0.01" pos="-0.003 0 0" contype="0" conaffinity="0" mass="0.1"/>
              </body>
              <body name="right" pos="{APART_M} 0 0">
                <joint name="right" type="slide" axis="-1 0 0" damping="20"/>
                <geom type="box" size="0.003 0.018 0.01" pos="0.003 0 0" contype="0" conaffinity="0" mass="0.1"/>
              </body>
            </body>
          </worldbody>
          <actuator>
            <position joint="left" kp="4000"/><position joint="right" kp="4000"/><position joint="lift" kp="20000"/>
          </actuator>
        </mujoco>""")
    half = 0.5  # of a quaternion: the gels face each other, their x along the fingers' width, their y up
    add_sensor(spec, Sensor.phystac(), body="left", name="left", quaternion=(half, half, half, half))
    add_sensor(spec, Sensor.phystac(), body="right", name="right", quaternion=(half, -half, -half, half))
    return spec.compile()


# --- the policies ---


def grip(gripper: Gripper, meaning: Meaning, wanted_n: float) -> Array:
    """Closes or opens the fingers until they feel this force; returns what they read."""
    readings_kpa = gripper.step(0.25)
    for _ in range(30):
        force_n = np.mean([meaning.force_n(finger) for finger in readings_kpa])
        if abs(force_n / wanted_n - 1.0) < 0.04:
            break
        stiffness_n_per_mm = 0.3 + 1.5 * force_n
        gripper.closed_mm += float(np.clip(0.7 * (wanted_n - force_n) / stiffness_n_per_mm, -0.2, 0.2))
        readings_kpa = gripper.step(0.25)
    return readings_kpa


def parting_kpa(readings_kpa: Array) -> float:
    """How much more the lower row reads than the upper one, mean of both fingers, kPa."""
    return float((readings_kpa[:, :4] - readings_kpa[:, 4:]).sum(1).mean())


def lift_by_touch(gripper: Gripper, meaning: Meaning) -> None:
    while gripper.step(0.04).max(axis=1).min() < 0.15:
        gripper.closed_mm += 0.03
    readings_kpa = grip(gripper, meaning, FIRST_N)
    parts: list[float] = []  # of what the parting would be if the object stood, in each step
    carried_n, steepest_kpa_per_n = 0.0, 0.0
    while gripper.risen_mm < LIFT_MM and not (len(parts) > 3 and np.mean(parts[-3:]) < 0.35):
        before_kpa = parting_kpa(readings_kpa)
        gripper.risen_mm += RISE_MM
        readings_kpa = gripper.step(0.3)
        sheared_n = RISE_MM * float(np.mean([meaning.stiffness_n_per_mm(finger) for finger in readings_kpa]))
        kpa_per_n = (parting_kpa(readings_kpa) - before_kpa) / sheared_n
        steepest_kpa_per_n = max(steepest_kpa_per_n, kpa_per_n if len(parts) < 2 else 0.0)
        if DEBUG: print('  est N %.3f true %.3f | k %.3f sheared %.3f true T %.3f z %.3f A %.3f'%(np.mean([meaning.force_n(f) for f in readings_kpa]),gripper.true_n, sheared_n/RISE_MM, sheared_n, -gripper.touch.wrench[0,:,1].mean(), 1e3*(gripper.height_m-gripper.start_m), parting_kpa(readings_kpa)))
        parts.append(float(np.clip(kpa_per_n / steepest_kpa_per_n, 0.0, 1.0)))
        carried_n += parts[-1] * sheared_n
        wanted_n = max(FIRST_N, MARGIN * (carried_n + 0.5 * sheared_n) / FRICTION)
        if wanted_n > 1.05 * np.mean([meaning.force_n(finger) for finger in readings_kpa]):
            readings_kpa = grip(gripper, meaning, wanted_n)
    if DEBUG: print(np.round(parts,2), 'carried',carried_n, 'W/2', gripper.model.body('thing').mass[0]*9.81/2, 'N',gripper.true_n)
    grip(gripper, meaning, max(FIRST_N, MARGIN * carried_n / FRICTION))
    gripper.lift()


def lift_without_touch(gripper: Gripper) -> None:
    while gripper.true_n < FIXED_N:
        gripper.closed_mm += 0.02
        gripper.step(0.04)
    gripper.lift()
DEBUG=True
if __name__=="__main__":
    import time,sys
    meaning=Meaning(1)
    rng=np.random.default_rng(1)
    for n in range(9):
        thing=draw(n,rng); t=time.time()
        g=Gripper(thing,n); lift_by_touch(g,meaning)
        print(thing.kind, round(1e3*thing.mass_kg),'g lifted',g.is_lifted,'ratio most',g.most_n/thing.needed_n,'end',g.true_n/thing.needed_n, 's',time.time()-t, 'sim',g.data.time,flush=True)
