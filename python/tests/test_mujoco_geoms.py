"""Tests that geoms are read individually, in their current form, by a sensor whose gel and
description match.
"""

from typing import Any

import mujoco
import mujoco.batch
import numpy as np
import pytest

from conftest import ROOT

from blocks import BLOCK, LEGS, Scene, palm
from twintac import Error, FastGel, Sensor
from twintac.mujoco import TouchSensors, add_sensor

VELOCITY = mujoco.mjtStage.mjSTAGE_VEL


@pytest.mark.parametrize("right_mm", [5.0, 5.000001])
def test_equal_legs_carry_a_block(right_mm: float) -> None:
    legs = LEGS.replace('name="right" type="box" size="0.004 0.004 0.005"', f'name="right" type="box" size="0.004 0.004 {1e-3 * right_mm}"')
    scene = Scene(palm(legs))
    scene.step(1000)
    assert scene.height_mm == pytest.approx(13.3, abs=0.1)
    assert scene.touch.wrench[0, 0, :3] == pytest.approx((0.0, 0.0, -0.589), abs=0.006)


def test_one_mesh_twice_is_two_things() -> None:
    corners = " ".join(f"{x} {y} {z}" for x in (-0.004, 0.004) for y in (-0.004, 0.004) for z in (-0.005, 0.005))
    legs = LEGS.replace('type="box" size="0.004 0.004 0.005"', 'type="mesh" mesh="leg"')
    scene = Scene(palm(legs, rest=f'<asset><mesh name="leg" vertex="{corners}"/></asset>'))
    scene.step(1000)
    assert scene.height_mm == pytest.approx(13.3, abs=0.15)
    assert scene.touch.wrench[0, 0, :3] == pytest.approx((0.0, 0.0, -0.589), abs=0.006)


def test_a_geom_of_another_size_is_felt_as_it_is() -> None:
    scene = Scene(palm(LEGS))
    scene.step(500)
    for name in ("left", "right"):
        scene.model.geom(name).size[2] = 0.008
    mujoco.mj_resetData(scene.model, scene.data)
    scene.data.qpos[2] = 0.0166
    scene.step(1000)
    assert scene.height_mm == pytest.approx(16.3, abs=0.1)
    # The size changes during a contact, for one geom of two.
    scene.model.geom("left").size[2] = 0.0082
    scene.step(1000)
    left, right = (float(scene.data.geom(name).xpos[2]) for name in ("left", "right"))
    assert 1e3 * (left - right) == pytest.approx(0.2, abs=0.1)
    scene.model.geom("left").pos[2] += 0.0001
    scene.model.geom("left").size[2] = np.nan
    with pytest.raises(ValueError, match="geom `left` has the size"):
        scene.step()


def test_each_world_of_a_batch_has_geoms_of_its_own_size() -> None:
    found = palm()
    batch = mujoco.batch.Batch(found, 3, persistent=True)
    touch = TouchSensors(found, ["touch"], n_worlds=3)
    batch.expand("geom_size")[1, found.geom("thing").id, 2] = 0.012
    batch.bind("qpos")[:, 2] = [0.0185, 0.0205, 0.0185]
    batch.forward(stage=VELOCITY)
    for number in range(600):
        if number == 300:
            batch.expand("geom_size")[2, found.geom("thing").id, 2] = 0.0095
        touch.update(batch)
        batch.step(stage=VELOCITY)
    heights_mm = 1e3 * batch.bind("qpos")[:, 2]
    assert heights_mm[1] - heights_mm[0] == pytest.approx(2.0, abs=0.02)
    assert heights_mm[2] - heights_mm[0] == pytest.approx(-0.5, abs=0.02)
    assert touch.wrench[:, 0, 2] == pytest.approx(np.full(3, -0.981), rel=0.01)


def test_worlds_of_models_of_their_own_have_their_meshes() -> None:
    def of(height_m: float) -> mujoco.MjModel:
        corners = " ".join(f"{x} {y} {z}" for x in (-0.006, 0.006) for y in (-0.006, 0.006) for z in (-height_m, height_m))
        return palm(BLOCK.replace('type="box" size="0.006 0.006 0.01"', 'type="mesh" mesh="m"'), rest=f'<asset><mesh name="m" vertex="{corners}"/></asset>')

    models = [of(0.01), of(0.012)]
    batch = mujoco.batch.Batch(models[0], 2, persistent=True)
    batch.set_models(models)
    batch.bind("qpos")[:, 2] = [0.0185, 0.0205]
    batch.forward(stage=VELOCITY)
    touch = TouchSensors(models[0], ["touch"], n_worlds=2)
    for _ in range(600):
        touch.update(batch)
        batch.step(stage=VELOCITY)
    assert float(np.diff(1e3 * batch.bind("qpos")[:, 2])[0]) == pytest.approx(2.0, abs=0.02)


