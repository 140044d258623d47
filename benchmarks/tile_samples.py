"""Savings by adaptive sample counts: spp="auto" against the same number of samples in all pixels, at equal noise.

    python benchmarks/tile_samples.py [--device cpu] [--noise-codes 2]

The shots have an object in focus in front of a background far out of focus; the demo shot is measured as well. Noise,
in 8-bit codes, is measured by two pictures with different seeds: the 99th percentile of tiles of 16 x 16 pixels, which
spp="auto" limits, and the root mean square over all pixels. Times are those of the samples.
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

SIZE = (240, 160)  # pixels of each picture
TILE = 16  # pixels along each side of a tile


def partly_sharp(lens_name: str, distance: float, wall_ratio: float) -> tuple[rc.Scene, rc.Camera]:
    """A board in focus in front of a wall, in the light of sky and sun.

    distance: of the board, m. wall_ratio: distance of the wall over that of the board.
    """
    random = np.random.default_rng(3)
    lens = rc.Lens.load(lens_name).focused(distance)
    width = lens.film_mm[0]
    field = width / abs(lens.first_order().effective_focal_length_mm)
    boards = [
        board((-0.1 * field * distance, 0, -distance), 0.55 * field * distance, 1),
        board((0, 0, -wall_ratio * distance), 1.5 * field * wall_ratio * distance, 4),
    ]
    sun = np.array([0.4, -0.6, -0.7])
    scene = scene_of(boards, random).with_environment(3000.0).with_sun(tuple(sun / np.linalg.norm(sun)), (8e4,) * 3)
    camera = rc.Camera(lens, film=rc.Film(width, width * SIZE[1] / SIZE[0], SIZE))
    return scene, camera.metered(scene, device="cpu")


def shots() -> Iterator[tuple[str, rc.Scene, rc.Camera]]:
    """Yields name, scene and camera of each shot."""
    for lens, distance, wall_ratio in (
        ("double-gauss-50mm", 1.5, 6.0),
        ("double-gauss-100mm", 2.0, 8.0),
        ("phone-4mm", 0.15, 20.0),
        ("tessar-50mm", 1.0, 4.0),
    ):
        yield f"{lens}, {distance} m before {distance * wall_ratio:g} m", *partly_sharp(lens, distance, wall_ratio)
    demo = Path(__file__).parents[1] / "scenes" / "demo.toml"
    try:
        shot = rc.Shot.load(demo)
    except (rc.InputError, rc.ImageFileError) as missing:  # a build without OpenImageIO cannot read its textures
        print(missing)
        return
    film = shot.camera.film
    yield "demo", shot.scene, shot.camera.replace(film=rc.Film(film.width_mm, film.height_mm, SIZE))


def noise_of(a: rc.Image, b: rc.Image) -> tuple[float, float]:
    """Noise of two pictures with different seeds, in 8-bit codes: 99th percentile of tiles, and RMS over all pixels."""
    squares = (codes(a) - codes(b)) ** 2 / 2
    rows, columns = (length // TILE for length in squares.shape[:2])
    tiles = squares[: rows * TILE, : columns * TILE].reshape(rows, TILE, columns, TILE, 3).mean(axis=(1, 3, 4))
    return float(np.sqrt(np.quantile(tiles, 0.99))), float(np.sqrt(squares.mean()))


def seconds_of(image: rc.Image) -> float:
    """Render time without the setup."""
    return image.stats.seconds - image.stats.setup_seconds


def time_to(noise: float, curve: list[tuple[float, float]]) -> float:
    """Seconds to a noise, by interpolation or extrapolation of the points (noise, seconds) on logarithmic scales."""
    noises, seconds = (np.log(values) for values in zip(*curve, strict=True))
    slope = (seconds[-1] - seconds[-2]) / (noises[-1] - noises[-2])
    if np.log(noise) < noises[-1]:
        return float(np.exp(seconds[-1] + slope * (np.log(noise) - noises[-1])))
    return float(np.exp(np.interp(np.log(noise), noises[::-1], seconds[::-1])))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--device", default="cpu")
    parser.add_argument("--noise-codes", type=float, default=2.0)
    arguments = parser.parse_args()
    warnings.simplefilter("ignore", UserWarning)
    print("| shot | samples a pixel | noisiest tiles, codes | seconds | the same everywhere | times as long |")
    print("|---|---|---|---|---|---|")
    for name, scene, camera in shots():

        def pair(**samples: object) -> tuple[rc.Image, rc.Image]:
            first, second = (
                rc.render(scene, camera, seed=seed, effects=(), device=arguments.device, **samples)  # type: ignore[arg-type]  # noqa: B023
                for seed in (1, 2)
            )
            return first, second

        pair(spp=1)
        adaptive = pair(spp="auto", noise_codes=arguments.noise_codes)
        worst, everywhere = noise_of(*adaptive)
        picture, took = adaptive[0], float(np.mean([seconds_of(image) for image in adaptive]))
        uniform = [pair(spp=4**k) for k in range(2, 6)]
        times = [float(np.mean([seconds_of(image) for image in images])) for images in uniform]
        of_worst, of_all = (
            [(noise_of(*images)[i], t) for images, t in zip(uniform, times, strict=True)] for i in (0, 1)
        )
        print(
            f"| {name} | {picture.spp} | {worst:.2f} | {took:.2f} | {time_to(worst, of_worst):.2f} | "
            f"{time_to(worst, of_worst) / took:.2f} (over all pixels {time_to(everywhere, of_all) / took:.2f}) |",
            flush=True,
        )


if __name__ == "__main__":
    main()
