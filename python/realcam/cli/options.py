"""What several commands read from the command line in the same way."""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from fractions import Fraction

import typer
from rich.console import Console

from .._core import InputError, Lens


def console() -> Console:
    """Stdout, wide enough for the tables where it is a file or a pipe."""
    result = Console()
    return result if result.is_terminal else Console(width=160)


def number(text: str, what: str) -> float:
    """A number, a fraction such as 1/125, or inf. Raises InputError."""
    try:
        if text.strip().lower() in ("inf", "infinity"):
            return math.inf
        return float(Fraction(text.strip())) if "/" in text else float(text)
    except (ValueError, ZeroDivisionError):
        raise InputError(f'{what} is "{text}"; a number is wanted') from None


def numbers(text: str, separator: str, count: int, what: str) -> tuple[float, ...]:
    """So many numbers with a separator in between. Raises InputError."""
    parts = text.lower().split(separator)
    if len(parts) != count:
        wanted = separator.join("xyz"[:count] if separator == "," else ("width", "height"))
        raise InputError(f'{what} is "{text}"; {wanted} is wanted')
    return tuple(number(part, what) for part in parts)


def lens(name: str, focus: str | None, f_number: float | None) -> Lens:
    """A lens with its rings set."""
    result = Lens.load(name)
    if focus is not None:
        result = result.focused(number(focus, "--focus"))
    if f_number is not None:
        result = result.stopped_down(f_number)
    return result


@contextmanager
def stoppable() -> Iterator[None]:
    """Ctrl-C ends the work with one line and exit code 130."""
    try:
        yield
    except KeyboardInterrupt:
        print("realcam: stopped; nothing was written", file=sys.stderr)
        raise typer.Exit(130) from None
