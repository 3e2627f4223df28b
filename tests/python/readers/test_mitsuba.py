"""Mitsuba files: transforms, groups, solids, materials, and what is said of bad ones."""
from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import echopath as ep

ROUNDING = 1e-12


def mitsuba(tmp_path, body: str, name: str = "scene.xml", **options):
    (tmp_path / name).write_text(f'<scene version="3.0.0">\n{body}\n</scene>')
    return ep.load_model(tmp_path / name, **options)


def corners(model, index: int = 0) -> np.ndarray:
    scene = ep.Scene()
    scene.add(model, name="m")
    return scene.world_vertices(index, 0.0)


def rectangle(transform: str, more: str = "") -> str:
    return f'<shape type="rectangle" id="mesh-plate"><transform name="to_world">{transform}</transform>{more}</shape>'


def test_steps_of_a_transform_are_applied_one_after_the_other(tmp_path):
    steps = '<scale x="2"/><rotate z="1" angle="90"/><translate value="10, 0, 1"/>'
    # (+-1, +-1, 0) -> (+-2, +-1) -> turned left (-+1, +-2) -> moved
    vertices = corners(mitsuba(tmp_path, rectangle(steps)))
    assert np.allclose(vertices, [[11, -2, 1], [11, 2, 1], [9, 2, 1], [9, -2, 1]], atol=ROUNDING)


def test_turns_about_any_axis_are_right_handed(tmp_path):
    turn = Rotation.from_rotvec(35.0 * np.array([1.0, -2.0, 2.0]) / 3.0, degrees=True)
    found = corners(mitsuba(tmp_path, rectangle('<rotate x="1" y="-2" z="2" angle="35"/>')))
    assert np.allclose(found, turn.apply([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]), atol=ROUNDING)


def test_a_matrix_and_looking_at_a_point(tmp_path):
    matrix = rectangle('<matrix value="0 0 1 5  1 0 0 6  0 1 0 7  0 0 0 1"/>')
    assert np.allclose(corners(mitsuba(tmp_path, matrix))[0], [5, 5, 6])
    turn = rectangle('<matrix value="0 0 1  1 0 0  0 1 0"/>')
    assert np.allclose(corners(mitsuba(tmp_path, turn))[0], [0, -1, -1])
    level = rectangle('<lookat origin="0, 0, 0" target="3, 0, 0"/>')  # ahead +x, up +y, left -z
    assert np.allclose(corners(mitsuba(tmp_path, level))[1], [0, -1, -1])
    look = rectangle('<lookat origin="1, 2, 3" target="1, 5, 3" up="0, 0, 1"/>')  # ahead +y, left -x, up +z
    assert np.allclose(corners(mitsuba(tmp_path, look)), [[2, 2, 2], [0, 2, 2], [0, 2, 4], [2, 2, 4]])


def test_names_as_mitsuba_before_2_wrote_them_are_known(tmp_path):
    """Its own documentation: `toWorld` became `to_world`, and so all names in camel case; `lookAt` became `lookat`."""
    steps = '<scale x="2"/><lookAt origin="1, 2, 3" target="1, 5, 3" up="0, 0, 1"/>'
    old = rectangle(steps).replace("to_world", "toWorld")
    new = rectangle(steps.replace("lookAt", "lookat"))
    assert np.array_equal(corners(mitsuba(tmp_path, old)), corners(mitsuba(tmp_path, new)))
    assert np.allclose(corners(mitsuba(tmp_path, old))[0], [3, 2, 2])
    named = mitsuba(tmp_path, '<default name="theScale" value="3"/>' + rectangle('<scale value="$theScale"/>'))
    assert np.abs(corners(named)).max() == 3.0


