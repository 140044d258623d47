"""The commands `realcam job ...`: render pictures on many machines that share a folder."""

from __future__ import annotations

import logging
import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from .. import files
from .._core import InputError
from ..image_file import DEVELOPED
from ..json_values import json_text
from ..number_text import counted, duration_text, number_text, percent_text
from ..progress import progress_bar
from ..shot import Shot
from ..video import write_video
from . import options
from .grouped_options import grouped
from .shot_options import load_shot, shot_options
from .work_options import (
    FarmOptions,
    PartOption,
    Scheduler,
    check_single,
    farm_files,
    write_farm_files,
)

if TYPE_CHECKING:
    from ..image import Image
    from ..job import Job

app = typer.Typer(help="Render pictures on many machines, in a folder that all of them share.", no_args_is_help=True)

Folder = Annotated[Path, typer.Argument(help="Folder of the job, created by `realcam job make`", metavar="FOLDER")]
Fps = Annotated[float, typer.Option("--fps", metavar="N", help="Frames per second of a video")]
ShotOptions = shot_options(without=("threads",))  # the number of threads is set for each process


def _tile(text: str, option: str) -> tuple[int, int]:
    """Converts the width and height of a tile in pixels, 128 or 128x64. Raises InputError."""
    sides = options.whole_numbers(text, option, "x", 1, 2)
    return sides[0], sides[-1]


@app.command()
@grouped
def make(
    shots: Annotated[
        list[Path], typer.Argument(help="Shot files (.toml), scene files, or bundled shots", metavar="SCENE")
    ],
    output: Annotated[Path, options.output("Folder of the job; it must not exist yet", "FOLDER")],
    changes: ShotOptions,  # type: ignore[valid-type]
    farm: FarmOptions,
    device: options.Device = "auto",
    frames: Annotated[
        range | None,
        options.parsed(
            options.frame_numbers, "--frames", "A-B", "Frames of a video: 1-240, or 1-240x10 for every tenth"
        ),
    ] = None,
    fps: Fps = 24.0,
    tile: Annotated[
        Any,
        options.parsed(
            _tile,
            "--tile",
            "PIXELS",
            "Size of a unit of work, 128 or 128x64, in steps of 32 [about a second on one core]",
        ),
    ] = None,
    quiet: options.Quiet = False,
) -> None:
    """Create the folder of a job from shots.

    The folder contains everything that the job needs; the shot files and the files that they name are not read again.
    """
    from ..job import Job
    from ..job.farm_files import work_of_job
    from ..job.making import check_is_new

    check_is_new(output)
    written = farm_files(farm, work_of_job(output))
    named = _named_shots(shots, changes, device)
    files.check_targets(written)
    if frames is not None:
        named = {
            frame: shot
            for name, still in named.items()
            for frame, shot in still.frames(frames, frames_per_second=fps, name=name, device=device).items()
        }
    job = Job.make(output, named, device=device, tile=tile)
    if not quiet:
        made = job.status()
        units = "units as the noise requires them" if made.is_adaptive else counted(made.units_known, "unit")
        typer.echo(f"{output}: {counted(made.shots, 'picture')}, {units}")
    write_farm_files(written, quiet)


