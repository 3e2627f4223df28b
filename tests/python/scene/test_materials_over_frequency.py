"""Named materials at other frequencies than 77 GHz, against what their sources say there."""
import gc
import math
import re
import weakref

import numpy as np
import pytest

import echopath as ep
from echopath.base.storage.data_folder import data_folder

EPS0 = 8.8541878128e-12


@pytest.mark.parametrize("name, frequency, permittivity, conductivity", [
    ("skin", 10e9, 31.29, 8.014), ("skin", 60e9, 7.975, 36.40),  # as the data base of Gabriel's models at IFAC lists dry skin
    ("concrete", 24e9, 5.24, 0.0462 * 24**0.7822), ("soil", 5.8e9, 15.0 * 5.8**-0.1, 0.035 * 5.8**1.63)])
def test_permittivities_are_those_of_the_sources(name, frequency, permittivity, conductivity):
    found = ep.materials.at(frequency)[name].permittivity
    assert found.real == pytest.approx(permittivity, rel=1e-3)
    assert -found.imag * 2 * math.pi * frequency * EPS0 == pytest.approx(conductivity, rel=1e-3)


@pytest.mark.parametrize("frequency", [1e9, 10e9, 60e9, 300e9])
def test_water_is_that_of_liebe_at_20_degrees(frequency):
    theta, f = 1 - 300 / 293.15, frequency / 1e9
    static, relaxation = 77.66 - 103.3 * theta, 20.20 + 146 * theta + 316 * theta**2
    middle, last = 0.0671 * static, 3.52
    liebe = (static - middle) / (1 + 1j * f / relaxation) + (middle - last) / (1 + 1j * f / (39.8 * relaxation)) + last
    assert ep.materials.at(frequency)["water"].permittivity == pytest.approx(liebe, rel=2e-4)


@pytest.mark.parametrize("name, frequency, largest_rms_db", [
    ("snow", 10e9, 0.5), ("grass", 10e9, 1.3), ("gravel", 24e9, 2.3), ("snow", 24e9, 0.5), ("asphalt_road", 24e9, 0.5),
    ("concrete_road", 10e9, 0.5)])
def test_grounds_keep_to_their_regression_over_frequency(name, frequency, largest_rms_db):
    head = (data_folder("materials") / "backscatter" / f"{name}.csv").read_text(encoding="utf-8").splitlines()[0]
    tail = head.split("at 77 GHz")[-1]
    level, slope, growth = (float(re.search(f"{key} = (-?[0-9.]+)", tail)[1]) for key in ("A1", "A2", "A3"))
    grazing_deg = np.arange(3.0, 31.0)
    regression = level + slope * np.log10(grazing_deg / 20.0) + growth * np.log10(frequency / 10e9)
    found = 10 * np.log10(ep.materials.at(frequency)[name].backscatter(np.radians(grazing_deg), frequency=frequency))
    assert np.sqrt(np.mean((found - regression)**2)) < largest_rms_db


def test_a_crown_loses_what_the_model_of_vegetation_says():
    """0.2 f^0.3 d^0.6 dB of 3 m, f in MHz, of which each of two passes loses half."""
    for frequency in (1e9, 24e9, 77e9):
        passed = ep.sheet_coefficients(ep.materials.at(frequency)["foliage"], frequency=frequency, incidence=0.0).passed_power()
        assert -20 * np.log10(passed[0]) == pytest.approx(0.2 * (frequency / 1e6)**0.3 * 3**0.6, rel=0.03)


def test_sheets_go_with_what_they_are_made_of():
    at_24, at_10 = ep.materials.at(24e9), ep.materials.at(10e9)
    assert at_24["glass_pane"].layers[0].permittivity == at_24["glass"].permittivity != ep.materials["glass"].permittivity
    assert [layer.permittivity for layer in at_10["wooden_door"].layers] == [at_10["chipboard"].permittivity, 1.0,
                                                                           at_10["chipboard"].permittivity]
    assert "glass_pane" not in at_24.not_given and "painted_bumper" in at_24.not_given


