"""Case D: figures from published runs of OpticStudio."""

from __future__ import annotations

import numpy as np
import pytest
import realcam as rc

from . import code_v_listing


def test_double_gauss_at_f_5() -> None:
    lens = code_v_listing.listed_lens()
    # The run states an entrance pupil of 20.00075: a fifth of the focal length.
    first = lens.stopped_down(5.0).first_order()
    # Half a unit of the last digit, and of the glasses' formulas that of an index in the seventh decimal:
    # 1e-5.
    assert first.effective_focal_length_mm == pytest.approx(100.003748, abs=1e-5)
    assert first.entrance_pupil_diameter_mm == pytest.approx(20.00075, abs=1e-5)
    assert first.entrance_pupil_position_mm == pytest.approx(57.912, abs=0.5e-3)
    assert first.exit_pupil_diameter_mm == pytest.approx(22.92889, abs=1e-5)
    # Seen from the run's image, in the paraxial focus.
    focus = lens.vertices_mm[-1] + first.back_focal_distance_mm
    assert first.exit_pupil_position_mm - focus == pytest.approx(-114.6444, abs=0.6e-4)


def test_singlet_with_its_stop_behind() -> None:
    first = rc.Lens.load("singlet-100mm").first_order()
    # An index of LAC9 that is off by 1e-7 makes 1.5e-5 of the focal length: catalogues round their
    # coefficients.
    assert first.effective_focal_length_mm == pytest.approx(101.501826, abs=2e-5)
    # The stop's radius, with four decimals in the lens file, makes 0.4e-5 of itself.
    assert first.f_number == pytest.approx(4.060073, abs=2e-5)
    assert first.entrance_pupil_diameter_mm == pytest.approx(25, abs=1e-4)
    assert first.exit_pupil_diameter_mm == pytest.approx(23.39711, abs=1e-4)


SPOTS = {486.1327: (0.032252, 0.046552), 587.5618: (0.137509, 0.156289), 656.2725: (0.188229, 0.214543)}


@pytest.mark.parametrize("wavelength_nm", SPOTS)
def test_axial_spot_of_the_singlet(wavelength_nm: float) -> None:
    """OpticStudio's standard spot: a middle ray and six rings of 6, 12, ... 36 rays of one weight, evenly spaced.

    Without ray aiming the program fills the paraxial entrance pupil, up to its edge, and not the stop on the second
    surface: a stop of that size in front of the lens does the same.
    """
    rms, largest = SPOTS[wavelength_nm]
    bundled = rc.Lens.load("singlet-100mm")
    surfaces = [rc.Stop(clear_semi_diameter_mm=12.5), *bundled.surfaces[:2]]
    lens = rc.Lens(surfaces=surfaces, film_distance_mm=bundled.film_distance_mm)
    spot = lens.spot(wavelength_nm=wavelength_nm, pattern="hexapolar", samples=6)
    assert spot.points_mm.shape == (127, 2)
    assert (spot.status == rc.RayStatus.OK).all()
    # An index off by 1e-6 moves the focus by 1.5e-4 mm, and the rim of the spot at f/4.06 by 1.8e-5.
    assert spot.rms_radius_mm == pytest.approx(rms, abs=2e-5)
    assert spot.max_radius_mm == pytest.approx(largest, abs=2e-5)
    # On the axis the chief ray is the centroid.
    assert spot.rms_radius_about_chief_ray_mm == pytest.approx(spot.rms_radius_mm, rel=1e-9)
    assert spot.max_radius_about_chief_ray_mm == pytest.approx(spot.max_radius_mm, rel=1e-9)


def test_reference_sphere_through_the_paraxial_exit_pupil() -> None:
    """OpticStudio's reference sphere: about the chief ray's image point, to where that ray crosses the plane of the
    paraxial exit pupil, which the run at f/5 states 114.6444 mm in front of its image."""
    lens = code_v_listing.listed_lens().stopped_down(5.0)
    first = lens.first_order()
    film = first.back_focal_distance_mm
    on_axis = lens.wavefront(film_distance_mm=film, exit_pupil="paraxial")
    assert on_axis.reference_radius_mm == pytest.approx(114.6444, abs=0.6e-4)
    assert on_axis.rms_waves == lens.wavefront(film_distance_mm=film).rms_waves

    for angle in (5.0, 10.0, 14.0):
        chief = lens.aim([[0.0, 0.0]], angle)
        out = lens.trace(chief.origins_mm, chief.directions, start="scene")
        point, direction = out.origins_mm[0], out.directions[0]
        at_pupil = point + (first.exit_pupil_position_mm - point[2]) / direction[2] * direction
        at_film = point + (lens.vertices_mm[-1] + film - point[2]) / direction[2] * direction
        ours = lens.wavefront(angle, film_distance_mm=film, pattern="hexapolar", samples=8)
        theirs = lens.wavefront(angle, film_distance_mm=film, pattern="hexapolar", samples=8, exit_pupil="paraxial")
        assert theirs.centre_mm == pytest.approx(tuple(at_film), abs=1e-9)
        assert theirs.reference_radius_mm == pytest.approx(np.linalg.norm(at_film - at_pupil), rel=1e-9)
        # The real chief ray crosses the axis elsewhere: pupil aberration.
        assert abs(theirs.reference_radius_mm / ours.reference_radius_mm - 1) > 1e-4
        # Two spheres about one centre: a ray that passes it at p has p^2 / 2 times the difference of the curvatures
        # between them, to (p / R)^2 of that.
        aimed = lens.aim(ours.pupil, angle)
        rays = lens.trace(aimed.origins_mm, aimed.directions, start="scene")
        good = ours.status == rc.RayStatus.OK
        off = np.linalg.norm(np.cross(rays.origins_mm - at_film, rays.directions), axis=1)
        curvature = 1 / theirs.reference_radius_mm - 1 / ours.reference_radius_mm
        expected = -0.5 * off**2 * curvature * 1e6 / ours.wavelength_nm
        difference = theirs.opd_waves - ours.opd_waves
        np.testing.assert_allclose(difference[good], expected[good], rtol=2e-5, atol=1e-8)
        assert np.abs(expected[good]).max() > 1e-6
    with pytest.raises(rc.InputError, match='unknown exit_pupil "entrance"; expected real or paraxial'):
        lens.wavefront(exit_pupil="entrance")
