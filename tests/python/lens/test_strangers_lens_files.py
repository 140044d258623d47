"""Lens files as other people's programs write them: what they lack, and what they have that is rare."""

from __future__ import annotations

import json
import math
import warnings
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
import realcam as rc

from ..programs import Command

pytestmark = pytest.mark.filterwarnings("ignore")

HEAD = """MODE SEQ
UNIT MM
{aperture}
GCAT SCHOTT
FTYP 0 0 2 3
YFLN 0 7
WAVM 1 0.5875618 1
PWAV 1
"""


def surface(radius: float, thickness: float | str, rim: float, more: str = "") -> str:
    curvature = 0 if math.isinf(radius) else 1 / radius
    return f'  TYPE STANDARD\n  CURV {curvature!r}\n  DISZ {thickness}\n  DIAM {rim} 1 0 0 1 ""\n{more}'


def glass(index: float, abbe: float) -> str:
    return f"  GLAS ___BLANK 1 0 {index} {abbe}\n"


CROWN, PLATE = glass(1.618, 63.4), glass(1.5168, 64.2)
OBJECT = "  CURV 0\n  DISZ INFINITY\n"


def zemax(surfaces: Sequence[str], aperture: str = "FNUM 4 0", first: int = 0, end: str = "") -> str:
    listed = "".join(f"SURF {first + i}\n{text}" for i, text in enumerate(surfaces))
    return HEAD.format(aperture=aperture) + listed + end


def load(folder: Path, name: str, text: str, **options: object) -> tuple[rc.Lens, str]:
    """The lens, and its warnings."""
    path = folder / name
    path.write_text(text)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        lens = rc.Lens.load(path, **options)  # type: ignore[arg-type]
    return lens, "\n".join(str(w.message) for w in caught)


def zoom(operands: str) -> str:
    """A zoom lens of two groups, the front one of focal length -60 mm, in Zemax's format."""
    return zemax(
        [
            OBJECT,
            surface(-70, 1.5, 14, PLATE),
            surface(55, 28, 13),
            surface(math.inf, 1, 5, "  STOP\n"),
            surface(30, 4, 9, CROWN),
            surface(-48, 44.5774, 9),
            surface(math.inf, 0, 10),
        ],
        "FLOA",
        end=f"MNUM 2 1\nTHIC 2 1 28\nTHIC 2 2 6\nTHIC 5 1 44.5774\nTHIC 5 2 53.8164\n{operands}",
    )


def test_the_stop_of_each_configuration(tmp_path: Path) -> None:
    """The f-number is inverse to the stop's semi-diameter."""
    alike, _ = load(tmp_path, "alike.zmx", zoom(""))
    lens, _ = load(tmp_path, "sizes.zmx", zoom("SDIA 3 1 5.0\nSDIA 3 2 6.2\n"))
    first, second = (lens.zoomed(i).first_order().f_number for i in range(2))
    assert first == pytest.approx(alike.zoomed(0).first_order().f_number, rel=1e-12)
    assert second == pytest.approx(alike.zoomed(1).first_order().f_number * 5 / 6.2, rel=1e-12)
    assert second == pytest.approx(4.335, abs=5e-4)
    # For any surface but the stop, SDIA sets a rim. A lens has one rim per surface: the largest, with a warning.
    rims, told = load(tmp_path, "rims.zmx", zoom("SDIA 5 1 8.5\nSDIA 5 2 9.5\n"))
    assert rims.surfaces[4].clear_semi_diameter_mm == 9.5 and "semi-diameters" in told


def test_a_thickness_behind_the_image_bends_no_ray(tmp_path: Path) -> None:
    plain, _ = load(tmp_path, "plain.zmx", zoom(""))
    lens, told = load(tmp_path, "image.zmx", zoom("THIC 6 1 0\nTHIC 6 2 3\n"))
    assert "behind the image" in told
    assert [lens.zoomed(i).film_distance_mm for i in range(2)] == [plain.zoomed(i).film_distance_mm for i in range(2)]
    with pytest.raises(rc.LensFileError, match="surface 7, which the lens does not have"):
        load(tmp_path, "none.zmx", zoom("THIC 7 1 0\n"))


