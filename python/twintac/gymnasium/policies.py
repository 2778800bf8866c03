"""Policies without training: random baselines and scripted baselines.

A policy is a function from observations, `[n, n_observed]`, to actions, `[n, n_actions]`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from twintac import Body, FastGel, Shape, Tasks
from twintac.gymnasium._spaces import Single, make_tasks

Policy: TypeAlias = Callable[[Single], Single]
"""A function from observations, `[n, n_observed]`, to actions, `[n, n_actions]`."""

_Double: TypeAlias = npt.NDArray[np.float64]
_Integers: TypeAlias = npt.NDArray[np.int64]

_N_TAXELS = 8
_HEIGHT_MM = 8.5


def random_policy(kind: str, seed: int = 0) -> Policy:
    """The random baseline: actions that are uniformly distributed from -1 to 1.

    Args:
        kind: the task.
        seed: seed of the random numbers.

    Returns:
        The policy.
    """
    n_actions = make_tasks(kind, 1).n_actions
    random = np.random.default_rng(seed)

    def act(observed: Single) -> Single:
        return random.uniform(-1.0, 1.0, (len(observed), n_actions)).astype(np.float32)

    return act


def scripted_policy(kind: str, seed: int = 0) -> Policy:
    """The scripted baseline of a task, for the task's own sensor. Making it takes some seconds. The
    baseline of HoldForce is calibrated on the task's shapes and that of FollowEdge on the task's
    discs, both with perfect sensors; that of ExploreShape with sensor variation. That of InHandTurn
    uses the angles of the joints, and no reading.

    Args:
        kind: the task.
        seed: seed of the random presses that the baseline is calibrated on.

    Returns:
        The policy.
    """
    scripts = {"HoldForce": _hold_force, "FollowEdge": _follow_edge, "ExploreShape": _explore_shape, "InHandTurn": _in_hand_turn}
    return scripts[kind](np.random.default_rng(seed))


def seeing_policy() -> Policy:
    """A scripted policy of InHandTurn that sees the object, as a teacher, and as the best that touch
    can be compared with. It needs observations with `touch="truth"`, or with the truth first, as in
    `touch="truth+taxels"`.

    Returns:
        The policy.
    """
    return _turn(sees=True)


def returns(policy: Policy, tasks: Tasks) -> _Double:
    """The return (sum of the rewards) of one episode of each environment.

    Args:
        policy: the policy to evaluate.
        tasks: the environments, which must not start new episodes by themselves
            (`autoreset="Disabled"`).

    Returns:
        The returns, `[n_environments]`.
    """
    observed, _ = tasks.reset()
    total, is_going = np.zeros(len(tasks)), np.ones(len(tasks), np.bool_)
    while is_going.any():
        observed, rewards, terminated, truncated, _, _ = tasks.step(policy(observed))
        total[is_going] += rewards[is_going]
        is_going &= ~(terminated | truncated)
    return total


def _contacts(
    shapes: list[Shape], number: _Integers, place_mm: _Double, yaw_rad: _Double, depth_mm: _Double
) -> tuple[Single, Single]:
    """The readings of perfect sensors, kPa, and the force, N, under shapes at given locations, yaws
    and depths.
    """
    batch = FastGel.phystac().batch([Body(shape) for shape in shapes])
    zero = np.zeros_like(yaw_rad)
    pose = np.stack(
        [*place_mm.T, _HEIGHT_MM - depth_mm, zero, zero, np.sin(0.5 * yaw_rad), np.cos(0.5 * yaw_rad)], axis=1
    )
    readings_kpa, wrench = batch.read(pose, body=number)
    return readings_kpa, -wrench[:, 2]


def _hold_force(random: np.random.Generator) -> Policy:
    """The scripted baseline of HoldForce. It estimates the force as a weighted sum of the readings
    (least squares). The speed is proportional to the error of the force.
    """
    n = 2000
    balls = [Shape.sphere(radius_mm) for radius_mm in (8.0, 10.0, 12.5)]
    shapes = [*balls, Shape.cylinder(5.0, 10.0, 0.8), Shape.box((10.0, 10.0, 10.0), 0.8)]
    place_mm = random.uniform(-1.0, 1.0, (n, 2)) * (8.0, 3.0)
    yaw_rad, depth_mm = random.uniform(-np.pi, np.pi, n), random.uniform(0.0, 3.5, n)
    readings_kpa, force_n = _contacts(shapes, random.integers(len(shapes), size=n), place_mm, yaw_rad, depth_mm)
    weights, *_ = np.linalg.lstsq(readings_kpa[force_n < 3.5], force_n[force_n < 3.5], rcond=None)
    speed_per_n = 3.0  # the best of 0.5, 0.8, 1.2, 1.6, 2 and 3

    def act(observed: Single) -> Single:
        felt_n = 10.0 * observed[:, :_N_TAXELS] @ weights
        missing_n = 3.0 * observed[:, 2 * _N_TAXELS + 2] - felt_n
        return np.clip(speed_per_n * missing_n, -1.0, 1.0)[:, None].astype(np.float32)

    return act


def _follow_edge(random: np.random.Generator) -> Policy:
    """The scripted baseline of FollowEdge. It estimates the direction out of the face, the distance
    of the edge and the force as weighted sums (least squares). Each speed is proportional to its
    error.
    """
    n = 4000
    shapes = [Shape.cylinder(radius_mm, 10.0, 0.8) for radius_mm in (8.0, 9.5, 11.0)]
    radius_mm = np.array([8.0, 9.5, 11.0])
    number = random.integers(len(shapes), size=n)
    way_out = random.uniform(-np.pi, np.pi, n)
    outward = np.stack([np.cos(way_out), np.sin(way_out)], axis=1)
    beside_mm, depth_mm = random.uniform(-3.0, 3.0, n), random.uniform(0.5, 1.5, n)
    # The gel's middle is beside the edge, so the disc's middle lies inward of it.
    place_mm = -(radius_mm[number] + beside_mm)[:, None] * outward
    readings_kpa, force_n = _contacts(shapes, number, place_mm, np.zeros(n), depth_mm)

    def features(readings_kpa: Single) -> Single:
        parts = readings_kpa / np.maximum(readings_kpa.sum(axis=1, keepdims=True), 0.5)
        return np.concatenate([parts, parts**2, np.ones((len(parts), 1))], axis=1)

    told = np.concatenate([outward, beside_mm[:, None]], axis=1)
    weights, *_ = np.linalg.lstsq(features(readings_kpa), told, rcond=None)
    force_weights, *_ = np.linalg.lstsq(readings_kpa, force_n, rcond=None)
    # The best of about twenty combinations.
    wanted_n, deeper_per_n, back_per_mm, ahead = 3.0, 0.5, 0.5, 1.0

    def act(observed: Single) -> Single:
        readings_kpa = 10.0 * observed[:, :_N_TAXELS]
        found = features(readings_kpa) @ weights
        outward = found[:, :2] / np.maximum(np.linalg.norm(found[:, :2], axis=1, keepdims=True), 1e-6)
        along = np.stack([-outward[:, 1], outward[:, 0]], axis=1) * observed[:, -1:]
        missing_n = wanted_n - readings_kpa @ force_weights
        is_touching = (readings_kpa @ force_weights > 0.5)[:, None]
        plane = np.where(is_touching, ahead * along - back_per_mm * found[:, 2:] * outward, 0.0)
        return np.clip(np.concatenate([plane, deeper_per_n * missing_n[:, None]], axis=1), -1.0, 1.0).astype(np.float32)

    return act


def _explore_shape(random: np.random.Generator) -> Policy:
    """The scripted baseline of ExploreShape. It makes four presses at fixed locations, to the
    largest depth. The probability of a shape is its fraction among the 25 nearest of 10,000 presses
    that were simulated before.
    """
    n, n_presses, n_shapes, nearest = 10_000, 4, 5, 25
    places = np.array([[0.0, 0.0], [0.35, 0.0], [-0.35, 0.0], [0.0, 0.5]])
    tasks = Tasks("ExploreShape", n, autoreset="Disabled")
    tasks.seed([int(seed) for seed in random.integers(2**40, 2**62, n)])
    observed, figures = tasks.reset()
    shape = figures[:, 0].astype(np.int64)

    def presses(observed: Single) -> _Double:
        step = observed[:, -(n_presses + 1) :].argmax(axis=1)
        where = places[np.minimum(step, n_presses - 1)]
        return np.concatenate([where, np.ones((len(observed), 1))], axis=1)

    libraries = []
    for _ in range(n_presses):
        nothing = np.zeros((n, n_shapes))
        observed, *_ = tasks.step(np.concatenate([presses(observed), nothing], axis=1))
        libraries.append(observed)

    def scores(observed: Single) -> _Double:
        found = np.zeros((len(observed), n_shapes))
        step = observed[:, -(n_presses + 1) :].argmax(axis=1)
        for pressed in range(1, n_presses + 1):
            own = np.flatnonzero(step == pressed)
            if len(own) == 0:
                continue
            library = libraries[pressed - 1][:, : -(n_presses + 1)]
            felt = observed[own, : -(n_presses + 1)]
            far = (felt**2).sum(axis=1)[:, None] - 2.0 * felt @ library.T + (library**2).sum(axis=1)
            close = shape[np.argpartition(far, nearest, axis=1)[:, :nearest]]
            part = (close[:, :, None] == np.arange(n_shapes)).sum(axis=1) + 0.5
            found[own] = 1.0 + np.log(part / part.max(axis=1, keepdims=True)) / 5.0
        return found

    def act(observed: Single) -> Single:
        return np.clip(np.concatenate([presses(observed), scores(observed)], axis=1), -1.0, 1.0).astype(np.float32)

    return act


def _in_hand_turn(random: np.random.Generator) -> Policy:
    """The scripted baseline of InHandTurn. The swing of the closed fingers is determined by the
    wanted angle and by the angles of the joints, which show how wide the object is. So it is right
    for cylinders; how a box lay stays unknown.
    """
    return _turn(sees=False)


def _turn(sees: bool) -> Policy:
    """The fingers swing back, close, and swing forward together: as far as a cylinder needs, or, if
    the policy sees the object, until the angle is right.
    """
    from twintac.gymnasium._hand import CLOSE_RAD, SWING_RAD
    from twintac.gymnasium._in_hand import FASTEST, N_HISTORY, N_JOINTS, N_STEPS, WANTED_RAD

    def scaled(rad: _Double, ends: tuple[float, float]) -> _Double:
        return (2.0 * rad - ends[0] - ends[1]) / (ends[1] - ends[0])

    def angle_rad(scaled: _Double, ends: tuple[float, float]) -> _Double:
        return 0.5 * (scaled * (ends[1] - ends[0]) + ends[0] + ends[1])

    closes, turns, stops = 5, 14, 40  # steps
    # Fitted to 96 cylinders: the swing for each radian that the object turns is
    # `at_0 - slope sin(close)`. The fingers swing back by `back` before they close.
    back, at_0, slope = 0.12, 0.41, 1.08
    # The part of the angle that is left, and the most, for which a seeing policy swings in a step.
    part_of_left, most_rad = 0.2, 0.2
    tight_rad = 0.3 if sees else 0.35

    def act(observed: Single) -> Single:
        step = np.round((1.0 - observed[:, -1]) * N_STEPS)
        n_frame = (observed.shape[1] - 2) // N_HISTORY
        joints, targets = np.split(observed[:, n_frame - 2 * N_JOINTS : n_frame], 2, axis=1)
        close_rad = angle_rad(joints[:, 1::2].mean(axis=1), CLOSE_RAD)
        wanted_rad = -observed[:, -2] * WANTED_RAD[1]  # as the fingers swing
        of_turn = at_0 - slope * np.sin(close_rad)
        if sees:
            left_rad = -observed[:, 0] * WANTED_RAD[1]
            now_rad = angle_rad(targets[:, 0::2].mean(axis=1), SWING_RAD)
            way_rad = now_rad + of_turn * np.clip(part_of_left * left_rad, -most_rad, most_rad)
            swing_rad = np.where(step < turns, -back * wanted_rad, way_rad)
        else:
            part = np.clip((step - turns) / (stops - turns), 0.0, 1.0)
            swing_rad = (part * of_turn - back) * wanted_rad
        grip_rad = np.where(step < closes, 0.0, np.where(step < turns, 0.06 + 0.03 * (step - closes), tight_rad))
        aim = np.empty((len(observed), N_JOINTS))
        aim[:, 0::2] = scaled(swing_rad, SWING_RAD)[:, None]
        aim[:, 1::2] = scaled(grip_rad, CLOSE_RAD)[:, None]
        return np.clip((aim - targets) / (2.0 * FASTEST), -1.0, 1.0).astype(np.float32)

    return act
