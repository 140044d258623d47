"""Generation of a data set: on all cores, in parts, or with any executor."""

from __future__ import annotations

import concurrent.futures
import os
from collections.abc import Callable
from contextlib import ExitStack, nullcontext
from functools import lru_cache
from multiprocessing import get_context
from pathlib import Path

from .. import demosaicing
from .._core import Camera, Film, InputError, Lens, Material, RealcamError, Scene, devices
from ..files import remove_leftovers
from ..job.engine import Engine
from ..job.executing import Outcome, Part, check_part, do_all, range_of_part
from ..session import Session
from .recipe import Recipe
from .sample import make_sample
from .shards import INDEX_FILE, DatasetFolder

ProgressCallback = Callable[[float], bool | None]

_WINDOW = 1000  # pictures submitted to an executor at a time


def make(
    recipe: Recipe,
    folder: str | os.PathLike[str],
    executor: concurrent.futures.Executor | None = None,
    *,
    part: Part | None = None,
    threads: int | None = None,
    device: str = "auto",
    progress: ProgressCallback | None = None,
) -> Path:
    """Generates the missing pictures of a data set, and returns the path of its index, dataset.json.

    executor: each of its processes renders one picture at a time, on this machine or on others that can access the same
    folder and the recipe's files; None: processes of this machine, one per core, or a single one for a GPU. part:
    (3, 8) makes the third eighth of the pictures in this process, so that 8 processes share the work; the last one of
    them to end writes the index. threads: number for each process; 0: all cores; None: 1, or all cores for a part and
    with a GPU. device: as in render; "auto": the kind of device that made the first picture, or a GPU if there is one.
    progress: called with the fraction done; the work stops if it returns False.
    Pictures and shards are written atomically, so that make() can continue after any interruption. Their bytes do not
    depend on the processes that make them; a process whose engine (see Job) would make other ones is refused.

    Raises InputError, DeviceError, and ImageFileError, for example if a disk is full. Finished pictures remain.
    """
    check_part(part, executor)
    demosaicing.check_is_installed()  # before the first picture, not after it
    target = DatasetFolder.open(folder, recipe)
    remove_leftovers(target.path)
    if device == "auto":
        first = target.engine()
        on_gpu = not first.is_cpu if first else any(d.name.startswith("cuda") for d in devices())
        device = "cuda" if on_gpu else "cpu"
    on_gpu = device.startswith("cuda")
    work = _Work(target, range_of_part(recipe.count, part), device, progress)
    if threads is None:
        threads = 0 if on_gpu or part else 1
    with ExitStack() as stack:
        if work.missing and executor is None and part is None:
            workers = 1 if on_gpu else min(len(work.missing), len(os.sched_getaffinity(0)))
            # Spawned, not forked: a fork would copy locks held by other threads.
            executor = stack.enter_context(
                concurrent.futures.ProcessPoolExecutor(workers, mp_context=get_context("spawn"))
            )
        if executor is not None:
            work.run_with(executor, threads)
        else:
            work.run(threads)
    if target.write_shards():
        target.write_index()
    if progress is not None:
        progress(1.0)
    return target.path / INDEX_FILE


class _Work:
    """The missing pictures of a data set among `numbers`. device, progress: see make."""

    def __init__(self, target: DatasetFolder, numbers: range, device: str, progress: ProgressCallback | None) -> None:
        self._target, self._count, self._device, self._progress = target, len(numbers), device, progress
        self.missing = target.missing(numbers)

    def run(self, threads: int) -> None:
        """Makes the pictures in this process."""
        for done, number in enumerate(self.missing):
            self._report(len(self.missing) - done)
            if message := _make_one(self._target.recipe, str(self._target.path), number, self._device, threads):
                raise InputError(message)

    def run_with(self, executor: concurrent.futures.Executor, threads: int) -> None:
        """Makes the pictures in the processes of an executor."""
        recipe, folder = self._target.recipe, str(self._target.path.absolute())

        def submit(number: int) -> concurrent.futures.Future[Outcome]:
            return executor.submit(_make_one, recipe, folder, number, self._device, threads)

        def report() -> None:
            self._report(len(self._target.not_done(self.missing)))

        location = str(self._target.path)
        do_all(self._unfinished, submit, window=_WINDOW, report=report, location=location, noun="picture")

    def _unfinished(self) -> list[int] | None:
        self.missing = self._target.not_done(self.missing)
        return self.missing or None

    def _report(self, left: int) -> None:
        """Reports the fraction done. left: missing pictures. Raises InputError if the caller stops the work."""
        if self._progress is not None and self._progress(1 - left / self._count) is False:
            raise InputError(f"{self._target.path}: stopped; start again to go on")


def _make_one(recipe: Recipe, folder: str, number: int, device: str, threads: int) -> Outcome:
    """Renders and writes one picture, unless it is finished. Returns an error message, empty on success."""
    try:
        target = DatasetFolder(Path(folder), recipe)
        if not target.sample_path(number).exists():
            target.check_engine(_engine(target, device))
            target.write_sample(number, make_sample(recipe, number, device, threads))
    except RealcamError as error:
        return f"picture {number}: {error}"
    except OSError as error:
        return f"picture {number}: {error.filename}: {error.strerror}"
    return ""


def _engine(target: DatasetFolder, device: str) -> Engine:
    """Returns the engine of this process: that of the first picture, if this machine has it."""
    first = target.engine()
    with first.pinned() if first else nullcontext():
        return _engine_of(device)


@lru_cache
def _engine_of(device: str) -> Engine:
    """Returns the engine of this process on a device."""
    triangle = Scene.from_arrays([[0, 0, -1], [1, 0, -1], [0, 1, -1]], [[0, 1, 2]], materials=[Material()])
    triangle = triangle.with_environment(1.0)
    camera = Camera(Lens.load("tessar-50mm"), film=Film(36, 24, (2, 2)))
    return Engine.of(Session(triangle, camera, spp=1, effects=(), device=device))
