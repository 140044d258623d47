"""A job's folder: the shots, and the samples taken so far. Everything in it is read as data and checked."""

from __future__ import annotations

import json
import math
import os
import re
import secrets
from collections.abc import Callable
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from .._core import InputError
from ..archive import owner_in_file, packed, read_archive, read_regular, write_archive
from ..files import write_whole
from ..film_part import FilmPart
from .engine import Engine
from .units import LONGEST_SIDE, Digest, Round, ShotRecord, Unit, checked_tile

FORMAT = 5
JOB_FILE = "job.json"
MOST_SPP = 1 << 24
_FOLDERS = ("shots", "scenes", "units", "rounds")
_MOST_BYTES = 1 << 26  # of job.json


T = TypeVar("T")


class DamagedFileError(InputError):
    """A file written by the job is damaged or missing. The file is removed, and its samples are taken again."""


@dataclass(frozen=True)
class JobFolder:
    """The content of job.json, which is written last: a folder that has it is complete.

    id: random, repeated in each file of samples. device: device of all processes, "cpu" or "cuda". probes: for each
    scene's digest, a hash of some samples.
    """

    path: Path
    id: Digest
    engine: Engine
    device: str
    shots: list[ShotRecord]
    probes: dict[str, str]

    @classmethod
    def open(cls, path: str | os.PathLike[str]) -> JobFolder:
        """Raises InputError if this is not a job's folder, or one of another format or version."""
        folder, file = Path(path), Path(path) / JOB_FILE
        if not os.path.lexists(file):
            why = f"it has no {JOB_FILE}" if folder.is_dir() else "there is no such folder"
            raise InputError(f"{folder}: this is no job's folder: {why}")
        content = read_regular(file, _MOST_BYTES)
        try:
            about = json.loads(content)
            if about["format"] != FORMAT:
                raise InputError(f"its format is {about['format']!r:.20}; this realcam reads {FORMAT}")
            engine = _from_json(Engine, about["engine"])
            engine.check_version(str(folder))
            shots, probes = [_from_json(ShotRecord, entry) for entry in about["shots"]], dict(about["probes"])
            more = {"path": folder, "engine": engine, "shots": shots, "probes": probes}
            made = _from_json(cls, {"id": about["id"], "device": about["device"]}, **more)
            check_names([shot.name for shot in shots])
            for shot in made.shots:
                shot.check_count()
                if checked_tile(shot.tile) != shot.tile or shot.scene not in made.probes:
                    raise InputError(f'shot "{shot.name}": the tile or the scene is not valid')
        except (KeyError, TypeError, ValueError, AttributeError, RecursionError) as error:
            if str(error).startswith(str(folder)):
                raise
            is_ours = isinstance(error, InputError)
            raise InputError(f"{file}: {error if is_ours else 'this is damaged'}") from None
        made.directory()
        return made

    @classmethod
    def new(cls, path: Path, *of: Any) -> JobFolder:
        """Writes job.json. of: values of the fields after the id. Raises ImageFileError."""
        folder = cls(path, secrets.token_hex(32), *of)
        about = {"format": FORMAT, **{key: value for key, value in asdict(folder).items() if key != "path"}}
        write_whole(path / JOB_FILE, json.dumps(about, indent=1).encode() + b"\n", is_durable=True)
        return folder

    def directory(self, *names: str) -> Path:
        """A directory of the job. Raises InputError if it, or one of its parents in the job, is a link or a file."""
        paths = [self.path / name for name in names[:1] or _FOLDERS] + [self.path.joinpath(*names)]
        for path in paths:
            if os.path.lexists(path) and (not path.is_dir() or (path.is_symlink() and path != self.path)):
                raise InputError(f"{path}: a directory of the job is expected, not a link or a file")
        return paths[-1]

    def is_current(self) -> bool:
        """False if the job was deleted or replaced since it was opened."""
        try:
            with (self.path / JOB_FILE).open("rb") as file:
                return self.id.encode() in file.read(200)
        except OSError:
            return False

    def done(self, shot: int) -> tuple[dict[str, float], list[str]]:
        """Returns the finished units of a shot with the times at which they were written, and the names of files that
        are truncated or belong to another job. `read` checks the content of a file."""
        here, done, damaged = self.directory("units", f"{shot:05d}"), dict[str, float](), list[str]()
        if here.is_dir():
            with os.scandir(here) as entries:
                for entry in entries:
                    if entry.name.endswith(".npz") and not entry.name.startswith("."):
                        is_own = entry.is_file(follow_symlinks=False) and owner_in_file(entry.path) == self.id
                        if is_own:
                            done[entry.name] = entry.stat().st_mtime
                        else:
                            damaged.append(f"{shot:05d}/{entry.name}")
        return done, sorted(damaged)

    def missing(self, shot: int, round_: Round) -> list[Unit]:
        done, _ = self.done(shot)
        return [unit for unit in self.shots[shot].units(shot, round_) if unit.file_name not in done]

    def unit_path(self, unit: Unit) -> Path:
        return self.directory("units", f"{unit.shot:05d}") / unit.file_name

    def read(self, unit: Unit, round_: Round) -> FilmPart:
        """The sums of a unit. Raises DamagedFileError unless they are those of this unit, and complete and finite."""
        path, record = self.unit_path(unit), self.shots[unit.shot]
        width, height = record.resolution
        try:
            part = FilmPart.load(path, owner=self.id, limit_bytes=1024 * width * height + (1 << 20))
            if not _is_whole(part, unit, record, round_):
                raise InputError(f"{path}: these are not the samples of this unit")
            return part
        except InputError as error:
            self.discard(str(unit))
            raise DamagedFileError(f"{error}; realcam job work {self.path} takes its samples again") from None

    def discard(self, unit: str) -> None:
        """Removes a unit's file (or a link with its name)."""
        shot, _, name = unit.partition("/")
        (self.directory("units", shot) / name).unlink(missing_ok=True)

    def rounds(self, shot: int) -> tuple[list[Round], bool]:
        """Returns the known rounds of a shot, and true if there are no further ones."""
        spp = self.shots[shot].spp
        if spp is not None:
            return [Round(0, 0, spp)], True
        known: list[Round] = []
        while os.path.lexists(path := self._round_path(shot, len(known))):
            try:
                round_ = self._read_round(path, shot, known)
            except InputError:
                path.unlink()  # the round is computed again
                break
            if round_ is None:
                return known, True
            known.append(round_)
        return known, False

    def write_round(self, shot: int, number: int, round_: Round | None) -> None:
        """Writes a round; None records that the shot has no further rounds. Raises ImageFileError."""
        about, arrays = (None, {}) if round_ is None else (dict(vars(round_)), {"counts": round_.counts})
        if about is not None:
            del about["counts"]
        path = self._round_path(shot, number)
        path.parent.mkdir(parents=True, exist_ok=True)
        kept = {name: array for name, array in arrays.items() if array is not None}
        write_archive(path, packed(about, kept, owner=self.id, is_compressed=True))

    def _read_round(self, path: Path, shot: int, known: list[Round]) -> Round | None:
        width, height = self.shots[shot].resolution
        about, arrays = read_archive(path, limit_bytes=4 * width * height, owner=self.id)
        if about is None:
            return None
        counts = arrays.get("counts")
        round_ = _from_json(Round, about, counts=counts)
        taken = 0 if round_.is_of_layers else sum(before.spp for before in known)
        is_valid = (round_.number, round_.samples) == (len(known), taken) and taken + round_.spp <= MOST_SPP
        if counts is not None:
            is_valid &= counts.shape == (height, width) and counts.dtype == np.uint32 and counts.max() == round_.spp
        if not is_valid or (counts is None) != (not known or round_.is_of_layers):
            raise InputError(f"{path}: this is not round {len(known)}")
        return round_

    def _round_path(self, shot: int, number: int) -> Path:
        return self.directory("rounds", f"{shot:05d}") / f"{number:03d}.npz"


