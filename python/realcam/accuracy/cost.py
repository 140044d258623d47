"""Measures a shot at all levels of simulation: times, errors, and levels that are missing."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Iterable
from dataclasses import asdict

import numpy as np

from .._core import Camera, InputError, RenderSettings, Scene
from ..image import Image
from ..number_text import counted
from ..planning import resolved
from ..render import ProgressCallback, render
from .errors import Codes, codes, flip, mean_square
from .levels import Level, known_effects, levels_of, sampling_strategies
from .measurements import LevelMeasurements, Measured, Measurements
from .report import text_of


class AccuracyCost(Measurements):
    """Measurements with their presentations: `str` gives Markdown tables."""

    def __str__(self) -> str:
        return text_of(self)

    def json(self) -> str:
        """Returns everything except the pictures as JSON."""

        def plain(item: object) -> object:
            if isinstance(item, dict):
                return {k: plain(v) for k, v in item.items() if not isinstance(v, np.ndarray)}
            if isinstance(item, list | tuple):
                return [plain(value) for value in item]
            return item

        return json.dumps(plain(asdict(self)), indent=1)

    def figure(self, path: str | os.PathLike[str]) -> None:
        """Writes plots of the error over time as .svg, or as .html with the tables. Raises ImageFileError."""
        from .figure import save_figure  # loads matplotlib, which tables do not need

        save_figure(self, path)


def accuracy_cost(
    scene: Scene,
    camera: Camera,
    *,
    device: str = "auto",
    threads: int = 0,
    seed: int = 0,
    max_bounces: int | str = "auto",
    size: int = 320,
    max_spp: int = 256,
    reference_spp: int = 4096,
    effects: Iterable[str] | None = None,
    levels: bool = True,
    samplings: bool = True,
    progress: ProgressCallback | None = None,
) -> AccuracyCost:
    """Renders a shot at all levels of simulation, from a blurred pinhole picture to the full lens with all effects.

    size: pixels of the longer side. max_spp: each level is rendered with 1, 4, 16, ... samples up to this number.
    reference_spp: samples of each of the two reference pictures, of the full lens with `effects`; effects None: all
    effects whose data the lens file has. levels, samplings: measure the levels of simulation, and compare strategies of
    pupil sampling. progress: called with the fraction done. Ctrl-C ends the measurement early; the result then lists
    the levels that are missing.

    Raises what render raises.
    """
    film = camera.film
    columns, rows = film.resolution
    scale = min(1.0, size / max(columns, rows))
    small = (max(1, round(columns * scale)), max(1, round(rows * scale)))
    camera = camera.replace(film=film.replace(resolution=small), model="full")
    requested = RenderSettings(effects=(), max_bounces=max_bounces)
    bounces = resolved(scene, camera, requested, device, stacklevel=2).settings.max_bounces
    settings = {"device": device, "threads": threads, "max_bounces": bounces}
    reference_effects = tuple(known_effects(camera) if effects is None else effects)

    def report(done: float) -> None:
        if progress is not None:
            progress(done)

    report(0.0)
    reference = Reference(scene, camera, reference_effects, reference_spp, seed, settings)
    pairs = [(level, reference) for level in levels_of(scene, camera, reference_effects, **settings)] if levels else []
    level_count = len(pairs)
    if samplings:
        without_effects = Reference(scene, camera, (), reference_spp, seed, settings)
        pairs += [(level, without_effects) for level in sampling_strategies()]
    done: list[tuple[bool, LevelMeasurements]] = []
    missing = [level.name for level, _ in pairs]
    impossible: list[str] = []
    try:
        for number, (level, against) in enumerate(pairs):
            report((1 + number) / (1 + len(pairs)))
            try:
                measurements = _measure(level, scene, camera, against, max_spp, seed, settings)
            except InputError:
                # The reference was rendered, so only this level is impossible. An ideal lens images no point at 90
                # degrees to its axis, a GPU has no double precision, and an exit pupil may lie behind the film.
                impossible.append(level.name)
            else:
                done.append((number < level_count, measurements))
            missing.remove(level.name)
    except KeyboardInterrupt:
        pass
    return AccuracyCost(
        device=reference.image.stats.device,
        size=small,
        reference=", ".join(("full lens", *reference_effects)) + f", {counted(2 * reference_spp, 'sample')}",
        reference_noise_codes=math.sqrt(reference.variance),
        levels=tuple(measurements for is_level, measurements in done if is_level),
        samplings=tuple(measurements for is_level, measurements in done if not is_level),
        missing=tuple(missing),
        impossible=tuple(impossible),
        reference_codes=reference.codes,
    )


class Reference:
    """Reference of the errors: the mean of two pictures with spp samples each.

    codes: of the mean picture. variance: of that mean, in codes^2.
    """

    def __init__(
        self,
        scene: Scene,
        camera: Camera,
        effects: tuple[str, ...],
        spp: int,
        seed: int,
        settings: dict[str, object],
    ) -> None:
        # Seeds differ from those of the levels, so that their noise is uncorrelated with the reference's.
        pair = [
            render(scene, camera, effects=effects, spp=spp, seed=seed + 1000 + k, **settings)  # type: ignore[arg-type]
            for k in range(2)
        ]
        self.image: Image = pair[0]
        a, b = (codes(image) for image in pair)
        self.codes: Codes = (a + b) / 2
        self.variance = mean_square(a, b) / 4


def _measure(
    level: Level,
    scene: Scene,
    camera: Camera,
    reference: Reference,
    max_spp: int,
    seed: int,
    settings: dict[str, object],
) -> LevelMeasurements:
    level.image(scene, camera, spp=1, seed=seed, **settings)  # so that the times exclude the building of caches
    pictures = []
    spp = 1
    while True:
        image, seconds = level.image(scene, camera, spp=spp, seed=seed, **settings)
        picture = codes(image)
        is_last = 4 * spp > max_spp
        if is_last or not level.is_stratified:
            second = codes(level.image(scene, camera, spp=spp, seed=seed + 1, **settings)[0])
            noise2 = mean_square(picture, second) / 2
        # Unstratified levels average first samples, whose texture filter is as wide as that of one sample. That is not
        # an error of the random numbers: only their noise counts.
        error2 = mean_square(picture, reference.codes) - reference.variance if level.is_stratified else noise2
        pictures.append(Measured(spp, seconds, math.sqrt(max(0.0, error2)), flip(reference.codes, picture)))
        if is_last:
            break
        spp *= 4
    mean = (picture + second) / 2
    bias2 = mean_square(mean, reference.codes) - noise2 / 2 - reference.variance
    # The mean square itself has a statistical error; a bias below three times that may be noise.
    if not level.is_stratified or bias2 < 3 * math.sqrt(2 / picture.size) * (noise2 + reference.variance):
        bias2 = 0.0
    stats = image.stats
    total_seconds = max(stats.lens_seconds + stats.scene_seconds + stats.other_seconds, 1e-12)
    return LevelMeasurements(
        name=level.name,
        model=level.model,
        effects=level.effects,
        pictures=tuple(pictures),
        samples_per_second=spp * picture.shape[0] * picture.shape[1] / seconds,
        lens_share=stats.lens_seconds / total_seconds,
        scene_share=stats.scene_seconds / total_seconds,
        other_share=stats.other_seconds / total_seconds,
        bias_codes=math.sqrt(max(0.0, bias2)),
        noise_codes=math.sqrt(noise2),
        difference=np.abs(mean - reference.codes).mean(axis=2),
        group=level.group,
        is_recommended=level.is_recommended,
    )
