"""Tests of sensors in simulators on devices: in each of them, a block rests on a palm with its
weight, and the readings are those of `twintac.mujoco`.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

mujoco = pytest.importorskip("mujoco", reason="MuJoCo 4 needs Python 3.11 or later")

from twintac import Sensor  # noqa: E402
from twintac.mujoco import TouchSensors, add_sensor  # noqa: E402
from twintac.simulators._moment import Memory, Poses, Touch, begin, moment  # noqa: E402
from twintac.simulators._mujoco import scene_of  # noqa: E402
from twintac.simulators._scene import Scene  # noqa: E402

Array = npt.NDArray[np.float64]
N_WORLDS, N_STEPS = 16, 600
MASS_KG = 0.1
WEIGHT_N = 9.81 * MASS_KG
PALM = f"""
<mujoco><option timestep="0.001"/><worldbody>
  <body name="palm" pos="0.3 -0.2 0.1" euler="0 0 30"/>
  <body name="block" pos="0.3 -0.2 0.1181"><freejoint/>
    <geom name="block" type="box" size="0.006 0.006 0.01" mass="{MASS_KG}" contype="0" conaffinity="0"/></body>
</worldbody></mujoco>"""

AT_THE_ORIGIN = PALM.replace('pos="0.3 -0.2 0.1" euler="0 0 30"', "").replace("0.3 -0.2 0.1181", "0 0 0.0181")


def palm(xml: str = PALM) -> Any:
    spec = mujoco.MjSpec.from_string(xml)
    add_sensor(spec, Sensor.phystac(), body="palm", name="touch")
    return spec.compile()


def poses_of(worlds: list[Any]) -> Poses:
    def rows(name: str, *shape: int) -> Array:
        return np.stack([np.asarray(getattr(data, name)).reshape(-1, *shape) for data in worlds])

    return Poses(rows("site_xpos", 3), rows("site_xmat", 3, 3), rows("geom_xpos", 3), rows("geom_xmat", 3, 3), rows("xipos", 3))


def stepped(model: Any, found: Scene, n_steps: int, start: Callable[[Any, int], None] = lambda data, world: None, n_worlds: int = 1) -> tuple[list[Any], Touch]:
    """Worlds of MuJoCo, with the forces of `moment`."""
    worlds = [mujoco.MjData(model) for _ in range(n_worlds)]
    for world, data in enumerate(worlds):
        start(data, world)
        mujoco.mj_step1(model, data)
    memory: Memory | None = None
    for _ in range(n_steps):
        poses, time_s = poses_of(worlds), np.array([data.time for data in worlds])
        memory, touch = moment(found, memory or begin(found, poses, time_s), poses, time_s)
        for data, push in zip(worlds, touch.push):
            data.xfrc_applied[found.body] = push
            mujoco.mj_step2(model, data)
            mujoco.mj_step1(model, data)
    return worlds, touch


def beside(model: Any, n_steps: int) -> tuple[Array, Array]:
    """The readings and forces of `twintac.mujoco`."""
    data = mujoco.MjData(model)
    touch = TouchSensors(model, ["touch"], geoms=["block"])
    for _ in range(n_steps):
        mujoco.mj_step1(model, data)
        touch.update(data)
        mujoco.mj_step2(model, data)
    return touch.readings_kpa[0, 0], touch.wrench[0, 0]


def is_at_rest(pressure_kpa: Any, wrench: Any, expected: tuple[Array, Array]) -> None:
    """Checks that all worlds carry the block's weight, and that readings agree with those of
    `twintac.mujoco` within 1 %.
    """
    pressure_kpa, wrench = np.asarray(pressure_kpa), np.asarray(wrench)
    assert wrench.shape == (N_WORLDS, 1, 6)
    assert -wrench[:, 0, 2] == pytest.approx(np.full(N_WORLDS, WEIGHT_N), rel=0.01)
    largest_kpa = float(expected[0].max())
    assert pressure_kpa[:, 0] == pytest.approx(np.tile(expected[0], (N_WORLDS, 1)), abs=0.01 * largest_kpa)
    assert wrench[:, 0] == pytest.approx(np.tile(expected[1], (N_WORLDS, 1)), abs=0.02 * WEIGHT_N)


def test_blocks_rest_on_palms_by_numpy() -> None:
    model = palm()
    found = scene_of(model, ["touch"], geoms=["block"])
    worlds, touch = stepped(model, found, N_STEPS, n_worlds=N_WORLDS)
    is_at_rest(touch.pressure_kpa, touch.wrench, beside(model, N_STEPS))
    assert all(abs(data.qvel).max() < 0.01 for data in worlds)


def test_blocks_rest_on_palms_in_mjx() -> None:
    pytest.importorskip("mujoco.mjx", reason="needs `pip install mujoco-mjx`")
    import jax
    from mujoco import mjx

    from twintac.simulators import mjx as touch_in_mjx

    model = palm()
    on_device = mjx.put_model(model)
    sensors = touch_in_mjx.put(model, ["touch"], geoms=["block"])
    step = jax.jit(jax.vmap(sensors.step, in_axes=(None, 0, 0)))
    data = jax.vmap(lambda _: mjx.make_data(on_device))(jax.numpy.zeros(N_WORLDS))
    memory = jax.vmap(sensors.begin, in_axes=(None, 0))(on_device, data)
    for _ in range(N_STEPS):
        data, memory, touch = step(on_device, data, memory)
    is_at_rest(touch.pressure_kpa, touch.wrench, beside(model, N_STEPS))
    assert float(abs(data.xfrc_applied).max()) == 0.0
    look = jax.jit(jax.vmap(sensors.look, in_axes=(None, 0, 0)))
    memory, one = look(on_device, data, memory)
    _, again = look(on_device, data, memory)
    assert (np.asarray(one.wrench) == np.asarray(again.wrench)).all()


def test_blocks_rest_on_palms_in_mujoco_warp() -> None:
    pytest.importorskip("mujoco_warp", reason="needs `pip install mujoco-warp torch`; its kernels take a minute to compile")
    import mujoco_warp

    from twintac.simulators.mujoco_warp import Sensors

    model = palm()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    on_device, worlds = mujoco_warp.put_model(model), mujoco_warp.put_data(model, data, nworld=N_WORLDS)
    sensors = Sensors(model, worlds, ["touch"], geoms=["block"])
    on_device.callback.control = sensors
    for _ in range(N_STEPS):
        mujoco_warp.step(on_device, worlds)
    is_at_rest(sensors.touch.pressure_kpa, sensors.touch.wrench, beside(model, N_STEPS))
    before = sensors.touch.wrench.clone()
    mujoco_warp.forward(on_device, worlds)
    mujoco_warp.forward(on_device, worlds)
    assert (sensors.touch.wrench - before).abs().max() < 0.02 * WEIGHT_N
    sensors.applied[:, model.body("block").id, 2] = 1.0
    mujoco_warp.forward(on_device, worlds)
    pushed_n = worlds.xfrc_applied.numpy()[:, model.body("block").id, 2]
    assert pushed_n == pytest.approx(np.full(N_WORLDS, 1.0 + WEIGHT_N), rel=0.02)


def in_mjlab() -> tuple[Any, Any]:
    """Simulation and scene with a block on a palm."""
    pytest.importorskip("mjlab", reason="needs `pip install mjlab`, which brings MuJoCo 3; kernels take a minute to compile")
    from mjlab.entity import EntityCfg
    from mjlab.scene import Scene as MjlabScene
    from mjlab.scene import SceneCfg
    from mjlab.sim import MujocoCfg, Simulation, SimulationCfg

    from twintac.simulators.mjlab import TouchSensorCfg

    def hand() -> Any:
        return mujoco.MjSpec.from_string('<mujoco><worldbody><body name="palm"><geom name="board" type="box" size=".01 .01 .001" pos="0 0 -.01" contype="0" conaffinity="0"/></body></worldbody></mujoco>')

    def block() -> Any:
        return mujoco.MjSpec.from_string(f'<mujoco><worldbody><body name="block" pos="0 0 .0181"><freejoint/><geom name="block" type="box" size="0.006 0.006 0.01" mass="{MASS_KG}" contype="0" conaffinity="0"/></body></worldbody></mujoco>')

    start = EntityCfg.InitialStateCfg(pos=(0.0, 0.0, 0.0181), joint_pos={}, joint_vel={})
    entities = {"hand": EntityCfg(spec_fn=hand, init_state=EntityCfg.InitialStateCfg(joint_pos={}, joint_vel={})), "block": EntityCfg(spec_fn=block, init_state=start)}
    touch = TouchSensorCfg("touch", bodies=("hand/palm",), geoms=("block/block",))
    scene_there = MjlabScene(SceneCfg(num_envs=N_WORLDS, entities=entities, sensors=(touch,)), "cpu")
    model = scene_there.compile()
    simulation = Simulation(num_envs=N_WORLDS, cfg=SimulationCfg(mujoco=MujocoCfg(timestep=0.001)), model=model, device="cpu")
    scene_there.initialize(simulation.mj_model, simulation.model, simulation.data)
    scene_there.reset()
    return simulation, scene_there


def test_blocks_rest_on_palms_in_mjlab() -> None:
    simulation, scene_there = in_mjlab()
    import torch

    for _ in range(N_STEPS):
        scene_there.write_data_to_sim()
        simulation.step()
        scene_there.update(0.001)
    felt = scene_there["touch"].data
    is_at_rest(felt.pressure_kpa, felt.wrench, beside(palm(AT_THE_ORIGIN), N_STEPS))
    scene_there.reset(torch.tensor([3]))
    is_known = scene_there["touch"].sensors._gels._now.is_known.numpy()
    assert not is_known[3].any() and is_known[2].all()


def test_steps_of_mjlab_that_were_captured_without_the_sensors_are_refused() -> None:
    simulation, scene_there = in_mjlab()
    simulation.model.struct.callback.control = None
    assert scene_there["touch"].data.pressure_kpa.shape == (N_WORLDS, 1, 8)
    for _ in range(2):
        simulation.step()
        scene_there.update(0.001)
    with pytest.raises(RuntimeError, match=r"call `env\.sim\.create_graph\(\)`"):
        scene_there["touch"].data


def test_blocks_rest_on_palms_in_newton() -> None:
    pytest.importorskip("newton", reason="needs `pip install 'newton[sim]' torch`, which brings MuJoCo 3; kernels take a minute to compile")
    import newton
    import warp

    from twintac.simulators.newton import Sensors

    def at(z_m: float) -> Any:
        return warp.transform((0.0, 0.0, z_m), warp.quat_identity())

    world = newton.ModelBuilder()
    block = world.add_body(xform=at(0.0181), label="block")
    of_weight = newton.ModelBuilder.ShapeConfig(density=MASS_KG / (0.012 * 0.012 * 0.02), has_shape_collision=False)
    world.add_shape_box(block, hx=0.006, hy=0.006, hz=0.01, cfg=of_weight, label="block")
    board = world.add_body(xform=at(-0.5), label="board", is_kinematic=True)
    world.add_site(board, xform=at(0.5), label="touch")
    builder = newton.ModelBuilder()
    builder.replicate(world, N_WORLDS)
    model = builder.finalize(device="cpu")
    sensors = Sensors(model, ["touch"], shapes=["block"])
    before, after = model.state(), model.state()
    newton.eval_fk(model, model.joint_q, model.joint_qd, before)
    solver, control = newton.solvers.SolverMuJoCo(model), model.control()
    for _ in range(N_STEPS):
        before.clear_forces()
        touch = sensors.push(before, 0.001)
        solver.step(before, after, control, None, 0.001)
        before, after = after, before
    is_at_rest(touch.pressure_kpa, touch.wrench, beside(palm(AT_THE_ORIGIN), N_STEPS))
    with pytest.raises(ValueError, match="no shape of the model"):
        Sensors(model, ["hand"], shapes=["block"])


def test_bodies_that_fixed_joints_join_in_newton_are_one_part() -> None:
    pytest.importorskip("newton", reason="needs `pip install 'newton[sim]' torch`, which brings MuJoCo 3; kernels take a minute to compile")
    import newton

    from twintac.simulators.newton import Sensors

    world = newton.ModelBuilder()
    palm_there, thumb, finger = (world.add_link(label=label, mass=0.1) for label in ("palm", "thumb", "finger"))
    joints = [world.add_joint_free(palm_there), world.add_joint_fixed(palm_there, thumb), world.add_joint_revolute(palm_there, finger)]
    world.add_articulation(joints)
    for body, label in ((palm_there, "palm"), (thumb, "thumb"), (finger, "finger")):
        world.add_shape_sphere(body, radius=0.01, label=label)
    world.add_site(thumb, label="touch")
    builder = newton.ModelBuilder()
    builder.replicate(world, 2)
    sensors = Sensors(builder.finalize(device="cpu"), ["touch"], shapes=["palm", "thumb", "finger"])
    assert sensors.scene.can_touch.tolist() == [[False, False, True]]


def test_blocks_rest_on_palms_in_genesis() -> None:
    pytest.importorskip("genesis", reason="needs `pip install genesis-world torch`; its kernels take minutes to compile")
    import genesis

    from twintac.simulators.genesis import Sensors

    genesis.init(backend=genesis.cpu, precision="32", logging_level="warning")
    scene = genesis.Scene(sim_options=genesis.options.SimOptions(dt=0.001), show_viewer=False)
    board = scene.add_entity(genesis.morphs.Box(size=(0.02, 0.02, 0.002), pos=(0.0, 0.0, 0.1), fixed=True, contype=1, conaffinity=1))
    density = MASS_KG / (0.012 * 0.012 * 0.02)
    block = scene.add_entity(
        genesis.morphs.Box(size=(0.012, 0.012, 0.02), pos=(0.0, 0.0, 0.1281), contype=2, conaffinity=2),
        material=genesis.materials.Rigid(rho=density),
    )
    scene.build(n_envs=N_WORLDS)
    sensors = Sensors(scene, board.links, geoms=block.geoms, position_mm=(0.0, 0.0, 10.0))
    for _ in range(N_STEPS):
        touch = sensors.push()
        scene.step()
    is_at_rest(touch.pressure_kpa, touch.wrench, beside(palm(AT_THE_ORIGIN), N_STEPS))
    sensors.forget(slice(3, 4))
    assert not sensors.memory.now.is_known[3].any() and sensors.memory.now.is_known[2].all()
    with pytest.raises(ValueError, match="no shape that can touch"):
        Sensors(scene, board.links, geoms=[])


def test_a_block_rests_on_a_palm_in_maniskill() -> None:
    """ManiSkill has one sub-scene on a CPU."""
    pytest.importorskip("mani_skill", reason="needs `pip install mani_skill torch`")
    import sapien
    from mani_skill.envs.sapien_env import BaseEnv
    from mani_skill.utils.structs.types import SimConfig

    from twintac.simulators.maniskill import Sensors

    class Palm(BaseEnv):  # type: ignore[misc, unused-ignore]
        touch: Sensors

        @property
        def _default_sim_config(self) -> Any:
            return SimConfig(sim_freq=1000, control_freq=1000)

        def _load_agent(self, options: Any) -> None:
            super()._load_agent(options, sapien.Pose([0.0, 0.0, 1.0]))

        def _load_scene(self, options: Any) -> None:
            self.palm = self._actor("palm", (0.01, 0.01, 0.001), 0.1, "build_kinematic")
            self.block = self._actor("block", (0.006, 0.006, 0.01), 0.1281, "build")

        def _actor(self, name: str, half_m: tuple[float, float, float], z_m: float, build: str) -> Any:
            builder = self.scene.create_actor_builder()
            builder.add_box_collision(half_size=half_m, density=MASS_KG / (0.012 * 0.012 * 0.02))
            builder.initial_pose = sapien.Pose([0.0, 0.0, z_m])
            made = getattr(builder, build)(name)
            made.set_collision_group_bit(2, 1, 1)  # what shares a bit of this group does not collide
            return made

        def _initialize_episode(self, env_idx: Any, options: Any) -> None:
            pass

        def _after_reconfigure(self, options: Any) -> None:
            self.touch = Sensors([self.palm], touching=[self.block], position_mm=(0.0, 0.0, 10.0))

        def _before_simulation_step(self) -> None:
            self.touch.push()

        def evaluate(self) -> dict[str, Any]:
            return {}

    env = Palm(obs_mode="none", reward_mode="none", sim_backend="cpu", render_backend="none", robot_uids="panda")
    env.reset(seed=1)
    for _ in range(N_STEPS):
        env.step(None)
    touch = env.touch.output
    expected = beside(palm(AT_THE_ORIGIN), N_STEPS)
    is_at_rest(touch.pressure_kpa.expand(N_WORLDS, -1, -1), touch.wrench.expand(N_WORLDS, -1, -1), expected)
    with pytest.raises(ValueError, match="no shape that can touch"):
        Sensors([env.palm], touching=[])


class Falling:
    """A rigid object with the interface of Isaac Lab's, that falls without turning."""

    def __init__(self, name: str, z_m: float, mass_kg: float | None = None) -> None:
        import torch

        self.name, self.mass_kg, self.device = name, mass_kg, "cpu"
        self.body_link_pose_w = torch.tensor([5.0, -3.0, z_m, 1.0, 0.0, 0.0, 0.0]).repeat(N_WORLDS, 1, 1)
        self.data = self.instantaneous_wrench_composer = self
        self.speed = torch.zeros(N_WORLDS)
        self.force_n = torch.zeros(N_WORLDS)

    @property
    def body_com_pos_w(self) -> Any:
        return self.body_link_pose_w[..., :3]

    def find_bodies(self, name: str) -> tuple[list[int], list[str]]:
        return ([0], [self.name]) if name == self.name else ([], [])

    def add_forces_and_torques(self, *, forces: Any, torques: Any, body_ids: list[int], is_global: bool) -> None:
        assert is_global and body_ids == [0] and forces.shape == torques.shape == (N_WORLDS, 1, 3)
        self.force_n = self.force_n + forces[:, 0, 2]

    def fall(self, dt: float) -> None:
        if self.mass_kg is not None:
            self.speed = self.speed + dt * (self.force_n / self.mass_kg - 9.81)
            self.body_link_pose_w[:, 0, 2] += dt * self.speed
        self.force_n = 0.0 * self.force_n


