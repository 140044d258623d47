"""Results of the measurements at the levels of simulation."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from .errors import Codes


@dataclass(frozen=True)
class Measured:
    """Time and error of a picture.

    seconds: of sampling and post-processing, without setup. rmse: RMS error against the reference, in 8-bit codes.
    flip: mean FLIP error, 0 to 1; None without the package flip-evaluator.
    """

    spp: int
    seconds: float
    rmse: float
    flip: float | None


@dataclass(frozen=True)
class LevelMeasurements:
    """Measurements of one level of simulation.

    name, model, effects, group, is_recommended: see Level. pictures: in the order of their samples. bias_codes: RMS
    error without noise, in 8-bit codes. noise_codes: RMS noise of the picture with the most samples, in 8-bit codes.
    lens_share, scene_share, other_share: fractions of the time. difference: (H, W), absolute difference between the
    best picture and the reference, averaged over the channels, in 8-bit codes.
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
        """Returns the error after a longer time, in 8-bit codes.

        It is extrapolated: noise falls with the square root of the time, bias stays.
        """
        last = self.pictures[-1]
        noise2 = max(0.0, last.rmse**2 - self.bias_codes**2)
        return math.sqrt(min(self.bias_codes, last.rmse) ** 2 + noise2 * last.seconds / seconds)

    def seconds_to(self, rmse: float) -> float:
        """Returns the seconds after which the error has fallen to `rmse`, in 8-bit codes; inf: never.

        They are interpolated logarithmically between the pictures.
        """
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

    levels: levels of simulation, against a reference with all effects; samplings: sampling strategies of the full lens
    without effects, against their own reference. missing: names of levels not measured because of an interruption;
    impossible: names of levels that cannot render this lens, or not on this device.
    """

    device: str
    size: tuple[int, int]
    reference: str
    reference_noise_codes: float
    levels: tuple[LevelMeasurements, ...]
    samplings: tuple[LevelMeasurements, ...]
    missing: tuple[str, ...]
    impossible: tuple[str, ...]
    reference_codes: Codes = field(repr=False, compare=False)
