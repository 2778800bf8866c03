"""Tests of sensors that a model declares in MJCF."""

import mujoco
import mujoco.batch
import numpy as np
import pytest

from twintac import FastGel, Sensor
from twintac.mujoco import TouchSensors

MODEL = """
<mujoco><option timestep="0.001"/>
  <worldbody>
    <body name="palm"><site name="palm"/><site name="thumb" pos="0.1 0 0"/></body>
    <body name="block" pos="0 0 0.0181"><freejoint/><geom type="box" size="0.006 0.006 0.01" mass="0.1"/></body>
  </worldbody>
  <sensor>
    <framepos objtype="body" objname="block"/>
    <user name="phystac/palm" objtype="site" objname="palm" datatype="real" needstage="vel" dim="8"/>
    <user name="other/palm" objtype="site" objname="palm" datatype="real" needstage="vel" dim="3"/>
    <user name="phystac/thumb" objtype="site" objname="thumb" datatype="real" needstage="vel" dim="8"/>
  </sensor>
</mujoco>"""


def test_a_declared_sensor_is_one_at_its_site() -> None:
    model = mujoco.MjModel.from_xml_string(MODEL)
    of_model, of_sites = TouchSensors(model), TouchSensors(model, ["palm", "thumb"])
    first, second = mujoco.MjData(model), mujoco.MjData(model)
    for _ in range(30):
        for touch, data in ((of_model, first), (of_sites, second)):
            mujoco.mj_step1(model, data)
            touch.update(data)
            mujoco.mj_step2(model, data)
    assert (of_model.readings_kpa == of_sites.readings_kpa).all() and of_model.readings_kpa[0, 0].max() > 1.0
    assert (first.qpos == second.qpos).all()
    assert (first.sensor("phystac/palm").data == of_model.readings_kpa[0, 0]).all()
    assert (first.sensor("phystac/thumb").data == of_model.readings_kpa[0, 1]).all()
    assert not first.sensor("other/palm").data.any() and not second.sensor("phystac/palm").data.any()
    assert "phystac/palm" in repr(of_model)


def test_within_pushing_the_readings_are_in_sensordata_as_well() -> None:
    model = mujoco.MjModel.from_xml_string(MODEL)
    touch, data = TouchSensors(model), mujoco.MjData(model)
    for _ in range(10):
        mujoco.mj_step1(model, data)
        with touch.pushing(data) as readings_kpa:
            mujoco.mj_step2(model, data)
            assert (data.sensor("phystac/palm").data == readings_kpa[0, 0]).all()
    assert readings_kpa[0, 0].max() > 0.1


def test_declared_sensors_of_a_batch_are_read_from_the_sensors() -> None:
    model = mujoco.MjModel.from_xml_string(MODEL)
    batch = mujoco.batch.Batch(model, 2, persistent=True)
    batch.forward(stage=mujoco.mjtStage.mjSTAGE_VEL)
    touch = TouchSensors(model, n_worlds=2)
    for _ in range(10):
        readings_kpa = touch.update(batch)
        batch.step(stage=mujoco.mjtStage.mjSTAGE_VEL)
    assert readings_kpa.shape == (2, 2, 8) and np.all(readings_kpa[:, 0].max(-1) > 0.1)


@pytest.mark.parametrize(
    ("before", "after", "problem"),
    [
        ('name="phystac/', 'name="mine/', "no sensor `phystac/…`: name `sites`, or declare it"),
        ('objname="palm" datatype="real" needstage="vel" dim="8"', 'objname="palm" datatype="real" needstage="vel" dim="6"', 'has `dim="6"`, and `phystac` has 8 taxels'),
        ('objtype="site" objname="palm" datatype="real" needstage="vel" dim="8"', 'objtype="body" objname="palm" datatype="real" needstage="vel" dim="8"', "is not at a site"),
        ('needstage="vel" dim="8"', 'needstage="acc" dim="8"', 'write `needstage="vel"`'),
        ('objname="thumb"', 'objname="palm"', "site of `phystac/thumb` is named twice"),
    ],
)
def test_what_is_declared_wrongly_is_refused(before: str, after: str, problem: str) -> None:
    model = mujoco.MjModel.from_xml_string(MODEL.replace(before, after))
    with pytest.raises(ValueError, match=problem):
        TouchSensors(model)


def test_sensors_of_another_description_are_declared_by_its_name() -> None:
    tip = MODEL.replace("phystac/thumb", "phystac-tip/thumb")
    model = mujoco.MjModel.from_xml_string(tip)
    touch = TouchSensors(model, sensor=Sensor.phystac_tip())
    assert touch.readings_kpa.shape == (1, 1, len(FastGel.phystac_tip().ports_mm))
    assert TouchSensors(model).readings_kpa.shape == (1, 1, 8)
