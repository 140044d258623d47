"""Test scenes in a room for realcam and Mitsuba 3: the same triangles and lights, with equivalent materials.

Mitsuba's variant must be set before this module is imported.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

import mitsuba as mi
import numpy as np
import realcam as rc

Settings = dict[str, Any]  # dictionary for mi.load_dict
EXPOSURE_S = 1 / 125


@dataclass(frozen=True)
class Mesh:
    """A triangle mesh; positions in metres."""

    positions: np.ndarray  # (V, 3)
    triangles: np.ndarray  # (T, 3), vertex indices
    normals: np.ndarray | None = None  # (V, 3); None: flat
    uvs: np.ndarray | None = None  # (V, 2)


@dataclass(frozen=True)
class Part:
    """A mesh with a material for both programs, and its motion during the exposure."""

    mesh: Mesh
    material: rc.Material
    bsdf: Settings  # the material for Mitsuba
    radiance: tuple[float, float, float] = (0.0, 0.0, 0.0)  # cd/m^2 of red, green and blue
    turn: float = 0.0  # rotation about y within EXPOSURE_S, radians
    shift: tuple[float, float, float] = (0.0, 0.0, 0.0)  # translation within EXPOSURE_S, metres

    @property
    def moves(self) -> bool:
        return self.turn != 0 or any(self.shift)

    def transform_at(self, time: float) -> np.ndarray:
        """(4, 4): transform at a time, as a fraction of the exposure."""
        matrix, angle = np.eye(4), time * self.turn
        matrix[0, 0] = matrix[2, 2] = np.cos(angle)
        matrix[0, 2], matrix[2, 0] = np.sin(angle), -np.sin(angle)
        matrix[:3, 3] = time * np.array(self.shift)
        return matrix


@dataclass(frozen=True)
class Shot:
    """A scene: its parts and its environment."""

    parts: list[Part]
    sky: float | np.ndarray = 100.0  # radiance of the environment, cd/m^2, or an environment map (H, W, 3)
    name: str = field(default="", compare=False)


def quad(corner: list[float], u: list[float], v: list[float], pieces: int = 1) -> Mesh:
    """A parallelogram with the edges u and v, divided into pieces x pieces; its normal is u x v."""
    c, a, b = (np.array(x, float) for x in (corner, u, v))
    steps = np.linspace(0, 1, pieces + 1)
    s, t = (x.ravel() for x in np.meshgrid(steps, steps, indexing="ij"))
    first = np.array([i * (pieces + 1) + k for i in range(pieces) for k in range(pieces)])
    n = pieces + 1
    triangles = np.concatenate(
        [np.stack([first, first + n, first + n + 1], 1), np.stack([first, first + n + 1, first + 1], 1)]
    )
    return Mesh(c + np.outer(s, a) + np.outer(t, b), triangles, uvs=np.stack([s, t], 1))


def sphere(center: list[float], radius: float, rings: int = 48) -> Mesh:
    """A smooth sphere with outward normals; rings: number of divisions from pole to pole."""
    polar, azimuth = np.meshgrid(
        np.linspace(0, np.pi, rings + 1), np.linspace(0, 2 * np.pi, 2 * rings + 1), indexing="ij"
    )
    normals = np.stack([np.sin(polar) * np.cos(azimuth), np.cos(polar), -np.sin(polar) * np.sin(azimuth)], -1).reshape(
        -1, 3
    )
    uvs = np.stack([azimuth / (2 * np.pi), 1 - polar / np.pi], -1).reshape(-1, 2)
    n = 2 * rings + 1
    a = np.array([r * n + c for r in range(rings) for c in range(2 * rings)])
    lower = np.stack([a, a + n, a + n + 1], 1)
    upper = np.stack([a, a + n + 1, a + 1], 1)
    # Triangles with two corners at a pole are degenerate and omitted.
    triangles = np.concatenate([lower[: -2 * rings], upper[2 * rings :]])
    return Mesh(np.array(center) + radius * normals, triangles, normals, uvs)


def flat(mesh: Mesh) -> Mesh:
    """The mesh without vertex normals."""
    return Mesh(mesh.positions, mesh.triangles, uvs=mesh.uvs)


def diffuse(reflectance: tuple[float, float, float]) -> tuple[rc.Material, Settings]:
    """Lambertian material for realcam and for Mitsuba."""
    return rc.Material(diffuse=reflectance), {
        "type": "twosided",
        "bsdf": {"type": "diffuse", "reflectance": {"type": "rgb", "value": list(reflectance)}},
    }


def room() -> list[Part]:
    """Floor, wall and a lamp of 4000 cd/m^2 that faces down."""
    return [
        Part(quad([-2, 0, 2], [4, 0, 0], [0, 0, -4]), *diffuse((0.6, 0.6, 0.6))),
        Part(quad([-2, 0, -2], [4, 0, 0], [0, 3, 0]), *diffuse((0.6, 0.3, 0.2))),
        Part(quad([-0.5, 2.5, -0.5], [1, 0, 0], [0, 0, 1]), *diffuse((0.5, 0.5, 0.5)), radiance=(4000, 3600, 3000)),
    ]


def ball(material: rc.Material, bsdf: Settings) -> Shot:
    """A sphere of this material in the room."""
    return Shot([*room(), Part(sphere([0, 0.7, 0], 0.7), material, bsdf)])


def realcam_scene(shot: Shot) -> rc.Scene:
    """The shot for realcam, with its moving parts as animated instances."""
    scene = static_scene([part for part in shot.parts if not part.moves])
    for i, part in enumerate(part for part in shot.parts if part.moves):
        scene = scene.with_instance(static_scene([part]), name=str(i))
        transforms = [part.transform_at(time) for time in np.linspace(0, 1, 9)]
        scene = scene.moved(str(i), transforms, times_s=list(np.linspace(0, EXPOSURE_S, 9)))
    return scene.with_environment(shot.sky)


def static_scene(parts: list[Part]) -> rc.Scene:
    """The parts without motion, as one mesh."""
    count = 0
    positions, triangles, normals, uvs, material_indices, materials = [], [], [], [], [], []
    for index, part in enumerate(parts):
        mesh = part.mesh
        positions.append(mesh.positions)
        triangles.append(mesh.triangles + count)
        normals.append(mesh.normals if mesh.normals is not None else np.zeros_like(mesh.positions))
        uvs.append(mesh.uvs if mesh.uvs is not None else np.zeros((len(mesh.positions), 2)))
        material_indices.append(np.full(len(mesh.triangles), index))
        materials.append(part.material.replace(emission=part.radiance))
        count += len(mesh.positions)
    return rc.Scene.from_arrays(
        np.concatenate(positions),
        np.concatenate(triangles),
        normals=np.concatenate(normals),
        uvs=np.concatenate(uvs),
        triangle_materials=np.concatenate(material_indices),
        materials=materials,
    )


def mitsuba_mesh(name: str, part: Part) -> mi.Mesh:
    """The part for Mitsuba, without motion."""
    mesh = part.mesh
    properties = mi.Properties()
    properties["mesh_bsdf"] = mi.load_dict(part.bsdf)
    if any(part.radiance):
        properties["mesh_emitter"] = mi.load_dict(
            {"type": "area", "radiance": {"type": "rgb", "value": list(part.radiance)}}
        )
    result = mi.Mesh(
        name,
        len(mesh.positions),
        len(mesh.triangles),
        has_vertex_normals=mesh.normals is not None,
        has_vertex_texcoords=mesh.uvs is not None,
        props=properties,
    )
    parameters = mi.traverse(result)
    parameters["vertex_positions"] = mesh.positions.astype(np.float32).ravel()
    parameters["faces"] = mesh.triangles.astype(np.uint32).ravel()
    if mesh.normals is not None:
        parameters["vertex_normals"] = mesh.normals.astype(np.float32).ravel()
    if mesh.uvs is not None:
        parameters["vertex_texcoords"] = mesh.uvs.astype(np.float32).ravel()
    parameters.update()
    return result


def transformed(part: Part, time: float) -> Part:
    """The part at a time, as a fraction of the exposure."""
    matrix, mesh = part.transform_at(time), part.mesh
    normals = None if mesh.normals is None else mesh.normals @ matrix[:3, :3].T
    positions = mesh.positions @ matrix[:3, :3].T + matrix[:3, 3]
    return replace(part, mesh=replace(mesh, positions=positions, normals=normals))


def mitsuba_scene(shot: Shot, time: float = 0.0) -> mi.Scene:
    """The shot for Mitsuba 3, which has no animated meshes, at a time as a fraction of the exposure."""
    parts: Settings = {
        f"part{i}": mitsuba_mesh(f"part{i}", transformed(part, time)) for i, part in enumerate(shot.parts)
    }
    if isinstance(shot.sky, np.ndarray):
        # The centre column of realcam's environment map is -z, the first column of Mitsuba's is.
        rotated = np.roll(shot.sky, shot.sky.shape[1] // 2, axis=1)
        parts["sky"] = {"type": "envmap", "bitmap": mi.Bitmap(np.ascontiguousarray(rotated, np.float32))}
    else:
        parts["sky"] = {"type": "constant", "radiance": {"type": "rgb", "value": shot.sky}}
    return mi.load_dict({"type": "scene"} | parts)


def checker() -> np.ndarray:
    """(64, 64, 3): a texture in linear colours, smooth enough that the programs' texture filters agree."""
    y, x = np.mgrid[0:64, 0:64] / 64
    return np.stack([0.2 + 0.6 * (np.sin(6 * np.pi * x) > 0), 0.3 + 0.3 * y, 0.7 - 0.5 * x], -1)


