"""Pages that programs write."""

from __future__ import annotations

from pathlib import Path


def write_text(page: Path, text: str) -> None:
    """Leaves a page that says the same alone, so that Sphinx does not read it again."""
    page.parent.mkdir(parents=True, exist_ok=True)
    if not page.is_file() or page.read_text(encoding="utf-8") != text:
        page.write_text(text, encoding="utf-8")
