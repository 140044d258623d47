"""Cross sections of lenses as arrays: outlines, faces, rays, marks."""

from __future__ import annotations

import functools
import math

import numpy as np
import pytest
import realcam as rc
from realcam.fields import fields_at
from realcam.section import CrossSection, Element, cross_section

from ...centred_lenses import CENTRED

GAUSS = rc.Lens.load("double-gauss-50mm")
FISHEYE = rc.Lens.load("fisheye-6mm-220deg")
MIRROR = rc.Lens.load("mirror-telephoto-500mm")
ALL = CENTRED


def one_element(
    radii_mm: tuple[float, float] = (50, -50), thickness_mm: float = 6, rims_mm: tuple[float, float] = (10, 8)
) -> rc.Lens:
    """A single element of index 1.5, 1 mm before its stop."""
    front, back = (
        rc.Surface(radius_of_curvature_mm=radius, thickness_mm=thickness, material=index, clear_semi_diameter_mm=rim)
        for radius, thickness, index, rim in zip(radii_mm, (thickness_mm, 1), (1.5, 1.0), rims_mm, strict=True)
    )
    stop = rc.Stop(clear_semi_diameter_mm=2)
    return rc.Lens(surfaces=[front, back, stop], film_distance_mm=50.0, allow_overlap=True)


@functools.cache
def outlines(name: str) -> CrossSection:
    return cross_section(rc.Lens.load(name), rays=0)


def upper_arc(section: CrossSection, index: int) -> np.ndarray:
    face = next(face for face in section.faces if face.surface == index)
    points = face.parts[-1]
    return points[points[:, 1] >= 0]


def has_points(element: Element, points: np.ndarray) -> bool:
    """True if the outline contains exactly these coordinates."""
    outline = {tuple(point) for polygon in element.polygons for point in polygon}
    return {tuple(point) for point in points} <= outline


@pytest.mark.parametrize("name", ALL)
def test_elements_are_their_faces_and_end_at_their_rims(name: str) -> None:
    lens, section = rc.Lens.load(name), outlines(name)
    assert section.elements
    for element in section.elements:
        faces = [lens.surfaces[i] for i in (element.front, element.back)]
        assert all(has_points(element, upper_arc(section, i)) for i in (element.front, element.back))
        points = np.concatenate(element.polygons)
        assert np.abs(points[:, 1]).max() == max(face.clear_semi_diameter_mm for face in faces)
        on_faces = {tuple(p) for i in (element.front, element.back) for p in upper_arc(section, i)}
        corners = [p for p in points if p[1] > 0 and tuple(p) not in on_faces]
        # Beyond the faces there is at most the corner over the smaller rim, flat against the axis.
        assert len(corners) <= 1
        for z, y in corners:
            index = min((element.front, element.back), key=lambda i: lens.surfaces[i].clear_semi_diameter_mm)
            rim = lens.surfaces[index].clear_semi_diameter_mm
            assert z == lens.vertices_mm[index] + lens.surfaces[index].sag_mm(rim)
            assert y == max(face.clear_semi_diameter_mm for face in faces)


@pytest.mark.parametrize("name", ALL)
def test_an_outline_encloses_the_glass_between_its_faces(name: str) -> None:
    """Shoelace area against the integral of the thickness: an outline that crosses itself, or a spur, has another."""
    lens = rc.Lens.load(name)
    for element in outlines(name).elements:
        front, back = (lens.surfaces[i] for i in (element.front, element.back))
        z1, z2 = lens.vertices_mm[element.front], lens.vertices_mm[element.back]
        rims = front.clear_semi_diameter_mm, back.clear_semi_diameter_mm
        hole = min(front.inner_semi_diameter_mm, back.inner_semi_diameter_mm)
        y = np.linspace(hole, max(rims), 2001)
        thickness = np.abs(
            z2 + np.array([back.sag_mm(min(v, rims[1])) for v in y])
            - z1 - np.array([front.sag_mm(min(v, rims[0])) for v in y])
        )  # fmt: skip
        expected = 2 * np.trapezoid(thickness, y)
        area = 0.0
        for z, r in (polygon.T for polygon in element.polygons):
            area += 0.5 * abs(np.dot(z, np.roll(r, -1)) - np.dot(r, np.roll(z, -1)))
        # Chords of 40 pieces a half face, denser towards the rim: an arc of a right angle differs by (pi/80)^2 / 12.
        assert area == pytest.approx(expected, rel=1e-3)


