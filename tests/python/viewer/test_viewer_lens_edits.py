"""The lens bench's edits: one surface at a time, taken back and done again."""

from __future__ import annotations

import math

import pytest
import realcam as rc
from realcam.viewer import lens_edits
from realcam.viewer.history import History
from realcam.viewer.lens_edits import glass_of, with_plate, with_value
from realcam.viewer.lens_view import lens_view

from ...centred_lenses import CENTRED

LENS = rc.Lens.load("double-gauss-50mm")


@pytest.mark.parametrize(
    ("field", "value", "name", "expected"),
    [
        ("radius_mm", 40, "radius_of_curvature_mm", 40.0),
        ("radius_mm", "-31,5", "radius_of_curvature_mm", -31.5),
        ("radius_mm", "−31.5", "radius_of_curvature_mm", -31.5),
        ("radius_mm", "", "radius_of_curvature_mm", math.inf),
        ("radius_mm", None, "radius_of_curvature_mm", math.inf),
        ("radius_mm", 0, "radius_of_curvature_mm", math.inf),
        ("thickness_mm", "4.25", "thickness_mm", 4.25),
        ("semi_diameter_mm", 9.5, "clear_semi_diameter_mm", 9.5),
        ("conic", -1, "conic", -1.0),
        ("a4", "1e-7", "aspheric_coefficients", {4: 1e-7}),
    ],
)
def test_a_value_of_the_table(field: str, value: object, name: str, expected: object) -> None:
    edited = with_value(LENS, 0, field, value)
    assert getattr(edited.surfaces[0], name) == expected
    assert edited.surfaces[1:] == LENS.surfaces[1:]
    assert getattr(LENS.surfaces[0], name) != expected  # a lens is never changed itself


def test_glasses_as_the_table_has_them() -> None:
    assert glass_of("air") is None
    assert glass_of("") is None
    assert glass_of(None) is None
    assert glass_of("1.5168") == 1.5168
    assert glass_of(1.5168) == 1.5168
    assert glass_of("1.5168, 64.2") == (1.5168, 64.2)
    assert glass_of("1.5168 64.2") == (1.5168, 64.2)
    assert glass_of("1,5168") == 1.5168
    assert glass_of("1,5168 / 64,2") == (1.5168, 64.2)
    assert glass_of("1,5168, 64,2") == (1.5168, 64.2)
    assert glass_of("1.5168,64.2") == (1.5168, 64.2)
    name = rc.glass_names()[0]
    assert with_value(LENS, 0, "glass", name).surfaces[0].material.label == name
    # The glass label that the table shows can be typed in again: that of a lens file, and that of a typed glass.
    for surface in LENS.surfaces:
        if surface.type == "refracting" and surface.material.label:
            once = with_value(LENS, 0, "glass", surface.material.label)
            twice = with_value(once, 0, "glass", once.surfaces[0].material.label)
            assert twice.surfaces[0].material.index(587.5618) == pytest.approx(
                surface.material.index(587.5618), abs=1e-4
            )


IMPOSSIBLE = {
    "a sphere smaller than its rim": lambda lens: with_value(lens, 0, "radius_mm", 1.0),
    "a negative thickness": lambda lens: with_value(lens, 1, "thickness_mm", -50.0),
    "no number": lambda lens: with_value(lens, 0, "radius_mm", "wide"),
    "NaN": lambda lens: with_value(lens, 0, "radius_mm", math.nan),
    "NaN as text": lambda lens: with_value(lens, 0, "thickness_mm", "nan"),
    "endless": lambda lens: with_value(lens, 0, "thickness_mm", "1e400"),
    "a rim of nothing": lambda lens: with_value(lens, 0, "semi_diameter_mm", 0),
    "an unknown glass": lambda lens: with_value(lens, 0, "glass", "schott:no such glass"),
    "a glass that is no text": lambda lens: with_value(lens, 0, "glass", "\ud800"),
    "three numbers": lambda lens: with_value(lens, 0, "glass", "1.5 64 3"),
    "an unknown column": lambda lens: with_value(lens, 0, "colour", 1),
    "a digit that is none": lambda lens: with_value(lens, 0, "a²", 1),
    "an odd power of great height": lambda lens: with_value(lens, 0, "a99999999999", 1),
    "no such surface": lambda lens: with_value(lens, 99, "radius_mm", 1),
    "a surface from behind": lambda lens: with_value(lens, -1, "radius_mm", 1),
    "the stop removed": lambda lens: lens_edits.without(lens, lens.stop_index),
    "no place for a plate": lambda lens: with_plate(lens, 99),
    "no other": lambda lens: lens_edits.swapped(lens, 0, 99),
}


@pytest.mark.parametrize("what", IMPOSSIBLE)
def test_what_is_no_lens_is_told_in_one_line(what: str) -> None:
    with pytest.raises(rc.RealcamError) as error:
        IMPOSSIBLE[what](LENS)
    assert "\n" not in str(error.value)
    assert len(str(error.value)) < 300
    assert rc.Lens.load("double-gauss-50mm") == LENS


def test_an_impossible_surface_is_named() -> None:
    with pytest.raises(rc.LensFileError) as error:
        with_value(LENS, 3, "radius_mm", 1.0)
    assert error.value.surface == 4  # errors count from 1, as tables of lenses do


@pytest.mark.parametrize("place", [0, len(LENS.surfaces)])
def test_a_plate_is_a_plate(place: int) -> None:
    """A plane-parallel plate in air has no power."""
    focal = LENS.first_order().effective_focal_length_mm
    plated = with_plate(LENS, place)
    assert len(plated.surfaces) == len(LENS.surfaces) + 2
    plate = plated.surfaces[place]
    assert math.isinf(plate.radius_of_curvature_mm)
    assert plate.material.label.endswith("N-BK7")
    back = lens_edits.without(lens_edits.without(plated, place), place)
    assert [s.radius_of_curvature_mm for s in back.surfaces] == [s.radius_of_curvature_mm for s in LENS.surfaces]
    for lens in (plated, back):
        assert lens.first_order().effective_focal_length_mm == pytest.approx(focal, rel=1e-9)


