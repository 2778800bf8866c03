"""Trains recurrent networks that estimate the force on a sensor, holds forces with them, and
compares them on emulated benches.

    python estimate_force.py train [--sensors dropout] [--seed 1] [--out runs/estimate]
    python estimate_force.py test --recordings runs/*/recordings/presses.parquet [--runs runs/estimate]

The network gets the observations of HoldForce and the list of dead taxels, and estimates the force
and how fast it grows as the robot moves. The robot moves by the missing force over that growth. The
network is trained with the true values of the simulation, in the states that it gets into itself
(DAgger: Ross, Gordon and Bagnell, 2011). Needs PyTorch; `train` takes three to six minutes.

A recording for `test` is made as for second_emulator.py. Several recordings, of benches whose `seed`
differs, are several sensors.
"""

import argparse
import csv
import time
from pathlib import Path

import numpy as np
import numpy.typing as npt
import torch  # type: ignore[import-not-found, unused-ignore]
from second_emulator import EPISODES_A_PRESS, Bench

from twintac import Recording, SensorVariation, Tasks
from twintac.gymnasium.policies import Policy, scripted_policy

Single = npt.NDArray[np.float32]
Double = npt.NDArray[np.float64]

# Of the task: steps, taxels, observations, their units, and the largest motion in a step.
N_STEPS, N_TAXELS, N_OBSERVED = 220, 8, 19
UNIT_N, MOST_MM = 3.0, 10.0 / 55.0

N_UNITS, N_ROUNDS, N_ENVS = 64, 10, 256
N_FITS, N_LAST_FITS, N_TOGETHER = 250, 2500, 32  # batches of episodes
LEARNING_RATES, LAST_LEARNING_RATES = (1.1e-3, 1e-4), (6e-4, 1e-5)
# Weight of the error of the logarithm of the growth, beside that of the force over UNIT_N.
GROWTH_WEIGHT = 0.1
# Part of the missing motion that the robot makes in a step.
GAIN = 0.8
SENSOR_STATES = ("as it is", "one taxel dead")
BENCH_SEED = 1  # of springs, forces, noise and dead taxels of a test
# Disturbances of the actions in training, and their correlation from step to step.
DISTURBANCE, CORRELATION = 0.05, 0.9

# Sensors of the training, and the part of the episodes with a dead taxel (taxel dropout).
SENSORS = {
    "perfect": (SensorVariation(), 0.0),
    "dropout": (SensorVariation(), 0.3),
    "usual": (SensorVariation.usual(), 0.3),
    "varied": (SensorVariation(**(SensorVariation.usual().fields() | {"gain_deviation": 0.08, "modulus_deviation": 0.6})), 0.3),
}


class Estimator(torch.nn.Module):  # type: ignore[misc, unused-ignore]
    """A recurrent network, from what is known in each step to the force over UNIT_N and the logarithm
    of its growth, N/mm.
    """

    def __init__(self) -> None:
        super().__init__()
        n_known = N_OBSERVED + N_TAXELS
        self.mean = torch.nn.Parameter(torch.zeros(n_known), requires_grad=False)
        self.deviation = torch.nn.Parameter(torch.ones(n_known), requires_grad=False)
        self.first = torch.nn.Sequential(torch.nn.Linear(n_known, N_UNITS), torch.nn.ELU(), torch.nn.Linear(N_UNITS, N_UNITS), torch.nn.ELU())
        self.memory = torch.nn.GRU(N_UNITS, N_UNITS, batch_first=True)
        self.last = torch.nn.Sequential(torch.nn.Linear(2 * N_UNITS, N_UNITS), torch.nn.ELU(), torch.nn.Linear(N_UNITS, 2))

    def scale(self, known: torch.Tensor) -> None:
        """Sets the scale of what is known, from episodes `[n, n_steps, n_known]`."""
        self.mean[:N_OBSERVED] = known.mean(dim=(0, 1))[:N_OBSERVED]
        self.deviation[:N_OBSERVED] = known.std(dim=(0, 1))[:N_OBSERVED] + 1e-2

    def forward(self, known: torch.Tensor, state: torch.Tensor | None = None) -> tuple[torch.Tensor, torch.Tensor]:
        """Estimates `[n, n_steps, 2]`, and the state of the memory."""
        now = self.first(((known - self.mean) / self.deviation).clamp(-8.0, 8.0))
        remembered, state = self.memory(now, state)
        return self.last(torch.cat([now, remembered], dim=-1)), state


