"""What is to be photographed for a window, and what comes of it."""

from __future__ import annotations

from dataclasses import dataclass, field

from .._core import Camera, RenderSettings, RenderStats

MOST_SPP = 4096  # with which a picture is done, however noisy it still is


@dataclass(frozen=True)
class PictureRequest:
    """camera: of the whole resolution. The others are as the user has set them."""

    camera: Camera
    settings: RenderSettings = field(default_factory=lambda: RenderSettings(effects=(), max_bounces=1))
    tone: str = "film"
    is_automatic: bool = False  #: the exposure time follows the light
    compensation_ev: float = 0.0
    noise_codes: float = 1.0  #: the picture is refined until its noise is as small
    max_spp: int = MOST_SPP
    denoises: bool = False  #: frames are shown without their noise, but for the last one

    def is_same_view(self, other: PictureRequest) -> bool:
        """True if both have the same camera, apart from its exposure."""
        mine, others = self.camera, other.camera
        return bool(mine.replace(exposure_time_s=1, iso=100) == others.replace(exposure_time_s=1, iso=100))

    def is_same_picture(self, other: PictureRequest) -> bool:
        """True if the samples of one can be developed for the other."""
        return self.is_same_view(other) and self.settings == other.settings


@dataclass(frozen=True)
class Costs:
    """Where the time of a picture goes, and its rays."""

    lens_share: float
    scene_share: float
    other_share: float
    samples_per_s: float
    rays_per_s: float
    passing_share: float  #: of the rays that are sent into the lens

    @classmethod
    def of(cls, stats: RenderStats, seconds: float) -> Costs:
        """The costs of samples that were taken in so many seconds."""
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
    """A developed picture on its way to the browser."""

    serial: int  #: of the request that it shows
    jpeg: bytes
    jpeg_quality: int
    width: int
    height: int
    whole_width: int  #: of the picture that was asked for
    whole_height: int
    samples: int  #: per pixel
    is_preview: bool  #: of fewer pixels than were asked for
    is_final: bool  #: nothing will be added
    noise_codes: float | None  #: root mean square, 8-bit codes; None where it is not known yet
    seconds: float  #: from the request to this frame
    exposure_time_s: float
    costs: Costs | None
    noise_tiles: list[list[float]] | None = None  #: the noise of parts of the picture, rows from above
    is_denoised: bool = False
    left_s: float | None = None  #: until nothing will be added; None if it is not known yet
    final_noise_codes: float | None = None  #: by then, as far as it is known


@dataclass(frozen=True)
class Point:
    """What a pixel shows."""

    distance_m: float  #: along the camera's axis from the film; inf where nothing is met
    illuminance_lx: float  #: on the film, mean of the spot around it
