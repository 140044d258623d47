"""The lens bench without its page: what actions make of camera, picture and files."""

from __future__ import annotations

import math
import re
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import realcam as rc

pytest.importorskip("simplejpeg")

from realcam.viewer import lens_edits, saving
from realcam.viewer.camera_controls import CameraControls
from realcam.viewer.effect_switches import EFFECTS
from realcam.viewer.lens_bench import LensBench
from realcam.viewer.listeners import Problem
from realcam.viewer.server import messages
from realcam.viewer.shot_source import ShotSource

from . import bench_shots

pytestmark = pytest.mark.picture_files

BenchOf = Callable[..., LensBench]


class BenchRecorder:
    """Records the notifications that a page would receive."""

    def __init__(self, bench: LensBench) -> None:
        self.bench = bench
        self.frames: list[Any] = []
        self.lenses: list[dict[str, Any]] = []
        self.problems: list[Problem | None] = []
        self.plans: list[Any] = []
        self.news = threading.Condition()
        bench.listeners.frame = lambda slot, frame: self.take(self.frames, (slot, frame))
        bench.listeners.lens = lambda view: self.take(self.lenses, view)
        bench.listeners.problem = lambda problem: self.take(self.problems, problem)
        bench.listeners.plan = lambda plan, note: self.take(self.plans, (plan, note))

    def take(self, where: list[Any], what: Any) -> None:
        with self.news:
            where.append(what)
            self.news.notify_all()

    def until(self, has_come: Callable[[], object]) -> None:
        with self.news:
            assert self.news.wait_for(has_come, 60)

    def until_shown(self) -> BenchRecorder:
        self.bench.show()
        self.until_final()
        return self

    def until_final(self, slot: str = "a") -> Any:
        """The last frame of what was asked for last."""

        def frames() -> list[Any]:
            return [frame for s, frame in self.frames if s == slot]

        required = self.bench.requested_serials[slot]
        self.until(lambda: frames() and frames()[-1].is_final and frames()[-1].serial >= required)
        return frames()[-1]


@pytest.fixture
def shot_path(tmp_path: Path) -> Path:
    return bench_shots.write_panels_shot(tmp_path)


@pytest.fixture
def bench(bench_of: BenchOf, shot_path: Path) -> LensBench:
    return bench_of(rc.Shot.load(shot_path), noise_codes=4.0)


def codes(bench: LensBench) -> np.ndarray:
    image = bench.image()
    return rc._core.develop(image.pixels, image.camera.iso)


def state(bench: LensBench) -> tuple[Any, ...]:
    return bench.controls, bench.history.now.lens, bench.history.can_undo, bench.history.can_redo


def test_the_bench_begins_with_the_shot(bench: LensBench, shot_path: Path) -> None:
    shot = rc.Shot.load(shot_path)
    assert bench.controls.camera.film == shot.camera.film
    assert bench.controls.focus_m == pytest.approx(bench_shots.MIDDLE_M)
    bench.noise_codes = 1.0
    recorder = BenchRecorder(bench).until_shown()
    recorder.until(lambda: recorder.lenses)
    picture = rc.render(shot.scene, shot.camera, effects=(), spp=256, device="cpu")
    difference = codes(bench).astype(float) - rc._core.develop(picture.pixels, 100)
    assert math.sqrt(np.mean(difference**2)) < 2  # refined to the noise of one code


def test_a_click_focuses_at_its_point(bench: LensBench) -> None:
    recorder = BenchRecorder(bench).until_shown()
    for u, distance in ((1 / 6, bench_shots.NEAR_M), (5 / 6, bench_shots.FAR_M), (1 / 2, bench_shots.MIDDLE_M)):
        assert bench.focus_at(u, 0.5)
        assert bench.controls.focus_m == pytest.approx(distance, rel=0.01)
        recorder.until_final()
        sharp = bench_shots.sharpness(codes(bench))
        assert np.argmax(sharp) == round(3 * u - 0.5)