SINGLET = [surface(25, 3, 6, CROWN), surface(-40, 24, 6), surface(math.inf, 0, 8)]


@pytest.mark.parametrize("name", ["lens.zmx", "lens.seq", "lens.dat"])
def test_without_a_stop_the_first_surface_is_one(name: str, tmp_path: Path) -> None:
    text = {
        ".zmx": zemax([OBJECT, *SINGLET]),
        ".seq": "RDM;LEN\nFNO 4\nDIM M\nWL 587.6\nYAN 0 5\nSO 0 1e13\nS 25 3 618.634\nS -40 24\nSI 0 0\nGO\n",
        ".dat": "25 3 1.618 12\n-40 0 1 12\n",
    }[name[-4:]]
    lens, told = load(tmp_path, name, text)
    assert lens.stop_index == 0 and "specifies no aperture stop: surface 1 is assumed" in told


def test_a_list_of_faces_alone(tmp_path: Path) -> None:
    """The list begins with surface 1, or gives the object the first element's glass, and ends with the last face."""
    proper, _ = load(tmp_path, "proper.zmx", zemax([OBJECT, *SINGLET], "FLOA"))
    faces = [surface(25, 3, 6, CROWN), surface(-40, 0, 6)]
    for first in (0, 1):
        lens, told = load(tmp_path, f"faces{first}.zmx", zemax(faces, "FLOA", first))
        assert "lists only faces" in told
        assert [s.radius_of_curvature_mm for s in lens.surfaces[1:]] == [25, -40]
        expected = proper.first_order().effective_focal_length_mm
        assert lens.first_order().effective_focal_length_mm == pytest.approx(expected, rel=1e-12)
        # The film lies where real rays are sharpest, in front of the paraxial focus.
        assert 0 < lens.first_order().back_focal_distance_mm - lens.film_distance_mm < 2
    # A stop between two faces has a label of its own.
    labelled = zemax(faces, "FLOA", 1).replace("SURF 2\n", "SURF 1AS\n  STOP\n  DISZ 1\n  DIAM 5\nSURF 2\n")
    assert load(tmp_path, "label.zmx", labelled)[0].stop_index == 1


# The medium before the film has the index n'. Focal lengths are closed forms of one or two surfaces.


def one_face(tmp_path: Path) -> rc.Lens:
    """A ball of water behind one face of radius 10 mm: power 0.05 per mm, and the focus 30 mm behind it."""
    text = """format = 1
name = "one-face"
film_mm = [1.2, 0.8]
film_distance_mm = 30
[[surface]]
type = "stop"
thickness_mm = 0
clear_semi_diameter_mm = 0.5
[[surface]]
radius_of_curvature_mm = 10
material = 1.5
clear_semi_diameter_mm = 4
"""
    return load(tmp_path, "face.toml", text)[0]


def test_first_order_of_an_image_space_of_glass(tmp_path: Path) -> None:
    data = one_face(tmp_path).first_order()
    assert data.effective_focal_length_mm == pytest.approx(20, rel=1e-12)  # 10 / (1.5 - 1)
    assert data.back_focal_distance_mm == pytest.approx(30, rel=1e-12)  # 1.5 times that
    assert data.front_focal_distance_mm == pytest.approx(-20, rel=1e-12)
    assert data.f_number == pytest.approx(20, rel=1e-12) and data.image_index == 1.5


@pytest.mark.parametrize("model", ["full", "thin", "thick", "mapped", "pinhole"])
@pytest.mark.parametrize("focus_m", [math.inf, 0.5])
def test_all_camera_models_have_the_scale_of_the_picture(model: str, focus_m: float, tmp_path: Path) -> None:
    """From the centre of the face, which is the middle of the pupil, refraction is n sin = n' sin."""
    lens = one_face(tmp_path).focused(focus_m)
    film_mm = lens.film_mm[0]
    camera = rc.Camera(lens, model=model, film=rc.Film(film_mm, film_mm * 2 / 3, (600, 400)))
    image_mm = camera.camera_matrix[0][0] * film_mm / 600
    # By the paraxial chief ray, whose slope in the glass is that in front over 1.5. The film stands where real rays are
    # sharpest, which for the mark of f/20 is 0.1 % from the paraxial image.
    assert image_mm == pytest.approx(lens.film_distance_mm / 1.5, rel=2e-3)


