"""Options of commands that divide work among processes and machines."""

from __future__ import annotations

import functools
import os
import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from .. import files
from .._core import InputError
from . import options

if TYPE_CHECKING:
    from ..job.executing import Part
    from ..job.farm_files import FarmWork


def _part(text: str, option: str) -> Part:
    """Converts "K/N". Raises InputError."""
    found = re.fullmatch(r"(\d{1,6})/(\d{1,6})", text)
    if not found or not 1 <= int(found[1]) <= int(found[2]):
        raise InputError(f'{option}: "{text:.40}": expected K/N, 1/8 to 8/8')
    return int(found[1]), int(found[2])


PartOption = Annotated[Any, options.parsed(_part, "--part", "K/N", "Render the K-th of N parts, in this process: 3/8")]
Scheduler = Annotated[
    str | None,
    typer.Option(
        "--scheduler", metavar="ADDRESS", help="Address of a Dask scheduler: tcp://head:8786, or its .json file"
    ),
]


@dataclass(frozen=True)
class FarmOptions:
    """Options for files that start the tasks of a render farm, for grouped()."""

    sbatch: Annotated[Path | None, typer.Option(metavar="FILE", help="Write a script for Slurm's sbatch")] = None
    qsub: Annotated[Path | None, typer.Option(metavar="FILE", help="Write a script for the qsub of PBS")] = None
    openjd: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Write a template of Open Job Description, .json")
    ] = None
    tasks: Annotated[
        int, typer.Option(metavar="N", help="Number of processes that these files start", min=1, max=100000)
    ] = 8


def farm_files(farm: FarmOptions, work: FarmWork) -> dict[Path, bytes]:
    """Returns the files that the options request, by their paths.

    Raises InputError for paths that a file's format cannot express, and as files.check_targets does; inputs that the
    command reads later have to be checked afterwards.
    """
    from ..job.farm_files import array_script, openjd_template

    scripts: list[tuple[Path | None, str, Callable[[FarmWork, int], str]]] = [
        (farm.sbatch, "--sbatch", functools.partial(array_script, "slurm")),
        (farm.qsub, "--qsub", functools.partial(array_script, "pbs")),
        (farm.openjd, "--openjd", openjd_template),
    ]
    requested = [(path, option, script) for path, option, script in scripts if path is not None]
    if len(files.check_targets([path for path, _, _ in requested])) < len(requested):
        raise InputError(f"expected one file each for {' and '.join(option for _, option, _ in requested)}")
    return {path: os.fsencode(script(work, farm.tasks)) for path, _, script in requested}


def write_farm_files(written: dict[Path, bytes], quiet: bool) -> None:
    """Writes the files of farm_files. Raises ImageFileError."""
    for path, content in written.items():
        files.write_whole(path, content)
        options.say_written(path, quiet)


def check_single(part: Part | None, scheduler: str | None, workers: int | None, is_here: bool = False) -> bool:
    """Returns True if this process does the work alone. Raises InputError for options of several processes then."""
    is_single = is_here or part is not None
    if is_single and (scheduler is not None or workers is not None):
        option = "--here" if is_here else "--part"
        raise InputError(f"{option} is for one process; --scheduler and --workers exclude it")
    return is_single
