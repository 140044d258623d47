"""rc.DeviceArray: numbers in a GPU's memory that realcam makes and other libraries share."""

from __future__ import annotations

import gc
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import realcam as rc
from frame_scene import frame_scene

from ..device_memory import LENS, needs_gpu, small_camera

TOUR = Path(__file__).parents[3] / "docs" / "python.md"


def test_device_arrays_are_made_by_realcam_alone() -> None:
    with pytest.raises(TypeError, match="No constructor"):
        rc.DeviceArray()  # type: ignore[call-arg]


@pytest.mark.gpu
@needs_gpu
def test_shapes_types_and_copies() -> None:
    camera = small_camera(position=(1e6, 20, 30), look_at=(1e6, 20, 29))
    rays, host = camera.generate_rays(spp=5, seed=1, device="cuda"), camera.generate_rays(spp=5, seed=1)
    for name in ("origins_m", "directions", "weights", "pixels"):
        array, expected = getattr(rays, name), getattr(host, name)
        assert isinstance(array, rc.DeviceArray)
        assert (array.shape, array.dtype, array.device) == (expected.shape, expected.dtype, "cuda:0")
        assert len(array) == len(expected)
        copy = array.numpy()
        assert (copy.shape, copy.dtype) == (expected.shape, expected.dtype)
        # Some roundings of float32, and of a double a million metres away.
        np.testing.assert_allclose(copy, expected, rtol=0 if name == "origins_m" else 1e-5, atol=1e-6)
        np.testing.assert_array_equal(np.asarray(array), copy)
        assert np.asarray(array, np.float64).dtype == np.float64
        assert np.array(array, copy=True).shape == copy.shape
        interface = array.__cuda_array_interface__
        assert (interface["version"], interface["shape"], interface["strides"]) == (3, expected.shape, None)
        assert interface["typestr"] == expected.dtype.str
        assert interface["data"][0] % 8 == 0
        assert interface["data"][1] is False
        assert array.__dlpack_device__() == (2, 0)
    assert repr(rays.origins_m) == 'realcam.DeviceArray(shape=(120, 3), dtype=float64, device="cuda:0")'
    with pytest.raises(ValueError, match="copy must not be False"):
        rays.weights.__array__(copy=False)


@pytest.mark.gpu
@needs_gpu
def test_dlpack_by_the_standard() -> None:
    weights = small_camera().generate_rays(device="cuda").weights
    for how, name in (
        ({}, '"dltensor"'),
        ({"max_version": (0, 8)}, '"dltensor"'),
        ({"max_version": (1, 1), "stream": 2}, '"dltensor_versioned"'),
        ({"dl_device": (2, 0), "copy": False, "stream": -1}, '"dltensor"'),
        ({"dl_device": (1, 0)}, '"dltensor"'),
        ({"copy": True, "max_version": (1, 0)}, '"dltensor_versioned"'),
    ):
        assert name in repr(weights.__dlpack__(**how))  # and a capsule that nobody takes frees itself
    for how in ({"dl_device": (2, 7)}, {"dl_device": (10, 0)}, {"dl_device": (1, 0), "copy": False}):
        with pytest.raises(BufferError):
            weights.__dlpack__(**how)
    if np.lib.NumpyVersion(np.__version__) >= "2.1.0":
        np.testing.assert_array_equal(np.from_dlpack(weights, device="cpu"), weights.numpy())


def as_torch(array: rc.DeviceArray) -> tuple[list[Any], Callable[[Any], int]]:
    torch = pytest.importorskip("torch")
    return [torch.from_dlpack(array), torch.as_tensor(array, device="cuda")], lambda tensor: tensor.data_ptr()


def as_cupy(array: rc.DeviceArray) -> tuple[list[Any], Callable[[Any], int]]:
    cupy = pytest.importorskip("cupy")
    return [cupy.from_dlpack(array), cupy.asarray(array)], lambda other: other.data.ptr


def to_host(array: Any) -> np.ndarray:
    return array.get() if hasattr(array, "get") else array.cpu().numpy()


