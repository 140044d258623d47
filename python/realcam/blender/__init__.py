"""The extension for Blender 5 that brings lenses as cameras of Cycles."""

from .extension_file import write_extension

__all__ = ["write_extension"]
