"""Sampling of ray directions from film points: realcam's exit-pupil table, in Dr.Jit."""

from __future__ import annotations

from typing import Any

import drjit as dr
import mitsuba as mi

from .._core import Lens, _pupil_table
from ..dispersion import media_indices
from .tables import Table
from .trace import opaque


class Pupil:
    """Exit-pupil regions in optical direction cosines (l, m), the measure in which the exposure integral has no
    factors: n^2 cos(theta) dw = dl dm.

    For each ring of the film, a fan of triangles from the centre of a box holds all light that passes. A triangle is
    chosen uniformly, so that a sample's weight is the number of triangles times the area of the chosen one.
    film_radius_mm: half diagonal of the film. wavelengths_nm: the regions contain the rays of all of them.
    """

    def __init__(self, lens: Lens, film_radius_mm: float, wavelengths_nm: list[float]) -> None:
        nodes, outline, image_radius_mm = _pupil_table(lens, film_radius_mm, wavelengths_nm)
        self.rows, self.sectors, _ = outline.shape
        self.nodes, self.outline = Table(nodes), Table(outline)
        self.image_radius_mm = opaque(image_radius_mm)
        self.index_squared = media_indices(lens, lens.wavelength_nm)[-1] ** 2

    def sample(self, x: Any, y: Any, u: Any) -> tuple[Any, Any]:
        """Samples an optical direction towards the scene for a film point (mm). Returns it and its weight, the area of
        direction cosines over the probability; 0 if no light arrives."""
        radius = dr.sqrt(x * x + y * y)
        is_off_axis = radius > 0
        cos = dr.select(is_off_axis, x / radius, 1.0)
        sin = dr.select(is_off_axis, y / radius, 0.0)
        position = self.rows * (1 - dr.sqrt(dr.maximum(1 - radius / self.image_radius_mm, 0)))
        row = mi.UInt32(dr.minimum(position, self.rows - 1))
        fraction = position - row
        near, far = self.nodes(row), self.nodes(row + 1)
        centre, half_width, half_height = (dr.lerp(a, b, fraction) for a, b in zip(near, far, strict=True))

        scaled = u.x * (2 * self.sectors)
        triangle = dr.minimum(mi.UInt32(scaled), 2 * self.sectors - 1)
        along = scaled - triangle
        is_lower = triangle >= self.sectors
        sector = dr.select(is_lower, triangle - self.sectors, triangle)
        sx, sy, dx, dy, hole_squared = self.outline(row * self.sectors + sector)
        # Distance from the centre, relative to the outline.
        radial = dr.sqrt(hole_squared + u.y * (1 - hole_squared))
        l_radial = centre + half_width * radial * (sx + along * dx)
        m_radial = half_height * radial * (sy + along * dy)
        m_radial = dr.select(is_lower, -m_radial, m_radial)
        l_film, m_film = l_radial * cos - m_radial * sin, l_radial * sin + m_radial * cos
        n_squared = self.index_squared - l_film * l_film - m_film * m_film
        is_lit = (n_squared > 0) & (radius < self.image_radius_mm)
        area = self.sectors * (sx * dy - sy * dx) * (1 - hole_squared) * half_width * half_height
        return mi.Vector3f(l_film, m_film, -dr.sqrt(dr.maximum(n_squared, 0.0))), dr.select(is_lit, area, 0.0)
