"""Cameras, films, lenses and surfaces that differ from another one in what is named, and in nothing else."""

from __future__ import annotations

from typing import Any

import pytest
import realcam as rc

LENS = rc.Lens.load("telephoto-200mm-inner-focus").focused(3).stopped_down(8)
FILM = rc.Film(24, 16, (60, 40))
CAMERA = rc.Camera(
    LENS, film=FILM, position=(1, 2, 3), look_at=(0, 0, 1), up=(0, 0.1, 1), exposure_time_s=0.5, iso=200, model="thick"
)
CAMERA_CHANGES: dict[str, Any] = {
    "lens": rc.Lens.load("tessar-50mm"),
    "film": rc.Film(36, 24, (6, 4)),
    "position": (5.0, 6.0, 7.0),
    "look_at": (1.0, 1.0, 1.0),
    "up": (1.0, 0.0, 0.0),
    "exposure_time_s": 0.25,
    "iso": 400.0,
    "model": "full",
}


def differences(one: Any, other: Any, names: list[str]) -> set[str]:
    return {name for name in names if getattr(one, name) != getattr(other, name)}


def test_a_camera_that_replaces_nothing_is_equal_and_all_is_another() -> None:
    assert CAMERA.replace() == CAMERA
    assert FILM.replace() == FILM
    assert CAMERA.replace(**CAMERA_CHANGES) == rc.Camera(**CAMERA_CHANGES)


def test_a_changed_camera_is_checked() -> None:
    with pytest.raises(rc.InputError, match="ISO"):
        CAMERA.replace(iso=-1)
    with pytest.raises(rc.InputError, match="must look at"):
        CAMERA.replace(look_at=CAMERA.position)


SURFACE = rc.Surface(
    radius_of_curvature_mm=50,
    thickness_mm=3,
    material="N-BK7",
    clear_semi_diameter_mm=10,
    conic=-0.5,
    aspheric_coefficients={4: 1e-6, 8: 1e-12},
    inner_semi_diameter_mm=1,
)
SURFACE_CHANGES: dict[str, Any] = {
    "radius_of_curvature_mm": 45.0,
    "thickness_mm": 4.0,
    "material": rc.Glass.named("N-SF6"),
    "clear_semi_diameter_mm": 9.0,
    "conic": 0.0,
    "aspheric_coefficients": {6: 1e-9},
    "inner_semi_diameter_mm": 0.0,
    "type": "mirror",
}


FILM_CHANGES: dict[str, Any] = {"width_mm": 30.0, "height_mm": 30.0, "resolution": (6, 4)}


@pytest.mark.parametrize(
    ("original", "changes", "name"),
    [
        (original, changes, name)
        for original, changes in ((CAMERA, CAMERA_CHANGES), (FILM, FILM_CHANGES), (SURFACE, SURFACE_CHANGES))
        for name in changes
    ],
)
def test_one_thing_changes_and_no_other(original: Any, changes: dict[str, Any], name: str) -> None:
    changed = original.replace(**{name: changes[name]})
    assert getattr(changed, name) == changes[name]
    assert differences(changed, original, list(changes)) == {name}


def test_none_as_a_material_is_air() -> None:
    assert SURFACE.replace(material=None).material == rc.Surface(clear_semi_diameter_mm=1).material
    assert SURFACE.replace(conic=0).material == SURFACE.material


LENS_PARTS = [
    "name",
    "title",
    "source",
    "surfaces",
    "wavelength_nm",
    "film_distance_mm",
    "film_mm",
    "focus_distance_m",
    "nearest_focus_m",
    "stop_index",
    "stop_semi_diameter_mm",
    "focus_group",
    "iris_blades",
    "iris_rounding",
    "iris_rotation_deg",
]


def test_one_surface_of_a_lens_changes_and_nothing_else() -> None:
    radius = 1.01 * LENS.surfaces[2].radius_of_curvature_mm
    changed = LENS.with_surface(2, radius_of_curvature_mm=radius)
    assert differences(changed, LENS, LENS_PARTS) == {"surfaces"}
    assert changed.surfaces[2] == LENS.surfaces[2].replace(radius_of_curvature_mm=radius)
    assert changed.surfaces[:2] + changed.surfaces[3:] == LENS.surfaces[:2] + LENS.surfaces[3:]
    assert changed.focus_group == LENS.focus_group is not None
    assert changed.focused(5).focus_distance_m == 5


def test_a_wide_open_stop_follows_its_rim_and_a_closed_one_stays() -> None:
    stop, rim = LENS.stop_index, LENS.surfaces[LENS.stop_index].clear_semi_diameter_mm
    closed, narrow = LENS.stop_semi_diameter_mm, 0.5 * LENS.stop_semi_diameter_mm
    for lens, new_rim, expected in (
        (LENS.wide_open(), 0.5 * rim, 0.5 * rim),
        (LENS, 0.99 * rim, closed),
        (LENS, narrow, narrow),
    ):
        assert lens.with_surface(stop, clear_semi_diameter_mm=new_rim).stop_semi_diameter_mm == expected


def test_a_lens_that_cannot_be_built_is_refused() -> None:
    with pytest.raises(rc.InputError, match="there is no surface 99; the lens has"):
        LENS.with_surface(99, conic=1)
    with pytest.raises(rc.InputError, match="there is no surface -1"):
        LENS.with_surface(-1, conic=1)
    with pytest.raises(rc.LensFileError, match="surface 3: the clear semi-diameter"):
        LENS.with_surface(2, clear_semi_diameter_mm=-1)
    with pytest.raises(rc.LensFileError, match="exactly one"):
        LENS.with_surface(2, type="stop")


def test_an_iris_changes_and_the_light_stays() -> None:
    changed = LENS.with_iris(5, rounding=0.25, rotation_deg=10)
    assert differences(changed, LENS, LENS_PARTS) == {"iris_blades", "iris_rounding", "iris_rotation_deg"}
    assert (changed.iris_blades, changed.iris_rounding) == (5, 0.25)
    assert changed.iris_rotation_deg == pytest.approx(10, rel=1e-15)
    assert changed.first_order().f_number == LENS.first_order().f_number
    assert changed.with_iris(7).with_iris(5) == changed
    with pytest.raises(rc.LensFileError, match="blades"):
        LENS.with_iris(2)
