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
import os
import pickle
import socket
import struct
import threading
from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import replace
from multiprocessing import AuthenticationError
from multiprocessing.connection import Connection, answer_challenge, deliver_challenge
from typing import Any

from .._core import Cancelled, DeviceError, InputError, RealcamError, Scene
from ..image import Image
from .picture_loop import PictureLoop
from .picture_request import Frame, PictureRequest, Point

_log = logging.getLogger(__name__)

_MOST_BYTES = 1 << 31  # a scene with its textures
_PATIENCE_S = 10  # with a machine that has not yet said who it is
_PAUSE_S = 2.0  # between two attempts to reach a machine that has gone
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
    """A connection on which threads take turns to send, and one thread receives."""

    def __init__(self, line: socket.socket) -> None:
        line.settimeout(None)
        line.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)  # a frame's end need not wait for an answer
        line.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)  # a machine that is switched off says no word
        self._socket = line
        self._connection = Connection(os.dup(line.fileno()))
        self._sending = threading.Lock()

    def prove(self, token: str, *, is_first: bool) -> None:
        """Both ends show that they know the token. Raises AuthenticationError, EOFError and OSError."""
        steps = (deliver_challenge, answer_challenge) if is_first else (answer_challenge, deliver_challenge)
        self._wait_at_most(_PATIENCE_S)
        try:
            for step in steps:
                step(self._connection, token.encode())
        except BlockingIOError:
            raise TimeoutError("it says nothing") from None
        self._wait_at_most(0)

    def _wait_at_most(self, seconds: int) -> None:
        """For the next bytes; 0: for ever. A timeout of Python's socket would not hold for the Connection."""
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVTIMEO, struct.pack("ll", seconds, 0))

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

    def end(self) -> None:
        """From any thread: the one that receives finds the end."""
        with contextlib.suppress(OSError):
            self._socket.shutdown(socket.SHUT_RDWR)

    def close(self) -> None:
        """From the thread that receives."""
        self.end()
        self._socket.close()
        self._connection.close()


class RemotePictureLoop:
    """What PictureLoop is, on the machine at `address`. Raises DeviceError where nobody there knows the token.

    When that machine has gone, it is looked for until it is there again, and the newest picture is asked for once more.
    """

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
        self._address, self._token = address, token
        self._scene = scene, max_bounces, seed
        self._lock = threading.Lock()  # of all below
        self._serial = self._serials_before = 0  #: the other end counts what it is asked for on one line from 1
        self._wanted: PictureRequest | None = None
        self._quality = 85
        self._questions: dict[int, Future[Any]] = {}
        self._numbers = itertools.count()
        self._closing = threading.Event()
        self._line: _Line | None = self._connected()
        self._thread = threading.Thread(target=self._listen, name="realcam-remote-picture", daemon=True)
        self._thread.start()

    def submit(self, request: PictureRequest) -> int:
        with self._lock:
            self._serial += 1
            self._wanted = request
            self._send("submit", request)
            return self._serial

    def image(self) -> Future[Image]:
        return self._ask("image")

    def point(self, u: float, v: float) -> Future[Point]:
        return self._ask("point", u, v)

    @property
    def jpeg_quality(self) -> int:
        return self._quality

    @jpeg_quality.setter
    def jpeg_quality(self, quality: int) -> None:
        with self._lock:
            if quality != self._quality:
                self._quality = quality
                self._send("quality", quality)

    def close(self) -> None:
        self._closing.set()
        with self._lock:
            if self._line:
                self._line.end()
        self._thread.join()

    def _ask(self, kind: str, *arguments: Any) -> Future[Any]:
        answer: Future[Any] = Future()
        with self._lock:
            if self._line is None:
                answer.set_exception(Cancelled(self._gone))
            else:
                number = next(self._numbers)
                self._questions[number] = answer
                self._send("ask", number, kind, *arguments)
        return answer

    @property
    def _gone(self) -> str:
        return f"{_named(self._address)}, the machine that photographs, is gone; it is looked for"

    def _send(self, *message: Any) -> None:
        if self._line:
            with contextlib.suppress(OSError):  # the thread that receives finds the end
                self._line.send(*message)

    def _connected(self) -> _Line:
        """A line on which the scene is under way. Raises DeviceError."""
        name = _named(self._address)
        try:
            line = _Line(socket.create_connection(self._address, timeout=_PATIENCE_S))
        except OSError as error:
            raise DeviceError(f"{name} does not answer: {error}") from None
        try:
            line.prove(self._token, is_first=False)
            line.send("scene", *self._scene)
        except AuthenticationError:
            line.close()
            raise DeviceError(f"{name} does not take the token") from None
        except (OSError, EOFError) as error:
            line.close()
            raise DeviceError(f"{name} is no machine that photographs: {error or 'it has hung up'}") from None
        return line

    def _listen(self) -> None:
        while self._line:
            reason = self._receive(self._line)
            with self._lock:
                self._line.close()
                self._line = None
                questions, self._questions = self._questions, {}
            for answer in questions.values():
                answer.set_exception(Cancelled(reason))
            if self._closing.is_set():
                return
            self._on_error(0, reason)
            self._connect_again()

    def _receive(self, line: _Line) -> str:
        """Until the line is gone; returns why."""
        try:
            while True:
                kind, *rest = line.receive()
                if kind == "frame":
                    self._on_frame(replace(rest[0], serial=rest[0].serial + self._serials_before))
                    line.send("shown")
                elif kind == "error":
                    self._on_error(rest[0], rest[1])
                elif kind == "answer" and rest[0] in self._questions:
                    self._questions.pop(rest[0]).set_result(rest[1])
                elif kind == "refusal" and rest[0] in self._questions:
                    self._questions.pop(rest[0]).set_exception(InputError(rest[1]))
        except (EOFError, OSError):
            return self._gone
        except InputError as error:
            return str(error)

    def _connect_again(self) -> None:
        while not self._closing.wait(_PAUSE_S):
            with contextlib.suppress(DeviceError):
                line = self._connected()
                with self._lock:
                    if self._closing.is_set():
                        line.close()
                        return
                    self._line = line
                    self._send("quality", self._quality)
                    if self._wanted:
                        self._serials_before = self._serial - 1
                        self._send("submit", self._wanted)
                return


def serve_pictures(host: str, port: int, token: str, device: str) -> None:
    """Photographs for other machines until Ctrl-C, each on a thread of its own. Raises OSError for a port in use."""
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    with socket.create_server((host, port), family=family) as listening:
        while True:
            connection, address = listening.accept()
            threading.Thread(
                target=_photograph_for, args=(_Line(connection), _named(address), token, device), daemon=True
            ).start()


def _named(address: tuple[Any, ...]) -> str:
    host, port, *_ = address
    return f"[{host}]:{port}" if ":" in host else f"{host}:{port}"


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


def _photograph_for(line: _Line, address: str, token: str, device: str) -> None:
    try:
        line.prove(token, is_first=True)
    except (AuthenticationError, EOFError, OSError) as error:
        _log.warning("refused %s: %s", address, error or "it has hung up")
        line.close()
        return
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
