"""Filters in front of the lens: the light that passes, its colour, the meter, the planner, and mistakes.

A sky of constant radiance has the same irradiance on the film with and without a neutral filter but for the factor. The
colour of a sky behind a curve is the integral of film_curves, which test_dispersion makes without the program's tables.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import realcam as rc

from .. import scenes
from .test_dispersion import film_curves

RED = [(560.0, 0.0), (600.0, 0.5), (640.0, 0.9)]


def camera(lens: str = "double-gauss-50mm") -> rc.Camera:
    return rc.Camera(rc.Lens.load(lens), film=rc.Film(3.6, 2.4, (12, 8)))


def sky_picture(effects: object, **settings: object) -> np.ndarray:
    return rc.render(scenes.sky(), camera(), spp=16, effects=effects, **settings).pixels  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("filter", "passed"),
    [("ND8", 1 / 8), ("ND1000", 1e-3), ("ND0.9", 10**-0.9), ("ND3.0", 1e-3), (0.125, 1 / 8), ("0.3", 0.3), ("ND1", 1)],
)
@pytest.mark.parametrize("effects", [(), "dispersion"])
def test_a_neutral_filter_is_a_factor(effects: object, filter: object, passed: float, device: str) -> None:
    # The same rays and wavelengths in both pictures: only the rounding of float32 differs. On a GPU, the light of
    # wavelengths that pixels share is rounded to multiples of 2^-24 lux for each of at most 3 per sample.
    atol = 3 * 2**-24 * camera().exposure_time_s if effects and device.startswith("cuda") else 0
    filtered, plain = (sky_picture(effects, device=device, **more) for more in ({"lens_filter": filter}, {}))
    np.testing.assert_allclose(filtered, passed * plain, rtol=2e-5, atol=atol)


@pytest.mark.parametrize("curve", [RED, [(450.0, 0.8), (520.0, 0.1)], [(380.0, 0.5), (780.0, 0.5)]])
def test_white_behind_a_curve_has_its_colour(curve: list[tuple[float, float]]) -> None:
    nm = np.arange(380.0, 780.5, 1.0)
    passed = np.interp(nm, *np.transpose(curve))
    expected = film_curves(nm) @ passed
    # One sample of white is right in the mean only: 3000 samples of a standard deviation of about 0.5 leave 0.01. The
    # analytic observer has an error of a hundredth of the channel that sees the most.
    found = rc.render(scenes.sky(), camera(), spp=64, effects="dispersion", lens_filter=curve).pixels.mean(axis=(0, 1))
    white = rc.render(scenes.sky(), camera(), spp=64, effects="dispersion").pixels.mean(axis=(0, 1))
    np.testing.assert_allclose(found / white, expected, atol=0.02 * expected.max())


def test_a_narrow_band_takes_the_axial_colour_away() -> None:
    """A singlet in focus at its design wavelength blurs a lamp's other colours: behind a filter its disc is smaller."""
    lens = rc.Lens.load("singlet-100mm").with_rings(f_number=8, focus_m=5)
    lamp = scenes.scene_of(scenes.quad((0, 0, -5), 0.001, right=(1, 0, 0), emission=1e6))

    def width(**settings: object) -> float:
        image = rc.render(
            lamp, rc.Camera(lens, film=rc.Film(1.0, 1.0, (51, 51))), spp=64, effects="dispersion",
            **settings,  # type: ignore[arg-type]
        )  # fmt: skip
        light = image.pixels.sum(axis=2)
        y, x = np.mgrid[:51, :51] - 25.0
        return float(np.sqrt((light * (x * x + y * y)).sum() / light.sum()))

    green = [(586.0, 0.0), (587.0, 1.0), (589.0, 1.0), (590.0, 0.0)]
    # The remaining blur is that of a spectral line at the band's centre: the lamp's size and spherical aberration.
    narrow = width(lens_filter=green)
    assert narrow == pytest.approx(width(illuminant=588.0), rel=0.03)
    assert narrow < 0.8 * width()