@app.command()
def work(
    folder: Folder,
    part: PartOption = None,
    workers: Annotated[
        int | None, typer.Option(metavar="N", help="Number of processes [one for each 4 cores]", min=1, max=10000)
    ] = None,
    threads: options.Threads = 0,
    here: Annotated[bool, typer.Option("--here", help="Render in this process alone, without Dask")] = False,
    scheduler: Scheduler = None,
    device: Annotated[
        str | None,
        typer.Option(
            metavar="DEVICE", help="Device of this process, such as cuda:1, if a job is for GPUs; requires --here"
        ),
    ] = None,
    quiet: options.Quiet = False,
) -> None:
    """Render the units of a job that are not done.

    Run it again after Ctrl-C, a stopped machine or a full disk: only the units in progress are lost. To share the work
    without a scheduler, give each of N processes its --part; all of them must have access to the folder.
    """
    from ..job import Job
    from ..job.clusters import dask_executor, has_dask

    is_single = check_single(part, scheduler, workers, here)
    logging.disable(logging.CRITICAL)  # Dask logs every closed connection; the job reports the errors that matter
    if device is not None and not is_single:
        raise InputError("--device is for one process; use it together with --here")
    job = Job.load(folder)
    with progress_bar(f"{folder}", is_shown=not quiet) as bar:
        if is_single or not (has_dask() or scheduler or workers):
            job.work(part=part, threads=threads, device=device, progress=bar)
        else:
            cores = len(os.sched_getaffinity(0))
            count = workers or max(1, cores // 4)
            with dask_executor(workers=count, scheduler=scheduler) as executor:
                share = threads or (max(1, cores // count) if scheduler is None else 0)
                job.work(executor, threads=share, progress=bar)
    if not quiet:
        done = f"the units of part {part[0]}/{part[1]}" if part and not job.status().is_done else "all units"
        typer.echo(f"{folder}: {done} are done; realcam job finish {folder} -o FILE makes the pictures")


@app.command()
def status(folder: Folder, as_json: options.AsJson = False) -> None:
    """Show the progress of a job."""
    from ..job import Job

    found = Job.load(folder).status()
    if as_json:
        typer.echo(json_text(found))
        return
    lines = [
        percent_text(found.share, 3),
        f"{number_text(found.units_done)} of {counted(found.units_known, 'unit')}"
        + (" known so far" if found.is_adaptive and not found.is_done else ""),
        f"{number_text(found.shots_done)} of {counted(found.shots, 'picture')}",
    ]
    if found.damaged:
        lines.append(f"{len(found.damaged)} damaged ({found.damaged[0]}), which realcam job work will repeat")
    if found.is_done:
        lines.append("done")
    elif found.seconds_left < float("inf"):
        lines.append(f"about {duration_text(found.seconds_left)} left at the pace of the last units")
    typer.echo(", ".join(lines))


@app.command()
def finish(
    folder: Folder,
    output: Annotated[
        list[Path],
        options.output(
            "For one picture: a file .exr, .png, .jpg, .tif or .webp, may be repeated; for several: a folder, or "
            "a video, .mp4"
        ),
    ],
    format: Annotated[
        str, typer.Option(metavar="NAME", help="Format of pictures in a folder: exr, png, jpg, tif or webp")
    ] = "exr",
    fps: Fps = 24.0,
    device: Annotated[
        str | None, typer.Option(metavar="DEVICE", help="Device for layers without samples [that of the job]")
    ] = None,
    quiet: options.Quiet = False,
) -> None:
    """Add up the units of a job and write its pictures. The command may be repeated."""
    from ..job import Job

    format = options.known_word(format, ("exr", "png", "jpg", "tif", "webp"), "format")
    job = Job.load(folder)
    files.remove_leftovers(job.path)
    is_video = [path.suffix.lower() for path in output] == [".mp4"]
    targets = {"": output} if is_video else _picture_files(job, output, format)
    files.check_targets([path for paths in targets.values() for path in paths], outside=job.path)
    with progress_bar("adding up", is_shown=not quiet) as bar:
        if is_video:
            write_video(output[0], (image.developed() for _, image in _images(job, device, bar)), fps)
            options.say_written(output[0], quiet)
            return
        for name, image in _images(job, device, bar):
            for path in targets[name]:
                image.save(path)
                options.say_written(path, quiet)


def _images(job: Job, device: str | None, bar: Callable[[float], bool]) -> Iterator[tuple[str, Image]]:
    """Yields name and picture of all shots in order."""
    for done, name in enumerate(job.names):
        bar(done / len(job.names))
        yield name, job.image(name, device=device)


def _picture_files(job: Job, output: list[Path], format: str) -> dict[str, list[Path]]:
    """Returns the files to write for each picture, by its name. Creates the folder if `output` is one."""
    if all(path.suffix.lower() in (".exr", *DEVELOPED) for path in output):
        if len(job.names) > 1:
            raise InputError(f"the job has {len(job.names)} pictures; --output must be a folder")
        return {job.names[0]: output}
    if len(output) > 1:
        raise InputError("--output must be one folder, or files .exr, .png, .jpg, .tif and .webp")
    files.make_folder(output[0])
    return {name: [output[0] / f"{name}.{format}"] for name in job.names}


def _named_shots(paths: list[Path], changes: Any, device: str) -> dict[str, Shot]:
    shots: dict[str, Shot] = {}
    for path in paths:
        if path.stem in shots:
            raise InputError(f"{path}: two shots are called {path.stem}; use other names")
        shots[path.stem] = load_shot(path, changes, device)
    return shots
