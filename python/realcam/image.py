"""A photograph: film exposure, depth, and how it was taken."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

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
        no half-written file is left.
        """
        image_file.check_writable(path)
        if Path(path).suffix.lower() == ".png":
            attributes = {**self.metadata(), "oiio:ColorSpace": "sRGB", "realcam:tone": tone}
            image_file.write_image(path, self.developed(tone), ("R", "G", "B"), attributes)
        else:
            layers = np.concatenate([self.pixels, self.depth[..., None]], axis=2)
            image_file.write_image(path, layers, ("R", "G", "B", "Z"), self.metadata())

    def metadata(self) -> dict[str, str | int | float]:
        """Name and value of what is written into picture files.

        Values of realcam's own entries are texts, as the executable writes them: PNG keeps no other kind.
        """
        lens, film = self.camera.lens, self.camera.film
        first_order = lens.first_order()
        return {
            "Software": f"realcam {_core.__version__}",
            "ExposureTime": float(self.camera.exposure_time_s),
            "FNumber": float(first_order.f_number),
            "Exif:PhotographicSensitivity": min(round(self.camera.iso), 65535),
            "Exif:FocalLength": float(first_order.effective_focal_length_mm),
            "Exif:LensModel": lens.name,
            "realcam:lens": lens.name,
            "realcam:model": self.camera.model,
            "realcam:focal_length_mm": f"{first_order.effective_focal_length_mm:.9g}",
            "realcam:f_number": f"{first_order.f_number:.9g}",
            "realcam:focus_distance_m": f"{lens.focus_distance_m:.9g}",
            "realcam:film_mm": f"{film.width_mm:.9g}x{film.height_mm:.9g}",
            "realcam:exposure_time_s": f"{self.camera.exposure_time_s:.9g}",
            "realcam:iso": f"{self.camera.iso:.9g}",
            "realcam:seed": str(self.seed),
            "realcam:spp": str(self.spp),
            "realcam:version": _core.__version__,
        }
