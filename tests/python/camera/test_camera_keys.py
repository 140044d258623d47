"""Keys of a camera's rings and dials: what they say between, and what is refused."""

from __future__ import annotations

import json
import math
import pickle
import subprocess
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import realcam as rc
from scipy.interpolate import CubicHermiteSpline, PchipInterpolator

from .. import scenes
from ..programs import PROGRAM

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
        # Values equal to the last digit: constant parameters are not interpolated through a logarithm.
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
    lenses = [camera.lens for camera in cameras]
    pupil_to_film = [last_vertex + a.film_distance_mm - a.first_order().exit_pupil_position_mm for a in lenses]
    tangents = [math.tan(math.radians(camera.field_of_view_deg.horizontal / 2)) for camera in cameras]
    assert tangents[0] > 1.08 * tangents[1]
    # First order; the distortion of a Tessar changes by less than a hundredth with the focus.
    assert tangents[0] / tangents[1] == pytest.approx(pupil_to_film[1] / pupil_to_film[0], rel=0.01)


def test_a_cut_to_another_lens() -> None:
    """The rings stay as they stand, where the keys say nothing else; within a lens they go from key to key."""
    gauss, zoom = rc.Lens.load("double-gauss-50mm"), rc.Lens.load("zoom-70-200mm")
    camera = rc.Camera(rc.Lens.load("tessar-50mm").stopped_down(5.6).focused(2.5), film=rc.Film(36, 24, (12, 8)))
    keys = (
        Key(1, lens=gauss.focused(9), iso=100),
        Key(2, focus_m=4, interpolation="smooth"),
        Key(3, lens=zoom, focus_m=6, f_number=4, focal_length_mm=100),
        Key(4, focal_length_mm=144, f_number=16),
        Key(5, lens=gauss, iso=1600),
    )
    shot = replace(shot_of(), camera=camera, keys=keys)

    def rings(time_s: float) -> tuple[str, float, float, float]:
        lens = shot.camera_at(time_s).lens
        data = lens.focused(math.inf).first_order()
        return lens.name, lens.focus_distance_m, data.f_number, data.effective_focal_length_mm

    fixed = gauss.first_order().effective_focal_length_mm
    assert shot.camera_at(0.999).lens == camera.lens
    for time_s, *expected in (
        (1, gauss.name, 4, 5.6, fixed),  # with the first focus that its keys have
        (2.9, gauss.name, 4, 5.6, fixed),
        (3, zoom.name, 6, 4, 100),
        (3.5, zoom.name, 6, 8, 120),
        (4.9, zoom.name, 6, 16, 144),
        (5, gauss.name, 6, 16, fixed),
    ):
        assert rings(time_s) == (expected[0], *(pytest.approx(value, rel=1e-6) for value in expected[1:])), time_s
    # A dial of the camera goes on over all cuts.
    assert [shot.camera_at(t).iso for t in (2, 3, 4)] == pytest.approx([200, 400, 800], rel=1e-12)
    assert pickle.loads(pickle.dumps(keys)) == keys


def test_a_wide_open_lens_leaves_the_next_one_wide_open() -> None:
    fast = rc.Lens.load("double-gauss-50mm-fast")
    shot = shot_of(Key(1, lens=fast.stopped_down(11)), Key(2, lens=rc.Lens.load("tessar-50mm"), f_number=4))
    assert shot.camera_at(1).lens.stop_semi_diameter_mm == fast.stop_semi_diameter_mm
    assert shot.camera_at(2).lens.first_order().f_number == pytest.approx(4, rel=1e-9)


def test_a_frame_whose_time_is_a_sum_is_that_of_its_key() -> None:
    """0.7 + 0.1 is a little less than 0.8, in doubles."""
    assert 0.7 + 0.1 < 0.8
    shot = shot_of(Key(0.8, lens=rc.Lens.load("double-gauss-50mm")))
    shot = replace(shot, camera=shot.camera.replace(shutter_opens_s=0.7))
    frames = shot.frames([1, 2], frames_per_second=10)
    assert [frame.camera.lens.name for frame in frames.values()] == ["tessar-50mm", "double-gauss-50mm"]