def test_irradiance_has_the_square_of_the_index(tmp_path: Path) -> None:
    """E = pi L n'^2 sin^2 u'; with the f-number N that is pi L / (4 N^2) for small apertures."""
    lens = one_face(tmp_path)
    sine = 0.5 / math.hypot(30, 0.5)
    assert rc.photography.working_f_number(lens) == pytest.approx(1 / (2 * 1.5 * sine), rel=2e-3)
    assert lens.t_stop == pytest.approx(20 / math.sqrt(1 - 0.04), rel=5e-3)  # Fresnel: 0.04 of the light goes back


def test_a_film_on_the_cover_glass(tmp_path: Path) -> None:
    """A plate before the focus has no power: the focal length is that of the singlet."""
    rows = [OBJECT, surface(25, 3, 6, CROWN), surface(-40, 22, 6), surface(math.inf, 1, 8, PLATE)]
    lens, told = load(tmp_path, "cover.zmx", zemax([*rows, surface(math.inf, 0, 8), surface(math.inf, 0, 8)]))
    cemented, _ = load(tmp_path, "cemented.zmx", zemax([*rows, surface(math.inf, 0, 8)]))
    phi1, phi2, d = 0.618 / 25, 0.618 / 40, 3 / 1.618
    expected = 1 / (phi1 + phi2 - phi1 * phi2 * d)
    for one in (lens, cemented):
        assert one.first_order().effective_focal_length_mm == pytest.approx(expected, rel=1e-9)
        assert one.first_order().f_number == pytest.approx(4, rel=1e-9)
    assert "touches the last face" in told and lens.film_distance_mm == 1e-3
    lens.save(tmp_path / "cover.toml")
    text = (tmp_path / "cover.toml").read_text().replace("film_distance_mm = 0.001", "film_distance_mm = 0")
    assert load(tmp_path, "zero.toml", text)[0].film_distance_mm == 1e-3


def crossing(rim: float) -> str:
    """Two faces that meet 7.5 mm from the axis; the fields' light passes 2 mm from it."""
    return zemax(
        [
            OBJECT,
            surface(math.inf, 1, 2, "  STOP\n"),
            surface(20, 1.5, rim, CROWN),
            surface(-20, 3, rim),
            surface(math.inf, 14, 6, PLATE),
            surface(math.inf, 0, 8),
            surface(math.inf, 0, 8),
        ],
        "ENPD 2",
    )


def test_rims_that_cross_beyond_the_light(tmp_path: Path) -> None:
    # Sags of r^2 / 40 on both sides use up 1.5 mm at 5.4 mm.
    lens, told = load(tmp_path, "far.zmx", crossing(6.0))
    assert lens.allow_overlap and "reaches that far" in told
    assert not load(tmp_path, "apart.zmx", crossing(5.0))[0].allow_overlap
    with pytest.raises(rc.LensFileError, match="such a lens cannot be manufactured"):
        load(tmp_path, "reached.zmx", crossing(6.0).replace("ENPD 2", "ENPD 11.5").replace("DIAM 2 ", "DIAM 6 "))


def test_a_decimal_comma_of_an_index(tmp_path: Path) -> None:
    with_point, _ = load(tmp_path, "point.zmx", zemax([OBJECT, *SINGLET]))
    text = zemax([OBJECT, *SINGLET]).replace("1.618 63.4", "1,618 63,4")
    with_comma, told = load(tmp_path, "comma.zmx", text)
    assert with_comma.surfaces == with_point.surfaces
    assert 'the comma of "1,618" is read as a decimal point' in told
    with pytest.raises(rc.LensFileError, match=r'n_d must be a finite number; it is "1,6,18"'):
        load(tmp_path, "commas.zmx", text.replace("1,618", "1,6,18"))


