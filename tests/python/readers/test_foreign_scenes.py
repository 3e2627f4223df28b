"""Foreign scenes: names of materials, scene files that name models, what the command line says of them."""
from __future__ import annotations

import json
import os
import re
import shlex
import string

import numpy as np
import pytest

import echopath as ep
from echopath.cli import main
from echopath.readers.material_names import material_of, note_of_unknown
from echopath.readers.sizes import unit_doubt
from fuzz.feeds.foreign import SQUARE
from fuzz.feeds.foreign_seeds import bvh_text, walk_frames
from support.files.mesh_texts import obj_boxes
from support.files.scene_text import WAVEFORM

ROUNDING = 1e-12


# --- materials ---

@pytest.mark.parametrize("name, ours", [
    ("itu_concrete", "concrete"), ("mat-itu_metal", "metal"), ("itu_ceiling_board", "ceiling_board"),
    ("itu_very_dry_ground", "dry_soil"), ("itu_wet_ground", "wet_soil"), ("itu_plasterboard", "plasterboard"),
    ("itu_floorboard", "floorboard"), ("itu_chipboard", "chipboard"), ("itu_plywood", "plywood"), ("itu_marble", "marble"),
    ("M_RoadLine.001", "asphalt"), ("MI_Asphalt_02", "asphalt"), ("CarPaint_Red", "metal"), ("Window_Glass", "glass"),
    ("fiberglass_panel", "plastic"), ("tire", "rubber"), ("Broadleaf_Leaves", "wood"), ("T-Shirt_cloth", "clothing"),
    ("skin_face", "skin"), ("car_body", "metal"), ("ClearCoat", "metal"), ("LightWood", "wood"), ("light_fabric", "clothing"),
    ("Head_Light_L", "plastic"), ("light.003", "plastic"), ("asphalt", "asphalt"), ("WoodenFloor", "wood"),
    ("Aluminium", "metal"), ("Wood_Fence", "wood"), ("wooden_fence_01", "wood"), ("Fence_Wood", "wood"), ("Fence", "metal"),
    ("Hardwood", "wood"), ("alu", "metal"), ("snow_ground", "snow"),
])
def test_usual_names_are_known(name, ours):
    assert material_of(name, {}) == (ours, None)


def test_patterns_that_take_nothing_are_told(tmp_path):
    path = tmp_path / "street.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl M_Asphalt\nf 1 2 3\n")
    (note,) = [note for note in ep.load_model(path, materials={"M_Asphlt*": "metal"}).notes if note.startswith("materials")]
    assert note == "materials: nothing in the file is called 'M_Asphlt*'; its materials are M_Asphalt"
    for own in ({"M_Asph*": "metal"}, {"asphalt": "metal"}, {"*": "metal"}):
        assert not [note for note in ep.load_model(path, materials=own).notes if note.startswith("materials")]


def test_brackets_in_patterns_stand_for_themselves(tmp_path):
    path = tmp_path / "car.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl Lack [rot]\nf 1 2 3\n")
    for pattern in ("Lack [rot]", "*[ROT]", "lack ?rot?"):
        model = ep.load_model(path, materials={pattern: "metal"})
        assert not model.notes and [node.material for node in model.nodes if node.mesh] == ["metal"]
    assert material_of("Lack r", {"lack [rot]": "metal"})[0] == "concrete"


def test_info_tells_what_lies_on_each_other_in_a_model(tmp_path, capsys):
    pytest.importorskip("trimesh")
    import trimesh

    town = trimesh.Scene()
    town.add_geometry(trimesh.creation.box((4.0, 0.3, 3.0)), node_name="wall", geom_name="wall")
    poster = trimesh.creation.box((1.0, 0.3, 1.0))
    town.add_geometry(poster, node_name="poster", geom_name="poster")
    town.export(tmp_path / "town.glb")
    assert main(["info", str(tmp_path / "town.glb")]) == 0
    told = " ".join(capsys.readouterr().out.split())
    assert "surfaces on each other (rounding decides" in told and "poster" in told.split("surfaces on each other")[1]


