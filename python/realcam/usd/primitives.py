"""glTF meshes made of USD surfaces and the materials of their faces."""

from __future__ import annotations

from typing import Any

import numpy as np
from pxr import Usd

from .glb import Glb, Json
from .gltf_material import TranslatedMaterial
from .shading_network import DEFAULT_COLOUR
from .stage import OpenStage
from .surface import NORMAL_DELTAS, POINT_DELTAS, Surface, triangulated, vertex_arrays

# Pairs of indices of the prim's faces and their material; None: all faces that no other pair lists.
FaceMaterials = list[tuple[np.ndarray | None, TranslatedMaterial]]


def add_mesh(opened: OpenStage, glb: Glb, prim: Usd.Prim, surface: Surface, materials: FaceMaterials) -> int:
    """Adds a surface as a mesh of the document, with one primitive for each material that is used. Returns its
    index."""
    primitives = []
    is_unassigned = np.ones(len(surface.counts), bool)
    for faces, material in materials:
        has_it = is_unassigned if faces is None else is_unassigned & np.isin(surface.faces, faces)
        is_unassigned = is_unassigned & ~has_it
        if has_it.any():
            part = surface if has_it.all() else surface.kept(has_it)
            primitives.append(_primitive(opened, glb, prim, part, material))
    return glb.add("meshes", {"name": str(prim.GetPath()), "primitives": primitives})


def _primitive(opened: OpenStage, glb: Glb, prim: Usd.Prim, surface: Surface, material: TranslatedMaterial) -> Json:
    points, values, indices = vertex_arrays(surface, triangulated(surface))
    attributes = {"POSITION": glb.floats(points)}
    if "normals" in values:
        attributes["NORMAL"] = glb.floats(values["normals"])
    for i, name in enumerate(material.uv_names):
        st = values.get(name)
        if st is None or st.shape[1] < 2:
            opened.notices.add(prim.GetPath(), f"has no texture coordinates {name}, which its material reads")
            st = np.zeros((len(points), 2))
        if material.clamps and (st.min() < -1e-4 or st.max() > 1 + 1e-4):
            opened.notices.add(prim.GetPath(), "wrap mode black: the edge of the texture is repeated instead")
        attributes[f"TEXCOORD_{i}"] = glb.floats(np.stack([st[:, 0], 1 - st[:, 1]], axis=-1))
    colours = _colours(material, values, len(points))
    if colours is not None:
        attributes["COLOR_0"] = glb.floats(colours)
    primitive = {"attributes": attributes, "indices": glb.indices(indices.ravel()), "material": material.index}
    if POINT_DELTAS in values:
        primitive["targets"] = _targets(glb, values)
    return primitive


def _targets(glb: Glb, values: dict[str, Any]) -> list[Json]:
    """Returns the morph targets of a deforming surface."""
    names = {"POSITION": POINT_DELTAS, "NORMAL": NORMAL_DELTAS}
    columns = range(0, values[POINT_DELTAS].shape[1], 3)
    return [
        {kind: glb.floats(values[name][:, k : k + 3]) for kind, name in names.items() if name in values}
        for k in columns
    ]


def _colours(material: TranslatedMaterial, values: dict[str, Any], count: int) -> np.ndarray | None:
    """Returns vertex colours, (V, 3 or 4); None if there are none."""
    if not material.colours and not material.opacities:
        return None
    rgb = np.ones((count, 3))
    if material.colours:
        found = values.get(material.colours)
        rgb = found if found is not None and found.shape[1] == 3 else rgb * np.array(DEFAULT_COLOUR)
    alpha = values.get(material.opacities or "")
    return np.asarray(rgb if alpha is None else np.hstack([rgb, alpha[:, :1]]))
