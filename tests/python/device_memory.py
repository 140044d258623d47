"""Arrays in a GPU's memory for the tests: what holds them, and what only says that it does."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import realcam as rc

GPUS = [device.name for device in rc.devices() if device.name.startswith("cuda:")]
needs_gpu = pytest.mark.skipif(not GPUS, reason=f"no GPU: {rc.devices()} is all there is")
needs_two = pytest.mark.skipif(len(GPUS) < 2, reason=f"two GPUs are wanted: {rc.devices()}")

LENS = rc.Lens.load("double-gauss-50mm")


def small_camera(lens: rc.Lens = LENS, **how: Any) -> rc.Camera:
    return rc.Camera(lens, film=rc.Film(36, 24, (6, 4)), **how)


def film_rays(count: int = 40) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(1)
    directions = np.concatenate([rng.uniform(-0.1, 0.1, (count, 2)), np.full((count, 1), -1.0)], axis=1)
    return np.tile([1.0, 2.0, LENS.film_position_mm], (count, 1)), directions


class Claimed:
    """Says that it lies on a GPU, by __cuda_array_interface__."""

    def __init__(self, **entries: Any) -> None:
        plain = {"shape": (2, 3), "typestr": "<f8", "data": (4096, False), "version": 3}
        self.__cuda_array_interface__ = plain | entries


class ClaimedByDLPack:
    """Says that it lies on a GPU, by __dlpack_device__; the numbers are those of an array of the host."""

    def __init__(self, array: np.ndarray | None = None, capsule: object = None) -> None:
        self.array, self.capsule = array, capsule

    def __dlpack_device__(self) -> tuple[int, int]:
        return 2, 0

    def __dlpack__(self, **how: Any) -> object:
        return self.capsule if self.array is None else self.array.__dlpack__()


class Unexportable(ClaimedByDLPack):
    def __dlpack__(self, **how: Any) -> object:
        raise BufferError("it needs its gradient")


EMPTY = Claimed(shape=(0, 3), data=(0, False))


def on_torch(array: np.ndarray, **how: Any) -> Any:
    return pytest.importorskip("torch").tensor(array, device="cuda", **how)


def on_cupy(array: np.ndarray) -> Any:
    return pytest.importorskip("cupy").asarray(array)


class DLPackAlone:
    """A producer without __cuda_array_interface__, older than version 1."""

    def __init__(self, array: np.ndarray) -> None:
        self.tensor = on_torch(array)

    def __dlpack_device__(self) -> tuple[int, int]:
        return self.tensor.__dlpack_device__()

    def __dlpack__(self, stream: int | None = None) -> object:
        return self.tensor.__dlpack__(stream=stream)


class Passed(DLPackAlone):
    def __init__(self, tensor: Any) -> None:
        self.tensor = tensor
