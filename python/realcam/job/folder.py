"""A job's folder: the shots, and the samples rendered so far. All files are untrusted data and are validated."""

from __future__ import annotations

import json
import math
import os
import re
import secrets
from collections.abc import Callable
from dataclasses import asdict, dataclass
from dataclasses import fields as dataclass_fields
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from .._core import InputError
from ..archive import owner_in_file, packed, read_archive, read_regular, write_archive
from ..files import write_whole
from ..film_part import FilmPart
from ..settings import MAX_SPP
from .engine import Engine
from .units import MAX_SIDE, Digest, Round, ShotRecord, Unit, checked_tile

FORMAT = 5
JOB_FILE = "job.json"
_FOLDERS = ("shots", "scenes", "units", "rounds")
_MAX_BYTES = 1 << 26  # of job.json


T = TypeVar("T")


class DamagedFileError(InputError):
    """A file written by the job is damaged or missing. The file was removed, and its samples must be rendered again."""


@dataclass(frozen=True)
class JobFolder:
    """The content of job.json, which is written last: a folder that has it is complete.

    path: of the folder. id: random, repeated in each file of samples. device: device of all processes, "cpu" or "cuda".
    probes: for each scene's digest, a hash of some samples.
    """

    path: Path
    id: Digest
    engine: Engine
    device: str
    shots: list[ShotRecord]
    probes: dict[str, str]

    @classmethod
    def open(cls, path: str | os.PathLike[str]) -> JobFolder:
        """Reads a job's folder. Raises InputError if it is none, or has another format or version."""
        folder, file = Path(path), Path(path) / JOB_FILE
        if not os.path.lexists(file):
            why = f"it has no {JOB_FILE}" if folder.is_dir() else "there is no such folder"
            raise InputError(f"{folder} is not the folder of a job: {why}")
        content = read_regular(file, _MAX_BYTES)
        try:
            fields = json.loads(content)
            if fields["format"] != FORMAT:
                raise InputError(f"its format is {fields['format']!r:.20}; this realcam reads {FORMAT}")
            engine = from_json(Engine, fields["engine"])
            engine.check_version(str(folder))
            shots, probes = [from_json(ShotRecord, entry) for entry in fields["shots"]], dict(fields["probes"])
            more = {"path": folder, "engine": engine, "shots": shots, "probes": probes}
            made = from_json(cls, {"id": fields["id"], "device": fields["device"]}, **more)
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
    def new(cls, path: Path, engine: Engine, device: str, shots: list[ShotRecord], probes: dict[str, str]) -> JobFolder:
        """Writes job.json into an existing folder. Raises ImageFileError."""
        folder = cls(path, secrets.token_hex(32), engine, device, shots, probes)
        content = {"format": FORMAT, **{key: value for key, value in asdict(folder).items() if key != "path"}}
        write_whole(path / JOB_FILE, json.dumps(content, indent=1).encode() + b"\n", is_durable=True)
        return folder

    def directory(self, *names: str) -> Path:
        """A directory of the job. Raises InputError if it, or one of its parents in the job, is a link or a file."""
        paths = [self.path / name for name in names[:1] or _FOLDERS] + [self.path.joinpath(*names)]
        for path in paths:
            if os.path.lexists(path) and (not path.is_dir() or (path.is_symlink() and path != self.path)):
                raise InputError(f"{path}: expected a directory of the job; found a link or a file")
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
        folder, done, damaged = self.directory("units", f"{shot:05d}"), dict[str, float](), list[str]()
        if folder.is_dir():
            with os.scandir(folder) as entries:
                for entry in entries:
                    if entry.name.endswith(".npz") and not entry.name.startswith("."):
                        is_own = entry.is_file(follow_symlinks=False) and owner_in_file(entry.path) == self.id
                        if is_own:
                            done[entry.name] = entry.stat().st_mtime
                        else:
                            damaged.append(f"{shot:05d}/{entry.name}")
        return done, sorted(damaged)

    def missing(self, shot: int, round_: Round) -> list[Unit]:
        """Returns the units of a round that have not been written."""
        done, _ = self.done(shot)
        return [unit for unit in self.shots[shot].units(shot, round_) if unit.file_name not in done]

    def unit_path(self, unit: Unit) -> Path:
        """Path of a unit's file. Raises InputError as `directory` does."""
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
            raise DamagedFileError(f"{error}; run realcam job work {self.path} to render its samples again") from None

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
        fields, arrays = (None, {}) if round_ is None else (dict(vars(round_)), {"counts": round_.counts})
        if fields is not None:
            del fields["counts"]
        path = self._round_path(shot, number)
        path.parent.mkdir(parents=True, exist_ok=True)
        stored = {name: array for name, array in arrays.items() if array is not None}
        write_archive(path, packed(fields, stored, owner=self.id, is_compressed=True))

    def _read_round(self, path: Path, shot: int, known: list[Round]) -> Round | None:
        """Reads the round after the known ones; None: there is no further one. Raises InputError if it is invalid."""
        width, height = self.shots[shot].resolution
        fields, arrays = read_archive(path, limit_bytes=4 * width * height, owner=self.id)
        if fields is None:
            return None
        counts = arrays.get("counts")
        round_ = from_json(Round, fields, counts=counts)
        taken = 0 if round_.is_of_layers else sum(before.spp for before in known)
        is_valid = (round_.number, round_.samples) == (len(known), taken) and taken + round_.spp <= MAX_SPP
        if counts is not None:
            is_valid &= counts.shape == (height, width) and counts.dtype == np.uint32 and counts.max() == round_.spp
        if not is_valid or (counts is None) != (not known or round_.is_of_layers):
            raise InputError(f"{path}: is not the file of round {len(known)}")
        return round_

    def _round_path(self, shot: int, number: int) -> Path:
        return self.directory("rounds", f"{shot:05d}") / f"{number:03d}.npz"


