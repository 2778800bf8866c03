"""Tests of sensors in MuJoCo: every kind of geom gives the readings of the same shape without
MuJoCo, forces are right, and many worlds behave as single ones.
"""

from collections.abc import Callable

import mujoco
import mujoco.batch
import numpy as np
import numpy.typing as npt
import pytest

from twintac import Body, FastGel, Pose, Sensor, Shape
from twintac.mujoco import TouchSensors, add_sensor
from twintac.mujoco._poses import quaternion_of

Array = npt.NDArray[np.float64]
TOP_M = 0.0085
SCENE = """
<mujoco>
  <option timestep="0.001"/>
  <asset>
    <mesh name="block" vertex="-.006 -.006 -.01  .006 -.006 -.01  -.006 .006 -.01  .006 .006 -.01
                               -.006 -.006 .01  .006 -.006 .01  -.006 .006 .01  .006 .006 .01"/>
    <hfield name="flat" nrow="2" ncol="2" size="0.006 0.006 0.001 0.019" elevation="1 1 1 1"/>
  </asset>
  <worldbody>
    <body name="board" pos="0.1 0.2 0.3" euler="20 -30 40"/>
    {things}
  </worldbody>
</mujoco>"""


def model(things: str, body: str = "board") -> mujoco.MjModel:
    spec = mujoco.MjSpec.from_string(SCENE.format(things=things))
    add_sensor(spec, Sensor.phystac(), body=body, name="touch", position_mm=(1.0, 2.0, 3.0), quaternion=(0.0, 0.6, 0.0, 0.8))
    return spec.compile()


def gel_from_world(data: mujoco.MjData) -> tuple[Array, Array]:
    site = data.site("touch")
    return np.asarray(site.xpos), np.asarray(site.xmat).reshape(3, 3)


# A geom, and the distance of its lowest point below its middle, m.
GEOMS = {
    "sphere": ('type="sphere" size="0.0125"', 0.0125, Shape.sphere(12.5)),
    "box": ('type="box" size="0.006 0.006 0.01"', 0.01, Shape.box((12.0, 12.0, 20.0), 0.0)),
    "cylinder": ('type="cylinder" size="0.006 0.01"', 0.01, Shape.cylinder(6.0, 20.0, 0.0)),
    "mesh": ('type="mesh" mesh="block"', 0.01, Shape.box((12.0, 12.0, 20.0), 0.0)),
    "ellipsoid": ('type="ellipsoid" size="0.0125 0.0125 0.0125"', 0.0125, Shape.sphere(12.5)),
    "capsule": ('type="capsule" size="0.0125 0.02"', 0.0325, Shape.sphere(12.5)),
    "hfield": ('type="hfield" hfield="flat" quat="0 1 0 0"', 0.0, Shape.box((12.0, 12.0, 20.0), 0.0)),
}


@pytest.mark.parametrize(
    ("place", "match"),
    [
        ({"position_mm": (0.0, 0.0, float("nan"))}, "`position_mm`"),
        ({"position_mm": (0.0, 0.0)}, "three finite lengths"),
        ({"quaternion": (0.0, 0.0, 0.0, 0.0)}, "of length 0.000"),
        ({"quaternion": (0.0, 0.0, 1.0, 1.0)}, "of length 1.414"),
    ],
)
def test_a_sensor_is_not_added_at_a_place_that_is_none(place: dict[str, tuple[float, ...]], match: str) -> None:
    spec = mujoco.MjSpec()
    spec.worldbody.add_body(name="board")
    with pytest.raises(ValueError, match=match):
        add_sensor(spec, Sensor.phystac(), body="board", name="touch", **place)
    assert not spec.sites


@pytest.mark.parametrize("kind", GEOMS)
def test_a_geom_is_felt_as_its_shape(kind: str) -> None:
    geom, below_m, shape = GEOMS[kind]
    found = model(f'<body name="thing"><freejoint/><geom {geom} mass="1"/></body>')
    data = mujoco.MjData(found)
    mujoco.mj_forward(found, data)
    origin, turn = gel_from_world(data)
    data.qpos[:3] = origin + turn @ np.array([0.001, 0.002, TOP_M + below_m - 0.001])
    mujoco.mju_mat2Quat(data.qpos[3:], turn.ravel())
    mujoco.mj_forward(found, data)
    touch = TouchSensors(found, ["touch"])
    readings_kpa = touch.update(data)[0, 0]
    expected_kpa, _ = FastGel.phystac().reader().read([(Body(shape), Pose((1.0, 2.0, 7.5)))])
    assert readings_kpa == pytest.approx(expected_kpa, abs=0.05 * float(expected_kpa.max()))
    assert touch.provenance == "simulated"


def test_a_plane_is_felt_wherever_its_frame_is() -> None:
    found = model('<body name="hand"><freejoint/><geom size="0.001" contype="0" conaffinity="0" mass="0.1"/></body><geom type="plane" size="1 1 1" pos="0.5 0.3 0"/>', "hand")
    data = mujoco.MjData(found)
    touch = TouchSensors(found, ["touch"])
    readings = []
    for x_m in (0.0, -0.7):
        # The board is turned over, so that the gel faces the plane below.
        data.qpos[:] = [x_m, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0]
        mujoco.mj_forward(found, data)
        origin, turn = gel_from_world(data)
        wanted = np.diag([1.0, -1.0, -1.0])
        mujoco.mju_mat2Quat(data.qpos[3:], (wanted @ turn.T @ np.diag([1.0, -1.0, -1.0])).ravel())
        mujoco.mj_forward(found, data)
        origin, turn = gel_from_world(data)
        assert turn[2, 2] == pytest.approx(-1.0)
        data.qpos[2] += TOP_M - 0.001 - origin[2]
        mujoco.mj_forward(found, data)
        touch.reset()  # the sensor has not slid to this position
        readings.append(touch.update(data)[0, 0].copy())
    assert readings[0].min() > 1.0
    assert readings[0] == pytest.approx(readings[1], rel=1e-3)


