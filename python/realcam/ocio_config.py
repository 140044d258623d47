"""Configurations of OpenColorIO, read under limits. Imports PyOpenColorIO; realcam.ocio does so on first use."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import PyOpenColorIO as ocio

from ._core import InputError, _read_file

_MAX_CONFIG_BYTES = 16 << 20
_MAX_LUT_BYTES = 128 << 20  # of each file
_MAX_ALL_LUT_BYTES = 512 << 20  # of a configuration's files together
_MAX_TRANSFORMS = 10_000  # of a colour space, with all that it refers to
_REC709 = "lin_rec709_srgb"  # linear Rec. 709 in OpenColorIO's own configurations
_BLACK_TO_WHITE = np.linspace(0, 1, 33, dtype=np.float32)


class _Files(ocio.PyConfigIOProxy):  # type: ignore[misc]
    """The files of a configuration, which OpenColorIO reads through this object.

    Only regular files are read: reading a device might never end. problem: the first reason why a file is refused.
    """

    def __init__(self, path: str) -> None:
        super().__init__()
        self.problem = ""
        self._left = _MAX_ALL_LUT_BYTES
        self._last: tuple[str, Any] = ("", None)
        self._text: str = _read_file(path, _MAX_CONFIG_BYTES).decode(errors="replace")

    def getConfigData(self) -> str:  # noqa: N802
        """Returns the text of the configuration."""
        return self._text

    def getFastLutFileHash(self, path: str) -> str:  # noqa: N802
        """Returns a text that changes with the file; empty if there is none, and OpenColorIO tries the next folder."""
        try:
            status = Path(path).stat()
        except OSError:
            return ""
        # Pipes and devices get a text, too: without one OpenColorIO would open them by itself.
        return f"{status.st_ino} {status.st_size} {status.st_mtime_ns}"

    def getLutData(self, path: str) -> Any:  # noqa: N802
        """Returns the content of a file. OpenColorIO asks again for each format that it tries."""
        if self._last[0] == path:
            return self._last[1]
        content = b""
        try:
            content = _read_file(path, min(_MAX_LUT_BYTES, self._left))
        except InputError as error:
            self.problem = self.problem or f"{path}: {error}"
        self._left -= len(content)
        self._last = path, ocio.vector_of_uint8_t(content or b"\n")  # OpenColorIO does not return from reading nothing
        return self._last[1]


class OcioConfig:
    """A configuration. name: its file, or a name that begins with "ocio://". All functions raise InputError, whose
    message begins with the name."""

    def __init__(self, name: str, *, is_built_in: bool) -> None:
        self.name = name
        self._files: _Files | None = None  # OpenColorIO keeps no reference to it
        with self._errors_named():
            if is_built_in:
                self._config = ocio.Config.CreateFromFile(name)
                return
            self._files = _Files(name)
            self._config = ocio.Config.CreateFromConfigIOProxy(self._files)
            self._config.setWorkingDir(str(Path(name).absolute().parent))
            _check_size(self._config)

    @property
    def views(self) -> Mapping[str, tuple[str, ...]]:
        """Names of the views by that of the display."""
        return {display: tuple(self._config.getViews(display)) for display in self._config.getDisplays()}

    def view(self, display: str, view: str) -> tuple[str, str]:
        """Returns the names of a display and of its view; "" stands for the default."""
        views, display = self.views, display or self._config.getDefaultDisplay()
        if display not in views:
            raise InputError(f"{self.name}: no display {display!r:.60}; expected {_listed(views)}")
        view = view or self._config.getDefaultView(display)
        if view not in views[display]:
            raise InputError(
                f"{self.name}: the display {display!r} has no view {view!r:.60}; expected {_listed(views[display])}"
            )
        return display, view

    def view_transform(self, display: str, view: str) -> Callable[[np.ndarray], None]:
        """Returns a function that converts colours (N, 3) float32 in place from linear Rec. 709 to display values."""
        with self._errors_named():
            processor = ocio.Config.GetProcessorFromConfigs(
                self._standard, _REC709, self._config, display, view, ocio.TRANSFORM_DIR_FORWARD
            )
            return processor.getDefaultCPUProcessor().applyRGB  # type: ignore[no-any-return]

    def is_srgb(self, display: str, view: str) -> bool:
        """True if the values of a view are encoded for sRGB (IEC 61966-2-1)."""
        space = self._config.getDisplayViewColorSpaceName(display, view)
        space = display if space == "<USE_DISPLAY_NAME>" else space
        color_space = self._config.getColorSpace(space)
        if color_space is None or color_space.isData():
            return False
        colors = np.stack(np.meshgrid(*[_BLACK_TO_WHITE[::4]] * 3), axis=-1).reshape(-1, 3)
        converted = colors.copy()
        try:
            ocio.Config.GetProcessorFromConfigs(
                self._config, space, self._standard, "sRGB - Display"
            ).getDefaultCPUProcessor().applyRGB(converted)
        except ocio.Exception:  # the configuration does not relate its displays to CIE XYZ
            return False
        return bool(np.abs(converted - colors).max() < 1e-3)  # a quarter of an 8-bit step

    def conversion_to_rec709(self, color_space: str, path: str) -> Callable[[np.ndarray], None]:
        """Returns a function that converts colours (N, 3) float32 in place to linear Rec. 709.

        color_space: of the configuration, or "file_rules" for the one that its rules choose for the file `path`. Values
        of a colour space of data remain as they are.
        """
        with self._errors_named():
            if color_space == "file_rules":
                color_space = self._config.getColorSpaceFromFilepath(path)[0]
            if self._config.getColorSpace(color_space) is None:
                names = [space.getName() for space in self._config.getColorSpaces()]
                raise InputError(f"no colour space {color_space!r:.60}; expected {_listed(names)}, or file_rules")
            processor = ocio.Config.GetProcessorFromConfigs(self._config, color_space, self._standard, _REC709)
            return processor.getDefaultCPUProcessor().applyRGB  # type: ignore[no-any-return]

    @cached_property
    def _standard(self) -> Any:
        """OpenColorIO's own configuration, which defines linear Rec. 709 and sRGB."""
        return ocio.Config.CreateFromFile("ocio://default")

    @contextmanager
    def _errors_named(self) -> Iterator[None]:
        """Raises errors of OpenColorIO as InputErrors in one line that begins with the configuration's name. Its
        remarks are not printed: they quote a stranger's text unchanged."""
        level = ocio.GetLoggingLevel()
        ocio.SetLoggingLevel(ocio.LOGGING_LEVEL_NONE)
        try:
            yield
        except (ocio.Exception, ocio.ExceptionMissingFile, InputError, RuntimeError, MemoryError) as error:
            problem = self._files.problem if self._files else ""
            text = " ".join((problem or str(error) or "there is too little memory for it").split())
            raise InputError(f"{self.name}: {text[:300]}") from None
        finally:
            ocio.SetLoggingLevel(level)


