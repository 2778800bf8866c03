"""Tests that the forces of gels are right whatever else is done to the data between steps, or that
an error is raised.
"""

import mujoco
import mujoco.batch
import numpy as np
import pytest

from blocks import BLOCK, Scene, palm
from twintac import FastGel, Sensor, SensorVariation
from twintac.mujoco import TouchSensors, add_sensor

WEIGHT_N = -0.981
INTEGRATION = mujoco.mjtState.mjSTATE_INTEGRATION
VELOCITY = mujoco.mjtStage.mjSTAGE_VEL


def at_rest() -> Scene:
    scene = Scene(palm())
    scene.step(500)
    assert scene.force_n == pytest.approx(WEIGHT_N, rel=0.01) and scene.height_mm == pytest.approx(18.0, abs=0.5)
    return scene


def check_rests(scene: Scene, n_steps: int = 500) -> None:
    expected_mm = at_rest().height_mm
    scene.step(n_steps)
    assert scene.force_n == pytest.approx(WEIGHT_N, rel=0.01)
    assert scene.height_mm == pytest.approx(expected_mm, abs=0.05)


def test_a_state_that_is_written_back_through_qpos_goes_on_from_there() -> None:
    scene = at_rest()
    qpos = scene.data.qpos.copy()
    qpos[2] += 0.004
    scene.data.qpos[:], scene.data.qvel[:] = qpos, 0.0
    scene.touch.reset()
    scene.step(20)
    # The block falls from its current position: nothing is under it yet.
    assert scene.data.qvel[2] == pytest.approx(-9.81 * 0.02, rel=0.01)
    check_rests(scene)


def test_at_rest_it_stays_at_rest_when_gels_forget() -> None:
    scene = at_rest()
    scene.touch.reset()
    way = scene.step(20)
    assert np.ptp(way[:, 2]) < 2e-6
    check_rests(scene, 1)


def test_data_that_are_reset_without_a_word_begin_anew() -> None:
    scene = Scene(palm())
    first = scene.step(200)
    mujoco.mj_resetData(scene.model, scene.data)
    assert np.array_equal(scene.step(200), first)
    mujoco.mj_resetData(scene.model, scene.data)
    scene.touch.reset()
    assert np.array_equal(scene.step(200), first)


def test_mujocos_own_reset_of_what_went_astray_begins_anew() -> None:
    scene = Scene(palm())
    first = scene.step(200)
    scene.data.qpos[2] = np.nan
    assert np.array_equal(scene.step(200), first)
    scene.data.qvel[2] = 1e20
    assert np.array_equal(scene.step(200), first)


def test_xfrc_applied_is_the_users() -> None:
    scene = at_rest()
    for _ in range(300):
        scene.data.xfrc_applied[:] = 0.0
        scene.step()
        scene.data.xfrc_applied[:] = 0.0
    check_rests(scene)
    thing = scene.model.body("thing").id
    for added_n in (-0.5, 0.4):
        scene.data.xfrc_applied[thing, 2] += added_n
        scene.step(400)
        assert scene.force_n == pytest.approx(WEIGHT_N + scene.data.xfrc_applied[thing, 2], rel=0.01)
    assert scene.data.xfrc_applied[thing, 2] == pytest.approx(-0.1)


def test_a_drag_that_a_viewer_assigns_acts_once() -> None:
    scene = at_rest()
    thing = scene.model.body("thing").id
    for _ in range(400):
        scene.data.xfrc_applied[:] = 0.0
        scene.data.xfrc_applied[thing, 2] = -0.3
        scene.step()
    assert scene.force_n == pytest.approx(WEIGHT_N - 0.3, rel=0.01)


def test_an_update_in_every_tenth_step_is_refused() -> None:
    scene = Scene(palm())
    with pytest.raises(ValueError, match="0.01 s have passed since the last update, a time step is 0.001 s"):
        for number in range(30):
            mujoco.mj_step1(scene.model, scene.data)
            if number % 10 == 0:
                scene.touch.update(scene.data)
            mujoco.mj_step2(scene.model, scene.data)


