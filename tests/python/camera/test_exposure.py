"""Exposure of ideal models and of grey cards against closed forms. Light through lenses: test_estimator_lens.cpp."""

from __future__ import annotations

import math

import numpy as np
import pytest
import realcam as rc

from .. import scenes


def test_relative_illumination_of_ideal_models_is_cos_to_the_fourth() -> None:
    lens = rc.Lens.load("double-gauss-50mm")
    first = lens.first_order()
    distances = {"thin": first.effective_focal_length_mm, "pinhole": first.effective_focal_length_mm}
    distances["thick"] = lens.film_position_mm - first.exit_pupil_position_mm
    for model, distance in distances.items():
        # One pixel wide: the rows' heights on the film are known.
        camera = rc.Camera(lens, film=rc.Film(0.01, 40, (1, 401)), exposure_time_s=1, model=model)
        column = rc.render(scenes.sky(), camera, effects=(), spp=64).pixels[:, 0, 0].astype(np.float64)
        heights = (np.arange(401) - 200) * 40 / 401
        cosine = distance / np.hypot(distance, heights)
        # Within a pixel of 0.1 mm cos^4 differs by at most 1%, which 64 stratified samples average to 1e-3 or
        # better.
        np.testing.assert_allclose(column / column[200], cosine**4, rtol=2e-3, err_msg=model)


def test_half_the_time_is_half_the_exposure_exactly() -> None:
    lens = rc.Lens.load("tessar-50mm")
    scene = scenes.scene_of(scenes.quad((0, 0, -3), 1, emission=(200, 100, 50))).with_environment(5.0)
    film = rc.Film(36, 24, (36, 24))
    whole, half = (
        rc.render(scene, rc.Camera(lens, film=film, exposure_time_s=t), effects=(), spp=8).pixels
        for t in (1 / 60, 1 / 120)
    )
    # Halving is exact in binary, wherever it happens.
    np.testing.assert_array_equal(half, whole / 2)


def grey_card_exposure(lens: rc.Lens, iso: float) -> rc.Image:
    """Card of 18% at 5 m, square to a sun of 80 klux behind the camera; f/16, 1/125 s."""
    scene = scenes.scene_of(scenes.quad((0, 0, -5), 5, diffuse=0.18)).with_sun((0, 0, -1), (8e4, 8e4, 8e4))
    camera = rc.Camera(lens.stopped_down(16), film=rc.Film(1, 1, (8, 8)), exposure_time_s=1 / 125, iso=iso)
    return rc.render(scene, camera, effects=(), spp=64)


@pytest.mark.parametrize("name", ["double-gauss-50mm", "telephoto-250mm"])
def test_sunny_16_lands_on_middle_grey(name: str) -> None:
    image = grey_card_exposure(rc.Lens.load(name), iso=100)
    # ISO 12232 (standard output sensitivity): 10 lx s / ISO is middle grey. A third of a stop is what cameras
    # can set.
    stops = math.log2(float(image.pixels.mean()) / 0.1)
    assert abs(stops) < 1 / 3
    # The closed form: L = 0.18 E / pi on the card, pi L / (4 N^2) on the film.
    expected = 0.18 * 8e4 / (4 * 16**2) / 125
    # 5%: the marginal ray at f/16 is paraxial, and focusing at infinity is that of the open lens: in front of
    # it.
    assert image.pixels.mean() == pytest.approx(expected, rel=0.05)


def test_middle_grey_is_code_118_and_sensitivity_scales() -> None:
    # sRGB (IEC 61966-2-1) of 0.18 is 117.7 / 255; middle grey lies below the knee of the tone curve.
    exposure = np.full((1, 1, 3), 0.1, np.float32)
    for tone in ("film", "linear"):
        assert rc._core.develop(exposure, 100, tone).tolist() == [[[118] * 3]]
        assert rc._core.develop(exposure / 8, 800, tone).tolist() == [[[118] * 3]]
    image = grey_card_exposure(rc.Lens.load("double-gauss-50mm"), iso=100)
    grey = float(np.median(image.developed("linear")))
    linear = 0.18 * float(image.pixels.mean()) / 0.1
    # One code for rounding, one for the noise of single pixels.
    assert grey == pytest.approx(255 * (1.055 * linear ** (1 / 2.4) - 0.055), abs=2)
    third = [255 * (1.055 * (0.18 * 2**s) ** (1 / 2.4) - 0.055) for s in (-1 / 3, 1 / 3)]
    assert third[0] < grey < third[1]


def test_white_is_clipped_and_black_is_black() -> None:
    ramp = np.array([0.0, -1.0, np.nan, 0.1, 10.0, 1e30], np.float32)
    linear = rc._core.develop(ramp, 100, "linear")
    assert linear.tolist() == [0, 0, 0, 118, 255, 255]
    film = rc._core.develop(np.linspace(0, 2, 2000, dtype=np.float32), 100, "film").astype(int)
    assert (np.diff(film) >= 0).all()
    assert film[-1] == 255 or film[-1] > 250
