"""Making a data set, on all cores or by any executor."""

from __future__ import annotations

import concurrent.futures
import os
from collections.abc import Callable
from contextlib import ExitStack
from multiprocessing import get_context
from pathlib import Path

from .. import demosaicing
from .._core import InputError, RealcamError, devices
from ..executing import Outcome, do_all
from ..files import remove_leftovers
from .recipe import Recipe
from .sample import make_sample
from .shards import DatasetFolder

ProgressCallback = Callable[[float], bool | None]

_WINDOW = 1000  # pictures that an executor has at a time


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
    demosaicing.check_is_installed()  # not after the first picture
    target = DatasetFolder.open(folder, recipe)
    remove_leftovers(target.path)
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
    folder, count, threads = str(target.path.absolute()), target.recipe.count, 0 if on_gpu else 1
    left = missing

    def wanted() -> list[int] | None:
        nonlocal left
        left = target.not_done(left)
        return left or None

    def submit(number: int) -> concurrent.futures.Future[Outcome]:
        return executor.submit(_make_one, target.recipe, folder, number, device, threads)

    def report() -> None:
        if progress is not None and progress(1 - len(target.not_done(left)) / count) is False:
            raise InputError(f"{target.path}: stopped; start again to go on")

    do_all(wanted, submit, window=_WINDOW, report=report, place=str(target.path), noun="picture")


def _make_one(recipe: Recipe, folder: str, number: int, device: str, threads: int) -> Outcome:
    """In a process of an executor."""
    try:
        DatasetFolder(Path(folder), recipe).write_sample(number, make_sample(recipe, number, device, threads))
    except RealcamError as error:
        return f"picture {number}: {error}"
    except OSError as error:
        return f"picture {number}: {error.filename}: {error.strerror}"
    return ""
