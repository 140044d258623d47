"""The second camera for comparison behind the wipe, at the same pose as the first."""

from __future__ import annotations

from dataclasses import dataclass, replace

from .._core import InputError, Lens
from .camera_controls import CameraControls

NOTHING = "nothing"
#: Kinds of comparison, as shown to the user.
COMPARISONS = (NOTHING, "thin lens", "these settings", "another lens")


@dataclass(frozen=True)
class Comparison:
    """Choice of the second camera. kind: one of COMPARISONS. stored: controls for "these settings". lens: lens for
    "another lens"."""

    kind: str = NOTHING
    stored: CameraControls | None = None
    lens: Lens | None = None

    @classmethod
    def of(cls, kind: str, now: CameraControls, lens: Lens | None = None) -> Comparison:
        """Returns a comparison with the current controls. Raises InputError if the kind is unknown or its lens is
        missing."""
        if kind not in COMPARISONS or (kind == "another lens") != (lens is not None):
            raise InputError(f'unknown comparison "{kind:.40}"; expected one of {", ".join(COMPARISONS)}')
        return cls(kind, now if kind == "these settings" else None, lens)

    def beside(self, now: CameraControls) -> CameraControls | None:
        """Returns the second camera's controls; None: no comparison. Raises InputError if its lens cannot be
        focused."""
        if self.stored is not None:
            return replace(self.stored, pose=now.pose)
        if self.lens is not None:
            return now.with_lens(self.lens).focused_within_reach()
        return replace(now, model="thin") if self.kind == "thin lens" else None
