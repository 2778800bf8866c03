"""Sensor variation and trained twins as arrays: what is certain is as in Rust, what is random has the deviations that were asked for."""

import hashlib
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from test_arrays import LIBRARIES, Library, library

from twintac import Body, Error, FastGel, SensorBatch, SensorVariation, Shape, Twin, arrays
from twintac.arrays._file import read_tensors

N_SENSORS, N_TAXELS, DT_S = 64, 8, 0.01
TOP_MM = 8.5


@pytest.fixture(scope="module", params=LIBRARIES)
def lib(request: pytest.FixtureRequest) -> Library:
    return library(request.param)


def presses_mm(n_moments: int = 40) -> np.ndarray[Any, Any]:
    """Origins of a ball that goes down and up again, elsewhere on each sensor, `[n_moments, n_sensors, 1, 3]`."""
    random = np.random.default_rng(1)
    at_mm = random.uniform((-10.0, -5.0), (10.0, 5.0), (N_SENSORS, 2))
    depth_mm = 2.0 * np.sin(np.pi * np.arange(n_moments) / (n_moments - 1)) - 0.2
    position_mm = np.zeros((n_moments, N_SENSORS, 1, 3))
    position_mm[..., 0, :2], position_mm[..., 0, 2] = at_mm, TOP_MM - depth_mm[:, None]
    return position_mm


def stepped(lib: Library, variation: SensorVariation, key: Any, pressure_kpa: Any) -> list[Any]:
    """What buses deliver, moment by moment."""
    spread = arrays.spread(variation, like=lib.like)
    drawn = arrays.draw(spread, key, N_TAXELS)
    bus = arrays.connected(spread, drawn)
    found = []
    for pressures in pressure_kpa:
        bus, delivered = arrays.deliver(spread, drawn, bus, DT_S, lib.array(pressures))
        found.append(np.asarray(delivered))
    return found


def in_rust(
    variation: SensorVariation | None, position_mm: np.ndarray[Any, Any], twin: Twin | None = None
) -> list[np.ndarray[Any, Any]]:
    batch = SensorBatch(
        FastGel.phystac(), [Body(Shape.sphere(5.0))], N_SENSORS, variation=variation, twin=twin
    )
    upright = np.array([0.0, 0.0, 0.0, 1.0])
    found = []
    for positions in position_mm:
        poses = np.concatenate([positions[:, 0], np.tile(upright, (N_SENSORS, 1))], axis=1)
        found.append(batch.step(DT_S, poses)[0])
    return found


@pytest.mark.parametrize(
    "variation",
    [
        SensorVariation(hysteresis=0.1),
        SensorVariation(quantum_kpa=0.05),
        SensorVariation(rate_hz=40.0),
        SensorVariation(cross_talk=0.1, hysteresis=0.05, rate_hz=25.0),
        SensorVariation(dead_chance=1.0),
        SensorVariation(stuck_chance=1.0),
        SensorVariation(late_chance=1.0, rate_hz=50.0),
    ],
    ids=["hysteresis", "resolution", "rate", "cross-talk", "dead", "stuck", "late"],
)
def test_what_is_certain_is_as_in_rust(variation: SensorVariation, lib: Library) -> None:
    position_mm = presses_mm()
    perfect_kpa = in_rust(None, position_mm)
    expected = in_rust(variation, position_mm)
    found = stepped(lib, variation, arrays.keys(0, N_SENSORS, like=lib.like), perfect_kpa)
    # One step of the resolution where rounding differs, in hardly any reading.
    off = np.abs(np.array(found) - np.array(expected)) > 1e-4 * np.abs(expected).max()
    assert off.mean() < (1e-3 if variation.fields()["quantum_kpa"] else 1e-9)


