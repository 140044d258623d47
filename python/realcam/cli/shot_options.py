"""The command line options that describe a shot, from the table of shot keys (cpp/shot/shot_keys.cpp)."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import asdict, make_dataclass
from pathlib import Path
from typing import Annotated, Any

import typer

from .. import _core
from ..shot import Shot, shot_with_words
from . import options
from .completions import completion_of


def shot_options(
    without: Collection[str] = (), panels: Collection[str] | None = None, also: Collection[str] = ()
) -> type:
    """Returns a dataclass of options for grouped(), with one field for each shot key.

    without: keys that the command sets itself. panels: headings of the help to whose options the group is restricted;
    None: all. also: keys under other headings.
    """
    group = []
    for key in _core._shot_keys():
        if key.option is None or key.name in without:
            continue
        if panels is None or key.group in panels or key.name in also:
            declared = _option(key, help=key.help, rich_help_panel=key.group)
            group.append((key.name, Annotated[str | None, declared], None))
    return make_dataclass("ShotOptions", group, frozen=True)


def ring_option(name: str) -> Any:
    """Returns the option of a shot key for a command about lenses, where the default is the lens's own setting."""
    key = next(key for key in _core._shot_keys() if key.name == name)
    if name == "focus_m":
        return options.parsed(options.number, str(key.option), key.placeholder, key.text, "a number of metres or inf")
    return _option(key, help=key.text)


def _option(key: _core._ShotKey, **settings: Any) -> Any:
    completion = completion_of(key.placeholder)
    return typer.Option(key.option, metavar=key.placeholder, autocompletion=completion, **settings)


def load_shot(path: Path, values: Any, device: str) -> Shot:
    """Loads a shot file. values: the command's ShotOptions, which override those of the file."""
    return shot_with_words(path, words_of(values), device)


def words_of(values: Any) -> dict[str, str]:
    """Returns the values of the options that the user specified, by shot key."""
    return {key: value for key, value in asdict(values).items() if value is not None}
