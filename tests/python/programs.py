"""The command line, as the executable and as the command of the Python package."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest
from realcam import _core

PYTHON = [sys.executable, "-m", "realcam"]
# CMake builds the executable beside the extension's folder; an installed package has no executable.
_BUILT = Path(_core.__file__).resolve().parents[1] / "realcam"
EXECUTABLE = [str(_BUILT)] if _BUILT.is_file() else []

Command = Callable[..., subprocess.CompletedProcess[str]]  # of the fixture `command`

# The executable starts sooner. Both run the same C++.
PROGRAM = EXECUTABLE or PYTHON

wants_executable = pytest.mark.skipif(not EXECUTABLE, reason="the executable is not built")


@cache
def loads_cuda_plugins() -> bool:
    """True if this build loads its CUDA backend as a plug-in; False if the backend is compiled in."""
    environment = {**os.environ, "REALCAM_CUDA_PLUGIN": ""}
    done = subprocess.run([*PYTHON, "devices"], capture_output=True, text=True, env=environment)
    return "no CUDA backend" in done.stderr