def test_no_single_letter_and_no_two_tell_a_material():
    """Each is a word of a name, in small letters, in capitals and with one capital."""
    for first in string.ascii_lowercase:
        words = [first, *(first + second for second in string.ascii_lowercase)]
        for case in (str.lower, str.upper, str.title):
            assert material_of("-".join(map(case, words)), {})[1] is not None, first


def test_unknown_names_are_concrete_and_counted():
    assert material_of("Material.001", {})[0] == "concrete"
    notes = note_of_unknown(["lambert1", "lambert1", "", "phong2"])
    assert "2 materials without an entry" in notes[0] and "lambert1, phong2" in notes[0]
    assert "1 mesh without a material is taken for concrete" in notes[1]


def test_users_extend_the_table_and_go_first(monkeypatch):
    monkeypatch.setattr(ep.foreign_materials, "_entries", dict(ep.foreign_materials._entries))
    assert material_of("Brick_Red", {})[0] == "brick"
    ep.foreign_materials["BRICK*"] = "marble"
    assert material_of("Brick_Red", {})[0] == "marble" and next(iter(ep.foreign_materials)) == "BRICK*"
    own = ep.Material(permittivity=4.0)
    assert material_of("Brick_Red", {"*red*": own})[0] is own
    del ep.foreign_materials["BRICK*"]
    assert material_of("Brick_Red", {})[0] == "brick"
    assert all(name in ep.materials for name in ep.foreign_materials.values())


@pytest.mark.parametrize("pattern, material, error", [
    ("a", "steal", "material: unknown material 'steal', the nearest known ones are"),
    ("a", 3, "material: must be a Material or a name of one, got 3"),
    (3, "metal", "pattern: must be patterns of names as text, got 3"),
])
def test_wrong_entries_are_refused_on_assignment(pattern, material, error):
    with pytest.raises((ValueError, TypeError), match=error):
        ep.foreign_materials[pattern] = material


def test_materials_of_the_recommendation_have_its_values_at_77_ghz():
    """eps' = a f^b, sigma = c f^d with f in GHz (ITU-R P.2040-3, table 3), eps'' = 17.98 sigma / f."""
    table = {"brick": (3.91, 0, 0.0238, 0.16), "plasterboard": (2.73, 0, 0.0085, 0.9395), "marble": (7.074, 0, 0.0055, 0.9262),
             "ceiling_board": (1.48, 0, 0.0011, 1.0750), "chipboard": (2.58, 0, 0.0217, 0.78), "plywood": (2.71, 0, 0.33, 0),
             "floorboard": (3.66, 0, 0.0044, 1.3515)}
    for name, (a, b, c, d) in table.items():
        permittivity = ep.materials[name].permittivity
        assert permittivity.real == pytest.approx(a * 77**b, rel=1e-3), name
        assert -permittivity.imag == pytest.approx(17.98 * c * 77**d / 77, abs=6e-4), name


def test_materials_have_the_values_of_the_recommendation_at_the_frequency_asked_for(tmp_path):
    (tmp_path / "a.obj").write_text(SQUARE + "usemtl itu_concrete\nf 1 2 3\nusemtl itu_medium_dry_ground\nf 1 3 4\n"
                                    "usemtl rubber\nf 1 2 4\nusemtl metal\nf 2 3 4\nusemtl own\nf 2 4 3\n")
    own = ep.Material(permittivity=2.0)
    model = ep.load_model(tmp_path / "a.obj", frequency=5e9, materials={"own": own})
    found = {node.foreign_material: node.material for node in model.nodes if node.mesh}
    # eps' = a f^b, sigma = c f^d, eps'' = sigma / (2 pi f eps0); f in GHz
    table = {"itu_concrete": (5.24, 0, 0.0462, 0.7822), "itu_medium_dry_ground": (15, -0.1, 0.035, 1.63)}
    for name, (a, b, c, d) in table.items():
        loss = c * 5**d / (2 * np.pi * 5e9 * 8.8541878128e-12)
        assert found[name].permittivity == pytest.approx(a * 5**b - 1j * loss, rel=1e-6)
    assert (found["rubber"], found["metal"], found["own"]) == ("rubber", "metal", own)
    assert "values at 77 GHz are taken for rubber" in model.notes
    at_77 = ep.load_model(tmp_path / "a.obj", frequency=77e9)
    assert not any("77 GHz" in note for note in at_77.notes)
    assert [node.material for node in ep.load_model(tmp_path / "a.obj").nodes if node.mesh][:2] == ["concrete", "soil"]
    with pytest.raises(ValueError, match="frequency: must be"):
        ep.load_model(tmp_path / "a.obj", frequency=-1.0)


