"""Friction of bodies on gels, from one time step to the next, with the state as arrays.

A gel that sticks resists like an elastic layer on a rigid base under a rigid disc of the contact's
area: with the stiffness `8 G a / (2 - ν) (1 + a / 2 h)` along the surface and `16/3 G a³` about the
vertical (Gazetas, 1991, "Formulas and charts for impedances of surface and embedded foundations").
Force and torque together slip at Coulomb's limit (an ellipsoid: Howe and Cutkosky, 1996). The
results are those of Rust's `Friction` and `Coupling`.
"""

import math
import os
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from .. import FastGel
from ._contact import REACH_MM, share_of_bodies
from ._convert import convert
from ._file import read_file
from ._gel import Gel
from ._namespace import Array, for_rows, namespace, refuse, root
from ._read import Reading, placed, reading_of, wrench_of
from ._shapes import Shapes

_Floats = npt.NDArray[np.float64]

# A point carries a body if it lies inside it by more than this fraction of the largest depth; width
# of the transition, as such a fraction.
CARRYING, CHANGE = 0.38, 0.24
# Smallest thickness of the gel under a body, as a fraction of its undeformed thickness.
THINNEST = 0.4
LEAST_RADIUS_MM = 0.5
# Lever arm of the friction that resists rotation about the contact's middle, as a fraction of the
# contact's radius.
ARM_OF_RADIUS = 0.6
# The table of the pressure at the gel's base under a tangential force: spacing and end of its
# distances, in heights of the gel; step and end of the wave numbers that are summed, in radians per
# height.
STEP, _FURTHEST = 0.02, 5.0
_WAVE_STEP, _SHORTEST_WAVE = 0.05, 25.0
_N_NODES = 256


class Friction(NamedTuple):
    """Friction on a gel, as arrays: the result of `friction`."""

    coefficient: Array
    """Coulomb's coefficient of friction, `[]`."""
    retardation_s: Array
    """Time constant of the gel's damping, s, `[]`: this time multiplied by the rate of the elastic
    force is added to the elastic force.
    """
    shear_modulus_n_per_mm2: Array
    """Shear modulus of the gel at small strain, N/mm², `[]`."""
    poissons_ratio: Array
    """Poisson's ratio of the gel, `[]`."""
    height_mm: Array
    """Height of the gel, mm, `[]`."""
    area_mm2: Array
    """Area of the gel's surface for each point, mm², `[]`."""
    order: Array
    """Numbers of the points of the first grid, from 1, `[n_points]`."""
    way: Array
    """Unit vectors from the points of the first grid to the ports, `[2, n_taxels, n_points]`."""
    away_mm: Array
    """Distances from the points of the first grid to the ports, mm, `[n_taxels, n_points]`."""
    kernel: Array
    """Pressure at the base under a tangential force, at evenly spaced distances, `[n_entries]`."""


class Held(NamedTuple):
    """The state of friction and damping of gels, for each body: the result of `held` and `step`."""

    is_held: Array
    """Whether the gel held the body in the previous step, `[..., n_bodies]`."""
    position_mm: Array
    """Position of the body in the previous step, mm, `[..., n_bodies, 3]`."""
    rotation: Array
    """Rotation of the body in the previous step, `[..., n_bodies, 3, 3]`."""
    force_n: Array
    """Friction force along the surface, N, `[..., n_bodies, 2]`."""
    torque_n_mm: Array
    """Friction torque about the vertical, N mm, `[..., n_bodies]`."""
    is_known: Array
    """Whether there was a previous step, `[..., n_bodies]`."""
    elastic: Array
    """The wrench without damping in the previous step, N and N mm, `[..., n_bodies, 6]`."""
    loss: Array
    """The part of the wrench that damping added, N and N mm, `[..., n_bodies, 6]`."""


