"""Generation of a data set, on all cores or with any executor."""

from __future__ import annotations

import concurrent.futures
import os
from collections.abc import Callable
from contextlib import ExitStack
from multiprocessing import get_context
from pathlib import Path

from .. import demosaicing
from .._core import InputError, RealcamError, devices
from ..files import remove_leftovers
from ..job.executing import Outcome, do_all
from .recipe import Recipe
from .sample import make_sample
from .shards import DatasetFolder

ProgressCallback = Callable[[float], bool | None]

_WINDOW = 1000  # pictures submitted to an executor at a time


def make(
    recipe: Recipe,
    folder: str | os.PathLike[str],
    executor: concurrent.futures.Executor | None = None,
    *,
    device: str = "auto",
    progress: ProgressCallback | None = None,
) -> Path:
    """Generates the missing pictures of a data set, and returns the path of its index, dataset.json.

    executor: each of its processes renders one picture at a time, on one core, on this machine or on others that can
    access the same folder; None: processes of this machine, one per core, or a single one for a GPU. device: as in
    render. progress: called with the fraction done; the work stops if it returns False.
    Pictures and shards are written atomically, so that make() can continue after any interruption.

    Raises InputError, DeviceError, and ImageFileError, for example if a disk is full. Finished pictures remain.
    """
    demosaicing.check_is_installed()  # before the first picture, not after it
    target = DatasetFolder.open(folder, recipe)
    remove_leftovers(target.path)
    missing = target.missing()
    on_gpu = device.startswith("cuda") or (device == "auto" and any(d.name.startswith("cuda") for d in devices()))
    with ExitStack() as stack:
        if missing and executor is None:
            workers = 1 if on_gpu else min(len(missing), len(os.sched_getaffinity(0)))
            # Spawned, not forked: a fork would copy locks held by other threads.
            executor = stack.enter_context(
                concurrent.futures.ProcessPoolExecutor(workers, mp_context=get_context("spawn"))
            )
        if executor is not None:
            _make_missing(
                executor, target, missing, "cuda" if on_gpu and device == "auto" else device, on_gpu, progress
            )
    for shard in target.shards:
        target.write_shard(shard)
    target.write_index()
    if progress is not None:
        progress(1.0)
    return target.path / "dataset.json"


def _make_missing(
    executor: concurrent.futures.Executor,
    target: DatasetFolder,
    missing: list[int],
    device: str,
    on_gpu: bool,
    progress: ProgressCallback | None,
) -> None:
    folder, count, threads = str(target.path.absolute()), target.recipe.count, 0 if on_gpu else 1
    remaining = missing

    def unfinished() -> list[int] | None:
        nonlocal remaining
        remaining = target.not_done(remaining)
        return remaining or None

    def submit(number: int) -> concurrent.futures.Future[Outcome]:
        return executor.submit(_make_one, target.recipe, folder, number, device, threads)

    def report() -> None:
        if progress is not None and progress(1 - len(target.not_done(remaining)) / count) is False:
            raise InputError(f"{target.path}: stopped; start again to go on")

    do_all(unfinished, submit, window=_WINDOW, report=report, location=str(target.path), noun="picture")


def _make_one(recipe: Recipe, folder: str, number: int, device: str, threads: int) -> Outcome:
    """Renders and writes one picture in a process of an executor. Returns an error message, empty on success."""
    try:
        DatasetFolder(Path(folder), recipe).write_sample(number, make_sample(recipe, number, device, threads))
    except RealcamError as error:
        return f"picture {number}: {error}"
    except OSError as error:
        return f"picture {number}: {error.filename}: {error.strerror}"
    return ""
