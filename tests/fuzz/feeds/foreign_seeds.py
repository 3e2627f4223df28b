"""Contents of files of foreign scenes, from which faulty ones are made: Mitsuba, USD, frames, motion capture."""
from __future__ import annotations

import io
import tempfile
from pathlib import Path

import numpy as np

CORPUS = Path(__file__).parents[1] / "corpus"
MITSUBA = ["""<scene version="3.0.0">
<default name="spp" value="16"/>
<bsdf type="twosided" id="mat-itu_concrete">
<bsdf type="diffuse"/>
</bsdf>
<bsdf type="itu-radio-material" id="box-mat"> <string name="type" value="metal"/> </bsdf>
<bsdf type="radio-material" id="own">
<float name="relative_permittivity" value="5"/>
<float name="conductivity" value="0.1"/>
<float name="thickness" value="0.004"/>
</bsdf>
<sensor type="perspective"> <transform name="to_world"> <lookat origin="0 0 5" target="1 0 0" up="0 0 1"/> </transform> </sensor>
<include filename="more.xml"/>
<shape type="ply" id="mesh-wall">
<string name="filename" value="wall.ply"/>
<ref id="mat-itu_concrete" name="bsdf"/>
<transform name="to_world">
<scale value="2"/>
<rotate x="0" y="0" z="1" angle="90"/>
<translate x="$spp" y="2" z="3"/>
<matrix value="1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1"/>
</transform>
</shape>
<shape type="shapegroup" id="group">
<shape type="cube"> <ref id="box-mat"/> </shape>
<shape type="sphere"> <float name="radius" value="0.5"/> <point name="center" x="1" y="0" z="0"/> </shape>
</shape>
<shape type="instance"> <ref id="group"/> <transform name="to_world"> <translate value="5 0 0"/> </transform> </shape>
<shape type="cylinder"> <point name="p0" value="0 0 0"/> <point name="p1" value="0 0 2"/> <ref id="own"/> </shape>
<shape type="obj"> <string name="filename" value="wall.obj"/> </shape>
<shape type="merge"> <shape type="disk"/> <shape type="rectangle"/> </shape>
</scene>
""", '<scene version="2.1.0">\n<shape type="rectangle" id="a"/>\n<include filename="scene.xml"/>\n</scene>\n']
USD = ['''#usda 1.0
(
    defaultPrim = "World"
    metersPerUnit = 0.01
    upAxis = "Y"
    startTimeCode = 0
    endTimeCode = 24
    timeCodesPerSecond = 24
)
def Xform "World"
{
    double3 xformOp:translate = (0, 1, 2)
    double3 xformOp:rotateXYZ.timeSamples = { 0: (0, 0, 0), 24: (0, 90, 0), }
    uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:rotateXYZ"]
    def Mesh "wall" ( prepend apiSchemas = ["MaterialBindingAPI"] )
    {
        int[] faceVertexCounts = [4, 3]
        int[] faceVertexIndices = [0, 1, 2, 3, 0, 2, 4]
        point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1)]
        point3f[] points.timeSamples = {
            0: [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1)],
            24: [(0, 0, 0), (2, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1)],
        }
        rel material:binding = </World/Looks/Concrete>
        def GeomSubset "pane" ( prepend apiSchemas = ["MaterialBindingAPI"] )
        {
            uniform token elementType = "face"
            uniform token familyName = "materialBind"
            int[] indices = [1]
            rel material:binding = </World/Looks/Glass>
        }
    }
    def Sphere "ball"
    {
        double radius = 0.5
        token visibility = "inherited"
    }
    def Cube "box"
    {
        double size = 2
    }
    def Capsule_1 "lamp"
    {
        double radiusTop = 0.1
        double radiusBottom = 0.2
        double height = 1
        uniform token axis = "X"
    }
    def Cylinder "post"
    {
        double height = 2
        uniform token axis = "X"
    }
    def PointInstancer "trees"
    {
        point3f[] positions = [(0, 0, 0), (5, 0, 0)]
        quath[] orientations = [(1, 0, 0, 0), (1, 0, 0, 0)]
        int[] protoIndices = [0, 0]
        rel prototypes = </World/trees/tree>
        def Xform "tree"
        {
            def Sphere "crown"
            {
                double radius = 1
            }
        }
    }
    def Scope "Looks"
    {
        def Material "Concrete"
        {
        }
        def Material "Glass"
        {
        }
    }
}
''', '''#usda 1.0
(
    upAxis = "Z"
)
def SkelRoot "person"
{
    def Skeleton "bones" ( prepend apiSchemas = ["SkelBindingAPI"] )
    {
        uniform token[] joints = ["hip", "hip/knee"]
        uniform matrix4d[] bindTransforms = [((1,0,0,0),(0,1,0,0),(0,0,1,0),(0,0,0,1)), ((1,0,0,0),(0,1,0,0),(0,0,1,0),(0,0,1,1))]
        uniform matrix4d[] restTransforms = [((1,0,0,0),(0,1,0,0),(0,0,1,0),(0,0,0,1)), ((1,0,0,0),(0,1,0,0),(0,0,1,0),(0,0,1,1))]
        rel skel:animationSource = </person/walk>
    }
    def SkelAnimation "walk"
    {
        uniform token[] joints = ["hip", "hip/knee"]
        float3[] translations.timeSamples = { 0: [(0, 0, 0), (0, 0, 1)], 10: [(1, 0, 0), (0, 0, 1)], }
        quatf[] rotations = [(1, 0, 0, 0), (1, 0, 0, 0)]
        half3[] scales = [(1, 1, 1), (1, 1, 1)]
    }
    def Mesh "skin" ( prepend apiSchemas = ["SkelBindingAPI"] )
    {
        int[] faceVertexCounts = [3, 3]
        int[] faceVertexIndices = [0, 1, 2, 1, 3, 2]
        point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 0, 1), (1, 0, 1)]
        int[] primvars:skel:jointIndices = [0, 1, 0, 1, 0, 1, 0, 1] (
            elementSize = 2
            interpolation = "vertex"
        )
        float[] primvars:skel:jointWeights = [1, 0, 0.5, 0.5, 0, 1, 0, 1] (
            elementSize = 2
            interpolation = "vertex"
        )
        matrix4d primvars:skel:geomBindTransform = ((1,0,0,0),(0,1,0,0),(0,0,1,0),(0,0,0.5,1))
        rel skel:skeleton = </person/bones>
    }
}
''', '''#usda 1.0
(
    metersPerUnit = 1
    upAxis = "Z"
    timeCodesPerSecond = 10
)
def SkelRoot "face"
{
    def Skeleton "bones" ( prepend apiSchemas = ["SkelBindingAPI"] )
    {
        uniform token[] joints = ["hip"]
        uniform matrix4d[] bindTransforms = [((1,0,0,0),(0,1,0,0),(0,0,1,0),(0,0,0,1))]
        uniform matrix4d[] restTransforms = [((1,0,0,0),(0,1,0,0),(0,0,1,0),(0,0,0,1))]
        rel skel:animationSource = </face/talk>
    }
    def SkelAnimation "talk"
    {
        uniform token[] blendShapes = ["smile", "open"]
        float[] blendShapeWeights.timeSamples = { 0: [0, 0], 10: [1, 0.5] }
    }
    def Mesh "skin" ( prepend apiSchemas = ["SkelBindingAPI"] )
    {
        int[] faceVertexCounts = [3, 3]
        int[] faceVertexIndices = [0, 1, 2, 1, 3, 2]
        point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 0, 1), (1, 0, 1)]
        uniform token[] skel:blendShapes = ["open", "smile"]
        rel skel:blendShapeTargets = [</face/skin/open>, </face/skin/smile>]
        rel skel:skeleton = </face/bones>
        def BlendShape "open"
        {
            uniform vector3f[] offsets = [(0, 0, -1), (0, 0, -1)]
            uniform int[] pointIndices = [0, 1]
        }
        def BlendShape "smile"
        {
            uniform vector3f[] offsets = [(0, 1, 0), (0, 1, 0), (0, 1, 0), (0, 1, 0)]
            uniform vector3f[] inbetweens:half = [(0, 0.2, 0), (0, 0.2, 0), (0, 0.2, 0), (0, 0.2, 0)] (
                weight = 0.5
            )
        }
    }
}
''']
BVH = """HIERARCHY
ROOT Hips
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation
LIMBS}
MOTION
Frames: 3
Frame Time: 0.0333333
"""
LIMBS = [("Spine", "0 10 0", [("Neck", "0 45 0", [("Head", "0 10 0", [])]),
                              *((f"{side}Arm", f"{18 * sign} 40 0", [(f"{side}ForeArm", f"{28 * sign} 0 0",
                                                                      [(f"{side}Hand", f"{25 * sign} 0 0", [])])])
                                for side, sign in (("Left", 1), ("Right", -1)))]),
         *((f"{side}UpLeg", f"{9 * sign} 0 0", [(f"{side}Leg", "0 -42 0", [(f"{side}Foot", "0 -42 0",
                                                                         [(f"{side}ToeBase", "0 -6 14", [])])])])
           for side, sign in (("Left", 1), ("Right", -1)))]


