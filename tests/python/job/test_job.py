"""rc.Job: the same bits as one machine, whatever becomes of processes, disks and files on the way."""

from __future__ import annotations

import concurrent.futures
import io
import json
import multiprocessing
import os
import random
import resource
import shutil
import signal
import time
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import realcam as rc
from realcam import archive
from realcam.job.folder import FORMAT, JobFolder
from realcam.job.units import Unit
from realcam.job.worker import Worker

from ..programs import Command
from .job_programs import picture, run, shot, started, units

TILE = (32, 32)


def made(folder: Path, **shots: rc.Shot) -> rc.Job:
    return rc.Job.make(folder, shots or {"lamp": shot()}, device="cpu", tile=TILE)


def test_several_processes_make_the_picture_of_one(tmp_path: Path) -> None:
    """A number of samples and a wanted noise, whose rounds are decided by the sum of all units."""
    shots = {"counted": shot(), "noise": shot("auto", noise_codes=1.5, max_spp=600)}
    job = made(tmp_path / "job", **shots)
    shares: list[float] = []
    context = multiprocessing.get_context("spawn")
    with concurrent.futures.ProcessPoolExecutor(2, context) as executor:
        job.work(executor, threads=1, progress=shares.append)
    assert shares == sorted(shares)
    assert shares[-1] == 1
    for name, each in shots.items():
        assert job.image(name) == picture(each)
        assert job.image(name).spp >= 8
    status = job.status()
    assert status.is_done
    assert (status.units_done, status.shots_done) == (status.units_known, 2)
    assert len(list((tmp_path / "job" / "rounds").rglob("*.npz"))) > 3  # the noise took several


def test_colours_that_end_in_other_pixels(tmp_path: Path) -> None:
    """Dispersion shares samples among the pixels of a 32-pixel tile. Units consist of whole tiles, and the rounds of
    spp="auto" share no samples."""
    with_colours = {"effects": ("dispersion",), "layers": ()}
    shots = {"counted": shot(40, **with_colours), "noise": shot("auto", noise_codes=4, max_spp=64, **with_colours)}
    job = made(tmp_path / "job", **shots)
    job.work()
    for name, each in shots.items():
        assert job.image(name) == picture(each)


def test_threads_are_processes_enough(tmp_path: Path) -> None:
    job = made(tmp_path / "job", lamp=shot(40))
    with concurrent.futures.ThreadPoolExecutor(3) as executor:
        job.work(executor, threads=1)
    assert job.image() == picture(shot(40))


@pytest.mark.slow
def test_processes_that_are_killed_lose_only_what_they_have_in_hand(tmp_path: Path) -> None:
    """Three processes; one at a time is killed at a random moment and started again."""
    folder = tmp_path / "job"
    job = made(folder, lamp=shot(400))
    moment = random.Random(5)
    workers = [started("work", folder, "--here", "--quiet", "--threads", "1") for _ in range(3)]
    kept: dict[str, tuple[int, int]] = {}
    for _ in range(3):
        time.sleep(moment.uniform(0.3, 1.2))
        victim = moment.randrange(3)
        kept |= units(folder)
        workers[victim].send_signal(signal.SIGKILL)
        workers[victim].wait()
        workers[victim] = started("work", folder, "--here", "--quiet", "--threads", "1")
    for worker in workers:
        _, errors = worker.communicate(timeout=120)
        assert (worker.returncode, errors) == (0, "")
    assert kept.items() <= units(folder).items()  # nothing that was done was done again
    assert job.image() == picture(shot(400))


def test_the_first_of_two_processes_that_render_a_unit_writes_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "job"
    made(folder, lamp=shot(4))
    first, second = (Worker(JobFolder.open(folder)) for _ in range(2))
    expose, written = second._expose, list[dict[str, tuple[int, int]]]()

    def expose_slowly(unit: Unit) -> object:
        part = expose(unit)
        first.run(unit)
        written.append(units(folder))
        return part

    monkeypatch.setattr(second, "_expose", expose_slowly)
    missing = second.missing(0)
    assert missing is not None
    second.run(missing[1][0])
    assert [units(folder)] == written
    assert not list(folder.rglob(".realcam-*"))


