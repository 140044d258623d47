"""Writes a lens as an OSL camera shader that traces its surfaces sequentially."""

from __future__ import annotations

import math
import re

import numpy as np

from .._core import Lens, _film_of_white
from ..dispersion import POLE_NM
from .aspheres import aspheres, is_asphere
from .expressible import check_expressible
from .figures import array_text, float_text, horner
from .focus_range import FocusRange, focus_range, gaps_of
from .functions import HOLE, MIRROR, PLANE, PUPIL, SPHERE, STOP
from .glasses import colour_variable, squared_indices
from .pupil_table import STOPS, PupilTable, pupil_table

_CELLS = 64
"""Number of strata of the spectrum."""
_PUPIL_WAVELENGTHS_NM = (420.0, 680.0)
"""Wavelengths whose rays the pupil table contains, in addition to those of the design wavelength."""


def shader_text(lens: Lens) -> str:
    """Returns the lens as an OSL shader for custom cameras of Blender 5.

    Focus, f-number and blades are parameters, whose defaults are the lens's current settings. Raises InputError, which
    names the surface, if OSL cannot express the lens.
    """
    check_expressible(lens)
    focusing = focus_range(lens)
    spectrum = _film_of_white("D65")
    edges_nm = np.append(spectrum[:, 0], spectrum[-1, 1])
    squares = squared_indices(lens, list(np.linspace(edges_nm[1], edges_nm[-2], 40)))
    disperses = any(len(square) > 1 for square in squares)
    pupil_nm = (lens.wavelength_nm, *_PUPIL_WAVELENGTHS_NM) if disperses else (lens.wavelength_nm,)
    table = pupil_table(focusing, {nm: colour_variable(lens).at(nm) for nm in pupil_nm})
    shapes = aspheres(focusing, table, pupil_nm)
    numbers = {  # values for the templates below
        "reach": float_text(table.reach_mm),
        "wide": float_text(lens.wide_open().f_number),
        "full": _full_stop_radius(lens),
        "length": float_text(_constant_length_mm(lens, focusing)),
        "moves": "".join(f" + gap_{i + 1}" for i in focusing.gaps_mm),
        "focal_length": float_text(abs(lens.first_order().effective_focal_length_mm)),
    }
    parts = [
        _heading(lens),
        SPHERE,
        HOLE if any(s.inner_semi_diameter_mm for s in lens.surfaces) else "",
        MIRROR if any(s.type == "mirror" for s in lens.surfaces) else "",
        PLANE,
        STOP,
        *(shape.function(i + 1, lens.surfaces[i].type == "mirror") for i, shape in shapes.items()),
        PUPIL.format(rows=table.ellipses.shape[2], stops=len(STOPS), last=STOPS[-1], **_pupil_numbers(table)),
        _parameters(lens, focusing, disperses),
        "{",
        _START.format(**numbers),
        _focus(focusing),
        _colour(lens, spectrum, edges_nm) if disperses else "    float colour = 0;\n    color film = 1;\n",
        _SAMPLE.format(**numbers),
        _surfaces(lens, focusing, squares),
        _END.format(**numbers),
        "}",
    ]
    return "\n".join(part for part in parts if part) + "\n"


# Parts of the shader's body. Braces are doubled; {reach}: radius of the image circle, mm; {wide}: f-number wide open;
# {full}: radius of the fully open stop, mm; {length}{moves}: distance from the front vertex to the film, mm.
_START = """\
    // The film point, upside down as the image is, in mm.
    vector size = 0;
    getattribute("cam:sensor_size", size);
    point raster = camera_shader_raster_position();
    point at = point((0.5 - raster[0]) * size[0], (0.5 - raster[1]) * size[1], 0);
    float radius = hypot(at[0], at[1]);
    throughput = 0;
    if (radius >= {reach}) return;

    // Opening of the diaphragm, relative to the fully open stop; its apothem, and the radius to the blades' corners.
    float open = f_number > 0 ? min(1, {wide} / f_number) : 1;
    float stop_radius = open * {full};
    float apothem = stop_radius;
    float corner = stop_radius;
    if (blades >= 3) {{
        apothem = apothem_of(blades, rounding, stop_radius, {full});
        float linear = (1 - rounding) * cos(M_PI / blades);
        corner = min({full}, apothem * (2 - rounding) / (linear + sqrt(linear * linear + rounding * (2 - rounding))));
    }}
    float rotation = radians(rotation_deg);
    vector chance = camera_shader_random_sample();
"""

