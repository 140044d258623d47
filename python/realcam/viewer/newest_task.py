"""Thread that runs the newest submitted task."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable

from .._core import Cancelled

_log = logging.getLogger(__name__)


class NewestTask:
    """Thread for work that becomes obsolete with each change: of several pending tasks, only the newest is run.

    Tasks deliver their results themselves. An exception is logged, and does not affect later tasks.
    quiet_s: a task starts when no other has been submitted for this time, so that expensive work waits for the end of a
    movement. delay_s: delay before a task starts, which lets more urgent work go first. share: largest fraction of time
    spent in tasks, which leaves time for more urgent work.
    """

    def __init__(self, name: str, *, quiet_s: float = 0.0, delay_s: float = 0.0, share: float = 1.0) -> None:
        self._quiet_s, self._delay_s = quiet_s, delay_s
        self._pause_ratio = 1 / share - 1  # pause after a task, relative to its duration
        self._wake = threading.Condition()
        self._task: Callable[[], None] | None = None
        self._is_closed = False
        self._name = name
        threading.Thread(target=self._run, name=name, daemon=True).start()

    def submit(self, task: Callable[[], None]) -> None:
        """Runs a task on the thread, in place of one that has not started yet."""
        with self._wake:
            self._task = task
            self._wake.notify()

    def close(self) -> None:
        """Ends the thread after its current task, without waiting for it."""
        with self._wake:
            self._is_closed = True
            self._wake.notify()

    def _run(self) -> None:
        while True:
            with self._wake:
                while self._task is None and not self._is_closed:
                    self._wake.wait()
                while self._quiet_s and not self._is_closed and self._wake.wait(self._quiet_s):
                    pass
            if self._delay_s:
                time.sleep(self._delay_s)
            with self._wake:
                task, self._task = self._task, None
                if self._is_closed or task is None:
                    return
            begun = time.perf_counter()
            try:
                task()
            except Cancelled:
                pass  # the interpreter is ending
            except Exception:
                _log.exception("a task of thread %s failed", self._name)
            if self._pause_ratio:
                time.sleep(self._pause_ratio * (time.perf_counter() - begun))