def test_a_jump_ahead_is_refused_until_the_gels_are_reset() -> None:
    scene = at_rest()
    scene.data.time += 5.0
    with pytest.raises(ValueError, match="call `reset`"):
        scene.step()
    scene.touch.reset()
    check_rests(scene)


def test_two_updates_in_a_step_are_as_one() -> None:
    once, twice = Scene(palm()), Scene(palm())
    way = once.step(300)
    for expected in way:
        mujoco.mj_step1(twice.model, twice.data)
        first = twice.touch.update(twice.data).copy()
        mujoco.mj_forward(twice.model, twice.data)
        again = twice.touch.update(twice.data)
        mujoco.mj_step2(twice.model, twice.data)
        assert np.array_equal(again, first) and np.array_equal(twice.data.qpos, expected)


def test_mj_forward_after_the_update_changes_nothing() -> None:
    scene = Scene(palm())
    for expected in Scene(palm()).step(300):
        mujoco.mj_step1(scene.model, scene.data)
        scene.touch.update(scene.data)
        mujoco.mj_forward(scene.model, scene.data)
        mujoco.mj_step2(scene.model, scene.data)
        assert scene.data.qpos == pytest.approx(expected, abs=1e-12)


def test_the_time_step_may_change() -> None:
    scene = at_rest()
    scene.model.opt.timestep = 0.0005
    with pytest.raises(ValueError, match="since the last update"):
        scene.step()  # the previous step was one of 1 ms
    scene.touch.reset()
    check_rests(scene, 1000)


@pytest.mark.parametrize("integrator", ["Euler", "RK4", "implicit", "implicitfast"])
@pytest.mark.parametrize("pushing", [False, True])
def test_integrators_rest_it_where_it_rests(integrator: str, pushing: bool) -> None:
    scene = Scene(palm())
    scene.model.opt.integrator = getattr(mujoco.mjtIntegrator, f"mjINT_{integrator.upper()}")
    for _ in range(500):
        mujoco.mj_forward(scene.model, scene.data)
        if pushing:
            with scene.touch.pushing(scene.data):
                mujoco.mj_step(scene.model, scene.data)
        else:
            scene.touch.update(scene.data)
            mujoco.mj_step(scene.model, scene.data)
    assert scene.force_n == pytest.approx(WEIGHT_N, rel=0.01)
    assert scene.height_mm == pytest.approx(at_rest().height_mm, abs=0.05)


def test_others_in_qfrc_applied_are_refused() -> None:
    scene = at_rest()
    scene.data.qfrc_applied[2] += 0.1
    with pytest.raises(ValueError, match="`qfrc_applied` of joint `free` in world 0"):
        scene.step()
    scene.data.qfrc_applied[2] -= 0.1
    scene.data.qfrc_applied[:] = 0.0
    with pytest.raises(ValueError, match="with touch.pushing"):
        scene.step()
    with pytest.raises(ValueError, match="is 0.25, `update` wrote 0"):
        other = Scene(palm())
        other.data.qfrc_applied[2] = 0.25
        other.step()


def test_a_whole_state_without_the_sensors_is_refused_until_it_is_clean() -> None:
    scene = at_rest()
    state = np.empty(mujoco.mj_stateSize(scene.model, INTEGRATION))
    mujoco.mj_getState(scene.model, scene.data, state, INTEGRATION)
    scene.data.qpos[2] += 0.002
    scene.touch.reset()
    scene.step(100)
    mujoco.mj_setState(scene.model, scene.data, state, INTEGRATION)
    scene.touch.reset()
    with pytest.raises(ValueError, match="set `qfrc_applied` to 0"):
        scene.step()
    scene.data.qfrc_applied[:] = 0.0
    check_rests(scene)