_SAMPLE = """\
    // A direction, uniformly distributed in the ellipse that contains the pupil of this film point.
    float middle = 0;
    float half_l = 0;
    float half_m = 0;
    float hole = 0;
    find_pupil(radius / {reach}, focus, corner / {full}, colour, middle, half_l, half_m, hole);
    float outwards = sqrt(hole * hole + (1 - hole * hole) * chance[0]);
    float l = middle + half_l * outwards * cos(2 * M_PI * chance[1]);
    float m = half_m * outwards * sin(2 * M_PI * chance[1]);
    float rest = 1 - l * l - m * m;
    if (rest <= 0) return;
    float cosine = radius > 0 ? at[0] / radius : 1;
    float sine = radius > 0 ? at[1] / radius : 0;
    vector way = vector(l * cosine - m * sine, l * sine + m * cosine, -sqrt(rest));
"""

_END = """\
    // Converts from the lens's frame, in mm, to the camera's, whose origin is the centre of the film.
    float depth = {length}{moves};
    position = point(at[0], at[1], depth - at[2]) * (0.001 / metres_per_unit);
    direction = normalize(vector(way[0], way[1], -way[2]));
    // The irradiance is the area of the directions that pass. keep_brightness normalises it to 1 at the film's centre.
    float brightness = M_PI * half_l * half_m * (1 - hole * hole);
    if (keep_brightness) brightness *= 4 * pow({wide} / open, 2) / M_PI;
    throughput = brightness * film;
    // Ray differentials of a lens without distortion: approximate but cheap, for bump maps and wireframes.
    vector across = Dx(raster);
    vector up = Dy(raster);
    dPdx = 0;
    dPdy = 0;
    dDdx = vector(across[0] * size[0] / {focal_length}, 0, 0);
    dDdy = vector(0, up[1] * size[1] / {focal_length}, 0);
"""


def _heading(lens: Lens) -> str:
    """Comment at the top of the shader."""
    lines = [f"// {_comment_text(line)}" for line in (lens.title or lens.name, lens.source) if line]
    lines += ["// A camera for Blender 5 (Cycles), written by realcam from the lens's prescription.", ""]
    return "\n".join(lines)


def _comment_text(text: str) -> str:
    """Text for a one-line comment: without line breaks, and without backslashes, which could continue the line."""
    return "".join(c if c.isprintable() and c != "\\" else " " for c in text)


def _name(lens: Lens) -> str:
    """Name of the shader: an identifier."""
    return "realcam_" + (re.sub(r"\W+", "_", lens.name, flags=re.ASCII).strip("_") or "lens")


