"""Keys of a camera's rings and dials: what they say between, and what is refused."""

from __future__ import annotations

import math
import pickle
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import realcam as rc
from scipy.interpolate import CubicHermiteSpline, PchipInterpolator

from . import scenes

Key = rc.CameraKey


def shot_of(*keys: rc.CameraKey, lens: str = "tessar-50mm", **changes: object) -> rc.Shot:
    scene = scenes.scene_of(scenes.quad((0, 0, -3), 3, diffuse=0.5)).with_environment(100)
    camera = rc.Camera(rc.Lens.load(lens), film=rc.Film(36, 24, (12, 8)), exposure_time_s=0.01)
    return rc.Shot(scene, camera, rc.RenderSettings(spp=2, effects=()), keys=keys, **changes)


def test_dials_change_evenly_in_stops_and_focus_in_dioptres() -> None:
    shot = shot_of(
        Key(1, focus_m=1, f_number=4, exposure_time_s=0.01, iso=100),
        Key(3, focus_m=math.inf, f_number=16, exposure_time_s=0.04, iso=6400),
    )
    camera = shot.camera_at(2)
    assert camera.lens.focus_distance_m == pytest.approx(2, rel=1e-9)
    # The f-number is that of the lens at infinity (paraxial), here of a lens that moves as a whole.
    assert camera.lens.first_order().f_number == pytest.approx(8, rel=1e-9)
    assert camera.exposure_time_s == pytest.approx(0.02, rel=1e-12)
    assert camera.iso == pytest.approx(800, rel=1e-12)
    for time, key in ((0, shot.keys[0]), (1, shot.keys[0]), (3, shot.keys[1]), (9, shot.keys[1])):
        held = shot.camera_at(time)
        # To the last digit: what does not change goes through no logarithm.
        assert (held.exposure_time_s, held.iso) == (key.exposure_time_s, key.iso)
        assert held.lens == shot.camera.lens.stopped_down(key.f_number).focused(key.focus_m)


def test_each_value_goes_between_the_keys_that_have_it() -> None:
    shot = shot_of(Key(0, focus_m=1), Key(1, iso=100), Key(2, iso=400), Key(4, focus_m=2))
    assert shot.camera_at(2).lens.focus_distance_m == pytest.approx(1 / 0.75, rel=1e-9)
    assert [shot.camera_at(t).iso for t in (0, 1.5, 4)] == pytest.approx([100, 200, 400], rel=1e-12)


def test_smooth_keys_are_the_monotone_cubic_of_scipy() -> None:
    times, isos = np.array([0, 1.0, 1.5, 4, 5, 7]), np.array([100, 130, 800, 900, 200, 150])
    shot = shot_of(*(Key(t, iso=iso, interpolation="smooth") for t, iso in zip(times, isos, strict=True)))
    stops = np.log(isos)
    slopes = PchipInterpolator(times, stops).derivative()(times)
    slopes[[0, -1]] = 0  # from rest to rest
    curve = CubicHermiteSpline(times, stops, slopes)
    at = np.linspace(0, 7, 71)
    found = [math.log(shot.camera_at(float(t)).iso) for t in at]
    np.testing.assert_allclose(found, curve(at), rtol=0, atol=1e-12)


def test_kinds_of_ways_stand_beside_each_other() -> None:
    shot = shot_of(
        Key(0, iso=100, interpolation="step"),
        Key(1, iso=200, interpolation="smooth"),
        Key(2, iso=400),
        Key(3, iso=800),
    )
    eased = 200 * 2 ** (3 * 0.25**2 - 2 * 0.25**3)
    found = [shot.camera_at(t).iso for t in (0.999, 1, 1.25, 2.5)]
    assert found == pytest.approx([100, 200, eased, 400 * math.sqrt(2)], rel=1e-12)


def test_a_zoom_that_opens_less_on_its_way_opens_as_far_as_it_does() -> None:
    lens = rc.Lens.load("zoom-25-50mm")
    widest = {name: lens.zoomed(name).first_order().f_number for name in lens.zoom_positions}
    assert max(widest.values()) < 4.5
    shot = shot_of(Key(0, focal_length_mm=26, f_number=8), Key(1, focal_length_mm=48), lens="zoom-25-50mm")
    for t in (0, 0.3, 1):
        data = shot.camera_at(t).lens.first_order()
        assert data.effective_focal_length_mm == pytest.approx(26 * (48 / 26) ** t, rel=1e-9)
        assert data.f_number == pytest.approx(8, rel=1e-9)
    open_shot = shot_of(Key(0, focal_length_mm=26), Key(1, focal_length_mm=48), lens="zoom-25-50mm")
    assert open_shot.camera_at(0.5).lens.stop_semi_diameter_mm == pytest.approx(
        open_shot.camera_at(0.5).lens.surfaces[lens.stop_index].clear_semi_diameter_mm
    )


def test_the_picture_breathes_as_the_lens_does() -> None:
    """The chief ray of a lens that moves as a whole leaves the same exit pupil, which is then farther from the film."""
    shot = shot_of(Key(0, focus_m=math.inf), Key(1, focus_m=0.5))
    cameras = [shot.camera_at(t) for t in (0, 1)]
    last_vertex = sum(surface.thickness_mm for surface in shot.camera.lens.surfaces[:-1])
    pupil_to_film = [
        last_vertex + camera.lens.film_distance_mm - camera.lens.first_order().exit_pupil_position_mm
        for camera in cameras
    ]
    tangents = [math.tan(math.radians(camera.field_of_view_deg.horizontal / 2)) for camera in cameras]
    assert tangents[0] > 1.08 * tangents[1]
    # First order; the distortion of a Tessar changes by less than a hundredth with the focus.
    assert tangents[0] / tangents[1] == pytest.approx(pupil_to_film[1] / pupil_to_film[0], rel=0.01)


