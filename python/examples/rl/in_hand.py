"""Trains a hand to turn an object on its palm by touch, and compares it with hands that feel less.

    python in_hand.py train --touch taxels [--seed 1] [--steps 2000000] [--out runs/in-hand]
    python in_hand.py test [--runs runs/in-hand] [--out runs/in-hand]
    python in_hand.py film --run runs/in-hand/taxels-1 --out turn.gif

Needs stable-baselines3; the film needs OpenGL, as `MUJOCO_GL` names it. `train` takes about three
hours on two cores. If it is stopped, the same command continues from the last checkpoint.
"""

import argparse
import csv
import json
import time
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
import numpy.typing as npt
import torch  # type: ignore[import-not-found, unused-ignore]
from stable_baselines3 import PPO  # type: ignore[import-not-found, unused-ignore]
from stable_baselines3.common.callbacks import BaseCallback  # type: ignore[import-not-found, unused-ignore]
from stable_baselines3.common.vec_env import VecNormalize  # type: ignore[import-not-found, unused-ignore]

import twintac.gymnasium  # registers the tasks
from twintac.gymnasium.policies import Policy, random_policy, scripted_policy
from twintac.gymnasium.sb3 import TouchVecEnv

KIND = "InHandTurn"
TOUCHES = ("taxels", "forces", "none")
N_ENVS, N_STEPS, GAMMA = 128, 60, 0.97
SETTINGS: dict[str, Any] = {
    "n_steps": N_STEPS,
    "gamma": GAMMA,
    "gae_lambda": 0.95,
    "batch_size": N_ENVS * N_STEPS // 8,
    "n_epochs": 8,
    "policy_kwargs": {"net_arch": [256, 128], "log_std_init": -0.7},
}
# Seeds of the episodes that no training has: five groups for the test, and one for the curve.
TEST_SEEDS, N_TEST = [10**9 + 10**6 * group for group in range(5)], 256
CURVE_SEED, N_CURVE = 2 * 10**9, 128
CHECKPOINT_STEPS = 20 * N_ENVS * N_STEPS
NEAR_DEG = 5.0


def play(policy: Policy, touch: str, seed: int, n: int) -> dict[str, npt.NDArray[Any]]:
    """Plays one episode in each of `n` worlds, and returns the returns, the errors of the angle at
    the end, whether the object fell, and whether it is a box.
    """
    env = gym.make_vec(f"TwinTac/{KIND}-v0", num_envs=n, touch=touch, autoreset_mode="Disabled")
    observed, infos = env.reset(seed=seed)
    last = {name: infos[name].copy() for name in ("error_rad", "is_dropped", "is_box")}
    returns, is_going = np.zeros(n), np.ones(n, np.bool_)
    while is_going.any():
        observed, rewards, terminated, truncated, infos = env.step(policy(observed))
        returns += rewards * is_going
        for name, values in last.items():
            values[is_going] = infos[name][is_going]
        is_going &= ~(terminated | truncated)
    return {
        "return": returns,
        "error_deg": np.degrees(last["error_rad"]),
        "is_dropped": last["is_dropped"] > 0.0,
        "is_box": last["is_box"] > 0.0,
    }


def trained(folder: Path) -> Policy:
    """The policy of a folder, without randomness."""
    touch = folder.name.rsplit("-", 1)[0]
    scale = VecNormalize.load(str(folder / "scale.pkl"), TouchVecEnv(KIND, 1, touch=touch))
    model = PPO.load(folder / "policy.zip", device="cpu")

    def act(observed: npt.NDArray[np.float32]) -> npt.NDArray[np.float32]:
        return np.asarray(model.predict(scale.normalize_obs(observed), deterministic=True)[0], np.float32)

    return act


def kept(path: Path, text: str) -> None:
    """Writes a file completely or not at all."""
    partial = path.with_suffix(".partial")
    partial.write_text(text)
    partial.replace(path)


