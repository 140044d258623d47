"""Coatings in pictures: each pixel loses what its rays lose when they are traced with their polarisation."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
import realcam as rc

from ...measurement import Measurement, hold
from .. import scenes

SPP = 64


def lit(camera: rc.Camera, effects: set[str], device: str = "cpu", **settings: object) -> np.ndarray:
    """(H, W, 3): the picture of a white sky."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        image = rc.render(scenes.sky(), camera, spp=SPP, effects=effects, device=device, **settings)  # type: ignore[arg-type]
    return image.pixels.astype(np.float64)


def camera_with(lens: rc.Lens, film: rc.Film) -> rc.Camera:
    return rc.Camera(lens, film=film, exposure_time_s=1)


def traced_share(camera: rc.Camera, wavelength_nm: float | None = None) -> np.ndarray:
    """(H, W): what the rays of each pixel keep on their way back through the lens, with their polarisation."""
    rays, lens = camera.generate_rays(spp=SPP), camera.lens
    passed = np.asarray(rays.weights) > 0
    start = 1000 * np.asarray(rays.origins_m)[passed] + (0, 0, lens.film_position_mm)
    back = -np.asarray(rays.directions, dtype=np.float64)[passed]
    trace = lens.trace(start, back, start="scene", transmission=True, wavelength_nm=wavelength_nm)
    weights, kept = np.asarray(rays.weights)[passed], np.asarray(trace.transmission)
    weights = np.where(np.asarray(trace.status) == int(rc.RayStatus.OK), weights, 0)
    pixels = np.asarray(rays.pixels)[passed]
    count = camera.film.resolution[0] * camera.film.resolution[1]
    whole = np.bincount(pixels, weights, count)
    share = np.bincount(pixels, weights * np.nan_to_num(kept), count) / np.where(whole > 0, whole, np.nan)
    return np.asarray(share.reshape(camera.film.resolution[::-1]))


LENSES = {
    "double-gauss-50mm": rc.Film(36, 24, (9, 6)),
    "phone-4mm": rc.Film(5.6, 4.2, (8, 6)),
    "fisheye-10mm": rc.Film(23.5, 15.6, (9, 6)),
    "mirror-telephoto-500mm": rc.Film(36, 24, (9, 6)),
}
# The largest error of a single ray with two products instead of its polarisation: docs/coatings.md.
LIMITS = {"bare": 0.012, "quarter_wave": 0.003}


@pytest.mark.parametrize("coating", LIMITS)
@pytest.mark.parametrize("name", LENSES)
def test_pixels_lose_what_their_rays_lose(name: str, coating: str) -> None:
    lens = rc.Lens.load(name)
    mirrors = [i for i, surface in enumerate(lens.surfaces) if surface.type == "mirror"]
    lens = lens.with_coating(coating)
    if mirrors:
        lens = lens.with_coating("aluminium", mirrors)
    camera = camera_with(lens, LENSES[name])
    with np.errstate(invalid="ignore"):
        share = lit(camera, {"coatings"})[..., 1] / lit(camera, set())[..., 1]
    error = np.nanmax(np.abs(share - traced_share(camera)))
    hold(
        Measurement(
            "Effects", f"share of the light that a lens of {coating} glass passes", f"{name}, all its film", "cpu",
            "float32", float(error), LIMITS[coating], "",
        )
    )  # fmt: skip


@pytest.mark.parametrize("nm", [430.0, 550.0, 660.0])
def test_a_line_of_light_loses_what_it_loses_at_its_wavelength(nm: float) -> None:
    lens = rc.Lens.load("double-gauss-100mm").with_coating("quarter_wave")
    camera = camera_with(lens, rc.Film(36, 24, (6, 4)))
    share = lit(camera, {"coatings", "dispersion"}, illuminant=nm) / lit(camera, {"dispersion"}, illuminant=nm)
    assert share[..., 1] == pytest.approx(traced_share(camera, nm), abs=LIMITS["quarter_wave"])


def test_white_light_takes_the_colour_of_the_coating() -> None:
    """Each channel keeps the mean of what its wavelengths keep. The analytic observer is right to a percent, of a share
    that varies by eight percent between green and violet."""
    from .test_dispersion import film_curves

    lens = rc.Lens.load("double-gauss-100mm").with_coating("quarter_wave")
    camera = camera_with(lens, rc.Film(3, 2, (3, 2)))
    share = lit(camera, {"coatings", "dispersion"}).sum((0, 1)) / lit(camera, {"dispersion"}).sum((0, 1))
    nm = np.arange(390.0, 741.0, 10.0)
    expected = film_curves(nm) @ [lens.transmission(wavelength_nm=float(w)) for w in nm]
    assert share == pytest.approx(expected, abs=3e-3)
    assert expected[1] - expected[2] > 0.01  # there is something to see: less blue


def test_light_that_never_passes_stays_without_numbers() -> None:
    """Total reflection under a coating, and rays along surfaces: no pixel is darker than black or no number."""
    lens = rc.Lens.load("fisheye-6mm-220deg").with_coating("quarter_wave")
    camera = camera_with(lens, rc.Film(24, 24, (24, 24)))
    for effects in ({"coatings"}, {"coatings", "dispersion"}):
        picture, whole = lit(camera, effects), lit(camera, effects - {"coatings"})
        assert np.isfinite(picture).all()
        grey = picture.mean(axis=2)
        assert (grey >= 0).all()
        assert (grey <= whole.mean(axis=2)).all()
        assert ((grey > 0) == (whole.mean(axis=2) > 0)).all()


def test_an_unknown_coating_is_said_and_taken_as_bare() -> None:
    lens = rc.Lens.load("double-gauss-50mm")
    camera = camera_with(lens, rc.Film(36, 24, (3, 2)))
    with pytest.warns(UserWarning, match=r"coatings: the coating of surfaces 1, 2, .* assumed to be uncoated"):
        unknown = rc.render(scenes.sky(), camera, spp=4, effects="coatings")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        bare = rc.render(scenes.sky(), camera.replace(lens=lens.with_coating("bare")), spp=4, effects="coatings")
    assert (unknown.pixels == bare.pixels).all()


def test_coatings_that_cannot_be_computed_are_named() -> None:
    coating = rc.Coating([rc.CoatingLayer(rc.Glass.table([(500, 1.38), (600, 1.37)]), thickness_nm=100)])
    lens = rc.Lens.load("double-gauss-100mm").with_coating(coating)
    for camera, effects, message in (
        (rc.Camera(lens), {"coatings", "dispersion"}, r"surface 11 of lens \"double-gauss-100mm\""),
        (rc.Camera(lens, model="thin"), {"coatings"}, "coatings: the camera's model must be full"),
    ):
        with pytest.raises(rc.InputError, match=message):
            rc.render(scenes.sky(), camera, spp=1, effects=effects)


def test_metadata_name_what_covers_the_surfaces() -> None:
    lens = rc.Lens.load("double-gauss-50mm").with_coating("quarter_wave", [0, 1])
    camera = camera_with(lens, rc.Film(36, 24, (3, 2)))
    with pytest.warns(UserWarning, match="coatings"):
        image = rc.render(scenes.sky(), camera, spp=1, effects="coatings")
    assert image.effects == ("coatings",)
    assert image.metadata()["realcam:coatings"].startswith("quarter_wave: 1, 2; unknown, taken as bare: ")
