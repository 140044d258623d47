"""One value says how a picture is taken: for functions, sessions, shot files and the command line alike."""

from __future__ import annotations

import copy
import json
import pickle
import re
import subprocess
from pathlib import Path
from typing import Any

import pytest
import realcam as rc

from ..programs import PROGRAM

DEFAULTS = rc.RenderSettings()
# Each setting occurs at least once with a value other than its default; given as arguments of the constructor.
OTHERS: list[dict[str, Any]] = [
    {"spp": 7, "seed": 2**32 - 1, "max_bounces": 0, "threads": 3},
    {"spp": "auto"},
    {"spp": "auto", "noise": 0.01, "seconds": 2.5},
    {"spp": "auto", "noise_codes": 0.3, "max_spp": 99},
    {"transport": "whitted", "clamp_cd_m2": 0.1, "pupil_sampling": "exit_pupil", "filter": "gaussian"},
    {"layers": ["normal", "depth"]},
    {"layers": "all", "effects": None},
    {"effects": ("auto", "ghosts=1e-8", "-motion_blur"), "quality": "draft"},
    {"effects": {"dispersion"}, "illuminant": [(400, 0.1), (700, 1 / 3)]},
    {"effects": ["coatings", "film_reflection=0.2"], "threshold_px": 0.3, "threshold_codes": 3},
    {"illuminant": 589.3},
]
each = pytest.mark.parametrize("words", OTHERS, ids=str)


@each
def test_it_is_a_value(words: dict[str, Any]) -> None:
    settings = rc.RenderSettings(**words)
    assert settings != DEFAULTS
    assert settings != words
    for same in (
        rc.RenderSettings(**words),
        DEFAULTS.with_(**words),
        settings.with_(),
        copy.deepcopy(settings),
        pickle.loads(pickle.dumps(settings)),
        eval(repr(settings), {"realcam": rc}),
    ):
        assert same == settings
        assert hash(same) == hash(settings)
        assert repr(same) == repr(settings)
    with pytest.raises(AttributeError):
        settings.spp = 3  # type: ignore[misc]


@each
def test_shots_take_the_same_words(words: dict[str, Any], tmp_path: Path) -> None:
    (tmp_path / "quad.obj").write_text("v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n")
    written = {"spp": 5} | {
        key: [] if v is None else sorted(v) if isinstance(v, set) else v for key, v in words.items()
    }
    shot = rc.Shot.load(tmp_path / "quad.obj", exposure_time_s=1, resolution=(6, 4), **written)
    assert shot.settings == rc.RenderSettings(**written)


def test_each_attribute_is_a_key_of_shot_files() -> None:
    attributes = {name for name in vars(rc.RenderSettings) if not name.startswith("_")} - {"with_"}
    assert attributes <= {key.name for key in rc._core._shot_keys()}
    for name in attributes:
        assert getattr(rc.RenderSettings, name).__doc__


def test_one_setting_may_be_written_in_several_ways() -> None:
    assert rc.RenderSettings(effects="coatings", layers="depth") == rc.RenderSettings(
        effects=iter(["coatings"]), layers={"depth"}
    )
    assert rc.RenderSettings(spp="auto", noise_codes=1) == rc.RenderSettings(spp="auto")
    assert rc.RenderSettings(quality="reference") == rc.RenderSettings(threshold_px=0.1, threshold_codes=0.25)
    assert rc.RenderSettings(illuminant=[(400, 1), (700, 2)]) == rc.RenderSettings(illuminant="400:1,700:2")
    assert rc.RenderSettings(effects="ghosts=1e-6").effects == ("ghosts",)
    assert repr(DEFAULTS) == "realcam.RenderSettings()"


