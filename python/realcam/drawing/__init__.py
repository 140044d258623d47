"""Drawings of lenses, with matplotlib."""

from .lens_drawings import draw, draw_cross_section, draw_states, save_cross_section, save_states, states_of

__all__ = [
    "draw",
    "draw_cross_section",
    "draw_states",
    "save_cross_section",
    "save_states",
    "states_of",
]
