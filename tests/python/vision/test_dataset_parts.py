"""Data sets in parts: the bytes of one process, whatever the processes and their order, and files of render farms."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import tarfile
import time
from dataclasses import replace
from pathlib import Path

import pytest
import realcam as rc
from realcam.dataset import Recipe, make, samples
from realcam.dataset.shards import ENGINE_FILE, DatasetFolder

from ..programs import PYTHON, Command
from .test_dataset import Here

pytestmark = pytest.mark.picture_files

RECIPE = Recipe(count=5, size=(48, 32), lenses=("tessar-50mm",), objects=(1, 2), spp=1, shard_size=2, labels=("mask",))
TEXT = """
format = 1
count = 5
size = [48, 32]
lenses = ["tessar-50mm"]
objects = [1, 2]
spp = 1
shard_size = 2
labels = ["mask"]
"""


def contents(folder: Path) -> dict[str, bytes]:
    """Returns the files that the user gets."""
    return {path.name: path.read_bytes() for path in [*folder.glob("shard-*.tar"), *folder.glob("dataset.json")]}


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    folder = tmp_path_factory.mktemp("whole") / "out"
    make(RECIPE, folder, Here(), device="cpu")
    return contents(folder)


@pytest.mark.parametrize("parts", [2, 3, 7])
def test_parts_have_the_bytes_of_one_process(made: dict[str, bytes], tmp_path: Path, parts: int) -> None:
    """Parts may end within a shard, or be empty; the last one to end writes the index."""
    for k in range(parts, 0, -1):
        index = make(RECIPE, tmp_path, part=(k, parts), threads=k % 3, device="cpu")
        assert index.exists() == (len(list(tmp_path.glob("shard-*.tar"))) == 3)
        assert contents(tmp_path).items() <= made.items()
    assert contents(tmp_path) == made
    assert not list((tmp_path / "samples").iterdir())


def test_a_part_makes_its_own_pictures_only(tmp_path: Path) -> None:
    shares: list[float] = []
    make(RECIPE, tmp_path, part=(2, 3), device="cpu", progress=shares.append)
    # Pictures 1 and 2 of 5, which complete no shard of two.
    assert sorted(path.name for path in (tmp_path / "samples").iterdir()) == ["000001.tar", "000002.tar"]
    assert shares == [0.0, 0.5, 1.0]
    before = {path: path.stat().st_mtime_ns for path in (tmp_path / "samples").iterdir()}
    make(RECIPE, tmp_path, part=(2, 3), device="cpu")
    assert {path: path.stat().st_mtime_ns for path in before} == before


@pytest.mark.parametrize("part", [(0, 2), (3, 2), (1, 10**6)])
def test_what_is_no_part_is_refused(tmp_path: Path, part: tuple[int, int]) -> None:
    with pytest.raises(rc.InputError, match="expected a part from 1 to the number of parts"):
        make(RECIPE, tmp_path, part=part)
    with pytest.raises(rc.InputError, match="an executor excludes it"):
        make(RECIPE, tmp_path, Here(), part=(1, 2))


def test_processes_that_write_the_same_shard(
    made: dict[str, bytes], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Another process finishes the shard, and removes its samples, while this one is reading them."""
    for k in (1, 2):
        make(replace(RECIPE, count=2), tmp_path / str(k), part=(k, 2), device="cpu")
    folder = tmp_path / "1"
    shutil.copytree(tmp_path / "2" / "samples", folder / "samples", dirs_exist_ok=True)
    own, content = DatasetFolder(folder, replace(RECIPE, count=2)), DatasetFolder._shard_content

    def late(self: DatasetFolder, shard: int) -> bytes:
        monkeypatch.setattr(DatasetFolder, "_shard_content", content)
        assert DatasetFolder(folder, self.recipe).write_shard(shard)
        return content(self, shard)

    (folder / "shard-000000.tar").unlink(missing_ok=True)
    monkeypatch.setattr(DatasetFolder, "_shard_content", late)
    assert own.write_shard(0)
    assert contents(folder)["shard-000000.tar"] == made["shard-000000.tar"]


