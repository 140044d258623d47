"""What was photographed and what it cost, in words."""

from __future__ import annotations

import math

from .image import Image


def summary(image: Image) -> str:
    """Some lines: lens, focus, film and exposure; rays per second, and where the time went."""
    camera, stats = image.camera, image.stats
    lens, film, data = camera.lens, camera.film, camera.lens.first_order()
    focus = "infinity" if math.isinf(lens.focus_distance_m) else f"{lens.focus_distance_m:.4g} m"
    busy = stats.lens_seconds + stats.scene_seconds + stats.other_seconds
    model = "" if camera.model == "full" else f", as {camera.model} model"
    width, height = film.resolution
    rows = [
        ("lens", f"{lens.title or lens.name}{model}"),
        ("", f"focal length {data.effective_focal_length_mm:.4g} mm, f/{data.f_number:.3g}, focus {focus}"),
        ("camera", f"at {_point(camera.position)}, looks at {_point(camera.look_at)}"),
        (
            "film",
            f"{film.width_mm:.4g} x {film.height_mm:.4g} mm, {width} x {height} pixels of {image.spp} samples",
        ),
        ("exposure", f"{_exposure(camera.exposure_time_s)}, ISO {camera.iso:.4g}"),
        (
            "lens rays",
            f"{_millions(stats.sampled_rays, stats.seconds)}/s;"
            f" {_millions(stats.sampled_rays, stats.lens_seconds)}/s a core while in the lens,"
            f" {_percent(stats.lens_seconds, busy)} of the time;"
            f" {_percent(stats.passed_rays, stats.sampled_rays)} of the sampled rays pass",
        ),
        (
            "scene rays",
            f"{_millions(stats.scene_rays, stats.seconds)}/s;"
            f" {_millions(stats.scene_rays, stats.scene_seconds)}/s a core while in the scene,"
            f" {_percent(stats.scene_seconds, busy)} of the time",
        ),
        ("time", f"{stats.seconds:.3g} s (set-up {stats.setup_seconds:.2g} s) on {stats.device}"),
    ]
    return "\n".join(f"{what:<11}{value}" for what, value in rows)


def _point(p: tuple[float, float, float]) -> str:
    return ",".join(f"{v:.4g}" for v in p)


def _exposure(seconds: float) -> str:
    return f"1/{1 / seconds:.4g} s" if seconds < 0.5 else f"{seconds:.4g} s"


def _millions(count: int, seconds: float) -> str:
    return f"{1e-6 * count / seconds if seconds > 0 else 0:.1f} M"


def _percent(part: float, whole: float) -> str:
    return f"{100 * part / whole if whole > 0 else 0:.1f}%"
