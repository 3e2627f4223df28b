"""Scene files: what they mean."""
from __future__ import annotations

import math
import re
import warnings
from pathlib import Path

import numpy as np
import pytest

import echopath as ep
from echopath.cli.run import simulate_file
from echopath.scene_file.tables import motion_tables, object_tables, radar_tables, run_tables, schema, traffic_tables
from echopath.scene_file.tables.table import Table
from support.files.scene_files import QUAD, RADAR, fault_of, mesh_object

DATA = Path(__file__).resolve().parents[4] / "data"
ROUNDING = 1e-12  # m
SWAY = 0.05       # relative: the torso sways by a few centimetres within a step


def test_waveform_and_antennas_are_those_of_the_file(write):
    radar = ep.load_scene(write("")).radar
    assert (radar.waveform.start_frequency, radar.waveform.bandwidth) == (77e9, 1e9)
    assert (radar.waveform.num_samples, radar.waveform.num_chirps) == (64, 8)
    assert [antenna.position.tolist() for antenna in radar.transmitters] == [[0.0, 0.0, 1.0]]
    assert [antenna.position.tolist() for antenna in radar.receivers] == [[0.0, 0.01, 1.0]]


def test_the_radar_and_its_antennas_stand_and_look_as_the_file_says(write):
    text = RADAR.replace("position = [0.0, 0.01, 1.0]", "position = [0.0, 0.01, 1.0]\nyaw_deg = -30.0\npitch_deg = 5.0")
    text += "[radar]\nposition = [3.0, -2.0, 1.5]\nyaw_deg = 90.0\npitch_deg = 10.0\nspeed = 12.0\n"
    radar = ep.load_scene(write("", radar=text)).radar
    assert radar.position.tolist() == [3.0, -2.0, 1.5]
    assert (radar.yaw, radar.pitch) == (math.radians(90.0), math.radians(10.0))
    np.testing.assert_allclose(radar.motion.velocity, (0.0, 12.0, 0.0), atol=ROUNDING)
    np.testing.assert_allclose(radar.world_from_radar(0.0)[:3, 0], (0.0, np.cos(radar.pitch), np.sin(radar.pitch)), atol=ROUNDING)
    antenna = radar.receivers[0]
    np.testing.assert_allclose((antenna.yaw, antenna.pitch), np.radians((-30.0, 5.0)), atol=ROUNDING)


def test_turns_in_degrees_are_angles_without_a_word_on_rad(write):
    radar = RADAR.replace("position = [0.0, 0.01, 1.0]", "position = [0.0, 0.01, 1.0]\nyaw_deg = 390.0")
    path = write(mesh_object('material = "concrete"\nyaw_deg = 900.0'), radar=f"{radar}[radar]\nyaw_deg = -450.0\n")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        loaded = ep.load_scene(path)
    assert loaded.radar.yaw == pytest.approx(-math.pi / 2) and loaded.radar.receivers[0].yaw == pytest.approx(math.pi / 6)
    name = next(iter(loaded.scene))
    assert loaded.scene[name].yaw == pytest.approx(math.pi)


@pytest.mark.parametrize("key, line", [("pitch_deg", "pitch_deg = 91.0"), ("yaw_deg", "yaw_deg = inf"),
                                       ("position", "position = [1.0, 2.0]")])
def test_a_wrong_place_of_the_radar_is_named(write, key, line):
    assert f"radar.{key}" in fault_of(write("", radar=f"{RADAR}[radar]\n{line}\n"))


def test_pitch_must_not_stand_beside_an_orientation(write):
    text = RADAR + "pitch_deg = 5.0\norientation = [1.0, 0.0, 0.0, 0.0]\n"
    assert "radar.receivers[0].pitch_deg: must not stand beside orientation" in fault_of(write("", radar=text))


def test_antennas_take_what_they_lack_from_the_radar(write):
    text = """
[[radar.receivers]]
position = [0.0, 0.02, 1.0]
polarization = [0.0, 1.0, 0.0]
pattern = {kind = "isotropic", gain = 0.3}
[radar.pattern]
kind = "cosine_power"
exponent = 2.0
"""
    first, second = ep.load_scene(write(text)).radar.receivers
    assert first.pattern.exponent == 2.0 and first.pattern.peak_gain == pytest.approx(6.0)  # lossless: 2 (exponent + 1)
    assert second.pattern.peak_gain == 0.3
    assert first.polarization.tolist() == [0.0, 0.0, 1.0] and second.polarization.tolist() == [0.0, 1.0, 0.0]