def test_what_a_kill_leaves_beside_a_shard_goes(made: dict[str, bytes], tmp_path: Path) -> None:
    """A process may be killed between writing a shard and removing its samples."""
    make(RECIPE, tmp_path, Here(), device="cpu")
    with tarfile.open(tmp_path / "shard-000000.tar") as tar:
        files = {name: tar.extractfile(name) for name in tar.getnames() if name.startswith("000001.")}
        contents_of_one = {name.partition(".")[2]: file.read() for name, file in files.items() if file}
    DatasetFolder(tmp_path, RECIPE).write_sample(1, contents_of_one)
    make(RECIPE, tmp_path, part=(1, 2), device="cpu")
    assert contents(tmp_path) == made
    assert not list((tmp_path / "samples").iterdir())


def test_a_shard_that_lost_its_end_is_made_whole(made: dict[str, bytes], tmp_path: Path) -> None:
    """A copy that was interrupted between two pictures is a valid archive."""
    make(RECIPE, tmp_path, Here(), device="cpu")
    path = tmp_path / "shard-000001.tar"
    with tarfile.open(path) as tar:
        second = tar.getmember("000003.png").offset
    path.write_bytes(path.read_bytes()[:second])
    make(RECIPE, tmp_path, part=(2, 2), device="cpu")
    assert contents(tmp_path) == made
    path.write_bytes(path.read_bytes()[: second - 1000])
    with pytest.raises(rc.InputError, match=r"shard-000001.tar: .*; remove it, and it is made again") as error:
        make(RECIPE, tmp_path, part=(2, 2), device="cpu")
    assert "\n" not in str(error.value)


