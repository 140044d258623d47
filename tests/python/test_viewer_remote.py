"""A renderer on another machine: `realcam view --photograph`, and what `--connect` makes of it."""

from __future__ import annotations

import pickle
import re
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from multiprocessing.connection import Client
from pathlib import Path

import numpy as np
import pytest
import realcam as rc
from realcam.bench import frame_scene

simplejpeg = pytest.importorskip("simplejpeg")
pytest.importorskip("nicegui")

from realcam.viewer.picture_request import Frame, PictureRequest  # noqa: E402
from realcam.viewer.remote import RemotePictureLoop  # noqa: E402

from .bench_pages import free_port  # noqa: E402

TOKEN = "the token of the tests"
CAMERA = rc.Camera(
    rc.Lens.load("double-gauss-50mm").focused(5.0),
    film=rc.Film(36, 24, (90, 60)),
    position=(0, 1, 3),
    look_at=(0, 0.4, -3),
    exposure_time_s=0.01,
)
REQUEST = PictureRequest(CAMERA, noise_codes=4.0)


class Photographer:
    """`realcam view --photograph` in a process of its own."""

    def __init__(self, folder: Path) -> None:
        self.port = free_port()
        self.log = folder / "photographer.log"
        self.start()

    def start(self) -> None:
        command = [sys.executable, "-m", "realcam", "view", "--photograph", "--device", "cpu"]
        with self.log.open("a") as log:
            self.process = subprocess.Popen(
                [*command, "--port", str(self.port), "--token", TOKEN], stdout=log, stderr=log
            )
        deadline = time.monotonic() + 60
        while time.monotonic() < deadline:
            try:
                socket.create_connection(("127.0.0.1", self.port), 1).close()
                return
            except OSError:
                assert self.process.poll() is None, self.log.read_text()
                time.sleep(0.1)
        raise AssertionError("nobody photographs")

    def kill(self) -> None:
        self.process.kill()
        self.process.wait()


class Watched:
    """A loop there, with what it has told here."""

    def __init__(self, port: int, token: str = TOKEN) -> None:
        self.frames: list[Frame] = []
        self.errors: list[str] = []
        self._news = threading.Condition()
        self.loop = RemotePictureLoop(
            SCENE,
            lambda frame: self._tell(self.frames, frame),
            lambda _, message: self._tell(self.errors, message),
            address=("127.0.0.1", port),
            token=token,
        )

    def _tell(self, whom: list, what: object) -> None:
        with self._news:
            whom.append(what)
            self._news.notify_all()

    def until(self, has_come: Callable[[], object], seconds: float = 60.0) -> None:
        with self._news:
            assert self._news.wait_for(has_come, seconds), (self.frames[-1:], self.errors)

    def until_done(self, serial: int) -> Frame:
        self.until(lambda: self.frames and self.frames[-1].serial == serial and self.frames[-1].is_final)
        return self.frames[-1]


SCENE = frame_scene(spheres=5, boxes=5)


@pytest.fixture(scope="module")
def photographer(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Photographer]:
    started = Photographer(tmp_path_factory.mktemp("photographer"))
    yield started
    started.kill()
    assert "Traceback" not in started.log.read_text()


@pytest.fixture
def watched(photographer: Photographer) -> Iterator[Watched]:
    made = Watched(photographer.port)
    yield made
    made.loop.close()


def test_it_photographs_as_the_machine_here_would(watched: Watched) -> None:
    frame = watched.until_done(watched.loop.submit(REQUEST))
    picture = simplejpeg.decode_jpeg(frame.jpeg).astype(float)
    here = rc.render(SCENE, CAMERA, spp=256, effects=()).developed().astype(float)
    assert picture.shape == here.shape
    # Noise as it was asked for, and what JPEG adds to it.
    assert np.sqrt(np.mean((picture - here) ** 2)) < 4.0 + 3.0
    assert watched.errors == []


def test_what_is_asked_of_it(watched: Watched) -> None:
    watched.until_done(watched.loop.submit(REQUEST))
    point = watched.loop.point(0.5, 0.7).result(60)
    image = watched.loop.image().result(60)
    assert image.camera == CAMERA
    assert point.distance_m == pytest.approx(float(image.depth[42, 45]), rel=0.05)


