"""What was measured at the levels of simulation, as values."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from .errors import Codes


@dataclass(frozen=True)
class Measured:
    """A picture. rmse: in 8-bit codes, against the reference; flip: 0 to 1, None without flip-evaluator."""

    spp: int
    seconds: float
    rmse: float
    flip: float | None


@dataclass(frozen=True)
class Rung:
    """One level of simulation.

    bias_codes: what of the error is no noise, root mean square; noise_codes: of a picture of the most samples.
    lens_share, scene_share, other_share: of the time. difference: (H, W) of the best picture to the reference, mean of
    the channels' absolute differences, codes. group, is_recommended: as those of Level.
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
        """The error after more time than was measured: noise falls with its square root, and bias stays."""
        last = self.pictures[-1]
        noise2 = max(0.0, last.rmse**2 - self.bias_codes**2)
        return math.sqrt(min(self.bias_codes, last.rmse) ** 2 + noise2 * last.seconds / seconds)

    def seconds_to(self, rmse: float) -> float:
        """Seconds until the error is so small, between the pictures on a logarithmic scale; inf: never."""
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
    """What the levels of simulation cost, and what ways there are to sample one of them.

    rungs: of a reference with all effects; samplings: of the full lens without effects, against its own reference.
    missing: those that were not measured, because it was interrupted, and impossible: those that cannot show what this
    lens sees, or not on this device.
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
