"""Objects of realcam are values: they pickle, copy, compare and print as Python's users expect."""

from __future__ import annotations

import copy
import importlib
import multiprocessing
import pickle
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np
import pytest
import realcam as rc
from realcam import pickling

from .picklable_values import MAKERS, camera, floor_scene, lens, scene

UNHASHABLE = {
    "CalibratedGeometry",
    "RayPairTable",
    "CoatingResponse",
    "Scene",
    "Spot",
    "Wavefront",
    "PSF",
    "RayBundle",
    "Seidel",
    "AimedRays",
    "FilmPupil",
    "TraceResult",
    "CameraRays",
    "Image",
    "OpticalFlow",
    "RawImage",
    "FilmPart",
}
each_kind = pytest.mark.parametrize("kind", sorted(MAKERS))


@each_kind
def test_equal_values_are_equal_and_others_are_not(kind: str) -> None:
    values = [make() for make in MAKERS[kind]]
    for i, make in enumerate(MAKERS[kind]):
        assert [value == make() for value in values] == [i == k for k in range(len(values))]
        assert [value != make() for value in values] == [i != k for k in range(len(values))]
    assert values[0] != "something else"
    assert values[0] != 3


@each_kind
def test_a_hash_agrees_with_equality_or_is_refused(kind: str) -> None:
    if kind in UNHASHABLE:
        with pytest.raises(TypeError, match="unhashable"):
            hash(MAKERS[kind][0]())
        return
    hashes = [hash(make()) for make in MAKERS[kind]]
    assert hashes == [hash(make()) for make in MAKERS[kind]]
    assert len(set(hashes)) == len(hashes)


@each_kind
def test_pickles_and_copies(kind: str) -> None:
    for make in MAKERS[kind]:
        value = make()
        pickled = [pickle.loads(pickle.dumps(value, protocol)) for protocol in range(pickle.HIGHEST_PROTOCOL + 1)]
        for again in (*pickled, copy.copy(value), copy.deepcopy({"here": [value]})["here"][0]):
            assert type(again) is type(value)
            assert again == value
            assert repr(again) == repr(value)


def test_all_effects_and_devices_pickle() -> None:
    for value in (*rc.effects(), *rc.devices()):
        again = pickle.loads(pickle.dumps(value))
        assert (again, hash(again), str(again)) == (value, hash(value), str(value))


@pytest.mark.parametrize("kind", ["AimedRays", "TraceResult", "CameraRays", "Image"])
def test_a_deep_copy_has_arrays_of_its_own(kind: str) -> None:
    value = MAKERS[kind][0]()
    twin = copy.deepcopy(value)
    name = next(n for n in ("pixels", "directions") if hasattr(value, n))
    getattr(twin, name)[...] = 0
    assert twin != value


@each_kind
def test_a_short_text_fits_a_line(kind: str) -> None:
    for make in MAKERS[kind]:
        text = repr(make())
        assert "\n" not in text
        if kind in ("RenderSettings", "OcioView"):  # can be evaluated, and so name all that differs from the default
            continue
        assert text.startswith(f"<realcam.{kind}")
        assert len(text) <= 130, text


def test_texts_say_what_there_is() -> None:
    assert repr(lens()) == "<realcam.Lens double-gauss-50mm, 11 surfaces, 50.36 mm f/4, focused at 1.5 m>"
    assert repr(rc.Film(24, 16, (6, 4))) == "<realcam.Film 24 x 16 mm, 6 x 4 pixels>"
    assert repr(camera()) == (
        "<realcam.Camera with double-gauss-50mm f/4 at (0, 1, 2), looks at (0, 0, 0), 1/125 s, ISO 400>"
    )
    assert repr(rc.Glass.named("N-BK7")) == "<realcam.Glass N-BK7>"
    assert repr(lens().surfaces[5]).startswith("<realcam.Surface stop, semi-diameter ")
    assert repr(rc.Material()) == "<realcam.Material diffuse (0.5, 0.5, 0.5)>"
    assert repr(scene()) == "<realcam.Scene 8 triangles, 1 material, 3 instances>"
    named = rc.Lens(surfaces=lens().surfaces, name="a\nb" + 100 * "\N{GREEK SMALL LETTER PI}")
    assert "a b\N{GREEK SMALL LETTER PI}" in repr(named)
    assert len(repr(named)) < 130