def resting(contact: bool) -> float:
    """The force under a block of 100 g at rest, N: on the gel, or with MuJoCo's contact on a box in
    place of the gel.
    """
    pad = f'<geom type="box" size="0.017 0.009 {0.5 * TOP_M}" pos="0 0 {0.5 * TOP_M}"/>' if contact else ""
    spec = mujoco.MjSpec.from_string(f"""
        <mujoco><option timestep="0.001"/><worldbody>
          <body name="board">{pad}</body>
          <body name="thing" pos="0.001 0 0.0195"><freejoint/><geom name="thing" type="box" size="0.006 0.006 0.01" mass="0.1"/></body>
        </worldbody></mujoco>""")
    add_sensor(spec, Sensor.phystac(), body="board", name="touch")
    found = spec.compile()
    data = mujoco.MjData(found)
    touch = None if contact else TouchSensors(found, ["touch"])
    for _ in range(700):
        mujoco.mj_step1(found, data)
        if touch is not None:
            touch.update(data)
        mujoco.mj_step2(found, data)
    if touch is not None:
        return float(-touch.wrench[0, 0, 2])
    force = np.zeros(6)
    total_n = 0.0
    for number in range(data.ncon):
        mujoco.mj_contactForce(found, data, number, force)
        total_n += force[0]
    return total_n


def test_the_gel_carries_what_mujocos_contact_would() -> None:
    assert resting(contact=False) == pytest.approx(resting(contact=True), rel=0.02)
    assert resting(contact=False) == pytest.approx(0.981, rel=0.02)


FALLING = '<body name="thing" pos="0 0 0.025"><freejoint/><geom type="sphere" size="0.0125" mass="0.05"/></body>'


def falling(n_worlds: int) -> tuple[mujoco.MjModel, Callable[[int], float]]:
    spec = mujoco.MjSpec.from_string(f'<mujoco><option timestep="0.001"/><worldbody><body name="board"/>{FALLING}</worldbody></mujoco>')
    add_sensor(spec, Sensor.phystac(), body="board", name="touch")
    return spec.compile(), lambda world: 1e-3 * world


def test_many_worlds_are_as_one() -> None:
    found, aside_m = falling(3)
    batch = mujoco.batch.Batch(found, 3, persistent=True)
    touch = TouchSensors(found, ["touch"], n_worlds=3)
    batch.bind("qpos")[:, 0] += [aside_m(world) for world in range(3)]
    batch.forward()
    together = []
    for _ in range(60):
        touch.update(batch)
        batch.step(stage=mujoco.mjtStage.mjSTAGE_VEL)
        together.append(touch.readings_kpa[:, 0].copy())
    for world in range(3):
        data = mujoco.MjData(found)
        data.qpos[0] += aside_m(world)
        alone = TouchSensors(found, ["touch"])
        for step in range(60):
            mujoco.mj_step1(found, data)
            alone.update(data)
            mujoco.mj_step2(found, data)
            assert alone.readings_kpa[0, 0] == pytest.approx(together[step][world], abs=1e-5)
    assert max(readings.max() for readings in together) > 1.0


def test_what_cannot_be_is_said() -> None:
    found, _ = falling(1)
    with pytest.raises(ValueError, match="no site `tuch`; it has touch"):
        TouchSensors(found, ["tuch"])
    with pytest.raises(ValueError, match="no geom `ball`"):
        TouchSensors(found, ["touch"], geoms=["ball"])
    with pytest.raises(ValueError, match="one world, the sensors are of 2"):
        TouchSensors(found, ["touch"], n_worlds=2).update(mujoco.MjData(found))
    spec = mujoco.MjSpec()
    with pytest.raises(ValueError, match="`hand`"):
        add_sensor(spec, Sensor.phystac(), body="hand", name="touch")


def test_quaternions_of_matrices_are_mujocos() -> None:
    random = np.random.default_rng(1)
    wanted = random.normal(size=(200, 4))
    wanted[:8] = np.concatenate([np.eye(4), -np.eye(4)])
    wanted /= np.linalg.norm(wanted, axis=1, keepdims=True)
    turn = np.zeros((200, 9))
    for row, quaternion in zip(turn, wanted):
        mujoco.mju_quat2Mat(row, quaternion)
    found = quaternion_of(turn.reshape(200, 3, 3))
    assert np.abs((found * wanted).sum(-1)) == pytest.approx(np.ones(200))
    assert (quaternion_of(np.zeros((2, 3, 3))) == 0.0).all()
    assert np.isnan(quaternion_of(np.full((1, 3, 3), np.nan))).any()


def test_what_comes_near_is_in_proximity() -> None:
    found = model('<body name="thing" pos="0 0 1"><freejoint/><geom type="sphere" size="0.005" mass="1"/></body>')
    touch, data = TouchSensors(found, ["touch"]), mujoco.MjData(found)
    mujoco.mj_forward(found, data)
    place_m, turn = gel_from_world(data)
    for gap_mm, expected in ((5.0, 0.0), (1.5, 0.25), (0.5, 0.75), (-0.5, 1.0)):
        data.qpos[:3] = place_m + turn @ np.array([0.0, 0.0, TOP_M + 0.005 + 1e-3 * gap_mm])
        touch.reset()
        mujoco.mj_forward(found, data)
        touch.update(data)
        assert touch.proximity == pytest.approx(np.array([[expected]]), abs=0.01), gap_mm
