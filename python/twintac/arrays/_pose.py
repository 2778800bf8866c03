"""Conversions of the poses that simulators have."""

from typing import Any

from ._namespace import Array, check_same_library, namespace, refuse


def rotation_of(quaternion: Array, *, is_scalar_first: bool = False) -> Array:
    """Rotation matrices of quaternions.

    Args:
        quaternion: quaternions `[..., 4]`, of any length but 0: `(x, y, z, w)`, as in Warp, Newton
            and this package.
        is_scalar_first: if true, quaternions are `(w, x, y, z)`, as in MuJoCo, Isaac Lab, ManiSkill
            and Genesis.

    Returns:
        Matrices `[..., 3, 3]`.

    Raises:
        Error: for another shape.
    """
    xp = namespace("quaternion", quaternion)
    if tuple(quaternion.shape[-1:]) != (4,):
        raise refuse("quaternion", f"has the shape {list(quaternion.shape)}", "[..., 4]")
    order = (1, 2, 3, 0) if is_scalar_first else (0, 1, 2, 3)
    x, y, z, w = (quaternion[..., place] for place in order)
    s = 2.0 / (x * x + y * y + z * z + w * w)
    rows = [
        [1.0 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w)],
        [s * (x * y + z * w), 1.0 - s * (x * x + z * z), s * (y * z - x * w)],
        [s * (x * z - y * w), s * (y * z + x * w), 1.0 - s * (x * x + y * y)],
    ]
    return xp.stack([xp.stack(row, axis=-1) for row in rows], axis=-2)


def gel_from_body(
    gel_position_m: Array, gel_rotation: Array, body_position_m: Array, body_rotation: Array
) -> tuple[Array, Array]:
    """Poses of bodies in the frames of gels, as `read` takes them, from poses in the world.

    Positions are subtracted before they are scaled to mm. With many worlds side by side, the
    precision is then limited only by the distance to the world's origin.

    Args:
        gel_position_m: positions of the gels, m, `[..., 3]`.
        gel_rotation: rotation matrices of the gels, `[..., 3, 3]`.
        body_position_m: positions of the bodies, m, `[..., n_bodies, 3]`.
        body_rotation: rotation matrices of the bodies, `[..., n_bodies, 3, 3]`.

    Returns:
        Positions, mm, `[..., n_bodies, 3]`, and rotation matrices `[..., n_bodies, 3, 3]`.

    Raises:
        Error: for arrays of several libraries.
    """
    xp: Any = namespace("gel_position_m", gel_position_m)
    check_same_library(
        xp, gel_rotation=gel_rotation, body_position_m=body_position_m, body_rotation=body_rotation
    )
    away_mm = 1e3 * (body_position_m - gel_position_m[..., None, :])
    turn = [[gel_rotation[..., row, axis][..., None] for row in range(3)] for axis in range(3)]
    position_mm = [sum(axis[row] * away_mm[..., row] for row in range(3)) for axis in turn]
    rotation = [
        sum(axis[row][..., None] * body_rotation[..., row, :] for row in range(3)) for axis in turn
    ]
    return xp.stack(position_mm, axis=-1), xp.stack(rotation, axis=-2)
