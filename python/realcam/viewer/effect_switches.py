"""Which effects a window simulates: those that are switched on, and those that the planner keeps."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace

from .._core import Plan, effects

EFFECTS = tuple(effect.name for effect in effects() if not effect.is_on)
_WITHOUT_SURFACES = {effect.name for effect in effects() if not effect.needs_full_lens}


@dataclass
class Switches:
    """How effects are chosen: each "auto", "on" or "off"."""

    of: dict[str, str] = field(default_factory=lambda: dict.fromkeys(EFFECTS, "auto"))
    words: dict[str, str] = field(default_factory=dict)  #: of those that the shot gives a number, "ghosts=1e-8"
    others: tuple[str, ...] = ()  #: what the shot says of effects without a switch, "-motion_blur"

    @classmethod
    def of_shot(cls, words: Iterable[str]) -> Switches:
        """As a shot file names effects: without "auto" all that it does not name are off."""
        words = tuple(words)
        switches = cls(dict.fromkeys(EFFECTS, "auto" if "auto" in words else "off"))
        others = []
        for word in words:
            name = word.removeprefix("-").partition("=")[0]
            if name in EFFECTS:
                switches.of[name] = "off" if word.startswith("-") else "on"
                if "=" in word:
                    switches.words[name] = word
            elif word != "auto":
                others.append(word)
        switches.others = tuple(others)
        return switches

    def named(self, plan: Plan | None) -> tuple[str, ...]:
        """What is simulated: what is on, what the plan keeps of the others, and what the shot says besides."""
        kept = {effect.partition("=")[0]: effect for effect in plan.effects} if plan else {}
        chosen = {name: self.words.get(name, name) for name, state in self.of.items() if state == "on"}
        switched = [
            chosen.get(name) or kept[name]
            for name, state in self.of.items()
            if name in chosen or (state == "auto" and name in kept)
        ]
        return (*switched, *self.others)

    def of_model(self, model: str) -> Switches:
        """With all effects off that the surfaces of a lens bring, where the camera's model has none."""
        if model == "full":
            return self
        return replace(self, of={name: self.of[name] if name in _WITHOUT_SURFACES else "off" for name in self.of})

    def as_words(self) -> list[str]:
        """As shot files name them."""
        automatic = ["auto"] if "auto" in self.of.values() else []
        on = [self.words.get(name, name) for name, state in self.of.items() if state == "on"]
        off = [f"-{name}" for name, state in self.of.items() if state == "off" and automatic]
        return [*automatic, *on, *off, *self.others]
