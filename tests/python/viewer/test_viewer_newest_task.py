"""Work that each change makes out of date."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Iterator
from itertools import pairwise

import pytest
import realcam as rc
from realcam.viewer.newest_task import NewestTask

WAIT_S = 30.0


@pytest.fixture
def tasks() -> Iterator[NewestTask]:
    made = NewestTask("realcam-test")
    yield made
    made.close()


def test_of_those_that_wait_the_newest_is_done(tasks: NewestTask) -> None:
    begun, may, ended = threading.Event(), threading.Event(), threading.Event()
    done: list[int] = []

    def first() -> None:
        begun.set()
        assert may.wait(WAIT_S)
        done.append(0)

    tasks.submit(first)
    assert begun.wait(WAIT_S)
    for k in (1, 2):
        tasks.submit(lambda k=k: done.append(k))
    tasks.submit(lambda: (done.append(3), ended.set()))
    may.set()
    assert ended.wait(WAIT_S)
    assert done == [0, 3]


@pytest.mark.parametrize(("error", "logged"), [(ValueError("a mistake of ours"), 1), (rc.Cancelled("Python ends"), 0)])
def test_a_task_that_fails_is_logged_and_the_next_is_done(
    tasks: NewestTask, caplog: pytest.LogCaptureFixture, error: Exception, logged: int
) -> None:
    """A task that was cancelled (Ctrl-C) is not logged."""
    failed, ended = threading.Event(), threading.Event()

    def fails() -> None:
        failed.set()
        raise error

    with caplog.at_level(logging.WARNING, logger="realcam"):
        tasks.submit(fails)
        assert failed.wait(WAIT_S)
        tasks.submit(ended.set)
        assert ended.wait(WAIT_S)
    assert len(caplog.records) == logged


def test_tasks_take_no_more_than_their_share_of_the_time() -> None:
    tasks, ended, times = NewestTask("realcam-test", share=0.25), threading.Event(), []

    def task() -> None:
        times.append(time.monotonic())
        time.sleep(0.05)
        if len(times) < 4:
            tasks.submit(task)
        else:
            ended.set()

    try:
        tasks.submit(task)
        assert ended.wait(WAIT_S)
    finally:
        tasks.close()
    # Tasks start at intervals of at least four times the duration of a task, which is 0.05 s or more.
    assert all(after - before >= 0.2 for before, after in pairwise(times))
