"""Materials and the library of them."""
import math

import numpy as np
import pytest

import echopath as ep
from echopath.base.storage.data_folder import data_folder
from support.radars import build_radar

TWO_PLACES = 0.005     # the material file says it with two places
THREE_PLACES = 0.0005  # with three
GARMENT = 0.66         # of the power is left by two passes through it: what the material file takes


def debye_skin(frequency):
    """Dry skin after Gabriel, Lau, Gabriel 1996 (the terms that matter above 1 GHz)."""
    omega, eps0 = 2 * math.pi * frequency, 8.8541878128e-12
    fast = 32.0 / (1 + 1j * omega * 7.234e-12)
    slow = 1100.0 / (1 + (1j * omega * 32.481e-9) ** 0.8)
    return 4.0 + fast + slow + 0.0002 / (1j * omega * eps0)


def itu_p2040(a, c, d):
    """Relative permittivity at 77 GHz from the coefficients of Recommendation ITU-R P.2040, table 3 (b = 0)."""
    return a - 1j * 17.98 * c * 77.0**d / 77.0


def test_library_has_the_promised_names():
    assert set(ep.materials) >= {"metal", "concrete", "asphalt", "glass", "skin", "clothing", "wood", "plastic",
                                 "bumper"}
    assert len(ep.materials) == len(list(ep.materials))
    assert "metal" in ep.materials and "metl" not in ep.materials


TOLERANCE = 0.1  # the library rounds; published values scatter more


@pytest.mark.parametrize("name, permittivity", [
    ("skin", debye_skin(77e9)),
    ("wood", itu_p2040(1.99, 0.0047, 1.0718)),
    ("concrete", itu_p2040(5.24, 0.0462, 0.7822)),
    ("glass", (2.51 - 0.085j) ** 2),
    ("plastic", 1.48**2),
])
def test_library_agrees_with_published_models(name, permittivity):
    assert abs(ep.materials[name].permittivity - permittivity) < TOLERANCE * abs(permittivity)


def test_clothing_reflects_like_skin_behind_a_garment():
    index = np.sqrt(debye_skin(77e9))
    skin = abs((1 - index) / (1 + index)) ** 2
    assert ep.materials["clothing"].reflectivity == pytest.approx(skin * GARMENT, abs=TWO_PLACES)


def test_bumper_is_the_mean_over_the_thickness_of_a_sheet():
    index, phase = 1.48, np.linspace(0.0, np.pi, 2001)[:-1]  # of the sheet, one way
    r = (1 - index) / (1 + index)
    sheet = np.abs(r * (1 - np.exp(-2j * phase)) / (1 - r**2 * np.exp(-2j * phase))) ** 2
    assert ep.materials["bumper"].reflectivity == pytest.approx(sheet.mean(), abs=THREE_PLACES)


def test_bodies_are_partly_rough_and_everything_has_a_source():
    for name in ("skin", "clothing"):
        assert 0.0 < ep.materials[name].scattering < 1.0
    for name in ep.materials:
        assert len(ep.materials.source(name)) > 20


def test_library_is_read_only_and_keeps_its_objects():
    assert ep.materials["metal"] is ep.materials["metal"]
    assert ep.materials["metal"] == ep.Material.metal()
    with pytest.raises(TypeError):
        ep.materials["metal"] = ep.Material.metal()


def test_unknown_names_bring_the_nearest():
    with pytest.raises(KeyError, match="concrete"):
        ep.materials["concret"]
    with pytest.raises(KeyError):
        ep.materials[3]


def test_fields_are_what_was_given():
    material = ep.Material(permittivity=4 - 0.2j, conductivity=0.1, roughness_height=1e-3, mirror=True)
    assert material.permittivity == 4 - 0.2j
    assert material.conductivity == 0.1
    assert material.roughness_height == 1e-3
    assert material.mirror and not material.conductor
    assert material.reflectivity is None and material.scattering is None and material.cross_polarization == 0.0
    assert ep.Material(permittivity=4, scattering=1.0, cross_polarization=0.3).cross_polarization == 0.3
    with pytest.raises(AttributeError):
        material.mirror = False


def test_replace_changes_a_copy():
    metal = ep.Material.metal()
    mirror = metal.replace(mirror=True)
    assert mirror.mirror and mirror.conductor and not metal.mirror
    assert mirror == ep.Material.metal(mirror=True)
    assert mirror != metal
    assert ep.materials["skin"].replace(scattering=0.5).scattering == 0.5