def _listed(names: Any) -> str:
    """Returns up to ten names as a text."""
    names = list(names)
    return ", ".join(map(str, names[:10])) + (f" and {len(names) - 10} more" if len(names) > 10 else "")


def _check_size(config: Any) -> None:
    """Raises InputError if a transform refers to others so often that the transforms of its conversion would fill
    the memory: five levels of a hundred references each are ten thousand million."""
    sizes: dict[str, int] = {}

    def size_of_space(name: str) -> int:
        if name not in sizes:
            sizes[name] = 1  # for a cycle, which OpenColorIO refuses
            space = config.getColorSpace(name) or config.getNamedTransform(name)
            sides = (
                (ocio.COLORSPACE_DIR_TO_REFERENCE, ocio.COLORSPACE_DIR_FROM_REFERENCE)
                if isinstance(space, ocio.ColorSpace)
                else (ocio.TRANSFORM_DIR_FORWARD, ocio.TRANSFORM_DIR_INVERSE)
            )
            sizes[name] = sum(size_of(space.getTransform(side)) for side in sides) if space else 1
        return sizes[name]

    def size_of(transform: Any) -> int:
        if isinstance(transform, ocio.GroupTransform):
            return sum(map(size_of, transform))
        if isinstance(transform, (ocio.ColorSpaceTransform, ocio.LookTransform)):
            return size_of_space(transform.getSrc()) + size_of_space(transform.getDst())
        if isinstance(transform, ocio.DisplayViewTransform):
            return size_of_space(transform.getSrc()) + 1
        return 1

    spaces = [space.getName() for space in config.getColorSpaces(ocio.SEARCH_REFERENCE_SPACE_ALL, ocio.COLORSPACE_ALL)]
    sizes_of_all = {name: size_of_space(name) for name in [*spaces, *config.getNamedTransformNames()]}
    for view in config.getViewTransforms():
        sides = (
            view.getTransform(ocio.VIEWTRANSFORM_DIR_TO_REFERENCE),
            view.getTransform(ocio.VIEWTRANSFORM_DIR_FROM_REFERENCE),
        )
        sizes_of_all[view.getName()] = sum(map(size_of, sides))
    for look in config.getLooks():
        sizes_of_all[look.getName()] = size_of(look.getTransform()) + size_of(look.getInverseTransform())
    for name, size in sizes_of_all.items():
        if size > _MAX_TRANSFORMS:
            raise InputError(f"{name!r:.60} has more than {_MAX_TRANSFORMS} transforms")