def test_random_numbers_have_the_deviations_asked_for(lib: Library) -> None:
    n_sensors = 20_000
    asked = {
        "gain_deviation": 0.1,
        "growth_deviation_per_kpa": 0.02,
        "offset_deviation_kpa": 0.3,
        "drift_deviation_kpa_per_k": 0.05,
    }
    variation = SensorVariation(
        **asked, dead_chance=0.1, stuck_chance=0.2, late_chance=0.3, place_deviation_mm=0.2,
        height_deviation_mm=0.1, tilt_deviation_rad=0.02, turn_deviation_rad=0.05,
    )  # fmt: skip
    spread = arrays.spread(variation, like=lib.like)
    drawn = arrays.draw(spread, arrays.keys(3, n_sensors, like=lib.like), N_TAXELS)
    values = (drawn.gain, drawn.growth_per_kpa, drawn.offset_kpa, drawn.drift_kpa_per_k)
    for deviation, drawn_values in zip(asked.values(), values, strict=True):
        spread_of = np.asarray(drawn_values)
        assert np.std(spread_of) == pytest.approx(deviation, rel=0.02)
        # Neither taxels of a sensor nor neighbouring sensors go together.
        together = np.corrcoef(spread_of.T) - np.eye(N_TAXELS)
        assert np.abs(together).max() < 0.03
        assert abs(np.corrcoef(spread_of[:-1, 0], spread_of[1:, 0])[0, 1]) < 0.03
    fates = [np.asarray(fate).mean() for fate in (drawn.is_dead, drawn.is_stuck, drawn.is_late)]
    assert fates == pytest.approx([0.1, 0.2, 0.3], abs=0.005)
    assert np.std(np.asarray(drawn.offset_mm), axis=0) == pytest.approx([0.2, 0.2, 0.1], rel=0.03)
    turns = np.asarray(drawn.rotation)
    assert np.allclose(turns @ turns.transpose(0, 2, 1), np.eye(3), atol=1e-5)
    assert np.std(turns[:, 1, 0]) == pytest.approx(0.05, rel=0.03)


def test_noise_and_temperature_are_as_wide_and_as_long_as_asked_for(lib: Library) -> None:
    none_kpa = np.zeros((200, N_SENSORS, N_TAXELS))
    key = arrays.keys(5, N_SENSORS, like=lib.like)
    noise_kpa = np.array(stepped(lib, SensorVariation(noise_deviation_kpa=0.05), key, none_kpa))
    assert np.std(noise_kpa) == pytest.approx(0.05, rel=0.02)
    assert abs(np.corrcoef(noise_kpa[1:].ravel(), noise_kpa[:-1].ravel())[0, 1]) < 0.02
    wandering = SensorVariation(
        drift_kpa_per_k=1.0, temperature_deviation_k=0.5, temperature_time_s=0.1
    )
    drift_kpa = np.array(stepped(lib, wandering, key, none_kpa))[..., 0]
    assert np.std(drift_kpa) == pytest.approx(0.5, rel=0.1)
    after = np.mean(drift_kpa[10:] * drift_kpa[:-10]) / np.var(drift_kpa)
    assert after == pytest.approx(np.exp(-1.0), abs=0.08)


def test_frames_jitter_about_their_rate(lib: Library) -> None:
    rising = np.arange(400.0)[:, None, None] + np.zeros((400, N_SENSORS, N_TAXELS))
    key = arrays.keys(5, N_SENSORS, like=lib.like)
    delivered = np.array(stepped(lib, SensorVariation(rate_hz=20.0, jitter=0.2), key, rising))
    n_frames = (np.diff(delivered[..., 0], axis=0) > 0.0).sum(axis=0)
    assert n_frames.mean() == pytest.approx(400 * DT_S * 20.0, rel=0.05) and np.std(n_frames) > 0.0


def test_libraries_draw_the_same_numbers() -> None:
    variation = SensorVariation(gain_deviation=0.1, noise_deviation_kpa=0.05, jitter=0.1, rate_hz=30.0)
    drawn = {}
    for name in LIBRARIES:
        try:
            lib = library(name)
        except pytest.skip.Exception:
            continue
        key = arrays.keys(7, N_SENSORS, like=lib.like)
        drawn[name] = np.array(stepped(lib, variation, key, np.ones((20, N_SENSORS, N_TAXELS))))
    for delivered in drawn.values():
        assert np.allclose(delivered, drawn["numpy"], atol=2e-6)


