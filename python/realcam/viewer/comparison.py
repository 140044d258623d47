"""What the picture is compared with behind the wipe: a second camera that stands where the first one does."""

from __future__ import annotations

from dataclasses import dataclass, replace

from .._core import InputError, Lens
from .camera_controls import CameraControls

NOTHING = "nothing"
COMPARISONS = (NOTHING, "thin lens", "these settings", "another lens")


@dataclass(frozen=True)
class Comparison:
    """kind: one of COMPARISONS. kept: the controls of "these settings". lens: of "another lens"."""

    kind: str = NOTHING
    kept: CameraControls | None = None
    lens: Lens | None = None

    @classmethod
    def of(cls, kind: str, now: CameraControls, lens: Lens | None = None) -> Comparison:
        """With the controls as they are at this moment. Raises InputError where there is nothing of that kind."""
        if kind not in COMPARISONS or (kind == "another lens") != (lens is not None):
            raise InputError(f'there is nothing like "{kind:.40}" to compare with')
        return cls(kind, now if kind == "these settings" else None, lens)

    def beside(self, now: CameraControls) -> CameraControls | None:
        """The second camera; None: there is none. Raises InputError where its lens cannot be focused."""
        if self.kept is not None:
            return replace(self.kept, pose=now.pose)
        if self.lens is not None:
            return now.with_lens(self.lens).focused_within_reach()
        return replace(now, model="thin") if self.kind == "thin lens" else None