def bvh_text(frames: np.ndarray, frame_time: float = 1 / 30) -> str:
    """A motion capture in cm of a person with y up; frames [T, 6 + 3 * 17]: root position and angles in degrees."""
    def joints(tree) -> str:
        return "".join(f"JOINT {name}\n{{\nOFFSET {offset}\nCHANNELS 3 Zrotation Yrotation Xrotation\n" +
                       (joints(below) if below else "End Site\n{\nOFFSET 0 8 0\n}\n") + "}\n" for name, offset, below in tree)

    head, _, _ = BVH.replace("LIMBS", joints(LIMBS)).partition("Frames:")
    rows = "\n".join(" ".join(f"{value:.9g}" for value in row) for row in frames)
    return f"{head}Frames: {len(frames)}\nFrame Time: {frame_time:.9g}\n{rows}\n"


def walk_frames(count: int) -> np.ndarray:
    """Channels of `count` frames of someone who goes ahead and swings arms and legs a little."""
    time = np.arange(count) / 30
    frames = np.zeros((count, 6 + 3 * 17))
    frames[:, 1], frames[:, 2] = 90.0, 130.0 * time
    for joint, sign in ((6, 1), (9, -1), (12, 1), (15, -1)):
        frames[:, 6 + joint + 2] = 15.0 * sign * np.sin(2 * np.pi * time)
    return frames