def test_noise_of_white_is_removed_behind_a_filter_too() -> None:
    """The control variate of wavelengths knows the filter's white: an even sky stays even."""

    def unevenness(**settings: object) -> np.ndarray:
        pixels = rc.render(
            scenes.sky(), rc.Camera(rc.Lens.load("double-gauss-50mm"), film=rc.Film(3.6, 2.4, (60, 40))), spp=16,
            effects="dispersion", **settings,  # type: ignore[arg-type]
        ).pixels  # fmt: skip
        return pixels.std(axis=(0, 1)) / pixels.mean(axis=(0, 1))

    plain, yellow = unevenness(), unevenness(lens_filter=[(470.0, 0.02), (520.0, 0.9)])
    assert yellow[0] < 3 * plain[0] and yellow[1] < 3 * plain[1]


def test_the_meter_sees_through_the_filter() -> None:
    def metered_s(lens_filter: str) -> float:
        shot = rc.Shot.load("demo", resolution=(12, 8), exposure_time_s="auto", lens_filter=lens_filter, device="cpu")
        return shot.camera.exposure_time_s

    assert metered_s("ND8") == pytest.approx(8 * metered_s("ND1"), rel=1e-4)


def test_the_planner_gives_a_coloured_filter_its_wavelengths() -> None:
    scene = scenes.scene_of(scenes.quad((0, 0, -3), 4, diffuse=0.5, emission=100))
    small = camera().replace(lens=rc.Lens.load("double-gauss-50mm").with_rings(f_number=16))
    plain = rc.plan(scene, small, quality="draft")
    red = rc.plan(scene, small, quality="draft", lens_filter=RED)
    assert "dispersion" not in plain.effects
    assert "dispersion" in red.effects
    assert any("filter's colour" in decision.reason for decision in red.decisions)


def test_settings_files_and_metadata(tmp_path: Path) -> None:
    assert rc.RenderSettings(lens_filter="ND8").lens_filter == "0.125"
    red = rc.RenderSettings(effects="dispersion", lens_filter=RED)
    assert red.lens_filter == "560:0,600:0.5,640:0.9"
    assert rc.RenderSettings(effects="dispersion", lens_filter=red.lens_filter) == red
    # Without the effects that show its colour, the filter that is equally bright is left.
    assert float(red.with_(effects=()).lens_filter) == pytest.approx(0.17, abs=0.03)
    image = rc.render(scenes.sky(), camera(), spp=1, effects=(), lens_filter="ND4")
    assert image.metadata()["realcam:lens_filter"] == "0.25"
    (tmp_path / "a.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    base = 'format = 1\nscene = "a.obj"\nposition_m = [0, 0, 3]\nexposure_time_s = 1\n'
    for line, expected in (
        ('lens_filter = "ND8"', "0.125"),
        ("lens_filter = 0.5", "0.5"),
        ("lens_filter = [[500, 0], [600, 1]]", "500:0,600:1"),
    ):
        (tmp_path / "shot.toml").write_text(base + line + "\n")
        assert rc.Shot.load(tmp_path / "shot.toml").settings.lens_filter == expected


@pytest.mark.parametrize(
    ("filter", "message"),
    [
        ("red", 'lens_filter: "red": expected a neutral density'),
        ("ND", 'lens_filter: "ND": expected'),
        ("ND0", 'lens_filter: "ND0": expected'),
        ("ND-0.3", 'lens_filter: "ND-0.3": expected'),
        (0, "lens_filter: the transmittance must lie above 0 and be at most 1"),
        (1.5, "at most 1"),
        (float("nan"), "at most 1"),
        ("500:0.5", "at least two points"),
        ([(500, 0.5), (400, 0.5)], "must be strictly increasing"),
        ([(500, 0.5), (600, 1.5)], "between 0 and 1"),
        ([(500, 0.0), (600, 0.0)], "no visible light passes"),
        ({}, "filter"),
    ],
)
def test_mistakes_are_named(filter: object, message: str) -> None:
    with pytest.raises(rc.InputError, match=message):
        rc.RenderSettings(effects="dispersion", lens_filter=filter)  # type: ignore[arg-type]


def test_a_coloured_filter_needs_wavelengths() -> None:
    with pytest.raises(rc.InputError, match="a coloured filter needs one of the effects dispersion and diffraction"):
        rc.RenderSettings(effects=(), lens_filter=RED)
