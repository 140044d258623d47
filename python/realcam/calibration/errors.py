"""Errors of calibration files."""

from __future__ import annotations

from .._core import RealcamError


class CalibrationFileError(RealcamError):
    """A calibration file that cannot be read. The message is one line: file, key or line, and what is expected."""