def archive(**arrays) -> bytes:
    """The bytes of a .npz file."""
    content = io.BytesIO()
    np.savez(content, **arrays)
    return content.getvalue()


def frame_text(bend: float) -> bytes:
    """A frame of a folder: two groups of an object, with normals and a smoothing group, of quads and a triangle."""
    return f"""v 0 0 {bend}
v 1 0 0
v {1 - 9 * bend} {1 - 9 * bend} 0
v 0 1 {bend}
vn 0 0 1
vn 0 {bend} 1
o body
g sheet
usemtl steel
f 1//1 2//2 3//1 4//2
s 1
g flap
f 1 2 3
""".encode()


def packed_stages(suffix: str) -> list[bytes]:
    """The stages of USD in its binary format (.usdc) or in packages (.usdz), as its library writes them."""
    from pxr import Sdf, Usd, UsdUtils

    found = []
    with tempfile.TemporaryDirectory() as folder:
        text, binary, package = (Path(folder) / f"stage{kind}" for kind in (".usda", ".usdc", ".usdz"))
        for stage in USD:
            text.write_text(stage)
            Usd.Stage.Open(str(text)).Export(str(binary))
            if suffix == package.suffix:
                UsdUtils.CreateNewUsdzPackage(Sdf.AssetPath(str(binary)), str(package))
            found.append((Path(folder) / f"stage{suffix}").read_bytes())
    return found


def seeds_of(suffix: str) -> list[bytes]:
    """Contents of files of one kind."""
    if suffix in (".usdc", ".usdz"):
        return packed_stages(suffix)
    if suffix in (".obj", ".stl", ".off"):
        return [file.read_bytes() for file in sorted((CORPUS / suffix[1:]).iterdir())]
    moving = np.array([[[0, 0, 0], [1, 0, 0], [1, 1, i], [0, 1, 0]] for i in range(3)], float)
    faces = [[0, 1, 2], [0, 2, 3]]
    return {".xml": [text.encode() for text in MITSUBA], ".usda": [text.encode() for text in USD],
            ".npz": [archive(vertices=moving, triangles=faces, times=[0.0, 0.1, 0.2]),
                     archive(vertices=moving[:1], faces=faces), archive(vertices=moving, triangles=faces, frame_rate=25),
                     archive(vertices=moving, triangles=faces, normals=moving[2])],
            ".bvh": [bvh_text(walk_frames(3)).encode(), bvh_text(walk_frames(1)).encode()]}[suffix]