def test_the_zoom_ring_is_undone_by_drags(bench: LensBench) -> None:
    assert bench.set_lens(rc.Lens.load("zoom-25-50mm"))
    for drag, focal_lengths_mm in enumerate(((26.0, 28.0, 30.0), (32.0, 34.0))):
        for focal_length_mm in focal_lengths_mm:
            assert bench.set_zoom(focal_length_mm, ("zoom", drag))
    assert bench.edit(lambda lens: lens_edits.with_value(lens, 0, "radius_mm", 82.0))
    bench.turn("zoom", 1)
    assert bench.controls.focal_length_mm > 34.5
    # The ring, the radius, and both drags.
    for focal_length_mm, radius_mm in ((34, 82), (34, 80), (30, 80), (25.4988, 80)):
        assert bench.undo()
        found = bench.controls.camera.lens
        assert found.first_order().effective_focal_length_mm == pytest.approx(focal_length_mm, rel=1e-5)
        assert found.surfaces[0].radius_of_curvature_mm == radius_mm
    for _ in range(4):
        assert bench.redo()
    assert bench.controls.focal_length_mm > 34.5
    bench.turn("zoom", 100)
    assert bench.controls.zoom == "49mm"
    assert not bench.turn("zoom", 1)


def test_the_drawing_and_the_sharp_range_are_of_the_film_that_is_chosen(bench: LensBench) -> None:
    """They ignore the lens's own film: half of a 15 mm diagonal reaches 7.5 mm from the axis, of 90 mm 45 mm."""
    recorder, sharp = BenchRecorder(bench), []
    bench.listeners.sharp_range = lambda found: recorder.take(sharp, found)
    bench.turn("aperture", 9)
    for width, height, half in ((12.0, 9.0, 7.5), (72.0, 54.0, 45.0), (36.0, 24.0, 0.5 * math.hypot(36, 24))):
        asked = len(sharp)
        assert bench.set_film_mm(width, height)
        recorder.until(
            lambda half=half: recorder.lenses and recorder.lenses[-1]["film"][-1][1] == pytest.approx(half, rel=1e-5)
        )
        recorder.until(lambda asked=asked: len(sharp) > asked)
        required = rc.depth_of_field(bench.controls.set_lens, 2 * half / 1500).real
        recorder.until(lambda required=required: sharp[-1] == pytest.approx(required))
        assert bench.controls.lens_on_film.film_mm == (width, height)


def test_what_was_reported_ends_with_the_next_change(bench: LensBench) -> None:
    recorder = BenchRecorder(bench)
    bench.report(Problem("no light reaches the metered point", view="picture"))
    assert recorder.problems[-1] == Problem("no light reaches the metered point", view="picture")
    assert bench.change(iso=200)
    assert recorder.problems[-1] is None
    assert not bench.edit(lambda lens: lens_edits.with_value(lens, 99, "radius_mm", 1.0))
    assert recorder.problems[-1].view == "lens"
    assert not bench.change(focus_m=-1.0)
    assert recorder.problems[-1].view == "picture"


def test_metering_makes_its_point_grey_however_often(bench: LensBench) -> None:
    """Middle grey is 10 lx s over the ISO speed (ISO 12232)."""
    bench.noise_codes = 1.0
    BenchRecorder(bench).until_shown()
    times = []
    for _ in range(3):
        assert bench.meter_at(0.5, 0.5)
        times.append(bench.controls.exposure_time_s)
        image = bench.image()
    assert times == pytest.approx([times[0]] * 3, rel=0.02)
    spot = image.pixels[38:43, 58:63] @ np.array([0.2126, 0.7152, 0.0722])
    assert spot.mean() == pytest.approx(0.1, rel=0.15)


