"""Study of the planner: random shots with all effects, without each effect, and as planned.

    python benchmarks/plan_study.py [--device cpu] [--shots 36] [--seed 1] [--spp 1024]  # results of one device
    python benchmarks/plan_study.py --page  # docs/generated/plan-study.md from the results of all devices

The size of an effect is measured by omitting it from a picture that has all effects; that of a camera model by
comparing it with the next better one without effects. A decision is "too noisy to tell" if the threshold lies within
four standard deviations of the measurement. The oracle decides by the measured sizes: it keeps the effects that reach
their thresholds and uses the cheapest camera model that the measurements allow.
Times are those of the samples, without the preparation of scene and lens, for equal numbers of samples. tile_samples.py
measures what sample counts by tile save.
"""

from __future__ import annotations

import argparse
import json
import time
import warnings
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from pathlib import Path
from statistics import median

import flip_evaluator
import numpy as np
import realcam as rc
from machine import machine
from picture_changes import Comparison, Picture, Size, added_codes, square_means, values
from plan_shots import Shot, random_shot
from srgb import srgb_codes
from tile_samples import seconds_of

EFFECTS = ("dispersion", "coatings", "ghosts", "diffraction")
# Effects that a camera model has: the models without and with the effect.
MODELS = {
    "defocus": ("pinhole", "thin"),
    "distortion": ("thin", "mapped"),
    "vignetting": ("thin", "mapped"),
    "aberrations": ("mapped", "full"),
}
NOISY = "too noisy to tell"
ROOT = Path(__file__).parents[1]
RESULTS = ROOT / "benchmarks" / "results"
PAGE = ROOT / "docs" / "generated" / "plan-study.md"


@dataclass
class Decision:
    """The planner's decision on an effect, and its measured size. The names are keys of the files of results."""

    effect: str
    unit: str  # "px" or "codes"
    threshold: float
    foreseen: float  # size that the planner estimated
    measured: float
    measured_at_least: float  # bounds of the measured size
    measured_at_most: float
    is_kept: bool

    @property
    def is_needed(self) -> bool:
        return self.measured >= self.threshold

    @property
    def verdict(self) -> str:
        """ "right", "false drop", "false keep" or NOISY. An effect that is kept only because another one requires the
        camera model is no false keep."""
        if self.measured_at_least < self.threshold <= self.measured_at_most:
            return NOISY
        if self.is_needed:
            return "right" if self.is_kept else "false drop"
        return "false keep" if self.is_kept and self.foreseen >= self.threshold else "right"


@dataclass
class Outcome:
    """Results of one shot. flip and rms: errors of the planned picture against the one with all effects.

    everything_s, planned_s, oracle_s: render times with all effects, as planned, and as decided by the oracle.
    flip_noise, rms_noise: the same errors of a picture with all effects and another seed.
    """

    shot: str
    decisions: list[Decision]
    planned: str
    planning_s: float
    everything_s: float
    planned_s: float
    oracle_s: float
    flip: float
    flip_noise: float
    rms: float
    rms_noise: float


class Darkroom:
    """Renders pictures of one shot, each once. Effects are specifications as in shot files."""

    def __init__(self, shot: Shot, device: str, spp: int) -> None:
        self.shot, self.device, self.spp = shot, device, spp
        self.rendered: dict[tuple[object, ...], rc.Image] = {}

    def image(self, effects: Iterable[str], model: str = "full", seed: int = 1) -> rc.Image:
        key = (frozenset(effects), model, seed)
        if key not in self.rendered:
            self.rendered[key] = self.fresh(effects, model, seed, spp=self.spp)
        return self.rendered[key]

    def fresh(self, effects: Iterable[str], model: str, seed: int, **samples: object) -> rc.Image:
        camera = self.shot.camera.replace(model=model)
        return rc.render(self.shot.scene, camera, device=self.device, seed=seed, effects=effects, **samples)

    def values(self, effects: Iterable[str], model: str = "full", seed: int = 1) -> Picture:
        try:
            return values(self.image(effects, model, seed))
        except rc.InputError:  # the field of view is too wide for this model
            return np.zeros_like(values(self.image((), "full", seed)))

    def sharp(self) -> Picture | None:
        """Picture of a pinhole camera; None if the field of view is too wide for a pinhole."""
        picture = self.values((), "pinhole")
        return picture if picture.any() else None

    def of_uniform_environment(self) -> Darkroom:
        """Pictures of a uniform environment with the same camera."""
        corner = [(0.0, 0.0, 1.0), (1e-3, 0.0, 1.0), (0.0, 1e-3, 1.0)]  # behind the camera
        scene = rc.Scene.from_arrays(corner, [(0, 1, 2)]).with_environment(1)
        return Darkroom(Shot("sky", scene, self.shot.camera), self.device, 256)

    def seconds(self, effects: Iterable[str], model: str) -> float:
        return seconds_of(self.image(effects, model))


