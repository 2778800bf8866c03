"""Touch in simulators that keep their worlds on a device: an adapter for each, which reads the
poses where they are, and adds what gels do to the forces on bodies.

Each adapter is a module that is imported by its name, and needs its simulator: `mjx` for MuJoCo
XLA, `mujoco_warp` for MuJoCo Warp, `mjlab` for mjlab, `newton` for Newton. Gel, friction and shapes
are those of `twintac.arrays`. On processors, `twintac.mujoco` is faster.
"""
