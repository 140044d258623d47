"""rc.Job: the same bits as one machine, whatever becomes of processes, disks and files on the way."""

from __future__ import annotations

import concurrent.futures
import json
import multiprocessing
import os
import random
import resource
import signal
import socket
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
import realcam as rc
from realcam import cli
from realcam.job import claims
from realcam.job.folder import FORMAT

from .job_programs import command, picture, run, shot, units

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
    assert (status.units_done, status.shots_done, status.in_hand) == (status.units_known, 2, 0)
    next((tmp_path / "job" / "units").rglob("*.npz")).with_suffix(".claim").touch()  # of a process killed just then
    assert job.status() == status
    assert len(list((tmp_path / "job" / "rounds").rglob("*.npz"))) > 3  # the noise took several


def test_colours_that_end_in_other_pixels(tmp_path: Path) -> None:
    """Pixels share samples in tiles of 32 pixels, of which units have whole ones, and in no round of a wanted noise."""
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


def test_processes_that_are_killed_lose_only_what_they_have_in_hand(tmp_path: Path) -> None:
    """Three processes, one of which is killed at a time, at any moment, and started again."""
    folder = tmp_path / "job"
    job = made(folder, lamp=shot(400))
    moment = random.Random(5)
    workers = [command("work", folder, "--here", "--quiet", "--threads", "1") for _ in range(3)]
    kept: dict[str, tuple[int, int]] = {}
    for _ in range(3):
        time.sleep(moment.uniform(0.3, 1.2))
        victim = moment.randrange(3)
        kept |= units(folder)
        workers[victim].send_signal(signal.SIGKILL)
        workers[victim].wait()
        workers[victim] = command("work", folder, "--here", "--quiet", "--threads", "1")
    for worker in workers:
        _, errors = worker.communicate(timeout=120)
        assert (worker.returncode, errors) == (0, "")
    assert kept.items() <= units(folder).items()  # nothing that was done was done again
    assert job.image() == picture(shot(400))
    assert not list(folder.rglob("*.claim"))


def test_a_full_disk_stops_work_in_one_line_and_loses_nothing(tmp_path: Path) -> None:
    """No file may be longer than a unit is: as on a disk that is full, a write ends before all is there."""
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


def test_another_version_is_refused_by_its_name(tmp_path: Path) -> None:
    folder = tmp_path / "job"
    made(folder)
    about = json.loads((folder / "job.json").read_text())
    about["engine"]["realcam"] = "9.8.7"
    (folder / "job.json").write_text(json.dumps(about))
    code, _, errors = run("work", folder, "--here")
    assert code == 2
    assert errors == (
        f"realcam: error: {folder}: realcam 9.8.7 made this job, and this is realcam {rc.__version__}; "
        "all machines of a job need the same version\n"
    )
    about["format"] += 1
    (folder / "job.json").write_text(json.dumps(about))
    with pytest.raises(rc.InputError, match=f"its format is {FORMAT + 1}; this realcam reads {FORMAT}"):
        rc.Job.load(folder)


def test_a_machine_that_computes_other_bits_is_refused(tmp_path: Path) -> None:
    folder = tmp_path / "job"
    made(folder)
    about = json.loads((folder / "job.json").read_text())
    for key, other, why in (
        ("instruction_set", "v2", "the job wants realcam .*x86-64-v2, and here is .*; their samples would differ"),
        ("embree", "1.0", "the job wants realcam .*Embree 1.0"),
    ):
        changed = {**about, "engine": {**about["engine"], key: other}}
        (folder / "job.json").write_text(json.dumps(changed))
        with pytest.raises(rc.InputError, match=why):
            rc.Job.load(folder).work()
    changed = {**about, "probes": dict.fromkeys(about["probes"], "0" * 64)}
    (folder / "job.json").write_text(json.dumps(changed))
    with pytest.raises(rc.InputError, match="this machine computes other samples than the one that made the job"):
        rc.Job.load(folder).work()
    assert units(folder) == {}
    assert "REALCAM_INSTRUCTION_SET" not in os.environ