class HeldReading(NamedTuple):
    """The output of a gel at a time step, with friction: the result of `step`. All numbers are
    `simulated`.
    """

    pressure_kpa: Array
    """Pressure at each port, kPa, `[..., n_taxels]`."""
    wrench: Array
    """Force on the gel, N, and torque about the centre of the top of the gel's bounding box, N mm,
    `[..., 6]`.
    """
    gap_mm: Array
    """The gap as in `Reading`, mm, `[..., n_bodies]`."""
    wrench_of_bodies: Array
    """The part of each body in the wrench, `[..., n_bodies, 6]`."""
    slip_mm_per_s: Array
    """How fast each body slips over the gel, mm/s, along x and y of the gel, `[..., n_bodies, 2]`: 0
    while it sticks."""


def friction(
    source: FastGel | str | os.PathLike[str] | bytes,
    coefficient: float,
    *,
    retardation_s: float = 0.0,
    like: Array | None = None,
) -> Friction:
    """Friction and damping of a gel, as those of `Coupling`.

    Args:
        source: the surrogate of the gel, as `load` takes it.
        coefficient: Coulomb's coefficient of friction, 0 or more.
        retardation_s: time constant of the gel's damping, s, 0 or more.
        like: an array of the library, precision and device of the result; NumPy in single precision
            unless given.

    Returns:
        The friction, for `step`.

    Raises:
        Error: for a number that is negative or not finite, and for a source that is not a surrogate
            of the gel.
    """
    for field, number in (("coefficient", coefficient), ("retardation_s", retardation_s)):
        if not 0.0 <= number < math.inf:
            raise refuse(field, f"is {number}", "0 or more")
    header = read_file(source).header
    material, grid = header["gel"]["material"], header["layout"]["grids"][0]
    shear_kpa, bulk_kpa = _shear_modulus_kpa(material), header["gel"]["bulk_modulus_kpa"]
    poissons_ratio = (3.0 * bulk_kpa - 2.0 * shear_kpa) / (2.0 * (3.0 * bulk_kpa + shear_kpa))
    row, column = np.divmod(np.arange(len(grid["height_mm"])), grid["n"][0])
    plan_mm = np.stack([column, row]) * grid["spacing_mm"] + np.array(grid["first_mm"])[:, None]
    ports_mm = np.array(header["ports_mm"], np.float64).reshape(-1, 2)
    apart_mm = ports_mm.T[:, :, None] - plan_mm[:, None, :]
    away_mm = np.hypot(*apart_mm)
    found = Friction(
        coefficient=np.array(float(coefficient)),
        retardation_s=np.array(float(retardation_s)),
        shear_modulus_n_per_mm2=np.array(1e-3 * shear_kpa),
        poissons_ratio=np.array(poissons_ratio),
        height_mm=np.array(float(header["layout"]["surroundings"]["height_mm"])),
        area_mm2=np.array(float(grid["spacing_mm"]) ** 2),
        order=1.0 + np.arange(len(row)),
        way=apart_mm / np.where(away_mm > 0.0, away_mm, 1.0),
        away_mm=away_mm,
        kernel=_kernel(poissons_ratio),
    )
    return convert(found, np.zeros(0, np.float32) if like is None else like)


def held(gel: Gel, position_mm: Array) -> Held:
    """The initial state of gels that hold nothing. To let the sensors of chosen worlds release
    their bodies, replace their part of the state by this one with `where`.

    Args:
        gel: the result of `load`.
        position_mm: positions of the bodies, `[..., n_bodies, 3]`; only the shape counts.

    Returns:
        The state, for `step`.
    """
    xp = namespace("gel", gel.points_mm)
    zero = xp.astype(0.0 * position_mm[..., 0], gel.points_mm.dtype)
    none = zero > 1.0

    def zeros(*last: int) -> Array:
        wide = xp.reshape(zero, (*zero.shape, *(1 for _ in last)))
        return xp.broadcast_to(wide, (*zero.shape, *last))

    return Held(none, zeros(3), zeros(3, 3), zeros(2), zero, none, zeros(6), zeros(6))


