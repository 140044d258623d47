"""The rings and dials of the camera."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Awaitable, Callable
from typing import Any

from nicegui import ui
from nicegui.events import GenericEventArguments

from ...ocio import OcioView
from ...photography import SharpRange
from ..ring_scales import ISO, SHUTTER_S, Ring
from .elements import RingSlider, show_choice
from .focus_scale import distance_text, distance_texts, focus_scale_svg
from .window import Window

#: Descriptions of the camera models, by their names in shot files.
MODELS = {
    "full": "all surfaces (exact)",
    "polynomial": "polynomial fit",
    "mapped": "thin lens with the real distortion",
    "thick": "thick lens",
    "thin": "thin lens",
    "pinhole": "pinhole",
}
#: Widths of the refined picture, in pixels.
WIDTHS = (320, 480, 640, 960, 1280, 1920)
#: Goals for the noise, in 8-bit codes.
NOISES = (4.0, 2.0, 1.0, 0.5)
#: Names of common film and sensor sizes, by width and height in mm.
FILMS = {
    (36.0, 24.0): "36 × 24 mm (full frame)",
    (23.6, 15.7): "23.6 × 15.7 mm (APS-C)",
    (17.3, 13.0): "17.3 × 13 mm (Micro Four Thirds)",
    (13.2, 8.8): "13.2 × 8.8 mm (1 inch)",
    (9.8, 7.3): "9.8 × 7.3 mm (large phone)",
    (56.0, 56.0): "56 × 56 mm (6 × 6)",
    (127.0, 101.6): "127 × 101.6 mm (4 × 5 inches)",
}
_NOISE_NOTES = {4.0: " (draft)", 0.5: " (fine)"}
_FOCUS_STEPS = 400  # steps of the slider, uniform in the inverse distance, like the travel of a focusing lens


def grey_levels(codes: float) -> str:
    """A noise level as text."""
    return "half a grey level" if codes == 0.5 else f"{codes:g} grey level{'' if codes == 1 else 's'}"


def _noise_texts(noise: float) -> dict[Any, str]:
    return {codes: grey_levels(codes) + _NOISE_NOTES.get(codes, "") for codes in dict.fromkeys((*NOISES, noise))}


class CameraPanel:
    """Controls of the camera: the rings below the picture, and the settings panel.

    update() refreshes both after changes from elsewhere.
    """

    def __init__(self, window: Window, run: Callable[..., Awaitable[Any]]) -> None:
        self._window, self._bench, self._run = window, window.bench, run
        self._sharp = SharpRange(math.nan, math.nan)

    def add_rings(self) -> None:
        """Adds the rings and dials: focus, zoom, aperture, shutter, ISO, exposure."""
        with ui.element("section").classes("rc-controls rc-rings").props('aria-label="Rings"'):
            with ui.element("div").classes("rc-ring-group"):
                self._focus_text = ui.label().props('data-testid="focus-text"')
                self._focus = self._ring("Focus", "Distance from the film to the plane in focus", self._set_focus)
                self._scale = ui.html("", sanitize=False).classes("rc-scale")
                self._sharp_text = ui.label().classes("rc-note").props('data-testid="sharp-text"')
                self._zoom_text = ui.label().props('data-testid="zoom-text"')
                self._zoom = self._ring(
                    "Zoom", "A longer focal length shows a smaller part of the scene, larger", self._set_zoom
                )
                self._position = self._choice(
                    "Zoom position",
                    {},
                    lambda value: self._run(self._bench.set_zoom, value),
                    "Zoom positions that the lens file describes",
                )
            with ui.element("div").classes("rc-ring-group"):
                self._aperture_text = ui.label().props('data-testid="aperture-text"')
                self._aperture = self._ring(
                    "Aperture",
                    "A larger f-number is a smaller aperture: a darker picture with more depth of field",
                    self._set_aperture,
                )
                self._shutter_text = ui.label().props('data-testid="shutter-text"')
                self._shutter = self._ring("Shutter", "Exposure time of the film", self._set_shutter)
                self._iso_text = ui.label().props('data-testid="iso-text"')
                self._iso = self._ring("ISO", "Sensitivity of the film: a larger number is brighter", self._set_iso)
            with ui.element("div").classes("rc-ring-row"):
                self._automatic = ui.switch("Automatic exposure").props('data-testid="automatic"')
                self._automatic.on("update:model-value", lambda e: self._change(is_automatic=bool(_value(e))))
                self._automatic.tooltip("The exposure time follows the mean brightness of the picture")
                self._compensation_ev = 0.0  # value last shown in the field
                self._compensation = ui.number("Compensation (EV)", value=0, min=-5, max=5, step=1 / 3, format="%.2f")
                self._compensation.on("update:model-value", self._set_compensation, throttle=0.1)
                self._compensation.tooltip(
                    "Brighter (+) or darker (-) than metered, in stops: by automatic exposure or a click with Meter"
                ).classes("w-40")

    def add_settings(self) -> None:
        """Adds the settings that are rarely changed."""
        self._model = self._choice(
            "Camera model", MODELS, lambda value: self._change(model=value), "How much of the lens is simulated"
        )
        self._width = self._choice(
            "Resolution",
            {w: f"{w} pixels across" for w in WIDTHS},
            lambda value: self._run(self._bench.set_resolution, int(value)),
            "Width of the refined picture",
        )
        self._noise = self._choice(
            "Refine to",
            _noise_texts(self._bench.noise_codes),
            lambda value: self._run(self._bench.set_noise, float(value)),
            "Noise to which the picture is refined, in grey levels of 255 from black to white",
        )
        self._denoise = ui.switch("Denoise while refining").props('data-testid="denoise"')
        self._denoise.on("update:model-value", lambda e: self._run(self._bench.set_denoising, bool(_value(e))))
        self._denoise.tooltip(
            "While the picture is being refined, it is shown and saved denoised by Open Image Denoise"
        )
        if self._bench.why_no_denoiser:
            self._denoise.disable()
            ui.label(self._bench.why_no_denoiser).classes("rc-note").props('data-testid="why-no-denoiser"')
        if isinstance(self._bench.tone, OcioView):
            self._view = self._choice(
                "View",
                {},
                lambda value: self._run(self._bench.set_view, *value),
                "View of the OpenColorIO configuration, which develops the picture in place of a tone curve",
            )
        self._film = self._choice(
            "Film",
            FILMS,
            lambda value: self._run(self._bench.set_film_mm, *value),
            "Size of the film or sensor; the picture keeps its width in pixels",
        )
        with ui.row().classes("items-center w-full no-wrap"):
            self._film_width = self._number(
                "Film width (mm)", "film-width", self._set_film, "Width of the exposed area"
            )
            self._film_height = self._number(
                "Film height (mm)", "film-height", self._set_film, "Height of the exposed area"
            )
        with ui.row().classes("items-center w-full no-wrap"):
            self._blades = self._number("Aperture blades", "blades", self._set_iris, "0 for a round aperture")
            self._rounding = self._number(
                "Blade rounding", "rounding", self._set_iris, "0 for straight sides of the aperture, 1 for a circle"
            )
            self._rotation = self._number(
                "Rotation (°)", "rotation", self._set_iris, "Angle by which the aperture's blades are rotated"
            )

    def update(self) -> None:
        """Shows the bench's current settings. On the server's loop."""
        now = self._bench.controls
        positions = now.lens.zoom_positions
        self._position.set_visibility(bool(positions))
        show_choice(self._position, {name: name for name in positions}, now.zoom if now.zoom in positions else None)
        for shown in (self._zoom, self._zoom_text):
            shown.set_visibility(now.zooms is not None)
        if now.zooms:
            text = f"{now.focal_length_mm:.4g} mm"
            self._show(self._zoom, now.zooms, now.focal_length_mm, text)
            self._zoom_text.set_text(f"Zoom {text}")
        apertures = self._bench.apertures
        f_number = max(now.f_number or 0.0, apertures.values[0])
        self._show(self._aperture, apertures, f_number, f"f/{apertures.text_of(f_number)}")
        self._aperture_text.set_text(f"Aperture f/{apertures.text_of(f_number)}")
        shutter = _seconds(SHUTTER_S, now.exposure_time_s)
        self._show(self._shutter, SHUTTER_S, now.exposure_time_s, shutter)
        self._shutter_text.set_text(f"Shutter {shutter}{' (automatic)' if now.is_automatic else ''}")
        self._show(self._iso, ISO, now.iso, ISO.text_of(now.iso))
        self._iso_text.set_text(f"ISO {ISO.text_of(now.iso)}")
        nearest = self._nearest_m
        step = round(_FOCUS_STEPS * (1 - nearest / now.focus_m)) if now.focus_m > nearest else 0
        self._focus.set(step, _FOCUS_STEPS, distance_text(now.focus_m))
        self._focus_text.set_text(f"Focus {distance_text(now.focus_m)}")
        self._show_scale()
        self._automatic.set_value(now.is_automatic)
        if now.compensation_ev != self._compensation_ev:  # otherwise the user may be typing a number
            self._compensation_ev = now.compensation_ev
            self._compensation.set_value(now.compensation_ev)
        self._model.set_value(now.model)
        width = now.film.resolution[0]
        show_choice(self._width, {w: f"{w} pixels across" for w in sorted({*WIDTHS, width})}, width)
        noise = self._bench.noise_codes
        show_choice(self._noise, _noise_texts(noise), noise)
        self._denoise.set_value(self._bench.denoises)
        if isinstance(tone := self._bench.tone, OcioView):
            views = {(display, view): f"{view}, {display}" for display in tone.views for view in tone.views[display]}
            show_choice(self._view, views, (tone.display, tone.view))
        size = now.film.width_mm, now.film.height_mm
        texts = FILMS if size in FILMS else {**FILMS, size: f"{size[0]:g} × {size[1]:g} mm"}
        show_choice(self._film, dict(texts), size)
        self._film_width.set_value(size[0])
        self._film_height.set_value(size[1])
        self._blades.set_value(now.lens.iris_blades)
        self._rounding.set_value(now.lens.iris_rounding)
        self._rotation.set_value(round(now.lens.iris_rotation_deg, 6))

    def show_sharp_range(self, sharp: SharpRange) -> None:
        """Shows the depth of field; nan if nothing is sharp. On the server's loop."""
        self._sharp = sharp
        self._show_scale()

    def _show_scale(self) -> None:
        now, sharp = self._bench.controls, self._sharp
        self._scale.set_content(focus_scale_svg(now.focus_m, sharp.near_m, sharp.far_m, self._nearest_m))
        if math.isnan(sharp.near_m):
            text = "Nothing is sharp: the aberrations alone blur points to more than 1/1500 of the film's diagonal"
        else:
            text = "Sharp from {} to {}".format(*distance_texts(sharp.near_m, sharp.far_m))
        self._sharp_text.set_text(text)

    @property
    def _nearest_m(self) -> float:
        """End of the focus ring: the nearest focus in the lens's file, or else ten focal lengths."""
        body = self._bench.controls.body
        if body.nearest_focus_m > 0:
            return body.nearest_focus_m
        return 0.01 * abs(body.first_order().effective_focal_length_mm)

    def _set_zoom(self, step: int) -> Awaitable[Any]:
        now = self._bench.controls
        zoom = now.zoomed(now.zooms.values[step]).zoom if now.zooms and step < len(now.zooms.values) else now.zoom
        return self._run(self._bench.set_zoom, zoom, ("zoom", self._zoom.gesture))

    def _set_focus(self, step: int) -> Awaitable[Any]:
        fraction = step / _FOCUS_STEPS
        return self._change(focus_m=math.inf if fraction >= 1 else self._nearest_m / (1 - fraction))

    def _set_aperture(self, step: int) -> Awaitable[Any]:
        values = self._bench.apertures.values
        return self._change(f_number=values[min(step, len(values) - 1)])

    def _set_shutter(self, step: int) -> Awaitable[Any]:
        return self._change(exposure_time_s=SHUTTER_S.values[step], is_automatic=False)

    def _set_iso(self, step: int) -> Awaitable[Any]:
        return self._change(iso=ISO.values[step])

    async def _set_film(self) -> None:
        width, height = _typed(self._film_width), _typed(self._film_height)
        if width and height:
            await self._run(self._bench.set_film_mm, width, height)
            self.update()

    async def _set_iris(self) -> None:
        blades, rounding, rotation = _typed(self._blades), _typed(self._rounding), _typed(self._rotation)
        if blades is not None and rounding is not None and rotation is not None:
            await self._run(self._bench.edit, lambda lens: lens.with_iris(round(blades), rounding, rotation))
            self.update()

    async def _set_compensation(self, event: GenericEventArguments) -> None:
        with contextlib.suppress(ValueError):  # incomplete input
            value = float(str(_value(event)))  # the field sends text, although it is a number field
            if abs(value) <= 10:
                await self._change(compensation_ev=value)

    def _change(self, **changes: Any) -> Awaitable[Any]:
        return self._run(self._bench.change, **changes)

    def _ring(self, name: str, help: str, act: Callable[[int], Awaitable[Any]]) -> RingSlider:
        """Adds a slider. act: sets the bench to a step of the slider."""

        async def turned(step: int) -> None:
            await act(step)
            self.update()

        return RingSlider(name, help, turned).props(f'data-testid="{name.lower()}"')

    def _show(self, slider: RingSlider, ring: Ring, value: float, text: str) -> None:
        slider.set(ring.step_of(value), len(ring.values) - 1, text)

    def _number(self, label: str, test_id: str, act: Callable[[], Awaitable[Any]], help: str) -> ui.number:
        """Number field whose value is applied at Enter, or when the field loses focus."""
        field = ui.number(label, format="%g").classes("grow").props(f'data-testid="{test_id}"')
        field.tooltip(help)
        field.on("change", act)
        return field

    def _choice(self, name: str, options: dict[Any, str], act: Callable[[Any], Awaitable[Any]], help: str) -> ui.select:
        """Adds a drop-down list. options: texts by value. act: called with the chosen value."""
        choice = ui.select(options, label=name).classes("w-full").props(f'data-testid="{name.lower()}"')
        choice.tooltip(help)

        async def chosen() -> None:
            await act(choice.value)

        choice.on("update:model-value", chosen)
        return choice


def _typed(field: ui.number) -> float | None:
    """Returns the field's number; None if it holds no finite number."""
    value = field.value
    return float(value) if isinstance(value, int | float) and math.isfinite(value) else None


def _value(event: GenericEventArguments) -> Any:
    """The value of a Vue event, whose arguments may be a list."""
    return event.args[0] if isinstance(event.args, list) and event.args else event.args


def _seconds(ring: Ring, value: float) -> str:
    """Text of an exposure time: the engraving, or a fraction below 0.1 s."""
    text = ring.text_of(value)
    return f"{text} s" if "/" in text or float(text) >= 0.1 else f"1/{1 / value:.3g} s"
