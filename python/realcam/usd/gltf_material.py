"""glTF material of a UsdPreviewSurface."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..rec709 import srgb_of_linear
from .glb import Json
from .shading_network import DEFAULTS, Primvar, ShadingNetwork
from .stage import OpenStage
from .textures import Floats, Pictures, Sampled, same_size


@dataclass
class TranslatedMaterial:
    """A material of the document. index: of "materials". uv_names: primvars of its texture coordinates, in the
    order of glTF's sets. colours, opacities: names of the primvars that multiply its colour and opacity, or None.
    clamps: a texture has wrap mode black, and its edge is repeated instead."""

    index: int
    uv_names: list[str] = field(default_factory=list)
    colours: str | None = None
    opacities: str | None = None
    clamps: bool = False


class MaterialBuilder:
    """Builds the glTF material of a UsdPreviewSurface."""

    def __init__(
        self, opened: OpenStage, pictures: Pictures, network: ShadingNetwork, name: str, colours: str | None
    ) -> None:
        self._opened, self._pictures, self._network, self._name = opened, pictures, network, name
        self._is_matte = colours is not None
        self.result = TranslatedMaterial(-1, colours=colours, opacities="displayOpacity" if colours else None)

    def json(self) -> Json:
        """Returns the material, and sets `result` but for its index."""
        value = self._network.input
        json: Json = {"name": self._name, "extensions": {}}
        if self.result.colours:
            colour: Any = (1.0, 1.0, 1.0)
        else:
            colour = self._colour(value("diffuseColor"))
        opacity = self._opacity(value("opacity"))
        base, textures = self._base(colour, opacity)
        if value("useSpecularWorkflow"):
            json["extensions"]["KHR_materials_pbrSpecularGlossiness"] = self._specular_workflow(base, textures)
        else:
            json["pbrMetallicRoughness"] = self._metallic_workflow(base, textures)
        self._alpha(json, base, opacity, bool(textures))
        self._emission(json, value("emissiveColor"))
        self._normal(json, value("normal"))
        self._clearcoat(json)
        if self._is_matte:
            json["extensions"]["KHR_materials_specular"] = {"specularFactor": 0}
        ior = self._constant("ior")
        if ior >= 1:
            json["extensions"]["KHR_materials_ior"] = {"ior": ior}
        for name in ("displacement", "occlusion"):
            if value(name) != DEFAULTS[name]:
                self._notice(f"{name} is left out")
        self.result.clamps = self._network.uses_black_wrap
        return json

    def _notice(self, text: str) -> None:
        self._opened.notices.add(self._network.path, text)

    def _constant(self, name: str) -> float:
        value = self._network.input(name)
        if isinstance(value, (Sampled, Primvar)):
            self._notice(f"{name}: a texture or primvar is left out; {DEFAULTS[name]:g} is used")
            return float(DEFAULTS[name])
        return float(value)

    def _colour(self, value: Any) -> Any:
        if isinstance(value, Primvar):
            self.result.colours = value.name
            return (1.0, 1.0, 1.0)
        return value

    def _opacity(self, value: Any) -> Any:
        if isinstance(value, Primvar):
            self.result.opacities = value.name
            return 1.0
        return value

    def _base(self, colour: Any, opacity: Any) -> tuple[list[float], Json]:
        """Returns the factors (r, g, b, opacity) and the texture of colour and opacity, as {"...": textureInfo}."""
        factor = [1.0, 1.0, 1.0, 1.0]
        if not isinstance(opacity, Sampled):
            factor[3] = _unit(opacity)
        if not isinstance(colour, Sampled):
            factor[:3] = [_unit(c) for c in colour]
        if not isinstance(colour, Sampled) and not isinstance(opacity, Sampled):
            return factor, {}
        if isinstance(colour, Sampled) and self._is_plain_colour(colour, opacity):
            return factor, self._file(colour)
        parts = [colour if isinstance(colour, Sampled) else (1.0, 1.0, 1.0)]
        if isinstance(opacity, Sampled):
            parts.append(opacity)
        return factor, self._computed("colour", parts, is_colour=True)

    def _is_plain_colour(self, colour: Sampled, opacity: Any) -> bool:
        """True if glTF reads colour and opacity from the file as the stage does."""
        is_8_bit = colour.picture.values.dtype == np.uint8
        has_space = colour.picture.is_srgb(colour.space) if is_8_bit else colour.space != "sRGB"
        if colour.output != "rgb" or not colour.has_identity() or not has_space or not is_8_bit:
            return False
        if not isinstance(opacity, Sampled):
            return True
        same = opacity.picture is colour.picture and opacity.mapping == colour.mapping
        return same and opacity.output == "a" and opacity.has_identity()

    def _metallic_workflow(self, base: list[float], textures: Json) -> Json:
        json: Json = {"baseColorFactor": base}
        if textures:
            json["baseColorTexture"] = textures
        metallic, roughness = self._number("metallic"), self._number("roughness")
        json["metallicFactor"] = 1.0 if isinstance(metallic, Sampled) else metallic
        json["roughnessFactor"] = 1.0 if isinstance(roughness, Sampled) else roughness
        if isinstance(metallic, Sampled) or isinstance(roughness, Sampled):
            info = self._roughness_and_metallic(roughness, metallic)
            if info:
                json["metallicRoughnessTexture"] = info
        return json

    def _number(self, name: str) -> Any:
        value = self._network.input(name)
        if isinstance(value, Primvar):
            self._notice(f"{name}: a primvar is left out; {DEFAULTS[name]:g} is used")
            return float(DEFAULTS[name])
        return value if isinstance(value, Sampled) else _unit(value)

    def _roughness_and_metallic(self, roughness: Any, metallic: Any) -> Json:
        """Returns the texture with roughness in green and metallic in blue; {} if it cannot be computed."""

        def is_plain(value: Any, output: str) -> bool:
            if not isinstance(value, Sampled):
                return True
            return value.output == output and value.has_identity() and not value.picture.is_srgb(value.space)

        sampled = [value for value in (roughness, metallic) if isinstance(value, Sampled)]
        first = sampled[0]
        is_one_file = all(v.picture is first.picture and v.mapping == first.mapping for v in sampled)
        # The other channel of the file multiplies its factor, so that both must come from the file.
        if len(sampled) == 2 and is_one_file and is_plain(roughness, "g") and is_plain(metallic, "b"):
            return self._file(first)
        one = (1.0,)
        parts = [one, *(v if isinstance(v, Sampled) else one for v in (roughness, metallic))]
        return self._computed("roughness", parts, is_colour=False)

    def _specular_workflow(self, base: list[float], textures: Json) -> Json:
        json: Json = {"diffuseFactor": base}
        if textures:
            json["diffuseTexture"] = textures
        specular, roughness = self._network.input("specularColor"), self._number("roughness")
        if isinstance(specular, Primvar):
            self._notice("specularColor: a primvar is left out")
            specular = DEFAULTS["specularColor"]
        json["specularFactor"] = [1.0] * 3 if isinstance(specular, Sampled) else [_unit(c) for c in specular]
        json["glossinessFactor"] = 1.0 if isinstance(roughness, Sampled) else 1 - roughness
        if isinstance(specular, Sampled) or isinstance(roughness, Sampled):
            rgb = specular if isinstance(specular, Sampled) else (1.0, 1.0, 1.0)
            # The texture's alpha is glossiness, 1 - roughness.
            gloss: Any = (1.0,)
            if isinstance(roughness, Sampled):
                scale, bias = tuple(-s for s in roughness.scale), tuple(1 - b for b in roughness.bias)
                gloss = Sampled(roughness.picture, roughness.output, roughness.mapping, scale, bias, roughness.space)
            info = self._computed("glossiness", [rgb, gloss], is_colour=True)
            if info:
                json["specularGlossinessTexture"] = info
        return json

    def _alpha(self, json: Json, base: list[float], opacity: Any, has_texture: bool) -> None:
        """Sets how opacity acts: an alpha test, transmitted light, or coverage."""
        threshold = self._constant("opacityThreshold")
        has_opacity = isinstance(opacity, Sampled) or base[3] < 1 or self.result.opacities
        if not has_opacity:
            return
        if threshold > 0:
            json.update({"alphaMode": "MASK", "alphaCutoff": threshold})
            return
        is_glass = self._network.input("opacityMode") == "transparent" and base[3] < 1
        if is_glass and not has_texture and not self.result.opacities and "pbrMetallicRoughness" in json:
            # Highlights stay on a transparent surface. glTF tints transmitted light by the base colour, and
            # UsdPreviewSurface does not: the colour becomes white as the surface becomes clear.
            share = base[3]
            json["pbrMetallicRoughness"]["baseColorFactor"] = [share * c + 1 - share for c in base[:3]] + [1.0]
            json["extensions"]["KHR_materials_transmission"] = {"transmissionFactor": 1 - share}
        else:
            json["alphaMode"] = "BLEND"

    def _emission(self, json: Json, value: Any) -> None:
        if isinstance(value, Primvar):
            self._notice("emissiveColor: a primvar is left out")
        elif not isinstance(value, Sampled):
            set_emission(json, value)
        else:
            linear = np.maximum(value.linear(), 0)
            strength = float(linear.max())
            if strength <= 0:
                return
            if self._is_plain_colour(value, 1.0):
                info, strength = self._file(value), 1.0
            else:
                scale, bias = (tuple(v / strength for v in values) for values in (value.scale, value.bias))
                scaled = Sampled(value.picture, value.output, value.mapping, scale, bias, value.space)
                info = self._computed("emission", [scaled], is_colour=True)
            if info:
                json["emissiveTexture"] = info
                set_emission(json, (strength,) * 3)

    def _normal(self, json: Json, value: Any) -> None:
        if not isinstance(value, Sampled):
            return  # a constant is the mesh's own normal in tangent space
        is_usual = value.scale[:3] == (2, 2, 2) and value.bias[:3] == (-1, -1, -1) and value.output == "rgb"
        if is_usual and not value.picture.is_srgb(value.space):
            json["normalTexture"] = self._file(value)
            return
        scale = tuple(s / 2 for s in value.scale)
        bias = tuple((b + 1) / 2 for b in value.bias)
        encoded = Sampled(value.picture, value.output, value.mapping, scale, bias, value.space)
        info = self._computed("normal", [encoded], is_colour=False)
        if info:
            json["normalTexture"] = info

    def _clearcoat(self, json: Json) -> None:
        coat, roughness = self._number("clearcoat"), self._number("clearcoatRoughness")
        if not isinstance(coat, Sampled) and coat == 0:
            return
        out: Json = {}
        for key, value, channel in (("clearcoat", coat, 0), ("clearcoatRoughness", roughness, 1)):
            out[f"{key}Factor"] = 1.0 if isinstance(value, Sampled) else value
            if isinstance(value, Sampled):
                parts: list[Any] = [(1.0,)] * channel + [value] + [(1.0,)] * (2 - channel)
                info = self._computed(key, parts, is_colour=False)
                if info:
                    out[f"{key}Texture"] = info
        json["extensions"]["KHR_materials_clearcoat"] = out

    def _file(self, sampled: Sampled) -> Json:
        return self._pictures.file_texture(sampled, self._uv_set(sampled.mapping.primvar))

    def _uv_set(self, primvar: str) -> int:
        names = self.result.uv_names
        if primvar not in names:
            names.append(primvar)
        return names.index(primvar)

    def _computed(self, use: str, parts: list[Any], *, is_colour: bool) -> Json:
        """Returns the texture of several parts side by side: textures or constants. Colours are encoded as sRGB, but
        for a fourth channel. {} if it would be too large."""
        sampled = [part for part in parts if isinstance(part, Sampled)]
        first = sampled[0]
        if any(part.mapping != first.mapping for part in sampled):
            self._notice(f"{use}: its textures have several mappings, and only the first one is used")
        try:
            values = [
                p.linear() if isinstance(p, Sampled) else np.array(p, np.float64).reshape(1, 1, -1) for p in parts
            ]
            table = np.clip(np.concatenate(same_size(_with_three(values)), axis=-1), 0, 1)
        except ValueError as error:
            self._notice(f"{use}: {error}; it is left out")
            return {}
        if is_colour:
            table = np.concatenate([srgb_of_linear(table[..., :3]), table[..., 3:]], axis=-1)
        key = (use, *(part if not isinstance(part, tuple) else ("constant", *part) for part in parts))
        uv_set = self._uv_set(first.mapping.primvar)
        return self._pictures.computed_texture(key, table, f"{self._name} {use}", first.mapping, uv_set)


def _with_three(values: list[Floats]) -> list[Floats]:
    """Returns the parts with at least three channels: a single grey part is repeated."""
    total = sum(v.shape[-1] for v in values)
    if values[0].shape[-1] == 1 and total < 3:
        return [np.repeat(values[0], 3, axis=-1), *values[1:]]
    return values


def set_emission(json: Json, radiance: Any) -> None:
    """Sets a material's radiance, in cd/m^2."""
    factor = [max(float(c), 0.0) for c in radiance]
    strength = max(factor)
    if strength > 0:
        json["emissiveFactor"] = [c / strength for c in factor]
        json.setdefault("extensions", {})["KHR_materials_emissive_strength"] = {"emissiveStrength": strength}


def _unit(value: Any) -> float:
    return min(max(float(value), 0.0), 1.0)
