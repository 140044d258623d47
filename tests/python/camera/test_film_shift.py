"""A film whose middle is not on the lens's axis shows a part of what a larger one shows."""

from __future__ import annotations

import math
import warnings
from pathlib import Path

import numpy as np
import pytest
import realcam as rc
from frame_scene import frame_scene

from .. import scenes
from ..programs import Command

DEMO = Path(__file__).resolve().parents[3] / "scenes" / "demo.glb"

WHOLE = rc.Film(36, 24, (360, 240))
# 100 um a pixel, as in the whole: its columns from 250 to 350, its rows from 20 to 80.
PART = rc.Film(10, 6, (100, 60), shift_mm=(12.0, 7.0))
CUT = (slice(20, 80), slice(250, 350))


def camera_with(film: rc.Film, model: str = "full") -> rc.Camera:
    lens = rc.Lens.load("double-gauss-50mm").focused(5.0)
    return rc.Camera(lens, film=film, model=model, position=(0, 1.5, 4), look_at=(0, 0.3, -4), exposure_time_s=1)


@pytest.mark.parametrize("model", ["pinhole", "thin", "mapped", "thick", "full", "polynomial"])
def test_a_shifted_film_sees_its_part_of_a_larger_one(model: str) -> None:
    scene, layers = frame_scene(spheres=20, boxes=20, rows=16), ["depth_middle", "normal"]
    whole, part = (
        rc.render(scene, camera_with(film, model), spp=16, effects=(), layers=layers, device="cpu")
        for film in (WHOLE, PART)
    )
    # The middle ray of a pixel is the same, but for roundings of its place and for the table of the pupil, whose rows
    # reach as far as the film's corner: at edges of objects they decide.
    same = np.isclose(part.layers["depth_middle"], whole.layers["depth_middle"][CUT], rtol=2e-4)
    assert same.mean() > 0.98
    # Other samples: of each picture's noise in blocks of 10 x 10 pixels.
    light = [
        pixels.mean(axis=2).reshape(6, 10, 10, 10).mean(axis=(1, 3)) for pixels in (part.pixels, whole.pixels[CUT])
    ]
    assert light[0] == pytest.approx(light[1], rel=0.1)
    assert light[0].mean() == pytest.approx(light[1].mean(), rel=5e-3)


@pytest.mark.parametrize("effects", [{"dispersion"}, {"diffraction"}, {"ghosts"}])
def test_effects_are_those_of_the_larger_film(effects: set[str]) -> None:
    """With a lamp in the part that the small film sees."""
    lens = rc.Lens.load("double-gauss-50mm").with_coating("bare").stopped_down(8)
    place = (12.0 / 50 * 1e3, 7.0 / 50 * 1e3, -1e3)
    scene = scenes.sky(1.0).with_point_light(place, 3 * (1e8,))
    light = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        for film in (WHOLE, PART):
            camera = rc.Camera(lens, film=film, exposure_time_s=1)
            light.append(rc.render(scene, camera, spp=64, effects=effects, device="cpu").pixels.mean(axis=2))
    part, whole = light[1], light[0][CUT]
    assert part.sum() == pytest.approx(whole.sum(), rel=0.02)
    if effects != {"dispersion"}:
        brightest = [np.array(np.unravel_index(np.argmax(a), a.shape)) for a in (part, whole)]
        assert np.abs(brightest[0] - brightest[1]).max() <= 1


def test_points_and_pixels_know_the_shift() -> None:
    whole, part = camera_with(WHOLE), camera_with(PART)
    pixels = np.array([[3.0, 4.0], [50.0, 30.0], [97.0, 58.0]])
    in_whole = pixels + np.array([250, 20])
    for through in ("light", "chief"):
        for a, b in zip(part.ray(pixels, through=through), whole.ray(in_whole, through=through), strict=True):
            np.testing.assert_allclose(a, b, atol=2e-6)
    origins, directions = part.ray(pixels)
    found = part.project(origins + 6 * directions)
    np.testing.assert_allclose(found, pixels, atol=0.05)
    # The axis meets the film 12 mm to the left of its middle, and 7 mm below.
    assert PART.principal_point == pytest.approx((50 - 120, 30 + 70))
    np.testing.assert_allclose(part.camera_matrix[:2, 2], PART.principal_point)
    assert WHOLE.principal_point == (180, 120)


