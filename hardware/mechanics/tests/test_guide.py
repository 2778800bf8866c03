"""Tests that the guide in docs/build agrees with the drawings."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from conftest import HERE, run

from casting.recipe import Recipe, density_of
from checks.files import Made
from mechanics.geometry import GeometryError, load
from mechanics.layout import Layout
from mechanics.parts.flange_plate import flange_screws
from mechanics.parts.jaw_mount import jaw_screws
from mechanics.parts.port_plate import potting_volume

GUIDE = HERE.parents[2] / "docs" / "build"
DENSITY = 1.07


@pytest.mark.parametrize("variant", ["phystac-ms5837", "fingertip"])
def test_weights_are_those_of_the_drawings(variant: str) -> None:
    geometry = load(HERE / f"{variant}.geometry.json")
    recipe = Recipe(geometry.gel.volume_mm3, potting_volume(Layout(geometry)), DENSITY)
    row = re.search(rf"^\| `{variant}` \|.*A?.*$", GUIDE.joinpath("casting.md").read_text(), re.MULTILINE)
    assert row
    gel = f"{recipe.gel_mm3 / 1000:.2f} mL, {recipe.gel_g:.1f} g"
    around = f"{recipe.potting_mm3 / 1000:.2f} mL, {recipe.potting_g:.1f} g"
    expected = (
        f"| `{variant}` | {gel} | {around} | {recipe.mixed_g:.0f} g | {recipe.each_g:.0f} g | {recipe.each_g:.0f} g |"
    )
    assert row[0] == expected


def test_screws_of_the_parts_list_are_those_of_the_drawings() -> None:
    text = GUIDE.joinpath("parts.md").read_text()
    for variant, clamp in (("phystac-ms5837", 20), ("fingertip", 30)):
        layout = Layout(load(HERE / f"{variant}.geometry.json"))
        lengths = [
            s[0].length
            for s in (
                layout.sensor_screws,
                layout.casting_screws,
                layout.clamp_screws,
                flange_screws(layout),
                jaw_screws(layout),
            )
        ]
        assert lengths == [12, 14, clamp, 10, 8]
    for said in (
        "screws M2 × 12 with nuts | 2",
        "screws M2 × 14 with nuts | 2",
        "M3 × 20 with nuts, fingertip: M3 × 30 | 4",
        "M3 × 10 (flange), M3 × 8 (jaw)",
    ):
        assert said in text


def test_pictures_of_the_guide_are_there_and_small() -> None:
    named = {name for page in GUIDE.glob("*.md") for name in re.findall(r"\]\(([\w-]+\.png)\)", page.read_text())}
    assert len(named) >= 10
    assert named == {path.name for path in GUIDE.glob("*.png")}
    for name in named:
        assert GUIDE.joinpath(name).stat().st_size <= 150_000, name


def test_a_mix_is_enough_and_halves_in_whole_grams() -> None:
    small = Recipe(100.0, 10.0, DENSITY)
    assert (small.mixed_g, small.each_g) == (10.0, 5.0)
    large = Recipe(10_000.0, 200.0, 1.1)
    assert large.mixed_g >= 2.0 * (large.gel_g + large.potting_g)
    assert large.mixed_g % 2.0 == 0.0
    for value in (0.0, 10.7, float("nan")):
        with pytest.raises(GeometryError):
            density_of(value)


def test_the_casting_sheet_is_the_same_each_time(block: Made, tmp_path: Path) -> None:
    from PIL import Image

    from casting.page import write_page

    picture = tmp_path / "picture.png"
    Image.new("RGB", (300, 200), "gray").save(picture)
    recipe = Recipe(block.figures["gel_volume_mm3"], block.figures["potting_volume_mm3"], DENSITY)
    sheets = []
    for name in ("a.pdf", "b.pdf"):
        write_page(block, recipe, picture, tmp_path / name)
        sheets.append(tmp_path.joinpath(name).read_bytes())
    assert sheets[0] == sheets[1]
    assert sheets[0].count(b"/Type /Page\n") == 1


def test_a_picture_that_does_not_exist_is_an_error(block_folder: Path) -> None:
    ran = run("render.py", block_folder, "--only", "sunset")
    assert (ran.returncode, "no picture `sunset`" in ran.stderr) == (2, True)


def test_figures_have_what_the_sheet_needs(block_folder: Path) -> None:
    figures = json.loads((block_folder / "mechanics.json").read_text())
    assert figures["gel_volume_mm3"] == 5202.0
    assert 100.0 < figures["potting_volume_mm3"] < 400.0
