"""Touch in Genesis, with PyTorch on the device of its scene. It needs `genesis-world`.

    sensors = Sensors(scene, [hand.get_link("palm")], geoms=block.geoms)  # after scene.build
    touch = sensors.push()  # adds the forces of the gels to the next step
    scene.step()
"""

import os
from collections.abc import Sequence
from typing import Any

import genesis as gs
import numpy as np
import torch

from .. import FastGel, Shape, arrays
from ..arrays._shapes import from_samples
from ._gels import Gels, local_pose, placed, rotation_of
from ._moment import Memory, Poses, Touch
from ._scene import Places
from ._scene import scene as scene_of
from ._shapes import primitive

__all__ = ["Memory", "Sensors", "Touch"]

_COM = gs.link_ref_frame.link_COM


class Sensors(Gels):
    """Sensors on links of rigid entities, in all environments of a scene that is built.

    Geoms that touch gels should not collide with the sensor's link (`contype` and `conaffinity` of
    their morphs): the link would carry them instead of the gel. With steps of 2 ms or less, bodies
    of 20 g and more stay at rest on a gel. The forces of the gels are the same in all substeps of a
    step.

    Args:
        scene: the scene.
        links: the links that carry the sensors.
        geoms: the geoms that can touch. Geoms of the sensor's own link never touch it.
        position_mm: position of the gel's frame in the frame of each link, mm.
        quaternion: orientation of the gel's frame, z out of the board, in the frame of each link,
            `(x, y, z, w)`.
        gel: the surrogate of the gel, as `arrays.load` takes it; PhysTac's unless given.
        friction: Coulomb's coefficient of every body on every gel.
        retardation_s: time constant of the gel's damping, s, see `twintac.Coupling`.

    Raises:
        ValueError: if there is no link or no geom, if nothing moves, and for geoms of unsupported
            types.
    """

    def __init__(
        self,
        scene: gs.Scene,
        links: Sequence[Any],
        *,
        geoms: Sequence[Any],
        position_mm: tuple[float, float, float] = (0.0, 0.0, 0.0),
        quaternion: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 1.0),
        gel: FastGel | str | os.PathLike[str] | bytes | None = None,
        friction: float = 0.8,
        retardation_s: float = 0.005,
    ) -> None:
        self._solver = scene.rigid_solver
        self._dt = float(scene.dt)
        in_order = {link.idx: link for link in [*links, *(geom.link for geom in geoms)]}
        self._links, numbers = list(in_order), {idx: n for n, idx in enumerate(in_order)}
        places = Places(
            site=np.arange(len(links)),
            geom=np.arange(len(geoms)),
            body_of_sensor=np.array([numbers[link.idx] for link in links], int),
            body_of_geom=np.array([numbers[geom.link.idx] for geom in geoms], int),
            moves=np.array([not link.is_fixed for link in in_order.values()], bool),
            part_of=np.arange(len(in_order)),
        )
        felt = [_shape(geom) for geom in geoms]
        like = self._solver.get_links_pos()
        found = scene_of(places, felt, gel, friction, retardation_s, like)
        self._site = [link.idx for link in links]
        self._geom = [geom.idx for geom in geoms]
        self._local = local_pose(position_mm, quaternion, like)
        self._begin(found, self._poses())

    def push(self, dt: float | None = None) -> Touch:
        """Reads the sensors, and adds the forces of the gels on links to the next `scene.step`. Call
        it once before each step.

        Args:
            dt: time since the last call, s; the time step of the scene unless given.

        Returns:
            The output of the sensors, `[n_envs, ...]`; one environment if the scene has no batch.
        """
        with torch.no_grad():
            touch = self._step(self._poses(), self._dt if dt is None else dt)
            push = touch.push if self._solver.n_envs else touch.push[0]
            links = [self._links[number] for number in self.scene.body.tolist()]
            self._solver.apply_links_external_wrench(push[..., :3], push[..., 3:], links, ref=_COM)
        return touch

    def _poses(self) -> Poses:
        solver = self._solver

        def rows(value: torch.Tensor) -> torch.Tensor:
            return value if solver.n_envs else value[None]

        link_m, link_turn = (
            rows(solver.get_links_pos(self._site)),
            rotation_of(rows(solver.get_links_quat(self._site))),
        )
        return Poses(
            *placed(link_m, link_turn, *self._local),
            rows(solver.get_geoms_pos(self._geom)),
            rotation_of(rows(solver.get_geoms_quat(self._geom))),
            rows(solver.get_links_pos(self._links, ref=_COM)),
        )


def _shape(geom: Any) -> arrays.Shapes:
    """The shape of a geom, with the geom's origin."""
    kind = geom.type
    if kind in (gs.GEOM_TYPE.MESH, gs.GEOM_TYPE.TERRAIN):
        corners_mm = 1e3 * np.asarray(geom.init_verts, float)
        return from_samples(Shape.surface(corners_mm, np.asarray(geom.init_faces).reshape(-1, 3)))
    half_m = np.asarray(geom.data, float)
    if kind == gs.GEOM_TYPE.BOX:
        half_m = 0.5 * half_m
    elif kind in (gs.GEOM_TYPE.CYLINDER, gs.GEOM_TYPE.CAPSULE):
        half_m = np.array([half_m[0], 0.5 * half_m[1]])
    elif kind == gs.GEOM_TYPE.PLANE and not np.allclose(half_m[:3], (0.0, 0.0, 1.0)):
        raise ValueError(f"a plane with the normal {half_m[:3]}: sensors feel planes with the normal z")
    shape = primitive(kind.name, half_m)
    if shape is None:
        raise ValueError(f"a geom of `{geom.link.name}` is a {kind.name}, which sensors do not feel")
    return shape