def test_groups_are_placed_by_their_instances_and_share_meshes(tmp_path):
    model = mitsuba(tmp_path, '<shape type="shapegroup" id="car"><shape type="cube" id="body"/></shape>' + "".join(
        f'<shape type="instance" id="i{x}"><ref id="car"/><transform name="to_world"><translate x="{x}"/></transform></shape>'
        for x in (3, 8)))
    scene = ep.Scene()
    scene.add(model, name="m")
    assert [mesh.name for mesh in scene.meshes] == ["m/i3/body", "m/i8/body"]
    assert np.allclose([scene.world_vertices(i, 0.0)[:, 0].mean() for i in (0, 1)], [3, 8])
    assert scene.meshes[0].mesh == scene.meshes[1].mesh


def test_solids_have_their_sizes(tmp_path):
    body = ('<shape type="sphere"><float name="radius" value="0.5"/><point name="center" x="2" y="0" z="1"/></shape>'
            '<shape type="cylinder"><point name="p0" value="1 1 1"/><point name="p1" value="1 1 4"/><float name="radius" '
            'value="2"/></shape><shape type="disk"/><shape type="cube"/>')
    meshes = [node.mesh for node in mitsuba(tmp_path, body).nodes]
    ball, tube, disk, cube = meshes
    assert np.allclose(np.linalg.norm(ball.vertices - [2, 0, 1], axis=1), 0.5) and ball.is_closed
    assert ball.area == pytest.approx(np.pi, rel=0.02) and tube.area == pytest.approx(2 * np.pi * 2 * 3, rel=0.01)
    assert disk.area == pytest.approx(np.pi, rel=0.01) and cube.area == pytest.approx(24) and cube.is_closed
    assert tube.vertices[:, 2].min() == pytest.approx(1.0) and tube.vertices[:, 2].max() == pytest.approx(4.0)
    a, b, c = disk.vertices[disk.triangles].transpose(1, 0, 2)
    assert np.all(np.cross(b - a, c - a)[:, 2] > 0.0)  # its normal is (0, 0, 1)


def test_materials_by_id_by_type_and_by_value(tmp_path):
    body = ('<bsdf type="twosided" id="mat-itu_brick"><bsdf type="diffuse"/></bsdf>'
            '<bsdf type="itu-radio-material" id="box-mat"><string name="type" value="glass"/></bsdf>'
            '<bsdf type="radio-material" id="own"><float name="relative_permittivity" value="4"/>'
            '<float name="conductivity" value="0.5"/><float name="scattering_coefficient" value="0.2"/></bsdf>')
    shapes = "".join(f'<shape type="cube"><ref id="{name}" name="bsdf"/></shape>' for name in ("mat-itu_brick", "box-mat", "own"))
    nodes = mitsuba(tmp_path, body + shapes + '<shape type="cube"><bsdf type="roughconductor"/></shape>').nodes
    assert [node.material for node in nodes[:2]] == ["brick", "glass"] and nodes[3].material == "metal"
    assert nodes[2].material == ep.Material(permittivity=4.0, conductivity=0.5, scattering=0.2)


@pytest.mark.parametrize("bsdf, ours", [
    ('<bsdf type="conductor" id="w"/>', "metal"),
    ('<bsdf type="twosided" id="w"><bsdf type="roughconductor"/></bsdf>', "metal"),
    ('<bsdf type="dielectric" id="w"/>', "glass"),
    ('<bsdf type="conductor" id="brick_red"/>', "brick"),
    ('<bsdf type="diffuse" id="w"/>', "concrete"),
])
def test_an_id_that_nothing_knows_leaves_the_material_to_the_type(tmp_path, bsdf, ours):
    model = mitsuba(tmp_path, bsdf + '<shape type="cube"><ref id="ID"/></shape>'.replace("ID", bsdf.split('"')[3]))
    assert model.nodes[0].material == ours
    said = f"the material 'w' is not known: {ours} is taken, as its type in the file says"
    assert (said in model.notes) == (ours in ("metal", "glass"))
    assert any("taken for concrete" in note for note in model.notes) == (ours == "concrete")


def test_what_the_caller_says_goes_before_the_type(tmp_path):
    body = '<bsdf type="conductor" id="w"/><shape type="cube"><ref id="w"/></shape>'
    assert mitsuba(tmp_path, body, materials={"*": "wood"}).nodes[0].material == "wood"