def test_effects_are_planned_for_each_lens() -> None:
    gauss, tessar = rc.Lens.load("double-gauss-50mm"), rc.Lens.load("tessar-50mm")
    keys = [Key(10, lens=gauss), Key(11, focus_m=2), Key(12, lens=gauss), Key(13, lens=tessar)]
    camera = rc.Camera(tessar)
    assert rc._core._frames_to_plan(range(1, 41), camera, keys, 1.0) == [1, 11, 14, 21, 40]
    assert rc._core._frames_to_plan([12], camera, keys, 1.0) == [12]


def test_blades_and_film_have_keys() -> None:
    shot = shot_of(
        Key(0, blade_rotation_deg=10, film_shift_mm=(0, -1)),
        Key(1, blades=6),
        Key(2, blade_rotation_deg=-20, blade_rounding=0.5, film_shift_mm=(3, 1)),
        Key(3, blades=9),
    )
    for time_s, blades, rotation_deg, shift_mm in (
        (0, 6, 10, (0, -1)),
        (1, 6, -5, (1.5, 0)),
        (2.9, 6, -20, (3, 1)),
        (3, 9, -20, (3, 1)),
    ):
        camera = shot.camera_at(time_s)
        assert camera.lens.iris_blades == blades
        assert camera.lens.iris_rounding == 0.5
        assert camera.lens.iris_rotation_deg == pytest.approx(rotation_deg, abs=1e-12)
        assert camera.film.shift_mm == pytest.approx(shift_mm)
    assert shot.keys[2].film_shift_mm == (3, 1)


@pytest.mark.parametrize(
    ("make", "expected"),
    [
        (lambda: Key(0), "a key of the camera has no value"),
        (lambda: Key(0, focus_m=0), "the focus distance must be a positive number of metres, or inf"),
        (lambda: Key(0, iso=math.inf), "the ISO number must be a positive number"),
        (lambda: Key(math.nan, iso=1), "a time must lie within 1e9 s"),
        (lambda: Key(0, blades=2), "the iris has 2 blades; expected 0"),
        (lambda: Key(0, blade_rounding=1.5), "the rounding of the iris must lie between 0"),
        (lambda: Key(0, film_shift_mm=(0, math.nan)), "the shift of the film must be a number"),
        (lambda: shot_of(Key(0, blade_rotation_deg=9)), "key 0 of the camera: the diaphragm of tessar-50mm is round"),
        (
            lambda: shot_of(Key(0, f_number=4), Key(1, lens=rc.Lens.load("mirror-telephoto-500mm"))),
            "key 1 of the camera: f/4 is faster than lens",
        ),
        (
            lambda: replace(
                shot_of(Key(1, lens=rc.Lens.load("zoom-70-200mm"), focal_length_mm=100)),
                camera=rc.Camera(rc.Lens.load("double-gauss-50mm").stopped_down(2.4)),
            ),
            "key 0 of the camera: f/2.4 is faster than the lens at 100 mm, which opens to f/2.9",
        ),
        (lambda: Key(0, iso=1, interpolation="bouncy"), 'interpolation: "bouncy": expected linear, smooth or step'),
        (lambda: shot_of(Key(1, iso=1), Key(1, iso=2)), "key 1 of the camera: the times must be strictly increasing"),
        (lambda: shot_of(Key(0, f_number=1.2)), "key 0 of the camera: f/1.2 is faster than lens"),
        (lambda: shot_of(Key(0, focus_m=0.02)), "key 0 of the camera: cannot focus at 0.02 m"),
        (lambda: shot_of(Key(0, focal_length_mm=50)), "key 0 of the camera: .* has no focal lengths between"),
        (lambda: shot_of(Key(0, iso=100), iso_follows_s=0.5), "iso_follows_s cannot be combined with the iso of keys"),
        (lambda: shot_of(iso_follows_s=-1), "iso_follows_s must be a number of seconds"),
    ],
)
def test_keys_that_cannot_be_are_refused(make: Callable[[], object], expected: str) -> None:
    with pytest.raises(rc.InputError, match=expected):
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
    # The shutter opens halfway between the two keys.
    assert shot.camera.lens.focus_distance_m == pytest.approx(2, rel=1e-9)
    assert shot.camera.iso == 400
    assert pickle.loads(pickle.dumps(shot)).keys == shot.keys


