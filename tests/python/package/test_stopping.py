"""Long calls hear Ctrl-C; threads that work while Python ends or forks do no harm; no more threads than there can be.

Each runs in a process of its own, which prints "ready" when the call in question is about to begin.
"""

from __future__ import annotations

import signal
import subprocess
import sys
import textwrap
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
import realcam as rc

PREPARE = """
import os, sys, threading, time
import numpy as np
import realcam as rc

def room():
    corners = np.array([(x, y, z) for x in (-2, 2) for y in (-2, 2) for z in (-2, 2)], float)
    sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = [triangle for a, b, c, d in sides for triangle in ((a, c, b), (a, d, c))]
    white = rc.Material(diffuse=(0.98, 0.98, 0.98), emission=(1, 1, 1))
    return rc.Scene.from_arrays(corners, faces, materials=[white])

camera = rc.Camera(rc.Lens.load("double-gauss-50mm"), film=rc.Film(36, 24, (600, 400)))
"""


def child(code: str) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-c", PREPARE + textwrap.dedent(code)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


@contextmanager
def started(code: str) -> Iterator[subprocess.Popen[str]]:
    process = child(code)
    try:
        assert process.stdout is not None
        while (line := process.stdout.readline()) != "ready\n":
            assert line, process.communicate()[1]
        yield process
    finally:
        process.kill()
        process.wait()


LONG_CALLS = {
    # 25 s, and a tile of 1024 pixels takes 4 s.
    "64 bounces": 'rc.render(room(), camera, effects=(), spp=256, max_bounces=64, device="cpu")',
    # This render waits for another thread's picture.
    "a second picture": """
        work = lambda: rc.render(room(), camera, effects=(), max_bounces=1, spp=4096, device="cpu")
        threading.Thread(target=work, daemon=True).start()
        time.sleep(0.3)
        rc.render(room(), camera, effects=(), max_bounces=1, spp=1, device="cpu")
        """,
    "metering": 'while True: camera.metered(room(), device="cpu", max_bounces=64)',
    "a session": 'rc.Session(room(), camera, device="cpu", max_bounces=64, effects=()).add(256)',
    "a session in another thread": """
        session = rc.Session(room(), camera, device="cpu", effects=())
        threading.Thread(target=lambda: session.add(4096), daemon=True).start()
        time.sleep(0.3)
        session.image()
        """,
    "a frame that waits for another": """
        live = rc.LiveView(room(), device="cpu", max_bounces=64)
        for _ in range(2):
            live.shoot(camera, spp=256)
        """,
    "the picture of frames": """
        live = rc.LiveView(room(), device="cpu", max_bounces=64)
        live.shoot(camera, spp=256)
        live.picture()
        """,
}


@pytest.mark.parametrize("what", LONG_CALLS)
def test_a_long_call_hears_ctrl_c(what: str) -> None:
    """Within one second; leaving Python takes another half at most on a busy machine."""
    code = textwrap.dedent(LONG_CALLS[what])
    with started(f'room(); print("ready", flush=True)\n{code}') as process:
        time.sleep(0.6)
        process.send_signal(signal.SIGINT)
        start = time.monotonic()
        _, errors = process.communicate(timeout=60)
        assert time.monotonic() - start < 1.5
    assert "KeyboardInterrupt" in errors
    assert "terminate" not in errors


def test_developing_hears_ctrl_c() -> None:
    """250 million numbers take over a second."""
    code = """
        exposure = np.full((1, 250_000_000), 0.02, np.float32)
        print("ready", flush=True)
        try:
            rc._core.develop(exposure, 100.0)
        except KeyboardInterrupt:
            print("heard", flush=True)
        """
    with started(code) as process:
        time.sleep(0.3)
        process.send_signal(signal.SIGINT)
        start = time.monotonic()
        assert process.stdout is not None
        assert process.stdout.readline() == "heard\n"
        assert time.monotonic() - start < 0.5


ONE_SAMPLE = rc.RenderSettings(effects=(), max_bounces=1, spp=1)


def grid_scene(side: int) -> rc.Scene:
    x, y = np.meshgrid(np.arange(side, dtype=float), np.arange(side, dtype=float))
    corners = np.stack([x, np.sin(x * y), y], axis=-1).reshape(-1, 3)
    first = (np.arange(side - 1)[:, None] * side + np.arange(side - 1)).reshape(-1, 1)
    triangles = np.concatenate([first + np.array((0, 1, side)), first + np.array((1, side + 1, side))])
    return rc.Scene.from_arrays(corners, triangles).with_environment(1)