def test_the_smaller_face_is_edged_flat() -> None:
    (drawn,) = cross_section(one_element(), rays=0).elements
    flat = 6 - (50 - math.sqrt(50**2 - 8**2))
    (polygon,) = drawn.polygons
    assert any(np.allclose(point, (flat, 10), rtol=0, atol=1e-12) for point in polygon)


def test_a_face_sunk_too_deep_for_that_is_joined_from_rim_to_rim() -> None:
    """A meniscus whose hollow back ends in front of the front's rim: no flat corner would lie in glass."""
    (drawn,) = cross_section(one_element((20, 30), 1, (19, 6)), rays=0).elements
    (polygon,) = drawn.polygons
    assert len(polygon) == 2 * 81  # both arcs, and nothing else


def test_mangin_mirrors_are_one_piece_of_glass_with_its_hole() -> None:
    section = cross_section(MIRROR, rays=0)
    assert [(e.front, e.back) for e in section.elements] == [(1, 2), (4, 5), (7, 8), (10, 11), (12, 13), (14, 15)]
    primary = section.elements[1]
    assert len(primary.polygons) == 2
    assert np.abs(np.concatenate(primary.polygons)[:, 1]).min() == MIRROR.surfaces[5].inner_semi_diameter_mm
    assert [blocker.surface for blocker in section.blockers] == [0, 3]
    assert section.blockers[1].obstruction_mm == MIRROR.surfaces[3].inner_semi_diameter_mm


@pytest.mark.parametrize("name", ALL)
def test_faces_tell_the_sign_of_their_radius(name: str) -> None:
    lens = rc.Lens.load(name)
    for face in outlines(name).faces:
        radius = lens.surfaces[face.surface].radius_of_curvature_mm
        assert face.radius_sign == (0 if math.isinf(radius) else math.copysign(1, radius))
        assert face.is_asphere == bool(
            lens.surfaces[face.surface].conic or lens.surfaces[face.surface].aspheric_coefficients
        )


@pytest.mark.parametrize("name", [*ALL, "focused", "stopped"])
def test_rays_end_on_the_film_where_the_spot_is(name: str) -> None:
    lens = {"focused": GAUSS.focused(0.7), "stopped": GAUSS.stopped_down(16)}.get(name) or rc.Lens.load(name)
    wavelengths = (lens.wavelength_nm, 656.3) if name.startswith("double") else (lens.wavelength_nm,)
    section = cross_section(lens, wavelengths_nm=wavelengths)
    dense = np.column_stack([np.zeros(401), np.linspace(-1, 1, 401)])
    assert len(section.bundles) == 3 * len(wavelengths)
    for bundle in section.bundles:
        spot = lens.spot(bundle.field.angle_deg, wavelength_nm=bundle.wavelength_nm, pupil=dense)
        there = spot.points_mm[:, 1][np.isfinite(spot.points_mm[:, 1])]
        assert len(bundle.paths_mm) == 7
        for x, y, z in bundle.paths_mm[:, -1]:
            assert z == pytest.approx(lens.film_position_mm, abs=1e-12)
            assert abs(x) < 1e-9
            # Aimed within 1e-10 of the stop's radius, twice.
            assert np.abs(there - y).min() < 1e-8


@pytest.mark.parametrize("name", ALL)
@pytest.mark.parametrize("rays_from", ["object", "film"])
def test_paths_are_those_of_traced_rays(name: str, rays_from: str) -> None:
    lens = rc.Lens.load(name)
    for bundle in cross_section(lens, rays_from=rays_from).bundles:
        points, start = bundle.paths_mm, bundle.paths_mm[:, 0]
        for i in range(len(lens.surfaces)):
            traced = lens.trace(
                start, points[:, 1] - start, start="scene", surface_count=i + 1, wavelength_nm=bundle.wavelength_nm
            )
            # A direction that is found from two points has their roundings.
            np.testing.assert_allclose(points[:, i + 1], traced.origins_mm, rtol=0, atol=1e-8)


