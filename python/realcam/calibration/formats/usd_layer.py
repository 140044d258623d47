"""Camera attributes of USD files in Pixar's binary format, by the package usd-core."""

from __future__ import annotations

from typing import Any

from ..._core import InputError
from ..files.document import Document

BINARY = b"PXR-USDC"  # the first bytes of such a file


def layer_prims(document: Document) -> dict[str, dict[str, object]]:
    """Returns the attributes of each Camera prim by its name, as usd_text.camera_prims.

    Only the file itself is read: layers that it refers to are not opened. Raises InputError without usd-core.
    """
    try:
        from pxr import Sdf, Tf
    except ImportError:
        raise InputError("reading binary USD files needs usd-core; pip install 'realcam[usd]'") from None
    try:
        layer = Sdf.Layer.OpenAsAnonymous(str(document.path))
    except Tf.ErrorException:
        layer = None
    if layer is None:
        document.fail("is a damaged USD file")
    found: dict[str, dict[str, object]] = {}

    def visit(path: Any) -> None:
        spec = layer.GetPrimAtPath(path)
        if spec is not None and spec.typeName == "Camera":
            name = spec.name if spec.name not in found else str(path)
            found[name] = {attribute.name: _value(attribute.default) for attribute in spec.attributes}

    layer.Traverse("/", visit)
    return found


def _value(value: Any) -> object:
    """Returns a number or a text; tuples as lists, and assets as their paths."""
    if isinstance(value, int | float | str):
        return value
    if hasattr(value, "path"):
        return str(value.path)
    return list(value) if hasattr(value, "__len__") else str(value)