def test_meshes_and_height_fields_that_change_are_read_anew() -> None:
    corners = " ".join(f"{x} {y} {z}" for x in (-0.006, 0.006) for y in (-0.006, 0.006) for z in (-0.01, 0.01))
    scene = Scene(palm(BLOCK.replace('type="box" size="0.006 0.006 0.01"', 'type="mesh" mesh="m"'), rest=f'<asset><mesh name="m" vertex="{corners}"/></asset>'))
    scene.step(500)
    before_mm = scene.height_mm
    scene.model.mesh_vert[:] *= 1.05
    scene.step(700)
    assert scene.height_mm - before_mm == pytest.approx(0.5, abs=0.1)
    field = '<hfield name="f" nrow="2" ncol="2" size="0.006 0.006 0.001 0.01" elevation="0 0 0 0.01"/>'
    turned = BLOCK.replace('type="box" size="0.006 0.006 0.01"', 'type="hfield" hfield="f" quat="0 1 0 0"').replace("0.019", "0.0083")
    hung = Scene(palm(turned, option='<flag gravity="disable"/>', rest=f"<asset>{field}</asset>"))
    hung.model.hfield_data[:] = 0.2
    hung.step()
    light_n = hung.force_n
    hung.model.hfield_data[:] = 0.9
    hung.step()
    assert hung.force_n < 2.0 * light_n < 0.0


def test_other_geoms_that_collide_are_refused() -> None:
    scene = Scene(palm(BLOCK + '<geom name="wall" size="0.01" pos="1 0 0" contype="0" conaffinity="0"/>'))
    scene.step(3)
    scene.model.geom("wall").contype = 1
    with pytest.raises(ValueError, match="other geoms collide"):
        scene.step()


def test_what_does_not_belong_together_is_refused() -> None:
    found, tip = palm(), Sensor.phystac_tip()
    with pytest.raises(Error, match="`phystac` is not that of `phystac-tip`"):
        TouchSensors(found, ["touch"], sensor=tip, gel=FastGel.phystac())
    with pytest.raises(Error, match="phystac"):
        TouchSensors(found, ["touch"], sensor=Sensor.phystac(), gel=FastGel.phystac_tip())
    own = Sensor.load(ROOT / "sensors/strip4-gel-d.toml")
    with pytest.raises(ValueError, match="which is not built in: give its `gel` too"):
        TouchSensors(found, ["touch"], sensor=own)
    with pytest.raises(ValueError, match="the site of `touch` is named twice"):
        TouchSensors(found, ["touch", "touch"])
    with pytest.raises(ValueError, match="`n_worlds` is 0"):
        TouchSensors(found, ["touch"], n_worlds=0)


def test_a_built_in_sensor_tells_its_gel() -> None:
    tip = Sensor.phystac_tip()
    scene = Scene(palm(LEGS.replace("0.0136", "0.0245").replace("-0.008", "0").replace("0.008", "0.0001"), sensor=tip), sensor=tip)
    plate = BLOCK.replace("0.006 0.006 0.01", "0.02 0.02 0.002").replace("0.019", "0.0215")
    scene = Scene(palm(plate, option='<flag gravity="disable"/>', sensor=tip), sensor=tip)
    top_mm = float(tip.bounds_mm[1, 2])
    for depth_mm, touches in ((-2.5, False), (0.8, True)):
        scene.data.qpos[:3] = [0.0, 0.0, 1e-3 * (top_mm - depth_mm) + 0.002]
        scene.touch.reset()
        mujoco.mj_forward(scene.model, scene.data)
        scene.touch.update(scene.data)
        assert (scene.force_n < -0.01) == touches
    assert repr(scene.touch) == "<TouchSensors at touch in one world, 1 geoms can touch, simulated>"


def test_where_nobody_knows_what_touches_nothing_is_read() -> None:
    other = '<body name="far" pos="1 0 0"><freejoint/><geom size="0.01" mass="0.1" contype="1"/></body>'
    scene = Scene(palm(BLOCK + other, option='<flag gravity="enable" autoreset="disable"/>'))
    scene.step(300)
    assert scene.force_n < -0.9
    scene.data.geom_xpos[scene.model.geom("thing").id] = np.nan
    scene.touch.update(scene.data)
    assert np.isnan(scene.touch.readings_kpa).all() and np.isnan(scene.touch.wrench).all()
    assert np.isfinite(scene.data.qfrc_applied).all() and not scene.data.qfrc_applied.any()
    mujoco.mj_kinematics(scene.model, scene.data)
    scene.step(500)
    assert scene.force_n == pytest.approx(-0.981, rel=0.01)
    for value in (np.inf, -np.inf, np.nan):
        scene.data.site_xpos[0, 1] = value
        assert np.isnan(scene.touch.update(scene.data)).all()
        mujoco.mj_kinematics(scene.model, scene.data)


