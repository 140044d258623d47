"""Writes docs/generated/effects.md from the table of effects: python tools/write_effects.py"""

from __future__ import annotations

from pathlib import Path

import realcam as rc

PAGE = Path(__file__).parents[1] / "docs" / "generated" / "effects.md"
TOP = """\
# Effects

*Made by `python tools/write_effects.py` from `cpp/camera/effects/effects.hpp`.*

Effects that pictures can have in addition to what is always simulated. `effects={"dispersion", "ghosts=1e-8",
"-motion_blur"}`, `--effects` and `effects` in shot files name them; [plan.md](../plan.md) says how `"auto"` decides.

| effect | what it is | what it needs | time, CPU and GPU |
|---|---|---|---|
"""
BOTTOM = """
Times are those of the frame benchmark's picture through the double Gauss, over those without effects
(`benchmarks/effects.py`).
"""


def row_of(effect: rc.EffectInfo) -> str:
    """Row of the table."""
    description = f"{effect.what}; {effect.usage}" if effect.usage else effect.what
    times = [f"{time:.2f}" if time else "–" for time in (effect.cpu_time, effect.gpu_time)]
    name = f"{effect.name}.md"
    has_page = (PAGE.parents[1] / name).exists()
    name = f"[`{effect.name}`](../{name})" if has_page else f"`{effect.name}`"
    return f"| {name} | {description} | {effect.needs} | {', '.join(times)} |\n"


def page() -> str:
    """The page as Markdown."""
    return TOP + "".join(map(row_of, rc.effects())) + BOTTOM


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