def test_a_pickled_scene_is_bytes_and_shares_what_it_shared() -> None:
    """An object that is in a scene 1000 times is pickled once, and large arrays leave without a copy."""
    count = 20000
    corners = np.random.default_rng(1).random((3 * count, 3))
    cloud = rc.Scene.from_arrays(corners, np.arange(3 * count).reshape(count, 3))
    flat = len(pickle.dumps(cloud))
    assert flat < 1.1 * (3 * count * 24 + count * 16)  # float64 corners, and 4 integers a triangle
    crowd = cloud.with_instance(cloud, np.stack([np.eye(4)] * 1000), name="cloud")
    assert len(pickle.dumps(crowd)) < flat + 1000 * 300
    buffers: list[pickle.PickleBuffer] = []
    head = pickle.dumps(crowd, 5, buffer_callback=buffers.append)
    assert len(head) < 1000 * 300 + 10000
    assert all(buffer.raw().readonly for buffer in buffers)
    assert pickle.loads(head, buffers=buffers) == crowd


def test_a_pickle_of_another_format_is_refused() -> None:
    function, (kind, number, version, state) = lens().__reduce__()
    assert function is pickling.restored
    with pytest.raises(rc.InputError, match=r"this Lens was pickled by realcam 7\.1 in format 99; .* reads format 1"):
        function(kind, 99, "7.1", state)
    for broken in (state[:-1], (*state, 1), None, [1, 2], (1,) * len(state)):
        with pytest.raises(rc.InputError, match=r"this Lens was pickled|damaged"):
            function(kind, number, version, broken)


def test_what_makes_no_sense_is_not_unpickled() -> None:
    function, (kind, number, version, state) = floor_scene().__reduce__()
    (positions, normals, uvs, second_uvs, colors, triangles, *rest), *others = state
    beyond = np.full_like(triangles, 255)
    with pytest.raises(rc.RealcamError, match="does not exist"):
        function(kind, number, version, ((positions, normals, uvs, second_uvs, colors, beyond, *rest), *others))


@pytest.mark.parametrize("method", ["fork", "spawn", "forkserver"])
def test_goes_to_other_processes(method: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Values travel as in torch's DataLoader: to workers by fork (on Linux) or pickled, and back pickled."""
    monkeypatch.syspath_prepend(Path(__file__).parent)
    tasks = importlib.import_module("worker_tasks")
    lit = floor_scene().with_environment(100)
    here = tasks.photograph((lit, camera()))  # whatever threads that starts exist before the fork
    with multiprocessing.get_context(method).Pool(2) as pool:
        assert pool.map(tasks.focal_length, [lens(), lens()]) == [tasks.focal_length(lens())] * 2
        results = pool.map_async(tasks.photograph, [(lit, camera())] * 4).get(timeout=60)
    for image in results:
        assert image == here


def test_functions_of_classes_travel_to_other_processes() -> None:
    names = ["double-gauss-50mm", "tessar-50mm"]
    with ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as executor:
        assert list(executor.map(rc.Lens.load, names)) == [rc.Lens.load(name) for name in names]
    for function in (rc.Scene.load, rc.Scene.from_arrays, rc.Sensor.load, rc.Glass.named, rc.Film.for_lens):
        assert pickle.loads(pickle.dumps(function)) is function
        assert function.__doc__
    with pytest.raises(rc.ArgumentError, match="nonsense"):
        rc.Lens.load("double-gauss-50mm", nonsense=1)  # type: ignore[call-overload]
