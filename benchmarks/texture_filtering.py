"""What levels of a texture (mipmaps) would spare in samples: a checkered plane to the horizon, seen by a pinhole.

    python benchmarks/texture_filtering.py

A model of the renderer's lookup in numpy, so that filters can be compared before they are built: bilinear in the finest
level, as cpp/scene/textures/texture.hpp is, or in a level that a sample's footprint chooses, the level between two by chance
(Pharr et al. 2024). The footprint's two widths on the plane, across and along the view, count as their larger one or as
their geometric mean. It is that of a pixel; of a pixel over the square root of the samples, which is what one sample
stands for; or of a pixel over the square root of the sample's number, which needs no plan of how many there will be.
Prints the root mean square error of a pixel against 2048 samples of the finest level, whose mean is the truth.
"""

from __future__ import annotations

import numpy as np

TEXELS, SQUARE = 512, 32  # a tile of 4 m with squares of 0.25 m
TILE_M, HEIGHT_M, FOCAL_PX = 4.0, 1.0, 160.0
WIDTH, ROWS, FAR = 192, 96, 12  # below the horizon; the rows at it in which squares are smaller than a pixel
DARK, BRIGHT = 0.05, 0.8


def levels() -> list[np.ndarray]:
    squares = np.arange(TEXELS) // SQUARE
    all_levels = [np.where((squares[:, None] + squares[None]) % 2, BRIGHT, DARK)]
    while len(all_levels[-1]) > 1:
        m = all_levels[-1]
        all_levels.append((m[::2, ::2] + m[1::2, ::2] + m[::2, 1::2] + m[1::2, 1::2]) / 4)
    return all_levels


LEVELS = levels()


def bilinear(level: int, u: np.ndarray, v: np.ndarray) -> np.ndarray:
    m = LEVELS[level]
    n = len(m)
    x, y = (u % 1) * n - 0.5, (v % 1) * n - 0.5
    i, j = np.floor(x).astype(int), np.floor(y).astype(int)
    s, t = x - i, y - j
    upper = (1 - s) * m[j % n, i % n] + s * m[j % n, (i + 1) % n]
    lower = (1 - s) * m[(j + 1) % n, i % n] + s * m[(j + 1) % n, (i + 1) % n]
    return (1 - t) * upper + t * lower


def picture(spp: int, width_of: str, share_of: str, rng: np.random.Generator) -> np.ndarray:
    y, x = np.mgrid[0:ROWS, 0:WIDTH].astype(float)
    side = int(np.sqrt(spp))
    total = np.zeros((ROWS, WIDTH))
    for s in range(spp):
        dx = (x + (s % side + rng.random(x.shape)) / side - WIDTH / 2) / FOCAL_PX
        dy = (y + (s // side + rng.random(x.shape)) / side) / FOCAL_PX
        way = HEIGHT_M / np.maximum(dy, 1e-6)
        share = {"pixel": 1.0, "pixel / sqrt(samples)": spp**-0.5, "pixel / sqrt(number)": (s + 1) ** -0.5}[share_of]
        across = share * way / FOCAL_PX / TILE_M * TEXELS
        along = across / np.maximum(dy, 1e-6) * HEIGHT_M
        width = np.sqrt(across * along) if width_of == "geometric mean" else np.maximum(across, along)
        level = np.zeros(x.shape) if width_of == "none" else np.log2(np.maximum(width, 1))
        level = np.minimum(np.floor(level + rng.random(x.shape) * (width_of != "none")), len(LEVELS) - 1).astype(int)
        for k in np.unique(level):
            at = level == k
            total[at] += bilinear(k, (dx * way / TILE_M + 0.13)[at], (way / TILE_M + 0.07)[at])
    return total / spp


def main() -> None:
    rng = np.random.default_rng(1)
    reference = (picture(1024, "none", "pixel", rng) + picture(1024, "none", "pixel", rng)) / 2
    cases = [("none", "pixel")] + [
        (width, share)
        for width in ("larger", "geometric mean")
        for share in ("pixel", "pixel / sqrt(samples)", "pixel / sqrt(number)")
    ]
    print(f"{'width':15}{'footprint':25}" + "".join(f"{spp:>8} spp  (far)" for spp in (1, 4, 16, 64)))
    for width, share in cases:
        line = f"{width:15}{share:25}"
        for spp in (1, 4, 16, 64):
            error = picture(spp, width, share, rng) - reference
            line += f"  {np.sqrt(np.mean(error**2)):9.4f} {np.sqrt(np.mean(error[:FAR] ** 2)):7.4f}"
        print(line)


if __name__ == "__main__":
    main()
