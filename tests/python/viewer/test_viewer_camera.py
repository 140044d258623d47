"""The lens bench's camera: where it stands, its rings, and what they make of the lens."""

from __future__ import annotations

import math
import re
from dataclasses import replace

import numpy as np
import pytest
import realcam as rc
from realcam.fields import angle_of_height
from realcam.viewer.camera_controls import CameraControls
from realcam.viewer.lens_view import ray_view
from realcam.viewer.page.focus_scale import distance_texts, focus_scale_svg
from realcam.viewer.pose import Pose
from realcam.viewer.ring_scales import ISO, SHUTTER_S, aperture_ring, zoom_ring

FILM = rc.Film(36, 24, (90, 60))
POSE = Pose((0.0, 1.0, 4.0), (0.0, 1.0, 0.0))


def controls(name: str = "double-gauss-50mm", **changes: object) -> CameraControls:
    lens = rc.Lens.load(name)
    return CameraControls(lens=lens.wide_open(), film=FILM, pose=POSE, zoom=lens.zoom_position, **changes)


# The pose.


def test_an_orbit_keeps_the_distance_and_the_point() -> None:
    turned = POSE.orbited(0.3, 0.2)
    assert turned.distance_m == pytest.approx(POSE.distance_m, rel=1e-12)
    assert turned.look_at_m == POSE.look_at_m
    # Right and up as the camera sees it: it looks along -z, so that its right is +x.
    assert POSE.orbited(0.3, 0).position_m == pytest.approx((4 * math.sin(0.3), 1, 4 * math.cos(0.3)))
    assert POSE.orbited(0, 0.2).position_m == pytest.approx((0, 1 + 4 * math.sin(0.2), 4 * math.cos(0.2)))


@pytest.mark.parametrize("step", [0.05, 1.0, 3.0, 100.0])
def test_no_orbit_reaches_the_pole(step: float) -> None:
    pose = POSE
    for k in range(200):
        pose = pose.orbited(0.1, step if k < 120 else -step)
        back = np.subtract(pose.position_m, pose.look_at_m) / pose.distance_m
        assert abs(back[1]) < 0.9951
        assert np.all(np.isfinite(pose.position_m))


def test_a_pan_moves_across_the_view_and_a_dolly_along_it() -> None:
    panned = POSE.panned(0.5, 0.25)
    assert panned.position_m == pytest.approx((0.5, 1.25, 4))
    assert panned.look_at_m == pytest.approx((0.5, 1.25, 0))
    tilted = Pose((3.0, 2.0, 1.0), (0.0, 0.5, 0.0)).panned(0.4, -0.7)
    move = np.subtract(tilted.position_m, (3, 2, 1))
    assert move @ (3, 1.5, 1) == pytest.approx(0, abs=1e-12)
    assert np.linalg.norm(move) == pytest.approx(math.hypot(0.4, 0.7))
    assert POSE.dollied(0.5).position_m == pytest.approx((0, 1, 2))


# The rings. What stands on cameras: ISO 2720 for f-numbers and times, ISO 12232 for speeds.

STOPS = ["1", "1.4", "2", "2.8", "4", "5.6", "8", "11", "16", "22", "32", "45", "64"]


def test_whole_stops_are_engraved_as_on_cameras() -> None:
    ring = aperture_ring(1.0)
    assert [ring.engraved[k] for k in range(0, len(ring.values), 3)] == STOPS
    assert list(SHUTTER_S.engraved[::3]) == [
        *("1/8000", "1/4000", "1/2000", "1/1000", "1/500", "1/250", "1/125", "1/60", "1/30", "1/15", "1/8", "1/4"),
        *("0.5", "1", "2", "4", "8", "15", "30"),
    ]
    assert list(ISO.engraved[::3]) == ["50", "100", "200", "400", "800", "1600", "3200", "6400", "12800", "25600"]


@pytest.mark.parametrize("ring", [aperture_ring(1.0), SHUTTER_S, ISO])
def test_engraved_figures_are_what_is_set_but_for_rounding(ring) -> None:
    assert len(ring.values) == len(ring.engraved)
    ratios = np.divide(ring.values[1:], ring.values[:-1])
    np.testing.assert_allclose(ratios, 2 ** (1 / 6 if ring.values[0] == 1 else 1 / 3), rtol=1e-12)
    for value, text in zip(ring.values, ring.engraved, strict=True):
        top, _, bottom = text.partition("/")
        # The largest rounding of cameras is 1/15 s for 1/16 s, and 0.3 s for 0.315 s.
        assert float(top) / float(bottom or 1) == pytest.approx(value, rel=0.07), text
        assert ring.text_of(value) == text
        assert ring.values[ring.step_of(value * 1.05)] == value
    assert ring.text_of(ring.values[3] * 2 ** (1 / 12)) not in ring.engraved


