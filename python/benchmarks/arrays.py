"""Compares the surrogate of the gel as arrays with that of Rust, in accuracy and speed: writes
docs/benchmarks/arrays.json and arrays.md.

pip install './python[arrays]' torch 'jax[cpu]'
python python/benchmarks/arrays.py
"""

import argparse
import importlib.metadata
import json
import os
import platform
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from twintac import Body, FastGel, arrays

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "python/tests"))

from contacts import Contacts, contacts, meshes, simple  # noqa: E402

COMMAND = "python python/benchmarks/arrays.py"
SENSORS = {"phystac": FastGel.phystac, "phystac_tip": FastGel.phystac_tip}
N_TOGETHER = 500
RATES = (1_024, 8_192)
LEAST_S, MOST_CALLS = 3.0, 20
WITHIN = 1e-4


class Library(NamedTuple):
    """A library: its functions, an array, a compiler of functions, and a function that waits for a
    result.
    """

    xp: Any
    like: Any
    compiled: Callable[[Any], Any]
    wait: Callable[[Any], Any]


def libraries() -> dict[str, Library]:
    """The installed libraries."""
    found = {"numpy": Library(np, np.zeros(1, np.float32), lambda f: f, lambda r: r)}
    try:
        import array_api_compat.torch as xp
        import torch
    except ImportError:
        pass
    else:
        found["torch"] = Library(xp, torch.zeros(1), lambda f: f, lambda r: r)
    try:
        import jax
    except ImportError:
        pass
    else:
        found["jax"] = Library(jax.numpy, jax.numpy.zeros(1), jax.jit, jax.block_until_ready)
    return found


def parts(drawn: Contacts) -> list[Contacts]:
    """The contacts in parts of at most `N_TOGETHER`, which fit into a processor's memory."""
    starts = range(0, len(drawn.number), N_TOGETHER)
    return [Contacts._make(value[start : start + N_TOGETHER] for value in drawn) for start in starts]


def given(lib: Library, drawn: Contacts) -> tuple[Any, Any, Any]:
    """Indices of shapes, positions and quaternions as arrays of a library."""
    pose = (lib.xp.asarray(value.astype(np.float32)) for value in (drawn.position_mm, drawn.quaternion))
    return lib.xp.asarray(drawn.number), *pose


def read(gel: arrays.Gel, shapes: arrays.Shapes, number: Any, position_mm: Any, quaternion: Any) -> Any:
    """From indices of shapes and poses to a reading."""
    return arrays.read(gel, arrays.choose(shapes, number), position_mm, arrays.rotation_of(quaternion))


