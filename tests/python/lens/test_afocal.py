"""Lenses without a focus: infinite figures, and errors that say so."""

import json
import math
from pathlib import Path

import numpy as np
import pytest
import realcam as rc

from ..programs import Command


def galilean(film_distance_mm: float | None = 40.0) -> rc.Lens:
    """Two thin elements of 128 and -64 mm: parallel light leaves them half as wide."""

    def face(radius_mm: float, thickness_mm: float, material: float) -> rc.Surface:
        return rc.Surface(
            radius_of_curvature_mm=radius_mm,
            thickness_mm=thickness_mm,
            material=material,
            clear_semi_diameter_mm=15,
        )

    return rc.Lens(
        surfaces=[
            face(128, 0, 2.0),
            face(math.inf, 64, 1.0),
            face(-64, 0, 2.0),
            face(math.inf, 2, 1.0),
            rc.Stop(clear_semi_diameter_mm=4),
        ],
        name="galilean",
        allow_overlap=True,  # elements without thickness, whose focal lengths are powers of two
        film_distance_mm=film_distance_mm,
    )


def test_what_an_afocal_lens_cannot_do_is_refused_with_the_reason() -> None:
    lens = galilean()
    for distance_m in (2.0, math.inf):
        with pytest.raises(rc.InputError, match="afocal"):
            lens.focused(distance_m)
    with pytest.raises(rc.InputError, match="has no f-number: it is afocal"):
        lens.stopped_down(8)
    with pytest.raises(rc.InputError, match="no best focus"):
        lens.best_focus_mm()
    with pytest.raises(rc.LensFileError, match="film_distance_mm is required"):
        galilean(film_distance_mm=None)


HOLE = rc.Lens(surfaces=[rc.Stop(clear_semi_diameter_mm=0.1)], name="hole", film_distance_mm=20.0)


def test_a_camera_without_a_lens_is_a_pinhole() -> None:
    """A stop alone, which is afocal: every model gives the same picture, and a stop of 0.1 mm cos^4 of it."""
    mean = {}
    for model in ("pinhole", "thin", "thick", "full"):
        camera = rc.Camera(HOLE, film=rc.Film(width_mm=20, height_mm=20, resolution=(8, 8)), model=model)
        rays = camera.generate_rays(spp=256)
        assert np.isfinite(rays.weights).all() and np.isfinite(rays.directions).all()
        mean[model] = rays.weights.mean()
    for model, value in mean.items():
        # The hole's own size changes the cosines by (0.1 / 20)^2; 1% of the full lens's samples miss.
        assert value == pytest.approx(mean["full"], rel=0.003), model


@pytest.mark.picture_files
def test_the_command_line_writes_infinite_figures_as_json_that_anyone_reads(tmp_path: Path, command: Command) -> None:
    path = tmp_path / "hole.toml"
    HOLE.save(path)

    def no_json(constant: str) -> None:
        pytest.fail(f"{constant} is no JSON")

    data = json.loads(command("lens", "info", path, "--json").stdout, parse_constant=no_json)
    assert data["effective_focal_length_mm"] is None
    assert data["entrance_pupil_diameter_mm"] == pytest.approx(0.2)
    assert "inf" in command("lens", "info", path).stdout
