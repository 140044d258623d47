"""Meshes of a USD stage whose points have time samples, compared with usd-core's own evaluation of the points."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import realcam as rc

pytest.importorskip("pxr")

from pxr import Gf, Sdf, Usd, UsdGeom, Vt

from .. import scenes
from .test_usd_stages import TOLERANCE, stage_file

TIMES = (1.0, 2.0, 4.5, 7.0)  # time codes of the samples
FRAMES = (0.0, 1.0, 1.3, 2.0, 3.25, 4.5, 6.9, 7.0, 9.0)  # time codes at which shapes are compared
PER_SECOND = 8.0


def new_stage(path: Path, start: float = 1.0) -> Usd.Stage:
    stage = Usd.Stage.CreateNew(str(path))
    UsdGeom.SetStageMetersPerUnit(stage, 1)
    UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.y)
    stage.SetTimeCodesPerSecond(PER_SECOND)
    stage.SetStartTimeCode(start)
    return stage


def random_points(seed: int, count: int) -> Vt.Vec3fArray:
    return Vt.Vec3fArray.FromNumpy(np.random.default_rng(seed).uniform(-5, 5, (count, 3)).astype(np.float32))


def triangle(stage: Usd.Stage, path: str = "/Mesh", seed: int = 0) -> UsdGeom.Mesh:
    mesh = UsdGeom.Mesh.Define(stage, path)
    mesh.CreateFaceVertexCountsAttr([3])
    mesh.CreateFaceVertexIndicesAttr([0, 1, 2])
    mesh.CreateSubdivisionSchemeAttr("none")
    points = mesh.CreatePointsAttr()
    for k, time in enumerate(TIMES):
        points.Set(random_points(100 * seed + k, 3), time)
    return mesh


def compare(stage: Usd.Stage, scene: rc.Scene, start: float = 1.0) -> None:
    """Compares the bounds of all meshes, whose points usd-core interpolates and transforms."""
    for code in (frame for frame in FRAMES if frame >= start):
        cache = UsdGeom.XformCache(Usd.TimeCode(code))
        rows = []
        for prim in stage.Traverse(Usd.TraverseInstanceProxies()):
            if prim.IsA(UsdGeom.Mesh):
                points = np.array(UsdGeom.Mesh(prim).GetPointsAttr().Get(code), float)
                rows.append(np.c_[points, np.ones(len(points))] @ np.array(cache.GetLocalToWorldTransform(prim)))
        expected = np.vstack(rows)[:, :3]
        found = np.array(scene.at_time((code - start) / PER_SECOND).bounds_m)
        assert np.abs(found - [expected.min(0), expected.max(0)]).max() <= TOLERANCE * np.ptp(expected, axis=0).max()


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("start", [0.0, 1.0, 3.25])
def test_points_between_samples(tmp_path: Path, seed: int, start: float) -> None:
    """Each point of a triangle touches the bounds at some time."""
    stage = new_stage(tmp_path / "stage.usda", start)
    triangle(stage, seed=seed)
    stage.Save()
    scene = rc.Scene.load(tmp_path / "stage.usda")
    assert not any("over time" in line and "Mesh" in line for line in scene.warnings)
    compare(stage, scene, start)


def test_points_and_transforms_move_together(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "stage.usda")
    parent = UsdGeom.Xform.Define(stage, "/Car").AddTranslateOp()
    own = UsdGeom.Xformable(triangle(stage, "/Car/Mesh")).AddScaleOp()
    for code in (1.0, 7.0):
        parent.Set(Gf.Vec3d(3 * code, 0, code), code)
        own.Set(Gf.Vec3f(1, code, 2), code)
    stage.Save()
    compare(stage, rc.Scene.load(tmp_path / "stage.usda"))


def test_scene_instances(tmp_path: Path) -> None:
    stage = new_stage(tmp_path / "stage.usda")
    UsdGeom.Xform.Define(stage, "/Flag")
    triangle(stage, "/Flag/Mesh")
    for k in range(2):
        copy = UsdGeom.Xform.Define(stage, f"/Copy{k}")
        copy.GetPrim().GetReferences().AddInternalReference("/Flag")
        copy.GetPrim().SetInstanceable(True)
        copy.AddTranslateOp().Set(Gf.Vec3d(20 * k + 20, 0, 7))
    stage.Save()
    compare(stage, rc.Scene.load(tmp_path / "stage.usda"))


def test_point_instances(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Copies beyond the limit of a stage keep their shape."""
    stage = new_stage(tmp_path / "stage.usda")
    places = np.array([[-30, 0, 0], [30, 1, 2]], np.float32)
    instancer = UsdGeom.PointInstancer.Define(stage, "/Copies")
    instancer.CreateProtoIndicesAttr([0, 0])
    instancer.CreatePositionsAttr(Vt.Vec3fArray.FromNumpy(places))
    points = triangle(stage, "/Copies/Mesh").GetPointsAttr()
    instancer.CreatePrototypesRel().AddTarget("/Copies/Mesh")
    stage.Save()

    def check(scene: rc.Scene, last_moves: bool) -> None:
        for code in FRAMES[1:]:
            rows = [np.array(points.Get(time)) for time in (code, code if last_moves else TIMES[0])]
            expected = np.vstack([row + place for row, place in zip(rows, places, strict=True)])
            found = np.array(scene.at_time((code - 1) / PER_SECOND).bounds_m)
            # The points are at up to 35 m, in floats.
            assert np.abs(found - [expected.min(0), expected.max(0)]).max() <= TOLERANCE * 70

    check(rc.Scene.load(tmp_path / "stage.usda"), True)
    monkeypatch.setattr("realcam.usd.deformation.MAX_MOVING_POINTS", 16)  # of the 16 of each instance
    scene = rc.Scene.load(tmp_path / "stage.usda")
    assert any("/Copies/Mesh: some of its instances keep the shape" in line for line in scene.warnings)
    check(scene, False)


