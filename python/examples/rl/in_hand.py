"""Trains hands to turn an object on their palm by touch, and compares hands that feel more or less.

    python in_hand.py train --touch taxels [--seed 1] [--out runs/in-hand]
    python in_hand.py test [--runs runs/in-hand] [--out runs/in-hand]
    python in_hand.py film --run runs/in-hand/taxels-1 --out turn.gif

A teacher sees the object. A student with a memory feels it, and learns to act as the teacher would
in the states that the student itself gets into (DAgger: Ross, Gordon and Bagnell, 2011). Needs
PyTorch; the film needs OpenGL, as `MUJOCO_GL` names it. `train` takes about half an hour on two
cores. If it is stopped, the same command continues with the round that it was in.
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

import twintac.gymnasium  # registers the tasks
from twintac.gymnasium.policies import Policy, random_policy, scripted_policy, seeing_policy

KIND = "TwinTac/InHandTurn-v0"
TOUCHES = ("taxels", "forces", "none")
N_STEPS, N_HISTORY, N_ACTIONS, N_TRUTH = 60, 4, 8, 5  # of the task
N_ROUNDS, N_ENVS = 16, 128
N_FITS, N_LAST_FITS, N_TOGETHER = 500, 4000, 64  # batches of episodes
LEARNING_RATES, LAST_LEARNING_RATES = (1e-3, 1e-4), (3e-4, 1e-5)
N_UNITS = 128
# The student also learns to tell what the teacher sees: so its memory holds it.
TRUTH_WEIGHT = 0.5
# Disturbances of the actions in training, and their correlation from step to step.
DISTURBANCE, CORRELATION = 0.02, 0.9
# Seeds of the episodes that no training has: those of trainings are smaller.
MOST_SEED, MOST_ROUNDS = 9, 100_000
TEST_SEEDS, N_TEST = [10**9 + 10**6 * group for group in range(5)], 128
NEAR_DEG = 5.0

Single = npt.NDArray[np.float32]


def play(policy: Policy, touch: str, seed: int, n: int) -> dict[str, npt.NDArray[Any]]:
    """Plays one episode in each of `n` worlds, and returns the returns, the errors of the angle at
    the end, whether the object fell, and whether it is a box.
    """
    env = gym.make_vec(KIND, num_envs=n, touch=touch, autoreset_mode="Disabled")
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


def is_near(found: dict[str, npt.NDArray[Any]]) -> npt.NDArray[np.bool_]:
    """Which episodes ended near the wanted angle."""
    return np.asarray((found["error_deg"] < NEAR_DEG) & ~found["is_dropped"])


class Student(torch.nn.Module):  # type: ignore[misc, unused-ignore]
    """A recurrent network, from what is felt in each step to actions, and to what the teacher sees."""

    def __init__(self, n_felt: int) -> None:
        super().__init__()
        self.mean = torch.nn.Parameter(torch.zeros(n_felt), requires_grad=False)
        self.deviation = torch.nn.Parameter(torch.ones(n_felt), requires_grad=False)
        self.first = torch.nn.Sequential(torch.nn.Linear(n_felt, N_UNITS), torch.nn.ELU())
        self.memory = torch.nn.GRU(N_UNITS, N_UNITS, batch_first=True)
        self.last = torch.nn.Sequential(torch.nn.Linear(2 * N_UNITS, N_UNITS), torch.nn.ELU(), torch.nn.Linear(N_UNITS, N_ACTIONS + N_TRUTH))

    def forward(self, felt: torch.Tensor, state: torch.Tensor | None = None) -> tuple[torch.Tensor, torch.Tensor]:
        """Outputs `[n, n_steps, 13]` for `felt`, `[n, n_steps, n_felt]`, and the state of the memory."""
        now = self.first(((felt - self.mean) / self.deviation).clamp(-5.0, 5.0))
        remembered, state = self.memory(now, state)
        return self.last(torch.cat([now, remembered], dim=-1)), state


def newest(observed: Single, n_truth: int = 0) -> Single:
    """What is felt now: the newest frame of an observation without the truth, and its last two numbers."""
    n_frame = (observed.shape[1] - 2) // N_HISTORY
    return np.concatenate([observed[:, n_truth:n_frame], observed[:, -2:]], axis=1)


def remembering(student: Student) -> Policy:
    """The policy of a student, for episodes that begin together."""
    state: torch.Tensor | None = None

    def act(felt: Single) -> Single:
        nonlocal state
        if felt[0, -1] == 1.0:  # the part of the episode that is left
            state = None
        with torch.no_grad():
            told, state = student(torch.as_tensor(felt[:, None]), state)
        return np.asarray(told[:, 0, :N_ACTIONS].clamp(-1.0, 1.0).numpy(), np.float32)

    return act


class Episodes:
    """What was felt in each step of episodes, what the teacher saw, and what it would have done."""

    def __init__(self, actor: Policy | None, seed: int) -> None:
        """`actor`: acts on what is felt; the teacher itself if there is none."""
        self.actor, self.teacher = actor, seeing_policy()
        self.random, self.disturbance = np.random.default_rng(seed), np.zeros((N_ENVS, N_ACTIONS))
        self.steps: list[tuple[Single, Single, Single]] = []

    def act(self, observed: Single) -> Single:
        """Acts in one step of all episodes, with a disturbance, and remembers it."""
        felt, taught = newest(observed, N_TRUTH), self.teacher(observed)
        self.steps.append((felt, observed[:, :N_TRUTH], taught))
        self.disturbance = CORRELATION * self.disturbance + DISTURBANCE * self.random.standard_normal(self.disturbance.shape)
        actions = taught if self.actor is None else self.actor(felt)
        return np.clip(actions + self.disturbance, -1.0, 1.0).astype(np.float32)

    def tensors(self) -> dict[str, torch.Tensor]:
        """All episodes, `[n_episodes, n_steps, ...]`; steps after the object fell have weight 0."""
        felt, truth, taught = (np.stack(values, axis=1) for values in zip(*self.steps))
        expected = 1.0 - np.arange(N_STEPS, dtype=np.float32) / N_STEPS
        weight = (np.abs(felt[:, :, -1] - expected) < 0.5 / N_STEPS).astype(np.float32)
        found = {"felt": felt, "truth": truth, "taught": taught, "weight": weight}
        return {name: torch.as_tensor(values) for name, values in found.items()}


def fit(student: Student, optimizer: torch.optim.Optimizer, rounds: list[Path], seed: int, n_fits: int, rates: tuple[float, float]) -> None:
    """Fits the student to all episodes, with a learning rate that falls from one value to another."""
    stored = [torch.load(path) for path in rounds]
    felt, truth, taught, weight = (torch.cat([one[name] for one in stored]) for name in ("felt", "truth", "taught", "weight"))
    student.mean.copy_(felt.mean(dim=(0, 1)))
    student.deviation.copy_(felt.std(dim=(0, 1)) + 1e-3)
    random = torch.Generator().manual_seed(seed)
    for number in range(n_fits):
        for group in optimizer.param_groups:
            group["lr"] = rates[0] + (rates[1] - rates[0]) * number / n_fits
        chosen = torch.randint(len(felt), (N_TOGETHER,), generator=random)
        told, _ = student(felt[chosen])
        off = ((told[..., :N_ACTIONS] - taught[chosen]) ** 2).mean(dim=-1) + TRUTH_WEIGHT * ((told[..., N_ACTIONS:] - truth[chosen]) ** 2).mean(dim=-1)
        optimizer.zero_grad()
        (off * weight[chosen]).mean().backward()
        torch.nn.utils.clip_grad_norm_(student.parameters(), 1.0)
        optimizer.step()


def first_seed(seed: int, number: int) -> int:
    """Seed of the first episode of a round; those of the others follow."""
    return 10**8 * seed + 1000 * number


def kept(path: Path, write: Any) -> None:
    """Writes a file completely or not at all; `write` writes to the path that it gets."""
    partial = path.with_name(f"partial-{path.name}")
    write(partial)
    partial.replace(path)


def train(touch: str, seed: int, n_rounds: int, out: Path) -> None:
    """Trains a student in rounds: the teacher acts in the first one, the student in the others."""
    folder = out / f"{touch}-{seed}"
    folder.mkdir(parents=True, exist_ok=True)
    torch.manual_seed(seed)
    seen = "truth" if touch == "none" else f"truth+{touch}"
    shape = gym.make_vec(KIND, num_envs=1, touch=touch).single_observation_space.shape or (0,)
    student = Student((shape[0] - 2) // N_HISTORY + 2)
    optimizer = torch.optim.Adam(student.parameters())
    rows: list[dict[str, Any]] = []
    if (folder / "training.pt").exists():
        before = torch.load(folder / "training.pt")
        student.load_state_dict(before["student"])
        optimizer.load_state_dict(before["optimizer"])
        rows = before["rows"]
        print(f"continues after round {len(rows)} of {n_rounds}", flush=True)
    paths = [folder / f"round-{number:02d}.pt" for number in range(n_rounds)]
    for number in range(len(rows), n_rounds):
        started = time.monotonic()
        of_round = first_seed(seed, number)
        episodes = Episodes(remembering(student) if number > 0 else None, of_round)
        found = play(episodes.act, seen, of_round, N_ENVS)
        kept(paths[number], lambda partial: torch.save(episodes.tensors(), partial))
        part = number / n_rounds
        rate = LEARNING_RATES[0] + (LEARNING_RATES[1] - LEARNING_RATES[0]) * part
        is_last = number == n_rounds - 1
        fit(student, optimizer, paths[: number + 1], of_round, N_LAST_FITS if is_last else N_FITS, LAST_LEARNING_RATES if is_last else (rate, rate))
        seconds = (rows[-1]["seconds"] if rows else 0.0) + time.monotonic() - started
        rows.append({"actor": "student" if number > 0 else "teacher", "steps": (number + 1) * N_ENVS * N_STEPS, "seconds": round(seconds, 1), "return": float(found["return"].mean()), "near": float(is_near(found).mean()), "dropped": float(found["is_dropped"].mean())})
        state = {"student": student.state_dict(), "optimizer": optimizer.state_dict(), "rows": rows}
        kept(folder / "training.pt", lambda partial: torch.save(state, partial))
        left_min = (n_rounds - number - 1) * seconds / (number + 1) / 60.0
        print(f"round {number + 1} of {n_rounds}, the {rows[-1]['actor']} acts: return {rows[-1]['return']:.2f}, {rows[-1]['near']:.0%} within {NEAR_DEG:.0f} degrees, {rows[-1]['dropped']:.0%} dropped, about {left_min:.0f} min left", flush=True)


def trained(folder: Path) -> tuple[Policy, list[dict[str, Any]]]:
    """The policy of a folder, and its learning curve."""
    stored = torch.load(folder / "training.pt")
    student = Student(len(stored["student"]["mean"]))
    student.load_state_dict(stored["student"])
    act = remembering(student)
    return lambda observed: act(newest(observed)), stored["rows"]


def summary(episodes: list[dict[str, npt.NDArray[Any]]]) -> dict[str, Any]:
    """Means over all episodes, with their standard errors."""
    every = {name: np.concatenate([found[name] for found in episodes]) for name in episodes[0]}
    near = is_near(every)

    def mean(values: npt.NDArray[Any]) -> list[float]:
        return [round(float(values.mean()), 4), round(float(values.std(ddof=1) / np.sqrt(len(values))), 4)]

    return {
        "return": mean(every["return"]),
        "near": mean(near),
        "near_cylinders": mean(near[~every["is_box"]]),
        "near_boxes": mean(near[every["is_box"]]),
        "dropped": mean(every["is_dropped"]),
        "median_error_deg": round(float(np.median(every["error_deg"])), 2),
        "near_of_each_seed": [round(float(is_near(found).mean()), 4) for found in episodes],
        "episodes": len(near),
    }


def test(runs: Path, out: Path) -> None:
    """Evaluates all policies in the same episodes, and writes `in-hand.json`, `.csv` and `.png`."""
    policies: dict[str, tuple[Policy, str]] = {}
    curves: list[dict[str, Any]] = []
    for touch in TOUCHES:
        for folder in sorted(runs.glob(f"{touch}-*")):
            policy, rows = trained(folder)
            policies[folder.name] = policy, touch
            curves += [{"run": folder.name} | row for row in rows]
    policies["teacher, sees"] = seeing_policy(), "truth"
    policies["script"] = scripted_policy("InHandTurn"), "none"
    policies["chance"] = random_policy("InHandTurn"), "none"
    found = {}
    for name, (policy, touch) in policies.items():
        found[name] = summary([play(policy, touch, seed, N_TEST) for seed in TEST_SEEDS])
        print(f"{name}: return {found[name]['return'][0]:.2f}, {found[name]['near'][0]:.1%} within {NEAR_DEG:.0f} degrees, {found[name]['dropped'][0]:.1%} dropped, simulated", flush=True)
    out.mkdir(parents=True, exist_ok=True)
    text = json.dumps({"provenance": "simulated", "policies": found}, indent=1) + "\n"
    kept(out / "in-hand.json", lambda partial: partial.write_text(text))
    with (out / "in-hand.csv").open("w", newline="") as file:
        table = csv.DictWriter(file, ["run", "actor", "steps", "seconds", "return", "near", "dropped"], lineterminator="\n")
        table.writeheader()
        table.writerows(curves)
    draw(out / "in-hand.png", curves, found)


def draw(path: Path, curves: list[dict[str, Any]], found: dict[str, Any]) -> None:
    """Plots the learning curves beside the baselines."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7, 3.6), layout="constrained")
    axes = figure.add_subplot(xlabel="environment steps, thousands", ylabel=f"episodes within {NEAR_DEG:.0f} degrees, %", ylim=(0, 100))
    for run in dict.fromkeys(row["run"] for row in curves):
        own = [row for row in curves if row["run"] == run and row["actor"] == "student"]
        line = axes.plot([1e-3 * row["steps"] for row in own], [100.0 * row["near"] for row in own], marker="o", markersize=3, label=f"{run}, in training")
        axes.plot(1e-3 * own[-1]["steps"], 100.0 * found[run]["near"][0], marker="*", markersize=12, color=line[0].get_color(), linestyle="", label=f"{run}, at the end, held out")
    for name, style in (("teacher, sees", "-."), ("script", "--"), ("chance", ":")):
        axes.axhline(100.0 * found[name]["near"][0], color="gray", linestyle=style, label=name)
    axes.set_title("InHandTurn: a student that feels learns from a teacher that sees (simulated)", fontsize=9)
    figure.legend(loc="outside right center", fontsize=8)
    axes.grid(alpha=0.3)
    figure.savefig(path, dpi=110)


