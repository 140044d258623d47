"""Helpers of the sensor tests: films of given exposure, and photon counts."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import realcam as rc

PLANCK, LIGHT = 6.62607015e-34, 299792458.0  # J s, m / s
LUMENS_PER_WATT = 683
# CIE 1931 luminosity at some wavelengths in nm (CIE 018:2019, table 1).
LUMINOSITY = {500: 0.323, 550: 0.99495, 555: 1.0, 600: 0.631}


@cache
def _taken(iso: float, exposure_time_s: float) -> rc.Image:
    lens = rc.Lens.load("double-gauss-50mm")
    camera = rc.Camera(lens, film=rc.Film(36, 24, (6, 4)), exposure_time_s=exposure_time_s, iso=iso)
    speck = rc.Scene.from_arrays([(0, 0, 1e3), (1, 0, 1e3), (0, 1, 1e3)], [(0, 1, 2)]).with_environment(1)
    return rc.render(speck, camera, effects=(), spp=1, device="cpu")


def film_of(
    pixels: np.ndarray,
    *,
    pitch_um: float,
    iso: float = 100,
    exposure_time_s: float = 0.01,
    illuminant: str = "",
) -> rc.Image:
    """An Image with an exposure of (H, W) or (H, W, 3) lux seconds on pixels of one size."""
    if pixels.ndim == 2:
        pixels = np.repeat(pixels[..., None], 3, axis=2)
    height, width = pixels.shape[:2]
    taken = _taken(iso, exposure_time_s)
    film = rc.Film(width * pitch_um / 1000, height * pitch_um / 1000, (width, height))
    return replace(
        taken,
        pixels=np.asarray(pixels, np.float32),
        depth=np.full((height, width), np.inf, np.float32),
        camera=taken.camera.replace(film=film),
        settings=rc.RenderSettings(effects=("dispersion",), illuminant=illuminant) if illuminant else taken.settings,
    )


def photons_per_um2(lux_s: float, wavelength_nm: float) -> float:
    """Photons per um^2 at a wavelength for which LUMINOSITY is known, from the definition of the candela and the
    energy of a photon."""
    joules_per_m2 = lux_s / (LUMENS_PER_WATT * LUMINOSITY[round(wavelength_nm)])
    return joules_per_m2 * wavelength_nm * 1e-9 / (PLANCK * LIGHT) * 1e-12


def counter(**changes: object) -> rc.Sensor:
    """A sensor whose numbers are electrons: one for each photon, of 1 um^2, and no noise but light's own."""
    return rc.Sensor.load("ideal").replace(
        color_filter_array="",
        quantum_efficiency=[(300, 1), (900, 1)],
        pixel_pitch_um=1,
        gain_dn_per_e=1,
        adc_bits=16,
        **changes,
    )


def electron_film(mean: float, shape: tuple[int, int], **changes: object) -> rc.Image:
    """A film that gives `mean` electrons in each pixel of `counter()`, at its own ISO, in light of 550 nm."""
    lux_s = mean / photons_per_um2(1, 550)
    iso = counter(**changes).iso_range()[0]
    return film_of(np.full(shape, lux_s), pitch_um=1, iso=iso, illuminant="550")
