"""Dome lights as an environment map."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pxr import Gf, Sdf, Usd, UsdGeom, UsdLux

from .._core import Scene
from ..image_file import read_environment
from .assets import asset_of, extracted
from .lights import radiance_of
from .stage import OpenStage

Pixels = NDArray[np.floating[Any]]


@dataclass
class Domes:
    """The dome lights of a stage: constant radiance, and maps with their rotations to the scene."""

    opened: OpenStage
    constant: Pixels = field(default_factory=lambda: np.zeros(3))
    maps: list[tuple[Pixels, Pixels]] = field(default_factory=list)

    def add(self, prim: Usd.Prim, scene_from_dome: Gf.Matrix4d) -> None:
        """Adds a dome light. scene_from_dome: matrix of the prim to the scene, where y is up."""
        radiance = radiance_of(self.opened, prim)
        pixels = self._texture(prim)
        if UsdLux.LightAPI(prim).GetNormalizeAttr().Get(self.opened.time):
            self.opened.notices.add(prim.GetPath(), "normalize has no meaning for a dome light")
        if pixels is None:
            self.constant = self.constant + np.array(radiance)
            return
        rotation = _rotation(scene_from_dome, _turns_to_z(prim, self.opened))
        self.maps.append((pixels * np.array(radiance, np.float32), rotation))

    def light(self, scene: Scene) -> Scene:
        """Returns the scene with the light of the domes; unchanged if there are none."""
        if not self.maps:
            return scene.with_environment(tuple(map(float, self.constant))) if self.constant.any() else scene
        if len(self.maps) == 1 and not self.constant.any():
            pixels, rotation = self.maps[0]
            if np.allclose(rotation[1], (0, 1, 0), atol=1e-6):
                # A dome's map has +z in its centre (OpenEXR's convention), and realcam's -z.
                turn = math.degrees(math.atan2(rotation[0, 2], rotation[2, 2]))
                return scene.with_environment(pixels, rotation_deg=turn + 180)
        largest = max((pixels for pixels, _ in self.maps), key=lambda pixels: pixels.size)
        total = np.zeros(largest.shape, np.float64) + self.constant
        for pixels, rotation in self.maps:
            total += _resampled(pixels, rotation, largest.shape[0], largest.shape[1])
        return scene.with_environment(total.astype(np.float32))

    def _texture(self, prim: Usd.Prim) -> Pixels | None:
        light, time = UsdLux.DomeLight(prim), self.opened.time
        if prim.IsA(UsdLux.DomeLight_1):
            light = UsdLux.DomeLight_1(prim)
        path = light.GetTextureFileAttr().Get(time)
        if not isinstance(path, Sdf.AssetPath) or not path.path:
            return None
        layout = light.GetTextureFormatAttr().Get(time)
        if layout not in ("automatic", "latlong"):
            self.opened.notices.add(prim.GetPath(), f"texture:format: expected latlong; found {layout}; it is left out")
            return None
        asset = asset_of(self.opened, path)
        if not asset.exists:
            self.opened.notices.add(prim.GetPath(), f"{path.path}: no such file; the dome has no texture")
            return None
        file = asset.path or str(extracted("dome.png", asset.data))
        return np.asarray(read_environment(file))


def _turns_to_z(prim: Usd.Prim, opened: OpenStage) -> bool:
    """True if the pole of the dome is z instead of y."""
    if not prim.IsA(UsdLux.DomeLight_1):
        return False
    axis = UsdLux.DomeLight_1(prim).GetPoleAxisAttr().Get(opened.time)
    return bool(axis == "Z" or (axis == "scene" and UsdGeom.GetStageUpAxis(opened.stage) == "Z"))


def _rotation(scene_from_dome: Gf.Matrix4d, turns_to_z: bool) -> Pixels:
    """Returns the matrix (3, 3), for column vectors, of directions of the map to the scene."""
    matrix: Pixels = np.array(scene_from_dome.RemoveScaleShear())[:3, :3].T
    if turns_to_z:
        matrix = matrix @ np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])  # takes +y to +z
    return matrix


def _resampled(pixels: Pixels, rotation: Pixels, height: int, width: int) -> Pixels:
    """Returns a dome's map in realcam's frame, (height, width, 3), by bilinear interpolation."""
    latitude = np.pi * (np.arange(height) + 0.5) / height
    longitude = 2 * np.pi * ((np.arange(width) + 0.5) / width - 0.5)
    sine = np.sin(latitude)[:, None]
    directions = np.stack(
        [
            sine * np.sin(longitude),
            np.broadcast_to(np.cos(latitude)[:, None], (height, width)),
            -sine * np.cos(longitude),
        ],
        axis=-1,
    )
    local = directions @ rotation  # the inverse of a rotation, applied to column vectors
    u = 0.5 + np.arctan2(-local[..., 0], local[..., 2]) / (2 * np.pi)
    v = np.arccos(np.clip(local[..., 1], -1, 1)) / np.pi
    x, y = u * pixels.shape[1] - 0.5, np.clip(v * pixels.shape[0] - 0.5, 0, pixels.shape[0] - 1)
    column, row = np.floor(x).astype(int), np.floor(y).astype(int)
    right, down = (x - column)[..., None], (y - row)[..., None]
    next_row = np.minimum(row + 1, pixels.shape[0] - 1)
    first, second = column % pixels.shape[1], (column + 1) % pixels.shape[1]
    upper = pixels[row, first] * (1 - right) + pixels[row, second] * right
    lower = pixels[next_row, first] * (1 - right) + pixels[next_row, second] * right
    return np.asarray(upper * (1 - down) + lower * down)