def size_of(
    effect: str,
    unit: str,
    before: Picture,
    after: Picture,
    detail: Picture,
    noise: tuple[Picture, Picture],
    sharp: Picture | None = None,
) -> Size:
    """Measures the size of an effect in its unit.

    before, after: pictures without and with the effect. detail, noise, sharp: as for Comparison. Light and distortion
    vary slowly over a picture and have little noise, so that smaller parts resolve the corners better.
    """
    if effect == "coatings":
        return Comparison(before, after, detail, noise, parts=(8, 12)).light_codes()
    if unit == "codes":
        return added_codes(srgb_codes(before), srgb_codes(after), (srgb_codes(noise[0]), srgb_codes(noise[1])))
    if effect == "distortion":
        return Comparison(before, after, detail, noise, parts=(8, 12)).moved_px()
    if effect == "diffraction":
        return Comparison(before, after, detail, noise, is_diffraction=True).airy_diameter_px()
    change = Comparison(before, after, detail, noise, sharp=sharp)
    return change.colours_px() if effect == "dispersion" else change.blurred_px()


def vignetting_codes(room: Darkroom, plain: Picture) -> Size:
    """Size of the vignetting: difference of both models in a uniform environment, at the brightness of the picture.

    plain: the picture without effects.
    """
    sky = room.of_uniform_environment()
    without, with_it = (square_means(sky.values((), model)) for model in MODELS["vignetting"])
    light = square_means(plain)
    codes = np.abs(srgb_codes(light * without / np.maximum(with_it, 1e-12)) - srgb_codes(light)).max(axis=2)
    return Size(*3 * (float(codes.max()),))


def measured(effect: str, unit: str, room: Darkroom, everything: frozenset[str]) -> Size | None:
    """Measures an effect by omitting it; None if it cannot be measured in pictures.

    everything: all effects.
    """
    detail, full, plain = room.values((), seed=3), room.values(everything), room.values(())
    plain_noise = (plain, room.values((), seed=2))
    if effect == "vignetting":
        return vignetting_codes(room, plain)
    if effect in MODELS:
        without, with_it = (room.values((), model) for model in MODELS[effect])
        return size_of(effect, unit, without, with_it, detail, plain_noise, room.sharp())
    if effect == "motion_blur":
        return size_of(effect, unit, plain, room.values({"-motion_blur"}), detail, plain_noise)
    if effect not in EFFECTS:
        return None
    if effect == "dispersion" and unit == "codes":
        # In codes, the size is that of the coatings' colour, which diffraction, as a spectral effect, would show as
        # well.
        everything -= {"diffraction"}
        full = room.values(everything)
    noise = (full, room.values(everything, seed=2))
    sharp = room.sharp() if effect == "dispersion" and unit == "px" else None
    omitted = size_of(effect, unit, room.values(everything - {effect}), full, detail, noise, sharp)
    if unit == "codes":
        return omitted
    # The noise of the other effects can hide a blur: a picture with this effect alone may measure it more precisely.
    with_it = room.values({effect})
    alone = size_of(effect, unit, plain, with_it, detail, (with_it, room.values({effect}, seed=2)), sharp)
    return min(omitted, alone, key=lambda size: size.at_most - size.at_least)


def decisions_of(plan: rc.Plan, room: Darkroom, everything: frozenset[str]) -> list[Decision]:
    decisions = []
    for decision in plan.decisions:
        size = measured(decision.effect, decision.unit, room, everything)
        if size is not None:
            sizes = (size.likely, size.at_least, size.at_most)
            decisions.append(
                Decision(
                    decision.effect, decision.unit, decision.threshold, decision.size, *sizes, is_kept=decision.is_kept
                )
            )
    return decisions


