"""Any numbers are a lens, a wavelength or a camera, or are refused: searched by hypothesis.

tests/fuzz searches lenses and rays for broken laws of optics, and test_scaled_lenses.cpp scales them.

Ordinarily the same examples each time, and few of them; HYPOTHESIS_PROFILE=search draws new ones, for minutes.
"""

from __future__ import annotations

import math
import os

import numpy as np
import realcam as rc
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from .. import scenes

settings.register_profile(
    "ci", derandomize=True, max_examples=40, deadline=None, database=None, suppress_health_check=list(HealthCheck)
)
settings.register_profile("search", max_examples=2000, deadline=None, suppress_health_check=list(HealthCheck))
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "ci"))

ANY = st.one_of(st.floats(), st.sampled_from([0.0, -0.0, 1e-300, 1e-12, 1.0, 36.0, 1e18, 1e300, math.inf, math.nan]))
SEEDS = st.integers(0, 2**32 - 1)


def check_sane(out: rc.TraceResult, surfaces: int) -> None:
    assert np.isin(out.status, [int(s) for s in rc.RayStatus]).all()
    assert np.isfinite(out.origins_mm).all()
    assert np.isfinite(out.optical_path_mm).all()
    bad = out.status == rc.RayStatus.BAD_INPUT
    np.testing.assert_allclose(np.linalg.norm(out.directions, axis=1), np.where(bad, 0, 1), atol=1e-15 * 4)
    assert (out.surface_index[bad] == -1).all()
    assert (out.surface_index[~bad] >= 0).all()
    assert (out.surface_index < surfaces).all()


@given(
    st.lists(
        st.fixed_dictionaries(
            {"clear_semi_diameter_mm": ANY},
            optional={
                "type": st.sampled_from(["refracting", "mirror", "stop", "aperture"]),
                "radius_of_curvature_mm": ANY,
                "thickness_mm": ANY,
                "conic": ANY,
                "inner_semi_diameter_mm": ANY,
                "material": st.one_of(st.none(), ANY, st.tuples(ANY, ANY)),
                "aspheric_coefficients": st.dictionaries(st.sampled_from([4, 6, 18]), ANY),
            },
        ),
        max_size=3,
    ),
    st.fixed_dictionaries(
        {},
        optional={
            "film_distance_mm": ANY,
            "film_mm": st.tuples(ANY, ANY),
            "wavelength_nm": ANY,
            "iris_blades": st.integers(-3, 30),
            "iris_rounding": ANY,
            "iris_rotation_deg": ANY,
            "focus_group": st.tuples(st.integers(-3, 5), st.integers(-3, 5)),
            "nearest_focus_m": ANY,
        },
    ),
    SEEDS,
)
def test_any_numbers_are_a_lens_or_an_error_of_ours(
    surfaces: list[dict[str, object]], options: dict[str, object], seed: int
) -> None:
    try:
        lens = rc.Lens(
            surfaces=[rc.Surface(**s) for s in [*surfaces, {"type": "stop", "clear_semi_diameter_mm": 5}]], **options
        )
    except (rc.InputError, rc.LensFileError):
        return
    assert lens.film_distance_mm > 0
    assert np.isfinite(lens.film_distance_mm)
    rng = np.random.default_rng(seed)
    for start in ("film", "scene"):
        out = lens.trace(rng.normal(0, 5, (16, 3)), rng.normal(0, 1, (16, 3)), start=start)
        check_sane(out, len(lens.surfaces))


LENSES = st.sampled_from(["double-gauss-50mm", "fisheye-6mm-220deg", "telephoto-200mm-inner-focus", "phone-4mm"])


@given(LENSES, ANY, SEEDS)
def test_any_wavelength_is_traced_or_refused(name: str, wavelength_nm: float, seed: int) -> None:
    lens = rc.Lens.load(name)
    rng = np.random.default_rng(seed)
    try:
        out = lens.trace(rng.normal(0, 5, (16, 3)), rng.normal(0, 1, (16, 3)), wavelength_nm=wavelength_nm)
    except rc.InputError:
        return
    check_sane(out, len(lens.surfaces))


POINTS = st.tuples(ANY, ANY, ANY)
USUAL = st.floats(0.1, 10)


@given(
    st.sampled_from(["pinhole", "thin", "thick", "full"]),
    st.one_of(st.just((36, 24)), st.tuples(st.one_of(USUAL, ANY), st.one_of(USUAL, ANY))),
    st.fixed_dictionaries(
        {},
        optional={
            "position": POINTS,
            "look_at": POINTS,
            "up": POINTS,
            "exposure_time_s": ANY,
            "iso": ANY,
        },
    ),
    SEEDS,
)
def test_any_camera_takes_finite_pictures_or_is_refused(
    model: str, film_mm: tuple[float, float], options: dict[str, object], seed: int
) -> None:
    try:
        film = rc.Film(*film_mm, (3, 2))
        camera = rc.Camera(rc.Lens.load("tessar-50mm"), film=film, model=model, **options)
        rays = camera.generate_rays(spp=2, seed=seed)
        image = rc.render(scenes.sky(1.0), camera, effects=(), spp=2, seed=seed)
    except rc.InputError:
        return
    assert np.isfinite(rays.origins_m).all()
    np.testing.assert_allclose(np.linalg.norm(rays.directions, axis=1), 1, atol=1e-5)
    assert np.isfinite(rays.weights).all()
    assert (rays.weights >= 0).all()
    assert np.isfinite(image.pixels).all()
    assert (image.pixels >= 0).all()
