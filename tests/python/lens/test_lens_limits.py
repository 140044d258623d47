"""Lenses that cannot be made, invalid glasses, and files that are not lens files."""

from __future__ import annotations

import math
import os
from pathlib import Path

import numpy as np
import pytest
import realcam as rc

STOP = rc.Stop(clear_semi_diameter_mm=2, thickness_mm=1)


def lens_of(*rows: dict[str, object], **more: object) -> rc.Lens:
    surfaces = [rc.Surface(**{"clear_semi_diameter_mm": 5.0, **row}) for row in rows]  # type: ignore[arg-type]
    return rc.Lens(surfaces=[STOP, *surfaces], **{"film_distance_mm": 50.0, **more})  # type: ignore[arg-type]


def front(**more: object) -> dict[str, object]:
    """Front surface of radius 10 with a semi-diameter of 5: its sag is 10 - sqrt(75) = 1.3397 mm."""
    return {"radius_of_curvature_mm": 10.0, "material": 1.5, **more}


PLANE: dict[str, object] = {}


def test_faces_that_cross_inside_their_rims_are_refused_with_their_numbers() -> None:
    lens_of(front(thickness_mm=1.35), PLANE)
    with pytest.raises(rc.LensFileError, match=r"surface 2: crosses surface 3, by 0\.24 mm at 5 mm") as caught:
        lens_of(front(thickness_mm=1.1), PLANE)
    assert caught.value.surface == 2
    # An overlap in air: the next element's front face curves back to this one's.
    first = [front(thickness_mm=3.0), {"thickness_mm": 1.2}]
    hollow: dict[str, object] = {"radius_of_curvature_mm": -10.0, "material": 1.5, "thickness_mm": 3.0}
    with pytest.raises(rc.LensFileError, match=r"surface 3: crosses surface 4, by 0\.14 mm at 5 mm"):
        lens_of(*first, hollow, PLANE)
    # An overlap within the rounding of printed figures is accepted: here 0.3 um.
    lens_of(front(thickness_mm=1.3394), PLANE)


def test_glass_is_there_up_to_the_rim_of_its_larger_face() -> None:
    # The back is edged flat at 2 mm, where the front's sag is 0.2020; at 5 mm it is 1.3397.
    with pytest.raises(rc.LensFileError, match=r"surface 2: crosses surface 3, by 0\.34 mm at 5 mm"):
        lens_of(front(thickness_mm=1.0), {"clear_semi_diameter_mm": 2.0})
    # A hollow one may be sunk into the glass, as in a fisheye's front.
    dome: dict[str, object] = {"radius_of_curvature_mm": 10.0, "material": 1.5, "clear_semi_diameter_mm": 9.9}
    lens_of({**dome, "thickness_mm": 1.0}, {"radius_of_curvature_mm": 5.0, "clear_semi_diameter_mm": 4.0})
    # Faces on both sides of an air gap overlap only up to the smaller rim.
    lens_of(
        {"material": 1.5, "thickness_mm": 3.0},
        {"radius_of_curvature_mm": 10.0, "thickness_mm": 1.0},
        {"material": 1.5, "thickness_mm": 2.0, "clear_semi_diameter_mm": 2.0},
        {"clear_semi_diameter_mm": 2.0},
    )


def test_faces_that_are_no_neighbours_may_not_cross_either() -> None:
    # A thin small plate between two large faces that meet around it.
    small = {"clear_semi_diameter_mm": 1.0}
    faces = [
        {"material": 1.5, "thickness_mm": 3.0},
        {"radius_of_curvature_mm": 10.0, "thickness_mm": 0.2},
        {"material": 1.6, "thickness_mm": 0.1, **small},
        {"thickness_mm": 0.2, **small},
        {"material": 1.5, "thickness_mm": 2.0},
        PLANE,
    ]
    with pytest.raises(rc.LensFileError, match=r"surface 3: crosses surface 6, by 0\.84 mm at 5 mm"):
        lens_of(*faces)


def test_an_asphere_that_dips_into_its_neighbour_between_axis_and_rim() -> None:
    # z = a r^2 (1 - (r / 5)^2) with a = 0.04 is highest at r = 5 / sqrt(2): 0.04 * 12.5 / 2 = 0.25 mm.
    dip = {"radius_of_curvature_mm": 12.5, "conic": -1.0, "aspheric_coefficients": {4: -0.04 / 25}, "material": 1.5}
    lens_of({**dip, "thickness_mm": 0.26}, PLANE)
    with pytest.raises(rc.LensFileError, match=r"surface 2: crosses surface 3, by 0\.05 mm at 3\.5"):
        lens_of({**dip, "thickness_mm": 0.2}, PLANE)


def test_crossing_may_be_allowed_and_stays_so() -> None:
    lens = lens_of(front(thickness_mm=1.1), PLANE, film_distance_mm=None, allow_overlap=True)
    assert lens.allow_overlap
    assert lens.focused(1.0).stopped_down(8).allow_overlap
    assert not lens_of(front(thickness_mm=2), PLANE).allow_overlap


