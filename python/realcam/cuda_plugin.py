"""The plug-in for GPUs, which realcam[cuda] brings as a package of its own."""

from __future__ import annotations

import os

from realcam_command import installed_file


def path_of_plugin() -> bytes:
    """The path of the library; empty: the package is not installed."""
    return os.fsencode(installed_file("realcam_cuda13", "librealcam_cuda13.so"))
