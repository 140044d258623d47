#!/usr/bin/env python3
"""Write docs/generated/numerics.md and its plot from the measurements of the tests.

    ./run numerics
    python tools/write_numerics.py MEASUREMENTS... [--page docs/generated/numerics.md] [--lens NAME ...]

The tests append their measurements, a line of JSON each, to the file named by the environment variable
REALCAM_MEASUREMENTS. Files of several machines make one page, because no machine has all backends and instruction sets;
if several have measured a case, the measurement closest to its limit counts. It is an error if a measurement exceeds
its limit, or if that of an intentionally broken routine does not. The plot is measured again, with the rays of
tests/truth/test_float32_error.py.
"""

from __future__ import annotations

import argparse
import html
import re
from collections.abc import Callable
from pathlib import Path

import measurements
import numerics_plot
from measurements import Figure, Run
from tabulate import tabulate

from tests.centred_lenses import CENTRED

PAGE = Path(__file__).parents[1] / "docs" / "generated" / "numerics.md"
PLOT = Path("images") / "float32-error.png"
SEPARATOR = " · "
LIMIT = "\N{NO-BREAK SPACE}≤\N{NO-BREAK SPACE}"

INTRODUCTION = """\
# How exact the figures are

This page is written by the command `./run numerics`, from what the tests measure, and never by hand.

Each line is a hard case. It gives the largest error that was found, the limit that the test asserts, and what was
tried. An error is the distance from a figure found in another way. That is a closed form, the same rays in 50 digits,
another program, a printed listing, or float64 for a figure in float32.

`0.53 ≤ 4` is the largest error and its limit. Where the head of a column names several backends, their errors follow in
that order. A single error is that of all of them. An *ulp* is the distance from 1 to the next number: 2⁻²³ = 1.2e-7 in
float32, 2⁻⁵² = 2.2e-16 in float64. An *ulp of scale* is that times the largest length in the case. It is what one
rounding may cost.
"""

PLOT_TEXT = """\
![Error of float32 image points over field and aperture]({plot})

{count:,} rays go from the film to the scene in float32, and back in float64. The distance by which they miss the film
point where they started is the error of the point in a picture. The limit is 1/50 of a pixel of 4 µm. Colours show the
worst ray at each film radius and height in the stop. White areas receive no light.
"""

BROKEN = """\
## Broken on purpose

A test that cannot fail proves nothing. These routines are wrong by intent, and exceed the limit that the tests assert
for the real ones.
"""


def escaped(text: str) -> str:
    """Text for a Markdown table."""
    return html.escape(text, quote=False).replace("|", "\\|").replace("*", "\\*")


def table(head: list[str], rows: list[list[str]]) -> str:
    return tabulate(rows, head, tablefmt="github", disable_numparse=True) + "\n"


def tried(figures: list[Figure]) -> str:
    """Descriptions of the measurements on all backends, without those that differ only in numbers."""
    texts = {}
    for figure in figures:
        text = figure.measurement.tried + (f", the worst of {figure.runs}" if figure.runs > 1 else "")
        texts.setdefault(re.sub(r"[\d.,]+", "", text), text)
    return escaped("; ".join(texts.values()))


def column(number_type: str, backends: tuple[str, ...]) -> str:
    """Head of a column: `float32`, `float32, CUDA` or `float32, CUDA · Embree v2 · v3`."""
    if backends == ("core",):
        return number_type
    names = list(backends)
    for i in range(1, len(names)):
        family = backends[i].split(" ")[0] + " "
        if backends[i - 1].startswith(family):
            names[i] = backends[i].removeprefix(family)
    return f"{number_type}, {SEPARATOR.join(names)}"


def short(number: float, digits: int = 6) -> str:
    """Number with this many significant digits, for the page."""
    text = f"{number:.{digits}g}".replace("nan", "NaN").replace("e-0", "e-").replace("e+0", "e").replace("e+", "e")
    return text.replace("-", "\N{MINUS SIGN}")  # a browser breaks the line after a hyphen


def merged(texts: list[str]) -> str:
    """The texts of all backends, or the only one if they are equal."""
    return SEPARATOR.join(texts[:1] if len(set(texts)) == 1 else texts)


