"""Making a data set, on all cores or by any executor."""

from __future__ import annotations

import concurrent.futures
import os
from collections.abc import Callable
from contextlib import ExitStack
from itertools import islice
from multiprocessing import get_context
from pathlib import Path

from .._core import InputError, RealcamError, devices
from .recipe import Recipe
from .sample import make_sample
from .shards import DatasetFolder

ProgressCallback = Callable[[float], bool | None]

_WINDOW = 64  # samples that an executor has at a time, for each of its processes or machines


def make(
    recipe: Recipe,
    folder: str | os.PathLike[str],
    executor: concurrent.futures.Executor | None = None,
    *,
    device: str = "auto",
    progress: ProgressCallback | None = None,
) -> Path:
    """Makes what is missing of a data set, and returns the path of its index, dataset.json.

    executor: of whose processes each makes a picture at a time, on one core, on this machine or others that see the
    same folder; None: processes of this machine, one for each core, or one alone for a GPU. device: as render has it.
    progress: called with the share done, and stops where it returns False.
    A picture and a shard appear in the folder as a whole or not at all, so that make() goes on after whatever has ended
    it. Raises InputError, DeviceError, and ImageFileError where a disk is full, say; what is done stays.
    """
    target = DatasetFolder.open(folder, recipe)
    missing = target.missing()
    on_gpu = device.startswith("cuda") or (device == "auto" and any(d.name.startswith("cuda") for d in devices()))
    with ExitStack() as stack:
        if missing and executor is None:
            workers = 1 if on_gpu else min(len(missing), len(os.sched_getaffinity(0)))
            # Processes are started afresh: a fork would copy threads that hold locks.
            executor = stack.enter_context(
                concurrent.futures.ProcessPoolExecutor(workers, mp_context=get_context("spawn"))
            )
        if executor is not None:
            _work_with(executor, target, missing, "cuda" if on_gpu and device == "auto" else device, on_gpu, progress)
    for shard in target.shards:
        target.write_shard(shard)
    target.write_index()
    if progress is not None:
        progress(1.0)
    return target.path / "dataset.json"


def _work_with(
    executor: concurrent.futures.Executor,
    target: DatasetFolder,
    missing: list[int],
    device: str,
    on_gpu: bool,
    progress: ProgressCallback | None,
) -> None:
    folder, count = str(target.path.absolute()), target.recipe.count
    left, done = iter(missing), count - len(missing)
    given: set[concurrent.futures.Future[str]] = set()
    try:
        while True:
            for number in islice(left, _WINDOW - len(given)):
                given.add(executor.submit(_make_one, target.recipe, folder, number, device, 0 if on_gpu else 1))
            if not given:
                return
            ready, given = concurrent.futures.wait(given, 1.0, concurrent.futures.FIRST_COMPLETED)
            for future in ready:
                try:
                    why = future.result()
                except (concurrent.futures.BrokenExecutor, concurrent.futures.CancelledError) as error:
                    words = str(error).strip().partition("\n")[0] or type(error).__name__
                    raise InputError(
                        f"{target.path}: a process was lost ({words:.200}); start again to go on"
                    ) from None
                if why:
                    raise InputError(why)
                done += 1
            if progress is not None and progress(done / count) is False:
                raise InputError(f"{target.path}: stopped; start again to go on")
    finally:
        for future in given:
            future.cancel()


def _make_one(recipe: Recipe, folder: str, number: int, device: str, threads: int) -> str:
    """In a process of an executor. Returns why it failed: exceptions of this package do not travel everywhere."""
    try:
        DatasetFolder(Path(folder), recipe).write_sample(number, make_sample(recipe, number, device, threads))
    except RealcamError as error:
        return f"picture {number}: {error}"
    except OSError as error:
        return f"picture {number}: {error.filename}: {error.strerror}"
    return ""