def step(
    gel: Gel,
    friction: Friction,
    before: Held,
    since_previous_s: Array | float,
    shapes: Shapes,
    position_mm: Array,
    rotation: Array | None = None,
) -> tuple[Held, HeldReading]:
    """One time step of bodies on gels, with friction and damping. A body keeps its index in all
    time steps.

    Args:
        gel: the result of `load`.
        friction: the result of `friction`.
        before: the state after the previous time step; at first the result of `held`.
        since_previous_s: time since the previous time step, s, above 0: one number for all sensors,
            or `[...]`.
        shapes: as in `read`.
        position_mm: as in `read`.
        rotation: as in `read`.

    Returns:
        The new state, and the output of the gels.

    Raises:
        Error: as `read` does.
    """
    xp = namespace("gel", gel.points_mm)
    shapes, position_mm, rotation = placed(xp, gel, shapes, position_mm, rotation)
    near = share_of_bodies(xp, gel, shapes, position_mm, rotation)
    together = reading_of(xp, gel, xp.max(near.share, axis=-3), near.gap_mm)
    apart = _shared(xp, gel, near.share, together)
    zero = xp.zeros_like(near.gap_mm)
    position_mm = position_mm + zero[..., None]
    rotation = rotation + zero[..., None, None]
    foot = _footprint(xp, gel, friction, near.share)
    now, wrench, slip_mm = _hold(xp, gel, friction, before, foot, apart, position_mm, rotation)
    pulls_kpa = _pulled_kpa(xp, friction, foot, now.force_n)
    now, wrench = _lose(xp, friction, before, now, since_previous_s, wrench)
    reading = HeldReading(
        together.pressure_kpa + xp.sum(pulls_kpa, axis=-2),
        xp.sum(wrench, axis=-2),
        near.gap_mm,
        wrench,
        slip_mm / for_rows(since_previous_s),
    )
    return now, reading


class _Footprint(NamedTuple):
    """The area in which the gel carries each body."""

    touches: Array
    part: Array
    """Fraction of its area with which each point carries the body, `[..., n_bodies, n_points]`."""
    area_mm2: Array
    thickness_mm: Array
    """Thickness of the gel that is left under the body, mm."""


def _shared(xp: Any, gel: Gel, share: Array, together: Reading) -> Array:
    """The wrench of all bodies, divided among them in proportion to their wrenches when each
    presses alone.
    """
    if share.shape[-3] == 1:
        return together.wrench[..., None, :]
    apart = wrench_of(xp, gel, share)
    sum_n = xp.sum(apart[..., 2], axis=-1)
    pushes = sum_n < 0.0
    part = xp.where(pushes, together.wrench[..., 2] / xp.where(pushes, sum_n, 1.0), 1.0)
    return apart * part[..., None, None]


def _footprint(xp: Any, gel: Gel, friction: Friction, share: Array) -> _Footprint:
    n_points = friction.away_mm.shape[-1]
    depth = share[..., :n_points, 0] - 1.0
    deepest = xp.max(depth, axis=-1)
    touches = deepest > 0.0
    inside = depth / xp.where(touches, deepest, 1.0)[..., None]
    part = xp.clip((inside - CARRYING) / CHANGE + 0.5, 0.0, 1.0)
    part = xp.where(touches[..., None], part, 0.0)
    # Of points that are equally deep, the last one counts.
    order = friction.order
    last = xp.max(xp.where(depth == deepest[..., None], order, 0.0), axis=-1)
    is_last = order == last[..., None]
    height_mm = xp.sum(xp.where(is_last, gel.points_mm[2, :n_points], 0.0), axis=-1)
    thickness_mm = xp.maximum(height_mm - deepest * REACH_MM, THINNEST * height_mm)
    return _Footprint(touches, part, friction.area_mm2 * xp.sum(part, axis=-1), thickness_mm)


