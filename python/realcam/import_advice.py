"""Advice for a failed import of the extension."""

from __future__ import annotations

import platform
import re


def advised(error: ImportError) -> ImportError:
    """Returns the error with a message that says what to do, if a remedy is known; otherwise unchanged."""
    text = str(error)
    if re.search(r"version `(GLIBC|GLIBCXX|CXXABI)_[\d.]+' not found", text):
        has = " ".join(platform.libc_ver()) or "another C library"
        return ImportError(
            "this wheel of realcam is for Linux with glibc 2.34 or later (Debian 12, Ubuntu 22.04, RHEL 9), and this "
            f"system has {has}; build realcam from its source instead (README.md)"
        )
    if "cannot import name '_core'" in text:
        return ImportError(
            f"realcam is not built for Python {platform.python_version()} on {platform.machine()}; install its wheel "
            "for this Python, or build it from its source (README.md)"
        )
    return error