def check_names(names: list[str]) -> None:
    """Raises InputError unless each name is distinct and can be the name of a picture's file."""
    if not names:
        raise InputError("a job wants one shot at least")
    for name in names:
        if not name or name.startswith(".") or "/" in name or "\\" in name or not name.isprintable() or len(name) > 200:
            raise InputError(f"a shot's name is that of its picture, a file; it is {name[:40]!r}")
    if len(set(names)) != len(names):
        raise InputError("two shots have the same name")


def _is_whole(part: FilmPart, unit: Unit, record: ShotRecord, round_: Round) -> bool:
    """True if a part has the samples, fields and shapes of its unit, and all sums are finite."""
    width, height = record.resolution
    counts = round_.counts_of(unit)
    wants_layers = unit.kind == "layers" or (unit.kind == "pixels" and record.has_layers and record.spp is not None)
    if (part.region, part.first, part.spp) != (unit.region, unit.first, unit.spp):
        return False
    if (part.pixels is not None, part.layers is not None) != (unit.kind == "pixels", wants_layers):
        return False
    if bool(part.splats) != (unit.kind == "light"):
        return False
    if any(light["sums"].shape[1:] != (height, width, 3) for light in part.splats):
        return False
    if part.pixels is not None and not (part.pixels["samples"] == (unit.spp if counts is None else counts)).all():
        return False
    sums = [array for array in (part.pixels, part.layers) if array is not None]
    return all(np.isfinite(array[name]).all() for array in sums for name in array.dtype.names or ())


_VALID: dict[str, Callable[[Any], bool]] = {
    "str": lambda value: isinstance(value, str) and len(value) <= 200 and value.isprintable(),
    "Digest": lambda value: isinstance(value, str) and re.fullmatch("[0-9a-f]{64}", value) is not None,
    "bool": lambda value: isinstance(value, bool),
    "float": lambda value: isinstance(value, float | int) and 0 <= value < math.inf,
    "int": lambda value: type(value) is int and 0 <= value <= MOST_SPP,
    "int | None": lambda value: value is None or (type(value) is int and 1 <= value <= MOST_SPP),
    "Size": lambda value: len(value) == 2 and all(type(n) is int and 1 <= n <= LONGEST_SIDE for n in value),
}


def _from_json(kind: type[T], entry: Any, **more: Any) -> T:
    """A dataclass whose fields, without those in `more`, are exactly the keys of a JSON object, with valid values."""
    types = {field.name: field.type for field in fields(kind) if field.name not in more}  # type: ignore[arg-type]
    if not isinstance(entry, dict) or entry.keys() != types.keys():
        raise InputError(f"the keys {', '.join(types)} are expected")
    for key, value in entry.items():
        if not _VALID[str(types[key])](value):
            raise InputError(f"{key} = {value!r:.40} is not valid")
    return kind(**{key: tuple(value) if isinstance(value, list) else value for key, value in entry.items()}, **more)
