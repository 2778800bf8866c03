"""Two fingers with a PhysTac each lift objects of unknown weight and shape, by touch alone.

    python grasp_by_touch.py [--objects 20] [--seed 1] [--plot grasps.png] [--json]

What a finger knows is what its eight barometers read, and how far it has been moved. It presses lightly and is raised in small steps while the object still
stands. As long as the object does, the gel is sheared by as much as the finger rises, and the readings of the upper and the lower row part. Where they stop parting,
the object hangs: by then the gel carries its weight, and the fingers hold it with what friction needs and a fifth more, as far as they know. Beside it
stands a gripper without touch, which takes every object with one force.
"""

import argparse
import json
from dataclasses import asdict, dataclass

import mujoco
import numpy as np
import numpy.typing as npt

from twintac import Body, Coupling, FastGel, Imperfection, Sensor, SensorBatch, Shape
from twintac.mujoco import TouchSensors, add_sensor

Array = npt.NDArray[np.float64]

FRICTION = 0.8
GRAVITY_M_PER_S2 = 9.81
FIRST_N = 0.17  # a light touch
MARGIN = 1.35  # of what friction needs
FIXED_N = 3.0  # of the gripper without touch: lifts the heaviest
FIRST_RISE_MM = 0.03  # of a step
RISE_N, RISE_PART = 0.025, 0.12  # that a step should load the gel with, and of what it carries already
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
    """The force on a finger, N, from what its sensor reads; and how stiff its gel is against shear, N/mm, from that and from how its rows part, as part of all readings for each
    mm: they part most under a ball, which moves away from one row."""

    def __init__(self, seed: int) -> None:
        rng = np.random.default_rng(seed)
        readings_kpa, force_n, parting_per_mm, stiffness_n_per_mm = lessons(6000, rng)
        self.force = fit(features(readings_kpa), force_n)
        self.stiffness = fit(with_parting(readings_kpa, parting_per_mm), stiffness_n_per_mm)

    def force_n(self, readings_kpa: Array) -> float:
        return max(float((features(readings_kpa[None]) @ self.force)[0]), 0.0)

    def stiffness_n_per_mm(self, readings_kpa: Array, parting_per_mm: float) -> float:
        known = with_parting(readings_kpa[None], np.array([parting_per_mm]))
        return float(np.clip((known @ self.stiffness)[0], 0.05, 2.0))


def with_parting(readings_kpa: Array, parting_per_mm: Array) -> Array:
    known, part = features(readings_kpa), np.clip(parting_per_mm, 0.0, 1.0)[:, None]
    return np.concatenate([known, part * known, part**2 * known[:, :8]], axis=1)


def fit(known: Array, wanted: Array) -> Array:
    """Least squares of the relative error, with a light pull to zero."""
    weight = 1.0 / (0.05 + wanted)
    rows = known * weight[:, None]
    square = rows.T @ rows + 1e-3 * np.eye(known.shape[1])
    return np.linalg.solve(square, rows.T @ (wanted * weight)).astype(float)


def lessons(n: int, rng: np.random.Generator) -> tuple[Array, Array, Array, Array]:
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
    pressed_kpa, pressed = sensors.step(1.0, poses, shape)
    poses[:, 1] -= 0.05
    nudged_kpa, nudged = sensors.step(1.0, poses, shape)
    stiffness_n_per_mm = (pressed[:, 1] - nudged[:, 1]).astype(float) / 0.05
    parted_kpa = parting_kpa((nudged_kpa - pressed_kpa).astype(float))
    parting_per_mm = parted_kpa / np.maximum(pressed_kpa.sum(1), 0.2) / 0.05
    poses[:, 1] -= rng.uniform(0.0, 0.6, n) * np.sqrt(depth_mm)
    readings_kpa, sheared = sensors.step(1.0, poses, shape)
    touching = sheared[:, 2] < -0.05
    force_n = -sheared[touching, 2].astype(float)
    return readings_kpa[touching].astype(float), force_n, parting_per_mm[touching], stiffness_n_per_mm[touching]


def parting_kpa(readings_kpa: Array) -> Array:
    """How much more the lower row of each sensor reads than the upper one, kPa."""
    parting: Array = (readings_kpa[:, :4] - readings_kpa[:, 4:]).sum(1)
    return parting


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

    def step(self, seconds: float, rise_mm: float = 0.0) -> Array:
        """Goes on for a while, and rises evenly in the first half of it; returns the mean of each sensor's last readings, kPa, `[2, 8]`."""
        readings_kpa = []
        n_steps = round(seconds / self.model.opt.timestep)
        for number in range(n_steps):
            if 2 * number < n_steps:
                self.risen_mm += 2.0 * rise_mm / n_steps
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
        self.step(4.0, LIFT_MM)

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
            <geom type="plane" size="0.3 0.3 0.1" solref="0.004 1" solimp="0.99 0.999 0.0001"/>
            <body name="thing" pos="0 0 {thing.half_height_m + 1e-4}"><freejoint/><geom {thing.geom} mass="{thing.mass_kg}" rgba="0.9 0.6 0.3 1"/></body>
            <body name="wrist" pos="0 0 {thing.half_height_m}">
              <joint name="lift" type="slide" axis="0 0 1" damping="400"/>
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
            <position joint="left" kp="4000"/><position joint="right" kp="4000"/><position joint="lift" kp="100000"/>
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