def test_rings_turn_by_thirds_and_stop_at_their_ends(bench: LensBench) -> None:
    bench.turn("aperture", 100)
    assert bench.controls.f_number == 64
    bench.turn("aperture", -100)
    assert bench.controls.camera.lens.first_order().f_number == pytest.approx(2.03, abs=0.01)
    bench.turn("aperture", 6)
    assert bench.controls.f_number == pytest.approx(4)  # 2.03, 2.2, 2.5, 2.8, 3.2, 3.5, 4
    bench.change(iso=100)
    bench.turn("iso", 3)
    assert bench.controls.iso == 200
    bench.change(exposure_time_s=1 / 64)
    bench.turn("shutter", -6)
    assert bench.controls.exposure_time_s == 1 / 256
    with pytest.raises(rc.InputError, match='unknown ring "barrel"'):
        bench.turn("barrel", 1)


IMPOSSIBLE: dict[str, Callable[[LensBench], object]] = {
    "a radius": lambda b: b.edit(lambda lens: lens_edits.with_value(lens, 2, "radius_mm", 1.0)),
    "a stop that is deleted": lambda b: b.edit(lambda lens: lens_edits.without(lens, lens.stop_index)),
    "a glass": lambda b: b.edit(lambda lens: lens_edits.with_value(lens, 0, "glass", "nothing")),
    "a focus": lambda b: b.change(focus_m=0.02),
    "a focus that is none": lambda b: b.change(focus_m=math.nan),
    "an exposure": lambda b: b.change(exposure_time_s=-1.0),
    "a speed": lambda b: b.change(iso=0.0),
    "a model": lambda b: b.change(model="fisheye"),
    "a zoom position": lambda b: b.change(zoom="200mm"),
    "a resolution": lambda b: b.set_resolution(0),
    "a place": lambda b: b.dolly(1e5),
}


def test_what_is_impossible_leaves_all_as_it_was(bench: LensBench) -> None:
    recorder = BenchRecorder(bench)
    assert bench.edit(lambda lens: lens_edits.with_value(lens, 0, "thickness_mm", 3.8))
    for what, action in IMPOSSIBLE.items():
        before = state(bench)
        assert action(bench) is False, what
        assert state(bench) == before, what
        problem = recorder.problems[-1]
        assert problem is not None and problem.message, what
        # The surface to blame is the third.
        assert problem.surface == (2 if what == "a radius" else None) or what in ("a stop that is deleted", "a glass")
        assert ("surface 3" in problem.message) == (what == "a radius")
        assert bench.edit(lambda lens: lens_edits.with_value(lens, 0, "thickness_mm", 3.9))
        assert recorder.problems[-1] is None
        assert bench.undo()
        assert bench.controls.lens == before[1]


def test_an_undo_that_cannot_be_leaves_the_history(bench: LensBench) -> None:
    """A lens that was valid before may be invalid with the camera's present settings."""
    first = bench.controls.lens
    assert bench.edit(lambda lens: lens_edits.with_value(lens, 0, "thickness_mm", 3.9))
    edited = bench.controls.lens
    real = CameraControls.camera.func

    def picky(self: CameraControls) -> rc.Camera:
        if self.lens == first:
            raise rc.InputError("not with this film")
        return real(self)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(CameraControls, "camera", property(picky))
        assert not bench.undo()
        assert (bench.controls.lens, bench.history.now.lens) == (edited, edited)
        assert bench.history.can_undo
    assert bench.undo()
    assert bench.controls.lens == first


def test_automatic_exposure_does_not_undo_what_the_user_does(bench: LensBench) -> None:
    """The picture's thread writes the time that it has metered while the user turns other rings."""
    recorder = BenchRecorder(bench)
    bench.change(is_automatic=True)
    for k in range(60):
        focus = 1.0 + 0.01 * k
        assert bench.change(focus_m=focus)
        time.sleep(0.002)
        assert bench.controls.focus_m == focus
    recorder.until_final()
    assert bench.controls.focus_m == focus
    assert bench.controls.exposure_time_s == recorder.frames[-1][1].exposure_time_s


