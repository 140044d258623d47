"""Performance figures of the copies of a lens."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Doubles = NDArray[np.float64]


@dataclass(frozen=True)
class CopyFigures:
    """Arrays over C copies, F fields and K frequencies, with the compensators of each copy set. nan: no light passes.

    mtf: (C, F, 2, K), tangential (lines perpendicular to the radial direction), then sagittal: the geometric MTF times
    the diffraction MTF of a perfect lens with the same pupil.
    rms_spot_mm: (C, F), RMS radius about the polychromatic centroid. distortion: (C, F), relative error of the distance
    from the axis against the paraxial scale. light: (C, F), fraction of the stop that passes light.
    chief_ray_mm: (C, F, 2), film points. focal_length_mm: (C,), of parabasal rays, mean of both meridians.
    film_shift_mm: (C,), away from the lens. film_slope: (C, 2), dz/dx and dz/dy of the film. element_shift_mm: (C, 3),
    along x, y and z.
    """

    mtf: Doubles
    rms_spot_mm: Doubles
    distortion: Doubles
    light: Doubles
    chief_ray_mm: Doubles
    focal_length_mm: Doubles
    film_shift_mm: Doubles
    film_slope: Doubles
    element_shift_mm: Doubles

    def __len__(self) -> int:
        return len(self.focal_length_mm)

    @staticmethod
    def joined(parts: list[dict[str, Doubles]]) -> CopyFigures:
        """Concatenates blocks of copies, as the core returns them."""
        return CopyFigures(**{name: np.concatenate([part[name] for part in parts]) for name in parts[0]})

    def mean_mtf(self, frequency: int) -> Doubles:
        """(C,): mean MTF of all fields and both directions. frequency: index; a field without light counts as 0."""
        mean: Doubles = np.nan_to_num(self.mtf[..., frequency]).mean((1, 2))
        return mean

    def lowest_mtf(self, frequency: int) -> Doubles:
        """(C,): MTF of the worst field, as the mean of both directions."""
        lowest: Doubles = np.nan_to_num(self.mtf[..., frequency]).mean(2).min(1)
        return lowest