def test_a_change_takes_with_it_what_has_no_meaning_any_more() -> None:
    noise = rc.RenderSettings(spp="auto", noise=0.01, seconds=3)
    assert noise.with_(spp=16) == rc.RenderSettings(spp=16)
    assert noise.with_(spp="auto") == noise
    assert noise.with_(noise_codes=2) == rc.RenderSettings(spp="auto", noise_codes=2, seconds=3)
    light = rc.RenderSettings(effects=("dispersion", "coatings"), illuminant="A")
    assert light.with_(effects="diffraction").illuminant == "A"
    assert light.with_(effects="coatings") == rc.RenderSettings(effects="coatings")
    with pytest.raises(rc.InputError, match="illuminant needs one of"):
        light.with_(effects="coatings", illuminant="A")
    with pytest.raises(rc.InputError, match='need spp "auto"'):
        DEFAULTS.with_(noise=0.1)


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ({"max_bounces": "many"}, "max_bounces must be a whole number or \"auto\"; it is 'many'"),
        ({"spp": 1.5}, 'spp must be a whole number or "auto"; it is 1.5'),
        ({"transport": 3}, "transport must be a text; it is 3"),
        ({"noise": [1]}, "noise must be a number or None; it is [1]"),
        ({"sp": 3}, "RenderSettings() has no argument sp; is spp meant?"),
        ({"effects": 5}, "effects must be names (rc.effects() lists them); they are 5"),
        ({"layers": [5]}, "layers must be names"),
        ({"illuminant": [1, 2]}, "illuminant must be a name, a wavelength in nm or (wavelength_nm, power) pairs"),
    ],
)
def test_a_word_that_is_none_is_told(words: dict[str, Any], sentence: str) -> None:
    for call in (rc.RenderSettings, DEFAULTS.with_):
        with pytest.raises(rc.ArgumentError) as error:
            call(**words)
        assert str(error.value).startswith(sentence)


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ({"spp": 0}, "spp must be a whole number from 1 to 16777216, or auto"),
        ({"spp": 1 << 25}, "spp must be a whole number from 1 to 16777216, or auto"),
        ({"max_bounces": 65}, "max_bounces must be a whole number from 0 to 64, or auto"),
        ({"seed": -1}, "seed must be a whole number from 0 to 4294967295"),
        ({"seed": 1 << 32}, "seed must be a whole number from 0 to 4294967295"),
        ({"threads": -1}, "threads must be a whole number from 0 to 4096"),
        ({"threads": 4097}, "threads must be a whole number from 0 to 4096"),
        ({"clamp_cd_m2": float("nan")}, "clamp_cd_m2 must be 0"),
        ({"threshold_px": 0}, "must be above 0"),
        ({"spp": 8, "noise": 0.1}, 'noise, noise_codes, seconds and max_spp need spp "auto"'),
        ({"spp": "auto", "noise": float("nan")}, "noise must be at least 1e-9"),
        ({"spp": "auto", "noise": 1e-300}, "noise must be at least 1e-9"),
        ({"spp": "auto", "noise_codes": float("inf")}, "noise_codes must be"),
        ({"spp": "auto", "noise": 0.1, "noise_codes": 1}, "exclude each other"),
        ({"spp": "auto", "seconds": 0}, "seconds must be above 0"),
        ({"spp": "auto", "max_spp": 1}, "max_spp must be a whole number from 2 to"),
        ({"effects": "sharpness"}, 'unknown effect "sharpness"'),
        ({"pupil_sampling": "iris"}, 'pupil_sampling must be outline, rear_element, exit_pupil or pixel; it is "iris"'),
    ],
)
def test_what_makes_no_sense_is_refused(words: dict[str, Any], sentence: str) -> None:
    with pytest.raises(rc.InputError, match=re.escape(sentence)):
        rc.RenderSettings(**words)


def scene_and_camera() -> tuple[rc.Scene, rc.Camera]:
    scene = rc.Scene.from_arrays([(-1, -1, -2), (1, -1, -2), (0, 1, -2)], [(0, 1, 2)]).with_environment(100)
    return scene, rc.Camera(rc.Lens.load("tessar-50mm"), film=rc.Film(resolution=(6, 4)), exposure_time_s=0.01)


