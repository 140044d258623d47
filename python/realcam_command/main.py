"""Who does what of the command line."""

from __future__ import annotations

import os
import signal
import sys

# Commands that the extension runs with the executable's C++, so that the two cannot differ.
_IN_CPP = (["render"], ["plan"], ["devices"], ["lens", "info"])


def main() -> None:
    """Runs the command line."""
    # Python's own handler would end an import in a traceback, and would not be called while C++ is at work.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    arguments = sys.argv[1:]
    try:
        if any(arguments[: len(command)] == command for command in _IN_CPP):
            sys.exit(_run_in_cpp(arguments))
        from realcam.cli.app import run
    except ImportError as error:
        print(f"realcam: error: {error}", file=sys.stderr)
        sys.exit(2)

    signal.signal(signal.SIGINT, signal.default_int_handler)
    run()


def _run_in_cpp(arguments: list[str]) -> int:
    """The exit code."""
    from realcam import _core

    if not hasattr(_core, "_run_command"):
        print("realcam: error: this build of realcam has no picture files, and no such command", file=sys.stderr)
        return 2
    from realcam.cli.command_words import normalised_for_cpp
    from realcam.installation import denoiser_library

    try:
        words = normalised_for_cpp(arguments)
    except _core.InputError as error:
        print(f"realcam: error: {_core.one_line(str(error))}", file=sys.stderr)
        return 2
    # The library is also needed without --denoise, for pictures whose noise goal is not reached.
    if arguments[0] == "render" and "--no-denoise" not in arguments and (library := denoiser_library()):
        os.environ["REALCAM_OIDN"] = library
    return _core._run_command([os.fsencode(word) for word in words])
