"""Files that a stage names: pictures beside it, and those inside a .usdz."""

from __future__ import annotations

import hashlib
import tempfile
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from pxr import Ar, Sdf

from .stage import OpenStage

MAX_PACKED_BYTES = 1 << 30  # of a file inside a .usdz


@dataclass(frozen=True)
class Asset:
    """A file that a stage names. name: as the stage names it. path: the file; "" if there is none. data: the bytes of a
    PNG or JPEG inside a .usdz, which has no path."""

    name: str
    path: str = ""
    data: bytes = b""

    @property
    def exists(self) -> bool:
        return bool(self.path or self.data)


def asset_of(opened: OpenStage, value: Sdf.AssetPath) -> Asset:
    """Returns the file of an asset path. As for glTF, a file that does not exist is looked up by its name beside the
    stage. Files of other formats than PNG and JPEG inside a .usdz are extracted."""
    name, resolved = value.path, value.resolvedPath
    if resolved and Ar.IsPackageRelativePath(resolved):
        data = _packed_data(resolved)
        if data.startswith((b"\x89PNG", b"\xff\xd8")) or not data:
            return Asset(name, data=data)
        return Asset(name, str(extracted(Path(name).name, data)))
    beside = Path(opened.path).absolute().parent / Path(name.replace("\\", "/")).name
    return Asset(name, next((str(path) for path in (resolved, beside) if path and Path(path).is_file()), ""))


def extracted(name: str, data: bytes) -> Path:
    """Writes a file of a .usdz into a temporary folder, and returns its path. It exists until the program ends: lenses
    are read after the stage, and a film's frames compare the contents of all inputs."""
    path = Path(_folder().name, hashlib.sha256(data).hexdigest(), name)
    if not path.is_file():
        path.parent.mkdir(exist_ok=True)
        with tempfile.NamedTemporaryFile(dir=path.parent, delete=False) as file:
            file.write(data)
        Path(file.name).replace(path)
    return path


@cache
def _folder() -> tempfile.TemporaryDirectory[str]:
    return tempfile.TemporaryDirectory(prefix="realcam-")


def _packed_data(path: str) -> bytes:
    """Returns the bytes of a file inside a .usdz; empty if it cannot be read or is larger than MAX_PACKED_BYTES."""
    opened = Ar.GetResolver().OpenAsset(Ar.ResolvedPath(path))
    return bytes(opened.GetBuffer()) if opened and opened.GetSize() <= MAX_PACKED_BYTES else b""
