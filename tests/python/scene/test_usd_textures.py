"""Textures of UsdPreviewSurface that are connected to an input of another type."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import realcam as rc

pytest.importorskip("pxr")
oiio = pytest.importorskip("OpenImageIO")

STAGE = """#usda 1.0
(metersPerUnit = 1)
def Material "Paint"
{
    token outputs:surface.connect = </Paint/Surface.outputs:surface>
    def Shader "Surface"
    {
        uniform token info:id = "UsdPreviewSurface"
        float inputs:INPUT.connect = </Paint/Picture.outputs:OUTPUT>
        token outputs:surface
    }
    def Shader "Picture"
    {
        uniform token info:id = "UsdUVTexture"
        asset inputs:file = @picture.png@
        token inputs:sourceColorSpace = "raw"
        float2 inputs:st.connect = </Paint/Reader.outputs:result>
        float3 outputs:OUTPUT
    }
    def Shader "Reader"
    {
        uniform token info:id = "UsdPrimvarReader_float2"
        string inputs:varname = "st"
        float2 outputs:result
    }
}
def Mesh "Wall" (prepend apiSchemas = ["MaterialBindingAPI"])
{
    int[] faceVertexCounts = [4]
    int[] faceVertexIndices = [0, 1, 2, 3]
    point3f[] points = [(-1, -1, -2), (1, -1, -2), (1, 1, -2), (-1, 1, -2)]
    texCoord2f[] primvars:st = [(0, 0), (1, 0), (1, 1), (0, 1)] (interpolation = "vertex")
    uniform token subdivisionScheme = "none"
    rel material:binding = </Paint>
}
def SphereLight "Lamp" { float inputs:intensity = 1000; float inputs:radius = 0.1; }
"""


def scene_of_stage(folder: Path, name: str, output: str) -> rc.Scene:
    picture = oiio.ImageBuf(oiio.ImageSpec(2, 2, 3, "uint8"))
    oiio.ImageBufAlgo.fill(picture, (0.2, 0.6, 0.9))
    assert picture.write(str(folder / "picture.png"))
    path = folder / f"{output}.usda"
    path.write_text(STAGE.replace("INPUT", name).replace("OUTPUT", output))
    return rc.Scene.load(path)


def light(scene: rc.Scene) -> np.ndarray:
    camera = rc.Camera(rc.Lens.load("double-gauss-50mm").focused(2.0), film=rc.Film(36, 24, (12, 8)))
    return rc.render(scene, camera, spp=4, max_bounces=0, progress=False).pixels


@pytest.mark.picture_files
@pytest.mark.parametrize("name", ["roughness", "metallic", "opacity", "clearcoatRoughness"])
def test_a_number_takes_the_first_channel_of_a_colour(tmp_path: Path, name: str) -> None:
    red, colour = (scene_of_stage(tmp_path, name, output) for output in ("r", "rgb"))
    assert red.warnings == []
    assert [f"/Paint/Surface: {name}: " in text for text in colour.warnings] == [True]
    assert (light(colour) == light(red)).all()


@pytest.mark.picture_files
def test_an_output_that_textures_lack_is_left_out(tmp_path: Path) -> None:
    warnings = scene_of_stage(tmp_path, "roughness", "grey").warnings
    assert len(warnings) == 1
    assert "/Paint/Picture: expected the output rgb, r, g, b or a; found grey; it is left out" in warnings[0]
