"""The commands `realcam lens plot` and `realcam lens report`: analyses of a lens as plots, numbers and reports."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer

from .._core import InputError
from . import lens_options, options
from .grouped_options import grouped

ObjectDistance = Annotated[
    float | None,
    options.parsed(
        options.number,
        "--object-distance",
        "METRES",
        "Distance from the object plane to the front vertex in metres, or inf [the plane in focus]",
    ),
]
Fields = Annotated[
    Sequence[float] | None,
    lens_options.fields_option("Field angles in degrees, separated by commas [up to the film's corner]"),
]
Wavelengths = Annotated[
    Sequence[float] | None,
    lens_options.wavelengths_option("Wavelengths in nm, separated by commas [F line, the design wavelength, C line]"),
]


def register(app: typer.Typer) -> None:
    """Adds the commands to the group `realcam lens`."""
    app.command("plot")(grouped(plot))
    app.command("report")(grouped(report))


def plot(
    kind: Annotated[str, typer.Argument(help="Kind of plot, one of the above", metavar="KIND")],
    name: Annotated[str | None, lens_options.lens_argument(lens_options.LENS_HELP)] = None,
    *,
    output: Annotated[
        list[Path] | None,
        options.output(".svg, .pdf, .png, .jpg, .tif or .webp; .json or .csv for the numbers. May be repeated"),
    ] = None,
    rings: lens_options.Rings,
    file: lens_options.File,
    fields: Fields = None,
    wavelengths: Wavelengths = None,
    frequencies: Annotated[
        Sequence[float] | None,
        options.parsed(
            options.numbers,
            "--frequencies",
            "PER_MM",
            "Frequencies of the MTF in periods per mm, separated by commas; for `mtf`, the highest frequency",
        ),
    ] = None,
    method: Annotated[
        str | None,
        typer.Option(
            metavar="NAME",
            help="For mtf, mtf-field and mtf-focus: diffraction or geometric (rays alone). For psf: direct, fft or "
            "geometric",
        ),
    ] = None,
    object_distance: ObjectDistance = None,
    theme: lens_options.ThemeName = "light",
    size: Annotated[
        str, typer.Option("--figure-size", metavar="NAME", help="Size of the plot: small or large")
    ] = "large",
    as_json: Annotated[bool, typer.Option("--json", help="Print the numbers as JSON")] = False,
    quiet: options.Quiet = False,
) -> None:
    """Plot one analysis of a lens, or write its numbers.

    KIND: ray-fan, spot, spot-through-focus, longitudinal, field-curves, distortion, distortion-grid, lateral-colour,
    seidel, wavefront, zernike, psf, mtf, mtf-field, mtf-focus, relative-illumination, pupil, bokeh,
    depth-of-field; over the film spot-map, wavefront-map, mtf-x-map, mtf-y-map, illumination-map, distortion-map.
    """
    from .. import analysis, files  # brings matplotlib, which other commands need not load
    from ..analysis import kinds, numbers
    from ..drawing.figure_files import FORMATS, save_figure

    if kind not in kinds.KINDS and name in kinds.KINDS:
        raise InputError(f'KIND and LENS are swapped (did you mean "{name} {kind}"?)')
    kind = options.known_word(kind, kinds.KINDS, "plot")
    if name is None:
        raise InputError(f"realcam lens plot {kind}: the name of a lens is missing")
    targets = output or ([] if as_json else [Path(f"{kind}.svg")])
    for target in targets:
        files.check_target(target, (*FORMATS, *numbers.FORMATS))
        lens_options.check_not_the_lens(target, name)
    lens = rings.set(file.lens(name))
    bundles = analysis.Bundles(lens, object_distance)
    request = kinds.PlotArguments(
        lens,
        bundles,
        fields,
        wavelengths,
        frequencies,
        method,
    )
    data = kinds.compute(kind, request)
    for target in targets:
        if target.suffix.lower() in numbers.FORMATS:
            numbers.save_numbers(data, target)
        else:
            figure = kinds.plot_figure(kind, data, theme=theme, size=size, title=options.title_of(lens))
            save_figure(figure, target)
        options.say_written(target, quiet or as_json)
    if as_json:
        typer.echo(numbers.as_json(data))


def report(
    name: lens_options.LensName,
    *,
    output: Annotated[Path | None, options.output("A .pdf or .html file [LENS.pdf in the current folder]")] = None,
    rings: lens_options.Rings,
    file: lens_options.File,
    fields: Fields = None,
    wavelengths: Wavelengths = None,
    object_distance: ObjectDistance = None,
    theme: Annotated[
        str | None, typer.Option(metavar="NAME", help="Colour theme: light or dark [light; the browser's for .html]")
    ] = None,
    quiet: options.Quiet = False,
) -> None:
    """Write a report about a lens on four pages: the lens, rays, contrast and colour, waves and light.

    For the file of another program that specifies an off-axis field or several wavelengths, the report uses three of
    them, unless options specify others.
    """
    from ..analysis import save_report
    from ..analysis.fields import three_of

    lens_of_file, file_fields, file_wavelengths = file.lens_and_light(name)
    lens = rings.set(lens_of_file)
    if fields is None and lens.is_rotational and lens.zoom_position == lens_of_file.zoom_position and any(file_fields):
        fields = three_of([0.0, *file_fields])
    if wavelengths is None and len(file_wavelengths) > 1:
        wavelengths = three_of(file_wavelengths, lens.wavelength_nm)
    target = output or lens_options.default_output(name, ".pdf")
    lens_options.check_not_the_lens(target, name)
    save_report(
        lens,
        target,
        fields_deg=fields,
        wavelengths_nm=wavelengths,
        object_distance_m=object_distance,
        theme=theme,
    )
    options.say_written(target, quiet)