class Checkpoints(BaseCallback):  # type: ignore[misc, unused-ignore]
    """Keeps the policy and a row of the learning curve at regular intervals."""

    def __init__(self, folder: Path, touch: str, rows: list[dict[str, Any]], total: int) -> None:
        super().__init__()
        self.folder, self.touch, self.rows, self.total = folder, touch, rows, total
        self.before_s, self.started = rows[-1]["seconds"] if rows else 0.0, time.monotonic()

    def keep(self) -> None:
        """Evaluates the policy, and writes it with the curve."""
        scale = self.model.get_vec_normalize_env()

        def act(observed: npt.NDArray[np.float32]) -> npt.NDArray[np.float32]:
            return np.asarray(self.model.predict(scale.normalize_obs(observed), deterministic=True)[0], np.float32)

        found = play(act, self.touch, CURVE_SEED, N_CURVE)
        seconds = self.before_s + time.monotonic() - self.started
        is_near = (found["error_deg"] < NEAR_DEG) & ~found["is_dropped"]
        row = {"steps": self.num_timesteps, "seconds": round(seconds), "return": float(found["return"].mean()), "near": float(is_near.mean()), "dropped": float(found["is_dropped"].mean())}
        self.rows.append(row)
        for name, save in (("policy.zip", self.model.save), ("scale.pkl", scale.save)):
            partial = self.folder / f"partial-{name}"
            save(str(partial))
            partial.replace(self.folder / name)
        kept(self.folder / "curve.json", json.dumps({"provenance": "simulated", "touch": self.touch, "rows": self.rows}, indent=1))
        left_min = (self.total - row["steps"]) / max(row["steps"], 1) * seconds / 60.0
        print(f"{row['steps']:9,d} steps: return {row['return']:.2f}, {row['near']:.0%} within {NEAR_DEG:.0f} degrees, {row['dropped']:.0%} dropped, about {left_min:.0f} min left", flush=True)

    def _on_rollout_start(self) -> None:
        if self.num_timesteps >= (self.rows[-1]["steps"] if self.rows else 0) + CHECKPOINT_STEPS:
            self.keep()

    def _on_step(self) -> bool:
        return True


def train(touch: str, seed: int, total: int, out: Path) -> None:
    """Trains with proximal policy optimization (PPO)."""
    folder = out / f"{touch}-{seed}"
    folder.mkdir(parents=True, exist_ok=True)
    rows: list[dict[str, Any]] = []
    env = TouchVecEnv(KIND, N_ENVS, touch=touch, seed=1000 * seed)
    settings = SETTINGS | {"learning_rate": lambda left: 1e-3 * left + 3e-5}
    if (folder / "curve.json").exists():
        rows = json.loads((folder / "curve.json").read_text())["rows"]
        scaled = VecNormalize.load(str(folder / "scale.pkl"), env)
        # Episodes of the first part are not repeated.
        env.seed(1000 * seed + rows[-1]["steps"])
        model = PPO.load(folder / "policy.zip", env=scaled, device="cpu", custom_objects={"learning_rate": settings["learning_rate"], "lr_schedule": settings["learning_rate"]})
        print(f"continues after {rows[-1]['steps']:,d} steps", flush=True)
    else:
        scaled = VecNormalize(env, gamma=GAMMA)
        model = PPO("MlpPolicy", scaled, seed=seed, device="cpu", **settings)
    checkpoints = Checkpoints(folder, touch, rows, total)
    done = rows[-1]["steps"] if rows else 0
    if done < total:
        model.learn(total - done, callback=checkpoints, reset_num_timesteps=False)
        checkpoints.keep()


def summary(episodes: list[dict[str, npt.NDArray[Any]]]) -> dict[str, Any]:
    """Means over all episodes, with their standard errors."""
    every = {name: np.concatenate([found[name] for found in episodes]) for name in episodes[0]}
    is_near = (every["error_deg"] < NEAR_DEG) & ~every["is_dropped"]

    def mean(values: npt.NDArray[Any]) -> list[float]:
        return [round(float(values.mean()), 4), round(float(values.std(ddof=1) / np.sqrt(len(values))), 4)]

    return {
        "return": mean(every["return"]),
        "near": mean(is_near),
        "near_cylinders": mean(is_near[~every["is_box"]]),
        "near_boxes": mean(is_near[every["is_box"]]),
        "dropped": mean(every["is_dropped"]),
        "near_of_each_seed": [round(float(((found["error_deg"] < NEAR_DEG) & ~found["is_dropped"]).mean()), 4) for found in episodes],
        "episodes": len(is_near),
    }


