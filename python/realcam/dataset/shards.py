"""Files of a data set: finished samples, and shards of many samples."""

from __future__ import annotations

import dataclasses
import io
import json
import os
import tarfile
from collections.abc import Collection, Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from .._core import InputError, __version__, one_line
from ..archive import read_regular
from ..files import make_folder, write_whole
from ..job.engine import Engine
from ..job.folder import from_json
from .recipe import Recipe

RECIPE_FILE = "recipe.json"
ENGINE_FILE = "engine.json"
INDEX_FILE = "dataset.json"
_PICTURES = ("samples/*", "shard-*.tar")


class DatasetFolder:
    """Folder of a data set: finished samples as tar files of their own, and shards, tar files of many samples.

    All functions that read or write files raise InputError and ImageFileError.
    """

    def __init__(self, path: Path, recipe: Recipe) -> None:
        self.path, self.recipe = path, recipe

    @classmethod
    def open(cls, path: str | os.PathLike[str], recipe: Recipe) -> DatasetFolder:
        """Creates the folder, or opens one of the same recipe, whose count may be smaller.

        Raises InputError if the folder belongs to another recipe, or holds files that look like those of a data set but
        are from another program.
        """
        folder = cls(Path(path), recipe)
        about = {"realcam": __version__, **json.loads(json.dumps(dataclasses.asdict(recipe)))}
        file = folder.path / RECIPE_FILE
        try:
            # In this order: another process may be creating the data set, and writes its recipe first.
            first_file = folder._first_file(INDEX_FILE, *_PICTURES)
            previous = json.loads(file.read_bytes()) if os.path.lexists(file) else None
            foreign = first_file if previous is None else None
        except OSError as error:
            raise InputError(f"{error.filename}: {error.strerror}; choose a folder that can be written to") from None
        except ValueError as error:
            raise InputError(one_line(f"{file}: is damaged ({error}); choose another folder")) from None
        if foreign:
            raise InputError(
                f"{foreign}: does not belong to this data set, as {RECIPE_FILE} is missing; choose another folder"
            )
        previous = about if previous is None else previous
        if not isinstance(previous, dict) or "realcam" not in previous or type(previous.get("count")) is not int:
            raise InputError(f"{file}: does not belong to a data set of realcam; choose another folder")
        changed = [key for key in about if key != "count" and previous.get(key) != about[key]]
        if changed and folder._first_file(*_PICTURES):  # a recipe without pictures yet may be corrected
            raise InputError(
                f"{folder.path}: was made with another recipe ({', '.join(changed)}); choose another folder"
            )
        if previous["count"] > recipe.count:
            raise InputError(
                f"{folder.path}: the data set was made with {previous['count']} pictures; the count must not be smaller"
            )
        make_folder(folder.path / "samples")
        if previous["count"] < recipe.count:
            (folder.path / INDEX_FILE).unlink(missing_ok=True)  # it lists fewer pictures
        write_whole(file, json.dumps(about, indent=1).encode() + b"\n")
        return folder

    def sample_path(self, number: int) -> Path:
        """Returns the path of a finished sample that is not in a shard yet."""
        return self.path / "samples" / f"{number:06d}.tar"

    def shard_path(self, shard: int) -> Path:
        """Returns the path of a shard."""
        return self.path / f"shard-{shard:06d}.tar"

    def numbers_of(self, shard: int) -> range:
        """Returns the numbers of a shard's samples."""
        size = self.recipe.shard_size
        return range(shard * size, min((shard + 1) * size, self.recipe.count))

    @property
    def shards(self) -> range:
        """Numbers of all shards of the recipe, written or not."""
        return range((self.recipe.count + self.recipe.shard_size - 1) // self.recipe.shard_size)

    def missing(self, numbers: range) -> list[int]:
        """Returns those of the numbers whose samples are neither in a shard nor finished."""
        # Finished samples are listed first: another process may be moving them to a shard.
        not_done = set(self.not_done(numbers))
        for shard in self.shards:
            if not_done.intersection(self.numbers_of(shard)):
                not_done -= self._numbers_in(shard)
        return sorted(not_done)

    def not_done(self, numbers: Iterable[int]) -> list[int]:
        """Returns those of the numbers whose samples have no file of their own."""
        done = {path.name for path in (self.path / "samples").iterdir()}
        return [number for number in numbers if self.sample_path(number).name not in done]

    def write_sample(self, number: int, files: Mapping[str, bytes]) -> None:
        """Writes a finished sample. files: contents by their suffix, for example "mask.png"."""
        content = io.BytesIO()
        with tarfile.open(fileobj=content, mode="w") as tar:
            _add(tar, number, files)
        write_whole(self.sample_path(number), content.getvalue())

    def write_shards(self) -> bool:
        """Writes the shards whose samples are all finished. Returns True if all shards are there.

        Several processes may call it at the same time: they write the same bytes.
        """
        missing = [shard for shard in self.shards if not self.write_shard(shard)]
        return not missing

    def write_shard(self, shard: int) -> bool:
        """Writes a shard if all of its samples are finished, and removes their own files.

        A shard that is there stays, unless the count was increased since it was written. Returns False if samples are
        missing.
        """
        numbers = self.numbers_of(shard)
        in_shard = self._numbers_in(shard)
        if len(in_shard) < len(numbers):
            if not in_shard.issuperset(self.not_done(numbers)):
                return False
            try:
                content = self._shard_content(shard)
            except InputError:
                if len(self._numbers_in(shard)) < len(numbers):
                    raise
                return True  # another process has written the shard, and removed the samples
            write_whole(self.shard_path(shard), content, is_durable=True)
        for number in set(numbers).difference(self.not_done(numbers)):
            path = self.sample_path(number)
            if len(in_shard) < len(numbers) or self._samples_of(path, [number], wanted=()):
                path.unlink(missing_ok=True)
        return True

    def write_index(self) -> None:
        """Writes dataset.json: images, annotations and categories in COCO's format."""
        images: list[dict[str, Any]] = []
        annotations: list[dict[str, Any]] = []
        for shard in self.shards:
            path = self.shard_path(shard)
            for key, files in read_samples(path, wanted=("json",)):
                label = json.loads(files["json"])
                size = label["height"], label["width"]
                name = {"id": int(key), "file_name": f"{key}.png", "shard": path.name}
                images.append(name | {"width": size[1], "height": size[0]})
                for item in label["objects"]:
                    annotations.append(_annotation(self.recipe, len(annotations) + 1, int(key), item, size))
        categories = [{"id": i, "name": name} for i, name in enumerate(self.recipe.categories, start=1)]
        index = {"images": images, "annotations": annotations, "categories": categories}
        write_whole(self.path / INDEX_FILE, json.dumps(index).encode())

    def _first_file(self, *names: str) -> Path | None:
        return next((path for name in names for path in sorted(self.path.glob(name))), None)

    def check_engine(self, engine: Engine) -> None:
        """Records the engine of the first picture. Raises InputError if this process has another one."""
        write_whole(self.path / ENGINE_FILE, json.dumps(dataclasses.asdict(engine)).encode() + b"\n", replaces=False)
        stored = self.engine()
        if stored != engine:
            raise InputError(
                f"{self.path}: its pictures require {stored}; this process has {engine}, whose pictures would differ"
            )

    def engine(self) -> Engine | None:
        """Returns the engine that makes the pictures; None before the first one."""
        file = self.path / ENGINE_FILE
        if not os.path.lexists(file):
            return None
        try:
            return from_json(Engine, json.loads(read_regular(file, 1 << 12)))
        except (ValueError, TypeError, AttributeError) as error:
            if isinstance(error, InputError) and str(error).startswith(str(file)):
                raise
            raise InputError(f"{file}: is damaged; choose another folder") from None

    def _numbers_in(self, shard: int) -> set[int]:
        """Returns the numbers of the samples in a shard; none if it does not exist."""
        path = self.shard_path(shard)
        return set(self._samples_of(path, self.numbers_of(shard), wanted=())) if os.path.lexists(path) else set()

    def _shard_content(self, shard: int) -> bytes:
        """Returns the content of a shard. Its samples are finished, or in its present file."""
        path, numbers = self.shard_path(shard), self.numbers_of(shard)
        samples = self._samples_of(path, numbers) if os.path.lexists(path) else {}
        content = io.BytesIO()
        with tarfile.open(fileobj=content, mode="w") as tar:
            for number in numbers:
                if number not in samples:
                    samples |= self._samples_of(self.sample_path(number), [number])
                if number not in samples:
                    raise InputError(f"{self.sample_path(number)}: is empty; remove it, and it is made again")
                _add(tar, number, samples.pop(number))
        return content.getvalue()

    def _samples_of(
        self, path: Path, numbers: Iterable[int], wanted: Collection[str] | None = None
    ) -> dict[int, dict[str, bytes]]:
        """Reads the samples of a tar file, by their numbers. wanted: see read_samples.

        Raises InputError unless it holds only pictures of these numbers with their labels.
        """
        keys = {f"{number:06d}": number for number in numbers}
        samples: dict[int, dict[str, bytes]] = {}
        for key, files in read_samples(path, wanted):
            if key not in keys or not {"png", "json"} <= files.keys():
                raise InputError(f"{path}: holds {key!a:.40}, and no picture of this data set; choose another folder")
            samples[keys[key]] = files
        return samples


def _add(tar: tarfile.TarFile, number: int, files: Mapping[str, bytes]) -> None:
    """Adds files without times and owners, so that the same pictures give the same bytes."""
    for name, content in files.items():
        entry = tarfile.TarInfo(f"{number:06d}.{name}")
        entry.size = len(content)
        tar.addfile(entry, io.BytesIO(content))


def read_samples(path: Path, wanted: Collection[str] | None = None) -> Iterator[tuple[str, dict[str, bytes]]]:
    """Yields the samples of a tar file: key, and files by their suffix after the first dot. Raises InputError.

    wanted: suffixes of the files that are read; the contents of others are empty. None: all.
    """
    key = ""
    files: dict[str, bytes] = {}
    try:
        with tarfile.open(path) as tar:
            for entry in tar:
                if not entry.isfile():
                    continue
                entry_key, _, suffix = entry.name.partition(".")
                if entry_key != key and files:
                    yield key, files
                    files = {}
                key = entry_key
                content = tar.extractfile(entry) if wanted is None or suffix in wanted else None
                files[suffix] = content.read() if content else b""
    except (tarfile.TarError, OSError, EOFError) as error:
        raise InputError(one_line(f"{path}: cannot be read ({error}); remove it, and it is made again")) from None
    if files:
        yield key, files


def _annotation(recipe: Recipe, number: int, image: int, item: dict[str, Any], size: tuple[int, int]) -> dict[str, Any]:
    """Returns COCO's annotation of an object. item: the object's label. size: rows and columns of the picture."""
    return {
        "id": number,
        "image_id": image,
        "category_id": recipe.categories.index(item["category"]) + 1,
        "bbox": item["box"],
        "area": item["area"],
        "segmentation": {"counts": item["run_lengths"], "size": list(size)},
        "iscrowd": 0,
    }
