"""Selection of the simulated effects: those switched on by the user, and those kept by the planner."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace

from .._core import Plan, effects

EFFECTS = tuple(effect.name for effect in effects() if not effect.is_on)
_WITHOUT_SURFACES = {effect.name for effect in effects() if not effect.needs_full_lens}


@dataclass
class Switches:
    """Switches of the effects: each "auto", "on" or "off"."""

    of: dict[str, str] = field(default_factory=lambda: dict.fromkeys(EFFECTS, "auto"))
    words: dict[str, str] = field(default_factory=dict)  #: words of effects with a number in the shot, "ghosts=1e-8"
    others: tuple[str, ...] = ()  #: the shot's words of effects without a switch, "-motion_blur"

    @classmethod
    def of_shot(cls, words: Iterable[str]) -> Switches:
        """Parses the effects of a shot file: without "auto", effects that it does not name are off."""
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
        """Effects to simulate: those that are on, those on "auto" that the plan keeps, and those of the shot without a
        switch."""
        kept = {effect.partition("=")[0]: effect for effect in plan.effects} if plan else {}
        chosen = {name: self.words.get(name, name) for name, state in self.of.items() if state == "on"}
        switched = [
            chosen.get(name) or kept[name]
            for name, state in self.of.items()
            if name in chosen or (state == "auto" and name in kept)
        ]
        return (*switched, *self.others)

    def of_model(self, model: str) -> Switches:
        """Returns the switches for a camera model: without lens surfaces, effects that need them are off."""
        if model == "full":
            return self
        return replace(self, of={name: self.of[name] if name in _WITHOUT_SURFACES else "off" for name in self.of})

    def as_words(self) -> list[str]:
        """Returns the effects in the notation of shot files."""
        automatic = ["auto"] if "auto" in self.of.values() else []
        on = [self.words.get(name, name) for name, state in self.of.items() if state == "on"]
        off = [f"-{name}" for name, state in self.of.items() if state == "off" and automatic]
        return [*automatic, *on, *off, *self.others]
