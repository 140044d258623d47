"""Case D: figures from published runs of OpticStudio."""

from __future__ import annotations

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
