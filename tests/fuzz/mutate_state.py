"""Mutations of the contents of realcam's pickles: nested tuples of numbers, bytes, arrays and None."""

from __future__ import annotations

import random
import warnings
from collections.abc import Iterator
from typing import Any

import numpy as np

Path = tuple[int, ...]

WHOLE = (-(2**63), -(2**31), -1, 0, 1, 2, 3, 7, 255, 256, 4096, 2**31 - 1, 2**31, 2**32, 2**63 - 1, 2**63, 10**30)
REAL = (float("nan"), float("inf"), -float("inf"), 0.0, -0.0, -1.0, 1e-320, 1e-9, 0.5, 1.0, 1e9, 1e30, 1e308, -1e308)
OTHERS = (None, True, False, (), (1,), [], {}, "text", b"\xff\xfe", b"", 3.5, -7, object, np.zeros((2, 2)))


def places(state: Any, path: Path = ()) -> Iterator[Path]:
    """Yields the path of every item in nested tuples, including the empty path of `state` itself."""
    yield path
    if isinstance(state, tuple):
        for i, item in enumerate(state):
            yield from places(item, (*path, i))


def item_at(state: Any, path: Path) -> Any:
    for i in path:
        state = state[i]
    return state


def with_item(state: Any, path: Path, item: Any) -> Any:
    if not path:
        return item
    items = list(state)
    items[path[0]] = with_item(items[path[0]], path[1:], item)
    return tuple(items)


def mutated(state: Any, draw: random.Random) -> Any:
    """The state with one to three things changed."""
    for _ in range(draw.choice((1, 1, 1, 2, 3))):
        paths = list(places(state))
        path = draw.choice(paths)
        item = item_at(state, path)
        if draw.random() < 0.1:
            item = item_at(state, draw.choice(paths))  # from elsewhere, or a thing in itself
        elif draw.random() < 0.08:
            item = draw.choice(OTHERS)
        elif isinstance(item, bool):
            item = draw.choice((not item, 2, -1))
        elif isinstance(item, int):
            item = draw.choice((*WHOLE, item + 1, item - 1, -item, 2 * item))
        elif isinstance(item, float):
            item = draw.choice(
                (*REAL, -item, item * draw.uniform(0, 2), item * 1e6, round(item) if abs(item) < 1e9 else 7)
            )
        elif isinstance(item, bytes):
            item = _other_bytes(item, draw)
        elif isinstance(item, tuple):
            item = _other_tuple(item, draw)
        elif isinstance(item, np.ndarray):
            item = _other_array(item, draw)
        state = with_item(state, path, item)
    return state


def _other_bytes(item: bytes, draw: random.Random) -> bytes:
    change = draw.randrange(4)
    if change == 0:
        return item[: draw.randint(0, len(item))]
    if change == 1:
        return item + draw.randbytes(draw.randint(1, 50))
    if change == 2:
        return item.decode(errors="replace").upper().encode() + b"\n\0\x1b"
    return draw.randbytes(len(item) + 1)


def _other_tuple(item: tuple[Any, ...], draw: random.Random) -> tuple[Any, ...]:
    if not item:
        return (draw.choice(OTHERS),)
    change, i, k = draw.randrange(4), draw.randrange(len(item)), draw.randrange(len(item))
    if change == 0:
        return item[:i] + item[i + 1 :]
    if change == 1:
        return (*item[:i], item[k], *item[i:])
    if change == 2:
        return tuple(item[k] if n == i else item[i] if n == k else item[n] for n in range(len(item)))
    return item * draw.choice((0, 2, 5))


def _other_array(item: np.ndarray, draw: random.Random) -> np.ndarray:
    change = draw.randrange(7)
    array = np.array(item)
    if change == 0:
        return array[: draw.randint(0, max(0, len(array)))] if array.ndim else array[None]
    if change == 1 and array.ndim:
        return np.concatenate([array] * draw.choice((2, 3)), axis=draw.randrange(array.ndim))
    if change == 2:
        return array.reshape(draw.choice(((-1,), (1, -1), (-1, 1))))
    if change == 3 and array.dtype.names:  # which no other type can hold
        return array[draw.choice(array.dtype.names)]
    if change == 3 and array.dtype.kind != "U":
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # that numbers are lost
            return array.astype(draw.choice(("f8", "f4", "i4", "u1", "?", ">f8", "U3")))
    if change == 4 and array.ndim > 1:
        return np.asfortranarray(array) if draw.random() < 0.5 else array[..., ::-1]
    if array.size == 0:
        return np.full((3, 8), 255, np.uint8)
    # Numbers within bytes: integers and floats of all sizes, at positions where one may be.
    flat = np.ascontiguousarray(array).reshape(-1).view(np.uint8)
    for _ in range(draw.choice((1, 1, 3))):
        kind, values = draw.choice((("<i4", WHOLE[1:12]), ("<i8", WHOLE[:15]), ("<f8", REAL), ("<f4", REAL[:10])))
        with np.errstate(over="ignore"):
            new = np.array([draw.choice(values)]).astype(kind).view(np.uint8)
        at = draw.randrange(len(flat)) // len(new) * len(new)
        flat[at : at + len(new)] = new[: len(flat[at : at + len(new)])]
    return array if not array.flags.c_contiguous else flat.view(array.dtype).reshape(array.shape)
