"""The command `realcam lens tolerance`: Monte Carlo tolerance analysis of a lens."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..json_values import json_text
from ..number_text import number_text, percent_text
from ..progress import progress_bar
from . import lens_options, options
from .grouped_options import grouped

if TYPE_CHECKING:
    from ..tolerance import ToleranceStudy


@grouped
def tolerance(
    name: lens_options.LensName,
    *,
    grade: Annotated[
        str, typer.Option(metavar="NAME", help="Grade of all tolerances: commercial, precision or high")
    ] = "commercial",
    output: Annotated[Path | None, options.output("File for a report, .html")] = None,
    copies: Annotated[int, typer.Option(metavar="N", help="Number of copies of the lens with random errors")] = 1000,
    seed: Annotated[int, typer.Option(metavar="N", help="Seed; the same seed makes the same copies")] = 0,
    compensate: Annotated[
        str,
        typer.Option(metavar="WHAT", help="Compensators: refocus, film_tilt, both separated by a comma, or nothing"),
    ] = "refocus",
    distribution: Annotated[
        str, typer.Option(metavar="NAME", help="Distribution of errors: uniform, or normal with the limit at 2 sigma")
    ] = "uniform",
    frequency: Annotated[
        float | None, typer.Option(metavar="PER_MM", help="Spatial frequency of the MTF [20 on a film of 36 x 24 mm]")
    ] = None,
    at_least: Annotated[
        float | None,
        typer.Option(
            metavar="MTF", help="Smallest acceptable MTF of the worst field, for the yield [half of the nominal lens's]"
        ),
    ] = None,
    rings: lens_options.Rings,
    file: lens_options.File,
    theme: Annotated[str | None, typer.Option(metavar="NAME", help="light or dark [as the browser is set]")] = None,
    as_json: options.AsJson = False,
    quiet: options.Quiet = False,
) -> None:
    """Make copies of a lens with manufacturing errors within tolerances, and compare their images with the design.

    Ctrl-C ends the study with the copies that are done.
    """
    from .. import files
    from ..tolerance import Tolerances, tolerance_study
    from ..tolerance.compensators import NAMES
    from ..tolerance.tolerances import check_distribution

    tolerances = Tolerances.grade(grade, distribution=distribution)
    words = [word.strip() for word in compensate.split(",")]
    # "nothing" is valid alone, but not in a list.
    known = (*NAMES, "nothing") if len(words) == 1 else NAMES
    compensators = [options.known_word(word, known, "compensator") for word in words if word != "nothing" or words[1:]]
    check_distribution(distribution)
    if output is not None:
        lens_options.check_not_the_lens(files.check_target(output, (".html",)), name)
    lens = rings.set(file.lens(name))
    with progress_bar(f"{copies} copies", is_shown=not (quiet or as_json)) as bar:
        study = tolerance_study(
            lens,
            tolerances,
            copies,
            compensators=compensators,
            seed=seed,
            frequencies_per_mm=None if frequency is None else [frequency],
            progress=bar,
        )
    min_mtf = 0.5 * study.nominal_measure("lowest_mtf") if at_least is None else at_least
    yield_share = study.yield_of(lowest_mtf=min_mtf)
    if output is not None:
        from ..tolerance.report import save_tolerance_report  # brings matplotlib

        save_tolerance_report(study, output, theme=theme)
    if as_json:
        yields = {"lowest_mtf": min_mtf, "share": yield_share}
        typer.echo(json_text({**study.summary(), "grade": grade, "yield": yields}))
        return
    if quiet:
        return
    if not study.is_whole:
        typer.echo(f"ended after {number_text(len(study))} of {number_text(copies)} copies")
    _print(study, min_mtf, yield_share)
    if output is not None:
        options.say_written(output)


def _print(study: ToleranceStudy, min_mtf: float, yield_share: float) -> None:
    """Prints a table of measures: value of the nominal lens, and quantiles over all copies."""
    from ..tolerance.plots import MEASURES, with_limit

    typer.echo(f"MTF at {number_text(study.frequencies_per_mm[study.middle_frequency])} periods per mm")
    typer.echo(f"{'':26}{'nominal':>10}{'10% below':>12}{'50% below':>12}{'90% below':>12}")
    for measure, name in MEASURES.items():
        scale = 100 if measure == "distortion" else 1
        low, middle, high = scale * study.quantiles(measure, [0.1, 0.5, 0.9])
        nominal = scale * study.nominal_measure(measure)
        typer.echo(f"{name:26}{nominal:10.4f}{low:12.4f}{middle:12.4f}{high:12.4f}")
    typer.echo(f"yield with an MTF of {min_mtf:.3g} in the worst field: {percent_text(yield_share, 3)}")
    typer.echo("worst offenders, mean MTF lost at the limit:")
    for offender in study.worst_offenders(8):
        typer.echo(f"  {offender.loss:7.4f}  {with_limit(offender)}")
