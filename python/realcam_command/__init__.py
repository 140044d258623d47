"""The command `realcam`.

A package of its own, because importing `realcam` takes a third of a second, in which Ctrl-C would end in a traceback.
"""

from __future__ import annotations

import os
import signal
import sys
from pathlib import Path

# What the C++ executable does. It comes with the Python package, which runs it, so that the two cannot differ.
_OF_THE_EXECUTABLE = (["render"], ["plan"], ["devices"], ["lens", "info"], ["lens", "list"])


def main() -> None:
    """Runs the command line."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    arguments = sys.argv[1:]
    if any(arguments[: len(command)] == command for command in _OF_THE_EXECUTABLE):
        _become(executable(), arguments)
    from realcam.cli import run

    signal.signal(signal.SIGINT, signal.default_int_handler)
    run()


def executable() -> Path:
    """The C++ program of this installation."""
    # Asked for without importing realcam.
    return Path(__file__).resolve().parents[1] / "realcam" / "bin" / "realcam"


def _become(program: Path, arguments: list[str]) -> None:
    try:
        os.execv(program, ["realcam", *arguments])
    except OSError as error:
        print(f"realcam: error: {program}: cannot be run: {error.strerror}", file=sys.stderr)
        sys.exit(2)
