"""A picture that collects samples while it is shown."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._core import Camera, RenderSettings, Scene
from .film_part import NO_STATS, CollectedFilm, FilmPart
from .image import Image
from .planning import Settled, settled
from .render import warn_of_effects, warn_of_no_light
from .settings import setting, settings_of

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from ._core import _Region, _SettingWords


@dataclass(frozen=True)
class ReachedNoise:
    """What has become of a picture that was to have little noise.

    noise: of the noisiest tile, in the measure that was asked for. is_reached: also false where lamps may be missing,
    because only samples of pixels look for them, and few would meet them. spp_wanted: of the noisiest pixels, for what
    was wanted. shortfall: a sentence where it was not reached.
    """

    noise: float
    is_reached: bool
    spp_wanted: float
    shortfall: str = ""


class Session:
    """One picture on a device, which collects samples for as long as scene and camera stay the same.

    session = rc.Session(scene, camera)
    while not good_enough(session.image()):
        session.add(16)

    settings, also by their names, as in Session(scene, camera, max_bounces=4), and device are those of render; add()
    after add() takes the samples that one render of as many would take. Effects "auto" are planned for each new
    picture, anew where set() brings another scene or another view, which takes some hundredths of a second: for
    pictures that change all the time, name them.
    Threads take turns, and cancel() ends the turn of another. Raises InputError, SceneFileError and DeviceError; after
    one of these the picture begins anew. Warns of a scene without light.
    """

    def __init__(
        self,
        scene: Scene,
        camera: Camera,
        settings: RenderSettings | None = None,
        *,
        device: str = "auto",
        **changes: Unpack[_SettingWords],
    ) -> None:
        self._asked_settings, self._asked_camera, self._device = settings_of(settings, changes), camera, device
        self._settled = self._plan(scene, camera)  # raises for what is no scene or camera
        self._core = _core._Session(scene, self._settled.camera, self._settled.settings, device)
        warn_of_no_light(scene)
        warn_of_effects(camera, self._settled.settings)

    def _plan(self, scene: Scene, camera: Camera) -> Settled:
        return settled(scene, camera, self._asked_settings, self._device, stacklevel=4)

    @property
    def scene(self) -> Scene:
        """The scene that was set last."""
        return self._core.scene

    @property
    def camera(self) -> Camera:
        """The camera that was set last. Its model is the one that was planned, where the effects are "auto"."""
        return self._core.camera

    @property
    def settings(self) -> RenderSettings:
        """Those that the picture has: its effects are named, or planned."""
        return self._settled.settings

    effects = setting("effects")

    @property
    def device(self) -> str:
        """What it computes with, for people: as RenderStats.device."""
        return self._core.device

    def set(
        self, *, scene: Scene | None = None, camera: Camera | None = None, settings: RenderSettings | None = None
    ) -> None:
        """Another scene, camera or settings; None keeps what was set last.

        Only what changed is prepared again: of a scene from moved(), the places; of a camera with the same lens and
        film, its pose. Each begins a new picture. Another exposure time or ISO only develops the samples anew. Raises
        KeyboardInterrupt on Ctrl-C.
        """
        new_scene = self.scene if scene is None else scene
        asked = self._asked_camera if camera is None else camera
        wanted = self._asked_settings if settings is None else settings_of(settings, {})
        if ("auto" in wanted.effects or wanted.max_bounces == "auto") and isinstance(asked, Camera):
            if asked.model == self.camera.model:  # made of self.camera: the model of it was planned
                asked = asked.replace(model=self._asked_camera.model)
            if scene is None and settings is None:
                now = self._settled_for(new_scene, asked)
            else:
                now = settled(new_scene, asked, wanted, self._device, stacklevel=2)
        elif settings is None:
            now = self._settled._replace(camera=asked)
        else:
            now = Settled(asked, wanted, "")
        self._core.set(new_scene, now.camera, now.settings)
        self._asked_settings, self._asked_camera, self._settled = wanted, asked, now
        if scene is not None:
            warn_of_no_light(scene)

    def _settled_for(self, scene: Scene, asked: Camera) -> Settled:
        """Planned anew, but where only the dials of the exposure were turned."""

        def exposed_alike(camera: Camera) -> Camera:
            return camera.replace(exposure_time_s=asked.exposure_time_s, iso=asked.iso)

        if asked != exposed_alike(self._asked_camera):
            return self._plan(scene, asked)
        return self._settled._replace(camera=exposed_alike(self._settled.camera))

    def add(self, spp: int = 1) -> None:
        """Takes spp samples more of each pixel, 1 to 16777216, and returns when they are there.

        Raises Cancelled where another thread calls cancel(), and KeyboardInterrupt on Ctrl-C. Both keep what was taken
        until then, so that pixels may differ in their number of samples; each is developed with its own.
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
        """Takes samples of the pixels that are noisier than wanted, until none is; the arguments are settings.

        What is not said is as the session's settings have it. Raises what add raises.
        """
        words = {"noise": noise, "noise_codes": noise_codes, "seconds": seconds, "max_spp": max_spp}
        said: Any = {name: value for name, value in words.items() if value is not None}
        return ReachedNoise(**self._core.add_until(self._asked_settings.with_(spp="auto", **said)))

    def image(self) -> Image:
        """What was collected, as render returns it; spp is the mean over the pixels, rounded.

        Layers are those of all samples that were begun, also after a stop. A pixel without a sample is black, at
        depth inf. Raises InputError where there is no sample yet.
        """
        picture = self._core.picture() | {"spp": round(float(self.samples.mean()))}
        settings = self.settings
        return Image(**picture, camera=self.camera, seed=settings.seed, settings=settings, plan=self._settled.summary)

    def expose(
        self, region: _Region, first: int = 0, spp: int = 256, counts: NDArray[np.uint32] | None = None
    ) -> FilmPart:
        """What some samples of a region of the film collect, apart from the picture of this session, which stays.

        region: column and row of its first pixel, from the upper left corner, its width and its height. first, spp: the
        samples with numbers from first on, at most 256. counts: (height, width), how many of them single pixels take.
        Parts of all regions and samples make the picture (image_of), on whatever machines they were exposed. Where a
        CPU took them in steps of 256 samples, it has the same bits as that of one session.
        Raises InputError, and what add raises.
        """
        found = self._core.expose_region(region, first, spp, counts)
        layers = None
        if counts is None and self.has_sampled_layers:
            layers = self._core.see_region(region, first, spp)
        return FilmPart(_region(region), first, spp, found["pixels"], layers, stats=found["stats"])

    def expose_layers(self, region: _Region, first: int = 0, spp: int = 256) -> FilmPart:
        """The layers alone of what expose gives without counts. Raises what expose raises."""
        return FilmPart(_region(region), first, spp, layers=self._core.see_region(region, first, spp))

    def expose_traced_light(self, first: int = 0, spp: int = 256) -> FilmPart:
        """Ghosts and other light that is traced apart from the samples of pixels, as it belongs to so many of them.

        It falls on the whole film. A picture needs this of all of its samples, or of none where part.splats is empty,
        which a part of 0 samples tells. Raises InputError, and what add raises.
        """
        return FilmPart(None, first, spp, splats=self._core.expose_splats(first, spp))

    def image_of(self, parts: Iterable[FilmPart]) -> Image:
        """The picture that has all parts, and none twice; those of later samples of a pixel come later.

        Raises InputError for parts of another picture.
        """
        film = CollectedFilm(*self.camera.film.resolution)
        for part in parts:
            film.add(part)
        return self._image_of(film)

    def _image_of(self, film: CollectedFilm) -> Image:
        layers = film.layers
        if layers is None and self.has_sampled_layers:
            layers = np.zeros(film.pixels.shape, _core._LAYER_SUM)
        picture = self._core.picture_of(film.pixels, layers, film.splats, NO_STATS | film.stats)
        settings = self.settings
        return Image(**picture, camera=self.camera, seed=settings.seed, settings=settings, plan=self._settled.summary)

    @property
    def has_sampled_layers(self) -> bool:
        """Whether the settings want layers that are means over the samples, which parts then have."""
        return not _core._SAMPLED_LAYERS.isdisjoint(self.settings.layers)

    @property
    def samples(self) -> NDArray[np.int64]:
        """(H, W) int64: the number of samples that each pixel has."""
        return self._core.samples

    def cancel(self) -> None:
        """Ends what another thread does with this session, within the time of a sample: it raises Cancelled."""
        self._core.cancel()


def _region(region: Sequence[int]) -> _Region:
    column, row, width, height = region
    return column, row, width, height
