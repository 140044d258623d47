"""Parts of a picture: regions of the film and ranges of samples that sessions expose apart, and that add up to it."""

from __future__ import annotations

import pickle
from pathlib import Path

import numpy as np
import pytest
import realcam as rc

from .. import scenes

LENS = rc.Lens.load("double-gauss-50mm").focused(3.0).with_coating("bare")
WIDTH, HEIGHT, SPP = 53, 41, 300
SAMPLES = ((0, 256), (256, 44))


def camera(width: int = WIDTH, height: int = HEIGHT) -> rc.Camera:
    return rc.Camera(LENS, film=rc.Film(36, 27, (width, height)), exposure_time_s=0.01)


def room() -> rc.Scene:
    """A lamp, which the lens shows ghosts of, before a wall."""
    lamp = scenes.quad((0.3, 0.4, -2), 0.05, emission=1e5)
    return scenes.scene_of(scenes.quad((0, 0, -3), 3, diffuse=0.6), lamp).with_environment(50.0)


def settings(**more: object) -> rc.RenderSettings:
    return rc.RenderSettings(**{"spp": SPP, "seed": 3, "max_bounces": 2, "effects": ("ghosts",), **more})


def regions(width: int = 17, height: int = 9) -> list[tuple[int, int, int, int]]:
    """Rectangles that cover the film and whose inner borders are not borders of the renderer's tiles."""
    return [
        (column, row, min(width, WIDTH - column), min(height, HEIGHT - row))
        for row in range(0, HEIGHT, height)
        for column in range(0, WIDTH, width)
    ]


def parts(session: rc.Session) -> list[rc.FilmPart]:
    light = [session.expose_traced_light(first, spp) for first, spp in ((0, 100), (100, 200))]
    return [session.expose(region, first, spp) for first, spp in SAMPLES for region in regions()] + light


def test_a_picture_of_parts_has_the_bits_of_the_whole(tmp_path: Path) -> None:
    """This includes all layers and ghosts. Two sessions share the work, and the parts travel as files."""
    with_layers = settings(layers="all")
    sessions = [rc.Session(room(), camera(), with_layers, device="cpu") for _ in range(2)]
    exposed = []
    for i, part in enumerate(parts(sessions[0])):
        part.save(tmp_path / f"{i}.npz")
        exposed.append(rc.FilmPart.load(tmp_path / f"{i}.npz"))
        assert exposed[-1] == part
    whole = rc.render(room(), camera(), with_layers, device="cpu")
    image = sessions[1].image_of(exposed)
    assert image == whole
    assert set(image.layers) == set(with_layers.layers)
    assert image.stats.sampled_rays == whole.stats.sampled_rays
    assert image.stats.passed_rays == whole.stats.passed_rays


def test_a_gpu_gives_the_same_picture_whatever_the_regions(device: str) -> None:
    """All tilings give the same bits, on a CPU also those of one render; a GPU sums a render in another order."""
    session = rc.Session(room(), camera(), settings(), device=device)
    one = session.image_of(
        [session.expose((0, 0, WIDTH, HEIGHT), first, spp) for first, spp in SAMPLES]
        + [session.expose_traced_light(0, 256), session.expose_traced_light(256, 44)]
    )
    many = session.image_of(parts(session))
    assert many == one
    whole = rc.render(room(), camera(), settings(), device=device)
    np.testing.assert_allclose(many.pixels, whole.pixels, rtol=1e-6)  # sums in double, in another order
    np.testing.assert_allclose(many.depth, whole.depth, rtol=1e-6)


def test_exposing_a_part_leaves_the_sessions_picture_as_it_is() -> None:
    session = rc.Session(room(), camera(), settings(layers=("normal", "variance")), device="cpu")
    session.add(8)
    before = session.image()
    session.expose((5, 6, 20, 10), 0, 16)
    session.expose_traced_light(0, 16)
    assert session.image() == before


def test_single_pixels_take_as_many_samples_as_their_counts_say() -> None:
    session = rc.Session(room(), camera(), settings(), device="cpu")
    counts = np.arange(6, dtype=np.uint32).reshape(2, 3)
    some = session.expose((10, 20, 3, 2), 0, 5, counts)
    assert some.pixels is not None
    np.testing.assert_array_equal(some.pixels["samples"], counts)
    one = session.expose((12, 20, 1, 1), 0, 2)
    assert one.pixels is not None
    assert some.pixels[0, 2] == one.pixels[0, 0]


def test_a_picture_without_traced_light_says_so() -> None:
    session = rc.Session(room(), camera(), settings(effects=(), light_tracing="off"), device="cpu")
    assert session.expose_traced_light(0, 0).splats == []
    lit = rc.Session(room(), camera(), settings(), device="cpu")
    assert lit.expose_traced_light(0, 0).splats != []


def test_what_is_no_part_of_the_picture_is_refused(tmp_path: Path) -> None:
    session = rc.Session(room(), camera(), settings(layers="normal"), device="cpu")
    with pytest.raises(rc.InputError, match="a region must lie on the film, which has 53 x 41 pixels"):
        session.expose((50, 0, 4, 1))
    with pytest.raises(rc.InputError, match="0 to 256 samples"):
        session.expose((0, 0, 1, 1), 0, 257)
    with pytest.raises(rc.InputError, match="expected a sample count for each pixel"):
        session.expose((0, 0, 2, 2), 0, 4, np.zeros(3, np.uint32))
    with pytest.raises(rc.InputError, match="does not lie on the film"):
        rc.Session(room(), camera(20, 20), settings(), device="cpu").image_of([session.expose((40, 30, 2, 2), 0, 1)])
    dim = rc.Session(room().with_environment(1.0), camera(), settings(), device="cpu")
    with pytest.raises(rc.InputError, match="other lights"):
        session.image_of([session.expose_traced_light(0, 4), dim.expose_traced_light(4, 4)])
    part = session.expose((0, 0, 2, 2), 0, 1)
    with pytest.raises(rc.InputError, match="sums of its region's pixels"):
        rc.FilmPart((0, 0, 3, 2), 0, 1, part.pixels)
    assert pickle.loads(pickle.dumps(part)) == part
    assert part != session.expose((0, 0, 2, 2), 1, 1)


def test_a_damaged_file_is_no_part(tmp_path: Path) -> None:
    session = rc.Session(room(), camera(), settings(), device="cpu")
    file = tmp_path / "part.npz"
    session.expose((0, 0, 8, 8), 0, 4).save(file)
    content = file.read_bytes()
    changed_bit = bytearray(content)
    changed_bit[len(content) // 2] ^= 4
    for damaged in (b"", content[: len(content) // 3], content[:-1], bytes(changed_bit)):
        file.write_bytes(damaged)
        with pytest.raises(rc.InputError, match=r"part\.npz: this file is damaged"):
            rc.FilmPart.load(file)
    with pytest.raises(rc.InputError, match="there is no such file"):
        rc.FilmPart.load(tmp_path / "other.npz")
