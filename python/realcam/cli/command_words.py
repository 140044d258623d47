"""Normalises command lines for the commands' parsers: numbers with units, US spellings, options of other programs.

The parsers, in Python and C++, report all errors that are not found here.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from pathlib import Path

from .. import _core
from .._core import InputError, lens_names
from ..bundled_scenes import SCENE_SUFFIXES, bundled_file, shot_names
from ..files import LENS_SUFFIXES

_LENGTHS_M = {
    **dict.fromkeys(("m", "metre", "metres", "meter", "meters"), "1"),
    "km": "1000",
    "cm": "0.01",
    "mm": "0.001",
    "um": "1e-6",
    "µm": "1e-6",
    "μm": "1e-6",
    "nm": "1e-9",
    **dict.fromkeys(("ft", "foot", "feet"), "0.3048"),
    **dict.fromkeys(("in", "inch", "inches"), "0.0254"),
}
_TIMES_S = {
    **dict.fromkeys(("s", "sec", "second", "seconds"), "1"),
    "ms": "0.001",
    "us": "1e-6",
    "µs": "1e-6",
    "μs": "1e-6",
    **dict.fromkeys(("min", "minute", "minutes"), "60"),
    **dict.fromkeys(("h", "hour", "hours"), "3600"),
}
_ANGLES_DEG = dict.fromkeys(("deg", "degree", "degrees", "°"), "1")


def _in(unit: str, sizes: Mapping[str, str]) -> dict[str, Decimal]:
    """Returns the sizes of all units, as multiples of `unit`."""
    return {name: Decimal(size) / Decimal(sizes[unit]) for name, size in sizes.items()}


# Keyed by the placeholder of an option's value in its help, which names the unit of a bare number.
_UNITS: dict[str, dict[str, Decimal]] = {
    "METRES": _in("m", _LENGTHS_M),
    "X,Y,Z": _in("m", _LENGTHS_M),
    "MM": _in("mm", _LENGTHS_M),
    "X,Y": _in("mm", _LENGTHS_M),
    "NM": _in("nm", _LENGTHS_M),
    "WxH": _in("mm", _LENGTHS_M),
    **dict.fromkeys(("S", "SECONDS", "TIME"), _in("s", _TIMES_S)),
    "DEGREES": _in("deg", _ANGLES_DEG),
    "PIXELS": {"px": Decimal(1), "pixels": Decimal(1)},
    "PERCENT": {"%": Decimal(1)},
    "SHARE": {"%": Decimal("0.01")},
    "PER_MM": dict.fromkeys(("/mm", "lp/mm"), Decimal(1)),
    "CELSIUS": dict.fromkeys(("c", "°c"), Decimal(1)),
    "CD_M2": dict.fromkeys(("cd/m2", "cd/m^2", "cd/m²", "nit", "nits"), Decimal(1)),
    "CD_M2|FILE": dict.fromkeys(("cd/m2", "cd/m^2", "cd/m²", "nit", "nits"), Decimal(1)),
}
_PREFIXES = {"F_NUMBER": r"f\s*[/:]?|1:", "ISO": "iso"}

_NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d{1,3})?"


# Separators between numbers: commas, the "x" of sizes, and the dash of ranges, but not the minus of an exponent.
_SEPARATOR = r"(\s*[,x×]\s*(?=[-+.\d])|(?<=[\w.])(?<!\de)\s*-\s*(?=[\d.f]))"


def plain_number(text: str, kind: str) -> str:
    """Strips the unit from a number, or from several with ",", "x" or "-" between them.

    kind: the placeholder. "50cm" of METRES becomes "0.5", "1/125 s" of TIME "1/125", "f/4" of F_NUMBER "4". A unit at
    the end applies to all numbers. Any other text is returned unchanged.
    """
    if len(text) > 200:
        return text
    words = re.split(_SEPARATOR, text.strip(), flags=re.IGNORECASE)
    if text == "∞" and kind in _UNITS:
        return "inf"
    if kind in _PREFIXES:
        pattern = rf"(?:{_PREFIXES[kind]})?\s*({_NUMBER})"
        found_numbers = [re.fullmatch(pattern, word, re.IGNORECASE) for word in words[::2]]
        plain = [found[1] for found in found_numbers if found]
    else:
        plain = _without_units(words[::2], _UNITS.get(kind, {}))
    if not plain or len(plain) < len(words[::2]):
        return text
    separators = [next(c for c in ",-x" if c in separator.replace("×", "x").lower()) for separator in words[1::2]]
    return "".join(word for pair in zip(plain, [*separators, ""], strict=True) for word in pair)


def _without_units(words: Sequence[str], sizes: Mapping[str, Decimal]) -> list[str]:
    """Returns the numbers in the base unit; an empty list unless all are numbers with known units."""
    pattern = rf"({_NUMBER})((?:/{_NUMBER})?)\s*([^\d\s.]\S*)?"
    numbers = [found for word in words if (found := re.fullmatch(pattern, word, re.IGNORECASE))]
    if len(numbers) < len(words) or not numbers[-1][3]:
        return []
    units = [found[3] or numbers[-1][3] for found in numbers]
    known = [size for unit in units if (size := sizes.get(unit, sizes.get(unit.lower())))]
    if len(known) < len(numbers):
        return []
    return [_scaled(found[1], size) + found[2] for found, size in zip(numbers, known, strict=True)]


def _scaled(number: str, size: Decimal) -> str:
    """Multiplies in decimal arithmetic, so that 50cm becomes exactly 0.5."""
    return f"{(Decimal(number) * size).normalize():f}"


_AMERICAN = {
    "colour": "color", "centre": "center", "metre": "meter", "fibre": "fiber", "grey": "gray", "optimis": "optimiz",
    "analys": "analyz", "catalogue": "catalog", "aluminium": "aluminum",
}  # fmt: skip


def in_known_spelling(word: str, known: Iterable[str]) -> str:
    """Returns the known word that differs only in American or British spelling; otherwise the word itself."""
    names = list(known)
    return word if word in names else next((name for name in names if _american(name) == _american(word)), word)


def _american(word: str) -> str:
    for british, american in _AMERICAN.items():
        word = word.replace(british, american)
    return word


# Option names that users of other programs try, and realcam's names; the first one that a command has is suggested.
_OTHER_NAMES = {
    **dict.fromkeys(("--aperture", "--f-stop", "--fstop", "--fnumber"), ("--f-number",)),
    **dict.fromkeys(("--samples", "--num-samples", "--sample-count"), ("--spp", "--copies", "--max-spp")),
    **dict.fromkeys(("--shutter", "--shutter-speed", "--shutter-time", "--exposure"), ("--exposure-time",)),
    **dict.fromkeys(("--distance", "--focus-distance"), ("--focus", "--object-distance")),
    **dict.fromkeys(("--out", "--outfile", "--save"), ("--output",)),
    **dict.fromkeys(("--width", "--height", "--size"), ("--resolution", "--size", "--width")),
    **dict.fromkeys(("--bounces", "--depth", "--max-depth"), ("--max-bounces",)),
    "--sensitivity": ("--iso",),
    "--gpu": ("--device",),
}
# Suffixes of files that commands write.
_WRITTEN = (
    ".png", ".jpg", ".jpeg", ".tif", ".tiff", ".webp", ".exr", ".dng", ".npy", ".mp4", ".svg", ".pdf", ".html", ".zip",
    ".csv",
)  # fmt: skip
# Suffixes of files that commands read, by the placeholder of an argument.
_READ = {
    "SCENE": (*SCENE_SUFFIXES, ".toml"),
    "LENS": LENS_SUFFIXES,
    "FILM": (".exr",),
    "RECIPE": (".toml",),
}


@dataclass(frozen=True)
class Grammar:
    """Options and arguments of a command.

    name: command as typed, "realcam render". options: placeholder of the value by option name; empty for a flag.
    arguments: placeholders in order. takes_more: True if the last argument may be repeated.
    """

    name: str
    options: Mapping[str, str]
    arguments: Sequence[str]
    takes_more: bool = False


def normalised(words: Sequence[str], grammar: Grammar) -> list[str]:
    """Returns the words of a command line behind the command's name in the form that its parser expects.

    Numbers have no units, options have their own spelling, and names of bundled scenes are replaced by their files.
    Raises InputError with a suggestion for options of other programs, an output without -o and swapped arguments.
    """
    result: list[str] = []
    arguments: list[str] = []
    values: list[tuple[str, str]] = []  # (option, value)
    unknown: list[str] = []
    option = ""  # the option whose value is the next word; empty: there is none
    for i, word in enumerate(words):
        if option and word not in grammar.options:
            result.append(_plain_value(option, word, grammar))
            values.append((option, word))
            option = ""
            continue
        option = ""
        if word == "--":
            result += words[i:]
            break
        if not word.startswith("-"):
            arguments.append(word)
            is_scene = _placeholder(len(arguments) - 1, grammar) == "SCENE"
            result.append(os.fspath(bundled_file(word, (".toml", *SCENE_SUFFIXES))) if is_scene else word)
            continue
        name, equals, value = word.partition("=")
        name = in_known_spelling(name, grammar.options)
        if name not in grammar.options:
            unknown.append(name)
        if equals:
            result.append(f"{name}={_plain_value(name, value, grammar)}")
            values.append((name, value))
        else:
            result.append(name)
            option = name if grammar.options.get(name) else ""
    if {"-h", "--help"} & set(words):
        return result
    for name in unknown:
        for own in _OTHER_NAMES.get(name, ()):
            if own in grammar.options:
                raise _mistake(f"unknown option {name}", own, grammar)
    if not unknown:  # the parser reports unknown options first
        _check_arguments(arguments, [value for name, value in values if name in ("-o", "--output")], grammar)
    return result


def normalised_for_cpp(words: Sequence[str]) -> list[str]:
    """Applies normalised() to a command line that begins with a command in C++; returns others unchanged."""
    for names, _, options in _core._listed_commands():
        if words[: len(names)] == names:
            grammar = Grammar(
                " ".join(["realcam", *names]),
                {"-h": "", "--help": "", **{name: value for found, value, _ in options for name in found}},
                [value for found, value, _ in options if not found],
            )
            return [*names, *normalised(words[len(names) :], grammar)]
    return list(words)


def _plain_value(option: str, text: str, grammar: Grammar) -> str:
    kinds = {"--f-number": "F_NUMBER", "--resolution": "PIXELS"}  # placeholders that options of other kinds share
    return plain_number(text, kinds.get(option, grammar.options.get(option, "")))


def _placeholder(index: int, grammar: Grammar) -> str:
    """Returns the placeholder of the argument at an index; empty if the command takes fewer arguments."""
    last = len(grammar.arguments) - 1
    return grammar.arguments[min(index, last)] if last >= 0 and (index <= last or grammar.takes_more) else ""


def _check_arguments(arguments: Sequence[str], outputs: Sequence[str], grammar: Grammar) -> None:
    """Raises InputError with a suggestion if arguments and --output seem to be swapped or options to be missing."""
    if not arguments or not grammar.arguments:
        return
    first, kind = arguments[0], _placeholder(0, grammar)
    read = next((name for name in outputs if _is_read(name, kind)), None)
    if read is not None and not _is_read(first, kind) and _suffix(first) in _WRITTEN:
        raise _mistake(f"{kind} and --output are swapped", f"{read} -o {first}", grammar)
    if kind == "SCENE" and "--lens" in grammar.options and first in lens_names() and not Path(first).exists():
        raise _mistake(f'{kind}: "{first}" is a lens', f"--lens {first}", grammar)
    last, kind = arguments[-1], _placeholder(len(arguments) - 1, grammar)
    if not kind and "--lens" in grammar.options and last in lens_names():
        raise _mistake(f'unexpected argument "{last}"', f"--lens {last}", grammar)
    is_written = _suffix(last) and not _is_read(last, kind or grammar.arguments[-1])
    if len(arguments) > 1 and is_written and "--output" in grammar.options and not outputs:
        raise _mistake(f'unexpected argument "{last}"', f"-o {last}", grammar)


def _is_read(word: str, kind: str) -> bool:
    """Returns True for a file, or a bundled name, that is valid for an argument with the placeholder `kind`."""
    names = {"SCENE": shot_names, "LENS": lens_names}.get(kind, list)()
    return _suffix(word) in _READ.get(kind, ()) or word in names


def _suffix(word: str) -> str:
    return Path(word).suffix.lower()


def _mistake(what: str, meant: str, grammar: Grammar) -> InputError:
    text = f'{what} (did you mean "{meant}"?) ({grammar.name} --help lists the options)'
    return InputError(text.encode(errors="replace").decode())  # words may be invalid UTF-8
