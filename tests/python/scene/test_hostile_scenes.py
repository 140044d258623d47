"""Scene files that are wrong, endless or named strangely, and Ctrl-C while one is read: Python's share of it.

What the files themselves may hold is tested in C++ (tests/cpp/io/*/test_hostile_*.cpp).
"""

from __future__ import annotations

import os
import signal
import time
from pathlib import Path

import numpy as np
import pytest
import realcam as rc

TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\n"


def test_names_that_are_no_utf_8(tmp_path: Path) -> None:
    """Names in files are read with U+FFFD for invalid bytes; a file's own name is accepted in Python's forms."""
    (tmp_path / "l.mtl").write_bytes(b"newmtl gr\xfcn\nd 0.5\nmap_Kd gr\xfcn.png\n")
    path = os.fsencode(tmp_path) + b"/\xff.obj"
    Path(os.fsdecode(path)).write_bytes(b"mtllib l.mtl\nusemtl gr\xfcn\n" + TRIANGLE.encode() + b"o gr\xfcn\nf 1 2 3\n")
    for name in (path, os.fsdecode(path), Path(os.fsdecode(path))):
        scene = rc.Scene.load(name, objects=["gr\ufffdn"])
        assert [instance for instance, _ in scene.instances] == ["gr\ufffdn"]
        assert any("texture gr\ufffdn.png" in warning for warning in scene.warnings)
    with pytest.raises(rc.SceneFileError, match="no such file"):
        rc.Scene.load(os.fsencode(tmp_path) + b"/\xfe.obj")


def test_what_is_quoted_is_short(tmp_path: Path) -> None:
    path = tmp_path / "long.obj"
    path.write_text(TRIANGLE + "f 1 2 " + "x" * 100_000 + "\n")
    with pytest.raises(rc.SceneFileError) as caught:
        rc.Scene.load(path)
    assert len(str(caught.value)) < len(str(path)) + 200
    start = time.perf_counter()
    path.write_text(TRIANGLE + "o car\nf 1 2 3\n")
    with pytest.raises(rc.SceneFileError) as caught:
        rc.Scene.load(path, objects=["x" * 1_000_000])
    assert len(str(caught.value)) < len(str(path)) + 200
    assert time.perf_counter() - start < 5


def write_ply(path: Path, columns: int) -> None:
    """A sheet of two triangles for each cell of a grid, binary."""
    y, x = np.mgrid[0:columns, 0:columns].astype("<f4")
    vertices = np.stack([x, y, np.sin(x + 0.3 * y)], axis=-1)
    first = (np.arange(columns - 1)[:, None] * columns + np.arange(columns - 1)).ravel()
    corners = np.concatenate(
        [first[:, None] + np.array(offsets) for offsets in ([0, 1, columns], [1, columns + 1, columns])]
    )
    faces = np.zeros(len(corners), dtype=[("count", "u1"), ("corners", "<i4", 3)])
    faces["count"], faces["corners"] = 3, corners
    header = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {columns**2}\nproperty float x\nproperty float y\n"
        f"property float z\nelement face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    path.write_bytes(header.encode() + vertices.tobytes() + faces.tobytes())


def test_ctrl_c_ends_the_reading(tmp_path: Path) -> None:
    """A signal that comes while a file is read is handled there, not after it."""
    path = tmp_path / "sheet.ply"
    write_ply(path, 700)  # a million triangles, some half a second
    start = time.perf_counter()
    rc.Scene.load(path)
    whole = time.perf_counter() - start

    def interrupt(*_: object) -> None:
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, interrupt)
    try:
        for share in (0.05, 0.3, 0.6):
            start = time.perf_counter()
            with pytest.raises(KeyboardInterrupt):
                signal.setitimer(signal.ITIMER_REAL, share * whole)
                rc.Scene.load(path)
            # The reader checks for signals every 0.02 s; the remaining time allows for a busy machine.
            assert time.perf_counter() - start < share * whole + 1
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
