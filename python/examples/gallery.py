"""Draws what the other examples compute, for the gallery: each runs as it stands, and a picture is
made of its variables.

    python gallery.py docs/gallery [EXAMPLE ...]
"""

import argparse
import runpy
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

HERE = Path(__file__).parent


def find_a_contact(names: dict[str, Any], axes: Axes) -> None:
    floor, contact, true = names["floor"], names["contact"], names["true"]
    values_kpa = floor.read(contact)
    x_mm, y_mm = floor.x_mm, floor.y_mm
    image = axes.pcolormesh(x_mm, y_mm, values_kpa, shading="nearest", cmap="viridis")
    axes.figure.colorbar(image, label="pressure on the base of the gel, kPa", shrink=0.8)
    axes.plot(*true.position_mm[:2], "wo", mfc="none", ms=14, label="true location")
    axes.plot(*contact.place_mm[:2], "w+", ms=14, label="estimated location")
    axes.legend(loc="upper right", framealpha=0.3, labelcolor="white")
    axes.set(aspect="equal", xlabel="x, mm", ylabel="y, mm")


def imperfect_sensors(names: dict[str, Any], axes: Axes) -> None:
    x_mm, readings_kpa = names["place_mm"][:, 0], names["readings_kpa"]
    for taxel in range(4):
        axes.plot(x_mm, readings_kpa[:, taxel], ".", ms=2, label=f"t{taxel}")
    axes.legend(markerscale=5, title="taxel")
    axes.set(xlabel="location of the ball, mm; each point is another sensor", ylabel="reading, kPa")


def fast_gel_arrays(names: dict[str, Any], axes: Axes) -> None:
    reading = names["reading"]
    gap_mm = reading.gap_mm.min(-1)
    points = axes.scatter(-reading.wrench[:, 2], reading.pressure_kpa.max(-1), c=-gap_mm, s=8, cmap="plasma")
    axes.figure.colorbar(points, label="depth of the deeper body, mm")
    axes.set(xlabel="force of a ball and a cube, N", ylabel="largest pressure of eight taxels, kPa")


def read_a_sensor(names: dict[str, Any], axes: Axes) -> None:
    readings = names["readings"]
    time_s = [reading.time_s for reading in readings]
    readings_kpa = np.array([reading.readings_kpa for reading in readings])
    for taxel, name in enumerate(names["sensor"].taxels):
        axes.plot(time_s, readings_kpa[:, taxel], lw=1, label=name)
    axes.legend(ncols=2, title="taxel")
    axes.set(xlabel="time, s", ylabel="reading, kPa (emulated)")


def recording_to_pandas(names: dict[str, Any], axes: Axes) -> None:
    frames, readings = names["frames"], names["readings"]
    largest = frames.groupby("press")[readings].max()
    image = axes.imshow(largest.to_numpy(), aspect="auto", cmap="viridis")
    axes.figure.colorbar(image, label="largest reading, kPa")
    axes.set(xlabel="taxel", ylabel="press", xticks=range(len(readings)), xticklabels=names["recording"].taxels)


def press_frame_by_frame(names: dict[str, Any], axes: Axes) -> None:
    """Goes the rest of the way from the example's last pose."""
    state, deep, aside = names["state"], names["deep"], names["aside"]
    way = np.linspace(0.0, 1.0, 31)
    start_mm, end_mm = np.array(aside.position_mm), np.array(deep.position_mm)
    poses = [type(deep)(tuple(start_mm + part * (end_mm - start_mm))) for part in way]
    readings_kpa = np.array([state.step(0.02, pose) for pose in poses])
    for taxel in range(4):
        axes.plot([pose.position_mm[0] for pose in poses], readings_kpa[:, taxel], label=f"t{taxel}")
    axes.legend(title="taxel")
    axes.set(xlabel="location of the ball on its way back, mm", ylabel="pressure at the port, kPa (simulated)")


def looks_like(picture: Path, other: Path, is_real_time: bool) -> bool:
    """Whether two pictures differ by one step of a color at most, as rounding differs from processor
    to processor; or, of what is read in real time, by 1 % of the range of colors on average. Two
    readings of an emulated sensor differ by 0.55 to 0.67 %, pictures of two examples by 2.9 %.
    """
    pixels, others = plt.imread(picture), plt.imread(other)
    if pixels.shape != others.shape:
        return False
    differences = np.abs(pixels - others)
    return bool(differences.max() < 1.5 / 255 or is_real_time and differences.mean() < 0.01)


PICTURES: dict[str, Callable[[dict[str, Any], Axes], None]] = {
    function.__name__: function
    for function in (fast_gel_arrays, find_a_contact, imperfect_sensors, press_frame_by_frame, read_a_sensor, recording_to_pandas)
}
REAL_TIME = {read_a_sensor.__name__}  # its frames come at slightly other times each run


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, help="folder of the pictures")
    parser.add_argument("examples", nargs="*", metavar="EXAMPLE", help=f"which to draw (default: all): {', '.join(PICTURES)}")
    asked = parser.parse_args()
    unknown = [name for name in asked.examples if name not in PICTURES]
    if unknown:
        parser.error(f"there is no picture of `{unknown[0]}`; there are {', '.join(PICTURES)}")
    asked.folder.mkdir(parents=True, exist_ok=True)
    for name in asked.examples or PICTURES:
        names = runpy.run_path(str(HERE / f"{name}.py"))
        figure, axes = plt.subplots(figsize=(5.6, 3.5), layout="constrained")
        PICTURES[name](names, axes)
        picture, new = asked.folder / f"{name}.png", asked.folder / f"{name}.new.png"
        figure.savefig(new, dpi=110)
        plt.close(figure)
        if picture.exists() and looks_like(new, picture, name in REAL_TIME):
            new.unlink()
            print(f"left {picture}: the new one looks the same (delete it to draw it anew)", file=sys.stderr)
            continue
        new.replace(picture)
        print(f"wrote {picture}", file=sys.stderr)


if __name__ == "__main__":
    main()
