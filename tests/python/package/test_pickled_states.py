"""The content of a pickle is validated like any other input: damage raises an InputError of one line, nothing else."""

from __future__ import annotations

import dataclasses
import pickle
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import realcam as rc
from realcam import _core, pickling

from .picklable_values import ALL_MAKERS, floor_scene, image, lens, scene

FUZZ = Path(__file__).resolve().parents[2] / "fuzz"


def arguments_of(value: Any) -> tuple[str, int, str, tuple[Any, ...]]:
    function, arguments = value.__reduce__()
    assert function is pickling.restored
    return arguments


def refused(value: Any, state: Any) -> str:
    kind, number, version, _ = arguments_of(value)
    with pytest.raises(rc.InputError) as error:
        pickling.restored(kind, number, version, state)
    assert "\n" not in str(error.value)
    return str(error.value)


def refused_with(value: Any, **fields: Any) -> str:
    """`value`: of a dataclass, whose pickle holds its fields in order."""
    return refused(value, tuple((vars(value) | fields)[field.name] for field in dataclasses.fields(value)))


def with_item(state: tuple[Any, ...], place: int, item: Any) -> tuple[Any, ...]:
    return (*state[:place], item, *state[place + 1 :])


def test_all_kinds_that_can_be_pickled_are_tried() -> None:
    """A kind that is added later has to be added to what the tests and the fuzzer make."""
    kinds = {name for name, kind in vars(_core).items() if isinstance(kind, type) and hasattr(kind, "_restored")}
    assert kinds == set(ALL_MAKERS) - {"FilmPart", "Image", "OcioView", "OpticalFlow", "RawImage", "Rig", "RigCamera"}


@pytest.mark.parametrize("kind", ["RenderStats", "Plan", "PlanDecision"])
def test_what_is_never_the_same_again_pickles(kind: str) -> None:
    value = ALL_MAKERS[kind][0]()
    assert pickle.loads(pickle.dumps(value)) == value