def test_a_world_that_is_lost_is_missing_alone() -> None:
    found = palm()
    found.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_AUTORESET
    batch = mujoco.batch.Batch(found, 3, persistent=True)
    touch = TouchSensors(found, ["touch"], n_worlds=3)
    batch.bind("qpos")[1, 2] = np.nan
    batch.forward(stage=VELOCITY)
    for _ in range(100):
        touch.update(batch)
        batch.step(stage=VELOCITY)
    assert np.isnan(touch.readings_kpa[1]).all() and np.isnan(touch.wrench[1]).all()
    assert touch.readings_kpa[[0, 2]].max() > 1.0 and np.isfinite(touch.wrench[[0, 2]]).all()


@pytest.mark.parametrize("floor", ['type="plane" size="1 1 1" pos="3 -4 0"', 'type="box" size="2 1.5 0.02" pos="0 0 -0.02"'])
def test_a_floor_holds_what_slides_over_it(floor: str) -> None:
    spec = mujoco.MjSpec.from_string(f"""<mujoco><option timestep="0.001" gravity="0 0 0"/><worldbody><geom name="floor" {floor}/>
        <body name="hand"><joint name="x" type="slide" axis="1 0 0"/><joint name="z" type="slide" axis="0 0 1"/>
        <geom size="0.001" contype="0" conaffinity="0" mass="0.1"/></body></worldbody></mujoco>""")
    add_sensor(spec, Sensor.phystac(), body="hand", name="touch", quaternion=(1.0, 0.0, 0.0, 0.0))
    found = spec.compile()
    data, touch = mujoco.MjData(found), TouchSensors(found, ["touch"], friction=0.5, retardation_s=0.0)
    for number in range(40):
        data.qpos[:] = [0.2 + 1e-4 * number, 0.0075]
        data.time = 1e-3 * number
        mujoco.mj_forward(found, data)
        data.qfrc_applied[:] *= 1.0
        touch.update(data)
    # It moves along x of the gel, which faces down. Friction with the floor resists, at Coulomb's
    # limit.
    normal_n, along_n = float(touch.wrench[0, 0, 2]), float(touch.wrench[0, 0, 0])
    assert normal_n < -1.0
    assert along_n == pytest.approx(0.5 * normal_n, rel=0.05)


HAND = """
<mujoco><option timestep="0.001"/><worldbody>
  <geom name="floor" type="{floor}" size="0.5 0.5 0.02" pos="0 0 {floor_m}"/>
  <body name="hand" pos="0 0 {height_m}" euler="0 {tilt} 0"><freejoint/>
    <geom name="board" type="box" size="0.017 0.009 0.001" pos="0 0 -0.001" mass="0.2"/>
    <body name="finger" pos="0 0 -0.01"><joint axis="0 1 0"/><geom name="finger" type="box" size="0.03 0.03 0.004" mass="0.1"/></body></body>
  <body name="above" pos="0 0 1"><freejoint/><geom name="above" type="sphere" size="0.01" mass="0.1"/></body>
</worldbody>{more}</mujoco>"""


def hand(**options: object) -> Any:
    filled = {"floor": "plane", "floor_m": 0.0, "height_m": 0.04, "tilt": 0, "more": "", **options}
    spec = mujoco.MjSpec.from_string(HAND.format(**filled))
    add_sensor(spec, Sensor.phystac(), body="hand", name="palm")
    return spec.compile()


@pytest.mark.parametrize("tilt", [0, 10, -15])
@pytest.mark.parametrize(("floor", "floor_m"), [("plane", 0.0), ("box", -0.02)])
def test_what_is_behind_a_sensor_does_not_press_it(floor: str, floor_m: float, tilt: int) -> None:
    for height_m in (0.02, 0.03, 0.04, 0.06):
        model = hand(floor=floor, floor_m=floor_m, tilt=tilt, height_m=height_m)
        touch, data = TouchSensors(model, ["palm"]), mujoco.MjData(model)
        mujoco.mj_step1(model, data)
        assert not touch.update(data).any() and not touch.wrench.any(), height_m


def test_bodies_that_mujoco_does_not_collide_do_not_touch() -> None:
    def can_touch(model: Any, **options: Any) -> list[str]:
        touch = TouchSensors(model, ["palm"], **options)
        return [model.geom(int(number)).name for number, can in zip(touch._geoms.number, touch._can_touch[0]) if can]

    assert can_touch(hand()) == ["floor", "above"]
    # What is named touches, also a child.
    assert can_touch(hand(), geoms=["finger", "above"]) == ["finger", "above"]
    excluded = hand(more='<contact><exclude body1="above" body2="hand"/><exclude body1="hand" body2="finger"/></contact>')
    assert can_touch(excluded) == ["floor"]
    assert can_touch(excluded, geoms=["floor", "finger"]) == ["floor"]
    unfiltered = hand(more='<option><flag filterparent="disable"/></option>')
    assert can_touch(unfiltered) == ["floor", "finger", "above"]
