"""Open Image Denoise on a GPU and on the CPU: the same network, in half precision on the GPU."""

from __future__ import annotations

import numpy as np
import pytest
import realcam as rc
from frame_scene import frame_camera, frame_scene
from realcam.denoiser import opened


def opens(device: str) -> bool:
    try:
        opened(device)
    except (rc.InputError, rc.DeviceError):
        return False
    return True


pytestmark = [
    pytest.mark.gpu,
    pytest.mark.skipif(not opens("cuda"), reason="no GPU beside which Open Image Denoise is installed"),
]


@pytest.fixture(scope="module")
def noisy() -> rc.Image:
    camera = frame_camera().replace(film=rc.Film(36, 24, (192, 128)))
    return rc.render(
        frame_scene(spheres=10, boxes=10),
        camera,
        effects=(),
        spp=4,
        layers=("albedo", "normal", "traced_light"),
        device="cuda",
    )


def test_a_gpu_denoises_as_the_cpu_does(noisy: rc.Image) -> None:
    """Half precision has 11 bits. A network of some twenty layers adds up their rounding to a few thousandths."""
    on_gpu, on_cpu = (noisy.denoised(device=device).pixels for device in ("cuda", "cpu"))
    light = on_cpu.mean()
    difference = np.sqrt(((on_gpu - on_cpu) ** 2).mean()) / light
    removed = np.sqrt(((noisy.pixels - on_cpu) ** 2).mean()) / light
    assert difference < 0.01 < 0.1 * removed, (difference, removed)


def test_auto_takes_the_gpu(noisy: rc.Image) -> None:
    np.testing.assert_array_equal(noisy.denoised().pixels, noisy.denoised(device="cuda:0").pixels)


def test_a_gpu_that_is_not_there_is_told(noisy: rc.Image) -> None:
    with pytest.raises(rc.DeviceError, match="cannot use the GPU 99; use device cpu"):
        noisy.denoised(device="cuda:99")


@pytest.mark.parametrize("fast", [False, True])
def test_one_denoiser_takes_pictures_of_other_sizes(fast: bool) -> None:
    one = opened("cuda")
    rng = np.random.default_rng(1)
    for size in ((8, 9), (64, 48), (8, 9)):
        arrays = [rng.random((*size, 3), np.float32) for _ in range(3)]
        np.testing.assert_array_equal(one.denoised(*arrays, fast), opened("cuda").denoised(*arrays, fast))
