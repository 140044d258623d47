"""realcam lens: look at lenses."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Annotated, Optional

import typer

from .._core import InputError
from . import lens_plots, options

app = typer.Typer(help="Look at lenses.", rich_markup_mode=None)

LensName = Annotated[
    str, typer.Argument(help="A bundled lens (see `realcam lens list`) or a lens file.", metavar="LENS")
]
FNumber = Annotated[Optional[float], typer.Option("--f-number", help="Close the diaphragm to this f-number.")]  # noqa: UP045
Focus = Annotated[Optional[str], typer.Option("--focus", help="Object plane to film in metres, or inf.")]  # noqa: UP045


options.add_command_of_the_executable(app, "list", "List the bundled lenses.")
options.add_command_of_the_executable(app, "info", "Print a lens's table of surfaces and its first-order data.")
lens_plots.register(app)


@app.command("draw")
def draw(
    name: LensName,
    output: Annotated[Path | None, typer.Option("--output", "-o", help="A .svg or .png file [LENS.svg, here].")] = None,
    f_number: FNumber = None,
    focus: Focus = None,
    rays: Annotated[int, typer.Option(help="Rays for each of three points of the film.", min=1, max=101)] = 7,
) -> None:
    """Write the cross-section of a lens, with rays from three points of the film."""
    from ..draw import save_cross_section

    lens = options.lens(name, focus, f_number)
    # By what the user called the lens: the name in a file may be any text.
    target = output or Path(f"{Path(name).name.removesuffix('.toml') or 'lens'}.svg")
    if Path(name).is_file() and target.exists() and target.samefile(name):
        raise InputError(f"{target}: is the lens file itself; the drawing needs another name")
    save_cross_section(lens, target, rays=rays)
    typer.echo(f"wrote {os.fsencode(target).decode(errors='replace')}")
