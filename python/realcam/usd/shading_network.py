"""Shading networks: inputs of a UsdPreviewSurface and what they are connected to."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from pxr import Gf, Sdf, UsdShade

from .._core import ImageFileError
from .assets import asset_of
from .stage import OpenStage
from .textures import Mapping, Pictures, Sampled

DEFAULT_COLOUR = (0.18, 0.18, 0.18)  # UsdPreviewSurface's diffuseColor

DEFAULTS: dict[str, Any] = {
    "diffuseColor": DEFAULT_COLOUR,
    "emissiveColor": (0.0, 0.0, 0.0),
    "useSpecularWorkflow": 0,
    "specularColor": (0.0, 0.0, 0.0),
    "metallic": 0.0,
    "roughness": 0.5,
    "clearcoat": 0.0,
    "clearcoatRoughness": 0.01,
    "opacity": 1.0,
    "opacityMode": "transparent",
    "opacityThreshold": 0.0,
    "ior": 1.5,
    "normal": None,
    "displacement": 0.0,
    "occlusion": 1.0,
}
_COLOURS = ("diffuseColor", "emissiveColor", "specularColor")
_MAX_NODES = 100  # of a shading network between a surface and its textures


@dataclass(frozen=True)
class Primvar:
    """An input that reads a primvar, such as displayColor."""

    name: str


class ShadingNetwork:
    """Inputs of a UsdPreviewSurface: constants, textures, or primvars."""

    def __init__(self, opened: OpenStage, pictures: Pictures, surface: UsdShade.Shader | None) -> None:
        self._opened, self._pictures, self._surface = opened, pictures, surface
        self.path = surface.GetPath() if surface else Sdf.Path.emptyPath
        self.uses_black_wrap = False

    def input(self, name: str) -> Any:
        """Returns the value of an input: a number, a tuple of three, a text, a Sampled or a Primvar."""
        default = DEFAULTS[name]
        port = self._surface.GetInput(name) if self._surface else None
        if not port:
            return default
        value, has_channels = self._resolved(port, default), name in _COLOURS or name == "normal"
        if isinstance(value, Sampled) and value.output == "rgb" and not has_channels:
            self._opened.notices.add(self.path, f"{name}: is connected to rgb; its r is used")
            return replace(value, output="r")
        if isinstance(value, (Sampled, Primvar)):
            return value
        if has_channels:
            return _triple(value, default)
        if isinstance(default, str):
            return str(value)
        return _number(value, default)

    def _resolved(self, port: UsdShade.Input, default: Any) -> Any:
        attributes = port.GetValueProducingAttributes()
        if not attributes:
            return default
        attribute = attributes[0]
        shader = UsdShade.Shader(attribute.GetPrim())
        output = attribute.GetName()
        if not output.startswith("outputs:"):
            value = attribute.Get(self._opened.time)
            if attribute.ValueMightBeTimeVarying():
                self._opened.notices.add(
                    attribute.GetPath(), "its values over time are left out; the first one is used"
                )
            return default if value is None else value
        kind = str(shader.GetIdAttr().Get() or "")
        if kind == "UsdUVTexture":
            return self._sampled(shader, output.removeprefix("outputs:"), default)
        if kind.startswith("UsdPrimvarReader_"):
            return Primvar(str(self._value(shader, "varname", "")))
        self._opened.notices.add(
            shader.GetPath(), f"expected a UsdUVTexture or UsdPrimvarReader; found {kind or 'no id'}; it is left out"
        )
        return default

    def _value(self, shader: UsdShade.Shader, name: str, default: Any) -> Any:
        """Returns the constant value of a node's input."""
        port = shader.GetInput(name)
        attributes = port.GetValueProducingAttributes() if port else []
        value = attributes[0].Get(self._opened.time) if attributes else None
        return default if value is None else value

    def _sampled(self, shader: UsdShade.Shader, output: str, default: Any) -> Any:
        if output not in ("rgb", *"rgba"):
            text = f"expected the output rgb, r, g, b or a; found {output}; it is left out"
            self._opened.notices.add(shader.GetPath(), text)
            return default
        fallback = tuple(self._value(shader, "fallback", Gf.Vec4f(0, 0, 0, 1)))
        constant = fallback[:3] if output == "rgb" else fallback["rgba".find(output)]
        path = self._value(shader, "file", Sdf.AssetPath())
        if not isinstance(path, Sdf.AssetPath) or not path.path:
            self._opened.notices.add(shader.GetPath(), "names no file; its fallback is used")
            return constant
        if "<UDIM>" in path.path:
            self._opened.notices.add(shader.GetPath(), "UDIM tiles are left out; the fallback is used")
            return constant
        asset = asset_of(self._opened, path)
        picture = self._pictures.picture(asset)
        try:
            if not asset.exists:
                raise ImageFileError("no such file")
            _ = picture.values
        except ImageFileError as error:
            self._opened.notices.add(shader.GetPath(), f"{path.path}: {error}; its fallback is used")
            return constant
        mapping = self._mapping(shader)
        if mapping is None:
            return constant
        scale = tuple(map(float, self._value(shader, "scale", (1, 1, 1, 1))))
        bias = tuple(map(float, self._value(shader, "bias", (0, 0, 0, 0))))
        space = str(self._value(shader, "sourceColorSpace", "auto"))
        return Sampled(picture, output, mapping, scale, bias, space)

    def _mapping(self, shader: UsdShade.Shader) -> Mapping | None:
        wrap_s, wrap_t = (self._wrap(str(self._value(shader, name, "useMetadata"))) for name in ("wrapS", "wrapT"))
        port, transform = shader.GetInput("st"), None
        for _ in range(_MAX_NODES):
            source = port.GetConnectedSource() if port else None
            if not source:
                break
            node = UsdShade.Shader(source[0].GetPrim())
            kind = str(node.GetIdAttr().Get() or "") if node else ""
            if kind == "UsdTransform2d" and transform is None:
                scale, offset = self._value(node, "scale", (1, 1)), self._value(node, "translation", (0, 0))
                transform = (
                    (float(scale[0]), float(scale[1])),
                    float(self._value(node, "rotation", 0.0)),
                    (float(offset[0]), float(offset[1])),
                )
                port = node.GetInput("in")
            elif kind.startswith("UsdPrimvarReader_"):
                name = str(self._value(node, "varname", "") or "st")
                return Mapping(name, *(transform or ((1.0, 1.0), 0.0, (0.0, 0.0))), (wrap_s, wrap_t))
            elif not kind and source[0].GetPrim().IsA(UsdShade.NodeGraph):
                port = source[0].GetInput(source[1]) or source[0].GetOutput(source[1])
            else:
                break
        self._opened.notices.add(
            shader.GetPath(),
            "its st: expected a UsdPrimvarReader_float2, with one UsdTransform2d at most; the fallback is used",
        )
        return None

    def _wrap(self, name: str) -> str:
        if name in ("repeat", "clamp", "mirror"):
            return name
        self.uses_black_wrap = True  # also the meaning of useMetadata for pictures that do not state a mode
        return "clamp"


def _triple(value: Any, default: Any) -> Any:
    try:
        numbers = tuple(float(c) for c in value)
    except TypeError:
        return default
    return numbers if len(numbers) == 3 else default


def _number(value: Any, default: Any) -> Any:
    try:
        return float(value)
    except (TypeError, ValueError):
        return default
