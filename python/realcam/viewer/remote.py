"""A picture loop on another machine: the one that has the GPU photographs, this one serves the page.

The two speak through multiprocessing.connection, whose ends prove to each other that they know the same token. What
they send is not encrypted; over a network that others read, use an SSH tunnel. Messages are pickles of realcam's values
alone: anything else that a pickle could name is refused.
"""

from __future__ import annotations

import contextlib
import io
import itertools
import logging
import pickle
import threading
from collections.abc import Callable
from concurrent.futures import Future
from multiprocessing import AuthenticationError
from multiprocessing.connection import Client, Connection, Listener
from typing import Any

from .._core import Cancelled, DeviceError, InputError, RealcamError, Scene
from ..image import Image
from .picture_loop import PictureLoop
from .picture_request import Frame, PictureRequest, Point

_log = logging.getLogger(__name__)

_MOST_BYTES = 1 << 31  # a scene with its textures
_ALLOWED = {
    ("realcam.pickling", "restored"),
    ("realcam.image", "Image"),
    ("realcam.viewer.picture_request", "PictureRequest"),
    ("realcam.viewer.picture_request", "Frame"),
    ("realcam.viewer.picture_request", "Costs"),
    ("realcam.viewer.picture_request", "Point"),
    ("numpy", "dtype"),
    ("numpy", "ndarray"),
    ("numpy._core.numeric", "_frombuffer"),
    ("numpy.core.numeric", "_frombuffer"),
    ("numpy._core.multiarray", "_reconstruct"),
    ("numpy.core.multiarray", "_reconstruct"),
}


class _Unpickler(pickle.Unpickler):
    def find_class(self, module: str, name: str) -> Any:
        if (module, name) not in _ALLOWED:
            raise InputError(f"the other end has sent {module}.{name}, which is nothing of realcam's")
        return super().find_class(module, name)


class _Line:
    """A connection on which threads take turns to send."""

    def __init__(self, connection: Connection) -> None:
        self._connection = connection
        self._sending = threading.Lock()

    def send(self, *message: Any) -> None:
        """Raises OSError where the other end is gone."""
        content = pickle.dumps(message, protocol=5)
        with self._sending:
            self._connection.send_bytes(content)

    def receive(self) -> tuple[Any, ...]:
        """Raises EOFError and OSError where the other end is gone, and InputError for what is none of our messages."""
        content = self._connection.recv_bytes(_MOST_BYTES)
        try:
            message = _Unpickler(io.BytesIO(content)).load()
        except (pickle.UnpicklingError, AttributeError, IndexError, ValueError, EOFError) as error:
            raise InputError(f"the other end has sent no message: {error}") from None
        if not isinstance(message, tuple) or not message or not isinstance(message[0], str):
            raise InputError("the other end has sent no message")
        return message

    def close(self) -> None:
        with contextlib.suppress(OSError):
            self._connection.close()