@pytest.mark.parametrize("name", rc.lens_names())
def test_the_aperture_ring_begins_at_the_widest_opening(name: str) -> None:
    widest = rc.Lens.load(name).first_order().f_number
    ring = aperture_ring(widest)
    assert ring.values[0] == widest
    assert list(ring.values) == sorted(set(ring.values))
    assert ring.values[-1] == 64
    assert np.all(np.diff(np.log2(ring.values)) < 1 / 3 + 0.06)  # f/0.95 is the widest of all


@pytest.mark.parametrize("name", rc.lens_names())
def test_the_zoom_ring_is_even_and_has_the_positions(name: str) -> None:
    lens = rc.Lens.load(name)
    ring = zoom_ring(lens)
    if not lens.zoom_positions:
        assert ring is None
        return
    known = lens.zoom_focal_lengths_mm
    assert (ring.values[0], ring.values[-1]) == (min(known), max(known))
    assert set(known) <= set(ring.values)
    steps = np.diff(np.log(ring.values)) / math.log(max(known) / min(known)) * (len(ring.values) - 1)
    # A position stands within half a step of where its step would be.
    assert np.all((steps > 0.49) & (steps < 1.51))
    assert np.count_nonzero(abs(steps - 1) > 1e-6) <= 2 * (len(known) - 2)


# The camera that they make.


def test_a_film_that_is_shifted_is_drawn_as_the_smallest_that_holds_it() -> None:
    """Its farther edges are 18 + 3 and 12 + 2 mm from the axis."""
    film = FILM.replace(shift_mm=(3.0, -2.0))
    assert replace(controls(), film=film).lens_on_film.film_mm == (42.0, 28.0)
    assert controls().lens_on_film.film_mm == (36.0, 24.0)


def test_the_stop_is_set_before_the_lens_is_focused() -> None:
    """Engraved f-numbers hold at infinity: a lens with a moving group has another focal length when focused near."""
    lens = rc.Lens.load("telephoto-200mm-inner-focus")
    made = controls(lens.name, f_number=4.0, focus_m=2.6).set_lens
    assert made.stop_semi_diameter_mm == lens.stopped_down(4.0).stop_semi_diameter_mm
    assert made.focus_distance_m == pytest.approx(2.6)
    assert lens.focused(2.6).first_order().f_number != pytest.approx(lens.first_order().f_number, rel=0.01)


@pytest.mark.parametrize("f_number", [None, 0.5, 1.9])
def test_no_ring_opens_a_lens_wider_than_it_is(f_number: float | None) -> None:
    assert controls(f_number=f_number).set_lens.first_order().f_number == pytest.approx(2.03, abs=0.01)


def test_the_aperture_stays_where_it_is_while_lenses_change() -> None:
    now = controls(f_number=1.45)
    assert now.set_lens.first_order().f_number > 2
    faster = now.with_lens(rc.Lens.load("double-gauss-50mm-fast"))
    assert faster.set_lens.first_order().f_number == pytest.approx(1.45, rel=1e-3)


def test_a_zoom_position_stays_where_the_lens_has_it() -> None:
    at_137 = replace(controls("zoom-70-210mm"), zoom="137mm")
    assert at_137.camera.lens.first_order().effective_focal_length_mm == pytest.approx(137, rel=0.02)
    assert at_137.with_lens(rc.Lens.load("zoom-70-210mm")).zoom == "137mm"
    assert at_137.with_lens(rc.Lens.load("zoom-70-200mm")).zoom == "70mm"
    assert at_137.with_lens(rc.Lens.load("tessar-50mm")).zoom is None


def test_a_zoom_ring_stays_where_the_lens_reaches_as_far() -> None:
    between = replace(controls("zoom-70-210mm"), zoom=100.0)
    assert between.camera.lens.first_order().effective_focal_length_mm == pytest.approx(100, rel=1e-9)
    assert between.with_lens(rc.Lens.load("zoom-80-200mm")).zoom == 100.0
    assert between.with_lens(rc.Lens.load("zoom-25-50mm")).zoom == "49mm"
    assert between.with_lens(rc.Lens.load("tessar-50mm")).zoom is None
    with pytest.raises(rc.InputError, match="no focal length of 300 mm"):
        replace(between, zoom=300.0).body  # noqa: B018


@pytest.mark.parametrize("zoom", ["35mm", 30.0])
def test_a_zoom_that_was_stopped_down_opens_again(zoom: str | float) -> None:
    lens = rc.Lens.load("zoom-25-50mm")
    now = CameraControls.of(rc.Camera(lens.zoomed(zoom).stopped_down(11).focused(2), film=FILM))
    assert now.zoom == (zoom if isinstance(zoom, str) else pytest.approx(zoom, rel=1e-9))
    assert now.apertures.values[0] == pytest.approx(lens.zoomed(zoom).first_order().f_number, rel=1e-9)
    for elsewhere in ("25mm", 40.0, "49mm"):
        wide = replace(now, zoom=elsewhere, f_number=None).set_lens
        assert wide.stop_semi_diameter_mm == lens.zoomed(elsewhere).stop_semi_diameter_mm