def test_the_film_lies_behind_the_rim_of_the_last_face() -> None:
    cup = [{"material": 1.5, "thickness_mm": 2.0}, {"radius_of_curvature_mm": 10.0}]
    lens_of(*cup, film_distance_mm=1.4)
    with pytest.raises(
        rc.LensFileError, match=r"the film, 1\.3 mm behind the last vertex .* cuts through its last face"
    ):
        lens_of(*cup, film_distance_mm=1.3)
    # A film that is smaller than the face may lie inside it.
    lens_of(*cup, film_distance_mm=1.3, film_mm=(4.0, 4.0))
    for absurd in (1e10, 1e308, math.inf):
        with pytest.raises(rc.LensFileError, match="at most 1e9 mm"):
            lens_of(*cup, film_distance_mm=absurd, allow_overlap=True)


def test_focusing_stops_where_faces_would_cross() -> None:
    # A positive element whose hollow front comes nearer to a plate as the lens focuses nearer.
    wide = {"clear_semi_diameter_mm": 10.0}
    rows: list[dict[str, object]] = [
        {"material": 1.5, "thickness_mm": 1.0, **wide},
        {"thickness_mm": 8.0, **wide},
        {"material": 1.5, "thickness_mm": 7.0, "radius_of_curvature_mm": -30.0, **wide},
        {"radius_of_curvature_mm": -12.0, **wide},
    ]
    lens = lens_of(*rows, film_distance_mm=None, focus_group=(3, 4))
    least = 30 - math.sqrt(800)  # sag of the hollow front at its rim
    gaps = []
    with pytest.raises(rc.InputError, match=r"cannot focus at 0\.\d* m: .* surfaces 3 and 4 overlap"):
        for distance in np.linspace(0.5, 0.2, 61):
            gaps.append(lens.focused(distance).surfaces[2].thickness_mm)
    assert least - 0.002 < gaps[-1] < least + 0.3
    assert gaps == sorted(gaps, reverse=True)
    free = lens_of(*rows, film_distance_mm=None, focus_group=(3, 4), allow_overlap=True)
    assert free.focused(0.5 - 0.3 * len(gaps) / 60).surfaces[2].thickness_mm < least


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (lambda: rc.Glass.cauchy([]), "at least one coefficient"),
        (lambda: rc.Glass.cauchy([1.5, math.nan]), "finite"),
        (lambda: rc.Glass.from_abbe_number(1.5, 0), "positive Abbe number"),
        (lambda: rc.Glass.from_abbe_number(1.5, -60), "positive Abbe number"),
        (lambda: rc.Glass.from_abbe_number(0.5, 60), "at least 1"),
        (lambda: rc.Glass.from_abbe_number(math.inf, 60), "finite"),
        (lambda: rc.Glass.sellmeier([], []), "the same number of coefficients"),
        (lambda: rc.Glass.sellmeier([1.0], [math.inf]), "finite"),
        (lambda: rc.Glass.table([]), "at least one"),
        (lambda: rc.Glass.table([(500, 1.5), (500, 1.6)]), "twice"),
        (lambda: rc.Glass.table([(-500, 1.5)]), "positive numbers"),
        (lambda: rc.Surface(material=(1.5, 0.0), clear_semi_diameter_mm=5), "positive Abbe number"),
    ],
)
def test_what_is_no_glass_is_refused(call: object, says: str) -> None:
    assert callable(call)
    with pytest.raises(rc.InputError, match=says):
        call()


def test_only_regular_files_are_read(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.toml")
    (tmp_path / "loop.toml").symlink_to(tmp_path / "loop.toml")
    large = tmp_path / "large.toml"
    with large.open("wb") as file:
        file.truncate((16 << 20) + 1)
    for path, says in (
        (tmp_path / "pipe.toml", "a pipe or a device"),
        (Path("/dev/zero"), "a pipe or a device"),
        (tmp_path / "loop.toml", "cannot be read"),
        (large, "larger than 16 MiB"),
        (tmp_path / "none.toml", "no such file"),
    ):
        with pytest.raises(rc.LensFileError, match=says) as caught:
            rc.Lens.load(path)
        assert str(path) in str(caught.value)


def test_names_that_are_no_utf_8(tmp_path: Path) -> None:
    path = os.fsencode(tmp_path) + b"/l\xe9ns.toml"
    with pytest.raises(rc.LensFileError, match="no such file") as caught:
        rc.Lens.load(os.fsdecode(path))
    assert os.fsencode(caught.value.file) == path
    good = "format = 1\nname = 'a'\nfilm_distance_mm = 9.0\n[[surface]]\ntype = 'stop'\nclear_semi_diameter_mm = 1.0\n"
    Path(os.fsdecode(path)).write_text(good)
    for form in (path, os.fsdecode(path)):
        assert rc.Lens.load(form).name == "a"
    with pytest.raises(rc.InputError, match="null"):
        rc.Lens.load("a\0b.toml")
