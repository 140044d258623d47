"""Pages that programs write."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterable
from pathlib import Path

import matplotlib.image
import numpy as np


def write_text(page: Path, text: str) -> None:
    """Leaves a page that says the same alone, so that Sphinx does not read it again."""
    page.parent.mkdir(parents=True, exist_ok=True)
    if not page.is_file() or page.read_text(encoding="utf-8") != text:
        page.write_text(text, encoding="utf-8")


def is_newer(made: Path, sources: Iterable[Path]) -> bool:
    return made.is_file() and made.stat().st_mtime > max(source.stat().st_mtime for source in sources)


def stand_in_for(pictures: Iterable[Path]) -> None:
    """Empty pictures where there are none, dated older than all sources, so that a later build makes the real ones."""
    for picture in pictures:
        if picture.is_file():
            continue
        if picture.suffix == ".svg":
            picture.write_text('<svg xmlns="http://www.w3.org/2000/svg" width="600" height="200"/>', encoding="utf-8")
        else:
            matplotlib.image.imsave(picture, np.full((280, 420, 3), 0.8))
        os.utime(picture, (0, 0))


def remove_others(folder: Path, names: Collection[str]) -> None:
    """Removes the pages of what is no longer there."""
    for page in folder.glob("*.md"):
        if page.stem not in names:
            page.unlink()
