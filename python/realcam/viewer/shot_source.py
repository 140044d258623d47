"""The shot or scene file with which a bench was opened."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import tomlkit

from ..shot import Shot, is_shot_file, shot_with_words, text_of_shot_of

CALIBRATION_FILES = ("calibration", "vignetting")  # keys of shot files
CALIBRATION_KEYS = (*CALIBRATION_FILES, "calibration_camera")


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
        return cls(path.name, _with_calibration(text, words or {}), path.absolute().parent), shot


def _with_calibration(text: str, words: Mapping[str, str]) -> str:
    """Returns the text of a shot file with the calibration of camera options; their paths become absolute."""
    changes = {key: words[key] for key in CALIBRATION_KEYS if key in words}
    if not changes:
        return text
    shot: Any = tomlkit.parse(text)
    changes |= {key: str(Path(changes[key]).absolute()) for key in CALIBRATION_FILES if key in changes}
    shot.update(changes)
    return tomlkit.dumps(shot)
