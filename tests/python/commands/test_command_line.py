"""The command line as a stranger meets it: help, mistyped words, figures as JSON, and pictures that show nothing."""

from __future__ import annotations

import json
import math
import os
import re
import shlex
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
import realcam as rc
import typer
from realcam.cli import app as cli
from realcam.cli.examples import EXAMPLES
from realcam.cli.help_texts import finish

from ..programs import PROGRAM

BENCHMARKS = Path(rc.__file__).resolve().parents[2] / "benchmarks"
wants_benchmarks = pytest.mark.skipif(not BENCHMARKS.is_dir(), reason="a wheel comes without the benchmarks")
# The same call as in the script that pip installs.
PYTHON_COMMAND = [sys.executable, "-c", "from realcam_command.main import main; main()"]

TREE = typer.main.get_command(cli.app)
finish(TREE)
IN_CPP = ["render", "plan", "devices", "lens info"]
QUAD = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n"

Said = Callable[[str], tuple[int, str, str]]  # exit code, stdout and stderr

pictures = pytest.mark.picture_files  # a build without picture files has none of these commands


def commands(command: Any = TREE, words: tuple[str, ...] = ()) -> Iterator[str]:
    """Names of all commands written in Python, and of the command groups."""
    name = " ".join(words)
    if name not in IN_CPP:
        yield name
    for word, below in getattr(command, "commands", {}).items():
        yield from commands(below, (*words, word))


