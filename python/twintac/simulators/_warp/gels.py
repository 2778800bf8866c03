"""One time step of all sensors of all worlds as launches of kernels, as `_moment` computes it."""

import os
from typing import Any

import torch
import warp as wp

from ... import FastGel
from ...arrays._file import read_file
from ...arrays._gel import grids_of
from .. import _moment, _scene
from . import friction, near, thin
from .columns import ThinBodies
from .distance import bodies
from .network import Network

wp.set_module_options({"enable_backward": False})


class WarpGels:
    """The gels of all worlds on a device. All memory is reserved here, so that the launches can be
    captured in a graph.

    Args:
        scene: the scene, of NumPy.
        gel: the surrogate of the gel, from which the scene was made.
        n_worlds: number of worlds.
        device: the device.
    """

    def __init__(
        self,
        scene: _scene.Scene,
        gel: FastGel | str | os.PathLike[str] | bytes | None,
        n_worlds: int,
        device: Any,
    ) -> None:
        def on_device(values: Any, kind: Any) -> Any:
            return wp.array(values, dtype=kind, device=device)

        def zeros(kind: Any, *shape: int) -> Any:
            return wp.zeros(shape, dtype=kind, device=device)

        source = FastGel.phystac() if gel is None else gel
        grids = grids_of(read_file(source).header)
        n_sensors, n_geoms = scene.can_touch.shape
        n_points = scene.gel.points_mm.shape[1]
        self._pairs = pairs = (n_worlds, n_sensors, n_geoms)
        self._n_points, self._device = n_points, device
        self._site, self._geom = on_device(scene.site, int), on_device(scene.geom, int)
        self._can_touch = on_device(scene.can_touch, bool)
        self._body = on_device(scene.body, int)
        self._body_of_geom = on_device(scene.body_of_geom, int)
        self._body_of_sensor = on_device(scene.body_of_sensor, int)
        self._points, self._bodies = near.points(scene.gel, device), bodies(scene.shapes, device)
        self._touched_mm = [float(gap_mm) for gap_mm in scene.gel.touched_mm]
        self._faces = thin.faces(scene.shapes, device)
        shape = (*pairs, n_points)
        self._thin = ThinBodies(self._faces, grids, shape, device)
        self._layer = friction.layer(scene.gel, scene.friction, device)
        self._position_mm, self._rotation = zeros(wp.vec3, *pairs), zeros(wp.mat33, *pairs)
        self._share = zeros(wp.vec3, *shape)
        self._touched_apart = zeros(float, *pairs)
        # One body alone is all bodies together.
        is_one = n_geoms == 1
        self._together = self._share if is_one else zeros(wp.vec3, n_worlds, n_sensors, 1, n_points)
        self._touched = self._touched_apart if is_one else zeros(float, n_worlds, n_sensors, 1)
        self._pressure = Network(scene.gel.pressure, self._together.shape, device)
        self._wrench = Network(scene.gel.wrench, self._together.shape, device)
        self._apart = self._wrench if is_one else Network(scene.gel.wrench, self._share.shape, device)
        self._foot = friction.foot(pairs, device)
        self._before, self._now = friction.held(pairs, device), friction.held(pairs, device)
        self._turn = zeros(int, n_worlds)
        self._passed_s = wp.ones(n_worlds, dtype=float, device=device)
        self.time_s = zeros(float, n_worlds)
        """The simulator's time of the last `launch`, if it is told, s, `[n_worlds]`."""
        self._wrench_of_bodies = zeros(wp.spatial_vector, *pairs)
        self._sum = zeros(wp.spatial_vector, n_worlds, n_sensors)
        self._gap_mm, self._slip_mm_per_s = zeros(float, *pairs), zeros(wp.vec2, *pairs)
        self._broken = zeros(float, *pairs)
        n_taxels = scene.gel.ports_mm.shape[0]
        self._pressure_kpa = zeros(float, n_worlds, n_sensors, n_taxels)
        self.push = zeros(wp.spatial_vector, n_worlds, len(scene.body))
        """Force and torque on each body of `Scene.body`, as in `Touch.push`, `[n_worlds, n_bodies]`."""

    def begin(self, time_s: Any) -> None:
        """Starts with gels that nothing has touched, at the simulator's time, `[n_worlds]`."""
        wp.launch(_begin, self._pairs[:1], [time_s], [self.time_s, self._passed_s], device=self._device)

    def tell_time(self, time_s: Any) -> None:
        """The simulator's time of the next `launch`, s, `[n_worlds]`. The same time again replaces
        the last time step; where time has gone back, the gels start anew.
        """
        outputs = [self.time_s, self._passed_s, self._turn]
        self._launch(friction.tell_time, self._pairs[:1], [time_s], outputs)

    def pass_time(self, step_s: float) -> None:
        """Time between the last `launch` and the next, s; 0 replaces the last time step."""
        outputs = [self._passed_s, self._turn]
        self._launch(friction.pass_time, self._pairs[:1], [step_s], outputs)

    def forget(self, worlds: torch.Tensor | slice | None = None) -> None:
        """Resets the gels of these worlds, indices or a mask; of all worlds unless given."""
        chosen = torch.zeros(self._pairs[0], dtype=torch.bool, device=wp.device_to_torch(self._device))
        chosen[slice(None) if worlds is None else worlds] = True
        self._launch(
            friction.forget, self._pairs, [wp.from_torch(chosen)], [self._before, self._now]
        )

    def launch(self, poses: _moment.Poses) -> None:
        """The new state and the output of the gels at poses, arrays of `wp.vec3` and `wp.mat33`,
        `[n_worlds, n]`.
        """
        pairs, n_worlds, n_sensors = self._pairs, self._pairs[0], self._pairs[1]
        self._launch(
            near.place,
            pairs,
            [self._site, self._geom, *poses[:4], self._can_touch],
            [self._position_mm, self._rotation, self._gap_mm, self._broken],
        )
        placed = [self._bodies, self._can_touch, self._position_mm, self._rotation]
        self._launch(
            near.approach,
            (*pairs, self._n_points),
            [self._points, self._faces, *placed],
            [self._share, self._gap_mm],
        )
        self._thin.launch(self._points, placed, self._share, self._gap_mm)
        self._see_touch(self._share, self._touched_apart)
        if self._together is not self._share:
            every_point = (n_worlds, n_sensors, self._n_points)
            self._launch(near.join, every_point, [self._share], [self._together])
            self._see_touch(self._together, self._touched)
            self._apart.launch(self._share, self._touched_apart)
        self._pressure.launch(self._together, self._touched)
        self._wrench.launch(self._together, self._touched)
        self._launch(friction.step_on, pairs, [self._layer, self._share], [self._foot])
        self._launch(
            friction.hold,
            pairs,
            [
                self._layer,
                self._foot,
                self._turn,
                self._passed_s,
                self._position_mm,
                self._rotation,
                self._wrench.output,
                self._apart.output,
                self._broken,
            ],
            [
                self._before,
                self._now,
                self._wrench_of_bodies,
                self._slip_mm_per_s,
                self._gap_mm,
            ],
        )
        self._launch(
            friction.pull,
            self._pressure_kpa.shape,
            [
                self._layer,
                self._foot,
                self._share,
                self._now,
                self._pressure.output,
                self._broken,
            ],
            [self._pressure_kpa],
        )
        self._launch(_add_up, pairs[:2], [self._wrench_of_bodies], [self._sum])
        self._launch(
            _push,
            self.push.shape,
            [
                self._body,
                self._body_of_geom,
                self._body_of_sensor,
                self._can_touch,
                self._site,
                poses.site_m,
                poses.site_rotation,
                poses.middle_m,
                self._layer.center_mm,
                self._wrench_of_bodies,
            ],
            [self.push],
        )

    def touch(self) -> _moment.Touch:
        """The output as tensors that share their memory with the gels: each launch changes them."""
        found = (
            self._pressure_kpa,
            self._sum,
            self._gap_mm,
            self._slip_mm_per_s,
            self.push,
        )
        return _moment.Touch(*map(wp.to_torch, found))

    def _see_touch(self, share: Any, touched: Any) -> None:
        self._launch(near.touch, touched.shape, [share, *self._touched_mm], [touched])

    def _launch(self, kernel: Any, shape: tuple[int, ...], inputs: list[Any], outputs: list[Any]) -> None:
        wp.launch(kernel, shape, inputs, outputs, device=self._device)


