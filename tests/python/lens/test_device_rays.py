"""Lens.trace on rays in a GPU's memory, and what it refuses."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import realcam as rc

from ..device_memory import (
    EMPTY,
    GPUS,
    LENS,
    Claimed,
    ClaimedByDLPack,
    DLPackAlone,
    Passed,
    Unexportable,
    film_rays,
    needs_gpu,
    needs_two,
    on_cupy,
    on_torch,
    small_camera,
)


@pytest.mark.parametrize(
    ("array", "says"),
    [
        (Claimed(shape=(2, 4)), r"origins_mm lies on a GPU, and must be of shape \(N, 3\)"),
        (Claimed(shape=(6,)), r"\(N, 3\)"),
        (Claimed(typestr="<i4"), 'type "<i4"; expected float64 or float32'),
        (Claimed(typestr=">f8"), 'type ">f8"; expected float64 or float32'),
        (Claimed(strides=(8, 16)), "contiguous copy"),
        (Claimed(strides=(48, 8)), "contiguous copy"),
        (Claimed(data=(4100, False)), "address that is not a multiple"),
        (Claimed(data=None), "cannot be read: TypeError"),
        (Claimed(shape="x"), "wrong type"),
        (Claimed(mask=Claimed()), "mask"),
        (ClaimedByDLPack(np.zeros((2, 4))), r"\(N, 3\)"),
        (ClaimedByDLPack(np.zeros((2, 3), np.int64)), "type int64; expected float64 or float32"),
        (ClaimedByDLPack(np.zeros((2, 3), np.float16)), "type float16; expected float64 or float32"),
        (ClaimedByDLPack(np.zeros((4, 3))[::2]), "contiguous copy"),
        (ClaimedByDLPack(np.zeros((3, 2)).T), "contiguous copy"),
        (ClaimedByDLPack(capsule=7), "returned no capsule"),
        (Unexportable(), "cannot be read: it needs its gradient"),
    ],
)
def test_what_cannot_be_traced_where_it_lies(array: object, says: str) -> None:
    with pytest.raises(rc.InputError, match=says):
        LENS.trace(array, array)  # type: ignore[call-overload]


def test_both_must_lie_on_the_same_device() -> None:
    for origins, directions, only in (
        (EMPTY, np.zeros((0, 3)), "origins_mm"),
        (np.zeros((0, 3)), EMPTY, "directions"),
    ):
        with pytest.raises(rc.InputError, match=f"same device, and only {only} lies on a GPU"):
            LENS.trace(origins, directions)  # type: ignore[call-overload]
    with pytest.raises(rc.InputError, match='on a GPU, and device is "cpu"'):
        LENS.trace(EMPTY, EMPTY, device="cpu")


@pytest.mark.parametrize("name", ["gpu", "cuda:", "cuda:x", "cuda:-1", ""])
def test_unknown_devices(name: str) -> None:
    with pytest.raises(rc.InputError, match="there is no device"):
        small_camera().generate_rays(device=name)
    with pytest.raises(rc.InputError, match="there is no device"):
        LENS.trace(*film_rays(), device=name)


def test_rays_are_made_on_one_gpu() -> None:
    for ask in (
        lambda: small_camera().generate_rays(device="cuda:0,1"),
        lambda: LENS.trace(*film_rays(), device="cuda:0,1"),
    ):
        with pytest.raises(rc.InputError, match="a single GPU"):
            ask()


@pytest.mark.skipif(bool(GPUS), reason="this machine has a GPU")
def test_without_a_gpu_it_says_why() -> None:
    for ask in (
        lambda: small_camera().generate_rays(device="cuda"),
        lambda: LENS.trace(*film_rays(), device="cuda:0"),
        lambda: LENS.trace(Claimed(), Claimed()),
        lambda: LENS.trace(EMPTY, EMPTY),
    ):
        with pytest.raises(rc.DeviceError, match=r"no NVIDIA (driver|GPU)|no CUDA backend"):
            ask()
    for auto, cpu in (
        (small_camera().generate_rays(device="auto").weights, small_camera().generate_rays().weights),
        (LENS.trace(*film_rays(), device="auto").origins_mm, LENS.trace(*film_rays()).origins_mm),
    ):
        np.testing.assert_array_equal(auto, cpu)


def test_the_cpu_takes_host_arrays_of_other_libraries() -> None:
    torch = pytest.importorskip("torch")
    origins, directions = film_rays()
    out = LENS.trace(torch.from_numpy(origins), torch.from_numpy(directions))
    assert isinstance(out.origins_mm, np.ndarray)
    np.testing.assert_array_equal(out.origins_mm, LENS.trace(origins, directions).origins_mm)


@pytest.mark.gpu
@needs_gpu
@pytest.mark.parametrize("to_gpu", [on_torch, on_cupy, DLPackAlone])
@pytest.mark.parametrize("dtype", ["float64", "float32"])
def test_rays_are_traced_where_they_lie(to_gpu: Callable[..., Any], dtype: str) -> None:
    # The rays have values that float32 represents exactly, so that both input types describe the same rays.
    origins, directions = (array.astype(np.float32).astype(np.float64) for array in film_rays())
    expected = LENS.trace(origins, directions, device="cuda", dtype=dtype)
    assert isinstance(expected.origins_mm, np.ndarray)
    for kind in (np.float64, np.float32):
        inputs = to_gpu(origins.astype(kind)), to_gpu(directions.astype(kind))
        for device in (None, "auto", "cuda", "cuda:0"):
            out = LENS.trace(*inputs, dtype=dtype, device=device)
            for name in ("origins_mm", "directions", "optical_path_mm", "status", "surface_index"):
                array = getattr(out, name)
                assert isinstance(array, rc.DeviceArray)
                assert array.dtype == getattr(expected, name).dtype
                np.testing.assert_array_equal(array.numpy(), getattr(expected, name))
    with pytest.raises(rc.InputError, match='lie on cuda:0, and device is "cpu"'):
        LENS.trace(*inputs, device="cpu")
    with pytest.raises(rc.InputError, match=r"\(N, 3\)"):
        LENS.trace(inputs[0], to_gpu(directions[:7]))
    with pytest.raises(rc.InputError, match="only origins_mm lies on a GPU"):
        LENS.trace(inputs[0], directions)


@pytest.mark.gpu
@needs_gpu
def test_results_go_in_again() -> None:
    """There and back again without the host."""
    origins, directions = film_rays()
    out = LENS.trace(on_torch(origins), on_torch(directions))
    rays = small_camera().generate_rays(device="cuda")
    again = LENS.trace(out.origins_mm, out.directions, start="film", surface_count=1)
    assert again.origins_mm.shape == (40, 3)
    back = LENS.trace(out.origins_mm, pytest.importorskip("torch").from_dlpack(out.directions).neg(), start="scene")
    expected = LENS.trace(out.origins_mm.numpy(), -out.directions.numpy(), start="scene", device="cuda")
    np.testing.assert_array_equal(back.origins_mm.numpy(), expected.origins_mm)
    with pytest.raises(rc.InputError, match="type int32; expected float64 or float32"):
        LENS.trace(rays.pixels, rays.pixels)


@pytest.mark.gpu
@needs_gpu
def test_no_rays() -> None:
    for empty in (on_torch(np.zeros((0, 3))), EMPTY):
        out = LENS.trace(empty, empty)
        assert (out.origins_mm.shape, out.status.shape, len(out.status)) == ((0, 3), (0,), 0)
        assert out.origins_mm.numpy().shape == (0, 3)
        assert tuple(pytest.importorskip("torch").from_dlpack(out.directions).shape) == (0, 3)


@pytest.mark.gpu
@needs_gpu
def test_what_torch_and_cupy_hold_and_cannot_be_traced() -> None:
    torch = pytest.importorskip("torch")
    origins, directions = film_rays()
    good = on_torch(directions)
    for array, says in (
        (on_torch(origins).T.contiguous().T, "contiguous copy"),
        (on_torch(origins).repeat(1, 2)[:, ::2], "contiguous copy"),
        (on_torch(origins).half(), "float64 or float32"),
        (on_torch(origins).requires_grad_(), "cannot be read: .*grad"),
        (Claimed(data=(np.zeros((2, 3)).ctypes.data & ~7, False)), "in no GPU's memory"),
    ):
        with pytest.raises(rc.InputError, match=says):
            LENS.trace(array, good)
    assert torch.cuda.is_available()


@pytest.mark.gpu
@needs_gpu
@pytest.mark.parametrize("library", ["torch", "cupy", "dlpack", "realcam"])
def test_the_producers_stream_is_waited_for(library: str) -> None:
    """The numbers are written by a stream that is still at work when trace is called."""
    torch = pytest.importorskip("torch")
    ready = [on_torch(array) for array in film_rays(100_000)]
    first = LENS.trace(*ready)
    expected = first.optical_path_mm.numpy()
    own = [first.origins_mm, first.directions]
    late = [torch.from_dlpack(array) for array in own]
    stream = torch.cuda.Stream()
    torch.cuda.synchronize()
    with torch.cuda.stream(stream):
        torch.cuda._sleep(200_000_000)  # clocks: a tenth of a second
        for array, values in zip(late, ready, strict=True):
            array.copy_(values)
        if library == "cupy":
            cupy = pytest.importorskip("cupy")
            with cupy.cuda.ExternalStream(stream.cuda_stream):
                out = LENS.trace(*(cupy.asarray(array) for array in late))
        else:
            inputs = {"torch": late, "dlpack": [Passed(array) for array in late], "realcam": own}[library]
            out = LENS.trace(*inputs)
    np.testing.assert_array_equal(out.optical_path_mm.numpy(), expected)


@pytest.mark.gpu
@needs_gpu
def test_a_gpu_that_is_not_there() -> None:
    with pytest.raises(rc.DeviceError, match=rf"no GPU 99; this machine has {len(GPUS)}"):
        small_camera().generate_rays(device="cuda:99")


@pytest.mark.gpu
@needs_two
def test_two_gpus() -> None:
    torch = pytest.importorskip("torch")
    origins, directions = film_rays()
    expected = LENS.trace(origins, directions, device="cuda:0")
    with torch.cuda.device(0):
        out = LENS.trace(*(torch.tensor(a, device="cuda:1") for a in (origins, directions)))
        rays = small_camera().generate_rays(device="cuda:1")
        assert torch.cuda.current_device() == 0
    assert {out.status.device, rays.weights.device} == {"cuda:1"}
    assert torch.from_dlpack(rays.weights).device == torch.device("cuda:1")
    np.testing.assert_array_equal(out.origins_mm.numpy(), expected.origins_mm)
    with pytest.raises(rc.InputError, match="origins_mm lies on cuda:0 and directions on cuda:1"):
        LENS.trace(on_torch(origins), torch.tensor(directions, device="cuda:1"))
    with pytest.raises(rc.InputError, match='lie on cuda:1, and device is "cuda:0"'):
        LENS.trace(*(torch.tensor(a, device="cuda:1") for a in (origins, directions)), device="cuda:0")