def test_beams_are_known_by_their_widths(write):
    beam = '[radar.pattern]\nkind = "gaussian_beam"\nazimuth_deg = {}\nelevation_deg = 10.0\n'
    first, = ep.load_scene(write(beam.format(60.0))).radar.receivers
    assert first.pattern == ep.GaussianBeam(azimuth=np.radians(60), elevation=np.radians(10))
    assert "radar.pattern.azimuth_deg: must be" in fault_of(write(beam.format(181.0)))


def test_mesh_files_are_found_beside_the_scene_file_and_placed(write):
    scene = ep.load_scene(write(mesh_object(
        'unit = 0.001\nmaterial = "concrete"\nposition = [10.0, 0.0, 0.0]\nyaw_deg = 90.0'))).scene
    corners = scene.world_vertices(0, 0.0)
    expected = [[9.5, 0.0, 0.0], [9.5, 1.0, 0.0], [10.0, 0.0, 0.0], [10.0, 1.0, 0.0]]
    assert sorted(np.round(corners, 12).tolist()) == expected
    assert scene.meshes[0].name == "quad"
    assert scene.meshes[0].material.permittivity == ep.materials["concrete"].permittivity


def test_materials_among_the_parameters_of_an_actor_are_told_as_others_are(write):
    text = ('[[objects]]\nname = "walker"\nactor = "standing_person"\nparameters = {edge = 0.08, skin = "rubber", '
            'clothing = {base = "leather", permittivity = 2.0}}\n')
    found = ep.load_scene(write(text.replace("leather", "plastic"))).scene
    person = ep.actors.standing_person(edge=0.08, skin="rubber", clothing=ep.materials["plastic"].replace(permittivity=2.0))
    expected = ep.Scene()
    expected.add(person, name="walker")
    assert [(mesh.material, mesh.material_name) for mesh in found.meshes] == [
        (mesh.material, mesh.material_name) for mesh in expected.meshes]
    assert "objects[0].parameters.clothing: unknown material 'leather'" in fault_of(write(text))


def test_groups_of_a_mesh_file_are_meshes_of_their_own(write, tmp_path):
    (tmp_path / "quad.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\ng floor\nf 1 2 3\ng wall\nf 1 2 4\n")
    scene = ep.load_scene(write(mesh_object('material = "metal"'))).scene
    assert [mesh.name for mesh in scene.meshes] == ["quad/floor", "quad/wall"]


def test_groups_may_have_any_names_and_groups_of_their_own(write, tmp_path):
    """As modellers write them: a group with faces beside groups below it, and signs that globs have for themselves."""
    names = "car", "car/Bob's_wheel", "car/wheel?", "car/wheel*", "door", "van", "van/van/wheel", "a?", "a*", "a__2/b"
    faces = "".join(f"g {name}\nf 1 2 {3 + number % 2}\n" for number, name in enumerate(names))
    (tmp_path / "quad.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n" + faces)
    expected = ["car/car", "car/Bob_s_wheel", "car/wheel_", "car/wheel__2", "door", "van/van_2", "van/van/wheel", "a_", "a__3",
                "a__2/b"]
    scene = ep.load_scene(write(mesh_object('material = "metal"'))).scene
    assert [mesh.name for mesh in scene.meshes] == [f"quad/{name}" for name in expected]
    own = ep.Scene()
    own.add(ep.load_meshes(tmp_path / "quad.obj"), name="quad", material="metal")
    assert [mesh.name for mesh in own.meshes] == [mesh.name for mesh in scene.meshes]


def test_linear_motion_moves_the_object(write):
    scene = ep.load_scene(write(mesh_object(
        'material = "metal"\nmotion = {kind = "linear", velocity = [-1.5, 0.0, 0.0]}'))).scene
    assert np.allclose(scene.world_vertices(0, 2.0) - scene.world_vertices(0, 0.0), [-3.0, 0.0, 0.0], atol=ROUNDING)


ROBOT = """
[[objects]]
name = "robot"
group = true
yaw_deg = 90.0
speed = 2.0
[[objects]]
name = "arm"
parent = "robot"
mesh = "quad.obj"
material = "metal"
position = [0.0, 0.0, 1.0]
motion = {kind = "linear", angular_velocity = [0.0, 0.0, 1.0]}
"""
RIDES = 'rides_on = "robot/arm"\nposition = [0.5, 0.0, 0.0]\nyaw_deg = -90.0\n'


