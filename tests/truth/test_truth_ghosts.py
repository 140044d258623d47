"""Case E: ghosts of a lens and a plate (GhostAnalysis, after Abd El-Maksoud and Sasian)."""

from __future__ import annotations

import pytest
import realcam as rc


def lens_and_plate(plate_mm: float = 1.0) -> rc.Lens:
    rim = {"clear_semi_diameter_mm": 20.0}
    return rc.Lens(
        surfaces=[
            rc.Stop(clear_semi_diameter_mm=5),
            rc.Surface(radius_of_curvature_mm=100, thickness_mm=5, material="schott:N-BK7", **rim),
            rc.Surface(radius_of_curvature_mm=-100, thickness_mm=50, **rim),
            rc.Surface(thickness_mm=plate_mm, material="schott:N-BK7", **rim),
            rc.Surface(**rim),
        ],
        film_distance_mm=45.25,
    )


# Surfaces that reflect, the first one first: focal length, back focal distance.
GHOSTS = {(2, 1): (15.4447, -40.3803), (3, 1): (138.1157, -64.5371), (4, 3): (97.5804, 43.9402)}


@pytest.mark.parametrize("pair", GHOSTS)
def test_ghosts_as_published(pair: tuple[int, int]) -> None:
    focal_length, back_focal_distance = GHOSTS[pair]
    ghost = lens_and_plate().ghost(*pair)
    # Half a unit of the last digit.
    assert ghost.effective_focal_length_mm == pytest.approx(focal_length, abs=0.51e-4)
    assert ghost.back_focal_distance_mm == pytest.approx(back_focal_distance, abs=0.51e-4)


@pytest.mark.parametrize("plate_mm", [0.5, 4.0])
def test_ghost_of_a_plate(plate_mm: float) -> None:
    """Two more passages through a plane-parallel plate: the image lies 2 d / n in front of the lens's own."""
    lens = lens_and_plate(plate_mm)
    first, index = lens.first_order(), rc.Glass.named("schott:N-BK7").index(lens.wavelength_nm)
    ghost = lens.ghost(4, 3)
    assert ghost.effective_focal_length_mm == pytest.approx(first.effective_focal_length_mm, rel=1e-12)
    assert ghost.back_focal_distance_mm == pytest.approx(first.back_focal_distance_mm - 2 * plate_mm / index, rel=1e-12)


@pytest.mark.parametrize("pair", [(1, 2), (2, 2), (2, -1), (6, 1), (2, 0)])
def test_what_makes_no_ghost_is_refused(pair: tuple[int, int]) -> None:
    with pytest.raises(rc.InputError, match="ghost"):
        lens_and_plate().ghost(*pair)


def test_a_film_ghost_by_hand() -> None:
    """Between the film and a plane face at distance d light goes 2 d further than it would."""
    lens = lens_and_plate()
    first = lens.first_order()
    film, last = len(lens.surfaces), len(lens.surfaces) - 1
    ghost = lens.ghost(film, last)
    expected = first.back_focal_distance_mm - 2 * lens.film_distance_mm
    assert ghost.effective_focal_length_mm == pytest.approx(first.effective_focal_length_mm, rel=1e-12)
    assert ghost.back_focal_distance_mm == pytest.approx(expected, rel=1e-12)
