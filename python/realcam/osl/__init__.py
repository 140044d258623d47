"""Lenses as Blender cameras: shaders in OSL, the Open Shading Language."""

from .focus_range import focus_range
from .shader import shader_text

__all__ = ["focus_range", "shader_text"]
