"""Runs tasks in the processes of an executor, on this machine or on others."""

from __future__ import annotations

import concurrent.futures
import time
from collections.abc import Callable, Hashable, Iterable
from itertools import islice
from typing import TypeVar

from .._core import InputError

Task = TypeVar("Task", bound=Hashable)
# Result of a task: an error message, or an empty string, because exceptions of this package do not pickle in every
# executor.
Outcome = str

_TRIES = 3  # attempts at a task whose process is lost


def do_all(
    wanted: Callable[[], Iterable[Task] | None],
    submit: Callable[[Task], concurrent.futures.Future[Outcome]],
    *,
    window: int,
    report: Callable[[], None],
    location: str,
    noun: str,
) -> None:
    """Submits tasks to an executor until all are done, by this executor or by others.

    wanted: returns the tasks that can be done now, or None when all are done. submit: submits one task. window: the
    largest number of tasks in flight. report: called about once a second; an exception from it ends the work.
    location, noun: the folder and the word for a task, for messages.

    Raises InputError with the error of a task, or if a process is lost.
    """
    given: dict[concurrent.futures.Future[Outcome], Task] = {}
    losses: dict[Task, int] = {}

    def lost(error: BaseException) -> str:
        words = str(error).strip().partition("\n")[0] or type(error).__name__
        return f"{location}: a process of the executor was lost ({words:.200}); what is done stays, start again"

    next_report_s = 0.0

    def tell() -> None:
        nonlocal next_report_s
        if time.monotonic() >= next_report_s:
            report()
            next_report_s = time.monotonic() + 1.0

    try:
        while True:
            if len(given) < (window + 1) // 2:
                tasks = wanted()
                if tasks is None:
                    return
                in_hand = set(given.values())
                for task in islice((task for task in tasks if task not in in_hand), window - len(given)):
                    given[submit(task)] = task
            done, _ = concurrent.futures.wait(given, 1.0, concurrent.futures.FIRST_COMPLETED)
            for future in done:
                task = given.pop(future)
                try:
                    why = future.result()
                except (concurrent.futures.BrokenExecutor, concurrent.futures.CancelledError) as error:
                    raise InputError(lost(error)) from None
                except Exception as error:
                    losses[task] = losses.get(task, 0) + 1
                    if losses[task] == _TRIES:
                        raise InputError(f"{noun} {task}: {lost(error)}") from None
                    continue
                if why:
                    raise InputError(why)
            tell()
    finally:
        for future in given:
            future.cancel()