def lift_by_touch(gripper: Gripper, meaning: Meaning) -> None:
    while gripper.step(0.04).max(axis=1).min() < 0.15:
        gripper.closed_mm += 0.03
    readings_kpa = grip(gripper, meaning, FIRST_N)
    parting: list[float] = []  # in each step, kPa/mm
    carried_n, rise_mm = 0.0, FIRST_RISE_MM
    while gripper.risen_mm < LIFT_MM and not hangs(parting):
        before_kpa = readings_kpa
        readings_kpa = gripper.step(0.4, rise_mm)
        parting.append(float((parting_kpa(readings_kpa) - parting_kpa(before_kpa)).mean()) / rise_mm)
        usual = standing(parting)
        per_mm = usual / readings_kpa.sum(1).mean()
        stiffness_n_per_mm = np.mean([meaning.stiffness_n_per_mm(finger, per_mm) for finger in readings_kpa])
        sheared_n = rise_mm * float(stiffness_n_per_mm)
        carried_n += float(np.clip(parting[-1] / (0.9 * usual), 0.0, 1.0)) * sheared_n
        next_n = RISE_N + RISE_PART * carried_n
        rise_mm = next_n / float(stiffness_n_per_mm)
        wanted_n = max(FIRST_N, MARGIN * (carried_n + 0.7 * next_n) / FRICTION)
        if wanted_n > 1.05 * np.mean([meaning.force_n(finger) for finger in readings_kpa]):
            readings_kpa = grip(gripper, meaning, wanted_n)
    grip(gripper, meaning, max(FIRST_N, MARGIN * carried_n / FRICTION))
    gripper.lift()


def standing(parting: list[float]) -> float:
    """How the rows part in a step of an object that stands: the median of its last five steps, but for those that may be of one that hangs."""
    usual = max(float(np.median(parting[:3])), 0.1)
    for number in range(3, len(parting)):
        stood = [step for step in parting[max(number - 4, 0) : number + 1] if step > 0.5 * usual]
        usual = float(np.median(stood)) if stood else usual
    return usual


def hangs(parting: list[float]) -> bool:
    """Whether the rows have stopped parting."""
    return len(parting) > 3 and float(np.mean(parting[-2:])) < 0.35 * standing(parting)


def lift_without_touch(gripper: Gripper) -> None:
    while gripper.true_n < FIXED_N:
        gripper.closed_mm += 0.02
        gripper.step(0.04)
    gripper.lift()


# --- what is asked on the command line ---


@dataclass(frozen=True)
class Grasp:
    """What came of one object: whether each policy lifted it, and the force with which it held it, and at most pressed it, N."""

    kind: str
    mass_g: float
    needed_n: float
    lifted: bool
    held_n: float
    most_n: float
    lifted_without_touch: bool
    held_without_touch_n: float


def grasp(thing: Thing, meaning: Meaning, seed: int) -> Grasp:
    touching, blind = Gripper(thing, seed), Gripper(thing, seed)
    lift_by_touch(touching, meaning)
    lift_without_touch(blind)
    return Grasp(
        kind=thing.kind,
        mass_g=round(1e3 * thing.mass_kg, 1),
        needed_n=round(thing.needed_n, 3),
        lifted=touching.is_lifted,
        held_n=round(touching.true_n, 3),
        most_n=round(touching.most_n, 3),
        lifted_without_touch=blind.is_lifted,
        held_without_touch_n=round(blind.true_n, 3),
    )


def plot(grasps: list[Grasp], path: str) -> None:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7, 4.5))
    axes = figure.add_subplot()
    needed_n = np.geomspace(0.1, 2.0, 50)
    axes.plot(needed_n, needed_n, "k-", label="what friction needs")
    axes.plot(needed_n, 2.0 * needed_n, "k--", label="twice as much")
    for kind, marker in (("box", "s"), ("ball", "o"), ("cylinder", "^")):
        own = [grasp for grasp in grasps if grasp.kind == kind and grasp.lifted]
        axes.plot([grasp.needed_n for grasp in own], [grasp.held_n for grasp in own], marker, label=f"{kind}, by touch")
    lost = [grasp for grasp in grasps if not grasp.lifted]
    axes.plot([grasp.needed_n for grasp in lost], [grasp.held_n for grasp in lost], "rx", label="dropped, by touch")
    axes.plot([grasp.needed_n for grasp in grasps], [grasp.held_without_touch_n for grasp in grasps], "+", color="gray", label="one force for all")
    axes.set(xscale="log", yscale="log", xlabel="force of each finger that friction needs, N", ylabel="force of each finger, N")
    axes.set_title("Objects that hang, simulated")
    axes.legend()
    figure.tight_layout()
    figure.savefig(path, dpi=130)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--objects", type=int, default=20, help="how many to lift (default: 20)")
    parser.add_argument("--seed", type=int, default=1, help="of all that is random (default: 1)")
    parser.add_argument("--plot", metavar="FILE", help="draw the forces into a picture; needs matplotlib")
    parser.add_argument("--json", action="store_true", help="print all as JSON")
    asked = parser.parse_args()
    meaning = Meaning(asked.seed)
    rng = np.random.default_rng(asked.seed)
    grasps = []
    for number in range(asked.objects):
        found = grasp(draw(number, rng), meaning, asked.seed + number)
        grasps.append(found)
        if not asked.json:
            end = "lifted" if found.lifted else "dropped"
            part, blind = found.held_n / found.needed_n, found.held_without_touch_n / found.needed_n
            print(f"{found.kind:<9}{found.mass_g:6.1f} g: {end}, held with {part:.2f} of the force needed; without touch {blind:5.2f}", flush=True)
    if asked.plot:
        plot(grasps, asked.plot)
    held = [found.held_n / found.needed_n for found in grasps]
    if asked.json:
        print(json.dumps({"provenance": "simulated", "seed": asked.seed, "grasps": [asdict(found) for found in grasps]}, indent=1))
    else:
        lifted = sum(found.lifted for found in grasps)
        print(f"{lifted} of {len(grasps)} lifted by touch, with {min(held):.2f} to {max(held):.2f} of the force needed, simulated")


if __name__ == "__main__":
    main()
