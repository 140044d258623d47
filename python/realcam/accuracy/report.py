"""Tables of the measurements at all levels."""

from __future__ import annotations

import math

from ..number_text import number_text, percent_text
from .measurements import LevelMeasurements, Measurements


def goals_of(levels: tuple[LevelMeasurements, ...]) -> list[float]:
    """Returns the target errors of the table's time columns, in 8-bit codes.

    They are 4, 2 and 1 times the smallest error that a level has with its most samples.
    """
    if not levels:
        return []
    best = min(level.pictures[-1].rmse for level in levels)
    return [4 * best, 2 * best, best]


def tables_of(cost: Measurements) -> list[tuple[str, list[str], list[list[str]]]]:
    """Returns the title, the column heads and the rows of cells of each table."""
    return [
        (title, *_rows_of(levels))
        for title, levels in (("level", cost.levels), ("every surface, sampled over", cost.samplings))
        if levels
    ]


def _rows_of(levels: tuple[LevelMeasurements, ...]) -> tuple[list[str], list[list[str]]]:
    goals = goals_of(levels)
    heads = ["M samples/s", "lens", "scene", "rest", "bias", "noise", "FLIP"]
    heads += [f"s to {number_text(goal, 2)} codes" for goal in goals]
    return heads, [_cells(level, goals) for level in levels]


def _cells(level: LevelMeasurements, goals: list[float]) -> list[str]:
    last = level.pictures[-1]
    shares = [percent_text(share) for share in (level.lens_share, level.scene_share, level.other_share)]
    seconds = [level.seconds_to(goal) for goal in goals]
    return [
        level.name,
        number_text(1e-6 * level.samples_per_second, 3),
        *shares,
        number_text(level.bias_codes, 2),
        number_text(level.noise_codes, 2),
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
