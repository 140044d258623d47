"""Reading a data set."""

from __future__ import annotations

import io
import json
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from .._core import InputError, one_line
from .pictures import codes_of
from .shards import read_samples


def samples(folder: str | os.PathLike[str], shards: slice = slice(None)) -> Iterator[dict[str, Any]]:
    """Yields the pictures of a data set with their labels, shard by shard.

    Each has "__key__", a string; "png", (H, W, 3) uint8; "json", a mapping; and, depending on the recipe's labels,
    "mask.png", (H, W) uint8, object ids; "depth.npy", (H, W) float32, metres; "motion.npy" and "flow.npy", (H, W, 2)
    float32, pixels; "next.png", like "png"; "flow_visible.png", (H, W) uint8, 255 where the point is visible in the
    next picture and 0 elsewhere. shards: selects shards of the folder; slice(worker, None, workers) divides them among
    workers.

    Raises InputError.
    """
    paths = sorted(Path(folder).glob("shard-*.tar"))
    if not paths:
        raise InputError(f"{os.fspath(folder)}: this has no shards; realcam dataset makes some")
    for path in paths[shards]:
        for key, files in read_samples(path):
            try:
                yield {"__key__": key, **{name: _decoded(name, content) for name, content in files.items()}}
            except ValueError as error:
                raise InputError(one_line(f"{path}: {key} cannot be read: {error}")) from None


def _decoded(name: str, content: bytes) -> Any:
    if name.endswith("png"):
        return codes_of(content)
    if name.endswith("npy"):
        return np.load(io.BytesIO(content), allow_pickle=False)
    return json.loads(content) if name.endswith("json") else content
