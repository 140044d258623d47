"""CODE V files with tilts, forms and apertures, read as CODE V means them.

CODE V's alpha and beta count clockwise, so they have the other sign here; gamma has the same.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import realcam as rc

pytestmark = pytest.mark.filterwarnings("ignore")

HEAD = "RDM;LEN\nTITLE 'X'\nEPD 6\nDIM M\nWL 587.6\nYAN 0 2\nSO 0 1e13\n"
STOP = "S 0 5\nSTO"
BACK = "S -40 60\nCIR 12"


def code_v(tmp_path: Path, *surfaces: str, image: str = "SI 0 0", head: str = HEAD) -> rc.Lens:
    path = tmp_path / "lens.seq"
    path.write_text("\n".join([head + surfaces[0], *surfaces[1:], image, "GO", ""]))
    return rc.Lens.load(path)


def one_form(tmp_path: Path, *lines: str) -> rc.Surface:
    return code_v(tmp_path, STOP, "\n".join(["S 50 4 600.400", "CIR 12", *lines]), BACK).surfaces[1]


def passed(
    lens: rc.Lens, angle_deg: tuple[float, float], half_width: float, film_z: float, centre_y: float = 0.0
) -> np.ndarray:
    """Points at which a bundle of parallel rays intersects a plane perpendicular to the lens frame's z axis."""
    ray_direction = np.array([*np.tan(np.deg2rad(angle_deg)), 1.0])
    ray_direction /= np.linalg.norm(ray_direction)
    grid = np.stack(np.meshgrid(*[np.linspace(-half_width, half_width, 25)] * 2), -1).reshape(-1, 2)
    origins = np.column_stack([grid[:, 0], grid[:, 1] + centre_y, np.zeros(len(grid))]) - 100 * ray_direction
    traced = lens.trace(origins, np.tile(ray_direction, (len(origins), 1)), start="scene")
    ok = traced.status == rc.RayStatus.OK
    at, direction = traced.origins_mm[ok], traced.directions[ok]
    return at + direction * ((film_z - at[:, 2]) / direction[:, 2])[:, None]


# A compact anastigmat of three mirrors, F/4 and 4 by 4 degrees, of CODE V's sample lenses. Its mirrors and its film are
# all tilted and decentred, so that it makes an image only if decentres and tilts have the signs that it was made with.
THREE_MIRRORS = (
    "S 0 300",
    "S -1058.98937 -276.006853 REFL\nCON\nK -1.314566\nDAR\nYDE 48.695345; ADE 8.438645\n"
    "REX 75.734236; REY 78.538674; ADY 99.602384",
    "S 0 -0.981318\nSTO\nDAR\nYDE 11.444717; ADE 10.2199",
    "S -324.065 319.16056 REFL\nCON\nK 0.889123\nDAR\nYDE 17.561821; ADE 9.66158\n"
    "REX 24.789115; REY 24.791683; ADY -6.213535",
    "S -453.96516 -321.621031 REFL\nASP\nK 0.226106; A 0.36895E-10\nDAR\nYDE 67.500535; ADE 9.514418\n"
    "REX 66.581268; REY 65.453521; ADY -112.35423",
)
THREE_MIRRORS_HEAD = "RDM Y\nLEN\nTIT 'F/4'\nDIM MM\nEPD 100\nWL 500\nXAN 0 0\nYAN 0 2\nPOL N\nSO 0 1e11\n"


def test_three_tilted_mirrors_make_the_image_that_they_were_made_for(tmp_path):
    image = "SI 0 15.407921\nYDE -47.681342; ADE 8.716957"
    lens = code_v(tmp_path, *THREE_MIRRORS, image=image, head=THREE_MIRRORS_HEAD)
    film_z = 300 - 276.006853 - 0.981318 + 319.16056 - 321.621031 + 15.407921 - 300
    points = passed(lens, (0, 0), 60, film_z, 100)
    assert len(points) > 100
    # The image surface has its vertex where the axial image is.
    np.testing.assert_allclose(points.mean(axis=0)[:2], [0, -47.681342], atol=2e-3)
    assert np.sqrt(((points - points.mean(axis=0)) ** 2).sum(axis=1).mean()) < 2e-3  # mm; Airy's disc has 2.4e-3
    turned = [row.replace("ADE ", "ADE -") for row in THREE_MIRRORS]
    other = passed(code_v(tmp_path, *turned, image=image, head=THREE_MIRRORS_HEAD), (0, 0), 60, film_z, 100)
    assert len(other) == 0 or np.ptp(other[:, 1]) > 1