def test_held_interpolation(tmp_path: Path) -> None:
    """A stage holds values by a setting in memory, which its file lacks."""
    from realcam import _core
    from realcam.usd.reading import Translation
    from realcam.usd.stage import OpenStage

    stage = new_stage(tmp_path / "stage.usda")
    stage.SetInterpolationType(Usd.InterpolationTypeHeld)
    triangle(stage)
    translation = Translation(OpenStage("stage", stage))
    translation.add_stage()
    compare(stage, _core._read_glb("stage", translation.glb.encoded(), [], 1.0, []))


@pytest.mark.parametrize("other", ["points", "indices"])
def test_samples_of_another_topology_are_left_out(tmp_path: Path, other: str) -> None:
    stage = new_stage(tmp_path / "stage.usda")
    mesh = triangle(stage)
    if other == "points":
        mesh.GetPointsAttr().Set(random_points(9, 4), TIMES[2])
    else:
        mesh.GetFaceVertexIndicesAttr().Set([0, 1, 2], TIMES[0])
        mesh.GetFaceVertexIndicesAttr().Set([0, 2, 1], TIMES[2])
    stage.Save()
    scene = rc.Scene.load(tmp_path / "stage.usda")
    assert any("/Mesh: its topology changes at time code 4.5" in line for line in scene.warnings)
    for code in (1.0, 1.3, 2.0, 4.5, 7.0):
        expected = np.array(mesh.GetPointsAttr().Get(min(code, 2.0)))
        found = np.array(scene.at_time((code - 1) / PER_SECOND).bounds_m)
        assert np.abs(found - [expected.min(0), expected.max(0)]).max() <= TOLERANCE * 10


