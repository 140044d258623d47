"""Is the planner right, and what does it save? Drawn shots with everything, without each effect, and as planned.

    python benchmarks/plan_study.py [--device cpu] [--shots 36] [--seed 1] [--spp 1024]  # one device's figures
    python benchmarks/plan_study.py --page  # docs/plan-study.md from the figures of all devices

An effect is measured by leaving it out of a picture that has all, a camera model against the next better one without
effects. The noise of two pictures that differ in their random numbers alone is taken off in squares. The oracle knows
what was measured: it keeps what reaches its threshold and takes the cheapest camera model that the measurements allow.
Times are those of the samples, without the preparation of scene and lens.
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
from picture_changes import change_in_codes, change_in_pixels, codes
from plan_shots import Shot, drawn_shot
from realcam.bench import machine

EFFECTS = ("dispersion", "coatings", "ghosts", "diffraction")
MODELS = {  # without, with
    "defocus": ("pinhole", "thin"),
    "distortion": ("thin", "mapped"),
    "vignetting": ("thin", "mapped"),
    "aberrations": ("mapped", "full"),
}
ROOT = Path(__file__).parents[1]
RESULTS = ROOT / "benchmarks" / "results"
PAGE = ROOT / "docs" / "plan-study.md"


@dataclass
class Decision:
    effect: str
    unit: str
    threshold: float
    foreseen: float
    measured: float
    noise: float
    is_kept: bool

    @property
    def is_needed(self) -> bool:
        return self.measured >= self.threshold

    @property
    def verdict(self) -> str:
        if self.noise > self.threshold and self.measured < 3 * self.noise:
            return "too noisy to tell"
        said = self.foreseen >= self.threshold
        if said == self.is_needed:
            return "right"
        return "false drop" if self.is_needed else "false keep"


@dataclass
class Outcome:
    """Of one shot. Errors are those of the planned picture against that with everything."""

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
    """Takes pictures of one shot, each once."""

    def __init__(self, shot: Shot, device: str, spp: int) -> None:
        self.shot, self.device, self.spp = shot, device, spp
        self.taken: dict[tuple[object, ...], rc.Image] = {}

    def image(self, effects: Iterable[str], model: str = "full", seed: int = 1) -> rc.Image:
        key = (frozenset(effects), model, seed)
        if key not in self.taken:
            camera = self.shot.camera.replace(model=model)
            self.taken[key] = rc.render(
                self.shot.scene, camera, spp=self.spp, device=self.device, seed=seed, effects=key[0]
            )
        return self.taken[key]

    def codes(self, effects: Iterable[str], model: str = "full", seed: int = 1) -> np.ndarray:
        try:
            return codes(self.image(effects, model, seed))
        except rc.InputError:  # the lens sees more than that model can
            return np.zeros_like(codes(self.image((), "full", seed)))

    def seconds(self, effects: Iterable[str], model: str) -> float:
        stats = self.image(effects, model).stats
        return stats.seconds - stats.setup_seconds


def measured(effect: str, unit: str, a: np.ndarray, b: np.ndarray) -> float:
    if effect in ("vignetting", "coatings"):
        return change_in_pixels(a, b).light_codes
    if unit == "codes":
        return change_in_codes(a, b)
    change = change_in_pixels(a, b)
    if effect == "distortion":
        return change.moved_px
    return max(change.colours_px, change.blur_px) if effect == "dispersion" else change.blur_px


def decisions_of(plan: rc.Plan, room: Darkroom, everything: frozenset[str]) -> list[Decision]:
    plain, plain_again = room.codes(()), room.codes((), seed=2)
    full, again = room.codes(everything), room.codes(everything, seed=2)
    decisions = []
    for decision in plan.decisions:
        effect, unit = decision.effect, decision.unit
        if effect in MODELS:
            without, with_it = (room.codes((), model) for model in MODELS[effect])
            noise = (plain, plain_again)
        elif effect in EFFECTS:
            without, with_it = room.codes(everything - {effect}), full
            noise = (full, again)
        elif effect == "motion_blur":
            without, with_it = room.codes({"-motion_blur"}), plain
            noise = (plain, plain_again)
        else:
            continue
        change, least = measured(effect, unit, without, with_it), measured(effect, unit, *noise)
        size = float(np.sqrt(max(change**2 - least**2, 0)))
        decisions.append(Decision(effect, unit, decision.threshold, decision.size, size, least, decision.is_kept))
    return decisions


def oracle_of(decisions: list[Decision], moves: bool) -> tuple[frozenset[str], str]:
    """Effects and the camera model."""
    needed = {decision.effect for decision in decisions if decision.is_needed}
    effects = needed & set(EFFECTS)
    if moves and "motion_blur" not in needed:
        effects |= {"-motion_blur"}
    if effects & {"dispersion", "coatings", "ghosts"} or "aberrations" in needed:
        return frozenset(effects), "full"
    if needed & {"distortion", "vignetting"}:
        return frozenset(effects), "mapped"
    return frozenset(effects), "thin" if "defocus" in needed else "pinhole"


def flip(a: np.ndarray, b: np.ndarray) -> float:
    pictures = [(picture / 255).astype(np.float32) for picture in (a, b)]
    return float(flip_evaluator.evaluate(*pictures, "LDR")[1])


def rms_of_white(a: rc.Image, b: rc.Image) -> float:
    difference = (a.pixels.astype(np.float64) - b.pixels) * 0.018 * a.camera.iso
    return float(np.sqrt(np.mean(difference**2)))


def outcome_of(shot: Shot, device: str, spp: int) -> Outcome:
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
        flip=flip(codes(full), codes(planned)),
        flip_noise=flip(codes(full), codes(again)),
        rms=rms_of_white(full, planned),
        rms_noise=rms_of_white(full, again),
    )


def summary(outcomes: list[Outcome]) -> list[str]:
    every = [d for outcome in outcomes for d in outcome.decisions]
    decisions = [d for d in every if d.verdict != "too noisy to tell"]
    wrong = [d for d in decisions if d.verdict != "right"]
    large_drops = [d for d in wrong if d.verdict == "false drop" and d.measured > 2 * d.threshold]
    times = [outcome.planned_s / outcome.everything_s for outcome in outcomes]
    saved = sum(o.everything_s - o.planned_s for o in outcomes)
    savable = sum(o.everything_s - o.oracle_s for o in outcomes)
    return [
        f"- {len(decisions) - len(wrong)} of {len(decisions)} decisions are right "
        f"({100 - 100 * len(wrong) / len(decisions):.0f}%); {sum(d.verdict == 'false drop' for d in wrong)} false "
        f"drops, {sum(d.verdict == 'false keep' for d in wrong)} false keeps; "
        f"{len(every) - len(decisions)} more are too noisy to tell. "
        f"Dropped with more than twice the threshold: {len(large_drops)}.",
        f"- Time as planned over time with everything: median {median(times):.2f}, worst {max(times):.2f}; "
        f"{100 * saved / savable:.0f}% of what the oracle saves.",
        f"- FLIP of the planned picture against that with everything: median {median(o.flip for o in outcomes):.4f}, "
        f"worst {max(o.flip for o in outcomes):.4f} (of noise alone: "
        f"{median(o.flip_noise for o in outcomes):.4f}, {max(o.flip_noise for o in outcomes):.4f}); root mean square "
        f"as a share of white: median {median(o.rms for o in outcomes):.4f}, worst {max(o.rms for o in outcomes):.4f}.",
        f"- Planning: median {1e3 * median(o.planning_s for o in outcomes):.0f} ms, worst "
        f"{1e3 * max(o.planning_s for o in outcomes):.0f} ms.",
    ]


def write_page() -> None:
    lines = [
        "# Is the planner right?",
        "",
        "Written by `python benchmarks/plan_study.py --page` from `benchmarks/results/*-plan.json`. An effect is "
        "measured by",
        "leaving it out of a picture that has all of them; sizes in pixels (px) or 8-bit codes, as in "
        "[the planner](plan.md).",
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


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--device", default="cpu")
    parser.add_argument("--shots", type=int, default=36)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--spp", type=int, default=1024)
    parser.add_argument("--output", type=Path, help="of the figures: a file for benchmarks/results")
    parser.add_argument("--page", action="store_true", help="only write the page")
    words = parser.parse_args()
    if words.page:
        return write_page()
    warnings.simplefilter("ignore", UserWarning)
    outcomes = []
    for number in range(words.shots):
        outcome = outcome_of(drawn_shot(number, words.seed), words.device, words.spp)
        outcomes.append(outcome)
        print(f"{outcome.shot}: {outcome.planned}; {outcome.planned_s:.2f} of {outcome.everything_s:.2f} s", flush=True)
        for d in outcome.decisions:
            if d.verdict != "right":
                sizes = f"foreseen {d.foreseen:.3g}, measured {d.measured:.3g} {d.unit} (noise {d.noise:.2g})"
                print(f"    {d.verdict}: {d.effect} {sizes}", flush=True)
    print("\n" + "\n".join(summary(outcomes)))
    if words.output:
        device = machine()["processor"] if words.device == "cpu" else words.device
        where = f"{device}, {words.spp} samples, shots of seed {words.seed}"
        record = {"where": where, "machine": machine(), "outcomes": [asdict(outcome) for outcome in outcomes]}
        words.output.write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
