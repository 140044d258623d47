"""Logging of malformed requests, which our page never sends."""

from __future__ import annotations

import logging
import traceback
from pathlib import Path

# Loggers of errors caused by network input.
_LOGGERS = ("asyncio", "nicegui", "uvicorn.error", "engineio.server", "socketio.server")
_PACKAGE = Path(__file__).parents[2]
_MIDDLEWARE = ("access.py", "left_requests.py")  # in the traceback of every request


class OneLine(logging.Filter):
    """Shortens exceptions outside of realcam's code to one line: the server's libraries do not validate all input, and
    an attacker must not fill the log with tracebacks.
    """

    def filter(self, record: logging.LogRecord) -> bool:
        error = record.exc_info[1] if record.exc_info else None
        error = error or (record.msg if isinstance(record.msg, BaseException) else None)
        if error is not None and not _is_ours(error):
            record.msg, record.args = f"a request could not be understood ({type(error).__name__})", ()
            record.exc_info = record.exc_text = None
            record.levelno, record.levelname = logging.WARNING, "WARNING"
        return True


def _is_ours(error: BaseException) -> bool:
    files = [Path(frame.filename) for frame in traceback.extract_tb(error.__traceback__)]
    return any(file.is_relative_to(_PACKAGE) and file.name not in _MIDDLEWARE for file in files)


def shorten_tracebacks() -> None:
    """Installs OneLine in the loggers of the server's libraries."""
    for name in _LOGGERS:
        logging.getLogger(name).addFilter(OneLine())
