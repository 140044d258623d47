"""Wavelengths and times of Camera.generate_rays: rays are those of the wavelength and of the time that they have."""

from __future__ import annotations

import numpy as np
import pytest
import realcam as rc

LENS = rc.Lens.load("double-gauss-50mm")
FILM = rc.Film(36, 24, (12, 8))


def test_every_ray_lands_in_its_pixel_at_its_wavelength() -> None:
    rays = rc.Camera(LENS, film=FILM).generate_rays(spp=16, wavelengths_nm=(380, 800))
    o = 1000 * rays.origins_m + [0, 0, LENS.film_position_mm]
    outside = []
    for i in np.flatnonzero(rays.weights > 0)[::11]:
        nm = float(rays.wavelengths_nm[i])
        back = LENS.trace(o[i : i + 1], -rays.directions[i : i + 1].astype(float), wavelength_nm=nm, start="scene")
        d, at = back.directions[0], back.origins_mm[0]
        x, y = (at + d * ((LENS.film_position_mm - at[2]) / d[2]))[:2]
        column, row = (0.5 - x / 36) * 12, (0.5 + y / 24) * 8
        outside.append(max(abs(column - rays.pixels[i] % 12 - 0.5), abs(row - rays.pixels[i] // 12 - 0.5)) - 0.5)
    assert len(outside) > 100
    # float32 places rays to 1e-4 mm on the film, and indices are right to 1e-5, which is 1e-3 mm in 100 mm: a pixel has
    # 3 mm. Traced at the design wavelength, some of these rays land 0.012 mm outside their pixels.
    assert max(outside) < 1e-3 / 3


def test_wavelengths_are_even_and_stratified() -> None:
    rays = rc.Camera(LENS, film=FILM).generate_rays(spp=64, wavelengths_nm=(400, 700))
    share = np.sort((rays.wavelengths_nm.reshape(-1, 64).astype(float) - 400) / 300, axis=1)
    assert share.min() >= 0 and share.max() <= 1
    # 64 stratified numbers are off by a few 64ths; independent ones by more than 8/64 in many of 96 pixels.
    assert np.abs(share - (np.arange(64) + 0.5) / 64).max() < 6 / 64


def test_without_a_range_rays_have_the_design_wavelength_and_are_those_of_before() -> None:
    camera = rc.Camera(LENS, film=FILM)
    rays = camera.generate_rays(spp=4)
    assert (rays.wavelengths_nm == np.float32(LENS.wavelength_nm)).all()
    one = camera.generate_rays(spp=4, wavelengths_nm=(LENS.wavelength_nm, LENS.wavelength_nm))
    both = (rays.weights > 0) & (one.weights > 0)
    assert both.mean() > 0.9
    np.testing.assert_allclose(one.directions[both], rays.directions[both], atol=2e-5)


def test_times_fill_each_row_s_exposure() -> None:
    camera = rc.Camera(LENS, film=FILM, shutter_opens_s=7.0, exposure_time_s=0.5, readout_time_s=0.25)
    times = camera.generate_rays(spp=64).times_s.reshape(8, 12 * 64)
    for row in range(8):
        begin = 7.0 + 0.25 * row / 8
        # Shares of the exposure are float32: 1e-7 of 0.75 s.
        assert begin - 1e-6 <= times[row].min() < begin + 0.02 and begin + 0.48 < times[row].max() <= begin + 0.5 + 1e-6


def test_a_moving_camera_is_where_its_rays_times_say() -> None:
    keys = [(0.0, (0.0, 0.0, 0.0), (0.0, 0.0, -1.0)), (1.0, (3.0, 0.0, 0.0), (3.0, 0.0, -1.0))]
    still = rc.Camera(LENS, film=FILM, exposure_time_s=1.0)
    moving = still.replace(motion=keys)
    a, b = still.generate_rays(spp=8), moving.generate_rays(spp=8)
    lit = a.weights > 0
    # It moves 3 m each second, along x.
    direction = (b.origins_m - a.origins_m)[lit]
    np.testing.assert_allclose(direction[:, 0], 3 * b.times_s[lit], atol=2e-6)
    np.testing.assert_allclose(direction[:, 1:], 0, atol=2e-6)


@pytest.mark.parametrize("wrong", [(700, 400), (100, 400), (400, float("nan"))])
def test_wavelengths_that_are_no_range(wrong: tuple[float, float]) -> None:
    with pytest.raises(rc.InputError, match="two numbers between 300 and 2500"):
        rc.Camera(LENS, film=FILM).generate_rays(wavelengths_nm=wrong)
    with pytest.raises(rc.InputError, match='requires the camera model "full"'):
        rc.Camera(LENS, film=FILM, model="thin").generate_rays(wavelengths_nm=(400, 700))
