"""realcam lens optimise: a lens made sharper, within bounds."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Optional

import typer

from .._core import InputError, Lens
from ..json_values import json_text
from ..progress import progress_bar
from ..variable import Variable
from . import lens_options, options

WAYS = ("radii", "thicknesses", "conics")
COLOURS_NM = (486.1327, 587.5618, 656.2725)


def optimise(
    name: lens_options.LensName,
    output: Annotated[Path, typer.Option("--output", "-o", metavar="FILE", help="A .toml, .zmx or .seq file")],
    vary: Annotated[
        Optional[list[str]],  # noqa: UP045
        typer.Option(
            "--vary",
            metavar="WHAT",
            help="radii, thicknesses, conics, or one of them: radius:2, thickness:3, conic:2, aspheric:2:4 (surface "
            "as lens info counts them, power); may be repeated [radii]",
        ),
    ] = None,
    field_deg: Annotated[
        Optional[list[float]],  # noqa: UP045
        typer.Option("--field", metavar="DEGREES", help="An angle whose spot is to be small; may be repeated [film]"),
    ] = None,
    focal_length: Annotated[
        Optional[float],  # noqa: UP045
        typer.Option("--focal-length", metavar="MM", help="What it is to be [as it is]"),
    ] = None,
    least_radius: Annotated[float, typer.Option(metavar="MM", help="No radius becomes smaller", min=0)] = 0.0,
    least_thickness: Annotated[float, typer.Option(metavar="MM", help="No thickness becomes smaller")] = 0.1,
    most_thickness: Annotated[
        Optional[float],  # noqa: UP045
        typer.Option(metavar="MM", help="No thickness becomes larger [three times the largest]"),
    ] = None,
    least_edge: Annotated[
        Optional[float],  # noqa: UP045
        typer.Option(metavar="MM", help="No glass becomes thinner at its edge [0.5, or as it is]"),
    ] = None,
    most_distortion: Annotated[
        Optional[float],  # noqa: UP045
        typer.Option("--most-distortion", metavar="PERCENT", help="At the outermost field, of either sign", min=0),
    ] = None,
    glasses: Annotated[bool, typer.Option("--glasses", help="Look for better glasses in the catalogue, too")] = False,
    global_looks: Annotated[
        int, typer.Option("--global", metavar="N", help="Looks all over the bounds before the search", min=0)
    ] = 0,
    steps: Annotated[int, typer.Option(metavar="N", help="Steps of the search", min=1, max=10000)] = 50,
    focus: lens_options.Focus = None,
    f_number: lens_options.FNumber = None,
    zoom: lens_options.Zoom = None,
    glass: lens_options.Glasses = None,
    force: lens_options.Force = False,
    pbrt_thickness: lens_options.PbrtThickness = None,
    as_json: options.AsJson = False,
    quiet: options.Quiet = False,
) -> None:
    """Make the spots of a lens smaller, by least squares within bounds. Ctrl-C ends it with the best lens so far."""
    from ..glass_search import GlassSearch, with_better_glasses
    from ..operands import Operand
    from ..optimisation import Optimisation, Targets, optimised

    lens_options.check_not_the_lens(output, name)
    if output.suffix.lower() not in (".toml", ".zmx", ".seq"):
        raise InputError(f"{output}: unknown suffix; .toml, .zmx or .seq is wanted")
    if glasses and global_looks:
        raise InputError("--glasses and --global cannot go together")
    lens = options.lens(name, focus, f_number, zoom=zoom, glass=glass, force=force, pbrt_thickness=pbrt_thickness)
    most = most_thickness or 3 * max(abs(s.thickness_mm) for s in lens.surfaces)

    def variables_of(text: str) -> list[Variable]:
        kind, *numbers = text.split(":")
        if text in WAYS:
            return _all_of(lens, text, least_radius, least_thickness, most)
        if len(numbers) != {"radius": 1, "thickness": 1, "conic": 1, "aspheric": 2}.get(kind):
            raise InputError(
                f'--vary: "{text}": {", ".join(WAYS)}, radius:2, thickness:3, conic:2 or aspheric:2:4 is wanted'
            )
        try:
            number, *power = [int(part) for part in numbers]
        except ValueError:
            raise InputError(f'--vary: "{text}": whole numbers are wanted after the colon') from None
        if not 1 <= number <= len(lens.surfaces):
            raise InputError(f'--vary: "{text}": there is no surface {number}; the lens has {len(lens.surfaces)}')
        surface = number - 1
        if kind == "radius":
            return [Variable.radius(surface, least_radius)]
        if kind == "thickness":
            return [Variable.thickness(surface, least_thickness, most)]
        if kind == "conic":
            return [Variable.conic(surface)]
        return [Variable.aspheric(surface, *power)]

    variables = [v for text in vary or ["radii"] for v in variables_of(text)]
    fields = tuple(field_deg) if field_deg else _fields(lens)
    operands = []
    for i in range(len(lens.surfaces) - 1):
        front, back = lens.surfaces[i], lens.surfaces[i + 1]
        if front.type != "refracting" or back.type != "refracting" or front.material.index(lens.wavelength_nm) < 1.1:
            continue
        edge = Operand("edge_thickness_mm", surface=i, bound="least", weight=10)
        now = edge.value_of(lens, 1)
        operands.append(
            Operand(
                "edge_thickness_mm",
                min(0.5, now) if least_edge is None else least_edge,
                surface=i,
                bound="least",
                weight=10,
            )
        )
    if most_distortion is not None:
        outermost = max(fields, key=abs)
        operands += [
            Operand("distortion_percent", sign * most_distortion, 0.1, bound, outermost)
            for sign, bound in ((1, "most"), (-1, "least"))
        ]
    targets = Targets(
        fields_deg=fields,
        wavelengths_nm=COLOURS_NM,
        focal_length_mm=focal_length or lens.first_order().effective_focal_length_mm,
        focal_length_weight=0.1,
        operands=operands,
    )
    with progress_bar("optimising", is_shown=not quiet) as bar:
        # Of the glasses nobody knows how many steps they take.
        expected = steps + global_looks if not glasses else 100 * steps

        def report(count: int, _: float) -> bool:
            return bar(min(1.0, count / expected))

        found: Optimisation | GlassSearch
        if glasses:
            found = searched = with_better_glasses(
                lens, variables, targets, most_steps=min(steps, 10), progress=report, answers_interrupt=True
            )
            changed = dict(searched.glasses)
        else:
            found = optimised(
                lens,
                variables,
                targets,
                most_steps=steps,
                progress=report,
                global_looks=global_looks,
                answers_interrupt=True,
            )
            changed = dict[int, str]()
    found.lens.save(output)
    if as_json:
        typer.echo(
            json_text(
                {
                    "rms_spot_before_mm": found.rms_spot_before_mm,
                    "rms_spot_mm": found.rms_spot_mm,
                    "evaluations": found.evaluations,
                    "glasses": {str(surface + 1): glass_name for surface, glass_name in changed.items()},
                    "message": found.message,
                    "file": str(output),
                }
            )
        )
    elif not quiet:
        typer.echo(
            f"RMS spot {1000 * found.rms_spot_before_mm:.3g} um before, {1000 * found.rms_spot_mm:.3g} um now, after "
            f"{found.evaluations} looks: {found.message}"
        )
        for surface, glass_name in changed.items():
            typer.echo(f"surface {surface + 1}: {glass_name}")
    options.say_written(output, quiet or as_json)
    if found.message == "interrupted":
        raise typer.Exit(130)


def _all_of(lens: Lens, way: str, least_radius: float, least: float, most: float) -> list[Variable]:
    chosen = []
    for i, surface in enumerate(lens.surfaces):
        bends = surface.type in ("refracting", "mirror") and surface.curvature_per_mm != 0
        if way == "radii" and bends:
            chosen.append(Variable.radius(i, least_radius))
        elif way == "conics" and bends:
            chosen.append(Variable.conic(i))
        elif way == "thicknesses" and i + 1 < len(lens.surfaces) and surface.thickness_mm > least:
            chosen.append(Variable.thickness(i, least, max(most, 1.001 * surface.thickness_mm)))
    return chosen


def _fields(lens: Lens) -> tuple[float, ...]:
    """The axis, 0.7 and all of the image height."""
    from ..fields import fields_at

    return tuple(field.angle_deg for field in fields_at(lens, (0.0, 0.7, 1.0)))
