"""Behaviour of GPUs under adverse conditions: no driver, little memory, another process, Ctrl-C."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest
import realcam as rc
from frame_scene import frame_scene

from ..device_memory import needs_gpu, needs_two

one_or_several = pytest.mark.parametrize("device", ["cuda:0", pytest.param("cuda:0,1", marks=needs_two)])

LENS = rc.Lens.load("tessar-50mm").focused(4.0)

TAKE = """
import realcam as rc
from frame_scene import frame_scene
lens = rc.Lens.load("tessar-50mm").focused(4.0)
camera = rc.Camera(lens, film=rc.Film(36, 24, (90, 60)), position=(0, 1, 3), look_at=(0, 0.6, -2))
scene = frame_scene(spheres=3, boxes=3)
"""


def camera(resolution: tuple[int, int] = (90, 60)) -> rc.Camera:
    return rc.Camera(LENS, film=rc.Film(36, 24, resolution), position=(0, 1, 3), look_at=(0, 0.6, -2))


def run(code: str, **environment: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-c", TAKE + code],
        env=os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)} | environment,
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )


def test_where_no_gpu_is_to_be_seen_the_cpu_serves() -> None:
    done = run(
        """
assert [device.name for device in rc.devices()] == ["cpu"], rc.devices()
image = rc.render(scene, camera, spp=1, device="auto")
assert image.stats.device.startswith("CPU"), image.stats.device
try:
    rc.render(scene, camera, spp=1, device="cuda")
except rc.DeviceError as error:
    print(error)
""",
        CUDA_VISIBLE_DEVICES="",
    )
    assert done.returncode == 0, done.stderr
    assert "GPU" in done.stdout or "driver" in done.stdout or "nvcc" in done.stdout


@needs_gpu
def test_a_gpu_that_is_not_there_is_named() -> None:
    with pytest.raises(rc.DeviceError, match=r"no GPU 77.*counted from 0"):
        rc.render(frame_scene(spheres=1, boxes=1), camera(), effects=(), device="cuda:77")


@pytest.mark.parametrize("name", ["gpu", "cuda:", "cuda:x", "cuda:0,", "cuda:-1", "cuda:0,0", "cuda0", ""])
def test_a_device_that_makes_no_sense_is_the_users_mistake(name: str) -> None:
    with pytest.raises(rc.InputError, match="no device"):
        rc.render(frame_scene(spheres=1, boxes=1), camera(), effects=(), device=name)


@needs_gpu
@pytest.mark.gpu
def test_two_processes_share_a_gpu() -> None:
    code = "\nprint(repr(float(rc.render(scene, camera, spp=400, device='cuda').pixels.astype(float).sum())))"
    processes = [
        subprocess.Popen([sys.executable, "-c", TAKE + code], stdout=subprocess.PIPE, text=True) for _ in range(2)
    ]
    sums = [process.communicate(timeout=300)[0] for process in processes]
    assert all(process.returncode == 0 for process in processes)
    assert sums[0] == sums[1] != ""


@needs_gpu
@pytest.mark.gpu
@pytest.mark.slow
def test_a_film_that_does_not_fit_is_taken_in_bands() -> None:
    torch = pytest.importorskip("torch")
    scene, wide = frame_scene(spheres=3, boxes=3), camera((6000, 4000))
    expected = rc.render(scene, wide, effects=(), spp=2, device="cuda:0").pixels
    # In a process of its own, because a backend keeps the memory that it once had.
    code = """
