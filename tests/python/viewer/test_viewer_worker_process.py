"""Work in a process of its own: what crashes, never ends, or is left without its parent."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from realcam.viewer.worker_process import WorkerProcess, WorkError

from .processes import is_there

WAIT_S = 60.0  # for what takes a second on a quiet machine
LONG = pow, 7, 10**9  # runs for minutes without letting any other thread of its process run


@pytest.fixture
def worker() -> Iterator[WorkerProcess]:
    made = WorkerProcess()
    yield made
    made.end()


def test_what_it_gives_and_what_it_raises(worker: WorkerProcess) -> None:
    assert worker.call(pow, 2, 10, seconds=WAIT_S) == 1024
    with pytest.raises(ValueError, match="invalid literal"):
        worker.call(int, "x", seconds=WAIT_S)
    pid = worker.call(os.getpid, seconds=WAIT_S)
    assert pid != os.getpid()
    assert worker.call(os.getpid, seconds=WAIT_S) == pid


def test_work_that_crashes_and_the_next(worker: WorkerProcess) -> None:
    for crash in ((signal.raise_signal, signal.SIGSEGV), (os._exit, 3)):
        with pytest.raises(WorkError, match="crashed"):
            worker.call(*crash, seconds=WAIT_S)
        assert worker.call(pow, 2, 10, seconds=WAIT_S) == 1024


def test_a_process_that_was_killed_at_rest_is_no_error(worker: WorkerProcess) -> None:
    pid = worker.call(os.getpid, seconds=WAIT_S)
    os.kill(pid, signal.SIGKILL)
    os.waitid(os.P_PID, pid, os.WEXITED | os.WNOWAIT)  # with all its threads, and not waited for yet
    assert worker.call(pow, 2, 10, seconds=WAIT_S) == 1024


@pytest.mark.parametrize("long", [(time.sleep, 1e6), LONG], ids=["sleeps", "computes"])
def test_work_that_never_ends_and_the_next(worker: WorkerProcess, long: tuple) -> None:
    pid = worker.call(os.getpid, seconds=WAIT_S)
    with pytest.raises(WorkError, match=r"longer than 0\.3 s"):
        worker.call(*long, seconds=0.3)
    assert not is_there(pid)
    assert worker.call(pow, 2, 10, seconds=WAIT_S) == 1024


def test_ctrl_c_is_not_for_it(worker: WorkerProcess) -> None:
    pid = worker.call(os.getpid, seconds=WAIT_S)
    os.kill(pid, signal.SIGINT)
    time.sleep(0.5)
    assert worker.call(os.getpid, seconds=WAIT_S) == pid


def test_one_that_is_ended_does_no_more(worker: WorkerProcess) -> None:
    """The worker is not restarted for callers that were waiting for it."""
    pid = worker.call(os.getpid, seconds=WAIT_S)
    told: list[str] = []

    def ask() -> None:
        for _ in range(2):
            try:
                worker.call(time.sleep, 1e6, seconds=WAIT_S)
            except WorkError as error:
                told.append(str(error))

    thread = threading.Thread(target=ask)
    thread.start()
    time.sleep(0.5)
    worker.end()
    thread.join(WAIT_S)
    assert told == ["crashed", "is no longer possible: the server is ending"]
    assert not is_there(pid)


def test_work_that_takes_all_memory(worker: WorkerProcess) -> None:
    with pytest.raises(MemoryError):
        worker.call(bytearray, 1 << 40, seconds=WAIT_S)


def test_threads_take_turns(worker: WorkerProcess) -> None:
    with ThreadPoolExecutor(20) as threads:
        answers = list(threads.map(lambda k: worker.call(pow, k, 2, seconds=WAIT_S), range(20)))
    assert answers == [k * k for k in range(20)]


PARENT = """
import threading, time, os
from realcam.viewer.worker_process import WorkerProcess
if __name__ == "__main__":
    worker = WorkerProcess()
    print(worker.call(os.getpid, seconds=60), flush=True)
    threading.Thread(target=lambda: worker.call(pow, 7, 10**9, seconds=600), daemon=True).start()
    time.sleep(600)
"""


@pytest.mark.parametrize("end", [signal.SIGKILL, signal.SIGTERM])
def test_it_ends_with_its_parent(tmp_path: Path, end: signal.Signals) -> None:
    """While it computes, and however the parent ends."""
    (tmp_path / "parent.py").write_text(PARENT)
    with subprocess.Popen([sys.executable, str(tmp_path / "parent.py")], stdout=subprocess.PIPE, text=True) as parent:
        assert parent.stdout is not None
        pid = int(parent.stdout.readline())
        time.sleep(1)
        assert is_there(pid)
        parent.send_signal(end)
        parent.wait(WAIT_S)
    deadline = time.monotonic() + WAIT_S
    while is_there(pid):
        assert time.monotonic() < deadline
        time.sleep(0.02)
