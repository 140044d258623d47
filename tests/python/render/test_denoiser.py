"""Open Image Denoise, where it is installed: nearer to the converged picture, and said so in the file."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest
import realcam as rc
from frame_scene import frame_scene
from realcam.denoiser import opened
from realcam.installation import denoiser_library

from .. import scenes
from ..programs import PROGRAM

GUIDES = ("albedo", "normal", "traced_light")
NOWHERE = "/nowhere/libOpenImageDenoise.so"
QUAD = "v -1 -1 -3\nv 1 -1 -3\nv 1 1 -4\nv -1 1 -4\nf 1 2 3 4\n"


def is_here() -> bool:
    try:
        opened("cpu")
    except rc.InputError:
        return False
    return True


wants_it = pytest.mark.skipif(not is_here(), reason="the extra realcam[denoise] is not installed")


def picture(spp: int, layers: tuple[str, ...] = (), seed: int = 0) -> rc.Image:
    camera = rc.Camera(
        rc.Lens.load("double-gauss-50mm").focused(5.0),
        film=rc.Film(36, 24, (120, 80)),
        position=(0, 1.5, 6),
        look_at=(0, 0.8, 0),
        exposure_time_s=1,
    )
    return rc.render(
        frame_scene(spheres=10, boxes=10), camera, effects=(), spp=spp, seed=seed, layers=layers, max_bounces=1
    )


@wants_it
def test_noise_falls() -> None:
    noisy = picture(4, (*GUIDES, "variance", "depth_middle"), seed=1)
    clean = noisy.denoised()
    truth = picture(1024).pixels.astype(float)

    def rmse(image: rc.Image) -> float:
        return float(np.sqrt(((image.pixels - truth) ** 2).mean()))

    assert rmse(clean) < 0.6 * rmse(noisy)
    # Light is neither made nor lost.
    assert clean.pixels.mean() == pytest.approx(noisy.pixels.mean(), rel=0.03)
    assert (clean.pixels.shape, clean.pixels.dtype) == (noisy.pixels.shape, np.float32)
    assert set(clean.layers) == {*GUIDES, "depth_middle"}
    assert clean != noisy
    assert "denoised" in repr(clean)


@wants_it
def test_it_is_never_on_by_itself_and_tells(tmp_path: Path) -> None:
    noisy = picture(2, GUIDES)
    assert noisy.denoiser == ""
    assert "realcam:denoiser" not in noisy.metadata()
    clean = noisy.denoised()
    assert clean.metadata()["realcam:denoiser"].startswith("Open Image Denoise 2.")
    np.testing.assert_array_equal(noisy.pixels, picture(2).pixels)
    if hasattr(rc._core, "_write_picture") and find_spec("OpenImageIO"):
        import OpenImageIO as oiio

        for name in ("a.exr", "a.png"):
            clean.save(tmp_path / name)
            spec = oiio.ImageBuf(str(tmp_path / name)).spec()
            assert spec.getattribute("realcam:denoiser") == clean.denoiser


@wants_it
@pytest.mark.parametrize("focus_m", [6.0, 1.0])
@pytest.mark.slow
def test_lamps_keep_their_light(focus_m: float) -> None:
    """Five small lamps before a lit wall: their light is traced, and stays what it is."""
    lamps = [scenes.quad((0.3 * x, 0.1 * x * x, -6), 0.01, emission=3e4) for x in range(-2, 3)]
    scene = scenes.scene_of(*lamps, scenes.quad((0, 0, -8), 4, diffuse=0.5)).with_point_light((2, 2, -5), (200,) * 3)
    lens = rc.Lens.load("double-gauss-50mm").focused(focus_m)
    camera = rc.Camera(lens, film=rc.Film(36, 24, (120, 80)), exposure_time_s=1)

    def taken(spp: int, seed: int) -> rc.Image:
        return rc.render(scene, camera, effects=(), spp=spp, seed=seed, max_bounces=1, layers=GUIDES, device="cpu")

    truth = taken(2048, 100).pixels.astype(float)
    for seed in range(3):
        noisy = taken(8, seed)
        assert noisy.layers["traced_light"].max() > 0.5 * truth.max()
        clean = noisy.denoised().pixels.astype(float)
        raw = noisy.pixels.astype(float)
        assert ((clean - truth) ** 2).mean() <= ((raw - truth) ** 2).mean()
        assert clean.mean() == pytest.approx(raw.mean(), rel=0.005)


def test_what_is_missing_is_told_in_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(rc.InputError, match="requires the layers albedo, normal, traced_light; render") as error:
        picture(1, ("albedo",)).denoised()
    assert "\n" not in str(error.value)
    image = picture(1, GUIDES)
    monkeypatch.setenv("REALCAM_OIDN", NOWHERE)
    with pytest.raises(rc.InputError, match=r"install it with pip install realcam\[denoise\]") as error:
        image.denoised()
    assert "\n" not in str(error.value)
    monkeypatch.setenv("REALCAM_OIDN", rc._core.__file__)  # another library
    with pytest.raises(rc.InputError, match=r"oidnNewDevice.*; install it with pip install realcam\[denoise\]"):
        opened("cpu")


@wants_it
@pytest.mark.parametrize("shape", [(4, 5, 1), (4, 5), (4, 4, 3), (0, 5, 3)])
def test_layers_of_another_size_are_refused(shape: tuple[int, ...]) -> None:
    right, other = np.ones((4, 5, 3), np.float32), np.ones(shape, np.float32)
    with pytest.raises(rc.InputError, match="of the same shape"):
        opened("cpu").denoised(right, other, right, fast=True)


@wants_it
@pytest.mark.parametrize("fast", [False, True])
@pytest.mark.parametrize("size", [(1, 1), (3, 200), (5, 4), (64, 48)])
def test_light_is_neither_made_nor_lost(fast: bool, size: tuple[int, int]) -> None:
    """A uniform grey picture of any size keeps its mean. Pixels at the edges change by a third, so the mean counts.

    The picture is scaled to the network's range, so that results are proportional to the exposure.
    """
    denoiser = opened("cpu")
    means = []
    for exposure in (1e-4, 0.1, 30.0):
        even = np.full((*size, 3), exposure, np.float32)
        result = denoiser.denoised(even, np.full_like(even, 0.5), np.full_like(even, 0.5), fast)
        assert result.shape == even.shape
        means.append(float(result.mean()) / exposure)
    # A single pixel is a corner.
    assert means[0] == pytest.approx(1, abs=0.25 if size == (1, 1) else 0.01)
    np.testing.assert_allclose(means, means[0], rtol=1e-3)


@wants_it
def test_a_denoiser_takes_pictures_of_other_sizes_and_qualities() -> None:
    """The lens bench uses a denoiser like this: buffers of one size must not be used for the next size."""
    one = opened("cpu")
    rng = np.random.default_rng(1)
    for size, fast in (((8, 9), True), ((20, 7), True), ((20, 7), False), ((8, 9), True)):
        arrays = [rng.random((*size, 3), np.float32) for _ in range(3)]
        np.testing.assert_array_equal(one.denoised(*arrays, fast), opened("cpu").denoised(*arrays, fast))


def realcam(*words: str, folder: Path, library: str | None = None) -> subprocess.CompletedProcess[str]:
    """The command, which gets its library by its environment."""
    (folder / "quad.obj").write_text(QUAD)
    environment = {**os.environ, "REALCAM_OIDN": denoiser_library() if library is None else library}
    command = [*PROGRAM, "render", "quad.obj", "--resolution", "48x32", "--device", "cpu", *words]
    return subprocess.run(command, capture_output=True, text=True, cwd=folder, env=environment)


@pytest.mark.picture_files
def test_no_picture_is_begun_without_the_library(tmp_path: Path) -> None:
    done = realcam("-o", "a.png", "--denoise", folder=tmp_path, library=NOWHERE)
    assert (done.returncode, done.stdout, done.stderr.count("\n")) == (2, "", 1)
    assert "install it with pip install realcam[denoise]" in done.stderr
    assert not (tmp_path / "a.png").exists()
    assert realcam("-o", "a.png", "--spp", "1", folder=tmp_path, library=NOWHERE).returncode == 0


@wants_it
@pytest.mark.picture_files
def test_the_command_denoises_as_python_does(tmp_path: Path) -> None:
    oiio = pytest.importorskip("OpenImageIO")
    words = ["--spp", "3", "--effects", "none", "--denoise", "--json"]
    done = realcam("-o", "a.exr", "-o", "a.png", *words, folder=tmp_path)
    assert done.returncode == 0, done.stderr
    figures = json.loads(done.stdout)
    (tmp_path / "shot.toml").write_text(
        'format = 1\nscene = "quad.obj"\nresolution = [48, 32]\nspp = 3\neffects = []\n'
    )
    shot = rc.Shot.load(tmp_path / "shot.toml", device="cpu")
    noisy = rc.render(shot.scene, shot.camera, shot.settings, layers=GUIDES, device="cpu")
    clean = noisy.denoised(device="cpu")
    assert figures["denoiser"] == clean.denoiser != ""
    picture = oiio.ImageInput.open(str(tmp_path / "a.exr"))
    spec = picture.spec()
    assert spec.channelnames == ("R", "G", "B", "Z")  # the layers that it went by were not asked for
    np.testing.assert_array_equal(picture.read_image(0, 0, 0, 3, "float"), clean.pixels)
    for name in ("a.exr", "a.png"):
        written = oiio.ImageBuf(str(tmp_path / name)).spec()
        assert {key: written.getattribute(key) for key in clean.metadata()} == clean.metadata()
    raw = realcam("-o", "b.exr", "--layers", "normal,variance", *words, folder=tmp_path)
    assert raw.returncode == 0, raw.stderr
    # The variance would be that of the noise, which is gone.
    assert oiio.ImageBuf(str(tmp_path / "b.exr")).spec().channelnames[4:] == ("Normal.X", "Normal.Y", "Normal.Z")


@wants_it
@pytest.mark.picture_files
@pytest.mark.parametrize("words", [("--denoise", "--spp", "1"), ("--seconds", "1e-3")], ids=" ".join)
def test_the_command_of_the_package_finds_the_library(
    words: tuple[str, ...], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("REALCAM_OIDN", raising=False)
    (tmp_path / "quad.obj").write_text(QUAD)
    command = [sys.executable, "-m", "realcam", "render", "quad.obj", "-o", "a.png", *words]
    done = subprocess.run(
        [*command, "--resolution", "24x16", "--device", "cpu"], capture_output=True, text=True, cwd=tmp_path
    )
    assert done.returncode == 0, done.stderr
    assert "denoised    by Open Image Denoise 2." in done.stdout
