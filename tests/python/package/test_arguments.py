"""Arguments of the wrong type, missing or unknown are told in one sentence; signatures read as Python's own."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest
import realcam as rc
from realcam import _core, arguments

LENS = rc.Lens.load("tessar-50mm")
CAMERA = rc.Camera(LENS, film=rc.Film(resolution=(3, 2)))
SCENE = rc.Scene.from_arrays([(0, 0, -2), (1, 0, -2), (0, 1, -2)], [(0, 1, 2)]).with_environment(1)

WRONG: list[tuple[Callable[[], Any], str]] = [
    (lambda: rc.Camera(LENS, position="abc"), "position must be three numbers; it is 'abc'"),
    (lambda: rc.Camera(LENS, look_at=(1, 2, None)), "look_at must be three numbers; it is (1, 2, None)"),
    (lambda: rc.Camera("tessar-50mm"), "lens must be a Lens or a RayPairTable; it is 'tessar-50mm'"),
    (lambda: rc.Camera(), "Camera() needs the argument lens"),
    (lambda: rc.Camera(LENS, isoo=3), "Camera() has no argument isoo; is iso meant?"),
    (lambda: rc.Camera(LENS, lens=LENS), "Camera() has the argument lens twice"),
    (
        lambda: rc.Camera(LENS, rc.Film()),
        "Camera() takes at most one argument without a name, and two are given; by name there are film, position, "
        "look_at, up, exposure_time_s, iso, model",
    ),
    (lambda: rc.Camera(LENS, film=3), "film must be a Film or None; it is 3"),
    (lambda: CAMERA.replace(iso=[1]), "iso must be a number or None; it is [1]"),
    (lambda: CAMERA.generate_rays(spp=1.5), "spp must be a whole number; it is 1.5"),
    (lambda: rc.Film(resolution=(1.5, 2)), "resolution must be two whole numbers; it is (1.5, 2)"),
    (lambda: rc.Film(resolution=960), "resolution must be two whole numbers; it is 960"),
    (
        lambda: CAMERA.generate_rays(spp=10**5000),
        f"spp must be a whole number between {-(2**31)} and {2**31 - 1}; it is one of the type int",
    ),
    (lambda: rc.Film(1, 2, (3, 4), (5, 6), 7), "Film() takes at most four arguments without a name, and five are "),
    (lambda: rc.Surface(clear_semi_diameter_mm=1, aspheric_coefficients=[1]), "aspheric_coefficients must be a dict"),
    (lambda: rc.Lens(surfaces=[1, 2]), "surfaces must be a list of items, each a Surface; it is [1, 2]"),
    (lambda: LENS.focused("near"), "focus_distance_m must be a number; it is 'near'"),
    (lambda: rc.Lens.focused(3, 2), "self must be a Lens; it is 3"),
    (lambda: LENS.spot(pattern=3), "pattern must be a text; it is 3"),
    (lambda: LENS.aim("abc"), "pupil must be an array of numbers; it is 'abc'"),
    (lambda: LENS.seidel(1, colours_nm=(1, 2, 3)), "colours_nm must be two numbers; it is (1, 2, 3)"),
    (lambda: rc.Glass.table([(1, 2), 3]), "points must be a list"),
    (lambda: SCENE.with_material(1.5, rc.Material()), "which must be a whole number or a text; it is 1.5"),
    (lambda: SCENE.with_instance("chair"), "object must be a Scene; it is 'chair'"),
    (lambda: rc.render(SCENE, SCENE, effects=()), "camera must be a Camera; it is <realcam.Scene"),
    (lambda: rc.render(SCENE, CAMERA, effects=(), spp="many"), "spp must be a whole number or \"auto\"; it is 'many'"),
]


@pytest.mark.parametrize(("call", "sentence"), WRONG, ids=[sentence for _, sentence in WRONG])
def test_a_wrong_argument_is_told_in_a_sentence(call: Callable[[], Any], sentence: str) -> None:
    with pytest.raises(rc.ArgumentError) as caught:
        call()
    text = str(caught.value)
    assert text.startswith(sentence)
    assert "\n" not in text
    assert len(text) < 200
    # Python's users catch TypeError, those of realcam its own errors.
    assert isinstance(caught.value, TypeError)
    assert isinstance(caught.value, rc.InputError)


def test_right_arguments_of_other_types_still_fit() -> None:
    camera = rc.Camera(LENS, position=np.array([1, 2, 3]), iso=np.float32(200), look_at=[0, 0, 0])
    assert camera.position == (1, 2, 3)
    assert rc.Film(np.int64(30), resolution=[np.int32(3), 2]).resolution == (3, 2)


def test_an_error_in_a_users_function_stays_as_it_is() -> None:
    def broken(done: float) -> bool:
        raise TypeError("this(): incompatible with my taste")

    with pytest.raises(TypeError, match="my taste") as caught:
        rc.render(SCENE, CAMERA, effects=(), spp=1, device="cpu", progress=broken)
    assert not isinstance(caught.value, rc.ArgumentError)


@pytest.mark.parametrize("answer", ["no", "", np.zeros(3)])
def test_a_progress_function_that_returns_something_else_is_told(answer: object) -> None:
    with pytest.raises(rc.InputError, match=r"progress must return False to stop, .* it returned"):
        rc.render(SCENE, CAMERA, effects=(), spp=1, device="cpu", progress=lambda done: answer)  # type: ignore[arg-type,return-value]


def test_progress_that_is_no_function_is_told_before_the_work() -> None:
    with pytest.raises(rc.InputError, match="progress must be a function"):
        rc.render(SCENE, CAMERA, effects=(), spp=2**24, device="cpu", progress=3)  # type: ignore[arg-type]
    with pytest.raises(rc.InputError, match="progress must be a function"):
        CAMERA.metered(SCENE, device="cpu", progress="bar")  # type: ignore[arg-type]


def classes() -> list[type]:
    return [c for c in vars(_core).values() if isinstance(c, type) and type(c).__name__ == "pybind11_type"]


@pytest.mark.parametrize("kind", classes(), ids=lambda kind: kind.__name__)
def test_no_object_without_a_value_can_be_made(kind: type) -> None:
    """Its memory would be read as it comes: Scene.__new__(Scene).triangle_count was a segmentation fault."""
    with pytest.raises(TypeError, match=rf"{kind.__name__}\.__new__ makes no {kind.__name__}"):
        kind.__new__(kind)
    with pytest.raises(TypeError):
        object.__new__(kind)
    with pytest.raises(TypeError):
        type("Heir", (kind,), {})()


def docstrings() -> Iterator[tuple[str, str]]:
    for owner in [*classes(), _core, rc, rc.Image]:
        for name, thing in vars(owner).items():
            if inspect.ismodule(thing) or (name != "__init__" and name.startswith("__")):
                continue
            text = inspect.getdoc(getattr(owner, name))
            if text and text != inspect.getdoc(object.__init__):
                yield f"{owner.__name__}.{name}", text


def test_signatures_are_written_as_users_write_types() -> None:
    for name, text in docstrings():
        assert not re.search(r"Supports(Float|Int|Index)|FixedSize|realcam\._core\.|collections\.abc", text), name


def test_every_signature_is_understood() -> None:
    """So that a wrong argument of any function finds its sentence."""
    for kind in [*classes(), _core]:
        for name, thing in vars(kind).items():
            doc = (getattr(getattr(kind, name), "__doc__", None) or "").split("\n")[0]
            if re.match(rf"{re.escape(name)}\(", doc) and not isinstance(thing, property):
                assert arguments._definition(doc).name == name


def test_what_a_docstring_refers_to_exists() -> None:
    seen = 0
    for name, text in docstrings():
        for reference in re.findall(r"\b[Ss]ee ([A-Za-z_][\w.]*\w)", text):
            thing: Any = rc
            for part in reference.removeprefix("realcam.").split("."):
                assert hasattr(thing, part), f"{name}: see {reference}"
                thing = getattr(thing, part)
            seen += 1
    assert seen > 0


def test_messages_repeat_no_page_of_what_was_given() -> None:
    for call in (
        lambda: rc.Lens.load("x" * 100_000),
        lambda: rc.Scene.load("x" * 100_000 + ".obj"),
        lambda: rc.render(SCENE, CAMERA, effects=(), device="x" * 100_000),
        lambda: rc.Lens.load("a/" + "b\n" * 100_000),
    ):
        with pytest.raises(rc.RealcamError) as caught:
            call()
        assert len(str(caught.value)) < 2100
        assert "\n" not in str(caught.value)
