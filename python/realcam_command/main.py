"""Who does what of the command line."""

from __future__ import annotations

import os
import signal
import sys

from . import denoiser_library, executable

# What the C++ executable does. It comes with the Python package, which runs it, so that the two cannot differ.
_OF_THE_EXECUTABLE = (["render"], ["plan"], ["devices"], ["lens", "info"], ["lens", "list"])


def main() -> None:
    """Runs the command line."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    arguments = sys.argv[1:]
    if any(arguments[: len(command)] == command for command in _OF_THE_EXECUTABLE):
        _become_the_executable(arguments)
    from realcam.cli import run

    signal.signal(signal.SIGINT, signal.default_int_handler)
    run()


def _become_the_executable(arguments: list[str]) -> None:
    program = executable()
    if "--denoise" in arguments and (library := denoiser_library()):
        os.environ["REALCAM_OIDN"] = library
    try:
        os.execv(program, ["realcam", *arguments])
    except OSError as error:
        print(f"realcam: error: {program}: cannot be run: {error.strerror}", file=sys.stderr)
        sys.exit(2)
