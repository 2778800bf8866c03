"""Touch in simulators that keep their worlds on a device: one adapter for each simulator. An
adapter reads the poses on the device and adds the forces of the gels to the forces on bodies.

Each adapter is a module that is imported by its name and needs its simulator: `mjx` (MuJoCo XLA),
`mujoco_warp` (MuJoCo Warp), `mjlab`, `newton`, `genesis`, `maniskill` and `isaaclab`. Gel, friction
and shapes are those of `twintac.arrays`; for MuJoCo Warp, mjlab and Newton they are kernels of
Warp. On CPUs, `twintac.mujoco` is faster.
"""
