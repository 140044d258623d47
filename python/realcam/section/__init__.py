"""Cross-sections of lenses, as arrays. realcam.drawing draws them."""

from ..fields import Field
from .marks import FocusGroup, Mark
from .outlines import Blocker, Element, Face, Overlap
from .ray_paths import RayBundle
from .section import CrossSection, cross_section

__all__ = [
    "Blocker",
    "CrossSection",
    "Element",
    "Face",
    "Field",
    "FocusGroup",
    "Mark",
    "Overlap",
    "RayBundle",
    "cross_section",
]
