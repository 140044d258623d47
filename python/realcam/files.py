"""Atomic file output: a file appears under its name only when it is complete."""

from __future__ import annotations

import os
import secrets
import stat
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path

from ._core import ImageFileError, InputError, _check_no_input, _record_input

LENS_SUFFIXES = (".toml", ".zmx", ".seq", ".len", ".dat", ".json", ".roa")  # of supported lens files


def system_name(path: str | os.PathLike[str]) -> bytes:
    """Returns a path as the bytes of the file system. Raises InputError for a null character, at which it would end."""
    name = os.fsencode(path)
    if b"\0" in name:
        raise InputError("a file name cannot hold a null character")
    return name


def record_input(path: str | os.PathLike[str]) -> None:
    """Records a file that a command reads in Python, so that check_target refuses it as an output."""
    _record_input(system_name(path))


def check_target(path: str | os.PathLike[str], suffixes: Sequence[str] = ()) -> Path:
    """Returns the path of an output file. Suffixes are compared without regard to case.

    Raises ImageFileError if the file cannot be created or has another suffix, and InputError if the name is invalid or
    is that of an input file of the command.
    """
    system_name(path)
    if suffixes and Path(path).suffix.lower() not in suffixes:
        known = ", ".join(suffixes[:-1]) + (" or " if suffixes[1:] else "") + suffixes[-1]
        raise ImageFileError(f"{os.fspath(path)}: unknown suffix; expected {known}")
    with _errors_named(path):
        why = _why_no_file(_followed(path))
    if why:
        raise ImageFileError(f"{os.fspath(path)}: {why}")
    _check_no_input(os.fsencode(path))
    return Path(path)


def check_targets(paths: Iterable[Path], *, outside: Path | None = None) -> set[Path]:
    """Returns the resolved paths of output files. Raises what check_target raises, and InputError if one lies in the
    folder `outside`, which the command reads."""
    resolved = {check_target(path).resolve() for path in paths}
    for path in resolved:
        if outside is not None and path.is_relative_to(outside.resolve()):
            raise InputError(f"{path}: lies in the folder {outside}, which the output is made from; choose another")
    return resolved


def make_folder(path: Path) -> None:
    """Creates a folder and its missing parents. Raises ImageFileError."""
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ImageFileError(f"{path}: the folder cannot be made: {error.strerror}") from None


def write_whole(
    path: str | os.PathLike[str], content: bytes, *, replaces: bool = True, is_durable: bool = False
) -> bool:
    """Writes a file completely or not at all, following symbolic links; a replaced file keeps its mode.

    replaces: if False, an existing file is left unchanged, and False is returned. is_durable: syncs the content to disk
    before the file gets its name, so that a power failure leaves no empty file. Raises ImageFileError.
    """
    check_target(path)
    with _errors_named(path):
        target = _followed(path)
        temporary = _temporary_beside(target)
        # Files of the module tempfile are private (mode 0600). open() applies the umask, which a program could only
        # query by setting it.
        with temporary.open("xb") as file:
            try:
                with suppress(FileNotFoundError):
                    os.fchmod(file.fileno(), stat.S_IMODE(target.stat().st_mode))
                file.write(content)
                if is_durable:
                    file.flush()
                    os.fsync(file.fileno())
                file.close()
                if replaces:
                    temporary.replace(target)
                else:
                    _take_name(temporary, target)
            except FileExistsError:
                return False
            finally:
                temporary.unlink(missing_ok=True)
    return True


def remove_leftovers(folder: Path) -> None:
    """Removes temporary files that a killed write_whole has left in a folder or its subfolders.

    Such files have not been written to for _QUIET_S seconds. Files that cannot be removed stay.
    """
    leftovers = list(folder.rglob(f"{_TEMPORARY}*"))
    if not leftovers:
        return
    with suppress(OSError):
        # The current time is taken from the file system, whose clock may be another machine's.
        with _temporary_beside(folder / "now").open("xb") as file:
            now = os.fstat(file.fileno()).st_mtime
        Path(file.name).unlink()
        for path in leftovers:
            with suppress(OSError):
                if now - path.stat().st_mtime > _QUIET_S:
                    path.unlink()


_TEMPORARY = ".realcam-"  # beginning of the names of temporary files
_QUIET_S = 60.0


def _temporary_beside(target: Path) -> Path:
    return target.with_name(f"{_TEMPORARY}{secrets.token_hex(8)}")


def _take_name(temporary: Path, target: Path) -> None:
    """Renames without replacing. Raises FileExistsError if the name is taken, even by a dangling link."""
    try:
        os.link(temporary, target)
    except FileExistsError:
        raise
    except OSError:  # a file system without hard links
        target.touch(exist_ok=False)
        temporary.replace(target)


def _why_no_file(target: Path) -> str:
    """Returns the reason why a file cannot be written; empty if it can."""
    folder = target.parent
    if not folder.is_dir():
        return f"the folder {folder} does not exist"
    if not os.access(folder, os.W_OK | os.X_OK):
        return f"the folder {folder} is not writable"
    if not target.exists():
        return ""
    if target.is_dir():
        return "is a folder; expected the name of a file"
    if not target.is_file():
        return "is a pipe or a device; expected the name of a file"
    return "" if os.access(target, os.W_OK) else "cannot be written: Permission denied"


def _followed(path: str | os.PathLike[str]) -> Path:
    """Returns the target of a symbolic link, which need not exist; other paths are returned unchanged."""
    return Path(os.path.realpath(path)) if Path(path).is_symlink() else Path(path)


@contextmanager
def _errors_named(path: str | os.PathLike[str]) -> Iterator[None]:
    """Converts OSError to an ImageFileError that names the user's path instead of the temporary file."""
    try:
        yield
    except OSError as error:
        raise ImageFileError(f"{os.fspath(path)}: cannot be written: {error.strerror}") from None
