"""The benchmarks' scene and cameras for Mitsuba 3. Its variant must be set before any of these functions is called."""

from __future__ import annotations

import math

import mitsuba as mi
import numpy as np
import realcam as rc
from frame_scene import FRAME_EMITTER_RADIANCE, frame_scene_arrays

Settings = dict[str, object]  # dictionary for mi.load_dict


DIFFUSE: Settings = {"type": "diffuse", "reflectance": {"type": "rgb", "value": 0.5}}
TWO_SIDED: Settings = {"type": "twosided", "bsdf": DIFFUSE}


def mesh(
    name: str, vertices: np.ndarray, faces: np.ndarray, radiance: float = 0.0, bsdf: Settings = DIFFUSE
) -> mi.Mesh:
    """A flat mesh; radiance above 0 (cd/m^2) makes it an emitter."""
    properties = mi.Properties()
    properties["mesh_bsdf"] = mi.load_dict(bsdf)
    if radiance:
        properties["mesh_emitter"] = mi.load_dict({"type": "area", "radiance": {"type": "rgb", "value": radiance}})
    result = mi.Mesh(name, len(vertices), len(faces), props=properties)
    parameters = mi.traverse(result)
    parameters["vertex_positions"] = vertices.astype(np.float32).ravel()
    parameters["faces"] = faces.astype(np.uint32).ravel()
    parameters.update()
    return result


def frame_scene(spheres: int, boxes: int, sky: float = 0.0) -> mi.Scene:
    """frame_scene of realcam: the same triangles, emitter and sky (cd/m^2)."""
    vertices, faces, materials = frame_scene_arrays(spheres=spheres, boxes=boxes)
    emitter = materials == 1
    parts = {
        "a": mesh("a", vertices, faces[~emitter]),
        "b": mesh("b", vertices, faces[emitter], FRAME_EMITTER_RADIANCE),
    }
    if sky:
        parts["sky"] = {"type": "constant", "radiance": {"type": "rgb", "value": sky}}
    return mi.load_dict({"type": "scene"} | parts)


def film(width: int, height: int) -> Settings:
    """Film with a box filter, as realcam's pixels have."""
    return {"type": "hdrfilm", "width": width, "height": height, "pixel_format": "rgb", "rfilter": {"type": "box"}}


def sensor(kind: str, camera: rc.Camera, sampler: str = "independent", spp: int = 1) -> Settings:
    """Mitsuba's camera that is equivalent to realcam's ideal model of the camera's lens.

    kind: "perspective" or "thinlens". It lies in the entrance pupil and has its radius; its field of view follows from
    the lens's paraxial magnification of the plane in focus.
    """
    lens, data = camera.lens, camera.lens.first_order()
    position, look_at = np.array(camera.position), np.array(camera.look_at)
    forward = (look_at - position) / np.linalg.norm(look_at - position)
    to_pupil_mm = lens.film_position_mm - data.entrance_pupil_position_mm
    object_mm = 1000 * lens.focus_distance_m - to_pupil_mm
    # Newton's equation gives the magnification from the distance to the front focal point.
    magnification = data.effective_focal_length_mm / (
        1000 * lens.focus_distance_m - lens.film_position_mm + data.front_focal_distance_mm
    )
    origin = position + 0.001 * to_pupil_mm * forward
    settings: Settings = {
        "type": kind,
        "fov": math.degrees(2 * math.atan(0.5 * camera.film.width_mm / (magnification * object_mm))),
        "fov_axis": "x",
        "near_clip": 1e-3,
        "to_world": mi.ScalarTransform4f().look_at(origin=list(origin), target=list(look_at), up=list(camera.up)),
        "film": film(*camera.film.resolution),
        "sampler": {"type": sampler, "sample_count": spp},
    }
    if kind == "thinlens":
        settings |= {
            "aperture_radius": 0.0005 * data.entrance_pupil_diameter_mm,
            "focus_distance": 0.001 * object_mm,
        }
    return settings
