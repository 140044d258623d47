"""Labelled pictures of random scenes through real lenses, in shards of tar files (docs/datasets.md)."""

from .making import make
from .reading import samples
from .recipe import Recipe

__all__ = ["Recipe", "make", "samples"]