def test_another_lens_brings_its_film_and_keeps_the_rings(bench: LensBench) -> None:
    bench.change(f_number=5.6)
    assert bench.set_lens(rc.Lens.load("phone-4mm"))
    film = bench.controls.film
    assert film.width_mm < 10
    assert film.resolution[0] == bench_shots.WIDTH
    assert bench.controls.f_number == 5.6
    assert bench.set_lens(rc.Lens.load("macro-105mm"))
    assert bench.controls.focus_m == pytest.approx(bench_shots.MIDDLE_M)
    bench.change(focus_m=0.45)
    assert bench.set_lens(rc.Lens.load("telephoto-200mm-inner-focus"))
    assert bench.controls.focus_m == 2.5  # its nearest


def test_an_edited_lens_comes_back_after_another(bench: LensBench) -> None:
    """Undo restores the edited lens with its film, at the present resolution."""
    assert bench.edit_value(0, "radius_mm", 41.0)
    edited, film = bench.controls.lens, bench.controls.film
    assert bench.set_lens(rc.Lens.load("phone-4mm"))
    phone = bench.controls.mount
    assert bench.set_resolution(2 * bench_shots.WIDTH)
    assert bench.undo()
    assert bench.controls.lens == edited
    assert bench.controls.film.width_mm == film.width_mm
    assert bench.controls.film.resolution == (2 * film.resolution[0], 2 * film.resolution[1])
    assert bench.redo()
    assert bench.controls.lens == phone.lens
    assert bench.controls.film.width_mm == phone.film.width_mm
    assert bench.undo()
    assert bench.undo()
    assert not bench.history.can_undo


@pytest.mark.slow
def test_every_bundled_lens_can_be_put_on_the_camera(bench: LensBench) -> None:
    recorder = BenchRecorder(bench)
    bench.show()
    for name in rc.lens_names():
        assert bench.set_lens(rc.Lens.load(name)), (name, recorder.problems)
        assert math.isfinite(bench.apertures.values[0]), name
        recorder.until(lambda name=name: recorder.lenses and recorder.lenses[-1]["name"] == name)


def test_switches_name_the_effects(bench: LensBench) -> None:
    recorder = BenchRecorder(bench)
    assert bench.switches.as_specs() == []
    bench.show()
    recorder.until(lambda: recorder.plans)  # how the switches stand, where nothing is left to the planner
    bench.switch("dispersion", "on")
    assert bench.switches.as_specs() == ["dispersion"]
    for effect in EFFECTS:
        bench.switch(effect, "auto")
    assert bench.switches.as_specs() == ["auto"]
    bench.switch("dispersion", "off")
    assert bench.switches.as_specs() == ["auto", "-dispersion"]
    with pytest.raises(rc.InputError):
        bench.switch("gravity", "on")


def test_a_second_picture_to_compare_with(bench: LensBench) -> None:
    recorder = BenchRecorder(bench)
    bench.change(f_number=16.0, exposure_time_s=1.2)
    bench.compare("these settings")
    recorder.until_final("b")
    bench.turn("aperture", -100)
    bench.change(exposure_time_s=0.02)
    recorder.until_final()
    assert bench_shots.sharpness(codes(bench))[0] < 25
    image = bench.image("b")
    assert bench_shots.sharpness(rc._core.develop(image.pixels, 100))[0] > 35
    bench.compare("nothing")
    with pytest.raises(rc.InputError):
        bench.compare("elsewhere")


# Files.


def saved_again(bench: LensBench, source: Path, path: Path) -> rc.Shot:
    opened_source, _ = ShotSource.opened(source, "cpu")
    for file, content in saving.shot_contents(opened_source, bench.controls, bench.switches.as_specs(), path).items():
        file.write_bytes(content)
    return rc.Shot.load(path)


