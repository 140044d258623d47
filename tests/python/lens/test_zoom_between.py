"""Zoom lenses between the positions that their files give."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
import realcam as rc
from scipy.interpolate import PchipInterpolator

LENSES = Path(__file__).resolve().parents[3] / "lenses"

ZOOMS = [name for name in rc.lens_names() if rc.Lens.load(name).zoom_positions]


def between(lens: rc.Lens, shares: int = 5) -> list[float]:
    least, *_, most = lens.zoom_focal_lengths_mm
    return [least * (most / least) ** (k / shares) for k in range(1, shares)]


@pytest.mark.parametrize("name", ZOOMS)
def test_the_focal_length_is_the_one_asked_for(name: str) -> None:
    lens = rc.Lens.load(name)
    for required in between(lens):
        there = lens.zoomed(required)
        assert there.first_order().effective_focal_length_mm == pytest.approx(required, rel=1e-9)
        assert there.zoom_positions == lens.zoom_positions
        # Spacings stay between those of the two neighbouring positions, so that glasses cannot collide.
        k = int(np.searchsorted(lens.zoom_focal_lengths_mm, required))
        before, after = (lens.zoomed(i) for i in (k - 1, k))
        for a, b, c in zip(before.surfaces[:-1], there.surfaces[:-1], after.surfaces[:-1], strict=True):
            low, high = sorted((a.thickness_mm, c.thickness_mm))
            assert low - 1e-9 <= b.thickness_mm <= high + 1e-9


@pytest.mark.parametrize("name", ZOOMS)
def test_at_a_position_it_is_the_position(name: str) -> None:
    lens = rc.Lens.load(name)
    for position, focal_length in zip(lens.zoom_positions, lens.zoom_focal_lengths_mm, strict=True):
        assert lens.zoomed(focal_length) == lens.zoomed(position)
        near = lens.zoomed(
            float(np.clip(focal_length * 1.0001, *lens.zoom_focal_lengths_mm[:: len(lens.zoom_positions) - 1]))
        )
        at = lens.zoomed(position)
        # A zoom ring turned by 1e-4 moves the groups and the film only a little: the interpolation is continuous.
        assert near.film_distance_mm == pytest.approx(at.film_distance_mm, abs=0.02)
        assert near.zoom_position == position


def test_two_groups_have_the_spacing_of_the_closed_form() -> None:
    """The power of two groups is linear in their spacing d: 1/f1 + 1/f2 - d / (f1 f2). Two positions determine it."""
    lens = rc.Lens.load("zoom-25-50mm")
    (moved,) = (
        i for i, s in enumerate(lens.surfaces[:-1])
        if len({lens.zoomed(p).surfaces[i].thickness_mm for p in lens.zoom_positions}) > 1
    )  # fmt: skip
    ends = [lens.zoomed(p) for p in (lens.zoom_positions[0], lens.zoom_positions[-1])]
    d = [end.surfaces[moved].thickness_mm for end in ends]
    power = [1 / end.first_order().effective_focal_length_mm for end in ends]
    for required in (27.0, 31.7, 44.0):
        expected = d[0] + (1 / required - power[0]) * (d[1] - d[0]) / (power[1] - power[0])
        # The focal length is solved for to 1e-12 in its logarithm; a spacing follows it 1.5 times in mm per mm.
        assert lens.zoomed(required).surfaces[moved].thickness_mm == pytest.approx(expected, abs=1e-7)


def test_the_film_is_where_far_light_is_sharpest() -> None:
    # A lens that moves as a whole, whose file has the film there in each position.
    lens = rc.Lens.load("zoom-25-50mm")
    for required in (27.0, 40.0):
        there = lens.zoomed(required)
        assert there.film_distance_mm == pytest.approx(there.focused(math.inf).film_distance_mm, abs=1e-6)


def test_a_focus_shift_of_the_positions_goes_over_from_one_to_the_next(tmp_path: Path) -> None:
    """For a file with a defocused film: the focus shift is scipy's monotone cubic over the log of the focal length."""
    lens = rc.Lens.load("zoom-25-50mm")
    shifts = [0.0, 0.05, 0.07]
    text = (LENSES / "zoom-25-50mm.toml").read_text(encoding="utf-8")
    head, *tables = text.split("[[zoom]]\n")
    for i, (table, shift) in enumerate(zip(tables, shifts, strict=True)):
        tables[i] = f"[[zoom]]\nfilm_distance_mm = {lens.zoomed(i).film_distance_mm + shift!r}\n{table}"
    (tmp_path / "shifts.toml").write_text(head + "".join(tables), encoding="utf-8")
    shifting = rc.Lens.load(tmp_path / "shifts.toml")
    curve = PchipInterpolator(np.log(lens.zoom_focal_lengths_mm), shifts)
    for required in between(lens):
        shift = shifting.zoomed(required).film_distance_mm - lens.zoomed(required).film_distance_mm
        assert shift == pytest.approx(float(curve(np.log(required))), abs=1e-6)


