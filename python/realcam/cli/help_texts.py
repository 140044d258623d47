"""`--help` of the commands in Python, in the format of the commands in C++."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

import typer

from .._core import _help_text
from ..number_text import number_text
from .examples import EXAMPLES
from .usage_message import check_usage

Section = tuple[str, list[tuple[str, str]]]


def finish(command: Any, words: tuple[str, ...] = ()) -> None:
    """Sets the help and the error handling of a command made by typer, and of its subcommands.

    words: the command as typed, without the program's name.
    """
    for parameter in command.params:
        # A parameter without a metavar gets its own name, where typer would show its type.
        if parameter.metavar is None and not getattr(parameter, "is_flag", False):
            parameter.metavar = str(parameter.name).upper()
        # Omits the type after an argument's name, as the metavar is sufficient.
        if isinstance(parameter, typer.core.TyperArgument):
            parameter.display_type_rich = lambda ctx: None  # type: ignore[method-assign]
    check_usage(command)
    examples = list(EXAMPLES.get(" ".join(words), ()))
    command.get_help = lambda context: _help_text(
        # Some versions of typer put required arguments in braces: {SHOT}...
        re.sub("[{}]", "", " ".join([context.command_path, *command.collect_usage_pieces(context)])),
        command.help,
        list(_sections(command, context)),
        examples,
    ).rstrip("\n")
    for name, subcommand in getattr(command, "commands", {}).items():
        finish(subcommand, (*words, name))


def _sections(command: Any, context: Any) -> Iterator[Section]:
    """Yields the sections of a command's help: title, and rows of name and text."""
    parts: dict[str, list[tuple[str, str]]] = {"Arguments": [], "Options": []}
    for parameter in command.get_params(context):
        usual = "Arguments" if parameter.param_type_name == "argument" else "Options"
        if record := parameter.get_help_record(context):
            names, text = record
            title = getattr(parameter, "rich_help_panel", None) or usual
            parts.setdefault(title, []).append((names, _as_in_cpp(text)))
    yield from parts.items()
    # Shows only the first paragraph of each command's help.
    commands = getattr(command, "commands", {})
    yield "Commands", [(name, subcommand.help.partition("\n\n")[0]) for name, subcommand in commands.items()]


def _as_in_cpp(text: str) -> str:
    """Converts defaults and ranges in brackets from typer's format to that of the commands in C++."""
    text = re.sub(r"\s+\[default: ", " [", text.removesuffix("."))
    if not (brackets := re.search(r" \[[^]]*\]$", text)):
        return text
    end = re.sub(r"([-\d.]+)<=x<=([-\d.]+)", r"\1 to \2", brackets[0])
    end = re.sub(r"x>=([-\d.]+)", r"\1 or more", end)
    end = re.sub(r"(?<![\w.])\d+(\.\d+)?(?![\w.])", lambda number: number_text(float(number[0])), end)
    return text[: brackets.start()] + end
