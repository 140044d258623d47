"""Figures 2 and 3: the table of a double Gauss, and its sketch with the spheres told by colour."""

from __future__ import annotations

import math

from realcam import Lens
from realcam.drawing import draw_states

from .experiment import Experiment, Row, drawn


def experiment(device: str) -> Experiment:
    lens = Lens.load("double-gauss-50mm")
    data = lens.first_order()
    rows = []
    for number, surface in enumerate(lens.surfaces, 1):
        radius = "plane" if math.isinf(surface.radius_of_curvature_mm) else f"{surface.radius_of_curvature_mm:g} mm"
        # The film follows the last surface, whose own thickness is 0.
        thickness = surface.thickness_mm if number < len(lens.surfaces) else lens.film_distance_mm
        words = [radius, f"{thickness:g} mm", surface.material.label or "air"]
        if surface.type == "stop":
            words = ["aperture stop", f"{thickness:g} mm"]
        words.append(f"clear {2 * surface.clear_semi_diameter_mm:g} mm")
        rows.append(Row(f"surface {number}", "", ", ".join(words)))
    rows.append(
        Row("focal length, f-number", "50 mm, f/2", f"{data.effective_focal_length_mm:.3f} mm, f/{data.f_number:.3f}")
    )
    sketch = draw_states([(lens.title or lens.name, lens)], radius_colours=True, insets=False, width_px=900)
    return Experiment(
        "Figures 2 and 3: the lens table and its sketch",
        (
            "A lens is its maker's table: radii, thicknesses, glasses and clear diameters of each surface. In the "
            "sketch a face is blue where its radius of curvature is positive (its centre lies on the film's side) "
            "and red where it is negative, as in the paper. The rays come from the object, so that they show how "
            "well the lens brings them together.",
        ),
        (drawn("Double Gauss 50 mm f/2 (US 2,673,491)", sketch),),
        tuple(rows),
    )