def test_what_cannot_be_is_told(watched: Watched) -> None:
    watched.loop.submit(PictureRequest(CAMERA, effects=("nonsense",)))
    watched.until(lambda: watched.errors)
    assert "nonsense" in watched.errors[-1]
    watched.until_done(watched.loop.submit(REQUEST))


def test_the_quality_that_is_set(watched: Watched) -> None:
    watched.loop.jpeg_quality = 40
    assert watched.until_done(watched.loop.submit(REQUEST)).jpeg_quality == 40


def test_two_benches_at_once(photographer: Photographer, watched: Watched) -> None:
    other = Watched(photographer.port)
    try:
        moved = PictureRequest(CAMERA.replace(position=(1, 1, 3)), noise_codes=4.0)
        frames = watched.until_done(watched.loop.submit(REQUEST)), other.until_done(other.loop.submit(moved))
        assert frames[0].jpeg != frames[1].jpeg
    finally:
        other.loop.close()


def test_a_machine_that_dies_and_comes_again(tmp_path: Path) -> None:
    photographer = Photographer(tmp_path)
    watched = Watched(photographer.port)
    try:
        watched.until_done(watched.loop.submit(REQUEST))
        photographer.kill()
        watched.until(lambda: watched.errors)
        assert f"127.0.0.1:{photographer.port}, the machine that photographs, is gone" in watched.errors[0]
        with pytest.raises(rc.Cancelled, match="is gone"):  # at once, so that the window's other actions are done
            watched.loop.point(0.5, 0.5).result(10)
        serial = watched.loop.submit(PictureRequest(CAMERA.replace(iso=200), noise_codes=4.0))
        photographer.start()
        watched.until_done(serial)
        assert watched.loop.image().result(60).camera.iso == 200
    finally:
        watched.loop.close()
        photographer.kill()


def test_closing_while_it_is_gone(tmp_path: Path) -> None:
    photographer = Photographer(tmp_path)
    watched = Watched(photographer.port)
    photographer.kill()
    watched.until(lambda: watched.errors)
    watched.loop.close()


def test_a_wrong_token(photographer: Photographer) -> None:
    with pytest.raises(rc.DeviceError, match="does not take the token"):
        Watched(photographer.port, token="another")


def test_nobody_there() -> None:
    port = free_port()
    with pytest.raises(rc.DeviceError, match=rf"127\.0\.0\.1:{port} does not answer"):
        Watched(port)


def test_somebody_else_there(monkeypatch: pytest.MonkeyPatch) -> None:
    """A server that waits for its client to speak first, as a web server does, and one that hangs up."""
    monkeypatch.setattr("realcam.viewer.remote._PATIENCE_S", 1)
    with socket.create_server(("127.0.0.1", 0)) as silent:
        with pytest.raises(rc.DeviceError, match="no machine that photographs: it says nothing"):
            Watched(silent.getsockname()[1])
        silent.accept()[0].close()  # that connection
        threading.Thread(target=lambda: silent.accept()[0].close(), daemon=True).start()
        with pytest.raises(rc.DeviceError, match="no machine that photographs"):
            Watched(silent.getsockname()[1])


def test_strangers_keep_nobody_waiting(photographer: Photographer) -> None:
    """One that says nothing, one that says nonsense, and one that knows the token and sends something else."""
    silent = socket.create_connection(("127.0.0.1", photographer.port))
    loud = socket.create_connection(("127.0.0.1", photographer.port))
    loud.sendall(b"GET / HTTP/1.1\r\n\r\n" * 100)
    known = Client(("127.0.0.1", photographer.port), authkey=TOKEN.encode())
    known.send_bytes(pickle.dumps(("scene", subprocess.Popen, 1, 0)))
    kind, _, message = pickle.loads(known.recv_bytes())
    assert kind == "error"
    assert re.search(r"subprocess\.Popen, which is nothing of realcam's", message)
    watched = Watched(photographer.port)
    try:
        watched.until_done(watched.loop.submit(REQUEST))
    finally:
        watched.loop.close()
        for line in (silent, loud, known):
            line.close()


def test_a_port_in_use(photographer: Photographer) -> None:
    command = [sys.executable, "-m", "realcam", "view", "--photograph", "--port", str(photographer.port)]
    ended = subprocess.run(command, capture_output=True, text=True, timeout=60)
    assert ended.returncode != 0
    assert "Traceback" not in ended.stderr
    assert str(photographer.port) in ended.stderr
