"""Optional packages, which extras of the installation provide."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from ._core import InputError


def imported(package: str, extra: str) -> Any:
    """Imports an optional package. Raises InputError, which names the extra, if it is missing."""
    try:
        return import_module(package)
    except ImportError:
        raise InputError(f"the Python package {package} is missing; pip install 'realcam[{extra}]' brings it") from None
