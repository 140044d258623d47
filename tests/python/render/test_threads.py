"""Sessions under several threads: no lock is waited for with the interpreter's held, and a picture is of one state."""

from __future__ import annotations

import signal
import subprocess
import sys
import threading
from types import FrameType

import pytest
import realcam as rc

from .. import scenes
from ..programs import loads_cuda_plugins

FILM = rc.Film(36, 27, (40, 30))
WALL = scenes.quad((0, 0, -3), 3, diffuse=0.6)


def room(lux: float) -> rc.Scene:
    return scenes.scene_of(WALL).with_environment(lux)


def camera() -> rc.Camera:
    return rc.Camera(rc.Lens.load("tessar-50mm").focused(3.0), film=FILM, exposure_time_s=1)


WARNED = """
import os
os.environ["REALCAM_CUDA_PLUGIN"] = "/nowhere/plugin.so"
import threading, time, warnings
import realcam as rc

mesh = [(-1, -1, -3), (1, -1, -3), (0, 1, -3)], [(0, 1, 2)]
scene = rc.Scene.from_arrays(*mesh).with_environment(100)
camera = rc.Camera(rc.Lens.load("tessar-50mm"), film=rc.Film(36, 24, (6, 4)), exposure_time_s=0.01)
take = {take}
warns = threading.Event()

def show(*_, **__):
    warns.set()
    time.sleep(0.3)  # with the lock of the interpreter free: the other thread comes as far as it can

warnings.showwarning = show
thread = threading.Thread(target=take)
thread.start()
warns.wait()
take()
thread.join()
print("both")
"""
TAKES = {
    "render": 'lambda: rc.render(scene, camera, effects=(), max_bounces=1, spp=1, device="auto")',
    "metered": 'lambda: camera.metered(scene, device="auto")',
}


@pytest.mark.parametrize("take", TAKES)
def test_a_warning_while_a_device_opens_blocks_no_other_thread(take: str) -> None:
    if not loads_cuda_plugins():
        pytest.skip("this build has the CUDA backend inside, and warns of no plug-in")
    code = WARNED.replace("{take}", TAKES[take])
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert (done.returncode, done.stdout.strip(), done.stderr) == (0, "both", "")


def test_a_picture_is_of_the_scene_that_was_set_last() -> None:
    """Samples that another thread adds while set() works are of the new scene, or are given up with the old one."""
    lights = {10.0: room(10.0), 1000.0: room(1000.0)}
    session = rc.Session(lights[10.0], camera(), device="cpu", effects=(), max_bounces=0)
    for lux in [1000.0, 10.0] * 10:
        thread = threading.Thread(target=session.add, args=(1,))
        thread.start()
        session.set(scene=lights[lux])
        thread.join()
        if not session.samples.any():
            continue  # they were given up
        # The wall is dark without bounces; the sky beside it has the environment's luminance.
        brightest = session.image().pixels.max()
        expected = rc.render(lights[lux], camera(), effects=(), max_bounces=0, spp=1, device="cpu").pixels.max()
        assert brightest == pytest.approx(expected, rel=0.2)
        assert session.scene == lights[lux]


@pytest.mark.parametrize("kind", ["render", "session"])
def test_a_signal_handler_cannot_use_the_session_it_interrupts(kind: str) -> None:
    scene, view = room(10.0), camera()
    session = rc.Session(scene, view, device="cpu", effects=())

    def take(spp: int) -> None:
        if kind == "session":
            session.add(spp)
        else:
            rc.render(scene, view, effects=(), spp=spp, device="cpu")

    def handler(_number: int, _frame: FrameType | None) -> None:
        take(1)

    before = signal.signal(signal.SIGALRM, handler)
    signal.setitimer(signal.ITIMER_REAL, 0.3)
    try:
        with pytest.raises(rc.InputError, match="a signal handler cannot take a picture with the session"):
            take(1 << 20)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    take(1)