def test_samples_beyond_the_limit_are_left_out(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("realcam.usd.deformation.MAX_MOVING_POINTS", 9)  # three samples of three points
    stage = new_stage(tmp_path / "stage.usda")
    points = triangle(stage).GetPointsAttr()
    triangle(stage, "/Still", seed=1)
    stage.Save()
    scene = rc.Scene.load(tmp_path / "stage.usda")
    assert any("/Mesh.points: its points over time are read up to 3 samples" in line for line in scene.warnings)
    assert any("/Still.points: its points over time are read up to 0 samples" in line for line in scene.warnings)
    still = np.array(UsdGeom.Mesh(stage.GetPrimAtPath("/Still")).GetPointsAttr().Get(TIMES[0]))
    for code in (1.0, 3.25, 4.5, 7.0):
        expected = np.vstack([np.array(points.Get(min(code, TIMES[2]))), still])
        found = np.array(scene.at_time((code - 1) / PER_SECOND).bounds_m)
        assert np.abs(found - [expected.min(0), expected.max(0)]).max() <= TOLERANCE * 10


def test_points_that_are_not_finite_are_one_line(tmp_path: Path) -> None:
    body = """def Mesh "M" { int[] faceVertexCounts = [3]; int[] faceVertexIndices = [0, 1, 2];
    point3f[] points.timeSamples = { 0: [(0, 0, 0), (1, 0, 0), (0, 1, 0)], 5: [(0, 0, 0), (nan, 0, 0), (0, 1, 0)] }
}"""
    with pytest.raises(rc.SceneFileError, match="/M: points at time code 5: expected finite numbers"):
        rc.Scene.load(stage_file(tmp_path, body))


@pytest.mark.parametrize("scheme", ["none", "catmullClark"])
def test_light_follows_the_shape(tmp_path: Path, scheme: str) -> None:
    """A matte floor that tilts by 60 degrees has the luminance of the cosine, without authored normals."""
    body = f"""def Mesh "Floor" {{
    int[] faceVertexCounts = [4]
    int[] faceVertexIndices = [0, 1, 2, 3]
    uniform token subdivisionScheme = "{scheme}"
    point3f[] points.timeSamples = {{
        0: [(-90, 0, 90), (90, 0, 90), (90, 0, -90), (-90, 0, -90)],
        24: [(-90, {90 * np.sin(np.pi / 3)}, 45), (90, {90 * np.sin(np.pi / 3)}, 45),
             (90, {-90 * np.sin(np.pi / 3)}, -45), (-90, {-90 * np.sin(np.pi / 3)}, -45)]
    }}
}}"""
    scene = rc.Scene.load(stage_file(tmp_path, body)).with_sun((0, -1, 0), (1, 1, 1))
    camera = scenes.pinhole(rc.Film(0.1, 0.1, (4, 4)), position=(60, 30, 0), look_at=(0, 0, 0))

    def light(time_s: float) -> float:
        picture = rc.render(scene.at_time(time_s), camera, spp=64, effects=(), max_bounces=0)
        return float(picture.pixels.astype(float).mean())

    for u in (0.3, 1.0):
        tilt = np.arctan2(u * np.sin(np.pi / 3), 1 - u / 2)
        assert light(u) == pytest.approx(light(0) * np.cos(tilt), rel=1e-5)  # floats; the sun has no noise


CUBE_FACES = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]


