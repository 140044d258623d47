"""Open Image Denoise, where it is installed: nearer to the converged picture, and said so in the file."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest
import realcam as rc
from frame_scene import frame_scene

GUIDES = ("albedo", "normal")


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


def test_noise_falls() -> None:
    pytest.importorskip("pyoidn")
    noisy = picture(4, (*GUIDES, "variance", "depth_middle"), seed=1)
    clean = noisy.denoised()
    truth = picture(1024).pixels.astype(float)

    def rmse(image: rc.Image) -> float:
        return float(np.sqrt(((image.pixels - truth) ** 2).mean()))

    assert rmse(clean) < 0.6 * rmse(noisy)
    # Light is neither made nor lost.
    assert clean.pixels.mean() == pytest.approx(noisy.pixels.mean(), rel=0.03)
    assert (clean.pixels.shape, clean.pixels.dtype) == (noisy.pixels.shape, np.float32)
    assert set(clean.layers) == {"albedo", "normal", "depth_middle"}
    assert clean != noisy
    assert "denoised" in repr(clean)


def test_it_is_never_on_by_itself_and_tells(tmp_path: Path) -> None:
    pytest.importorskip("pyoidn")
    noisy = picture(2, GUIDES)
    assert noisy.denoiser == ""
    assert "realcam:denoiser" not in noisy.metadata()
    clean = noisy.denoised()
    assert clean.metadata()["realcam:denoiser"].startswith("Open Image Denoise 2.")
    np.testing.assert_array_equal(noisy.pixels, picture(2).pixels)
    if sys.modules.get("OpenImageIO") or __import__("importlib.util").util.find_spec("realcam._pictures"):
        oiio = pytest.importorskip("OpenImageIO")
        for name in ("a.exr", "a.png"):
            clean.save(tmp_path / name)
            spec = oiio.ImageBuf(str(tmp_path / name)).spec()
            assert spec.getattribute("realcam:denoiser") == clean.denoiser


def test_what_is_missing_is_told_in_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(rc.InputError, match="wants the layers albedo and normal; render") as error:
        picture(1, ("albedo",)).denoised()
    assert "\n" not in str(error.value)
    image = picture(1, GUIDES)
    monkeypatch.setitem(sys.modules, "pyoidn", None)
    with pytest.raises(rc.InputError, match=r"pip install realcam\[denoise\] brings it") as error:
        image.denoised()
    assert "\n" not in str(error.value)