def test_a_rim_beyond_its_hemisphere(tmp_path: Path) -> None:
    """No ray meets a sphere of 12 mm farther than 12 mm from its axis, whatever the file says."""
    far, told = load(tmp_path, "far.zmx", zemax([OBJECT, surface(12, 3, 12.3, CROWN), *SINGLET[1:]]))
    near, _ = load(tmp_path, "near.zmx", zemax([OBJECT, surface(12, 3, 11.9, CROWN), *SINGLET[1:]]))
    assert far.surfaces[1].clear_semi_diameter_mm == pytest.approx(12, rel=1e-8)
    assert "its clear semi-diameter of 12.3 mm is larger than the surface, and becomes 12 mm" in told
    assert far.first_order() == near.first_order()


def test_cement_of_norland(tmp_path: Path) -> None:
    """Norland's data as lens makers have them, n^2 = A0 + A2 / l^2 + A3 / l^4 + A4 / l^6 + A5 / l^8."""
    text = zemax([OBJECT, surface(12, 3, 8, "  GLAS NOA61 0 0 1.5 40\n"), *SINGLET[1:]]).replace("SCHOTT", "NOA61 MISC")
    lens, _ = load(tmp_path, "cement.zmx", text)
    for nm in (486.1327, 587.5618, 656.2725):
        square = sum(
            a / (nm / 1000) ** p
            for a, p in zip(
                (2.36390625, 0.025493134, -0.000580235, -0.349933e-5, 0.445404e-7), (0, 2, 4, 6, 8), strict=True
            )
        )
        assert lens.surfaces[1].material.index(nm) == pytest.approx(math.sqrt(square), abs=1e-7)


def test_a_medium_of_index_minus_one_is_a_mirror(tmp_path: Path) -> None:
    texts = [
        zemax(
            [
                OBJECT,
                surface(math.inf, 90, 10, "  STOP\n"),
                surface(-200, -60, 12, mirror),
                surface(-150, 66, 5, mirror),
                surface(math.inf, 0, 9),
            ],
            "ENPD 10",
        )
        for mirror in ("  GLAS MIRROR 0 0 1.5 40\n", "  GLAS ___BLANK 1 0 -1 0\n")
    ]
    named, by_index = (load(tmp_path, f"{i}.zmx", text)[0] for i, text in enumerate(texts))
    assert [s.type for s in named.surfaces] == ["stop", "mirror", "mirror"]
    assert by_index.surfaces == named.surfaces
    assert by_index.film_distance_mm == named.film_distance_mm


def test_an_object_in_water_is_seen_through_a_plane_window(tmp_path: Path) -> None:
    """A plane has no power, and the front face has that of water: the focal length follows from both faces."""
    water = OBJECT + "  GLAS ___BLANK 1 0 1.33306 54\n"
    lens, told = load(tmp_path, "water.zmx", zemax([water, *SINGLET]))
    phi1, phi2, d = (1.618 - 1.33306) / 25, 0.618 / 40, 3 / 1.618
    assert lens.first_order().effective_focal_length_mm == pytest.approx(1 / (phi1 + phi2 - phi1 * phi2 * d), rel=1e-9)
    assert "its object lies in a medium" in told


@pytest.mark.parametrize("power", [24, 30, 38])
def test_aspheric_terms_of_high_powers(power: int, tmp_path: Path) -> None:
    """The term is 1 um at the rim; all formats say the same sag."""
    value = 1e-3 * 6.0**-power
    count = power // 2
    data = "".join(f"  XDAT {k + 2} {value if k == count else 0!r}\n" for k in range(1, count + 1))
    face = surface(25, 3, 6, CROWN).replace("STANDARD", "XASPHERE") + f"  XDAT 1 {count}\n  XDAT 2 1\n{data}"
    lens, _ = load(tmp_path, "high.zmx", zemax([OBJECT, face, *SINGLET[1:]], "ENPD 6"))
    written = [lens]
    for suffix in (".zmx", ".toml", ".json", ".roa"):
        path = tmp_path / f"again{suffix}"
        lens.save(path)
        written.append(rc.Lens.load(path))
    for one in written:
        asphere = next(s for s in one.surfaces if s.radial_terms)
        assert asphere.radius_of_curvature_mm == pytest.approx(25, rel=1e-12)
        assert asphere.radial_terms == pytest.approx({power: value}, rel=1e-12)