@pytest.mark.gpu
@needs_gpu
@pytest.mark.parametrize("share", [as_torch, as_cupy])
def test_other_libraries_share_the_memory(share: Callable[..., Any]) -> None:
    rays = small_camera().generate_rays(spp=5, device="cuda")
    expected = {name: getattr(rays, name).numpy() for name in ("origins_m", "directions", "weights", "pixels")}
    kept = []
    for name, numbers in expected.items():
        array = getattr(rays, name)
        others, address = share(array)
        for other in others:
            assert address(other) == array.__cuda_array_interface__["data"][0]
            assert tuple(other.shape) == numbers.shape
            kept.append((other, numbers))
    del rays, array, others, other
    gc.collect()
    small_camera().generate_rays(spp=50, seed=3, device="cuda")  # would take the memory if it were free
    for other, numbers in kept:
        assert to_host(other).dtype == numbers.dtype
        np.testing.assert_array_equal(to_host(other), numbers)


@pytest.mark.gpu
@needs_gpu
def test_what_is_written_by_one_is_read_by_the_other() -> None:
    torch = pytest.importorskip("torch")
    weights = small_camera().generate_rays(device="cuda").weights
    shared, copied = torch.from_dlpack(weights), torch.from_dlpack(weights.__dlpack__(copy=True))
    shared.fill_(7)
    torch.cuda.synchronize()
    assert (weights.numpy() == 7).all()
    assert (copied.cpu().numpy() != 7).all()


@pytest.mark.gpu
@needs_gpu
def test_memory_is_freed() -> None:
    torch = pytest.importorskip("torch")
    camera = rc.Camera(LENS, film=rc.Film(36, 24, (960, 640)))
    torch.from_dlpack(camera.generate_rays(device="cuda").origins_m)
    gc.collect()
    before = torch.cuda.mem_get_info()[0]
    for _ in range(20):  # 56 bytes a ray: 0.7 GB, were they kept
        rays = camera.generate_rays(device="cuda")
        torch.from_dlpack(rays.origins_m)
        rays.directions.__dlpack__(max_version=(1, 0))
        rays.weights.__dlpack__(copy=True)
    del rays
    gc.collect()
    assert torch.cuda.mem_get_info()[0] > before - 100e6


@pytest.mark.slow
@pytest.mark.gpu
@needs_gpu
def test_arrays_that_live_until_the_process_ends() -> None:
    script = """
import sys, realcam as rc
rays = rc.Camera(rc.Lens.load("tessar-50mm"), film=rc.Film(36, 24, (6, 4))).generate_rays(device="cuda")
sys.kept = [rays, rays.origins_m.__dlpack__(), rays.weights.__dlpack__(max_version=(1, 0))]
try:
    import torch
    sys.kept += [torch.from_dlpack(rays.origins_m), torch.as_tensor(rays.directions, device="cuda")]
except ImportError:
    pass
"""
    run = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
    assert "rror" not in run.stderr, run.stderr


@pytest.mark.gpu
@needs_gpu
def test_out_of_device_memory() -> None:
    large = rc.Camera(LENS, film=rc.Film(36, 24, (32768, 32768)), model="thin")
    for spp, says in ((256, r"out of memory: \d+ MiB more were requested, and \d+ MiB"), (2**31 - 1, "fewer spp")):
        with pytest.raises(rc.DeviceError, match=says):
            large.generate_rays(spp=spp, device="cuda")
    assert small_camera().generate_rays(device="cuda").weights.numpy().max() > 0  # and it works on


@pytest.mark.gpu
@needs_gpu
def test_the_example_of_the_tour() -> None:
    pytest.importorskip("torch")
    (example,) = re.findall(r"```python\n([^`]*?from_dlpack[^`]*?)```", TOUR.read_text(encoding="utf-8"))
    names = {"rc": rc, "lens": LENS, "camera": small_camera(), "scene": frame_scene(spheres=1, boxes=1)}
    exec(example, names)
    assert isinstance(names["out"], rc.TraceResult)
    assert names["exposure"].shape == (*names["depth"].shape, 3)
