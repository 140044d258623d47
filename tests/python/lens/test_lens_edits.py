"""A lens made larger, turned round, with surfaces put in and taken out: what must hold of it then."""

from __future__ import annotations

import math

import numpy as np
import pytest
import realcam as rc

LENSES = ("double-gauss-50mm", "phone-4mm", "mirror-telephoto-500mm", "telephoto-200mm-inner-focus")


def plate(thickness_mm: float = 2.0, index: float = 1.5, rim_mm: float = 30.0) -> list[rc.Surface]:
    return [
        rc.Surface(material=index, thickness_mm=thickness_mm, clear_semi_diameter_mm=rim_mm),
        rc.Surface(clear_semi_diameter_mm=rim_mm, thickness_mm=0.0),
    ]


def bundle(lens: rc.Lens, count: int = 50) -> tuple[np.ndarray, np.ndarray]:
    """Rays from the scene over half of the front, slightly oblique."""
    random = np.random.default_rng(1)
    data = lens.first_order()
    at = random.uniform(-0.3, 0.3, (count, 2)) * data.entrance_pupil_diameter_mm
    at += 0.35 * data.entrance_pupil_diameter_mm  # beside what blocks the middle of a mirror lens
    slope = np.array([0.004, -0.003, 1.0])
    direction = slope / np.linalg.norm(slope)
    origins = np.column_stack([at, np.zeros(count)]) + slope * (-data.entrance_pupil_position_mm)
    return origins, np.tile(direction, (count, 1))


@pytest.mark.parametrize("name", LENSES)
def test_scaling_by_a_power_of_two_scales_every_length_exactly(name: str) -> None:
    lens = rc.Lens.load(name).focused(5.0)
    twice = lens.scaled(2.0)
    assert twice.focus_distance_m == 2 * lens.focus_distance_m
    assert twice.film_distance_mm == 2 * lens.film_distance_mm
    assert twice.film_mm == (2 * lens.film_mm[0], 2 * lens.film_mm[1])
    small, large = lens.first_order(), twice.first_order()
    assert large.effective_focal_length_mm == 2 * small.effective_focal_length_mm
    assert large.f_number == small.f_number
    assert twice.scaled(0.5) == lens


@pytest.mark.parametrize("name", LENSES)
def test_a_lens_turned_round_takes_the_same_rays_back(name: str) -> None:
    lens = rc.Lens.load(name)
    turned = lens.reversed(film_distance_mm=50.0)
    length = lens.vertices_mm[-1]
    origins, directions = bundle(lens)
    through = lens.trace(origins, directions, start="scene")
    passed = through.status == rc.RayStatus.OK
    assert passed.sum() > 10
    # Into the turned lens from where they came out, mirrored in z.
    mirror = np.array([1.0, 1.0, -1.0])
    back = turned.trace(
        mirror * (through.origins_mm[passed] - [0, 0, length]), -mirror * through.directions[passed], start="scene"
    )
    assert (back.status == rc.RayStatus.OK).all()
    np.testing.assert_allclose(back.directions, -mirror * directions[passed], atol=1e-10)
    data, other = lens.first_order(), turned.first_order()
    assert other.effective_focal_length_mm == pytest.approx(data.effective_focal_length_mm, rel=1e-12)
    # The focal points are exchanged; distances count from the first and the last vertex.
    assert other.back_focal_distance_mm == pytest.approx(-data.front_focal_distance_mm, rel=1e-9, abs=1e-9)
    assert turned.reversed(lens.film_distance_mm).surfaces == lens.surfaces


def test_turning_round_keeps_the_focus_group_and_wants_an_image() -> None:
    lens = rc.Lens.load("telephoto-200mm-inner-focus")
    first, last = lens.focus_group or (0, 0)
    count = len(lens.surfaces)
    assert lens.reversed(100.0).focus_group == (count - 1 - last, count - 1 - first)
    # A negative lens, and a lens whose front focus lies inside the glass, form no image behind
    # the reversed lens.
    negative = rc.Lens(
        surfaces=[
            rc.Surface(radius_of_curvature_mm=-50, material=1.5, thickness_mm=2, clear_semi_diameter_mm=5),
            rc.Surface(clear_semi_diameter_mm=5, thickness_mm=1),
            rc.Stop(clear_semi_diameter_mm=4),
        ],
        film_distance_mm=30,
    )
    with pytest.raises(rc.LensFileError, match="film distance is required"):
        negative.reversed()


