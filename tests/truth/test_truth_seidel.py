"""Third-order and chromatic sums through the Python API: the CODE V listing (case A) and the Lagrange invariant.

tests/cpp/optics/analysis/test_seidel.cpp has the closed forms.
"""

from __future__ import annotations

import numpy as np
import pytest
import realcam as rc

from ..centred_lenses import CENTRED
from ..measurement import Measurement, hold
from . import code_v_listing as listing

LENS = rc.Lens.load("double-gauss-100mm")
SUMS = LENS.seidel(14.0000000032, colours_nm=(486.1, 656.3))


def columns(sums: rc.Seidel) -> np.ndarray:
    """Array with the listing's columns: SA, TCO, TAS, SAS, PTB, DST, AX, LAT, PTZ."""
    return np.stack(
        [
            sums.spherical_mm,
            sums.tangential_coma_mm,
            sums.tangential_astigmatism_mm,
            sums.sagittal_astigmatism_mm,
            sums.petzval_mm,
            sums.distortion_mm,
            sums.axial_colour_mm,
            sums.lateral_colour_mm,
            sums.petzval_curvature_per_mm,
        ],
        axis=1,
    )


def test_third_order_sums_surface_by_surface() -> None:
    found = columns(SUMS)
    worst = max(np.abs(found - listing.THIRD_ORDER).max(), np.abs(found.sum(axis=0) - listing.THIRD_ORDER_SUM).max())
    # Half a unit of the last digit.
    hold(
        Measurement(
            "Truth",
            "third-order and colour sums of a double Gauss as CODE V prints them, from Python",
            "11 surfaces and sum x 9 figures",
            "core",
            "float64",
            float(worst),
            0.51e-6,
            "mm",
        )
    )


def test_paraxial_rays_surface_by_surface() -> None:
    found = np.stack(
        [
            SUMS.marginal_height_mm,
            SUMS.marginal_slope,
            SUMS.marginal_invariant,
            SUMS.chief_height_mm,
            SUMS.chief_slope,
            SUMS.chief_invariant,
        ],
        axis=1,
    )
    # Half a unit of the last digit, and of the stop's radius in the lens file: 0.8e-6 of the marginal ray's 25 mm.
    assert np.abs(found - listing.PARAXIAL_RAYS).max() < 1.3e-6


def test_paraxial_image_height() -> None:
    assert SUMS.chief_slope.shape == (11,)
    focus = LENS.first_order().back_focal_distance_mm
    height = SUMS.chief_height_mm[-1] + SUMS.chief_slope[-1] * focus
    assert height == pytest.approx(24.9337, abs=0.51e-4)
    on_film = SUMS.chief_height_mm[-1] + SUMS.chief_slope[-1] * LENS.film_distance_mm
    assert on_film == pytest.approx(24.846684, abs=0.51e-6)


@pytest.mark.parametrize("name", CENTRED)
def test_lagrange_invariant_behind_every_surface(name: str) -> None:
    lens = rc.Lens.load(name)
    sums = lens.seidel(5.0, object_distance_m=3.0)
    index, sense, indices = 1.0, 1.0, []
    for surface in lens.surfaces:
        if surface.type == "mirror":
            sense = -sense
        elif surface.type == "refracting":
            index = surface.material.index(lens.wavelength_nm)
        indices.append(sense * index)
    products = np.array(indices) * [
        sums.chief_slope * sums.marginal_height_mm,
        sums.marginal_slope * sums.chief_height_mm,
    ]
    # Rounding, of the products that are subtracted.
    scale = np.abs(products).sum(axis=0) + abs(sums.lagrange_invariant_mm)
    assert (np.abs(products[0] - products[1] - sums.lagrange_invariant_mm) / scale).max() < 1e-13
