"""The command `realcam`.

A package of its own, because importing `realcam` takes a third of a second, in which Ctrl-C would end in a traceback.
"""

from __future__ import annotations

from pathlib import Path


def executable() -> Path:
    """The C++ program of this installation."""
    # Asked for without importing realcam.
    return Path(__file__).resolve().parents[1] / "realcam" / "bin" / "realcam"