def film(folder: Path, out: Path, seed: int) -> None:
    """Films episodes as an animated GIF."""
    from PIL import Image

    touch, (policy, _) = folder.name.rsplit("-", 1)[0], trained(folder)
    env = gym.make_vec(KIND, num_envs=2, touch=touch, autoreset_mode="Disabled", render_mode="rgb_array")
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
    one.add_argument("--seed", type=int, choices=range(MOST_SEED + 1), default=1, help="of all that is random (default: 1)")
    one.add_argument("--rounds", type=int, default=N_ROUNDS, help=f"rounds of {N_ENVS} episodes (default: {N_ROUNDS})")
    one.add_argument("--out", type=Path, default=Path("runs/in-hand"), help="folder of the runs (default: runs/in-hand)")
    other = commands.add_parser("test", help="compare all trained policies with a teacher, a script and chance")
    other.add_argument("--runs", type=Path, default=Path("runs/in-hand"), help="folder of the runs (default: runs/in-hand)")
    other.add_argument("--out", type=Path, default=Path("runs/in-hand"), help="folder of the results (default: runs/in-hand)")
    filmed = commands.add_parser("film", help="film a trained policy")
    filmed.add_argument("--run", type=Path, required=True, help="folder of the run")
    filmed.add_argument("--out", type=Path, default=Path("turn.gif"), help="file (default: turn.gif)")
    filmed.add_argument("--seed", type=int, default=TEST_SEEDS[0], help="of the first of two episodes")
    asked = parser.parse_args()
    torch.set_num_threads(1)
    if asked.command == "train" and not 2 <= asked.rounds <= MOST_ROUNDS:
        one.error(f"argument --rounds: is {asked.rounds}, expected 2 to {MOST_ROUNDS}")
    if asked.command == "train":
        train(asked.touch, asked.seed, asked.rounds, asked.out)
    elif asked.command == "test":
        test(asked.runs, asked.out)
    else:
        film(asked.run, asked.out, asked.seed)


if __name__ == "__main__":
    main()