def test_equal_materials_are_one_key():
    assert len({ep.Material(permittivity=4), ep.Material(permittivity=4 + 0j), ep.Material(permittivity=5)}) == 2
    assert ep.Material(permittivity=4) != "metal"


@pytest.mark.parametrize("arguments, word", [
    ({}, "exactly one"),
    ({"conductor": True, "permittivity": 4}, "exactly one"),
    ({"permittivity": 4 + 1j}, "permittivity"),
    ({"permittivity": 1e200}, "permittivity: must be from 1e-100 to 1e100 in size"),
    ({"permittivity": 1e-310}, "permittivity: must be from 1e-100 to 1e100 in size"),
    ({"permittivity": 4, "conductivity": 1e300}, "conductivity: must be at most 1e100 S/m; conductor=True"),
    ({"reflectivity": 1.5}, "reflectivity"),
    ({"permittivity": 4, "scattering": 2.0}, "scattering"),
    ({"permittivity": 4, "scattering": 1.0, "cross_polarization": 0.6}, "cross_polarization"),
    ({"permittivity": 4, "roughness_height": -1.0}, "roughness_height"),
    ({"permittivity": 4, "roughness_height": 1e-3, "scattering": 0.4}, "scattering"),
])
def test_bad_values_are_refused_by_name(arguments, word):
    with pytest.raises(ValueError, match=word):
        ep.Material(**arguments)


@pytest.mark.parametrize("polarization", ["scalar", "jones"])
@pytest.mark.parametrize("matter, sign", [({"permittivity": 1e100}, 1.0), ({"permittivity": 4, "conductivity": 1e100}, 1.0),
                                          ({"permittivity": 1e-100}, -1.0)])
def test_the_largest_and_the_smallest_permittivities_reflect_all(matter, sign, polarization):
    """Fresnel's coefficient is (1 - n) / (1 + n) at normal incidence: that of a conductor without bounds, of other sign at 0."""
    echoes = []
    for material in (ep.Material.metal(), ep.Material(**matter)):
        scene = ep.Scene()
        scene.add(ep.actors.plate(1.0, 1.0), name="plate", material=material, position=(3, 0, 0))  # a mirror: one path
        echoes.append(ep.trace(scene, build_radar(num_chirps=4), num_rays=100, polarization=polarization).amplitude)
    np.testing.assert_allclose(echoes[1], sign * echoes[0], rtol=1e-6)  # weights are of single precision


@pytest.mark.parametrize("arguments, word", [
    ({"permitivity": 4}, "'permittivity'"),
    ({"permittivity": "four"}, "permittivity"),
    ({"conductor": 1}, "conductor"),
])
def test_bad_kinds_are_refused_by_name(arguments, word):
    with pytest.raises(TypeError, match=word):
        ep.Material(**arguments)


def test_reprs_are_short():
    assert repr(ep.Material.metal(mirror=True)) == "Material(conductor=True, mirror=True)"
    assert repr(ep.Material(permittivity=5 - 0.3j, scattering=0.4)) == "Material(permittivity=(5-0.3j), scattering=0.4)"
    assert repr(ep.materials).startswith("materials(asphalt, ")


def test_the_data_are_found_beside_a_source_tree_that_is_not_installed(monkeypatch):
    def not_installed(name):
        raise ModuleNotFoundError(name)

    monkeypatch.setattr("echopath.base.storage.data_folder.resources.files", not_installed)
    assert (data_folder("materials") / "metal.toml").is_file()


def test_a_mirror_of_layers_is_refused_with_what_would_do():
    layered = [name for name in ep.materials if ep.materials[name].layers]
    assert {"glass_pane", "plasterboard_wall"} <= set(layered)
    for name in layered:
        thickness = 1e3 * sum(layer.thickness for layer in ep.materials[name].layers)
        with pytest.raises(ValueError, match=rf"mirror: .* 'glass' in the place of 'glass_pane'.* got True of {thickness:g} mm"):
            ep.materials[name].replace(mirror=True)
    assert ep.materials["glass"].replace(mirror=True).mirror and ep.materials["plasterboard"].replace(mirror=True).mirror