@pytest.mark.parametrize("index", [1.5, 1.8])
def test_a_plate_moves_the_focus_by_its_thickness_less_its_reduced_thickness(index: float) -> None:
    lens = rc.Lens.load("double-gauss-50mm")
    count = len(lens.surfaces)
    with_plate = lens.inserted(count, plate(3.0, index), gap_mm=5.0)
    assert with_plate.film_position_mm == pytest.approx(lens.film_position_mm, abs=1e-12)
    # W. J. Smith, Modern Optical Engineering: a plane-parallel plate shifts an image by t (n - 1) / n.
    shift = with_plate.first_order().back_focal_distance_mm + 5 + 3 - lens.first_order().back_focal_distance_mm
    assert shift == pytest.approx(3.0 * (index - 1) / index, abs=1e-9)
    without = with_plate.removed(count, count + 1)
    assert without.surfaces == lens.surfaces
    assert without.film_distance_mm == pytest.approx(lens.film_distance_mm, abs=1e-12)


def test_surfaces_in_front_and_in_the_middle_move_the_numbers_of_the_others() -> None:
    lens = rc.Lens.load("telephoto-200mm-inner-focus")
    first, last = lens.focus_group or (0, 0)
    in_front = lens.inserted(0, [plate(rim_mm=60)[0], rc.Surface(clear_semi_diameter_mm=60, thickness_mm=20)])
    assert in_front.focus_group == (first + 2, last + 2)
    assert in_front.stop_index == lens.stop_index + 2
    # A plate before a distant object changes nothing.
    assert in_front.first_order().effective_focal_length_mm == pytest.approx(
        lens.first_order().effective_focal_length_mm, rel=1e-12
    )
    assert in_front.removed(0, 1) == lens.focused(math.inf) or in_front.removed(0, 1).surfaces == lens.surfaces
    gone = lens.removed(first, last)
    assert gone.focus_group is None
    assert gone.vertices_mm[first] == pytest.approx(lens.vertices_mm[last + 1], abs=1e-12)


def test_a_film_is_changed_and_nothing_else() -> None:
    lens = rc.Lens.load("tessar-50mm").focused(2.0).stopped_down(8)
    other = lens.with_film(6, 4)
    assert other.film_mm == (6, 4)
    assert other.with_film(*lens.film_mm) == lens


def test_several_surfaces_change_at_once() -> None:
    lens = rc.Lens.load("tessar-50mm")
    radii = {i: 1.01 * lens.surfaces[i].radius_of_curvature_mm for i in (0, 1)}
    together = lens.with_surfaces({i: lens.surfaces[i].replace(radius_of_curvature_mm=r) for i, r in radii.items()})
    one_by_one = lens
    for i, radius in radii.items():
        one_by_one = one_by_one.with_surface(i, radius_of_curvature_mm=radius)
    assert together == one_by_one


@pytest.mark.parametrize(
    ("edit", "message"),
    [
        (lambda lens: lens.scaled(0), "positive and finite"),
        (lambda lens: lens.scaled(math.nan), "positive and finite"),
        (lambda lens: lens.inserted(99, plate()), "found 99"),
        (lambda lens: lens.inserted(11, plate()), "distance from it is required"),
        (lambda lens: lens.inserted(0, plate(), gap_mm=1), "a distance from the preceding surface is not possible"),
        (lambda lens: lens.inserted(3, []), "no surfaces to insert"),
        (lambda lens: lens.inserted(11, plate(), gap_mm=60), "film"),
        (lambda lens: lens.removed(5), "no surface of type"),
        (lambda lens: lens.removed(0, 99), "no surface 99"),
        (lambda lens: lens.removed(3, 2), "must not come before"),
        (lambda lens: lens.removed(0, 10), "all surfaces"),
        (lambda lens: lens.with_film(0, 10), "positive lengths"),
        (lambda lens: lens.with_surfaces({77: lens.surfaces[0]}), "no surface 77"),
    ],
)
def test_what_cannot_be_done_is_said(edit: object, message: str) -> None:
    with pytest.raises((rc.InputError, rc.LensFileError), match=message):
        edit(rc.Lens.load("double-gauss-50mm"))  # type: ignore[operator]
