"""The CUDA plug-in, a separate package that the extra realcam[cuda] installs."""

from __future__ import annotations

import os

from realcam_command import installed_file


def path_of_plugin() -> bytes:
    """Returns the path of the library; empty if the package is not installed."""
    return os.fsencode(installed_file("realcam_cuda13", "librealcam_cuda13.so"))
