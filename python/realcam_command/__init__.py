"""The command `realcam`.

A package of its own, because importing `realcam` takes a third of a second, in which Ctrl-C would end in a traceback.
"""

from __future__ import annotations

import os
from importlib.util import find_spec
from pathlib import Path


def denoiser_library() -> str:
    """The path of Open Image Denoise: what REALCAM_OIDN names, or what realcam[denoise] brings; empty: neither."""
    named = os.environ.get("REALCAM_OIDN", "")
    package = None if named else find_spec("pyoidn")
    folders = (package.submodule_search_locations or ()) if package else ()
    found = (path for folder in folders for path in Path(folder).rglob("libOpenImageDenoise.so*"))
    return named or str(next(found, ""))