def test_rings_stay_as_they_are() -> None:
    lens = rc.Lens.load("zoom-70-200mm").stopped_down(5.6).focused(3)
    there = lens.zoomed(100.0)
    assert there.focus_distance_m == pytest.approx(3, rel=1e-9)
    assert there.focused(math.inf).first_order().f_number == pytest.approx(5.6, rel=1e-6)
    # Zooming from one intermediate focal length to another gives the same lens as zooming from a position.
    assert there.zoomed(150.0).zoomed("70mm").surfaces == lens.zoomed("70mm").surfaces
    opened = rc.Lens.load("zoom-70-200mm").zoomed(100.0)
    assert opened.stop_semi_diameter_mm == opened.surfaces[opened.stop_index].clear_semi_diameter_mm


def test_focal_lengths_that_it_has_not_are_refused() -> None:
    lens = rc.Lens.load("zoom-70-200mm")
    for required in (70.0, 300.0, math.nan, -1.0):
        with pytest.raises(rc.InputError, match=r"has no focal length of .* mm; it zooms from 72.091 to 194 mm"):
            lens.zoomed(required)
    with pytest.raises(rc.InputError, match="has no zoom position 100; it has 3, counted from 0"):
        lens.zoomed(100)
    with pytest.raises(rc.InputError, match="has no focal lengths between zoom positions; it has fewer than two"):
        rc.Lens.load("tessar-50mm").zoomed(50.0)


@pytest.mark.parametrize("focus_m", [2.0, 3.0])
@pytest.mark.parametrize("position", ["80mm", "200mm"])
def test_a_focusing_group_finds_its_way_back_to_infinity(position: str, focus_m: float) -> None:
    """The first group images infinity at a second position, too, 0.1 m further out, where the lens has f/108."""
    rest = rc.Lens.load("zoom-80-200mm").zoomed(position)
    near = rest.focused(focus_m)
    back = near.focused(math.inf)
    for surface, there in zip(rest.surfaces, back.surfaces, strict=True):
        assert there.thickness_mm == pytest.approx(surface.thickness_mm, abs=1e-3)
    assert near.f_number == back.f_number == pytest.approx(rest.first_order().f_number, rel=1e-4)


@pytest.mark.parametrize("name", ["zoom-70-200mm", "tessar-50mm"])
def test_rings_are_set_together_as_one_by_one(name: str) -> None:
    """Closing the diaphragm and focusing commute, but for the rounding of the search for the focus."""
    lens = rc.Lens.load(name)
    zoom = 100.0 if lens.zoom_positions else None
    there = lens if zoom is None else lens.zoomed(zoom)
    together = lens.with_rings(zoom=zoom, f_number=8, focus_m=3)
    assert together == there.stopped_down(8).focused(3)
    other = there.focused(3).stopped_down(8)
    assert together.f_number == pytest.approx(8, rel=1e-9)
    assert other.film_distance_mm == pytest.approx(together.film_distance_mm, rel=1e-9)
    assert together.wide_open().f_number == pytest.approx(there.f_number, rel=1e-9)


def test_a_ring_that_the_lens_does_not_reach() -> None:
    lens = rc.Lens.load("tessar-50mm")
    with pytest.raises(rc.InputError, match=r"f/1.4 is faster than lens"):
        lens.with_rings(f_number=1.4)
    assert lens.with_rings(f_number=1.4, opens_as_far_as_it_can=True) == lens.wide_open() == lens