def test_iset_begins_with_the_focal_length(tmp_path: Path) -> None:
    rows = "# radius axpos N aperture\n25 3 1.618 12\n-40 2 1 12\n0 2 1 10\n"
    plain, _ = load(tmp_path, "lens.dat", rows)
    lens, told = load(tmp_path, "lens.dat", "# singlet\n# focal length (in mm)\n25.3\n" + rows)
    assert lens.surfaces == plain.surfaces and "25.3 mm, is ignored" in told


def optiland(material: dict[str, object]) -> str:
    def row(z: float, radius: float, material: dict[str, object], **more: object) -> dict[str, object]:
        frame = {"x": 0, "y": 0, "z": z, "rx": 0, "ry": 0, "rz": 0, "reference_cs": None}
        geometry = {"type": "StandardGeometry", "cs": frame, "radius": radius, "conic": 0}
        model = {"type": "RefractiveReflectiveModel", "is_reflective": False}
        return {"type": "Surface", "geometry": geometry, "material_post": material, "interaction_model": model, **more}

    air = {"type": "IdealMaterial", "index": 1.0}
    far = {"type": "ObjectSurface", "geometry": {"type": "Plane", "cs": {"z": -math.inf}}, "material_post": air}
    faces = [row(0, 50, material, is_stop=True), row(4, -80, air), row(64, math.inf, air)]
    return json.dumps(
        {
            "aperture": {"type": "EPD", "value": 8},
            "fields": {"fields": [{"x": 0, "y": 3}], "field_definition": {"field_type": "AngleField"}},
            "wavelengths": {"wavelengths": [{"value": 0.5875618, "is_primary": True, "unit": "um"}]},
            "surface_group": {"surfaces": [far, *faces]},
        }
    )


@pytest.mark.parametrize(
    ("page", "n_d", "told"),
    [
        ("BaF2/Malitson", 1.47448, ""),  # Malitson (1964)
        ("BaF2/Kaiser", 1.47448, "is unknown"),
        ("SiO2/Malitson", 1.458464, ""),  # Malitson (1965): 1.45846
        ("CaF2/Malitson", 1.433849, ""),
        ("CaF2/Daimon-20", 1.433877, ""),
        ("ZnS/Querry", 2.3598, ""),
    ],
)
def test_the_shelf_main_names_substances(page: str, n_d: float, told: str, tmp_path: Path) -> None:
    path = f"/opt/optiland/database/data-nk/main/{page}.yml"
    material = {"type": "Material", "name": page.split("/")[0], "filename": path}
    lens, warned = load(tmp_path, "lens.json", optiland(material))
    index = next(s for s in lens.surfaces if s.material.index(600.0) > 1.1).material.index(587.5618)
    assert index == pytest.approx(n_d, abs=2e-4 if "Querry" in page else 5e-6)
    assert told in warned and ("is unknown" in warned) == bool(told)


def lens_of(
    front: Sequence[tuple[float, float, float, object]], back: Sequence[tuple[float, float, float, object]]
) -> rc.Lens:
    """Radius, thickness, rim and material of the faces on both sides of a stop."""

    def faces(rows: Sequence[tuple[float, float, float, object]]) -> list[rc.Surface]:
        return [
            rc.Surface(radius_of_curvature_mm=r, thickness_mm=t, clear_semi_diameter_mm=rim, material=material)  # type: ignore[arg-type]
            for r, t, rim, material in rows
        ]

    stop = rc.Surface(type="stop", clear_semi_diameter_mm=4)
    return rc.Lens(surfaces=[*faces(front), stop, *faces(back)])


def test_two_makers_glasses_of_one_name(tmp_path: Path) -> None:
    """Schott and CDGM each have an F2: a bare name is ambiguous if a file lists both catalogues."""
    crown = "cdgm:H-ZK9A"
    lens = lens_of(
        [(22, 3, 9, crown), (-400, 6, 9, None), (-22, 1, 5, "schott:F2"), (20, 5.75, 5, None)],
        [(60, 3, 7, crown), (-18, 0, 7, None)],
    )
    with pytest.warns(UserWarning, match="schott:F2.*another maker"):
        lens.save(tmp_path / "two.zmx")
    assert "F2 0 0" not in (tmp_path / "two.zmx").read_text()
    again, _ = load(tmp_path, "again.zmx", (tmp_path / "two.zmx").read_text())
    assert again.first_order().effective_focal_length_mm == pytest.approx(
        lens.first_order().effective_focal_length_mm, rel=1e-9
    )


