"""Trains a policy with Stable-Baselines3, and compares it with the scripted and the random
baseline.

pip install './python[rl]' stable-baselines3 matplotlib
python python/examples/rl/train.py --task HoldForce --seed 1 --out runs/rl

It writes `HoldForce-1.csv` (the learning curve), `HoldForce-1.png`, `HoldForce-1.zip` (the policy)
and `HoldForce-1.pkl` (the normalization of observations) into the folder.
"""

import argparse
import csv
import time
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import torch  # type: ignore[import-not-found, unused-ignore]
from stable_baselines3 import PPO  # type: ignore[import-not-found, unused-ignore]
from stable_baselines3.common.callbacks import BaseCallback  # type: ignore[import-not-found, unused-ignore]
from stable_baselines3.common.vec_env import VecNormalize  # type: ignore[import-not-found, unused-ignore]

from twintac import SensorVariation, Tasks
from twintac.gymnasium.policies import Policy, random_policy, returns, scripted_policy
from twintac.gymnasium.sb3 import TouchVecEnv

N_JUDGED = 512
FIRST_JUDGED = 10**9
UNIT = {"HoldForce": "N of all frames", "FollowEdge": "mm of edge", "ExploreShape": "nats"}

SETTINGS: dict[str, dict[str, Any]] = {
    "HoldForce": {"n_envs": 128, "n_steps": 110, "gamma": 0.9, "gae_lambda": 0.9, "steps": 800_000},
    "FollowEdge": {"n_envs": 128, "n_steps": 110, "gamma": 0.97, "gae_lambda": 0.95, "steps": 3_000_000},
    "ExploreShape": {"n_envs": 512, "n_steps": 20, "gamma": 0.8, "gae_lambda": 0.9, "steps": 4_000_000},
}


def evaluate(kind: str, policy: Policy) -> npt.NDArray[np.float64]:
    """Returns of episodes that are in no training, on sensors with the default variation; the same
    episodes for every policy.
    """
    tasks = Tasks(kind, N_JUDGED, autoreset="Disabled")
    tasks.seed([FIRST_JUDGED + number for number in range(N_JUDGED)])
    return returns(policy, tasks)


def mean_and_error(returns: npt.NDArray[np.float64]) -> tuple[float, float]:
    """The mean, and its standard error."""
    return float(returns.mean()), float(returns.std(ddof=1) / np.sqrt(len(returns)))


def load(folder: Path, name: str, seed: int) -> tuple[PPO, VecNormalize]:
    """A trained policy, and the normalization of its observations."""
    kind = name.split("-")[0]
    scale = VecNormalize.load(str(folder / f"{name}-{seed}.pkl"), TouchVecEnv(kind, 1))
    return PPO.load(folder / f"{name}-{seed}.zip", device="cpu"), scale


def trained_policy(model: PPO, scale: VecNormalize) -> Policy:
    """The network's policy without randomness."""

    def act(observed: npt.NDArray[np.float32]) -> npt.NDArray[np.float32]:
        return np.asarray(model.predict(scale.normalize_obs(observed), deterministic=True)[0], np.float32)

    return act


class Curve(BaseCallback):  # type: ignore[misc, unused-ignore]
    """Evaluates the policy at regular intervals."""

    def __init__(self, kind: str, every: int) -> None:
        super().__init__()
        self.kind, self.every, self.next = kind, every, 0
        self.rows: list[tuple[int, float, float, float]] = []
        self.returns = np.zeros(N_JUDGED)
        self.started = time.monotonic()

    def evaluate(self) -> None:
        """Evaluates the policy, and adds a row."""
        assert isinstance(self.model, PPO)
        scale = self.model.get_vec_normalize_env()
        assert scale is not None
        self.returns = evaluate(self.kind, trained_policy(self.model, scale))
        mean, error = mean_and_error(self.returns)
        seconds = time.monotonic() - self.started
        self.rows.append((self.num_timesteps, seconds, mean, error))
        print(f"{self.num_timesteps:9d} steps, {seconds:4.0f} s: {mean:.2f} ± {error:.2f} {UNIT[self.kind]}, simulated", flush=True)

    def _on_rollout_start(self) -> None:
        if self.num_timesteps >= self.next:
            self.next += self.every
            self.evaluate()

    def _on_step(self) -> bool:
        return True


