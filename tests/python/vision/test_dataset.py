"""Data sets: what recipes say, labels against pictures and geometry, and shards that are whole or not there."""

from __future__ import annotations

import concurrent.futures
import dataclasses
import json
import os
import signal
import subprocess
import sys
import tarfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import realcam as rc
from realcam.dataset import Recipe, make, samples
from realcam.dataset.pictures import codes_of, png_bytes
from realcam.dataset.scenes import random_cameras, random_scene
from realcam.dataset.shards import DatasetFolder

pytestmark = pytest.mark.picture_files

SMALL = Recipe(
    count=3,
    size=(96, 64),
    seed=5,
    lenses=("double-gauss-50mm", "tessar-50mm"),
    board=(6, 4),
    speed_m_s=(20, 30),
    readout_time_s=0.002,
    iso=(100, 800),
    labels=("depth", "mask", "motion", "flow"),
    camera_speed_m_s=(0.5, 1),
    camera_turn_deg_s=(0, 10),
    next_after_s=0.02,
    spp=2,
    shard_size=2,
)


class Here(concurrent.futures.Executor):
    """Runs each call at once in this process, and counts them."""

    def __init__(self) -> None:
        self.calls = 0

    def submit(self, f: Callable[..., Any], /, *args: Any, **words: Any) -> concurrent.futures.Future[Any]:
        self.calls += 1
        future: concurrent.futures.Future[Any] = concurrent.futures.Future()
        future.set_result(f(*args, **words))
        return future


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("dataset") / "out"
    make(SMALL, folder, Here(), device="cpu")
    return folder


def test_shards_hold_all_files_of_each_sample_in_order(made: Path) -> None:
    names = []
    for path in sorted(made.glob("shard-*.tar")):
        with tarfile.open(path) as tar:
            names.append(tar.getnames())
    flow = ["next.png", "flow.npy", "flow_visible.png"]
    suffixes = ["png", "depth.npy", "mask.png", "motion.npy", *flow, "json"]
    keys = [["000000", "000001"], ["000002"]]
    assert names == [[f"{key}.{suffix}" for key in shard for suffix in suffixes] for shard in keys]
    assert not list((made / "samples").iterdir())


def test_labels_agree_with_the_layers_and_with_geometry(made: Path) -> None:
    seen_boards = 0
    for sample in samples(made):
        mask, label, depth = sample["mask.png"], sample["json"], sample["depth.npy"]
        assert sample["png"].shape == (64, 96, 3) and mask.shape == depth.shape == (64, 96)
        assert len(label["objects"]) > 0
        for seen in label["objects"]:
            x, y, width, height = seen["box"]
            here = mask == seen["id"]
            assert here.sum() == seen["area"] == here[y : y + height, x : x + width].sum()
            assert here[y].any() and here[y + height - 1].any() and here[:, x].any() and here[:, x + width - 1].any()
            # COCO's run lengths, column by column, undone.
            values = np.repeat(np.arange(len(seen["run_lengths"])) % 2, seen["run_lengths"])
            assert np.array_equal(values.reshape(96, 64).T.astype(bool), here)
        # A pinhole's view of the board's corners is near; the matrix alone leaves out distortion: some pixels of 96.
        board = label["board"]
        pose = label["pose"]["world_to_camera"]
        rays = np.array(board["corners_m"]) @ np.array(pose["rotation"]).T + pose["translation_m"]
        ideal = (rays / rays[:, 2:]) @ np.array(label["camera_matrix"]).T
        visible = np.array(board["corners_visible"])
        seen_boards += int(visible.any())
        corners = np.array([[np.nan] * 2 if corner is None else corner for corner in board["corners_px"]])
        assert corners[visible] == pytest.approx(ideal[visible, :2], abs=4)
        # In 20 ms bodies go 0.4 m along the floor, which the camera alone moves: by 20 mm and 0.2 degrees.
        flow, seen_there = sample["flow.npy"], sample["flow_visible.png"]
        length = np.linalg.norm(flow, axis=2)
        assert np.nanmedian(length[mask == 1]) < 4 < np.nanmax(length[mask > 1])
        assert set(np.unique(seen_there)) <= {0, 255} and (seen_there[mask == 1] == 255).mean() > 0.5
        # While the shutter is open, all moves as much less as the exposure is shorter.
        exposed = sample["json"]["exposure_time_s"] / 0.02
        on_floor = (mask == 1) & np.isfinite(flow).all(axis=2)
        assert sample["motion.npy"][on_floor] == pytest.approx(exposed * flow[on_floor], abs=0.05)
    assert seen_boards > 0


