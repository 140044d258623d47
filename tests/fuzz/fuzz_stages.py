"""Changes the text of USD stages and reads them: each must become a scene, or an error in one line.

See many_mutations.py. It needs the package usd-core (realcam[usd]).
"""

from __future__ import annotations

import random
import re
import sys
import tempfile
import traceback
from functools import cache
from pathlib import Path

from many_mutations import Target, main
from text_mutations import mutated

HEADER = (
    '#usda 1.0\n(\n    metersPerUnit = 0.01\n    upAxis = "Z"\n    startTimeCode = 1\n    timeCodesPerSecond = 24\n)\n'
)

GEOMETRY = """def Xform "World" (variants = { string size = "small"; }; prepend variantSets = "size")
{
    variantSet "size" = {
        "small" { double3 xformOp:scale = (1, 1, 1); }
        "large" { double3 xformOp:scale = (3, 2, 1); }
    }
    float xformOp:rotateZ.timeSamples = { 1: 0, 12: 200, 24: 360 }
    uniform token[] xformOpOrder = ["xformOp:rotateZ", "xformOp:scale"]
    def Mesh "Polygons"
    {
        int[] faceVertexCounts = [4, 3]
        int[] faceVertexIndices = [0, 1, 2, 3, 1, 4, 2]
        point3f[] points.timeSamples = {
            1: [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (2, 0, 1)],
            9: [(0, 0, 1), (1, 0, 0), (1, 2, 0), (0, 1, 0), (2, 0, 1)],
        }
        uniform token subdivisionScheme = "none"
        normal3f[] normals = [(0, 0, 1), (0, 0, 1), (0, 0, 1), (0, 0, 1), (0, 1, 0)]
        texCoord2f[] primvars:st = [(0, 0), (1, 0), (1, 1)] (interpolation = "faceVarying")
        int[] primvars:st:indices = [0, 1, 2, 0, 1, 2, 0]
        color3f[] primvars:displayColor = [(1, 0, 0), (0, 1, 0)] (interpolation = "uniform")
        int[] holeIndices = [1]
    }
    def Mesh "Subdivided"
    {
        int[] faceVertexCounts = [4, 4, 4]
        int[] faceVertexIndices = [0, 1, 2, 3, 4, 5, 1, 0, 1, 5, 6, 2]
        point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1)]
        point3f[] points.timeSamples = {
            1: [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1)],
            24: [(0, 0, 5), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 2), (1, 0, 1), (1, 1, 1)],
        }
        int[] creaseIndices = [0, 1, 2]
        int[] creaseLengths = [3]
        float[] creaseSharpnesses = [1.5]
        int[] cornerIndices = [3]
        float[] cornerSharpnesses = [10]
    }
    def PointInstancer "Copies"
    {
        rel prototypes = [</World/Copies/Ball>, </World/Polygons>]
        int[] protoIndices = [0, 1, 0]
        point3f[] positions = [(0, 0, 0), (4, 0, 0), (8, 0, 0)]
        quath[] orientations = [(1, 0, 0, 0), (0.7, 0, 0.7, 0), (1, 0, 0, 0)]
        float3[] scales = [(1, 1, 1), (1, 2, 3), (0.5, 0.5, 0.5)]
        int64[] invisibleIds = [2]
        def Sphere "Ball" { double radius = 0.4; }
    }
}
"""

LOOK = """def Scope "Look"
{
    def Material "Paint"
    {
        token outputs:surface.connect = </Look/Paint/Surface.outputs:surface>
        def Shader "Surface"
        {
            uniform token info:id = "UsdPreviewSurface"
            color3f inputs:diffuseColor.connect = </Look/Paint/Picture.outputs:rgb>
            float inputs:roughness.connect = </Look/Paint/Picture.outputs:g>
            float inputs:opacity = 0.5
            color3f inputs:emissiveColor = (1, 2, 3)
            token outputs:surface
        }
        def Shader "Picture"
        {
            uniform token info:id = "UsdUVTexture"
            asset inputs:file = @seed.png@
            float4 inputs:scale = (1, 2, 1, 1)
            float4 inputs:bias = (0, 0.1, 0, 0)
            token inputs:wrapS = "mirror"
            float2 inputs:st.connect = </Look/Paint/Turn.outputs:result>
            float3 outputs:rgb
            float outputs:g
        }
        def Shader "Turn"
        {
            uniform token info:id = "UsdTransform2d"
            float2 inputs:in.connect = </Look/Paint/Reader.outputs:result>
            float inputs:rotation = 30
            float2 outputs:result
        }
        def Shader "Reader"
        {
            uniform token info:id = "UsdPrimvarReader_float2"
            string inputs:varname = "st"
            float2 outputs:result
        }
    }
}
def Cube "Box" (prepend apiSchemas = ["MaterialBindingAPI"]) { rel material:binding = </Look/Paint>; }
"""