def test_laws_and_library_differ_at_77_ghz_as_the_docstring_says():
    """Of the power that half spaces reflect and that sheets let pass."""
    def powers(library) -> dict:
        sheets = {name: ep.sheet_coefficients(material, frequency=77e9, incidence=0.0).passed_power()[0]
                  for name, material in library.items() if material.layers}
        indices = {name: np.sqrt(material.permittivity) for name, material in library.items() if material.permittivity}
        return {name: abs((1 - index) / (1 + index))**2 for name, index in indices.items()} | sheets

    of_laws, of_library = powers(ep.materials.at(77e9)), powers(ep.materials)
    differences = {name: 10 * np.log10(of_laws[name] / of_library[name]) for name in of_library}
    told = {"concrete": 0.22, "glass_pane": 1.74}
    for name, difference in differences.items():
        assert difference == pytest.approx(told.get(name, 0.0), abs=0.02 if name in told else 0.1), name


@pytest.mark.parametrize("frequency", [1e9, 3e9, 10e9, 60e9])
def test_bumpers_are_given_where_they_reflect_what_is_given(frequency):
    """The mean of what sheets of 2 to 4 mm of polypropylene reflect, by Airy's sum; thin ones reflect next to nothing."""
    phase = 2 * np.pi * 1.48 * np.linspace(2e-3, 4e-3, 201) * frequency / ep.speed_of_light
    face = (0.48 / 2.48)**2
    mean = np.mean(4 * face * np.sin(phase)**2 / ((1 - face)**2 + 4 * face * np.sin(phase)**2))
    library = ep.materials.at(frequency)
    is_right = abs(10 * np.log10(library["bumper"].reflectivity / mean)) < 1.5
    assert is_right == ("bumper" not in library.not_given)


def test_what_nobody_gives_keeps_its_values_and_is_named():
    library = ep.materials.at(24e9)
    assert {"rubber", "clothing", "soil"} <= set(library.not_given) and not {"metal", "skin", "grass"} & set(library.not_given)
    assert all(library[name] == ep.materials[name] for name in library.not_given)
    assert ep.materials.not_given == ep.materials.at(77e9).not_given == ()  # those of a tenth around 77 GHz hold there
    assert ep.materials.at(77e9)["asphalt"] == ep.materials["asphalt"]      # whose law ends at 40 GHz
    assert list(library) == list(ep.materials) and ep.materials.at(24e9) is library
    with pytest.raises(ValueError, match="frequency: must be"):
        ep.materials.at(24.0)


def test_a_run_over_many_frequencies_does_not_keep_them_all():
    """As of a data set whose radars all have others: each library was kept for good."""
    libraries = [weakref.ref(ep.materials.at(20e9 + 1e6 * number)) for number in range(200)]
    gc.collect()
    assert 0 < sum(library() is not None for library in libraries) < 100


def radar_at(frequency):
    return ep.Radar(ep.ChirpSequence(start_frequency=frequency - 75e6, bandwidth=150e6, num_samples=32, sampling_rate=2e6,
                                     num_chirps=2),
                    transmitters=[ep.Antenna()], receivers=[ep.Antenna()])


def street():
    scene = ep.Scene()
    scene.add(ep.actors.wall(8.0, 3.0), name="wall", material=ep.materials["brick"].replace(mirror=True), position=(0, 3, 0))
    scene.add(ep.actors.pedestrian(), name="person", position=(6, 0, 0))
    scene.add(ep.actors.plate(1.0, 1.0), name="own", material=ep.materials["skin"].replace(scattering=0.5), position=(9, 0, 0))
    return scene


def test_a_whole_scene_gets_the_values_at_its_radar():
    scene, at_60 = street(), ep.materials.at(60e9)
    assert ep.adapt_materials(scene, radar_at(60e9)) == ("clothing",)
    assert scene["wall"].material == at_60["brick"].replace(mirror=True)
    materials = {mesh.name: mesh.material for mesh in scene.meshes}
    assert materials["person/head"] == at_60["skin"] and materials["person/torso"] == ep.materials["clothing"]
    assert materials["own"] == ep.materials["skin"].replace(scattering=0.5)
    ep.adapt_materials(scene, radar_at(24e9))  # from the names, not from what the first call left
    assert scene["wall"].material == ep.materials.at(24e9)["brick"].replace(mirror=True)
    assert scene["person/head"].material == ep.materials.at(24e9)["skin"]