def waves() -> np.ndarray:
    """(64, 64, 3): a normal map with values of 0 to 1."""
    y, x = np.mgrid[0:64, 0:64] / 64
    slope = 0.4 * np.cos(4 * np.pi * x), 0.2 * np.sin(4 * np.pi * y)
    n = np.stack([-slope[0], -slope[1], np.ones_like(x)], -1)
    return n / np.linalg.norm(n, axis=-1, keepdims=True) * 0.5 + 0.5


def many_lamps() -> Shot:
    """Sixty small lamps with random position, size, orientation and colour."""
    rng = np.random.default_rng(3)
    parts = room()[:2]
    for _ in range(60):
        x, z = rng.uniform(-1.8, 1.8, 2)
        corner = [x, rng.uniform(0.3, 2.5), z]
        size = rng.uniform(0.02, 0.1)
        radiance = tuple(float(v) for v in rng.uniform(500, 30000, 3))
        u = rng.normal(size=3)
        v = np.cross(u, rng.normal(size=3))
        parts.append(
            Part(
                quad(corner, list(size * u / np.linalg.norm(u)), list(size * v / np.linalg.norm(v))),
                *diffuse((0.5, 0.5, 0.5)),
                radiance=radiance,
            )
        )
    return Shot(parts, sky=0.0)


