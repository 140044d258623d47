"""Matplotlib figures in HTML pages with light and dark themes."""

from __future__ import annotations

from dataclasses import fields

from matplotlib.figure import Figure
from matplotlib.transforms import Bbox

from .figure_files import figure_bytes
from .themes import LIGHT, THEMES, Theme


def inline_svg(figure: Figure, salt: str, crop: Bbox | None = None) -> str:
    """Returns an <svg> element in which the light theme's colours are CSS variables. salt, crop: as in figure_bytes."""
    text = figure_bytes(figure, ".svg", dpi=130, salt=f"realcam-{salt}", crop=crop).decode()
    text = text[text.index("<svg") :]
    for name, colour in _colours(LIGHT).items():
        text = text.replace(colour, f"var(--{name})")
    return text


def page_top(title: str, style: str, theme: str | None) -> str:
    """Returns the start of an HTML page, up to its heading.

    title: HTML-escaped. style: CSS, which may use the colour variables. theme: "light", "dark", or None for the
    browser's setting; print always uses the light theme.
    """
    return f"""<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width">
<title>{title}</title>
<style>
{_colour_variables(theme)}{style}</style>
<h1>{title}</h1>"""


def _colour_variables(theme: str | None) -> str:
    light, dark = (_declared(name) for name in ("light", "dark"))
    screen = light if theme is None else _declared(theme)
    following = f"@media (prefers-color-scheme: dark) {{ {dark} }}\n" if theme is None else ""
    # Colour of secondary text.
    quiet = ":root { --quiet: color-mix(in srgb, var(--text) 70%, var(--page)); }"
    return f"{screen}\n{following}@media print {{ {light} }}\n{quiet}"


def _declared(theme: str) -> str:
    values = "; ".join(f"--{name}: {colour}" for name, colour in _colours(THEMES[theme]).items())
    return f":root {{ color-scheme: {theme}; {values} }}"


def _colours(theme: Theme) -> dict[str, str]:
    """Returns the colours of a theme by the names of their CSS variables."""
    single = {field.name: getattr(theme, field.name) for field in fields(theme) if field.name != "rays"}
    return {**single, **{f"ray-{number}": colour for number, colour in enumerate(theme.rays)}}
