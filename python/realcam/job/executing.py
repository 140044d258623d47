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

Part = tuple[int, int]  # (k, n): the k-th of n parts of the work, k from 1

_TRIES = 3  # attempts at a task whose process is lost


def check_part(part: Part | None, executor: concurrent.futures.Executor | None) -> None:
    """Raises InputError unless a part is valid, and for one process: an executor has the whole work."""
    if part is None:
        return
    if not 1 <= part[0] <= part[1] <= 100000:
        raise InputError(f"part {part[0]} of {part[1]}: expected a part from 1 to the number of parts")
    if executor is not None:
        raise InputError(f"part {part[0]} of {part[1]}: a part is for one process; an executor excludes it")


def range_of_part(count: int, part: Part | None) -> range:
    """Returns the indices of the tasks of a part: contiguous, and each of `count` tasks belongs to one part."""
    k, n = part or (1, 1)
    return range(count * (k - 1) // n, count * k // n)


def do_all(
    available: Callable[[], Iterable[Task] | None],
    submit: Callable[[Task], concurrent.futures.Future[Outcome]],
    *,
    window: int,
    report: Callable[[], None],
    location: str,
    noun: str,
) -> None:
    """Submits tasks to an executor until all are done, by this executor or by others.

    available: returns the tasks that can be done now, or None when all are done. submit: submits one task. window: the
    largest number of tasks in flight. report: called about once a second; an exception from it ends the work.
    location, noun: the folder and the word for a task, for messages.

    Raises InputError with the error of a task, or if a process is lost.
    """
    running: dict[concurrent.futures.Future[Outcome], Task] = {}
    losses: dict[Task, int] = {}

    def lost(error: BaseException) -> str:
        """Message for a lost process."""
        text = str(error).strip().partition("\n")[0] or type(error).__name__
        return f"{location}: a process of the executor was lost ({text:.200}); finished {noun}s remain, start again"

    next_report_s = 0.0

    def report_each_second() -> None:
        nonlocal next_report_s
        if time.monotonic() >= next_report_s:
            report()
            next_report_s = time.monotonic() + 1.0

    try:
        while True:
            if len(running) < (window + 1) // 2:
                tasks = available()
                if tasks is None:
                    return
                in_progress = set(running.values())
                for task in islice((task for task in tasks if task not in in_progress), window - len(running)):
                    running[submit(task)] = task
            done, _ = concurrent.futures.wait(running, 1.0, concurrent.futures.FIRST_COMPLETED)
            for future in done:
                task = running.pop(future)
                try:
                    message = future.result()
                except (concurrent.futures.BrokenExecutor, concurrent.futures.CancelledError) as error:
                    raise InputError(lost(error)) from None
                except Exception as error:
                    losses[task] = losses.get(task, 0) + 1
                    if losses[task] == _TRIES:
                        raise InputError(f"{noun} {task}: {lost(error)}") from None
                    continue
                if message:
                    raise InputError(message)
            report_each_second()
    finally:
        for future in running:
            future.cancel()
