"""Glasses of the catalogue: by the numbers that makers print, and where a lens becomes better."""

from __future__ import annotations

import numpy as np
import pytest
import realcam as rc


def test_the_numbers_are_those_that_schott_prints() -> None:
    """N-BK7: n_d 1.51680, V_d 64.17, P_gF 0.5349; SF6: 1.80518, 25.43, 0.6102 (Schott's data sheets)."""
    for name, n_d, abbe, partial in (("N-BK7", 1.51680, 64.17, 0.5349), ("SF6", 1.80518, 25.43, 0.6102)):
        match = rc.nearest_glasses(name, 1)[0]
        assert match.distance == 0
        assert match.n_d == pytest.approx(n_d, abs=6e-6)
        assert match.abbe_number == pytest.approx(abbe, abs=6e-3)
        assert match.partial_dispersion == pytest.approx(partial, abs=6e-5)


def test_equivalents_of_other_makers_are_found() -> None:
    """Ohara's S-BSL7 and Hoya's BSC7 are these makers' equivalents of N-BK7."""
    assert rc.nearest_glasses("N-BK7", 1, makers=["ohara"])[0].name in ("ohara:S-BSL7", "ohara:BSL7")
    assert rc.nearest_glasses("N-BK7", 1, makers=["hoya"])[0].name == "hoya:BSC7"


def test_an_achromat_gets_a_flint_for_its_second_crown() -> None:
    """A cemented pair of nearly one glass cannot be achromatic: the search moves towards glasses that are farther
    apart, and lateral and axial colour shrink with the difference of their Abbe numbers."""
    lens = rc.Lens(
        surfaces=[
            rc.Stop(clear_semi_diameter_mm=10, thickness_mm=1),
            rc.Surface(radius_of_curvature_mm=60, material="schott:N-BK7", thickness_mm=6, clear_semi_diameter_mm=12),
            rc.Surface(
                radius_of_curvature_mm=-45, material="schott:N-BAF10", thickness_mm=3, clear_semi_diameter_mm=12
            ),
            rc.Surface(radius_of_curvature_mm=-150, clear_semi_diameter_mm=12),
        ],
    ).focused(np.inf)
    variables = [rc.Variable.radius(i, 15) for i in (1, 2, 3)]
    targets = rc.Targets(wavelengths_nm=(486.1, 587.6, 656.3), focal_length_mm=100.0, focal_length_weight=0.1)
    plain = rc.optimised(lens, variables, targets, most_steps=6, samples=3)
    found = rc.with_better_glasses(
        lens, variables, targets, surfaces=[2], candidates=6, most_steps=6, rounds=1, samples=3, makers=["schott"]
    )
    assert list(found.glasses) == [2]
    assert found.rms_spot_mm < plain.rms_spot_mm
    before, after = (rc.nearest_glasses(of.surfaces[2].material, 1)[0].abbe_number for of in (lens, found.lens))
    assert after < before


def test_surfaces_without_glass_are_refused() -> None:
    lens = rc.Lens.load("cooke-triplet-50mm")
    with pytest.raises(rc.InputError, match="no glass with dispersion behind surface 2"):
        rc.with_better_glasses(lens, [rc.Variable.radius(0)], surfaces=[1])
    with pytest.raises(rc.InputError, match="there is no surface 70"):
        rc.with_better_glasses(lens, [rc.Variable.radius(0)], surfaces=[70])
    with pytest.raises(rc.InputError, match="constant index has no dispersion"):
        rc.nearest_glasses(rc.Glass.constant(1.5))
