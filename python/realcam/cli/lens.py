"""realcam lens: look at lenses."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated, Optional

import typer

from .._core import InputError
from ..json_values import json_text
from . import lens_figures, lens_options, lens_plots, lens_tolerance, optimise, options
from .commands_in_cpp import add_command_in_cpp
from .completions import completion_of

app = typer.Typer(help="Look at lenses.", rich_markup_mode=None)

Circle = Annotated[
    Optional[float],  # noqa: UP045
    typer.Option(
        "--circle-of-confusion", metavar="MM", help="Largest blur that is sharp, in mm [the film's diagonal / 1500]"
    ),
]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON; what is infinite or does not exist is null")]


add_command_in_cpp(app, "lens", "list")
add_command_in_cpp(app, "lens", "info")
lens_plots.register(app)
app.command("optimise")(optimise.optimise)
app.command("tolerance")(lens_tolerance.tolerance)


@app.command("draw")
def draw(
    name: lens_options.LensName,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", metavar="FILE", help="A .svg, .png or .pdf file [LENS.svg, here]")
    ] = None,
    f_number: lens_options.FNumber = None,
    focus: lens_options.Focus = None,
    plane: Annotated[
        str, typer.Option(metavar="PLANE", help="yz or xz, in which lenses that are not of revolution are others")
    ] = "yz",
    rays: lens_options.Rays = 7,
    rays_from: lens_options.RaysFrom = "object",
    fields: lens_options.Fields = "0,0.7,1",
    fields_deg: lens_options.FieldsDeg = None,
    wavelengths: lens_options.Wavelengths = None,
    radius_colours: lens_options.RadiusColours = False,
    marks: lens_options.Marks = False,
    insets: Annotated[bool, typer.Option(help="Show the rays at the film magnified")] = True,
    states: Annotated[
        str,
        typer.Option(
            metavar="WHICH",
            help="rows: zoom positions, or farthest and nearest focus, one below the other; ghost: the nearest "
            "focus as outlines in the same drawing; one: as --focus says",
        ),
    ] = "one",
    theme: lens_options.ThemeName = "light",
    width: lens_options.Width = 1600,
    zoom: lens_options.Zoom = None,
    glass: lens_options.Glasses = None,
    force: lens_options.Force = False,
    pbrt_thickness: lens_options.PbrtThickness = None,
    quiet: options.Quiet = False,
) -> None:
    """Write the cross-section of a lens, with rays from the object in focus."""
    from ..draw import save_cross_section, save_states, states_of

    if states not in ("one", "rows", "ghost"):
        raise InputError(f'--states: "{states:.40}" is unknown; one, rows or ghost is wanted')
    if states == "rows" and (focus is not None or fields_deg is not None):
        raise InputError(
            "--states rows shows focus states or zoom positions, by shares of the film: --focus and "
            "--fields-deg do not go with it"
        )
    lens = options.lens(name, focus, f_number, zoom=zoom, glass=glass, force=force, pbrt_thickness=pbrt_thickness)
    target = output or lens_options.output_of(name, ".svg")
    lens_options.check_not_the_lens(target, name)
    places = lens_options.numbers(fields, "--fields") or []
    colours = lens_options.numbers(wavelengths, "--wavelengths")
    if states == "rows":
        save_states(
            states_of(lens),
            target,
            rays=rays,
            rays_from=rays_from,
            fields=places,
            wavelengths_nm=colours,
            radius_colours=radius_colours,
            marks=marks,
            insets=insets,
            theme=theme,
            width_px=width,
        )
    else:
        ghost = None
        if states == "ghost":
            if not lens.nearest_focus_m > 0:
                raise InputError(f'--states ghost: the file of lens "{lens.name}" names no nearest focus')
            ghost = lens.focused(lens.nearest_focus_m)
        save_cross_section(
            lens,
            target,
            rays,
            plane=plane,
            rays_from=rays_from,
            fields=places,
            fields_deg=lens_options.numbers(fields_deg, "--fields-deg"),
            wavelengths_nm=colours,
            radius_colours=radius_colours,
            marks=marks,
            insets=insets,
            ghost=ghost,
            theme=theme,
            width_px=width,
        )
    options.say_written(target, quiet)


@app.command("photo")
def photo(
    name: lens_options.LensName,
    f_number: lens_options.FNumber = None,
    focus: lens_options.Focus = None,
    circle: Circle = None,
    exposure_time: Annotated[
        Optional[str],  # noqa: UP045
        typer.Option("--exposure-time", metavar="TIME", help="In seconds, 1/125 or 0.008: also print exposure values"),
    ] = None,
    iso: Annotated[float, typer.Option("--iso", metavar="ISO", help="Sensitivity, for exposure values")] = 100.0,
    zoom: lens_options.Zoom = None,
    glass: lens_options.Glasses = None,
    force: lens_options.Force = False,
    pbrt_thickness: lens_options.PbrtThickness = None,
    as_json: AsJson = False,
    quiet: options.Quiet = False,
) -> None:
    """Print photographers' figures: depth of field, angle of view, breathing, T-stop, exposure value."""
    from ..photography import photographic_figures

    if not 0 < iso < math.inf:
        raise InputError("--iso: a positive number is wanted")
    lens = options.lens(name, focus, f_number, zoom=zoom, glass=glass, force=force, pbrt_thickness=pbrt_thickness)
    figures = photographic_figures(
        lens,
        circle_of_confusion_mm=circle,
        exposure_time_s=None if exposure_time is None else lens_options.seconds(exposure_time),
        iso=iso,
    )
    if as_json:
        typer.echo(json_text(figures))
    elif not quiet:
        lens_figures.print_columns([lens.title or lens.name], [lens_figures.photo_rows(figures)])