# --- scenes, scene files and the command line ---

@pytest.fixture
def town(tmp_path):
    """A street of two rows of houses on a ground, in a Mitsuba file."""
    houses = "".join(f'<shape type="cube" id="house{x}{side}"><transform name="to_world"><scale value="8 8 6"/>'
                     f'<translate x="{x}" y="{side * 20}" z="6"/></transform><ref id="mat-itu_brick"/></shape>'
                     for x in (-40, -20, 0, 20, 40) for side in (-1, 1))
    ground = ('<shape type="rectangle" id="ground"><transform name="to_world"><scale value="60 40 1"/></transform>'
              '<ref id="mat-itu_concrete"/></shape>')
    bsdfs = '<bsdf type="diffuse" id="mat-itu_brick"/><bsdf type="diffuse" id="mat-itu_concrete"/>'
    (tmp_path / "town.xml").write_text(f'<scene version="3.0.0">{bsdfs}{houses}{ground}</scene>')
    return tmp_path / "town.xml"


def test_load_scene_takes_a_foreign_file_by_its_suffix(town):
    found = ep.load_scene(town)
    assert found.radar is None and found.title == "town" and len(found.scene.meshes) == 11
    assert "town/house0-1" in found.scene


def test_load_scene_passes_on_what_it_is_told_of_a_foreign_file(tmp_path):
    (tmp_path / "wall.obj").write_text(SQUARE + "usemtl pane\nf 1 2 3 4\n")
    scene = ep.load_scene(tmp_path / "wall.obj", unit=2.0, up="y", materials={"pane": "glass"}, smooth=True).scene
    assert scene.meshes[0].material == ep.materials["glass"]
    assert np.allclose(scene.world_vertices(0, 0.0).max(axis=0), [0, 2, 2])
    with pytest.raises(ValueError, match="animation: must be none"):
        ep.load_scene(tmp_path / "wall.obj", animation="walk")
    (tmp_path / "scene.toml").write_text(WAVEFORM)
    for name, value in (("unit", 0.5), ("loop", True), ("materials", {"a": "metal"})):
        with pytest.raises(ValueError, match=f"{name}: must be left out for a scene file, whose objects say it"):
            ep.load_scene(tmp_path / "scene.toml", **{name: value})
    with pytest.raises(TypeError, match="'units'.*unit"):
        ep.load_scene(tmp_path / "wall.obj", units=2.0)


def test_info_tries_the_unit_and_the_axis_that_it_advises(tmp_path, capsys):
    (tmp_path / "man.obj").write_text(SQUARE.replace("1", "180") + "f 1 2 3 4\n")
    assert main(["info", str(tmp_path / "man.obj")]) == 0
    assert "with unit=0.01 (cm)" in capsys.readouterr().out
    assert main(["info", str(tmp_path / "man.obj"), "--unit", "0.01", "--up", "y"]) == 0
    said = capsys.readouterr().out
    assert "0 x 1.8 x 1.8 m" in said and "unit?" not in said and "y is up" in said
    (tmp_path / "scene.toml").write_text(WAVEFORM)
    assert main(["info", str(tmp_path / "scene.toml"), "--unit", "2"]) == 2
    assert "must be a file that load_model reads for --unit" in capsys.readouterr().err


