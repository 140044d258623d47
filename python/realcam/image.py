"""A photograph: film exposure, depth, and how it was taken."""

from __future__ import annotations

import os
from dataclasses import dataclass

import numpy as np

from . import _core, image_file
from ._core import Camera, RenderStats


@dataclass(frozen=True, eq=False)
class Image:
    """What lies on the film after the exposure, without noise.

    pixels: (H, W, 3) float32, exposure in lux seconds, linear Rec. 709, row 0 at the top.
    depth: (H, W) float32, metres along the camera's axis from the film; inf where nothing was met.
    """

    pixels: np.ndarray
    depth: np.ndarray
    camera: Camera
    spp: int
    seed: int
    stats: RenderStats

    def __eq__(self, other: object) -> bool:
        """Whether pictures, cameras and settings are the same; what it cost to take them does not count."""
        if not isinstance(other, Image):
            return NotImplemented
        return (self.camera, self.spp, self.seed) == (other.camera, other.spp, other.seed) and all(
            np.array_equal(*arrays, equal_nan=True)
            for arrays in ((self.pixels, other.pixels), (self.depth, other.depth))
        )

    __hash__ = None  # type: ignore[assignment]  # its arrays may be written to

    def __repr__(self) -> str:
        height, width = self.depth.shape
        return f"<realcam.Image {width} x {height} pixels of {self.spp} samples, taken with {self.camera!r:.60}>"

    def developed(self, tone: str = "film", iso: float | None = None) -> np.ndarray:
        """(H, W, 3) uint8 sRGB at the camera's sensitivity, or another one.

        10 / iso lux seconds become middle grey (118). tone: "film" (soft highlights) or "linear" (clipped).
        """
        return _core.develop(self.pixels, self.camera.iso if iso is None else iso, tone)

    def save(self, path: str | os.PathLike[str], tone: str = "film") -> None:
        """Writes .png (developed) or .exr (film exposure R, G, B in lux seconds, and depth as layer Z in metres).

        Lens, f-number, focus, exposure time, ISO, seed and version are in the file's metadata. Raises ImageFileError;
        no half-written file is left. An image does not know which files its scene was read from: one of the same name
        is replaced, as any other.
        """
        image_file.write_image(self, path, tone)

    def metadata(self) -> dict[str, str]:
        """Names ("realcam:...") and values of what is written into picture files."""
        entries: dict[str, str] = _core._metadata(self.camera, self.spp, self.seed)
        return entries
