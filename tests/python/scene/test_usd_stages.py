"""USD stages: what realcam reads, compared with usd-core's own evaluation and with closed forms."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import realcam as rc

pytest.importorskip("pxr")

from pxr import Gf, Sdf, Usd, UsdGeom

# Points and normals pass through 32-bit floats, of 6e-8 relative rounding, and matrices of the stage are doubles.
TOLERANCE = 1e-6

QUAD = """int[] faceVertexCounts = [4]
        int[] faceVertexIndices = [0, 1, 2, 3]
        point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
        uniform token subdivisionScheme = "none"
"""


def stage_file(folder: Path, body: str, header: str = "metersPerUnit = 1", name: str = "stage.usda") -> Path:
    path = folder / name
    path.write_text(f"#usda 1.0\n(\n    {header}\n)\n{body}")
    return path


def world_bounds(path: Path) -> np.ndarray:
    """Bounds by usd-core, in metres, in the frame of scenes, where y is up."""
    stage = Usd.Stage.Open(str(path))
    cache = UsdGeom.BBoxCache(Usd.TimeCode(stage.GetStartTimeCode()), ["default", "render"])
    box = cache.ComputeWorldBound(stage.GetPseudoRoot()).ComputeAlignedRange()
    low, high = np.array(box.GetMin()), np.array(box.GetMax())
    if UsdGeom.GetStageUpAxis(stage) == "Z":
        low, high = np.array([low[0], low[2], -high[1]]), np.array([high[0], high[2], -low[1]])
    return UsdGeom.GetStageMetersPerUnit(stage) * np.array([low, high])


def compare_bounds(path: Path) -> None:
    expected = world_bounds(path)
    found = np.array(rc.Scene.load(path).bounds_m)
    assert np.abs(found - expected).max() <= TOLERANCE * np.ptp(expected, axis=0).max()


@pytest.mark.parametrize("header", ["metersPerUnit = 1", 'metersPerUnit = 0.01; upAxis = "Z"', 'upAxis = "Y"'])
def test_units_axes_and_nested_transforms(tmp_path: Path, header: str) -> None:
    body = f"""def Xform "Outer" {{
    double3 xformOp:translate = (100.25, -3, 7)
    float3 xformOp:rotateXYZ = (20, 30, 40)
    float3 xformOp:scale = (1, -2, 0.5)
    uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:rotateXYZ", "xformOp:scale"]
    def Mesh "Inner" {{
        matrix4d xformOp:transform = ((1, 0.2, 0, 0), (0, 2, 0, 0), (0.1, 0, 1, 0), (0, 5, 0, 1))
        uniform token[] xformOpOrder = ["xformOp:transform"]
        {QUAD} }}
    def Mesh "Reset" {{
        double3 xformOp:translate = (90, 0, 9)
        uniform token[] xformOpOrder = ["!resetXformStack!", "xformOp:translate"]
        {QUAD} }}
}}"""
    compare_bounds(stage_file(tmp_path, body, header))


@pytest.mark.parametrize(
    "shape",
    [
        'Cube "C" { double size = 3; }',
        'Sphere "S" { double radius = 2; }',
        'Cylinder "C" { double radius = 2; double height = 5; token axis = "X"; }',
        'Cone "C" { double radius = 2; double height = 5; token axis = "Y"; }',
        'Capsule "C" { double radius = 1; double height = 5; }',
        'Plane "P" { double width = 2; double length = 5; token axis = "X"; }',
        'Plane "P" { double width = 2; double length = 5; token axis = "Y"; }',
        'Plane "P" { double width = 2; double length = 5; }',
    ],
)
def test_extents_of_shapes(tmp_path: Path, shape: str) -> None:
    compare_bounds(stage_file(tmp_path, f"def {shape}"))


def test_point_instancer_with_nested_prototypes(tmp_path: Path) -> None:
    body = f"""def PointInstancer "Copies" {{
    rel prototypes = [</Copies/Group>]
    int[] protoIndices = [0, 0, 0]
    point3f[] positions = [(0, 0, 0), (10, 0, 0), (99, 0, 0)]
    quath[] orientations = [(1, 0, 0, 0), (0.5, 0.5, 0.5, 0.5), (1, 0, 0, 0)]
    float3[] scales = [(1, 1, 1), (2, 3, 4), (1, 1, 1)]
    int64[] invisibleIds = [2]
    def Xform "Group" {{
        double3 xformOp:translate = (0, 7, 0)
        uniform token[] xformOpOrder = ["xformOp:translate"]
        def Xform "Part" {{
            float xformOp:rotateZ = 30
            uniform token[] xformOpOrder = ["xformOp:rotateZ"]
            def Mesh "Quad" {{ {QUAD} }}
        }}
    }}
}}"""
    path = stage_file(tmp_path, body)
    compare_bounds(path)
    assert rc.Scene.load(path).triangle_count == 4


def test_purpose_visibility_references_and_variants(tmp_path: Path) -> None:
    stage_file(tmp_path, 'def Cube "Part" { double size = 2; }', 'defaultPrim = "Part"', name="part.usda")
    body = """def Xform "Chair" (
    variants = { string size = "small"; }
    prepend variantSets = "size"
) {
    variantSet "size" = {
        "small" { def "Leg" (references = @part.usda@) { }
        }
        "large" { def "Leg" (references = @part.usda@) {
            float3 xformOp:scale = (5, 5, 5)
            uniform token[] xformOpOrder = ["xformOp:scale"]
        }
        }
    }
}
def Cube "Proxy" { uniform token purpose = "proxy"
    double size = 50; }
