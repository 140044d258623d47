"""Drawings of lenses, with matplotlib."""

from .lens_drawings import draw as draw
from .lens_drawings import draw_cross_section as draw_cross_section
from .lens_drawings import draw_states as draw_states
from .lens_drawings import save_cross_section as save_cross_section
from .lens_drawings import save_states as save_states
from .lens_drawings import states_of as states_of
