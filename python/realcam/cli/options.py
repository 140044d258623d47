"""Options and arguments that several commands share."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Annotated

import typer

from .._core import InputError, Lens, LensFileError, _did_you_mean
from ..number_text import number_text
from .command_words import spelled
from .completions import completion_of

SHOT_HELP = "A shot file (.toml), a scene file (.obj, .gltf, .glb or .ply), or the name of a bundled shot: demo"
ShotName = Annotated[Path, typer.Argument(help=SHOT_HELP, metavar="SCENE")]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="Print warnings and errors alone")]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON")]
Device = Annotated[
    str,
    typer.Option(
        metavar="DEVICE",
        help="auto (a GPU if there is one), cpu, cuda, or cuda:1",
        autocompletion=completion_of("DEVICE"),
    ),
]
Threads = Annotated[int, typer.Option(metavar="N", help="0: all", min=0, max=4096)]


def say_written(target: Path, quiet: bool = False) -> None:
    if not quiet:
        typer.echo(f"wrote {os.fsencode(target).decode(errors='replace')}")


def number(text: str, what: str, wanted: str = "a number") -> float:
    """A number, or inf. Raises InputError."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if math.isnan(value):
        raise InputError(f'{what}: "{text}" is not {wanted}')
    return value


def frame_numbers(text: str) -> range:
    """The numbers of frames: 7, 1-240, or 1-240x10 for every tenth. Raises InputError."""
    found = re.fullmatch(r"(\d{1,6})(?:-(\d{1,6})(?:x(\d{1,6}))?)?", text)
    step = int(found[3] or 1) if found else 0
    numbers = range(int(found[1]), int(found[2] or found[1]) + 1, step) if found and step else None
    if not numbers:
        raise InputError(f'--frames: "{text:.40}": expected a number, 1-240 or 1-240x2, the smaller one first')
    return numbers


def known_word(word: str, known: Iterable[str], what: str) -> str:
    """Returns the listed spelling of a word; American spellings are known.

    Raises InputError, with similar words, if the word is not listed.
    """
    names = list(known)
    if (listed := spelled(word, names)) in names:
        return listed
    raise InputError(f'unknown {what} "{word:.40}"{_did_you_mean(word, names)}; expected one of {", ".join(names)}')


def glasses(texts: Sequence[str]) -> dict[str, tuple[float, float] | float | str]:
    """Glasses as the command line names them: NAME=n_d,V_d, NAME=n or NAME=schott:F4. Raises InputError."""
    result: dict[str, tuple[float, float] | float | str] = {}
    for text in texts:
        name, equals, glass = text.partition("=")
        if not (name and equals and glass):
            raise InputError(f'--glass: "{text}": expected NAME=n_d,V_d or NAME=MAKER:GLASS')
        if name in result:
            raise InputError(f'--glass: the glass "{name}" is given twice')
        n_d, comma, v_d = glass.partition(",")
        if comma:
            result[name] = (number(n_d, "--glass"), number(v_d, "--glass"))
        else:
            result[name] = number(n_d, "--glass") if n_d[0].isdigit() else glass
    return result


def advice_on(error: LensFileError) -> str:
    """Names the option that avoids the error, as the end of the error's message; empty if there is no such option."""
    if error.can_be_forced:
        return "; --force reads it all the same"
    if not error.glass:
        return ""
    return f"; --glass {error.glass}={error.candidate or 'n_d,V_d'} names it"


def title_of(lens: Lens) -> str:
    """A line over a plot: the lens, its focal length and its f-number."""
    data = lens.first_order()
    focal_length, f_number = number_text(data.effective_focal_length_mm), number_text(lens.f_number, 3)
    text = f"{lens.title or lens.name}   f = {focal_length} mm, f/{f_number}"
    return "".join(c for c in text if c.isprintable())  # titles come from files and may contain control characters
