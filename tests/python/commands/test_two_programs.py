"""The executable, the command of the Python package, and the Python module take the same pictures."""

from __future__ import annotations

import json
import os
import re
import subprocess
from pathlib import Path

import numpy as np
import pytest
import realcam as rc

from ..programs import EXECUTABLE, PYTHON, wants_executable

oiio = pytest.importorskip("OpenImageIO")

ROOT = Path(__file__).resolve().parents[3]
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


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "card.obj").write_text(CARD)
    (tmp_path / "card.mtl").write_text("newmtl m\nKd 0.8 0.5 0.2\nKs 0.2 0.2 0.2\nNs 30\n")
    rng = np.random.default_rng(1)
    for name, pixels in {
        "sky.exr": rng.random((8, 16, 3), np.float32) * 100,
        "rgba.png": rng.integers(0, 255, (5, 7, 4), np.uint8, endpoint=True),
    }.items():
        written(tmp_path / name, pixels)
    return tmp_path


def content(path: Path) -> bytes:
    """Less the time at which OpenImageIO wrote the file."""
    return re.sub(rb"capDate\0string\0.{4}\d{4}:\d\d:\d\d \d\d:\d\d:\d\d", b"", path.read_bytes(), flags=re.DOTALL)


def meaning(path: Path) -> tuple[object, ...]:
    """Size, pixel bytes and metadata of a picture file, without the entries that depend on the OpenImageIO version."""
    picture = oiio.ImageInput.open(str(path))
    spec = picture.spec()
    pixels = {}
    for i, name in enumerate(spec.channelnames):
        # Channels are read in the file's own type, without conversion.
        type_name = str(spec.channelformat(i))
        pixels[name] = (type_name, picture.read_image(0, 0, i, i + 1, type_name).tobytes())
    # These entries differ by library: the time, the name of the colour space, and how rows are packed.
    own = {"DateTime", "oiio:ColorSpace", "openexr:chunkCount", "oiio:RowsPerChunk"}
    says = {entry.name: entry.value for entry in spec.extra_attribs if entry.name not in own}
    return spec.width, spec.height, pixels, says


@pytest.mark.parametrize("name", SHOTS)
def test_a_shot_is_the_same_file_to_the_last_byte(folder: Path, name: str) -> None:
    text = SHOTS[name]
    if "resolution" not in text:
        text += "resolution = [48, 32]\n"
    (folder / "shot.toml").write_text(f'format = 1\nscene = "card.obj"\n{text}')
    made = run(PYTHON, "render", "shot.toml", "-o", "b.exr", "-o", "b.png", folder=folder)
    assert made.returncode == 0, made.stderr
    shot = rc.Shot.load(folder / "shot.toml")
    picture = shot.render()
    picture.save(folder / "c.exr")
    picture.save(folder / "c.png", tone=shot.tone)
    for suffix in (".exr", ".png"):
        assert content(folder / f"b{suffix}") == content(folder / f"c{suffix}")
    spec = oiio.ImageBuf(str(folder / "b.exr")).spec()
    assert {key: spec.getattribute(key) for key in picture.metadata()} == picture.metadata()
    if not EXECUTABLE:
        return
    made = run(EXECUTABLE, "render", "shot.toml", "-o", "a.exr", "-o", "a.png", folder=folder)
    assert made.returncode == 0, made.stderr
    for suffix in (".exr", ".png"):
        assert meaning(folder / f"a{suffix}") == meaning(folder / f"b{suffix}")


def written(path: Path, pixels: np.ndarray, **wishes: object) -> None:
    type_name = {"float32": "float", "uint8": "uint8", "uint16": "uint16"}[str(pixels.dtype)]
    spec = oiio.ImageSpec(*pixels.shape[1::-1], pixels.shape[2], wishes.pop("type", type_name))
    for name in ("x", "y", "full_x", "full_y", "full_width", "full_height", "tile_width", "tile_height"):
        setattr(spec, name, wishes.pop(name, getattr(spec, name)))
    for name, value in wishes.items():
        if isinstance(value, tuple):
            spec.attribute(name.replace("__", ":"), oiio.TypeDesc(f"float[{len(value)}]"), value)
        else:
            spec.attribute(name.replace("__", ":"), value)
    output = oiio.ImageOutput.create(str(path))
    assert output.open(str(path), spec), output.geterror()
    if spec.tile_width > 0:
        assert output.write_image(pixels), output.geterror()
    else:
        assert output.write_scanlines(spec.y, spec.y + spec.height, 0, pixels), output.geterror()
    assert output.close()


