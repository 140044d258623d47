"""Reading of uploaded lens files in a separate process, so that a malicious file cannot crash or block the server."""

from __future__ import annotations

import tempfile
from pathlib import Path

from .._core import InputError, Lens, RealcamError
from .worker_process import WorkerProcess, WorkError

_TIMEOUT_S = 10.0
#: Process that reads lens files for all windows.
reader = WorkerProcess()


def lens_from(name: str, content: bytes) -> tuple[Lens, list[str]]:
    """Returns the lens of a file, and notes on unsupported parts of it. name: the user's file name. Raises InputError.

    Blocks, and must not be called on the server's loop.
    """
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"{Path(name).stem[:60]}{Path(name).suffix.lower()}"
        try:
            path.write_bytes(content)
            lens, notes = reader.call(_read, path, seconds=_TIMEOUT_S)
        except WorkError as error:
            raise InputError(f"{name}: reading the file {error}") from None
        except (RealcamError, OSError) as error:
            raise InputError(str(error).replace(str(path), name)) from None
    return lens, [note.replace(str(path), name) for note in notes]


def _read(path: Path) -> tuple[Lens, list[str]]:
    return Lens._load_with_notes(path)
