"""The planner: sizes against closed forms, decisions on both sides of their thresholds, and what it refuses."""

from __future__ import annotations

import copy
import json
import re
import warnings
from pathlib import Path

import numpy as np
import pytest
import realcam as rc
from realcam.image_file import read_film

from .. import scenes
from ..programs import Command

WAVELENGTH_MM = 550e-6


def board(distance_m: float, radiance: float = 1.0, half_width: float = 100.0) -> rc.Scene:
    """It fills the picture."""
    return scenes.scene_of(scenes.quad((0, 0, -distance_m), half_width, emission=radiance))


def camera_of(name: str = "double-gauss-50mm", *, film: rc.Film | None = None, **settings: object) -> rc.Camera:
    lens = rc.Lens.load(name)
    f_number = settings.pop("f_number", None)
    focus = settings.pop("focus_m", None)
    if focus is not None:
        lens = lens.focused(focus)  # type: ignore[arg-type]
    if f_number is not None:
        lens = lens.stopped_down(f_number)  # type: ignore[arg-type]
    return rc.Camera(lens, film=film or rc.Film(36, 24, (900, 600)), exposure_time_s=0.01, **settings)  # type: ignore[arg-type]


def decisions(scene: rc.Scene, camera: rc.Camera, **settings: object) -> dict[str, rc.PlanDecision]:
    plan = rc.plan(scene, camera, device="cpu", **settings)  # type: ignore[arg-type]
    return {decision.effect: decision for decision in plan.decisions}


@pytest.mark.parametrize("f_number", [2.8, 8.0, 22.0])
def test_airys_disc_is_1_22_wavelengths_over_the_sine(f_number: float) -> None:
    camera = camera_of(f_number=f_number, film=rc.Film(24, 16, (6000, 4000)))
    airy = decisions(board(1e4), camera)["diffraction"]
    assert airy.size == pytest.approx(2.44 * WAVELENGTH_MM * f_number * 6000 / 24, rel=0.02)
    assert airy.is_kept  # 4 um pixels: 0.94 pixels at f/2.8


def test_a_coarse_film_sees_no_diffraction() -> None:
    assert not decisions(board(1e4), camera_of(f_number=5.6))["diffraction"].is_kept


@pytest.mark.parametrize("distance_m", [1.0, 3.0, 30.0])
def test_defocus_is_the_circle_of_confusion(distance_m: float) -> None:
    camera = camera_of(f_number=8.0, focus_m=2.0)
    first = camera.lens.first_order()
    size = decisions(board(distance_m, radiance=200), camera)["defocus"].size
    # The ideal lens: distances from its front principal plane, which is within millimetres of the front vertex.
    f = first.effective_focal_length_mm
    s, s0 = (1000 * d - camera.lens.film_position_mm for d in (distance_m, 2.0))
    circle = f / first.f_number * abs(s - s0) / s * f / (s0 - f)
    assert size == pytest.approx(circle * 900 / 36, rel=0.1, abs=0.3)  # and what aberrations add, most in the corners


@pytest.mark.parametrize(("f_number", "focus_m", "radiance", "model"), [(11, 30, 200, "pinhole"), (2.1, 1, 1, "thin")])
def test_what_is_sharp_in_a_small_picture_needs_no_lens(
    f_number: float, focus_m: float, radiance: float, model: str
) -> None:
    camera = camera_of(f_number=f_number, focus_m=focus_m, film=rc.Film(3.6, 2.4, (90, 60)))
    plan = rc.plan(board(30.0, radiance=radiance), camera, device="cpu", effects={"-coatings", "-ghosts"})
    assert (plan.model, plan.effects) == (model, [])
    assert {d.effect for d in plan.decisions if d.is_kept} == ({"defocus"} if model == "thin" else set())


def test_colours_of_one_index_fall_together() -> None:
    camera = camera_of("wide-22mm", film=rc.Film(24, 16, (6000, 4000)))
    one = decisions(board(1e4), camera)["dispersion"]
    assert one.size == pytest.approx(0, abs=1e-3)
    assert not one.is_kept
    many = decisions(board(1e4), camera_of("singlet-100mm", film=rc.Film(24, 16, (6000, 4000))))["dispersion"]
    assert many.is_kept


