"""Pictures for the demo scene, made from formulas, and a PNG writer."""

from __future__ import annotations

import struct
import zlib

import numpy as np


def png(codes: np.ndarray) -> bytes:
    """8-bit sRGB: (H, W, 3) colours or (H, W) greys."""
    height, width = codes.shape[:2]
    colour_type = 2 if codes.ndim == 3 else 0
    rows = codes.reshape(height, -1).astype(np.int16)
    # Each row as its difference to the one above, which packs better (filter 2 of the format).
    above = np.concatenate([np.zeros_like(rows[:1]), rows[:-1]])
    filtered = np.column_stack([np.full(height, 2), (rows - above) % 256]).astype(np.uint8)

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    head = struct.pack(">IIBBBBB", width, height, 8, colour_type, 0, 0, 0)
    body = zlib.compress(filtered.tobytes(), 9)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", body) + chunk(b"IEND", b"")


def srgb(linear: np.ndarray) -> np.ndarray:
    v = np.clip(linear, 0, 1)
    codes = np.where(v <= 0.0031308, 12.92 * v, 1.055 * v ** (1 / 2.4) - 0.055)
    return np.round(255 * codes).astype(np.uint8)


def noise(rng: np.random.Generator, height: int, width: int, cells_y: int, cells_x: int) -> np.ndarray:
    """Smooth, 0 to 1, seamless on all sides."""
    grid = rng.random((cells_y, cells_x))
    y, x = np.arange(height) * cells_y / height, np.arange(width) * cells_x / width
    i, j = y.astype(int), x.astype(int)
    fy, fx = (3 * f**2 - 2 * f**3 for f in (y - i, x - j))
    i1, j1 = (i + 1) % cells_y, (j + 1) % cells_x
    top = grid[np.ix_(i, j)] * (1 - fx) + grid[np.ix_(i, j1)] * fx
    low = grid[np.ix_(i1, j)] * (1 - fx) + grid[np.ix_(i1, j1)] * fx
    return top * (1 - fy)[:, None] + low * fy[:, None]


def planks(rng: np.random.Generator, height: int = 640, width: int = 640, boards: int = 5) -> np.ndarray:
    """Oiled boards, their grain along x."""
    grain = 0.5 * noise(rng, height, width, 160, 5) + 0.3 * noise(rng, height, width, 320, 12)
    waves = noise(rng, height, width, 10, 3)
    y = np.arange(height)[:, None] / height
    rings = 0.5 + 0.5 * np.sin(2 * np.pi * (26 * y + 3.5 * waves))
    board = (y * boards).astype(int) % boards
    tone = rng.uniform(0.72, 1.15, boards)[board]
    # Levels in steps: fine noise does not pack.
    value = np.round((0.55 + 0.5 * grain + 0.16 * rings) * 24) / 24 * tone
    gap = np.abs(((y * boards) % 1) - 0.5) > 0.488
    value = np.where(gap, 0.16 * value, value)
    return srgb(value[..., None] * np.array([0.30, 0.155, 0.072]))


def tiles(rng: np.random.Generator, count: int = 4, size: int = 256) -> np.ndarray:
    """Stone tiles with joints."""
    y, x = np.mgrid[0:size, 0:size] * count / size
    tone = rng.uniform(0.75, 1.1, (count, count))[y.astype(int), x.astype(int)]
    joint = np.maximum(np.abs(y % 1 - 0.5), np.abs(x % 1 - 0.5)) > 0.475
    value = np.where(joint, 0.3, tone * (0.85 + 0.2 * np.round(6 * noise(rng, size, size, 32, 32)) / 6))
    return srgb(value[..., None] * np.array([0.16, 0.17, 0.19]))


def bricks(rng: np.random.Generator, size: int = 256) -> np.ndarray:
    rows, columns = 12, 5
    y, x = np.mgrid[0:size, 0:size] / size
    row = (y * rows).astype(int)
    across = x * columns + 0.5 * (row % 2)
    tone = rng.uniform(0.6, 1.15, (rows, columns))[row, across.astype(int) % columns]
    joint = (np.abs((y * rows) % 1 - 0.5) > 0.43) | (np.abs(across % 1 - 0.5) > 0.47)
    return srgb(np.where(joint[..., None], [0.10, 0.10, 0.11], tone[..., None] * np.array([0.20, 0.115, 0.092])))


def test_chart(width: int = 480, height: int = 680) -> np.ndarray:
    """A Siemens star in a ring, a grid, line groups that grow finer, and a grey scale."""
    scale = 4  # samples for each pixel and direction
    chart = np.full((height * scale, width * scale), 0.86)
    y, x = np.mgrid[0 : height * scale, 0 : width * scale] / scale
    dx, dy = x - width / 2, y - width / 2
    radius, angle = np.hypot(dx, dy), np.arctan2(dy, dx)
    inside = (np.abs(dx) < width / 2 - 22) & (np.abs(dy) < width / 2 - 22)
    grid = ((np.abs(dx + 18) % 36 - 18 > -1) & (np.abs(dx + 18) % 36 - 18 < 1)) | (
        (np.abs(dy + 18) % 36 - 18 > -1) & (np.abs(dy + 18) % 36 - 18 < 1)
    )
    chart[inside & grid] = 0.35
    star = 0.42 * width
    chart[radius < star + 10] = 0.86
    chart[(radius < star) & (np.floor(angle * 36 / np.pi) % 2 == 0)] = 0.02
    chart[(radius > star + 4) & (radius < star + 10)] = 0.02
    chart[radius < 10] = 0.02
    chart[radius < 5] = 0.86
    for i in range(8):  # lines of 12 pixels down to 2
        period = 24 * 0.775**i
        left = 24 + i * (width - 48) / 8
        cell = (x >= left) & (x < left + (width - 48) / 8 - 10)
        upright = cell & (y > width + 8) & (y < width + 58)
        flat = cell & (y > width + 66) & (y < width + 116)
        chart[upright & ((x - left) % period < period / 2)] = 0.02
        chart[flat & ((y - width - 66) % period < period / 2)] = 0.02
    steps = (y > width + 132) & (y < height - 24) & (x > 24) & (x < width - 24)
    shade = np.floor(np.clip((x - 24) / (width - 48), 0, 1) * 10) / 9
    chart[steps] = (0.02 + 0.84 * shade**2.2)[steps]
    border = (x < 6) | (x > width - 6) | (y < 6) | (y > height - 6)
    chart[border] = 0.02
    return srgb(chart.reshape(height, scale, width, scale).mean(axis=(1, 3)))


def ruler(width: int = 1200, height: int = 96, length_mm: int = 300) -> np.ndarray:
    """Black marks on brushed steel, a line for each millimetre."""
    x = np.arange(width) / width * length_mm
    mark = np.full((height, width), 0.52)
    for mm in range(1, length_mm):
        depth = 44 if mm % 10 == 0 else 32 if mm % 5 == 0 else 20
        mark[:depth, np.abs(x - mm) < (0.22 if mm % 10 else 0.3)] = 0.03
    return srgb(mark)
