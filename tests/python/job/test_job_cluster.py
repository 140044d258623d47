"""Jobs on Dask: workers and schedulers that end without a word."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
import realcam as rc
from realcam.job.clusters import dask_executor

from ..programs import Command
from .job_programs import picture, shot, started, units

pytest.importorskip("distributed", reason="realcam[cluster] is missing")

SHOT = shot(500)


def made(folder: Path) -> rc.Job:
    return rc.Job.make(folder, {"lamp": SHOT}, device="cpu", tile=(32, 32))


def workers_of(program: int) -> list[int]:
    """Processes that a process has started by multiprocessing, and that compute."""
    found: list[int] = []
    for task in Path(f"/proc/{program}/task").iterdir():
        found += map(int, (task / "children").read_text().split())
    return [child for child in found if b"spawn_main" in Path(f"/proc/{child}/cmdline").read_bytes()]


def wait_for(units_done: int, folder: Path, program: subprocess.Popen[str]) -> None:
    end = time.monotonic() + 60
    while len(units(folder)) < units_done:
        assert program.poll() is None, program.communicate()
        assert time.monotonic() < end
        time.sleep(0.05)


@pytest.mark.slow
def test_a_worker_that_is_killed_is_replaced(tmp_path: Path) -> None:
    folder = tmp_path / "job"
    job = made(folder)
    program = started("work", folder, "--workers", "2", "--threads", "1", "--quiet")
    for done in (1, 5):
        wait_for(done, folder, program)
        os.kill(workers_of(program.pid)[-1], signal.SIGKILL)
    output, errors = program.communicate(timeout=120)
    assert (program.returncode, output, errors) == (0, "", "")
    assert job.image() == picture(SHOT)


def test_workers_that_end_before_they_are_ready_are_told_of(monkeypatch: pytest.MonkeyPatch) -> None:
    import distributed

    def ends(**_: object) -> None:
        raise RuntimeError("Nanny failed to start.")  # as Dask has it where its process was killed

    monkeypatch.setattr(distributed, "LocalCluster", ends)
    message = r"^this machine: Dask's worker processes did not start: Nanny failed"
    with pytest.raises(rc.InputError, match=message), dask_executor(workers=1):
        pass


@pytest.fixture
def address() -> str:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return f"tcp://127.0.0.1:{probe.getsockname()[1]}"


@pytest.fixture
def scheduler(address: str) -> Iterator[subprocess.Popen[bytes]]:
    """With one worker."""

    def dask(part: str, *words: str) -> subprocess.Popen[bytes]:
        program = [sys.executable, "-m", f"distributed.cli.dask_{part}", *words, "--no-dashboard"]
        environment = {**os.environ, "PYTHONPATH": str(Path(rc.__file__).parents[1])}
        return subprocess.Popen(program, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    programs = [
        dask("scheduler", "--host", "127.0.0.1", "--port", address.rpartition(":")[2]),
        dask("worker", address, "--nthreads", "1", "--no-nanny", "--death-timeout", "20"),
    ]
    yield programs[0]
    for program in programs:
        program.kill()
        program.wait()


@pytest.mark.slow
def test_a_scheduler_that_is_killed_stops_work_in_one_line(
    tmp_path: Path, address: str, scheduler: subprocess.Popen[bytes]
) -> None:
    folder = tmp_path / "job"
    job = made(folder)
    program = started("work", folder, "--scheduler", address, "--threads", "1")
    wait_for(3, folder, program)
    scheduler.kill()
    output, errors = program.communicate(timeout=60)
    assert (program.returncode, output) == (2, "")
    assert errors.startswith(f"realcam: error: {folder}: a process of the executor was lost")
    assert errors.count("\n") == 1
    kept = units(folder)
    job.work()
    assert kept.items() <= units(folder).items()
    assert job.image() == picture(SHOT)


def test_a_scheduler_that_is_not_there_is_told_in_one_line(
    tmp_path: Path, address: str, monkeypatch: pytest.MonkeyPatch, command: Command
) -> None:
    from realcam.job import clusters

    monkeypatch.setattr(clusters, "_TIMEOUT_S", 1)
    with (
        pytest.raises(rc.InputError, match=f"{address}: no Dask scheduler answers there"),
        clusters.dask_executor(workers=1, scheduler=address),
    ):
        pass
    made(tmp_path / "job")
    refused = command("job", "work", tmp_path / "job", "--scheduler", "nowhere.json")
    assert (refused.returncode, refused.stderr.count("\n")) == (2, 1)
    assert "nowhere.json" in refused.stderr
