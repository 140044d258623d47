"""Properties that hold for every lens and every ray, searched by hypothesis.

Ordinarily the same examples each time, and few of them; HYPOTHESIS_PROFILE=search draws new ones, for minutes.
"""

from __future__ import annotations

import os

import numpy as np
import pytest
import realcam as rc
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from .. import scenes
from . import drawn
from .drawn import ANY, Drawn

settings.register_profile(
    "ci", derandomize=True, max_examples=40, deadline=None, database=None, suppress_health_check=list(HealthCheck)
)
settings.register_profile("search", max_examples=2000, deadline=None, suppress_health_check=list(HealthCheck))
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "ci"))

EPS = {"float64": 2.0**-52, "float32": 2.0**-23}
STARTS = st.sampled_from(["film", "scene"])
TYPES = st.sampled_from(["float64", "float32"])
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


@given(drawn.lenses(hard=True), STARTS, TYPES, SEEDS)
def test_rays_end_in_a_status_with_finite_numbers(lens: Drawn, start: str, dtype: str, seed: int) -> None:
    out = lens.lens().trace(*drawn.rays(lens, start, seed), start=start, dtype=dtype)
    check_sane(out, len(lens.rows))
    assert (out.status != rc.RayStatus.BAD_INPUT).all()


TRIPLES = hnp.arrays(np.float64, (8, 3), elements=ANY)


@given(drawn.lenses(hard=True), STARTS, TYPES, TRIPLES, TRIPLES)
def test_any_numbers_at_all_are_rays_or_bad_input(
    lens: Drawn, start: str, dtype: str, origins: np.ndarray, directions: np.ndarray
) -> None:
    built = lens.lens()
    out = built.trace(origins, directions, start=start, dtype=dtype)
    check_sane(out, len(lens.rows))
    from_vertex = origins.copy()
    from_vertex[:, 2] -= 0 if start == "scene" else built.vertices_mm[-1]
    good = np.isfinite(origins).all(axis=1) & np.isfinite(directions).all(axis=1)
    good &= (directions != 0).any(axis=1) & (np.abs(np.where(np.isfinite(from_vertex), from_vertex, 0)) <= 1e18).all(
        axis=1
    )
    np.testing.assert_array_equal(out.status != rc.RayStatus.BAD_INPUT, good)


@given(drawn.lenses(hard=True), STARTS, TYPES, SEEDS)
def test_a_mirror_image_of_the_rays_gives_that_of_the_result(lens: Drawn, start: str, dtype: str, seed: int) -> None:
    # Exact: every formula is odd or even in x.
    built, flip = lens.lens(), np.array([-1.0, 1.0, 1.0])
    origins, directions = drawn.rays(lens, start, seed)
    one = built.trace(origins, directions, start=start, dtype=dtype)
    other = built.trace(origins * flip, directions * flip, start=start, dtype=dtype)
    np.testing.assert_array_equal(other.status, one.status)
    np.testing.assert_array_equal(other.origins_mm, one.origins_mm * flip)
    np.testing.assert_array_equal(other.directions, one.directions * flip)
    np.testing.assert_array_equal(other.optical_path_mm, one.optical_path_mm)


@given(drawn.lenses(hard=True), STARTS, TYPES, SEEDS, st.integers(-6, 6))
def test_a_lens_scaled_by_a_power_of_two_scales_its_rays(
    lens: Drawn, start: str, dtype: str, seed: int, power: int
) -> None:
    # Exact, because no formula knows a length; but enter_lens does, which moves rays from more than a metre away.
    scale = 2.0**power
    assume(5 * lens.size * max(scale, 1) < 100)
    origins, directions = drawn.rays(lens, start, seed)
    one = lens.lens().trace(origins, directions, start=start, dtype=dtype)
    other = lens.lens(scale).trace(origins * scale, directions, start=start, dtype=dtype)
    np.testing.assert_array_equal(other.status, one.status)
    np.testing.assert_array_equal(other.origins_mm, one.origins_mm * scale)
    np.testing.assert_array_equal(other.directions, one.directions)
    np.testing.assert_array_equal(other.optical_path_mm, one.optical_path_mm * scale)