def test_glass_takes_what_its_transmittance_says() -> None:
    camera = camera_of()
    lens = camera.lens.with_coating("bare")
    radiance = 150.0
    scene = board(100.0, radiance=radiance)
    taken = rc.render(scene, camera.replace(lens=lens), effects=(), spp=16, device="cpu")
    value = 0.018 * 100 * float(taken.pixels[300, 450].mean())
    assert 0.1 < value < 1
    transmittance = (lens.first_order().f_number / lens.t_stop) ** 2
    expected = 255 * 1.055 * (value ** (1 / 2.4) - (value * transmittance) ** (1 / 2.4))
    assert decisions(scene, camera.replace(lens=lens))["coatings"].size == pytest.approx(expected, rel=0.03)


@pytest.mark.parametrize("pixels", [0.2, 0.8, 3.0])
def test_motion_is_measured_on_the_film(pixels: float) -> None:
    distance, camera = 10.0, camera_of(focus_m=10.0, f_number=8.0)
    mm_on_film = pixels * 36 / 900
    image = camera.lens.first_order().effective_focal_length_mm * distance / (distance - 0.1)
    speed = mm_on_film / image * distance / camera.exposure_time_s
    there, further = np.eye(4), np.eye(4)
    there[:3, 3] = (0, 0, -distance)
    further[:3, 3] = (speed, 0, -distance)
    still = scenes.scene_of(scenes.quad((0, 0, 1e4), 1.0))
    moving = still.with_instance(scenes.scene_of(scenes.quad((0, 0, 0), 100.0, emission=1.0)), name="board")
    moving = moving.moved("board", [there, further], times_s=[0, 1])
    motion = decisions(moving, camera)["motion_blur"]
    assert motion.size == pytest.approx(pixels, rel=0.05)
    assert motion.is_kept == (pixels > 0.5)


def test_what_is_named_stays() -> None:
    scene, camera = board(1e4), camera_of(f_number=5.6)
    kept = decisions(scene, camera, effects={"auto", "diffraction", "-coatings"})
    assert kept["diffraction"].is_kept
    assert kept["diffraction"].by == "user"
    assert not kept["coatings"].is_kept
    assert kept["coatings"].by == "user"
    assert kept["ghosts"].by == "planner"


def test_a_chosen_model_stays_and_takes_what_it_can() -> None:
    camera = camera_of(f_number=5.6, model="thin", film=rc.Film(3.6, 2.4, (45, 30)))
    camera = camera.replace(lens=camera.lens.with_coating("bare"))
    plan = rc.plan(board(10.0, radiance=150), camera, device="cpu")
    assert plan.model == "thin"
    coatings = next(d for d in plan.decisions if d.effect == "coatings")
    assert coatings.size > 1
    assert not coatings.is_kept
    assert "an ideal lens cannot show it" in coatings.reason
    rc.render(board(10.0, radiance=150), camera, spp=1, device="cpu", effects="auto")


def test_what_nobody_knows_of_the_glass_is_left_to_the_user() -> None:
    camera = camera_of(f_number=8.0, focus_m=5.0)
    scene = board(5.0, radiance=1e-3).with_point_light((0.05, 0.05, -4.9), (100.0, 100.0, 100.0))
    assert camera.lens.unknown_coatings
    ghosts = decisions(scene, camera)["ghosts"]
    assert ghosts.size > 10
    assert not ghosts.is_kept
    assert "does not say how the glass is coated" in ghosts.reason
    assert "ghosts" in rc.plan(scene, camera, device="cpu", effects={"ghosts"}).effects


def test_coloured_ghosts_call_for_dispersion() -> None:
    """Sun in the frame of a coated lens at f/5.6, which calls for diffraction too: ghosts have one colour without
    dispersion, and differ by more than a code with it. A lens whose glasses have one index has ghosts of one colour."""
    scene = scenes.scene_of(scenes.quad((0, 0, -50), 4.0, diffuse=0.02)).with_sun((-0.15, -0.1, 1.0), (8e4, 8e4, 8e4))
    sunny = {"exposure_time_s": 1 / 2000, "iso": 100}
    fisheye = rc.Lens.load("fisheye-10mm").with_coating("bare").stopped_down(8)
    of_one_index = decisions(scene, rc.Camera(fisheye, film=rc.Film(23.5, 15.6, (240, 160)), **sunny))
    assert of_one_index["ghosts"].is_kept
    assert of_one_index["dispersion"].size == pytest.approx(0, abs=1e-3)
    lens = rc.Lens.load("double-gauss-50mm").focused(10.0).stopped_down(5.6).with_coating("quarter_wave")
    camera = rc.Camera(lens, film=rc.Film(36, 24, (240, 160)), **sunny)
    of = decisions(scene, camera)
    assert of["ghosts"].is_kept
    assert of["dispersion"].unit == "codes"
    assert of["dispersion"].size > 1
    assert of["dispersion"].is_kept
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        pictures = [
            rc.render(scene, camera, spp=64, device="cpu", effects={"ghosts", "coatings", *more}, seed=seed)
            for more, seed in (((), 0), (("dispersion",), 0))
        ]
    one, many = (picture.developed().astype(float).reshape(20, 8, 30, 8, 3).mean(axis=(1, 3)) for picture in pictures)
    colour = np.abs(many - one).max()
    assert colour > 1, "the picture shows it"


