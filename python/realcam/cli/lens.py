"""The commands `realcam lens ...`: lists, drawings, figures, analyses and conversions of lenses."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

import typer

from .._core import InputError
from ..json_values import json_text
from . import (
    lens_figures,
    lens_image,
    lens_list,
    lens_options,
    lens_plots,
    lens_rays,
    lens_tolerance,
    optimise,
    options,
)
from .commands_in_cpp import add_command_in_cpp
from .grouped_options import grouped

app = typer.Typer(help="Inspect, compare, convert and improve lenses.", rich_markup_mode=None)

Circle = Annotated[
    float | None,
    typer.Option(
        "--circle-of-confusion",
        metavar="MM",
        help="Largest blur that counts as sharp, in mm [the film's diagonal / 1500]",
    ),
]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON; infinite and missing values are null")]


app.command("list")(lens_list.list_lenses)
add_command_in_cpp(app, "lens", "info")
lens_plots.register(app)
app.command("optimise")(optimise.optimise)
app.command("tolerance")(lens_tolerance.tolerance)
app.command("image")(lens_image.image)
app.command("rays")(lens_rays.rays)
app.command("fit")(lens_rays.fit)


@app.command("draw")
@grouped
def draw(
    name: lens_options.LensName,
    *,
    output: Annotated[
        Path | None, options.output("A .svg, .pdf, .png, .jpg, .tif or .webp file [LENS.svg in the current folder]")
    ] = None,
    rings: lens_options.Rings,
    plane: Annotated[
        str, typer.Option(metavar="PLANE", help="yz or xz, which differ for lenses that are not rotationally symmetric")
    ] = "yz",
    rays: lens_options.Rays = 7,
    rays_from: lens_options.RaysFrom = "object",
    fields: Annotated[
        Sequence[float] | None,
        options.parsed(
            options.numbers, "--fields", "SHARES", "Field points, as fractions of the film's half diagonal [0,0.7,1]"
        ),
    ] = None,
    fields_deg: Annotated[
        Sequence[float] | None,
        lens_options.fields_option("Field points as angles in front of the lens, instead of --fields"),
    ] = None,
    look: lens_options.Look,
    insets: Annotated[bool, typer.Option(help="Show the rays at the film magnified")] = True,
    states: Annotated[
        str,
        typer.Option(
            metavar="WHICH",
            help="rows: zoom positions, or farthest and nearest focus, one below the other; ghost: the lens at its "
            "nearest focus as outlines in the same drawing; one: the lens as the options set it",
        ),
    ] = "one",
    file: lens_options.File,
    quiet: options.Quiet = False,
) -> None:
    """Write the cross-section of a lens, with rays from the object in focus."""
    from ..drawing.lens_drawings import save_cross_section, save_states, states_of

    if states not in ("one", "rows", "ghost"):
        raise InputError(f'--states: "{states:.40}" is unknown; expected one, rows or ghost')
    if states == "rows" and (rings.focus_m is not None or fields_deg is not None):
        raise InputError(
            "--states rows shows focus states or zoom positions, with fields relative to the film's corner: --focus "
            "and --fields-deg cannot be combined with it"
        )
    lens = rings.set(file.lens(name))
    target = output or lens_options.default_output(name, ".svg")
    lens_options.check_not_the_lens(target, name)
    drawn: dict[str, Any] = {
        "rays": rays,
        "rays_from": rays_from,
        "fields": fields or (0, 0.7, 1),
        "insets": insets,
        **look.arguments(),
    }
    if states == "rows":
        save_states(states_of(lens), target, **drawn)
    else:
        ghost = None
        if states == "ghost":
            if not lens.nearest_focus_m > 0:
                raise InputError(f'--states ghost: the file of lens "{lens.name}" does not specify a nearest focus')
            ghost = lens.focused(lens.nearest_focus_m)
        save_cross_section(lens, target, plane=plane, fields_deg=fields_deg, ghost=ghost, **drawn)
    options.say_written(target, quiet)


@app.command("photo")
@grouped
def photo(
    name: lens_options.LensName,
    *,
    rings: lens_options.Rings,
    circle: Circle = None,
    exposure_time: Annotated[
        float | None,
        options.parsed(
            options.seconds,
            "--exposure-time",
            "TIME",
            "Exposure time in seconds, such as 1/125; prints exposure values, too",
        ),
    ] = None,
    iso: Annotated[
        float, typer.Option(metavar="ISO", help="Sensitivity as an ISO number, for exposure values")
    ] = 100.0,
    file: lens_options.File,
    as_json: AsJson = False,
    quiet: options.Quiet = False,
) -> None:
    """Print photographers' figures: depth of field, angle of view, breathing, T-stop, exposure value."""
    from ..photography import photographic_figures

    if not 0 < iso < math.inf:
        raise InputError("--iso: expected a positive number")
    lens = rings.set(file.lens(name))
    figures = photographic_figures(
        lens,
        circle_of_confusion_mm=circle,
        exposure_time_s=exposure_time,
        iso=iso,
    )
    if as_json:
        typer.echo(json_text(figures))
    elif not quiet:
        lens_figures.print_columns([lens.title or lens.name], [lens_figures.photo_rows(figures)])


