"""Function calls in a separate process, which may crash, hang or be killed."""

from __future__ import annotations

import contextlib
import fcntl
import importlib
import multiprocessing
import os
import resource
import signal
import threading
from collections.abc import Callable
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from typing import Any, TypeVar

from .._core import InputError

T = TypeVar("T")
_NICENESS = 5  # lower priority than rendering
_START_TIMEOUT_S = 60.0  # of the process, and of an import in it
_MAX_BYTES = 4 << 30  # memory limit of the process
_PROCESSES = multiprocessing.get_context("spawn")


class WorkError(InputError):
    """A call that timed out or crashed. Its message is the predicate of a sentence: "crashed"."""


class WorkerProcess:
    """Calls functions one at a time in a process, which is started on demand and restarted if it has died.

    The process ends with its parent, whatever either is doing.
    """

    def __init__(self) -> None:
        self._call_lock = threading.Lock()  # serialises calls
        self._process_lock = threading.Lock()  # guards the fields below
        self._is_ended = False
        self._process: BaseProcess | None = None
        self._connection: Connection | None = None

    def call(self, function: Callable[..., T], *arguments: Any, seconds: float) -> T:
        """Returns the function's result or raises its exception. Function, arguments and result must be picklable.

        Raises WorkError if the process crashes, or after `seconds`. A start of the process is not counted.
        """
        with self._call_lock:
            connection, is_new = self._started()
            try:
                if is_new and not connection.poll(_START_TIMEOUT_S):
                    raise WorkError(f"did not begin within {_START_TIMEOUT_S:g} s")
                if is_new:
                    connection.recv()
                connection.send((function, arguments))
                if not connection.poll(seconds):
                    raise WorkError(f"took longer than {seconds:g} s")
                is_done, value = connection.recv()
            except (EOFError, OSError):
                self._discard()
                raise WorkError("crashed") from None
            except BaseException:
                self._discard()
                raise
        if not is_done:
            raise value
        result: T = value
        return result

    def warm_up(self, module: str) -> None:
        """Starts the process and imports a module, to shorten the first call."""
        with contextlib.suppress(WorkError):
            self.call(_import, module, seconds=_START_TIMEOUT_S)

    def end(self) -> None:
        """Kills the process permanently. A call in progress raises WorkError, and so do later calls."""
        with self._process_lock:
            self._is_ended = True
            self._kill()

    def _started(self) -> tuple[Connection, bool]:
        """Returns the connection to the process, and true if it was started now and will send that it is ready.

        Raises WorkError after end().
        """
        if self._connection and self._process and self._process.is_alive():
            return self._connection, False
        self._discard()
        with self._process_lock:
            if self._is_ended:
                raise WorkError("is no longer possible: the server is ending")
            self._connection, child_connection = _PROCESSES.Pipe()
            self._process = _PROCESSES.Process(
                target=_work, args=(child_connection,), name="realcam-worker", daemon=True
            )
            self._process.start()
            child_connection.close()
            return self._connection, True

    def _discard(self) -> None:
        """Kills the process, if there is one, so that the next call starts another."""
        if self._connection:
            self._connection.close()
        self._kill()
        self._process = self._connection = None

    def _kill(self) -> None:
        process = self._process
        if process:
            process.kill()
            process.join()


def _work(connection: Connection) -> None:
    """Main function of the process: answers calls (function, arguments) by (True, result) or (False, exception)."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C in a terminal is handled by the parent
    _end_with_parent()
    os.nice(_NICENESS)
    resource.setrlimit(resource.RLIMIT_DATA, (_MAX_BYTES, _MAX_BYTES))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    connection.send(None)  # ready: this module and the package are imported
    while True:
        try:
            function, arguments = connection.recv()
        except EOFError:
            return
        try:
            answer = True, function(*arguments)
        except Exception as error:
            answer = False, error
        connection.send(answer)


def _import(module: str) -> None:
    importlib.import_module(module)


def _end_with_parent() -> None:
    """Lets the kernel send SIGIO, whose default action ends the process, when the pipe to the parent closes."""
    parent = multiprocessing.parent_process()
    assert parent is not None
    signal.signal(signal.SIGIO, signal.SIG_DFL)
    fcntl.fcntl(parent.sentinel, fcntl.F_SETOWN, os.getpid())
    flags = fcntl.fcntl(parent.sentinel, fcntl.F_GETFL)
    fcntl.fcntl(parent.sentinel, fcntl.F_SETFL, flags | os.O_ASYNC)
    if not parent.is_alive():  # the parent ended before the signal was set up
        os._exit(1)