class RemotePictureLoop:
    """What PictureLoop is, on the machine at `address`. Raises DeviceError where nobody there knows the token."""

    def __init__(
        self,
        scene: Scene,
        on_frame: Callable[[Frame], None],
        on_error: Callable[[int, str], None],
        *,
        address: tuple[str, int],
        token: str,
        max_bounces: int = 1,
        seed: int = 0,
        device: str = "",
    ) -> None:
        self._on_frame, self._on_error = on_frame, on_error
        try:
            self._line = _Line(Client(address, authkey=token.encode()))
        except AuthenticationError:
            raise DeviceError(f"{address[0]}:{address[1]} does not take the token") from None
        except (OSError, EOFError) as error:
            raise DeviceError(f"{address[0]}:{address[1]} does not answer: {error}") from None
        self._serials = itertools.count(1)
        self._questions: dict[int, Future[Any]] = {}
        self._numbers = itertools.count()
        self._is_closed = False
        self._quality = 85
        self._line.send("scene", scene, max_bounces, seed)
        self._thread = threading.Thread(target=self._listen, name="realcam-remote-picture", daemon=True)
        self._thread.start()

    def submit(self, request: PictureRequest) -> int:
        serial = next(self._serials)
        self._send("submit", request, serial)
        return serial

    def image(self) -> Future[Image]:
        return self._ask("image")

    def point(self, u: float, v: float, spot: float = 0.03) -> Future[Point]:
        return self._ask("point", u, v, spot)

    @property
    def jpeg_quality(self) -> int:
        return self._quality

    @jpeg_quality.setter
    def jpeg_quality(self, quality: int) -> None:
        if quality != self._quality:
            self._quality = quality
            self._send("quality", quality)

    def close(self) -> None:
        self._is_closed = True
        with contextlib.suppress(OSError):
            self._line.send("close")
        self._line.close()
        self._thread.join()

    def _ask(self, kind: str, *arguments: Any) -> Future[Any]:
        number, answer = next(self._numbers), Future[Any]()
        self._questions[number] = answer
        self._send("ask", number, kind, *arguments)
        return answer

    def _send(self, *message: Any) -> None:
        try:
            self._line.send(*message)
        except OSError as error:
            self._on_error(0, f"the machine that photographs is gone: {error}")

    def _listen(self) -> None:
        reason = "the machine that photographs is gone"
        try:
            while True:
                kind, *rest = self._line.receive()
                if kind == "frame":
                    self._on_frame(rest[0])
                    self._line.send("shown")
                elif kind == "error":
                    self._on_error(rest[0], rest[1])
                elif kind == "answer" and rest[0] in self._questions:
                    self._questions.pop(rest[0]).set_result(rest[1])
                elif kind == "refusal" and rest[0] in self._questions:
                    self._questions.pop(rest[0]).set_exception(InputError(rest[1]))
        except (EOFError, OSError):
            pass
        except InputError as error:
            reason = str(error)
        for answer in self._questions.values():
            answer.set_exception(Cancelled(reason))
        if not self._is_closed:
            self._on_error(0, reason)


def serve_pictures(host: str, port: int, token: str, device: str) -> None:
    """Photographs for other machines until Ctrl-C, each on a thread of its own. Raises OSError for a port in use."""
    with Listener((host, port), authkey=token.encode()) as listener:
        while True:
            try:
                connection = listener.accept()
            except (AuthenticationError, EOFError, ConnectionError) as error:
                _log.warning("refused a connection: %s", error)
                continue
            threading.Thread(target=_photograph_for, args=(_Line(connection), device), daemon=True).start()


class _Outbox:
    """The newest frame, of which one at a time is under way: a slow network must not fill memory."""

    def __init__(self, line: _Line) -> None:
        self._line, self._lock = line, threading.Lock()
        self._waiting: Frame | None = None
        self._is_under_way = False

    def put(self, frame: Frame) -> None:
        with self._lock:
            if self._is_under_way:
                self._waiting = frame
                return
            self._is_under_way = True
        self._send(frame)

    def shown(self) -> None:
        with self._lock:
            frame, self._waiting = self._waiting, None
            self._is_under_way = frame is not None
        if frame is not None:
            self._send(frame)

    def _send(self, frame: Frame) -> None:
        with contextlib.suppress(OSError):  # the one that listens ends the loop
            self._line.send("frame", frame)


def _photograph_for(line: _Line, device: str) -> None:
    loop: PictureLoop | None = None
    try:
        kind, *rest = line.receive()
        if kind != "scene":
            return
        outbox = _Outbox(line)
        # Serials are the other end's: the loop's own count the same requests from 1.
        scene, max_bounces, seed = rest
        loop = PictureLoop(
            scene,
            outbox.put,
            lambda serial, message: _say(line, "error", serial, message),
            device=device,
            max_bounces=max_bounces,
            seed=seed,
        )
        while True:
            kind, *rest = line.receive()
            if kind == "submit":
                loop.submit(rest[0])
            elif kind == "shown":
                outbox.shown()
            elif kind == "quality":
                loop.jpeg_quality = int(rest[0])
            elif kind == "ask":
                _answer(line, loop, *rest)
            elif kind == "close":
                return
    except (EOFError, OSError):
        pass
    except RealcamError as error:
        _say(line, "error", 0, str(error))
    finally:
        if loop:
            loop.close()
        line.close()


def _answer(line: _Line, loop: PictureLoop, number: int, kind: str, *arguments: Any) -> None:
    future: Future[Any] = loop.image() if kind == "image" else loop.point(*arguments)

    def tell(done: Future[Any]) -> None:
        error = done.exception()
        if error is None:
            _say(line, "answer", number, done.result())
        else:
            _say(line, "refusal", number, str(error))

    future.add_done_callback(tell)


def _say(line: _Line, *message: Any) -> None:
    with contextlib.suppress(OSError):
        line.send(*message)
