"""The command `realcam lens image`: simulates the image of a flat picture through a lens."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer

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
    output: Annotated[Path, options.output("A .png, .jpg, .tif or .webp file")],
    rings: lens_options.Rings,
    object_distance: lens_plots.ObjectDistance = None,
    height_deg: Annotated[
        float | None, typer.Option(metavar="DEGREES", help="Angle that the picture's height spans [fits the film]")
    ] = None,
    height: Annotated[
        float | None,
        typer.Option(metavar="METRES", help="Height of the picture in metres, for an object at a finite distance"),
    ] = None,
    projection: Annotated[
        str | None,
        typer.Option(
            metavar="NAME",
            help="tangent (r = f tan): a flat object; angle (r = f theta): distances from the picture's centre are "
            "field angles [angle beyond 70 degrees]",
        ),
    ] = None,
    resolution: Annotated[
        Sequence[int] | None,
        options.parsed(options.size, "--resolution", "WxH", "Number of pixels of the film [as the picture]"),
    ] = None,
    pixel: Annotated[float | None, typer.Option(metavar="UM", help="Pixel pitch in um [fits the film]")] = None,
    crop: Annotated[
        Sequence[int] | None,
        options.parsed(
            options.whole_numbers,
            "--crop",
            "X,Y,W,H",
            "Part of the film to compute, in pixels: left, top, width, height [all]",
            ",",
            4,
        ),
    ] = None,
    flip: Annotated[
        str,
        typer.Option(
            metavar="NAME", help="none, horizontal, vertical, or both: upside down and mirrored, as on the film"
        ),
    ] = "none",
    falloff: Annotated[bool, typer.Option(help="Include relative illumination")] = True,
    psfs: Annotated[
        bool, typer.Option("--psfs", help="Put a grid of point spread functions to the right of the picture")
    ] = False,
    psf_grid: Annotated[
        Sequence[int] | None,
        options.parsed(
            options.size, "--psf-grid", "XxY", "Number of point spread functions computed over the film [7x5]"
        ),
    ] = None,
    wavelengths: Annotated[
        Sequence[float] | None,
        lens_options.wavelengths_option("Wavelengths in nm, separated by commas [440 to 640]"),
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
            object_distance_m=object_distance,
            resolution=resolution,
            pixel_um=pixel,
            crop=crop,
            flip=flip,
            falloff=falloff,
            psf_grid=psf_grid or (7, 5),
            wavelengths_nm=wavelengths,
            progress=bar,
        )
    simulated.save(output, psfs=psfs)
    options.say_written(output, quiet)