def knowing(observed: Single, is_dead: Single) -> Single:
    """What is known: an observation, in which dead taxels read zero, and which taxels are dead."""
    alive = np.concatenate([1.0 - is_dead, 1.0 - is_dead, np.ones((len(observed), N_OBSERVED - 2 * N_TAXELS))], axis=1)
    return np.concatenate([observed * alive, is_dead], axis=1).astype(np.float32)


def dead_taxels(chance: float, n: int, random: np.random.Generator) -> Single:
    """1 for the dead taxel of an episode, `[n, N_TAXELS]`; an episode has one with this chance."""
    return np.asarray(np.eye(N_TAXELS)[random.integers(0, N_TAXELS, n)] * (random.random(n) < chance)[:, None], np.float32)


def acting(network: Estimator) -> Policy:
    """The policy of a network, from what is known, for the steps of episodes that begin together."""
    state: torch.Tensor | None = None

    def act(known: Single) -> Single:
        nonlocal state
        with torch.no_grad():
            told, state = network(torch.as_tensor(known[:, None]), state)
        force, growth = told[:, 0].numpy().T
        missing_n = UNIT_N * (known[:, N_OBSERVED - 1] - force)
        return np.asarray(np.clip(GAIN * missing_n / np.exp(growth) / MOST_MM, -1.0, 1.0)[:, None], np.float32)

    return act


def growth_n_per_mm(figures: Double, before: Double) -> Double:
    """How fast the force grows as the robot moves, from the task's figures of two steps. Before first
    touch it is the wanted force over the way to it.
    """
    force_n, wanted_n, depth_mm, spring = figures.T
    moved_mm = depth_mm - before[:, 2]
    hertz = 1.5 * np.maximum(force_n, 0.02) / np.maximum(depth_mm, 0.05)
    secant = np.divide(force_n - before[:, 0], moved_mm, out=np.zeros_like(hertz), where=np.abs(moved_mm) > 5e-3)
    gel = np.where((secant > 0.3 * hertz) & (secant < 3.0 * hertz), secant, hertz).clip(0.3, 20.0)
    way_mm = np.maximum(-depth_mm, 0.0) + wanted_n / spring + 0.2
    return np.asarray(np.where(depth_mm < 0.05, wanted_n / way_mm, 1.0 / (1.0 / spring + 1.0 / gel)))


def play(network: Estimator | None, sensors: str, seed: int, random: np.random.Generator) -> dict[str, torch.Tensor]:
    """Plays an episode in each environment: with the network, or with the true values without one.
    What was known, and the true values, `[N_ENVS, N_STEPS, ...]`.
    """
    variation, chance = SENSORS[sensors]
    tasks = Tasks("HoldForce", N_ENVS, variation=variation, autoreset="Disabled")
    tasks.seed([seed + number for number in range(N_ENVS)])
    is_dead = dead_taxels(chance, N_ENVS, random)
    act = acting(network) if network is not None else None
    observed, told = tasks.reset()
    figures = before = np.asarray(told, np.float64)
    disturbance, is_going = np.zeros((N_ENVS, 1)), np.ones(N_ENVS, np.bool_)
    rows: dict[str, list[npt.NDArray[np.float32]]] = {name: [] for name in ("known", "force", "growth", "weight", "error")}
    for _ in range(N_STEPS):
        known, growth = knowing(observed, is_dead), growth_n_per_mm(figures, before)
        rows["known"].append(known)
        rows["force"].append((figures[:, 0] / UNIT_N).astype(np.float32))
        rows["growth"].append(np.log(growth).astype(np.float32))
        rows["weight"].append(is_going.astype(np.float32))
        missing_n = figures[:, 1] - figures[:, 0]
        actions = act(known) if act is not None else (missing_n / growth / MOST_MM)[:, None]
        disturbance = CORRELATION * disturbance + DISTURBANCE * random.standard_normal(disturbance.shape)
        observed, rewards, terminated, truncated, told, _ = tasks.step(np.clip(actions + disturbance, -1.0, 1.0).astype(np.float32))
        rows["error"].append((-rewards * is_going).astype(np.float32))
        figures, before = np.asarray(told, np.float64), figures
        is_going &= ~(terminated | truncated)
    return {name: torch.as_tensor(np.stack(values, axis=1)) for name, values in rows.items()}


