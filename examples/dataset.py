"""Reads a data set of `realcam dataset` as PyTorch's DataLoader does, or without PyTorch where that is not installed.

    realcam dataset recipe.toml -o pictures --count 20
    python examples/dataset.py pictures --batch 4 --workers 2

Each batch has pictures, depths and masks of one size. Workers share the shards: each reads every so-many-th.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator

import numpy as np
from realcam.dataset import samples

try:
    from torch.utils.data import DataLoader, IterableDataset, get_worker_info
except ImportError:
    DataLoader = get_worker_info = None
    IterableDataset = object


class Pictures(IterableDataset):
    """(3, H, W) float32 from 0 to 1, depth in metres, and ids of objects."""

    def __init__(self, folder: str) -> None:
        self.folder = folder

    def __iter__(self) -> Iterator[tuple[np.ndarray, np.ndarray, np.ndarray]]:
        info = get_worker_info() if get_worker_info else None
        shards = slice(info.id, None, info.num_workers) if info else slice(None)
        for sample in samples(self.folder, shards):
            picture = np.ascontiguousarray(sample["png"].transpose(2, 0, 1), np.float32) / 255
            yield picture, sample["depth.npy"], sample["mask.png"].astype(np.int64)


def batches(pictures: Pictures, size: int) -> Iterator[tuple[np.ndarray, ...]]:
    """Yields batches as a DataLoader does, as NumPy arrays."""
    batch: list[tuple[np.ndarray, ...]] = []
    for sample in pictures:
        batch.append(sample)
        if len(batch) == size:
            yield tuple(map(np.stack, zip(*batch, strict=True)))
            batch = []
    if batch:
        yield tuple(map(np.stack, zip(*batch, strict=True)))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder")
    parser.add_argument("--batch", type=int, default=4)
    parser.add_argument("--workers", type=int, default=0)
    wanted = parser.parse_args()
    pictures = Pictures(wanted.folder)
    if DataLoader:
        loader = DataLoader(pictures, batch_size=wanted.batch, num_workers=wanted.workers)
    else:
        print("without PyTorch")
        loader = batches(pictures, wanted.batch)
    for picture, depth, mask in loader:
        depth, mask = np.asarray(depth), np.asarray(mask)
        print(f"{tuple(picture.shape)}, nearest {np.nanmin(depth):.2f} m, {np.mean(mask == 1):.0%} floor")


if __name__ == "__main__":
    main()