def _hold(
    xp: Any,
    gel: Gel,
    friction: Friction,
    before: Held,
    foot: _Footprint,
    wrench: Array,
    position_mm: Array,
    rotation: Array,
) -> tuple[Held, Array, Array]:
    """The friction, the wrench of each body with it, and how far each body has slipped, mm."""
    holds = foot.touches & (wrench[..., 2] < 0.0)
    down_n = xp.where(holds, wrench[..., 2], -1.0)
    x_mm, y_mm = -wrench[..., 4] / down_n, wrench[..., 3] / down_n
    moved_mm, turned_rad = _moved(xp, gel, before, position_mm, rotation, x_mm, y_mm)
    was_held = before.is_held
    radius_mm = xp.clip(root(xp, foot.area_mm2 / math.pi), LEAST_RADIUS_MM, None)
    modulus = friction.shear_modulus_n_per_mm2
    along = 8.0 * modulus * radius_mm / (2.0 - friction.poissons_ratio)
    along = along * (1.0 + 0.5 * radius_mm / friction.height_mm)
    about = 16.0 / 3.0 * modulus * radius_mm**3
    force_n = [
        xp.where(was_held, before.force_n[..., axis] + along * moved_mm[axis], 0.0)
        for axis in (0, 1)
    ]
    torque_n_mm = xp.where(was_held, before.torque_n_mm + about * turned_rad, 0.0)
    normal_n = root(xp, xp.sum(wrench[..., :3] ** 2, axis=-1))
    limit_n = friction.coefficient * normal_n
    arm_n = torque_n_mm / (ARM_OF_RADIUS * radius_mm)
    needed_n = root(xp, force_n[0] ** 2 + force_n[1] ** 2 + arm_n**2)
    slips = needed_n > limit_n
    kept = xp.where(slips, limit_n / xp.where(slips, needed_n, 1.0), 1.0)
    slipped = xp.where(holds, 1.0 - kept, 0.0) / along
    slip_mm = xp.stack([slipped * part for part in force_n], axis=-1)
    kept = xp.where(holds, kept, 0.0)
    force_n, torque_n_mm = [kept * part for part in force_n], kept * torque_n_mm
    spin_n_mm = x_mm * force_n[1] - y_mm * force_n[0] + torque_n_mm
    none = xp.zeros_like(spin_n_mm)
    added = xp.stack([*force_n, none, none, none, spin_n_mm], axis=-1)
    now = before._replace(
        is_held=holds,
        position_mm=position_mm,
        rotation=rotation,
        force_n=xp.stack(force_n, axis=-1),
        torque_n_mm=torque_n_mm,
    )
    return now, xp.where(foot.touches[..., None], wrench, 0.0) + added, slip_mm


def _moved(
    xp: Any,
    gel: Gel,
    before: Held,
    position_mm: Array,
    rotation: Array,
    x_mm: Array,
    y_mm: Array,
) -> tuple[list[Array], Array]:
    """Displacement along the surface, mm, of the point of a body that is at a location of the
    surface, and rotation of the body about the vertical, radians, since the previous time step.
    """
    place_mm = [gel.center_mm[0] + x_mm, gel.center_mm[1] + y_mm, gel.center_mm[2] + 0.0 * x_mm]
    away_mm = [place_mm[row] - before.position_mm[..., row] for row in range(3)]
    own_mm = [
        sum(before.rotation[..., row, axis] * away_mm[row] for row in range(3)) for axis in range(3)
    ]
    moved_mm = [
        sum(rotation[..., row, axis] * own_mm[axis] for axis in range(3))
        + position_mm[..., row]
        - place_mm[row]
        for row in (0, 1)
    ]
    turn = [
        [
            sum(rotation[..., row, axis] * before.rotation[..., column, axis] for axis in range(3))
            for column in range(3)
        ]
        for row in range(3)
    ]
    # The axis of the rotation, multiplied by twice the sine of the angle, and twice the cosine.
    sines = [turn[2][1] - turn[1][2], turn[0][2] - turn[2][0], turn[1][0] - turn[0][1]]
    sine = root(xp, sines[0] ** 2 + sines[1] ** 2 + sines[2] ** 2)
    cosine = turn[0][0] + turn[1][1] + turn[2][2] - 1.0
    is_turned = sine > 1e-6
    angle = xp.atan2(xp.where(is_turned, sine, 1.0), xp.where(is_turned, cosine, 1.0))
    per_sine = xp.where(is_turned, angle / xp.where(is_turned, sine, 1.0), 0.5)
    return moved_mm, sines[2] * per_sine