def test_blocks_rest_on_palms_by_the_interface_of_isaac_lab() -> None:
    pytest.importorskip("torch", reason="needs PyTorch")
    from twintac import arrays
    from twintac.simulators.isaaclab import Sensors

    hand, block = Falling("palm", 0.1), Falling("block", 0.1181, MASS_KG)
    shape = arrays.centered(arrays.box((12.0, 12.0, 20.0)))
    sensors = Sensors([(hand, "palm")], touching=[(block, "block", shape)])
    for _ in range(N_STEPS):
        touch = sensors.push(0.001)
        carried_n = hand.force_n
        hand.fall(0.001)
        block.fall(0.001)
    guided = AT_THE_ORIGIN.replace("<freejoint/>", '<joint type="slide" axis="0 0 1"/>')
    is_at_rest(touch.pressure_kpa, touch.wrench, beside(palm(guided), N_STEPS))
    assert carried_n.numpy() == pytest.approx(np.full(N_WORLDS, -WEIGHT_N), rel=0.01)
    with pytest.raises(ValueError, match="expected one"):
        Sensors([(hand, "finger")], touching=[(block, "block", shape)])


def test_a_second_look_changes_nothing_and_time_that_goes_back_forgets() -> None:
    model = palm()
    found = scene_of(model, ["touch"], geoms=["block"])
    data = mujoco.MjData(model)
    mujoco.mj_step1(model, data)

    def pushed(aside_m: float) -> Poses:
        poses = poses_of([data])
        down_m = np.array([aside_m, 0.0, -0.001])
        return poses._replace(geom_m=poses.geom_m + down_m)

    def at(memory: Memory, aside_m: float, time_s: float) -> tuple[Memory, Touch]:
        return moment(found, memory, pushed(aside_m), np.array([time_s]))

    memory = begin(found, pushed(0.0), np.array([0.0]))
    memory, first = at(memory, 0.0, 0.0)
    memory, second = at(memory, 2e-4, 0.001)
    assert abs(float(second.wrench[0, 0, 0] - first.wrench[0, 0, 0])) > 0.01
    kept = memory
    for _ in range(3):
        memory, again = at(memory, 2e-4, 0.001)
        assert (again.wrench == second.wrench).all()
    _, other = at(memory, 0.0, 0.001)
    assert other.wrench == pytest.approx(at(kept, 0.0, 0.001)[1].wrench)
    _, forgot = at(memory, 2e-4, 0.0)
    assert forgot.wrench == pytest.approx(at(begin(found, pushed(2e-4), np.array([0.0])), 2e-4, 0.0)[1].wrench)