LINES_NM = (486.1327, 587.5618, 656.2725)


@pytest.mark.parametrize("material", [(1.67, 47.1), "schott:F4", "SF5", "N-BK7", "ZNS-QUERRY"])
def test_glasses_for_optiland_are_written_as_data(material: object, tmp_path: Path) -> None:
    lens = lens_of([], [(50, 4, 8, material), (-80, 0, 8, None)])
    path = tmp_path / "lens.json"
    lens.save(path)
    again, _ = load(tmp_path, "again.json", path.read_text())
    expected = [lens.surfaces[1].material.index(nm) for nm in LINES_NM]
    assert [again.surfaces[1].material.index(nm) for nm in LINES_NM] == pytest.approx(expected, abs=1e-9)
    pytest.importorskip("optiland")
    from optiland.fileio import load_optiland_file

    read = load_optiland_file(str(path))
    posts = [s.material_post for s in read.surface_group.surfaces]
    indices = [[float(np.squeeze(post.n(nm / 1000))) for nm in LINES_NM] for post in posts]
    assert indices[2] == pytest.approx(expected, abs=1e-6)


AGF = """CC made for a test
NM XYZ-1 2 517642 1.5168 64.17 0 1
CD 1.03961212 0.00600069867 0.231792344 0.0200179144 1.01046945 103.560653
LD 0.3 2.5
NM XYZ-2 1 0 1.6 40 0 1
CD 2.5 -0.01 0.02 0.0004 0.00001 0.000001
LD 0.3 2.5
"""


def test_catalogues_of_glasses(tmp_path: Path, command: Command) -> None:
    catalogue = tmp_path / "mine.agf"
    catalogue.write_text(AGF)
    rows = [OBJECT, surface(25, 3, 6, "  GLAS XYZ-1 0 0 1.5 40\n"), surface(-40, 3, 6, "  GLAS XYZ-2 0 0 1.5 40\n")]
    text = zemax([*rows, surface(-80, 40, 8), surface(math.inf, 0, 8)])
    with pytest.raises(rc.LensFileError, match="unknown glass"):
        load(tmp_path, "lens.zmx", text)
    lens, _ = load(tmp_path, "lens.zmx", text, glass_catalogue=catalogue)
    first, second = (lens.surfaces[i].material.index(587.5618) for i in (1, 2))
    assert first == pytest.approx(1.5168, abs=1e-6)  # these are N-BK7's coefficients
    l2 = 0.5875618**2
    schott = 2.5 - 0.01 * l2 + 0.02 / l2 + 0.0004 / l2**2 + 0.00001 / l2**3 + 0.000001 / l2**4
    assert second == pytest.approx(math.sqrt(schott), abs=1e-7)
    assert command("lens", "info", tmp_path / "lens.zmx", "--glass-catalogue", catalogue).returncode == 0
    (tmp_path / "no.agf").write_text("NM X 99\n")
    with pytest.raises(rc.LensFileError, match="number of the dispersion formula"):
        load(tmp_path, "lens.zmx", text, glass_catalogue=[tmp_path / "no.agf"])


def test_lenses_of_the_lens_path_have_names(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, command: Command) -> None:
    monkeypatch.setenv("REALCAM_LENS_PATH", "")
    folder = tmp_path / "lenses"
    folder.mkdir()
    (folder / "mine.zmx").write_text(zemax([OBJECT, *SINGLET]))
    (folder / "notes.txt").write_text("no lens")
    listed = command("lens", "list", "--lens-path", folder).stdout
    assert "mine " in listed and "notes" not in listed
    assert "25.3" in command("lens", "info", "mine", "--lens-path", folder).stdout
    monkeypatch.setenv("REALCAM_LENS_PATH", f"{tmp_path}/none:{folder}")
    with pytest.warns(UserWarning):
        assert rc.Lens.load("mine").name == "mine"
    with pytest.raises(rc.LensFileError, match="did you mean"):
        rc.Lens.load("minne")
