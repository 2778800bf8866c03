"""Tests that a gel carries coins, plates and hollow bodies as it carries thick bodies."""

import pytest

from blocks import Scene, palm

COIN = '<body name="thing" pos="0.001 0.0005 {z_m}"><freejoint/><geom name="thing" {geom} mass="0.05"/></body>'
HALF_M = {"coin": 'type="cylinder" size="0.006 {half_m}"', "plate": 'type="box" size="0.005 0.004 {half_m}"', "lens": 'type="ellipsoid" size="0.006 0.006 {half_m}"'}


def rests_mm(kind: str, thickness_mm: float, push_n: float, lean: float = 0.0) -> float:
    """Depth of the lowest point of a body in the gel after it was pushed for 0.6 s, mm."""
    half_m = 0.5e-3 * thickness_mm
    things = COIN.format(z_m=0.0086 + half_m, geom=HALF_M[kind].format(half_m=half_m))
    scene = Scene(palm(things))
    scene.data.qpos[3:] = [1.0, 0.0, lean, 0.0]
    scene.data.qvel[:] = 0.0
    body = scene.model.body("thing").id
    for step in range(600):
        scene.data.xfrc_applied[body, 2] = -push_n * min(1.0, step / 200)
        scene.step()
    return 8.5 - (scene.height_mm - 0.5 * thickness_mm)


@pytest.mark.parametrize(("kind", "push_n"), [("coin", 0.5), ("coin", 1.0), ("coin", 2.0), ("coin", 3.0), ("plate", 0.5), ("plate", 2.0)])
def test_what_is_thin_rests_where_what_is_thick_does(kind: str, push_n: float) -> None:
    thick_mm = rests_mm(kind, 4.0, push_n)
    for thickness_mm in (0.3, 1.0):
        assert rests_mm(kind, thickness_mm, push_n) == pytest.approx(thick_mm, abs=0.1)


def test_a_lens_does_not_fall_through() -> None:
    assert 0.5 < rests_mm("lens", 2.0, 2.0) < 3.0


def test_a_coin_that_leans_does_not_fall_through() -> None:
    assert 0.5 < rests_mm("coin", 0.5, 2.0, lean=0.05) < 2.5
