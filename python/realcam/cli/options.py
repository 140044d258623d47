"""Options and arguments that several commands share."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Annotated, Any

import typer

from .._core import InputError, Lens, LensFileError, _did_you_mean
from ..number_text import optics_text
from .command_words import in_known_spelling
from .completions import completion_of

SHOT_HELP = "A shot file (.toml), a scene file (.obj, .gltf, .glb, .ply or .usd), or the name of a bundled shot: demo"
ShotName = Annotated[Path, typer.Argument(help=SHOT_HELP, metavar="SCENE")]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="Print only warnings and errors")]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON")]
Device = Annotated[
    str,
    typer.Option(
        metavar="DEVICE",
        help="auto (a GPU if there is one), cpu, cuda, or cuda:1",
        autocompletion=completion_of("DEVICE"),
    ),
]
Threads = Annotated[int, typer.Option(metavar="N", help="Number of threads; 0: all", min=0, max=4096)]


def output(help: str, metavar: str = "FILE") -> Any:
    """Returns the option for what a command writes."""
    return typer.Option("--output", "-o", metavar=metavar, help=help)


def parsed(convert: Callable[..., Any], name: str, metavar: str | None, help: str, *arguments: Any) -> Any:
    """Returns an option whose text is converted by convert(text, name, *arguments), which may raise InputError."""

    def parser(text: str) -> Any:
        try:
            return convert(text, name, *arguments)
        except InputError as error:  # a ValueError, whose message typer would replace
            raise typer.BadParameter(str(error)) from error

    return typer.Option(name, parser=parser, metavar=metavar, help=help)


def say_written(target: Path, quiet: bool = False) -> None:
    """Prints that a file was written, unless quiet."""
    if not quiet:
        typer.echo(f"wrote {os.fsencode(target).decode(errors='replace')}")


def number(text: str, option: str, expected: str = "a number") -> float:
    """Converts a number, or inf. option, expected: for the message. Raises InputError."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if math.isnan(value):
        raise InputError(f'{option}: "{text}" is not {expected}')
    return value


def numbers(text: str, option: str) -> list[float]:
    """Converts numbers with commas between them. Raises InputError."""
    return [number(word.strip(), option) for word in text.split(",")]


def whole_numbers(text: str, option: str, separator: str, *counts: int) -> tuple[int, ...]:
    """Converts whole numbers with a separator between them. counts: permitted counts. Raises InputError."""
    words = text.split(separator)
    if len(words) not in counts or not all(word.strip().isdecimal() and len(word) < 9 for word in words):
        count = " or ".join(map(str, counts))
        raise InputError(f'{option}: "{text:.40}": expected {count} whole numbers with "{separator}" between')
    return tuple(map(int, words))


def size(text: str, option: str) -> tuple[int, ...]:
    """Converts a width and a height, 1920x1080. Raises InputError."""
    return whole_numbers(text, option, "x", 2)


def seconds(text: str, option: str) -> float:
    """Converts a time in seconds, 0.008 or 1/125. Raises InputError."""
    numerator, slash, denominator = text.partition("/")
    divisor = number(denominator, option) if slash else 1.0
    if divisor == 0:
        raise InputError(f'{option}: "{text}" divides by 0')
    return number(numerator, option) / divisor


def frame_numbers(text: str, option: str) -> range:
    """Converts the numbers of frames: 7, 1-240, or 1-240x10 for every tenth frame. Raises InputError."""
    found = re.fullmatch(r"(\d{1,6})(?:-(\d{1,6})(?:x(\d{1,6}))?)?", text)
    step = int(found[3] or 1) if found else 0
    numbers = range(int(found[1]), int(found[2] or found[1]) + 1, step) if found and step else None
    if not numbers:
        raise InputError(f'{option}: "{text:.40}": expected a number, 1-240 or 1-240x2, the smaller one first')
    return numbers


def known_word(word: str, known: Iterable[str], what: str) -> str:
    """Returns a word in the spelling of the list `known`; American spellings are accepted.

    what: kind of word, for the message. Raises InputError, with similar words, if the word is not listed.
    """
    names = list(known)
    if (listed := in_known_spelling(word, names)) in names:
        return listed
    raise InputError(f'unknown {what} "{word:.40}"{_did_you_mean(word, names)}; expected one of {", ".join(names)}')


def glasses(texts: Sequence[str]) -> dict[str, tuple[float, float] | float | str]:
    """Converts glasses, NAME=n_d,V_d, NAME=n or NAME=schott:F4, to a dict for Lens.load. Raises InputError."""
    result: dict[str, tuple[float, float] | float | str] = {}
    for text in texts:
        name, equals, glass = text.partition("=")
        if not (name and equals and glass):
            raise InputError(f'--glass: "{text}": expected NAME=n_d,V_d or NAME=MAKER:GLASS')
        if name in result:
            raise InputError(f'--glass: the glass "{name}" is specified twice')
        n_d, comma, v_d = glass.partition(",")
        if comma:
            result[name] = (number(n_d, "--glass"), number(v_d, "--glass"))
        else:
            result[name] = number(n_d, "--glass") if n_d[0].isdigit() else glass
    return result


def advice_on(error: LensFileError) -> str:
    """Returns the end of the error's message that names the option which avoids the error; empty if there is none."""
    if error.can_be_forced:
        return "; --force reads it all the same"
    if not error.glass:
        return ""
    return f"; --glass {error.glass}={error.candidate or 'n_d,V_d'} names it"


def title_of(lens: Lens) -> str:
    """Returns the title of a plot: the lens, its focal length and its f-number."""
    text = f"{lens.title or lens.name}   {optics_text(lens)}"
    return "".join(c for c in text if c.isprintable())  # titles come from files and may contain control characters
