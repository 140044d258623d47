"""Glass selection from the catalogue: the nearest glasses to a given one, and glass substitution in a lens."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

from .._core import Glass, InputError, Lens, LensFileError, RealcamError, glass_names
from ..derivatives.variable import Variable, check_surface_exists
from ..dispersion import LINE_C_NM, LINE_D_NM, LINE_F_NM
from .optimiser import Targets, optimised

_LINE_G_NM = 435.8343


@dataclass(frozen=True)
class GlassMatch:
    """A glass of the catalogue. partial_dispersion: (n_g - n_F) / (n_F - n_C).

    distance: from the requested glass; 1 is 0.01 of n_d, 1 of V_d, or 0.005 of the partial dispersion.
    """

    name: str
    n_d: float
    abbe_number: float
    partial_dispersion: float
    distance: float


def _numbers(glass: Glass) -> tuple[float, float, float]:
    """n_d, Abbe number and partial dispersion of a glass; inf and 0 if it has no dispersion."""
    g, f, d, c = (glass.index(nm) for nm in (_LINE_G_NM, LINE_F_NM, LINE_D_NM, LINE_C_NM))
    if f <= c:
        return d, math.inf, 0.0
    return d, (d - 1) / (f - c), (g - f) / (f - c)


@lru_cache(maxsize=1)
def _catalogue() -> tuple[tuple[str, tuple[float, float, float]], ...]:
    """Names and _numbers() of the catalogue's glasses with dispersion."""
    rows = []
    for name in glass_names():
        try:
            numbers = _numbers(Glass.named(name))
        except RealcamError:
            continue  # its table does not reach from the g line to the C line
        if math.isfinite(numbers[1]):
            rows.append((name, numbers))
    return tuple(rows)


def nearest_glasses(glass: Glass | str, count: int = 5, *, makers: Sequence[str] | None = None) -> list[GlassMatch]:
    """The catalogue's glasses nearest in index, Abbe number and partial dispersion, the nearest first.

    makers: the makers to choose from, as named before the colon: ("schott", "ohara"); None: all. Prices are not
    considered. Raises InputError for an unknown name, and for a glass without dispersion.
    """
    n, v, p = _numbers(Glass.named(glass) if isinstance(glass, str) else glass)
    if not math.isfinite(v):
        raise InputError("a glass with a constant index has no dispersion; specify an index and an Abbe number")
    matches = [
        GlassMatch(name, *numbers, math.hypot((numbers[0] - n) / 0.01, numbers[1] - v, (numbers[2] - p) / 0.005))
        for name, numbers in _catalogue()
        if makers is None or name.split(":")[0] in makers
    ]
    return sorted(matches, key=lambda match: match.distance)[:count]


@dataclass(frozen=True)
class GlassSearch:
    """Result of a glass search.

    lens: the best lens. glasses: the new glasses, by surface index. rms_spot_before_mm, rms_spot_mm: RMS spot radius of
    the initial and the best lens. evaluations: number of evaluated lenses. message: reason for the end.
    """

    lens: Lens
    glasses: Mapping[int, str]
    rms_spot_before_mm: float
    rms_spot_mm: float
    evaluations: int
    message: str


def with_better_glasses(
    lens: Lens,
    variables: Sequence[Variable],
    targets: Targets | None = None,
    *,
    surfaces: Sequence[int] | None = None,
    candidates: int = 5,
    makers: Sequence[str] | None = None,
    most_steps: int = 8,
    rounds: int = 2,
    samples: int = 6,
    progress: Callable[[int, float], bool | None] | None = None,
    answers_interrupt: bool = False,
) -> GlassSearch:
    """Substitutes glasses of the catalogue, one surface after the other, and optimises the lens with each candidate.

    surfaces: indices of the surfaces whose glass may change; None: all glasses with dispersion. candidates: the number
    of nearest glasses that are tried for each surface; the best one is kept. makers: as for nearest_glasses. The search
    ends when a round changes nothing, or after `rounds`. most_steps: of each optimisation. progress, answers_interrupt:
    as for optimised. Raises InputError for surfaces without a dispersive glass behind them.
    """
    chosen = _glass_surfaces(lens, surfaces)
    state = _Progress(progress)
    best = optimised(
        lens, variables, targets, most_steps=most_steps, samples=samples, progress=state,
        answers_interrupt=answers_interrupt,
    )  # fmt: skip
    before, glasses, message = best.rms_spot_before_mm, dict[int, str](), "no other glass is better"
    try:
        for _ in range(rounds):
            changed = False
            for surface in chosen:
                start = best.lens
                for match in _other_glasses(start.surfaces[surface].material, candidates, makers):
                    if state.is_ended:
                        return GlassSearch(
                            best.lens,
                            glasses,
                            before,
                            best.rms_spot_mm,
                            state.evaluations,
                            "stopped by the progress function",
                        )
                    try:
                        trial = start.with_surface(surface, material=match.name)
                        found = optimised(
                            trial, variables, targets, most_steps=most_steps, samples=samples, progress=state
                        )
                    except (InputError, LensFileError):
                        continue  # with this glass the lens cannot be focused, or passes no light
                    if found.merit < best.merit:
                        best, changed = found, True
                        glasses[surface] = match.name
            if not changed:
                break
        else:
            message = "all rounds changed a glass"
    except KeyboardInterrupt:
        if not answers_interrupt:
            raise
        message = "interrupted"
    return GlassSearch(best.lens, glasses, before, best.rms_spot_mm, state.evaluations, message)


def _other_glasses(glass: Glass, count: int, makers: Sequence[str] | None) -> list[GlassMatch]:
    """The nearest glasses, without equivalents of the glass under another name."""
    pool = nearest_glasses(glass, len(_catalogue()), makers=makers)
    return [match for match in pool if match.distance > 1e-3][:count]


class _Progress:
    """Counts the evaluations of all optimisations, and remembers that the caller has stopped the search."""

    def __init__(self, progress: Callable[[int, float], bool | None] | None) -> None:
        self.evaluations, self.progress, self.is_ended = 0, progress, False

    def __call__(self, _: int, rms_mm: float) -> bool:
        self.evaluations += 1
        if self.progress is not None and self.progress(self.evaluations, rms_mm) is False:
            self.is_ended = True
        return not self.is_ended


def _glass_surfaces(lens: Lens, surfaces: Sequence[int] | None) -> list[int]:
    """Indices of the surfaces whose glass may change; None: all with dispersion. Raises InputError."""

    def has_glass(i: int) -> bool:
        if lens.surfaces[i].type != "refracting":
            return False
        n, v, _ = _numbers(lens.surfaces[i].material)
        return n > 1.1 and math.isfinite(v)

    if surfaces is None:
        found = [i for i in range(len(lens.surfaces)) if has_glass(i)]
        if not found:
            raise InputError(f'lens "{lens.name}" has no glass with dispersion')
        return found
    for i in surfaces:
        check_surface_exists(lens, i)
        if not has_glass(i):
            raise InputError(f"there is no glass with dispersion behind surface {i + 1}")
    return list(surfaces)
