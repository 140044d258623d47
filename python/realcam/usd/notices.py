"""Messages about content of a stage that is left out or read in another way."""

from __future__ import annotations

from collections import defaultdict

_MAX_PATHS = 3  # prim paths listed in a notice


class Notices:
    """Collects notices; prims with the same notice share a line."""

    def __init__(self) -> None:
        self._paths: dict[str, list[str]] = defaultdict(list)

    def add(self, prim_path: object, text: str) -> None:
        """Adds a notice about a prim."""
        paths = self._paths[text]
        if str(prim_path) not in paths[-1:]:
            paths.append(str(prim_path))

    def lines(self) -> list[str]:
        """Returns a line for each notice: prim paths, then the text."""
        return [f"{_listed(paths)}: {text}" for text, paths in self._paths.items()]


def _listed(paths: list[str]) -> str:
    shown = ", ".join(paths[:_MAX_PATHS])
    return shown if len(paths) <= _MAX_PATHS else f"{shown} and {len(paths) - _MAX_PATHS} more"
