"""The command `realcam lens list`: lists bundled lenses and those of the lens path, with filters."""

from __future__ import annotations

import os
import warnings
from dataclasses import dataclass
from typing import Annotated

import typer

from .._core import Camera, InputError, Lens, RealcamError, lens_names, one_line
from ..json_values import json_text
from ..number_text import number_text
from ..photography.lens_kinds import KINDS, kind_of, year_of
from . import lens_options, options


@dataclass(frozen=True)
class ListedLens:
    """Row of the list.

    focal_lengths_mm: the shortest and the longest, which differ if the lens zooms. year: None if unknown. file: None
    for a bundled lens.
    """

    name: str
    title: str
    kind: str
    focal_lengths_mm: tuple[float, float]
    f_number: float
    year: int | None
    source: str
    file: str | None = None


def list_lenses(
    words: Annotated[
        list[str] | None,
        typer.Argument(metavar="TEXT", help="Words that the name, title or source of a lens must contain [all lenses]"),
    ] = None,
    focal_length: Annotated[
        str | None,
        typer.Option(
            "--focal-length",
            "--focal",
            metavar="MM",
            help="Focal length or range in mm, 50 or 35-70; a zoom lens must include it",
        ),
    ] = None,
    f_number: Annotated[str | None, typer.Option(metavar="N", help="Largest f-number, or a range: 1.4-2.8")] = None,
    kind: Annotated[str | None, typer.Option(metavar="NAME", help=f"Kind of lens: {', '.join(KINDS)}")] = None,
    lens_path: lens_options.LensPath = None,
    as_json: options.AsJson = False,
) -> None:
    """List the bundled lenses and those of the lens path, with kind, focal length in mm and f-number."""
    lens_options.add_to_lens_path(lens_path)
    focal = _range(focal_length, "--focal-length")
    if focal and focal[0] == focal[1]:
        focal = focal[0] / 1.05, focal[0] * 1.05  # nominal focal lengths are rounded
    fast = _range(f_number, "--f-number")
    if fast and fast[0] == fast[1]:
        fast = 0, fast[1]
    wanted_kinds = _kinds(kind)
    lenses = [
        lens
        for lens in _all_lenses()
        if all(word.lower() in f"{lens.name} {lens.title} {lens.source}".lower() for word in words or ())
        and (not focal or (lens.focal_lengths_mm[0] <= focal[1] and lens.focal_lengths_mm[1] >= focal[0]))
        and (not fast or fast[0] <= float(f"{lens.f_number:.2g}") <= fast[1])
        and lens.kind in wanted_kinds
    ]
    if as_json:
        typer.echo(json_text(lenses))
    elif not lenses:
        raise InputError("no lens matches; realcam lens list shows all")
    else:
        _print(lenses)


def _all_lenses() -> list[ListedLens]:
    listed = [_listed(name) for name in lens_names()]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for name, file in lens_options.lens_files_on_path().items():
            try:
                listed.append(_listed(name, os.fsencode(file).decode(errors="replace")))
            except RealcamError as error:
                message = one_line(os.fsencode(f"{file} is left out: {error}").decode(errors="replace"))
                typer.echo(f"realcam: warning: {message}", err=True)
    return listed


def _listed(name: str, file: str | None = None) -> ListedLens:
    lens = Lens.load(name)
    focal_lengths_mm = lens.zoom_focal_lengths_mm or [lens.first_order().effective_focal_length_mm]
    return ListedLens(
        os.fsencode(name).decode(errors="replace"),
        lens.title,
        kind_of(lens, Camera(lens).field_of_view_deg.diagonal),
        (min(focal_lengths_mm), max(focal_lengths_mm)),
        lens.f_number,
        year_of(lens.source),
        lens.source,
        file,
    )


def _range(text: str | None, option: str) -> tuple[float, float] | None:
    """Converts a number, or two with a minus between them. Raises InputError."""
    if text is None:
        return None
    first, _, last = text.partition("-")
    shortest = options.number(first, option, "a number or two with a minus between, 35-70")
    longest = options.number(last, option) if last else shortest
    if not 0 < shortest <= longest:
        raise InputError(f'{option}: "{text:.40}": expected positive numbers, the smaller one first')
    return shortest, longest


def _kinds(word: str | None) -> list[str]:
    """Returns the kinds whose names contain the word ("wide" selects "wide angle" and "very wide angle"); None: all.

    Raises InputError if there are none.
    """
    known = [kind for kind in KINDS if word is None or word.replace("-", " ").lower() in kind]
    return known or [options.known_word(word or "", KINDS, "kind")]


def _print(lenses: list[ListedLens]) -> None:
    rows = [
        (
            lens.name,
            lens.kind,
            "-".join(dict.fromkeys(number_text(focal, 3) for focal in lens.focal_lengths_mm)) + " mm",
            f"f/{number_text(lens.f_number, 2)}",
            lens.title or lens.file or "",
        )
        for lens in lenses
    ]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for name, kind, focal, f_number, title in rows:
        line = f"{name:{widths[0]}}  {kind:{widths[1]}}  {focal:>{widths[2]}}  {f_number:{widths[3]}}  {title}"
        typer.echo("".join(c if c.isprintable() else "\N{REPLACEMENT CHARACTER}" for c in line.rstrip()))
