"""Tests of the results and errors of make.py."""

from __future__ import annotations

import hashlib
import json
import math
from pathlib import Path
from typing import Any

import pytest
from conftest import HERE, run

from checks.files import read_stl
from checks.shapes import distance
from mechanics.gel import edge_height, top_height
from mechanics.geometry import Gel, GeometryError, Indenter, load
from mechanics.layout import Layout
from mechanics.parts.gel import gel
from mechanics.parts.indenter import exact_to, indenter
from mechanics.parts.port_plate import anchors, port_plate
from mechanics.triangles import triangles


def written(value: Any, folder: Path) -> Path:
    """A geometry.json with a value."""
    path = folder / "geometry.json"
    path.write_text(json.dumps(value))
    return path


def test_all_parts_are_there(block_folder: Path) -> None:
    figures = json.loads((block_folder / "mechanics.json").read_text())
    names = [part["name"] for part in figures["parts"]]
    assert len([name for name in names if name.startswith("indenter-")]) == 7
    for name in names:
        assert block_folder.joinpath(f"{name}.step").read_text().startswith("ISO-10303-21;")
        assert read_stl(block_folder / f"{name}.stl").volume > 0.0
    assert not list(block_folder.glob(".*.tmp"))


def test_the_same_input_gives_the_same_bytes(block_folder: Path, tmp_path: Path) -> None:
    ran = run("make.py", HERE / "phystac-ms5837.geometry.json", "--out", tmp_path, "--only", "lid")
    assert ran.returncode == 0, ran.stderr
    for suffix in ("step", "stl"):
        sums = [
            hashlib.sha256((folder / f"lid.{suffix}").read_bytes()).hexdigest() for folder in (block_folder, tmp_path)
        ]
        assert sums[0] == sums[1], suffix


def _geometry() -> dict[str, Any]:
    value: dict[str, Any] = json.loads((HERE / "phystac-ms5837.geometry.json").read_text())
    return value


def _set(value: Any, path: tuple[str | int, ...], to: Any) -> None:
    for key in path[:-1]:
        value = value[key]
    value[path[-1]] = to


@pytest.mark.parametrize(
    ("path", "to", "said"),
    [
        (("board", "holes", 0, "position_mm"), [-19.0, 0.0], "move the hole to at least"),
        (("board", "holes", 0, "screw"), "M3", "board.holes[0].screw: only M2"),
        (("board", "holes"), [], "two M2 holes or more"),
        (("board", "top_z_mm"), -2.0, "chips must reach"),
        (("board", "connector", "opens_toward"), [1, 1], "opens_toward"),
        (("gel", "solid", "kind"), "stl", "only `block` and `dome`"),
        (("gel", "bounds_mm"), [[0, 0, 0], [0, 1, 1]], "bounds_mm"),
        (("gel", "volume_mm3"), "much", "gel.volume_mm3: expected a number"),
        (("chip", "footprint_confirmed"), 1, "footprint_confirmed"),
        (("taxels", 0, "position_mm"), [100.0, 0.0, 0.0], "is not on the board"),
        (("taxels",), [], "geometry.taxels is empty"),
        (("shell", "height_mm"), 1.0, "too thin for screw heads"),
        (("indenters", 0, "shape"), {"kind": "stl", "path": "a.stl"}, "has no STEP"),
        (("indenters", 1, "shape", "edge_radius_mm"), "round", "expected a length"),
    ],
)
def test_what_cannot_be_built_is_an_error(path: tuple[str | int, ...], to: Any, said: str, tmp_path: Path) -> None:
    value = _geometry()
    _set(value, path, to)
    with pytest.raises(GeometryError) as caught:
        layout = Layout(load(written(value, tmp_path)))
        edge_height(layout.geometry.gel)
        for each in layout.geometry.indenters[:2]:
            indenter(each)
    assert said in str(caught.value)


def test_errors_reach_the_command_line(tmp_path: Path) -> None:
    for arguments, said in (
        ([tmp_path / "none.json"], "can't be read"),
        ([HERE / "phystac.geometry.json", "--only", "wheel"], "no part `wheel`"),
    ):
        ran = run("make.py", *arguments, "--out", tmp_path / "out")
        assert (ran.returncode, said in ran.stderr) == (2, True), ran.stderr
    ran = run("check.py", tmp_path)
    assert (ran.returncode, "error:" in ran.stderr) == (2, True)


def _gel(solid: dict[str, Any], low: tuple[float, float], high: tuple[float, float], top: float) -> Gel:
    return Gel(solid, 0.0, (*low, 0.0), (*high, top))


