"""Draws the lens drawings of README.md and docs/drawing.md."""

from __future__ import annotations

import sys
from pathlib import Path

import realcam as rc
from PIL import Image
from realcam.drawing import save_cross_section, save_states, states_of

WIDTH = 1000  # of the drawings, pixels


def save_drawings(folder: Path) -> None:
    """Writes lens.png and drawing-*.png."""
    gauss = rc.Lens.load("double-gauss-50mm")
    save_cross_section(gauss, folder / "lens.png")
    save_cross_section(
        gauss.focused(0.6),
        folder / "drawing-options.png",
        wavelengths_nm=(486.1, 587.6, 656.3),
        radius_colours=True,
        marks=True,
        width_px=WIDTH,
    )
    save_cross_section(rc.Lens.load("fisheye-6mm-220deg"), folder / "drawing-fisheye.png", theme="dark", width_px=WIDTH)
    telephoto = rc.Lens.load("telephoto-200mm-inner-focus")
    save_states(states_of(telephoto), folder / "drawing-states.png", insets=False, width_px=WIDTH)
    pair = [rc.Lens.load(name).stopped_down(4) for name in ("tessar-50mm", "sonnar-50mm")]
    save_states([(lens.title, lens) for lens in pair], folder / "drawing-compare.png", width_px=WIDTH)
    save_cross_section(with_crossing_faces(), folder / "drawing-error.png", rays=0, width_px=WIDTH)
    for picture in (folder / "lens.png", *folder.glob("drawing-*.png")):
        Image.open(picture).convert("RGB").quantize(64).save(picture, optimize=True)  # reduces the file to a fifth


def with_crossing_faces() -> rc.Lens:
    """A triplet whose front element is so thin that its faces intersect."""
    triplet = rc.Lens.load("cooke-triplet-50mm")
    surfaces = [triplet.surfaces[0].replace(thickness_mm=0.6), *triplet.surfaces[1:]]
    return rc.Lens(surfaces=surfaces, name="too thin", film_distance_mm=triplet.film_distance_mm, allow_overlap=True)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: python tools/lens_drawings.py FOLDER")
    save_drawings(Path(sys.argv[1]))
