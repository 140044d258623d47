"""The executable, the command of the Python package, and the Python module take the same pictures."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import realcam as rc
from realcam_command import executable

oiio = pytest.importorskip("OpenImageIO")

ROOT = Path(__file__).resolve().parents[2]
pytestmark = pytest.mark.picture_files

CARD = (
    "mtllib card.mtl\nusemtl m\nv -1 -1 -2\nv 1 -1 -2\nv 1 1 -3\nv -1 1 -3\n"
    "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n"
)
SHOTS = {
    "all is chosen": "",
    "an environment and a texture": 'environment = "sky.exr"\ntexture = "rgba.png"\nresolution = [60, 40]\nspp = 3\n',
    "metered with bounces": 'lens = "tessar-50mm"\nf_number = 8\nmax_bounces = 3\nseed = 9\nspp = 2\ntone = "linear"\n',
    "all layers": 'layers = ["all"]\nspp = 2\n',
    "some layers": 'layers = ["object_id", "normal"]\nenvironment_cd_m2 = 3\nspp = 2\n',
    "a shifted film": "film_mm = [24, 16]\nfilm_shift_mm = [3, -2.5]\nfocus_m = 3\nspp = 2\n",
    "another model": 'model = "thick"\nfocus_m = inf\nfilm_mm = [24, 24]\nexposure_time_s = 0.001\niso = 800\n',
}


def run(program: list[object], *words: object, folder: Path) -> subprocess.CompletedProcess[bytes]:
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "python")}
    return subprocess.run([*map(str, program), *map(str, words)], capture_output=True, cwd=folder, env=environment)


PYTHON = [sys.executable, "-m", "realcam"]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "card.obj").write_text(CARD)
    (tmp_path / "card.mtl").write_text("newmtl m\nKd 0.8 0.5 0.2\nKs 0.2 0.2 0.2\nNs 30\n")
    rng = np.random.default_rng(1)
    for name, pixels in {
        "sky.exr": rng.random((8, 16, 3), np.float32) * 100,
        "rgba.png": rng.integers(0, 255, (5, 7, 4), np.uint8, endpoint=True),
    }.items():
        type_name = {"float32": "float", "uint8": "uint8"}[str(pixels.dtype)]
        output = oiio.ImageOutput.create(str(tmp_path / name))
        assert output.open(str(tmp_path / name), oiio.ImageSpec(*pixels.shape[1::-1], pixels.shape[2], type_name))
        assert output.write_image(pixels), output.geterror()
        assert output.close()
    return tmp_path


def content(path: Path) -> bytes:
    """Less the time at which OpenImageIO wrote the file."""
    return re.sub(rb"capDate\0string\0.{4}\d{4}:\d\d:\d\d \d\d:\d\d:\d\d", b"", path.read_bytes(), flags=re.DOTALL)


@pytest.mark.parametrize("name", SHOTS)
def test_a_shot_is_the_same_file_to_the_last_byte(folder: Path, name: str) -> None:
    text = SHOTS[name]
    if "resolution" not in text:
        text += "resolution = [48, 32]\n"
    (folder / "shot.toml").write_text(f'format = 1\nscene = "card.obj"\n{text}')
    made = run([executable()], "render", "shot.toml", "-o", "a.exr", "-o", "a.png", folder=folder)
    assert made.returncode == 0, made.stderr
    made = run(PYTHON, "render", "shot.toml", "-o", "b.exr", "-o", "b.png", folder=folder)
    assert made.returncode == 0, made.stderr
    shot = rc.Shot.load(folder / "shot.toml")
    picture = shot.render()
    picture.save(folder / "c.exr")
    picture.save(folder / "c.png", tone=shot.tone)
    for suffix in (".exr", ".png"):
        first = content(folder / f"a{suffix}")
        assert first == content(folder / f"b{suffix}")
        assert first == content(folder / f"c{suffix}")
    spec = oiio.ImageBuf(str(folder / "a.exr")).spec()
    assert {key: spec.getattribute(key) for key in picture.metadata()} == picture.metadata()


CHANNELS = {
    "normal": ("Normal.X", "Normal.Y", "Normal.Z"),
    "albedo": ("Albedo.R", "Albedo.G", "Albedo.B"),
    "circle_of_confusion_mm": ("CircleOfConfusion",),
    "sample_count": ("SampleCount",),
    "variance": ("Variance.R", "Variance.G", "Variance.B"),
    "depth_middle": ("DepthMiddle.Z",),
    "normal_middle": ("NormalMiddle.X", "NormalMiddle.Y", "NormalMiddle.Z"),
    "object_id": ("ObjectId",),
    "material_id": ("MaterialId",),
    "motion": ("Motion.X", "Motion.Y"),
}


@pytest.mark.parametrize("program", ["executable", "python"])
def test_layers_are_channels_of_the_file(folder: Path, program: str) -> None:
    words = ["render", "card.obj", "-o", "a.exr", "--resolution", "30x20", "--spp", "3", "--layers", "all"]
    words += ["--effects", "none"]
    made = run([executable()] if program == "executable" else PYTHON, *words, folder=folder)
    assert made.returncode == 0, made.stderr
    (folder / "shot.toml").write_text('format = 1\nscene = "card.obj"\nresolution = [30, 20]\nspp = 3\n')
    shot = rc.Shot.load(folder / "shot.toml")
    layers = rc.render(shot.scene, shot.camera, effects=(), spp=3, layers="all").layers
    picture = oiio.ImageInput.open(str(folder / "a.exr"))
    spec = picture.spec()
    assert spec.channelnames[:4] == ("R", "G", "B", "Z")
    assert set(spec.channelnames[4:]) == {name for names in CHANNELS.values() for name in names}
    for layer, names in CHANNELS.items():
        for i, name in enumerate(names):
            at = spec.channelnames.index(name)
            is_number = layers[layer].dtype == np.uint32
            assert spec.channelformat(at) == ("uint" if is_number else "float")
            stored = picture.read_image(0, 0, at, at + 1, "uint" if is_number else "float")[..., 0]
            expected = layers[layer] if len(names) == 1 else layers[layer][..., i]
            np.testing.assert_array_equal(stored, expected, err_msg=name)
    assert json.loads(spec.getattribute("realcam:objects")) == {"1": "static geometry"}
    assert json.loads(spec.getattribute("realcam:materials")) == {"1": "m"}
    assert "CircleOfConfusion: mm on the film" in spec.getattribute("realcam:unit")


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["--layers", "all", "-o", "a.png"], "--layers: layers are written to .exr, and no --output is one"),
        (["--layers", "colour", "-o", "a.exr"], '--layers: unknown layer "colour"; all, or some of depth, normal'),
        (["--layers", "depth,,normal", "-o", "a.exr"], '--layers: unknown layer ""'),
    ],
)
def test_layers_that_cannot_be_written_are_refused(folder: Path, words: list[str], says: str) -> None:
    made = run([executable()], "render", "card.obj", *words, folder=folder)
    assert made.returncode == 2
    assert says in made.stderr.decode()


@pytest.mark.parametrize(
    "words",
    [
        ["lens", "info", "phone-4mm"],
        ["lens", "info", "phone-4mm", "--json", "--focus", "0.5"],
        ["lens", "list"],
        ["lens", "list", "--json"],
        ["lens", "info", "--help"],
        ["render", "--help"],
        ["devices", "--json"],
        ["--version"],
        ["render", "gone.obj", "-o", "x.png"],
        ["render", "card.obj"],
        ["render", "card.obj", "-o", "x.png", "--threads", "-1"],
        ["lens", "info", b"\xff.toml"],
    ],
    ids=str,
)
def test_the_commands_print_the_same(folder: Path, words: list[str | bytes]) -> None:
    text = [os.fsdecode(word) for word in words]
    one, other = run([executable()], *text, folder=folder), run(PYTHON, *text, folder=folder)
    assert (one.returncode, one.stdout, one.stderr) == (other.returncode, other.stdout, other.stderr)
    assert one.stdout + one.stderr


@pytest.mark.parametrize(
    "words",
    [
        ["lens", "draw"],
        ["nonsense"],
        ["bench", "--foo"],
        ["lens", "draw", "x", "--rays", "0"],
        ["lens", "draw", "nope"],
    ],
    ids=str,
)
def test_mistakes_end_in_one_line_of_one_style(folder: Path, words: list[str]) -> None:
    """Also of the commands that are Python."""
    result = run(PYTHON, *words, folder=folder)
    assert result.returncode == 2
    assert result.stdout == b""
    lines = result.stderr.decode().splitlines()
    assert len(lines) == 1
    assert lines[0].startswith("realcam: error: ")