@pytest.mark.slow
def test_times_are_measured_where_they_are_asked_for() -> None:
    camera = camera_of(film=rc.Film(3.6, 2.4, (45, 30)))
    scene = board(10.0, radiance=150)
    assert all(d.time_share is None for d in decisions(scene, camera).values())
    measured = {name for name, d in decisions(scene, camera, times=True).items() if d.time_share is not None}
    assert measured == {"coatings", "ghosts", "diffraction", "dispersion", "bounces"}
    assert all((d.time_share or 0) >= 0 for d in decisions(scene, camera, times=True).values())


def test_where_there_is_nothing_to_plan_the_picture_is_taken() -> None:
    camera = camera_of(film=rc.Film(3.6, 2.4, (45, 30)))
    triangle = np.array([[0.0, 0.0, 1e5], [1.0, 0.0, 1e5], [0.0, 1.0, 1e5]])
    behind = rc.Scene.from_arrays(triangle, [[0, 1, 2]])
    with pytest.raises(rc.NothingToPlan):
        rc.plan(behind, camera, device="cpu")
    with pytest.warns(UserWarning, match="nothing to plan"):
        picture = rc.render(behind, camera, spp=1, device="cpu")
    assert (picture.effects, picture.plan) == ((), "")
    assert picture.camera.model == "full"


def test_qualities_are_thresholds() -> None:
    scene, camera = board(1e4), camera_of(f_number=5.6)
    for quality, pixels, codes in (("draft", 2.0, 4.0), ("photo", 0.5, 1.0), ("reference", 0.1, 0.25)):
        of = decisions(scene, camera, quality=quality)
        assert (of["defocus"].threshold, of["coatings"].threshold) == (pixels, codes)
    of = decisions(scene, camera, threshold_px=0.01)
    assert of["diffraction"].is_kept
    assert of["coatings"].threshold == 1


def test_an_automatic_picture_is_that_of_its_plan_and_says_so(tmp_path: Path) -> None:
    scene, camera = board(3.0), camera_of(f_number=2.1, focus_m=1.0, film=rc.Film(3.6, 2.4, (45, 30)))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        plan = rc.plan(scene, camera, device="cpu")
        automatic = rc.render(scene, camera, spp=4, device="cpu", effects="auto")
        named = rc.render(scene, camera.replace(model=plan.model), spp=4, device="cpu", effects=plan.effects)
    np.testing.assert_array_equal(automatic.pixels, named.pixels)
    assert list(automatic.effects) == plan.effects
    assert automatic.metadata()["realcam:plan"] == automatic.plan == plan.summary
    automatic.save(tmp_path / "picture.exr")
    written = read_film(tmp_path / "picture.exr")[1]
    # All that the file says, but for the version of the library that wrote it.
    assert {name: written[name] for name in automatic.metadata()} == automatic.metadata()
    assert "realcam:plan" not in rc.render(scene, camera, effects=(), max_bounces=1, spp=1, device="cpu").metadata()


def test_a_plan_is_a_value() -> None:
    plan = rc.plan(board(3.0), camera_of(), device="cpu")
    assert copy.deepcopy(plan) == plan
    assert str(plan).startswith(f"camera model {plan.model}, max_bounces {plan.max_bounces}\n")
    for decision in plan.decisions:
        assert decision.effect in str(plan)
        assert decision.reason in str(plan)


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"threshold_px": 0.0}, "above 0"),
        ({"threshold_codes": float("nan")}, "above 0"),
        ({"quality": "best"}, 'quality must be draft, photo or reference; it is "best"'),
        ({"effects": {"ghosts", "-ghosts"}}, "both named and left out"),
        ({"distance_m": -10}, "sees no object and no light"),
    ],
)
def test_what_cannot_be_planned_is_said(settings: dict[str, object], message: str) -> None:
    distance_m = settings.pop("distance_m", 3.0)
    with pytest.raises(rc.InputError, match=message):
        rc.plan(board(distance_m), camera_of(), device="cpu", **settings)  # type: ignore[arg-type]