def test_an_alias_is_another_id_of_what_is_above_it(tmp_path):
    """As Mitsuba documents it: `id` is there, and `as` refers to it from there on."""
    group = '<shape type="shapegroup" id="house">' + rectangle("", '<ref id="wall"/>') + "</shape>"
    aliases = '<alias id="mat-itu_brick" as="wall"/><alias id="house" as="villa"/>'
    model = mitsuba(tmp_path, '<bsdf type="diffuse" id="mat-itu_brick"/>' + group + aliases +
                    '<shape type="instance"><ref id="villa"/></shape>')
    assert [node.foreign_material for node in model.nodes if node.mesh is not None] == ["itu_brick"]


def test_a_radio_material_with_a_thickness_is_a_pane_that_waves_pass(tmp_path):
    """Airy's sum for a slab at normal incidence: R = r (1 - p^2) / (1 - r^2 p^2), T = (1 - r^2) p / (1 - r^2 p^2)."""
    pane = ('<bsdf type="radio-material" id="pane"><float name="relative_permittivity" value="6.3"/><float name="conductivity" '
            'value="0.2"/><float name="thickness" value="0.004"/><float name="scattering_coefficient" value="0.1"/></bsdf>')
    material = mitsuba(tmp_path, pane + rectangle("", '<ref id="pane"/>')).nodes[0].material
    assert material == ep.Material(layers=[ep.Layer(0.004, 6.3, 0.2)], scattering=0.1)
    frequency, c, vacuum = 77e9, 299792458.0, 8.8541878128e-12
    index = np.sqrt(6.3 - 0.2j / (2 * np.pi * frequency * vacuum))
    r, p = (1 - index) / (1 + index), np.exp(-2j * np.pi * frequency / c * index * 0.004)
    found = ep.sheet_coefficients(material, frequency=frequency, incidence=0.0)
    assert abs(found.te_reflection[0]) == pytest.approx(abs(r * (1 - p**2) / (1 - r**2 * p**2)), rel=1e-6)
    assert abs(found.te_transmission[0]) == pytest.approx(abs((1 - r**2) * p / (1 - r**2 * p**2)), rel=1e-6)
    for wrong in ("0", "-1"):
        with pytest.raises(ep.FileError, match="line 2: <bsdf>: thickness: of a layer must be > 0 m"):
            mitsuba(tmp_path, pane.replace('"0.004"', f'"{wrong}"') + rectangle("", '<ref id="pane"/>'))


def test_parameters_and_included_files_are_filled_in(tmp_path):
    moved = rectangle('<translate x="$far"/>')
    (tmp_path / "more.xml").write_text(f'<scene version="3.0.0">{moved}</scene>')
    model = mitsuba(tmp_path, '<default name="far" value="7"/><include filename="more.xml"/>')
    assert corners(model)[:, 0].mean() == pytest.approx(7)


def test_files_are_looked_for_in_the_folders_of_the_scene_first_as_mitsuba_does(tmp_path):
    """Its resolver knows the folder of the main file, from that of the last <path> on, and not those of included files."""
    def write(name: str, body: str):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(f'<scene version="3.0.0">{body}</scene>')

    def included(name: str) -> str:
        return f'<include filename="{name}"/>'

    write("main/parts/outer.xml", included("parts/inner.xml"))                       # from the folder of the main file
    write("main/parts/inner.xml", rectangle('<translate x="1"/>') + included("far.xml") + included("beside.xml"))
    write("main/parts/beside.xml", rectangle('<translate x="2"/>'))                   # of which Mitsuba itself knows nothing
    for folder, x in (("common", 3), ("main", 4), ("main/parts", 5)):
        write(f"{folder}/far.xml", rectangle(f'<translate x="{x}"/>'))
    body = '<path value="../common"/><path value="nowhere"/>' + included("parts/outer.xml")
    model = mitsuba(tmp_path / "main", body)
    assert [corners(model, index)[:, 0].mean() for index in range(3)] == pytest.approx([1, 3, 2])
    with pytest.raises(ep.FileError, match="more than 100 folders"):
        mitsuba(tmp_path / "main", '<path value="."/>' * 101)


