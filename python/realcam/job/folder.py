"""A job's folder: what is to be photographed, and what is done of it."""

from __future__ import annotations

import io
import json
import os
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from .._core import InputError
from ..files import write_whole
from ..film_part import FilmPart
from .engine import Engine
from .units import Round, ShotRecord, Unit

FORMAT = 4
JOB_FILE = "job.json"


class DamagedFileError(InputError):
    """A file that a job has written is damaged or missing. It is removed, and so is done again."""


@dataclass(frozen=True)
class JobFolder:
    """What the file job.json says; it is written last, so that a folder that has one is whole.

    device: of the workers, "cpu" or "cuda". probes: of each scene by its digest, a hash of some samples.
    """

    path: Path
    engine: Engine
    device: str
    shots: list[ShotRecord]
    probes: dict[str, str]

    @classmethod
    def open(cls, path: str | os.PathLike[str]) -> JobFolder:
        """Raises InputError for what is no job's folder, or that of another format or version."""
        file = Path(path) / JOB_FILE
        try:
            about = json.loads(file.read_bytes())
        except FileNotFoundError:
            why = f"it has no {JOB_FILE}" if Path(path).is_dir() else "there is no such folder"
            raise InputError(f"{os.fspath(path)}: this is no job's folder: {why}") from None
        except (OSError, ValueError) as error:
            raise InputError(f"{file}: this cannot be read: {error}") from None
        try:
            if about["format"] != FORMAT:
                raise InputError(f"{file}: its format is {about['format']!r:.20}; this realcam reads {FORMAT}")
            engine = Engine(**about["engine"])
            engine.check_version(os.fspath(path))
            shots = [ShotRecord.read(entry) for entry in about["shots"]]
            return cls(Path(path), engine, str(about["device"]), shots, dict(about["probes"]))
        except (KeyError, TypeError, ValueError, AttributeError) as error:
            if isinstance(error, InputError):
                raise
            raise InputError(f"{file}: this is damaged; what realcam job make has written is wanted") from None

    def write(self) -> None:
        """Raises ImageFileError."""
        about = {
            "format": FORMAT,
            "engine": asdict(self.engine),
            "device": self.device,
            "shots": [asdict(shot) for shot in self.shots],
            "probes": self.probes,
        }
        write_whole(self.path / JOB_FILE, json.dumps(about, indent=1).encode() + b"\n", is_durable=True)

    def unit_path(self, unit: Unit) -> Path:
        return self.path / "units" / unit.name

    def round_path(self, shot: int, number: int) -> Path:
        return self.path / "rounds" / f"{shot:05d}" / f"{number:03d}.npz"

    def missing(self, shot: int, round_: Round) -> list[Unit]:
        """Units of a round that are not done, in their order."""
        here = self.path / "units" / f"{shot:05d}"
        done = {path.name for path in here.iterdir()} if here.is_dir() else set()
        return [unit for unit in self.shots[shot].units(shot, round_) if unit.file_name not in done]

    def rounds(self, shot: int) -> tuple[list[Round], bool]:
        """Those that are known, and whether there will be no other."""
        spp = self.shots[shot].spp
        if spp is not None:
            return [Round(0, 0, spp)], True
        known: list[Round] = []
        while (path := self.round_path(shot, len(known))).exists():
            try:
                round_ = read_round(path)
            except DamagedFileError:
                break
            if round_ is None:
                return known, True
            known.append(round_)
        return known, False

    def read(self, unit: Unit) -> FilmPart:
        """What a unit has collected. Raises DamagedFileError."""
        path = self.unit_path(unit)
        try:
            part = FilmPart.load(path)
            if (part.region, part.first, part.spp) != (unit.region, unit.first, unit.spp):
                raise InputError(f"{path}: this is another part of the film")
            return part
        except InputError as error:
            path.unlink(missing_ok=True)
            raise DamagedFileError(f"{error}; realcam job work {self.path} does it again") from None


def write_round(path: Path, round_: Round | None) -> None:
    """None: the shot has no further one. Raises ImageFileError."""
    content = io.BytesIO()
    if round_ is None:
        np.savez(content, end=True)
    else:
        counts: dict[str, Any] = {} if round_.counts is None else {"counts": round_.counts}
        numbers = [round_.number, round_.samples, round_.spp, round_.is_of_layers, round_.traces_lights]
        np.savez_compressed(content, numbers=numbers, estimate=[round_.taken, round_.left], **counts)
    path.parent.mkdir(parents=True, exist_ok=True)
    write_whole(path, content.getvalue(), is_durable=True)


def read_round(path: Path) -> Round | None:
    """None: the shot has no further one. Raises DamagedFileError."""
    try:
        with np.load(path, allow_pickle=False) as arrays:
            if "end" in arrays:
                return None
            number, samples, spp, is_of_layers, traces_lights = (int(value) for value in arrays["numbers"])
            taken, left = (float(value) for value in arrays["estimate"])
            counts = arrays.get("counts")
            return Round(number, samples, spp, counts, bool(is_of_layers), bool(traces_lights), taken, left)
    except Exception as error:  # numpy and zipfile have many words for what is damaged
        path.unlink(missing_ok=True)
        raise DamagedFileError(f"{path}: this was damaged: {error}") from None
