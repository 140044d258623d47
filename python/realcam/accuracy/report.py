"""The ladder as a table."""

from __future__ import annotations

import math

from rich.box import MARKDOWN
from rich.console import Console
from rich.table import Table

from .ladder import AccuracyCost, Rung


def goals_of(cost: AccuracyCost) -> list[float]:
    """Errors that the ladder says the time to, codes: of the best level at the most samples, and twice and four times
    that."""
    if not cost.rungs:
        return []
    best = min(rung.pictures[-1].rmse for rung in cost.rungs)
    return [4 * best, 2 * best, best]


def rows_of(cost: AccuracyCost) -> tuple[list[str], list[list[str]]]:
    """Heads and cells."""
    goals = goals_of(cost)
    heads = ["level", "M samples/s", "lens", "scene", "rest", "bias", "noise", "FLIP"]
    heads += [f"s to {goal:.2g} codes" for goal in goals]
    return heads, [_cells(rung, goals) for rung in cost.rungs]


def _cells(rung: Rung, goals: list[float]) -> list[str]:
    last = rung.pictures[-1]
    shares = [f"{100 * share:.0f}%" for share in (rung.lens_share, rung.scene_share, rung.other_share)]
    seconds = [rung.seconds_to(goal) for goal in goals]
    return [
        rung.name,
        f"{1e-6 * rung.samples_per_second:.3g}",
        *shares,
        f"{rung.bias_codes:.2g}",
        f"{rung.noise_codes:.2g}",
        "" if last.flip is None else f"{last.flip:.4f}",
        *("never" if math.isinf(value) else f"{value:.2g}" for value in seconds),
    ]


def table_of(cost: AccuracyCost) -> str:
    """As Markdown, with what was compared above, and what is missing below."""
    heads, rows = rows_of(cost)
    table = Table(box=MARKDOWN, header_style="")
    for number, head in enumerate(heads):
        table.add_column(head, justify="left" if number == 0 else "right", no_wrap=True)
    for row in rows:
        table.add_row(*row)
    console = Console(width=400, no_color=True, record=True, file=None, quiet=False)
    with console.capture() as captured:
        console.print(table)
    lines = [
        f"{cost.size[0]} x {cost.size[1]} pixels on {cost.device}. Bias, noise (with the most samples) and errors in "
        f"8-bit codes against: {cost.reference}, whose own noise is {cost.reference_noise_codes:.2g} codes.",
        *(line.rstrip() for line in captured.get().splitlines() if line.strip()),
    ]
    if cost.impossible:
        lines.append(f"Cannot show what this lens sees: {', '.join(cost.impossible)}.")
    if cost.missing:
        lines.append(f"Interrupted; not measured: {', '.join(cost.missing)}.")
    return "\n".join(lines) + "\n"