def test_a_tilt_without_a_word_moves_all_that_follows(tmp_path):
    lens = code_v(tmp_path, STOP, "S 50 4 600.400\nXDE 0.5; YDE -0.3; ADE 4; BDE -3; CDE 20", BACK)
    moved = lens.surfaces[1]
    assert moved.decentre_mm == pytest.approx((0.5, -0.3, 0))
    assert moved.tilt_deg == pytest.approx((-4, 3, 20))
    assert not moved.returns and lens.surfaces[2].tilt_deg == (0, 0, 0)


def test_decenter_and_return_moves_one_surface(tmp_path):
    lens = code_v(tmp_path, STOP, "S 50 4 600.400\nDAR\nYDE -0.3; ZDE 0.1; ADE 4", BACK)
    assert lens.surfaces[1].returns and lens.surfaces[1].decentre_mm == pytest.approx((0, -0.3, 0.1))
    assert lens.surfaces[2].decentre_mm == (0, 0, 0)


def test_a_reverse_decentre_undoes_an_ordinary_one(tmp_path):
    plain = code_v(tmp_path, STOP, "S 50 4 600.400", BACK)
    place = "YDE 2; ADE 45; CDE 10"
    undone = code_v(tmp_path, STOP, f"S 0 0\n{place}", f"S 0 0\nREV\n{place}", "S 50 4 600.400", BACK)
    assert undone.is_rotational and undone.surfaces == plain.surfaces
    # REV may also name a surface by its number.
    again = code_v(tmp_path, STOP, f"S 0 0\n{place}", f"S 0 0\n{place}\nREV S3", "S 50 4 600.400", BACK)
    assert again.surfaces == plain.surfaces


def test_a_bend_turns_the_axis_as_a_mirror_turns_light(tmp_path):
    lens = code_v(tmp_path, STOP, "S 0 -30 REFL\nBEN\nADE 40", "S 0 -20 600.400", "S 0 -50", image="SI 0 0")
    ray_direction = np.array([[0.0, 0, 1]])
    traced = lens.trace(np.array([[0.0, 0, -5]]), ray_direction, start="scene")
    # CODE V's alpha counts clockwise: the mirror's upper half leans towards the light, and turns it downwards.
    np.testing.assert_allclose(traced.directions[0], [0, -np.sin(np.deg2rad(80)), -np.cos(np.deg2rad(80))], atol=1e-12)
    np.testing.assert_allclose(lens.surfaces[1].tilt_deg, (-40, 0, 0))


def test_toroids_and_cylinders(tmp_path):
    y = one_form(tmp_path, "YTO\nRDX 30\nK -0.5\nA 1e-5")
    assert (y.form, y.radius_of_curvature_x_mm, y.conic) == ("toroid", pytest.approx(30), -0.5)
    assert y.aspheric_coefficients == {4: 1e-5}
    x = one_form(tmp_path, "XTO\nRDX 30\nK -0.5\nA 1e-5\nREX 3; REY 5; ADY 1")
    # The section with the conic lies in the xz plane: the surface is turned about its axis, its aperture with it.
    assert (x.form, x.tilt_deg, x.returns) == ("toroid", (0, 0, 90), True)
    assert x.radius_of_curvature_mm == pytest.approx(30) and x.radius_of_curvature_x_mm == pytest.approx(50)
    assert x.aperture == {"rectangle_mm": (5, 3), "offset_mm": (1, 0)}
    flat_x = one_form(tmp_path, "CYL")
    assert flat_x.form == "toroid" and flat_x.sag_at_mm(3, 0) == 0 and flat_x.sag_at_mm(0, 3) > 0
    lens = code_v(tmp_path, STOP, "S 0 4 600.400\nCYL\nRDX 25\nCIR 12", BACK)
    along_x, along_y = (
        lens.trace(np.array([[*at, -5.0]]), np.array([[0.0, 0, 1]]), start="scene") for at in ((3, 0), (0, 3))
    )
    # Behind a cylinder with power in x alone, the ray in y has met one curved face only.
    assert abs(along_x.directions[0, 0]) > abs(along_y.directions[0, 1]) + 0.05


def test_an_anamorphic_asphere_has_the_sag_of_its_formula(tmp_path):
    s = one_form(
        tmp_path, "AAS\nRDX 80\nK -0.4\nKX 0.3\nAR 1e-5; BR -2e-8; CR 1e-11; DR 1e-14\nAP 0.1; BP -0.2; CP 0; DP 0.5"
    )
    for x, y in ((3, 0), (0, 4), (5, -2), (-6, 7)):
        cx, cy = 1 / 80, 1 / 50
        root = np.sqrt(1 - 1.3 * cx**2 * x**2 - 0.6 * cy**2 * y**2)
        sag = (cx * x**2 + cy * y**2) / (1 + root)
        for n, (r, p) in enumerate(((1e-5, 0.1), (-2e-8, -0.2), (1e-11, 0), (1e-14, 0.5)), 2):
            sag += r * ((1 - p) * x**2 + (1 + p) * y**2) ** n
        assert s.sag_at_mm(x, y) == pytest.approx(sag, rel=1e-13)


