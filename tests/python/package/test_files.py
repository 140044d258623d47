"""Files that are written as a whole."""

from __future__ import annotations

import os
import stat
import subprocess
import sys
import threading
from pathlib import Path

import pytest
import realcam as rc
from realcam.files import write_whole


def mode(path: Path) -> int:
    return stat.S_IMODE(path.stat().st_mode)


def test_a_file_that_is_replaced_keeps_its_mode(tmp_path: Path) -> None:
    for expected in (0o600, 0o640, 0o755):
        path = tmp_path / f"{expected:o}"
        path.write_text("before")
        path.chmod(expected)
        assert write_whole(path, b"after")
        assert path.read_bytes() == b"after"
        assert mode(path) == expected


def test_a_new_file_has_the_mode_of_the_umask(tmp_path: Path) -> None:
    script = (
        f"import os; from realcam.files import write_whole; os.umask(0o027); write_whole({str(tmp_path / 'x')!r}, b'')"
    )
    subprocess.run([sys.executable, "-c", script], check=True)
    assert mode(tmp_path / "x") == 0o640


def test_the_umask_of_other_threads_stays(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It is the process's: whoever sets it for a moment gives other threads' files the wrong mode."""
    monkeypatch.setattr(os, "umask", lambda mask: pytest.fail("the umask was set"))
    assert write_whole(tmp_path / "x", b"")


def test_a_name_that_is_taken_stays(tmp_path: Path) -> None:
    path = tmp_path / "x"
    assert write_whole(path, b"mine", replaces=False)
    assert not write_whole(path, b"another", replaces=False)
    assert path.read_bytes() == b"mine"
    assert [file.name for file in tmp_path.iterdir()] == ["x"]


def test_of_many_that_want_a_name_one_gets_it(tmp_path: Path) -> None:
    path, got = tmp_path / "x", []
    begin = threading.Barrier(16)

    def write(k: int) -> None:
        begin.wait()
        if write_whole(path, str(k).encode() * 10_000, replaces=False):
            got.append(k)

    threads = [threading.Thread(target=write, args=(k,)) for k in range(16)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(got) == 1
    assert path.read_bytes() == str(got[0]).encode() * 10_000


def test_without_links_a_name_is_taken_all_the_same(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def no_links(*_: object) -> None:
        raise PermissionError("a file system without links")

    monkeypatch.setattr(os, "link", no_links)
    test_of_many_that_want_a_name_one_gets_it(tmp_path)
    assert not write_whole(tmp_path / "x", b"another", replaces=False)


def test_what_is_no_file_stays(tmp_path: Path) -> None:
    (tmp_path / "folder").mkdir()
    os.mkfifo(tmp_path / "pipe")
    for name in ("folder", "pipe", "nowhere/x"):
        with pytest.raises(rc.ImageFileError, match=name):
            write_whole(tmp_path / name, b"")
    assert stat.S_ISFIFO((tmp_path / "pipe").stat().st_mode)
    assert sorted(file.name for file in tmp_path.iterdir()) == ["folder", "pipe"]