@pytest.mark.parametrize("scheme", ["catmullClark", "loop"])
def test_subdivided_surfaces_turn_with_their_points(scheme: str) -> None:
    """Subdivision commutes with affine maps: points are mapped as the control points are, normals by the rotation."""
    from realcam.usd.deformation import Deformations
    from realcam.usd.glb import Glb
    from realcam.usd.meshes import mesh_surface
    from realcam.usd.stage import OpenStage
    from realcam.usd.surface import NORMAL_DELTAS, POINT_DELTAS

    turn = np.array(Gf.Matrix3d(Gf.Rotation(Gf.Vec3d(1, 2, 3), 40)))
    corners = np.array([[x, y, z] for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)], float)
    stage = Usd.Stage.CreateInMemory()
    mesh = UsdGeom.Mesh.Define(stage, "/Mesh")
    faces = CUBE_FACES if scheme == "catmullClark" else [f for a, b, c, d in CUBE_FACES for f in ([a, b, c], [a, c, d])]
    mesh.CreateFaceVertexCountsAttr([len(face) for face in faces])
    mesh.CreateFaceVertexIndicesAttr(np.ravel(faces).tolist())
    mesh.CreateSubdivisionSchemeAttr(scheme)
    mesh.CreateCreaseLengthsAttr([3])
    mesh.CreateCreaseIndicesAttr([0, 1, 3])
    mesh.CreateCreaseSharpnessesAttr([1.5])
    moved = (corners, corners @ turn, 3 * corners + [5, 6, 7])
    for code, points in enumerate(moved):
        mesh.CreatePointsAttr().Set(Vt.Vec3fArray.FromNumpy(points.astype(np.float32)), code)
    opened = OpenStage("stage", stage)
    samples = Deformations(opened, Glb()).samples_of(mesh.GetPrim())
    assert samples is not None
    surface = mesh_surface(opened, mesh.GetPrim(), [], samples)
    assert surface is not None
    points, normals = surface.points, surface.values["normals"].rows
    assert len(points) > 90  # two levels
    found = surface.points + surface.values[POINT_DELTAS].rows.reshape(-1, 2, 3).swapaxes(0, 1)
    found_normals = normals + surface.values[NORMAL_DELTAS].rows.reshape(-1, 2, 3).swapaxes(0, 1)
    assert np.abs(found - [points @ turn, 3 * points + [5, 6, 7]]).max() <= TOLERANCE
    assert np.abs(found_normals - [normals @ turn, normals]).max() <= TOLERANCE


@pytest.mark.parametrize(("interpolation", "count"), [("vertex", 4), ("faceVarying", 6), ("uniform", 2)])
def test_authored_normals_follow_their_samples(interpolation: str, count: int) -> None:
    """At first, all corners have the same normal; later, the corners of a point may differ."""
    from realcam.usd.deformation import Deformations
    from realcam.usd.glb import Glb
    from realcam.usd.meshes import mesh_surface
    from realcam.usd.stage import OpenStage
    from realcam.usd.surface import NORMAL_DELTAS, POINT_DELTAS, triangulated, vertex_arrays

    stage = Usd.Stage.CreateInMemory()
    mesh = UsdGeom.Mesh.Define(stage, "/Mesh")
    mesh.CreateFaceVertexCountsAttr([3, 3])
    mesh.CreateFaceVertexIndicesAttr([0, 1, 2, 2, 1, 3])
    mesh.CreateSubdivisionSchemeAttr("none")
    primvar = UsdGeom.PrimvarsAPI(mesh).CreatePrimvar("normals", Sdf.ValueTypeNames.Normal3fArray, interpolation)
    for code in range(3):
        mesh.CreatePointsAttr().Set(random_points(code, 4), code)
        primvar.Set(random_points(10 + code, count) if code else Vt.Vec3fArray(count, Gf.Vec3f(0, 0, 1)), code)
    opened = OpenStage("stage", stage)
    samples = Deformations(opened, Glb()).samples_of(mesh.GetPrim())
    assert samples is not None
    surface = mesh_surface(opened, mesh.GetPrim(), [], samples)
    assert surface is not None
    assert not opened.notices.lines()
    triangles = triangulated(surface)
    points, values, indices = vertex_arrays(surface, triangles)
    corners = triangles.corners.ravel()
    element = {"vertex": surface.corners[corners], "uniform": np.repeat(triangles.face_rows, 3)}.get(
        interpolation, corners
    )
    for code in (1, 2):
        columns = slice(3 * code - 3, 3 * code)
        at_code = (points + values[POINT_DELTAS][:, columns])[indices.ravel()]
        expected = np.array(mesh.GetPointsAttr().Get(code))[surface.corners[corners]]
        assert np.abs(at_code - expected).max() <= 10 * TOLERANCE
        at_code = (values["normals"] + values[NORMAL_DELTAS][:, columns])[indices.ravel()]
        assert np.abs(at_code - np.array(primvar.ComputeFlattened(code))[element]).max() <= 10 * TOLERANCE
