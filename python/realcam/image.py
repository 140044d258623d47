"""A photograph: film exposure, depth and other layers, and how it was taken."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from . import _core, denoiser, notebook
from ._core import Camera, InputError, RenderSettings, RenderStats
from .files import system_name
from .number_text import counted
from .ocio import OcioView, develop
from .pickling import PickledByFields
from .settings import setting


@dataclass(frozen=True, eq=False)
class Image(PickledByFields):
    """A picture: the film's exposure, without sensor noise, and how it was taken.

    pixels: (H, W, 3) float32, exposure in lux seconds, linear Rec. 709, row 0 at the top.
    depth: (H, W) float32, metres along the camera's axis from the film; inf where no sample hit a surface. Mean over
      the samples that hit one, weighted by their contribution to the exposure.
    camera: the camera, with the planned model if it was planned. spp: samples per pixel; with the setting "auto", the
      mean over the pixels. seed: of the random numbers. stats: render time and numbers of rays.
    layers: the requested layers by name (docs/layers.md), arrays of shape (H, W), (H, W, 2) or (H, W, 3), float32, and
      uint32 for ids and sample counts. object_names, material_names: indexed by the ids in the layers; empty without id
      layers.
    settings: those of the render, with "auto" replaced by the planned values. plan: Plan.summary; empty without a plan.
    denoiser: name and version if the pixels were denoised, otherwise empty. shortfall: a sentence if the noise exceeds
      its limit, otherwise empty.
    tone, exr_color_space: how developed() and save() convert the pixels unless told otherwise.
    """

    pixels: np.ndarray
    depth: np.ndarray
    camera: Camera
    spp: int
    seed: int
    stats: RenderStats
    layers: Mapping[str, np.ndarray] = field(default_factory=dict)
    object_names: tuple[str, ...] = ()
    material_names: tuple[str, ...] = ()
    settings: RenderSettings = field(default_factory=lambda: RenderSettings(effects=()))
    denoiser: str = ""
    plan: str = ""
    shortfall: str = ""
    tone: str | OcioView = "film"
    exr_color_space: str = "rec709"

    transport, clamp_cd_m2 = setting("transport"), setting("clamp_cd_m2")
    effects, illuminant = setting("effects"), setting("illuminant")

    def __post_init__(self) -> None:
        pixels, depth = self.pixels, self.depth
        is_picture = isinstance(pixels, np.ndarray) and pixels.dtype.kind == "f" and pixels.shape[2:] == (3,)
        if not is_picture or pixels.size == 0:
            raise InputError("pixels must be an array of floats of shape (H, W, 3)")
        if not isinstance(depth, np.ndarray) or depth.dtype.kind != "f" or depth.shape != pixels.shape[:2]:
            raise InputError("depth must be an array of floats of shape (H, W), with H and W of the pixels")
        if not isinstance(self.layers, Mapping):
            raise InputError("layers must be a mapping of names to arrays")
        for name, layer in self.layers.items():
            if not isinstance(layer, np.ndarray) or layer.shape[:2] != depth.shape:
                raise InputError(f"the layer {name!r:.40} must be an array with H and W of the pixels")
        if not isinstance(self.camera, Camera):
            raise InputError("camera must be a Camera")
        for names in (self.object_names, self.material_names):
            if not isinstance(names, tuple) or not all(isinstance(name, str) for name in names):
                raise InputError("object_names and material_names must be tuples of texts")
        if not isinstance(self.tone, (str, OcioView)) or not isinstance(self.exr_color_space, str):
            raise InputError("tone must be a text or an OcioView, and exr_color_space a text")
        self.metadata()  # raises InputError for other attributes of the wrong type

    def __eq__(self, other: object) -> bool:
        """Returns True if pixels, layers, camera and metadata are equal; stats are not compared."""
        if not isinstance(other, Image):
            return NotImplemented
        mine, others = self._arrays(), other._arrays()
        return (
            self.metadata() == other.metadata()
            and self.camera == other.camera
            and (self.object_names, self.material_names) == (other.object_names, other.material_names)
            and mine.keys() == others.keys()
            and all(np.array_equal(mine[name], others[name], equal_nan=True) for name in mine)
        )

    def _arrays(self) -> dict[str, np.ndarray]:
        return {**self.layers, "pixels": self.pixels, "depth": self.depth}

    __hash__ = None  # type: ignore[assignment]  # its arrays may be written to

    def __repr__(self) -> str:
        height, width = self.depth.shape
        layers = f", with layers {', '.join(self.layers)}" if self.layers else ""
        denoised = ", denoised" if self.denoiser else ""
        return (
            f"<realcam.Image {width} x {height} pixels of {counted(self.spp, 'sample')}{denoised}{layers}, "
            f"taken with {self.camera!r:.60}>"
        )

    def _repr_png_(self) -> bytes:
        return notebook.picture_png(self.pixels, self.camera.iso, self.tone)

    def developed(self, tone: str | OcioView | None = None, iso: float | None = None) -> np.ndarray:
        """Returns the picture as 8-bit display values, (H, W, 3) uint8.

        tone: tone curve, "film" (soft highlights) or "linear" (clipped), with values in sRGB; or a view of
        OpenColorIO; None: the image's. iso: sensitivity; None: the camera's. An exposure of 10 / iso lux seconds is
        middle grey, which tone curves develop to 118. Raises InputError.
        """
        return develop(self.pixels, self.camera.iso if iso is None else iso, self.tone if tone is None else tone)

    def denoised(self, *, device: str = "auto") -> Image:
        """Returns the picture denoised by Intel's Open Image Denoise: for viewing, not for measurements.

        Requires the layers albedo, normal and traced_light, and the extra realcam[denoise] (docs/denoising.md). Only
        the pixels change; the layers variance and dual_pixel_*, which describe or contain the noise, are dropped.
        device: "auto" (a GPU if the denoiser can use one), "cpu", "cuda" or "cuda:1". Raises InputError if a layer or
        the extra is missing; DeviceError.
        """
        pixels, name = denoiser.denoised(self.pixels, self.layers, device)
        noisy = ("variance", "dual_pixel_left", "dual_pixel_right")
        layers = {layer: array for layer, array in self.layers.items() if layer not in noisy}
        return replace(self, pixels=pixels, layers=layers, denoiser=name)

    def save(
        self,
        path: str | os.PathLike[str],
        tone: str | OcioView | None = None,
        *,
        exr_color_space: str | None = None,
    ) -> None:
        """Writes .png, .jpg, .tif, .webp (developed) or .exr (film exposure R, G, B in lux seconds, depth as Z in
        metres, and all layers).

        tone: see Image.developed. exr_color_space: of the colours in .exr files, "rec709" or "acescg", both linear;
        None: the image's. Lens, f-number, focus, exposure time, ISO, seed and version are in the file's metadata.
        Raises ImageFileError; no half-written file is left. Existing files are replaced, even those that the scene was
        read from.
        """
        _core._write_picture(
            system_name(path),
            self,
            self.tone if tone is None else tone,
            self.exr_color_space if exr_color_space is None else exr_color_space,
        )

    def metadata(self) -> dict[str, str]:
        """Returns the metadata of picture files: values by their names "realcam:..."."""
        return _core._metadata(self)
