"""First-order data, focus and f-number of lenses that are not of revolution, against closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest
import realcam as rc

GLASS = (1.5168, 64.2)


def paraxial(curvatures: list[float], indices: list[float], distances: list[float]) -> tuple[float, float]:
    """Focal length and back focal distance of refracting surfaces in one section: y - nu trace by hand."""
    y, u, n = 1.0, 0.0, 1.0
    for k, (c, after) in enumerate(zip(curvatures, indices, strict=True)):
        u = (n * u - y * c * (after - n)) / after
        n = after
        if k < len(distances):
            y += distances[k] * u
    return -1 / u, -y / u


def cylinder(*, turned_deg: float = 0.0) -> rc.Lens:
    """A thick lens of a cylinder with its power in the xz plane, and a sphere; a stop behind it."""
    return rc.Lens(
        surfaces=[
            rc.Surface(
                form="toroid",
                radius_of_curvature_x_mm=60,
                thickness_mm=8,
                material=GLASS,
                clear_semi_diameter_mm=8,
                tilt_deg=(0, 0, turned_deg),
                returns=True,
            ),
            rc.Surface(radius_of_curvature_mm=-90, thickness_mm=3, clear_semi_diameter_mm=8),
            rc.Stop(clear_semi_diameter_mm=2, thickness_mm=0),
        ],
        film_distance_mm=80,
    )


@pytest.mark.parametrize("name", ["double-gauss-50mm", "fisheye-6mm-220deg", "tessar-50mm"])
def test_a_lens_of_revolution_has_two_like_meridians(name: str) -> None:
    """Differences over four rays have errors of the fourth order of a thousandth of the stop, and of rounding: 1e-9."""
    lens = rc.Lens.load(name)
    data = lens.first_order()
    for meridian in lens.meridians():
        assert meridian.focal_length_mm == pytest.approx(data.effective_focal_length_mm, rel=1e-9)
        assert meridian.f_number == pytest.approx(data.f_number, rel=1e-9)
        assert meridian.entrance_pupil_diameter_mm == pytest.approx(data.entrance_pupil_diameter_mm, rel=1e-9)
        assert meridian.back_focal_distance_mm == pytest.approx(data.back_focal_distance_mm, abs=1e-7)


@pytest.mark.parametrize("turned_deg", [0.0, 30.0, -65.0])
def test_the_meridians_of_a_cylinder_turn_with_it(turned_deg: float) -> None:
    lens = cylinder(turned_deg=turned_deg)
    n = GLASS[0]
    with_power = paraxial([1 / 60, -1 / 90], [n, 1.0], [8.0])
    without = paraxial([0.0, -1 / 90], [n, 1.0], [8.0])
    by_focal_length = sorted(lens.meridians(), key=lambda m: m.focal_length_mm)
    truth = ((*with_power, turned_deg), (*without, turned_deg + 90))
    for meridian, (focal, back, azimuth) in zip(by_focal_length, truth, strict=True):
        assert meridian.focal_length_mm == pytest.approx(focal, rel=1e-9)
        assert meridian.back_focal_distance_mm + 3 == pytest.approx(back, abs=1e-6)
        assert math.remainder(meridian.azimuth_deg - azimuth, 180) == pytest.approx(0, abs=1e-6)
    assert abs(lens.meridians()[0].azimuth_deg) <= 45


def anamorphic() -> rc.Lens:
    """A Galilean pair of cylinders that widens the view in the xz plane, before a lens of revolution."""
    base = rc.Lens.load("double-gauss-50mm")
    front = [
        rc.Surface(thickness_mm=3, material=GLASS, clear_semi_diameter_mm=34),
        rc.Surface(form="toroid", radius_of_curvature_x_mm=77.52, thickness_mm=47.5, clear_semi_diameter_mm=34),
        rc.Surface(
            form="toroid",
            radius_of_curvature_x_mm=103.36,
            thickness_mm=7,
            material=GLASS,
            clear_semi_diameter_mm=34,
        ),
        rc.Surface(thickness_mm=4, clear_semi_diameter_mm=34),
    ]
    return rc.Lens(surfaces=[*front, *base.surfaces], film_distance_mm=base.film_distance_mm, name="anamorphic")


def section(lens: rc.Lens, of: str) -> tuple[float, float]:
    curvatures, indices = [], []
    for surface in lens.surfaces:
        radius = surface.radius_of_curvature_mm if of == "y" else math.inf
        if of == "x":
            radius = surface.radius_of_curvature_x_mm if surface.form == "toroid" else surface.radius_of_curvature_mm
        curvatures.append(1 / radius)
        index = surface.material.index(lens.wavelength_nm)
        indices.append(indices[-1] if surface.type == "stop" and indices else index)
    return paraxial(curvatures, indices, [s.thickness_mm for s in lens.surfaces][:-1])


def test_an_anamorphic_lens() -> None:
    lens = anamorphic()
    across, upright = lens.meridians()
    for meridian, of in ((across, "x"), (upright, "y")):
        focal, back = section(lens, of)
        assert meridian.focal_length_mm == pytest.approx(focal, rel=1e-9)
        assert meridian.back_focal_distance_mm == pytest.approx(back, abs=1e-6)
    assert (across.azimuth_deg, upright.azimuth_deg) == (pytest.approx(0, abs=1e-7), pytest.approx(90, abs=1e-7))
    data = lens.first_order()
    assert data.effective_focal_length_mm == pytest.approx(
        math.sqrt(across.focal_length_mm * upright.focal_length_mm), rel=1e-12
    )
    assert data.f_number == pytest.approx(math.sqrt(across.f_number * upright.f_number), rel=1e-9)


@pytest.mark.parametrize("focus_m", [math.inf, 1.0])
def test_focus_goes_over_into_that_of_a_lens_of_revolution(focus_m: float) -> None:
    """Tilted by so little that the spot does not change, it is focused where the centred lens is. Both ways add up the
    same light by other rays: Gauss's nodes on arms, and in the meridional plane."""
    lens = rc.Lens.load("double-gauss-50mm")
    centred = lens.focused(focus_m)
    nearly = lens.with_element_tilted(2, 3, x_deg=1e-7).focused(focus_m)
    assert nearly.film_distance_mm == pytest.approx(centred.film_distance_mm, abs=1e-7)
    zoom = rc.Lens.load("zoom-80-200mm")  # a group moves
    centred, nearly = zoom.focused(3.0), zoom.with_element_tilted(0, 1, x_deg=1e-7).focused(3.0)
    for a, b in zip(centred.surfaces, nearly.surfaces, strict=True):
        assert a.thickness_mm == pytest.approx(b.thickness_mm, abs=1e-7)