def _pulled_kpa(xp: Any, friction: Friction, foot: _Footprint, force_n: Array) -> Array:
    """Pressures at the ports due to friction along the surface, `[..., n_bodies, n_taxels]`: those
    of a layer as high as the gel that is left under the body, with the force spread over all points
    that carry it.
    """
    height_mm = xp.where(foot.touches, foot.thickness_mm, 1.0)
    n_entries = friction.kernel.shape[0]
    entries = friction.away_mm / (STEP * height_mm[..., None, None])
    inside = xp.clip(entries, 0.0, n_entries - 1.001)
    entry = xp.floor(inside)
    number = xp.reshape(xp.astype(entry, xp.int32), (-1,))
    low = xp.reshape(xp.take(friction.kernel, number, axis=0), tuple(entry.shape))
    high = xp.reshape(xp.take(friction.kernel, number + 1, axis=0), tuple(entry.shape))
    felt = low + (inside - entry) * (high - low)
    felt = xp.where(entries < n_entries - 1.0, felt, 0.0)
    along = sum(friction.way[axis] * force_n[..., axis, None, None] for axis in (0, 1))
    part = xp.sum(foot.part, axis=-1)
    scale = 1e3 / (xp.where(foot.touches, part, 1.0) * height_mm**2)  # N/mm² = 1000 kPa
    return scale[..., None] * xp.sum(foot.part[..., None, :] * along * felt, axis=-1)


def _lose(
    xp: Any,
    friction: Friction,
    before: Held,
    now: Held,
    since_previous_s: Array | float,
    wrench: Array,
) -> tuple[Held, Array]:
    """Adds the damping, `t dF/dt`. If the sum would pull at a body, the wrench is 0: a gel does not
    adhere.
    """
    lead = friction.retardation_s / for_rows(since_previous_s)
    loss = xp.where(before.is_known[..., None], lead * (wrench - before.elastic), 0.0)
    lossy = wrench + loss
    known = xp.ones_like(before.torque_n_mm + wrench[..., 2]) > 0.0
    now = now._replace(is_known=known, elastic=wrench, loss=loss)
    return now, xp.where(lossy[..., 2:3] > 0.0, 0.0, lossy)


def _shear_modulus_kpa(material: dict[str, Any]) -> float:
    """The shear modulus of a material model at small strain, kPa."""
    if "shear_modulus_kpa" in material:
        return float(material["shear_modulus_kpa"])
    if "terms" in material:
        return 0.5 * float(sum(term["mu_kpa"] * term["alpha"] for term in material["terms"]))
    return 2.0 * float(material["c10_kpa"] + material.get("c01_kpa", 0.0))


def _kernel(poissons_ratio: float) -> _Floats:
    """Pressure on the base of an elastic layer that is bonded to the base and pulled along its
    surface at a point, over the distance: the sum over all wave numbers (a Hankel transform of the
    first order).
    """
    wave = _WAVE_STEP * np.arange(1, int(_SHORTEST_WAVE / _WAVE_STEP) + 1)
    sinh, cosh = np.sinh(wave), np.cosh(wave)
    compressible = 1.0 - 2.0 * poissons_ratio
    below = (2.0 * (1.0 - poissons_ratio) * cosh) ** 2 + wave**2 - (compressible * sinh) ** 2
    pressure = 2.0 / 3.0 * (1.0 + poissons_ratio) * (compressible * sinh + wave * cosh) / below
    part = pressure * wave * _WAVE_STEP / (2.0 * np.pi)
    distance = STEP * np.arange(int(_FURTHEST / STEP) + 1)
    # The Bessel function of the first order by its integral, whose sum converges quickly.
    angle = np.pi * (np.arange(_N_NODES) + 0.5) / _N_NODES
    found = np.zeros(len(distance))
    for own, amount in zip(wave, part):
        phase = angle[:, None] - own * distance * np.sin(angle)[:, None]
        found += amount * np.cos(phase).mean(axis=0)
    return found
