"""Renders the pictures of docs/any-lens.md: the demo scene, and ghosts of a lamp, through lenses without rotational
symmetry."""

from __future__ import annotations

import sys
from pathlib import Path

import realcam as rc
from realcam.cli.sheet import save_sheet

ROOT = Path(__file__).resolve().parents[1]
HEIGHT = 240  # of each picture, pixels


def save_pictures(path: Path) -> None:
    """Writes the demo scene through several lenses."""
    shot = rc.Shot.load(ROOT / "scenes" / "demo.toml")
    gauss, focus_m = shot.camera.lens, shot.camera.lens.focus_distance_m

    def through(lens: rc.Lens, width_mm: float, height_mm: float, squeeze: float = 1.0, stops: float = 0.0) -> rc.Image:
        """Renders the demo scene.

        squeeze: factor by which the developed anamorphic picture is wider than the film. stops: additional exposure.
        """
        film = rc.Film(width_mm, height_mm, (round(HEIGHT * squeeze * width_mm / height_mm), HEIGHT))
        camera = rc.Camera(
            lens,
            film=film,
            position=shot.camera.position,
            look_at=shot.camera.look_at,
            exposure_time_s=shot.camera.exposure_time_s,
            iso=shot.camera.iso * 2**stops,
        )
        return rc.render(shot.scene, camera, effects=(), spp=512)

    slower = gauss.stopped_down(2.8)
    pictures = [
        ("Double Gauss 50 mm", through(gauss, 36, 24)),
        (
            "Anamorphic converter before a Tessar 50 mm",
            through(rc.Lens.load("scope-adapter-50mm").focused(focus_m), 30, 24, 1.327, 1),
        ),
        ("Periscope before a Tessar 50 mm", through(rc.Lens.load("periscope-50mm").focused(focus_m), 36, 24, stops=1)),
        ("Double Gauss tilted by 8 degrees: a wedge is sharp", through(slower.tilted(y_deg=8), 36, 24, stops=1)),
        ("Double Gauss shifted by 6 mm", through(gauss.shifted(y_mm=6), 36, 24)),
        ("Human eye, with its curved retina", through(rc.Lens.load("eye-22mm"), 16, 10.7, stops=2)),
    ]
    save_sheet(pictures, path, columns=2)


def save_ghosts(path: Path) -> None:
    """Writes ghosts of a lamp in the upper left of the frame, by coated lenses with similar vertical fields of view."""

    def through(lens: rc.Lens, width_mm: float, height_mm: float, squeeze: float = 1.0, iso: float = 1600) -> rc.Image:
        lens = lens.focused(30).with_coating("quarter_wave")
        film = rc.Film(width_mm, height_mm, (round(HEIGHT * squeeze * width_mm / height_mm), HEIGHT))
        camera = rc.Camera(lens, film=film, position=(0, 1.6, 0), look_at=(0, 1.6, -1), exposure_time_s=1 / 50, iso=iso)
        # The lamp lies a quarter of the picture's width and height from its upper left corner.
        (origin,), (direction,) = camera.ray([(0.25 * film.resolution[0], 0.25 * film.resolution[1])])
        scene = night.with_point_light(origin + 30 * direction, (4e5, 4e5, 4e5))
        return rc.render(scene, camera, effects={"ghosts", "dispersion"}, spp=128)

    night = rc.Scene.from_arrays([(0.0, 0.0, 99.0), (1.0, 0.0, 99.0), (0.0, 1.0, 99.0)], [[0, 1, 2]])
    pictures = [
        ("Double Gauss 100 mm", through(rc.Lens.load("double-gauss-100mm"), 36, 24)),
        ("Front anamorphic 31 mm", through(rc.Lens.load("anamorphic-31mm"), 17, 18.6, 1.93)),
        ("Rear anamorphic 65 mm", through(rc.Lens.load("anamorphic-65mm"), 22, 18.6, 2, iso=100)),
    ]
    save_sheet(pictures, path, columns=1)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit("usage: python tools/any_lens_picture.py PICTURE GHOSTS")
    save_pictures(Path(sys.argv[1]))
    save_ghosts(Path(sys.argv[2]))
