"""Data sets of labelled pictures of random scenes through real lenses, as tar shards (docs/datasets.md)."""

from .making import make
from .reading import samples
from .recipe import Recipe

__all__ = ["Recipe", "make", "samples"]
