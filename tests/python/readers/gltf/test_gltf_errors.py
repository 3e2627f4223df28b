"""Files of glTF that are faulty, cut off or out of measure are refused by name."""
import json

import pytest

import echopath as ep
from support.files.gltf_files import box_file, loaded


def changed(place: str, value) -> dict:
    """The document of the box with another value at a place."""
    document = json.loads(box_file().gltf())
    *keys, last = [int(key) if key.isdigit() else key for key in place.split(".")]
    at = document
    for key in keys:
        at = at[key]
    at[last] = value
    return document


FAULTS = [
    ("asset.version", "1.0", r"asset\.version: must be 2\.0, is '1\.0'"),
    ("asset", 3, r"asset: must be an object, is 3"),
    ("extensionsRequired", ["KHR_meshopt_compression"], "requires the extension KHR_meshopt_compression, which is not"),
    ("extensionsRequired", ["EXT_new_meshes"], "requires the extension EXT_new_meshes, which is not"),
    ("meshes.0.primitives.0.attributes.POSITION", 7, r"meshes\[0\]\.primitives\[0\]\.attributes\.POSITION: must be a whole n"),
    ("meshes.0.primitives.0.attributes.POSITION", "x", "POSITION: must be a whole number from 0 to 1, is 'x'"),
    ("meshes.0.primitives.0.attributes.POSITION", 1, r"accessors\[1\]\.type: must be VEC3 for meshes\[0\]"),
    ("meshes.0.primitives.0.mode", 7, r"mode: must be a whole number from 0 to 6, is 7"),
    ("meshes.0.primitives", [], r"meshes\[0\]\.primitives: must hold at least one primitive"),
    ("meshes", {}, "meshes: must be a list, is {}"),
    ("accessors.0.count", 9, r"accessors\[0\]: ends at byte 108 of bufferViews\[0\], which has 96 bytes"),
    ("accessors.0.count", -1, r"accessors\[0\]\.count: must be a whole number from 1"),
    ("accessors.0.byteOffset", 4, r"accessors\[0\]: ends at byte 100"),
    ("accessors.0.componentType", 5130, r"componentType: must be one of 5120"),
    ("accessors.1.count", 4, "has 4 corners, which make no whole triangles"),
    ("bufferViews.0.byteLength", 10000, r"bufferViews\[0\]\.byteLength: ends at byte 10000 of a buffer of"),
    ("bufferViews.0.buffer", 1, r"bufferViews\[0\]\.buffer: must be a whole number from 0 to 0, is 1"),
    ("buffers.0.byteLength", 10**9, r"buffers\[0\]\.byteLength: is 1000000000, but there are"),
    ("buffers.0.uri", "data:;base64,!!", r"buffers\[0\]\.uri: holds no base64"),
    ("buffers.0.uri", "no.bin", r"buffers\[0\]\.uri: no\.bin is no file that is there"),
    ("buffers.0", {"byteLength": 9}, r"buffers\[0\]: has no uri, and there is no binary chunk"),
    ("nodes.0.children", [0], r"nodes\[0\]\.children\[0\]: nodes\[0\] has its place in the tree already"),
    ("nodes.0.children", [1], r"nodes\[0\]\.children\[0\]: must be a whole number from 0 to 0, is 1"),
    ("nodes.0.mesh", 1, r"nodes\[0\]\.mesh: must be a whole number"),
    ("nodes.0.rotation", [0, 0, 0, 0], r"nodes\[0\]\.rotation: must be a unit quaternion"),
    ("nodes.0.scale", [1, 2], r"nodes\[0\]\.scale: must be a list of 3 finite numbers"),
    ("nodes.0.translation", [1, 2, 10**400], r"nodes\[0\]\.translation\[2\]: must be a finite number"),
    ("nodes.0.matrix", [1] * 16, r"nodes\[0\]\.matrix: must end its columns with 0, 0, 0 and 1"),
    ("nodes.0.skin", 0, r"nodes\[0\]\.skin: must be left out, as there is none"),
    ("scenes.0.nodes", [5], r"scenes\[0\]\.nodes\[0\]: must be a whole number from 0 to 0, is 5"),
    ("scene", "main", "scene: must be a whole number from 0 to 0, is 'main'"),
    ("nodes.0.name", 5, r"nodes\[0\]\.name: must be text, is 5"),
]


