"""The command `realcam lens optimise`: minimises the spots of a lens by least squares within bounds."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from .._core import InputError, Lens
from ..derivatives.variable import Variable
from ..dispersion import LINE_C_NM, LINE_D_NM, LINE_F_NM
from ..json_values import json_text
from ..number_text import counted, number_text
from ..progress import progress_bar
from . import lens_options, options
from .grouped_options import grouped

if TYPE_CHECKING:
    from ..optimisation.glass_search import GlassSearch
    from ..optimisation.operands import Operand
    from ..optimisation.optimiser import Optimisation

VARIABLE_GROUPS = ("radii", "thicknesses", "conics")


@dataclass(frozen=True)
class Bounds:
    """Options for the bounds of the variables, in mm."""

    least_radius: Annotated[float, typer.Option(metavar="MM", help="Smallest radius in mm", min=0)] = 0.0
    least_thickness: Annotated[float, typer.Option(metavar="MM", help="Smallest air thickness in mm")] = 0.1
    least_glass: Annotated[
        float,
        typer.Option(metavar="MM", help="Smallest glass thickness in mm, or that of the input lens if it is smaller"),
    ] = 1.0
    most_thickness: Annotated[
        float | None,
        typer.Option(metavar="MM", help="Largest thickness in mm [three times the largest of the input lens]"),
    ] = None
    least_edge: Annotated[
        float | None,
        typer.Option(
            metavar="MM",
            help="Smallest edge thickness of glass in mm [0.5, or that of the input lens if it is smaller]",
        ),
    ] = None

    def least_thickness_of(self, lens: Lens, surface: int) -> float:
        """Returns the lower bound of the thickness behind a surface. surface: index from 0."""
        s = lens.surfaces[surface]
        is_glass = s.type == "refracting" and s.material.index(lens.wavelength_nm) > 1.1
        return max(self.least_thickness, min(self.least_glass, s.thickness_mm)) if is_glass else self.least_thickness

    def most_thickness_of(self, lens: Lens) -> float:
        """Returns the upper bound of all thicknesses."""
        return self.most_thickness or 3 * max(abs(s.thickness_mm) for s in lens.surfaces)


@grouped
def optimise(
    name: lens_options.LensName,
    *,
    output: Annotated[Path, options.output("A .toml, .zmx or .seq file")],
    vary: Annotated[
        list[str] | None,
        typer.Option(
            metavar="WHAT",
            help="Variables: radii, thicknesses, conics, or a single one: radius:2, thickness:3, conic:2, aspheric:2:4 "
            "(number of the surface from 1, power); may be repeated [radii]",
        ),
    ] = None,
    fields_deg: Annotated[
        Sequence[float] | None,
        lens_options.fields_option(
            "Field angles whose spots are minimised, separated by commas [those of the lens's file; the film's]"
        ),
    ] = None,
    focal_length: Annotated[
        float | None, typer.Option(metavar="MM", help="Target focal length in mm [that of the input lens]")
    ] = None,
    bounds: Bounds,
    most_distortion: Annotated[
        float | None,
        typer.Option(
            metavar="PERCENT",
            help="Largest distortion in percent at the outermost field, of either sign [no limit]",
            min=0,
        ),
    ] = None,
    glasses: Annotated[bool, typer.Option("--glasses", help="Also search the catalogue for better glasses")] = False,
    global_looks: Annotated[
        int,
        typer.Option("--global", metavar="N", help="Number of lenses sampled over the bounds before the search", min=0),
    ] = 0,
    steps: Annotated[
        int, typer.Option(metavar="N", help="Largest number of optimisation steps", min=1, max=10000)
    ] = 50,
    rings: lens_options.Rings,
    file: lens_options.File,
    as_json: options.AsJson = False,
    quiet: options.Quiet = False,
) -> None:
    """Minimise the spots of a lens by least squares within bounds. Ctrl-C ends the search with the best lens so far."""
    from .. import files
    from ..optimisation.glass_search import with_better_glasses
    from ..optimisation.operands import Operand
    from ..optimisation.optimiser import Targets, optimised

    lens_options.check_not_the_lens(files.check_target(output, (".toml", ".zmx", ".seq")), name)
    if glasses and global_looks:
        raise InputError("--glasses and --global cannot be combined")
    lens, file_fields_deg, _ = file.lens_and_light(name)
    lens = rings.set(lens)
    variables = [v for text in vary or ["radii"] for v in _variables_of(text, lens, bounds)]
    fields = tuple(fields_deg or file_fields_deg or _fields(lens))
    operands = _edges(lens, bounds.least_edge)
    if most_distortion is not None:
        outermost = max(fields, key=abs)
        operands += [
            Operand("distortion_percent", sign * most_distortion, 0.1, bound, outermost)
            for sign, bound in ((1, "most"), (-1, "least"))
        ]
    targets = Targets(
        fields_deg=fields,
        wavelengths_nm=(LINE_F_NM, LINE_D_NM, LINE_C_NM),
        focal_length_mm=focal_length or lens.first_order().effective_focal_length_mm,
        focal_length_weight=0.1,
        operands=operands,
    )
    with progress_bar("optimising", is_shown=not quiet) as bar:
        # The number of steps of a glass search is unknown in advance.
        expected = steps + global_looks if not glasses else 100 * steps

        def report(count: int, _: float) -> bool:
            return bar(min(1.0, count / expected))

        found: Optimisation | GlassSearch
        new_glasses: Mapping[int, str] = {}
        if glasses:
            found = searched = with_better_glasses(
                lens, variables, targets, most_steps=min(steps, 10), progress=report, answers_interrupt=True
            )
            new_glasses = searched.glasses
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
    found.lens.save(output)
    if file_fields_deg and output.suffix.lower() != ".toml":
        warnings.warn(f"{output}: the fields and wavelengths of {name} are not written; set them again", stacklevel=1)
    if as_json or not quiet:
        _print(found, new_glasses, output, as_json)
    options.say_written(output, quiet or as_json)
    if found.message == "interrupted":
        raise typer.Exit(130)


def _variables_of(text: str, lens: Lens, bounds: Bounds) -> list[Variable]:
    """Returns the variables that a value of --vary names. Raises InputError."""
    kind, *numbers = text.split(":")
    if text in VARIABLE_GROUPS:
        return [v for i in range(len(lens.surfaces)) for v in _surface_variables(i, text, lens, bounds)]
    if len(numbers) != {"radius": 1, "thickness": 1, "conic": 1, "aspheric": 2}.get(kind):
        raise InputError(
            f'--vary: "{text}": expected {", ".join(VARIABLE_GROUPS)}, radius:2, thickness:3, conic:2 or aspheric:2:4'
        )
    try:
        number, *power = [int(part) for part in numbers]
    except ValueError:
        raise InputError(f'--vary: "{text}": expected whole numbers after the colon') from None
    if not 1 <= number <= len(lens.surfaces):
        raise InputError(f'--vary: "{text}": there is no surface {number}; the lens has {len(lens.surfaces)}')
    surface = number - 1
    if kind == "radius":
        return [Variable.radius(surface, bounds.least_radius)]
    if kind == "thickness":
        least, most = bounds.least_thickness_of(lens, surface), bounds.most_thickness_of(lens)
        return [Variable.thickness(surface, least, most)]
    if kind == "conic":
        return [Variable.conic(surface)]
    return [Variable.aspheric(surface, *power)]


def _surface_variables(i: int, group: str, lens: Lens, bounds: Bounds) -> Iterator[Variable]:
    """Yields the variable of surface i, from 0, in one of VARIABLE_GROUPS, if it has one."""
    surface = lens.surfaces[i]
    is_curved = surface.type in ("refracting", "mirror") and surface.curvature_per_mm != 0
    if group == "radii" and is_curved:
        yield Variable.radius(i, bounds.least_radius)
    elif group == "conics" and is_curved:
        yield Variable.conic(i)
    elif group == "thicknesses" and i + 1 < len(lens.surfaces) and surface.thickness_mm > bounds.least_thickness:
        most = max(bounds.most_thickness_of(lens), 1.001 * surface.thickness_mm)
        yield Variable.thickness(i, bounds.least_thickness_of(lens, i), most)


def _edges(lens: Lens, least: float | None) -> list[Operand]:
    """Returns operands that bound the edge thickness of each glass from below.

    least: bound in mm; None: 0.5, or the present edge thickness if that is smaller.
    """
    from ..optimisation.operands import Operand

    operands = []
    for i, (front, back) in enumerate(pairwise(lens.surfaces)):
        if front.type != "refracting" or back.type != "refracting" or front.material.index(lens.wavelength_nm) < 1.1:
            continue
        edge = Operand("edge_thickness_mm", surface=i, bound="least", weight=10)
        operands.append(replace(edge, target=min(0.5, edge.value_of(lens, 1)) if least is None else least))
    return operands


def _fields(lens: Lens) -> tuple[float, ...]:
    """Returns the field angles in degrees of the axis, and of 0.7 and 1 times the image height."""
    from ..fields import fields_at

    return tuple(field.angle_deg for field in fields_at(lens, (0.0, 0.7, 1.0)))


def _print(found: Optimisation | GlassSearch, glasses: Mapping[int, str], file: Path, as_json: bool) -> None:
    if as_json:
        figures = {
            "rms_spot_before_mm": found.rms_spot_before_mm,
            "rms_spot_mm": found.rms_spot_mm,
            "evaluations": found.evaluations,
            "glasses": {str(surface + 1): name for surface, name in glasses.items()},
            "message": found.message,
            "file": str(file),
        }
        typer.echo(json_text(figures))
    else:
        typer.echo(
            f"RMS spot {number_text(1000 * found.rms_spot_before_mm, 3)} um before, "
            f"{number_text(1000 * found.rms_spot_mm, 3)} um now, "
            f"after {counted(found.evaluations, 'evaluation')}: {found.message}"
        )
        for surface, name in glasses.items():
            typer.echo(f"surface {surface + 1}: {name}")
