"""realcam lens: look at lenses."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Annotated, Any, Optional

import typer
from rich.table import Table

from .._core import FirstOrder, Lens, Surface, lens_names
from . import options

app = typer.Typer(help="Look at lenses.", no_args_is_help=True, rich_markup_mode=None)

LensName = Annotated[
    str, typer.Argument(help="A bundled lens (see `realcam lens list`) or a lens file.", metavar="LENS")
]
FNumber = Annotated[Optional[float], typer.Option("--f-number", help="Close the diaphragm to this f-number.")]  # noqa: UP045
Focus = Annotated[Optional[str], typer.Option("--focus", help="Object plane to film in metres, or inf.")]  # noqa: UP045


@app.command("list")
def list_lenses(as_json: Annotated[bool, typer.Option("--json", help="As JSON.")] = False) -> None:
    """List the bundled lenses."""
    rows: list[dict[str, Any]] = []
    for name in lens_names():
        lens = Lens.load(name)
        data = lens.first_order()
        rows.append(
            {
                "name": name,
                "title": lens.title,
                "effective_focal_length_mm": data.effective_focal_length_mm,
                "f_number": data.f_number,
            }
        )
    if as_json:
        typer.echo(json.dumps(rows, indent=2))
        return
    table = Table(box=None, pad_edge=False)
    table.add_column("lens")
    table.add_column("focal length", justify="right")
    table.add_column("f-number", justify="right")
    table.add_column("")
    for row in rows:
        table.add_row(
            row["name"],
            f"{row['effective_focal_length_mm']:.4g} mm",
            f"f/{row['f_number']:.3g}",
            row["title"],
        )
    options.console().print(table)


@app.command("info")
def info(
    name: LensName,
    f_number: FNumber = None,
    focus: Focus = None,
    as_json: Annotated[bool, typer.Option("--json", help="As JSON.")] = False,
) -> None:
    """Print a lens's table of surfaces and its first-order data."""
    lens = options.lens(name, focus, f_number)
    if as_json:
        typer.echo(json.dumps(_as_dict(lens), indent=2))
        return
    console = options.console()
    console.print(f"[bold]{lens.title or lens.name}[/bold]", highlight=False)
    if lens.source:
        console.print(lens.source, highlight=False, style="dim")
    console.print(_surface_table(lens))
    console.print(_first_order_table(lens))


@app.command("draw")
def draw(
    name: LensName,
    output: Annotated[Path | None, typer.Option("--output", "-o", help="A .svg or .png file [LENS.svg].")] = None,
    f_number: FNumber = None,
    focus: Focus = None,
    rays: Annotated[int, typer.Option(help="Rays for each of three points of the film.", min=1, max=101)] = 7,
) -> None:
    """Write the cross-section of a lens, with rays from three points of the film."""
    from ..draw import save_cross_section

    lens = options.lens(name, focus, f_number)
    target = output or Path(f"{lens.name or 'lens'}.svg")
    save_cross_section(lens, target, rays=rays)
    typer.echo(f"wrote {target}")


def _kind(surface: Surface) -> str:
    if surface.type != "refracting":
        return surface.type
    if surface.aspheric_coefficients:
        return "asphere"
    if math.isinf(surface.radius_of_curvature_mm):
        return "plane"
    return "conic" if surface.conic else "sphere"


def _surface_table(lens: Lens) -> Table:
    table = Table(box=None, pad_edge=False)
    for title in (
        "#",
        "kind",
        "radius/mm",
        "thickness/mm",
        "material",
        "n",
        "semi-dia./mm",
        "conic, aspheric terms",
    ):
        table.add_column(title, justify="left" if title in ("kind", "material", "conic, aspheric terms") else "right")
    last = len(lens.surfaces)
    for number, surface in enumerate(lens.surfaces, start=1):
        terms = [f"k {surface.conic:g}"] if surface.conic else []
        terms += [f"r^{power} {value:g}" for power, value in surface.aspheric_coefficients.items()]
        if surface.inner_semi_diameter_mm:
            terms.append(f"blocked inside {surface.inner_semi_diameter_mm:g}")
        radius = surface.radius_of_curvature_mm
        thickness = surface.thickness_mm if number < last else lens.film_distance_mm
        index = surface.material.index(lens.wavelength_nm)
        table.add_row(
            str(number),
            _kind(surface),
            "" if math.isinf(radius) else f"{radius:.6g}",
            f"{thickness:.6g}" + ("" if number < last else " to film"),
            surface.material.label,
            f"{index:.5f}" if surface.material.label else "",
            f"{surface.clear_semi_diameter_mm:.5g}",
            ", ".join(terms),
        )
    return table


def _first_order_rows(lens: Lens, data: FirstOrder) -> list[tuple[str, str]]:
    focus = lens.focus_distance_m
    width, height = lens.film_mm
    return [
        ("effective focal length", f"{data.effective_focal_length_mm:.4f} mm"),
        ("back focal distance", f"{data.back_focal_distance_mm:.4f} mm"),
        ("front focal distance", f"{data.front_focal_distance_mm:.4f} mm"),
        ("f-number", f"{data.f_number:.4f}"),
        (
            "entrance pupil",
            f"diameter {data.entrance_pupil_diameter_mm:.4f} mm at {data.entrance_pupil_position_mm:.4f} mm",
        ),
        (
            "exit pupil",
            f"diameter {data.exit_pupil_diameter_mm:.4f} mm at {data.exit_pupil_position_mm:.4f} mm",
        ),
        ("film distance", f"{lens.film_distance_mm:.4f} mm behind the last vertex"),
        ("focus", "infinity" if math.isinf(focus) else f"{focus:g} m from the film"),
        ("film", f"{width:g} x {height:g} mm"),
        ("wavelength", f"{lens.wavelength_nm:g} nm"),
    ]


def _first_order_table(lens: Lens) -> Table:
    table = Table(box=None, pad_edge=False, show_header=False)
    for row in _first_order_rows(lens, lens.first_order()):
        table.add_row(*row)
    table.caption = "Positions from the front vertex, towards the film."
    table.caption_justify = "left"
    return table


def _as_dict(lens: Lens) -> dict[str, object]:
    data = lens.first_order()
    names = [name for name in dir(data) if not name.startswith("_")]
    return {
        "name": lens.name,
        "title": lens.title,
        "source": lens.source,
        "wavelength_nm": lens.wavelength_nm,
        "film_mm": list(lens.film_mm),
        "film_distance_mm": lens.film_distance_mm,
        "focus_distance_m": None if math.isinf(lens.focus_distance_m) else lens.focus_distance_m,
        # JSON has no infinity, which an afocal lens has here.
        "first_order": {name: value if math.isfinite(value := getattr(data, name)) else None for name in names},
        "surfaces": [
            {
                "type": surface.type,
                "radius_of_curvature_mm": None
                if math.isinf(surface.radius_of_curvature_mm)
                else surface.radius_of_curvature_mm,
                "thickness_mm": surface.thickness_mm,
                "material": surface.material.label or None,
                "refractive_index": surface.material.index(lens.wavelength_nm),
                "clear_semi_diameter_mm": surface.clear_semi_diameter_mm,
                "inner_semi_diameter_mm": surface.inner_semi_diameter_mm,
                "conic": surface.conic,
                "aspheric_coefficients": {str(p): v for p, v in surface.aspheric_coefficients.items()},
            }
            for surface in lens.surfaces
        ],
    }