def cell(figures: dict[str, Figure], backends: tuple[str, ...]) -> str:
    """Errors of one case in one number type, in the order of the backends, and their limit."""
    if not figures:
        return ""
    errors = [short(figures[b].measurement.worst, 2) if b in figures else "–" for b in backends]
    limits = [short(figures[b].measurement.limit) for b in backends if b in figures]
    return f"{merged(errors)}{LIMIT}{merged(limits)}"


def grouped_by(figures: list[Figure], key: Callable[[Figure], object]) -> dict:
    groups: dict = {}
    for figure in figures:
        groups.setdefault(key(figure), []).append(figure)
    return groups


def case_tables(figures: list[Figure]) -> str:
    """Tables of the cases, one for each set of backends on which cases were measured."""
    cases = grouped_by(figures, lambda f: (f.measurement.what, f.measurement.unit))
    tables: dict[tuple[str, ...], list[tuple[str, str]]] = {}
    for case in sorted(cases):
        backends = tuple(sorted({f.measurement.backend for f in cases[case]}))
        tables.setdefault(backends, []).append(case)
    texts = []
    for backends, names in tables.items():
        types = sorted({f.measurement.number_type for name in names for f in cases[name]})
        rows = []
        for what, unit in names:
            of_type = grouped_by(cases[what, unit], lambda f: f.measurement.number_type)
            cells = [cell({f.measurement.backend: f for f in of_type.get(t, [])}, backends) for t in types]
            rows.append([escaped(what), *cells, escaped(unit), tried(cases[what, unit])])
        texts.append(table(["case", *(column(t, backends) for t in types), "unit", "tried"], rows))
    return "\n".join(texts)


def broken_table(figures: list[Figure]) -> str:
    """Table of the intentionally broken routines."""
    rows = []
    for figure in sorted(figures, key=lambda f: measurements.SECTIONS.index(f.measurement.section)):
        m = figure.measurement
        limits = [short(m.worst, 2), short(m.limit), escaped(m.unit)]
        rows.append([escaped(m.what), column(m.number_type, (m.backend,)), *limits, tried([figure]), m.section])
    return table(["broken routine", "number type", "error", "limit", "unit", "tried", "section"], rows)


def run_text(figures: list[Figure], runs: list[Run]) -> str:
    """Paragraph on the runs and the measurement closest to its limit."""
    nearest = max((f for f in figures if not f.broken), key=lambda f: f.share_of_limit)
    return (
        "The figures are of these runs:\n\n"
        + "".join(f"- commit {r.commit}, {r.date}, {r.processor}, {'; '.join(r.devices)}\n" for r in runs)
        + f"\nThere are {sum(f.runs for f in figures)} measurements. Nearest to its limit, at "
        f"{nearest.share_of_limit:.0%}, is *{escaped(nearest.measurement.what)}*.\n"
    )


def page(figures: list[Figure], runs: list[Run], plot_text: str) -> str:
    """The page as Markdown."""
    figures = measurements.grouped(figures)
    parts = [INTRODUCTION, run_text(figures, runs)]
    for section in measurements.SECTIONS:
        held = [f for f in figures if f.measurement.section == section and not f.broken]
        if held:
            parts += [f"## {section}\n", *([plot_text] if section == "Bundled lenses" else []), case_tables(held)]
    broken = [f for f in figures if f.broken]
    if broken:
        parts += [BROKEN, broken_table(broken)]
    return "\n".join(parts)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument(
        "measurements", type=Path, nargs="+", help="files that the tests have written, one for each machine"
    )
    parser.add_argument(
        "--page", type=Path, default=PAGE, help="page to write; its plot is written into the folder images beside it"
    )
    parser.add_argument("--lens", action="append", help="plot only this lens; may be repeated")
    options = parser.parse_args()
    try:
        read = [measurements.read(path) for path in options.measurements]
    except measurements.MeasurementError as error:
        raise SystemExit(f"write_numerics: {error}") from error
    figures = [figure for file_figures, _ in read for figure in file_figures]
    runs = list(dict.fromkeys(run for _, file_runs in read for run in file_runs))
    count = numerics_plot.save_error_plot(options.lens or CENTRED, options.page.parent / PLOT)
    options.page.write_text(page(figures, runs, PLOT_TEXT.format(plot=PLOT.as_posix(), count=count)), encoding="utf-8")


if __name__ == "__main__":
    main()