@pytest.mark.parametrize("spec", [INTEGRATION, mujoco.mjtState.mjSTATE_FULLPHYSICS])
def test_a_state_in_the_middle_of_a_contact_is_replayed_to_the_same_bits(spec: mujoco.mjtState) -> None:
    noisy = SensorVariation(noise_deviation_kpa=0.05, hysteresis=0.05, rate_hz=60.0, jitter=0.1)
    scene = Scene(palm(BLOCK.replace('pos="0.001 0 0.019"', 'pos="0.001 0 0.022" euler="3 5 0"')), variation=noisy)
    scene.step(60)
    assert scene.force_n < -0.2 and abs(scene.data.qvel[2]) > 1e-3
    state, touch = np.empty(mujoco.mj_stateSize(scene.model, spec)), scene.touch.state()
    mujoco.mj_getState(scene.model, scene.data, state, spec)
    first, readings_kpa = scene.step(100), scene.touch.readings_kpa
    for _ in range(2):
        mujoco.mj_setState(scene.model, scene.data, state, spec)
        scene.touch.set_state(touch)
        assert np.array_equal(scene.step(100), first)
        assert np.array_equal(scene.touch.readings_kpa, readings_kpa)
    with pytest.raises(ValueError, match="`state` is of"):
        TouchSensors(palm(), ["touch"], n_worlds=2).set_state(touch)


def test_reset_leaves_nothing() -> None:
    scene = at_rest()
    kept = scene.touch.readings_kpa
    scene.touch.reset()
    assert kept.max() > 1.0 and not scene.touch.readings_kpa.any() and not scene.touch.wrench.any()
    assert not scene.touch.read_ground_truth().any() and not scene.touch.slip_mm_per_s.any()
    with pytest.raises(ValueError, match="`world` is 1, there are 1"):
        scene.touch.reset(1)


def test_slip_and_readings_without_variation_belong_to_the_state() -> None:
    scene = Scene(palm(), friction=0.2, variation=SensorVariation(gain_deviation=0.2))
    scene.step(300)
    assert not scene.touch.slip_mm_per_s.any()
    truth_kpa = scene.touch.read_ground_truth()
    assert not np.allclose(truth_kpa, scene.touch.readings_kpa, rtol=0.01)
    perfect = Scene(palm(), friction=0.2)
    perfect.step(300)
    assert np.array_equal(truth_kpa, perfect.touch.readings_kpa)
    scene.data.qvel[0] = 0.1
    scene.step(10)
    state, slip, truth_kpa = scene.touch.state(), scene.touch.slip_mm_per_s, scene.touch.read_ground_truth()
    # It slips as fast as its lower face moves; it also tips over its edge.
    lower_mm_per_s = 1e3 * (scene.data.qvel[0] - 0.01 * scene.data.qvel[4])
    assert slip[0, 0, 0] == pytest.approx(lower_mm_per_s, rel=0.15) and abs(slip[0, 0, 1]) < 5.0
    assert slip[0, 0, 0] > 30.0
    scene.step(5)
    assert not np.array_equal(scene.touch.slip_mm_per_s, slip)
    scene.touch.set_state(state)
    assert np.array_equal(scene.touch.slip_mm_per_s, slip)
    assert np.array_equal(scene.touch.read_ground_truth(), truth_kpa)


def test_bodies_fall_asleep_and_wake() -> None:
    scene = Scene(palm(option='<flag sleep="enable"/>'))
    scene.step(1500)
    assert scene.force_n == pytest.approx(WEIGHT_N, rel=0.01)
    asleep = Scene(palm(BLOCK.replace("0.019", "0.0175"), option='<flag sleep="enable"/>'))
    asleep.step(20)
    assert asleep.data.qpos[2] > 0.0175


