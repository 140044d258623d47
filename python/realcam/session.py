"""Progressive rendering: the class Session, a picture that accumulates samples."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._core import Camera, RenderSettings, Scene
from .film_part import NO_STATS, AccumulatedFilm, FilmPart
from .image import Image
from .planning import Resolved, resolved
from .render import warn_of_effects, warn_of_no_light
from .settings import setting, settings_of

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._core import _Region, _SettingsKwargs


@dataclass(frozen=True)
class ReachedNoise:
    """Result of rendering to a noise limit.

    noise: noise of the noisiest tile, in the requested measure. is_reached: False if the limit was missed, and also if
    lamps may be missing because only paths from the film sample them and few would hit them. spp_wanted: samples per
    pixel that the noisiest tile needs for the limit. shortfall: a sentence if the limit was not reached, otherwise
    empty.
    """

    noise: float
    is_reached: bool
    spp_wanted: float
    shortfall: str = ""


class Session:
    """One picture on a device, which accumulates samples while scene and camera stay the same.

    session = rc.Session(scene, camera)
    while not good_enough(session.image()):
        session.add(16)

    settings, also as keywords, as in Session(scene, camera, max_bounces=4), and device: as for render. Repeated calls
    of add() take the same samples as one render of their total. Effects "auto" are planned for each new picture, and
    again if set() changes the scene or the view, which takes some hundredths of a second: name the effects for
    pictures that change all the time.
    Calls from several threads are serialised; cancel() ends the running one. Raises InputError, SceneFileError and
    DeviceError, after which the picture starts from scratch. Warns of a scene without light.
    """

    def __init__(
        self,
        scene: Scene,
        camera: Camera,
        settings: RenderSettings | None = None,
        *,
        device: str = "auto",
        **changes: Unpack[_SettingsKwargs],
    ) -> None:
        self._requested_settings, self._requested_camera, self._device = settings_of(settings, changes), camera, device
        self._resolved = self._plan(scene, camera)  # raises if scene or camera have the wrong type
        self._core = _core._Session(scene, self._resolved.camera, self._resolved.settings, device)
        warn_of_no_light(scene)
        warn_of_effects(camera, self._resolved.settings)

    def _plan(self, scene: Scene, camera: Camera) -> Resolved:
        return resolved(scene, camera, self._requested_settings, self._device, stacklevel=4)

    @property
    def scene(self) -> Scene:
        """The scene that was set last."""
        return self._core.scene

    @property
    def camera(self) -> Camera:
        """The camera that was set last, with the planned model if the effects are "auto"."""
        return self._core.camera

    @property
    def settings(self) -> RenderSettings:
        """The picture's settings, with "auto" replaced by the planned values."""
        return self._resolved.settings

    effects = setting("effects")

    @property
    def device(self) -> str:
        """Readable name of the device, as in RenderStats.device."""
        return self._core.device

    def set(
        self, *, scene: Scene | None = None, camera: Camera | None = None, settings: RenderSettings | None = None
    ) -> None:
        """Changes the scene, camera or settings; None: unchanged.

        Only changed data is prepared again: of a scene from moved(), the instances' transforms; of a camera with the
        same lens and film, its pose. A change begins a new picture, except that another exposure time or ISO only
        develops the samples again. Raises KeyboardInterrupt on Ctrl-C.
        """
        new_scene = self.scene if scene is None else scene
        new_camera = self._requested_camera if camera is None else camera
        new_settings = self._requested_settings if settings is None else settings_of(settings, {})
        if ("auto" in new_settings.effects or new_settings.max_bounces == "auto") and isinstance(new_camera, Camera):
            if new_camera.model == self.camera.model:  # derived from self.camera, whose model was planned
                new_camera = new_camera.replace(model=self._requested_camera.model)
            if scene is None and settings is None:
                planned = self._resolved_for(new_scene, new_camera)
            else:
                planned = resolved(new_scene, new_camera, new_settings, self._device, stacklevel=2)
        elif settings is None:
            planned = self._resolved._replace(camera=new_camera)
        else:
            planned = Resolved(new_camera, new_settings, "")
        self._core.set(new_scene, planned.camera, planned.settings)
        self._requested_settings, self._requested_camera, self._resolved = new_settings, new_camera, planned
        if scene is not None:
            warn_of_no_light(scene)

    def _resolved_for(self, scene: Scene, new_camera: Camera) -> Resolved:
        """Returns a new plan, or the last one if only exposure time or ISO of the camera have changed."""

        def with_new_exposure(camera: Camera) -> Camera:
            return camera.replace(exposure_time_s=new_camera.exposure_time_s, iso=new_camera.iso)

        if new_camera != with_new_exposure(self._requested_camera):
            return self._plan(scene, new_camera)
        return self._resolved._replace(camera=with_new_exposure(self._resolved.camera))

    def add(self, spp: int = 1) -> None:
        """Takes spp more samples per pixel, 1 to 16777216, and returns when they are done.

        Raises Cancelled if another thread calls cancel(), and KeyboardInterrupt on Ctrl-C. Both keep the samples taken
        until then, so that pixels may differ in their sample counts; each is normalised by its own.
        """
        self._core.add(spp)

    def add_until(
        self,
        noise: float | None = None,
        *,
        noise_codes: float | None = None,
        seconds: float | None = None,
        max_spp: int | None = None,
    ) -> ReachedNoise:
        """Takes samples of pixels above the noise limit until no pixel exceeds it.

        Arguments as for RenderSettings; None: the value of the session's settings. Raises what add() raises.
        """
        arguments = {"noise": noise, "noise_codes": noise_codes, "seconds": seconds, "max_spp": max_spp}
        changes: Any = {name: value for name, value in arguments.items() if value is not None}
        return ReachedNoise(**self._core.add_until(self._requested_settings.with_(spp="auto", **changes)))

    def image(self) -> Image:
        """Returns the accumulated picture, as render does; its spp is the mean over the pixels, rounded.

        Layers include all samples that were begun, even after a cancellation. A pixel without a sample is black, at
        depth inf. Raises InputError before the first sample.
        """
        return replace(self._core.image(self._resolved.summary), spp=round(float(self.samples.mean())))

    def expose(
        self, region: _Region, first: int = 0, spp: int = 256, counts: NDArray[np.uint32] | None = None
    ) -> FilmPart:
        """Renders some samples of a region of the film, apart from this session's picture.

        region: column and row of its first pixel, from the upper left corner, its width and its height. first, spp:
        index of the first sample, and samples per pixel, at most 256. counts: (height, width), individual sample counts
        of the pixels, up to spp. Parts of all regions and samples, from any machines, form the picture (image_of). If a
        CPU took them in steps of 256 samples, it is bitwise equal to a single session's.
        Raises InputError, and what add raises.
        """
        found = self._core.sample_region(region, first, spp, counts)
        layers = None
        if counts is None and self.has_sampled_layers:
            layers = self._core.layer_sums_of_region(region, first, spp)
        return FilmPart(_region(region), first, spp, found["pixels"], layers, stats=found["stats"])

    def expose_layers(self, region: _Region, first: int = 0, spp: int = 256) -> FilmPart:
        """Renders only the layers of expose(), for all samples. Raises what expose() raises."""
        return FilmPart(_region(region), first, spp, layers=self._core.layer_sums_of_region(region, first, spp))

    def expose_traced_light(self, first: int = 0, spp: int = 256) -> FilmPart:
        """Renders ghosts and other light that is traced separately and splatted on the film, not sampled per pixel.

        The part covers the whole film. A picture requires it for all of its samples, or not at all if part.splats is
        empty, which a part of 0 samples already shows. Raises InputError, and what add() raises.
        """
        return FilmPart(None, first, spp, splats=self._core.sample_splats(first, spp))

    def image_of(self, parts: Iterable[FilmPart]) -> Image:
        """Returns the picture assembled from all parts; each must occur once, in the order of their samples.

        Raises InputError for parts of another picture.
        """
        film = AccumulatedFilm(*self.camera.film.resolution)
        for part in parts:
            film.add(part)
        return self._image_of(film)

    def _image_of(self, film: AccumulatedFilm) -> Image:
        layers = film.layers
        if layers is None and self.has_sampled_layers:
            layers = np.zeros(film.pixels.shape, _core._LAYER_SUM)
        stats = NO_STATS | film.stats
        return self._core.image_of(film.pixels, layers, film.splats, stats, self._resolved.summary)

    @property
    def has_sampled_layers(self) -> bool:
        """True if a requested layer is a mean over the samples, so that parts contain layers."""
        return not _core._SAMPLED_LAYERS.isdisjoint(self.settings.layers)

    @property
    def samples(self) -> NDArray[np.int64]:
        """(H, W) int64: sample count of each pixel."""
        return self._core.samples

    def cancel(self) -> None:
        """Cancels another thread's call on this session, within the time of a sample: that call raises Cancelled."""
        self._core.cancel()


def _region(region: Sequence[int]) -> _Region:
    column, row, width, height = region
    return column, row, width, height
