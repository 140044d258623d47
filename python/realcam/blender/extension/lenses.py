"""The lenses of this extension: their data in lenses.json, and a shader for each."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from typing import Any

FOLDER = Path(__file__).resolve().parent / "lenses"

# Name and size of the films; None: that of the lens.
FILMS_MM = {
    "lens": ("The lens's own", None),
    "full_frame": ("Full frame, 36 x 24 mm", (36.0, 24.0)),
    "aps_c": ("APS-C, 23.5 x 15.7 mm", (23.5, 15.7)),
    "super_35": ("Super 35, 24.9 x 18.7 mm", (24.9, 18.7)),
    "four_thirds": ("Micro Four Thirds, 17.3 x 13 mm", (17.3, 13.0)),
    "one_inch": ("1 inch, 13.2 x 8.8 mm", (13.2, 8.8)),
    "six_by_six": ("6 x 6, 56 x 56 mm", (56.0, 56.0)),
}


@cache
def lenses() -> dict[str, dict[str, Any]]:
    """Lens data by key, in the order of lenses.json; extension_file.py writes them."""
    return json.loads((FOLDER / "lenses.json").read_text(encoding="utf-8"))


def shader_of(key: str) -> str:
    """Text of a lens's OSL shader."""
    return (FOLDER / f"{key}.osl").read_text(encoding="utf-8")


def film_mm(key: str, film: str) -> tuple[float, float]:
    """Width and height of a film, a key of FILMS_MM; "lens" is that of the lens file."""
    return FILMS_MM[film][1] or tuple(lenses()[key]["film_mm"])


def f_numbers(key: str) -> list[float]:
    """f-numbers of the ring's click stops: wide open, then third stops."""
    widest = lenses()[key]["f_number"]
    clicks = (2 ** (third / 6) for third in range(67))
    return [widest, *(round(click, 2 if click < 2 else 1) for click in clicks if click > 1.06 * widest and click < 46)]