def test_a_sensor_depends_on_its_key_alone() -> None:
    spread = arrays.spread(SensorVariation(gain_deviation=0.1))
    key = arrays.keys(1, 3, 5)
    drawn = arrays.draw(spread, key, N_TAXELS)
    alone = arrays.draw(spread, key[1, 2], N_TAXELS)
    assert np.array_equal(np.asarray(drawn.gain)[1, 2], np.asarray(alone.gain))
    other = arrays.draw(spread, arrays.keys(2, 3, 5), N_TAXELS)
    assert not np.array_equal(np.asarray(drawn.gain), np.asarray(other.gain))
    assert len(np.unique(arrays.keys(1, 100_000))) > 99_990


def test_chosen_sensors_are_drawn_anew(lib: Library) -> None:
    spread = arrays.spread(SensorVariation(gain_deviation=0.1), like=lib.like)
    before = arrays.draw(spread, arrays.keys(1, 4, like=lib.like), N_TAXELS)
    other = arrays.draw(spread, arrays.keys(2, 4, like=lib.like), N_TAXELS)
    chosen = lib.xp.asarray(np.array([True, False, True, False]))
    gain = np.asarray(arrays.select(chosen, other, before).gain)
    assert np.array_equal(gain[::2], np.asarray(other.gain)[::2])
    assert np.array_equal(gain[1::2], np.asarray(before.gain)[1::2])


def test_installed_elsewhere_a_sensor_reads_what_is_there() -> None:
    spread = arrays.spread(SensorVariation(place_deviation_mm=1.0, turn_deviation_rad=0.3))
    drawn = arrays.draw(spread, arrays.keys(1, 2), N_TAXELS)
    position_mm = np.array([[[1.0, 2.0, 7.0]]] * 2)
    upright = np.eye(3)[None, None] * np.ones((2, 1, 1, 1))
    moved_mm, turned = arrays.installed(drawn, position_mm, upright)
    for sensor in range(2):
        turn, offset_mm = np.asarray(drawn.rotation)[sensor], np.asarray(drawn.offset_mm)[sensor]
        assert np.allclose(np.asarray(moved_mm)[sensor, 0], offset_mm + turn @ position_mm[sensor, 0])
        assert np.allclose(np.asarray(turned)[sensor, 0], turn)
        wrench = np.concatenate([turn @ [1.0, 2.0, 3.0], turn @ [4.0, 5.0, 6.0]])
        back = arrays.as_described(drawn, np.tile(wrench, (2, 1, 1)))
        assert np.allclose(np.asarray(back)[sensor, 0], [1.0, 2.0, 3.0, 4.0, 5.0, 6.0], atol=1e-5)


def test_a_stiffer_gel_has_larger_pressures_and_forces_by_the_same_factor() -> None:
    spread = arrays.spread(SensorVariation(modulus_deviation=0.4))
    drawn = arrays.draw(spread, arrays.keys(1, 2000), N_TAXELS)
    modulus = np.asarray(drawn.modulus)
    assert modulus.shape == (2000,) and np.std(np.log(modulus)) == pytest.approx(0.4, rel=0.05)
    assert abs(np.mean(np.log(modulus))) < 0.03
    for values in (np.ones((2000, N_TAXELS)), np.ones((2000, 3, 6))):
        stiff = np.asarray(arrays.stiffened(drawn, values))
        assert stiff.shape == values.shape and np.all(stiff[7] == modulus[7])


