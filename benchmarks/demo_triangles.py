"""Triangles of scenes/demo.glb by material, for programs that cannot read glTF."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

DEMO = Path(__file__).parent.parent / "scenes" / "demo.glb"
# glTF component types, and numbers per element by accessor type.
DTYPES = {5123: np.uint16, 5125: np.uint32, 5126: np.float32}
WIDTHS = {"SCALAR": 1, "VEC3": 3}

Mesh = tuple[np.ndarray, np.ndarray]


def demo_triangles() -> list[tuple[Mesh, float]]:
    """Returns all primitives as (points, faces), in metres, with the mean radiance of their channels, cd/m^2.

    Raises ValueError for nodes with a matrix or children, which the scene does not have.
    """
    data = DEMO.read_bytes()
    json_bytes = int.from_bytes(data[12:16], "little")
    gltf, buffer = json.loads(data[20 : 20 + json_bytes]), data[28 + json_bytes :]

    def array(accessor: int) -> np.ndarray:
        """(count, width): content of an accessor, by its index."""
        about = gltf["accessors"][accessor]
        view = gltf["bufferViews"][about["bufferView"]]
        width = WIDTHS[about["type"]]
        offset = view.get("byteOffset", 0) + about.get("byteOffset", 0)
        values = np.frombuffer(buffer, DTYPES[about["componentType"]], about["count"] * width, offset)
        return values.reshape(-1, width)

    parts = []
    for node in gltf["nodes"]:
        if "mesh" not in node:
            continue
        if {"matrix", "children"} & node.keys():
            raise ValueError("the demo's nodes must have translation, rotation and scale only")
        rotation = Rotation.from_quat(node.get("rotation", (0, 0, 0, 1)))
        for part in gltf["meshes"][node["mesh"]]["primitives"]:
            points = rotation.apply(array(part["attributes"]["POSITION"]) * node.get("scale", (1, 1, 1)))
            faces = array(part["indices"]).reshape(-1, 3).astype(np.int64)
            parts.append(((points + node.get("translation", (0, 0, 0)), faces), radiance(gltf, part["material"])))
    return parts


def radiance(gltf: dict, material: int) -> float:
    """Mean emitted radiance of a material's channels, cd/m^2."""
    about = gltf["materials"][material]
    strength = about.get("extensions", {}).get("KHR_materials_emissive_strength", {}).get("emissiveStrength", 1)
    return float(np.mean(about.get("emissiveFactor", (0, 0, 0))) * strength)
