"""Measures how many environment steps are made in a second: writes docs/benchmarks/tasks.json and
tasks.md.

pip install './python[rl]' 'mujoco>=4'
python python/benchmarks/tasks.py
"""

import json
import os
import platform
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np

import twintac.gymnasium
from twintac.gymnasium.policies import Policy, random_policy, scripted_policy

ROOT = Path(__file__).parents[2]
COMMAND = "python python/benchmarks/tasks.py"
KINDS = ("HoldForce", "FollowEdge", "ExploreShape", "InHandTurn")
N_ENVIRONMENTS = 1024
N_HANDS = 64  # environments of InHandTurn, whose bodies MuJoCo moves
N_THREADS = 2
N_WARM_UP, N_STEPS = 60, 300
N_SINGLE, N_SINGLE_HAND = 3000, 300
FEELS_KPA = 0.1


def spread(rates: list[float]) -> dict[str, float]:
    """The median, and the range of the middle 80 %."""
    low, middle, high = np.percentile(rates, [10, 50, 90])
    return {"median": float(middle), "lowest_tenth": float(low), "highest_tenth": float(high)}


def policy_of(kind: str) -> Policy:
    """A policy that keeps the sensors in contact: the scripted baseline, or the random baseline
    where the scripted one takes longer than the environments.
    """
    return random_policy(kind) if kind == "ExploreShape" else scripted_policy(kind)


class Timed:
    """A vector environment whose steps are timed one by one."""

    def __init__(self, env: gym.vector.VectorEnv[Any, Any, Any], act: Callable[[Any], Any]) -> None:
        self.env, self.act = env, act
        self.observed, _ = env.reset(seed=1)
        self.rates: list[float] = []
        self.touched: list[float] = []

    def step(self, counts: bool) -> None:
        """Makes one step; `counts` says whether its rate counts."""
        actions = self.act(self.observed)
        started = time.perf_counter()
        self.observed, *_ = self.env.step(actions)
        if counts:
            self.rates.append(self.env.num_envs / (time.perf_counter() - started))
            self.touched.append(float((self.observed[:, :8].max(axis=1) > 0.1 * FEELS_KPA).mean()))


def together() -> dict[str, dict[str, Any]]:
    """Many environments in one call. They are measured in turns, so that other load of the machine
    affects all alike.
    """
    timed = {}
    for kind in KINDS:
        for name, variation in ((kind, None), (f"{kind}, perfect sensors", twintac.SensorVariation())):
            n = N_HANDS if kind == "InHandTurn" else N_ENVIRONMENTS
            env = gym.make_vec(f"TwinTac/{kind}-v0", num_envs=n, variation=variation, n_threads=N_THREADS)
            timed[name] = Timed(env, policy_of(kind))
    cart = gym.make_vec("CartPole-v1", num_envs=N_ENVIRONMENTS)
    timed["CartPole-v1"] = Timed(cart, lambda _: np.zeros(N_ENVIRONMENTS, np.int64))
    for step in range(N_WARM_UP + N_STEPS):
        for one in timed.values():
            one.step(step >= N_WARM_UP)
    found: dict[str, dict[str, Any]] = {}
    for name, one in timed.items():
        found[name] = {"steps_per_s": spread(one.rates)}
        if name != "CartPole-v1":
            found[name]["touched"] = float(np.mean(one.touched))
    return found


def alone(kind: str) -> dict[str, float]:
    """The rate of one environment."""
    env = gym.make(f"TwinTac/{kind}-v0")
    act = policy_of(kind)
    observed, _ = env.reset(seed=1)
    rates = []
    for _ in range(N_SINGLE_HAND if kind == "InHandTurn" else N_SINGLE):
        action = act(observed[None])[0]
        started = time.perf_counter()
        observed, _, terminated, truncated, _ = env.step(action)
        rates.append(1.0 / (time.perf_counter() - started))
        if terminated or truncated:
            observed, _ = env.reset()
    return spread(rates)


