"""Results of the measurements at the levels of simulation."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from .errors import Codes


@dataclass(frozen=True)
class Measured:
    """Time and error of a picture. rmse: against the reference, in 8-bit codes; flip: 0 to 1, None if not installed."""

    spp: int
    seconds: float
    rmse: float
    flip: float | None


@dataclass(frozen=True)
class Rung:
    """One level of simulation.

    bias_codes: RMS error without noise; noise_codes: RMS noise of the picture with the most samples.
    lens_share, scene_share, other_share: fractions of the time. difference: (H, W), mean absolute difference of the
    channels between the best picture and the reference, codes. group, is_recommended: see Level.
    """

    name: str
    model: str
    effects: tuple[str, ...]
    pictures: tuple[Measured, ...]
    samples_per_second: float
    lens_share: float
    scene_share: float
    other_share: float
    bias_codes: float
    noise_codes: float
    difference: np.ndarray = field(repr=False, compare=False)
    group: str
    is_recommended: bool

    def error_after(self, seconds: float) -> float:
        """Extrapolated error after a longer time: noise falls with the square root of the time, bias stays."""
        last = self.pictures[-1]
        noise2 = max(0.0, last.rmse**2 - self.bias_codes**2)
        return math.sqrt(min(self.bias_codes, last.rmse) ** 2 + noise2 * last.seconds / seconds)

    def seconds_to(self, rmse: float) -> float:
        """Seconds until the error falls to `rmse`, interpolated logarithmically between the pictures; inf: never."""
        if self.bias_codes >= rmse:
            return math.inf
        last = None
        for picture in self.pictures:
            if picture.rmse <= rmse:
                if last is None:
                    return picture.seconds
                share = math.log(last.rmse / rmse) / math.log(last.rmse / picture.rmse)
                return float(last.seconds * (picture.seconds / last.seconds) ** share)
            last = picture
        # Noise falls with the square root of the time.
        assert last is not None
        noise2 = last.rmse**2 - self.bias_codes**2
        return last.seconds * max(1.0, noise2 / (rmse**2 - self.bias_codes**2))


@dataclass(frozen=True)
class Measurements:
    """Measurements of the levels of simulation, and of the sampling strategies of the full lens.

    rungs: levels, against a reference with all effects; samplings: sampling strategies of the full lens without
    effects, against their own reference. missing: names of levels not measured because of an interruption; impossible:
    names of levels that cannot render this lens, or not on this device.
    """

    device: str
    size: tuple[int, int]
    reference: str
    reference_noise_codes: float
    rungs: tuple[Rung, ...]
    samplings: tuple[Rung, ...]
    missing: tuple[str, ...]
    impossible: tuple[str, ...]
    reference_codes: Codes = field(repr=False, compare=False)