@pytest.mark.parametrize(
    ("make", "wanted"),
    [
        (lambda: Key(0), "a key of the camera has no value"),
        (lambda: Key(0, focus_m=0), "the focus distance must be a positive number of metres, or inf"),
        (lambda: Key(0, iso=math.inf), "the ISO number must be a positive number"),
        (lambda: Key(math.nan, iso=1), "a time must lie within 1e9 s"),
        (lambda: Key(0, iso=1, interpolation="bouncy"), 'interpolation: "bouncy": linear, smooth or step is wanted'),
        (lambda: shot_of(Key(1, iso=1), Key(1, iso=2)), "key 1 of the camera: the times must rise"),
        (lambda: shot_of(Key(0, f_number=1.2)), "key 0 of the camera: f/1.2 is faster than lens"),
        (lambda: shot_of(Key(0, focus_m=0.02)), "key 0 of the camera: cannot focus at 0.02 m"),
        (lambda: shot_of(Key(0, focal_length_mm=50)), "key 0 of the camera: .* has no focal lengths between"),
        (lambda: shot_of(Key(0, iso=100), iso_follows_s=0.5), "iso_follows_s and the iso of keys exclude each other"),
        (lambda: shot_of(iso_follows_s=-1), "iso_follows_s must be a number of seconds"),
    ],
)
def test_keys_that_cannot_be_are_refused(make: Callable[[], object], wanted: str) -> None:
    with pytest.raises(rc.InputError, match=wanted):
        make()


FILE = """format = 1
scene = "wall.obj"
environment_cd_m2 = 2000
lens = "zoom-25-50mm"
resolution = [12, 8]
effects = []
spp = 2
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "wall.obj").write_text("v -5 -5 0\nv 5 -5 0\nv 5 5 0\nv -5 5 0\nf 1 2 3 4\n")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_a_shot_file_has_keys(folder: Path) -> None:
    (folder / "a.toml").write_text(
        FILE + "exposure_time_s = 0.01\nshutter_opens_s = 1\n[[key]]\ntime_s = 0\nfocus_m = 1\nfocal_length_mm = 26\n"
        'interpolation = "smooth"\n[[key]]\ntime_s = 2\nfocus_m = inf\niso = 400\n'
        "[shake]\nrms_deg = 0.1\nseed = 3\n"
    )
    shot = rc.Shot.load("a.toml", device="cpu")
    assert shot.keys == (
        Key(0, focus_m=1, focal_length_mm=26, interpolation="smooth"),
        Key(2, focus_m=math.inf, iso=400),
    )
    assert shot.shake == rc.Shake(rms_deg=0.1, seed=3)
    # As the shutter opens, halfway between the keys.
    assert shot.camera.lens.focus_distance_m == pytest.approx(2, rel=1e-9)
    assert shot.camera.iso == 400
    assert pickle.loads(pickle.dumps(shot)).keys == shot.keys


@pytest.mark.parametrize(
    ("text", "line", "wanted"),
    [
        ("[[key]]\ntime_s = 1\niso = 100\n[[key]]\ntime_s = 1\niso = 200\n", 12, "the times must rise"),
        ("[[key]]\ntime_s = 1\niso = 100\n[[key]]\ntime_s = 0.5\niso = 200\n", 12, "the times must rise"),
        ("[[key]]\ntime_s = 1\nfocus = 2\n", 10, 'unknown key "focus" (did you mean "focus_m"?)'),
        ("[[key]]\niso = 100\n", 8, '"time_s" is missing: a number'),
        ("[[key]]\ntime_s = 1\n", 9, "a key of the camera has no value"),
        ('[[key]]\ntime_s = 1\nfocus_m = "auto"\n', 10, '"focus_m" of a key must be a number of metres or inf'),
        ('[[key]]\ntime_s = 1\niso = 1\ninterpolation = "slow"\n', 11, '"interpolation" must be linear, smooth'),
        ("iso = 200\n[[key]]\ntime_s = 1\niso = 100\n", 8, '"iso" and "iso" of [[key]] exclude each other'),
        ('zoom = "35mm"\n[[key]]\ntime_s = 1\nfocal_length_mm = 30\n', 8, '"zoom" and "focal_length_mm" of [[key]]'),
        ("[[key]]\ntime_s = 1\nfocal_length_mm = 80\n", 8, "no focal length of 80 mm; it zooms from 25.499 to 48.801"),
        ("[[key]]\ntime_s = 1\nf_number = 2\n", 8, "f/2 is faster than lens"),
        ("[[key]]\ntime_s = 1\nfocal_length_mm = 30\nf_number = 2\n", 8, "f/2 is faster than the lens at 30 mm"),
        ("key = 3\n", 8, "tables [[key]] are wanted"),
        ("iso_follows_s = -1\n", 8, '"iso_follows_s" must be a number of seconds, 0 or more'),
        ("[shake]\nrms_degrees = 1\n", 9, 'unknown key "rms_degrees"'),
        ("[shake]\nseed = 1\n", 8, '[shake] wants a "file", "rms_deg" or "rms_mm"'),
        ("[shake]\nrms_deg = -1\n", 9, "must be an angle from 0 to 9 degrees"),
    ],
)  # fmt: skip
def test_mistakes_are_named_with_file_and_line(folder: Path, text: str, line: int, wanted: str) -> None:
    (folder / "a.toml").write_text(FILE + text)
    with pytest.raises(rc.InputError) as refusal:
        rc.Shot.load("a.toml", device="cpu")
    assert str(refusal.value).startswith(f"a.toml:{line}: ")
    assert wanted in str(refusal.value)
    assert "\n" not in str(refusal.value)