def test_the_index_is_cocos(made: Path) -> None:
    index = json.loads((made / "dataset.json").read_text())
    assert [image["file_name"] for image in index["images"]] == ["000000.png", "000001.png", "000002.png"]
    assert [image["shard"] for image in index["images"]] == ["shard-000000.tar"] * 2 + ["shard-000001.tar"]
    labels = [seen for sample in samples(made) for seen in sample["json"]["objects"]]
    assert [each["bbox"] for each in index["annotations"]] == [seen["box"] for seen in labels]
    names = {each["id"]: each["name"] for each in index["categories"]}
    assert [names[each["category_id"]] for each in index["annotations"]] == [seen["category"] for seen in labels]
    for each in index["annotations"]:
        assert sum(each["segmentation"]["counts"][1::2]) == each["area"]
        assert sum(each["segmentation"]["counts"]) == 96 * 64 and each["segmentation"]["size"] == [64, 96]


def test_what_is_there_is_not_made_again(made: Path, tmp_path: Path) -> None:
    folder, executor = tmp_path / "out", Here()
    one = dataclasses.replace(SMALL, count=1)
    make(one, folder, executor, device="cpu")
    assert executor.calls == 1
    make(one, folder, executor, device="cpu")
    assert executor.calls == 1
    # More pictures; that of the shard which was not full is kept. All are the same bytes as made at once.
    make(SMALL, folder, executor, device="cpu")
    assert executor.calls == 3
    for path in made.glob("*.tar"):
        assert (folder / path.name).read_bytes() == path.read_bytes()
    assert (folder / "dataset.json").read_bytes() == (made / "dataset.json").read_bytes()
    with pytest.raises(rc.InputError, match=r"another recipe \(seed, spp\)"):
        make(dataclasses.replace(SMALL, seed=6, spp=3), folder, executor)
    with pytest.raises(rc.InputError, match="made with 3 pictures"):
        make(one, folder, executor)


