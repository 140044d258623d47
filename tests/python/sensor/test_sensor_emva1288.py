"""A photon-transfer series, analysed by the reference implementation of EMVA 1288, gives the data sheet back."""

from __future__ import annotations

import logging
from collections.abc import Callable

import numpy as np
import pytest
import realcam as rc

from .sensors import film_of, photons_per_um2

WAVELENGTH_NM = 550
SHAPE = (384, 512)
WITHIN = 0.01  # what the project asks for; the comments say how well each figure can be known

# One whose sheet has all figures, and whose converter ends below its full well; the same with room above the well,
# where the saturation capacity has to be the file's; with 12 dB of gain; and another, with the figures its file lacks.
SERIES: dict[str, Callable[[], tuple[rc.Sensor, float]]] = {
    "imx900": lambda: (rc.Sensor.load("sony-imx900-mono"), 0.0),
    "imx174": lambda: (rc.Sensor.load("sony-imx174-mono").replace(prnu_percent=0.9, dsnu_e=8), 0.0),
    "imx900, black at 100": lambda: (rc.Sensor.load("sony-imx900-mono").replace(black_level_dn=100), 0.0),
    "imx900 + 12 dB": lambda: (rc.Sensor.load("sony-imx900-mono"), 12.0),
}


def saturation_e(sensor: rc.Sensor, gain_dn_per_e: float) -> float:
    """Electrons at the largest temporal variance: the sheet's figure, or the value set by the converter's end.

    Found by brute force: the variance of values clipped at the converter's end, for electron counts around the means of
    pixels of different response, plus the read noise.
    """
    converter_e = (2**sensor.adc_bits - 1 - sensor.black_level_dn) / gain_dn_per_e
    if converter_e > sensor.full_well_e:
        return sensor.saturation_capacity_e
    # Five times as many values change the variances by 2e-5; steps of 0.1% locate the maximum ten times more closely
    # than the test requires.
    normal = np.linspace(-6, 6, 121)
    weights = np.exp(-0.5 * normal**2)
    weights /= weights.sum()
    means = np.linspace(0.9, 1, 101) * converter_e
    variances = []
    for mean in means:
        expected = mean * (1 + sensor.prnu_percent / 100 * normal)[:, None]
        signal = np.minimum(expected + np.sqrt(expected + sensor.read_noise_e**2) * normal, converter_e)
        variances.append(weights @ (signal**2 @ weights - (signal @ weights) ** 2))
    return float(means[np.argmax(variances)])


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(SERIES))
def test_a_photon_transfer_series_gives_the_parameters_back(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("emva1288", reason="emva1288 comes with the dev extra")
    # emva1288 1.0.2 uses a function that numpy 2 has no more.
    monkeypatch.setattr(np, "asfarray", lambda values: np.asarray(values, float), raising=False)
    from emva1288.process import routines
    from emva1288.process.data import Data1288
    from emva1288.process.results import Results1288

    sensor, gain_db = SERIES[name]()
    iso = sensor.iso_range()[0] * 10 ** (gain_db / 20)
    gain = sensor.gain_dn_per_e * 10 ** (gain_db / 20)
    saturation = saturation_e(sensor, gain)
    assert (saturation == sensor.saturation_capacity_e) == (name == "imx900, black at 100")
    area = sensor.pixel_pitch_um**2
    efficiency = np.interp(WAVELENGTH_NM, *np.array(sensor.quantum_efficiency).T)
    seeds = iter(range(10**6))

    def frames(electrons: float, count: int) -> list[np.ndarray]:
        lux_s = electrons / (area * efficiency * photons_per_um2(1, WAVELENGTH_NM))
        film = film_of(np.full(SHAPE, lux_s), pitch_um=sensor.pixel_pitch_um, iso=iso, illuminant=str(WAVELENGTH_NM))
        return [sensor.expose(film, seed=next(seeds)).mosaic.astype(np.int64) for _ in range(count)]

    # 40 even steps, and steps of 0.3% where the saturation is looked for.
    levels = np.concatenate([np.linspace(0.02, 0.94, 40), np.arange(0.955, 1.05, 0.003)]) * saturation
    temporal = {0.0: frames(0, 2)} | {e / efficiency: frames(e, 2) for e in levels}
    spatial = {0.0: frames(0, 16), 0.5 * saturation / efficiency: frames(0.5 * saturation, 16)}

    def reduced(images: list[np.ndarray], kind: str) -> dict[str, object]:
        sums = routines.get_int_imgs(images)
        return sums if kind == "spatial" else {k: np.sum(sums[k]) for k in ("sum", "pvar")} | {"dmean": sums["dmean"]}

    data = Data1288(
        {
            "temporal": {1e7: {photons: reduced(images, "temporal") for photons, images in temporal.items()}},
            "spatial": {1e7: {photons: reduced(images, "spatial") for photons, images in spatial.items()}},
            "height": SHAPE[0],
            "width": SHAPE[1],
        },
        loglevel=logging.ERROR,
    )
    found = Results1288(data.data, pixel_area=area, loglevel=logging.ERROR)
    # 196 608 pixels in pairs know a variance to 0.32%, and the slope through some thirty of them to 0.1%.
    assert pytest.approx(gain, rel=WITHIN) == found.K
    # The same pairs, minus the twelfth of quantisation, give this to 0.2%. The dark current of 10 ms adds less.
    assert found.sigma_d == pytest.approx(sensor.read_noise_e, rel=WITHIN)
    # The maximum of variances known to 0.32%, on a curve that is flat there: some 0.5%. The sheet's 9458 electrons of
    # the imx900 cannot all be measured: its converter ends at 9662, and pixels differ.
    assert found.u_e_sat == pytest.approx(saturation, rel=WITHIN)
    # Standard deviations over 196 608 pixels are known to 0.16%; the temporal noise of 16 frames adds to them.
    assert pytest.approx(sensor.dsnu_e, rel=WITHIN) == found.DSNU1288
    assert pytest.approx(sensor.prnu_percent, rel=WITHIN) == found.PRNU1288
    assert pytest.approx(100 * efficiency, rel=WITHIN) == found.QE
