"""Entries for the commands in C++, so that the help of Python's command line lists them and shells complete them."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from functools import cache
from typing import Annotated, Any

import typer

from .. import _core
from .._core import InputError
from .completions import completion_of


@cache
def _listed() -> dict[tuple[str, ...], tuple[str, list[tuple[list[str], str, str]]]]:
    """Returns (description, options) of each command in C++ by its words; an option is (names, placeholder, help).

    Empty if the extension is built without commands.
    """
    listed = getattr(_core, "_listed_commands", list)
    return {tuple(words): (description, options) for words, description, options in listed()}


def add_command_in_cpp(app: typer.Typer, *words: str) -> None:
    """Adds a command in C++ to the help and to the shell completion.

    The command itself is never called here, because realcam_command runs it in the extension before.
    """
    if words not in _listed():
        return
    description, options = _listed()[words]

    def command(**_: Any) -> None:
        raise InputError(f'"{" ".join(words)}": options come after the command')

    parameters = [_parameter(i, *option) for i, option in enumerate(options)]
    command.__signature__ = inspect.Signature(parameters)  # type: ignore[attr-defined]
    command.__annotations__ = {parameter.name: parameter.annotation for parameter in parameters}
    app.command(words[-1], help=description)(command)


def _parameter(number: int, names: list[str], metavar: str, help: str) -> inspect.Parameter:
    declare: Callable[..., Any] = typer.Option if names else typer.Argument
    settings = {"help": help, **({"metavar": metavar, "autocompletion": completion_of(metavar)} if metavar else {})}
    kind = str | None if metavar else bool
    return inspect.Parameter(
        f"option_{number}",
        inspect.Parameter.KEYWORD_ONLY,
        default=inspect.Parameter.empty if not names else None if metavar else False,
        annotation=Annotated[kind, declare(*names, **settings)],
    )
