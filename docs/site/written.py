"""Pages that programs write."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from pathlib import Path


def write_text(page: Path, text: str) -> None:
    """Leaves a page that says the same alone, so that Sphinx does not read it again."""
    page.parent.mkdir(parents=True, exist_ok=True)
    if not page.is_file() or page.read_text(encoding="utf-8") != text:
        page.write_text(text, encoding="utf-8")


def is_newer(made: Path, sources: Iterable[Path]) -> bool:
    return made.is_file() and made.stat().st_mtime > max(source.stat().st_mtime for source in sources)


def remove_others(folder: Path, names: Collection[str]) -> None:
    """Removes the pages of what is no longer there."""
    for page in folder.glob("*.md"):
        if page.stem not in names:
            page.unlink()
