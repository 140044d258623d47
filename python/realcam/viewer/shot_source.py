"""The shot or scene file with which a bench was opened."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from ..shot import Shot, is_shot_file, shot_with_words, text_of_shot_of


@dataclass(frozen=True)
class ShotSource:
    """Source of a bench. name: of the file. text: content of a shot file. folder: base of its relative paths."""

    name: str
    text: str
    folder: Path

    @classmethod
    def opened(cls, path: Path, device: str, words: Mapping[str, str] | None = None) -> tuple[ShotSource, Shot]:
        """Opens a shot or scene file. words: camera options, as for shot_with_words; saved shots include them. Raises
        the errors of Shot.load."""
        shot = shot_with_words(path, words or {}, device)
        text = path.read_text(encoding="utf-8") if is_shot_file(path) else text_of_shot_of(path.name)
        return cls(path.name, text, path.absolute().parent), shot
