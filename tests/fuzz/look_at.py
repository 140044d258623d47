"""Uses an unpickled value in every way that a user may: a value that was accepted must not break anything."""

from __future__ import annotations

import contextlib
import pickle
import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
import realcam as rc

LENS = rc.Lens.load("tessar-50mm")
FILM = rc.Film(36, 24, (6, 4))
CORNERS, TRIANGLES = [(-1, 0, -1), (1, 0, -1), (1, 0, 1), (-1, 0, 1)], [(0, 2, 1), (0, 3, 2)]


def floor(*materials: rc.Material) -> rc.Scene:
    return rc.Scene.from_arrays(CORNERS, TRIANGLES, uvs=np.zeros((4, 2)), materials=list(materials))


def photograph(scene: rc.Scene, camera: rc.Camera, effects: tuple[str, ...] = ()) -> None:
    rc.render(scene, camera, spp=1, effects=effects, device="cpu", threads=1)


def use_lens(lens: rc.Lens) -> None:
    lens.first_order()
    lens.trace([(0.0, 0.1, lens.film_position_mm)], [(0.0, 0.01, -1.0)])
    lens.trace([(0.0, 0.1, -100.0)], [(0.0, 0.01, 1.0)], start="scene", transmission=True)
    for name in lens.zoom_positions:
        lens.zoomed(name)
    lens.stopped_down(8)


def use_camera(camera: rc.Camera) -> None:
    if max(camera.film.resolution) <= 64:
        for chunk in camera.ray_chunks(max_rays=100):
            np.array(chunk.weights)
            break
    camera.replace(iso=200)
    camera.project([(0.0, 0.0, -5.0)])


def use_scene(scene: rc.Scene) -> None:
    for name, _ in scene.instances[:3]:
        scene.moved(name, np.eye(4))
    photograph(scene, rc.Camera(LENS, film=FILM, position=(0, 1, 2), look_at=(0, 0, 0)))


def use_material(material: rc.Material) -> None:
    material.replace(diffuse=(1, 0, 0))
    scene = floor(material, rc.Material()).with_material(1, material).with_environment(10)
    photograph(scene, rc.Camera(LENS, film=FILM, position=(0, 1, 2), look_at=(0, 0, 0)))


def use_psf(psf: rc.PSF) -> None:
    psf.energy_inside(5)
    psf.mtf()


def use_surface(surface: rc.Surface) -> None:
    surface.replace(thickness_mm=1)
    rc.Lens(surfaces=[surface, rc.Stop(clear_semi_diameter_mm=3, thickness_mm=1)], film_distance_mm=50)


USES: dict[type, Callable[[Any], object]] = {
    rc.Lens: use_lens,
    rc.Camera: use_camera,
    rc.RenderSettings: lambda settings: settings.with_(seed=3),
    rc.Film: lambda film: rc.Camera(LENS, film=film),
    rc.Glass: lambda glass: (glass.index(550), glass.index(100), glass.index(20000)),
    rc.Surface: use_surface,
    rc.Coating: lambda coating: (coating.response(0, 550, inside=1.5), LENS.with_coating(coating)),
    rc.CoatingLayer: lambda layer: (layer.index(550), rc.Coating([layer])),
    rc.Scene: use_scene,
    rc.Material: use_material,
    rc.Wavefront: lambda wavefront: wavefront.map_waves(),
    rc.PSF: use_psf,
    rc.Sensor: lambda sensor: (sensor.iso_range(), sensor.film()),
    rc.Image: lambda image: (image.developed(), image.metadata()),
    rc.RawImage: lambda raw: (raw.metadata(), raw.white_level_dn),
}


def look_at(value: Any) -> None:
    """Raises AssertionError, or whatever else, where a value is not as one that a constructor has made."""
    repr(value)
    str(value)
    assert value == value
    with contextlib.suppress(TypeError):
        hash(value)
    for name in dir(type(value)):
        if name.startswith("_"):
            continue
        try:
            attribute = getattr(value, name)
        except rc.RealcamError:
            continue
        if isinstance(attribute, np.ndarray):
            attribute.tobytes()
    assert pickle.loads(pickle.dumps(value)) == value
    use = USES.get(type(value))
    if use is None:
        return
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        with contextlib.suppress(rc.RealcamError):  # refused in a line, as what a user writes
            use(value)
