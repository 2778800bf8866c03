"""Friction of bodies on gels, from one moment to the next, with what it remembers as arrays.

Sticking, a gel resists as an elastic layer on a rigid base does under a rigid disc of the contact's
area, with `8 G a / (2 - ν) (1 + a / 2 h)` along the surface and `16/3 G a³` about the vertical
(Gazetas, 1991, "Formulas and charts for impedances of surface and embedded foundations"); force and
torque together slip at Coulomb's limit (an ellipsoid: Howe and Cutkosky, 1996). It is what Rust's
`Friction` and `Coupling` do.
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
from ._namespace import Array, namespace, refuse, root
from ._read import Reading, placed, reading_of, wrench_of
from ._shapes import Shapes

_Floats = npt.NDArray[np.float64]

# Points that are inside a body by more than this part of the deepest carry it, and how wide the
# change is from those that do not.
_CARRYING, _CHANGE = 0.38, 0.24
# The gel under a body is no thinner than this part of what it was.
_THINNEST = 0.4
_LEAST_RADIUS_MM = 0.5
# Lever arm of friction that turns a contact about its middle, as part of its radius.
_ARM_OF_RADIUS = 0.6
# The table of what a pull does at the gel's base: distance of its entries and its end, in heights;
# step and end of the waves that are summed, in radians over the height.
_STEP, _FURTHEST = 0.02, 5.0
_WAVE_STEP, _SHORTEST_WAVE = 0.05, 25.0
_N_NODES = 256


class Friction(NamedTuple):
    """Friction on a gel, as arrays: what `friction` returns."""

    coefficient: Array
    """Coulomb's, `[]`."""
    retardation_s: Array
    """Time by which the gel's force leads its elastic one, s, `[]`."""
    shear_modulus_n_per_mm2: Array
    poissons_ratio: Array
    height_mm: Array
    """Of the gel, `[]`."""
    area_mm2: Array
    """Of the gel's surface for each point, `[]`."""
    order: Array
    """Numbers of the points of the first grid, 1 and so on, `[n_points]`."""
    way: Array
    """From the points of the first grid to the ports, of length 1, `[2, n_taxels, n_points]`."""
    away_mm: Array
    """How far it is, `[n_taxels, n_points]`."""
    kernel: Array
    """What a pull does at the base at distances that grow evenly, `[n_entries]`."""


class Held(NamedTuple):
    """What gels remember of each body: what `held` and `step` return."""

    is_held: Array
    """Whether it was in touch, `[..., n_bodies]`."""
    position_mm: Array
    """Where it was, `[..., n_bodies, 3]`."""
    rotation: Array
    """`[..., n_bodies, 3, 3]`"""
    force_n: Array
    """What friction holds along the surface, `[..., n_bodies, 2]`, and about the vertical."""
    torque_n_mm: Array
    is_known: Array
    """Whether a moment went before, `[..., n_bodies]`."""
    elastic: Array
    """The wrench without loss a moment before, `[..., n_bodies, 6]`, and what loss added."""
    loss: Array


class HeldReading(NamedTuple):
    """What a gel does at a moment, with friction: what `step` returns."""

    pressure_kpa: Array
    """Pressure at each port, kPa, `[..., n_taxels]`."""
    wrench: Array
    """Force on the gel, N, and torque about the top of its middle, N mm, `[..., 6]`."""
    gap_mm: Array
    """As `Reading` has it, `[..., n_bodies]`."""
    wrench_of_bodies: Array
    """What each body does by itself, `[..., n_bodies, 6]`."""


def friction(
    source: FastGel | str | os.PathLike[str] | bytes,
    coefficient: float,
    *,
    retardation_s: float = 0.0,
    like: Array | None = None,
) -> Friction:
    """Friction with Coulomb's coefficient, 0 or more, on the gel that `load` takes, and the gel's
    loss, as `Coupling` has them.

    Raises `Error` for a number that cannot be.
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
    """Gels that remember nothing, for bodies at poses `[..., n_bodies, 3]`. To let go of the bodies
    of some sensors, put parts of this in the place of theirs, by `where`."""
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
    """One more moment of bodies that gels hold with friction and loss, `since_previous_s` after the
    one before: what gels then remember, and what they do. Each body is the same one in each moment.

    - `before`: what gels remember; at first what `held` returns.
    - `since_previous_s`: one time for all, or `[...]`, s, above 0.
    - The others are those of `read`.

    Raises `Error`, as `read` does.
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
    now, wrench = _hold(xp, gel, friction, before, foot, apart, position_mm, rotation)
    pulls_kpa = _pulled_kpa(xp, friction, foot, now.force_n)
    now, wrench = _lose(xp, friction, before, now, since_previous_s, wrench)
    reading = HeldReading(
        together.pressure_kpa + xp.sum(pulls_kpa, axis=-2),
        xp.sum(wrench, axis=-2),
        near.gap_mm,
        wrench,
    )
    return now, reading


class _Footprint(NamedTuple):
    """Where each body is carried."""

    touches: Array
    part: Array
    """How much of its area each point carries, `[..., n_bodies, n_points]`."""
    area_mm2: Array
    thickness_mm: Array
    """Of the gel that is left under it."""


