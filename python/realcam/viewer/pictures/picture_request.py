"""Requests and results of a picture loop."""

from __future__ import annotations

from dataclasses import dataclass, field

from ..._core import Camera, RenderSettings, RenderStats
from ...ocio import OcioView

MAX_SPP = 4096  # samples per pixel at which refinement ends regardless of the noise


@dataclass(frozen=True)
class PictureRequest:
    """A picture to render. camera: at full resolution. Other fields: the user's settings."""

    camera: Camera
    settings: RenderSettings = field(default_factory=lambda: RenderSettings(effects=(), max_bounces=1))
    tone: str | OcioView = "film"
    is_automatic: bool = False  #: automatic exposure sets the exposure time
    compensation_ev: float = 0.0
    noise_codes: float = 1.0  #: RMS noise in 8-bit codes to which the picture is refined
    max_spp: int = MAX_SPP
    denoises: bool = False  #: frames are denoised, except for the final one

    def is_same_view(self, other: PictureRequest) -> bool:
        """True if both have the same camera, apart from its exposure."""
        mine, others = self.camera, other.camera
        return bool(mine.replace(exposure_time_s=1, iso=100) == others.replace(exposure_time_s=1, iso=100))

    def is_same_picture(self, other: PictureRequest) -> bool:
        """True if the samples of one can be developed for the other."""
        return self.is_same_view(other) and self.settings == other.settings


@dataclass(frozen=True)
class Costs:
    """Time and rays of a picture. Shares are fractions of its render time."""

    lens_share: float
    scene_share: float
    other_share: float
    samples_per_s: float
    rays_per_s: float
    passing_share: float  #: fraction of the rays sent into the lens that pass it

    @classmethod
    def of(cls, stats: RenderStats, seconds: float) -> Costs:
        """Costs of samples rendered in `seconds`."""
        stages = stats.lens_seconds, stats.scene_seconds, stats.other_seconds
        all_stages = sum(stages) or 1.0
        return cls(
            lens_share=stages[0] / all_stages,
            scene_share=stages[1] / all_stages,
            other_share=stages[2] / all_stages,
            samples_per_s=stats.sampled_rays / seconds,
            rays_per_s=stats.scene_rays / seconds,
            passing_share=stats.passed_rays / max(stats.sampled_rays, 1),
        )


@dataclass(frozen=True)
class Frame:
    """A developed picture for the browser."""

    serial: int  #: of its request
    jpeg: bytes
    jpeg_quality: int
    width: int
    height: int
    whole_width: int  #: of the full resolution
    whole_height: int
    samples: int  #: per pixel
    is_preview: bool  #: below the full resolution
    is_final: bool  #: refinement is complete
    noise_codes: float | None  #: RMS noise in 8-bit codes; None: not known yet
    seconds: float  #: from the request to this frame
    exposure_time_s: float
    costs: Costs | None
    noise_tiles: list[list[float]] | None = None  #: RMS noise of tiles of the picture, rows from the top
    is_denoised: bool = False
    left_s: float | None = None  #: forecast of the time until refinement is complete; None: not known yet
    final_noise_codes: float | None = None  #: forecast of the final noise; None: not known yet


@dataclass(frozen=True)
class Point:
    """Distance and light at a pixel."""

    distance_m: float  #: along the camera's axis from the film; inf if nothing is hit
    illuminance_lx: float  #: on the film, mean of the surrounding spot