@pytest.mark.slow
def test_a_kill_leaves_whole_files_and_the_next_run_goes_on(tmp_path: Path) -> None:
    recipe, out = tmp_path / "recipe.toml", tmp_path / "out"
    recipe.write_text("format = 1\nsize = [60, 40]\ncount = 6\nspp = 2\nshard_size = 3\nlenses = ['tessar-50mm']\n")
    command = [sys.executable, "-m", "realcam", "dataset", str(recipe), "-o", str(out), "--workers", "1"]
    process = subprocess.Popen(command, start_new_session=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    deadline = time.monotonic() + 120
    while not list(out.glob("samples/*.tar")) and process.poll() is None and time.monotonic() < deadline:
        time.sleep(0.05)
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    done = {path.name: path.stat().st_mtime_ns for path in out.glob("samples/0*.tar")}
    assert done or (out / "dataset.json").exists()
    executor = Here()
    make(Recipe.load(recipe), out, executor, device="cpu")
    assert executor.calls <= 6 - len(done)
    assert [sample["__key__"] for sample in samples(out)] == [f"{i:06d}" for i in range(6)]


def test_a_camera_stands_outside_of_all_bodies() -> None:
    """A fisheye comes so near that every tenth one stood in a body, and one in a box sees no light to be metered."""
    recipe = dataclasses.replace(Recipe(), lenses=("fisheye-6mm-220deg",), objects=(8, 8))
    for number in range(12):
        rng = np.random.default_rng([1, number])
        seen = random_scene(recipe, rng)
        camera = random_cameras(recipe, seen, rng)[""]
        sizes = 2 * seen.centres_m[:, 1]
        # A body is within the cube of its size, turned about the vertical.
        across = np.linalg.norm((seen.centres_m - camera.position)[:, [0, 2]], axis=1)
        assert ((across > np.sqrt(0.5) * sizes) | (camera.position[1] > sizes)).all()


def test_a_recipe_that_has_made_no_picture_may_be_mended(tmp_path: Path) -> None:
    recipe = dataclasses.replace(Recipe(), count=1, size=(60, 40), spp=1, models={"cup": "no-such-file.obj"})
    with pytest.raises(rc.InputError, match=r"picture \d: .*no-such-file.obj"):
        make(recipe, tmp_path / "out", Here(), device="cpu")
    with pytest.raises(rc.InputError, match="this has no shards"):
        list(samples(tmp_path))
    make(dataclasses.replace(recipe, models={}), tmp_path / "out", Here(), device="cpu")
    with pytest.raises(rc.InputError, match=r"another recipe \(models\)"):
        make(recipe, tmp_path / "out", Here(), device="cpu")


def test_models_of_files_are_bodies_of_their_category(tmp_path: Path) -> None:
    model = tmp_path / "wedge.obj"
    model.write_text("v 0 0 0\nv 40 0 0\nv 0 30 0\nv 0 0 20\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n")
    recipe = tmp_path / "recipe.toml"
    recipe.write_text("format = 1\ncount = 1\nsize = [60, 40]\nspp = 1\n[models]\nwedge = 'wedge.obj'\n")
    make(Recipe.load(recipe), tmp_path / "out", Here(), device="cpu")
    (sample,) = samples(tmp_path / "out")
    assert {seen["category"] for seen in sample["json"]["objects"]} == {"wedge"}
    assert 0 < max(seen["area"] for seen in sample["json"]["objects"]) < 60 * 40


@pytest.mark.parametrize("shape", [(7, 5), (7, 5, 3)])
def test_pictures_come_back_from_their_bytes(shape: tuple[int, ...]) -> None:
    codes = np.random.default_rng(1).integers(0, 256, shape, dtype=np.uint8)
    assert np.array_equal(codes_of(png_bytes(codes)), codes)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("count = 3", "expected format = 1"),
        ("format = 1\ncout = 3", r"recipe.toml:2: unknown key \"cout\""),
        ("format = 1\n\ncount = 'many'", "recipe.toml:3: count must be a whole number; it is 'many'"),
        ("format = 1\nsize = [3]", "recipe.toml:2: size must be two whole numbers"),
        ("format = 1\niso = [800, 100]", "recipe.toml:2: iso must be a range, the smaller number first"),
        ("format = 1\nlabels = ['depht']", 'recipe.toml:2: labels: "depht" is unknown'),
        ("format = 1\nboard = [9]", r"recipe.toml:2: board must be \[columns, rows\]"),
        ("format = 1\nsensor = 'nothing'", "recipe.toml:2: .*nothing"),
        ("format = 1\ncount = ", "recipe.toml:2: not valid TOML"),
    ],
)
def test_mistakes_in_a_recipe_have_one_line(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "recipe.toml"
    path.write_text(text)
    with pytest.raises(rc.InputError, match=message) as caught:
        Recipe.load(path)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("dataset.json", b'{"mine": 1}'),
        ("shard-000000.tar", None),
        ("samples/000001.tar", None),
        ("recipe.json", b'{"count": 3}'),
        ("recipe.json", b"[1]"),
    ],
)
@pytest.mark.parametrize("is_begun", [False, True])
def test_files_of_other_programs_stay(tmp_path: Path, name: str, content: bytes | None, is_begun: bool) -> None:
    """This includes files of another data set in the folder."""
    file = tmp_path / name
    if is_begun:
        if name == "dataset.json":
            pytest.skip("an index beside a recipe is the data set's own")
        DatasetFolder.open(tmp_path, SMALL)
    file.parent.mkdir(exist_ok=True)
    if content is None:
        (tmp_path / "7.jpg").write_bytes(b"precious")
        with tarfile.open(file, "w") as tar:
            tar.add(tmp_path / "7.jpg", "7.jpg")
    else:
        file.write_bytes(content)
    before = file.read_bytes()
    made_one = {"png": b"", "json": b"{}"}
    with pytest.raises(rc.InputError, match="choose another folder") as error:
        folder = DatasetFolder.open(tmp_path, SMALL)
        for number in folder.missing(range(SMALL.count)):
            folder.write_sample(number, made_one)
        folder.write_shard(0)
    assert "\n" not in str(error.value)
    assert file.read_bytes() == before


@pytest.mark.parametrize(
    ("words", "limits"),
    [
        *(
            (words, r"\d+ or less")
            for words in ({"count": 10**12}, {"size": (10**6, 10)}, {"objects": (1, 10**9)}, {"board": (10**6, 5)})
        ),
        ({"spp": 10**12}, r"a whole number from 1 to \d+, or auto"),
    ],
    ids=str,
)
def test_recipes_that_no_machine_can_make_are_refused(words: dict[str, Any], limits: str) -> None:
    with pytest.raises(rc.InputError, match=rf"^{next(iter(words))} must be {limits}$"):
        Recipe(**words)
