"""The other programs, and which of them are installed here."""

from __future__ import annotations

from importlib import metadata
from types import ModuleType

from . import optiland_peer, ray_optics_peer

PEERS: dict[str, ModuleType] = {peer.NAME: peer for peer in (optiland_peer, ray_optics_peer)}


def version(name: str) -> str | None:
    """Returns the installed version of the peer, or None if it is not installed."""
    try:
        return metadata.version(PEERS[name].PACKAGE)
    except metadata.PackageNotFoundError:
        return None
