"""The command line as people write it: units, US spellings, other programs' options, names of bundled shots."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
import realcam as rc
from realcam.cli.command_words import Grammar, in_known_spelling, normalised, plain_number

from ..programs import Command
from .test_command_line import QUAD

pictures = pytest.mark.picture_files
RENDER = Grammar(
    "realcam render",
    {"--focus": "METRES", "--f-number": "N", "--json": "", "-o": "FILE", "--output": "FILE"},
    ["SCENE"],
)


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The current folder, which is empty."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize(
    ("text", "kind", "plain"),
    [
        ("2m", "METRES", "2"),
        ("50cm", "METRES", "0.5"),
        ("1.5 metres", "METRES", "1.5"),
        ("1.5 meters", "METRES", "1.5"),
        ("10ft", "METRES", "3.048"),  # the international foot is 0.3048 m
        ("12in", "METRES", "0.3048"),
        ("0.05 km", "METRES", "50"),
        ("5cm", "MM", "50"),
        ("0.55µm", "NM", "550"),
        ("1/125s", "TIME", "1/125"),
        ("1/125 sec", "TIME", "1/125"),
        ("8ms", "TIME", "0.008"),
        ("2min", "SECONDS", "120"),
        ("1h", "S", "3600"),
        ("45°", "DEGREES", "45"),
        ("f/4", "F_NUMBER", "4"),
        ("F/5.6", "F_NUMBER", "5.6"),
        ("f4", "F_NUMBER", "4"),
        ("1:2.8", "F_NUMBER", "2.8"),
        ("ISO 400", "ISO", "400"),
        ("36x24mm", "WxH", "36x24"),
        ("3.6 x 2.4 cm", "WxH", "36x24"),
        ("960x640px", "PIXELS", "960x640"),
        ("10cm,1m,-20mm", "X,Y,Z", "0.1,1,-0.02"),
        ("486nm,588nm", "NM", "486,588"),
        ("1%", "SHARE", "0.01"),
        ("35-70mm", "MM", "35-70"),
        ("3.5cm - 70mm", "MM", "35-70"),
        ("f/1.4-2.8", "F_NUMBER", "1.4-2.8"),
        ("f/1.4-f/2.8", "F_NUMBER", "1.4-2.8"),
        ("1e-3m", "METRES", "0.001"),
        ("∞", "METRES", "inf"),
        ("1e3mm", "METRES", "1"),
    ],
)
def test_numbers_have_units(text: str, kind: str, plain: str) -> None:
    assert plain_number(text, kind) == plain


@pytest.mark.parametrize(
    ("text", "kind"),
    [
        ("2", "METRES"),
        ("auto", "METRES"),
        ("inf", "METRES"),
        ("2 s", "METRES"),  # a time
        ("50 mm", "TIME"),
        ("5 m", "TIME"),  # metres, or minutes
        ("2m", "FILE"),
        ("36mmx24s", "WxH"),
        ("1e-3", "TIME"),
        ("1-240", "SECONDS"),
        ("-1,-2e-3", "X,Y,Z"),
        ("0.1,.2,+3", "X,Y,Z"),
        ("f/", "F_NUMBER"),
        ("1e999999999m", "METRES"),
        ("four", "F_NUMBER"),
        ("", "METRES"),
    ],
)
def test_all_else_is_left_to_the_parser(text: str, kind: str) -> None:
    assert plain_number(text, kind) == text


def test_words_of_a_command_line() -> None:
    words = "a.glb --focus 2m --f-number=f/4 --json -o 2m --f-number --json -- --focus 3m"
    plain = "a.glb --focus 2 --f-number=4 --json -o 2m --f-number --json -- --focus 3m"
    assert normalised(words.split(), RENDER) == plain.split()


def test_spelling() -> None:
    known = ("radius-colours", "lateral-colour", "glass-catalogue", "optimise", "analyse", "sony-imx071-color")
    for word, listed in {
        "lateral-color": "lateral-colour",
        "radius-colors": "radius-colours",
        "glass-catalog": "glass-catalogue",
        "optimize": "optimise",
        "analyze": "analyse",
        "sony-imx071-colour": "sony-imx071-color",
        "optimise": "optimise",
        "lateral-colr": "lateral-colr",
    }.items():
        assert in_known_spelling(word, known) == listed


@pictures
@pytest.mark.parametrize(
    ("words", "told"),
    [
        ("render demo y.png", 'unexpected argument "y.png" (did you mean "-o y.png"?) (realcam render --help'),
        ("job make demo y.job", 'unexpected argument "y.job" (did you mean "-o y.job"?) (realcam job make --help'),
        ("render y.png -o scene.glb", 'SCENE and --output are swapped (did you mean "scene.glb -o y.png"?)'),
        ("lens draw a.svg -o tessar-50mm", 'LENS and --output are swapped (did you mean "tessar-50mm -o a.svg"?)'),
        ("lens plot tessar-50mm mtf", 'KIND and LENS are swapped (did you mean "mtf tessar-50mm"?)'),
        ("render tessar-50mm -o a.png", 'SCENE: "tessar-50mm" is a lens (did you mean "--lens tessar-50mm"?)'),
        ("devices x.png", 'unexpected argument "x.png" (realcam devices --help'),
        ("render a.glb b.glb", 'unexpected argument "b.glb" (realcam render --help'),
        ("render a.glb tessar-50mm -o a.png", 'unexpected argument "tessar-50mm" (did you mean "--lens tessar-50mm"?)'),
        ("render demo -o a.png --aperture 4", 'unknown option --aperture (did you mean "--f-number"?)'),
        ("lens draw tessar-50mm --aperture=4", 'unknown option --aperture (did you mean "--f-number"?)'),
        ("render demo -o a.png --samples 4", 'unknown option --samples (did you mean "--spp"?)'),
        ("lens tolerance tessar-50mm --samples 4", 'unknown option --samples (did you mean "--copies"?)'),
        ("plan demo --shutter 1/125", 'unknown option --shutter (did you mean "--exposure-time"?)'),
        ("lens info tessar-50mm --shutter 1/125", "unknown option --shutter (realcam lens info --help"),
        ("render demo --outptu y.png", 'unknown option --outptu (did you mean "--output"?)'),
        ("render demo \udcff.png", 'unexpected argument "?.png" (did you mean "-o ?.png"?)'),
        ("render dmo -o a.png", 'no file and no bundled shot is called "dmo" (did you mean "demo"?)'),
        ("render demo -o a.png --focus 2s", '--focus must be a number of metres, inf or auto; it is "2s"'),
    ],
)
def test_mistakes_have_a_hint_in_one_line(words: str, told: str, command: Command, folder: Path) -> None:
    done = command(*words.split())
    assert (done.returncode, done.stdout, done.stderr.count("\n")) == (2, "", 1)
    assert told in done.stderr
    assert not list(folder.iterdir())


@pictures
def test_units_reach_all_commands(command: Command) -> None:
    """Commands in C++ and in Python are compared by the figures that they print."""
    info = command("lens", "info", "tessar-50mm", "--f-number", "f/4", "--focus", "50cm").stdout
    assert info == command("lens", "info", "tessar-50mm", "--f-number", "4", "--focus", "0.5").stdout
    photo = ("lens", "photo", "tessar-50mm", "--f-number")
    written = command(*photo, "F8", "--focus", "2m", "--exposure-time", "1/125s", "--iso", "ISO400").stdout
    assert re.search(r"focus +2 m\n", written) and "f/8" in written
    assert written == command(*photo, "8", "--focus", "2", "--exposure-time", "1/125", "--iso", "400").stdout


@pictures
def test_us_spellings(command: Command) -> None:
    assert command("lens", "plot", "lateral-color", "tessar-50mm", "-o", "a.csv").returncode == 0
    assert command("lens", "draw", "tessar-50mm", "--radius-colors", "-o", "a.svg").returncode == 0
    catalog = command("lens", "info", "tessar-50mm", "--glass-catalog", "gone.agf")  # of a command in C++
    assert catalog.stderr.startswith("realcam: error: gone.agf")
    assert command("lens", "optimize").stderr.startswith("realcam: error: LENS is required")


SMALL = ("--resolution", "48x32", "--spp", "1", "--effects=none", "--device", "cpu")


@pictures
def test_a_bundled_shot_has_a_name(command: Command, folder: Path) -> None:
    done = command("render", "demo", "-o", "a.png", *SMALL, "--quiet")
    assert (done.returncode, done.stderr) == (0, "")
    assert (folder / "a.png").is_file()
    plan = command("plan", "demo", "--resolution", "48x32", "--effects=none", "--device", "cpu", "--json")
    assert plan.returncode == 0, plan.stderr
    shot = rc.Shot.load("demo", device="cpu")
    assert shot.camera.lens.name == "double-gauss-50mm" and shot.max_bounces == 6
    assert rc.Scene.load("demo").triangle_count == shot.scene.triangle_count
    with pytest.raises(rc.ArgumentError, match="load\\(\\) has no argument scal; is scale meant"):
        rc.Scene.load("demo", scal=2)  # type: ignore[call-arg]
    # A file or folder of this name in the current folder takes precedence over the bundled shot, for every loader.
    (folder / "demo").mkdir()
    for refused in (rc.Shot.load, rc.Scene.load):
        with pytest.raises(rc.RealcamError, match="demo"):
            refused("demo")
    assert command("render", "demo", "-o", "a.png", *SMALL).stderr.startswith("realcam: error: demo: ")
    with pytest.raises(rc.RealcamError, match=r'"dem" \(did you mean "demo"\?\)'):
        rc.Scene.load("dem")


@pictures
def test_scenes_stand_where_shots_do(command: Command, folder: Path) -> None:
    """A scene file alone is what a shot file is that names it and nothing else."""
    (folder / "a quad.obj").write_text(QUAD)
    (folder / "shot.toml").write_text('format = 1\nscene = "a quad.obj"\n')
    alone, shot = rc.Shot.load("a quad.obj", device="cpu"), rc.Shot.load("shot.toml", device="cpu")
    assert (alone.camera, alone.settings, alone.tone) == (shot.camera, shot.settings, shot.tone)
    assert alone.scene.triangle_count == shot.scene.triangle_count
    for name in ("gone.obj", "gone.xyz"):
        with pytest.raises(rc.RealcamError, match=f"^{name}: "):
            rc.Shot.load(name)
    sheet = ("compare", "a quad.obj", "--size", "48", "--seconds", "1s", "--device", "cpu", "-o", "a.png")
    done = command(*sheet, "--vary", "f_number=f/4,f/8")
    assert done.returncode == 0 and "f/8" in done.stdout, done.stderr
    assert command("job", "make", "a quad.obj", "-o", "a.job", "--spp", "1").returncode == 0


@pictures
def test_all_pictures_of_a_comparison_have_an_f_number(command: Command) -> None:
    sheet = ("compare", "demo", "--size", "48", "--seconds", "1", "--device", "cpu", "-o", "a.png", "--f-number", "f/4")
    done = command(*sheet, "--vary", "lens=tessar-50mm,heliar-100mm")
    assert done.returncode == 0, done.stderr
    labels = re.findall(r"^(\S+), .* mm, f/([\d.]+), from", done.stdout, re.M)
    assert labels == [("tessar-50mm", "4"), ("heliar-100mm", "4.5")]  # which has no wider opening
    # The exposure equals that of the shot: 0.025 s at f/2.1.
    times_s = [float(text) for text in re.findall(r", ([\d.]+) s,", done.stdout)]
    assert times_s == pytest.approx([0.025 * (n / 2.1) ** 2 for n in (4, 4.5)], rel=0.01)
    assert "--f-number cannot be combined with --vary f_number" in command(*sheet, "--vary", "f_number=2,4").stderr


@pictures
def test_commands_that_take_a_shot_share_its_options(command: Command, folder: Path) -> None:
    (folder / "quad.obj").write_text(QUAD)
    values = {"lens": "tessar-50mm", "focus_m": 2.5, "exposure_time_s": 1 / 60, "spp": 2, "environment_cd_m2": 100}
    words = ["--lens", "tessar-50mm", "--focus", "250cm", "--exposure-time", "1/60s", "--spp", "2"]
    words += ["--environment", "100cd/m2", "--device", "cpu"]
    made = command("job", "make", "quad.obj", "-o", "a.job", *words, "--resolution", "20x10")
    assert made.returncode == 0, made.stderr
    job = rc.Job.load(folder / "a.job")
    job.work()
    image = job.image()
    shot = rc.Shot.load(folder / "quad.obj", resolution=(20, 10), device="cpu", **values)
    assert (image.camera.replace(model=shot.camera.model), image.spp) == (shot.camera, 2)
    compared = command(
        *("compare", "quad.obj", "--vary", "f_number=8", "--size", "20", "--json", "-o", "a.png"), *words
    )
    (picture,) = json.loads(compared.stdout)
    assert (picture["lens"], picture["f_number"], picture["spp"]) == ("tessar-50mm", pytest.approx(8), 2)
    assert picture["focus_m"] == pytest.approx(2.5)
    # The brightness of the shot, which is wide open.
    opened = shot.camera.lens.f_number
    assert picture["exposure_time_s"] == pytest.approx(1 / 60 * (8 / opened) ** 2, rel=1e-6)
