"""Cross-sections of lenses, as arrays. realcam.drawing draws them."""

from ..fields import Field
from .marks import FocusGroup, Mark
from .outlines import Blocker, Crossing, Element, Face
from .ray_paths import RayBundle
from .section import CrossSection, cross_section

__all__ = [
    "Blocker",
    "CrossSection",
    "Crossing",
    "Element",
    "Face",
    "Field",
    "FocusGroup",
    "Mark",
    "RayBundle",
    "cross_section",
]