@app.command("compare")
def compare(
    first: lens_options.LensName,
    second: Annotated[str, typer.Argument(help="Another one", metavar="LENS", autocompletion=completion_of("LENS"))],
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", metavar="FILE", help="Also draw both at one scale: .svg, .png or .pdf"),
    ] = None,
    f_number: lens_options.FNumber = None,
    focus: lens_options.Focus = None,
    circle: Circle = None,
    mtf: Annotated[
        Optional[str],  # noqa: UP045
        typer.Option(
            "--mtf",
            metavar="PER_MM",
            help="Also the MTF at these frequencies, in periods per mm: 10,30. Takes seconds",
        ),
    ] = None,
    wavelengths: lens_options.Wavelengths = None,
    radius_colours: lens_options.RadiusColours = False,
    marks: lens_options.Marks = False,
    theme: lens_options.ThemeName = "light",
    width: lens_options.Width = 1600,
    zoom: lens_options.Zoom = None,
    glass: lens_options.Glasses = None,
    force: lens_options.Force = False,
    pbrt_thickness: lens_options.PbrtThickness = None,
    as_json: AsJson = False,
    quiet: options.Quiet = False,
) -> None:
    """Print figures of two lenses side by side, at the same focus and stop if these are given, and draw both."""
    from ..photography import lens_summary

    lenses = [
        options.lens(name, focus, f_number, zoom=zoom, glass=glass, force=force, pbrt_thickness=pbrt_thickness)
        for name in (first, second)
    ]
    colours = lens_options.numbers(wavelengths, "--wavelengths")
    if output is not None:
        from ..figure_files import check_figure_target

        lens_options.check_not_the_lens(check_figure_target(output), first, second)
    frequencies = lens_options.numbers(mtf, "--mtf") or []
    summaries = [
        lens_summary(lens, mtf_frequencies_per_mm=frequencies, circle_of_confusion_mm=circle) for lens in lenses
    ]
    if as_json:
        typer.echo(json_text(summaries))
    elif not quiet:
        rows = [lens_figures.summary_rows(summary) for summary in summaries]
        lens_figures.print_columns([lens.title or lens.name for lens in lenses], rows)
    if output is not None:
        from ..draw import save_states

        save_states(
            [(lens.title or lens.name, lens) for lens in lenses],
            output,
            wavelengths_nm=colours,
            radius_colours=radius_colours,
            marks=marks,
            theme=theme,
            width_px=width,
        )
        options.say_written(output, quiet or as_json)


@app.command("convert")
def convert(
    name: lens_options.LensName,
    output: Annotated[
        Path, typer.Option("--output", "-o", metavar="FILE", help="A .toml, .zmx, .seq, .json, .roa or .osl file")
    ],
    zoom: lens_options.Zoom = None,
    glass: lens_options.Glasses = None,
    force: lens_options.Force = False,
    pbrt_thickness: lens_options.PbrtThickness = None,
    quiet: options.Quiet = False,
) -> None:
    """Write a lens for realcam (.toml), Zemax (.zmx), CODE V (.seq), Optiland (.json), ray-optics or Blender (.osl)."""
    lens_options.check_not_the_lens(output, name)
    options.lens(name, zoom=zoom, glass=glass, force=force, pbrt_thickness=pbrt_thickness).save(output)
    options.say_written(output, quiet)


@app.command("blender")
def blender(
    names: Annotated[
        Optional[list[str]],  # noqa: UP045
        typer.Argument(
            help="Lenses, bundled or files [all that are bundled]", metavar="LENS", autocompletion=completion_of("LENS")
        ),
    ] = None,
    output: Annotated[Path, typer.Option("--output", "-o", metavar="FILE", help="A .zip file")] = Path(
        "realcam-lenses.zip"
    ),
    quiet: options.Quiet = False,
) -> None:
    """Write an extension for Blender 5 with lenses as cameras of Cycles. All lenses take some minutes."""
    from ..blender import write_extension

    lens_options.check_not_the_lens(output, *(names or []))
    lenses = [options.lens(name) for name in names] if names else None
    write_extension(output, lenses, left_out=lambda why: typer.echo(f"left out: {why}", err=True))
    options.say_written(output, quiet)


@app.command("gallery")
def gallery(
    names: Annotated[
        Optional[list[str]],  # noqa: UP045
        typer.Argument(
            help="Lenses, bundled or files [all that are bundled]", metavar="LENS", autocompletion=completion_of("LENS")
        ),
    ] = None,
    output: Annotated[Path, typer.Option("--output", "-o", metavar="FILE", help="A .png, .svg or .pdf file")] = Path(
        "lenses.png"
    ),
    columns: Annotated[int, typer.Option(metavar="N", help="Drawings side by side", min=1, max=50)] = 6,
    theme: lens_options.ThemeName = "light",
    glass: lens_options.Glasses = None,
    force: lens_options.Force = False,
    pbrt_thickness: lens_options.PbrtThickness = None,
    quiet: options.Quiet = False,
) -> None:
    """Write a contact sheet: the cross-sections of all bundled lenses, or of those named."""
    from ..gallery import save_gallery

    lens_options.check_not_the_lens(output, *(names or []))
    lenses = [
        options.lens(name, glass=glass, force=force, pbrt_thickness=pbrt_thickness) for name in names or []
    ]  # fmt: skip
    save_gallery(output, lenses or None, columns, theme=theme)
    options.say_written(output, quiet)
