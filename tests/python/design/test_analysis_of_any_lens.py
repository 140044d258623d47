"""Spots, wavefronts, contrast and light of fields that are named by film points, of lenses of any kind."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
import realcam as rc
from realcam import analysis
from realcam.fields import fields_along

from ..lens.test_first_order_of_any_lens import anamorphic

LENS = rc.Lens.load("double-gauss-50mm")
TURNS = {"pattern": "rings", "samples": 8}  # the same places after a turn by 90 degrees


@pytest.mark.parametrize("field_deg", [0.0, 7.0, 18.0])
def test_a_film_point_names_the_field_of_its_chief_ray(field_deg: float) -> None:
    by_angle = LENS.spot(field_deg)
    by_place = LENS.spot(film_mm=by_angle.chief_ray_mm)
    assert by_place.chief_ray_mm == pytest.approx(by_angle.chief_ray_mm, abs=1e-9)
    np.testing.assert_allclose(by_place.points_mm, by_angle.points_mm, atol=1e-9)
    # The wavefront's reference sphere reaches to the exit pupil of rays close to the chief ray, and with an angle to
    # where that crosses the axis: another radius of the sphere changes little.
    wave = LENS.wavefront(film_mm=by_angle.chief_ray_mm).rms_waves
    assert wave == pytest.approx(LENS.wavefront(field_deg).rms_waves, rel=2e-3)


def test_a_lens_of_revolution_is_the_same_all_around() -> None:
    upwards = LENS.spot(film_mm=(0, 12), **TURNS)
    for place in ((12, 0), (-12, 0), (0, -12)):
        around = LENS.spot(film_mm=place, **TURNS)
        assert around.rms_radius_mm == pytest.approx(upwards.rms_radius_mm, rel=1e-9)
        assert math.hypot(*around.centroid_mm) == pytest.approx(math.hypot(*upwards.centroid_mm), rel=1e-12)
        wave = LENS.wavefront(film_mm=place, **TURNS)
        assert wave.rms_waves == pytest.approx(LENS.wavefront(film_mm=(0, 12), **TURNS).rms_waves, rel=1e-8)
        light = LENS.film_pupil(place).irradiance
        assert light == pytest.approx(LENS.film_pupil((0, 12)).irradiance, rel=1e-4)


def test_an_anamorphic_lens_that_is_turned() -> None:
    """Turning by 90 degrees exchanges x and y."""
    lens = anamorphic().stopped_down(4)
    quarter = turned(lens)
    for x, y in ((0.0, 0.0), (10.0, 4.0), (-3.0, 9.0)):
        here, there = lens.spot(film_mm=(x, y), **TURNS), quarter.spot(film_mm=(-y, x), **TURNS)
        assert there.rms_radius_mm == pytest.approx(here.rms_radius_mm, rel=1e-6)
        contrast = [one.mtf([20.0])[1:] for one in (lens.psf(film_mm=(x, y)), quarter.psf(film_mm=(-y, x)))]
        assert float(contrast[0][0][0]) == pytest.approx(float(contrast[1][1][0]), abs=2e-3)


def turned(lens: rc.Lens) -> rc.Lens:
    """About its axis, by 90 degrees; what follows and the film stay, so that each surface is turned alone."""
    surfaces = [
        s if s.type == "stop" else s.replace(tilt_deg=(0, 0, 90), returns=True) if s.form == "toroid" else s
        for s in lens.surfaces
    ]
    return rc.Lens(surfaces=surfaces, film_distance_mm=lens.film_distance_mm).stopped_down(4)


def test_light_in_the_middle_is_pi_sine_squared() -> None:
    """Holds in both meridians: an anamorphic lens has different marginal-ray angles in x and in y, and the transmitted
    rays fill an ellipse of direction cosines."""
    for lens in (LENS, LENS.stopped_down(5.6), anamorphic(), anamorphic().stopped_down(8)):
        pupil = lens.film_pupil()
        half = 0.5 * np.ptp(pupil.outline.reshape(-1, 2), axis=0)
        assert pupil.irradiance == pytest.approx(math.pi * half[0] * half[1], rel=1e-3)
        # It also agrees with the f-number, except for the film's defocus and for spherical aberration.
        f_number = lens.first_order().f_number
        assert pupil.irradiance == pytest.approx(math.pi / (4 * f_number**2), rel=0.05)


def test_pictures_are_exposed_by_the_light_of_the_pupil() -> None:
    """A white world through an anamorphic lens: what generate_rays lets pass is the pupil's area, within the noise of
    4096 rays a place, 0.5%."""
    lens = anamorphic().stopped_down(4)
    film = rc.Film(24, 16, (7, 5))
    weights = rc.Camera(lens, film=film).generate_rays(spp=4096).weights
    weights = np.asarray(weights, float).reshape(5, 7, -1).mean(axis=2)
    for row, column in ((2, 3), (0, 0), (2, 6), (4, 3)):
        place = ((column - 3) * 24 / 7, -(row - 2) * 16 / 5)
        # A picture shows upright what the lens throws on the film upside down.
        around = [(dx - place[0], dy - place[1]) for dx in (-1, 1) for dy in (-1, 1)]
        mean = np.mean([lens.film_pupil(point).irradiance for point in around])
        assert weights[row, column] / weights[2, 3] == pytest.approx(mean / lens.film_pupil().irradiance, rel=0.01)


def test_maps_over_the_film() -> None:
    lens = LENS.stopped_down(5.6)
    spots = analysis.field_map(lens, "spot", points=(5, 3))
    assert spots.values.shape == (3, 5)
    np.testing.assert_allclose(spots.values, spots.values[::-1, ::-1], rtol=1e-6)
    assert spots.values[1, 4] == pytest.approx(
        1e3 * lens.spot(film_mm=(18, 0), pattern="rings", samples=12).rms_radius_mm
    )
    light = analysis.field_map(lens, "illumination", points=(5, 3))
    curve = analysis.film_pupils(lens, samples=11)
    assert light.values[0, 0] == pytest.approx(100 * curve.relative_illumination[-1], rel=2e-3)
    contrast = analysis.field_map(lens, "mtf-y", points=(3, 3), frequency_per_mm=20.0)
    along_y = analysis.mtf_over_field(lens, [20.0], wavelengths_nm=[lens.wavelength_nm], samples=3)
    assert contrast.values[1, 1] == pytest.approx(along_y.tangential[0, 0, 0], abs=1e-6)


def test_the_map_of_distortion_is_its_curve_in_all_directions() -> None:
    data = analysis.field_map(LENS, "distortion", points=(3, 3))
    curve = analysis.distortion(LENS)
    corner = math.hypot(*LENS.film_mm) / 2
    along = float(np.dot(data.vectors_mm[2, 2], [18, 12])) / corner
    # The one is a share of the real height, the other of the paraxial one.
    assert 100 * along / (corner - along) == pytest.approx(curve.percent[-1], abs=2e-3)
    squeezed = analysis.field_map(anamorphic(), "distortion", points=(5, 5))
    assert squeezed.values[2, 2] == pytest.approx(0, abs=1e-9)


def test_fields_that_are_none() -> None:
    with pytest.raises(rc.InputError, match="field_deg and film_mm both name a field"):
        LENS.spot(10.0, film_mm=(0, 1))
    with pytest.raises(rc.InputError, match=r"at the film point \(0, 500\) mm reaches"):
        LENS.spot(film_mm=(0, 500))
    with pytest.raises(rc.InputError, match="point of the film"):
        LENS.spot(film_mm=(math.nan, 0))
    with pytest.raises(rc.InputError, match='unknown quantity "sharpness"'):
        analysis.field_map(LENS, "sharpness")
    assert LENS.film_pupil((0, 500)).irradiance == 0


def test_no_field_is_lost_beyond_a_small_image_circle() -> None:
    """The light ends at the same film point, however much larger the film is."""
    lens = rc.Lens.load("tessar-50mm").with_film(80.0, 80.0)
    large = rc.Lens.load("tessar-50mm").with_film(400.0, 400.0)
    for axis in (0, 1):
        assert [field.share for field in fields_along(large, (-1, 0, 1), axis)] == [-1, 0, 1]
        last = [fields_along(one, (1,), axis)[0].film_height_mm for one in (lens, large)]
        assert last[1] == pytest.approx(last[0], rel=0.06)  # steps of 5%


@pytest.mark.parametrize(
    "name",
    [
        "view-camera-210mm",
        *(
            pytest.param(name, marks=pytest.mark.slow)
            for name in (
                "anamorphic-31mm", "anamorphic-65mm", "off-axis-500mm", "periscope-50mm", "schmidt-225mm",
                "scope-adapter-50mm",
            )
        ),
    ],
)  # fmt: skip
@pytest.mark.slow
def test_reports_of_lenses_that_are_not_of_revolution(name: str, tmp_path: Path) -> None:
    """The report has maps over the film, and film points instead of field angles; every plot is drawn."""
    lens = rc.Lens.load(name)
    analysis.save_report(lens, tmp_path / "r.html", wavelengths_nm=[587.6])
    page = (tmp_path / "r.html").read_text(encoding="utf-8")
    x, y = (0.35 * side for side in lens.film_mm)
    points = f"(0, 0), ({x:.3g}, 0), (0, {y:.3g}), ({x:.3g}, {y:.3g}) mm on the film"
    assert points in page
    assert "Over the film" in page and "Points of the film" in page
    for title in (
        "RMS radius of the spot",
        "RMS wavefront error",
        "contrast of a pattern along x",
        "illumination, relative",
    ):
        assert title in page, title
    assert page.count(f"({x:.3g}, {y:.3g}) mm, RMS") == 2  # spot and wavefront
    assert "no light" not in page
    with pytest.raises(rc.InputError, match="fields_deg does not apply"):
        analysis.save_report(lens, tmp_path / "r.html", fields_deg=[0, 5, 10])


def test_spots_at_film_points_are_those_of_their_angles() -> None:
    """The double Gauss at 10 degrees, by its angle and by the film point at which the chief ray ends."""
    lens = LENS.stopped_down(4)
    height = lens.spot(10.0).chief_ray_mm[1]
    by_angle = analysis.spot_diagram(lens, [10.0], [546.0], rings=4)
    by_point = analysis.spot_diagram(lens, wavelengths_nm=[546.0], film_mm=[(0.0, height)], rings=4)
    np.testing.assert_allclose(by_point.points_mm, by_angle.points_mm, atol=1e-7)
    assert np.isnan(by_point.fields_deg).all()
    np.testing.assert_array_equal(by_point.film_mm, [(0.0, height)])
    with pytest.raises(rc.InputError, match="film_mm must be at least one film point"):
        analysis.spot_diagram(lens, film_mm=[1.0, 2.0, 3.0])


def test_numbers_of_maps_are_written(tmp_path: Path) -> None:
    """Maps without frequency and vectors have null for them."""
    told = json.loads(analysis.as_json(analysis.field_map(LENS, "spot", points=(2, 2))))
    assert told["frequency_per_mm"] is None and told["vectors_mm"] is None
    assert np.shape(told["values"]) == (2, 2)


def test_the_distortion_of_a_lens_whose_middle_is_obstructed() -> None:
    """The mirror lens blocks the ray through the middle of its stop; bundles find where it would end, by its angle."""
    lens = rc.Lens.load("mirror-telephoto-500mm")

    def height_mm(angle_deg: float) -> float:
        return abs(lens.bundle(angle_deg, object_distance_m=math.inf, arms=8, nodes=2).chief_ray_mm[1])

    edge = height_mm(1.2)
    straight = height_mm(0.01) / math.tan(math.radians(0.01)) * math.tan(math.radians(1.2))
    narrow = lens.with_film(36, 2 * edge)
    bent = analysis.field_map(narrow, "distortion", points=(3, 3))
    assert np.isfinite(bent.values).all()
    assert bent.vectors_mm is not None
    assert bent.vectors_mm[2, 1, 1] == pytest.approx(edge - straight, rel=0.01)
    assert bent.vectors_mm[1, 1] == pytest.approx(0, abs=1e-6)