def test_focus_stops_at_the_nearest() -> None:
    now = controls("macro-105mm", focus_m=0.2)
    with pytest.raises(rc.InputError):
        now.camera  # noqa: B018
    assert now.focused_within_reach().focus_m == pytest.approx(0.41)
    assert now.focused_within_reach().camera.lens.focus_distance_m == pytest.approx(0.41)
    far = controls("macro-105mm", focus_m=3.0)
    assert far.focused_within_reach() is far


def test_what_cannot_be_focused_at_all_is_told() -> None:
    now = controls(focus_m=0.01)  # inside of the lens, which has no end of its ring
    with pytest.raises(rc.InputError):
        now.focused_within_reach()


@pytest.mark.parametrize("name", rc.lens_names())
def test_controls_of_a_camera_make_that_camera(name: str) -> None:
    lens = rc.Lens.load(name)
    wide = lens.first_order().f_number
    near = max(lens.nearest_focus_m * 1.2, 60e-3 * abs(lens.first_order().effective_focal_length_mm))
    made = lens.stopped_down(1.5 * wide).focused(near)
    film = rc.Film.for_lens(lens, resolution=(90, 60))
    camera = rc.Camera(made, film=film, position=(1, 2, 3), look_at=(0, 0, 1), exposure_time_s=0.1, iso=400)
    again = CameraControls.of(camera).camera
    assert again.position == camera.position
    assert (again.exposure_time_s, again.iso, again.film) == (camera.exposure_time_s, camera.iso, camera.film)
    assert again.lens.focus_distance_m == pytest.approx(camera.lens.focus_distance_m)
    assert again.lens.film_distance_mm == pytest.approx(camera.lens.film_distance_mm, rel=1e-9)
    assert again.lens.stop_semi_diameter_mm == pytest.approx(camera.lens.stop_semi_diameter_mm, rel=1e-6)


# The scale on the barrel.


def marks_of(svg: str) -> dict[str, float]:
    return {text: float(x) for x, text in re.findall(r'<text x="([\d.]+)" y="33"[^>]*>([^<]+)</text>', svg)}


def test_the_barrel_is_even_in_the_inverse_distance() -> None:
    marks = marks_of(focus_scale_svg(2.0, 1.5, 3.0, 0.5))
    assert marks["∞"] > marks["2"] > marks["1"] > marks["0.5"]
    for text, x in marks.items():
        share = 0.0 if text == "∞" else 0.5 / float(text)
        # Written to a tenth; the figures' sizes do not matter.
        assert x == pytest.approx(marks["∞"] + share * (marks["0.5"] - marks["∞"]), abs=0.11), text
    assert min(np.diff(sorted(marks.values()))) > 20  # none is written over another


def test_the_barrel_says_what_is_sharp() -> None:
    assert "Focused at 2 m; sharp from 1.5 m to 3 m" in focus_scale_svg(2.0, 1.5, 3.0, 0.5)
    assert "Focused at infinity; sharp from 20 m to infinity" in focus_scale_svg(math.inf, 20.0, math.inf, 0.5)
    nowhere = focus_scale_svg(2.0, math.nan, math.nan, 0.5)
    assert "nothing is sharp" in nowhere
    assert "nan" not in nowhere


@pytest.mark.parametrize(
    ("near", "far", "texts"),
    [
        (0.745, 2.35, ("0.745 m", "2.35 m")),
        (1.1987, 1.2019, ("1.199 m", "1.202 m")),
        (12.3401, 12.3409, ("12.34 m", "12.341 m")),
        (5.0, math.inf, ("5 m", "∞")),
        (3.0, 3.0, ("3 m", "3 m")),
    ],
)
def test_two_distances_have_as_many_digits_as_tell_them_apart(near: float, far: float, texts: tuple[str, str]) -> None:
    assert distance_texts(near, far) == texts


@pytest.mark.parametrize("name", ["double-gauss-50mm", "fisheye-6mm-220deg", "phone-4mm", "mirror-telephoto-500mm"])
def test_drawn_rays_end_where_the_mouse_is(name: str) -> None:
    lens = rc.Lens.load(name)
    _, last_mm = angle_of_height(lens, 0.5 * math.hypot(*lens.film_mm))  # that gets light
    for share in (0.1, 0.3, 0.8):
        middle, bundle = ray_view(lens, (0.0, share * last_mm))["bundles"]
        ends = np.array([path[-1][1] for path in bundle])
        # The chief ray ends there; the others around it, by the lens's aberrations.
        assert np.median(ends) == pytest.approx(share * last_mm, abs=0.02 * last_mm)
        assert np.median([path[-1][1] for path in middle]) == pytest.approx(0, abs=0.01 * last_mm)