def test_bundles_come_from_infinity_or_from_the_plane_in_focus() -> None:
    for bundle in cross_section(GAUSS).bundles:
        direction = bundle.paths_mm[:, 1] - bundle.paths_mm[:, 0]
        direction /= np.linalg.norm(direction, axis=1)[:, None]
        angle = math.radians(bundle.field.angle_deg)
        assert np.allclose(direction, (0, math.sin(angle), math.cos(angle)), rtol=0, atol=1e-12)
        start = bundle.paths_mm[:, 0] @ direction[0]
        assert np.ptp(start) < 1e-9  # on one plane across the light
    near = GAUSS.focused(0.8)
    plane = -(1000 * near.focus_distance_m - near.film_position_mm)
    for bundle in cross_section(near).bundles:
        first, second = bundle.paths_mm[:, 0], bundle.paths_mm[:, 1]
        at_object = first + (second - first) * ((plane - first[:, 2]) / (second - first)[:, 2])[:, None]
        assert np.ptp(at_object[:, 1]) < 1e-7


def test_fields_are_shares_of_the_corner_of_the_film() -> None:
    corner = 0.5 * math.hypot(*GAUSS.film_mm)
    fields = fields_at(GAUSS, (-1, 0, 0.7, 1))
    assert [field.film_height_mm for field in fields] == pytest.approx([-corner, 0, 0.7 * corner, corner], abs=1e-7)
    assert fields[0].angle_deg == -fields[3].angle_deg
    assert GAUSS.spot(fields[3].angle_deg).chief_ray_mm[1] == pytest.approx(corner, abs=1e-7)
    with pytest.raises(rc.InputError, match="from -1 to 1"):
        fields_at(GAUSS, (1.1,))


def test_a_fisheye_sees_behind_the_plane_of_its_front_vertex() -> None:
    """The patent's image of 110 degrees lies at 10.47 mm; the film is larger than the image."""
    (edge,) = cross_section(FISHEYE, fields=(1,)).bundles
    assert 110 <= edge.field.angle_deg < 120
    assert 10.47 <= edge.field.film_height_mm < 0.5 * math.hypot(*FISHEYE.film_mm)
    assert np.all(edge.paths_mm[:, 0, 2] > edge.paths_mm[:, 1, 2])
    assert FISHEYE.spot(110).chief_ray_mm[1] == pytest.approx(10.47, abs=0.01)


def test_film_points_send_rays_that_meet_in_them() -> None:
    for bundle in cross_section(GAUSS, rays_from="film").bundles:
        assert np.allclose(bundle.paths_mm[:, -1], (0, bundle.field.film_height_mm, GAUSS.film_position_mm))


def test_marks_of_a_thick_lens() -> None:
    """The lensmaker's equation: 1/f = (n - 1) (1/R1 - 1/R2 + (n - 1) t / (n R1 R2))."""
    lens = one_element()
    n, t, r1, r2 = 1.5, 6.0, 50.0, -50.0
    f = 1 / ((n - 1) * (1 / r1 - 1 / r2 + (n - 1) * t / (n * r1 * r2)))
    marks = {mark.label: mark for mark in cross_section(lens, rays=0).marks}
    # The last vertex is the stop's, 1 mm behind the glass.
    assert marks["H"].z_mm == pytest.approx(-f * (n - 1) * t / (n * r2), rel=1e-9)
    assert marks["H'"].z_mm == pytest.approx(t - f * (n - 1) * t / (n * r1), rel=1e-9)
    assert marks["F"].z_mm == pytest.approx(marks["H"].z_mm - f, rel=1e-9)
    assert marks["F'"].z_mm == pytest.approx(marks["H'"].z_mm + f, rel=1e-9)
    assert (marks["XP"].z_mm, marks["XP"].semi_diameter_mm) == (7.0, 2.0)


def test_the_focus_group_travels_as_the_patent_says() -> None:
    """JP H01-102413 A: d10 goes from 21.00 to 35.49 at 2.5 m, paraxially; rays of f/1.86 focus 0.1 mm elsewhere."""
    group = cross_section(rc.Lens.load("telephoto-200mm-inner-focus"), rays=0).focus_group
    assert group is not None
    assert (group.first, group.last) == (10, 12)
    assert group.travel_mm == pytest.approx(14.49, abs=0.15)
    assert cross_section(GAUSS, rays=0).focus_group is None


