"""The options that say what is photographed and how, which all commands that take a shot share (cpp/shot/shot_keys)."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import asdict, make_dataclass
from pathlib import Path
from typing import Annotated, Any

import typer

from .. import _core
from ..shot import Shot, shot_with_words
from .completions import completion_of


def shot_options(name: str, without: Collection[str] = (), panels: Collection[str] | None = None) -> type:
    """A group of options (grouped_options), but for those of some keys, which a command decides itself.

    panels: only those with these headings in help texts.
    """
    group = []
    for key, option, panel, placeholder, text in _core._shot_keys():
        if option is None or key in without or (panels is not None and panel not in panels):
            continue
        wanted = typer.Option(
            option,
            metavar=placeholder,
            help=text,
            rich_help_panel=panel,
            autocompletion=completion_of(placeholder),
        )
        group.append((key, Annotated[str | None, wanted], None))
    return make_dataclass(name, group, frozen=True)


def load_shot(path: Path, options: Any, device: str) -> Shot:
    """Loads a shot with the values of the options in place of its own."""
    return shot_with_words(path, words_of(options), device)


def words_of(options: Any) -> dict[str, str]:
    """Returns the options that were given, by their keys."""
    return {key: word for key, word in asdict(options).items() if word is not None}