def touch_grid() -> dict[str, Any]:
    """MuJoCo's touch sensor with eight cells, with as many scenes and threads."""
    script = ROOT / "crates/twin/sensors/examples/rate/touch_grid.py"
    asked = {"n_scenes": N_ENVIRONMENTS, "n_threads": N_THREADS, "n_steps": N_STEPS, "n_warm_up": N_WARM_UP}
    ran = subprocess.run([sys.executable, script, json.dumps(asked)], capture_output=True, text=True, check=False)
    if ran.returncode != 0:
        return {"note": f"not measured: {ran.stderr.strip().splitlines()[-1]}"}
    found: dict[str, Any] = json.loads(ran.stdout)
    rates = [N_ENVIRONMENTS / seconds for seconds in found.pop("seconds")]
    return {**found, "steps_per_s": spread(rates)}


def page(results: dict[str, Any]) -> str:
    """The results as a Markdown page."""

    def row(name: str, rate: dict[str, float], touched: float | None) -> str:
        inside = f"{rate['lowest_tenth']:,.0f} to {rate['highest_tenth']:,.0f}"
        return f"| {name} | {rate['median']:,.0f} | {inside} | {'' if touched is None else f'{100 * touched:.0f} %'} |"

    machine = results["machine"]
    rows = [row(name, one["steps_per_s"], one.get("touched")) for name, one in results["together"].items()]
    grid = results["touch_grid"]
    if "steps_per_s" in grid:
        rows.append(row(f"MuJoCo {grid['version']}, `touch_grid` of {grid['cells']} cells", grid["steps_per_s"], grid["touched"]))
    singles = [row(name, rate, None) for name, rate in results["alone"].items()]
    return "\n".join(
        [
            "# Environments stepped together",
            "",
            f"Made by `{COMMAND}` on {machine['processor']}, {machine['processors']} processors (simulated data). Load average at the end: {machine['load_average']:.1f} (what is above "
            f"{N_THREADS} was other work, and made all rates lower).",
            "",
            f"{N_ENVIRONMENTS} environments ({N_HANDS} of InHandTurn) are stepped in one call on {N_THREADS} threads from Python, and begin anew by themselves. Robots follow the scripted baseline of their task, those of ExploreShape the random one. All "
            f"take turns in one run; of {N_STEPS} calls each, the median counts, and 80 % lie within the range. *Touched* is the fraction of sensors that had read more than {FEELS_KPA} kPa, of ExploreShape in the episode's first press; an episode's first observation has no reading.",
            "",
            "| environment | steps a second | range | touched |",
            "|---|---:|---:|---:|",
            *rows,
            "",
            "A step of ExploreShape is a whole press of two frames; one of InHandTurn is 40 steps of MuJoCo with four sensors. CartPole-v1 is Gymnasium's own vector environment, a simple one without touch. MuJoCo's step also moves bodies; its sensor sums contact forces in cells, without a gel.",
            *([grid["note"]] if "note" in grid else []),
            "",
            "One environment by itself, `gym.make`:",
            "",
            "| environment | steps a second | range | |",
            "|---|---:|---:|---|",
            *singles,
            "",
        ]
    )


def main() -> None:
    """Measures everything, and writes the results."""
    grid = touch_grid()
    if "n_cells" in grid:
        grid["cells"] = grid.pop("n_cells")
    cpu = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")), platform.processor())
    results = {
        "command": COMMAND,
        "provenance": "simulated",
        "environments": N_ENVIRONMENTS,
        "hands": N_HANDS,
        "threads": N_THREADS,
        "together": together(),
        "alone": {kind: alone(kind) for kind in KINDS},
        "touch_grid": grid,
        "machine": {"processor": cpu, "processors": os.cpu_count(), "load_average": os.getloadavg()[0]},
    }
    folder = ROOT / "docs/benchmarks"
    (folder / "tasks.json").write_text(json.dumps(results, indent=2) + "\n")
    (folder / "tasks.md").write_text(page(results))
    print(page(results))


if __name__ == "__main__":
    main()
