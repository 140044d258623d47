"""Blur in rendered pictures against the circle of confusion, and depth of field against its closed form."""

from __future__ import annotations

import math

import numpy as np
import pytest
import realcam as rc

from .. import scenes, yardsticks

FOCAL_LENGTH, INDEX = 100.0, 1.5

# A mark whose sharp image is 0.05 mm wide in a picture of 0.8 mm and 2.6 million samples gets 10000 of them.
# The squared radius of an evenly lit disc has a standard deviation of 0.58 of its mean, so that a diameter
# measured from it is good to 0.29 / sqrt(10000) = 0.3%; stratified over the pixels, the samples do better.
MARK_MM, PICTURE_MM, PITCH_MM, SPP = 0.05, 0.8, 0.01, 400


def thin_singlet(f_number: float) -> rc.Lens:
    """A biconvex lens without thickness, its stop on it: focal length 100 mm by the lensmaker's equation."""
    radius, opening = 2 * (INDEX - 1) * FOCAL_LENGTH, FOCAL_LENGTH / (2 * f_number)
    front = rc.Surface(radius_of_curvature_mm=radius, material=INDEX, clear_semi_diameter_mm=1.1 * opening)
    back = rc.Surface(radius_of_curvature_mm=-radius, clear_semi_diameter_mm=1.1 * opening)
    surfaces = [rc.Stop(clear_semi_diameter_mm=opening), front, back]
    return rc.Lens(surfaces=surfaces, name="thin singlet", allow_overlap=True)


def picture(lens: rc.Lens, *marks: scenes.Quad, model: str, size_mm: float = PICTURE_MM, spp: int = SPP) -> np.ndarray:
    """Exposure of bright marks on black: (rows, columns). The camera at the origin looks along -z."""
    count = round(size_mm / PITCH_MM)
    film = rc.Film(size_mm, size_mm, (count, count))
    camera = rc.Camera(lens, film=film, exposure_time_s=1, model=model)
    return rc.render(scenes.scene_of(*marks), camera, effects=(), spp=spp).pixels[..., 0].astype(np.float64)


