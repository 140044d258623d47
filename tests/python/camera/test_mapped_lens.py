"""The camera model mapped: a thin lens's blur, with the real lens's distortion and vignetting."""

from __future__ import annotations

import numpy as np
import pytest
import realcam as rc

from ...measurement import Measurement, hold
from .. import scenes

LENSES = ["double-gauss-50mm", "wide-22mm", "phone-4mm", "mirror-telephoto-500mm", "fisheye-10mm"]


def camera_with(name: str, model: str, resolution: tuple[int, int] = (48, 32), share: float = 1.0) -> rc.Camera:
    lens = rc.Lens.load(name).focused(6.0)
    width, height = (share * side for side in lens.film_mm)
    return rc.Camera(lens, film=rc.Film(width, height, resolution), model=model, exposure_time_s=1)


@pytest.mark.parametrize("name", LENSES)
def test_light_falls_off_as_through_the_real_lens(name: str) -> None:
    share = 0.6 if name == "fisheye-10mm" else 1.0  # its corners see 90 degrees
    full, mapped = (
        rc.render(scenes.sky(), camera_with(name, model, (24, 16), share), effects=(), spp=4096, device="cpu").pixels[
            ..., 1
        ]
        for model in ("full", "mapped")
    )
    error = np.abs(mapped - full).max() / full.max()
    # 4096 samples of a pupil that is vignetted by some percent have a noise of 0.1%; the map uses as many samples.
    hold(Measurement("Lenses", "light that a mapped lens brings to each pixel, of the real lens's", name, "cpu",
                     "float32", float(error), 0.006, "of the brightest"))  # fmt: skip


@pytest.mark.parametrize("name", LENSES)
def test_points_in_focus_are_where_the_real_lens_shows_them(name: str) -> None:
    """The mean of a point's light: rays of the real lens, and of the mapped one, through the plane in focus."""
    share = 0.6 if name == "fisheye-10mm" else 1.0
    places = []
    for model in ("full", "mapped"):
        camera = camera_with(name, model, (13, 9), share)
        rays = camera.generate_rays(spp=4096)
        focus = camera.lens.focus_distance_m
        o, d, w = (np.asarray(part, dtype=float) for part in (rays.origins_m, rays.directions, rays.weights))
        t = (-focus - o[:, 2]) / d[:, 2]
        x = o[:, :2] + t[:, None] * d[:, :2]
        pixels = np.asarray(rays.pixels)
        sums = np.stack([np.bincount(pixels, w * x[:, k], 13 * 9) for k in (0, 1)], axis=1)
        light = np.bincount(pixels, w, 13 * 9)
        places.append(sums / light[:, None])
    pixel = np.abs(places[0][0, 0] - places[0][12, 0]) / 12 / 100  # a hundredth of these large pixels
    error = np.abs(places[1] - places[0]).max() / (100 * pixel)
    # The mean over a pixel's 4096 samples is known to 0.3 / 64 of the pixel, of two pictures.
    hold(Measurement("Lenses", "place of points in focus through a mapped lens, of the real lens's", name, "cpu",
                     "float32", float(error), 0.03, "pixels of 13 x 9"))  # fmt: skip


def test_what_is_out_of_focus_is_blurred_as_by_a_thin_lens() -> None:
    lens = rc.Lens.load("double-gauss-50mm").focused(2.0)
    film = rc.Film(6, 4, (60, 40))
    mark = scenes.scene_of(scenes.quad((0, 0, -6), 0.02, emission=1000.0))
    widths = []
    for model in ("thin", "mapped"):
        camera = rc.Camera(lens, film=film, model=model, exposure_time_s=1)
        light = rc.render(mark, camera, effects=(), spp=512, max_bounces=0, device="cpu").pixels[..., 1].astype(float)
        along = (np.arange(60) + 0.5) * 0.1 - 3
        middle = (light * along).sum() / light.sum()
        widths.append(np.sqrt((light * (along - middle) ** 2).sum() / light.sum()))
    assert widths[1] == pytest.approx(widths[0], rel=0.01)


def test_a_film_that_sees_behind_the_lens_has_no_mapped_lens() -> None:
    camera = camera_with("fisheye-6mm-220deg", "mapped")
    with pytest.raises(rc.InputError, match=r"mapped cannot represent lens .* its film sees 90 degrees"):
        rc.render(scenes.sky(), camera, effects=(), spp=1)


def test_field_of_view_is_the_real_lens_s() -> None:
    full, mapped = (camera_with("wide-22mm", model).field_of_view_deg for model in ("full", "mapped"))
    assert mapped == pytest.approx(full)