def test_a_scene_file_names_a_model_with_its_settings(tmp_path):
    (tmp_path / "wall.obj").write_text(SQUARE + "usemtl pane\nf 1 2 3 4\n")
    (tmp_path / "scene.toml").write_text(WAVEFORM + """
[[radar.transmitters]]
position = [0.0, 0.0, 0.0]
[[radar.receivers]]
position = [0.0, 0.0, 0.0]
[[objects]]
name = "wall"
model = "wall.obj"
unit = 2.0
up = "y"
smooth = true
frequency = 10e9
materials = {"pane*" = {base = "glass", mirror = true}}
position = [5.0, 0.0, 0.0]
""")
    scene = ep.load_scene(tmp_path / "scene.toml").scene
    assert scene.meshes[0].material == ep.materials["glass"].replace(mirror=True)
    assert [node.smooth for node in scene.nodes] == [False, True]
    assert np.allclose(scene.world_vertices(0, 0.0).max(axis=0), [5, 2, 2])
    good = (tmp_path / "scene.toml").read_text()
    for wrong in ('model = "gone.obj"', 'mesh = "wall.obj"', 'model = "wall.obj"\nanimation = "walk"'):
        (tmp_path / "bad.toml").write_text(good.replace('model = "wall.obj"', wrong))
        with pytest.raises((ValueError, ep.FileError)):
            ep.load_scene(tmp_path / "bad.toml")


def test_a_scene_file_names_a_motion_capture_as_model_and_as_actor(tmp_path):
    (tmp_path / "walk.bvh").write_text(bvh_text(walk_frames(8)))
    assert main(["scene", str(tmp_path / "walk.bvh"), "--out", str(tmp_path / "walk.toml")]) == 0
    text = (tmp_path / "walk.toml").read_text()
    (tmp_path / "actor.toml").write_text(text.replace('model = "walk.bvh"', 'actor = "captured_pedestrian"\n'
                                                      'parameters = {path = "walk.bvh"}'))
    model, actor = (ep.load_scene(tmp_path / name).scene for name in ("walk.toml", "actor.toml"))
    assert [mesh.name for mesh in model.meshes] == [mesh.name for mesh in actor.meshes]
    for index in range(len(model.meshes)):
        assert np.allclose(model.world_vertices(index, 0.1), actor.world_vertices(index, 0.1), atol=ROUNDING)


def test_info_tells_content_size_axes_unit_and_materials(town, capsys):
    assert main(["info", str(town)]) == 0
    said = capsys.readouterr().out
    for words in ("Mitsuba 3.0.0", "11, 11", "120 x 80 x 12 m", "z is up", "itu_brick", "brick, 10 meshes", "house-40-1"):
        assert words in said, words


WITHOUT_SURFACES = {  # files, and what is said of them beside that
    "a.xml": ('<scene version="3.0.0"><integrator type="path"/></scene>', ""),
    "a.usda": ('#usda 1.0\n(upAxis = "Z")\ndef Xform "a" {}\n', ""),
    "a.gltf": (json.dumps({"asset": {"version": "2.0"}, "nodes": [{}], "animations": [
        {"name": name, "samplers": [], "channels": []} for name in ("walk", "run")]}),
        "; it has animations alone (walk, run)")}


@pytest.mark.parametrize("name", WITHOUT_SURFACES)
def test_a_file_without_surfaces_is_refused_in_any_format(tmp_path, name):
    content, said = WITHOUT_SURFACES[name]
    (tmp_path / name).write_text(content)
    with pytest.raises(ep.FileError, match=re.escape(f"{name}: holds no surface{said}") + "$"):
        ep.load_model(tmp_path / name)


@pytest.mark.parametrize("extent, unit, names, words", [
    (180.0, 1.0, ["walking_man"], "a person of 180 m is hardly right; with unit=0.01 [(]cm[)]"),
    (0.004, 0.001, ["Car.obj"], "a vehicle of 4 mm is hardly right; with unit=1 [(]m[)]"),
    (0.004, 1.0, ["thing"], "a scene of 4 mm is hardly right"),
    (141.0, 1.0, ["Fox"], "an animal of 141 m is hardly right; with unit=0.01 [(]cm[)]"),
    (1.8, 1.0, ["man"], None), (180.0, 1.0, ["town"], None), (4.5, 1.0, ["car"], None),
    (9.0, 1.0, ["dog_house"], None), (60.0, 1.0, ["BusStop"], None),
    (60.0, 1.0, ["map", "house_left", "ground", "van0"], None), (60.0, 1.0, ["map", "van0"], "a vehicle of 60 m is hardly right"),
    (4.2, 1.0, ["thing", "Car_Body"], None), (4.2, 1.0, ["thing", "body", "wheel"], None),
    (8000.0, 1.0, ["room", "floor", "person"], "a room of 8 km is hardly right; with unit=0.001 [(]mm[)]"),
    (8.0, 1.0, ["LivingRoom", "person"], None), (8.0, 1.0, ["scene", "floor", "person", "table"], None),
    (0.9, 1.0, ["office_chair"], None), (600.0, 1.0, ["scene", "OfficeTower01", "apartment_block"], None),
    (900.0, 1.0, ["scene", "MainOffice01"], "a room of 900 m is hardly right"), (8.0, 1.0, ["kitchen_scan", "person"], None),
    (600.0, 1.0, ["town", "house", "office"], None), (60.0, 1.0, ["scene", "car_floor"], "a vehicle of 60 m is hardly right"),
])
def test_sizes_that_cannot_be_say_which_unit_would_be_right(extent, unit, names, words):
    doubt = unit_doubt(extent, unit, names)
    assert doubt is None if words is None else re.match(words, doubt)


