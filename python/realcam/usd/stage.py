"""Opening of stages: composition, variants, and limits on a stranger's file."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from pxr import Ar, Sdf, Tf, Usd, UsdGeom, UsdUtils

from .._core import InputError, SceneFileError, _did_you_mean
from ..files import record_input
from .notices import Notices

MAX_LAYERS = 10_000
MAX_PRIMS = 2_000_000  # with those of instances
MAX_DEPTH = 256  # of the hierarchy, with nested point instancers
MAX_BYTES = 8 << 30  # of all layers

_SELECTION = re.compile(r"(?P<prim>/[^{}]*)\{(?P<set>[^{}=]+)=(?P<variant>[^{}=]*)\}")


class Diagnostics:
    """Collects usd-core's warnings, such as a missing reference, which it would otherwise print."""

    def __init__(self) -> None:
        self._delegate = UsdUtils.CoalescingDiagnosticDelegate()

    def texts(self) -> list[str]:
        """Returns the warnings, without the places in memory that usd-core adds to them."""
        items = self._delegate.TakeCoalescedDiagnostics()
        texts = [" ".join(part.commentary.split()) for item in items for part in item.unsharedItems]
        if any(".mtlx" in text for text in texts):
            texts = [text for text in texts if ".mtlx" not in text]
            texts.append("MaterialX files (.mtlx) are left out, which usd-core cannot read")
        return [re.sub(r" \([^()]* on stage @.*\)$", "", text)[:300] for text in texts]


@dataclass
class OpenStage:
    """A composed stage.

    path: its file, for messages. time: time code at which static values are read, the first of the stage.
    """

    path: str
    stage: Usd.Stage
    diagnostics: Diagnostics | None = None
    notices: Notices = field(default_factory=Notices)
    _prim_count: int = 0

    @property
    def time(self) -> Usd.TimeCode:
        return Usd.TimeCode(self.stage.GetStartTimeCode())

    @property
    def metres_per_unit(self) -> float:
        """Raises SceneFileError if the stage's value is not positive."""
        value: float = UsdGeom.GetStageMetersPerUnit(self.stage)
        if not 0 < value < float("inf"):
            raise SceneFileError(f"{self.path}: metersPerUnit: expected a positive number; found {value:g}")
        return value

    def take_diagnostics(self) -> None:
        """Adds what usd-core has warned of since the last call to the notices."""
        for text in self.diagnostics.texts() if self.diagnostics else []:
            self.notices.add("usd-core", text)

    def seconds(self, time_code: float) -> float:
        """Returns the time of a time code in seconds; the stage begins at 0."""
        return float((time_code - self.stage.GetStartTimeCode()) / self.stage.GetTimeCodesPerSecond())

    def count(self, prim: Usd.Prim, depth: int) -> None:
        """Counts a prim that is read, at a depth of the hierarchy. Raises SceneFileError beyond the limits."""
        self._prim_count += 1
        if self._prim_count > MAX_PRIMS:
            raise SceneFileError(f"{self.path}: has more than {MAX_PRIMS} prims and instances")
        if depth > MAX_DEPTH:
            raise self.fail(prim, f"is more than {MAX_DEPTH} prims deep")

    def fail(self, prim: object, message: str) -> SceneFileError:
        """Returns an error that names the file and a prim."""
        where = prim.GetPath() if isinstance(prim, Usd.Prim) else prim
        return SceneFileError(f"{self.path}: {where}: {message}")


def open_stage(path: str, variants: Sequence[str] = ()) -> OpenStage:
    """Opens a stage with all payloads, and selects variants, such as "/Chair{color=red}". Raises SceneFileError, and
    InputError for a selection that the stage does not have."""
    _check_file(path)
    diagnostics = Diagnostics()
    try:
        stage = Usd.Stage.Open(str(Path(path).absolute()), Usd.Stage.LoadAll)
        if stage is None:
            raise SceneFileError(f"{path}: is not a USD stage")
        opened = OpenStage(path, stage, diagnostics)
        for selection in variants:
            _select(opened, selection)
    except Tf.ErrorException as error:
        raise SceneFileError(f"{path}: is not a valid USD stage: {_first_message(error)}") from None
    opened.take_diagnostics()
    if not stage.GetTimeCodesPerSecond() > 0:
        raise SceneFileError(
            f"{path}: timeCodesPerSecond: expected a positive number; found {stage.GetTimeCodesPerSecond():g}"
        )
    _check_layers(opened)
    return opened


def children_of(prim: Usd.Prim) -> list[Usd.Prim]:
    """Returns the loaded, active and defined children of a prim, also those of an instance."""
    return list(prim.GetFilteredChildren(Usd.TraverseInstanceProxies(Usd.PrimDefaultPredicate)))


def _check_file(path: str) -> None:
    if Path(path).stat().st_size > MAX_BYTES:
        raise SceneFileError(f"{path}: is larger than {MAX_BYTES >> 30} GiB")


def _check_layers(opened: OpenStage) -> None:
    layers = opened.stage.GetUsedLayers()
    if len(layers) > MAX_LAYERS:
        raise SceneFileError(f"{opened.path}: has {len(layers)} layers; at most {MAX_LAYERS} are read")
    outermost = {Ar.SplitPackageRelativePathOuter(layer.realPath)[0] for layer in layers if layer.realPath}
    files = [file for file in map(Path, outermost) if file.is_file()]
    if sum(file.stat().st_size for file in files) > MAX_BYTES:
        raise SceneFileError(f"{opened.path}: its layers are larger than {MAX_BYTES >> 30} GiB")
    for file in files:
        record_input(file)


def _select(opened: OpenStage, selection: str) -> None:
    """Selects a variant in the session layer."""
    match = _SELECTION.fullmatch(selection)
    if not match or not Sdf.Path.IsValidPathString(match["prim"]):
        raise InputError(f'variants: expected a selection such as "/Chair{{color=red}}"; found "{selection:.80}"')
    prim = opened.stage.GetPrimAtPath(match["prim"])
    if not prim:
        raise InputError(f'{opened.path}: variants: there is no prim "{match["prim"]}"')
    sets = prim.GetVariantSets()
    if match["set"] not in sets.GetNames():
        near = _did_you_mean(match["set"], sets.GetNames())
        raise InputError(f'{opened.path}: {match["prim"]}: has no variant set "{match["set"]}"{near}')
    variants = sets.GetVariantSet(match["set"])
    if match["variant"] not in variants.GetVariantNames():
        expected = ", ".join(variants.GetVariantNames())
        raise InputError(
            f'{opened.path}: {match["prim"]}: variant set "{match["set"]}": expected {expected}; '
            f'found "{match["variant"]}"'
        )
    with Usd.EditContext(opened.stage, opened.stage.GetSessionLayer()):
        variants.SetVariantSelection(match["variant"])


def _first_message(error: Tf.ErrorException) -> str:
    return " ".join(str(error.args[0].commentary).split())[:300] if error.args else type(error).__name__
