"""Files that appear under their name when they are whole."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ._core import ImageFileError, InputError


def system_name(path: str | os.PathLike[str]) -> bytes:
    """A path as the system spells it. Raises InputError where the system would take its beginning for the whole."""
    name = os.fsencode(path)
    if b"\0" in name:
        raise InputError("a file name cannot hold a null character")
    return name


def check_target(path: str | os.PathLike[str]) -> None:
    """Raises ImageFileError where no file of this name can be made, and InputError where it is no name."""
    system_name(path)
    with _errors_named(path):
        why = _why_no_file(_followed(path))
    if why:
        raise ImageFileError(f"{os.fspath(path)}: {why}")


def write_whole(path: str | os.PathLike[str], content: bytes) -> None:
    """Writes a file through links, as a whole or not at all. Raises ImageFileError."""
    with _errors_named(path):
        target = _followed(path)
        handle, temporary = tempfile.mkstemp(dir=target.parent, prefix=".realcam-")
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(content)
            umask = os.umask(0)
            os.umask(umask)
            Path(temporary).chmod(0o666 & ~umask)  # mkstemp makes private files
            Path(temporary).replace(target)
        finally:
            Path(temporary).unlink(missing_ok=True)


def _why_no_file(target: Path) -> str:
    folder = target.parent
    if not folder.is_dir():
        return f"the folder {folder} does not exist"
    if not os.access(folder, os.W_OK | os.X_OK):
        return f"the folder {folder} is not writable"
    if not target.exists():
        return ""
    if target.is_dir():
        return "is a folder; the name of a file is wanted"
    if not target.is_file():
        return "is a pipe or a device; the name of a file is wanted"
    return "" if os.access(target, os.W_OK) else "cannot be written: Permission denied"


def _followed(path: str | os.PathLike[str]) -> Path:
    """What a path leads to through links, which need not exist."""
    return Path(os.path.realpath(path)) if Path(path).is_symlink() else Path(path)


@contextmanager
def _errors_named(path: str | os.PathLike[str]) -> Iterator[None]:
    """Errors of the system name the file as the user calls it, and not a temporary one."""
    try:
        yield
    except OSError as error:
        raise ImageFileError(f"{os.fspath(path)}: cannot be written: {error.strerror}") from None