def uneven_sky() -> np.ndarray:
    """(1024, 2048, 3): an environment map with a sun of some degrees.

    It has many pixels because Mitsuba interpolates between pixel centres that are shifted by half a pixel.
    """
    y, x = (np.mgrid[0:1024, 0:2048] + 0.5) / 1024
    sky = 50 + 40 * np.stack([np.cos(x * np.pi), np.sin(6 * y), np.cos(x * 3 * np.pi)], -1)
    return sky + 60000 * np.exp(-((x - 1.25) ** 2 + (y - 0.24) ** 2) / 0.0011)[..., None]


def srgb_codes(linear: np.ndarray) -> np.ndarray:
    """8-bit sRGB of linear values of 0 to 1."""
    encoded = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    return np.round(255 * encoded).astype(np.uint8)


def bitmap(codes: np.ndarray, raw: bool) -> Settings:
    """Texture for Mitsuba, whose row 0 is at v = 0. raw: True for data, False for sRGB colours."""
    return {"type": "bitmap", "bitmap": mi.Bitmap(codes[::-1].copy()), "raw": raw, "wrap_mode": "repeat"}


def metal(roughness: float) -> Shot:
    """A metal ball. The roughness must be so small that multiple scattering between microfacets, which Mitsuba omits,
    is negligible. It is white, because only realcam's Schlick term whitens colours towards grazing incidence."""
    material = rc.Material.metallic_roughness(base_color=(1, 1, 1), metallic=1, roughness=roughness)
    return ball(
        material,
        {
            "type": "twosided",
            "bsdf": {
                "type": "roughconductor",
                "material": "none",
                "distribution": "ggx",
                "alpha": roughness**2,
            },
        },
    )