@pytest.mark.parametrize("focus_m", [math.inf, 2.0])
def test_a_focused_lens_makes_the_smallest_spot_on_its_film(focus_m: float) -> None:
    """The light of the point that the film's middle sees, sent evenly into the lens: the root mean square on planes
    before and behind the film is larger than on it."""
    lens = anamorphic().focused(focus_m)
    at = np.linspace(-16, 16, 81)
    x, y = (part.ravel() for part in np.meshgrid(at, at))
    origins = np.column_stack([x, y, np.full(x.size, -1.0)])
    if math.isinf(focus_m):
        directions = np.tile([0.0, 0.0, 1.0], (x.size, 1))
    else:
        directions = origins - [0, 0, lens.film_position_mm - 1000 * focus_m]
        directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    rays = lens.trace(origins, directions, start="scene")
    passes = rays.status == 0
    o, d = rays.origins_mm[passes], rays.directions[passes]

    def spread(z: float) -> float:
        places = o[:, :2] + ((z - o[:, 2]) / d[:, 2])[:, None] * d[:, :2]
        return float(np.var(places, axis=0).sum())

    planes = lens.film_position_mm + np.linspace(-0.05, 0.05, 21)
    best = np.polynomial.Polynomial.fit(planes, [spread(z) for z in planes], 2).deriv().roots()[0]
    # The grid of rays is cut by the stop as by a staircase, which leaves some 0.1% of the depth of focus.
    assert best == pytest.approx(lens.film_position_mm, abs=0.001)


def test_f_numbers_are_set_and_kept() -> None:
    lens = anamorphic().stopped_down(8)
    assert lens.first_order().f_number == pytest.approx(8, rel=1e-9)
    assert lens.focused(2.0).stopped_down(5.6).stop_semi_diameter_mm == pytest.approx(
        lens.stopped_down(5.6).stop_semi_diameter_mm,
        rel=1e-3,  # focusing changes the pupil by the film's way
    )
    with pytest.raises(rc.InputError, match=r"f/1\.2 is faster than"):
        lens.stopped_down(1.2)


def test_tilt_and_shift_change_no_first_order_data() -> None:
    lens = rc.Lens.load("double-gauss-50mm")
    data = lens.first_order()
    for moved in (lens.shifted(y_mm=8), lens.tilted(x_deg=5), lens.tilted(x_deg=5).shifted(x_mm=3)):
        assert moved.first_order().effective_focal_length_mm == data.effective_focal_length_mm
        assert moved.stopped_down(4).first_order().f_number == pytest.approx(4, rel=1e-12)
        assert moved.stopped_down(4).stop_semi_diameter_mm == lens.stopped_down(4).stop_semi_diameter_mm


def test_without_light_there_are_no_data() -> None:
    base = rc.Lens.load("double-gauss-50mm")
    away = base.with_surface(3, tilt_deg=(90, 0, 0))
    with pytest.raises(rc.InputError, match="no ray is found from the centre of the film"):
        away.first_order()
    assert "tilted" in repr(away)  # which says what is known