def _parameters(lens: Lens, focusing: FocusRange, disperses: bool) -> str:
    """Declaration of the shader with its parameters and outputs."""
    # A lens at infinity is focused by Blender's depth of field.
    focus_m = lens.focus_distance_m if math.isfinite(lens.focus_distance_m) else 0
    full_mm = lens.surfaces[lens.stop_index].clear_semi_diameter_mm
    wide = lens.wide_open().f_number
    f_number = wide * full_mm / lens.stop_semi_diameter_mm if lens.stop_semi_diameter_mm < full_mm else 0
    nearest = f"{focusing.nearest_m:.3g}"
    # Type, name, default, help, and smallest value.
    rows = [
        (
            "float",
            "focus_m",
            focus_m,
            f"Focus distance from the film; 0: Blender's depth-of-field distance; nearest {nearest} m",
            0,
        ),
        ("float", "f_number", f_number, f"f-number; 0: wide open, f/{wide:.3g}", 0),
        ("float", "blades", lens.iris_blades, "Number of diaphragm blades; 0: circular", 0),
        ("float", "rounding", lens.iris_rounding, "Rounding of the blades; 0: straight, 1: circular", 0),
        ("float", "rotation_deg", lens.iris_rotation_deg, "Rotation of the diaphragm", None),
        ("int", "dispersion", int(disperses), "Refractive indices depend on the wavelength", None),
        (
            "int",
            "keep_brightness",
            1,
            "Same brightness at the centre at any f-number; otherwise the illuminance of the film",
            None,
        ),
        ("float", "metres_per_unit", 1, "Metres per unit of the scene", 0),
    ]
    written = []
    for kind, name, value, help_text, least in rows:
        hints = [f'string help = "{help_text}"']
        if kind == "int":
            hints.append('string widget = "checkBox"')
        if least is not None:
            hints.append(f"float min = {least}")
        written.append(f"    {kind} {name} = {float_text(value)} [[ {', '.join(hints)} ]],")
    outputs = [
        "point position",
        "vector direction",
        "color throughput",
        *(f"vector d{p}d{q}" for p in "PD" for q in "xy"),
    ]
    written += [f"    output {output} = 0," for output in outputs]
    return f"shader {_name(lens)}(\n" + "\n".join(written)[:-1] + ")"


def _focus(focusing: FocusRange) -> str:
    """Statements that compute the focus parameter and the variable gaps from the focus distance."""
    lines = [
        "    // Focus parameter: 0 at infinity, 1 at the nearest focus.",
        "    float object = focus_m;",
        "    if (object <= 0) {",
        '        getattribute("cam:focal_distance", object);',
        "        object = object < 0.0001 ? 0 : object * metres_per_unit;",
        "    }",
        "    float focus = 0;",
        f"    if (object > 0) focus = object > {float_text(focusing.nearest_m)} ? "
        f"{float_text(focusing.nearest_m - focusing.start_m)} / (object - {float_text(focusing.start_m)}) : 1;",
    ]
    lines += [
        f"    float gap_{index + 1} = {horner(list(polynomial.coef), 'focus')};"
        for index, polynomial in focusing.gaps_mm.items()
    ]
    return "\n".join(lines) + "\n"


def _colour(lens: Lens, spectrum: np.ndarray, edges_nm: np.ndarray) -> str:
    """Statements that sample a wavelength.

    spectrum: parts of equal probability for white light, with their RGB. edges_nm: their ends.
    """
    parts = len(spectrum) // _CELLS
    colour = colour_variable(lens)
    return f"""\
    // A wavelength: the first digits of a random number select {parts} of the equally probable parts of the spectrum,
    // and a hash selects one of them and the position in it.
    float colour = 0;
    color film = 1;
    if (dispersion) {{
        float edges_nm[{len(edges_nm)}] = {array_text(edges_nm)};
        float whites[{3 * len(spectrum)}] = {array_text(spectrum[:, 2:].ravel())};
        int cell = min((int)(chance[0] * {_CELLS}), {_CELLS - 1});
        float within = {parts} * noise("hash", chance[0] * 4096, chance[1] * 4096);
        int part = {parts} * cell + min((int)within, {parts - 1});
        float wavelength_nm = mix(edges_nm[part], edges_nm[part + 1], within - floor(within));
        colour = {float_text(colour.scale)} / (wavelength_nm - {POLE_NM:g}) - {float_text(colour.offset)};
        film = color(whites[3 * part], whites[3 * part + 1], whites[3 * part + 2]);
        chance[0] = chance[0] * {_CELLS} - cell;
    }}
"""