def test_a_figure_in_a_room_is_held_to_the_size_of_a_figure():
    assert unit_doubt(1.8, 1.0, ["room", "figure"], is_figure=True) is None
    told = unit_doubt(180.0, 1.0, ["room", "figure"], is_figure=True)
    assert told is not None and told.startswith("a figure with a skeleton of 180 m is hardly right; with unit=0.001 (mm)")


def test_one_body_of_kilometres_is_told_with_the_unit_that_would_be_right():
    told = unit_doubt(4300.0, 1.0, ["lid"], is_body=True)
    assert told is not None and told.startswith("a single body of 4.3 km is hardly right; with unit=0.001 (mm)")
    assert unit_doubt(4300.0, 1.0, ["town"]) is None and unit_doubt(430.0, 1.0, ["hall"], is_body=True) is None


def test_an_object_alone_is_no_mirror_in_the_scene_that_is_written_for_it(tmp_path, capsys):
    corners = "v 0 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\n"  # half a square: the radar looks at the middle of its longest side
    (tmp_path / "plate.obj").write_text(corners)
    assert main(["scene", str(tmp_path / "plate.obj"), "--out", str(tmp_path / "plate.toml"), "--up", "z"]) == 0
    found = ep.load_scene(tmp_path / "plate.toml")
    assert not any(mesh.material.mirror for mesh in found.scene.meshes)
    assert ep.trace(found.scene, found.radar, num_rays=2000).num_paths > 100


@pytest.mark.usefixtures("blank_pictures")
def test_things_of_a_street_are_told_apart_in_the_scene_that_is_written_for_it(tmp_path, capsys):
    boxes = {"ground": ((60, 30, 0.1), (20, 0, -0.05)), "house": ((30, 10, 8), (20, 14, 4)),
             "wall": ((30, 0.3, 5), (20, -8, 2.5)), "van": ((4.5, 1.9, 2), (8, 2.2, 1.1)),
             "trailer": ((13.6, 2.6, 4), (25, 2.2, 2.1)), "pole": ((0.2, 0.2, 8), (15, -6, 4)),
             "bin": ((0.8, 0.8, 1.1), (12, -5, 0.6))}
    (tmp_path / "street.obj").write_text(obj_boxes(boxes))
    out = tmp_path / "street.toml"
    assert main(["scene", str(tmp_path / "street.obj"), "--out", str(out), "--up", "z"]) == 0
    found = ep.load_scene(out)
    assert dict(found.labels.objects) == {name: (f"street/{name}",) for name in ("van", "trailer", "pole", "bin")}
    capsys.readouterr()
    assert main(["run", str(out), "--out", str(tmp_path / "run"), "--rays", "3000"]) == 0
    told = capsys.readouterr().out
    assert all(f"\n  {name} " in told for name in ("van", "trailer", "pole", "bin")) and "\n  street " not in told


@pytest.mark.parametrize("path, out", [("in/a.obj", "results/a.toml"), ("results/../../../in/a.obj", "a.toml")])
def test_a_scene_file_finds_its_model_where_links_lead_to_other_folders(tmp_path, monkeypatch, path, out):
    """results is a link to deep/er/est, so that results/.. is deep/er."""
    monkeypatch.chdir(tmp_path)
    for folder in ("in", "deep/er/est"):
        (tmp_path / folder).mkdir(parents=True)
    (tmp_path / "results").symlink_to("deep/er/est")
    (tmp_path / "in/a.obj").write_text("v 0 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n")
    assert main(["scene", path, "--out", out]) == 0
    assert len(ep.load_scene(out).scene.meshes) == 1