def test_mutations_become_a_value_or_an_error(tmp_path: Path) -> None:
    """The fuzz target, in a process of its own: what it holds to includes that no signal ends it."""
    command = [sys.executable, str(FUZZ / "fuzz_pickles.py"), "4000", "--seed", "7", "--folder", str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert ", 0 broken" in done.stdout.replace("; 0 broken", ", 0 broken")


def test_a_point_spread_function_has_the_values_of_its_size() -> None:
    psf = lens().psf(5, size=32)
    state = arguments_of(psf)[3]
    for size in (512, 31, 0, -1, 1, 2**31 - 1):
        assert "it is damaged" in refused(psf, with_item(state, 0, size))
    assert "it is damaged" in refused(psf, with_item(state, 4, np.concatenate([state[4]] * 8)))


def test_enumerators_are_those_that_exist() -> None:
    surface = lens().surfaces[0]
    state = arguments_of(surface)[3]
    for number in (-1, 4, 99, 2**31, 2**40, 0.5, "mirror", None):
        refused(surface, with_item(state, 0, number))
    coating = rc.Coating.quarter_wave()
    for number in (-1, 5, 2**33):
        refused(coating, with_item(arguments_of(coating)[3], 0, number))


def test_enumerators_and_truth_values_within_bytes_are_looked_at() -> None:
    """The materials of a scene, and the rays of a wavefront, are pickled as their bytes."""
    floor = floor_scene()
    parts, *others = arguments_of(floor)[3]
    index = 6  # of the materials
    for model in (7, -1):
        damaged = parts[index].copy()
        damaged[0, :4] = np.array([model], np.int32).view(np.uint8)
        assert "it is damaged" in refused(floor, (with_item(parts, index, damaged), *others))


def test_maps_have_a_place_for_each_ray() -> None:
    wavefront = lens().wavefront(5, samples=8)
    inner, *rest, columns = arguments_of(wavefront)[3]
    assert columns == 8
    for wrong in (7, 1, -8, 10**6):
        assert "it is damaged" in refused(wavefront, (inner, *rest, wrong))
    (*field, pattern, rays, chief), opd, *others = inner
    assert "it is damaged" in refused(wavefront, ((((*field, pattern[:1], rays, chief)), opd, *others), *rest, columns))
    assert "it is damaged" in refused(wavefront, ((((*field, pattern, rays, chief)), opd[:1], *others), *rest, columns))


def test_a_glass_is_made_as_others_are() -> None:
    glass = rc.Glass.named("N-BK7")
    formula, coefficients, points, label = arguments_of(glass)[3]
    assert len(coefficients) == 6
    assert "Cauchy's formula needs at least one" in refused(glass, (0, coefficients[:0], points, label))
    assert "it is damaged" in refused(glass, (formula, coefficients[:5], points, label))
    table = rc.Glass.table([(400, 1.5), (600, 1.4)])
    state = arguments_of(table)[3]
    assert "a glass table needs at least one" in refused(table, with_item(state, 2, state[2][:0]))
    twice = np.concatenate([state[2], state[2]])
    assert "contains a wavelength twice" in refused(table, with_item(state, 2, twice))


def test_what_is_shared_is_of_one_type() -> None:
    """A number refers to an object written earlier. A reference to a motion must not be accepted as a mesh."""
    moving = scene().moved(scene().instances[0][0], [np.eye(4), np.eye(4)], times_s=[0, 1])
    geometry, instances, *others = arguments_of(moving)[3]
    # Shared objects in the order of their numbers: the static geometry, the chair, the motion of its first instance.
    (chair, *_, motion), (of_second, *_, standing), _ = instances
    assert isinstance(chair, tuple) and isinstance(motion, tuple) and standing is None and of_second == 1
    for number in (2, 3, 10**6, -1):
        damaged = (instances[0], with_item(instances[1], 0, number), instances[2])
        assert "it is damaged" in refused(moving, (geometry, damaged, *others))
    for number in (0, 1, 2**40):
        damaged = (instances[0], with_item(instances[1], 4, number), instances[2])
        assert "cannot be read" in refused(moving, (geometry, damaged, *others))
    # A chair that is a part of itself.
    assert "cannot be read" in refused(moving, (geometry, (with_item(instances[0], 0, 1), *instances[1:]), *others))


def test_parts_of_instances_come_after_their_whole() -> None:
    value = scene()
    geometry, (first, *others), *rest = arguments_of(value)[3]
    for whole in (0, 1, -2, 2**40):
        message = refused(value, (geometry, (with_item(first, 3, whole), *others), *rest))
        assert f"is a part of instance {whole}" in message


def test_a_material_by_itself_has_no_numbers_of_textures() -> None:
    material = rc.Material(texture=np.zeros((2, 2, 3), np.uint8))
    name, values, textures = arguments_of(material)[3]
    place = next(i for i, item in enumerate(values) if isinstance(item, tuple) and item and item[0] == -1)
    damaged = with_item(values, place, with_item(values[place], 0, 2**31 - 1))
    assert "texture indices" in refused(material, (name, damaged, textures))


def test_films_lenses_and_cameras_are_held_to_their_limits() -> None:
    film = rc.Film()
    assert "resolution" in refused(film, (36.0, 24.0, 0, 10, (0.0, 0.0)))
    assert "shift" in refused(film, (36.0, 24.0, 9, 6, (float("nan"), 0.0)))
    value = lens()
    state = arguments_of(value)[3]
    place = next(i for i, item in enumerate(state) if isinstance(item, float) and item == value.film_distance_mm)
    assert "the film must lie behind" in refused(value, with_item(state, place, float("nan")))
    place = next(i for i, item in enumerate(state) if isinstance(item, float) and item == value.wavelength_nm)
    for wavelength_nm in (float("nan"), float("inf"), -1.0, 1e300):
        assert "the design wavelength must lie" in refused(value, with_item(state, place, wavelength_nm))


def test_arrays_of_results_are_of_one_length() -> None:
    result = lens().trace(np.full((4, 3), (0.0, 0.0, 80.0)), np.array([[0, 0.01 * i, -1] for i in range(4)]))
    state = arguments_of(result)[3]
    for place, item in enumerate(state[:5]):
        assert "it is damaged" in refused(result, with_item(state, place, item[:-1]))
        assert "it is damaged" in refused(result, with_item(state, place, "an array"))


def test_texts_are_texts() -> None:
    coating = rc.Coating(reflectance=0.9, name="a coating")
    state = arguments_of(coating)[3]
    assert "it is damaged" in refused(coating, with_item(state, 1, b"\xff\xfe"))


def test_what_names_no_value_is_refused() -> None:
    state = arguments_of(rc.Film())[3]
    for kind in ("Session", "_restored", "no such thing", "devices", 3, None, b"Film"):
        with pytest.raises(rc.InputError, match="cannot restore this object"):
            pickling.restored(kind, pickling.FORMAT, "0.1", state)  # type: ignore[arg-type]
    for number in (None, "1", np.zeros(3)):
        with pytest.raises(rc.InputError, match="in format"):
            pickling.restored("Film", number, "0.1", state)  # type: ignore[arg-type]
    with pytest.raises(rc.InputError, match=r"realcam \? in format 9"):
        pickling.restored("Film", 9, "0.1\n" * 100, state)


def test_a_picture_is_checked_too() -> None:
    picture = image()
    refused_with(picture, pixels=picture.pixels[:, :, 0])
    refused_with(picture, depth=picture.depth[:1])
    refused_with(picture, pixels=None)
    refused_with(picture, layers={"normal": picture.pixels[:1]})
    refused_with(picture, camera="a camera")
    assert "the image's spp" in refused_with(picture, spp="many")
    assert "it is damaged" in refused(picture, None)
    raw = rc.Sensor.load().expose(picture)
    assert raw.gain_dn_per_e > 0  # a cached property, which the pickle then has too
    assert pickle.loads(pickle.dumps(raw)) == raw
    assert "iso" in refused_with(raw, iso=float("nan"))
