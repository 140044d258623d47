"""The command `realcam`.

A package of its own, because importing `realcam` takes a third of a second, in which Ctrl-C would end in a traceback.
"""

from __future__ import annotations

import os
import site
from importlib.machinery import PathFinder
from pathlib import Path


def installed_file(package: str, pattern: str) -> str:
    """The path of a file of an installed package; empty: there is none.

    Packages are looked for where Python installs them and beside this one. `sys.path` would begin with the current
    folder, whose libraries must not be loaded because somebody works in it.
    """
    folders = [*site.getsitepackages(), str(Path(__file__).resolve().parents[1])]
    if site.ENABLE_USER_SITE:
        folders.append(site.getusersitepackages())
    spec = PathFinder.find_spec(package, folders)
    if spec is None or spec.origin is None:  # a namespace package: a folder of this name
        return ""
    found = (path for folder in spec.submodule_search_locations or () for path in Path(folder).rglob(pattern))
    return str(next(found, ""))


def denoiser_library() -> str:
    """The path of Open Image Denoise: what REALCAM_OIDN names, or what realcam[denoise] brings; empty: neither."""
    return os.environ.get("REALCAM_OIDN", "") or installed_file("pyoidn", "libOpenImageDenoise.so*")
