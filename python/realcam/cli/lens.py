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

Zoom = Annotated[Optional[str], typer.Option("--zoom", help="Zoom position, by its name in `realcam lens info`.")]  # noqa: UP045
Glasses = Annotated[
    Optional[list[str]],  # noqa: UP045
    typer.Option(
        "--glass",
        help="A glass that the lens's file names and no catalogue has, or several: NAME=n_d,V_d or NAME=schott:F4; "
        "may be repeated.",
        metavar="NAME=N,V",
    ),
]
Force = Annotated[
    bool, typer.Option("--force", help="Leave out what the lens's file has that there is no model of, and name it.")
]
PbrtThickness = Annotated[
    Optional[str],  # noqa: UP045
    typer.Option(
        "--pbrt-thickness",
        help="Where a thickness in a .dat file stands: after or before the surface of its row [by the first row].",
        metavar="WHERE",
    ),
]

options.add_command_of_the_executable(app, "list", "List the bundled lenses.")
options.add_command_of_the_executable(app, "info", "Print a lens's table of surfaces and its first-order data.")


@app.command("draw")
def draw(
    name: LensName,
    output: Annotated[Path | None, typer.Option("--output", "-o", help="A .svg or .png file [LENS.svg, here].")] = None,
    f_number: FNumber = None,
    focus: Focus = None,
    rays: Annotated[int, typer.Option(help="Rays for each of three points of the film.", min=1, max=101)] = 7,
    zoom: Zoom = None,
    glass: Glasses = None,
    force: Force = False,
    pbrt_thickness: PbrtThickness = None,
) -> None:
    """Write the cross-section of a lens, with rays from three points of the film."""
    from ..draw import save_cross_section

    lens = options.lens(name, focus, f_number, zoom=zoom, glass=glass or (), force=force, pbrt_thickness=pbrt_thickness)
    # By what the user called the lens: the name in a file may be any text.
    target = output or Path(f"{Path(name).name.removesuffix('.toml') or 'lens'}.svg")
    if Path(name).is_file() and target.exists() and target.samefile(name):
        raise InputError(f"{target}: is the lens file itself; the drawing needs another name")
    save_cross_section(lens, target, rays=rays)
    typer.echo(f"wrote {os.fsencode(target).decode(errors='replace')}")


@app.command("convert")
def convert(
    name: LensName,
    output: Annotated[Path, typer.Option("--output", "-o", help="A .toml, .zmx or .seq file.")],
    zoom: Zoom = None,
    glass: Glasses = None,
    force: Force = False,
    pbrt_thickness: PbrtThickness = None,
) -> None:
    """Write a lens as a file of realcam (.toml), Zemax (.zmx) or CODE V (.seq)."""
    if Path(name).is_file() and output.exists() and output.samefile(name):
        raise InputError(f"{output}: is the lens file itself; another name is wanted")
    options.lens(name, zoom=zoom, glass=glass or (), force=force, pbrt_thickness=pbrt_thickness).save(output)
    typer.echo(f"wrote {os.fsencode(output).decode(errors='replace')}")
