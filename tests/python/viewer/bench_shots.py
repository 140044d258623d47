"""A small shot for the lens bench: three panels of squares, near, in focus and far, so that blur can be measured."""

from __future__ import annotations

from pathlib import Path

import numpy as np

NEAR_M, MIDDLE_M, FAR_M = 0.6, 1.2, 20.0
SQUARES = 13  # across a panel, which is a third of the picture
WIDTH, HEIGHT = 120, 80

# A film of 36 mm behind a lens of about 50 mm sees 0.72 of the distance.
_SHOT = """format = 1
scene = "panels.obj"
lens = "{lens}"
position_m = [0.0, 0.0, 0.0]  # the middle of the film
look_at_m = [0.0, 0.0, -{middle}]
film_mm = [36.0, 24.0]
resolution = [{width}, {height}]
focus_m = {middle}
exposure_time_s = 0.02
iso = 100
environment_cd_m2 = [60.0, 60.0, 60.0]
effects = []
"""


def write_panels_shot(folder: Path, *, width: int = WIDTH, lens: str = "double-gauss-50mm", more: str = "") -> Path:
    """Writes panels.toml and what it needs. `more`: further lines of it."""
    lines, count = ["mtllib panels.mtl"], 0
    for third, distance in ((-1, NEAR_M), (0, MIDDLE_M), (1, FAR_M)):
        # The film is at the origin and the front of the lens about 0.1 m before it.
        unit = 0.72 * distance / 3
        across = unit / SQUARES
        # The middle one is wider: what is out of focus before and behind it does not reach into its middle.
        for column in range(SQUARES):
            for row in range(2 * SQUARES):
                x = third * unit - 0.5 * unit + column * across
                y = unit - (row + 1) * across
                z = -distance
                lines.append(f"usemtl {'white' if (row + column) % 2 else 'black'}")
                for corner in ((x, y), (x + across, y), (x + across, y + across), (x, y + across)):
                    lines.append(f"v {corner[0]:.6f} {corner[1]:.6f} {z:.6f}")
                lines.append("f " + " ".join(str(count + k) for k in range(1, 5)))
                count += 4
    (folder / "panels.obj").write_text("\n".join(lines) + "\n")
    (folder / "panels.mtl").write_text("newmtl white\nKd 0.8 0.8 0.8\nnewmtl black\nKd 0.04 0.04 0.04\n")
    height = round(width * HEIGHT / WIDTH)
    text = _SHOT.format(middle=MIDDLE_M, width=width, height=height, lens=lens) + more
    path = folder / "panels.toml"
    path.write_text(text)
    return path


def sharpness(codes: np.ndarray) -> tuple[float, float, float]:
    """Sharpness of the near, the middle and the far panel: standard deviation of the brightness within it, in codes.

    Squares that are blurred to the width of two are all of one grey.
    """
    grey = codes[..., :3].astype(float).mean(axis=2)
    height, width = grey.shape
    rows = slice(round(0.25 * height), round(0.75 * height))
    near, middle, far = (
        float(grey[rows, round((k + 0.2) * width / 3) : round((k + 0.8) * width / 3)].std()) for k in range(3)
    )
    return near, middle, far