def test_all_that_take_pictures_have_the_same_defaults() -> None:
    scene, camera = scene_and_camera()
    plan = rc.plan(scene, camera, device="cpu")
    plain = DEFAULTS.with_(effects=(), max_bounces=plan.max_bounces)
    assert rc.render(scene, camera, effects=(), device="cpu").settings == plain
    assert rc.Session(scene, camera, effects=(), device="cpu").settings == plain
    live = rc.LiveView(scene, device="cpu").settings  # planning takes longer than a frame
    assert live == DEFAULTS.with_(effects=(), max_bounces=1)
    assert rc.Shot(scene, camera).settings == DEFAULTS
    # Only settings that are "auto" change: to their planned values.
    planned = DEFAULTS.with_(effects=plan.effects, max_bounces=plan.max_bounces)
    assert rc.render(scene, camera, device="cpu").settings == planned
    assert rc.Session(scene, camera, device="cpu").settings == planned


@pytest.mark.pictures
def test_shot_files_and_the_command_line_have_the_same_defaults(tmp_path: Path) -> None:
    (tmp_path / "quad.obj").write_text("v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n")
    (tmp_path / "shot.toml").write_text('format = 1\nscene = "quad.obj"\nresolution = [6, 4]\n')
    shot = rc.Shot.load(tmp_path / "shot.toml", device="cpu")
    # Only the stopping rule differs: shots and the command line stop at a noise goal, functions at a number of samples.
    assert shot.settings == DEFAULTS.with_(spp="auto", noise_codes=2, seconds=60)
    image = shot.render(device="cpu")
    command = [*PROGRAM, "render", "quad.obj", "-o", "a.png", "--json", "--device", "cpu", "--resolution", "6x4"]
    told = json.loads(subprocess.run(command, capture_output=True, check=True, cwd=tmp_path).stdout)
    for name in ("seed", "transport", "clamp_cd_m2"):
        assert told[name] == getattr(DEFAULTS, name), name
    assert told["max_bounces"] == image.settings.max_bounces
    assert (tuple(told["effects"]), told["plan"]) == (image.effects, image.plan)
    assert (told["spp"], told["noise"]["goal"], told["noise"]["unit"]) == (image.spp, 2, "codes")


def test_a_value_and_its_words_make_the_same_picture() -> None:
    scene, camera = scene_and_camera()
    words: dict[str, Any] = {"spp": 3, "seed": 4, "max_bounces": 2, "effects": ("diffraction",), "layers": ("normal",)}
    settings = rc.RenderSettings(**words)
    image = rc.render(scene, camera, settings, device="cpu")
    assert image.settings == settings
    assert image == rc.render(scene, camera, **words, device="cpu")
    assert image == rc.render(scene, camera, settings.with_(seed=9), seed=4, device="cpu")
    assert image == rc.Shot(scene, camera, settings).render(device="cpu")
    session = rc.Session(scene, camera, settings, device="cpu")
    session.add(3)
    assert image == session.image()
    live = rc.LiveView(scene, settings, device="cpu")
    live.shoot(camera, spp=3)
    assert (live.image().pixels == image.pixels).all()
    assert live.image().settings == settings.with_(layers=())
    with pytest.raises(rc.ArgumentError, match="settings must be RenderSettings or None; it is 64"):
        rc.render(scene, camera, 64)  # type: ignore[arg-type]
    with pytest.raises(rc.InputError, match="whole number"):
        live.shoot(camera, spp="auto")


def test_effects_and_devices_are_named_values() -> None:
    ghosts = next(effect for effect in rc.effects() if effect.name == "ghosts")
    assert (ghosts.is_on, ghosts.parameter) == (False, 1e-6)
    assert str(ghosts) == f"ghosts: {ghosts.description}"
    for effect in rc.effects():  # one that is on is named as left out
        named = rc.RenderSettings(effects=("-" if effect.is_on else "") + effect.name)
        assert (named != DEFAULTS.with_(effects=()), named.effects != ()) == (True, True)
    cpu = rc.devices()[0]
    assert (cpu.name, str(cpu)) == ("cpu", f"cpu: {cpu.description}")
