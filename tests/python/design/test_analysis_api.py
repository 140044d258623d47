"""Lens.seidel, wavefront, spot, aim and ghost: shapes, patterns, choices and errors. tests/truth proves the figures."""

from __future__ import annotations

import math

import numpy as np
import pytest
import realcam as rc

from ...centred_lenses import CENTRED

LENS = rc.Lens.load("double-gauss-50mm")


def test_seidel_has_a_row_for_each_surface() -> None:
    sums = LENS.seidel(10.0)
    count = len(LENS.surfaces)
    names = [name for name in dir(sums) if not name.startswith("_")]
    arrays = {name: value for name in names if isinstance(value := getattr(sums, name), np.ndarray)}
    assert len(arrays) == 18
    for name, value in arrays.items():
        assert value.shape[0] == count, name
        assert np.isfinite(value).all(), name
    assert (sums.seidel_mm.shape, sums.colour_mm.shape) == ((count, 5), (count, 2))
    assert sums.coefficients_waves.shape == (count, 7)
    # The stop does nothing.
    assert not sums.seidel_mm[LENS.stop_index].any()
    # W040 = S_I / 8, W131 = S_II / 2, W222 = S_III / 2, W220 = (S_III + S_IV) / 4, W311 = S_V / 2; in waves.
    s = sums.seidel_mm / (sums.wavelength_nm * 1e-6)
    expected = [s[:, 0] / 8, s[:, 1] / 2, s[:, 2] / 2, (s[:, 2] + s[:, 3]) / 4, s[:, 4] / 2]
    np.testing.assert_allclose(sums.coefficients_waves[:, :5], np.stack(expected, axis=1), rtol=1e-14)


def test_seidel_changes_its_sign_with_the_field_where_it_must() -> None:
    up, down = LENS.seidel(10.0).seidel_mm, LENS.seidel(-10.0).seidel_mm
    np.testing.assert_allclose(down, up * [1, -1, 1, 1, -1], rtol=1e-12, atol=1e-18)


def test_a_constant_index_has_no_colour() -> None:
    assert not rc.Lens.load("wide-22mm").seidel(10.0).colour_mm.any()
    coloured = rc.Lens.load("double-gauss-100mm").seidel(10.0).axial_colour_mm
    # Colours in the other order change the sign.
    turned = rc.Lens.load("double-gauss-100mm").seidel(10.0, colours_nm=(656.2725, 486.1327)).axial_colour_mm
    np.testing.assert_allclose(turned, -coloured, rtol=1e-12, atol=1e-18)


@pytest.mark.parametrize(("pattern", "samples", "count"), [("grid", 20, 316), ("rings", 5, 100), ("hexapolar", 6, 127)])
def test_patterns(pattern: str, samples: int, count: int) -> None:
    wavefront = LENS.stopped_down(8).wavefront(0.0, pattern=pattern, samples=samples)
    spot = LENS.stopped_down(8).spot(0.0, pattern=pattern, samples=samples)
    assert wavefront.opd_waves.shape == wavefront.weights.shape == wavefront.status.shape == (count,)
    assert wavefront.pupil.shape == spot.points_mm.shape == (count, 2)
    assert (wavefront.status == rc.RayStatus.OK).all()
    assert wavefront.weights.sum() == pytest.approx(1)
    assert np.hypot(*wavefront.pupil.T).max() <= 1 + 1e-15
    # Each pattern represents the whole disc: the mean of x^2 is 1/4. Equal weights on rings up to the edge overweight
    # the edge, by one part in the number of rings.
    mean = (wavefront.weights * wavefront.pupil[:, 0] ** 2).sum()
    assert mean == pytest.approx(0.25, rel={"grid": 0.02, "rings": 1e-12, "hexapolar": 0.2}[pattern])


def test_figures_of_a_wavefront_are_those_of_its_rays() -> None:
    wavefront = LENS.wavefront(12.0, samples=40)
    good = wavefront.status == rc.RayStatus.OK
    assert 100 < good.sum() < good.size
    np.testing.assert_array_equal(np.isnan(wavefront.opd_waves), ~good)
    w, weights = wavefront.opd_waves[good], wavefront.weights[good] / wavefront.weights[good].sum()
    mean = (weights * w).sum()
    assert wavefront.rms_waves == pytest.approx(math.sqrt((weights * (w - mean) ** 2).sum()), rel=1e-12)
    assert wavefront.peak_to_valley_waves == pytest.approx(w.max() - w.min(), rel=1e-12)
    assert wavefront.strehl == pytest.approx(abs((weights * np.exp(2j * np.pi * w)).sum()) ** 2, rel=1e-9)
    image = wavefront.map_waves()
    assert image.shape == (40, 40)
    # Rows from the lowest y, columns from the lowest x.
    row, column = np.argwhere(np.isfinite(image))[7]
    here = np.isclose(wavefront.pupil, ((2 * column + 1) / 40 - 1, (2 * row + 1) / 40 - 1)).all(axis=1)
    assert image[row, column] == wavefront.opd_waves[here][0]
    # The field lies in the y-z plane.
    np.testing.assert_allclose(image, image[:, ::-1], atol=1e-6)


