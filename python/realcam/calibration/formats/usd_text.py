"""A tolerant reader of camera attributes in USD text (.usda): lines "type name = value" inside "def Camera" prims."""

from __future__ import annotations

import re

PRIM = re.compile(r'^\s*(?:def|over|class)\s+(\w*)\s*"([^"]*)"')
ATTRIBUTE = re.compile(r"^\s*(?:custom\s+|uniform\s+)*([\w\[\]]+)\s+([\w:]+)\s*=\s*([^\n]*?)\s*$")
TEXT = re.compile(r'"([^"]*)"|\'([^\']*)\'|@([^@]*)@')


def camera_prims(text: str) -> dict[str, dict[str, object]]:
    """Returns the attributes of each Camera prim by its name: numbers and tuples as texts, the others as texts."""
    found: dict[str, dict[str, object]] = {}
    current: dict[str, object] = {}
    for line in text.splitlines():
        prim = PRIM.match(line)
        if prim:
            # Attributes of other prims go into a mapping that is dropped.
            current = _new_camera(found, prim[2]) if prim[1] == "Camera" else {}
            continue
        attribute = ATTRIBUTE.match(line)
        if attribute:
            current[attribute[2]] = _value(attribute[3])
    return found


def _new_camera(found: dict[str, dict[str, object]], name: str) -> dict[str, object]:
    number = 2
    unique = name
    while unique in found:
        unique, number = f"{name} {number}", number + 1
    found[unique] = {}
    return found[unique]


def _value(text: str) -> str:
    quoted = TEXT.match(text)
    if quoted:
        return str(next(part for part in quoted.groups() if part is not None))
    return re.sub(r"[()\[\]]", " ", text).strip()
