"""The second camera for comparison behind the wipe, at the same pose as the first."""

from __future__ import annotations

from dataclasses import dataclass, replace

from .._core import InputError, Lens
from .camera_controls import CameraControls

NOTHING = "nothing"
COMPARISONS = (NOTHING, "thin lens", "these settings", "another lens")


@dataclass(frozen=True)
class Comparison:
    """Choice of the second camera. kind: one of COMPARISONS. kept: controls for "these settings". lens: lens for
    "another lens"."""

    kind: str = NOTHING
    kept: CameraControls | None = None
    lens: Lens | None = None

    @classmethod
    def of(cls, kind: str, now: CameraControls, lens: Lens | None = None) -> Comparison:
        """Returns a comparison with the current controls. Raises InputError if the kind is unknown or its lens is
        missing."""
        if kind not in COMPARISONS or (kind == "another lens") != (lens is not None):
            raise InputError(f'there is nothing like "{kind:.40}" to compare with')
        return cls(kind, now if kind == "these settings" else None, lens)

    def beside(self, now: CameraControls) -> CameraControls | None:
        """Returns the second camera's controls; None: no comparison. Raises InputError if its lens cannot be
        focused."""
        if self.kept is not None:
            return replace(self.kept, pose=now.pose)
        if self.lens is not None:
            return now.with_lens(self.lens).focused_within_reach()
        return replace(now, model="thin") if self.kind == "thin lens" else None