def fit(network: Estimator, optimizer: torch.optim.Optimizer, rounds: list[dict[str, torch.Tensor]], n_fits: int, rates: tuple[float, float]) -> None:
    """Fits the network to all episodes, with a learning rate that falls from one value to another."""
    known, force, growth, weight = (torch.cat([one[name] for one in rounds]) for name in ("known", "force", "growth", "weight"))
    for number in range(n_fits):
        for group in optimizer.param_groups:
            group["lr"] = rates[0] + (rates[1] - rates[0]) * number / n_fits
        chosen = torch.randint(len(known), (N_TOGETHER,))
        told, _ = network(known[chosen])
        off = (told[..., 0] - force[chosen]).abs() + GROWTH_WEIGHT * (told[..., 1] - growth[chosen]).abs()
        optimizer.zero_grad()
        (off * weight[chosen]).mean().backward()
        torch.nn.utils.clip_grad_norm_(network.parameters(), 1.0)
        optimizer.step()


def train(sensors: str, seed: int, out: Path) -> None:
    """Trains a network in rounds: the true values act in the first one, the network in the others."""
    torch.manual_seed(seed)
    random = np.random.default_rng(seed)
    network = Estimator()
    optimizer = torch.optim.Adam(network.parameters())
    rounds: list[dict[str, torch.Tensor]] = []
    started = time.monotonic()
    for number in range(N_ROUNDS):
        played = play(network if number > 0 else None, sensors, 10**7 * seed + 1000 * number, random)
        rounds.append(played)
        if number < 2:
            network.scale(torch.cat([one["known"] for one in rounds]))
        rate = LEARNING_RATES[0] + (LEARNING_RATES[1] - LEARNING_RATES[0]) * number / N_ROUNDS
        is_last = number == N_ROUNDS - 1
        fit(network, optimizer, rounds, N_LAST_FITS if is_last else N_FITS, LAST_LEARNING_RATES if is_last else (rate, rate))
        actor = "network" if number > 0 else "true values"
        print(f"round {number + 1} of {N_ROUNDS}, the {actor} acted: error {float(played['error'].mean()):.3f} N, simulated, {time.monotonic() - started:.0f} s", flush=True)
    out.mkdir(parents=True, exist_ok=True)
    partial = out / f"partial-{sensors}-{seed}.pt"
    torch.save(network.state_dict(), partial)
    partial.replace(out / f"{sensors}-{seed}.pt")


def trained(path: Path) -> Estimator:
    """A trained network."""
    network = Estimator()
    network.load_state_dict(torch.load(path))
    return network


def errors_n(bench: Bench, network: Estimator | None, has_dead_taxel: bool) -> Double:
    """Mean errors of the force in every press on a bench, N; of the scripted baseline without a
    network. The script is not told which taxel is dead.
    """
    act = acting(network) if network is not None else scripted_policy("HoldForce")
    dead = np.eye(N_TAXELS, dtype=np.float32)[bench.episodes(np.random.default_rng(BENCH_SEED))[2]] * has_dead_taxel

    def policy(observed: Single) -> Single:
        return act(knowing(observed, dead) if network is not None else observed)

    returns = bench.returns(policy, has_dead_taxel, BENCH_SEED)
    return np.asarray(-returns.reshape(-1, EPISODES_A_PRESS).mean(axis=1) / N_STEPS)