@pytest.mark.parametrize("name", CENTRED)
def test_a_plate_has_room_before_every_surface_of_every_lens(name: str) -> None:
    """The surfaces behind the plate keep their positions. There is no room only if two surfaces touch."""
    lens = rc.Lens.load(name)
    for index in range(1, len(lens.surfaces) + 1):
        last = index == len(lens.surfaces)
        room = lens.film_distance_mm if last else lens.surfaces[index - 1].thickness_mm
        try:
            plated = with_plate(lens, index)
        except rc.InputError:
            front, back = lens.surfaces[index - 1 : index + 1]
            rim = min(front.clear_semi_diameter_mm, back.clear_semi_diameter_mm)
            assert min(room, room + back.sag_mm(rim) - front.sag_mm(rim)) < 0.01 * room + 1e-9
            continue
        more = len(plated.surfaces) - len(lens.surfaces)
        assert plated.film_position_mm == pytest.approx(lens.film_position_mm, rel=1e-9)
        assert plated.vertices_mm[index + more :] == pytest.approx(lens.vertices_mm[index:], rel=1e-9, abs=1e-9)
        assert all((s.thickness_mm > 0) == (room > 0) for s in plated.surfaces[index : index + more - last])


def test_a_surface_in_glass_has_no_effect() -> None:
    """Until it is edited: the same glass lies on both sides of it."""
    lens = rc.Lens.load("cooke-triplet-50mm")
    split = with_plate(lens, 1)
    assert len(split.surfaces) == len(lens.surfaces) + 1
    rays = [lens.spot(7.0), split.spot(7.0)]
    assert rays[1].points_mm == pytest.approx(rays[0].points_mm, abs=1e-9, nan_ok=True)


def test_surfaces_are_swapped() -> None:
    triplet = rc.Lens.load("cooke-triplet-50mm")
    swapped = lens_edits.swapped(triplet, 0, 1)
    assert swapped.surfaces[0].radius_of_curvature_mm == triplet.surfaces[1].radius_of_curvature_mm
    assert swapped.surfaces[1].radius_of_curvature_mm == triplet.surfaces[0].radius_of_curvature_mm
    assert swapped.surfaces[2:] == triplet.surfaces[2:]


# Undo and redo.


def lenses(count: int) -> list[rc.Lens]:
    return [with_value(LENS, 0, "thickness_mm", 5 + 0.01 * k) for k in range(count)]


def test_undo_and_redo() -> None:
    history = History(LENS)
    assert (history.can_undo, history.can_redo) == (False, False)
    assert history.undo() is LENS
    a, b, c = lenses(3)
    history.push(a)
    history.push(b)
    assert (history.undo(), history.undo()) == (a, LENS)
    assert (history.can_undo, history.can_redo) == (False, True)
    assert history.redo() == a
    history.push(c)  # and what was undone is gone
    assert not history.can_redo
    assert history.redo() == c
    assert history.undo() == a


def test_a_drag_is_undone_in_one_step() -> None:
    history = History(LENS)
    drag = lenses(10)
    for lens in drag[:5]:
        history.push(lens, 1)
    for lens in drag[5:]:
        history.push(lens, 2)
    assert history.undo() == drag[4]
    assert history.undo() == LENS
    assert history.redo() == drag[4]
    history.push(drag[7], 2)  # the mouse is still down, but what it did was taken back: another step
    assert not history.can_redo
    assert history.undo() == drag[4]


def test_the_history_has_an_end() -> None:
    history = History(LENS)
    for lens in lenses(300):
        history.push(lens)
    steps = 0
    while history.can_undo:
        history.undo()
        steps += 1
    assert 100 <= steps <= 300
    assert history.now != LENS


def test_what_the_zoom_ring_moves_is_not_edited() -> None:
    """The zoom positions' thicknesses would override the typed value, so that the edit would have no visible effect."""
    lens = rc.Lens.load("zoom-70-200mm")
    moved = [
        index
        for index in range(len(lens.surfaces))
        if len({lens.zoomed(name).surfaces[index].thickness_mm for name in lens.zoom_positions}) > 1
    ]
    assert moved
    for index, surface in enumerate(lens.surfaces):
        longer = surface.thickness_mm + 1e-3
        if index in moved:
            with pytest.raises(rc.InputError, match=f"the zoom ring changes the thickness behind surface {index + 1}"):
                with_value(lens, index, "thickness_mm", longer)
        elif index + 1 < len(lens.surfaces):
            edited = with_value(lens, index, "thickness_mm", longer)
            assert all(edited.zoomed(z).surfaces[index].thickness_mm == longer for z in lens.zoom_positions)


def test_a_toroid_has_a_radius_in_each_plane() -> None:
    lens = rc.Lens.load("anamorphic-31mm")
    rows = lens_view(lens)["surfaces"]
    assert [row["type"] for row in rows if "radius_x_mm" in row] == ["refracting"] * 5
    front = rows[0]
    assert (front["radius_mm"] is None) != (front["radius_x_mm"] is None)  # a cylinder
    edited = with_value(lens, 0, "radius_x_mm", -70.0)
    assert edited.surfaces[0].radius_of_curvature_x_mm == -70
    assert edited.surfaces[0].radius_of_curvature_mm == lens.surfaces[0].radius_of_curvature_mm
    with pytest.raises(rc.LensFileError, match="surface 8"):
        with_value(lens, 7, "radius_x_mm", 50.0)
