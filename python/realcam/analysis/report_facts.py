"""Texts and tables of a report: data of the lens in its current state, prescription, and Seidel sums."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from .._core import InputError
from ..fields import FieldPosition
from . import lens_tables
from .fields import Bundles, Doubles
from .seidel_bars import SYMBOLS, seidel_bars, seidel_table

WIDEST_DEG = 60.0  # largest field of the Seidel sums


@dataclass(frozen=True)
class ReportFacts:
    """Texts of a report: data of the lens, and the table of its surfaces."""

    title: str
    source: str  #: reference of the prescription, from the lens file
    figures: list[tuple[str, str]]  #: (name, value) of first-order and photographic data
    columns: tuple[str, ...]  #: heads of the table: the prescription's, then those of the Seidel sums if there are any
    prescription_columns: int  #: number of the prescription's columns
    rows: list[tuple[str, ...]]  #: one for each surface, and the sums if there are Seidel sums; "sum" is their kind
    note: str  #: explanations below the table


def facts_of(source: Bundles, fields: Sequence[FieldPosition], colours: Doubles) -> ReportFacts:
    """Returns the texts for a lens. fields: angles, or film points of a lens without rotational symmetry. colours:
    (W,), wavelengths, nm. Raises InputError if no light passes."""
    lens = source.lens
    columns: tuple[str, ...] = lens_tables.PRESCRIPTION
    rows = list(lens_tables.prescription(lens))
    count = len(columns)
    note = "The last thickness is the distance to the film. A positive radius has its centre on the film's side."
    fields_deg = [field for field in fields if not isinstance(field, tuple)]
    points = [f"({field[0]:.3g}, {field[1]:.3g})" for field in fields if isinstance(field, tuple)]
    try:
        if not fields_deg:
            raise InputError("the lens is not rotationally symmetric")
        seidel = seidel_bars(
            lens,
            min(max(map(abs, fields_deg)), WIDEST_DEG),
            object_distance_m=source.object_distance_m,
            bundles=source,
        )
        columns = (*columns, *SYMBOLS)
        sums = seidel_table(seidel)
        rows = [row + by_surface for row, by_surface in zip(rows, sums, strict=False)]
        rows.append(("", "sum", *[""] * (count - 2), *sums[-1]))
        note += f" Seidel sums and chromatic sums are in µm, for a field of {seidel.field_deg:.3g}°."
    except InputError as error:
        note += f" There are no Seidel sums: {error}."
    figures = [
        *lens_tables.first_order(lens),
        ("fields", ", ".join(f"{angle:.3g}°" for angle in fields_deg) or f"{', '.join(points)} mm on the film"),
        ("wavelengths", ", ".join(f"{nm:.5g}" for nm in colours) + " nm"),
    ]
    return ReportFacts(
        printable(lens.title or lens.name or "lens"), printable(lens.source), figures, columns, count, rows, note
    )


def printable(text: str) -> str:
    """Removes unprintable characters from a text read from a file."""
    return "".join(c for c in text if c.isprintable())