def test_the_centroid_is_another_centre() -> None:
    chief, centroid = LENS.wavefront(12.0), LENS.wavefront(12.0, reference="centroid")
    spot = LENS.spot(12.0, pattern="grid", samples=64)
    assert chief.centre_mm[:2] == pytest.approx(spot.chief_ray_mm, abs=1e-12)
    assert centroid.centre_mm[:2] == pytest.approx(spot.centroid_mm, abs=1e-12)
    assert centroid.centre_mm[2] == pytest.approx(LENS.film_position_mm)
    # The two references differ by a tilt.
    levels = [LENS.wavefront(12.0, reference=r, remove="tilt").rms_waves for r in ("chief", "centroid")]
    assert levels[0] == pytest.approx(levels[1], rel=0.02)


def test_a_spot_about_its_centroid_is_the_smallest() -> None:
    spot = LENS.spot(15.0, pattern="grid", samples=40)
    good = spot.status == rc.RayStatus.OK
    assert 100 < good.sum() < good.size
    points = spot.points_mm[good]
    assert points.mean(axis=0) == pytest.approx(spot.centroid_mm, abs=1e-12)
    radii = np.hypot(*(points - spot.centroid_mm).T)
    assert spot.rms_radius_mm == pytest.approx(math.sqrt((radii**2).mean()), rel=1e-12)
    assert spot.max_radius_mm == pytest.approx(radii.max(), rel=1e-12)
    shift = math.dist(spot.centroid_mm, spot.chief_ray_mm)
    assert spot.rms_radius_about_chief_ray_mm == pytest.approx(math.hypot(spot.rms_radius_mm, shift), rel=1e-9)
    # Positive field: the light rises towards +y.
    assert spot.chief_ray_mm[1] > 0
    assert LENS.spot(-15.0).chief_ray_mm[1] == pytest.approx(-spot.chief_ray_mm[1], rel=1e-9)


def test_a_spot_on_another_plane() -> None:
    there = LENS.film_distance_mm + 0.5
    moved = rc.Lens(surfaces=LENS.surfaces, film_distance_mm=there)
    assert LENS.spot(5.0, film_distance_mm=there).rms_radius_mm == moved.spot(5.0).rms_radius_mm
    assert LENS.spot(5.0, film_distance_mm=there).rms_radius_mm > 3 * LENS.spot(5.0).rms_radius_mm


PLATE = rc.Lens(
    surfaces=[
        rc.Stop(clear_semi_diameter_mm=5, thickness_mm=1),
        rc.Surface(material=1.5, thickness_mm=5, clear_semi_diameter_mm=9),
        rc.Surface(clear_semi_diameter_mm=9),
    ],
    film_distance_mm=10,
)
TELECENTRIC = rc.Lens(
    surfaces=[
        rc.Surface(radius_of_curvature_mm=50, material=1.5, clear_semi_diameter_mm=9),
        rc.Surface(thickness_mm=100, clear_semi_diameter_mm=9),
        rc.Stop(clear_semi_diameter_mm=5),
    ],
    film_distance_mm=10,
    allow_overlap=True,
)