def test_special_surfaces(tmp_path):
    odd = one_form(tmp_path, "SPS ODD 0.0\nSCO K -1.2\nSCO AR3 2e-4\nSCO C6 -1e-6\nSCC AR3 100")
    assert odd.conic == -1.2 and odd.radial_terms == pytest.approx({3: 2e-4, 5: -1e-6})
    # Coefficients of x and y over 20 mm: C3 is y, C4 x^2, C8 x^2 y.
    xy = one_form(tmp_path, "SPS XYP 20\nSCO NRADIUS 20\nSCO K -0.5\nSCO C3 0.4; SCO C4 0.8\nSCO C8 -0.16")
    assert xy.conic == -0.5
    assert xy.xy_terms == pytest.approx({(0, 1): 0.02, (2, 0): 0.002, (2, 1): -2e-5})
    with pytest.raises(rc.LensFileError, match=r"surface 2.*special surface \(SPS ZRN\)"):
        one_form(tmp_path, "SPS ZRN\nSCO C5 1")


def test_apertures(tmp_path):
    assert one_form(tmp_path, "REX 5; REY 3; ADX 1; ADY -1").aperture == {"rectangle_mm": (5, 3), "offset_mm": (1, -1)}
    ellipse = one_form(tmp_path, "ELX L'A' 5; ELY L'A' 3\nCIR OBS L'B' 1")
    assert ellipse.aperture == {"ellipse_mm": (5, 3)} and ellipse.inner_semi_diameter_mm == 1
    turned = one_form(tmp_path, "REX 5; REY 3; ARO 30")
    c, s = np.cos(np.pi / 6), np.sin(np.pi / 6)
    assert turned.aperture["polygon_mm"][0] == pytest.approx((5 * c - 3 * s, 5 * s + 3 * c))
    bar = one_form(tmp_path, "REX OBS 0.5; REY OBS 9; ADX 2; ARO 45").obscurations[0]
    assert bar["rectangle_mm"] == (0.5, 9) and bar["offset_mm"] == (2, 0) and bar["angle_deg"] == 45
    # The circle of 12 mm and the rectangle: what both leave open.
    assert one_form(tmp_path, "REX 30; REY 30").clear_semi_diameter_mm == 12
    with pytest.raises(rc.LensFileError, match=r"surface 2.*a rotated elliptical aperture"):
        one_form(tmp_path, "ELX 5; ELY 3; ARO 30")
    with pytest.raises(rc.LensFileError, match=r"surface 2.*several apertures"):
        one_form(tmp_path, "ELX 5; ELY 3; REX 4; REY 4")
    with pytest.raises(rc.LensFileError, match=r"surface 2.*ADX has no preceding aperture"):
        code_v(tmp_path, STOP, "S 50 4 600.400\nADX 1", BACK)


def test_the_image_surface_is_curved_and_tilted(tmp_path):
    lens = code_v(tmp_path, STOP, "S 50 4 600.400\nCIR 12", BACK, image="SI -55 0\nADE 3; YDE 0.2")
    assert lens.film_radius_of_curvature_mm == pytest.approx(-55)
    assert not lens.is_rotational


def test_a_paraboloid_has_its_focus_in_front_of_it(tmp_path):
    """One mirror: light goes back, and the film stands where it came from."""
    lens = code_v(tmp_path, "S -200 -100 REFL\nCON\nK -1", head=HEAD.replace("EPD 6", "EPD 60"))
    points = passed(lens, (0, 0), 29, -100)
    assert len(points) > 300
    assert np.abs(points[:, :2]).max() < 1e-12


def test_without_sto_the_first_surface_is_the_stop(tmp_path):
    path = tmp_path / "lens.seq"
    path.write_text(HEAD + "S 50 4 600.400\nS -50 40\nSI 0 0\nGO\n")
    with pytest.warns(UserWarning, match="specifies no aperture stop"):
        assert rc.Lens.load(path).stop_index == 0


def test_glass_that_is_set_to_air_again_is_air(tmp_path: Path) -> None:
    lens = code_v(tmp_path, STOP, "S 50 4 600.400\nCIR 12", "S -40 3 700.300\nCIR 12\nGLA AIR", "S 0 60\nCIR 12")
    assert lens.surfaces[2].material.index(587.6) == pytest.approx(1, abs=1e-9)
