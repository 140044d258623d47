"""`--help` as realcam has it: examples at the end of each command, and no types of Python."""

from __future__ import annotations

from typing import Any

import typer

from .examples import EXAMPLES


def finish_help(command: Any, words: tuple[str, ...] = ()) -> None:
    """Finishes the help of a command as typer makes it, and of all below it. `words`: those that call it, without the
    program's name."""
    for parameter in command.params:
        # What an option or argument does not name is called as it is itself, and not by the name of a type.
        if parameter.metavar is None and not getattr(parameter, "is_flag", False):
            parameter.metavar = str(parameter.name).upper()
        # An argument's line would have its type behind its name, which says enough.
        if isinstance(parameter, typer.core.TyperArgument):
            parameter.display_type_rich = lambda ctx: None  # type: ignore[method-assign]
    if command.help:  # which click would cut off in a list of commands
        command.short_help = " ".join(command.help.split("\n\n")[0].split())
    examples = EXAMPLES.get(" ".join(words))
    if examples:
        # The mark keeps the lines from being made one paragraph.
        command.epilog = "\b\nExamples:\n" + "\n".join(f"  {example}" for example in examples)
    for name, below in getattr(command, "commands", {}).items():
        finish_help(below, (*words, name))