def spread(
    lens: rc.Lens, origins: np.ndarray, directions: np.ndarray, size: float, **how: str
) -> tuple[np.ndarray, ...]:
    """Sensitivity to the rounding of the entering rays: change of the results per change of the origins (relative to
    `size`) and directions, from steps of 1e-7. Also returns which rays pass for all steps."""
    step = 1e-7
    base = lens.trace(origins, directions, **how)
    moved, stays = np.zeros(len(origins)), base.status == 0
    for axis in (0, 1):
        for of_origin in (size, 0.0):
            shift = np.zeros(3)
            shift[axis] = step
            near = lens.trace(origins + of_origin * shift, directions + (0 if of_origin else shift), **how)
            stays &= near.status == 0
            change = np.linalg.norm(near.origins_mm - base.origins_mm, axis=1) / size
            moved = np.maximum(moved, change + np.linalg.norm(near.directions - base.directions, axis=1))
    return stays, moved / step


@given(drawn.lenses(hard=False), STARTS, SEEDS, st.floats(0, 7))
def test_rotated_rays_give_rotated_results(lens: Drawn, start: str, seed: int, angle: float) -> None:
    built = lens.lens()
    cos, sin = np.cos(angle), np.sin(angle)
    turn = np.array([[cos, sin, 0], [-sin, cos, 0], [0, 0, 1]])
    origins, directions = drawn.rays(lens, start, seed)
    stays, condition = spread(built, origins, directions, lens.size, start=start)
    one = built.trace(origins, directions, start=start)
    other = built.trace(origins @ turn, directions @ turn, start=start)
    # The rotation rounds the rays, and each surface its hit: a few times four numbers, ten sizes long.
    bound = 64 * len(lens.rows) * EPS["float64"] * (10 + condition[stays])
    assert (other.status[stays] == 0).all()
    apart = np.linalg.norm(other.origins_mm - one.origins_mm @ turn, axis=1)[stays] / lens.size
    turned = np.linalg.norm(other.directions - one.directions @ turn, axis=1)[stays]
    assert (apart + turned <= bound).all(), np.max((apart + turned) / bound)


@given(drawn.lenses(hard=False), STARTS, SEEDS)
def test_a_ray_sent_back_retraces_its_way(lens: Drawn, start: str, seed: int) -> None:
    built, back = lens.lens(), "film" if start == "scene" else "scene"
    origins, directions = drawn.rays(lens, start, seed)
    one = built.trace(origins, directions, start=start)
    passed = one.status == 0
    origins, directions = (
        origins[passed],
        directions[passed] / np.linalg.norm(directions[passed], axis=1, keepdims=True),
    )
    ends, ways = one.origins_mm[passed], -one.directions[passed]
    other = built.trace(ends, ways, start=back)
    stays, condition = spread(built, ends, ways, lens.size, start=back)
    assert (other.status[stays] == 0).all()
    # The reversed ray, leaving the first surface, must hit the original point in the opposite direction.
    reach = np.sum((origins - other.origins_mm) * other.directions, axis=1, keepdims=True)
    apart = np.linalg.norm(other.origins_mm + reach * other.directions - origins, axis=1) / lens.size
    turned = np.linalg.norm(other.directions + directions, axis=1)
    bound = 64 * len(lens.rows) * EPS["float64"] * (10 + 10 * condition)
    assert (apart + turned <= bound)[stays].all(), np.max(((apart + turned) / bound)[stays])


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


@given(LENSES, ANY)
def test_any_focus_distance_is_set_or_refused(name: str, metres: float) -> None:
    try:
        lens = rc.Lens.load(name).focused(metres)
    except rc.InputError:
        return
    assert lens.focus_distance_m == pytest.approx(metres, rel=1e-15)
    assert 0 < lens.film_distance_mm < np.inf


@given(LENSES, ANY)
def test_any_f_number_is_set_or_refused(name: str, f_number: float) -> None:
    lens = rc.Lens.load(name)
    try:
        stopped = lens.stopped_down(f_number)
    except rc.InputError:
        return
    assert 0 <= stopped.stop_semi_diameter_mm <= lens.stop_semi_diameter_mm


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