def check_names(names: list[str]) -> None:
    """Raises InputError unless each name is distinct and can be the name of a picture's file."""
    if not names:
        raise InputError("a job needs at least one shot")
    for name in names:
        if not name or name.startswith(".") or "/" in name or "\\" in name or not name.isprintable() or len(name) > 200:
            raise InputError(f"a shot's name must be valid as the name of its picture's file; it is {name[:40]!r}")
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


# Checks of JSON values, by the annotations of dataclass fields.
_VALID: dict[str, Callable[[Any], bool]] = {
    "str": lambda value: isinstance(value, str) and len(value) <= 200 and value.isprintable(),
    "Digest": lambda value: isinstance(value, str) and re.fullmatch("[0-9a-f]{64}", value) is not None,
    "bool": lambda value: isinstance(value, bool),
    "float": lambda value: isinstance(value, float | int) and 0 <= value < math.inf,
    "int": lambda value: type(value) is int and 0 <= value <= MAX_SPP,
    "int | None": lambda value: value is None or (type(value) is int and 1 <= value <= MAX_SPP),
    "Size": lambda value: len(value) == 2 and all(type(n) is int and 1 <= n <= MAX_SIDE for n in value),
}


def from_json(kind: type[T], entry: Any, **more: Any) -> T:
    """Makes a dataclass from a JSON object, whose keys must be exactly the fields that are not in `more`.

    more: values of the other fields. Raises InputError for other keys and for invalid values.
    """
    types = {field.name: field.type for field in dataclass_fields(kind) if field.name not in more}  # type: ignore[arg-type]
    if not isinstance(entry, dict) or entry.keys() != types.keys():
        raise InputError(f"expected the keys {', '.join(types)}")
    for key, value in entry.items():
        if not _VALID[str(types[key])](value):
            raise InputError(f"{key} = {value!r:.40} is not valid")
    return kind(**{key: tuple(value) if isinstance(value, list) else value for key, value in entry.items()}, **more)
