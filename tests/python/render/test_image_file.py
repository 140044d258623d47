"""Pictures on disk: what is in them, and nothing half-written."""

from __future__ import annotations

import os
import signal
import struct
import subprocess
import sys
import time
import zlib
from pathlib import Path

import numpy as np
import pytest
import realcam as rc

from .. import scenes
from ..sky_files import write_exr_parts

oiio = pytest.importorskip("OpenImageIO")

pytestmark = pytest.mark.picture_files
ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture(scope="module")
def image() -> rc.Image:
    lens = rc.Lens.load("double-gauss-50mm").focused(2.5).stopped_down(5.6)
    camera = rc.Camera(lens, film=rc.Film(12, 9, (16, 12)), exposure_time_s=1 / 60, iso=400)
    # The upper half of the picture is red, the lower half blue, and the sides are black.
    upper = scenes.quad((0, 0.25, -2.5), 0.2, 0.25, emission=(300, 10, 0))
    lower = scenes.quad((0, -0.25, -2.5), 0.2, 0.25, emission=(0, 10, 300))
    return rc.render(scenes.scene_of(upper, lower), camera, effects=(), spp=4, seed=11)


def read(path: Path) -> tuple[np.ndarray, oiio.ImageSpec]:
    buffer = oiio.ImageBuf(str(path))
    assert not buffer.has_error, buffer.geterror()
    return buffer.get_pixels(buffer.spec().format), buffer.spec()


def test_exr_holds_exposure_and_depth_to_the_bit(image: rc.Image, tmp_path: Path) -> None:
    path = tmp_path / "picture.exr"
    image.save(path)
    pixels, spec = read(path)
    assert tuple(spec.channelnames) == ("R", "G", "B", "Z")
    assert spec.format == oiio.FLOAT
    np.testing.assert_array_equal(pixels[..., :3], image.pixels)
    np.testing.assert_array_equal(pixels[..., 3], image.depth)
    assert np.isinf(image.depth).any()
    assert list(tmp_path.iterdir()) == [path]


def test_developed_pictures_have_four_formats(image: rc.Image, tmp_path: Path) -> None:
    codes = image.developed("film").astype(int)
    for suffix, most_codes in ((".PNG", 0), (".tif", 0), (".TIFF", 0), (".webp", 0), (".jpg", 40), (".jpeg", 40)):
        path = tmp_path / f"picture{suffix}"
        image.save(path)
        pixels, spec = read(path)
        assert (spec.format, spec.nchannels) == (oiio.UINT8, 3)
        assert np.abs(pixels.astype(int) - codes).max() <= most_codes, suffix  # small sharp patches, as JPEG has them
        if suffix != ".webp":
            told = str(spec.getattribute("ImageDescription" if suffix != ".PNG" else "realcam:lens"))
            assert "double-gauss-50mm" in told
    image.save(str(tmp_path / "linear.png"), tone="linear")
    pixels, _ = read(tmp_path / "linear.png")
    np.testing.assert_array_equal(pixels, image.developed("linear"))
    # Row 0 is the top: red above, blue below.
    assert pixels[2, 8, 0] > pixels[2, 8, 2]
    assert pixels[9, 8, 2] > pixels[9, 8, 0]