import numpy, torch
wide = rc.Camera(lens, film=rc.Film(36, 24, (6000, 4000)), position=(0, 1, 3), look_at=(0, 0.6, -2))
rc.render(scene, camera, spp=1, device="cuda:0")
free, _ = torch.cuda.mem_get_info(0)
hog = torch.empty(free - (600 << 20), dtype=torch.uint8, device="cuda:0")  # the film alone has 960 MB of sums
pixels = rc.render(scene, wide, effects=(), spp=2, device="cuda:0").pixels.astype(float)
print(repr(float(pixels.sum())), repr(float(pixels[::-1][:100].sum())))
"""
    done = run(code)
    assert done.returncode == 0, done.stderr
    sums = [float(text) for text in done.stdout.split()]
    np.testing.assert_allclose(
        sums, [expected.astype(float).sum(), expected[::-1][:100].astype(float).sum()], rtol=1e-12
    )
    assert torch.cuda.is_available()


@needs_gpu
@pytest.mark.gpu
@one_or_several
def test_progress_stops_a_picture_soon(device: str) -> None:
    """This includes an expensive scene after a cheap one."""
    wide = camera((1200, 800))
    sky = rc.Scene.from_arrays([[0, 0, 1e5], [1e-3, 0, 1e5], [0, 1e-3, 1e5]], [[0, 1, 2]]).with_environment(1.0)
    rc.render(sky, wide, effects=(), spp=4096, max_bounces=0, device=device)  # many samples a millisecond
    for scene, bounces in ((frame_scene(spheres=3, boxes=3), 1), (frame_scene(), 64)):
        settings = rc.RenderSettings(effects=(), max_bounces=bounces)
        times: list[float] = []

        def progress(_: float, times: list[float] = times) -> bool:
            times.append(time.perf_counter())
            return len(times) < 3

        with pytest.raises(rc.Cancelled):
            rc.render(scene, wide, settings, spp=1 << 20, device=device, progress=progress)
        # The picture takes many minutes. What is under way ends within a sample of each thread, which takes a GPU some
        # milliseconds: of a path of 65 bounces, each a ray and a shadow ray. Most of a tenth is slack.
        assert time.perf_counter() - times[-1] < 0.1
        assert rc.render(scene, wide, settings, spp=1, device=device).spp == 1


@needs_gpu
@pytest.mark.gpu
@one_or_several
def test_ctrl_c_stops_a_picture(device: str) -> None:
    scene, wide = frame_scene(spheres=3, boxes=3), camera((1200, 800))
    rc.render(scene, wide, effects=(), spp=1, device=device)
    times: list[float] = []

    def interrupt() -> None:
        times.append(time.perf_counter())
        os.kill(os.getpid(), signal.SIGINT)

    threading.Timer(0.3, interrupt).start()
    with pytest.raises(KeyboardInterrupt):
        rc.render(scene, wide, effects=(), spp=1 << 20, device=device)
    assert time.perf_counter() - times[0] < 0.3  # signals are looked for 20 times a second
    assert rc.render(scene, wide, effects=(), spp=1, device=device).spp == 1


CURRENT = """
import ctypes
driver = ctypes.CDLL("libcuda.so.1")

def call(name, *arguments):
    code = getattr(driver, name)(*arguments)
    assert code == 0, (name, code)

context = ctypes.c_void_p()
call("cuInit", 0)
call("cuDevicePrimaryCtxRetain", ctypes.byref(context), 0)
call("cuCtxSetCurrent", context)

def current():
    device = ctypes.c_int(-1)
    call("cuCtxGetDevice", ctypes.byref(device))
    return device.value
"""


@needs_gpu
@pytest.mark.gpu
@pytest.mark.parametrize(
    "device", ["cuda:0", pytest.param("cuda:1", marks=needs_two), pytest.param("cuda:0,1", marks=needs_two)]
)
def test_the_callers_gpu_stays_current(device: str) -> None:
    last = f"cuda:{device[-1]}"
    code = f"""
import gc

def frame():
    live = rc.LiveView(scene, device={last!r})  # kept, because a view that is gone stops its frames
    return live.shoot(camera, spp=1).codes

for take in (
    lambda: rc.render(scene, camera, spp=1, device={device!r}),
    lambda: rc.render(scene, camera, spp=1, device={device!r}, progress=lambda share: True),
    frame,
    lambda: rc.LiveView(scene, device={last!r}).cancel(),
    lambda: camera.generate_rays(spp=1, device={last!r}),
):
    take()
    gc.collect()
    assert current() == 0, current()