@pytest.mark.parametrize(
    ("call", "required"),
    [
        (lambda: LENS.wavefront(60.0), "no ray at a field angle of 60 deg reaches the centre of the stop"),
        (lambda: LENS.spot(30.0), "none of 127 rays at a field angle of 30 deg passes lens"),
        (lambda: LENS.spot(200.0), "field angle is 200 deg; expected less than 180 deg"),
        (lambda: LENS.spot(95.0, object_distance_m=2.0), "less than 90 deg"),
        (lambda: LENS.spot(0.0, object_distance_m=0.0), "object distance must be a positive"),
        (lambda: LENS.spot(0.0, film_distance_mm=math.inf), "film_distance_mm must be a finite length"),
        (lambda: LENS.spot(0.0, wavelength_nm=5.0), "wavelength must lie between"),
        (lambda: LENS.wavefront(0.0, pattern="spiral"), 'unknown pattern "spiral"; expected grid, rings or hexapolar'),
        (lambda: LENS.wavefront(0.0, samples=0), "samples must lie between 1 and 2048"),
        (lambda: LENS.wavefront(0.0, reference="film"), 'unknown reference "film"; expected chief or centroid'),
        (lambda: LENS.wavefront(0.0, remove="coma"), 'cannot remove "coma"; expected tilt, focus or None'),
        (lambda: LENS.wavefront(0.0, remove="focus", pupil=[[0, 0]]), "too few, or too close together"),
        (lambda: LENS.wavefront(0.0, pupil=np.zeros((0, 2))), r"pupil must be an array of shape \(N, 2\)"),
        (lambda: LENS.wavefront(0.0, pupil=[[50, 0]]), "units of the stop's radius"),
        (lambda: LENS.wavefront(0.0, pattern="rings", samples=4).map_waves(), 'a map requires the pattern "grid"'),
        (lambda: LENS.wavefront(0.0, film_distance_mm=-30.0), "no reference sphere"),
        (lambda: LENS.seidel(90.0), "less than 90 deg"),
        (lambda: PLATE.seidel(3.0), "afocal"),
        (lambda: TELECENTRIC.spot(3.0), "telecentric on the object's side"),
        (lambda: TELECENTRIC.seidel(3.0), "telecentric on the object's side"),
        (
            lambda: rc.analysis.mtf(LENS, object_distance_m=-1),
            "object_distance_m must be a positive length, or inf; it is -1",
        ),
        (lambda: rc.analysis.mtf(LENS, frequencies_per_mm=-1), "^frequencies_per_mm must not be negative"),
        (lambda: rc.analysis.mtf_over_frequency(LENS, highest_per_mm=-1), "^highest_per_mm must not be negative"),
        (lambda: rc.analysis.mtf_over_frequency(LENS, highest_per_mm=math.inf), "^highest_per_mm must be finite"),
        (lambda: rc.analysis.mtf_over_frequency(LENS, samples=0), "^samples must be 1 or more; it is 0"),
        (lambda: rc.analysis.mtf_through_focus(LENS, -1.0), "^frequency_per_mm must not be negative"),
        (lambda: rc.analysis.field_map(LENS, "mtf-x", frequency_per_mm=-1), "^frequency_per_mm must not be negative"),
        (lambda: rc.analysis.ray_fan(LENS, samples=-1), "^samples must be 1 or more"),
        (lambda: rc.analysis.longitudinal_aberration(LENS, samples=0), "^samples must be 1 or more"),
        (lambda: rc.analysis.depth_over_focus(LENS, samples=-1), "^samples must be 1 or more"),
        (
            lambda: rc.analysis.depth_over_focus(LENS, circle_of_confusion_mm=0),
            "circle of confusion must be a positive",
        ),
        (lambda: rc.analysis.distortion_grid(LENS, lines=-1), "^lines must be 1 or more"),
        (lambda: rc.analysis.bokeh(LENS, size=0), "^size must be 1 or more"),
    ],
)
def test_mistakes_get_one_clear_error(call: object, required: str) -> None:
    assert callable(call)
    with pytest.raises(rc.InputError, match=required) as error:
        call()
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("name", CENTRED)
@pytest.mark.parametrize("f_number", [None, 8.0])
def test_a_ray_aimed_at_the_edge_of_the_stop_passes_it_when_it_is_traced(name: str, f_number: float | None) -> None:
    lens = rc.Lens.load(name)
    if f_number is not None:
        lens = lens.stopped_down(max(f_number, 1.4 * lens.first_order().f_number))  # some open to f/10 and less
    turn = np.linspace(0, 2 * np.pi, 400, endpoint=False)
    aimed = lens.aim(np.column_stack([np.cos(turn), np.sin(turn)]))
    ok = aimed.status == rc.RayStatus.OK
    assert ok.any() or f_number is None
    again = lens.trace(aimed.origins_mm[ok], aimed.directions[ok], start="scene")
    assert (again.status == rc.RayStatus.OK).all()
    at_stop = lens.trace(aimed.origins_mm[ok], aimed.directions[ok], start="scene", surface_count=lens.stop_index + 1)
    # Rays are aimed 5e-11 inside the stop's edge, and land within half of that.
    share = np.hypot(*at_stop.origins_mm[:, :2].T) / lens.stop_semi_diameter_mm
    assert share.min(initial=1) > 1 - 1e-10
    assert share.max(initial=0) <= 1


def test_rays_that_no_stop_lets_pass_have_no_numbers() -> None:
    aimed = LENS.aim([[0.0, 0.0], [1 + 1e-8, 0.0], [1.2, 0.0], [9.0, 0.0]])
    status = rc.RayStatus
    assert aimed.status.tolist() == [status.OK, status.VIGNETTED, status.VIGNETTED, status.NO_CONVERGENCE]
    assert np.isnan(aimed.origins_mm[1:]).all() and np.isnan(aimed.directions[1:]).all()


def test_the_plane_in_focus_is_the_object_where_none_is_given() -> None:
    """test_analysis.py has spots, wavefronts and third-order sums."""
    near = LENS.focused(0.8)
    to_object = 0.8 - near.film_position_mm / 1000
    places = [[0.3, 0.4], [0.0, 0.9]]
    expected = near.aim(places, 5.0, object_distance_m=to_object).directions
    np.testing.assert_allclose(near.aim(places, 5.0).directions, expected, atol=1e-12)
    # The film is at the smallest axial spot of the plane in focus; focusing converges to 1e-9 of the distance.
    assert near.best_focus_mm() == pytest.approx(near.film_distance_mm, rel=1e-9)
    assert near.best_focus_mm(math.inf) == pytest.approx(LENS.film_distance_mm, rel=1e-9)
    # For a lens focused at infinity the plane in focus is at infinity, even for field angles beyond 90 degrees.
    fisheye = rc.Lens.load("fisheye-6mm-220deg")
    assert fisheye.spot(100.0).rms_radius_mm == fisheye.spot(100.0, object_distance_m=math.inf).rms_radius_mm
    with pytest.raises(rc.InputError, match="expected less than 90 deg for the plane in focus"):
        fisheye.focused(1.0).spot(100.0)