def _shared(xp: Any, gel: Gel, share: Array, together: Reading) -> Array:
    """The wrench of all bodies, shared among them as each would have it by itself."""
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
    part = xp.clip((inside - _CARRYING) / _CHANGE + 0.5, 0.0, 1.0)
    part = xp.where(touches[..., None], part, 0.0)
    # Of points that are equally deep the last one counts.
    order = friction.order
    last = xp.max(xp.where(depth == deepest[..., None], order, 0.0), axis=-1)
    is_last = order == last[..., None]
    height_mm = xp.sum(xp.where(is_last, gel.points_mm[2, :n_points], 0.0), axis=-1)
    thickness_mm = xp.maximum(height_mm - deepest * REACH_MM, _THINNEST * height_mm)
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
) -> tuple[Held, Array]:
    """What friction holds, and the wrench of each body with it."""
    holds = foot.touches & (wrench[..., 2] < 0.0)
    down_n = xp.where(holds, wrench[..., 2], -1.0)
    x_mm, y_mm = -wrench[..., 4] / down_n, wrench[..., 3] / down_n
    moved_mm, turned_rad = _moved(xp, gel, before, position_mm, rotation, x_mm, y_mm)
    was_held = before.is_held
    radius_mm = xp.clip(root(xp, foot.area_mm2 / math.pi), _LEAST_RADIUS_MM, None)
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
    arm_n = torque_n_mm / (_ARM_OF_RADIUS * radius_mm)
    needed_n = root(xp, force_n[0] ** 2 + force_n[1] ** 2 + arm_n**2)
    slips = needed_n > limit_n
    kept = xp.where(slips, limit_n / xp.where(slips, needed_n, 1.0), 1.0)
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
    return now, xp.where(foot.touches[..., None], wrench, 0.0) + added


def _moved(
    xp: Any,
    gel: Gel,
    before: Held,
    position_mm: Array,
    rotation: Array,
    x_mm: Array,
    y_mm: Array,
) -> tuple[list[Array], Array]:
    """How far a body's point at a place of the surface has moved along it, mm, and how far it has
    turned about the vertical, radians."""
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
    # The turn's axis times twice its sine, and twice its cosine.
    sines = [turn[2][1] - turn[1][2], turn[0][2] - turn[2][0], turn[1][0] - turn[0][1]]
    sine = root(xp, sines[0] ** 2 + sines[1] ** 2 + sines[2] ** 2)
    cosine = turn[0][0] + turn[1][1] + turn[2][2] - 1.0
    is_turned = sine > 1e-6
    angle = xp.atan2(xp.where(is_turned, sine, 1.0), xp.where(is_turned, cosine, 1.0))
    per_sine = xp.where(is_turned, angle / xp.where(is_turned, sine, 1.0), 0.5)
    return moved_mm, sines[2] * per_sine


def _pulled_kpa(xp: Any, friction: Friction, foot: _Footprint, force_n: Array) -> Array:
    """What pulls along the surface do at the ports, `[..., n_bodies, n_taxels]`: that of a layer as
    high as the gel that is left, pulled at all places that carry the body."""
    height_mm = xp.where(foot.touches, foot.thickness_mm, 1.0)
    n_entries = friction.kernel.shape[0]
    entries = friction.away_mm / (_STEP * height_mm[..., None, None])
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
    """Adds the gel's loss, `t dF/dt`: a gel does not pull at what leaves it."""
    lead = friction.retardation_s / since_previous_s
    lead = lead[..., None, None] if len(getattr(lead, "shape", ())) else lead
    loss = xp.where(before.is_known[..., None], lead * (wrench - before.elastic), 0.0)
    lossy = wrench + loss
    known = xp.ones_like(before.torque_n_mm + wrench[..., 2]) > 0.0
    now = now._replace(is_known=known, elastic=wrench, loss=loss)
    return now, xp.where(lossy[..., 2:3] > 0.0, 0.0, lossy)


def _shear_modulus_kpa(material: dict[str, Any]) -> float:
    """Of each model at small strain."""
    if "shear_modulus_kpa" in material:
        return float(material["shear_modulus_kpa"])
    if "terms" in material:
        return 0.5 * float(sum(term["mu_kpa"] * term["alpha"] for term in material["terms"]))
    return 2.0 * float(material["c10_kpa"] + material.get("c01_kpa", 0.0))


def _kernel(poissons_ratio: float) -> _Floats:
    """Pressure on the base of an elastic layer that is bonded to it and pulled along its surface at
    a point, over the distance: the sum of all waves (a Hankel transform of the first order)."""
    wave = _WAVE_STEP * np.arange(1, int(_SHORTEST_WAVE / _WAVE_STEP) + 1)
    sinh, cosh = np.sinh(wave), np.cosh(wave)
    compressible = 1.0 - 2.0 * poissons_ratio
    below = (2.0 * (1.0 - poissons_ratio) * cosh) ** 2 + wave**2 - (compressible * sinh) ** 2
    pressure = 2.0 / 3.0 * (1.0 + poissons_ratio) * (compressible * sinh + wave * cosh) / below
    part = pressure * wave * _WAVE_STEP / (2.0 * np.pi)
    distance = _STEP * np.arange(int(_FURTHEST / _STEP) + 1)
    # The Bessel function of the first order by its integral, whose sum converges at once.
    angle = np.pi * (np.arange(_N_NODES) + 0.5) / _N_NODES
    found = np.zeros(len(distance))
    for own, amount in zip(wave, part):
        phase = angle[:, None] - own * distance * np.sin(angle)[:, None]
        found += amount * np.cos(phase).mean(axis=0)
    return found