def test_what_was_read_for_another_frequency_gets_the_values_at_the_radar(tmp_path):
    """Models that were read for 24 GHz lost their names, so that the values stayed before a radar at 60 GHz, and nothing told."""
    (tmp_path / "wall.obj").write_text("v 5 0 0\nv 5 1 0\nv 5 0 1\nusemtl itu_concrete\nf 1 2 3\n", encoding="utf-8")
    scene = ep.Scene()
    scene.add(ep.load_model(tmp_path / "wall.obj", frequency=24e9), name="wall")
    scene.add(ep.actors.plate(1.0, 1.0), name="plate", material=ep.materials.at(24e9)["skin"])
    assert {mesh.material_name for mesh in scene.meshes} == {"concrete", "skin"}
    ep.adapt_materials(scene, radar_at(60e9))
    assert {mesh.material for mesh in scene.meshes} == {ep.materials.at(60e9)[name] for name in ("concrete", "skin")}


class ReadScene(ep.Scene):
    """Counts how often all of its nodes are read."""

    num_reads = 0

    @property
    def nodes(self):
        ReadScene.num_reads += 1
        return super().nodes


def test_a_scene_of_many_objects_is_read_once():
    """Once for each object, two thousand took 10 s."""
    scene = ReadScene()
    for number in range(20):
        scene.add(ep.actors.plate(1.0, 1.0), name=f"plate_{number}", material="brick")
    ReadScene.num_reads = 0
    ep.adapt_materials(scene, radar_at(24e9))
    assert ReadScene.num_reads == 1
    assert {node.material for node in scene.nodes} == {ep.materials.at(24e9)["brick"]}


def test_an_adapted_plate_has_the_echo_of_its_permittivity():
    scene = ep.Scene()
    scene.add(ep.actors.plate(0.3, 0.3), name="plate", material="concrete", position=(0, 0, 0))
    at = dict(frequency=10e9, incidence=(-1, 0, 0), observation=(-1, 0, 0), num_rays=2000)
    before = ep.rcs(scene, **at)
    ep.adapt_materials(scene, radar_at(10e9))
    powers = [abs((1 - np.sqrt(eps)) / (1 + np.sqrt(eps)))**2 for eps in (5.0 - 0.3j, 5.24 - 0.5029j)]
    assert np.squeeze(ep.rcs(scene, **at) / before) == pytest.approx(powers[1] / powers[0], rel=1e-4)


SCENE_FILE = """adapt_materials = {adapt}
[radar.waveform]
start_frequency = 59.925e9
bandwidth = 150e6
num_samples = 32
sampling_rate = 2e6
num_chirps = 2
chirp_interval = 60e-6
[[radar.transmitters]]
position = [0, 0, 0]
[[radar.receivers]]
position = [0, 0, 0]
[[objects]]
actor = "plate"
parameters = {{width = 1.0, height = 1.0}}
material = {material}
name = "plate"
"""


@pytest.mark.parametrize("adapt, material, frequency", [
    ("false", '"skin"', 77e9), ("true", '"skin"', 60e9), ("false", '{base = "skin", frequency = 24e9, scattering = 0.5}', 24e9)])
def test_scene_files_choose_the_frequency(tmp_path, adapt, material, frequency):
    path = tmp_path / "scene.toml"
    path.write_text(SCENE_FILE.format(adapt=adapt, material=material), encoding="utf-8")
    found = ep.load_scene(path).scene["plate"].material
    expected = ep.materials["skin"] if frequency == 77e9 else ep.materials.at(frequency)["skin"]
    assert found.permittivity == expected.permittivity


def test_a_frequency_without_a_base_is_refused(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text(SCENE_FILE.format(adapt="false", material="{permittivity = 2.0, frequency = 24e9}"), encoding="utf-8")
    with pytest.raises(ValueError, match="frequency.* needs a base"):
        ep.load_scene(path)