def said(words: list[str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> tuple[int, str, str]:
    """Exit code, stdout and stderr of the command line that is Python."""
    monkeypatch.setattr("sys.argv", ["realcam", *words])
    with pytest.raises(SystemExit) as ended:
        cli.run()
    return int(ended.value.code or 0), *capsys.readouterr()


@pytest.fixture
def python(monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]) -> Said:
    """`said` of a command line in one text."""
    return lambda words: said(shlex.split(words), monkeypatch, capfd)


@pytest.fixture
def cpp(capfd: pytest.CaptureFixture[str]) -> Said:
    """Runs a command in C++ within this process, because a process of its own takes a quarter of a second to start."""

    def run_here(words: str) -> tuple[int, str, str]:
        code = rc._core._run_command([os.fsencode(word) for word in shlex.split(words)])  # type: ignore[attr-defined]
        return code, *capfd.readouterr()

    return run_here


def refusal(outcome: tuple[int, str, str]) -> str:
    """The one line that a command which was refused has printed."""
    code, output, errors = outcome
    assert (code, output, errors.count("\n")) == (2, "", 1)
    assert errors.startswith("realcam: error: ")
    return errors


def run(*words: object, folder: Path | None = None) -> subprocess.CompletedProcess[str]:
    return subprocess.run([*PROGRAM, *map(str, words)], capture_output=True, text=True, cwd=folder)


@pytest.mark.parametrize("name", sorted(commands()))
def test_help(name: str, python: Said) -> None:
    code, text, errors = python(f"{name} -h")
    assert (code, errors) == (0, "")
    assert python(f"{name} --help")[1] == text
    assert text.startswith(f"Usage: realcam {name}".rstrip())
    assert "-h, --help" in text
    assert not re.search(r"<\w+(\[|>| range)", text), "a type of Python"
    assert not re.search(r"<=|>=|\d\.0[];]", text), "a range as Python writes it"
    usage, _, rest = text.partition("\n")
    assert not re.search("[{}]", usage)
    assert not re.search(r"\w\.\.\.$", rest, re.M), "a line that was cut off"
    has_examples = name in EXAMPLES
    assert ("\nExamples:\n  realcam " in text) == has_examples
    assert has_examples or name in ("", "lens", "sensor", "calibration")


def test_ranges_in_the_help_are_those_of_people(python: Said) -> None:
    ranges = {"compare": "[480; 8 to 4096]", "cost": "[256; 4 or more]", "job make": "[8; 1 to 100 000]"}
    for name, text in ranges.items():
        assert text in " ".join(python(f"{name} -h")[1].split())


def test_the_help_of_plots_names_all(python: Said) -> None:
    text = python("lens plot -h")[1].partition("KIND: ")[2].partition(".\n")[0]
    assert set(re.findall(r"[a-z]+(?:-[a-z]+)*", text)) - {"over", "the", "film"} == set(rc.analysis.KINDS)


@pictures
@pytest.mark.parametrize("name", IN_CPP)
def test_help_of_what_is_in_cpp(name: str, cpp: Said) -> None:
    code, text, errors = cpp(f"{name} -h")
    assert (code, errors) == (0, "")
    assert cpp(f"{name} --help")[1] == text
    examples = re.findall(rf"(?m)^  realcam ({name}\b.*)$", text.partition("Examples:\n")[2])
    assert examples
    for example in examples:
        for option in re.findall(r"(?<= )--?[a-z][a-z-]*", example):
            assert re.search(rf"(^|[ ,]){option}\b", text, re.M), f"{example}: {option}"


@pytest.mark.parametrize(
    "name, example", [(name, line) for name, lines in EXAMPLES.items() for line in lines if f" {name} " in f"{line} "]
)
def test_examples_are_command_lines(name: str, example: str) -> None:
    words = shlex.split(example)[1:]
    command: Any = TREE
    for word in name.split():
        assert words.pop(0) == word
        command = command.commands[word]
    command.make_context(name, words)  # raises for what the command does not take


@pytest.mark.parametrize(
    "words, meant",
    [
        ("expse film.exr", r'"expse" \(did you mean "expose"\?\) \(realcam --help lists the commands\)'),
        ("lens drow", r'unknown command "drow" \(did you mean "draw"'),
        ("lens draw tessar-50mm --f-numbr 8", r'--f-numbr \(did you mean "--f-number"\?\) \(realcam lens draw --help'),
        ("lens photo tessar-50mm --exposur-time 1/50", 'did you mean "--exposure-time"'),
        ("cost shot.toml --devise cpu", 'did you mean "--device"'),
        ("lens", "a command is missing; .*draw, photo.* are known"),
        ("sensor", "a command is missing; list, info are known"),
        ("lens draw", r"LENS is required \(realcam lens draw --help lists the options"),
        ("bench --threads many", '--threads: "many" is not a whole number'),
        ("lens plot mtf-feild tessar-50mm", r'unknown plot "mtf-feild" \(did you mean "mtf" or "mtf-field"'),
        pytest.param("bench lens-ray", 'or "lens-rays"', marks=wants_benchmarks),
        ("lens list --kind telee", 'unknown kind "telee"'),
        ("lens list --focal wide", '--focal-length: "wide" is not a number or two with a minus between, 35-70'),
        ("lens list --focal 70-35", '--focal-length: "70-35": expected positive numbers, the smaller one first'),
        ("lens list --f-number 0", "--f-number: "),
        ("lens list no-such-lens", "no lens matches; realcam lens list shows all"),
        ("lens list --lens-path nowhere", "--lens-path: nowhere is not a folder"),
        ("lens draw tessar-50mm -o a.svg --theme pink", 'theme "pink" is unknown; expected light or dark'),
        ("lens draw tessar-50mm -o a.svg --states all", "expected one, rows or ghost"),
        ("lens draw tessar-50mm -o a.svg --fields 0,x", '--fields: "x" is not a number'),
        ("lens draw double-gauss-50mm -o a.svg --states ghost", "does not specify a nearest focus"),
        ("lens draw tessar-50mm -o a.svg --states rows --focus 2", "cannot be combined with it"),
        ("lens draw tessar-50mm -o a.svg --wavelengths 5", "between 100 and 20000 nm"),
        ("lens photo tessar-50mm --iso -3", "--iso: expected a positive number"),
        ("lens photo tessar-50mm --exposure-time 1/0", "divides by 0"),
        ("lens photo tessar-50mm --exposure-time x", '--exposure-time: "x" is not a number'),
        ("lens photo tessar-50mm --exposure-time -1", "positive number of seconds"),
        ("lens photo tessar-50mm --circle-of-confusion 0", "circle of confusion must be a positive length"),
        ("lens plot mft tessar-50mm", 'unknown plot "mft"'),
        ("lens plot mtf", "the name of a lens is missing"),
        ("lens plot mtf tessar-50mm -o mtf.txt", r"expected .* \.json or \.csv$"),
        ("lens plot wavefront tessar-50mm --fields-deg 0,5", "shows one field; found 2"),
        ("lens plot mtf tessar-50mm --fields-deg 1,a", '"a" is not a number'),
        ("lens plot mtf tessar-50mm --theme blue", "expected light or dark"),
        ("lens plot mtf tessar-50mm --method fft", "expected diffraction or geometric"),
        (
            "lens plot spot tessar-50mm --method fft",
            "the plot spot takes no --method, only --fields-deg, --wavelengths, --object",
        ),
        ("lens plot depth-of-field tessar-50mm --fields-deg 5", "takes no --fields-deg, only options of the lens"),
        ("lens plot mtf tessar-50mm --frequencies 10,20", "shows one frequency; found 2"),
        ("lens report tessar-50mm -o x.svg", r"expected \.pdf or \.html"),
        ("lens report tessar-50mm --fields-deg 1,2 -o x.pdf", "three fields; found 2"),
        ("lens report tessar-50mm --fields-deg 0,10,70 -o x.pdf", "70"),
        ("lens tolerance tessar-50mm --grade cheap", 'unknown grade "cheap"'),
        ("lens tolerance tessar-50mm --compensate hope", 'unknown compensator "hope"; expected one of refocus'),
        ("lens tolerance tessar-50mm --compensate refocus,nothing", "expected one of refocus, film_tilt$"),
        ("lens tolerance tessar-50mm -o report.doc", r"\.html"),
        ("lens optimise tessar-50mm -o a.toml --vary colours", '--vary: "colours": expected radii, thicknesses'),
        ("lens optimise tessar-50mm -o a.toml --vary radius:x", '"radius:x": expected whole numbers'),
        ("lens optimise tessar-50mm -o a.toml --vary radius:70", "there is no surface 70; the lens has 8"),
        ("lens optimise tessar-50mm -o a.toml --vary radius:0", "there is no surface 0; the lens has 8"),
        ("lens optimise tessar-50mm -o a.toml --vary aspheric:2", "conic:2 or aspheric:2:4"),
        ("lens optimise tessar-50mm -o a.toml --glasses --global 9", "cannot be combined"),
        ("lens optimise tessar-50mm -o a.toml --global 9", "finite bounds"),
    ],
)
def test_mistakes_end_in_one_line(
    words: str, meant: str, python: Said, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    errors = refusal(python(words))
    assert re.search(meant, errors), errors
    assert not list(tmp_path.iterdir()), "nothing half-written"


@pictures
@pytest.mark.parametrize("name", IN_CPP)
def test_help_has_one_form(name: str, python: Said, cpp: Said) -> None:
    """For a command in C++, the help that Python would print is the help that C++ prints, but for option groups."""
    text = python(f"{name} --help")[1]
    printed = cpp(f"{name} --help")[1].partition("\nExamples:\n")[0]

    def paragraphs(page: str) -> list[str]:
        """One for each option, argument and heading; which column texts begin in depends on the names in a group."""
        lines = re.sub(r"\n {4,}", " ", page).replace(" [required]", "").splitlines()
        return sorted({" ".join(line.split()) for line in lines} - {"Camera:", "Scene:", "Picture:", "Video:", ""})

    assert paragraphs(text) == paragraphs(printed)


@pictures
@pytest.mark.parametrize(
    "words",
    [
        "",
        "tessar-50mm more",
        "tessar-50mm --forc",
        "tessar-50mm --json=3",
        "tessar-50mm --focus",
        "tessar-50mm --focus near",
        "tessar-50mm --zoom wide --zoom tele",
        "tesar-50mm",
        "gone.toml",
        "tessar-50mm --zoom wide",
        "tessar-50mm --f-number 1",
    ],
)
def test_mistakes_are_told_in_the_same_words(words: str, python: Said, cpp: Said) -> None:
    """Compares a command in Python with one in C++ that has the same options."""
    errors = refusal(python(f"lens photo {words}"))
    assert errors.replace("lens photo", "lens info") == refusal(cpp(f"lens info {words}"))


def asked_by_bash(typed: str) -> dict[str, str]:
    return {"_REALCAM_COMPLETE": "complete_bash", "COMP_WORDS": typed, "COMP_CWORD": str(typed.count(" "))}


@pytest.mark.parametrize(
    ("typed", "expected"),
    [
        ("realcam re", {"render"}),
        ("realcam lens info tessar", {"tessar-50mm"}),
        ("realcam lens photo tessar-50mm --exp", {"--exposure-time"}),
        ("realcam render scene.glb --lens tessar", {"tessar-50mm"}),
        ("realcam render scene.glb --environment-s", {"--environment-scale"}),
        ("realcam plan shot.toml --device c", {"cpu"}),
        ("realcam expose film.exr --sensor sony-imx071-c", {"sony-imx071-color"}),
        ("realcam render sce", set()),  # bash completes names of files
    ],
)
@pictures
def test_a_shell_completes(typed: str, expected: set[str], python: Said, monkeypatch: pytest.MonkeyPatch) -> None:
    for name, value in asked_by_bash(typed).items():
        monkeypatch.setenv(name, value)
    code, output, errors = python("")
    assert (code, errors) == (0, "")
    assert set(output.split()) - {"cuda", "cuda:0", "cuda:1"} == expected


@pictures
def test_a_shell_completes_the_command_that_pip_installs() -> None:
    asked = asked_by_bash("realcam lens in")
    done = subprocess.run(PYTHON_COMMAND, capture_output=True, text=True, env={**os.environ, **asked})
    assert (done.returncode, done.stderr, done.stdout.split()) == (0, "", ["info"])


def test_bench_says_where_the_benchmarks_are(tmp_path: Path, python: Said, monkeypatch: pytest.MonkeyPatch) -> None:
    # An installed package lies outside of the repository.
    monkeypatch.setattr("realcam.cli.bench.__file__", str(tmp_path / "site-packages/realcam/cli/bench.py"))
    errors = refusal(python("bench frame"))
    assert "source repository" in errors and "./run bench" in errors


@pictures
@pytest.mark.parametrize(
    "words, meant",
    [
        ("render scene.glb -o a.png --exposur-time=1/50", 'option --exposur-time (did you mean "--exposure-time"'),
        # Unknown options are reported even if a required one is missing, too.
        ("render scene.glb --outptu a.png", 'option --outptu (did you mean "--output"'),
        ("render --f-numbr 8", '(did you mean "--f-number"'),
        ("render scene.glb", "--output is required (realcam render --help lists the options)"),
        ("rendr", 'unknown command "rendr" (did you mean "render"'),
        ("lens lst", 'unknown command "lst" (did you mean "list"'),
        ("render quad.obj -o a.png --spp 4 --noise 0.1", 'noise_codes, seconds and max_spp need spp "auto"'),
        ("render quad.obj -o a.png --noise-codes nan", '--noise-codes must be a number; it is "nan"'),
        ("render quad.obj -o a.png --seconds inf", '--seconds must be a number; it is "inf"'),
        ("render quad.obj -o a.png --max-spp 0", "--max-spp must be a whole number from 2 to 16777216"),
        ("render quad.obj -o a.png --quality best", '--quality must be draft, photo or reference; it is "best"'),
        ("render quad.obj -o a.png --layers all", "layers need an .exr file, and no --output is one"),
        (
            "render quad.obj -o a.exr --layers depth,,normal",
            '--layers: unknown layer ""; expected all, or some of depth, normal',
        ),
        # The package has more commands.
        ("lens", "a command is missing; info, list are known (realcam lens --help lists the commands)"),
        ("render scene.glb -o a.png --spp 4 --spp 8", "--spp is specified more than once (realcam render --help"),
        ("render quad.obj -o a.png --spp= --seed 3", "is empty"),
        ("render scene.glb -o a.png --zzzzzzzzzzzzzz", "unknown option --zzzzzzzzzzzzzz (realcam render --help"),
    ],
)
def test_mistyped_words_for_what_is_in_cpp(words: str, meant: str, cpp: Said) -> None:
    assert meant in refusal(cpp(words))


def render(folder: Path, *words: object, scene: str = "quad.obj") -> tuple[dict[str, Any], str]:
    """Renders a small picture. Returns the JSON figures and the text on stderr."""
    (folder / "quad.obj").write_text(QUAD)
    settings = ["--resolution", "48x32", "--device", "cpu", "--effects", "none", "--json"]
    done = run("render", scene, "-o", "a.png", *settings, *words, folder=folder)
    assert done.returncode == 0, done.stderr
    figures: dict[str, Any] = json.loads(done.stdout)
    return figures, done.stderr


@pictures
def test_figures_of_a_picture_as_json(tmp_path: Path) -> None:
    figures, told = render(
        tmp_path, "--spp", 4, "--seed", 3, "--iso", 200, "--f-number", 4, "--focus", 3, "-o", "b.exr"
    )
    assert figures["pictures"] == ["a.png", "b.exr"]
    assert figures["lens"]["name"] == "double-gauss-50mm"
    assert figures["lens"]["f_number"] == pytest.approx(4)
    assert figures["lens"]["focus_distance_m"] == pytest.approx(3)
    assert figures["camera"]["resolution"] == [48, 32]
    assert figures["camera"]["film_mm"] == [36, 24]
    assert (figures["spp"], figures["seed"], figures["noise"]) == (4, 3, None)
    assert figures["exposure"]["iso"] == 200
    assert figures["exposure"]["is_metered"] is True
    # The meter has a picture of its own, with other samples.
    assert figures["exposure"]["stops_above_middle_grey"] == pytest.approx(0, abs=0.3)
    assert figures["has_daylight"] is True
    assert "daylight" in told
    assert figures["effects"] == []
    assert figures["time_s"]["all"] >= figures["time_s"]["picture"] > 0
    assert figures["rays"]["sampled"] >= figures["rays"]["passed"] > 0
    assert "CPU" in figures["device"]
    assert figures["warnings"] == []


@pytest.mark.slow
@pictures
def test_without_a_number_of_samples_the_noise_and_the_time_decide(tmp_path: Path) -> None:
    (tmp_path / "shot.toml").write_text('format = 1\nscene = "quad.obj"\nenvironment_cd_m2 = 100\n')
    (tmp_path / "counted.toml").write_text('format = 1\nscene = "quad.obj"\nenvironment_cd_m2 = 100\nspp = 3\n')

    def figures(scene: str, *words: object) -> tuple[dict[str, Any], str]:
        return render(tmp_path, *words, scene=scene)

    aim = "realcam: samples are taken until the noise is {}; --noise-codes, --seconds or --spp change this\n"
    for scene in ("quad.obj", "shot.toml"):
        image, told = figures(scene)
        assert (image["noise"]["goal"], image["noise"]["unit"]) == (2, "codes")
        assert image["noise"]["is_reached"]
        assert aim.format("2 codes of 255, for 60 s at most") in told
    # A noise goal alone has no time limit; a time limit alone keeps the default noise goal.
    assert aim.format("3 codes of 255") in figures("quad.obj", "--noise-codes", 3)[1]
    assert aim.format("10% of the light, for 9 s at most") in figures("shot.toml", "--noise", 0.1, "--seconds", 9)[1]
    assert aim.format("2 codes of 255, for 9 s at most") in figures("shot.toml", "--seconds", 9)[1]
    # A number of samples is one, wherever it stands.
    for scene, words in (("counted.toml", []), ("shot.toml", ["--spp", 3])):
        image, told = figures(scene, *words)
        assert (image["spp"], image["noise"]) == (3, None)
        assert "samples are taken" not in told


@pictures
def test_noise_and_time_that_are_out_of_reach_end_with_one_line(tmp_path: Path) -> None:
    """The picture is written, and a warning says how far it got."""
    reached, _ = render(tmp_path, "--spp", "auto", "--noise", "0.2", "--environment", "100")
    assert reached["noise"] == {"goal": 0.2, "unit": "share", "is_reached": True, "shortfall": ""}
    for words in (["--noise-codes", 1e-9, "--max-spp", 32], ["--noise-codes", 1e-9, "--seconds", 1e-9]):
        figures, told = render(tmp_path, "--spp", "auto", *words)
        assert figures["noise"]["is_reached"] is False
        assert figures["warnings"] == [figures["noise"]["shortfall"]]
        assert figures["noise"]["shortfall"] in told and told.count("realcam: warning: ") == 1
        assert (tmp_path / "a.png").exists()


@pytest.mark.slow
@pictures
def test_pictures_that_show_nothing_are_told(tmp_path: Path) -> None:
    """The message states the number of stops and the remedy, from the figures of the metered picture."""
    light = ["--spp", 4, "--environment", "100"]
    metered, told = render(tmp_path, *light)
    assert "nearly all" not in told
    time_s = metered["exposure"]["exposure_time_s"]
    for stops, word, expected in (
        (-6, "black", "a higher --iso or a smaller --f-number"),
        (7, "white", "a lower --iso"),
    ):
        figures, told = render(tmp_path, *light, "--exposure-time", time_s * 2**stops)
        [warning] = figures["warnings"]
        assert f"realcam: warning: {warning}\n" in told
        assert f"nearly all {word}, {abs(stops)} stops {'below' if stops < 0 else 'above'} middle grey" in warning
        assert expected in warning
        numerator, _, denominator = re.search(r"auto or about ([\d.]+)(/([\d.]+))?", warning).groups()  # type: ignore[union-attr]
        advised = float(numerator) / float(denominator or 1)
        assert math.log2(advised / time_s) == pytest.approx(0, abs=0.2)
    # Two stops more or less are a matter of taste.
    assert "nearly all" not in render(tmp_path, *light, "--exposure-time", time_s * 4)[1]
    assert "nearly all" not in render(tmp_path, *light, "--exposure-time", time_s / 4)[1]
    dark, told = render(tmp_path, "--spp", 4, "--environment", "0", "--exposure-time", "1")
    assert dark["warnings"] == ["the picture is black: no light reaches the film"]
    assert dark["exposure"]["stops_above_middle_grey"] is None


@pictures
@pytest.mark.slow
def test_a_closed_diaphragm_before_a_fixed_shutter_is_told(tmp_path: Path) -> None:
    """The demo's shutter is right for f/2.1, and f/8 takes four stops of its light."""
    demo = Path(__file__).resolve().parents[3] / "scenes" / "demo.toml"
    small = ["--resolution", "60x40", "--spp", "8", "--effects", "none", "--device", "cpu"]
    for f_number, is_told in ((2.1, False), (4, False), (8, True), (16, True)):
        done = run("render", demo, "-o", "a.png", "--f-number", f_number, *small, folder=tmp_path)
        assert ("nearly all black" in done.stderr) == is_told, done.stderr


@pictures
def test_a_small_lit_thing_before_nothing_is_no_black_picture(tmp_path: Path) -> None:
    (tmp_path / "lamp.mtl").write_text("newmtl lamp\nKd 0 0 0\nKe 100 100 100\n")
    (tmp_path / "lamp.obj").write_text(
        "mtllib lamp.mtl\nusemtl lamp\n" + QUAD.replace("1 ", "0.05 ").replace("f 0.05", "f 1")
    )
    done = run(
        *("render", "lamp.obj", "-o", "a.png", "--position", "0,0,4", "--look-at", "0,0,0", "--effects", "none"),
        *("--resolution", "60x40", "--spp", "4", "--focus", "4", "--device", "cpu"),
        folder=tmp_path,
    )
    assert done.returncode == 0, done.stderr
    assert "nearly all" not in done.stderr


@pytest.mark.parametrize(
    "words",
    [
        "draw tessar-50mm -o a.svg",
        "plot distortion tessar-50mm -o a.svg -o a.csv",
        "convert tessar-50mm -o a.toml",
        "gallery tessar-50mm -o a.svg",
        "compare tessar-50mm sonnar-50mm -o a.svg",
        "photo tessar-50mm",
    ],
)
def test_quiet_commands_say_nothing(words: str, python: Said, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    code, text, errors = python(f"lens {words}")
    written = "".join(f"wrote {file}\n" for file in words.split() if file.startswith("a."))
    assert (code, errors) == (0, "")
    assert text.endswith(written) and (len(text) > len(written)) == words.startswith(("compare", "photo"))
    for option in ("-q", "--quiet"):
        assert python(f"lens {words} {option}") == (0, "", "")


@pytest.mark.slow
@pictures
def test_a_quiet_render_tells_warnings_alone(tmp_path: Path) -> None:
    """Daylight is brought without a word. The shutter of an hour is warned of."""
    (tmp_path / "quad.obj").write_text(QUAD)
    words = ("render", "quad.obj", "-o", "a.png", "--resolution", "20x10", "--spp", "1", "--device", "cpu", "--quiet")
    done = run(*words, folder=tmp_path)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    done = run(*words, "--exposure-time", "3600", folder=tmp_path)
    assert done.stdout == "" and done.stderr.startswith("realcam: warning: "), done.stderr
    assert json.loads(run(*words, "--json", folder=tmp_path).stdout)  # which was asked for


def test_sensors_as_json(python: Said) -> None:
    listed = json.loads(python("sensor list --json")[1])
    assert [sensor["name"] for sensor in listed] == rc.sensor_names()
    sensor = rc.Sensor.load("sony-imx071-color")
    told = json.loads(python(f"sensor info {sensor.name} --json")[1])
    assert told["gain_dn_per_e"] == sensor.gain_dn_per_e
    assert tuple(told["resolution"]) == sensor.resolution
    assert told["iso_range"] == list(sensor.iso_range())
    ideal = json.loads(python("sensor info ideal --json")[1])
    assert ideal["iso_range"] is None  # any