def test_what_was_deleted_or_damaged_is_done_again(tmp_path: Path) -> None:
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
    code, output, _ = run("status", folder)
    assert code == 0
    assert f", 1 damaged (00000/{done[5].name}), which realcam job work does again" in output
    with pytest.raises(rc.InputError, match=r"2 of .* units are missing; realcam job work does them"):
        job.image()
    (folder / "rounds" / "00000" / "002.npz").write_bytes(b"nothing")
    job.work()
    assert job.image() == before == picture(noisy)
    # What only the sum of all looks into says what to do.
    done[-1].write_bytes(b"nothing")
    with pytest.raises(rc.InputError, match=r"damaged; realcam job work .* does it again"):
        job.image()
    job.work()
    assert job.image() == before


@pytest.mark.parametrize(
    ("lost", "why"),
    [
        ("job.json", "this is no job's folder: it has no job.json"),
        ("shots/00000.shot", "No such file or directory; the job cannot go on without it"),
        ("scenes", "No such file or directory; the job cannot go on without it"),
    ],
)
def test_a_folder_that_is_half_deleted_says_what_is_missing(tmp_path: Path, lost: str, why: str) -> None:
    folder = tmp_path / "job"
    made(folder, lamp=shot(4))
    (folder / lost).rename(tmp_path / "lost")
    code, _, errors = run("work", folder, "--here")
    assert code == 2
    assert why in errors
    assert errors.count("\n") == 1


def test_a_shot_that_was_changed_is_refused_and_never_runs_code(tmp_path: Path) -> None:
    folder = tmp_path / "job"
    made(folder, lamp=shot(4))
    file = folder / "shots" / "00000.shot"
    wicked = b"cos\nsystem\n(S'touch " + os.fsencode(tmp_path / "ran") + b"'\ntR."
    file.write_bytes(wicked)
    with pytest.raises(rc.InputError, match="not the file that the job was made with"):
        rc.Job.load(folder).work()
    import hashlib

    about = json.loads((folder / "job.json").read_text())
    about["shots"][0]["digest"] = hashlib.sha256(wicked).hexdigest()
    (folder / "job.json").write_text(json.dumps(about))
    with pytest.raises(rc.InputError, match=r"os\.system is no part of a scene or camera"):
        rc.Job.load(folder).work()
    assert not (tmp_path / "ran").exists()