def test_what_a_gel_gets_its_body_gets_and_what_touches_gets_the_opposite() -> None:
    xml = """
    <mujoco><option gravity="0 0 0"/><worldbody>
      <body name="palm" pos="5 0 0"><freejoint/><geom size="0.01" pos="0 0 -0.03" mass="1" contype="0" conaffinity="0"/></body>
      <body name="rod" pos="5.004 0.002 0.05"><freejoint/><geom name="rod" type="capsule" size="0.005 0.036" pos="0.002 0 -0.001" mass="0.1"/>
        <geom name="end" type="sphere" size="0.004" pos="0 0 0.1" mass="0.3"/></body>
    </worldbody></mujoco>"""
    model = palm(xml)
    found = scene_of(model, ["touch"])
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    poses = poses_of([data])
    _, touch = moment(found, begin(found, poses, np.zeros(1)), poses, np.zeros(1))
    assert [model.body(int(body)).name for body in found.body] == ["palm", "rod"]
    on_palm, on_rod = touch.push[0]
    assert -on_palm[2] == pytest.approx(float(-touch.wrench[0, 0, 2])) and on_palm[2] < -0.05
    assert on_palm[:3] == pytest.approx(-on_rod[:3])
    # About one point, the torques are opposite, too, so the angular momentum does not change.
    about_palm = on_rod[3:] + np.cross(data.xipos[found.body[1]] - data.xipos[found.body[0]], on_rod[:3])
    assert about_palm == pytest.approx(-on_palm[3:], abs=1e-6)


