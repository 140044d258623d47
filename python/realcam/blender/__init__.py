"""The extension for Blender 5 that provides lenses as custom Cycles cameras."""

from .extension_file import write_extension

__all__ = ["write_extension"]
