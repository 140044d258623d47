"""USD stages as scenes: composed by the package usd-core, translated to glTF, and read by realcam's glTF reader.

The extension calls read_stage and camera_settings for files that end in .usd, .usda, .usdc or .usdz
(cpp/bindings/scene/bind_stages.cpp).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from importlib import import_module
from typing import Any

import numpy as np

from .._core import RealcamError, Scene, SceneFileError

__all__ = ["camera_settings", "read_stage"]


def read_stage(path: str, scale: float, objects: Sequence[str], variants: Sequence[str]) -> Scene:
    """Reads a stage, with the arguments of Scene.load. Raises SceneFileError and InputError."""
    return _call("reading", "scene_of_stage", path, scale, objects, variants)  # type: ignore[no-any-return]


def camera_settings(path: str, scale: float, variants: Sequence[str], camera: str) -> str:
    """Returns the settings of a stage's camera as the text of a shot file; paths are absolute. A further key,
    focus_is_to_pupil = true, says that focus distances are measured to the entrance pupil of the shot's lens.

    camera: its name; "": the first perspective camera. Returns "" if the stage has no such camera. Raises
    SceneFileError and InputError.
    """
    return _call("cameras", "settings_text", path, scale, variants, camera)  # type: ignore[no-any-return]


def _call(module: str, function: str, path: str, *arguments: Any) -> Any:
    """Calls a function of a module of this package, which imports usd-core. Errors of usd-core become
    SceneFileErrors in one line."""
    try:
        import pxr  # noqa: F401
    except ImportError:
        raise SceneFileError(f"{path}: USD stages need usd-core: pip install realcam[usd]") from None
    from pxr import Tf

    call: Callable[..., Any] = getattr(import_module(f".{module}", __name__), function)
    try:
        with np.errstate(all="ignore"):  # numbers of a stranger's file may overflow; readers check what they make
            return call(path, *arguments)
    except RealcamError:
        raise
    except (
        Tf.ErrorException,
        RuntimeError,
        MemoryError,
        TypeError,
        ValueError,
        IndexError,
        OverflowError,
        OSError,  # by a name inside of a .usdz that no file may have
    ) as error:
        raise SceneFileError(f"{path}: {_reason(error)}") from None


def _reason(error: BaseException) -> str:
    """Returns an error of usd-core in one line."""
    if isinstance(error, MemoryError):
        return "there is too little memory for it"
    # A Tf.ErrorException has parts with a commentary, and a text that shows the place in usd-core's source.
    commentary = getattr(error.args[0], "commentary", error) if error.args else type(error).__name__
    return " ".join(str(commentary).split())[:300]
