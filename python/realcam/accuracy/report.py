"""Tables of the measurements at all levels."""

from __future__ import annotations

import math

from ..number_text import number_text, percent_text
from .measurements import Measurements, Rung


def goals_of(rungs: tuple[Rung, ...]) -> list[float]:
    """Returns the target errors of the table's time columns, in 8-bit codes.

    They are 4, 2 and 1 times the smallest error that a level has with its most samples.
    """
    if not rungs:
        return []
    best = min(rung.pictures[-1].rmse for rung in rungs)
    return [4 * best, 2 * best, best]


def tables_of(cost: Measurements) -> list[tuple[str, list[str], list[list[str]]]]:
    """Returns the title, the column heads and the rows of cells of each table."""
    return [
        (title, *_rows_of(rungs))
        for title, rungs in (("level", cost.rungs), ("every surface, sampled over", cost.samplings))
        if rungs
    ]


def _rows_of(rungs: tuple[Rung, ...]) -> tuple[list[str], list[list[str]]]:
    goals = goals_of(rungs)
    heads = ["M samples/s", "lens", "scene", "rest", "bias", "noise", "FLIP"]
    heads += [f"s to {number_text(goal, 2)} codes" for goal in goals]
    return heads, [_cells(rung, goals) for rung in rungs]


def _cells(rung: Rung, goals: list[float]) -> list[str]:
    last = rung.pictures[-1]
    shares = [percent_text(share) for share in (rung.lens_share, rung.scene_share, rung.other_share)]
    seconds = [rung.seconds_to(goal) for goal in goals]
    return [
        rung.name,
        number_text(1e-6 * rung.samples_per_second, 3),
        *shares,
        number_text(rung.bias_codes, 2),
        number_text(rung.noise_codes, 2),
        "" if last.flip is None else f"{last.flip:.4f}",
        *("never" if math.isinf(value) else number_text(value, 2) for value in seconds),
    ]


def text_of(cost: Measurements) -> str:
    """Returns Markdown tables, preceded by a description of the comparison and followed by the missing levels."""
    noise = number_text(cost.reference_noise_codes, 2)
    lines = [
        f"{cost.size[0]} x {cost.size[1]} pixels on {cost.device}. Bias, noise (with the most samples) and errors in "
        f"8-bit codes against: {cost.reference}, whose own noise is {noise} codes; ways of "
        "sampling against the same without effects.",
    ]
    for title, heads, rows in tables_of(cost):
        lines += ["", *_markdown([title, *heads], rows)]
    if cost.impossible:
        lines += ["", f"Not possible with this lens on this device: {', '.join(cost.impossible)}."]
    if cost.missing:
        lines += ["", f"Interrupted; not measured: {', '.join(cost.missing)}."]
    return "\n".join(lines) + "\n"


def _markdown(heads: list[str], rows: list[list[str]]) -> list[str]:
    # Imported here because rich takes a tenth of realcam's import time.
    from rich.box import MARKDOWN
    from rich.console import Console
    from rich.table import Table

    table = Table(box=MARKDOWN, header_style="")
    for number, head in enumerate(heads):
        table.add_column(head, justify="left" if number == 0 else "right", no_wrap=True)
    for row in rows:
        table.add_row(*row)
    console = Console(width=400, no_color=True)
    with console.capture() as captured:
        console.print(table)
    return [line.rstrip() for line in captured.get().splitlines() if line.strip()]