def without_its_perceptron(model: Path, folder: Path) -> Path:
    """The same model, of the variant without a perceptron."""
    record = json.loads((model / "twin.json").read_text(encoding="utf-8"))
    record["variant"], record["start"]["hidden"] = "pressure+memory", []
    data = (model / "weights.safetensors").read_bytes()
    tensors = {name: array for name, array in read_tensors(data).items() if "layer" not in name}
    header: dict[str, Any] = {}
    body = b""
    for name, array in tensors.items():
        ends = [len(body), len(body) + array.nbytes]
        header[name] = {"dtype": "F32", "shape": array.shape, "data_offsets": ends}
        body += array.tobytes()
    start = json.dumps(header).encode()
    changed = {
        "twin.json": json.dumps(record).encode(),
        "weights.safetensors": len(start).to_bytes(8, "little") + start + body,
    }
    checksums = json.loads((model / "checksums.json").read_text(encoding="utf-8"))
    folder.mkdir()
    for name in checksums["sha256"]:
        contents = changed.get(name, (model / name).read_bytes())
        (folder / name).write_bytes(contents)
        checksums["sha256"][name] = hashlib.sha256(contents).hexdigest()
    (folder / "checksums.json").write_text(json.dumps(checksums), encoding="utf-8")
    return folder


@pytest.mark.parametrize("has_perceptron", [False, True])
def test_a_twin_reads_what_rust_reads(
    has_perceptron: bool, trained: Path, tmp_path: Path, lib: Library
) -> None:
    folder = trained / "model"
    if not has_perceptron:
        folder = without_its_perceptron(folder, tmp_path / "model")
    twin = arrays.twin(folder, like=lib.like)
    assert bool(twin.layers) == has_perceptron
    position_mm = presses_mm()
    pressure_kpa = in_rust(None, position_mm)
    expected = np.array(in_rust(None, position_mm, Twin.load(folder)))
    memory = arrays.rested(twin, lib.array(pressure_kpa[0]))
    for pressures, reads in zip(pressure_kpa, expected, strict=True):
        memory, readings_kpa = arrays.read_twin(twin, memory, DT_S, lib.array(pressures))
        assert np.abs(np.asarray(readings_kpa) - reads).max() < 1e-4 * np.abs(expected).max()


def test_a_contact_has_hysteresis(lib: Library) -> None:
    touches = lib.xp.asarray(np.array([False, False]))
    seen = []
    for value in ([0.2, 0.6], [0.6, 0.4], [0.4, 0.2], [0.0, 0.4]):
        touches = arrays.contact(touches, lib.array(value), on=0.5, off=0.3)
        seen.append(np.asarray(touches).tolist())
    assert seen == [[False, True], [True, True], [True, False], [False, False]]


def test_a_history_keeps_the_last_frames(lib: Library) -> None:
    frames = [lib.array(np.full((2, 3), float(number))) for number in range(4)]
    kept = arrays.history(frames[0], 3)
    for number in (1, 2, 3):
        is_new = lib.xp.asarray(np.array([True, number != 2]))
        kept = arrays.push(kept, frames[number], is_new)
    assert np.asarray(kept)[..., 0].tolist() == [[1.0, 2.0, 3.0], [0.0, 1.0, 3.0]]


def test_what_cannot_be_is_refused_by_name(trained: Path, tmp_path: Path) -> None:
    spread = arrays.spread(SensorVariation())
    key = arrays.keys(0, 2)
    calls: dict[str, Callable[[], Any]] = {
        "seed": lambda: arrays.keys(-1, 2),
        "off": lambda: arrays.contact(np.zeros(1, bool), np.zeros(1), on=0.1, off=0.2),
        "n_frames": lambda: arrays.history(np.zeros((1, 8)), 0),
        "n_taxels": lambda: arrays.draw(spread, key, 0),
        "pressure_kpa": lambda: arrays.read_twin(
            arrays.twin(trained / "model"),
            arrays.Relaxed(*(np.zeros(1),) * 3), DT_S, np.zeros((1, 3), np.float32),
        ),
    }  # fmt: skip
    for field, call in calls.items():
        with pytest.raises(Error) as raised:
            call()
        assert raised.value.field == field
    with pytest.raises(Error) as raised:
        arrays.twin(tmp_path / "nothing")
    assert raised.value.file is not None and raised.value.file.endswith("twin.json")
