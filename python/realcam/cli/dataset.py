"""The command `realcam dataset`: makes labelled pictures of random scenes."""

from __future__ import annotations

import dataclasses
import os
from concurrent.futures import Executor, ProcessPoolExecutor
from contextlib import ExitStack
from multiprocessing import get_context
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..files import check_targets
from ..json_values import json_text
from ..number_text import counted
from ..progress import progress_bar
from . import options
from .completions import completion_of
from .grouped_options import grouped
from .work_options import FarmOptions, PartOption, Scheduler, check_single, farm_files, write_farm_files

if TYPE_CHECKING:
    from ..job.farm_files import FarmWork


@grouped
def dataset(
    recipe: Annotated[Path, typer.Argument(help="Recipe of the data set, .toml (docs/datasets.md)", metavar="RECIPE")],
    output: Annotated[Path, options.output("Folder of the shards; existing ones are kept", "FOLDER")],
    farm: FarmOptions,
    count: Annotated[int | None, typer.Option(metavar="N", help="Number of pictures [the recipe's]", min=1)] = None,
    workers: Annotated[
        int | None,
        typer.Option(metavar="N", help="Number of processes [one for each core; 1 on a GPU]", min=1, max=4096),
    ] = None,
    part: PartOption = None,
    threads: Annotated[
        int | None,
        typer.Option(
            metavar="N", help="Number of threads of each process; 0: all [1; all with --part or a GPU]", min=0, max=4096
        ),
    ] = None,
    scheduler: Scheduler = None,
    device: Annotated[
        str,
        typer.Option(
            metavar="DEVICE", help="auto (a GPU if there is one), cpu or cuda", autocompletion=completion_of("DEVICE")
        ),
    ] = "auto",
    as_json: options.AsJson = False,
    quiet: options.Quiet = False,
) -> None:
    """Make labelled pictures of random scenes through real lenses, in shards. Repeat the command to continue.

    To share the pictures among N processes, give each its --part. With --sbatch, --qsub or --openjd, the command writes
    these files and makes no pictures itself.
    """
    from ..dataset import Recipe, make
    from ..job.clusters import dask_executor

    check_single(part, scheduler, workers)
    loaded = Recipe.load(recipe)
    if count is not None:
        loaded = dataclasses.replace(loaded, count=count)
    if written := farm_files(farm, work_of_dataset(recipe, output, count, device)):
        check_targets(written, outside=output)
        write_farm_files(written, quiet or as_json)
        if as_json:
            typer.echo(json_text({"files": [os.fspath(path) for path in written]}))
        return
    with ExitStack() as stack:
        report = stack.enter_context(progress_bar("making pictures", is_shown=not quiet and not as_json))
        executor: Executor | None = None
        if scheduler is not None:
            executor = stack.enter_context(dask_executor(workers=workers or 1, scheduler=scheduler))
        elif workers is not None:
            executor = stack.enter_context(ProcessPoolExecutor(workers, mp_context=get_context("spawn")))
        index = make(loaded, output, executor, part=part, threads=threads, device=device, progress=report)
    is_complete = index.exists()
    if as_json:
        typer.echo(json_text({"index": os.fspath(index) if is_complete else None, "pictures": loaded.count}))
    elif is_complete:
        options.say_written(index, quiet)
    elif not quiet:
        typer.echo(f"{output}: part {part[0]}/{part[1]} of {counted(loaded.count, 'picture')} is done")


def work_of_dataset(recipe: Path, folder: Path, count: int | None, device: str) -> FarmWork:
    """Returns the commands of a data set on a render farm."""
    from ..job.farm_files import FarmPath, FarmWork

    file, output = FarmPath("Recipe", recipe, "FILE", "IN"), FarmPath("Folder", folder)
    words = ("--device", device, *(() if count is None else ("--count", str(count))), "--output", output, file)
    return FarmWork(folder, ("dataset",), words, ("dataset", "--quiet", *words))
