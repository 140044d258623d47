"""The shot or scene file with which a bench was opened."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import tomlkit

from .._core import _shot_keys as shot_keys
from ..ocio import BUILT_IN
from ..shot import Shot, is_shot_file, shot_with_words, text_of_shot_of

CALIBRATION_FILES = ("calibration", "vignetting")  # keys of shot files
CALIBRATION_KEYS = (*CALIBRATION_FILES, "calibration_camera")
_REPLACED = {"environment": ("environment_cd_m2", "environment_layer"), "ocio": ("tone", "display", "view")}


@dataclass(frozen=True)
class ShotSource:
    """Source of a bench. name: of the file. text: content of a shot file. folder: base of its relative paths."""

    name: str
    text: str
    folder: Path

    @classmethod
    def opened(cls, path: Path, device: str, words: Mapping[str, str] | None = None) -> tuple[ShotSource, Shot]:
        """Opens a shot or scene file. words: options, as for shot_with_words; saved shots include them. Raises
        the errors of Shot.load."""
        shot = shot_with_words(path, words or {}, device)
        text = path.read_text(encoding="utf-8") if is_shot_file(path) else text_of_shot_of(path.name)
        return cls(path.name, _with_options(text, words or {}), path.absolute().parent), shot


def _with_options(text: str, words: Mapping[str, str]) -> str:
    """Returns the text of a shot file with options that controls of the bench do not describe. Their paths become
    absolute."""
    of_camera = {key.name for key in shot_keys() if key.group == "Camera"}
    changes = {key: word for key, word in words.items() if key in CALIBRATION_KEYS or key not in of_camera}
    if not changes:
        return text
    shot: Any = tomlkit.parse(text)
    for key in changes:
        for other in (key, *_REPLACED.get(key, ())):
            shot.pop(other, None)
    shot.update({key: _value_of(key, word) for key, word in changes.items()})
    return tomlkit.dumps(shot)


def _value_of(key: str, word: str) -> str | float:
    """Returns the value of an option for a shot file, where texts of options are values, too."""
    if key == "environment":
        with suppress(ValueError):
            return float(word)
    is_file = key in ("environment", "ocio", *CALIBRATION_FILES) and not word.startswith(BUILT_IN)
    return str(Path(word).absolute()) if is_file else word
