"""What is known of each copy of a lens."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Doubles = NDArray[np.float64]


@dataclass(frozen=True)
class CopyFigures:
    """Arrays over C copies, F fields and K frequencies, with each copy's compensators set. nan: no light passes.

    mtf: (C, F, 2, K), of lines across the direction from the axis outwards (tangential), then along it. It is that of
    rays alone times what diffraction leaves of a perfect lens with such a pupil.
    rms_spot_mm: (C, F), radius about the middle of all colours. distortion: (C, F), of the distance from the axis,
    against the scale of the picture near the axis. light: (C, F), share of the stop from which light comes.
    chief_ray_mm: (C, F, 2), on the film. focal_length_mm: (C,), of close rays, mean of both meridians.
    film_shift_mm: (C,), away from the lens. film_slope: (C, 2), of the film along x and y. element_shift_mm: (C, 3).
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
        return CopyFigures(**{name: np.concatenate([part[name] for part in parts]) for name in parts[0]})

    def mean_mtf(self, frequency: int) -> Doubles:
        """(C,): of all fields and both directions. frequency: its number; a field without light has no contrast."""
        mean: Doubles = np.nan_to_num(self.mtf[..., frequency]).mean((1, 2))
        return mean

    def lowest_mtf(self, frequency: int) -> Doubles:
        """(C,): of the worst field, the mean of both directions."""
        lowest: Doubles = np.nan_to_num(self.mtf[..., frequency]).mean(2).min(1)
        return lowest