def beside_rust(libs: dict[str, Library], n_contacts: int) -> dict[str, Any]:
    """Differences from Rust, for contacts of one to three bodies of all shapes on each sensor."""
    found: dict[str, Any] = {}
    own, rusts = zip(*simple(), *meshes())
    for sensor, load in SENSORS.items():
        fast = load()
        gel, shapes = arrays.load(fast), arrays.stack(own)
        drawn = [
            part for n_bodies in (1, 2, 3) for part in parts(contacts(gel, n_contacts // 3 + 1, n_bodies, len(own), n_bodies))
        ]
        # Rust treats thin triangle meshes in another way.
        drawn = [_thick(part, len(simple())) for part in drawn]
        expected = [part.by_rust(fast, list(rusts)) for part in drawn]
        largest = [max(np.abs(both[place]).max() for both in expected) for place in (0, 1)]
        found[sensor] = {"contacts": sum(len(part.number) for part in drawn), "largest_kpa": float(largest[0])}
        for name, lib in libs.items():
            its_gel, its_shapes = arrays.load(fast, like=lib.like), arrays.convert(shapes, lib.like)
            work = lib.compiled(read)
            errors: list[Any] = []
            wrenches: list[Any] = []
            for part, both in zip(drawn, expected):
                reading = work(its_gel, its_shapes, *given(lib, part))
                errors.append(np.abs(np.asarray(reading.pressure_kpa) - both[0]).max(axis=-1))
                wrenches.append(np.abs(np.asarray(reading.wrench) - both[1]).max(axis=-1))
            error_kpa, wrench = np.concatenate(errors), np.concatenate(wrenches)
            found[sensor][name] = {
                "largest_error_kpa": float(error_kpa.max()),
                "largest_error_of_largest": float(error_kpa.max() / largest[0]),
                "mean_error_kpa": float(error_kpa.mean()),
                "largest_wrench_error_of_largest": float(wrench.max() / largest[1]),
                "beyond_tolerance": int(((error_kpa > WITHIN * largest[0]) | (wrench > WITHIN * largest[1])).sum()),
            }
            print(sensor, name, found[sensor][name], flush=True)
    return found


def _thick(drawn: Contacts, n_simple: int) -> Contacts:
    """The same contacts, with triangle meshes upright: they are then thicker than deep."""
    is_sampled = (drawn.number >= n_simple)[..., None]
    return drawn._replace(quaternion=np.where(is_sampled, [0.0, 0.0, 0.0, 1.0], drawn.quaternion))


def slopes(libs: dict[str, Library], n_contacts: int) -> dict[str, Any]:
    """Gradients in single precision along random directions, compared with central differences in
    double precision.
    """
    fast, own = FastGel.phystac(), [own for own, _ in simple()]
    shapes, exact = arrays.stack(own), arrays.load(fast, like=np.zeros(1))
    drawn = contacts(exact, n_contacts, 2, len(own), 9, depth_mm=3.0)
    way = np.random.default_rng(1).normal(size=drawn.position_mm.shape)
    ends = [drawn._replace(position_mm=drawn.position_mm + step * way) for step in (1e-5, -1e-5)]
    above, below = (np.concatenate([part.by_arrays(exact, shapes).pressure_kpa.sum(-1) for part in parts(end)]) for end in ends)
    difference = (above - below) / 2e-5
    found: dict[str, Any] = {}
    for name, lib in libs.items():
        gel, its_shapes = arrays.load(fast, like=lib.like), arrays.convert(shapes, lib.like)

        def felt(position_mm: Any, number: Any, quaternion: Any) -> Any:
            return read(gel, its_shapes, number, position_mm, quaternion).pressure_kpa.sum()

        number, position_mm, quaternion = given(lib, drawn)
        if name == "jax":
            import jax

            slope = np.asarray(jax.jit(jax.grad(felt))(position_mm, number, quaternion))
        elif name == "torch":
            felt(position_mm.requires_grad_(), number, quaternion).backward()
            slope = position_mm.grad.numpy()
        else:
            continue
        along = (slope * way).sum(axis=(-2, -1))
        size = np.maximum(np.abs(difference), 1e-3 * np.abs(difference).max())
        found[name] = {
            "contacts": n_contacts,
            "within_2_percent": float((np.abs(along - difference) < 0.02 * size).mean()),
            "no_numbers": int((~np.isfinite(slope)).sum()),
        }
    return found


def timed(call: Callable[[], Any], n_sensors: int) -> dict[str, float]:
    """The best rate of several calls, and the processor time of a sensor, over all threads."""
    call()
    best_s, own_s, n_calls, started = np.inf, 0.0, 0, time.perf_counter()
    while n_calls < 2 or (time.perf_counter() - started < LEAST_S and n_calls < MOST_CALLS):
        wall, processor = time.perf_counter(), time.process_time()
        call()
        best_s = min(best_s, time.perf_counter() - wall)
        own_s += time.process_time() - processor
        n_calls += 1
    return {"sensors_per_s": n_sensors / best_s, "processor_us_per_sensor": 1e6 * own_s / n_calls / n_sensors}


def rates(libs: dict[str, Library]) -> dict[str, Any]:
    """Rates with one body on each sensor: balls, boxes and cylinders, up to 2 mm deep."""
    fast = FastGel.phystac()
    own, rusts = zip(*simple())
    shapes, gel = arrays.stack(own), arrays.load(fast)
    found: dict[str, Any] = {}
    for n in RATES:
        drawn = contacts(gel, n, 1, len(own), 4, depth_mm=2.0)
        batch = fast.batch([Body(shape) for shape in rusts], 1)
        poses = np.concatenate([drawn.position_mm, drawn.quaternion], axis=-1)[:, 0]
        row = {"rust, one thread": timed(lambda: batch.read(poses, drawn.number[:, 0]), n)}
        for name, lib in libs.items():
            its_gel, its_shapes = arrays.load(fast, like=lib.like), arrays.convert(shapes, lib.like)
            work, inputs = lib.compiled(read), given(lib, drawn)
            row[name] = timed(lambda: lib.wait(work(its_gel, its_shapes, *inputs)), n)
        found[str(n)] = row
        print(n, row, flush=True)
    return found


def page(results: dict[str, Any]) -> str:
    """The results as a Markdown page."""
    machine, rows = results["machine"], []
    for sensor, found in results["beside_rust"].items():
        for name in results["libraries"]:
            own = found[name]
            part, wrench = (f"{own[key]:.1e}" for key in ("largest_error_of_largest", "largest_wrench_error_of_largest"))
            rows.append(f"| {sensor} | {name} | {own['largest_error_kpa']:.1e} | {part} | {wrench} | {own['beyond_tolerance']} |")
    speeds = [
        f"| {name} | {n} | {own['sensors_per_s']:,.0f} | {own['processor_us_per_sensor']:,.0f} |"
        for n, row in results["rates"].items()
        for name, own in row.items()
    ]
    slope = "; ".join(
        f"{name}: {100 * own['within_2_percent']:.1f} %, {own['no_numbers']} are NaN" for name, own in results["slopes"].items()
    )
    versions = ", ".join(f"{name} {version}" for name, version in results["libraries"].items())
    is_busy = machine["load_average"] > machine["processors"]
    busy = "; other work made all rates lower" if is_busy else ""
    return "\n".join(
        [
            "# The surrogate of the gel as arrays",
            "",
            f"Made by `{results['command']}` on {machine['processor']}, {machine['processors']} processors, without a GPU (simulated data): {versions}. Load average at the end: "
            f"{machine['load_average']:.1f}{busy}. Rates on a GPU have not been measured.",
            "",
            f"The table has the largest differences from Rust's `FastBatch` on {results['beside_rust']['phystac']['contacts']:,} random contacts of one to three bodies of all shapes, "
            f"and the number of contacts that differ by more than {WITHIN:g} of the largest. Where Rust's readings jump, rounding decides on which side of the jump a contact is.",
            "",
            "| sensor | library | pressure, kPa | of the largest pressure | of the largest of the wrench | contacts beyond |",
            "|---|---|---:|---:|---:|---:|",
            *rows,
            "",
            f"Gradients are compared with central differences along random directions, on {next(iter(results['slopes'].values()))['contacts']:,} contacts of two bodies. Within 2 %: {slope}.",
            "",
            "One body on each sensor. Processor time counts all threads.",
            "",
            "| | sensors | sensors a second | processor time a sensor, µs |",
            "|---|---:|---:|---:|",
            *speeds,
            "",
        ]
    )


def main() -> None:
    """Measures everything, and writes the results."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--contacts", type=int, default=10_000, help="contacts of each sensor beside Rust's")
    n_contacts = parser.parse_args().contacts
    libs = libraries()
    cpu = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")), platform.processor())
    results = {
        "command": f"{COMMAND} --contacts {n_contacts}",
        "provenance": "simulated",
        "libraries": {name: importlib.metadata.version(name) for name in libs},
        "rates": rates(libs),
        "slopes": slopes(libs, n_contacts // 5),
        "beside_rust": beside_rust(libs, n_contacts),
        "machine": {"processor": cpu, "processors": os.cpu_count(), "load_average": os.getloadavg()[0]},
    }
    folder = ROOT / "docs/benchmarks"
    (folder / "arrays.json").write_text(json.dumps(results, indent=2) + "\n")
    (folder / "arrays.md").write_text(page(results))
    print(page(results))


if __name__ == "__main__":
    main()