def test_the_field_of_view_is_that_of_both_sides() -> None:
    film = rc.Film(20, 10, (20, 10), shift_mm=(4.0, 8.0))
    camera = camera_with(film, "pinhole")
    across = camera.replace(film=rc.Film(20, 10, (20, 10))).field_of_view_deg.horizontal
    b = 10 / math.tan(math.radians(across) / 2)
    view = camera.field_of_view_deg
    degrees = [math.degrees(math.atan(h / b)) for h in (14, 6, 13, 3)]
    assert view.horizontal == pytest.approx(degrees[0] + degrees[1], rel=1e-6)
    assert view.vertical == pytest.approx(degrees[2] - degrees[3], rel=1e-6)  # the axis is beyond its lower edge


def test_films_say_their_shift_and_keep_it(tmp_path: Path) -> None:
    assert PART.shift_mm == (12, 7)
    assert PART.replace(resolution=(50, 30)).shift_mm == (12, 7)
    assert PART.replace(shift_mm=(0, 0)) == rc.Film(10, 6, (100, 60))
    assert "shifted by (12, 7) mm" in repr(PART)
    assert "shifted" not in repr(WHOLE)
    for wrong in ((math.nan, 0), (math.inf, 0), (0, -2e9)):
        with pytest.raises(rc.InputError, match="the film's shift must be two finite lengths"):
            rc.Film(10, 6, (100, 60), shift_mm=wrong)
    assert rc.camera_json(camera_with(PART))["film_shift_mm"] == [12, 7]


def test_the_shift_moves_the_film_and_not_the_lens() -> None:
    # A camera on its side: the picture's right is up in the scene, and its top points to the left. Light from the
    # right falls on the left half of the film, so that a film shifted to the picture's right lies below.
    turned = {"position": (1, 2, 3), "look_at": (1, 2, 2), "up": (-1, 0, 0)}
    lens = rc.Lens.load("double-gauss-50mm")
    unshifted = rc.Camera(lens, film=rc.Film(10, 6, (100, 60)), **turned)
    shifted = unshifted.replace(film=rc.Film(10, 6, (100, 60), shift_mm=(12, 7)))
    assert unshifted.film_centre_m == unshifted.position == shifted.position == (1, 2, 3)
    assert shifted.entrance_pupil_position_m == unshifted.entrance_pupil_position_m
    np.testing.assert_allclose(shifted.film_centre_m, (1.007, 1.988, 3), rtol=0, atol=1e-12)
    pose = rc.camera_json(shifted)["pose"]
    assert pose["position_m"] == [1, 2, 3]
    assert pose["film_centre_m"] == list(shifted.film_centre_m)
    # The line from there through the entrance pupil goes on, but for the lens's distortion, to the picture's middle.
    through = np.subtract(shifted.entrance_pupil_position_m, shifted.film_centre_m)
    far = np.array([shifted.entrance_pupil_position_m + 1000 * through / np.linalg.norm(through)])
    assert np.abs(shifted.project(far)[0] - (50, 30)).max() < 10


@pytest.mark.picture_files
def test_shot_files_and_the_command_line_shift_the_film(tmp_path: Path, command: Command) -> None:
    shot = tmp_path / "shot.toml"
    shot.write_text(
        f'format = 1\nscene = "{DEMO}"\nfilm_mm = [12, 8]\nfilm_shift_mm = [1.5, -2]\nresolution = [24, 16]\n'
    )
    assert rc.Shot.load(shot).camera.film.shift_mm == (1.5, -2)
    out = ["-o", tmp_path / "picture.exr", "--resolution", "24x16", "--spp", "1"]
    for words in ([shot], [DEMO, "--film", "12x8", "--film-shift", "1.5,-2"]):
        assert command("render", *words, *out).returncode == 0
        assert b"realcam:film_shift_mm" in (tmp_path / "picture.exr").read_bytes()
    refused = command("render", DEMO, *out, "--film-shift", "3")
    assert refused.returncode == 2
    assert "two lengths in mm, such as 0,8" in refused.stderr