def oracle_of(decisions: list[Decision], moves: bool) -> tuple[frozenset[str], str]:
    """Effects and camera model that the measured sizes require. moves: True if the shot has motion blur."""
    needed = {decision.effect for decision in decisions if decision.is_needed}
    effects = needed & set(EFFECTS)
    if moves and "motion_blur" not in needed:
        effects |= {"-motion_blur"}
    if effects & {"dispersion", "coatings", "ghosts"} or "aberrations" in needed:
        return frozenset(effects), "full"
    if needed & {"distortion", "vignetting"}:
        return frozenset(effects), "mapped"
    return frozenset(effects), "thin" if "defocus" in needed else "pinhole"


def flip(a: Picture, b: Picture) -> float:
    """Mean FLIP error (Andersson et al. 2020) of two linear pictures."""
    pictures = [(srgb_codes(picture) / 255).astype(np.float32) for picture in (a, b)]
    return float(flip_evaluator.evaluate(*pictures, "LDR")[1])


def rms_of_white(a: Picture, b: Picture) -> float:
    """RMS difference as a fraction of white."""
    return float(np.sqrt(np.mean((a - b) ** 2)))


def outcome_of(shot: Shot, device: str, spp: int) -> Outcome:
    """Plans a shot, and measures the plan."""
    room = Darkroom(shot, device, spp)
    everything = frozenset(EFFECTS)
    rc.plan(shot.scene, shot.camera, device=device)
    start = time.perf_counter()
    plan = rc.plan(shot.scene, shot.camera, device=device)
    planning = time.perf_counter() - start
    decisions = decisions_of(plan, room, everything)
    oracle, oracle_model = oracle_of(decisions, any(d.effect == "motion_blur" for d in plan.decisions))
    planned, full, again = room.image(plan.effects, plan.model), room.image(everything), room.image(everything, seed=2)
    return Outcome(
        shot=shot.name,
        decisions=decisions,
        planned=", ".join([plan.model, *plan.effects]),
        planning_s=planning,
        everything_s=room.seconds(everything, "full"),
        planned_s=room.seconds(plan.effects, plan.model),
        oracle_s=room.seconds(oracle, oracle_model),
        flip=flip(values(full), values(planned)),
        flip_noise=flip(values(full), values(again)),
        rms=rms_of_white(values(full), values(planned)),
        rms_noise=rms_of_white(values(full), values(again)),
    )


def summary(outcomes: list[Outcome]) -> list[str]:
    """Markdown list of the results over all shots."""
    every = [d for outcome in outcomes for d in outcome.decisions]
    decisions = [d for d in every if d.verdict != NOISY]
    wrong = [d for d in decisions if d.verdict != "right"]
    large_drops = [d for d in wrong if d.verdict == "false drop" and d.measured > 2 * d.threshold]
    times, ideal = (
        [getattr(outcome, which) / outcome.everything_s for outcome in outcomes] for which in ("planned_s", "oracle_s")
    )
    saved = sum(o.everything_s - o.planned_s for o in outcomes)
    savable = sum(o.everything_s - o.oracle_s for o in outcomes)
    return [
        f"- {len(decisions) - len(wrong)} of {len(decisions)} decisions are right "
        f"({100 - 100 * len(wrong) / len(decisions):.0f}%); {sum(d.verdict == 'false drop' for d in wrong)} false "
        f"drops, {sum(d.verdict == 'false keep' for d in wrong)} false keeps; "
        f"{len(every) - len(decisions)} more are too noisy to tell. "
        f"Dropped with more than twice the threshold: {len(large_drops)}.",
        f"- Time as planned over time with everything: median {median(times):.2f}, worst {max(times):.2f}. The oracle "
        f"has {median(ideal):.2f} and {max(ideal):.2f}. {100 * saved / savable:.0f}% of what it saves is saved.",
        f"- FLIP of the planned picture against that with everything: median {median(o.flip for o in outcomes):.4f}, "
        f"worst {max(o.flip for o in outcomes):.4f} (of noise alone: "
        f"{median(o.flip_noise for o in outcomes):.4f}, {max(o.flip_noise for o in outcomes):.4f}). Root mean square "
        f"as a share of white: median {median(o.rms for o in outcomes):.4f}, worst {max(o.rms for o in outcomes):.4f}.",
        f"- Planning: median {1e3 * median(o.planning_s for o in outcomes):.0f} ms, worst "
        f"{1e3 * max(o.planning_s for o in outcomes):.0f} ms.",
    ]