def assert_same_camera(one: rc.Camera, other: rc.Camera) -> None:
    assert one.film == other.film
    assert (one.position, one.look_at, one.up) == (other.position, other.look_at, other.up)
    assert (one.exposure_time_s, one.iso, one.model) == (other.exposure_time_s, other.iso, other.model)
    assert one.lens.zoom_position == other.lens.zoom_position
    assert one.lens.first_order().effective_focal_length_mm == pytest.approx(
        other.lens.first_order().effective_focal_length_mm, rel=1e-9
    )
    assert one.lens.focus_distance_m == pytest.approx(other.lens.focus_distance_m, rel=1e-9)
    assert one.lens.film_distance_mm == pytest.approx(other.lens.film_distance_mm, rel=1e-9)
    assert one.lens.stop_semi_diameter_mm == pytest.approx(other.lens.stop_semi_diameter_mm, rel=1e-9)
    for mine, others in zip(one.lens.surfaces, other.lens.surfaces, strict=True):
        assert mine.replace(thickness_mm=0) == others.replace(thickness_mm=0)
        assert mine.thickness_mm == pytest.approx(others.thickness_mm, rel=1e-9)


CHANGES: dict[str, Callable[[LensBench], object]] = {
    "nothing": lambda b: True,
    "the rings": lambda b: b.change(f_number=5.6, focus_m=3.0, exposure_time_s=0.5, iso=400, model="thin"),
    "infinity": lambda b: b.change(focus_m=math.inf),
    "the pose": lambda b: b.orbit(0.1, 0.1) and b.pan(0.1, 0) and b.dolly(1),
    "another lens": lambda b: b.set_lens(rc.Lens.load("tessar-50mm")),
    "a phone": lambda b: b.set_lens(rc.Lens.load("phone-4mm")),
    "a zoom": lambda b: b.set_lens(rc.Lens.load("zoom-70-210mm")) and b.change(zoom="137mm", f_number=8.0),
    "a zoom between positions": lambda b: b.set_lens(rc.Lens.load("zoom-70-210mm")) and b.set_zoom(99.5),
    "a lens of which a group moves": lambda b: b.set_lens(rc.Lens.load("macro-105mm")) and b.change(focus_m=0.45),
    "an edit": lambda b: b.edit(lambda lens: lens_edits.with_value(lens, 0, "radius_mm", 30.0)),
    "an asphere": lambda b: b.edit(lambda lens: lens_edits.with_value(lens, 0, "a4", 1e-7)),
    "a shifted film": lambda b: b.change(film=b.controls.film.replace(shift_mm=(2.0, -1.0))),
    "an effect": lambda b: b.switch("dispersion", "on") or True,
}


@pytest.mark.parametrize("what", CHANGES)
def test_a_saved_shot_is_the_same_camera(
    bench_of: BenchOf, bench: LensBench, shot_path: Path, tmp_path: Path, what: str
) -> None:
    assert CHANGES[what](bench)
    other = tmp_path / "elsewhere"
    other.mkdir()
    again = saved_again(bench, shot_path, other / "saved.toml")
    assert_same_camera(again.camera, bench.controls.camera)
    assert list(again.effects) == bench.switches.as_specs()
    # Saving once more from the saved shot: values do not drift, and no lens is written again.
    twice = saved_again(bench_of(again), other / "saved.toml", other / "twice.toml")
    assert_same_camera(twice.camera, again.camera)


def test_a_shot_is_saved_over_itself(bench: LensBench, shot_path: Path) -> None:
    bench.change(iso=800)
    assert saved_again(bench, shot_path, shot_path).camera.iso == 800


@pytest.mark.parametrize(
    ("lens", "more"),
    [
        ("double-gauss-50mm", "blades = 6\nblade_rotation_deg = 10\n"),
        ("double-gauss-50mm", "blades = 6\nf_number = 4\n"),
        ("double-gauss-50mm", "f_number = 2.8\n"),
        ("zoom-25-50mm", 'zoom = "35mm"\nf_number = 8\n'),
    ],
)
def test_what_a_shot_says_of_its_lens_is_kept(bench_of: BenchOf, tmp_path: Path, lens: str, more: str) -> None:
    """A bundled lens is saved by its name; a lens with another diaphragm is written to a file next to the shot."""
    path = bench_shots.write_panels_shot(tmp_path, lens=lens, more=more)
    shot = rc.Shot.load(path)
    again = saved_again(bench_of(shot), path, tmp_path / "saved.toml")
    assert_same_camera(again.camera, shot.camera)
    assert again.camera.lens.iris_blades == shot.camera.lens.iris_blades
    assert (tmp_path / "saved-lens.toml").exists() == ("blades" in more)