def test_a_scene_file_names_a_model_below_it_by_the_link_that_its_user_takes(tmp_path):
    (tmp_path / "in").mkdir()
    (tmp_path / "models").symlink_to("in")
    (tmp_path / "in/a.obj").write_text("v 0 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n")
    assert main(["scene", str(tmp_path / "models/a.obj"), "--out", str(tmp_path / "a.toml")]) == 0
    assert 'model = "models/a.obj"' in (tmp_path / "a.toml").read_text()


def test_commands_that_are_told_can_be_pasted(tmp_path, capsys):
    """Names with spaces stand in quotes of the shell."""
    (tmp_path / "a b.obj").write_text("v 0 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n")
    assert main(["scene", str(tmp_path / "a b.obj"), "--out", str(tmp_path / "my scene.toml")]) == 0
    told = capsys.readouterr().out.splitlines()[-1]
    assert shlex.split(told.partition(".toml: ")[2]) == ["echopath", "run", str(tmp_path / "my scene.toml"), "--out", "DIR"]
    assert main(["run", str(tmp_path / "a b.obj"), "--out", str(tmp_path / "out")]) == 2
    told = capsys.readouterr().err.split("`")[1]
    assert shlex.split(told) == ["echopath", "scene", str(tmp_path / "a b.obj"), "--out", "SCENE.toml"]


def test_a_scene_file_that_may_have_been_edited_is_kept(tmp_path, capsys):
    (tmp_path / "plate.obj").write_text("v 0 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n")
    out = tmp_path / "plate.toml"
    out.write_text("edited")
    assert main(["scene", str(tmp_path / "plate.obj"), "--out", str(out)]) == 2
    assert "--out: must be a new file, as there may be edits in one that is there (--overwrite " in capsys.readouterr().err
    assert out.read_text() == "edited"
    assert main(["scene", str(tmp_path / "plate.obj"), "--out", str(out), "--overwrite"]) == 0
    assert len(ep.load_scene(out).scene.meshes) == 1


def test_scene_writes_a_file_that_runs_with_the_radar_in_the_street(town, tmp_path, capsys):
    out = tmp_path / "run" / "town.toml"
    assert main(["scene", str(town), "--out", str(out)]) == 0
    found = ep.load_scene(out)
    x, y, z = found.radar.position
    assert abs(y) < 12 and abs(x) < 60 and z == pytest.approx(1.5)  # between the rows, which begin at |y| = 12
    paths = ep.trace(found.scene, found.radar, num_rays=2000)
    assert paths.num_paths > 0
    assert main(["run", str(town), "--out", str(tmp_path / "x")]) == 2
    assert "has no radar; `echopath scene" in capsys.readouterr().err
    assert main(["scene", str(town), "--out", str(tmp_path / "town.txt")]) == 2


def test_other_kinds_of_files_and_arguments_are_refused_by_name(tmp_path):
    with pytest.raises(ValueError, match="path: must be a file of the kinds .glb, .gltf, .vrm, .obj, .ply"):
        ep.load_model(tmp_path / "a.doc")
    with pytest.raises(ep.FileError, match="a.usd: cannot be opened"):
        ep.load_model(tmp_path / "a.usd")
    with pytest.raises(ValueError, match="up: must be 'x', 'y' or 'z', got 'w'"):
        ep.load_model(tmp_path / "a.obj", up="w")
    with pytest.raises(ValueError, match="materials.'a'.: unknown material 'steal'"):
        ep.load_model(tmp_path / "a.obj", materials={"a": "steal"})
    for path in (tmp_path / ("a" * 300 + ".obj"), tmp_path / "/".join(["abc"] * 1500)):
        with pytest.raises(ep.FileError, match="path: must be the name of a file that can be, got '/"):
            ep.load_model(path)
    os.mkfifo(tmp_path / "pipe.obj")  # which has no end
    with pytest.raises(ep.FileError, match="is no regular file"):
        ep.load_model(tmp_path / "pipe.obj")