def test_radars_ride_on_objects_and_other_radars_do(write):
    """An arm of 0.5 m turns by 1 rad/s on a robot that drives along +y with 2 m/s; the radar looks to its right."""
    riding = "[radar]\n" + RIDES + "during = [0.0, 3.0]\n" + RADAR
    other = riding.replace("[radar]", "[[interferers]]").replace("[radar.", "[interferers.")
    loaded = ep.load_scene(write(ROBOT + other, radar=riding))
    for radar in (loaded.radar, loaded.scene.interferers[0].radar):
        for time in (0.0, 1.3, 3.0):
            pose, angle = radar.world_from_radar(time), 0.5 * np.pi + time
            np.testing.assert_allclose(pose[:3, 3], [0.5 * np.cos(angle), 2.0 * time + 0.5 * np.sin(angle), 1.0], atol=1e-5)
            np.testing.assert_allclose(pose[:2, 0], [np.sin(angle), -np.cos(angle)], atol=1e-5)
    for lines, told in (("during = [0.0, 3.0]\n", "radar.during: needs rides_on"),
                        (RIDES, "radar.rides_on: must be an id of the .*; an object needs `during`, got 'robot/arm'"),
                        ('rides_on = "arm"\nduring = [0, 1]\n', "radar.rides_on: must be the full name of an object, .* 'arm'"),
                        (RIDES + "during = [0.0, inf]\n", "radar: during: must be finite")):
        with pytest.raises(ValueError, match=told):
            ep.load_scene(write(ROBOT, radar="[radar]\n" + lines + RADAR))


def test_objects_are_in_the_frames_of_their_lifetime(write):
    quad = mesh_object('material = "metal"')
    scene = ep.load_scene(write(quad + "lifetime = [0.5, inf]\n" + quad.replace('"quad"', '"always"'))).scene
    assert scene["quad"].lifetime == (0.5, np.inf) and scene["always"].lifetime is None
    for wrong in ("[1.0, 0.5]", "[1.0]", "1.0", "[nan, 1.0]"):
        with pytest.raises(ValueError, match=r"objects\[0\]\.lifetime: "):
            ep.load_scene(write(mesh_object(f"lifetime = {wrong}")))


def test_keyframes_move_the_object_through_their_points(write):
    scene = ep.load_scene(write(mesh_object("""material = "metal"
[objects.motion]
kind = "keyframes"
times = [0.0, 1.0, 2.0, 3.0]
translations = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [2.0, 2.0, 0.0]]"""))).scene
    rest = scene.world_vertices(0, 0.0)
    assert np.allclose(scene.world_vertices(0, 2.0) - rest, [1.0, 1.0, 0.0], atol=ROUNDING)


def test_keyframes_name_their_interpolation(write):
    scene = ep.load_scene(write(mesh_object("""material = "metal"
[objects.motion]
kind = "keyframes"
times = [0.0, 1.0, 1.5, 9.0]
translations = [[0.0, 0.0, 0.0], [5.0, 0.0, 0.0], [6.0, 0.0, 0.0], [6.0, 0.0, 0.0]]
interpolation = "monotone\""""))).scene
    stopped = scene.world_vertices(0, 1.5) - scene.world_vertices(0, 0.0)
    for time in (2.0, 5.0, 8.0):
        assert np.allclose(scene.world_vertices(0, time) - scene.world_vertices(0, 0.0), stopped, atol=ROUNDING)


def test_a_material_table_changes_a_named_material(write):
    table = 'material = {base = "concrete", scattering = 0.3, cross_polarization = 0.1, mirror = true}'
    material = ep.load_scene(write(mesh_object(table))).scene.meshes[0].material
    assert material.permittivity == ep.materials["concrete"].permittivity
    assert (material.scattering, material.cross_polarization, material.mirror) == (0.3, 0.1, True)


def test_a_loss_is_a_negative_imaginary_part(write):
    material = ep.load_scene(write(mesh_object("material = {permittivity = [5.0, 0.3]}"))).scene.meshes[0].material
    assert material.permittivity == 5.0 - 0.3j


def test_settings_are_those_of_the_file_or_the_defaults(write):
    scene_file = ep.load_scene(write(mesh_object('material = "metal"') + """
[trace]
num_rays = 1234
[spectrum]
window = ["hann", ["chebyshev", 80]]
[parts.route]
direct = "T . R"
[parts.body]
quad = "T 'quad' R"
"""))
    assert scene_file.trace == ep.TraceSettings(num_rays=1234)
    assert scene_file.signal == ep.SignalSettings(window=("hann", ("chebyshev", 80)))
    assert scene_file.partitions() == {"route": {"direct": "T . R"}, "body": {"quad": "T 'quad' R"}}


