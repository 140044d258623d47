"""Messages about mistakes in a command line, in the format of the commands in C++."""

from __future__ import annotations

import re
from typing import Any

import typer

from .._core import InputError, _did_you_mean
from .command_words import Grammar, in_known_spelling, normalised

# click's UsageError: newer versions of typer bundle click under a private name.
UsageError: Any = typer.BadParameter.__bases__[0]


def check_usage(command: Any) -> None:
    """Replaces the parser of a click command by one that normalises the words and checks them more strictly.

    It raises UsageError if an option that may be used once is specified twice (click would silently use the last
    value), and its errors have the command as `ctx` and the wrong word as `word`.
    """
    parse = command.parse_args

    def parse_strictly(context: Any, words: list[str]) -> Any:
        values: dict[str, Any] = {}
        if subcommands := getattr(command, "commands", None):
            words = [in_known_spelling(word, subcommands) for word in words[:1]] + words[1:]
        elif not context.resilient_parsing:
            words = normalised(words, _grammar_of(command, context))
        try:
            values, _, order = command.make_parser(context).parse_args(args=list(words))
            for parameter in order:
                if order.count(parameter) > 1 and not parameter.multiple and not getattr(parameter, "is_flag", True):
                    raise UsageError(f"{max(parameter.opts, key=len)} is specified more than once")
            return parse(context, words)
        except UsageError as error:
            error.ctx = error.ctx or context
            if parameter := getattr(error, "param", None):
                error.word = values.get(parameter.name)
            raise

    command.parse_args = parse_strictly


def _grammar_of(command: Any, context: Any) -> Grammar:
    options: dict[str, str] = {}
    arguments = []
    for parameter in command.get_params(context):
        if parameter.param_type_name == "argument":
            arguments.append(parameter)
        else:
            value = "" if parameter.is_flag or parameter.count else parameter.metavar
            options |= dict.fromkeys((*parameter.opts, *parameter.secondary_opts), value)
    return Grammar(
        context.command_path,
        options,
        [argument.metavar for argument in arguments],
        bool(arguments) and arguments[-1].nargs == -1,
    )


def usage_message(error: Any) -> str:
    """Returns the message of click's UsageError: the mistake, what was meant, and where the options are listed."""
    if isinstance(error.__cause__, InputError):  # from options.parsed
        return str(error.__cause__)
    context = error.ctx
    commands = getattr(context.command, "commands", None) if context else None
    where = f"{context.command_path if context else 'realcam'} --help lists the {'commands' if commands else 'options'}"
    return f"{_what_is_wrong(error, commands)} ({where})"


def _what_is_wrong(error: Any, commands: dict[str, Any] | None) -> str:
    """Describes the mistake. commands: subcommands of the command, by name; None if it has none."""
    said: str = error.message.rstrip(".")  # click's message
    if option := getattr(error, "option_name", None):
        if said.startswith("No such option"):
            return f"unknown option {option}{_did_you_mean(_plain(option), _options_of(error.ctx))}"
        return f"{option} {'requires a value' if 'requires' in said else 'takes no value'}"
    if parameter := getattr(error, "param", None):
        name = max(parameter.opts, key=len) if parameter.param_type_name == "option" else parameter.metavar
        if not said:  # click gives no message for a missing parameter
            return f"{name} is required"
        # The wording depends on the version of typer.
        if "number" in said or "float" in said or "integer" in said:
            return f'{name}: "{error.word}" is not a {"whole " * ("integer" in said)}number'
        return f"{name}: {said}"
    if commands and (unknown := re.match(r"No such command '(.*?)'", said)):
        return f'unknown command "{unknown[1]}"{_did_you_mean(_plain(unknown[1]), list(commands))}'
    if commands:
        return f"a command is missing; {', '.join(commands)} are known"
    if extra := re.match(r"Got unexpected extra argument\S* \((\S*).*\)", said):
        return f'unexpected argument "{extra[1]}"'
    return said


def _options_of(context: Any) -> list[str]:
    """Returns the long names of a command's options. A mistyped one-letter option could mean any of them."""
    parameters = context.command.get_params(context) if context else []
    names = (name for parameter in parameters for name in (*parameter.opts, *parameter.secondary_opts))
    return [name for name in names if name.startswith("--")]


def _plain(word: str) -> str:
    """Replaces bytes that are not valid UTF-8 by "?"."""
    return word.encode(errors="replace").decode()
