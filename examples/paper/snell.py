"""Equation 5: refraction in vector form, as printed in the paper and corrected."""

from __future__ import annotations

import numpy as np
from realcam import Lens, Surface
from realcam.lens import Stop

from .experiment import Experiment, Row


def refracted(incident: np.ndarray, mu: float, printed: bool) -> np.ndarray:
    """R1 = mu R0 + (mu cos t0 - sqrt(1 - mu^2 (1 - cos^2 t0))) N for unit R0 and a normal N = (0, 0, -1) against it.

    printed: with mu under the root where mu^2 belongs.
    """
    cosine = incident[..., 2]
    factor = mu if printed else mu * mu
    along = np.sqrt(1 - factor * (1 - cosine**2)) - mu * cosine
    out = mu * incident
    out[..., 2] += along
    return out


def experiment(device: str) -> Experiment:
    index = 1.5168
    angles = np.radians([10.0, 30.0, 50.0])
    incident = np.column_stack([np.sin(angles), 0 * angles, np.cos(angles)])
    # A plane of this glass, traced by the core.
    lens = Lens(
        surfaces=[
            Stop(clear_semi_diameter_mm=10, thickness_mm=1),
            Surface(material=index, clear_semi_diameter_mm=10),
        ],
        film_distance_mm=5,
    )
    traced = lens.trace(incident * 0 + [0, 0, -1.0], incident, start="scene").directions
    rows = []
    for angle, ray, real in zip(np.degrees(angles), incident, traced, strict=True):
        snell = np.degrees(np.arcsin(np.sin(np.radians(angle)) / index))
        right, wrong = (refracted(ray, 1 / index, printed) for printed in (False, True))
        of_trace = np.degrees(np.arctan2(real[0], real[2]))
        rows.append(
            Row(
                f"{angle:g} degrees onto glass of n = {index}",
                f"{np.degrees(np.arctan2(wrong[0], wrong[2])):.4f} degrees, length {np.linalg.norm(wrong):.4f}",
                f"{of_trace:.4f} degrees traced; {np.degrees(np.arctan2(right[0], right[2])):.4f} with the square, "
                f"length {np.linalg.norm(right):.4f}; arcsin(sin / n) = {snell:.4f}",
            )
        )
    return Experiment(
        "Equation 5: Snell's law as a vector",
        (
            "The law is R1 = mu R0 + (sqrt(1 - mu² (1 - cos²)) - mu cos) N with mu = n0 / n1 and N along the light."
            " The paper prints mu instead of mu² under the root. What is printed gives vectors that are no unit "
            "vectors, and other angles, because the part along the surface is mu sin and the part across it has to "
            "be sqrt(1 - mu² sin²). The error vanishes at normal incidence, where it is easily overlooked.",
        ),
        (),
        tuple(rows),
    )
