"""Cross-sections of lenses, as arrays. realcam.drawing draws them."""

from ..fields import Field as Field
from .marks import FocusGroup as FocusGroup
from .marks import Mark as Mark
from .outlines import Blocker as Blocker
from .outlines import Element as Element
from .outlines import Face as Face
from .outlines import Overlap as Overlap
from .ray_paths import RayBundle as RayBundle
from .section import CrossSection as CrossSection
from .section import cross_section as cross_section
