"""realcam lens: look at lenses."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Annotated, Optional

import typer

from .._core import InputError
from . import options

app = typer.Typer(help="Look at lenses.", rich_markup_mode=None)

LensName = Annotated[
    str, typer.Argument(help="A bundled lens (see `realcam lens list`) or a lens file.", metavar="LENS")
]
FNumber = Annotated[Optional[float], typer.Option("--f-number", help="Close the diaphragm to this f-number.")]  # noqa: UP045
Focus = Annotated[Optional[str], typer.Option("--focus", help="Object plane to film in metres, or inf.")]  # noqa: UP045


options.add_command_of_the_executable(app, "list", "List the bundled lenses.")
options.add_command_of_the_executable(app, "info", "Print a lens's table of surfaces and its first-order data.")


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


@app.command("gallery")
def gallery(
    names: Annotated[
        Optional[list[str]],  # noqa: UP045
        typer.Argument(help="Lenses, bundled or files [all that are bundled].", metavar="LENS"),
    ] = None,
    output: Annotated[Path, typer.Option("--output", "-o", help="A .png, .svg or .pdf file.")] = Path("lenses.png"),
    columns: Annotated[int, typer.Option(help="Drawings side by side.", min=1, max=50)] = 6,
) -> None:
    """Write a contact sheet: the cross-sections of all bundled lenses, or of those named."""
    from ..gallery import save_gallery

    lenses = [options.lens(name, None, None) for name in names] if names else None
    for name in names or []:
        if Path(name).is_file() and output.exists() and output.samefile(name):
            raise InputError(f"{output}: is one of the lens files; the contact sheet needs another name")
    save_gallery(output, lenses, columns)
    typer.echo(f"wrote {os.fsencode(output).decode(errors='replace')}")
