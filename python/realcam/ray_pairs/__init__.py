"""Lenses that are known by rays before and behind them: measured pairs of rays, and polynomials fitted to them."""

from .ray_file import save_rays
from .ray_pair_lens import RayPairLens

__all__ = ["RayPairLens", "save_rays"]