def textured() -> Shot:
    """A ball with a colour texture."""
    colors = srgb_codes(checker())
    bsdf = {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": bitmap(colors, raw=False)}}
    return ball(rc.Material(diffuse=(1, 1, 1), texture=colors), bsdf)


def normal_mapped() -> Shot:
    """A flat wall with a normal map; on smooth meshes the programs' tangent frames differ."""
    normals = np.round(255 * waves()).astype(np.uint8)
    material = rc.Material(diffuse=(0.7, 0.7, 0.7), normal_map=normals)
    bsdf = {
        "type": "normalmap",
        "normalmap": bitmap(normals, raw=True),
        "use_shadowing_function": False,
        "flip_invalid_normals": False,
        "bsdf": {"type": "diffuse", "reflectance": {"type": "rgb", "value": 0.7}},
    }
    floor, _, lamp = room()
    return Shot([floor, lamp, Part(quad([-2, 0, -2], [4, 0, 0], [0, 3, 0]), material, bsdf)])


def holed() -> Shot:
    """A plate with round holes in front of a ball, and one with an opacity of 0.5 above it, for visibility and
    shadows."""
    y, x = np.mgrid[0:64, 0:64] / 64 * 4 % 1 - 0.5
    alpha = np.where(x**2 + y**2 < 0.1, 0, 255).astype(np.uint8)
    color = {"type": "rgb", "value": [0.2, 0.6, 0.3]}
    bsdf = {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": color}}
    with_map = rc.Material(diffuse=(0.2, 0.6, 0.3), opacity_texture=alpha)
    half_opaque = rc.Material(diffuse=(0.2, 0.6, 0.3), opacity=0.5)
    return Shot(
        [
            *ball(*diffuse((0.8, 0.5, 0.2))).parts,
            Part(
                quad([-0.9, 0.1, 1.0], [0.9, 0, 0], [0, 0.9, 0]),
                with_map,
                {"type": "mask", "opacity": bitmap(alpha[..., None], raw=True), "bsdf": bsdf},
            ),
            Part(
                quad([0, 1.7, -0.6], [1.2, 0, 0], [0, 0, 1.2]),
                half_opaque,
                {"type": "mask", "opacity": 0.5, "bsdf": bsdf},
            ),
        ]
    )


def moving() -> Shot:
    """A ball in translation, a rotating plate in front of it, and a moving lamp above both."""
    floor, wall, lamp = room()
    plate = Part(quad([-0.8, 0.2, 1.2], [0.7, 0, 0], [0, 0.7, 0]), *diffuse((0.3, 0.5, 0.8)), turn=0.9)
    ball_in_flight = Part(sphere([-0.4, 0.7, 0], 0.5), *diffuse((0.8, 0.5, 0.2)), shift=(0.8, 0.3, 0.2))
    return Shot([floor, wall, replace(lamp, shift=(0.6, -0.5, 0.4), turn=0.5), plate, ball_in_flight])


SHOTS: dict[str, Callable[[], Shot]] = {
    "motion": moving,
    "diffuse": lambda: ball(*diffuse((0.8, 0.5, 0.2))),
    "mirror": lambda: ball(
        rc.Material(diffuse=(0, 0, 0), mirror=(0.8, 0.8, 0.8), fresnel=False),
        {
            "type": "twosided",
            "bsdf": {"type": "conductor", "material": "none", "specular_reflectance": {"type": "rgb", "value": 0.8}},
        },
    ),
    "smooth glass": lambda: ball(
        rc.Material(diffuse=(0, 0, 0), transmission=1, ior=1.5), {"type": "dielectric", "int_ior": 1.5, "ext_ior": 1.0}
    ),
    "film": lambda: ball(
        rc.Material(diffuse=(0, 0, 0), transmission=1, ior=1.5, thin=True),
        {"type": "thindielectric", "int_ior": 1.5, "ext_ior": 1.0},
    ),
    "rough metal": lambda: metal(0.12),
    "narrow metal": lambda: metal(0.08),
    # Smooth enough that multiple scattering between microfacets, which Mitsuba omits, is negligible: at a roughness of
    # 0.25 its ball is darker.
    "rough glass": lambda: ball(
        rc.Material.metallic_roughness(transmission=1, roughness=0.12, ior=1.5),
        {"type": "roughdielectric", "distribution": "ggx", "alpha": 0.0144, "int_ior": 1.5, "ext_ior": 1.0},
    ),
    "textured": textured,
    "normal map": normal_mapped,
    "image environment": lambda: Shot(
        [*ball(*diffuse((0.5, 0.5, 0.5))).parts[:2], Part(sphere([0, 0.7, 0], 0.7), *diffuse((0.8, 0.8, 0.8)))],
        sky=uneven_sky(),
    ),
    "emissive mesh": lambda: Shot(
        [*room()[:2], Part(flat(sphere([0, 0.7, 0], 0.4, 12)), *diffuse((0.5, 0.5, 0.5)), radiance=(3000, 2000, 1000))],
        sky=20.0,
    ),
    "many lights": many_lamps,
    "holes": holed,
}