def write_page() -> None:
    """Writes PAGE from the files of results."""
    lines = [
        "# Is the planner right?",
        "",
        "This page is written by the command `python benchmarks/plan_study.py --page`, from the files",
        "`benchmarks/results/*-plan.json`. An effect is measured by leaving it out of a picture that has all of them.",
        "Sizes are in pixels (px) or 8-bit codes, as on the page [planner](../plan.md).",
    ]
    for path in sorted(RESULTS.glob("*-plan.json")):
        record = json.loads(path.read_text(encoding="utf-8"))
        outcomes = [Outcome(**{**o, "decisions": [Decision(**d) for d in o["decisions"]]}) for o in record["outcomes"]]
        lines += ["", f"## {record['where']}", "", *summary(outcomes), ""]
        lines += ["| shot | taken with | time, of everything | FLIP | foreseen / measured, where not right |"]
        lines += ["|---|---|---|---|---|"]
        for o in outcomes:
            wrong = "; ".join(
                f"{d.effect} {d.foreseen:.2g} / {d.measured:.2g} {d.unit} ({d.verdict})"
                for d in o.decisions
                if d.verdict.startswith("false")
            )
            lines += [f"| {o.shot} | {o.planned} | {o.planned_s / o.everything_s:.2f} | {o.flip:.4f} | {wrong} |"]
        lines += ["", "Sizes foreseen / measured:", ""]
        names = list(dict.fromkeys(d.effect for o in outcomes for d in o.decisions))
        lines += ["| shot | " + " | ".join(names) + " |", "|---" * (len(names) + 1) + "|"]
        for o in outcomes:
            found = {d.effect: f"{d.foreseen:.2g} / {d.measured:.2g}" for d in o.decisions}
            lines += [f"| {o.shot} | " + " | ".join(found.get(name, "") for name in names) + " |"]
    PAGE.write_text("\n".join(lines) + "\n", encoding="utf-8")


def gpu_name() -> str:
    """Description of the first GPU, as in rc.devices()."""
    return next(device.description for device in rc.devices() if device.name.startswith("cuda"))


def write_record(path: Path, where: str, outcomes: list[Outcome]) -> None:
    record = {"where": where, "machine": machine(), "outcomes": [asdict(outcome) for outcome in outcomes]}
    path.write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--device", default="cpu")
    parser.add_argument("--shots", type=int, default=36)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--spp", type=int, default=1024)
    parser.add_argument("--output", type=Path, help="file for the results, for benchmarks/results")
    parser.add_argument("--page", action="store_true", help="only write the page")
    arguments = parser.parse_args()
    if arguments.page:
        return write_page()
    warnings.simplefilter("ignore", UserWarning)
    outcomes: list[Outcome] = []
    device = machine()["processor"] if arguments.device == "cpu" else gpu_name()
    where = f"{device}, {arguments.spp} samples, shots of seed {arguments.seed}"
    for number in range(arguments.shots):
        outcome = outcome_of(random_shot(number, arguments.seed), arguments.device, arguments.spp)
        outcomes.append(outcome)
        print(f"{outcome.shot}: {outcome.planned}; {outcome.planned_s:.2f} of {outcome.everything_s:.2f} s", flush=True)
        for d in outcome.decisions:
            if d.verdict != "right":
                between = f"{d.measured_at_least:.2g} to {d.measured_at_most:.2g}"
                sizes = f"foreseen {d.foreseen:.3g}, measured {d.measured:.3g} ({between}) {d.unit}"
                print(f"    {d.verdict}: {d.effect} {sizes}", flush=True)
        if arguments.output:
            write_record(arguments.output, where, outcomes)
    print("\n" + "\n".join(summary(outcomes)))


if __name__ == "__main__":
    main()
