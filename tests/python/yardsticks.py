"""Independent optics for the tests: paraxial matrices."""

from __future__ import annotations

import numpy as np
import realcam as rc


def system_matrix(lens: rc.Lens, first: int = 0, last: int | None = None) -> np.ndarray:
    """Takes (height, slope) from the front of surface `first` to the back of the one before `last`.

    Refraction n' u' = n u - y c (n' - n); behind a mirror both the index and the direction of travel change
    sign, and thicknesses are negative, so that slopes stay dy/dz.
    """
    matrix, index, sense = np.eye(2), 1.0, 1.0
    for i, s in enumerate(lens.surfaces[:last]):
        before = sense * index
        if s.type == "mirror":
            sense = -sense
        elif s.type == "refracting":
            index = s.material.index(lens.wavelength_nm)
        after = sense * index
        if i < first:
            continue
        power = s.curvature_per_mm * (after - before)
        matrix = np.array([[1, 0], [-power / after, before / after]]) @ matrix
        if i + 1 < len(lens.surfaces):
            matrix = np.array([[1, s.thickness_mm], [0, 1]]) @ matrix
    return matrix


class Paraxial:
    """First-order data of a lens in its present state; positions from the front vertex, mm."""

    def __init__(self, lens: rc.Lens) -> None:
        self.film = lens.film_position_mm
        self.last_vertex = self.film - lens.film_distance_mm
        self.whole = system_matrix(lens)
        front = system_matrix(lens, last=lens.stop_index)
        rear = system_matrix(lens, first=lens.stop_index + 1)
        self.focal_length = -1 / self.whole[1, 0]
        self.entrance_pupil = front[0, 1] / front[0, 0]
        self.entrance_pupil_diameter = 2 * lens.stop_semi_diameter_mm / abs(front[0, 0])
        # A ray through the middle of the stop, and one beside it along the axis, behind the lens.
        gap = lens.surfaces[lens.stop_index].thickness_mm if lens.stop_index + 1 < len(lens.surfaces) else 0.0
        through = rear @ (gap, 1.0)
        self.exit_pupil = self.last_vertex - through[0] / through[1]
        beside = rear @ (lens.stop_semi_diameter_mm, 0.0)
        self.exit_pupil_diameter = 2 * abs(beside[0] + (self.exit_pupil - self.last_vertex) * beside[1])

    def image(self, film_to_object_mm: float) -> float:
        """Position of the image of an axial object at this distance from the film."""
        height, slope = self.whole @ (film_to_object_mm - self.film, 1.0)
        return self.last_vertex - height / slope

    def image_scale(self, film_to_object_mm: float) -> float:
        """Size on the film over size of an object, by rays through the middle of the entrance pupil."""
        height, slope = self.whole @ (-self.entrance_pupil, 1.0)
        on_film = height + slope * (self.film - self.last_vertex)
        return abs(on_film) / (film_to_object_mm - self.film + self.entrance_pupil)

    def blur_diameter(self, film_to_object_mm: float) -> float:
        """Circle of confusion on the film: the cone from the exit pupil to the image, cut by the film."""
        image = self.image(film_to_object_mm)
        return self.exit_pupil_diameter * abs((self.film - image) / (image - self.exit_pupil))
