"""Textures of one glTF material that lie by two sets of texture coordinates."""

from __future__ import annotations

import base64
import json
import struct
import zlib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import realcam as rc

POSITIONS = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)]
# TEXCOORD_1 is TEXCOORD_0 turned by a right angle and scaled: u1 = 0.5 v0 + 0.25, v1 = 1 - u0.
FIRST = [(0, 1), (1, 1), (1, 0), (0, 0)]
SECOND = [(0.5 * v + 0.25, 1 - u) for u, v in FIRST]
# The same as KHR_texture_transform, which scales, then turns against the clock with v downwards, then moves: by a right
# angle (u, v) becomes (v, -u).
AS_TRANSFORM = {"scale": [1, 0.5], "rotation": float(np.pi / 2), "offset": [0.25, 1]}


def data_uri(kind: str, content: bytes) -> str:
    return f"data:{kind};base64,{base64.b64encode(content).decode()}"


def png(pixels: np.ndarray) -> bytes:
    """(H, W, 4) uint8."""

    def chunk(name: bytes, content: bytes) -> bytes:
        return struct.pack(">I", len(content)) + name + content + struct.pack(">I", zlib.crc32(name + content))

    rows = b"".join(b"\0" + row.tobytes() for row in pixels)
    size = struct.pack(">IIBBBBB", pixels.shape[1], pixels.shape[0], 8, 6, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", size) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def pictures() -> list[np.ndarray]:
    """Three that look like nothing turned: colours, a normal map whose normals lean by up to 40 degrees, and holes."""
    row, column = np.mgrid[0:16, 0:16]
    colours = np.stack([15 * column + 15, 10 * row + 60, 7 * (row + column) + 20, 255 + 0 * row], axis=-1)
    lean = np.stack([np.sin(row / 5.0) * 0.6, np.cos(column / 3.0) * 0.4], axis=-1)
    normals = np.concatenate([lean, np.sqrt(1 - (lean**2).sum(axis=-1, keepdims=True)), np.ones((16, 16, 1))], axis=-1)
    holes = np.stack([255 + 0 * row] * 3 + [np.where(row + 2 * column < 18, 255, 0)], axis=-1)
    return [colours.astype(np.uint8), (127.5 + 127.5 * normals).round().astype(np.uint8), holes.astype(np.uint8)]


def scene_file(path: Path, material: dict[str, Any], sets: Sequence[Sequence[tuple[float, float]]]) -> rc.Scene:
    arrays = [np.array(POSITIONS, np.float32), *(np.array(uvs, np.float32) for uvs in sets)]
    indices = np.array([0, 1, 2, 0, 2, 3], np.uint16)
    blobs = [a.tobytes() for a in (*arrays, indices)]
    offsets = np.cumsum([0, *map(len, blobs)])
    primitive = {
        "attributes": {"POSITION": 0} | {f"TEXCOORD_{i}": 1 + i for i in range(len(sets))},
        "indices": len(arrays),
        "material": 0,
    }
    gltf = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [primitive]}],
        "materials": [material],
        "textures": [{"source": i} for i in range(3)],
        "images": [{"uri": data_uri("image/png", png(p))} for p in pictures()],
        "buffers": [{"uri": data_uri("application/octet-stream", b"".join(blobs)), "byteLength": int(offsets[-1])}],
        "bufferViews": [
            {"buffer": 0, "byteOffset": int(offset), "byteLength": len(blob)}
            for offset, blob in zip(offsets, blobs, strict=False)
        ],
        "accessors": [
            {"bufferView": i, "componentType": 5126, "type": f"VEC{a.shape[1]}", "count": len(a)}
            for i, a in enumerate(arrays)
        ]
        + [{"bufferView": len(arrays), "componentType": 5123, "type": "SCALAR", "count": 6}],
    }
    path.write_text(json.dumps(gltf))
    return rc.Scene.load(path)


def material_with(second: dict[str, Any], member: str) -> dict[str, Any]:
    """A material whose texture of that name lies by the second set, or by what `second` says, and all others by the
    first."""

    def info(name: str, source: int) -> dict[str, Any]:
        return {"index": source} | (second if name == member else {})

    material = {
        "pbrMetallicRoughness": {
            "baseColorTexture": info("base", 0),
            "metallicRoughnessTexture": info("rough", 0),
            "metallicFactor": 0.6,
        },
        "normalTexture": info("normal", 1),
        "emissiveTexture": info("emission", 0),
        "emissiveFactor": [0.1, 0.2, 0.3],
        "extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 0.8, "clearcoatTexture": info("coat", 0)}},
    }
    if member == "holes":
        material["pbrMetallicRoughness"]["baseColorTexture"] = {"index": 2} | second
        material["alphaMode"] = "MASK"
    return material


@pytest.mark.parametrize("member", ["base", "rough", "normal", "emission", "coat", "holes"])
def test_a_second_set_of_coordinates_lies_as_a_transform_of_the_first(member: str, device: str, tmp_path: Path) -> None:
    lens = rc.Lens.load("double-gauss-50mm").focused(3.0).stopped_down(8)
    camera = rc.Camera(lens, film=rc.Film(36, 24, (96, 64)), position=(0, 0, 3), look_at=(0, 0, 0), exposure_time_s=1)

    def picture(scene: rc.Scene) -> np.ndarray:
        lit = scene.with_point_light((1, 1.5, 2), (100, 90, 80)).with_environment((0.2, 0.2, 0.2))
        return rc.render(lit, camera, spp=16, device=device, effects=()).pixels

    both = picture(scene_file(tmp_path / "two.gltf", material_with({"texCoord": 1}, member), [FIRST, SECOND]))
    moved = {"extensions": {"KHR_texture_transform": AS_TRANSFORM}}
    by_transform = picture(scene_file(tmp_path / "one.gltf", material_with(moved, member), [FIRST]))
    neither = picture(scene_file(tmp_path / "none.gltf", material_with({}, member), [FIRST]))
    assert np.abs(by_transform - neither).max() > 0.005 * neither.max()
    # The corners' coordinates are exact; what is between them is rounded in another order. A texel's edge lies off by
    # less than 1e-5 of a texel, and a sample on the other side of a hole's edge counts for a 16th of its pixel.
    near = np.abs(both - by_transform) <= 1e-4 * by_transform.max()
    assert near.mean() > (0.999 if member == "holes" else 1 - 1e-9)
