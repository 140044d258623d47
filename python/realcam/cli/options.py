"""What several commands read from the command line in the same way."""

from __future__ import annotations

import math

import typer

from .._core import InputError, Lens


def add_command_of_the_executable(app: typer.Typer, name: str, help: str) -> None:
    """Lists a command in the help; realcam_command has handed it to the executable before anybody gets here."""

    def command() -> None:
        raise InputError(f'"{name}" is a command of the executable; options come after it')

    app.command(name, help=help)(command)


def number(text: str, what: str) -> float:
    """A number, or inf. Raises InputError."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if math.isnan(value):
        raise InputError(f'{what}: "{text}" is not a number')
    return value


def lens(name: str, focus: str | None, f_number: float | None) -> Lens:
    """A lens with its rings set."""
    result = Lens.load(name)
    # The stop first: f-numbers are of the lens at infinity, and a focusing group that has moved makes another lens.
    if f_number is not None:
        result = result.stopped_down(f_number)
    if focus is not None:
        result = result.focused(number(focus, "--focus"))
    return result


def title_of(lens: Lens) -> str:
    """A line over a plot: the lens, its focal length and its f-number."""
    data = lens.first_order()
    text = f"{lens.title or lens.name}   f = {data.effective_focal_length_mm:.4g} mm, f/{data.f_number:.3g}"
    return "".join(c for c in text if c.isprintable())  # titles come from files, and may hold any characters