@pytest.mark.slow
def test_a_kill_of_parts_leaves_whole_files_and_they_go_on(made: dict[str, bytes], tmp_path: Path) -> None:
    (tmp_path / "recipe.toml").write_text(TEXT)
    out = tmp_path / "out"
    command = [*PYTHON, "dataset", str(tmp_path / "recipe.toml"), "-o", str(out), "--device", "cpu", "--part"]
    killed = subprocess.Popen([*command, "1/2"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    deadline = time.monotonic() + 120
    while not list(out.glob("samples/0*.tar")) and killed.poll() is None and time.monotonic() < deadline:
        time.sleep(0.002)
    os.kill(killed.pid, signal.SIGKILL)
    killed.wait()
    for path in [*out.glob("samples/0*.tar"), *out.glob("shard-*.tar")]:
        with tarfile.open(path) as tar:
            assert tar.getnames()
    running = [subprocess.Popen([*command, part], stdout=subprocess.DEVNULL) for part in ("1/2", "2/2")]
    assert [program.wait(timeout=120) for program in running] == [0, 0]
    assert contents(out) == made


def test_another_engine_is_refused_in_one_line(tmp_path: Path) -> None:
    """Its pictures would have other bits."""
    make(replace(RECIPE, count=1), tmp_path, Here(), device="cpu")
    file = tmp_path / ENGINE_FILE
    stored = json.loads(file.read_text())
    assert stored["device"] == "CPU"
    for change, message in (
        ({"embree": "1.0"}, r"picture 1: .*: its pictures require realcam .*Embree 1.0.*; this process has realcam"),
        ({"embree": 7}, "engine.json: .*damaged"),
        ({"realcam": "x\ny"}, "engine.json: .*damaged"),
        ({"more": 1}, "engine.json: .*damaged"),
    ):
        file.write_text(json.dumps(stored | change))
        with pytest.raises(rc.InputError, match=message) as error:
            make(RECIPE, tmp_path, part=(1, 1), device="cpu")
        assert "\n" not in str(error.value)
    file.unlink()
    file.symlink_to("/dev/zero")
    with pytest.raises(rc.InputError, match=r"engine.json: a regular file is expected"):
        make(RECIPE, tmp_path, part=(1, 1))


@pytest.mark.slow
def test_a_scheduler_makes_the_bytes_of_one_process(made: dict[str, bytes], tmp_path: Path) -> None:
    pytest.importorskip("distributed", reason="realcam[cluster] is missing")
    from realcam.job.clusters import dask_executor

    with dask_executor(workers=2) as executor:
        make(RECIPE, tmp_path, executor, device="cpu")
    assert contents(tmp_path) == made


@pytest.mark.slow
def test_scripts_of_farms_make_the_data_set(
    made: dict[str, bytes], tmp_path: Path, command: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    """In another current folder than that of the command which wrote them."""
    home = tmp_path / "at home"
    home.mkdir()
    monkeypatch.chdir(home)
    Path("recipe.toml").write_text(TEXT.replace("count = 5", "count = 3"))
    words = ("dataset", "recipe.toml", "-o", "out", "--count", "5", "--device", "cpu", "--tasks", "2")
    files = ("--sbatch", "night.sbatch", "--qsub", "night.qsub", "--openjd", "night.json")
    written = command(*words, *files)
    assert (written.returncode, written.stderr) == (0, "")
    assert written.stdout == "wrote night.sbatch\nwrote night.qsub\nwrote night.json\n"
    assert not Path("out").exists()
    programs = tmp_path / "bin"
    programs.mkdir()
    (programs / "realcam").write_text(f'#!/bin/sh\nexec {sys.executable} -m realcam "$@"\n')
    (programs / "realcam").chmod(0o755)
    place = {**os.environ, "PATH": f"{programs}:{os.environ['PATH']}"}
    for script, variable, task in (
        ("night.sbatch", "SLURM_ARRAY_TASK_ID", "2"),
        ("night.qsub", "PBS_ARRAY_INDEX", "1"),
    ):
        done = subprocess.run(
            ["bash", home / script], env={**place, variable: task}, cwd=tmp_path, capture_output=True, text=True
        )
        assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    assert contents(home / "out") == made
    template = json.loads(Path("night.json").read_text())
    assert [step["name"] for step in template["steps"]] == ["Work", "Finish"]
    paths = {f"{{{{Param.{p['name']}}}}}": p["default"] for p in template["parameterDefinitions"]}
    (home / "out" / "dataset.json").unlink()
    arguments = template["steps"][1]["script"]["actions"]["onRun"]["args"]
    subprocess.run([programs / "realcam", *(paths.get(word, word) for word in arguments)], check=True)
    assert contents(home / "out") == made


@pytest.mark.parametrize("target", ["recipe.toml", "models/box.obj", "link", "out/night.sbatch"])
@pytest.mark.parametrize("option", ["--sbatch", "--openjd"])
def test_files_of_farms_replace_no_input(
    tmp_path: Path, command: Command, monkeypatch: pytest.MonkeyPatch, option: str, target: str
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("models").mkdir()
    Path("out").mkdir()
    Path("models/box.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    Path("link").symlink_to("models/box.obj")
    Path("recipe.toml").write_text(f"{TEXT}[models]\nbox = 'models/box.obj'\n")
    before = {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}
    refused = command("dataset", "recipe.toml", "-o", "out", option, target)
    assert (refused.returncode, refused.stdout, refused.stderr.count("\n")) == (2, "", 1)
    assert "is also an input of this command" in refused.stderr or "lies in the folder out" in refused.stderr
    assert {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()} == before


@pytest.mark.parametrize(
    ("words", "why"),
    [
        (("--part", "9/8"), "expected K/N, 1/8 to 8/8"),
        (("--part", "1/2", "--workers", "2"), "--part is for one process"),
        (("--part", "1/2", "--scheduler", "nowhere.json"), "--part is for one process"),
        (("--scheduler", "nowhere.json"), "nowhere.json: no Dask scheduler answers there"),
        (("--sbatch", "a", "--openjd", "a"), "expected one file each for --sbatch and --openjd"),
    ],
)
def test_mistakes_on_the_command_line_have_one_line(
    tmp_path: Path, command: Command, monkeypatch: pytest.MonkeyPatch, words: tuple[str, ...], why: str
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("recipe.toml").write_text(TEXT)
    refused = command("dataset", "recipe.toml", "-o", "out", *words)
    assert (refused.returncode, refused.stdout, refused.stderr.count("\n")) == (2, "", 1)
    assert why in refused.stderr
    assert not list(Path().glob("out/samples/*.tar"))


def test_a_part_of_a_command_says_what_is_done(
    tmp_path: Path, command: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("recipe.toml").write_text(TEXT)
    words = ("dataset", "recipe.toml", "-o", "out", "--device", "cpu")
    first = command(*words, "--part", "1/2")
    assert (first.returncode, first.stdout) == (0, "out: part 1/2 of 5 pictures is done\n")
    assert json.loads(command(*words, "--part", "1/2", "--json").stdout) == {"index": None, "pictures": 5}
    assert command(*words, "--part", "2/2").stdout == "wrote out/dataset.json\n"
    assert len(list(samples("out"))) == 5
