"""For each effect a picture without and with it."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import matplotlib.image
import numpy as np
import realcam as rc

ROOT = Path(__file__).resolve().parents[2]
# The scenes of the pictures in docs/motion.md and docs/diffraction.md.
sys.path.insert(0, str(ROOT / "tools"))

from diffraction_picture import night  # noqa: E402
from motion_picture import board, street  # noqa: E402

SIZE = (600, 400)
TOOLS = ROOT / "tools"
SOURCES = (Path(__file__), TOOLS / "diffraction_picture.py", TOOLS / "motion_picture.py")


@dataclass(frozen=True)
class Pair:
    """Two pictures of a scene, which differ in one effect."""

    scene: rc.Scene
    camera: rc.Camera
    without: tuple[str, ...]
    with_effect: tuple[str, ...]
    what: str
    spp: int = 32
    is_denoised: bool = True
    page: str = ""  #: of docs/, if it has not the effect's name

    def save(self, folder: Path, name: str) -> None:
        for suffix, effects in (("without", self.without), ("with", self.with_effect)):
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # of coatings that no lens file knows
                image = rc.render(
                    self.scene,
                    self.camera,
                    spp=self.spp,
                    max_bounces=2,
                    effects=effects,
                    layers=["albedo", "normal", "traced_light"],
                )
            image = image.denoised() if self.is_denoised else image
            matplotlib.image.imsave(folder / f"{name}-{suffix}.png", image.developed())


def demo() -> rc.Shot:
    return rc.Shot.load(ROOT / "scenes" / "demo.toml")


def sized(camera: rc.Camera) -> rc.Camera:
    return camera.replace(film=camera.film.replace(resolution=SIZE))


def dispersion() -> Pair:
    """The corner of a board through a single lens, which nothing corrects."""
    lens = rc.Lens.load("singlet-100mm").with_film(36, 24).focused(2.0)
    camera = rc.Camera(lens, film=rc.Film(9, 6, SIZE, shift_mm=(9, 6)), position=(0, 0, 2.0), exposure_time_s=1 / 60)
    scene = board(0.5, 0.36, (90, 66)).with_environment(1200)
    camera = camera.metered(scene)
    return Pair(scene, camera, (), ("dispersion",), "The corner of a board through a single lens of one glass.")


def coatings() -> Pair:
    shot = demo()
    return Pair(
        shot.scene, sized(shot.camera), (), ("coatings",),
        "The demo shot. The lens file does not say how its glass is coated, so it is bare, and takes four tenths.",
    )  # fmt: skip


def lamp_shot(candela: float) -> rc.Shot:
    """The demo shot, with two spotlights in the picture that shine into the lens alone."""
    shot = demo()
    scene, eye = shot.scene, np.array(shot.camera.position)
    for place in ((-0.2, 0.24, -0.4), (0.12, 0.3, -0.5)):
        scene = scene.with_spot_light(place, eye - place, (candela, 0.9 * candela, 0.8 * candela), outer_cone_deg=8)
    return replace(shot, scene=scene, camera=sized(shot.camera))


def ghosts() -> Pair:
    shot = lamp_shot(120)
    return Pair(
        shot.scene, shot.camera, (), ("ghosts",),
        "The demo shot with two lamps that shine into a bare lens. Each pair of surfaces makes a disc or a star of a "
        "lamp, and all together a veil.",
        spp=384,
    )  # fmt: skip


def film_reflection() -> Pair:
    """Through a lens whose last surfaces make large patches of what the film reflects."""
    shot = lamp_shot(2000)
    lens, now = rc.Lens.load("double-gauss-50mm-fast"), shot.camera.lens
    stops = lens.first_order().f_number / now.first_order().f_number
    camera = shot.camera.replace(
        lens=lens.focused(now.focus_distance_m), exposure_time_s=shot.camera.exposure_time_s * stops**2
    )
    return Pair(
        shot.scene, camera, (), ("film_reflection",),
        "The demo shot with two strong lamps. The film reflects a twentieth of their light, and surfaces of the lens "
        "return it: as bright patches on the other side of the middle, and as a veil.",
        spp=128, page="ghosts",
    )  # fmt: skip


def diffraction() -> Pair:
    lens = rc.Lens.load("double-gauss-50mm").with_iris(blades=6, rotation_deg=8).stopped_down(16).focused(5.0)
    camera = rc.Camera(lens, film=rc.Film(24, 16, SIZE), exposure_time_s=1.0, iso=400)
    return Pair(
        night(), camera, (), ("diffraction",),
        "Three lamps before a board, at f/16 with six blades.", spp=256, is_denoised=False,  # thin rays stay
    )  # fmt: skip


def moving(readout_time_s: float) -> tuple[rc.Scene, rc.Camera]:
    lens = rc.Lens.load("double-gauss-50mm").focused(6.0).stopped_down(5.6)
    camera = rc.Camera(lens, film=rc.Film(36, 24, SIZE), exposure_time_s=1 / 125, shutter_opens_s=0.004)
    scene = street().with_environment(900.0).with_sun((0.3, -0.4, -0.85), (9e3, 9e3, 9e3))
    return scene, camera.replace(readout_time_s=readout_time_s)


def motion_blur() -> Pair:
    scene, camera = moving(0.0)
    return Pair(
        scene, camera, ("-motion_blur",), (),
        "A spoke that turns six times a second, and a post that passes at 12 m/s; 1/125 s.", page="motion",
    )  # fmt: skip


def rolling_shutter() -> Pair:
    scene, camera = moving(1 / 40)
    return Pair(
        scene, camera, ("-rolling_shutter",), (),
        "The same, by a sensor whose rows are read one after the other in 1/40 s.", page="motion",
    )  # fmt: skip


PAIRS: dict[str, Callable[[], Pair]] = {
    make.__name__: make
    for make in (dispersion, coatings, ghosts, film_reflection, diffraction, motion_blur, rolling_shutter)
}