@pytest.mark.filterwarnings("ignore::echopath.GuardWarning")  # one path has half of the power
def test_the_guard_is_on_unless_the_file_turns_it_off(write):
    scene = mesh_object('material = "metal"') + "\n[trace]\nnum_rays = 2000\n"
    for text, is_on in (("", True), ("guard = true\n", True), ("guard = false\n", False)):
        frame = simulate_file(ep.load_scene(write(text + RADAR + scene, radar="")))
        assert bool(frame.checks) == is_on


def test_all_cells_of_the_covariance_of_capon_may_be_chosen(write):
    settings = ep.load_scene(write('[angle]\nmethod = "capon"\nvelocity_neighbours = 3\nrange_neighbours = 0\n')).angle_settings()
    assert settings["velocity_neighbours"] == 3 and settings["range_neighbours"] == 0
    assert "angle.velocity_neighbours: must be at most 64, got 65" in fault_of(write("[angle]\nvelocity_neighbours = 65\n"))


def test_angles_are_keywords_of_range_azimuth_in_radians(write):
    assert ep.load_scene(write("")).angle_settings() == {
        "method": "bartlett", "combine": "peak", "window": "rect", "elevation": 0.0, "diagonal_loading": 0.01,
        "range_neighbours": 2, "forward_backward": False}
    settings = ep.load_scene(write("""
[angle]
azimuth_deg = [-30, 30, 20]
elevation_deg = [-10.0, 0.0, 10.0]
window = ["chebyshev", 40]
combine = "sum"
velocity = 1.5
""")).angle_settings()
    assert settings["azimuth"] == pytest.approx(np.radians([-30.0, -10.0, 10.0, 30.0]))
    assert settings["elevation"] == pytest.approx(np.radians([-10.0, 0.0, 10.0]))
    assert (settings["window"], settings["combine"], settings["velocity"]) == (("chebyshev", 40), "sum", 1.5)


def test_a_map_from_above_may_have_a_velocity_gate(write):
    assert ep.load_scene(write("[angle]\nvelocity_gate = [-3, 3.5]\n")).angle_settings()["velocity_gate"] == (-3.0, 3.5)
    with pytest.raises(ValueError, match="angle.velocity_gate: must be a pair .low, high."):
        ep.load_scene(write("[angle]\nvelocity_gate = [3, -3.5]\n"))


def test_one_flat_table_of_parts_is_one_partition(write):
    assert ep.load_scene(write('[parts]\ndirect = "T . R"\n')).partitions() == {"parts": {"direct": "T . R"}}


def test_the_street_is_that_of_its_description():
    street = ep.load_scene(DATA / "scenes" / "street.toml")
    waveform = street.radar.waveform
    assert (waveform.start_frequency, waveform.bandwidth) == (77e9, 1e9)
    assert (waveform.num_samples, waveform.sampling_rate) == (512, 20e6)
    assert (waveform.num_chirps, waveform.chirp_interval) == (256, 100e-6)
    corners = {mesh.name: street.scene.world_vertices(mesh.id, 0.0)
               for mesh in street.scene.meshes if mesh.material.mirror}
    ys = sorted({round(float(y), 9) for name, points in corners.items() if "wall" in name for y in points[:, 1]})
    assert ys == [-3.0, 3.0]
    assert np.ptp(corners["floor"][:, 2]) == 0.0
    names = [mesh.name for mesh in street.scene.meshes]
    assert sum(name.startswith("pedestrian/") for name in names) >= 16


def test_the_pedestrian_of_the_street_walks_towards_the_radar():
    street = ep.load_scene(DATA / "scenes" / "street.toml")
    mesh = next(mesh for mesh in street.scene.meshes if mesh.name == "pedestrian/torso")
    begin, end = (street.scene.world_vertices(mesh.id, time).mean(axis=0) for time in (0.0, 2.0))
    speed = math.dist(begin[:2], end[:2]) / 2.0
    assert 10.0 <= begin[0] <= 12.0 and end[0] < begin[0]
    assert speed == pytest.approx(1.4, rel=SWAY, abs=0)