def test_mujocos_force_sensors_feel_gels_within_pushing() -> None:
    holds = '<geom type="box" size="0.01 0.01 0.001" pos="0 0 -0.002" mass="0.05" contype="0" conaffinity="0"/><joint name="up" type="slide" axis="0 0 1" stiffness="5000" damping="20"/><site name="wrist"/>'
    found = palm(palm_holds=holds, rest='<sensor><force name="wrist" site="wrist"/></sensor>')
    scene = Scene(found)
    with pytest.raises(ValueError, match="force sensor `wrist` does not feel"):
        scene.step()
    scene.step(1500, pushing=True)
    assert scene.force_n == pytest.approx(WEIGHT_N, rel=0.01)
    mujoco.mj_step1(scene.model, scene.data)
    with scene.touch.pushing(scene.data):
        mujoco.mj_step2(scene.model, scene.data)
    assert abs(scene.data.sensordata[2]) == pytest.approx(0.15 * 9.81, rel=0.01)
    assert not scene.data.xfrc_applied.any() and not scene.data.qfrc_applied.any()


def test_pushing_is_update_and_leaves_forces_to_the_user() -> None:
    by_update, by_pushing = Scene(palm()), Scene(palm())
    assert by_pushing.step(300, pushing=True) == pytest.approx(by_update.step(300), abs=1e-9)
    thing = by_pushing.model.body("thing").id
    by_pushing.data.xfrc_applied[thing, 2], by_pushing.data.qfrc_applied[2] = 0.1, -0.4
    by_pushing.step(400, pushing=True)
    assert by_pushing.force_n == pytest.approx(WEIGHT_N - 0.3, rel=0.01)
    assert by_pushing.data.xfrc_applied[thing].tolist() == [0.0, 0.0, 0.1, 0.0, 0.0, 0.0]
    mujoco.mj_step1(by_pushing.model, by_pushing.data)
    with pytest.raises(ValueError, match="write it before"), by_pushing.touch.pushing(by_pushing.data):
        by_pushing.data.xfrc_applied[:] = 0.0
        mujoco.mj_step2(by_pushing.model, by_pushing.data)
    with pytest.raises(RuntimeError, match="mine"), by_pushing.touch.pushing(by_pushing.data):
        raise RuntimeError("mine")
    assert by_pushing.data.xfrc_applied[thing, 2] == 0.0


def test_update_and_pushing_take_turns() -> None:
    scene = at_rest()
    scene.step(200, pushing=True)
    assert not scene.data.qfrc_applied.any()
    scene.step(200)
    check_rests(scene, 200)


def test_sensors_of_two_kinds_push_together() -> None:
    spec = mujoco.MjSpec.from_string(f'<mujoco><option timestep="0.001"/><worldbody><body name="palm"/>{BLOCK.replace("0.019", "0.0185").replace("0.006 0.006", "0.02 0.006")}</worldbody></mujoco>')
    for name, x_mm in (("a", -15.0), ("b", 15.0)):
        add_sensor(spec, Sensor.phystac(), body="palm", name=name, position_mm=(x_mm, 0.0, 0.0), quaternion=(0.0, 0.0, np.sqrt(0.5), np.sqrt(0.5)))
    found = spec.compile()
    data = mujoco.MjData(found)
    kinds = [TouchSensors(found, [name], gel=FastGel.phystac()) for name in ("a", "b")]
    for _ in range(600):
        mujoco.mj_step1(found, data)
        with kinds[0].pushing(data), kinds[1].pushing(data):
            mujoco.mj_step2(found, data)
    assert sum(float(kind.wrench[0, 0, 2]) for kind in kinds) == pytest.approx(WEIGHT_N, rel=0.01)
    assert all(kind.wrench[0, 0, 2] < -0.3 for kind in kinds)
    with pytest.raises(ValueError, match="with touch.pushing"):
        for _ in range(2):
            mujoco.mj_step1(found, data)
            for kind in kinds:
                kind.update(data)
            mujoco.mj_step2(found, data)


def worlds(n: int) -> tuple[mujoco.batch.Batch, TouchSensors]:
    found = palm()
    batch = mujoco.batch.Batch(found, n, persistent=True)
    touch = TouchSensors(found, ["touch"], n_worlds=n)
    batch.bind("qpos")[:, 0] += 1e-3 * np.arange(n)
    batch.forward(stage=VELOCITY)
    return batch, touch


