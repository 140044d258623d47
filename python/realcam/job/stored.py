"""Scenes and cameras in the files of a job, which any realcam of the same version reads again."""

from __future__ import annotations

import hashlib
import io
import pickle
from pathlib import Path
from typing import Any

from .._core import InputError
from ..files import write_whole

# What pickles of realcam's values name. A pickle could name any function there is, and a job's folder comes from
# elsewhere.
_KNOWN = {
    ("realcam.pickling", "restored"),
    ("numpy", "ndarray"),
    ("numpy", "dtype"),
    ("numpy.core.multiarray", "_reconstruct"),
    ("numpy._core.multiarray", "_reconstruct"),
    ("numpy.core.numeric", "_frombuffer"),
    ("numpy._core.numeric", "_frombuffer"),
}


class _Reader(pickle.Unpickler):
    def find_class(self, module: str, name: str) -> Any:
        if (module, name) not in _KNOWN:
            raise pickle.UnpicklingError(f"{module}.{name} is no part of a scene or camera")
        return super().find_class(module, name)


def digest_of(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def pickled(value: Any) -> bytes:
    return pickle.dumps(value, protocol=5)


def store(path: Path, content: bytes) -> None:
    """Writes a file that read_stored reads, unless it is there already. Raises ImageFileError."""
    path.parent.mkdir(exist_ok=True)
    if not path.exists():
        write_whole(path, content, is_durable=True)


def read_stored(path: Path, digest: str) -> Any:
    """The value that was pickled. Raises InputError where the file is missing or is not what was stored."""
    try:
        content = path.read_bytes()
    except OSError as error:
        raise InputError(f"{path}: {error.strerror}; the job cannot go on without it") from None
    if digest_of(content) != digest:
        raise InputError(f"{path}: this is not the file that the job was made with")
    try:
        return _Reader(io.BytesIO(content)).load()
    except pickle.UnpicklingError as error:
        raise InputError(f"{path}: {error}") from None