def test_the_hierarchy_is_left_unfinished() -> None:
    """The first answer of the progress function, long before all triangles are in it, ends the work."""
    camera = rc.Camera(rc.Lens.load("tessar-50mm"), film=rc.Film(36, 24, (3, 2)), position=(0, 3, 3))
    scene = grid_scene(1225)
    told: list[float] = []
    with pytest.raises(rc.Cancelled):
        rc.render(scene, camera, ONE_SAMPLE, device="cpu", progress=lambda done: bool(told.append(done)))
    assert len(told) == 1
    assert told[0] < 0.5
    told.clear()
    image = rc.render(scene, camera, ONE_SAMPLE, device="cpu", progress=told.append)  # builds it from scratch
    assert told.count(0) >= 2
    assert told == sorted(told)
    assert told[-1] == 1
    assert image.pixels.any()
    assert rc.render(scene, camera, ONE_SAMPLE, device="cpu") == image


AT_WORK = {
    "render": 'rc.render(room(), camera, effects=(), max_bounces=1, spp=64, device="cpu")',
    "session": 'rc.Session(room(), camera, device="cpu", effects=()).add(64)',
    "live": "live.shoot(camera, spp=64).codes",
    "generate_rays": "camera.generate_rays(spp=20)",
    "trace": "camera.lens.trace(np.full((3_000_000, 3), (0.0, 0.0, 80.0)), np.full((3_000_000, 3), (0.0, 0.0, -1.0)))",
    "wavefront": "camera.lens.wavefront(5, samples=512)",
    "psf": "camera.lens.psf(5, size=512)",
    "develop": "rc._core.develop(np.full(30_000_000, 0.02, np.float32), 100.0)",
}


def ends_cleanly(code: str) -> str:
    """Runs the code in a process that must end without errors. Returns the process's stderr."""
    process = child(code)
    _, errors = process.communicate(timeout=60)
    assert process.returncode == 0, errors
    assert "terminate" not in errors
    return errors


@pytest.mark.parametrize("what", AT_WORK)
def test_python_ends_cleanly_while_a_daemon_thread_works(what: str) -> None:
    code = f"""
        live = rc.LiveView(room(), device="cpu")
        def work():
            while True:
                {AT_WORK[what]}
        threading.Thread(target=work, daemon=True).start()
        time.sleep(0.4)
        """
    start = time.monotonic()
    ends_cleanly(code)
    assert time.monotonic() - start < 6  # a second of import and sleep, and the end of what is under way


@pytest.mark.parametrize("kept", ["live", "frame"])
def test_python_ends_cleanly_with_a_frame_under_way(kept: str) -> None:
    """The frame would take minutes. Only the view, or only the frame, is still referenced, from a reference cycle."""
    code = f"""
        live = rc.LiveView(room(), device="cpu", max_bounces=64)
        frame = live.shoot(camera, spp=1 << 20)
        cycle = [{kept}]
        cycle.append(cycle)
        del live, frame
        time.sleep(0.3)
        """
    assert not ends_cleanly(code)


def test_a_process_forked_amid_a_frame_says_why_it_does_not_work() -> None:
    code = """
        live = rc.LiveView(room(), device="cpu", max_bounces=64)
        frame = live.shoot(camera, spp=1 << 20)
        child = os.fork()
        if child == 0:
            for work in (lambda: frame.codes, lambda: live.shoot(camera), lambda: live.cancel()):
                try:
                    work()
                except rc.InputError as error:
                    print(error, flush=True)
            del live, work  # which waits for nobody
            os._exit(0)
        print(os.waitpid(child, 0)[1], flush=True)
        live.cancel()
        """
    out, errors = child(code).communicate(timeout=30)
    lines = out.splitlines()
    assert len(lines) == 4, (out, errors)
    assert all(line.startswith("this process was forked while") for line in lines[:3])
    assert lines[3] == "0"


PICTURES = {
    "write": 'image.save("b.png")',
    "read": 'rc.read_environment("a.exr")',
    "read a shot's": 'rc.Shot.load("shot.toml")',
}
SHOT = f"""
format = 1
scene = {str(Path(__file__).resolve().parents[3] / "scenes" / "demo.glb")!r}
lens = "tessar-50mm"
environment = "a.exr"
exposure_time_s = 0.01
"""


@pytest.mark.picture_files
@pytest.mark.parametrize("what", PICTURES)
def test_python_ends_cleanly_while_a_daemon_thread_is_at_a_picture(what: str, tmp_path: Path) -> None:
    (tmp_path / "shot.toml").write_text(SHOT)
    code = f"""
        os.chdir({str(tmp_path)!r})
        image = rc.render(room(), camera.replace(film=rc.Film(36, 24, (900, 600))), effects=(), spp=1, device="cpu")
        image.save("a.exr")
        once = threading.Event()
        def work():
            while True:
                {PICTURES[what]}
                once.set()
        threading.Thread(target=work, daemon=True).start()
        assert once.wait(30)
        time.sleep(0.3)
        """
    ends_cleanly(code)


