"""Lights of UsdLux: areas become surfaces that emit, others lights of glTF.

intensity * 2^exposure is a radiance in cd/m^2, times colour and blackbody colour. With `normalize` it is divided by the
area of the light in the units of the stage, and a distant light has it in lux.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from pxr import Gf, Usd, UsdLux

from .glb import Json
from .shapes import about_axis, disc, rectangle, revolved, sphere
from .stage import OpenStage
from .surface import Surface, Values

# Polygons instead of circles, and polyhedra instead of spheres, with the perimeter or area of the original: so their
# mean projected width or area is the same too (Cauchy's formula). With these segments, illuminances are right to 0.1%.
_SPHERE_SEGMENTS, _CYLINDER_SEGMENTS = 64, 128

Radiance = tuple[float, float, float]


@dataclass(frozen=True)
class AreaLight:
    """A surface that emits from its front. radiance: in cd/m^2."""

    surface: Surface
    radiance: Radiance


def radiance_of(opened: OpenStage, prim: Usd.Prim) -> Radiance:
    """Returns intensity times colour of a light, before normalisation."""
    light, time = UsdLux.LightAPI(prim), opened.time
    strength = _number(light.GetIntensityAttr(), time, 1.0) * 2 ** _number(light.GetExposureAttr(), time, 0.0)
    colour = np.array(light.GetColorAttr().Get(time) or (1, 1, 1), np.float64)
    if light.GetEnableColorTemperatureAttr().Get(time):
        kelvin = _number(light.GetColorTemperatureAttr(), time, 6500.0)
        colour = colour * np.array(UsdLux.BlackbodyTemperatureAsRgb(kelvin))
    values = np.nan_to_num(strength * colour, posinf=0, neginf=0)
    red, green, blue = (max(float(v), 0.0) for v in values)
    _notice_what_is_left_out(opened, prim, light)
    return red, green, blue


def is_normalised(prim: Usd.Prim, time: Usd.TimeCode) -> bool:
    return bool(UsdLux.LightAPI(prim).GetNormalizeAttr().Get(time))


def area_light(opened: OpenStage, prim: Usd.Prim, world: Gf.Matrix4d) -> AreaLight | None:
    """Returns a light with an area; None for a prim of another type, and for spheres that are points or spots.

    world: matrix of the prim to the stage.
    """
    surface = _surface_of(opened, prim)
    if surface is None:
        return None
    _notice_shaping(opened, prim)
    radiance = radiance_of(opened, prim)
    if is_normalised(prim, opened.time):
        area = world_area(surface, world)
        radiance = scaled(radiance, 1 / area if area > 0 else 0)
    return AreaLight(surface, radiance)


def punctual_light(opened: OpenStage, prim: Usd.Prim, world: Gf.Matrix4d) -> Json | None:
    """Returns a light of KHR_lights_punctual: a distant light, or a sphere that is a point or a spot; None for other
    prims."""
    if prim.IsA(UsdLux.DistantLight):
        return _distant(opened, prim)
    if prim.IsA(UsdLux.SphereLight):
        return _point(opened, prim, world)
    return None


def world_area(surface: Surface, world: Gf.Matrix4d) -> float:
    """Returns the area of a surface in the units of the stage."""
    linear = np.array(world)[:3, :3]
    points = np.asarray(surface.points, np.float64) @ linear
    starts = np.cumsum(surface.counts) - surface.counts
    first = np.repeat(starts, surface.counts)
    local = np.arange(len(surface.corners)) - first
    after = first + (local + 1) % np.repeat(surface.counts, surface.counts)
    anchor = points[surface.corners[first]]
    crosses = np.cross(points[surface.corners] - anchor, points[surface.corners[after]] - anchor)
    return float(np.linalg.norm(np.add.reduceat(crosses, starts), axis=-1).sum() / 2)


def scaled(radiance: Radiance, factor: float) -> Radiance:
    red, green, blue = radiance
    return factor * red, factor * green, factor * blue


def _surface_of(opened: OpenStage, prim: Usd.Prim) -> Surface | None:
    time = opened.time
    if prim.IsA(UsdLux.SphereLight):
        radius = _radius_of(prim, time)
        if radius <= 0 or _is_point(prim, time) or _cone_of(prim, time) is not None:
            return None
        unit = sphere(1.0, _SPHERE_SEGMENTS)
        factor = radius * math.sqrt(4 * math.pi / world_area(unit, Gf.Matrix4d(1)))
        return _with_points(unit, unit.points * factor)
    if prim.IsA(UsdLux.DiskLight):
        radius = _number(UsdLux.DiskLight(prim).GetRadiusAttr(), time, 0.5)
        unit = disc(1.0, 0.0, -1)
        factor = radius * math.sqrt(math.pi / world_area(unit, Gf.Matrix4d(1)))
        return _with_points(unit, unit.points * factor) if radius > 0 else None
    if prim.IsA(UsdLux.RectLight):
        light = UsdLux.RectLight(prim)
        width, height = _number(light.GetWidthAttr(), time, 1.0), _number(light.GetHeightAttr(), time, 1.0)
        if width <= 0 or height <= 0:
            return None
        front = rectangle(width, height).reversed()
        st = np.stack([0.5 - front.points[:, 0] / width, 0.5 + front.points[:, 1] / height], axis=-1)
        return front.with_values(normals=Values(np.tile([0.0, 0.0, -1.0], (4, 1)), "point"), st=Values(st, "point"))
    if prim.IsA(UsdLux.CylinderLight):
        light = UsdLux.CylinderLight(prim)
        radius, length = _number(light.GetRadiusAttr(), time, 0.5), _number(light.GetLengthAttr(), time, 1.0)
        if radius <= 0 or length <= 0:
            return None
        angle = math.pi / _CYLINDER_SEGMENTS
        of_polygon = radius * angle / math.sin(angle)  # radius of the polygon with the perimeter of the circle
        profile = np.array([[of_polygon, -length / 2], [of_polygon, length / 2]])
        return about_axis(revolved(profile, np.array([[1.0, 0.0]] * 2), _CYLINDER_SEGMENTS), "X")
    return None


def _with_points(surface: Surface, points: np.ndarray) -> Surface:
    return Surface(points, surface.counts, surface.corners, surface.faces, surface.values)


def _distant(opened: OpenStage, prim: Usd.Prim) -> Json:
    """A distant light of radiance L and angle a has the illuminance L pi sin^2(a / 2); with `normalize`, or without an
    angle, L is the illuminance itself."""
    attribute = UsdLux.DistantLight(prim).GetAngleAttr()
    angle = _number(attribute, opened.time, 0.53)
    factor = 1.0
    if angle > 0 and not is_normalised(prim, opened.time):
        factor = math.pi * math.sin(math.radians(min(angle, 180.0)) / 2) ** 2
    if attribute.HasAuthoredValue() and angle > 0:
        opened.notices.add(prim.GetPath(), "the angle of the distant light is left out; its light is parallel")
    return _json("directional", scaled(radiance_of(opened, prim), factor))


def _point(opened: OpenStage, prim: Usd.Prim, world: Gf.Matrix4d) -> Json | None:
    """A sphere of radiance L and radius r has the intensity L pi r^2; with `normalize` L is divided by 4 pi r^2."""
    time = opened.time
    radius = _radius_of(prim, time)
    metres = opened.metres_per_unit
    if is_normalised(prim, time):
        factor = metres**2 / 4
    else:
        scale = abs(np.linalg.det(np.array(world)[:3, :3])) ** (1 / 3)
        factor = math.pi * (radius * scale * metres) ** 2
        if radius <= 0:
            opened.notices.add(prim.GetPath(), "a point light without normalize emits no light; it is left out")
            return None
    intensity = scaled(radiance_of(opened, prim), factor)
    cone = _cone_of(prim, time)
    if cone is None:
        return _json("point", intensity)
    angle, softness = cone
    if radius > 0 and not _is_point(prim, time):
        opened.notices.add(prim.GetPath(), "the radius of a light with a shaping cone is left out; it is a point")
    if softness > 0:
        opened.notices.add(prim.GetPath(), "the falloff of shaping:cone:softness is that of glTF's spots")
    _notice_shaping(opened, prim)
    outer = math.radians(angle)
    return {**_json("spot", intensity), "spot": {"innerConeAngle": outer * (1 - softness), "outerConeAngle": outer}}


def _cone_of(prim: Usd.Prim, time: Usd.TimeCode) -> tuple[float, float] | None:
    """Returns angle in degrees and softness of a shaping cone up to 90 degrees; None if there is none."""
    if not prim.HasAPI(UsdLux.ShapingAPI):
        return None
    shaping = UsdLux.ShapingAPI(prim)
    angle = _number(shaping.GetShapingConeAngleAttr(), time, 90.0)
    softness = _number(shaping.GetShapingConeSoftnessAttr(), time, 0.0)
    return (angle, min(max(softness, 0.0), 1.0)) if 0 < angle <= 90 else None


def _notice_shaping(opened: OpenStage, prim: Usd.Prim) -> None:
    if not prim.HasAPI(UsdLux.ShapingAPI):
        return
    shaping, time = UsdLux.ShapingAPI(prim), opened.time
    if shaping.GetShapingIesFileAttr().HasAuthoredValue():
        opened.notices.add(prim.GetPath(), "shaping:ies:file is left out")
    if _number(shaping.GetShapingFocusAttr(), time, 0.0) != 0:
        opened.notices.add(prim.GetPath(), "shaping:focus is left out")
    angle = _number(shaping.GetShapingConeAngleAttr(), time, 90.0)
    is_open = angle == 90 and not prim.IsA(UsdLux.CylinderLight)
    if not prim.IsA(UsdLux.SphereLight) and not is_open and angle < 180:
        opened.notices.add(prim.GetPath(), "shaping:cone is left out; only spheres are spots")
    elif prim.IsA(UsdLux.SphereLight) and 90 < angle < 180:
        opened.notices.add(prim.GetPath(), "shaping:cone of more than 90 degrees is left out")


def _notice_what_is_left_out(opened: OpenStage, prim: Usd.Prim, light: UsdLux.LightAPI) -> None:
    time = opened.time
    for name in ("diffuse", "specular"):
        if _number(prim.GetAttribute(f"inputs:{name}"), time, 1.0) != 1:
            opened.notices.add(prim.GetPath(), f"inputs:{name} is not physical and is left out")
    if light.GetFiltersRel().GetTargets():
        opened.notices.add(prim.GetPath(), "light filters are left out")
    for name in ("lightLink", "shadowLink"):
        has_root = prim.GetAttribute(f"collection:{name}:includeRoot").Get(time)
        if has_root is False or prim.GetRelationship(f"collection:{name}:excludes").GetTargets():
            opened.notices.add(prim.GetPath(), f"{name} is left out; the light reaches all surfaces")
    if prim.HasAPI(UsdLux.ShadowAPI):
        opened.notices.add(prim.GetPath(), "the shadow settings are not physical and are left out")
    for attribute in (light.GetIntensityAttr(), light.GetExposureAttr(), light.GetColorAttr()):
        if attribute.ValueMightBeTimeVarying():
            opened.notices.add(attribute.GetPath(), "its values over time are left out; the first one is used")


def _json(kind: str, strength: Radiance) -> Json:
    intensity = max(strength)
    colour = [c / intensity for c in strength] if intensity > 0 else [0.0, 0.0, 0.0]
    return {"type": kind, "color": colour, "intensity": intensity}


def _is_point(prim: Usd.Prim, time: Usd.TimeCode) -> bool:
    return bool(UsdLux.SphereLight(prim).GetTreatAsPointAttr().Get(time))


def _radius_of(prim: Usd.Prim, time: Usd.TimeCode) -> float:
    return _number(UsdLux.SphereLight(prim).GetRadiusAttr(), time, 0.5)


def _number(attribute: Usd.Attribute, time: Usd.TimeCode, default: float) -> float:
    """Returns the value of an attribute if it is a finite number."""
    value = attribute.Get(time) if attribute else None
    return float(value) if isinstance(value, (int, float)) and math.isfinite(value) else default