MOVING = """shutter_opens_s = 0.5
[[pose]]
time_s = 0
position_m = [0, 0, 0]
look_at_m = [0, 0, -2]
[[pose]]
time_s = 1
position_m = [2, 0, 0]
look_at_m = [2, 0, -2]
[[key]]
time_s = 0
f_number = 4
[[key]]
time_s = 1
f_number = 16
"""


def test_a_shot_that_moves_is_saved_as_it_is_seen(bench_of: BenchOf, tmp_path: Path) -> None:
    """The bench shows where camera and rings are when the shutter opens: here halfway from key to key."""
    path = bench_shots.write_panels_shot(tmp_path)
    still = re.sub(r"(?m)^(position_m|look_at_m) = .*\n", "", path.read_text())
    path.write_text(still + MOVING)
    bench = bench_of(rc.Shot.load(path))
    pose = bench.controls.pose
    assert (*pose.position_m, *pose.look_at_m, *pose.up) == pytest.approx((1, 0, 0, 1, 0, -2, 0, 1, 0))
    assert bench.controls.camera.shutter_opens_s == 0.5
    assert bench.orbit(0.1, 0.0)
    again = saved_again(bench, path, tmp_path / "saved.toml")
    assert again.camera.position == pytest.approx(bench.controls.pose.position_m, rel=1e-12)
    assert again.camera.lens.first_order().f_number == pytest.approx(8, rel=0.02)  # focused nearer than infinity
    assert again.keys == ()


def test_pictures_of_all_kinds(bench: LensBench, tmp_path: Path) -> None:
    bench.noise_codes = 1.0  # JPEG is no good at noise
    BenchRecorder(bench).until_shown()
    image = bench.image()
    for suffix in saving.PICTURE_SUFFIXES:
        (tmp_path / f"picture{suffix}").write_bytes(saving.picture_content(image, f"x{suffix}", "film"))
    oiio = pytest.importorskip("OpenImageIO")
    png = oiio.ImageBuf(str(tmp_path / "picture.png")).get_pixels(oiio.UINT8)[..., :3]
    assert np.array_equal(png, rc._core.develop(image.pixels, image.camera.iso))
    exr = oiio.ImageBuf(str(tmp_path / "picture.exr")).get_pixels(oiio.FLOAT)[..., :3]
    np.testing.assert_allclose(exr, image.pixels, rtol=1e-3)  # half floats have 11 bits
    rawpy = pytest.importorskip("rawpy")
    with rawpy.imread(str(tmp_path / "picture.dng")) as raw:
        assert raw.raw_image_visible.shape == image.pixels.shape[:2]
    jpeg = oiio.ImageBuf(str(tmp_path / "picture.jpg")).get_pixels(oiio.UINT8)[..., :3]
    assert math.sqrt(np.mean((jpeg.astype(float) - png) ** 2)) < 4
    for name in ("picture.gif", "picture", "picture.png.exe"):
        with pytest.raises(rc.InputError, match=r"expected a .* file whose name ends in"):
            saving.picture_content(image, name, "film")


