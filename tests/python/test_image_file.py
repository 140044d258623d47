"""Pictures on disk: what is in them, and nothing half-written."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import OpenImageIO as oiio
import pytest
import realcam as rc
from realcam import image_file

from . import scenes


@pytest.fixture(scope="module")
def image() -> rc.Image:
    lens = rc.Lens.load("double-gauss-50mm").focused(2.5).stopped_down(5.6)
    camera = rc.Camera(lens, film=rc.Film(12, 9, (16, 12)), exposure_time_s=1 / 60, iso=400)
    # Of the upper half red, of the lower half blue; nothing at the sides.
    upper = scenes.quad((0, 0.25, -2.5), 0.2, 0.25, emission=(300, 10, 0))
    lower = scenes.quad((0, -0.25, -2.5), 0.2, 0.25, emission=(0, 10, 300))
    return rc.render(scenes.scene_of(upper, lower), camera, spp=4, seed=11)


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


def test_png_holds_the_developed_picture(image: rc.Image, tmp_path: Path) -> None:
    for tone in ("film", "linear"):
        path = tmp_path / f"{tone}.png"
        image.save(str(path), tone=tone)
        pixels, spec = read(path)
        assert (spec.format, spec.nchannels) == (oiio.UINT8, 3)
        np.testing.assert_array_equal(pixels, image.developed(tone))
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
    # Where other programs look for it. Exif has rationals.
    assert value("ExposureTime") == pytest.approx(1 / 60, rel=1e-4)
    assert value("FNumber") == pytest.approx(5.6, rel=1e-4)
    assert "realcam" in spec.getattribute("Software")


@pytest.mark.parametrize("focus", [float("inf"), 3.0])
@pytest.mark.parametrize("suffix", [".exr", ".png"])
def test_focus_at_infinity_is_written_too(tmp_path: Path, focus: float, suffix: str) -> None:
    lens = rc.Lens.load("tessar-50mm").focused(focus)
    picture = rc.render(scenes.sky(), rc.Camera(lens, film=rc.Film(4, 4, (2, 2)), iso=3200), spp=1)
    path = tmp_path / f"x{suffix}"
    picture.save(path)
    assert float(read(path)[1].getattribute("realcam:focus_distance_m")) == focus


@pytest.mark.parametrize("name", ["picture.jpeg", "picture", "picture.exr.bak", ".png"])
def test_unknown_suffix_says_which_are_known(image: rc.Image, tmp_path: Path, name: str) -> None:
    with pytest.raises(rc.ImageFileError, match=r"\.png .*\.exr"):
        image.save(tmp_path / name)
    assert list(tmp_path.iterdir()) == []


def test_suffix_in_capitals(image: rc.Image, tmp_path: Path) -> None:
    image.save(tmp_path / "A.PNG")
    image.save(tmp_path / "B.EXR")
    assert read(tmp_path / "A.PNG")[1].nchannels == 3
    assert read(tmp_path / "B.EXR")[1].nchannels == 4


def test_missing_folder_and_folder_in_place_of_the_file(image: rc.Image, tmp_path: Path) -> None:
    with pytest.raises(rc.ImageFileError, match=r"picture\.png.*nowhere does not exist"):
        image.save(tmp_path / "nowhere" / "picture.png")
    (tmp_path / "taken.png").mkdir()
    with pytest.raises(rc.ImageFileError, match="is a folder"):
        image.save(tmp_path / "taken.png")
    assert [path.name for path in tmp_path.iterdir()] == ["taken.png"]


def test_folder_that_is_not_writable(image: rc.Image, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    if os.geteuid() == 0:  # root may write everywhere: ask as somebody else would be answered
        monkeypatch.setattr(os, "access", lambda *_, **__: False)
    else:
        tmp_path.chmod(0o500)
    with pytest.raises(rc.ImageFileError, match="not writable"):
        image.save(tmp_path / "picture.png")
    tmp_path.chmod(0o700)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("suffix", [".exr", ".png"])
def test_a_failing_disk_leaves_the_old_file(
    image: rc.Image, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, suffix: str
) -> None:
    path = tmp_path / f"picture{suffix}"
    path.write_bytes(b"the old one")

    def full(self: Path, target: object) -> Path:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "replace", full)
    with pytest.raises((rc.ImageFileError, OSError)):
        image.save(path)
    assert path.read_bytes() == b"the old one"
    assert [p.name for p in tmp_path.iterdir()] == [path.name]


def test_an_interrupt_leaves_nothing(image: rc.Image, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*_: object) -> np.ndarray:
        raise KeyboardInterrupt

    monkeypatch.setattr(image_file.np, "ascontiguousarray", interrupted)
    with pytest.raises(KeyboardInterrupt):
        image.save(tmp_path / "picture.exr")
    assert list(tmp_path.iterdir()) == []


def test_written_files_have_ordinary_permissions(image: rc.Image, tmp_path: Path) -> None:
    before = os.umask(0o027)
    try:
        image.save(tmp_path / "picture.png")
    finally:
        os.umask(before)
    assert (tmp_path / "picture.png").stat().st_mode & 0o777 == 0o640


def test_unknown_tone_curve(image: rc.Image, tmp_path: Path) -> None:
    with pytest.raises(rc.InputError, match="film or linear"):
        image.save(tmp_path / "picture.png", tone="sepia")
    assert list(tmp_path.iterdir()) == []


def test_an_environment_image_is_read_as_light(tmp_path: Path) -> None:
    light = np.array([[[0.25, 5.0, 100.0], [0, 1, 2]]], np.float32)
    image_file.write_image(tmp_path / "sky.exr", light, ("R", "G", "B"), {})
    np.testing.assert_array_equal(image_file.read_environment(tmp_path / "sky.exr"), light)
    codes = np.array([[[0, 118, 255], [10, 188, 64]]], np.uint8)
    image_file.write_image(tmp_path / "sky.png", codes, ("R", "G", "B"), {})
    v = codes / 255
    expected = np.where(v <= 0.04045, v / 12.92, ((v + 0.055) / 1.055) ** 2.4)  # IEC 61966-2-1
    np.testing.assert_allclose(image_file.read_environment(tmp_path / "sky.png"), expected, rtol=1e-5)
    with pytest.raises(rc.ImageFileError, match="nowhere"):
        image_file.read_environment(tmp_path / "nowhere.exr")
    (tmp_path / "broken.exr").write_bytes(b"not an image")
    with pytest.raises(rc.ImageFileError, match="cannot be read"):
        image_file.read_environment(tmp_path / "broken.exr")


def test_a_picture_cut_short_by_a_full_disk_is_no_success(tmp_path: Path) -> None:
    pixels = np.random.default_rng(1).integers(0, 255, (64, 64, 3), dtype=np.uint8)
    target = tmp_path / "whole.png"
    image_file.write_image(target, pixels, ("R", "G", "B"), {})
    cut = tmp_path / "cut.png"
    cut.write_bytes(target.read_bytes()[:4096])  # what a disk of 4 KB keeps
    with pytest.raises(rc.ImageFileError, match="completely"):
        image_file._check_complete(str(cut), "cut.png", pixels.shape)