def test_geoms_are_felt_as_their_shapes() -> None:
    xml = """
    <mujoco><asset><mesh name="brick" vertex="-.006 -.006 -.01 .006 -.006 -.01 -.006 .006 -.01 .006 .006 -.01
                                              -.006 -.006 .01 .006 -.006 .01 -.006 .006 .01 .006 .006 .01"/></asset>
    <worldbody><body name="palm"/>
      <geom name="box" type="box" size=".006 .006 .01" pos="0 0 .0178"/>
      <geom name="mesh" type="mesh" mesh="brick" pos="0 0 .0178"/>
      <geom name="ball" type="sphere" size=".0125" pos="0 0 .02"/>
      <geom name="egg" type="ellipsoid" size=".0125 .0125 .0125" pos="0 0 .02"/>
      <geom name="rod" type="capsule" size=".0125 .02" pos="0 0 .04"/>
    </worldbody></mujoco>"""
    model = palm(xml)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    poses = poses_of([data])

    def felt(geom: str) -> Array:
        found = scene_of(model, ["touch"], geoms=[geom])
        pressure_kpa: Array = moment(found, begin(found, poses, np.zeros(1)), poses, np.zeros(1))[1].pressure_kpa[0, 0]
        return pressure_kpa

    with pytest.raises(ValueError, match="on a body that moves"):
        felt("box")
    model = palm(xml.replace('<body name="palm"/>', '<body name="palm"><freejoint/><geom size="0.001" mass="1" contype="0" conaffinity="0"/></body>'))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    poses = poses_of([data])
    assert felt("mesh") == pytest.approx(felt("box"), rel=0.02)
    assert felt("egg") == pytest.approx(felt("ball"), rel=0.02)
    assert felt("rod") == pytest.approx(felt("ball"), rel=0.02)


@pytest.mark.parametrize(("sites", "geoms", "problem"), [(["hand"], None, "no site `hand`"), (["touch"], ["ball"], "no geom `ball`"), ([], None, "`sites` has none"), (["touch"], None, "no shape that can touch")])
def test_what_a_model_does_not_have_is_refused(sites: list[str], geoms: list[str] | None, problem: str) -> None:
    with pytest.raises(ValueError, match=problem):
        scene_of(palm(), sites, geoms=geoms)