def step(batch: mujoco.batch.Batch, touch: TouchSensors, n_steps: int) -> np.ndarray:
    way = []
    for _ in range(n_steps):
        touch.update(batch)
        batch.step(stage=VELOCITY)
        way.append(batch.bind("qpos").copy())
    return np.array(way)


def test_a_world_that_is_reset_begins_anew_and_the_others_go_on() -> None:
    (batch, touch), (other, other_touch) = worlds(3), worlds(3)
    first, went_on = step(batch, touch, 100), step(other, other_touch, 200)
    assert np.array_equal(first, went_on[:100])
    batch.reset(ids=[2], stage=mujoco.mjtStage.mjSTAGE_NONE)
    batch.bind("qpos")[2, 0] += 2e-3
    batch.forward(stage=VELOCITY)
    again = step(batch, touch, 100)
    assert np.array_equal(again[:, 2], first[:, 2])
    assert np.array_equal(again[:, :2], went_on[100:, :2])
    readings_kpa, wrench = touch.readings_kpa.copy(), touch.wrench.copy()
    touch.reset(world=2)
    assert not touch.readings_kpa[2].any() and not touch.wrench[2].any()
    assert np.array_equal(touch.readings_kpa[:2], readings_kpa[:2]) and np.array_equal(touch.wrench[:2], wrench[:2])


def test_a_world_goes_on_from_the_state_of_another() -> None:
    batch, touch = worlds(3)
    step(batch, touch, 40)
    kept, state = touch.state(0), batch.state[0].copy()
    first = step(batch, touch, 50)[:, 0]
    batch.state[2] = state
    touch.set_state(kept, 2)
    for world in (0, 1):
        touch.reset(world)
    batch.forward(stage=VELOCITY)
    assert np.array_equal(step(batch, touch, 50)[:, 2], first)


def test_pushing_steps_a_batch() -> None:
    (batch, touch), (other, other_touch) = worlds(2), worlds(2)
    expected = step(other, other_touch, 200)
    batch.bind("qfrc_applied")[:, 3] = 0.0
    for number in range(200):
        with touch.pushing(batch) as readings_kpa:
            batch.step(stage=VELOCITY)
        assert batch.bind("qpos") == pytest.approx(expected[number], abs=1e-9)
    assert readings_kpa.max() > 1.0 and not batch.bind("xfrc_applied").any()


def test_worlds_that_do_not_go_on_together_are_refused() -> None:
    batch, touch = worlds(2)
    step(batch, touch, 5)
    touch.update(batch)
    batch.step(ids=[0], stage=VELOCITY)
    with pytest.raises(ValueError, match="world 1 has stood still"):
        touch.update(batch)
    found = palm()
    with pytest.raises(ValueError, match="persistent=True"):
        TouchSensors(found, ["touch"], n_worlds=2).update(mujoco.batch.Batch(found, 2))
    with pytest.raises(ValueError, match="no poses yet"):
        TouchSensors(found, ["touch"]).update(mujoco.MjData(found))
    with pytest.raises(ValueError, match="of another model"):
        TouchSensors(found, ["touch"]).update(mujoco.MjData(palm(BLOCK + '<geom size="0.01"/>')))


def test_sensors_that_are_replaced_are_drawn_anew_and_those_of_a_number_are_the_same() -> None:
    scene = Scene(palm(), variation=SensorVariation(gain_deviation=0.2))

    def readings_kpa(number: int) -> list[float]:
        mujoco.mj_resetData(scene.model, scene.data)
        scene.touch.replace(0, number)
        assert not scene.touch.readings_kpa.any()
        scene.step(100)
        return list(map(float, scene.touch.readings_kpa[0, 0]))

    scene.step(100)
    at_first = list(map(float, scene.touch.readings_kpa[0, 0]))
    other = readings_kpa(7)
    assert other != at_first
    assert readings_kpa(0) == at_first and readings_kpa(7) == other
    with pytest.raises(ValueError, match="`world` is 1, there are 1"):
        scene.touch.replace(1, 0)
