"""Writes the glTF 2.0 document in which a stage passes to realcam's glTF reader, as the bytes of a .glb."""

from __future__ import annotations

import json
import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

Json = dict[str, Any]

_COMPONENTS = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}
_FLOAT, _UINT32 = 5126, 5125


class Glb:
    """A glTF document under construction. Lengths are in the stage's unit, radiance in cd/m^2."""

    def __init__(self) -> None:
        self.json: Json = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}]}
        self._data = bytearray()

    def add(self, kind: str, element: Json) -> int:
        """Appends an element to a list of the document, such as "meshes", and returns its index."""
        elements: list[Json] = self.json.setdefault(kind, [])
        elements.append(element)
        return len(elements) - 1

    def light(self, element: Json) -> int:
        """Appends a light of KHR_lights_punctual and returns its index."""
        extension = self.json.setdefault("extensions", {}).setdefault("KHR_lights_punctual", {"lights": []})
        extension["lights"].append(element)
        return len(extension["lights"]) - 1

    def sampler(self, seconds: int, values: NDArray[Any], is_held: bool) -> int:
        """Adds a sampler to the animation, and returns its index. seconds: accessor of the times of its keys."""
        mode = "STEP" if is_held else "LINEAR"
        samplers: list[Json] = self._animation()["samplers"]
        samplers.append({"input": seconds, "output": self.floats(values), "interpolation": mode})
        return len(samplers) - 1

    def animate(self, node: int, path: str, sampler: int) -> None:
        """Animates the translation, rotation, scale or weights (`path`) of a node by a sampler."""
        self._animation()["channels"].append({"sampler": sampler, "target": {"node": node, "path": path}})

    def floats(self, values: NDArray[Any]) -> int:
        """Adds an array of shape (N,) or (N, 2 to 4) as 32-bit floats, and returns the index of its accessor."""
        return self._accessor(np.ascontiguousarray(values, np.float32), _FLOAT)

    def indices(self, values: NDArray[Any]) -> int:
        """Adds an array of shape (N,) of indices, and returns the index of its accessor."""
        return self._accessor(np.ascontiguousarray(values, np.uint32), _UINT32)

    def view(self, data: bytes) -> int:
        """Adds bytes to the binary chunk, and returns the index of their view."""
        element = {"buffer": 0, "byteOffset": len(self._data), "byteLength": len(data)}
        self._data += data + bytes(-len(data) % 4)
        return self.add("bufferViews", element)

    def encoded(self) -> bytes:
        """Returns the bytes of the .glb."""
        if self._data:
            self.json["buffers"] = [{"byteLength": len(self._data)}]
        text = json.dumps(self.json, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        chunks = struct.pack("<I", len(text)) + b"JSON" + text
        if self._data:
            chunks += struct.pack("<I", len(self._data)) + b"BIN\0" + self._data
        return b"glTF" + struct.pack("<II", 2, 12 + len(chunks)) + chunks

    def _animation(self) -> Json:
        animations: list[Json] = self.json.setdefault("animations", [{"channels": [], "samplers": []}])
        return animations[0]

    def _accessor(self, values: NDArray[Any], component: int) -> int:
        kind = _COMPONENTS[1 if values.ndim == 1 else values.shape[1]]
        element = {"componentType": component, "count": len(values), "type": kind}
        if len(values):
            element["bufferView"] = self.view(values.tobytes())
        return self.add("accessors", element)
