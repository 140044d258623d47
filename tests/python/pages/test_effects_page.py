"""docs/generated/effects.md says what the table of effects says."""

from __future__ import annotations

import importlib.util
from pathlib import Path

TOOL = Path(__file__).parents[3] / "tools" / "write_effects.py"


def test_the_page_is_made_of_the_table() -> None:
    spec = importlib.util.spec_from_file_location("write_effects", TOOL)
    assert spec and spec.loader
    tool = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(tool)
    assert tool.PAGE.read_text(encoding="utf-8") == tool.page(), "python tools/write_effects.py writes it anew"
