"""The plug-in for GPUs, which realcam[cuda] brings as a package of its own."""

from __future__ import annotations

import os
from importlib.util import find_spec
from pathlib import Path


def path_of_plugin() -> bytes:
    """The path of the library; empty: the package is not installed."""
    package = find_spec("realcam_cuda13")
    folders = (package.submodule_search_locations or ()) if package else ()
    found = (path for folder in folders for path in Path(folder).glob("librealcam_cuda13.so"))
    return os.fsencode(next(found, ""))