def train(kind: str, seed: int, variation: SensorVariation | None, steps: int | None) -> tuple[PPO, Curve]:
    """Trains with proximal policy optimization (PPO), with two layers of 128 units."""
    own = dict(SETTINGS[kind])
    n_envs, total = own.pop("n_envs"), steps or own["steps"]
    del own["steps"]
    env = VecNormalize(TouchVecEnv(kind, n_envs, variation=variation, seed=1000 * seed), gamma=own["gamma"])
    model = PPO(
        "MlpPolicy",
        env,
        seed=seed,
        device="cpu",
        batch_size=n_envs * own["n_steps"] // 8,
        n_epochs=8,
        policy_kwargs={"net_arch": [128, 128], "log_std_init": -0.7},
        learning_rate=lambda left: 1e-3 * left + 3e-5,
        **own,
    )
    curve = Curve(kind, total // 20)
    model.learn(total, callback=curve)
    curve.evaluate()
    return model, curve


def write(folder: Path, name: str, kind: str, curve: Curve, others: dict[str, tuple[float, float]], better: tuple[float, float]) -> None:
    """Writes the learning curve as a table and as a plot; `better` is the advantage over the
    scripted baseline in the same episodes, with its standard error.
    """
    folder.mkdir(parents=True, exist_ok=True)
    with (folder / f"{name}.csv").open("w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["policy", "steps", "seconds", "mean_return", "standard_error", "unit", "provenance"])
        for policy, (mean, error) in {**others, "trained minus script": better}.items():
            table.writerow([policy, "", "", f"{mean:.4f}", f"{error:.4f}", UNIT[kind], "simulated"])
        for done, seconds, mean, error in curve.rows:
            table.writerow(["trained", done, f"{seconds:.1f}", f"{mean:.4f}", f"{error:.4f}", UNIT[kind], "simulated"])
    draw(folder / f"{name}.png", kind, curve, others)


def draw(path: Path, kind: str, curve: Curve, others: dict[str, tuple[float, float]]) -> None:
    """Plots the return over steps."""
    import matplotlib  # type: ignore[import-not-found, unused-ignore]

    matplotlib.use("Agg")
    from matplotlib import pyplot  # type: ignore[import-not-found, unused-ignore]

    figure, axes = pyplot.subplots(figsize=(6, 3.6), layout="constrained")
    steps, _, means, _ = zip(*curve.rows)
    axes.plot([1e-6 * done for done in steps], means, marker="o", markersize=3, label="trained (PPO)")
    for (policy, (mean, _)), style in zip(others.items(), ("--", ":")):
        axes.axhline(mean, color="gray", linestyle=style, label=policy)
    axes.set_xlabel("environment steps, millions")
    axes.set_ylabel(f"mean return of an episode, {UNIT[kind]}")
    axes.set_title(f"{kind}, {N_JUDGED} episodes that no training has (simulated)", fontsize=10)
    axes.legend(loc="lower right")
    axes.grid(alpha=0.3)
    figure.savefig(path, dpi=110)
    pyplot.close(figure)


def main() -> None:
    """Trains, evaluates and writes."""
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--task", choices=sorted(SETTINGS), required=True)
    arguments.add_argument("--seed", type=int, default=1)
    arguments.add_argument("--steps", type=int, help="environment steps of the training")
    arguments.add_argument("--perfect", action="store_true", help="train on perfect sensors; it is evaluated on imperfect ones all the same")
    arguments.add_argument("--out", type=Path, default=Path("runs/rl"))
    given = arguments.parse_args()
    torch.set_num_threads(1)
    kind = given.task
    script = evaluate(kind, scripted_policy(kind))
    others = {"script": mean_and_error(script), "chance": mean_and_error(evaluate(kind, random_policy(kind)))}
    for policy, (mean, error) in others.items():
        print(f"{policy}: {mean:.2f} ± {error:.2f} {UNIT[kind]}, simulated", flush=True)
    model, curve = train(kind, given.seed, SensorVariation() if given.perfect else None, given.steps)
    better = mean_and_error(curve.returns - script)
    print(f"better than the script in the same episodes by {better[0]:.2f} ± {better[1]:.2f} {UNIT[kind]}, simulated")
    name = f"{kind}{'-perfect' if given.perfect else ''}-{given.seed}"
    write(given.out, name, kind, curve, others, better)
    model.save(given.out / f"{name}.zip")
    scale = model.get_vec_normalize_env()
    assert scale is not None
    scale.save(str(given.out / f"{name}.pkl"))
    print(f"wrote {name}.csv, .png, .zip and .pkl into {given.out}")


if __name__ == "__main__":
    main()
