"""What do sample counts by tile save? spp="auto" against the same number of samples everywhere, at equal noise.

    python benchmarks/tile_samples.py [--device cpu] [--noise-codes 2]

Shots that are partly sharp: a thing in focus before what is far out of it, and the demo shot. Noise is that of tiles
of 16 pixels, told by two pictures with other random numbers, in 8-bit codes: of the noisiest tile but one in a hundred,
which is what spp="auto" is to bound, and over all pixels. Times are those of the samples.
"""

from __future__ import annotations

import argparse
import warnings
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import realcam as rc
from plan_shots import board, scene_of
from realcam.accuracy.errors import codes

SIZE = (240, 160)
TILE = 16


def partly_sharp(lens_name: str, distance: float, behind: float) -> tuple[rc.Scene, rc.Camera]:
    """A board in focus before a wall so many times as far away, in the light of sky and sun."""
    random = np.random.default_rng(3)
    lens = rc.Lens.load(lens_name).focused(distance)
    width = lens.film_mm[0]
    field = width / abs(lens.first_order().effective_focal_length_mm)
    boards = [
        board((-0.1 * field * distance, 0, -distance), 0.55 * field * distance, 1),
        board((0, 0, -behind * distance), 1.5 * field * behind * distance, 4),
    ]
    sun = np.array([0.4, -0.6, -0.7])
    scene = scene_of(boards, random).with_environment(3000.0).with_sun(tuple(sun / np.linalg.norm(sun)), (8e4,) * 3)
    camera = rc.Camera(lens, film=rc.Film(width, width * SIZE[1] / SIZE[0], SIZE))
    return scene, camera.metered(scene, device="cpu")


def shots() -> Iterator[tuple[str, rc.Scene, rc.Camera]]:
    for lens, distance, behind in (
        ("double-gauss-50mm", 1.5, 6.0),
        ("double-gauss-100mm", 2.0, 8.0),
        ("phone-4mm", 0.15, 20.0),
        ("tessar-50mm", 1.0, 4.0),
    ):
        yield f"{lens}, {distance} m before {distance * behind:g} m", *partly_sharp(lens, distance, behind)
    demo = Path(__file__).parents[1] / "scenes" / "demo.toml"
    try:
        shot = rc.Shot.load(demo)
    except (rc.InputError, rc.ImageFileError) as missing:  # of a build without OpenImageIO
        print(missing)
        return
    film = shot.camera.film
    yield "demo", shot.scene, shot.camera.replace(film=rc.Film(film.width_mm, film.height_mm, SIZE))


def noise_of(a: rc.Image, b: rc.Image) -> tuple[float, float]:
    """Of either, which differ in their random numbers: of the noisiest tile but one in a hundred, and of all, codes."""
    squares = (codes(a) - codes(b)) ** 2 / 2
    rows, columns = (length // TILE for length in squares.shape[:2])
    tiles = squares[: rows * TILE, : columns * TILE].reshape(rows, TILE, columns, TILE, 3).mean(axis=(1, 3, 4))
    return float(np.sqrt(np.quantile(tiles, 0.99))), float(np.sqrt(squares.mean()))


def seconds_of(image: rc.Image) -> float:
    return image.stats.seconds - image.stats.setup_seconds


def time_to(noise: float, curve: list[tuple[float, float]]) -> float:
    """Between, or beyond, the points (noise, seconds) of a curve, on logarithmic scales."""
    noises, seconds = (np.log(values) for values in zip(*curve, strict=True))
    slope = (seconds[-1] - seconds[-2]) / (noises[-1] - noises[-2])
    if np.log(noise) < noises[-1]:
        return float(np.exp(seconds[-1] + slope * (np.log(noise) - noises[-1])))
    return float(np.exp(np.interp(np.log(noise), noises[::-1], seconds[::-1])))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--device", default="cpu")
    parser.add_argument("--noise-codes", type=float, default=2.0)
    words = parser.parse_args()
    warnings.simplefilter("ignore", UserWarning)
    print("| shot | samples a pixel | noisiest tiles, codes | seconds | the same everywhere | times as long |")
    print("|---|---|---|---|---|---|")
    for name, scene, camera in shots():

        def pair(**samples: object) -> tuple[rc.Image, rc.Image]:
            first, second = (
                rc.render(scene, camera, seed=seed, effects=(), device=words.device, **samples)  # type: ignore[arg-type]  # noqa: B023
                for seed in (1, 2)
            )
            return first, second

        pair(spp=1)
        by_tile = pair(spp="auto", noise_codes=words.noise_codes)
        worst, everywhere = noise_of(*by_tile)
        picture, took = by_tile[0], float(np.mean([seconds_of(image) for image in by_tile]))
        even = [pair(spp=4**k) for k in range(2, 6)]
        times = [float(np.mean([seconds_of(image) for image in images])) for images in even]
        of_worst, of_all = ([(noise_of(*images)[i], t) for images, t in zip(even, times, strict=True)] for i in (0, 1))
        print(
            f"| {name} | {picture.spp} | {worst:.2f} | {took:.2f} | {time_to(worst, of_worst):.2f} | "
            f"{time_to(worst, of_worst) / took:.2f} (over all pixels {time_to(everywhere, of_all) / took:.2f}) |",
            flush=True,
        )


if __name__ == "__main__":
    main()
