"""Writes the table of settings in docs/shot-files.md from the table of shot keys: python tools/write_settings.py"""

from __future__ import annotations

import re
from pathlib import Path

from realcam import _core

PAGE = Path(__file__).parents[1] / "docs" / "shot-files.md"
BEGIN = "<!-- Made by `python tools/write_settings.py` from cpp/shot/shot_keys.cpp and picture_keys.cpp. -->\n"
END = "<!-- End of the table. -->\n"
TOP = """\
| key | option | meaning | left out |
|---|---|---|---|
| `format` | | 1, the version of the file format | an error |
| `scene` | | .obj (with .mtl), .gltf, .glb, .ply, or a stage of [USD](usd.md) | an error |
"""


def row_of(key: _core._ShotKey) -> str:
    """Row of the table."""
    meaning = f"{key.text}. {key.details}" if key.details else key.text
    option = f"`{key.option} {key.placeholder}`" if key.option else ""
    cells = [_with_links(cell.replace("|", r"\|")) for cell in (f"`{key.name}`", option, meaning, key.initial)]
    return "| " + " | ".join(cells) + " |\n"


def _with_links(text: str) -> str:
    return re.sub(r"docs/(([\w-]+)\.md)", r"[\2](\1)", text)


def page(text: str) -> str:
    """The page's text, with the current table."""
    before, _, rest = text.partition(BEGIN)
    _, _, after = rest.partition(END)
    return before + BEGIN + TOP + "".join(map(row_of, _core._shot_keys())) + END + after


if __name__ == "__main__":
    PAGE.write_text(page(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
