"""Touch in simulators that keep their worlds on a device: one adapter for each simulator. An
adapter reads the poses on the device and adds the forces of the gels to the forces on bodies.

Each adapter is a module that is imported by its name and needs its simulator: `mjx` for MuJoCo XLA,
`mujoco_warp` for MuJoCo Warp, `mjlab` for mjlab, `newton` for Newton, and others. Gel, friction and
shapes are those of `twintac.arrays`, `_warp` has them as kernels. On CPUs, `twintac.mujoco` is
faster.
"""
