"""Samples that mipmap levels of a texture save: a checkered plane up to the horizon, seen by a pinhole camera.

    python benchmarks/texture_filtering.py

Models the renderer's texture lookup in numpy, to compare filters before they are implemented: bilinear interpolation in
the finest level, or in the level selected by a sample's footprint, stochastically between two levels (Pharr et al.
2024). The footprint's widths across and along the view direction are combined as the larger one or as their geometric
mean. The footprint is that of a pixel; that divided by the square root of the number of samples, the area of one
sample; or that divided by the square root of the sample's index from 1, for which the number of samples need not be
known. Prints the root mean square error of a pixel against 2048 samples of the finest level, which converge to the
exact value.
"""

from __future__ import annotations

import numpy as np

TEXELS, SQUARE = 512, 32  # texels along the texture and along a square: 4 m with squares of 0.25 m
TILE_M, HEIGHT_M, FOCAL_PX = 4.0, 1.0, 160.0  # side of the texture, height of the camera, focal length in pixels
# Columns and rows of the picture below the horizon, and the first rows, in which squares are smaller than a pixel.
WIDTH, ROWS, FAR = 192, 96, 12
DARK, BRIGHT = 0.05, 0.8  # reflectances


def levels() -> list[np.ndarray]:
    """Mipmap levels of the checkerboard, the finest first."""
    squares = np.arange(TEXELS) // SQUARE
    all_levels = [np.where((squares[:, None] + squares[None]) % 2, BRIGHT, DARK)]
    while len(all_levels[-1]) > 1:
        m = all_levels[-1]
        all_levels.append((m[::2, ::2] + m[1::2, ::2] + m[::2, 1::2] + m[1::2, 1::2]) / 4)
    return all_levels


LEVELS = levels()


def bilinear(level: int, u: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Bilinear interpolation in a level at texture coordinates, which repeat."""
    m = LEVELS[level]
    n = len(m)
    x, y = (u % 1) * n - 0.5, (v % 1) * n - 0.5
    i, j = np.floor(x).astype(int), np.floor(y).astype(int)
    s, t = x - i, y - j
    upper = (1 - s) * m[j % n, i % n] + s * m[j % n, (i + 1) % n]
    lower = (1 - s) * m[(j + 1) % n, i % n] + s * m[(j + 1) % n, (i + 1) % n]
    return (1 - t) * upper + t * lower


def picture(spp: int, width_of: str, footprint: str, rng: np.random.Generator) -> np.ndarray:
    """(ROWS, WIDTH): mean of spp samples per pixel.

    width_of: "none" (finest level), "larger" or "geometric mean". footprint: "pixel", "pixel / sqrt(samples)" or
    "pixel / sqrt(number)".
    """
    y, x = np.mgrid[0:ROWS, 0:WIDTH].astype(float)
    side = int(np.sqrt(spp))
    total = np.zeros((ROWS, WIDTH))
    for s in range(spp):
        dx = (x + (s % side + rng.random(x.shape)) / side - WIDTH / 2) / FOCAL_PX
        dy = (y + (s // side + rng.random(x.shape)) / side) / FOCAL_PX
        distance = HEIGHT_M / np.maximum(dy, 1e-6)  # on the plane, m
        scale = {"pixel": 1.0, "pixel / sqrt(samples)": spp**-0.5, "pixel / sqrt(number)": (s + 1) ** -0.5}[footprint]
        across = scale * distance / FOCAL_PX / TILE_M * TEXELS
        along = across / np.maximum(dy, 1e-6) * HEIGHT_M
        width = np.sqrt(across * along) if width_of == "geometric mean" else np.maximum(across, along)
        level = np.zeros(x.shape) if width_of == "none" else np.log2(np.maximum(width, 1))
        level = np.minimum(np.floor(level + rng.random(x.shape) * (width_of != "none")), len(LEVELS) - 1).astype(int)
        for k in np.unique(level):
            chosen = level == k
            u, v = dx * distance / TILE_M + 0.13, distance / TILE_M + 0.07
            total[chosen] += bilinear(k, u[chosen], v[chosen])
    return total / spp


def main() -> None:
    rng = np.random.default_rng(1)
    reference = (picture(1024, "none", "pixel", rng) + picture(1024, "none", "pixel", rng)) / 2
    cases = [("none", "pixel")] + [
        (width, footprint)
        for width in ("larger", "geometric mean")
        for footprint in ("pixel", "pixel / sqrt(samples)", "pixel / sqrt(number)")
    ]
    print(f"{'width':15}{'footprint':25}" + "".join(f"{spp:>8} spp  (far)" for spp in (1, 4, 16, 64)))
    for width, footprint in cases:
        line = f"{width:15}{footprint:25}"
        for spp in (1, 4, 16, 64):
            error = picture(spp, width, footprint, rng) - reference
            line += f"  {np.sqrt(np.mean(error**2)):9.4f} {np.sqrt(np.mean(error[:FAR] ** 2)):7.4f}"
        print(line)


if __name__ == "__main__":
    main()