def test(runs: Path, out: Path) -> None:
    """Evaluates all policies in the same episodes, and writes `in-hand.json` and `in-hand.csv`."""
    policies: dict[str, tuple[Policy, str]] = {"script": (scripted_policy(KIND), "none"), "chance": (random_policy(KIND), "none")}
    curves: list[dict[str, Any]] = []
    for touch in TOUCHES:
        for folder in sorted(runs.glob(f"{touch}-*")):
            policies[folder.name] = trained(folder), touch
            curves += [{"run": folder.name} | row for row in json.loads((folder / "curve.json").read_text())["rows"]]
    found = {}
    for name, (policy, touch) in policies.items():
        found[name] = summary([play(policy, touch, seed, N_TEST) for seed in TEST_SEEDS])
        print(f"{name}: return {found[name]['return'][0]:.2f}, {found[name]['near'][0]:.1%} within {NEAR_DEG:.0f} degrees, {found[name]['dropped'][0]:.1%} dropped, simulated", flush=True)
    out.mkdir(parents=True, exist_ok=True)
    kept(out / "in-hand.json", json.dumps({"provenance": "simulated", "policies": found}, indent=1) + "\n")
    with (out / "in-hand.csv").open("w", newline="") as file:
        table = csv.DictWriter(file, ["run", "steps", "seconds", "return", "near", "dropped"], lineterminator="\n")
        table.writeheader()
        table.writerows(curves)
    draw(out / "in-hand.png", curves, found)


def draw(path: Path, curves: list[dict[str, Any]], found: dict[str, Any]) -> None:
    """Plots the learning curves beside the baselines."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6, 3.6), layout="constrained")
    axes = figure.add_subplot(xlabel="environment steps, millions", ylabel=f"episodes within {NEAR_DEG:.0f} degrees, %", ylim=(0, 100))
    for run in dict.fromkeys(row["run"] for row in curves):
        own = [row for row in curves if row["run"] == run]
        axes.plot([1e-6 * row["steps"] for row in own], [100.0 * row["near"] for row in own], marker="o", markersize=3, label=run)
    for name, style in (("script", "--"), ("chance", ":")):
        axes.axhline(100.0 * found[name]["near"][0], color="gray", linestyle=style, label=name)
    axes.set_title("InHandTurn, episodes that no training has (simulated)", fontsize=10)
    axes.legend()
    axes.grid(alpha=0.3)
    figure.savefig(path, dpi=110)


def film(folder: Path, out: Path, seed: int) -> None:
    """Films episodes as an animated GIF."""
    from PIL import Image

    touch, policy = folder.name.rsplit("-", 1)[0], trained(folder)
    env = gym.make_vec(f"TwinTac/{KIND}-v0", num_envs=2, touch=touch, autoreset_mode="Disabled", render_mode="rgb_array")
    observed, _ = env.reset(seed=seed)
    frames = []
    for _ in range(N_STEPS):
        observed, *_ = env.step(policy(observed))
        frames.append(Image.fromarray(np.concatenate(env.render() or (), axis=1)).quantize(64))
    frames[0].save(out, save_all=True, append_images=frames[1:], duration=80, loop=0, optimize=True)


def main() -> None:
    """Trains, tests or films."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    one = commands.add_parser("train", help="train a policy")
    one.add_argument("--touch", choices=TOUCHES, default="taxels", help="what the fingertips measure (default: taxels)")
    one.add_argument("--seed", type=int, default=1, help="of all that is random (default: 1)")
    one.add_argument("--steps", type=int, default=2_000_000, help="environment steps (default: two million)")
    one.add_argument("--out", type=Path, default=Path("runs/in-hand"), help="folder of the runs (default: runs/in-hand)")
    other = commands.add_parser("test", help="compare all trained policies with a script and with chance")
    other.add_argument("--runs", type=Path, default=Path("runs/in-hand"), help="folder of the runs (default: runs/in-hand)")
    other.add_argument("--out", type=Path, default=Path("runs/in-hand"), help="folder of the results (default: runs/in-hand)")
    filmed = commands.add_parser("film", help="film a trained policy")
    filmed.add_argument("--run", type=Path, required=True, help="folder of the run")
    filmed.add_argument("--out", type=Path, default=Path("turn.gif"), help="file (default: turn.gif)")
    filmed.add_argument("--seed", type=int, default=TEST_SEEDS[0], help="of the first of two episodes")
    asked = parser.parse_args()
    torch.set_num_threads(1)
    if asked.command == "train":
        train(asked.touch, asked.seed, asked.steps, asked.out)
    elif asked.command == "test":
        test(asked.runs, asked.out)
    else:
        film(asked.run, asked.out, asked.seed)


if __name__ == "__main__":
    main()
