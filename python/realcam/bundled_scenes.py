"""The scenes bundled with realcam, each with a shot file of the same name."""

from __future__ import annotations

import inspect
import os
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Any

from ._core import InputError, Scene, _did_you_mean

SCENE_SUFFIXES = (".gltf", ".glb", ".obj", ".ply", ".usd", ".usda", ".usdc", ".usdz")


@cache
def scenes_folder() -> Path:
    """Returns the folder of the bundled scenes, in the installed package or in the repository.

    Raises InputError if it is missing.
    """
    package = Path(__file__).resolve().parent
    for folder in (package / "scenes", package.parents[1] / "scenes"):
        if (folder / "demo.toml").is_file():
            return folder
    raise InputError("the demo scene is missing from this installation")


def shot_names() -> list[str]:
    """Returns the names of the bundled shots."""
    return sorted(path.stem for path in scenes_folder().glob("*.toml"))


def bundled_file(path: str | os.PathLike[str], suffixes: Sequence[str]) -> str | os.PathLike[str]:
    """Returns the file of a bundled shot or scene given by its name; returns any other path unchanged.

    A file or folder of this name in the current folder takes precedence. Raises InputError for a name that resembles
    a bundled shot's.
    """
    if not isinstance(path, (str, bytes, os.PathLike)):
        return path
    name = os.fsencode(path).decode(errors="replace")
    if not name or set(name) & {"/", "."} or os.path.lexists(path):
        return path
    found = (scenes_folder() / f"{name}{suffix}" for suffix in suffixes if name in shot_names())
    if file := next(filter(Path.is_file, found), None):
        return file
    if near := _did_you_mean(name, shot_names()):
        raise InputError(f'no file and no bundled shot is called "{name:.60}"{near}')
    return path


_read_scene = Scene.load


def _load(*arguments: Any, **named: Any) -> Scene:
    """Loads a scene as Scene.load does, also by the name of a bundled scene, and replaces it."""
    if arguments:
        arguments = (bundled_file(arguments[0], SCENE_SUFFIXES), *arguments[1:])
    elif "path" in named:
        named["path"] = bundled_file(named["path"], SCENE_SUFFIXES)
    return _read_scene(*arguments, **named)  # reports invalid arguments


def _signature(
    path: str | os.PathLike[str],
    *,
    scale: float = 1.0,
    objects: Sequence[str] = [],
    variants: Sequence[str] = [],
    scene_name: str = "",
) -> Scene:
    return _load(path, scale=scale, objects=objects, variants=variants, scene_name=scene_name)


_load.__signature__ = inspect.signature(_signature)  # type: ignore[attr-defined]
_load.__name__, _load.__qualname__, _load.__doc__ = "load", "Scene.load", _read_scene.__doc__
Scene.load = staticmethod(_load)  # type: ignore[method-assign]
