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
_LONGEST_START_S = 60.0  # of the process, and of an import in it
_MOST_BYTES = 4 << 30  # memory limit of the process
_PROCESSES = multiprocessing.get_context("spawn")


class WorkError(InputError):
    """A call that timed out or crashed. Its message is the predicate of a sentence: "crashed"."""


class WorkerProcess:
    """Calls functions one at a time in a process, which is started on demand and restarted if it has died.

    The process ends with its parent, whatever either is doing.
    """

    def __init__(self) -> None:
        self._turn = threading.Lock()  # serialises calls
        self._beginning = threading.Lock()  # guards the fields below
        self._is_ended = False
        self._process: BaseProcess | None = None
        self._line: Connection | None = None

    def call(self, function: Callable[..., T], *arguments: Any, seconds: float) -> T:
        """Returns the function's result or raises its exception. Function, arguments and result must be picklable.

        Raises WorkError if the process crashes, or after `seconds`. A start of the process is not counted.
        """
        with self._turn:
            line, is_new = self._begun()
            try:
                if is_new and not line.poll(_LONGEST_START_S):
                    raise WorkError(f"did not begin within {_LONGEST_START_S:g} s")
                if is_new:
                    line.recv()
                line.send((function, arguments))
                if not line.poll(seconds):
                    raise WorkError(f"took longer than {seconds:g} s")
                is_done, value = line.recv()
            except (EOFError, OSError):
                self._forget()
                raise WorkError("crashed") from None
            except BaseException:
                self._forget()
                raise
        if not is_done:
            raise value
        result: T = value
        return result

    def warm_up(self, module: str) -> None:
        """Starts the process and imports a module, to shorten the first call."""
        with contextlib.suppress(WorkError):
            self.call(_import, module, seconds=_LONGEST_START_S)

    def end(self) -> None:
        """Kills the process permanently. A call in progress raises WorkError, and so do later calls."""
        with self._beginning:
            self._is_ended = True
            self._kill()

    def _begun(self) -> tuple[Connection, bool]:
        """Returns the connection to the process, and true if it was started now and will send that it is ready."""
        if self._line and self._process and self._process.is_alive():
            return self._line, False
        self._forget()
        with self._beginning:
            if self._is_ended:
                raise WorkError("is not done any more")
            self._line, theirs = _PROCESSES.Pipe()
            self._process = _PROCESSES.Process(target=_work, args=(theirs,), name="realcam-worker", daemon=True)
            self._process.start()
            theirs.close()
            return self._line, True

    def _forget(self) -> None:
        if self._line:
            self._line.close()
        self._kill()
        self._process = self._line = None

    def _kill(self) -> None:
        process = self._process
        if process:
            process.kill()
            process.join()


def _work(line: Connection) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C in a terminal is handled by the parent
    _end_with_parent()
    os.nice(_NICENESS)
    resource.setrlimit(resource.RLIMIT_DATA, (_MOST_BYTES, _MOST_BYTES))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    line.send(None)  # ready: this module and the package are imported
    while True:
        try:
            function, arguments = line.recv()
        except EOFError:
            return
        try:
            answer = True, function(*arguments)
        except Exception as error:
            answer = False, error
        line.send(answer)


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
