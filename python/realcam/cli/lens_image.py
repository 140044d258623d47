"""The command `realcam lens image`: simulates the image of a flat picture through a lens."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from .._core import InputError
from ..image_file import DEVELOPED
from ..progress import progress_bar
from . import lens_options, lens_plots, options
from .grouped_options import grouped


@grouped
def image(
    name: lens_options.LensName,
    picture: Annotated[
        Path, typer.Argument(help="A .png, .jpg, .tif, .webp, .bmp, .exr or .hdr file", metavar="PICTURE")
    ],
    *,
    output: Annotated[Path, typer.Option("--output", "-o", metavar="FILE", help="A .png, .jpg, .tif or .webp file")],
    rings: lens_options.Rings,
    object_distance: lens_plots.ObjectDistance = None,
    height_deg: Annotated[
        float | None,
        typer.Option("--height-deg", metavar="DEGREES", help="Angle that the picture's height spans [fits the film]"),
    ] = None,
    height: Annotated[
        float | None,
        typer.Option(
            "--height", metavar="METRES", help="Height of the picture in metres, for an object at a finite distance"
        ),
    ] = None,
    projection: Annotated[
        str | None,
        typer.Option(
            "--projection",
            metavar="NAME",
            help="tangent (r = f tan): a flat object; angle (r = f theta): distances from the picture's centre are "
            "field angles [angle beyond 70 degrees]",
        ),
    ] = None,
    resolution: Annotated[
        str | None, typer.Option("--resolution", metavar="WxH", help="Number of pixels of the film [as the picture]")
    ] = None,
    pixel: Annotated[
        float | None, typer.Option("--pixel", metavar="UM", help="Pixel pitch in um [fits the film]")
    ] = None,
    crop: Annotated[
        str | None,
        typer.Option(
            "--crop", metavar="X,Y,W,H", help="Part of the film to compute, in pixels: left, top, width, height [all]"
        ),
    ] = None,
    flip: Annotated[
        str,
        typer.Option(
            "--flip",
            metavar="NAME",
            help="none, horizontal, vertical, or both: upside down and mirrored, as on the film",
        ),
    ] = "none",
    falloff: Annotated[bool, typer.Option(help="Include relative illumination")] = True,
    psfs: Annotated[
        bool, typer.Option("--psfs", help="Put a grid of point spread functions to the right of the picture")
    ] = False,
    psf_grid: Annotated[
        str, typer.Option("--psf-grid", metavar="XxY", help="Number of point spread functions computed over the film")
    ] = "7x5",
    wavelengths: Annotated[
        str | None,
        typer.Option("--wavelengths", metavar="NM", help="Wavelengths in nm, separated by commas [440 to 640]"),
    ] = None,
    file: lens_options.File,
    quiet: options.Quiet = False,
) -> None:
    """Image a flat picture through a lens: blur, distortion, lateral colour, falloff and diffraction."""
    from .. import files
    from ..analysis.image_simulation import image_simulation

    lens_options.check_not_the_lens(files.check_target(output, DEVELOPED), name)
    lens = rings.set(file.lens(name))
    with progress_bar("image simulation", is_shown=not quiet) as bar:
        simulated = image_simulation(
            lens,
            picture,
            height_deg=height_deg,
            height_m=height,
            projection=projection,
            object_distance_m=None if object_distance is None else options.number(object_distance, "--object-distance"),
            resolution=None if resolution is None else _whole_numbers(resolution, "--resolution", "x", 2),
            pixel_um=pixel,
            crop=None if crop is None else _whole_numbers(crop, "--crop", ",", 4),
            flip=flip,
            falloff=falloff,
            psf_grid=_whole_numbers(psf_grid, "--psf-grid", "x", 2),
            wavelengths_nm=lens_options.numbers(wavelengths, "--wavelengths"),
            progress=bar,
        )
    simulated.save(output, psfs=psfs)
    options.say_written(output, quiet)


def _whole_numbers(text: str, option: str, separator: str, count: int) -> tuple[int, ...]:
    """Converts `count` whole numbers with a separator between them. Raises InputError."""
    words = text.split(separator)
    if len(words) != count or not all(word.strip().isdecimal() and len(word) < 9 for word in words):
        raise InputError(f'{option}: "{text:.40}": expected {count} whole numbers with "{separator}" between')
    return tuple(map(int, words))