def test_files_are_found_as_programs_of_windows_write_their_paths(tmp_path):
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "more.xml").write_text(f'<scene version="3.0.0">{rectangle("")}</scene>')
    assert len(corners(mitsuba(tmp_path, '<include filename="parts\\more.xml"/>'))) == 4


def test_a_camera_with_y_upwards_says_the_vertical_axis(tmp_path):
    camera = ('<sensor type="perspective"><transform name="to_world"><lookat origin="0 0 5" target="0 0 0" up="0 1 0"/>'
              "</transform></sensor>")
    model = mitsuba(tmp_path, camera + rectangle(""))
    assert model.up == "y" and any("y upwards" in note for note in model.notes)
    assert mitsuba(tmp_path, camera + rectangle(""), up="z").up == "z"


def test_parameters_of_the_picture_need_no_value(tmp_path):
    """Mitsuba asks for them on its command line, as `-Dspp=64`; those that place a sensor tell which way is up."""
    sensor = ('<integrator type="path"><integer name="max_depth" value="$depth"/></integrator><sensor type="perspective">'
              '<float name="fov" value="$fov"/><sampler type="independent"><integer name="sample_count" value="$spp"/></sampler>')
    upright = '<transform name="to_world"><lookat origin="0 0 5" target="0 0 0" up="0 $up 0"/></transform></sensor>'
    with pytest.raises(ep.FileError, match="the parameter '[$]up' has no default"):
        mitsuba(tmp_path, sensor + upright + rectangle(""))
    model = mitsuba(tmp_path, '<default name="up" value="1"/>' + sensor + upright + rectangle(""))
    assert model.up == "y" and len(model.nodes) == 1


@pytest.mark.parametrize("body, message", [
    ('<shape type="ply"><string name="filename" value="gone.ply"/></shape>', "line 2: <shape>: the file 'gone.ply' is not there"),
    ('<shape type="ply"/>', "names no file"),
    ('<shape type="cube"><ref id="nobody"/></shape>', "line 2: <ref>: there is no element with the id 'nobody'"),
    ('<shape type="instance"/>', "must refer to a shape group"),
    (rectangle('<translate x="$where"/>'), "the parameter '[$]where' has no default"),
    (rectangle('<translate x="far"/>'), "<translate>: x must be numbers, got 'far'"),
    (rectangle('<matrix value="1 2 3"/>'), "value must be 9 or 16 finite numbers"),
    (rectangle('<turn/>'), "unknown transform; known are translate, scale"),
    ('<include filename="scene.xml"/>', "includes itself"),
    ("<shape", "is no XML"),
    ("<a>" * 70 + "</a>" * 70, "more than 64 elements within each other"),
])
def test_faults_of_a_file_are_told_by_its_line(tmp_path, body, message):
    with pytest.raises(ep.FileError, match=f"scene.xml.*{message}"):
        mitsuba(tmp_path, body)


def test_entities_that_grow_without_end_are_refused(tmp_path):
    (tmp_path / "bomb.xml").write_text('<!DOCTYPE a [<!ENTITY b "bbbb"><!ENTITY c "&b;&b;&b;">]><scene>&c;</scene>')
    with pytest.raises(ep.FileError, match="bomb.xml, line 1: a document type, which may expand without end, is refused"):
        ep.load_model(tmp_path / "bomb.xml")


def test_what_is_left_out_is_counted(tmp_path):
    model = mitsuba(tmp_path, '<shape type="hair"/><shape type="hair"/>' + rectangle('<scale x="0"/>') + rectangle(""))
    assert "a shape of the type 'hair' is left out (2 times)" in model.notes
    assert "a shape whose transform flattens it is left out" in model.notes and len(model.nodes) == 1