def _media(squares: list[list[float]]) -> tuple[list[str], list[str]]:
    """Returns declarations of the squared indices that depend on the wavelength, and for each medium the variable or
    number of its squared index. squares: of squared_indices()."""
    names: dict[tuple[float, ...], str] = {}
    declared = ["    // Squares of the indices of glasses."]
    for square in map(tuple, squares):
        if len(square) == 1:
            names[square] = float_text(square[0])
        elif square not in names:
            names[square] = f"glass_{len(declared)}"
            declared.append(f"    float {names[square]} = {horner(square, 'colour')};")
    return declared if len(declared) > 1 else [], [names[tuple(square)] for square in squares]


def _surfaces(lens: Lens, focusing: FocusRange, squares: list[list[float]]) -> str:
    """Statements that trace the ray through the surfaces, by the functions of functions.py."""
    gaps = gaps_of(focusing.lens)
    lines, media = _media(squares)
    lines.append("    // The surfaces, from the film to the scene.")
    z_sign = -1  # of the ray's direction
    for index in reversed(range(len(lens.surfaces))):
        surface = lens.surfaces[index]
        gap = f"gap_{index + 1}" if index in focusing.gaps_mm else float_text(gaps[index])
        curvature, rim = float_text(surface.curvature_per_mm), float_text(surface.clear_semi_diameter_mm)
        before, behind = media[index + 1], media[index]  # along the ray, which runs from the film to the scene
        where = "at"
        if surface.type == "stop":
            call, where = f"pass_stop({gap}, corner, blades, rounding, rotation, apothem, at, way)", "met(at, way)"
        elif surface.type == "aperture":
            call, where = f"pass_plane({gap}, {rim}, at, way)", "met(at, way)"
        elif is_asphere(surface):
            call = f"cross_surface_{index + 1}({gap}, {before}, {behind}, {z_sign}, at, way)"
        elif surface.type == "mirror":
            call = f"cross_mirror({gap}, {curvature}, {rim}, {before}, {z_sign}, at, way)"
        else:
            call = f"cross_sphere({gap}, {curvature}, {rim}, {before}, {behind}, {z_sign}, at, way)"
        if surface.type == "mirror":
            z_sign = -z_sign
        lines.append(f"    if (!{call}) return;")
        if surface.inner_semi_diameter_mm:
            lines.append(f"    if (!misses_hole({float_text(surface.inner_semi_diameter_mm)}, {where})) return;")
    return "\n".join(lines) + "\n"


def _constant_length_mm(lens: Lens, focusing: FocusRange) -> float:
    """Sum of the gaps that do not depend on the focus."""
    return sum(gap for i, gap in enumerate(gaps_of(focusing.lens)) if i not in focusing.gaps_mm)


def _full_stop_radius(lens: Lens) -> str:
    """Radius of the fully open stop, mm."""
    return float_text(lens.surfaces[lens.stop_index].clear_semi_diameter_mm)


def _pupil_numbers(table: PupilTable) -> dict[str, object]:
    """Values for the template PUPIL."""
    blocked, drifts = bool(table.ellipses[..., 4].any()), bool(table.drift.any())
    rows = table.ellipses.shape[2]
    columns = 5 if blocked else 4
    return {
        "columns": columns,
        "count": table.ellipses[..., :columns].size,
        "ellipses": array_text(table.ellipses[..., :columns].ravel()),
        "foci": table.ellipses.shape[0],
        "choice": " : ".join(f"open > {stop:.6g} ? {i}" for i, stop in enumerate(STOPS[1:-1])) + f" : {len(STOPS) - 2}",
        "levels": array_text(STOPS),
        "drifts": f"\n    float drifts[{table.drift.size}] = {array_text(table.drift.ravel())};" if drifts else "",
        "drift": f"\n        middle += weight * colour * drifts[(state + next_state) * {rows} + row + next_row];"
        if drifts
        else "",
        "hole": "\n        hole += weight * mix(ellipses[wide + 4], ellipses[narrow + 4], closing);" if blocked else "",
    }
