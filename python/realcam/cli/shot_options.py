"""The command line options that describe a shot, from the table of shot keys (cpp/shot/shot_keys.cpp)."""

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
    """Returns a dataclass of options for grouped(), with one field for each shot key.

    name: name of the dataclass. without: keys that the command sets itself. panels: headings of the help to whose
    options the group is restricted; None: all.
    """
    group = []
    for key, option, panel, placeholder, text in _core._shot_keys():
        if option is None or key in without or (panels is not None and panel not in panels):
            continue
        declared = typer.Option(
            option,
            metavar=placeholder,
            help=text,
            rich_help_panel=panel,
            autocompletion=completion_of(placeholder),
        )
        group.append((key, Annotated[str | None, declared], None))
    return make_dataclass(name, group, frozen=True)


def load_shot(path: Path, options: Any, device: str) -> Shot:
    """Loads a shot file; values of the options override those of the file."""
    return shot_with_words(path, words_of(options), device)


def words_of(options: Any) -> dict[str, str]:
    """Returns the values of the options that the user specified, by shot key."""
    return {key: value for key, value in asdict(options).items() if value is not None}
