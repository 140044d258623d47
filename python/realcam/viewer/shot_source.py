"""What a bench was opened with: a shot file, or a scene file."""

from __future__ import annotations

import tempfile
from dataclasses import dataclass
from pathlib import Path

import tomlkit

from .._core import RealcamError
from ..shot import Shot


@dataclass(frozen=True)
class ShotSource:
    """text: of a shot file. folder: what paths in it are relative to."""

    name: str
    text: str
    folder: Path

    @classmethod
    def opened(cls, path: Path, device: str) -> tuple[ShotSource, Shot]:
        """A .toml as a shot file, all else as a scene, as `realcam render` does. Raises what Shot.load raises."""
        folder = path.absolute().parent
        if path.suffix == ".toml":
            shot = Shot.load(path, device=device)
            return cls(path.name, path.read_text(encoding="utf-8"), folder), shot
        with tempfile.TemporaryDirectory() as elsewhere:
            only = Path(elsewhere) / f"{path.name}.toml"
            only.write_text(tomlkit.dumps({"format": 1, "scene": str(path.absolute())}), encoding="utf-8")
            try:
                shot = Shot.load(only, device=device)
            except RealcamError as error:  # which may name the file that nobody knows
                raise type(error)(str(error).replace(f"{only}:2: ", "").replace(str(only), str(path))) from None
        return cls(path.name, tomlkit.dumps({"format": 1, "scene": path.name}), folder), shot
