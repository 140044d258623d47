"""Rendering on many machines."""

from __future__ import annotations

import concurrent.futures
import os
import time
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path

from .._core import InputError
from ..files import remove_leftovers, system_name
from ..image import Image
from ..ocio import OcioView
from ..shot import Shot
from .executing import Part, check_part, do_all
from .folder import JobFolder
from .making import make_folder
from .status import JobStatus, status_of
from .units import Unit
from .worker import Worker, run_unit

ProgressCallback = Callable[[float], bool | None]

_WINDOW = 1000  # units submitted to an executor at a time


class Job:
    """Pictures that any number of processes and machines render together, in a folder that all of them can access.

    job = rc.Job.make("terrace.job", {"terrace": rc.Shot.load("terrace.toml")})
    job.work()  # here, and in as many other processes as there are
    job.image("terrace").save("terrace.exr")

    Pictures have the same bits as those of rc.render on one machine with the same device. Each is divided into units:
    tiles of the film times 256 samples. The file of a unit is written atomically, so that a process or machine that
    stops loses only its current unit.
    """

    def __init__(self, folder: JobFolder) -> None:
        self._folder = folder

    @classmethod
    def load(cls, folder: str | os.PathLike[str]) -> Job:
        """Opens a job's folder. Raises InputError if it is not one, or belongs to another version of realcam."""
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
        """Writes a folder with everything that the pictures need, under the names of the shots.

        Effects "auto" are planned here. device: device of all processes, "cpu" or "cuda". tile: width and height of
        units in pixels, rounded up to multiples of 32; None: about a second of work for one core, or whole rows for a
        GPU. A limit of seconds is dropped, because machines differ: only the noise goal and max_spp apply.
        Raises InputError, also if the folder already exists; ImageFileError, DeviceError.
        """
        return cls(make_folder(folder, shots, device, tile))

    @property
    def path(self) -> Path:
        """The job's folder."""
        return self._folder.path

    @property
    def names(self) -> list[str]:
        """Names of the shots."""
        return [shot.name for shot in self._folder.shots]

    def __repr__(self) -> str:
        return f"<realcam.Job {os.fspath(self.path):.60}, {len(self.names)} shots>"

    def status(self) -> JobStatus:
        """Returns the job's progress. Raises InputError."""
        return status_of(self._folder)

    def work(
        self,
        executor: concurrent.futures.Executor | None = None,
        *,
        part: Part | None = None,
        threads: int = 0,
        device: str | None = None,
        progress: ProgressCallback | None = None,
    ) -> None:
        """Renders the missing units.

        executor: its processes take one unit at a time, on this machine or others that can access the same folder;
        None: this process renders all units. part: (3, 8) limits this process to the third eighth of the units, so that
        8 processes share the work; with a noise goal it also takes units of other parts that the next round needs.
        threads: number for each process; 0: all cores. device: device of this process, "cuda:1" say, if that of the job
        is "cuda". progress: called with the fraction done; the work stops if it returns False.
        Raises InputError, DeviceError, and ImageFileError, if a disk is full, say: finished units remain, and work()
        continues from there.
        """
        check_part(part, executor)
        remove_leftovers(self.path)
        for name in self.status().damaged:
            self._folder.discard(name)
        report = _Report(self, progress)
        if executor is None:
            for _ in Worker(self._folder, threads, device).work(part):
                report()
        else:
            self._work_with(executor, threads, report)
        report(is_last=True)

    def image(self, name: str | None = None, *, device: str | None = None) -> Image:
        """Returns the picture of a shot. name: None: the only shot. device: for layers of single rays; None: the job's.

        Raises InputError if units are missing.
        """
        shot = self._index_of(name)
        worker = Worker(self._folder, device=device)
        rounds, is_all = self._folder.rounds(shot)
        if not is_all or any(self._folder.missing(shot, round_) for round_ in rounds):
            status = self.status()
            missing = f"{status.units_known - status.units_done} of {status.units_known} units are missing"
            raise InputError(f"{self.path}: {missing}; run realcam job work to render them")
        film, stored = worker.film(shot), worker.shot(shot)
        image = worker.session(shot)._image_of(film.film)
        return replace(
            image,
            settings=stored.settings,
            plan=stored.plan,
            shortfall=film.shortfall,
            tone=stored.tone,
            exr_color_space=stored.exr_color_space,
        )

    def tone(self, name: str | None = None) -> str | OcioView:
        """The shot's tone curve or view, which image() has, too."""
        return Worker(self._folder).shot(self._index_of(name)).tone

    def _index_of(self, name: str | None) -> int:
        """Index of a shot; None: the only one. Raises InputError."""
        if name is None and len(self.names) == 1:
            return 0
        if name not in self.names:
            raise InputError(f"{self.path}: the job has {len(self.names)} shots; specify the name of one of them")
        return self.names.index(name)

    def _work_with(self, executor: concurrent.futures.Executor, threads: int, report: _Report) -> None:
        """Renders the missing units in the processes of an executor."""
        worker, folder = Worker(self._folder, threads), str(self.path.absolute())

        def missing_units() -> list[Unit] | None:
            found = [worker.missing(shot) for shot in range(len(self.names))]
            return [unit for missing in found if missing for unit in missing[1]] or None

        def submit(unit: Unit) -> concurrent.futures.Future[str]:
            return executor.submit(run_unit, folder, self._folder.id, unit, threads)

        do_all(missing_units, submit, window=_WINDOW, report=report, location=str(self.path), noun="unit")


class _Report:
    """Reports the fraction done, about once a second."""

    def __init__(self, job: Job, progress: ProgressCallback | None) -> None:
        self._job, self._progress, self._next, self._largest = job, progress, 0.0, 0.0

    def __call__(self, is_last: bool = False) -> None:
        if self._progress is None or (time.monotonic() < self._next and not is_last):
            return
        begin = time.monotonic()
        # The number of samples that a noise goal still needs is an estimate, so the fraction may decrease;
        # the largest one is reported.
        self._largest = max(self._largest, self._job.status().share)
        if self._progress(self._largest) is False:
            raise InputError(f"{self._job.path}: stopped; work() continues from here")
        # Listing many units takes time; this keeps its cost below about 2 %.
        self._next = time.monotonic() + max(1.0, 50 * (time.monotonic() - begin))
