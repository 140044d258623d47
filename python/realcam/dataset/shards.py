"""Files of a data set: finished samples, and shards of many samples."""

from __future__ import annotations

import dataclasses
import io
import json
import os
import tarfile
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from .._core import InputError, __version__, one_line
from ..files import make_folder, write_whole
from .recipe import Recipe

RECIPE_FILE = "recipe.json"
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
            previous = json.loads(file.read_bytes()) if file.exists() else None
            foreign = folder._first_file(RECIPE_FILE, INDEX_FILE, *_PICTURES) if previous is None else None
        except OSError as error:
            raise InputError(f"{error.filename}: {error.strerror}; choose a folder that can be written to") from None
        except ValueError as error:
            raise InputError(one_line(f"{file}: this is damaged ({error}); choose another folder")) from None
        if foreign:
            raise InputError(f"{foreign}: is not of this data set, as {RECIPE_FILE} is missing; choose another folder")
        previous = about if previous is None else previous
        if not isinstance(previous, dict) or "realcam" not in previous or type(previous.get("count")) is not int:
            raise InputError(f"{file}: is not of a data set of realcam; choose another folder")
        changed = [key for key in about if key != "count" and previous.get(key) != about[key]]
        if changed and folder._first_file(*_PICTURES):  # a recipe without pictures yet may be corrected
            raise InputError(f"{folder.path}: made by another recipe ({', '.join(changed)}); choose another folder")
        if previous["count"] > recipe.count:
            raise InputError(
                f"{folder.path}: the data set was made with {previous['count']} pictures; the count may not be smaller"
            )
        make_folder(folder.path / "samples")
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

    def missing(self) -> list[int]:
        """Returns the numbers of samples that are neither in a shard nor finished.

        Unpacks a shard that has become incomplete because the count was increased.
        """
        numbers_missing: list[int] = []
        for shard in self.shards:
            numbers = self.numbers_of(shard)
            in_shard = self._samples_in(shard)
            if 0 < len(in_shard) < len(numbers):  # the count was increased since the shard was written
                for number, files in in_shard.items():
                    self.write_sample(number, files)
                self.shard_path(shard).unlink()
                in_shard = {}
            if not in_shard:
                numbers_missing += self.not_done(numbers)
        return numbers_missing

    def not_done(self, numbers: Iterable[int]) -> list[int]:
        """Returns those of the numbers whose samples are not finished. None of them may be in a shard."""
        done = {path.name for path in (self.path / "samples").iterdir()}
        return [number for number in numbers if self.sample_path(number).name not in done]

    def write_sample(self, number: int, files: Mapping[str, bytes]) -> None:
        """Writes a finished sample. files: contents by their suffix, for example "mask.png"."""
        content = io.BytesIO()
        with tarfile.open(fileobj=content, mode="w") as tar:
            _add(tar, number, files)
        write_whole(self.sample_path(number), content.getvalue())

    def write_shard(self, shard: int) -> None:
        """Writes a shard of finished samples and removes their own files. Does nothing if the shard exists."""
        if self.shard_path(shard).exists():
            return
        numbers = self.numbers_of(shard)
        content = io.BytesIO()
        with tarfile.open(fileobj=content, mode="w") as tar:
            for number in numbers:
                for files in self._samples_of(self.sample_path(number), [number]).values():
                    _add(tar, number, files)
        write_whole(self.shard_path(shard), content.getvalue(), is_durable=True)
        for number in numbers:
            self.sample_path(number).unlink(missing_ok=True)

    def write_index(self) -> None:
        """Writes dataset.json: images, annotations and categories in COCO's format."""
        images: list[dict[str, Any]] = []
        annotations: list[dict[str, Any]] = []
        for shard in self.shards:
            path = self.shard_path(shard)
            for key, files in read_samples(path):
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

    def _samples_in(self, shard: int) -> dict[int, dict[str, bytes]]:
        """Returns the samples of a shard by their numbers; none if it does not exist."""
        path = self.shard_path(shard)
        return self._samples_of(path, self.numbers_of(shard)) if os.path.lexists(path) else {}

    def _samples_of(self, path: Path, numbers: Iterable[int]) -> dict[int, dict[str, bytes]]:
        """Reads the samples of a tar file, by their numbers.

        Raises InputError unless it holds only pictures of these numbers with their labels.
        """
        keys = {f"{number:06d}": number for number in numbers}
        samples: dict[int, dict[str, bytes]] = {}
        for key, files in read_samples(path):
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


def read_samples(path: Path) -> Iterator[tuple[str, dict[str, bytes]]]:
    """Yields the samples of a tar file: key, and files by their suffix after the first dot. Raises InputError."""
    key = ""
    files: dict[str, bytes] = {}
    try:
        with tarfile.open(path) as tar:
            for entry in tar:
                content = tar.extractfile(entry)
                if content is None:
                    continue
                entry_key, _, suffix = entry.name.partition(".")
                if entry_key != key and files:
                    yield key, files
                    files = {}
                key = entry_key
                files[suffix] = content.read()
    except (tarfile.TarError, OSError, EOFError) as error:
        raise InputError(one_line(f"{path}: this cannot be read ({error}); removed, it is made again")) from None
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
