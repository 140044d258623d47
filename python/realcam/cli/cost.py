"""The command `realcam cost`: render time against accuracy of a shot at all levels of simulation."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..files import check_target
from ..progress import progress_bar
from . import options
from .grouped_options import grouped
from .shot_options import load_shot, shot_options

# Without samples, effects and camera models, which the command itself varies.
ShotOptions = shot_options(("resolution", "model"), ("Camera", "Scene"), also=("seed", "max_bounces", "threads"))


@grouped
def cost(
    shot: options.ShotName,
    changes: ShotOptions,  # type: ignore[valid-type]
    output: Annotated[
        list[Path] | None, options.output("Error over time as .svg, or as .html with the table; may be repeated")
    ] = None,
    size: Annotated[
        int, typer.Option(metavar="PIXELS", help="Size of the longer side in pixels", min=8, max=4096)
    ] = 320,
    max_spp: Annotated[
        int,
        typer.Option(
            metavar="N",
            help="Largest number of samples per pixel; each level is rendered with 1, 4, 16, ... of them",
            min=4,
        ),
    ] = 256,
    reference_spp: Annotated[int, typer.Option(metavar="N", help="Samples per pixel of the reference", min=16)] = 4096,
    device: options.Device = "auto",
    as_json: options.AsJson = False,
    quiet: options.Quiet = False,
) -> None:
    """Render a shot at all levels of simulation, from a blurred pinhole picture to the full lens with all effects."""
    from ..accuracy import accuracy_cost  # brings matplotlib, which other commands need not load

    for path in output or []:
        check_target(path, (".svg", ".html"))
    loaded = load_shot(shot, changes, device)
    with progress_bar("measuring", is_shown=not quiet) as bar:
        result = accuracy_cost(
            loaded.scene,
            loaded.camera,
            device=device,
            threads=loaded.settings.threads,
            seed=loaded.seed,
            max_bounces=loaded.max_bounces,
            size=size,
            max_spp=max_spp,
            reference_spp=reference_spp,
            progress=bar,
        )
    if as_json or not quiet:
        typer.echo(result.json() if as_json else str(result), nl=as_json)
    for path in output or []:
        result.figure(path)
    if result.missing:
        raise KeyboardInterrupt
