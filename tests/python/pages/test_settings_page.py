"""docs/shot-files.md has the settings of the table of shot keys."""

from __future__ import annotations

import importlib.util
from pathlib import Path

TOOL = Path(__file__).parents[3] / "tools" / "write_settings.py"


def test_the_page_is_made_of_the_table() -> None:
    spec = importlib.util.spec_from_file_location("write_settings", TOOL)
    assert spec and spec.loader
    tool = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(tool)
    text = tool.PAGE.read_text(encoding="utf-8")
    assert text == tool.page(text), "python tools/write_settings.py writes the table again"