"""
    done = run(CURRENT + code)
    assert done.returncode == 0, done.stderr


@needs_two
@pytest.mark.gpu
def test_a_view_of_the_second_gpu_goes_on_in_another_thread() -> None:
    live = rc.LiveView(frame_scene(spheres=3, boxes=3), device="cuda:1")
    live.shoot(camera(), spp=4)
    taken: list[np.ndarray] = []

    def go_on() -> None:
        frame = live.shoot(camera(), spp=4)
        taken.extend([frame.codes, live.picture()[0].numpy()])

    thread = threading.Thread(target=go_on)  # its current GPU is the first one
    thread.start()
    thread.join()
    expected = rc.render(
        frame_scene(spheres=3, boxes=3), camera(), effects=(), spp=8, max_bounces=1, device="cuda:1"
    ).pixels
    np.testing.assert_allclose(taken[1], expected, rtol=1e-6)


@needs_two
@pytest.mark.gpu
def test_a_gpu_without_a_sample_adds_nothing() -> None:
    scene, wide = frame_scene(spheres=3, boxes=3), camera((1200, 800))
    expected = rc.render(scene, wide, effects=(), spp=1, device="cuda:0").pixels
    for _ in range(20):
        # Samples that the second GPU takes in this picture must not appear in the next one.
        rc.render(scene, wide, effects=(), spp=64, device="cuda:0,1")
        np.testing.assert_array_equal(rc.render(scene, wide, effects=(), spp=1, device="cuda:0,1").pixels, expected)


# A kernel of another library in the same process that traps. From then on every call on that GPU fails until the
# process ends, as where the GPU falls off its bus: both are errors that stay.
LOSE = r"""
import ctypes, threading, time
driver = ctypes.CDLL("libcuda.so.1")

def fall_of(ordinal):
    # Loaded beforehand: loading waits for kernels that run.
    def call(name, *arguments):
        code = getattr(driver, name)(*arguments)
        assert code == 0, (name, code)
    context, module, kernel, stream = (ctypes.c_void_p() for _ in range(4))
    call("cuInit", 0)
    call("cuDevicePrimaryCtxRetain", ctypes.byref(context), ordinal)
    call("cuCtxSetCurrent", context)
    text = b".version 7.0\n.target sm_75\n.address_size 64\n.visible .entry fall() { trap; }"
    call("cuModuleLoadData", ctypes.byref(module), text)
    call("cuModuleGetFunction", ctypes.byref(kernel), module, b"fall")
    call("cuStreamCreate", ctypes.byref(stream), 1)  # one that waits for no other
    def fall():
        call("cuCtxSetCurrent", context)
        call("cuLaunchKernel", kernel, 1, 1, 1, 1, 1, 1, 0, stream, None, None)
    return fall

wide = rc.Camera(lens, film=rc.Film(36, 24, (1200, 800)), position=(0, 1, 3), look_at=(0, 0.6, -2))
"""


@needs_gpu
@pytest.mark.gpu
@one_or_several
def test_a_gpu_lost_in_mid_frame(device: str, tmp_path: Path) -> None:
    picture = tmp_path / "picture.exr"
    code = f"""
rc.render(scene, wide, spp=1, device={device!r})
threading.Timer(0.5, fall_of({device[-1]})).start()
start = time.perf_counter()
for i in range(2):  # it stays lost
    try:
        rc.render(scene, wide, spp=1 << 20, device={device!r}).save({str(picture)!r})
    except rc.DeviceError as error:
        print(error)
assert time.perf_counter() - start < 30, "the picture takes many minutes"
assert rc.render(scene, camera, spp=1, device="cpu").spp == 1
"""
    done = run(LOSE + code)
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("the GPU failed while") == 2, done.stdout
    assert not list(tmp_path.iterdir())


@needs_gpu
@pytest.mark.gpu
def test_a_gpu_lost_under_a_live_view() -> None:
    code = """
live = rc.LiveView(scene, device="cuda")
# Few pixels leave multiprocessors free for the kernel that falls; all those samples take them seconds.
few = rc.Camera(lens, film=rc.Film(36, 24, (20, 10)), position=(0, 1, 3), look_at=(0, 0.6, -2))
live.shoot(few, spp=1).codes
fall = fall_of(0)
frame = live.shoot(few, spp=1 << 23)
fall()
for shoot in (lambda: frame.codes, lambda: live.shoot(camera, spp=1).codes, lambda: rc.LiveView(scene, device="cuda")):
    try:
        shoot()
    except rc.DeviceError as error:
        print(error)
try:
    live.cancel()
except rc.DeviceError:
    pass
"""
    done = run(LOSE + code)
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("the GPU failed while") == 3, done.stdout
