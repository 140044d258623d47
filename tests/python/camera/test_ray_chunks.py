"""A camera's rays in pieces are the rays of the whole, bit by bit."""

from __future__ import annotations

import numpy as np
import pytest
import realcam as rc

NAMES = ("origins_m", "directions", "weights", "pixels")
FILM = rc.Film(36, 24, (31, 17))


@pytest.mark.parametrize("model", ["full", "thin"])
@pytest.mark.parametrize("max_rays", [1, 100, 527, 10**9])
def test_pieces_are_the_whole(model: str, max_rays: int, device: str) -> None:
    """Pieces of one ray, ones that end amid a pixel or at a frame's end, and one that holds all 2635."""
    camera = rc.Camera(rc.Lens.load("tessar-50mm"), film=FILM, position=(1e6, 2, 3), look_at=(0, 0, 0), model=model)
    if max_rays == 1:
        camera = camera.replace(film=FILM.replace(resolution=(3, 2)))
    whole = camera.generate_rays(spp=5, seed=7, device=device)
    pieces = list(camera.ray_chunks(spp=5, seed=7, device=device, max_rays=max_rays))
    assert max(len(piece.weights) for piece in pieces) <= max_rays
    assert len(pieces) == -(-len(whole.weights) // max_rays)
    for name in NAMES:
        joined = np.concatenate([np.asarray(getattr(piece, name)) for piece in pieces])
        expected = np.asarray(getattr(whole, name))
        assert joined.dtype == expected.dtype
        assert joined.tobytes() == expected.tobytes(), name


def test_an_iterator_is_one() -> None:
    chunks = rc.Camera(rc.Lens.load("tessar-50mm"), film=FILM).ray_chunks(max_rays=300)
    assert iter(chunks) is chunks
    assert [len(piece.weights) for piece in chunks] == [300, 227]
    with pytest.raises(StopIteration):
        next(chunks)


def test_wrong_pieces_are_refused_at_once() -> None:
    camera = rc.Camera(rc.Lens.load("tessar-50mm"), film=FILM)
    for wrong, complaint in (({"max_rays": 0}, "max_rays"), ({"spp": 0}, "spp"), ({"seed": -1}, "seed")):
        with pytest.raises(rc.InputError, match=complaint):
            camera.ray_chunks(**wrong)


def test_more_rays_than_memory_holds_come_one_piece_after_the_other() -> None:
    """32768 x 32768 pixels of 2^31 - 1 rays: 10^20 bytes in all."""
    film = rc.Film(36, 36, (32768, 32768))
    camera = rc.Camera(rc.Lens.load("tessar-50mm"), film=film)
    first = next(camera.ray_chunks(spp=2**31 - 1, max_rays=1000))
    assert (first.pixels == 0).all()
    assert len(first.weights) == 1000
