"""What a bench was opened with: a shot file, or a scene file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from ..shot import Shot, is_shot_file, shot_with_words, text_of_shot_of


@dataclass(frozen=True)
class ShotSource:
    """text: of a shot file. folder: what paths in it are relative to."""

    name: str
    text: str
    folder: Path

    @classmethod
    def opened(cls, path: Path, device: str, words: Mapping[str, str] | None = None) -> tuple[ShotSource, Shot]:
        """words: of the camera, as for shot_with_words; a shot that is saved has them. Raises what Shot.load raises."""
        shot = shot_with_words(path, words or {}, device)
        text = path.read_text(encoding="utf-8") if is_shot_file(path) else text_of_shot_of(path.name)
        return cls(path.name, text, path.absolute().parent), shot