@app.command("compare")
@grouped
def compare(
    first: lens_options.LensName,
    second: Annotated[str, lens_options.lens_argument("Another lens")],
    *,
    output: Annotated[
        Path | None, options.output("Drawing of both at one scale: .svg, .pdf, .png, .jpg, .tif or .webp")
    ] = None,
    rings: lens_options.Rings,
    circle: Circle = None,
    mtf: Annotated[
        Sequence[float] | None,
        options.parsed(
            options.numbers,
            "--mtf",
            "PER_MM",
            "Frequencies of the MTF in periods per mm: 10,30. Takes seconds [no MTF]",
        ),
    ] = None,
    look: lens_options.Look,
    file: lens_options.File,
    as_json: AsJson = False,
    quiet: options.Quiet = False,
) -> None:
    """Print figures of two lenses side by side, and draw both. Options for focus and f-number apply to both."""
    from ..photography import lens_summary

    lenses = [rings.set(file.lens(name)) for name in (first, second)]
    drawn = look.arguments()
    if output is not None:
        from ..drawing.figure_files import check_figure_target

        lens_options.check_not_the_lens(check_figure_target(output), first, second)
    summaries = [lens_summary(lens, mtf_frequencies_per_mm=mtf or (), circle_of_confusion_mm=circle) for lens in lenses]
    if as_json:
        typer.echo(json_text(summaries))
    elif not quiet:
        rows = [lens_figures.summary_rows(summary) for summary in summaries]
        lens_figures.print_columns([lens.title or lens.name for lens in lenses], rows)
    if output is not None:
        from ..drawing.lens_drawings import save_states

        save_states([(lens.title or lens.name, lens) for lens in lenses], output, **drawn)
        options.say_written(output, quiet or as_json)


@app.command("convert")
@grouped
def convert(
    name: lens_options.LensName,
    *,
    output: Annotated[Path, options.output("A .toml, .zmx, .seq, .json, .roa or .osl file")],
    zoom: lens_options.Zoom = None,
    file: lens_options.File,
    quiet: options.Quiet = False,
) -> None:
    """Write a lens for realcam (.toml), Zemax (.zmx), CODE V (.seq), Optiland (.json), ray-optics or Blender (.osl)."""
    lens_options.check_not_the_lens(output, name)
    lens_options.Rings(zoom=zoom).set(file.lens(name)).save(output)
    options.say_written(output, quiet)


@app.command("blender")
def blender(
    names: lens_options.LensNames = None,
    output: Annotated[Path, options.output("A .zip file")] = Path("realcam-lenses.zip"),
    quiet: options.Quiet = False,
) -> None:
    """Write an extension for Blender 5 with lenses as cameras of Cycles. All lenses take some minutes."""
    from ..blender import write_extension

    lens_options.check_not_the_lens(output, *(names or []))
    lenses = [lens_options.File().lens(name) for name in names] if names else None
    write_extension(output, lenses, left_out=lambda why: typer.echo(f"left out: {why}", err=True))
    options.say_written(output, quiet)


@app.command("gallery")
@grouped
def gallery(
    names: lens_options.LensNames = None,
    *,
    output: Annotated[Path, options.output("A .png, .jpg, .tif, .webp, .svg or .pdf file")] = Path("lenses.png"),
    columns: Annotated[int, typer.Option(metavar="N", help="Number of drawings in a row", min=1, max=50)] = 6,
    theme: lens_options.ThemeName = "light",
    file: lens_options.File,
    quiet: options.Quiet = False,
) -> None:
    """Write a contact sheet: the cross-sections of all bundled lenses, or of those named."""
    from ..drawing.gallery import save_gallery

    lens_options.check_not_the_lens(output, *(names or []))
    lenses = [file.lens(name) for name in names or []]
    save_gallery(output, lenses or None, columns, theme=theme)
    options.say_written(output, quiet)
