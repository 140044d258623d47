"""The command `realcam dataset`: makes labelled pictures of random scenes."""

from __future__ import annotations

import os
from concurrent.futures import ProcessPoolExecutor
from contextlib import ExitStack
from multiprocessing import get_context
from pathlib import Path
from typing import Annotated, Optional

import typer

from ..json_values import json_text
from ..progress import progress_bar
from . import options
from .completions import completion_of


def dataset(
    recipe: Annotated[Path, typer.Argument(help="Recipe of the data set, .toml (docs/datasets.md)", metavar="RECIPE")],
    output: Annotated[
        Path, typer.Option("--output", "-o", metavar="FOLDER", help="Folder of the shards; existing ones are kept")
    ],
    count: Annotated[
        Optional[int],  # noqa: UP045
        typer.Option("--count", metavar="N", help="Number of pictures [the recipe's]", min=1),
    ] = None,
    workers: Annotated[
        Optional[int],  # noqa: UP045
        typer.Option("--workers", metavar="N", help="Processes [one for each core; one for a GPU]", min=1, max=4096),
    ] = None,
    device: Annotated[
        str,
        typer.Option(
            metavar="DEVICE", help="auto (a GPU if there is one), cpu or cuda", autocompletion=completion_of("DEVICE")
        ),
    ] = "auto",
    as_json: options.AsJson = False,
    quiet: options.Quiet = False,
) -> None:
    """Make labelled pictures of random scenes through real lenses, in shards. Repeat the command to continue."""
    from dataclasses import replace

    from ..dataset import Recipe, make

    loaded = Recipe.load(recipe)
    if count is not None:
        loaded = replace(loaded, count=count)
    with ExitStack() as stack:
        report = stack.enter_context(progress_bar("making pictures", is_shown=not quiet and not as_json))
        executor = None
        if workers is not None:
            executor = stack.enter_context(ProcessPoolExecutor(workers, mp_context=get_context("spawn")))
        index = make(loaded, output, executor, device=device, progress=report)
    if as_json:
        typer.echo(json_text({"index": os.fspath(index), "pictures": loaded.count}))
    else:
        options.say_written(index, quiet)
