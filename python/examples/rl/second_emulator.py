"""Evaluates policies that hold forces on the emulated bench: with another gel, computed by finite
elements, and a sensor whose variation was in no training.

twintac record --lab default --at-once --protocol protocols/hold-force.toml --out runs/hold-force
python python/examples/rl/train.py --task HoldForce --seed 1 --out runs/rl
python python/examples/rl/train.py --task HoldForce --seed 1 --perfect --out runs/rl
python python/examples/rl/second_emulator.py --policies runs/rl --seeds 1 \\
    --recording runs/hold-force/recordings/presses.parquet

Each recorded press gives force and readings over depth, from its slow approach; as in the task, a
spring in series takes a part of the travel. Noise and resolution of readings are those of the
emulated bench. As on any test setup, readings are first divided by the sensor's common gain, in kPa
for each newton, which is measured with one press of the ball and a force sensor. Every policy is
evaluated twice: on the emulated sensor as it is, and on one with a dead taxel, another one in each
episode.
"""

import argparse
import csv
from pathlib import Path

import numpy as np
import numpy.typing as npt

from twintac import Body, FastGel, Pose, Recording, Shape
from twintac.gymnasium.policies import Policy, scripted_policy

Double = npt.NDArray[np.float64]

HEIGHT_MM = 8.5
DEPTHS_MM = np.arange(0.0, 3.101, 0.05)
N_STEPS, N_SAME = 220, 55
NOISE_KPA, QUANTUM_KPA = 0.015, 0.01  # emulators/default.toml, sensors/phystac.toml
EPISODES_A_PRESS = 32