def test(recordings: list[Path], runs: Path, out: Path) -> None:
    """Evaluates all networks and the scripted baseline on every bench, and writes a table and a plot."""
    benches = {path.parent.parent.name: Bench(Recording.load(path)) for path in recordings}
    networks: dict[str, Estimator | None] = {"script": None}
    for kind in SENSORS:
        networks |= {path.stem: trained(path) for path in sorted(runs.glob(f"{kind}-*.pt"))}
    found: dict[str, list[Double]] = {}
    for name, network in networks.items():
        found[name] = []
        for has_dead_taxel, sensor in enumerate(SENSOR_STATES):
            of_benches = np.array([errors_n(bench, network, bool(has_dead_taxel)).mean() for bench in benches.values()])
            found[name].append(of_benches)
            each = ", ".join(f"{bench} {error:.3f}" for bench, error in zip(benches, of_benches))
            print(f"{name}, {sensor}: {of_benches.mean():.3f} N, emulated; {each}", flush=True)
    out.parent.mkdir(parents=True, exist_ok=True)
    with out.open("w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["policy", "sensor", "bench", "mean_error", "unit", "provenance"])
        for name, of_states in found.items():
            for sensor, of_benches in zip(SENSOR_STATES, of_states):
                table.writerows([name, sensor, bench, f"{error:.4f}", "N", "emulated"] for bench, error in zip(benches, of_benches))
    draw(out.with_suffix(".png"), list(benches), found)


def draw(path: Path, benches: list[str], found: dict[str, list[Double]]) -> None:
    """Plots the errors on every bench; a point is one training."""
    from matplotlib.figure import Figure

    kinds = list(dict.fromkeys(name.rsplit("-", 1)[0] for name in found))
    labels = {"script": "scripted baseline", "dropout": "trained with taxel dropout"}
    figure = Figure(figsize=(8, 3.6), layout="constrained")
    for panel, sensor in enumerate(SENSOR_STATES):
        axes = figure.add_subplot(1, 2, panel + 1, title=f"sensor: {sensor}", ylim=(0.0, 0.5), ylabel="mean error of the force, N")
        for number, kind in enumerate(kinds):
            own = [values[panel] for name, values in found.items() if name.rsplit("-", 1)[0] == kind]
            at = np.arange(len(benches)) + 0.18 * (number - 0.5 * (len(kinds) - 1))
            axes.plot(np.tile(at, len(own)), np.concatenate(own), "o", markersize=4, label=labels.get(kind, f"trained on {kind} sensors"))
        axes.set_xticks(np.arange(len(benches)), benches, rotation=30, ha="right", fontsize=8)
        axes.grid(alpha=0.3, axis="y")
    figure.axes[0].legend(fontsize=8)
    figure.suptitle("HoldForce on emulated benches (emulated)", fontsize=10)
    figure.savefig(path, dpi=110)


def main() -> None:
    """Trains or tests."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    one = commands.add_parser("train", help="train a network")
    one.add_argument("--sensors", choices=SENSORS, default="dropout", help="sensors of the training (default: dropout, perfect ones with taxel dropout)")
    one.add_argument("--seed", type=int, default=1, help="of all that is random (default: 1)")
    one.add_argument("--out", type=Path, default=Path("runs/estimate"), help="folder of the networks (default: runs/estimate)")
    other = commands.add_parser("test", help="compare all trained networks and the scripted baseline")
    other.add_argument("--recordings", type=Path, nargs="+", required=True, help="one of each bench, in BENCH/recordings")
    other.add_argument("--runs", type=Path, default=Path("runs/estimate"), help="folder of the networks (default: runs/estimate)")
    other.add_argument("--out", type=Path, default=Path("runs/estimate/benches.csv"), help="table; the plot beside it is a PNG (default: runs/estimate/benches.csv)")
    asked = parser.parse_args()
    torch.set_num_threads(1)
    if asked.command == "test":
        names = [path.parent.parent.name for path in asked.recordings]
        if len(set(names)) < len(names):
            other.error(f"argument --recordings: two benches have the same name, of {', '.join(names)}; the folder above recordings/ is the name")
        if not any(asked.runs.glob("*-*.pt")):
            other.error(f"argument --runs: {asked.runs} has no network; `train --out {asked.runs}` makes one")
    if asked.command == "train":
        train(asked.sensors, asked.seed, asked.out)
    else:
        test(asked.recordings, asked.runs, asked.out)


if __name__ == "__main__":
    main()