@pytest.mark.slow
def test_a_shot_file_cuts_to_other_lenses(folder: Path) -> None:
    bundled = rc.Lens.load("double-gauss-50mm")
    (folder / "mine").mkdir()
    bundled.with_surface(0, radius_of_curvature_mm=30).save("mine/my.toml")
    (folder / "a.toml").write_text(
        FILE + 'zoom = "35mm"\nf_number = 5.6\nfocus_m = 3\nblades = 7\nexposure_time_s = 0.01\n'
        '[[key]]\ntime_s = 1\nlens = "mine/my.toml"\n'
        '[[key]]\ntime_s = 2\nlens = "zoom-70-200mm"\nfocal_length_mm = 90\n'
        "[[key]]\ntime_s = 3\nf_number = 8\nfocus_m = 2\nblades = 9\n"
    )
    shot = rc.Shot.load("a.toml", device="cpu")
    found = []
    for time_s in range(4):
        lens = shot.camera_at(time_s).lens
        data = lens.focused(math.inf).first_order()
        found.append((data.effective_focal_length_mm, data.f_number, lens.focus_distance_m, lens.iris_blades))
    lenses = [shot.camera_at(time_s).lens for time_s in (0, 1, 2)]
    assert [lens.name for lens in lenses] == ["zoom-25-50mm", "double-gauss-50mm", "zoom-70-200mm"]
    assert lenses[1].surfaces[0].radius_of_curvature_mm == 30
    assert found[0] == pytest.approx((35.1475, 5.6, 3, 7), rel=1e-5)
    assert found[1][1:] == pytest.approx((5.6, 3, 7))
    assert found[3] == pytest.approx((90, 8, 2, 9))
    words = ["render", "a.toml", "-o", "a.#.exr", "--frames", "1-3", "--fps", "1", "--json", "--device", "cpu"]
    for more, names in (([], [lens.name for lens in lenses]), (["--lens", "tessar-50mm"], ["tessar-50mm"] * 3)):
        told = subprocess.run([*PROGRAM, *words, *more, "--again"], capture_output=True, text=True, check=True).stdout
        assert [frame["lens"]["name"] for frame in json.loads(told)] == names


def test_each_lens_of_a_film_tells_what_it_cannot_show(folder: Path) -> None:
    (folder / "a.toml").write_text(
        FILE.replace("effects = []", 'effects = ["dispersion"]') + "exposure_time_s = 0.01\n"
        '[[key]]\ntime_s = 1\nlens = "planar-50mm-1897"\n[[key]]\ntime_s = 2\nlens = "telephoto-250mm"\n'
    )
    words = ["render", "a.toml", "-o", "a.png", "--frames", "1-4", "--fps", "1", "--quiet", "--device", "cpu"]
    told = subprocess.run([*PROGRAM, *words], capture_output=True, text=True, check=True).stderr
    # One warning for each lens whose file states only refractive indices.
    lines = told.splitlines()
    assert len(lines) == 2, told
    for line, lens in zip(lines, ("planar-50mm-1897", "telephoto-250mm"), strict=True):
        assert "dispersion: the glasses of" in line and lens in line


def test_an_f_number_of_the_file_is_that_of_all_focal_lengths(folder: Path) -> None:
    """This holds even if the lens cannot open to that f-number at the zoom position it had before its keys apply."""
    lens = (Path(__file__).parents[3] / "lenses" / "zoom-25-50mm.toml").read_text()
    slow = lens.replace("stop_semi_diameter_mm = 8.31038", "stop_semi_diameter_mm = 4.15519")
    assert slow != lens
    (folder / "slow.toml").write_text(slow)
    text = FILE.replace("zoom-25-50mm", "./slow.toml") + "exposure_time_s = 0.01\nf_number = 4\n"
    (folder / "a.toml").write_text(text + "[[key]]\ntime_s = 1\nfocal_length_mm = 48.8\n")
    data = rc.Shot.load("a.toml", device="cpu").camera_at(0).lens.focused(math.inf).first_order()
    assert data.f_number == pytest.approx(4, rel=0.005)
    (folder / "a.toml").write_text(text + "[[key]]\ntime_s = 1\nfocal_length_mm = 25.5\n")
    with pytest.raises(rc.InputError, match=r"a\.toml:10: f/4 is faster than the lens at 25.5 mm, .* to f/7\.998"):
        rc.Shot.load("a.toml", device="cpu")


