"""From poses of shapes to the output of a gel."""

from typing import Any, NamedTuple

from ._contact import REACH_MM, near
from ._gel import Gel, Network
from ._namespace import Array, broadcast, check_same_library, check_shape, namespace, refuse, times
from ._shapes import Shapes


class Reading(NamedTuple):
    """The output of a gel for given poses: the result of `read`. All numbers are `simulated`."""

    pressure_kpa: Array
    """Pressure at each port, kPa, `[..., n_taxels]`."""
    wrench: Array
    """Force on the gel, N, and torque about the centre of the top of the gel's bounding box, N mm,
    `[..., 6]`.
    """
    gap_mm: Array
    """Distance of each body from the nearest point of the gel's surface, mm, negative inside the
    gel, `[..., n_bodies]`. Its gradient is not 0 where nothing touches, in contrast to that of the
    pressures: it leads a body to the gel.
    """


def read(gel: Gel, shapes: Shapes, position_mm: Array, rotation: Array | None = None) -> Reading:
    """Pressures, force and torque of gels under rigid shapes, as `FastReader.read` computes them,
    for as many sensors as the leading dimensions say.

    The function uses arrays alone. All of them are of one library and stay on their device, and
    gradients may be taken through all results. NaN in the inputs gives NaN in the results.

    Args:
        gel: the result of `load`.
        shapes: shapes of the bodies, `[..., n_bodies]`; their leading dimensions may be fewer, or
            1.
        position_mm: origins of the bodies in the gel's frame, mm, `[..., n_bodies, 3]`. A body that
            is far away touches nothing.
        rotation: matrices from the bodies' frames to the gel's frame, `[..., n_bodies, 3, 3]`;
            upright unless given. `rotation_of` makes them from quaternions.

    Returns:
        Pressures, wrench and gaps.

    Raises:
        Error: for an argument of another shape or library; its `field` names the argument.
    """
    xp = namespace("gel", gel.points_mm)
    shapes, position_mm, rotation = placed(xp, gel, shapes, position_mm, rotation)
    return reading_of(xp, gel, *near(xp, gel, shapes, position_mm, rotation))


def placed(
    xp: Any, gel: Gel, shapes: Shapes, position_mm: Array, rotation: Array | None
) -> tuple[Shapes, Array, Array]:
    """Checked shapes and poses, in the precision of the gel."""
    arrays = {"shapes": shapes.half_mm, "position_mm": position_mm, "rotation": rotation}
    check_same_library(xp, **arrays)
    check_shape("position_mm", position_mm, 3)
    leading = {
        "shapes": tuple(shapes.grown_mm.shape),
        "position_mm": tuple(position_mm.shape[:-1]),
    }
    if not leading["shapes"]:
        expected = "those of a sensor's bodies, [..., n_bodies]: see `stack`"
        raise refuse("shapes", "is one shape", expected)
    precision = gel.points_mm.dtype
    if rotation is None:
        one, no = xp.ones_like(gel.center_mm[0]), xp.zeros_like(gel.center_mm[0])
        rotation = xp.reshape(xp.stack([one, no, no, no, one, no, no, no, one]), (1, 3, 3))
    else:
        check_shape("rotation", rotation, 3, 3)
        leading["rotation"] = tuple(rotation.shape[:-2])
    broadcast(**leading)
    return (
        shapes.as_precise(xp, precision),
        xp.astype(position_mm, precision, copy=False),
        xp.astype(rotation, precision, copy=False),
    )


def reading_of(xp: Any, gel: Gel, share: Array, gap_mm: Array) -> Reading:
    """The output of the networks for the proximity of bodies."""
    pressure_kpa = _touched(xp, gel, share) * _outputs(xp, gel.pressure, share)
    return Reading(pressure_kpa, wrench_of(xp, gel, share), gap_mm)


def wrench_of(xp: Any, gel: Gel, share: Array) -> Array:
    """Force and torque for the proximity of bodies, `[..., 6]`."""
    return _touched(xp, gel, share) * _outputs(xp, gel.wrench, share)


def _touched(xp: Any, gel: Gel, share: Array) -> Array:
    """The degree of contact, 0 to 1, `[..., 1]`. It multiplies the outputs, which would not be
    exactly 0 without contact.
    """
    nearest_mm = REACH_MM * (1.0 - xp.max(share[..., 0], axis=-1))
    near_mm, far_mm = gel.touched_mm[0], gel.touched_mm[1]
    return xp.clip((far_mm - nearest_mm) / (far_mm - near_mm), 0.0, 1.0)[..., None]


def _outputs(xp: Any, network: Network, share: Array) -> Array:
    """The outputs of a network, `[..., n_rows * n_outputs]`."""
    n_points, n_rows = network.near.shape
    share = share[..., :n_points, :]
    leading = tuple(share.shape[:-2])
    features = _silu(xp, times(xp, share, network.point.weight) + network.point.bias)
    features = features - _silu(xp, network.point.bias)
    features = xp.reshape(features, (*leading, -1 if 0 not in leading else network.rows.shape[0]))
    hidden = times(xp, features, network.rows)
    hidden = xp.reshape(hidden, (*leading, *network.bias.shape)) + network.bias
    for weight, bias in network.layers:
        hidden = times(xp, _silu(xp, hidden), weight) + bias
    # A row without a near body gives 0.
    n_near = times(xp, xp.astype(share[..., 0] > 0.0, share.dtype), network.near)
    hidden = xp.where(n_near[..., None] == 0.0, 0.0, hidden)
    return network.unit * xp.reshape(hidden, (*leading, n_rows * hidden.shape[-1]))


def _silu(xp: Any, value: Array) -> Array:
    """The sigmoid linear unit `x / (1 + e⁻ˣ)`, written so that nothing overflows."""
    half = 0.5 * value
    return half + half * xp.tanh(half)
