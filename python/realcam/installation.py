"""Optional packages and libraries beside realcam, and advice if they are missing."""

from __future__ import annotations

import os
import platform
import re
import site
from importlib import import_module
from importlib.machinery import PathFinder
from pathlib import Path
from typing import Any


def installed_file(package: str, pattern: str) -> str:
    """Returns the path of a file of an installed package that matches a glob pattern; empty if there is none.

    Packages are searched for where Python installs them and beside this one, but not on `sys.path`: it may begin with
    the current folder, whose libraries must not be loaded.
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
    """Returns the path of Open Image Denoise, from REALCAM_OIDN or the extra realcam[denoise]; empty if missing."""
    return os.environ.get("REALCAM_OIDN", "") or installed_file("pyoidn", "libOpenImageDenoise.so*")


def cuda_plugin() -> bytes:
    """Returns the path of the CUDA plug-in, from the extra realcam[cuda]; empty if it is not installed."""
    return os.fsencode(installed_file("realcam_cuda13", "librealcam_cuda13.so"))


def imported(package: str, extra: str) -> Any:
    """Imports an optional package. Raises InputError, which names the extra, if it is missing."""
    try:
        return import_module(package)
    except ImportError:
        from ._core import InputError  # not above: this module advises when the extension cannot be imported

        raise InputError(
            f"the Python package {package} is missing; pip install 'realcam[{extra}]' installs it"
        ) from None


def advised(error: ImportError) -> ImportError:
    """Returns the error of a failed import of the extension, with a message that tells what to do if a remedy is
    known."""
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