def test_a_dome_is_the_described_one() -> None:
    """An asymmetric dome with its crown at an edge: volume and heights agree with the formula of
    the description.
    """
    solid = {"kind": "dome", "x_mm": [-4.0, 8.0], "y_mm": [-3.0, 5.0], "crown_at_mm": [-4.0, 1.0], "crown_mm": 9.0}
    solid |= {"drop_x_mm": [0.0, 3.0], "drop_y_mm": [2.0, 1.0]}
    of = _gel(solid, (-4.0, -3.0), (8.0, 5.0), 9.0)
    made = gel(of)
    mean_fall = 12.0 * 3.0 / (3 * 12.0) + (4.0 * 2.0 + 4.0 * 1.0) / (3 * 8.0)
    assert made.volume == pytest.approx(12.0 * 8.0 * (9.0 - mean_fall), rel=1e-6)
    assert top_height(of, 8.0, -3.0) == pytest.approx(9.0 - 3.0 - 2.0)
    corners, _ = triangles(made.solids()[0])
    upper = [p for p in corners.tolist() if p[2] > 3.9]
    assert (
        max(abs(top_height(of, x, y) - z) for x, y, z in upper if z > edge_height(of) + 0.01 and _is_top(of, x, y, z))
        < 1e-3
    )


def _is_top(of: Gel, x: float, y: float, z: float) -> bool:
    is_inside = of.low[0] < x < of.high[0] and of.low[1] < y < of.high[1]
    return is_inside or z >= top_height(of, x, y) - 1e-3


def test_a_block_has_round_edges_that_meet_in_a_mitre() -> None:
    x, y, z, r = 20.0, 10.0, 6.0, 1.5
    of = _gel({"kind": "block", "size_mm": [x, y, z], "edge_radius_mm": r}, (-10.0, -5.0), (10.0, 5.0), z)
    quarter = math.pi / 4
    expected = x * y * z - 2 * (x + y) * r**2 * (1 - quarter) + 8 * r**3 * (5 / 6 - quarter)
    assert gel(of).volume == pytest.approx(expected, rel=1e-6)
    assert edge_height(of) == pytest.approx(z - r)


@pytest.mark.parametrize("edge", [0.0, 0.5])
def test_other_sizes_of_shapes_are_exact_too(edge: float) -> None:
    sizes = {"height_mm": 8.0, "edge_radius_mm": edge}
    for shape in (
        {"kind": "x", "length_mm": 18.0, "width_mm": 9.0, **sizes},
        {"kind": "wedge", "angle_rad": 1.0, "length_mm": 12.0, **sizes},
        {"kind": "triangle", "side_mm": 20.0, **sizes},
        {"kind": "box", "size_mm": [12.0, 9.0, 8.0], "edge_radius_mm": edge},
    ):
        of = Indenter("other", shape)
        corners, _ = triangles(indenter(of).solids()[0])
        below = corners[corners[:, 2] <= exact_to(of)]
        assert abs(distance(shape, below)).max() < 1e-3, shape


def test_anchors_keep_off_chips_and_stay_under_the_gel() -> None:
    layout = Layout(load(HERE / "phystac-ms5837.geometry.json"))
    places = anchors(layout)
    assert len(places) >= 8
    for place in places:
        assert layout.gel.distance(place) == 0.0
        assert min(hole.distance(place) for hole in layout.chip_holes) > 0.95


def test_a_larger_sensor_is_built(tmp_path: Path) -> None:
    value = _geometry()
    value["gel"] |= {
        "solid": {"kind": "block", "size_mm": [50.0, 40.0, 9.0]},
        "volume_mm3": 18000.0,
        "bounds_mm": [[-25, -20, 0], [25, 20, 9]],
    }
    value["taxels"] = [
        {"name": f"t{i}{j}", "position_mm": [9.0 * (i - 1.5), 9.0 * (j - 1.5), 0.0], "port_radius_mm": 1.0}
        for i in range(4)
        for j in range(4)
    ]
    x, y = 35.0, 23.0
    value["board"]["outline_mm"] = [[-x, -y], [x, -y], [x, y], [-x, y]]
    value["board"]["holes"] = [{"position_mm": [at, 0.0], "drill_mm": 2.2, "screw": "M2"} for at in (-31.0, 31.0)]
    layout = Layout(load(written(value, tmp_path)))
    plate = port_plate(layout)
    assert plate.is_valid and len(plate.solids()) == 1
    assert plate.bounding_box().size.X == pytest.approx(2 * x)