def test_live_views_want_names() -> None:
    camera = camera_of(film=rc.Film(3.6, 2.4, (6, 4)))
    with pytest.raises(rc.InputError, match='"auto" is for pictures that are planned first'):
        rc.LiveView(board(3.0), device="cpu").shoot(camera, effects=["auto"])


def test_a_lamp_behind_an_object_makes_neither_ghosts_nor_stars() -> None:
    lamp, camera = (0.05, 0.05, -4.9), camera_of(f_number=8.0, focus_m=5.0)
    camera = camera.replace(lens=camera.lens.with_coating("bare"))
    dark = board(5.0, radiance=1e-3)
    for place, is_seen in ((lamp, True), ((lamp[0], lamp[1], -5.1), False)):
        of = decisions(dark.with_point_light(place, (100.0, 100.0, 100.0)), camera)
        assert of["ghosts"].is_kept == is_seen
        assert of["diffraction"].is_kept == is_seen


@pytest.fixture
def shot_file(tmp_path: Path) -> Path:
    """A quad in an .obj, and a shot of it."""
    corners = scenes.quad((0, 0, -3), 100.0)[0]
    lines = [f"v {x} {y} {z}" for x, y, z in corners] + ["f 1 2 3", "f 1 3 4"]
    (tmp_path / "board.obj").write_text("\n".join(lines) + "\n")
    text = 'format = 1\nscene = "board.obj"\nenvironment_cd_m2 = 100\nfocus_m = 1\nresolution = [45, 30]\n'
    (tmp_path / "shot.toml").write_text(text + "film_mm = [3.6, 2.4]\nposition_m = [0, 0, 0]\nlook_at_m = [0, 0, -1]\n")
    return tmp_path / "shot.toml"


def test_both_programs_plan_alike(shot_file: Path, command: Command) -> None:
    printed = command("plan", str(shot_file), "--device", "cpu", "--json")
    assert printed.returncode == 0, printed.stderr
    told = json.loads(printed.stdout)
    shot = rc.Shot.load(shot_file, device="cpu")
    plan = rc.plan(shot.scene, shot.camera, device="cpu")
    assert (told["model"], told["effects"]) == (plan.model, plan.effects)
    assert [d["effect"] for d in told["decisions"]] == [d.effect for d in plan.decisions]
    np.testing.assert_allclose([d["size"] for d in told["decisions"]], [d.size for d in plan.decisions], rtol=1e-5)
    # The command measures times, which are never the same twice.
    printed = command("plan", str(shot_file), "--device", "cpu").stdout
    without_times = re.sub(r"(  left out|  kept) *\+[0-9.e+]+%", r"\1", printed)
    assert re.sub(" +", " ", without_times).replace(" time ", " ") == re.sub(" +", " ", str(plan)).replace(
        " time ", " "
    )


def test_shot_files_may_ask_for_a_plan(shot_file: Path) -> None:
    shot_file.write_text(shot_file.read_text() + 'effects = ["auto", "-coatings"]\n')
    shot = rc.Shot.load(shot_file, device="cpu")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        picture = shot.render(device="cpu")
    assert "coatings" not in picture.effects
    assert "coatings" in picture.plan


def test_explanations_are_printed_and_kept(shot_file: Path, tmp_path: Path, command: Command) -> None:
    out = tmp_path / "picture.exr"
    words = ["--device", "cpu", "--effects", "auto", "--explain", "--spp", "1", "-o", str(out)]
    printed = command("render", str(shot_file), *words)
    assert printed.returncode == 0, printed.stderr
    shot = rc.Shot.load(shot_file, device="cpu")
    plan = rc.plan(shot.scene, shot.camera, device="cpu")
    assert printed.stdout.startswith(str(plan))
    assert read_film(out)[1]["realcam:plan"] == plan.summary


def test_an_unknown_quality_is_said(shot_file: Path, command: Command) -> None:
    printed = command("plan", str(shot_file), "--quality", "best")
    assert printed.returncode == 2
    assert printed.stderr == 'realcam: error: --quality must be draft, photo or reference; it is "best"\n'


@pytest.mark.parametrize(
    "name",
    [
        "off-axis-500mm",
        pytest.param(
            "schmidt-225mm",
            marks=pytest.mark.xfail(
                strict=True, reason="the first-order data of ghosts need a film behind the mirrors"
            ),
        ),
    ],
)
def test_a_film_before_a_single_mirror_can_be_planned(name: str) -> None:
    lens = rc.Lens.load(name)
    plan = rc.plan(board(30.0), rc.Camera(lens, film=rc.Film(*lens.film_mm, (24, 16))), device="cpu")
    assert plan.model == "full"  # a thin lens does not mirror the picture