@pytest.mark.slow
def test_a_full_disk_stops_work_in_one_line_and_loses_nothing(tmp_path: Path) -> None:
    """File sizes are limited to less than a unit: as on a full disk, a write ends before all data is written."""
    folder = tmp_path / "job"
    job = made(folder)

    def limit(size: int) -> Callable[[], None]:
        return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))

    code, output, errors = run("work", folder, "--here", preexec_fn=limit(20_000))
    assert code == 2
    assert output == ""
    assert errors.startswith(f"realcam: error: {folder}/units/00000/000-")
    assert errors.endswith("cannot be written: File too large\n")
    assert errors.count("\n") == 1
    assert [path for path in (folder / "units").rglob("*") if path.is_file()] == []
    assert run("work", folder, "--here", "--quiet") == (0, "", "")
    assert job.image() == picture(shot())


def test_another_version_is_refused_by_its_name(tmp_path: Path, command: Command) -> None:
    folder = tmp_path / "job"
    made(folder)
    about = json.loads((folder / "job.json").read_text())
    about["engine"]["realcam"] = "9.8.7"
    (folder / "job.json").write_text(json.dumps(about))
    refused = command("job", "work", folder, "--here")
    assert refused.returncode == 2
    made_by_another = (
        f"{folder}: this job was made by realcam 9.8.7, and this is realcam {rc.__version__}; all machines"
    )
    assert refused.stderr.startswith(f"realcam: error: {made_by_another}")
    about["format"] += 1
    (folder / "job.json").write_text(json.dumps(about))
    with pytest.raises(rc.InputError, match=f"its format is {FORMAT + 1}; this realcam reads {FORMAT}"):
        rc.Job.load(folder)


def test_a_machine_that_computes_other_bits_is_refused(tmp_path: Path) -> None:
    folder = tmp_path / "job"
    made(folder)
    about = json.loads((folder / "job.json").read_text())
    for key, other, why in (
        (
            "instruction_set",
            "v2",
            "the job requires realcam .*x86-64-v2; this process has .*, whose samples would differ",
        ),
        ("embree", "1.0", "the job requires realcam .*Embree 1.0"),
    ):
        changed = {**about, "engine": {**about["engine"], key: other}}
        (folder / "job.json").write_text(json.dumps(changed))
        with pytest.raises(rc.InputError, match=why):
            rc.Job.load(folder).work()
    changed = {**about, "probes": dict.fromkeys(about["probes"], "0" * 64)}
    (folder / "job.json").write_text(json.dumps(changed))
    with pytest.raises(
        rc.InputError, match="the samples of this machine differ from those of the one that made the job"
    ):
        rc.Job.load(folder).work()
    assert units(folder) == {}
    assert "REALCAM_INSTRUCTION_SET" not in os.environ