def test_faces_that_cross_are_told_with_their_zone() -> None:
    """Two spheres of radius 50 that are 1 mm apart on the axis, and meet where both sags are half of that."""
    lens = one_element(thickness_mm=1, rims_mm=(9, 9))
    sag = 50 - math.sqrt(50**2 - 9**2)
    assert lens.overlaps() == [(0, 1, pytest.approx(2 * sag - 1), 9.0)]
    (crossing,) = cross_section(lens, rays=0).overlaps
    upper, lower = crossing.zones
    assert np.array_equal(lower, upper[::-1] * (1, -1))
    inner = math.sqrt(50**2 - 49.5**2)  # there both sags are half a millimetre
    assert upper[:, 1].max() == 9.0
    assert upper[:, 1].min() == pytest.approx(inner, abs=9 / 400)
    assert one_element().overlaps() == []


def test_two_crossings_are_both_told() -> None:
    *faces, stop = one_element(thickness_mm=1, rims_mm=(9, 9)).surfaces
    faces[1] = faces[1].replace(thickness_mm=4)
    lens = rc.Lens(surfaces=[*faces, *faces, stop], film_distance_mm=50.0, allow_overlap=True)
    assert [crossing[:2] for crossing in lens.overlaps()] == [(0, 1), (2, 3)]


def test_what_makes_no_sense_is_refused() -> None:
    for options, message in (
        ({"rays_from": "sky"}, "object or film"),
        ({"rays": -1}, "0 or more"),
        ({"rays_from": "film", "fields_deg": [1]}, 'fields_deg requires rays_from="object"'),
        ({"fields_deg": [60]}, "60"),
        ({"plane": "xy"}, "expected yz or xz"),
    ):
        with pytest.raises(rc.InputError, match=message):
            cross_section(GAUSS, **options)


def test_a_lens_that_is_tilted_is_drawn_where_it_stands() -> None:
    """Rays meet the faces that are drawn, and the film where they do in a spot."""
    lens = GAUSS.tilted(x_deg=6).shifted(y_mm=3)
    section = cross_section(lens, rays=5, fields=[0, 0.5])
    for face in section.faces:
        outline = np.concatenate(face.parts)
        for bundle in section.bundles:
            met = section.drawn(bundle.paths_mm)[:, 1 + face.surface]
            # Between 80 points of an outline an arc rises by less than the square of the step over 8 radii.
            for point in met:
                near = np.argsort(np.hypot(*(outline - point).T))[:2]
                a, b = outline[near]
                along = (b - a) / np.hypot(*(b - a))
                assert abs(along[0] * (point - a)[1] - along[1] * (point - a)[0]) < 0.02
    for bundle, field in zip(section.bundles, section.fields, strict=True):
        spot = lens.spot(film_mm=(0.0, field.film_height_mm))
        at = (bundle.paths_mm[:, -1] - lens.film_frame[3]) @ lens.film_frame[:3].T
        assert at[:, 2] == pytest.approx(0, abs=1e-9)
        assert at[len(at) // 2, 1] == pytest.approx(spot.chief_ray_mm[1], abs=0.5)


def test_the_other_plane_of_an_anamorphic_lens() -> None:
    flat = rc.Surface(
        form="toroid", radius_of_curvature_x_mm=60, thickness_mm=8, material=1.5, clear_semi_diameter_mm=9
    )
    lens = rc.Lens(
        surfaces=[flat, rc.Surface(thickness_mm=2, clear_semi_diameter_mm=9), rc.Stop(clear_semi_diameter_mm=5)],
        film_distance_mm=100,
    )
    upright, across = (cross_section(lens, plane=plane, rays=0) for plane in ("yz", "xz"))
    assert np.ptp(np.concatenate(upright.faces[0].parts)[:, 0]) == 0
    assert np.ptp(np.concatenate(across.faces[0].parts)[:, 0]) == pytest.approx(60 - math.sqrt(60**2 - 9**2))
    assert (upright.faces[0].radius_sign, across.faces[0].radius_sign) == (0, 1)
    bundle = cross_section(lens, plane="xz", rays=3, fields=[0]).bundles[0]
    assert np.abs(bundle.paths_mm[:, :, 1]).max() < 1e-12  # rays stay in the plane


def test_a_curved_film_is_drawn_as_an_arc_on_which_rays_end() -> None:
    lens = GAUSS.with_film_radius(-60)
    section = cross_section(lens, rays=3)
    centre = np.array([lens.film_position_mm - 60, 0])
    assert np.hypot(*(section.film - centre).T) == pytest.approx(60)
    for bundle in section.bundles:
        assert np.hypot(*(section.drawn(bundle.paths_mm)[:, -1] - centre).T) == pytest.approx(60)
