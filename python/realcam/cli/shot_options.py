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


def shot_options(
    name: str, without: Collection[str] = (), panels: Collection[str] | None = None, also: Collection[str] = ()
) -> type:
    """Returns a dataclass of options for grouped(), with one field for each shot key.

    name: name of the dataclass. without: keys that the command sets itself. panels: headings of the help to whose
    options the group is restricted; None: all. also: keys under other headings.
    """
    group = []
    for key in _core._shot_keys():
        if key.option is None or key.name in without:
            continue
        if panels is None or key.group in panels or key.name in also:
            declared = _option(key, help=key.help, rich_help_panel=key.group)
            group.append((key.name, Annotated[str | None, declared], None))
    return make_dataclass(name, group, frozen=True)


def ring_option(name: str) -> Any:
    """Returns the option of a shot key for a command about lenses, where the default is the lens's own setting."""
    return _option(next(key for key in _core._shot_keys() if key.name == name))


def _option(key: _core._ShotKey, *, help: str | None = None, rich_help_panel: str | None = None) -> Any:
    return typer.Option(
        key.option,
        metavar=key.placeholder,
        help=help or key.text,
        rich_help_panel=rich_help_panel,
        autocompletion=completion_of(key.placeholder),
    )


def load_shot(path: Path, options: Any, device: str) -> Shot:
    """Loads a shot file; values of the options override those of the file."""
    return shot_with_words(path, words_of(options), device)


def words_of(options: Any) -> dict[str, str]:
    """Returns the values of the options that the user specified, by shot key."""
    return {key: value for key, value in asdict(options).items() if value is not None}
