"""Translation of a stage's prims to nodes of a glTF document, and the scene that realcam's glTF reader makes of it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from pxr import Gf, Usd, UsdGeom, UsdLux, UsdShade, UsdSkel

from .. import _core
from .._core import RealcamError, Scene
from .cameras import camera_json
from .deformation import Deformations
from .dome import Domes
from .glb import Glb, Json
from .lights import area_light, is_normalised, punctual_light, radiance_of, scaled, world_area
from .materials import Materials
from .meshes import mesh_surface, shape_with_primvars
from .motion import flat, set_transform
from .primitives import FaceMaterials, add_mesh
from .shapes import shape_surface
from .stage import OpenStage, children_of, open_stage

_MAX_NESTED_INSTANCERS = 16
_WRONG_VALUES = (TypeError, ValueError, IndexError, OverflowError, np.linalg.LinAlgError)
_SHOWN_PURPOSES = (UsdGeom.Tokens.default_, UsdGeom.Tokens.render)
_Y_FROM_Z_UP = Gf.Matrix4d(1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1)  # for row vectors: y to -z, z to y


def scene_of_stage(path: str, scale: float, objects: Sequence[str], variants: Sequence[str]) -> Scene:
    """See realcam.usd.read_stage."""
    opened = open_stage(path, variants)
    translation = Translation(opened)
    translation.add_stage()
    opened.take_diagnostics()
    lines = opened.notices.lines()
    scene = _core._read_glb(path, translation.glb.encoded(), lines, scale, objects)
    return translation.domes.light(scene)


@dataclass(frozen=True)
class _Part:
    """A mesh of a prototype. matrix: to the frame of the prototype's root, without the root's own transform."""

    matrix: Gf.Matrix4d
    mesh: int


@dataclass(frozen=True)
class _Visit:
    """A prim on the stack of the traversal. node: of its parent; depth: below the root."""

    prim: Usd.Prim
    node: int
    depth: int


class Translation:
    """Translates a stage: the document in `glb`, and the dome lights in `domes`."""

    def __init__(self, opened: OpenStage) -> None:
        self.opened = opened
        self.glb = Glb()
        self.domes = Domes(opened)
        self._materials = Materials(opened, self.glb)
        self._deformations = Deformations(opened, self.glb)
        self._meshes: dict[Any, int | None] = {}
        self._world = UsdGeom.XformCache(opened.time)
        up = UsdGeom.GetStageUpAxis(opened.stage)
        if up not in (UsdGeom.Tokens.y, UsdGeom.Tokens.z):
            opened.notices.add("upAxis", f"expected Y or Z; found {up}; Y is up")
        turn = _Y_FROM_Z_UP if up == UsdGeom.Tokens.z else Gf.Matrix4d(1)
        self._scene_from_stage = turn * Gf.Matrix4d().SetScale(opened.metres_per_unit)

    def add_stage(self) -> None:
        """Adds all prims that are shown: visible, and with the purpose default or render."""
        root = self.glb.add("nodes", {"name": "", "matrix": flat(self._scene_from_stage)})
        pseudo_root = self.opened.stage.GetPseudoRoot()
        stack = [_Visit(prim, root, 1) for prim in reversed(children_of(pseudo_root))]
        while stack:
            visit = stack.pop()
            prim = visit.prim
            self.opened.count(prim, visit.depth)
            if not self._is_shown(prim):
                continue
            try:
                node = self._add_node(prim, visit.node, root)
            except RealcamError:
                raise
            except _WRONG_VALUES as error:  # a stage may give an attribute any type
                raise self.opened.fail(prim, f"expected other values: {str(error).splitlines()[0]:.200}") from None
            if not prim.IsA(UsdGeom.PointInstancer):  # whose prototypes are not shown themselves
                stack += [_Visit(child, node, visit.depth + 1) for child in reversed(children_of(prim))]

    def _is_shown(self, prim: Usd.Prim) -> bool:
        """True unless the prim hides itself and its descendants."""
        if prim.IsA(UsdShade.Material) or prim.IsA(UsdShade.Shader) or prim.IsA(UsdGeom.Subset):
            return False
        if not prim.IsA(UsdGeom.Imageable):
            return True
        imageable = UsdGeom.Imageable(prim)
        visibility = imageable.GetVisibilityAttr()
        if visibility.ValueMightBeTimeVarying():
            self.opened.notices.add(visibility.GetPath(), "its values over time are left out; the first one is used")
        if visibility.Get(self.opened.time) == UsdGeom.Tokens.invisible:
            return False
        return imageable.ComputePurpose() in _SHOWN_PURPOSES

    def _add_node(self, prim: Usd.Prim, parent: int, root: int) -> int:
        """Adds the node of a prim, with its mesh, light or camera, and returns its index."""
        node: Json = {"name": prim.GetName()}
        index = self.glb.add("nodes", node)
        if prim.IsA(UsdGeom.Xformable):
            xformable = UsdGeom.Xformable(prim)
            set_transform(self.opened, self.glb, node, index, xformable)
            if xformable.GetResetXformStack():
                parent = root
        self.glb.json["nodes"][parent].setdefault("children", []).append(index)
        if prim.IsA(UsdGeom.Camera):
            node["camera"] = self.glb.add("cameras", camera_json(self.opened, prim))
        elif prim.IsA(UsdGeom.PointInstancer):
            self._add_instances(UsdGeom.PointInstancer(prim), index)
        elif prim.HasAPI(UsdLux.LightAPI) and not prim.IsA(UsdGeom.Gprim):
            self._add_light(prim, node)
        else:
            mesh = self._mesh_of(prim)
            if mesh is not None:
                node["mesh"] = mesh
                self._deformations.play(index, mesh)
        return index

    def _add_light(self, prim: Usd.Prim, node: Json) -> None:
        world = self._world.GetLocalToWorldTransform(prim)
        if prim.IsA(UsdLux.DomeLight) or prim.IsA(UsdLux.DomeLight_1):
            self.domes.add(prim, world * self._scene_from_stage)
            return
        area = area_light(self.opened, prim, world)
        if area:
            texture = None
            if prim.IsA(UsdLux.RectLight):
                path = UsdLux.RectLight(prim).GetTextureFileAttr().Get(self.opened.time)
                texture = self._materials.texture(path, "st") if path and path.path else None
            material = self._materials.of_light(prim.GetName(), area.radiance, texture)
            node["mesh"] = add_mesh(self.opened, self.glb, prim, area.surface, [(None, material)])
            return
        punctual = punctual_light(self.opened, prim, world)
        if punctual:
            node["extensions"] = {"KHR_lights_punctual": {"light": self.glb.light(punctual)}}
        elif prim.GetTypeName() != "SphereLight":
            self.opened.notices.add(prim.GetPath(), f"a {prim.GetTypeName()} is left out")

    def _mesh_of(self, prim: Usd.Prim) -> int | None:
        """Returns the index of a gprim's mesh in the document; None for other prims and for empty meshes. Instances
        share it."""
        if not prim.IsA(UsdGeom.Gprim):
            return None
        light = self._mesh_light(prim)
        bound = _bound_material(prim)
        origin = prim.GetPrimInPrototype() if prim.IsInstanceProxy() else prim
        # Inherited materials and primvars may differ between instances.
        key = (str(origin.GetPath()), str(bound.GetPath()) if bound else "", light, _inherited(prim, origin))
        if key not in self._meshes:
            self._meshes[key] = self._new_mesh(prim, light)
        return self._meshes[key]

    def _mesh_light(self, prim: Usd.Prim) -> tuple[float, ...] | None:
        """Returns the radiance of a mesh with MeshLightAPI; None for other prims."""
        if not prim.HasAPI(UsdLux.MeshLightAPI):
            return None
        radiance = radiance_of(self.opened, prim)
        if is_normalised(prim, self.opened.time):
            surface = mesh_surface(self.opened, prim, ())
            area = world_area(surface, self._world.GetLocalToWorldTransform(prim)) if surface else 0
            radiance = scaled(radiance, 1 / area if area > 0 else 0)
        return radiance

    def _new_mesh(self, prim: Usd.Prim, light: tuple[float, ...] | None) -> int | None:
        if prim.HasAPI(UsdSkel.BindingAPI) and UsdSkel.BindingAPI(prim).GetInheritedSkeleton():
            self.opened.notices.add(prim.GetPath(), "its skeleton is left out; it has the pose of its points")
        materials = self._materials_of(prim, light)
        names = {name for _, m in materials for name in (*m.uv_names, m.colours, m.opacities) if name}
        samples = None
        if prim.IsA(UsdGeom.Mesh):
            samples = self._deformations.samples_of(prim)
            surface = mesh_surface(self.opened, prim, sorted(names), samples)
        else:
            surface = shape_surface(prim, self.opened.time)
            if surface:
                surface = shape_with_primvars(self.opened, prim, surface, sorted(names))
            elif shape_surface(prim, self.opened.time) is None and not _is_shape(prim):
                self.opened.notices.add(prim.GetPath(), f"a {prim.GetTypeName()} is left out")
        if not surface:
            return None
        mesh = add_mesh(self.opened, self.glb, prim, surface, materials)
        if samples:
            self._deformations.add(mesh, samples)
        return mesh

    def _materials_of(self, prim: Usd.Prim, light: tuple[float, ...] | None) -> FaceMaterials:
        """Returns the materials of the prim's faces."""
        out: FaceMaterials = []
        if prim.IsA(UsdGeom.Mesh):
            for subset in UsdShade.MaterialBindingAPI(prim).GetMaterialBindSubsets():
                bound = _bound_material(subset.GetPrim())
                indices = np.array(subset.GetIndicesAttr().Get(self.opened.time) or [], np.int64)
                out.append((indices, self._materials.of_material(bound, light)))
        out.append((None, self._materials.of_material(_bound_material(prim), light)))
        return out

    def _add_instances(self, instancer: UsdGeom.PointInstancer, node: int) -> None:
        """Adds the instances of a point instancer as children of its node."""
        for matrix, part in self._instance_parts(instancer, 1):
            child = self.glb.add("nodes", {"mesh": part.mesh, "matrix": flat(part.matrix * matrix)})
            self._deformations.play(child, part.mesh)
            self.glb.json["nodes"][node].setdefault("children", []).append(child)

    def _instance_parts(self, instancer: UsdGeom.PointInstancer, depth: int) -> Iterator[tuple[Gf.Matrix4d, _Part]]:
        """Yields the meshes of all instances, with the matrices of the instances to the instancer's frame."""
        opened, time = self.opened, self.opened.time
        prim = instancer.GetPrim()
        if depth > _MAX_NESTED_INSTANCERS:
            raise opened.fail(prim, f"is nested in more than {_MAX_NESTED_INSTANCERS} point instancers")
        indices = list(instancer.GetProtoIndicesAttr().Get(time) or [])
        paths = instancer.GetPrototypesRel().GetForwardedTargets()
        if indices and (min(indices) < 0 or max(indices) >= len(paths)):
            raise opened.fail(prim, f"protoIndices: expected numbers from 0 to {len(paths) - 1}; found {max(indices)}")
        for attribute in (instancer.GetPositionsAttr(), instancer.GetOrientationsAttr(), instancer.GetScalesAttr()):
            if attribute.ValueMightBeTimeVarying():
                opened.notices.add(attribute.GetPath(), "its values over time are left out; the first one is used")
        matrices = instancer.ComputeInstanceTransformsAtTime(
            time, time, UsdGeom.PointInstancer.IncludeProtoXform, UsdGeom.PointInstancer.IgnoreMask
        )
        if indices and len(matrices) != len(indices):
            raise opened.fail(prim, f"positions: expected {len(indices)}, as many as protoIndices")
        mask = instancer.ComputeMaskAtTime(time) or [True] * len(indices)
        parts: dict[int, list[_Part]] = {}
        for index, matrix, shown in zip(indices, matrices, mask, strict=True):
            if not shown:
                continue
            if index not in parts:
                prototype = opened.stage.GetPrimAtPath(paths[index])
                if not prototype:
                    raise opened.fail(prim, f"prototypes: there is no prim {paths[index]}")
                parts[index] = list(self._prototype_parts(prototype, depth))
            for part in parts[index]:
                opened.count(prim, depth)
                yield matrix, part

    def _prototype_parts(self, prototype: Usd.Prim, depth: int) -> Iterator[_Part]:
        """Yields the meshes of a prototype."""
        time = self.opened.time
        stack = [(prototype, Gf.Matrix4d(1), 0)]
        while stack:
            prim, matrix, level = stack.pop()
            self.opened.count(prim, level)
            if not self._is_shown(prim):
                continue
            if level > 0 and prim.IsA(UsdGeom.Xformable):
                matrix = UsdGeom.Xformable(prim).GetLocalTransformation(time) * matrix
            if prim.IsA(UsdGeom.PointInstancer):
                for instance, part in self._instance_parts(UsdGeom.PointInstancer(prim), depth + 1):
                    yield _Part(part.matrix * instance * matrix, part.mesh)
                continue
            if prim.HasAPI(UsdLux.LightAPI) and not prim.IsA(UsdGeom.Gprim):
                self.opened.notices.add(prim.GetPath(), "a light in a prototype of a point instancer is left out")
            mesh = self._mesh_of(prim)
            if mesh is not None:
                yield _Part(matrix, mesh)
            stack += [(child, matrix, level + 1) for child in reversed(children_of(prim))]


def _bound_material(prim: Usd.Prim) -> UsdShade.Material | None:
    material, _ = UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial(UsdShade.Tokens.full)
    return material if material else None


def _inherited(prim: Usd.Prim, origin: Usd.Prim) -> tuple[str, ...]:
    """Returns what distinguishes the inherited primvars of an instance; () for prims that are no instance."""
    if prim == origin:
        return ()
    inherited = UsdGeom.PrimvarsAPI(prim).FindPrimvarsWithInheritance()
    outside = [p.GetAttr() for p in inherited if not p.GetAttr().GetPrim().IsInstanceProxy()]
    return tuple(str(attribute.GetPath()) for attribute in outside)


def _is_shape(prim: Usd.Prim) -> bool:
    return prim.GetTypeName() in ("Cube", "Sphere", "Cylinder", "Cylinder_1", "Cone", "Capsule", "Capsule_1", "Plane")