class Bench:
    """The response of the emulated bench over depth, at the locations of a recording."""

    def __init__(self, recording: Recording) -> None:
        columns = recording.columns()
        press = np.asarray(columns["press_index"])
        readings = np.stack([np.asarray(columns[f"{taxel}_kpa"]) for taxel in recording.taxels], axis=1)
        depth_mm = HEIGHT_MM - np.asarray(columns["z_mm"])
        force_n = np.asarray(columns["force_n"])
        tables = []
        for number in np.unique(press):
            own = np.flatnonzero(press == number)
            inwards = own[: int(depth_mm[own].argmax()) + 1]
            tables.append(
                [np.interp(DEPTHS_MM, depth_mm[inwards], values[inwards]) for values in (force_n, *readings.T)]
            )
        table: Double = np.array(tables)
        table -= table[:, :, :1]  # force and readings are 0 at first touch
        self.force_n: Double = np.maximum.accumulate(np.maximum(table[:, 0], 0.0), axis=1)
        self.readings_kpa: Double = table[:, 1:]
        first = int(np.flatnonzero(press == 0)[0])
        place = (float(np.asarray(columns["x_mm"])[first]), float(np.asarray(columns["y_mm"])[first]))
        self.gain = self._gain(place)

    def _gain(self, place_mm: tuple[float, float]) -> float:
        """The ratio of this sensor's readings for each newton to those of perfect sensors, under
        the ball of the first press.
        """
        reader, ball = FastGel.phystac().reader(), Body(Shape.sphere(12.5))
        fast = []
        for depth_mm in np.arange(0.5, 3.5, 0.25):
            readings_kpa, wrench = reader.read([(ball, Pose((*place_mm, HEIGHT_MM - depth_mm)))])
            fast.append(readings_kpa.sum() / -wrench[2])
        there = self.force_n[0] > 0.5
        here = self.readings_kpa[0].sum(axis=0)[there] / self.force_n[0][there]
        return float(np.median(here) / np.median(fast))

    def episodes(self, random: np.random.Generator) -> tuple[Double, Double, npt.NDArray[np.int64]]:
        """Springs, N/mm, wanted forces, N, and dead taxels of the episodes of every press."""
        n = len(self.force_n) * EPISODES_A_PRESS
        stiffness = np.exp(random.uniform(0.0, np.log(10.0), n))
        return stiffness, random.uniform(0.3, 3.0, (n, N_STEPS // N_SAME)), random.integers(0, 8, n)

    def returns(self, policy: Policy, has_dead_taxel: bool, seed: int) -> Double:
        """Returns (sums of rewards, N) of episodes of every press, with the same springs, forces,
        noise and dead taxels for every policy.
        """
        random = np.random.default_rng(seed)
        press = np.repeat(np.arange(len(self.force_n)), EPISODES_A_PRESS)
        n, every = len(press), np.arange(len(press))
        stiffness, wanted_n, dead = self.episodes(random)
        shared_mm = DEPTHS_MM + self.force_n[press] / stiffness[:, None]
        travel_mm, before, total = np.full(n, -0.5), np.zeros((n, 8)), np.zeros(n)
        readings, speed = np.zeros((n, 8)), np.zeros(n)
        for step in range(N_STEPS + 1):
            now = wanted_n[:, min(step // N_SAME, wanted_n.shape[1] - 1)]
            known = np.stack([travel_mm / 5.0, speed, now / 3.0], axis=1)
            observed = np.concatenate([readings / 10.0, readings - before, known], axis=1).clip(-10.0, 10.0)
            if step == N_STEPS:
                return total
            actions = policy(observed.astype(np.float32))[:, 0].clip(-1.0, 1.0)
            moved_mm = np.clip(travel_mm + actions * 10.0 / 55.0, -1.0, 9.0) - travel_mm
            travel_mm, speed = travel_mm + moved_mm, moved_mm * 5.5
            depth_mm = np.array([np.interp(travel_mm[i], shared_mm[i], DEPTHS_MM) for i in every])
            at = np.minimum((depth_mm / DEPTHS_MM[1]).astype(np.int64), len(DEPTHS_MM) - 2)
            part = depth_mm / DEPTHS_MM[1] - at
            force_n = (1.0 - part) * self.force_n[press, at] + part * self.force_n[press, at + 1]
            clean = (1.0 - part)[:, None] * self.readings_kpa[press, :, at] + part[:, None] * self.readings_kpa[press, :, at + 1]
            noisy = clean + random.normal(0.0, NOISE_KPA, clean.shape)
            before, readings = readings, np.round(noisy / QUANTUM_KPA) * QUANTUM_KPA / self.gain
            if has_dead_taxel:
                readings[every, dead] = 0.0
            total -= np.abs(force_n - now)
        raise AssertionError("the last step returns")


def main() -> None:
    """Evaluates the scripted baseline and all trained policies."""
    from train import load, trained_policy  # needs Stable-Baselines3

    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--recording", type=Path, required=True)
    arguments.add_argument("--policies", type=Path, required=True, help="folder that train.py wrote")
    arguments.add_argument("--seeds", type=int, nargs="+", required=True, help="seeds that were trained with")
    arguments.add_argument("--out", type=Path, default=Path("runs/rl/second_emulator.csv"))
    given = arguments.parse_args()
    recording = Recording.load(given.recording)
    bench = Bench(recording)
    print(f"common gain {bench.gain:.2f}, {recording.provenance}")
    policies: dict[str, Policy] = {"script": scripted_policy("HoldForce")}
    for seed in given.seeds:
        policies[f"randomized, seed {seed}"] = trained_policy(*load(given.policies, "HoldForce", seed))
        policies[f"perfect sensors, seed {seed}"] = trained_policy(*load(given.policies, "HoldForce-perfect", seed))
    rows: list[list[str]] = []
    for sensor, has_dead_taxel in (("as it is", False), ("one taxel dead", True)):
        # Episodes of one press have the same location and shape, so only presses are independent.
        errors_n = {
            name: -bench.returns(policy, has_dead_taxel, seed=1).reshape(-1, EPISODES_A_PRESS).mean(axis=1) / N_STEPS
            for name, policy in policies.items()
        }
        gains_n = [
            errors_n[f"perfect sensors, seed {seed}"].mean() - errors_n[f"randomized, seed {seed}"].mean()
            for seed in given.seeds
        ]
        errors_n["gain from randomizing, over seeds"] = np.array(gains_n)
        for name, error_n in errors_n.items():
            deviation = error_n.std(ddof=1) / np.sqrt(len(error_n)) if len(error_n) > 1 else np.nan
            rows.append([sensor, name, f"{error_n.mean():.4f}", f"{deviation:.4f}", "N", recording.provenance])
            print(f"{sensor}, {name}: {error_n.mean():.3f} ± {deviation:.3f} N, {recording.provenance}")
    with given.out.open("w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["sensor", "policy", "mean_error", "standard_error", "unit", "provenance"])
        table.writerows(rows)


if __name__ == "__main__":
    main()
