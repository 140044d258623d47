"""Pictures without effects do not depend on what only effects read: dispersion of glasses and coatings of surfaces."""

from __future__ import annotations

import numpy as np
import pytest
import realcam as rc

from .. import scenes


def singlet(abbe_number: float, coating: str) -> rc.Lens:
    # An index of 1.6 at the design wavelength, whatever the dispersion.
    surfaces = [
        rc.Stop(clear_semi_diameter_mm=5, thickness_mm=2),
        rc.Surface(
            radius_of_curvature_mm=60,
            thickness_mm=4,
            material=rc.Glass.from_abbe_number(1.6, abbe_number),
            clear_semi_diameter_mm=9,
            coating=coating,
        ),
        rc.Surface(radius_of_curvature_mm=-60, clear_semi_diameter_mm=9, coating=coating),
    ]
    return rc.Lens(surfaces=surfaces, film_distance_mm=50)


@pytest.mark.parametrize(
    ("effect", "other"), [("dispersion", singlet(30, "bare")), ("coatings", singlet(60, "quarter_wave"))]
)
def test_data_of_an_effect_that_is_off_changes_no_bit(effect: str, other: rc.Lens, device: str) -> None:
    scene = scenes.scene_of(scenes.quad((0.1, 0.2, -2), 0.3, emission=100)).with_environment(10)

    def pixels(lens: rc.Lens, effects: tuple[str, ...]) -> np.ndarray:
        camera = rc.Camera(lens, film=rc.Film(24, 16, (24, 16)), exposure_time_s=0.1)
        return rc.render(scene, camera, effects=effects, spp=8, device=device).pixels

    usual = singlet(60, "bare")
    np.testing.assert_array_equal(pixels(usual, ()), pixels(other, ()))
    assert (pixels(usual, (effect,)) != pixels(other, (effect,))).any()