@pytest.mark.parametrize("place,value,said", FAULTS)
def test_each_fault_is_told_with_its_place(tmp_path, place, value, said):
    path = tmp_path / "bad.gltf"
    path.write_text(json.dumps(changed(place, value)))
    if "corners" in said:
        assert any(said in note for note in ep.load_model(path).notes)
        return
    with pytest.raises(ep.FileError, match=said) as caught:
        ep.load_model(path)
    assert str(caught.value).startswith(f"{path}: ")


@pytest.mark.parametrize("content,said", [
    (b"", "is no glTF: begins with b''"),
    (b"<!DOCTYPE html>", "is no glTF: begins with b'<!DOCTYPE html>'"),
    (b"\xff\xfe{}", r"is no glTF: its JSON is not UTF-8 text \(byte 0\)"),
    (b"[" * 100000, "has JSON that is nested too deeply"),
    (b"[]", r"must be a JSON object, is \[\]"),
    (b'{"asset": {"version": NaN}}', "NaN is no number of JSON"),
    (b"glTF\1\0\0\0\0\0\0\0", "is a GLB of version 1"),
    (b"glTF\2\0\0\0", "is cut off within its head"),
    (b"glTF\2\0\0\0\xff\0\0\0", "is cut off: should have 255 bytes, has 12"),
    (b'{"asset": {"version": "2.0"}}', "holds no surface"),
    (b'{"asset": {"version": "1.0"}, "buffers": {"box": {"uri": "box.bin"}}}', r"must be 2\.0, is '1\.0'; only glTF 2\.0 is"),
])
def test_what_is_no_gltf_is_told_so(tmp_path, content, said):
    (tmp_path / "bad.glb").write_bytes(content)
    with pytest.raises(ep.FileError, match=said):
        ep.load_model(tmp_path / "bad.glb")


def test_files_cut_off_anywhere_are_refused(tmp_path):
    content, path = box_file().glb(), tmp_path / "cut.glb"
    for size in range(0, len(content), 37):
        path.write_bytes(content[:size])
        with pytest.raises(ep.FileError):
            ep.load_model(path)


def test_a_small_file_gets_no_giant_memory(tmp_path):
    file = box_file()
    file.json["accessors"][0] = {"componentType": 5126, "count": 2**31 - 1, "type": "VEC3"}
    with pytest.raises(ep.FileError, match="needs more than 256 MiB of memory, too much for a file of"):
        loaded(tmp_path, file)


def test_deep_trees_are_refused_and_broad_ones_read(tmp_path):
    file = box_file()
    file.json["nodes"] = [{"children": [i + 1]} for i in range(3000)] + [{"mesh": 0}]
    with pytest.raises(ep.FileError, match="lies deeper than 512 levels"):
        loaded(tmp_path, file)
    file.json["nodes"] = [{"name": "a", "mesh": 0} for _ in range(3000)]
    file.json["scenes"] = [{"nodes": list(range(3000))}]
    assert len(loaded(tmp_path, file).nodes) == 3000


def test_arguments_are_checked_by_name(tmp_path):
    path = tmp_path / "model.glb"
    path.write_bytes(box_file().glb())
    with pytest.raises(ValueError, match="animation: must be none, the file has no animation, got 'walk'"):
        ep.load_model(path, animation="walk")
    with pytest.raises(ValueError, match="up: must be 'x', 'y' or 'z', got 'w'"):
        ep.load_model(path, up="w")
    with pytest.raises(ValueError, match="path: must be a file of the kinds .*glb"):
        ep.load_model(tmp_path / "model.doc")
    with pytest.raises(TypeError, match="materials: must be a mapping"):
        ep.load_model(path, materials=["metal"])
    with pytest.raises(ep.FileError, match="cannot be opened"):
        ep.load_model(tmp_path / "none.glb")