def test_the_render_settings_of_the_shot_file_are_kept(bench_of: BenchOf, tmp_path: Path) -> None:
    """They are shown, stated in the picture's metadata, and saved."""
    more = 'transport = "whitted"\nclamp_cd_m2 = 40.0\nilluminant = "A"\nmax_bounces = 2\n'
    path = bench_shots.write_panels_shot(tmp_path, more=more)
    path.write_text(path.read_text().replace("effects = []", 'effects = ["dispersion"]'))
    shot = rc.Shot.load(path)
    bench = bench_of(shot, noise_codes=2.0)
    recorder = BenchRecorder(bench).until_shown()
    image = bench.image()
    again = saved_again(bench, path, tmp_path / "saved.toml")
    bench.switch("dispersion", "off")  # to which the illuminant belongs
    recorder.until_final()
    assert bench.problem is None
    assert bench.image().illuminant is None
    assert saved_again(bench, path, tmp_path / "without.toml").illuminant is None
    rendered = shot.render(device="cpu")
    for picture in (image, rendered, again):
        assert (picture.transport, picture.clamp_cd_m2, picture.illuminant) == ("whitted", pytest.approx(40), "A")
    told_of, expected = image.metadata(), rendered.metadata()
    assert told_of.keys() == expected.keys()
    assert {entry for entry in expected if told_of[entry] != expected[entry]} <= {"realcam:spp"}
    # The mean of 9600 pixels, each with a noise of 5%.
    np.testing.assert_allclose(image.pixels.mean(axis=(0, 1)), rendered.pixels.mean(axis=(0, 1)), rtol=5e-3)


def test_clamped_light_is_seen(bench_of: BenchOf, tmp_path: Path) -> None:
    """Light from bounces is cut off at the clamp, as rc.render cuts it."""
    path = bench_shots.write_panels_shot(tmp_path, more="clamp_cd_m2 = 1.0\nmax_bounces = 3\n")
    shot = rc.Shot.load(path)
    bench = bench_of(shot, noise_codes=2.0)
    BenchRecorder(bench).until_shown()
    seen = bench.image().pixels.mean()
    settings = {"spp": 64, "max_bounces": 3, "effects": (), "device": "cpu"}
    means = [rc.render(shot.scene, shot.camera, clamp_cd_m2=c, **settings).pixels.mean() for c in (1.0, 0.0)]
    assert means[0] < 0.98 * means[1]
    assert seen == pytest.approx(means[0], rel=0.01)


def test_a_thickness_is_typed_as_it_is_shown(bench: LensBench) -> None:
    """If focusing has changed the thickness, the lens grows by the typed difference, and the group focuses again."""
    bench.set_lens(rc.Lens.load("telephoto-200mm-inner-focus"))
    bench.change(focus_m=2.5)
    group = [k for k in range(len(bench.controls.body.surfaces)) if abs(bench.controls.focusing_shift_mm(k)) > 1]
    assert group
    for more in (0.0, 0.5):
        before = bench.controls
        shown = before.set_lens.surfaces[group[0]].thickness_mm
        assert bench.edit_value(group[0], "thickness_mm", shown + more)
        lengths = [c.body.film_position_mm for c in (before, bench.controls)]
        assert lengths[1] - lengths[0] == pytest.approx(more, abs=1e-9)


def test_another_copy_is_one_of_the_lens_and_is_undone(bench: LensBench) -> None:
    drawn = bench.controls.lens
    messages.perform({"type": "another_copy", "grade": "precision"}, bench)
    first = bench.controls.lens
    assert first != drawn
    assert bench.another_copy("precision")
    second = bench.controls.lens
    assert bench.undo() and bench.controls.lens == first
    assert bench.another_copy("precision")
    third = bench.controls.lens  # what undo has brought back is a copy, too, and no drawing
    # All copies derive from the lens as designed: errors do not add up beyond the limit of 0.1% of each radius.
    for copy in (first, second, third):
        for surface, before in zip(copy.surfaces, drawn.surfaces, strict=True):
            assert surface.curvature_per_mm == pytest.approx(before.curvature_per_mm, rel=1.01e-3, abs=1e-4)
    assert first != second and first != third and second != third
    assert bench.undo() and bench.controls.lens == first
    assert bench.undo() and bench.controls.lens == drawn
    with pytest.raises(messages.BadMessage, match="commercial, precision, high"):
        messages.perform({"type": "another_copy", "grade": "cheap"}, bench)
