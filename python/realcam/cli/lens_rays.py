"""The commands `realcam lens rays` and `realcam lens fit`: rays of a lens, and a lens fitted to rays."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

from ..files import check_target, record_input
from ..json_values import json_text
from . import lens_options, options
from .grouped_options import grouped


@grouped
def rays(
    name: lens_options.LensName,
    *,
    output: Annotated[Path, options.output("The .npz file to write")],
    rings: lens_options.Rings,
    count: Annotated[int, typer.Option("--rays", metavar="N", help="Number of rays, including blocked ones")] = 20000,
    wavelengths: Annotated[
        Sequence[float] | None,
        lens_options.wavelengths_option("Wavelengths of the rays in nm, separated by commas [the design wavelength]"),
    ] = None,
    file: lens_options.File,
    quiet: options.Quiet = False,
) -> None:
    """Write pairs of rays behind and in front of a lens, to which `realcam lens fit` fits a lens without surfaces."""
    from ..ray_pairs import save_rays

    lens = rings.set(file.lens(name))
    lens_options.check_not_the_lens(output, name)
    save_rays(lens, output, rays=count, wavelengths_nm=wavelengths)
    options.say_written(output, quiet)


def fit(
    rays: Annotated[Path, typer.Argument(help="An .npz file of the format ray-pairs/1", metavar="RAYS")],
    output: Annotated[Path, options.output("The .npz file to write")],
    as_json: options.AsJson = False,
    quiet: options.Quiet = False,
) -> None:
    """Fit a lens to pairs of rays in front of and behind it, and print its errors on rays that the fit has not used."""
    from ..ray_pairs import RayPairLens

    record_input(rays)
    check_target(output)  # before the fit, which takes seconds
    lens = RayPairLens.fit(rays)
    lens.save(output)
    report = lens.fit_report
    if as_json:
        typer.echo(json_text(asdict(report)))
        return
    if not quiet:
        for what, value in {
            "rays": f"{report.rays} at f/{lens.f_number:.4g}",
            "polynomials": f"degree {report.degree}",
            "direction": f"{1e6 * report.direction_rms_rad:.3g} microradians rms, "
            f"{1e6 * report.direction_worst_rad:.3g} at worst",
            "position": f"{1e3 * report.distance_rms_mm:.3g} um rms",
            "passing": f"{100 * report.passing_accuracy:.2f}% of the rays decided rightly",
            "measured": f"film points up to {report.film_radius_mm:.4g} mm, with light up to "
            f"{report.light_radius_mm:.4g} mm; angles up to {report.largest_angle_deg:.4g} degrees",
        }.items():
            typer.echo(f"{what:12} {value}")
    options.say_written(output, quiet)