@pytest.mark.parametrize("suffix", [".exr", ".png"])
def test_metadata_can_be_read_back(image: rc.Image, tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"picture{suffix}"
    image.save(path)
    spec = read(path)[1]

    def value(name: str) -> float:
        return float(spec.getattribute(name))

    assert spec.getattribute("realcam:lens") == "double-gauss-50mm"
    assert spec.getattribute("realcam:model") == "full"
    assert spec.getattribute("realcam:version") == rc.__version__
    # Nine digits in text.
    assert value("realcam:f_number") == pytest.approx(5.6, rel=1e-8)
    assert value("realcam:focus_distance_m") == pytest.approx(2.5, rel=1e-8)
    assert value("realcam:exposure_time_s") == pytest.approx(1 / 60, rel=1e-8)
    assert value("realcam:iso") == 400
    assert value("realcam:seed") == 11
    assert value("realcam:spp") == 4
    assert "realcam" in spec.getattribute("Software")
    if suffix == ".png":
        return
    # Standard tags that other programs read.
    assert value("ExposureTime") == pytest.approx(1 / 60, rel=1e-4)
    assert value("FNumber") == pytest.approx(5.6, rel=1e-4)
    assert value("isoSpeed") == 400
    assert value("focus") == pytest.approx(2.5)
    assert value("effectiveFocalLength") == pytest.approx(value("realcam:focal_length_mm"), rel=1e-6)
    assert spec.getattribute("lensModel") == "double-gauss-50mm"
    assert tuple(spec.getattribute("sensorOverallDimensions")) == (12, 9)


@pytest.mark.parametrize("suffix", [".EXR", ".png"])
def test_focus_at_infinity_is_written_too(tmp_path: Path, suffix: str) -> None:
    lens = rc.Lens.load("tessar-50mm").focused(float("inf"))
    picture = rc.render(scenes.sky(), rc.Camera(lens, film=rc.Film(4, 4, (2, 2)), iso=3200), effects=(), spp=1)
    path = tmp_path / f"x{suffix}"
    picture.save(path)
    assert float(read(path)[1].getattribute("realcam:focus_distance_m")) == float("inf")


@pytest.mark.parametrize(
    ("name", "why"),
    [
        *((name, r"\.png, \.jpg, .*\.exr") for name in ("picture.gif", "picture", "picture.exr.bak", ".png")),
        ("nowhere/picture.png", r'picture\.png.*nowhere" does not exist'),
        ("folder.png", "is a folder"),
        ("pipe.png", "is a pipe or a device"),
        ("/proc/picture.png", r"^/proc/picture\.png: cannot be written"),  # refuses everybody, root too
        ("x" * 252 + ".png", "File name too long"),
    ],
)
def test_a_name_that_cannot_be_written_is_told_why(image: rc.Image, tmp_path: Path, name: str, why: str) -> None:
    (tmp_path / "folder.png").mkdir()
    os.mkfifo(tmp_path / "pipe.png")
    with pytest.raises(rc.ImageFileError, match=why):
        image.save(tmp_path / name)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["folder.png", "pipe.png"]


TAKE = """
import sys, numpy as np, realcam as rc
from tests.python import scenes
picture = rc.render(scenes.sky(), rc.Camera(rc.Lens.load("tessar-50mm"), film=rc.Film(36, 24, {size})), spp=1)
"""


@pytest.mark.parametrize("suffix", [".exr", ".png"])
def test_a_limit_on_file_sizes_leaves_the_old_file(tmp_path: Path, suffix: str) -> None:
    """A limit acts like a full disk: the old file stays, no other file appears, and the message gives the reason."""
    path = tmp_path / f"picture{suffix}"
    path.write_bytes(b"the old one")
    limit = """
import resource, signal
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))
try:
    picture.save(sys.argv[1])
except rc.ImageFileError as error:
    print(error)
"""
    run = subprocess.run(
        [sys.executable, "-c", TAKE.format(size=(300, 200)) + limit, path], capture_output=True, text=True, cwd=ROOT
    )
    assert "picture" + suffix + ": cannot be written: the disk is full, or a limit" in run.stdout, run.stderr
    assert path.read_bytes() == b"the old one"
    assert [p.name for p in tmp_path.iterdir()] == [path.name]


@pytest.mark.slow
@pytest.mark.parametrize("by", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
@pytest.mark.parametrize("suffix", [".exr", ".png"])
def test_a_signal_while_a_picture_is_written_leaves_nothing(tmp_path: Path, suffix: str, by: signal.Signals) -> None:
    path = tmp_path / f"picture{suffix}"
    # Noise takes seconds to compress.
    save = """
rng = np.random.default_rng(1)
object.__setattr__(picture, "pixels", rng.random((3000, 4000, 3), dtype=np.float32))
object.__setattr__(picture, "depth", rng.random((3000, 4000), dtype=np.float32))
print("saving", flush=True)
picture.save(sys.argv[1])
"""
    program = TAKE.format(size=(2, 2)) + save
    with subprocess.Popen(
        [sys.executable, "-c", program, str(path)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, cwd=ROOT
    ) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == b"saving\n"
        time.sleep(0.3)
        process.send_signal(by)
        process.communicate(timeout=20)
        assert process.returncode != 0
    assert list(tmp_path.iterdir()) == []


def test_a_symbolic_link_is_followed(image: rc.Image, tmp_path: Path) -> None:
    (tmp_path / "pictures").mkdir()
    target, link = tmp_path / "pictures" / "one.png", tmp_path / "link.png"
    link.symlink_to("pictures/one.png")
    for _ in range(2):  # it points nowhere at first
        image.save(link)
        assert link.is_symlink()
        assert read(target)[1].nchannels == 3
    assert sorted(p.name for p in tmp_path.rglob("*")) == ["link.png", "one.png", "pictures"]


def test_names_that_are_no_utf8(image: rc.Image, tmp_path: Path) -> None:
    path = os.fsdecode(os.fsencode(tmp_path) + b"/\xff\xfe.png")
    image.save(path)
    assert [os.fsencode(p.name) for p in tmp_path.iterdir()] == [b"\xff\xfe.png"]
    with pytest.raises(rc.ImageFileError, match="does not exist"):
        image.save(os.fsdecode(os.fsencode(tmp_path) + b"/\xff/x.png"))


def test_a_new_file_has_the_mode_of_the_umask_and_one_that_is_replaced_its_own(image: rc.Image, tmp_path: Path) -> None:
    new, private = tmp_path / "picture.png", tmp_path / "private.exr"
    private.write_text("private")
    private.chmod(0o600)
    before = os.umask(0o027)
    try:
        image.save(new)
        image.save(private)
    finally:
        os.umask(before)
    assert new.stat().st_mode & 0o777 == 0o640
    assert private.stat().st_mode & 0o777 == 0o600


def test_unknown_tone_curve(image: rc.Image, tmp_path: Path) -> None:
    with pytest.raises(rc.InputError, match="film or linear"):
        image.save(tmp_path / "picture.png", tone="sepia")
    assert list(tmp_path.iterdir()) == []


def write(path: Path, pixels: np.ndarray, **attributes: object) -> None:
    """Writes a picture with OpenImageIO instead of realcam."""
    spec = oiio.ImageSpec(pixels.shape[1], pixels.shape[0], pixels.shape[2], str(pixels.dtype))
    if pixels.shape[2] == 4:
        spec.alpha_channel = 3
    for name, value in attributes.items():
        spec.attribute(name, value)
    output = oiio.ImageOutput.create(str(path))
    assert output.open(str(path), spec), output.geterror()
    assert output.write_image(pixels), output.geterror()
    assert output.close()


def srgb_to_linear(v: np.ndarray) -> np.ndarray:
    return np.where(v <= 0.04045, v / 12.92, ((v + 0.055) / 1.055) ** 2.4)  # IEC 61966-2-1


def test_an_environment_image_is_read_as_light(tmp_path: Path) -> None:
    light = np.array([[[0.25, 5.0, 100.0], [0, 1, 2]]], np.float32)
    write(tmp_path / "sky.exr", light)
    np.testing.assert_array_equal(rc.read_environment(tmp_path / "sky.exr"), light)
    # 8 bits of mantissa under the largest of the three.
    write(tmp_path / "sky.hdr", light)
    np.testing.assert_allclose(rc.read_environment(tmp_path / "sky.hdr"), light, atol=100 / 256)
    for kind, most in ((np.uint8, 255), (np.uint16, 65535)):
        codes = (np.array([[[0, 0.463, 1], [0.04, 0.737, 0.251]]]) * most).astype(kind)
        write(tmp_path / "sky.png", codes)
        np.testing.assert_allclose(
            rc.read_environment(tmp_path / "sky.png"), srgb_to_linear(codes / most), rtol=1e-5, atol=1e-9
        )
    grey = np.array([[[0.5], [2.0]]], np.float32)
    write(tmp_path / "grey.exr", grey)
    np.testing.assert_array_equal(rc.read_environment(tmp_path / "grey.exr"), grey.repeat(3, axis=2))


def test_a_scene_takes_an_environment_from_a_file(tmp_path: Path) -> None:
    light = np.full((4, 8, 3), 7, np.float32)
    write(tmp_path / "sky.exr", light)
    camera = scenes.pinhole()
    from_file = rc.render(scenes.sky(0.0).with_environment(tmp_path / "sky.exr"), camera, effects=(), spp=1)
    np.testing.assert_array_equal(from_file.pixels, rc.render(scenes.sky(7.0), camera, effects=(), spp=1).pixels)


def test_what_is_no_environment(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    write(tmp_path / "sky.exr", np.ones((8, 16, 3), np.float32))
    write(tmp_path / "sky.png", np.ones((8, 16, 3), np.uint8))
    os.mkfifo(tmp_path / "pipe.exr")
    (tmp_path / "folder.exr").mkdir()
    (tmp_path / "text.exr").write_bytes(b"not an image")
    (tmp_path / "empty.hdr").write_bytes(b"")
    for name in ("sky.exr", "sky.png"):
        whole = (tmp_path / name).read_bytes()
        (tmp_path / f"cut-{name}").write_bytes(whole[: len(whole) // 2])
    for name, why in {
        "nowhere.exr": "no such file",
        "pipe.exr": "pipe",
        "folder.exr": "folder",
        "text.exr": "is not a picture",
        "empty.hdr": "is not a picture",
        "cut-sky.exr": "broken or incomplete",
        "cut-sky.png": "broken or incomplete",
    }.items():
        with pytest.raises(rc.ImageFileError, match=f"{name}: .*{why}") as error:
            rc.read_environment(tmp_path / name)
        assert "\n" not in str(error.value)
    captured = capfd.readouterr()
    assert captured.out == captured.err == ""


def test_a_picture_cut_short_is_refused(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    """Wherever it ends: OpenImageIO goes on with grey rows where a JPEG or a TIFF has no more data."""
    codes = np.random.default_rng(3).integers(0, 256, (64, 64, 3)).astype(np.uint8)
    pictures = {"sequential.jpg": {}, "progressive.jpg": {"jpeg:progressive": 1}, "plain.tif": {"compression": "none"}}
    for name, wishes in pictures.items():
        write(tmp_path / name, codes, **wishes)
        whole = (tmp_path / name).read_bytes()
        rc.read_environment(tmp_path / name)
        for share in np.linspace(0.01, 0.99, 15):
            (tmp_path / f"cut-{name}").write_bytes(whole[: int(share * len(whole))])
            with pytest.raises(rc.ImageFileError, match=f"cut-{name}: is (broken or incomplete|no picture)"):
                rc.read_environment(tmp_path / f"cut-{name}")
    captured = capfd.readouterr()
    assert captured.out == captured.err == ""


def test_a_name_with_a_null_character_is_none(image: rc.Image, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The system would take its beginning."""
    monkeypatch.chdir(tmp_path)
    for use in (image.save, rc.read_environment, scenes.sky(1.0).with_environment):
        with pytest.raises(rc.InputError, match="a file name cannot hold a null character"):
            use("a.png\0b.png")
    assert list(tmp_path.iterdir()) == []


def textured(folder: Path, name: str) -> np.ndarray:
    """Albedo of a scene file's texture as photographed: radiance of a card under a uniform sky, relative to the sky."""
    (folder / "card.mtl").write_text(f"newmtl m\nKd 1 1 1\nmap_Kd {name}\n")
    (folder / "card.obj").write_text(
        "mtllib card.mtl\nusemtl m\nv -1 -1 -2\nv 1 -1 -2\nv 1 1 -2\nv -1 1 -2\n"
        "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n"
    )
    scene = rc.Scene.load(folder / "card.obj").with_environment(1.0)
    assert scene.warnings == []
    seen = rc.render(scene, scenes.pinhole(), effects=(), spp=64, max_bounces=0)
    sky = rc.render(scenes.sky(1.0), scenes.pinhole(), effects=(), spp=1)
    return (seen.pixels / sky.pixels)[6:10, 10:14].mean(axis=(0, 1))


@pytest.mark.parametrize("kind", ["uint8 png", "uint16 png", "uint8 tif", "float32 exr", "uint8 bmp", "uint8 tga"])
def test_alpha_is_not_multiplied_into_a_texture(tmp_path: Path, kind: str) -> None:
    dtype, suffix = kind.split()
    most = 65535 if dtype == "uint16" else 255
    code = np.array([200, 100, 50, 128]) * (most // 255)
    if dtype == "float32":
        # OpenEXR keeps colours multiplied by alpha, and linear.
        alpha = 128 / 255
        pixel = np.append(srgb_to_linear(code[:3] / 255) * alpha, alpha)
    else:
        pixel = code
    channels = 3 if suffix == "bmp" else 4
    picture = np.broadcast_to(pixel.astype(dtype), (8, 8, 4))[..., :channels]
    write(tmp_path / f"card.{suffix}", np.ascontiguousarray(picture), **{"oiio:UnassociatedAlpha": 1})
    expected = srgb_to_linear(np.array([200, 100, 50]) / 255)
    # The card is lit by its whole half of the sky, so that its radiance is its reflectance. 1024 cosine-distributed
    # samples of a constant have no noise; half a code of 8 bits is 1.2% of the darkest channel.
    np.testing.assert_allclose(textured(tmp_path, f"card.{suffix}"), expected, rtol=0.012)


def write_png(path: Path, size: int, bits: int, colour_type: int, rows: bytes) -> None:
    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = chunk(b"IHDR", struct.pack(">IIBBBBB", size, size, bits, colour_type, 0, 0, 0))
    data = chunk(b"IDAT", zlib.compress(rows, 9))
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + header + data + chunk(b"IEND", b""))


def test_a_picture_that_claims_too_many_pixels_is_refused(tmp_path: Path) -> None:
    """A PNG says in 33 bytes that it has 40000 x 40000."""
    path = tmp_path / "bomb.png"
    write_png(path, 40000, 8, 2, b"\0" * 100)
    with pytest.raises(rc.ImageFileError, match="40000 x 40000 pixels; at most 128 million"):
        rc.read_environment(path)
    # The size is within the limit, but these bytes could not decompress to that many pixels.
    write_png(path, 11000, 8, 2, b"\0" * 100)
    with pytest.raises(rc.ImageFileError, match=r"11000 x 11000 pixels, and [0-9]+ bytes cannot hold so many"):
        rc.read_environment(path)
    # Highly compressible files are accepted: here 1 bit a pixel, all pixels equal.
    write_png(tmp_path / "white.png", 4096, 1, 0, (b"\0" + b"\xff" * 512) * 4096)
    assert (rc.read_environment(tmp_path / "white.png") == 1).all()


def test_a_picture_of_very_many_channels_is_refused(tmp_path: Path) -> None:
    write(tmp_path / "many.exr", np.zeros((2, 2, 65), np.float32))
    with pytest.raises(rc.ImageFileError, match="has 65 channels; at most 64"):
        rc.read_environment(tmp_path / "many.exr")


def test_a_broken_file_is_quoted_whatever_its_bytes_are(image: rc.Image, tmp_path: Path) -> None:
    """OpenImageIO quotes the type of an attribute with the bytes of the file, which may be invalid UTF-8."""
    path = tmp_path / "picture.exr"
    image.save(path)
    whole = path.read_bytes()
    broken = whole.replace(b"pixelAspectRatio\0float\0", b"pixelAspectRatio\0floa\xff\0")
    assert broken != whole
    path.write_bytes(broken)
    with pytest.raises(rc.ImageFileError) as error:
        rc.read_environment(path)
    assert "\n" not in str(error.value)


def test_names_of_channels_may_be_any_bytes(tmp_path: Path) -> None:
    path, light = tmp_path / "picture.exr", np.float32([[0.5, 2]])
    write_exr_parts(path, [("", {"R": light, "G": light, "B": light, "mask~": light})])
    whole = path.read_bytes()
    assert whole.count(b"mask~\0") == 1
    path.write_bytes(whole.replace(b"mask~\0", b"mask\xe9\0"))
    np.testing.assert_array_equal(rc.read_environment(path), np.dstack([light] * 3))


def test_mutations_become_pixels_or_an_error(tmp_path: Path) -> None:
    """The fuzz target, in a process of its own: what it holds to includes that no signal ends it."""
    command = [sys.executable, str(ROOT / "tests" / "fuzz" / "fuzz_pictures.py"), "300", "--seed", "7"]
    done = subprocess.run([*command, "--folder", str(tmp_path)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert "; 0 broken" in done.stdout
