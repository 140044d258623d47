"""Archives (.npz) of arrays and a JSON description, with a checksum of all of their bytes."""

from __future__ import annotations

import hashlib
import io
import json
import os
import stat
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ._core import InputError
from .files import write_whole

# The end of the file, stored as the comment of the zip archive: the owner, and SHA-256 of all bytes before the digest.
# The checksums of zipfile cover only the members, so a damaged directory would still load.
_OWNER_LENGTH, _DIGEST_LENGTH = 64, 64


def packed(about: Any, arrays: Mapping[str, np.ndarray], *, owner: str = "", is_compressed: bool = False) -> bytes:
    """Returns the content of an archive.

    about: the description, a value that JSON can represent. owner: identity of the job that the archive belongs to, at
    most 64 ASCII characters.
    """
    content = io.BytesIO()
    text = np.frombuffer(json.dumps(about).encode(), np.uint8)
    (np.savez_compressed if is_compressed else np.savez)(content, about=text, **arrays)  # type: ignore[arg-type]
    with zipfile.ZipFile(content, "a") as archive:
        archive.comment = f"{owner:{_OWNER_LENGTH}.{_OWNER_LENGTH}}{'0' * _DIGEST_LENGTH}".encode()
    unsigned = content.getvalue()[:-_DIGEST_LENGTH]
    return unsigned + hashlib.sha256(unsigned).hexdigest().encode()


def write_archive(path: str | os.PathLike[str], content: bytes, *, replaces: bool = True) -> None:
    """Writes packed content completely or not at all, also if the machine loses power. Raises ImageFileError.

    replaces: if False, an existing file is left unchanged.
    """
    write_whole(path, content, replaces=replaces, is_durable=True)


def digest_of(content: bytes) -> str:
    """Returns the digest at the end of an archive's content."""
    return content[-_DIGEST_LENGTH:].decode("ascii", "replace")


def read_archive(
    path: Path, *, limit_bytes: int, owner: str = "", digest: str | None = None
) -> tuple[Any, dict[str, np.ndarray]]:
    """Returns the description and the arrays of an archive.

    limit_bytes: the largest permitted size of the unpacked content. digest: the expected digest; None: any. Raises
    InputError if the file is missing, not a regular file, damaged, too large, or belongs to another owner.
    """
    content = read_regular(path, limit_bytes + (1 << 20))
    unsigned, found = content[:-_DIGEST_LENGTH], digest_of(content)
    if hashlib.sha256(unsigned).hexdigest() != found:
        raise InputError(f"{path}: this file is damaged: its checksum differs")
    if digest not in (None, found):
        raise InputError(f"{path}: this is not the file that the job was made with")
    if unsigned[-_OWNER_LENGTH:].decode("ascii", "replace").rstrip() != owner:
        raise InputError(f"{path}: this file belongs to another job")
    arrays = unpacked(path, content, limit_bytes)
    try:
        return json.loads(arrays.pop("about").tobytes()), arrays
    except (KeyError, ValueError) as error:
        raise InputError(f"{path}: this file is malformed ({type(error).__name__})") from None


def unpacked(path: Path, content: bytes, limit_bytes: int, kinds: str = "biuf") -> dict[str, np.ndarray]:
    """Returns the arrays in the content of an .npz file.

    limit_bytes: the largest permitted size of the unpacked content. kinds: permitted kinds of dtypes. Raises InputError
    if the content is malformed or too large, or holds an array of another kind.
    """
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            if sum(member.file_size for member in archive.infolist()) > limit_bytes + (1 << 20):
                raise InputError(f"{path}: this file holds more than the {limit_bytes} bytes that are expected")
        # A header may state any shape: numpy allocates its array, but touches the memory only as bytes are read.
        with np.load(io.BytesIO(content), allow_pickle=False) as members:
            arrays = {name: members[name] for name in members.files}
    except InputError:
        raise
    except Exception as error:  # zipfile, zlib, numpy and json have a dozen exceptions for malformed content
        raise InputError(f"{path}: this file is malformed ({type(error).__name__})") from None
    if any(array.dtype.kind not in kinds for array in arrays.values()):
        raise InputError(f"{path}: this file holds an array that is not numeric")
    return arrays


def owner_in_file(path: str | os.PathLike[str]) -> str | None:
    """Returns the owner stored at the end of an archive, or None if the file is not a complete archive.

    The checksum is not verified. Raises OSError.
    """
    with open(path, "rb", opener=_opened_without_following) as file:
        size, end = os.fstat(file.fileno()).st_size, _OWNER_LENGTH + _DIGEST_LENGTH
        if not stat.S_ISREG(os.fstat(file.fileno()).st_mode) or size < end + 22:
            return None
        file.seek(size - end - 22)  # the zip format's end-of-directory record has 22 bytes before the comment
        found = file.read()
    return found[22:-_DIGEST_LENGTH].decode("ascii", "replace").rstrip() if found.startswith(b"PK\5\6") else None


def read_regular(path: Path, limit_bytes: int) -> bytes:
    """Returns the content of a regular file of at most limit_bytes; does not follow links. Raises InputError."""
    try:
        with open(path, "rb", opener=_opened_without_following) as file:
            about = os.fstat(file.fileno())
            if not stat.S_ISREG(about.st_mode):
                raise InputError(f"{path}: a regular file is expected, not a folder, pipe or device")
            if about.st_size > limit_bytes:
                raise InputError(f"{path}: this file has {about.st_size} bytes; at most {limit_bytes} are expected")
            return file.read(about.st_size)
    except FileNotFoundError:
        raise InputError(f"{path}: there is no such file") from None
    except OSError as error:
        why = "a regular file is expected, not a link" if path.is_symlink() else error.strerror
        raise InputError(f"{path}: {why}") from None


def _opened_without_following(path: str, flags: int) -> int:
    return os.open(path, flags | os.O_NOFOLLOW | os.O_NONBLOCK)  # opening a pipe must not wait for a writer
