"""Views of OpenColorIO configurations in place of tone curves; the extra realcam[color] has OpenColorIO."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from . import _core
from ._core import InputError
from .pickling import PickledByFields

if TYPE_CHECKING:
    from .ocio_config import OcioConfig

BUILT_IN = "ocio://"  #: beginning of the names of OpenColorIO's built-in configurations

_MAX_LIGHT = 65504.0  # the largest half float: OpenColorIO makes larger numbers black where they overflow
_ROWS_PER_PART = 64


@dataclass(frozen=True)
class OcioView(PickledByFields):
    """A view of an OpenColorIO configuration, for the argument `tone` of Image.save and Image.developed.

    config: a configuration file (.ocio), or the name of a built-in one, such as "ocio://studio-config-latest".
    display, view: names in the configuration; "": its default display, and the default view of the display.
    Raises InputError if the extra realcam[color] is not installed, or if the configuration has no such view.
    """

    config: str
    display: str = ""
    view: str = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "config", os.fspath(self.config))
        if not all(isinstance(text, str) for text in (self.config, self.display, self.view)):
            raise InputError("config, display and view of an OcioView must be texts")
        display, view = self._opened.view(self.display, self.view)
        object.__setattr__(self, "display", display)
        object.__setattr__(self, "view", view)
        _ = self._transform  # raises InputError if the configuration cannot make it

    @cached_property
    def _opened(self) -> OcioConfig:
        return opened(self.config)

    @cached_property
    def _transform(self) -> Callable[[np.ndarray], None]:
        return self._opened.view_transform(self.display, self.view)

    @property
    def views(self) -> Mapping[str, tuple[str, ...]]:
        """The views of the configuration by display."""
        return self._opened.views

    @cached_property
    def is_srgb(self) -> bool:
        """True if the display values are encoded for sRGB (IEC 61966-2-1)."""
        return self._opened.is_srgb(self.display, self.view)

    def developed(self, pixels: np.ndarray, iso: float) -> np.ndarray:
        """Returns 8-bit display values, (H, W, 3) uint8, of an exposure (H, W, 3) in lux seconds, linear Rec. 709.

        An exposure of 10 / iso lux seconds is the scene-linear value 0.18, middle grey. NaN becomes 0.
        """
        linear = (np.asarray(pixels, np.float64) * (0.018 * iso)).clip(-_MAX_LIGHT, _MAX_LIGHT).astype(np.float32)
        np.nan_to_num(linear, copy=False)
        if linear.ndim != 3 or linear.shape[2] != 3:
            raise InputError("pixels must be an array of shape (H, W, 3)")
        colors = linear.reshape(-1, 3)
        part = _ROWS_PER_PART * 1024
        parts = [colors[i : i + part] for i in range(0, len(colors), part)]
        if len(parts) == 1:
            self._transform(parts[0])
        else:
            with ThreadPoolExecutor(os.cpu_count()) as threads:
                list(threads.map(self._transform, parts))
        codes: np.ndarray = (np.nan_to_num(linear).clip(0, 1) * np.float32(255) + np.float32(0.5)).astype(np.uint8)
        return codes

    def metadata(self) -> dict[str, str]:
        """Returns the metadata of picture files, values by their names "realcam:..."."""
        return {"realcam:ocio": self.config, "realcam:display": self.display, "realcam:view": self.view}


def develop(pixels: np.ndarray, iso: float, tone: str | OcioView) -> np.ndarray:
    """Returns the 8-bit display values of an exposure, (H, W, 3) uint8. tone: see Image.developed. Raises
    InputError."""
    return tone.developed(pixels, iso) if isinstance(tone, OcioView) else _core.develop(pixels, iso, tone)


def metadata_of(tone: str | OcioView) -> dict[str, str]:
    """Returns the metadata entries of a tone curve or view."""
    return tone.metadata() if isinstance(tone, OcioView) else {"realcam:tone": tone}


def opened(config: str) -> OcioConfig:
    """Opens a configuration. Raises InputError, whose message begins with its name."""
    try:
        import PyOpenColorIO  # noqa: F401
    except ImportError:
        raise InputError(f"{config}: configurations need OpenColorIO: pip install realcam[color]") from None
    from .ocio_config import OcioConfig

    return OcioConfig(config, is_built_in=config.startswith(BUILT_IN))
