"""Selection of the simulated effects: those switched on by the user, and those kept by the planner."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace

from .._core import Plan, effects

#: Effects with a switch: those that are off by default.
EFFECTS = tuple(effect.name for effect in effects() if not effect.is_on)
#: Effects that any camera model can simulate; the others need the surfaces of the lens.
_EFFECTS_OF_ANY_MODEL = {effect.name for effect in effects() if not effect.needs_full_lens}


@dataclass
class Switches:
    """Switches of the simulated effects.

    Effect specifications are the strings of a shot file's key `effects`: "ghosts", "ghosts=1e-8" with a parameter,
    "-ghosts" for an effect that is off, and "auto" for all others.
    """

    #: "auto" (simulated if the planner keeps it), "on" or "off", for each of EFFECTS.
    states: dict[str, str] = field(default_factory=lambda: dict.fromkeys(EFFECTS, "auto"))
    #: Specifications in the shot of effects that have a parameter, by effect: "ghosts=1e-8".
    specs_with_parameter: dict[str, str] = field(default_factory=dict)
    #: Specifications in the shot of effects without a switch: "-motion_blur".
    specs_without_switch: tuple[str, ...] = ()

    @classmethod
    def from_shot(cls, specs: Iterable[str]) -> Switches:
        """Parses the effect specifications of a shot: without "auto", effects that it does not name are off."""
        specs = tuple(specs)
        switches = cls(dict.fromkeys(EFFECTS, "auto" if "auto" in specs else "off"))
        others = []
        for spec in specs:
            name = spec.removeprefix("-").partition("=")[0]
            if name in EFFECTS:
                switches.states[name] = "off" if spec.startswith("-") else "on"
                if "=" in spec:
                    switches.specs_with_parameter[name] = spec
            elif spec != "auto":
                others.append(spec)
        switches.specs_without_switch = tuple(others)
        return switches

    def effects_to_simulate(self, plan: Plan | None) -> tuple[str, ...]:
        """Specifications of the effects to simulate: those that are on, those on "auto" that the plan keeps, and those
        of the shot without a switch. plan: None: no effect on "auto" is simulated."""
        planned = {effect.partition("=")[0]: effect for effect in plan.effects} if plan else {}
        on = self._specs_that_are_on()
        switched = [
            on.get(name) or planned[name]
            for name, state in self.states.items()
            if name in on or (state == "auto" and name in planned)
        ]
        return (*switched, *self.specs_without_switch)

    def restricted_to_model(self, model: str) -> Switches:
        """Returns the switches for a camera model: without lens surfaces, effects that need them are off."""
        if model == "full":
            return self
        return replace(
            self,
            states={name: state if name in _EFFECTS_OF_ANY_MODEL else "off" for name, state in self.states.items()},
        )

    def as_specs(self) -> list[str]:
        """Returns the effect specifications for a shot file."""
        automatic = ["auto"] if "auto" in self.states.values() else []
        off = [f"-{name}" for name, state in self.states.items() if state == "off" and automatic]
        return [*automatic, *self._specs_that_are_on().values(), *off, *self.specs_without_switch]

    def _specs_that_are_on(self) -> dict[str, str]:
        return {name: self.specs_with_parameter.get(name, name) for name, state in self.states.items() if state == "on"}
