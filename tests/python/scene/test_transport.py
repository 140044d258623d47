"""Light transport by name, and a clamp that the picture's metadata state."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import realcam as rc

from .. import scenes


def corner(material: rc.Material) -> rc.Scene:
    """A surface before the camera and a grey floor, under a lamp behind the camera."""
    wall = (scenes.quad((0, 0, -2), 2)[0], material)
    floor = scenes.quad((0, -0.5, 0), 4, right=(1, 0, 0), up=(0, 0, -1), diffuse=0.5)
    lamp = scenes.quad((0, 1.5, 1), 0.5, right=(-1, 0, 0), emission=1000)
    return scenes.scene_of(wall, floor, lamp)


def picture(scene: rc.Scene, spp: int = 32, **options: object) -> np.ndarray:
    image = rc.render(scene, scenes.pinhole(), effects=(), spp=spp, device="cpu", **options)  # type: ignore[arg-type]
    return np.asarray(image.pixels, float)


def test_whitted_leaves_out_what_diffuse_surfaces_send_each_other() -> None:
    scene = corner(rc.Material(diffuse=(0.5, 0.5, 0.5)))
    direct = picture(scene, max_bounces=0)
    np.testing.assert_allclose(picture(scene, transport="whitted", max_bounces=4), direct, rtol=1e-5)
    assert picture(scene, max_bounces=4).mean() > 1.05 * direct.mean()


def test_whitted_follows_mirrors_and_glass() -> None:
    mirror = corner(rc.Material(diffuse=(0, 0, 0), mirror=(1, 1, 1), fresnel=False))
    direct = picture(mirror, max_bounces=0)
    # The floor seen in the mirror is lit by the lamp alone, without the light from the wall that a path would add.
    whitted, paths = (picture(mirror, transport=name, max_bounces=1, spp=256) for name in ("whitted", "paths"))
    assert whitted.mean() > 1.2 * direct.mean()
    assert whitted.mean() < paths.mean() * 1.01
    pane = corner(rc.Material(diffuse=(0, 0, 0), transmission=1, thin=True))
    behind = scenes.scene_of(scenes.quad((0, 0, -2.5), 3, emission=10))
    seen = picture(pane.with_instance(behind), transport="whitted", max_bounces=2)
    assert seen.mean() > picture(pane, transport="whitted", max_bounces=2).mean()


def test_a_clamp_cuts_off_what_comes_by_a_bounce_and_is_told() -> None:
    scene = corner(rc.Material(diffuse=(0.5, 0.5, 0.5)))
    free, direct = picture(scene, max_bounces=2), picture(scene, max_bounces=0)
    np.testing.assert_array_equal(picture(scene, max_bounces=2, clamp_cd_m2=1e6), free)
    clamped = picture(scene, max_bounces=2, clamp_cd_m2=0.5)
    assert direct.mean() < clamped.mean() < free.mean()
    # Direct light is left alone.
    assert (clamped >= direct * (1 - 1e-5)).all()
    image = rc.render(scene, scenes.pinhole(), effects=(), spp=1, clamp_cd_m2=0.5, transport="whitted")
    assert image.metadata()["realcam:clamp_cd_m2"] == "0.5"
    assert image.metadata()["realcam:transport"] == "whitted"
    plain = rc.render(scene, scenes.pinhole(), effects=(), spp=1).metadata()
    assert not {"realcam:clamp_cd_m2", "realcam:transport"} & plain.keys()
    session = rc.Session(scene, scenes.pinhole(), device="cpu", max_bounces=2, clamp_cd_m2=0.5, effects=())
    session.add(32)
    np.testing.assert_array_equal(session.image().pixels, clamped.astype(np.float32))


def test_wrong_names_and_numbers() -> None:
    scene = corner(rc.Material())
    with pytest.raises(rc.InputError, match='transport must be paths or whitted; it is "kajiya"'):
        picture(scene, transport="kajiya")
    for clamp in (-1.0, float("nan")):
        with pytest.raises(rc.InputError, match="clamp_cd_m2 must be 0"):
            picture(scene, clamp_cd_m2=clamp)


@pytest.mark.picture_files
def test_a_shot_file_has_them_too(tmp_path: Path) -> None:
    (tmp_path / "quad.obj").write_text("v -1 -1 0\nv 1 -1 0\nv 1 1 0\nf 1 2 3\n")
    text = 'format = 1\nscene = "quad.obj"\nexposure_time_s = 1\nenvironment_cd_m2 = 1\n'
    (tmp_path / "a.toml").write_text(text + 'transport = "whitted"\nclamp_cd_m2 = 3\n')
    shot = rc.Shot.load(tmp_path / "a.toml")
    assert (shot.transport, shot.clamp_cd_m2) == ("whitted", 3)
    (tmp_path / "b.toml").write_text(text + 'transport = "rays"\n')
    with pytest.raises(rc.InputError, match=r':5: "transport" must be paths or whitted'):
        rc.Shot.load(tmp_path / "b.toml")
    (tmp_path / "c.toml").write_text(text + "clamp_cd_m2 = -3\n")
    with pytest.raises(rc.InputError, match=r":5: clamp_cd_m2 must be 0"):
        rc.Shot.load(tmp_path / "c.toml")