@pytest.mark.parametrize(
    ("text", "line", "expected"),
    [
        ("[[key]]\ntime_s = 1\niso = 100\n[[key]]\ntime_s = 1\niso = 200\n", 12, "times must be strictly increasing"),
        ("[[key]]\ntime_s = 1\nfocus = 2\n", 10, 'unknown key "focus" (did you mean "focus_m"?)'),
        ("[[key]]\niso = 100\n", 8, '"time_s" is missing: a number'),
        ("[[key]]\ntime_s = 1\n", 9, "a key of the camera has no value"),
        ('[[key]]\ntime_s = 1\nfocus_m = "auto"\n', 10, '"focus_m" of a key must be a number of metres or inf'),
        ('[[key]]\ntime_s = 1\niso = 1\ninterpolation = "slow"\n', 11, '"interpolation" must be linear, smooth'),
        ("iso = 200\n[[key]]\ntime_s = 1\niso = 100\n", 8, '"iso" and "iso" of [[key]] exclude each other'),
        ('zoom = "35mm"\n[[key]]\ntime_s = 1\nfocal_length_mm = 30\n', 8, '"zoom" and "focal_length_mm" of [[key]]'),
        ("[[key]]\ntime_s = 1\nfocal_length_mm = 80\n", 8, "no focal length of 80 mm; it zooms from 25.499 to 48.801"),
        ("[[key]]\ntime_s = 1\nfocal_length_mm = 30\nf_number = 2\n", 8, "f/2 is faster than the lens at 30 mm"),
        ('[[key]]\ntime_s = 1\nlens = "phone-4mm"\n', 8, "the lens is made for a film of 4.8 x 3.6 mm"),
        ('[[key]]\ntime_s = 1\nlens = "tesar-50mm"\n', 8, '"tessar-50mm"'),
        ('[[key]]\ntime_s = 1\nlens = ""\n', 10, '"lens" is empty'),
        ('f_number = 4.5\n[[key]]\ntime_s = 1\nlens = "mirror-telephoto-500mm"\n', 9, "f/4.5 is faster than lens"),
        ("blades = 7\n[[key]]\ntime_s = 1\nblades = 6\n", 8, '"blades" and "blades" of [[key]] exclude each other'),
        ("[[key]]\ntime_s = 1\nblades = 6.5\n", 10, '"blades" must be a whole number'),
        ("film_shift_mm = [1, 0]\n[[key]]\ntime_s = 1\nfilm_shift_mm = [0, 0]\n", 8, '"film_shift_mm" of [[key]]'),
        ("[[key]]\ntime_s = 1\nfilm_shift_mm = 3\n", 10, '"film_shift_mm"'),
        ("[[key]]\ntime_s = 1\nfilm_mm = [36, 24]\n", 10, 'unknown key "film_mm"'),
        ("key = 3\n", 8, "expected tables [[key]]"),
        ("[shake]\nrms_degrees = 1\n", 9, 'unknown key "rms_degrees"'),
        ("[shake]\nseed = 1\n", 8, '[shake] needs a "file", "rms_deg" or "rms_mm"'),
    ],
)  # fmt: skip
def test_mistakes_are_named_with_file_and_line(folder: Path, text: str, line: int, expected: str) -> None:
    (folder / "a.toml").write_text(FILE + text)
    with pytest.raises(rc.InputError) as refusal:
        rc.Shot.load("a.toml", device="cpu")
    assert str(refusal.value).startswith(f"a.toml:{line}: ")
    assert expected in str(refusal.value)
    assert "\n" not in str(refusal.value)