def moments(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Centroid (right, up) from the middle of the film, and variance along both; mm and mm^2."""
    rows, columns = values.shape
    x = (np.arange(columns) + 0.5 - columns / 2) * PITCH_MM
    y = -(np.arange(rows) + 0.5 - rows / 2) * PITCH_MM
    weights = values / values.sum()
    mean = np.array([weights.sum(axis=0) @ x, weights.sum(axis=1) @ y])
    square = np.array([weights.sum(axis=0) @ x**2, weights.sum(axis=1) @ y**2])
    return mean, square - mean**2


def blur_diameter(values: np.ndarray, mark_mm: float = MARK_MM) -> float:
    """Diameter of an evenly lit disc from its variance, diameter^2 / 16 along each axis.

    The image is that disc, spread by the mark's own sharp image (a square of side `mark_mm`: side^2 / 12),
    and by the pixels (Sheppard's correction, pitch^2 / 12).
    """
    _, variance = moments(values)
    return 4 * math.sqrt(max(0.0, float(variance.mean()) - mark_mm**2 / 12 - PITCH_MM**2 / 12))


def mark_at(film_to_mark_mm: float, scale: float, film_mm: tuple[float, float] = (0.0, 0.0)) -> scenes.Quad:
    """A square whose sharp image, `scale` times its size, is MARK_MM wide, at film_mm (right, up)."""
    x, y = (1e-3 * value / scale for value in film_mm)
    return scenes.quad((x, y, -film_to_mark_mm / 1000), 0.5e-3 * MARK_MM / scale, emission=1e4)


# A thin lens of 100 mm at magnification 1 / 10.
FOCUS_MM, IMAGE_MM = 1100.0, 110.0  # from the lens


@pytest.mark.parametrize("distance_mm", [700.0, 3000.0])
@pytest.mark.parametrize("model", ["thin", "thick", "full"])
def test_circle_of_confusion_of_a_thin_lens(model: str, distance_mm: float) -> None:
    f_number = 16.0
    lens = thin_singlet(f_number).focused((FOCUS_MM + IMAGE_MM) / 1000)
    expected = FOCAL_LENGTH**2 / f_number * abs(distance_mm - FOCUS_MM) / (distance_mm * (FOCUS_MM - FOCAL_LENGTH))
    if model == "thick":
        # Focusing goes by real rays, 0.12 mm in front of the paraxial plane; this model is paraxial on that
        # film.
        expected = yardsticks.Paraxial(lens).blur_diameter(distance_mm + IMAGE_MM)
    mark = mark_at(distance_mm + IMAGE_MM, IMAGE_MM / distance_mm)
    # Four standard deviations.
    assert blur_diameter(picture(lens, mark, model=model)) == pytest.approx(expected, rel=0.01)


@pytest.mark.parametrize("distance_m", [0.8, 5.0])
@pytest.mark.parametrize("name", ["double-gauss-50mm", "tessar-50mm", "double-gauss-100mm", "zoom-70-210mm"])
def test_circle_of_confusion_of_a_full_lens(name: str, distance_m: float) -> None:
    lens = rc.Lens.load(name).focused(2.0).stopped_down(16)
    paraxial = yardsticks.Paraxial(lens)
    values = picture(lens, mark_at(1000 * distance_m, paraxial.image_scale(1000 * distance_m)), model="full")
    # The film stands where the open lens is sharpest, and the paraxial blur counts that in. The spherical
    # aberration left at f/16 makes the blur 1 to 3 um larger behind the focus, and smaller in front of it.
    expected = paraxial.blur_diameter(1000 * distance_m)
    assert abs(blur_diameter(values) - expected) < 0.003 + 0.01 * expected


@pytest.mark.parametrize("model", ["thin", "full"])
def test_depth_of_field_in_a_picture(model: str) -> None:
    """The depth over which the blur stays below c: 2 N c (m + 1) / m^2 (source paper, equation 8)."""
    f_number, c = 16.0, 0.05
    m = IMAGE_MM / FOCUS_MM
    lens = thin_singlet(f_number).focused((FOCUS_MM + IMAGE_MM) / 1000)
    # One picture of marks at eight depths, four on each side of the focus, side by side on the film.
    depths = np.array([960.0, 985.0, 1010.0, 1035.0, 1165.0, 1200.0, 1235.0, 1270.0])
    places = [(0.3 * (i % 4 - 1.5), 0.4 * (i // 4 - 0.5)) for i in range(8)]
    marks = [mark_at(d + IMAGE_MM, IMAGE_MM / d, place) for d, place in zip(depths, places, strict=True)]
    values = picture(lens, *marks, model=model, size_mm=1.2, spp=800)
    blurs = []
    for x, y in places:
        column, row = round((x + 0.6) / PITCH_MM), round((0.6 - y) / PITCH_MM)
        blurs.append(blur_diameter(values[row - 14 : row + 14, column - 14 : column + 14]))
    # Dioptres are linear in the blur.
    near, far = (np.polyval(np.polyfit(blurs[side], 1 / depths[side], 1), c) for side in (slice(4), slice(4, 8)))
    measured = 1 / far - 1 / near
    # The equation leaves out (N c / (f m))^2 = 0.6%. Each end lies near four blurs, whose 0.3% are about
    # doubled by taking the mark's own size from them: 0.3% of the depth for each end, and 1.5% in all at
    # four deviations.
    assert measured == pytest.approx(2 * f_number * c * (m + 1) / m**2, rel=0.02)


@pytest.mark.parametrize("distance_mm", [400.0, 20000.0])
def test_a_pinhole_is_sharp_everywhere(distance_mm: float) -> None:
    lens = thin_singlet(4.0).focused((FOCUS_MM + IMAGE_MM) / 1000)
    values = picture(lens, mark_at(distance_mm + IMAGE_MM, IMAGE_MM / distance_mm), model="pinhole")
    # The square covers four pixels, and half of the next ones on each side; nothing else gets light.
    profile = np.zeros(80)
    profile[37:43] = 0.5, 1, 1, 1, 1, 0.5
    expected = np.outer(profile, profile)
    assert (values[expected == 0] == 0).all()
    # Inner pixels get light from all their 400 samples. Across an edge lie 20 x 20 strata, so that half a
    # pixel is good to one in 20 or better; the real film, at 109.88 mm, makes the image 0.1% smaller, 0.5% of
    # half a pixel.
    np.testing.assert_allclose(values / values[38:42, 38:42].mean(), expected, atol=0.05)


@pytest.mark.parametrize(
    ("name", "focus_mm"), [("double-gauss-50mm", 3000), ("telephoto-250mm", 5000), ("wide-22mm", 800)]
)
def test_the_plane_in_focus_is_the_sharpest(name: str, focus_mm: float) -> None:
    """Wide open, where the paraxial plane and the sharpest one differ."""
    lens = rc.Lens.load(name).focused(focus_mm / 1000)
    paraxial = yardsticks.Paraxial(lens)
    near, focus, far = (
        blur_diameter(picture(lens, mark_at(d, paraxial.image_scale(d)), model="full"))
        for d in (0.9 * focus_mm, focus_mm, 1.1 * focus_mm)
    )
    # Least RMS spot, as the lens promises: the blur from a moment is just that. Defocus adds in quadrature to
    # the spot, so that 10% of the distance on either side must show the same increase, to first order.
    assert near > 1.1 * focus
    assert far > 1.1 * focus
    rises = near**2 - focus**2, (far**2 - focus**2) * (1.1 / 0.9) ** 2
    # To 20% for terms of the third order in the distance and the samples' noise.
    assert rises[0] == pytest.approx(rises[1], rel=0.2)


def test_three_blades_make_a_triangle_of_the_same_area() -> None:
    surfaces = thin_singlet(4.0).surfaces

    def blurred(blades: int) -> np.ndarray:
        lens = rc.Lens(surfaces=surfaces, iris_blades=blades, allow_overlap=True)
        lens = lens.focused((FOCUS_MM + IMAGE_MM) / 1000).stopped_down(16)
        return picture(lens, mark_at(700 + IMAGE_MM, IMAGE_MM / 700, (0, 0)), model="full", spp=4 * SPP)

    round_blur, triangle = blurred(0), blurred(3)
    # f-numbers mean the same light. Of the samples over the circle that holds the triangle, 41% pass.
    assert triangle.sum() == pytest.approx(round_blur.sum(), rel=0.03)
    # Second moments of area A: a triangle's A / (6 sqrt 3), a disc's A / (4 pi).
    mark = MARK_MM**2 / 12 + PITCH_MM**2 / 12
    ratio = (moments(triangle)[1] - mark) / (moments(round_blur)[1] - mark)
    np.testing.assert_allclose(ratio, 4 * math.pi / (6 * math.sqrt(3)), rtol=0.04)