def tables() -> dict:
    parts = (motion_tables, object_tables, radar_tables, run_tables, schema, traffic_tables)
    return {name: value for part in parts for name, value in vars(part).items()
            if isinstance(value, type) and issubclass(value, Table) and value is not Table}


# Where the rows of a table begin in data/README.md, unless that is "[trace]" for TraceTable and so on.
HEADS = {"WaveformTable": "[radar.waveform]", "AntennaTable": "[[radar.transmitters]]", "ObjectTable": "[[objects]]",
         "InterfererTable": "[[interferers]]", "TrafficTable": "[[traffic]]", "TrafficActorTable": "[[traffic]]"}


def described(name: str) -> str:
    """What data/README.md says of a table: its own rows, those of the table that it extends, and the names of all tables. Where
    it has no rows, because sentences describe it, all that is said of scene files."""
    chapter = (DATA / "README.md").read_text().split("## Scene files (TOML)\n")[1].split("\n## ")[0]
    parts = re.split(r"\n(?=\| `\[)", chapter)[1:]
    rows = {part.split("`")[1]: part.split("\n\n")[0] for part in parts}
    kinds = [kind.__name__ for kind in tables()[name].__mro__]
    heads = [HEADS.get(kind, f"[{kind.removesuffix('Table').lower()}]") for kind in kinds]
    own = [rows[head] for head in heads if head in rows]
    return "\n".join([*own, *(part.split("|")[1] for part in parts)]) if own else chapter


@pytest.mark.parametrize("name", tables())
def test_every_key_is_written_down_in_the_data_readme(name):
    readme = described(name)
    for key in tables()[name].model_fields:
        assert any(form in readme for form in (f"`{key}`", f"{key} =", f".{key}]", f"[{key}]")), key


def test_a_key_of_another_table_does_not_stand_for_one_that_is_missing():
    assert "`offset`" not in described("TraceTable") and "`num_rays`" in described("TraceTable")


def test_a_group_carries_its_parts_and_has_no_shape(write):
    """A point 0.2 m from the axis of a fan that hangs at (3, 1, 2) and turns by a quarter of a turn in a second."""
    text = """
[[objects]]
name = "fan"
group = true
position = [3.0, 1.0, 2.0]
[[objects]]
name = "rotor"
group = true
parent = "fan"
motion = {kind = "linear", angular_velocity = [1.5707963267948966, 0.0, 0.0]}
[[objects]]
name = "blade"
parent = "fan/rotor"
actor = "box"
parameters = {size = [0.01, 0.4, 0.05]}
material = "metal"
[[objects]]
name = "empty"
group = true
"""
    scene = ep.load_scene(write(text)).scene
    assert [mesh.name for mesh in scene.meshes] == ["fan/rotor/blade"] and "empty" in scene
    tip = scene.world_vertices(0, 0.0)[:, 1].argmax()
    np.testing.assert_allclose(scene.world_vertices(0, 0.0)[tip, 1], 1.2, rtol=0, atol=ROUNDING)
    np.testing.assert_allclose(scene.world_vertices(0, 1.0)[tip, 2], 2.2, rtol=0, atol=ROUNDING)


@pytest.mark.parametrize("written", ["meshes\\quad.obj", "..\\{here}\\meshes\\quad.obj", "meshes/quad.obj"])
def test_files_are_found_as_programs_of_windows_write_their_paths(write, written):
    path = write("[[objects]]\nname = 'quad'\nmesh = 'there.obj'\nmaterial = 'metal'\n")
    (path.parent / "meshes").mkdir()
    (path.parent / "meshes" / "quad.obj").write_text(QUAD)
    path.write_text(path.read_text().replace("there.obj", written.format(here=path.parent.name)))
    (mesh,) = ep.load_scene(path).scene.meshes
    assert mesh.name == "quad" and len(mesh.triangles) == 2


def test_a_name_with_backslashes_is_that_of_a_file_that_has_them(write):
    """As Linux allows; and a file that is not there is named as it was written."""
    path = write("[[objects]]\nname = 'quad'\nmesh = 'meshes\\quad.obj'\nmaterial = 'metal'\n")
    with pytest.raises(ep.FileError, match=r"objects\[0\].mesh: .*meshes\\quad.obj: cannot be opened"):
        ep.load_scene(path)
    (path.parent / "meshes").mkdir()
    (path.parent / "meshes" / "quad.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n")
    (path.parent / "meshes\\quad.obj").write_text(QUAD)
    (mesh,) = ep.load_scene(path).scene.meshes
    assert len(mesh.triangles) == 2