@wp.kernel
def _begin(now_s: wp.array[float], time_s: wp.array[float], passed_s: wp.array[float]) -> None:
    w = wp.tid()
    # No time has passed yet, so the first time step follows an empty state.
    time_s[w] = now_s[w] - 1.0
    passed_s[w] = 1.0


@wp.kernel
def _add_up(wrench: wp.array3d[wp.spatial_vector], total: wp.array2d[wp.spatial_vector]) -> None:
    w, s = wp.tid()
    found = wp.spatial_vector()
    for g in range(wrench.shape[2]):
        found += wrench[w, s, g]
    total[w, s] = found


@wp.kernel
def _push(
    body: wp.array[int],
    body_of_geom: wp.array[int],
    body_of_sensor: wp.array[int],
    can_touch: wp.array2d[bool],
    site: wp.array[int],
    site_m: wp.array2d[wp.vec3],
    site_rotation: wp.array2d[wp.mat33],
    middle_m: wp.array2d[wp.vec3],
    center_mm: wp.vec3,
    wrench: wp.array3d[wp.spatial_vector],
    push: wp.array2d[wp.spatial_vector],
) -> None:
    """The forces, N, and torques, N m, of the gels on each body, along the axes of the world."""
    w, b = wp.tid()
    force_n, torque_n_m = wp.vec3(0.0, 0.0, 0.0), wp.vec3(0.0, 0.0, 0.0)
    at_m = middle_m[w, body[b]]
    for s in range(wrench.shape[1]):
        turn = site_rotation[w, site[s]]
        lever_m = site_m[w, site[s]] + 0.001 * (turn * center_mm) - at_m
        for g in range(wrench.shape[2]):
            sign = float(0.0)
            if body_of_sensor[s] == body[b]:
                sign = 1.0
            if body_of_geom[g] == body[b]:
                sign -= 1.0
            if can_touch[s, g] and sign != 0.0:
                own = sign * wrench[w, s, g]
                part_n = turn * wp.vec3(own[0], own[1], own[2])
                force_n += part_n
                torque_n_m += 0.001 * (turn * wp.vec3(own[3], own[4], own[5]))
                torque_n_m += wp.cross(lever_m, part_n)
    push[w, b] = wp.spatial_vector(
        force_n[0], force_n[1], force_n[2], torque_n_m[0], torque_n_m[1], torque_n_m[2]
    )