def test_what_was_deleted_or_damaged_is_done_again(tmp_path: Path, command: Command) -> None:
    folder = tmp_path / "job"
    noisy = shot("auto", noise_codes=1.5, max_spp=600)
    job = made(folder, lamp=noisy)
    job.work()
    before = job.image()
    done = sorted((folder / "units").rglob("*.npz"))
    done[3].unlink()
    done[5].write_bytes(done[5].read_bytes()[:1000])
    status = job.status()
    assert (status.units_known - status.units_done, status.is_done) == (2, False)
    assert status.damaged == (f"00000/{done[5].name}",)
    told = command("job", "status", folder)
    assert told.returncode == 0
    assert f", 1 damaged (00000/{done[5].name}), which realcam job work will repeat" in told.stdout
    with pytest.raises(rc.InputError, match=r"2 of .* units are missing; run realcam job work to render them"):
        job.image()
    (folder / "rounds" / "00000" / "002.npz").write_bytes(b"nothing")
    job.work()
    assert job.image() == before == picture(noisy)
    # Damage that only the final sum over all units detects is reported with the command that repairs it.
    content = bytearray(done[-1].read_bytes())
    content[len(content) // 2] ^= 1
    done[-1].write_bytes(content)
    with pytest.raises(rc.InputError, match=r"damaged: .* run realcam job work .* to render its samples again"):
        job.image()
    job.work()
    assert job.image() == before


@pytest.mark.parametrize(
    ("lost", "why"),
    [
        ("job.json", "is not the folder of a job: it has no job.json"),
        ("shots/00000.npz", "there is no such file"),
        ("scenes", "there is no such file"),
    ],
)
def test_a_folder_that_is_half_deleted_says_what_is_missing(tmp_path: Path, lost: str, why: str) -> None:
    folder = tmp_path / "job"
    made(folder, lamp=shot(4))
    (folder / lost).rename(tmp_path / "lost")
    with pytest.raises(rc.InputError, match=why) as error:
        rc.Job.load(folder).work()
    assert "\n" not in str(error.value)


def changed(folder: Path, **entries: object) -> None:
    """Overwrites entries of job.json; those named after a shot's field are written into its first shot."""
    about = json.loads((folder / "job.json").read_text())
    for key, value in entries.items():
        (about if key in about else about["shots"][0])[key] = value
    (folder / "job.json").write_text(json.dumps(about, indent=1))


def test_a_strangers_shot_is_data_or_one_error(tmp_path: Path) -> None:
    """The file is replaced by a pickle, with the digest that job.json names, and by descriptions of invalid values."""
    folder = tmp_path / "job"
    made(folder, lamp=shot(4))
    file = folder / "shots" / "00000.npz"
    original = file.read_bytes()
    wicked = b"cos\nsystem\n(S'touch " + os.fsencode(tmp_path / "ran") + b"'\ntR."
    file.write_bytes(wicked)
    with pytest.raises(rc.InputError, match=r"00000\.npz: this file is damaged"):
        rc.Job.load(folder).work()
    with np.load(io.BytesIO(original)) as members:
        about, buffer = json.loads(members["about"].tobytes()), members["buffer"]
    for values, arrays, why in (
        (about, {"buffer": np.array([{}], object)}, "malformed"),
        (about, {"buffer": buffer[:-8]}, "this Camera cannot be read"),
        ({**about, "Camera": {**about["Camera"], "kind": "Scene"}}, {"buffer": buffer}, "this Camera cannot be read"),
        ({**about, "Camera": {**about["Camera"], "state": [1, 2]}}, {"buffer": buffer}, "this Camera was pickled"),
        ({**about, "Camera": 3}, {"buffer": buffer}, "this Camera cannot be read"),
        ({}, {"buffer": buffer}, "malformed"),
        ([1], {"buffer": buffer}, "malformed"),
        (about, {}, "malformed"),
    ):
        content = archive.packed(values, arrays)
        file.write_bytes(content)
        changed(folder, digest=archive.digest_of(content))
        with pytest.raises(rc.InputError, match=why) as error:
            rc.Job.load(folder).work()
        assert "\n" not in str(error.value)
    assert not (tmp_path / "ran").exists()


HUGE = 10**15


@pytest.mark.parametrize(
    ("key", "values"),
    [
        ("name", ("../victim/holiday", "a\nb", 3)),
        ("spp", (HUGE, 0, 1.5, True, 1 << 24)),
        ("resolution", ([1 << 20, 1 << 20], [60], "60x40")),
        ("tile", ([1, 1], [32, -32])),
        ("digest", ("../../x",)),
        ("scene", ("0" * 64,)),
        ("has_layers", (1,)),
        ("shots", ([], {"a": 1}, [None])),
        ("probes", (7,)),
        ("engine", ([], {"realcam": rc.__version__})),
        ("device", (["cpu"],)),
        ("id", ("x",)),
        ("format", (None,)),
    ],
)
def test_a_strangers_job_file_is_refused_in_one_line(
    tmp_path: Path, job_of_four: Path, key: str, values: tuple[object, ...]
) -> None:
    folder = tmp_path / "job"
    shutil.copytree(job_of_four, folder)
    original = (folder / "job.json").read_bytes()
    for value in values:
        (folder / "job.json").write_bytes(original)
        # 4096 x 4096 pixels of 2^24 samples are more units than a folder can hold.
        changed(folder, **({"resolution": [4096, 4096], "tile": [32, 32]} if value == 1 << 24 else {}), **{key: value})
        with pytest.raises(rc.InputError) as error:
            rc.Job.load(folder)
        assert str(error.value).startswith(str(folder))
        assert "\n" not in str(error.value)


@pytest.fixture(scope="session")
def job_of_four(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A job of 4 samples a pixel, whose units are done."""
    folder = tmp_path_factory.mktemp("four") / "job"
    made(folder, lamp=shot(4)).work()
    return folder


def test_pipes_devices_and_links_are_refused(tmp_path: Path, job_of_four: Path) -> None:
    """Reading never blocks on a pipe, and no file that a link points to is read, overwritten or deleted."""
    folder = tmp_path / "job"
    outside = tmp_path / "outside"
    for name in ("job.json", "shots/00000.npz"):
        for make in (os.mkfifo, lambda path: path.symlink_to("/dev/zero"), lambda path: path.symlink_to(outside)):
            shutil.rmtree(folder, ignore_errors=True)
            shutil.copytree(job_of_four, folder)
            (folder / name).unlink()
            make(folder / name)
            with pytest.raises(rc.InputError, match="regular file is expected"):
                rc.Job.load(folder).image()
    for name in ("units", "units/00000", "rounds", "scenes"):
        shutil.rmtree(folder)
        shutil.copytree(job_of_four, folder)
        (folder / "rounds").mkdir(exist_ok=True)
        shutil.rmtree(outside, ignore_errors=True)
        (folder / name).rename(outside)
        precious = outside / "precious.npz"
        precious.write_bytes(b"mine")
        (folder / name).symlink_to(outside)
        with pytest.raises(rc.InputError, match="found a link or a file"):
            rc.Job.load(folder).work()
        assert precious.read_bytes() == b"mine"


def test_units_of_another_job_do_not_count(tmp_path: Path) -> None:
    """A worker of a deleted job must not fill its successor, whose folder has the same name."""
    folder = tmp_path / "job"
    old = made(folder, lamp=shot(4))
    old.work()
    kept = tmp_path / "units"
    shutil.copytree(folder / "units", kept)
    shutil.rmtree(folder)
    job = made(folder, lamp=shot(4, seed=8))
    with pytest.raises(rc.InputError, match=r"the job was replaced|not the file that the job was made with"):
        old.work()
    shutil.copytree(kept, folder / "units", dirs_exist_ok=True)
    assert len(job.status().damaged) == len(list(kept.rglob("*.npz")))
    assert job.status().units_done == 0
    with pytest.raises(rc.InputError, match="units are missing"):
        job.image()
    job.work()
    assert job.image() == picture(shot(4, seed=8))


def test_each_changed_bit_of_a_unit_is_found(job_of_four: Path, tmp_path: Path) -> None:
    """Changes bits of the archive's directory, and a sample of the other bits."""
    file = next((job_of_four / "units").rglob("*pixels*.npz"))
    content, damaged = file.read_bytes(), tmp_path / "unit.npz"
    directory = content.rindex(b"PK\1\2")
    bits = [*range(8 * directory, 8 * len(content), 7), *range(0, 8 * directory, 997)]
    for bit in bits:
        wrong = bytearray(content)
        wrong[bit // 8] ^= 1 << bit % 8
        damaged.write_bytes(wrong)
        with pytest.raises(rc.InputError):
            rc.FilmPart.load(damaged, owner=rc.Job.load(job_of_four)._folder.id)


def test_a_unit_holds_the_samples_that_its_name_says(tmp_path: Path, job_of_four: Path) -> None:
    """Well-formed files of this job with other samples, infinite sums, fields left out, or of another unit."""
    folder = tmp_path / "job"
    shutil.copytree(job_of_four, folder)
    job = rc.Job.load(folder)
    right = job.image()
    files = sorted((folder / "units").rglob("*pixels*.npz"))
    part = rc.FilmPart.load(files[0], owner=job._folder.id)
    assert part.pixels is not None

    def with_field(name: str, value: float) -> rc.FilmPart:
        pixels = part.pixels.copy()
        pixels[name] = value
        return replace(part, pixels=pixels)

    for wrong in (
        with_field("samples", 3),
        with_field("irradiance", np.inf),
        with_field("depth", np.nan),
        replace(part, layers=None),
        replace(part, spp=3),
        rc.FilmPart.load(files[1], owner=job._folder.id),
    ):
        files[0].write_bytes(wrong.packed(job._folder.id))
        with pytest.raises(rc.InputError, match="these are not the samples of this unit"):
            job.image()
        job.work()
        assert job.image() == right


def test_parts_share_a_job_without_a_scheduler(tmp_path: Path) -> None:
    """With a number of samples each part takes its own units only; with a noise goal any part completes the job."""
    counted = made(tmp_path / "counted", a=shot(40), b=shot(40, seed=4))
    done = [0]
    for k in (3, 1, 2):
        counted.work(part=(k, 3))
        done.append(counted.status().units_done)
    assert all(after - before >= done[-1] // 4 for before, after in pairwise(done))
    assert counted.status().is_done
    assert counted.image("b") == picture(shot(40, seed=4))
    noisy = shot("auto", noise_codes=1.5, max_spp=600)
    job = made(tmp_path / "noise", lamp=noisy)
    job.work(part=(2, 8))
    assert job.image() == picture(noisy)
    with pytest.raises(rc.InputError, match="part 4 of 3"):
        job.work(part=(4, 3))


def test_what_is_no_job_is_refused(tmp_path: Path) -> None:
    folder = tmp_path / "job"
    with pytest.raises(rc.InputError, match="there is no such folder"):
        rc.Job.load(folder)
    for shots, tile, why in (
        ({}, TILE, "a job needs at least one shot"),
        *(
            ({name: shot(4)}, TILE, "a shot's name must be valid as the name of its picture")
            for name in ("", "a/b", ".hidden", "a\nb")
        ),
        ({"lamp": shot(4)}, (0, 8), "a tile must have 1 to"),
    ):
        with pytest.raises(rc.InputError, match=why):
            rc.Job.make(folder, shots, device="cpu", tile=tile)
    assert not folder.exists()
    job = made(folder, one=shot(4), two=shot(4, seed=1))
    with pytest.raises(rc.InputError, match="this job exists already"):
        made(folder)
    with pytest.raises(rc.InputError, match="the job has 2 shots; specify the name of one"):
        job.image()
    with pytest.raises(rc.InputError, match="10 of 10 units are missing"):
        job.image("two")
    (folder / "job.json").write_text(json.dumps({"format": FORMAT}))
    with pytest.raises(rc.InputError, match=r"job\.json: this is damaged"):
        rc.Job.load(folder)


def test_work_can_be_stopped_and_goes_on(tmp_path: Path) -> None:
    job = made(tmp_path / "job")
    with pytest.raises(rc.InputError, match="stopped"):
        job.work(progress=lambda done: False)
    assert len(units(job.path)) == 1
    job.work()
    assert job.image() == picture(shot())


SHOT = """
format = 1
scene = "wall.obj"
environment_cd_m2 = 200
position_m = [0, 0, 2]
look_at_m = [0, 0, 0]
resolution = [48, 32]
exposure_time_s = 0.01
effects = []
"""


def test_the_commands_make_work_tell_and_finish(
    tmp_path: Path, command: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    def job(*words: str) -> tuple[int, str, str]:
        ended = command("job", *words)
        return ended.returncode, ended.stdout, ended.stderr

    monkeypatch.chdir(tmp_path)
    (tmp_path / "wall.obj").write_text("v -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n")
    (tmp_path / "one.toml").write_text(SHOT + "spp = 8\n")
    (tmp_path / "two.toml").write_text(SHOT + "seed = 7\n")  # as many samples as the noise wants
    words = ("make", "one.toml", "two.toml", "-o", "both.job", "--device", "cpu", "--tile", "32x16")
    code, output, errors = job(*words, "--sbatch", "both.sbatch", "--openjd", "both.json", "--tasks", "5")
    assert (code, errors) == (0, "")
    assert output == "both.job: 2 pictures, units as the noise requires them\nwrote both.sbatch\nwrote both.json\n"
    (tmp_path / "wall.obj").unlink()  # the job has all that it needs
    script = (tmp_path / "both.sbatch").read_text()
    assert "#SBATCH --array=1-5\n" in script
    last = script.splitlines()[-1]
    assert last.startswith("exec realcam job work --quiet --part") and last.endswith(str(tmp_path / "both.job"))
    template = json.loads((tmp_path / "both.json").read_text())
    assert template["specificationVersion"] == "jobtemplate-2023-09"
    assert [step["name"] for step in template["steps"]] == ["Work", "Finish"]
    code, _, errors = job("finish", "both.job", "-o", "pictures")
    assert (code, errors.count("\n")) == (2, 1)
    assert "units are missing" in errors
    code, output, _ = job("work", "both.job", "--here")
    assert code == 0
    assert output == "both.job: all units are done; realcam job finish both.job -o FILE makes the pictures\n"
    assert json.loads(job("status", "both.job", "--json")[1])["shots_done"] == 2
    assert job("finish", "both.job", "-o", "pictures", "--format", "png")[0] == 0
    assert sorted(path.name for path in (tmp_path / "pictures").iterdir()) == ["one.png", "two.png"]
    (tmp_path / "link").symlink_to("both.job/units")
    before = contents(tmp_path / "both.job")
    for inside in ("both.job", "both.job/units", "link"):
        code, _, errors = job("finish", "both.job", "-o", inside)
        assert (code, errors.count("\n")) == (2, 1)
    assert contents(tmp_path / "both.job") == before


@pytest.fixture(scope="session")
def job_of_two(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("two") / "two.job"
    made(folder, one=shot(4), two=shot(4, seed=1))
    return folder


def contents(folder: Path) -> dict[Path, bytes]:
    return {path: path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


@pytest.mark.parametrize(
    ("words", "why"),
    [
        (("finish", "JOB", "-o", "one.exr"), "the job has 2 pictures; --output must be a folder"),
        (("finish", "JOB", "-o", "x", "--format", "gif"), 'unknown format "gif"'),
        (("work", "JOB", "--here", "--scheduler", "x"), "--scheduler and --workers exclude it"),
        (("work", "JOB", "--part", "9/8"), "expected K/N, 1/8 to 8/8"),
        (("work", "JOB", "--device", "cuda:1"), "use it together with --here"),
        (("work", "nowhere"), "nowhere is not the folder of a job: there is no such folder"),
        (("make", "nowhere.toml", "-o", "new"), "nowhere.toml"),
        (("make", "nowhere.toml", "-o", "JOB"), "this job exists already"),
        (("make", "nowhere.toml", "-o", "new", "--tile", "8y8"), "expected 1 or 2 whole numbers"),
    ],
)
def test_a_mistake_on_the_command_line_is_told_in_one_line(
    job_of_two: Path, monkeypatch: pytest.MonkeyPatch, command: Command, words: tuple[str, ...], why: str
) -> None:
    monkeypatch.chdir(job_of_two.parent)
    refused = command("job", *(job_of_two if word == "JOB" else word for word in words))
    assert (refused.returncode, refused.stdout, refused.stderr.count("\n")) == (2, "", 1)
    assert why in refused.stderr


def test_what_a_killed_write_leaves_goes_when_work_goes_on(tmp_path: Path) -> None:
    job = made(tmp_path / "job", lamp=shot(4))
    old, new = (tmp_path / "job" / "shots" / f".realcam-{name}" for name in ("old", "new"))
    for path in (old, new):
        path.touch()
    long_ago = old.stat().st_mtime - 100
    os.utime(old, (long_ago, long_ago))
    job.work()
    # The other one may be a file that another process writes just now.
    assert sorted(path.name for path in (tmp_path / "job").rglob(".realcam-*")) == [new.name]


def test_frames_are_shots_that_share_their_scene(tmp_path: Path) -> None:
    """A rack focus of three frames, each with random numbers of its own."""
    still = shot(20)
    frames = {
        f"rack.{number:04d}": replace(
            still,
            camera=still.camera.replace(lens=still.camera.lens.focused(distance_m)),
            settings=still.settings.with_(seed=number),
        )
        for number, distance_m in ((1, 1.5), (2, 2.2), (3, 4.0))
    }
    job = made(tmp_path / "job", **frames)
    assert len(list((tmp_path / "job" / "scenes").iterdir())) == 1
    job.work()
    for name, frame in frames.items():
        assert job.image(name) == picture(frame)
