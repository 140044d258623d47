"""Files that appear under their name when they are whole."""

from __future__ import annotations

import os
from pathlib import Path

from ._core import ImageFileError, InputError


def system_name(path: str | os.PathLike[str]) -> bytes:
    """A path as the system spells it. Raises InputError where the system would take its beginning for the whole."""
    name = os.fsencode(path)
    if b"\0" in name:
        raise InputError("a file name cannot hold a null character")
    return name


def check_folder(path: str | os.PathLike[str]) -> None:
    """Raises ImageFileError where no file of this name can be made, and InputError where it is no name."""
    system_name(path)
    folder = Path(path).parent
    if not folder.is_dir():
        raise ImageFileError(f"{os.fspath(path)}: the folder {folder} does not exist")
    if not os.access(folder, os.W_OK | os.X_OK):
        raise ImageFileError(f"{os.fspath(path)}: the folder {folder} is not writable")
    if Path(path).is_dir():
        raise ImageFileError(f"{os.fspath(path)}: is a folder; the name of a file is wanted")


def publish(temporary: str, path: str | os.PathLike[str]) -> None:
    """Gives a finished temporary file its name, and the permissions that a new file gets."""
    umask = os.umask(0)
    os.umask(umask)
    Path(temporary).chmod(0o666 & ~umask)  # mkstemp makes private files
    Path(temporary).replace(path)