LIGHTS = """def SphereLight "Lamp" (prepend apiSchemas = ["ShapingAPI"])
{
    float inputs:intensity = 100
    float inputs:exposure = 2
    bool inputs:normalize = 1
    float inputs:shaping:cone:angle = 40
    float inputs:shaping:cone:softness = 0.2
}
def RectLight "Panel"
{
    float inputs:width = 2
    bool inputs:enableColorTemperature = 1
    float inputs:colorTemperature = 3000
}
def CylinderLight "Tube" { float inputs:radius = 0.1; }
def DistantLight "Sun" { float inputs:angle = 0.5; }
def DomeLight "Sky" { float inputs:intensity = 3; asset inputs:texture:file = @seed.png@; }
def Camera "Main"
{
    float focalLength = 35
    float horizontalAperture = 36
    float focusDistance.timeSamples = { 1: 100, 24: 200 }
    float fStop = 2.8
    custom string realcam:lens = "double-gauss-50mm"
    double3 xformOp:translate.timeSamples = { 1: (0, 0, 9), 24: (1, 0, 9) }
    uniform token[] xformOpOrder = ["xformOp:translate"]
}
def Cylinder "Post" { token axis = "X"; double height = 3; }
def "Copy" (prepend references = </Post>; instanceable = true) { }
"""

WORD = re.compile(r'"\w+"|[\w:]+')
EXTREMES = ("0", "-1", "1e38", "-1e38", "1e-38", "2147483647", "-2147483648", "1e300", "nan", "inf", "0.5")


def seeds() -> list[str]:
    return [HEADER + body for body in (GEOMETRY, LOOK, LIGHTS, GEOMETRY + LOOK + LIGHTS)]


def case_of(stages: list[str], seed: int, number: int) -> str:
    draw = random.Random(seed * 2**40 + number)
    text = stages[number % len(stages)]
    for _ in range(draw.randint(1, 4)):
        text = mutated(text, draw, WORD, EXTREMES) or "#"
    return text


@cache
def scratch() -> tempfile.TemporaryDirectory[str]:
    """Kept until the process ends, with a picture for the stages."""
    import OpenImageIO as oiio

    folder = tempfile.TemporaryDirectory(prefix="realcam-fuzz-")
    buffer = oiio.ImageBuf(oiio.ImageSpec(8, 4, 3, "uint8"))
    oiio.ImageBufAlgo.fill(buffer, (0.2, 0.5, 0.9))
    buffer.write(str(Path(folder.name, "seed.png")))
    return folder


def read(case: str) -> tuple[str, str]:
    import realcam as rc
    from realcam.usd import camera_settings

    # usd-core keeps layers by their names.
    with tempfile.NamedTemporaryFile("w", suffix=".usda", dir=scratch().name, encoding="utf-8") as file:
        file.write(case)
        file.flush()
        try:
            camera_settings(file.name, 1.0, [], "")
            scene = rc.Scene.load(file.name)
            messages, outcome = scene.at_time(0.3).warnings, "read"
        except rc.RealcamError as error:
            messages, outcome = [str(error)], "refused"
        except BaseException:
            return "broken", traceback.format_exc(limit=-3)
    long = [text for text in messages if "\n" in text or len(text) > 2500]
    return ("broken", f"a message of several lines, or a long one: {long[0]}") if long else (outcome, "")


if __name__ == "__main__":
    sys.exit(main(__doc__ or "", __file__, Target("stages", seeds, case_of, read)))