STRAIGHT = {"oiio__UnassociatedAlpha": 1}
WINDOWS = {"x": 3, "y": -2, "full_x": 0, "full_y": 0, "full_width": 60, "full_height": 75}
PICTURES: dict[str, tuple[str, int, dict[str, object]]] = {
    "grey with alpha.png": ("uint8", 2, STRAIGHT),
    "16 bits.png": ("uint16", 4, STRAIGHT),
    "colour.jpg": ("uint8", 3, {}),
    "progressive.jpg": ("uint8", 3, {"jpeg__progressive": 1}),
    "alpha.exr": ("float32", 4, {}),
    "half.exr": ("float32", 3, {"type": "half", "compression": "piz"}),
    "tiles.exr": ("float32", 4, {"tile_width": 16, "tile_height": 16}),
    "windows.exr": ("float32", 4, WINDOWS),
    "windows of tiles.exr": ("float32", 3, {**WINDOWS, "tile_width": 16, "tile_height": 16}),
    "primaries.exr": ("float32", 3, {"chromaticities": (0.708, 0.292, 0.17, 0.797, 0.131, 0.046, 0.3127, 0.329)}),
    "round.exr": ("float32", 3, {"textureformat": "LatLong Environment"}),
    "alpha.tif": ("uint8", 4, STRAIGHT),
    "16 bits of tiles.tif": ("uint16", 3, {"tile_width": 16, "tile_height": 32}),
    "floats.tif": ("float32", 3, {"compression": "lzw"}),
    "alpha.tga": ("uint8", 4, STRAIGHT),
    "colour.bmp": ("uint8", 3, {}),
}


@wants_executable
@pytest.mark.parametrize("name", PICTURES)
def test_both_libraries_read_the_same_of_a_picture(folder: Path, name: str) -> None:
    """The picture serves as a texture and as an environment; the rendered pixels agree to the last bit."""
    dtype, channels, wishes = PICTURES[name]
    pixels = np.random.default_rng(7).random((70, 50, channels))
    if dtype != "float32":
        pixels *= np.iinfo(dtype).max
    written(folder / name, pixels.astype(dtype), **wishes)
    (folder / "shot.toml").write_text(
        f'format = 1\nscene = "card.obj"\ntexture = "{name}"\nenvironment = "{name}"\nresolution = [30, 20]\n'
        "spp = 4\neffects = []\n"
    )
    made = run(EXECUTABLE, "render", "shot.toml", "-o", "a.exr", "--device", "cpu", folder=folder)
    assert made.returncode == 0, made.stderr
    # Some random colours of other primaries have no Rec. 709 without a negative number.
    assert b"warning" not in made.stderr or name == "primaries.exr"
    rc.Shot.load(folder / "shot.toml", device="cpu").render(device="cpu").save(folder / "b.exr")
    assert meaning(folder / "a.exr") == meaning(folder / "b.exr")


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
    "position_middle": ("PositionMiddle.X", "PositionMiddle.Y", "PositionMiddle.Z"),
    "traced_light": ("TracedLight.R", "TracedLight.G", "TracedLight.B"),
}


@pytest.mark.parametrize("program", [pytest.param("executable", marks=wants_executable), "python"])
def test_layers_are_channels_of_the_file(folder: Path, program: str) -> None:
    words = ["render", "card.obj", "-o", "a.exr", "--resolution", "30x20", "--spp", "3", "--layers", "all"]
    words += ["--effects", "none"]
    made = run(EXECUTABLE if program == "executable" else PYTHON, *words, folder=folder)
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


@wants_executable
@pytest.mark.parametrize(
    "words",
    [
        "lens info phone-4mm --json --focus 0.5",
        "render --help",
        "devices --json",
        "--version",
        "render gone.obj -o x.png",
        "render x.glb --outptu y.png",
        "lens info \udcff.toml",
    ],
    ids=ascii,
)
def test_the_commands_print_the_same(folder: Path, words: str) -> None:
    one, other = (run(program, *words.split(), folder=folder) for program in (EXECUTABLE, PYTHON))
    assert (one.returncode, one.stdout, one.stderr) == (other.returncode, other.stdout, other.stderr)
    assert one.stdout + one.stderr


@wants_executable
def test_both_list_the_same_lenses(folder: Path) -> None:
    """The executable by name and title alone; a lens file by its path, which is all that it knows of it."""
    rc.Lens.load("tessar-50mm").save(folder / "mine.toml")
    words = ("lens", "list", "--json", "--lens-path", folder)
    one, other = (json.loads(run(program, *words, folder=folder).stdout) for program in (EXECUTABLE, PYTHON))
    assert [row["name"] for row in one] == [row["name"] for row in other] == [*rc.lens_names(), "mine"]
    assert [row["title"] for row in one] == [row["file"] or row["title"] for row in other]
