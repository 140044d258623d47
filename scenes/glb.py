"""Writes binary glTF 2.0 (.glb): meshes, instances of them, materials, and pictures inside."""

from __future__ import annotations

import json
import struct
from pathlib import Path
from typing import Any

import numpy as np
from shapes import Mesh

Json = dict[str, Any]


class Glb:
    """Collects a scene and writes it. Units are metres, y is up; emission is radiance in cd/m^2."""

    def __init__(self) -> None:
        self._bytes = bytearray()
        self._json: Json = {
            "asset": {"version": "2.0", "generator": "realcam"},
            "extensionsUsed": ["KHR_materials_emissive_strength"],
            "scene": 0,
            "scenes": [{"nodes": []}],
            "samplers": [{}],
        }

    def picture(self, png: bytes) -> int:
        """Adds a PNG as a texture and returns its number."""
        image = self._add("images", {"bufferView": self._view(png), "mimeType": "image/png"})
        return self._add("textures", {"source": image, "sampler": 0})

    def material(
        self,
        name: str,
        colour: tuple[float, float, float] = (1, 1, 1),
        *,
        roughness: float = 1.0,
        metallic: float = 0.0,
        texture: int | None = None,
        emission: tuple[float, float, float] = (0, 0, 0),
    ) -> int:
        """colour: linear reflectance. emission: cd/m^2 for each channel, on the front of a surface."""
        surface: Json = {
            "baseColorFactor": [*colour, 1],
            "metallicFactor": metallic,
            "roughnessFactor": roughness,
        }
        if texture is not None:
            surface["baseColorTexture"] = {"index": texture}
        material: Json = {"name": name, "pbrMetallicRoughness": surface}
        strength = max(emission)
        if strength > 0:
            # emissiveFactor itself may not exceed 1.
            material["emissiveFactor"] = [round(e / strength, 6) for e in emission]
            material["extensions"] = {"KHR_materials_emissive_strength": {"emissiveStrength": strength}}
        return self._add("materials", material)

    def mesh(self, name: str, parts: list[tuple[Mesh, int]]) -> int:
        """A mesh of several parts, each with its material; returns its number."""
        primitives = []
        for shape, material in parts:
            attributes = {"POSITION": self._accessor(shape.positions, "VEC3", bounds=True)}
            attributes["NORMAL"] = self._accessor(shape.normals, "VEC3")
            if shape.uvs is not None:
                attributes["TEXCOORD_0"] = self._accessor(shape.uvs, "VEC2")
            indices = self._accessor(shape.triangles.reshape(-1), "SCALAR")
            primitives.append({"attributes": attributes, "indices": indices, "material": material})
        return self._add("meshes", {"name": name, "primitives": primitives})

    def place(
        self, name: str, mesh: int, position: tuple[float, float, float] = (0, 0, 0), turn_deg: float = 0
    ) -> None:
        """Puts a mesh into the scene, turned about the vertical."""
        node: Json = {"name": name, "mesh": mesh}
        if any(position):
            node["translation"] = [round(p, 6) for p in position]
        if turn_deg:
            half = np.radians(turn_deg) / 2
            node["rotation"] = [0, round(float(np.sin(half)), 9), 0, round(float(np.cos(half)), 9)]
        self._json["scenes"][0]["nodes"].append(self._add("nodes", node))

    def write(self, path: Path) -> None:
        self._json["buffers"] = [{"byteLength": len(self._bytes)}]
        text = json.dumps(self._json, separators=(",", ":")).encode()
        chunks = [(text + b" " * (-len(text) % 4), b"JSON"), (bytes(self._bytes), b"BIN\0")]
        body = b"".join(struct.pack("<I", len(data)) + kind + data for data, kind in chunks)
        path.write_bytes(b"glTF" + struct.pack("<II", 2, 12 + len(body)) + body)

    def _add(self, kind: str, value: Json) -> int:
        values = self._json.setdefault(kind, [])
        values.append(value)
        return len(values) - 1

    def _view(self, data: bytes) -> int:
        view = self._add("bufferViews", {"buffer": 0, "byteOffset": len(self._bytes), "byteLength": len(data)})
        self._bytes += data + bytes(-len(data) % 4)
        return view

    def _accessor(self, values: np.ndarray, kind: str, *, bounds: bool = False) -> int:
        if kind == "SCALAR":
            small = values.max() < 65535
            data, component = values.astype(np.uint16 if small else np.uint32), 5123 if small else 5125
        else:
            # Rounded to a micrometre, so that the last bits of a machine's sine do not change the file.
            data, component = (np.round(values, 6) + 0.0).astype(np.float32), 5126
        accessor: Json = {"componentType": component, "count": len(data), "type": kind}
        if bounds:
            accessor["min"] = [float(v) for v in data.min(axis=0)]
            accessor["max"] = [float(v) for v in data.max(axis=0)]
        accessor["bufferView"] = self._view(data.tobytes())
        return self._add("accessors", accessor)