FORK = """
    lit = room()
    ended = False
    def work():
        rc.render(lit, camera, effects=(), max_bounces=1, spp=10**6, device="cpu", progress=lambda done: not ended)
    thread = threading.Thread(target=work)
    if {concurrent}:
        thread.start()
        time.sleep(0.5)
    else:
        rc.render(lit, camera, effects=(), max_bounces=1, spp=1, device="cpu")
    child = os.fork()
    if child == 0:
        try:
            image = rc.render(lit, camera.replace(film=rc.Film(36, 24, (30, 20))), effects=(), spp=1, device="cpu")
            print("rendered", image.pixels.shape, flush=True)
        except rc.InputError as error:
            print(error, flush=True)
        os._exit(0)
    print(os.waitpid(child, 0)[1], flush=True)
    ended = True
"""


@pytest.mark.parametrize("concurrent", [True, False])
def test_a_forked_process_works_or_says_why_not(concurrent: bool) -> None:
    out, errors = child(FORK.format(concurrent=concurrent)).communicate(timeout=30)
    expected = "this process was forked while another thread was running" if concurrent else "rendered (20, 30, 3)"
    assert out.splitlines()[0].startswith(expected), (out, errors)
    assert out.splitlines()[1] == "0"


def test_a_process_forked_amid_a_render_ends_at_once() -> None:
    """sys.exit in the child runs the exit handler that waits for renders; the child has no render to wait for."""
    code = """
        work = lambda: rc.render(room(), camera, effects=(), max_bounces=1, spp=10**6, device="cpu")
        thread = threading.Thread(target=work, daemon=True)
        thread.start()
        time.sleep(0.5)
        if os.fork() == 0:
            sys.exit()  # the pipes close when it has ended, and after the parent has
        os.kill(os.getpid(), 9)
        """
    process = child(code)
    begin = time.monotonic()
    process.communicate(timeout=30)
    assert time.monotonic() - begin < 8  # the wait for work would last 10 s


def test_more_threads_than_cores_are_no_reason_for_a_warning(capfd: pytest.CaptureFixture[str]) -> None:
    scene = rc.Scene.from_arrays([(0, 0, -2), (1, 0, -2), (0, 1, -2)], [(0, 1, 2)]).with_environment(1)
    camera = rc.Camera(rc.Lens.load("tessar-50mm"), film=rc.Film(36, 24, (3, 2)))
    many = rc.render(scene, camera, ONE_SAMPLE, threads=1000, device="cpu")
    assert capfd.readouterr().err == ""
    assert many == rc.render(scene, camera, ONE_SAMPLE, device="cpu")


def test_no_thread_to_be_had_is_told() -> None:
    """A thread wants 8 MB of addresses for its stack; with less, or a little more, there is one sentence."""
    code = """
        import resource
        lit, small = room(), camera.replace(film=rc.Film(36, 24, (3, 2)))
        try:
            # Starts Embree alone.
            rc.render(lit, small.replace(model="thin"), effects=["ghosts"], max_bounces=1, device="cpu")
        except rc.InputError:
            pass
        size = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
        resource.setrlimit(resource.RLIMIT_AS, (size + {room} * 2**20,) * 2)
        try:
            rc.render(lit, small, effects=(), max_bounces=1, spp=1, device="cpu", progress=lambda done: True)
            print("rendered", flush=True)
        except (rc.DeviceError, MemoryError) as error:
            print(error, flush=True)
        """
    answers = []
    for room in (2, 9, 12, 16):
        process = child(code.format(room=room))
        out, errors = process.communicate(timeout=60)
        assert process.returncode == 0, errors
        answers.append(out.strip())
    told = "the system could not start a thread; allow more memory (ulimit -v) or threads (ulimit -u)"
    assert answers[0] == told
    assert set(answers) <= {told, "out of memory", "rendered"}


def renders_of(process: int) -> list[str]:
    """matplotlib starts other programs when it is imported for the first time."""
    children = Path(f"/proc/{process}/task/{process}/children").read_text().split()
    return [child for child in children if b"\0render\0" in Path(f"/proc/{child}/cmdline").read_bytes()]


@pytest.mark.picture_files
def test_the_demo_takes_its_render_along_when_it_is_terminated(tmp_path: Path) -> None:
    """The render process ends with the demo, and no empty folder is left behind."""
    command = [sys.executable, "-m", "realcam", "demo", "-o", str(tmp_path / "a" / "b"), "--spp", str(2**24)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        end = time.monotonic() + 30
        while not (children := renders_of(process.pid)) and time.monotonic() < end:
            time.sleep(0.05)
        time.sleep(0.5)
        process.terminate()
        _, errors = process.communicate(timeout=30)
        assert process.returncode == 128 + signal.SIGTERM, errors
        assert b"Traceback" not in errors
    assert children
    assert not Path(f"/proc/{children[0]}").exists()
    assert list(tmp_path.iterdir()) == []
