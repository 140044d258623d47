"""Materials: UsdPreviewSurface as materials of glTF."""

from __future__ import annotations

from typing import Any

from pxr import Sdf, UsdShade

from .assets import asset_of
from .glb import Glb, Json
from .gltf_material import MaterialBuilder, TranslatedMaterial, set_emission
from .shading_network import ShadingNetwork
from .stage import OpenStage
from .textures import Mapping, Pictures, Sampled


class Materials:
    """Translates the materials of a stage, each once."""

    def __init__(self, opened: OpenStage, glb: Glb) -> None:
        self._opened = opened
        self._glb = glb
        self._pictures = Pictures(glb)
        self._known: dict[Any, TranslatedMaterial] = {}

    def of_material(self, material: UsdShade.Material | None, light: tuple[float, ...] | None) -> TranslatedMaterial:
        """Returns a bound material. None: the matte material of prims without one, whose colour is displayColor.
        light: radiance of a mesh light, which replaces the material's own."""
        key = (str(material.GetPath()) if material else "", light)
        if key not in self._known:
            surface = self._surface_of(material) if material else None
            self._known[key] = self._translated(material, surface, light)
        return self._known[key]

    def of_light(self, name: str, radiance: tuple[float, ...], texture: Sampled | None = None) -> TranslatedMaterial:
        """Returns a black material that emits, in cd/m^2, from the front. texture: factor on the radiance."""
        key = (name, radiance, texture)
        if key not in self._known:
            json: Json = {"name": name, "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0}}
            json["extensions"] = {"KHR_materials_specular": {"specularFactor": 0}}
            set_emission(json, radiance)
            uv_names = []
            if texture:
                uv_names = [texture.mapping.primvar]
                json["emissiveTexture"] = self._pictures.file_texture(texture, 0)
            self._known[key] = TranslatedMaterial(self._glb.add("materials", json), uv_names)
        return self._known[key]

    def texture(self, asset_path: Sdf.AssetPath, primvar: str) -> Sampled | None:
        """Returns the texture of a light; None if there is no such file."""
        asset = asset_of(self._opened, asset_path)
        wraps = ("clamp", "clamp")
        return Sampled(self._pictures.picture(asset), "rgb", Mapping(primvar, wraps=wraps)) if asset.exists else None

    def _surface_of(self, material: UsdShade.Material) -> UsdShade.Shader | None:
        """Returns the material's UsdPreviewSurface; None, with a notice, if it has another surface."""
        source = material.ComputeSurfaceSource()
        shader = source[0] if source else None
        if not shader:
            self._opened.notices.add(material.GetPath(), "has no surface; a grey one is used")
        elif shader.GetIdAttr().Get() != "UsdPreviewSurface":
            found = shader.GetIdAttr().Get() or "a surface without an id"
            self._opened.notices.add(
                material.GetPath(), f"expected a UsdPreviewSurface; found {found}; a grey surface is used"
            )
        else:
            return shader
        return None

    def _translated(
        self, material: UsdShade.Material | None, surface: UsdShade.Shader | None, light: tuple[float, ...] | None
    ) -> TranslatedMaterial:
        name = material.GetPrim().GetName() if material else "displayColor"
        network = ShadingNetwork(self._opened, self._pictures, surface)
        builder = MaterialBuilder(self._opened, self._pictures, network, name, None if material else "displayColor")
        json = builder.json()
        if light is not None:
            json.pop("emissiveTexture", None)
            set_emission(json, light)
        result = builder.result
        result.index = self._glb.add("materials", json)
        return result