def test_a_claim_counts_while_its_owner_lives(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    mine, others = claims.Claims(), claims.Claims()
    unit = tmp_path / "unit.npz"
    with mine.claimed(unit) as is_mine:
        assert is_mine
        with others.claimed(unit) as is_others:
            assert not is_others
    with others.claimed(unit) as is_others:
        assert is_others
    assert list(tmp_path.iterdir()) == []
    # Of a process that is gone, on this machine.
    gone = multiprocessing.get_context("spawn").Process()
    gone.start()
    gone.join()
    (tmp_path / "unit.claim").write_text(f"{gone.pid} {socket.gethostname()}")
    with mine.claimed(unit) as is_mine:
        assert is_mine
    # Of another machine, which nobody can ask: by its silence.
    monkeypatch.setattr(claims, "_SILENCE_S", 0.05)
    (tmp_path / "unit.claim").write_text("1 elsewhere")
    with mine.claimed(unit) as is_mine:
        assert not is_mine
    time.sleep(0.1)
    os.utime(tmp_path / "unit.claim")
    with mine.claimed(unit) as is_mine:
        assert not is_mine  # it was renewed
    time.sleep(0.1)
    with mine.claimed(unit) as is_mine:
        assert is_mine


def test_what_is_no_job_is_refused(tmp_path: Path) -> None:
    folder = tmp_path / "job"
    with pytest.raises(rc.InputError, match="there is no such folder"):
        rc.Job.load(folder)
    with pytest.raises(rc.InputError, match="a job wants one shot at least"):
        rc.Job.make(folder, {})
    for name in ("", "a/b", ".hidden", "a\nb"):
        with pytest.raises(rc.InputError, match="a shot's name is that of its picture"):
            rc.Job.make(folder, {name: shot(4)}, device="cpu")
    with pytest.raises(rc.InputError, match="a tile must have 1 to"):
        rc.Job.make(folder, {"lamp": shot(4)}, device="cpu", tile=(0, 8))
    assert not folder.exists()
    job = made(folder, one=shot(4), two=shot(4, seed=1))
    with pytest.raises(rc.InputError, match="this job is there already"):
        made(folder)
    with pytest.raises(rc.InputError, match="the job has 2 shots; the name of one is wanted"):
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


def test_the_commands_make_work_tell_and_finish(tmp_path: Path) -> None:
    (tmp_path / "wall.obj").write_text("v -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n")
    (tmp_path / "one.toml").write_text(SHOT + "spp = 8\n")
    (tmp_path / "two.toml").write_text(SHOT + "seed = 7\n")  # as many samples as the noise wants
    words = ("make", "one.toml", "two.toml", "-o", "both.job", "--device", "cpu", "--tile", "32x16")
    code, output, errors = run(*words, "--sbatch", "both.sbatch", "--openjd", "both.json", "--tasks", "5", cwd=tmp_path)
    assert (code, errors) == (0, "")
    assert output == "both.job: 2 pictures, units as the noise wants them\nwrote both.sbatch\nwrote both.json\n"
    (tmp_path / "wall.obj").unlink()  # the job has all that it needs
    script = (tmp_path / "both.sbatch").read_text()
    assert "#SBATCH --array=1-5\n" in script
    words_of_script = script.splitlines()[-1].split()
    assert words_of_script[:6] == ["exec", "realcam", "job", "work", "--here", "--quiet"]
    assert words_of_script[-1] == str(tmp_path / "both.job")
    template = json.loads((tmp_path / "both.json").read_text())
    assert template["specificationVersion"] == "jobtemplate-2023-09"
    assert [step["name"] for step in template["steps"]] == ["Work", "Finish"]
    code, _, errors = run("finish", "both.job", "-o", "pictures", cwd=tmp_path)
    assert code == 2
    assert errors.count("\n") == 1
    assert "units are missing" in errors
    code, output, _ = run("work", "both.job", "--here", cwd=tmp_path)
    assert code == 0
    assert output == "both.job: all units are done; realcam job finish both.job -o FILE makes the pictures\n"
    code, output, _ = run("status", "both.job", "--json", cwd=tmp_path)
    assert json.loads(output)["shots_done"] == 2
    assert run("finish", "both.job", "-o", "pictures", "--format", "png", cwd=tmp_path)[0] == 0
    assert sorted(path.name for path in (tmp_path / "pictures").iterdir()) == ["one.png", "two.png"]


@pytest.mark.parametrize(
    ("words", "why"),
    [
        (("finish", "JOB", "-o", "one.exr"), "the job has 2 pictures; a folder is wanted for --output"),
        (("finish", "JOB", "-o", "x", "--format", "jpg"), 'unknown format "jpg"'),
        (("work", "JOB", "--here", "--cluster", "slurm"), "exclude each other"),
        (("work", "JOB", "--device", "cuda:1"), "--here is wanted with it"),
        (("work", "nowhere"), "nowhere: this is no job's folder: there is no such folder"),
        (("make", "nowhere.toml", "-o", "new"), "nowhere.toml"),
        (("make", "nowhere.toml", "-o", "JOB"), "this job is there already"),
        (("make", "nowhere.toml", "-o", "new", "--tile", "8y8"), "pixels are wanted, 128 or 128x64"),
    ],
)
def test_a_mistake_on_the_command_line_is_told_in_one_line(
    tmp_path_factory: pytest.TempPathFactory,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    words: tuple[str, ...],
    why: str,
) -> None:
    folder = tmp_path_factory.getbasetemp() / "two.job"
    if not folder.exists():
        made(folder, one=shot(4), two=shot(4, seed=1))
    monkeypatch.chdir(folder.parent)
    monkeypatch.setattr("sys.argv", ["realcam", "job", *(str(folder) if word == "JOB" else word for word in words)])
    with pytest.raises(SystemExit, match="2"):
        cli.run()
    output, errors = capsys.readouterr()
    assert output == ""
    assert why in errors
    assert errors.count("\n") == 1


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