def Cube "Hidden" { token visibility = "invisible"
    double size = 50; }
"""
    path = stage_file(tmp_path, body)
    assert np.array(rc.Scene.load(path).bounds_m).max() == pytest.approx(1)
    assert np.array(rc.Scene.load(path, variants=["/Chair{size=large}"]).bounds_m).max() == pytest.approx(5)
    for selection, message in (
        ("/Chair{size=huge}", 'expected large, small; found "huge"'),
        ("/Chair{colour=red}", 'has no variant set "colour"'),
        ("/Table{size=large}", 'there is no prim "/Table"'),
        ("Chair=large", 'expected a selection such as "/Chair{color=red}"'),
    ):
        with pytest.raises(rc.InputError, match="variant") as error:
            rc.Scene.load(path, variants=[selection])
        assert message in str(error.value)
    shot = tmp_path / "shot.toml"
    shot.write_text('format = 1\nscene = "stage.usda"\nvariants = ["/Chair{size=large}"]\nexposure_time_s = 1\n')
    assert np.array(rc.Shot.load(shot).scene.bounds_m).max() == pytest.approx(5)


@pytest.mark.parametrize(
    ("interpolation", "count"), [("constant", 1), ("uniform", 2), ("varying", 6), ("vertex", 6), ("faceVarying", 8)]
)
def test_primvars_in_all_interpolations(interpolation: str, count: int) -> None:
    """Values of each corner of each triangle, compared with UsdGeom.Primvar.ComputeFlattened."""
    from realcam.usd.meshes import mesh_surface
    from realcam.usd.stage import OpenStage
    from realcam.usd.surface import triangulated, vertex_arrays

    stage = Usd.Stage.CreateInMemory()
    mesh = UsdGeom.Mesh.Define(stage, "/Mesh")
    mesh.CreatePointsAttr([(0, 0, 0), (1, 0, 0), (2, 0, 0), (0, 1, 0), (1, 1, 0), (2, 1, 0)])
    mesh.CreateFaceVertexCountsAttr([4, 4])
    mesh.CreateFaceVertexIndicesAttr([0, 1, 4, 3, 1, 2, 5, 4])
    mesh.CreateSubdivisionSchemeAttr("none")
    primvar = UsdGeom.PrimvarsAPI(mesh).CreatePrimvar("st", Sdf.ValueTypeNames.TexCoord2fArray, interpolation)
    primvar.Set([Gf.Vec2f(i, i * i) for i in range(count)])
    primvar.SetIndices([(3 * i) % count for i in range(count)])
    surface = mesh_surface(OpenStage("stage", stage), mesh.GetPrim(), ["st"])
    assert surface is not None
    triangles = triangulated(surface)
    points, values, indices = vertex_arrays(surface, triangles)
    flat = np.array(primvar.ComputeFlattened())
    element = {
        "constant": np.zeros(12, int),
        "uniform": np.repeat(triangles.face_rows, 3),
        "faceVarying": triangles.corners.ravel(),
    }.get(interpolation, surface.corners[triangles.corners.ravel()])
    assert np.array_equal(values["st"][indices.ravel()], flat[element])
    assert np.array_equal(points[indices], np.array(mesh.GetPointsAttr().Get())[surface.corners[triangles.corners]])


def test_concave_faces_keep_their_area() -> None:
    from realcam.usd.surface import Surface, triangulated

    angles = np.arange(40) * 2 * np.pi / 40
    radii = np.where(np.arange(40) % 2, 1.0, 0.3)
    star = np.stack([radii * np.cos(angles), radii * np.sin(angles), 0 * angles], axis=-1)
    for points in (star, star[::-1]):
        corners = triangulated(Surface(points, np.array([40]), np.arange(40), np.arange(1))).corners
        a, b, c = np.moveaxis(points[corners], 1, 0)
        areas = np.cross(b - a, c - a)[:, 2] / 2
        assert np.abs(areas).sum() == pytest.approx(abs(areas.sum()))  # no triangle lies outside
        assert np.abs(areas).sum() == pytest.approx(20 * 0.3 * np.sin(np.pi / 20))


def test_limit_of_a_catmull_clark_cube() -> None:
    """A corner of the cube of +-1 has the limit (9 v + 4 sum of edges + sum of faces) / 24 = 1 / 2 (Halstead 1993); its
    normal is along the diagonal."""
    from realcam.usd.subdivision import Sharpness, subdivided
    from realcam.usd.surface import Surface

    points = np.array([[x, y, z] for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)], float)
    faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    cube = Surface(points, np.full(6, 4), np.ravel(faces), np.arange(6))
    no_creases = Sharpness(np.zeros((0, 2), int), np.zeros(0), np.zeros(0, int), np.zeros(0))
    smooth = subdivided(cube, "catmullClark", no_creases)
    assert np.abs(smooth.points[:8] - points / 2).max() < 1e-12
    assert np.abs(smooth.values["normals"].rows[:8] - points / np.sqrt(3)).max() < 1e-12
    edges = np.array([[a, b] for face in faces for a, b in zip(face, [*face[1:], face[0]], strict=True)])
    sharp = subdivided(cube, "catmullClark", Sharpness(edges, np.full(24, 10.0), np.zeros(0, int), np.zeros(0)))
    assert np.abs(sharp.points[:8] - points).max() < 1e-12


def test_motion_follows_usd(tmp_path: Path) -> None:
    """A whole turn between two samples, in the seconds of the stage."""
    body = """def Cube "Wheel" {
    double3 xformOp:translate.timeSamples = { 10: (0, 0, 0), 34: (2, 0, 0) }
    float xformOp:rotateZ.timeSamples = { 10: 0, 34: 360 }
    uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:rotateZ"]
}"""
    path = stage_file(tmp_path, body, "metersPerUnit = 1; startTimeCode = 10; timeCodesPerSecond = 24")
    scene, stage = rc.Scene.load(path), Usd.Stage.Open(str(path))

    def expected(time_s: float) -> np.ndarray:
        cache = UsdGeom.XformCache(Usd.TimeCode(10 + 24 * time_s))
        return np.array(cache.GetLocalToWorldTransform(stage.GetPrimAtPath("/Wheel"))).T

    def found(time_s: float) -> np.ndarray:
        return np.asarray(scene.at_time(time_s).instances[0][1])

    for time_s in (0.0, 0.1, 0.37, 0.5, 0.99, 1.0):
        difference = found(time_s) @ np.linalg.inv(found(0)) - expected(time_s) @ np.linalg.inv(expected(0))
        # Between keys, which are as close as a matrix may differ by 1e-3 in their middle, glTF and USD interpolate
        # rotations by different formulas.
        assert np.abs(difference).max() < 2e-3


@pytest.mark.parametrize("axis", ["X", "up"])
def test_another_up_axis_is_named(tmp_path: Path, axis: str) -> None:
    """UsdGeom defines Y and Z."""
    path = stage_file(tmp_path, 'def Cube "C" { }', f'upAxis = "{axis}"')
    assert any(f"upAxis: expected Y or Z; found {axis}" in line for line in rc.Scene.load(path).warnings)


POINTS = "point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]"


@pytest.mark.parametrize(
    ("body", "message"),
    [
        (
            f'def Mesh "M" {{ int[] faceVertexCounts = [3]; int[] faceVertexIndices = [0, 1, 9]; {POINTS}; }}',
            "/M: faceVertexIndices: expected indices from 0 to 2; found 9",
        ),
        (
            f'def Mesh "M" {{ int[] faceVertexCounts = [4]; int[] faceVertexIndices = [0, 1, 2]; {POINTS}; }}',
            "/M: faceVertexIndices: expected 4 indices; found 3",
        ),
        ("def Mesh { nonsense", "is not a valid USD stage"),
        (
            'def Cube "C" { }\ndef PointInstancer "P" { rel prototypes = [</C>]; int[] protoIndices = [3]; '
            "point3f[] positions = [(0, 0, 0)]; }",
            "/P: protoIndices: expected numbers from 0 to 0; found 3",
        ),
    ],
)
def test_bad_input_is_one_line(tmp_path: Path, body: str, message: str) -> None:
    path = stage_file(tmp_path, body)
    with pytest.raises(rc.SceneFileError) as error:
        rc.Scene.load(path)
    text = str(error.value)
    assert text.startswith(f"{path}: ")
    assert message in text
    assert "\n" not in text


def test_a_name_in_a_package_that_no_file_may_have_is_one_line(tmp_path: Path) -> None:
    name = f"{'a' * 300}.exr"
    (tmp_path / "sky").write_bytes(b"no PNG")
    (tmp_path / "stage.usda").write_text(f'#usda 1.0\ndef DomeLight "D" {{ asset inputs:texture:file = @./{name}@; }}')
    with Sdf.ZipFileWriter.CreateNew(str(tmp_path / "stage.usdz")) as package:
        package.AddFile(str(tmp_path / "stage.usda"), "stage.usda")
        package.AddFile(str(tmp_path / "sky"), name)
    with pytest.raises(rc.SceneFileError, match="name too long"):
        rc.Scene.load(tmp_path / "stage.usdz")


def test_notices_name_what_is_left_out(tmp_path: Path) -> None:
    body = """def Cube "Box" (references = @missing.usda@) { }
def BasisCurves "Hair" { }
def DistantLight "Sun" { float inputs:angle = 3; }
"""
    warnings = "\n".join(rc.Scene.load(stage_file(tmp_path, body)).warnings)
    for text in ("missing.usda", "/Hair: a BasisCurves is left out", "/Sun: the angle of the distant light"):
        assert text in warnings


def test_package_is_imported_on_first_use() -> None:
    code = "import sys, realcam; sys.exit(any(name.split('.')[0] == 'pxr' for name in sys.modules))"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_without_usd_core(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pxr", None)
    with pytest.raises(rc.SceneFileError, match=r"pip install realcam\[usd\]"):
        rc.Scene.load(stage_file(tmp_path, 'def Cube "C" { }'))
