"""Pictures on many machines."""

from __future__ import annotations

import concurrent.futures
import os
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path

from .._core import InputError
from ..executing import do_all
from ..files import remove_leftovers, system_name
from ..image import Image
from ..shot import Shot
from .folder import JobFolder
from .making import make_folder
from .status import JobStatus, status_of
from .units import Unit
from .worker import Worker, run_unit

ProgressCallback = Callable[[float], bool | None]

_WINDOW = 1000  # units that an executor has at a time


class Job:
    """Pictures that any number of processes and machines take together, in a folder that all of them see.

    job = rc.Job.make("terrace.job", {"terrace": rc.Shot.load("terrace.toml")})
    job.work()  # here, and in as many other processes as there are
    job.image("terrace").save("terrace.exr")

    Pictures have the same bits as those of rc.render on one machine with the same device. Each is divided into units,
    tiles of the film times 256 samples. A unit is a file that is written as a whole or not at all, so that a process or
    a machine that stops loses the unit that it has in hand and nothing else.
    """

    def __init__(self, folder: JobFolder) -> None:
        self._folder = folder

    @classmethod
    def load(cls, folder: str | os.PathLike[str]) -> Job:
        """Raises InputError for what is no job's folder, or that of another version of realcam."""
        system_name(folder)
        return cls(JobFolder.open(folder))

    @classmethod
    def make(
        cls,
        folder: str | os.PathLike[str],
        shots: Mapping[str, Shot],
        *,
        device: str = "auto",
        tile: tuple[int, int] | None = None,
    ) -> Job:
        """Writes a folder with all that the pictures need, under the names of the shots.

        Effects "auto" are planned here. device: that of all processes, "cpu" or "cuda". tile: width and height of units
        in pixels, rounded up to multiples of 32; None: about a second's work of one core, or whole rows for a GPU. A
        limit of seconds falls away, because machines differ: the noise alone decides, and max_spp.
        Raises InputError, also where the folder is there already; ImageFileError, DeviceError.
        """
        return cls(make_folder(folder, shots, device, tile))

    @property
    def path(self) -> Path:
        return self._folder.path

    @property
    def names(self) -> list[str]:
        """Of the shots."""
        return [shot.name for shot in self._folder.shots]

    def __repr__(self) -> str:
        return f"<realcam.Job {os.fspath(self.path):.60}, {len(self.names)} shots>"

    def status(self) -> JobStatus:
        """How far it is. Raises InputError."""
        return status_of(self._folder)

    def work(
        self,
        executor: concurrent.futures.Executor | None = None,
        *,
        threads: int = 0,
        device: str | None = None,
        progress: ProgressCallback | None = None,
    ) -> None:
        """Takes samples until all units are done, here or by whoever else works on them.

        executor: of whose processes each takes a unit at a time, on this machine or others that see the same folder;
        None: this process. threads: of each process; 0: all cores. device: of this process, "cuda:1" say, where that of
        the job is "cuda". progress: called with the share done, and stops where it returns False.
        Raises InputError, DeviceError, and ImageFileError where a disk is full, say: what is done stays, and work()
        goes on from there.
        """
        remove_leftovers(self.path)
        for name in self.status().damaged:
            (self.path / "units" / name).unlink(missing_ok=True)
        report = _Report(self, progress)
        if executor is None:
            self._work_here(Worker(self._folder, threads, device), report)
        else:
            self._work_with(executor, threads, report)
        report(is_done=True)

    def image(self, name: str | None = None, *, device: str | None = None) -> Image:
        """The picture of a shot; None: of the only one. device: for layers of single rays; None: that of the job.

        Raises InputError where units are missing.
        """
        shot = self._number_of(name)
        worker = Worker(self._folder, device=device)
        self._check_done(worker, shot)
        film = worker.film(shot)
        stored = worker.shot(shot)
        image = worker.session(shot)._image_of(film.film)
        settings = stored.settings
        return replace(image, settings=settings, plan=stored.plan, shortfall=film.shortfall)

    def tone(self, name: str | None = None) -> str:
        """The shot's tone curve, for Image.save."""
        return Worker(self._folder).shot(self._number_of(name)).tone

    def _number_of(self, name: str | None) -> int:
        if name is None and len(self.names) == 1:
            return 0
        if name not in self.names:
            raise InputError(f"{self.path}: the job has {len(self.names)} shots; the name of one is wanted")
        return self.names.index(name)

    def _check_done(self, worker: Worker, shot: int) -> None:
        if worker.is_done(shot):
            return
        status = self.status()
        raise InputError(
            f"{self.path}: {status.units_known - status.units_done} of {status.units_known} units are missing; realcam "
            "job work does them"
        )

    def _missing(self, worker: Worker) -> Iterator[tuple[int, list[Unit]]]:
        """Of each shot that is not done, the units that can be done now."""
        for shot in range(len(self._folder.shots)):
            if not worker.is_done(shot):
                yield shot, worker.missing(shot)

    def _work_here(self, worker: Worker, report: _Report) -> None:
        while True:
            is_all, is_idle = True, True
            for _, units in self._missing(worker):
                is_all = False
                for unit in units:
                    if worker.run(unit):
                        is_idle = False
                    report()
            if is_all:
                return
            if is_idle:  # others have the rest in hand
                time.sleep(0.5)

    def _work_with(self, executor: concurrent.futures.Executor, threads: int, report: _Report) -> None:
        worker = Worker(self._folder, threads)
        folder = str(self.path.absolute())

        def wanted() -> list[Unit] | None:
            shots = list(self._missing(worker))
            return [unit for _, units in shots for unit in units] if shots else None

        def submit(unit: Unit) -> concurrent.futures.Future[tuple[bool, str]]:
            return executor.submit(run_unit, folder, unit, threads)

        do_all(wanted, submit, window=_WINDOW, report=report, place=str(self.path), noun="unit")


class _Report:
    """Tells the share that is done, about once a second."""

    def __init__(self, job: Job, progress: ProgressCallback | None) -> None:
        self._job, self._progress, self._next, self._most = job, progress, 0.0, 0.0

    def __call__(self, is_done: bool = False) -> None:
        if self._progress is None or (time.monotonic() < self._next and not is_done):
            return
        begin = time.monotonic()
        # What the noise still wants is an estimate, which also shrinks.
        self._most = 1.0 if is_done else max(self._most, self._job.status().share)
        if self._progress(self._most) is False:
            raise InputError(f"{self._job.path}: stopped; work() goes on from here")
        # Of many units, a look at all of them takes a while.
        self._next = time.monotonic() + max(1.0, 50 * (time.monotonic() - begin))
