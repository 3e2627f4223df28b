"""polarization="auto": field vectors where they matter, and how far off one coefficient a hit is there."""
import numpy as np
import pytest

import echopath as ep
from echopath.actors import shapes
from support.radars import build_radar

FREQUENCY = 77e9
WAVELENGTH = ep.speed_of_light / FREQUENCY
METAL, CONCRETE = ep.Material.metal(), ep.Material(permittivity=5.3 - 0.3j)
LAMBERT = ep.Material(reflectivity=0.5, scattering=1.0)
SIDE = 0.3                 # m, of the faces of a dihedral
TILTS = np.radians([0.0, 20.0, 45.0, 70.0, 90.0])
EDGES_DB = 0.3             # physical optics of the edges of faces of 77 wavelengths, and the rays


def scene_of(*materials) -> ep.Scene:
    scene = ep.Scene()
    for number, material in enumerate(materials):
        scene.add(shapes.plate(0.5, 0.5), name=f"plate_{number}", material=material, position=(10.0 + number, 0.0, 0.0))
    return scene


def model_of(scene, radar=None, **settings) -> str:
    return ep.trace(scene, radar or radar_of(), num_rays=64, max_bounces=2, **settings).frame.polarization


def radar_of(*receivers):
    return build_radar(receivers=list(receivers) or [ep.Antenna()])


@pytest.mark.parametrize("material, model", [
    (METAL, "jones"), (CONCRETE, "jones"), (ep.Material(permittivity=5, roughness_height=1e-4), "jones"),
    (LAMBERT, "scalar"), (ep.Material(permittivity=5, roughness_height=3e-3), "scalar"),
    (ep.Material.metal(mirror=True), "scalar"),
    (ep.Material(reflectivity=0.5, scattering=1.0, cross_polarization=0.1), "jones")])
def test_field_vectors_where_a_material_asks_for_them(material, model):
    scene = scene_of(LAMBERT, material)
    assert model_of(scene) == model
    (effect,) = [one for one in ep.effects(scene, radar_of()) if one.name == "polarised fields"]
    assert effect.modelled == (model == "jones") and ("plate_1" in effect.reason) == (model == "jones")
    for chosen in ("scalar", "jones"):
        assert model_of(scene, polarization=chosen) == chosen


def test_antennas_of_two_polarisations_ask_for_field_vectors():
    crossed = radar_of(ep.Antenna(), ep.Antenna(polarization=(0, 1, 0)))
    assert model_of(scene_of(LAMBERT), crossed) == "jones" and model_of(scene_of(LAMBERT)) == "scalar"


def test_a_word_that_is_no_model_is_refused():
    with pytest.raises(ValueError, match="polarization: must be 'auto', 'scalar' or 'jones', got 'stokes'"):
        model_of(scene_of(METAL), polarization="stokes")
    with pytest.raises(ValueError, match="model: must be 'auto', 'scalar' or 'jones', got 'stokes'"):
        ep.rcs(scene_of(METAL), frequency=FREQUENCY, incidence=(-1, 0, 0), model="stokes")
    with pytest.raises(ValueError, match="model: 'scalar' takes one vector"):
        ep.rcs(scene_of(METAL), frequency=FREQUENCY, incidence=(-1, 0, 0), polarization="vv", model="scalar")


def test_a_frequency_may_be_an_array_of_no_axes():
    scene = dihedral(np.pi / 4)
    settings = {"incidence": (-1, 0, 0), "max_bounces": 2, "num_rays": 4096}
    assert ep.rcs(scene, frequency=np.array(FREQUENCY), **settings) == ep.rcs(scene, frequency=FREQUENCY, **settings)


def dihedral(tilt: float) -> ep.Scene:
    """Metal faces that open toward -x; the fold turned from z by `tilt` in rad about the line of sight."""
    fold = np.array([0.0, np.sin(tilt), np.cos(tilt)])
    across = np.array([0.0, np.cos(tilt), -np.sin(tilt)])
    scene = ep.Scene()
    for number, side in enumerate((1.0, -1.0)):
        along = SIDE * (np.array([-1.0, 0.0, 0.0]) + side * across) / np.sqrt(2.0)
        corners = np.array([fold, -fold]) * SIDE / 2
        vertices = np.array([corners[0], corners[1], corners[1] + along, corners[0] + along])
        scene.add(ep.Mesh(vertices, [[0, 1, 2], [0, 2, 3]]), name=f"face_{number}", material=METAL)
    return scene


@pytest.mark.parametrize("tilt", TILTS)
def test_a_dihedral_turns_the_polarisation_as_its_fold_lies(tilt):
    """Along the bisector: sigma = 8 pi (a b)^2 / lambda^2 of the field that is turned to the other side of the fold, of which
    the antenna takes cos^2(2 tilt) (Ruck 1970)."""
    truth = 8 * np.pi * (SIDE * SIDE) ** 2 / WAVELENGTH ** 2 * np.cos(2 * tilt) ** 2
    found = ep.rcs(dihedral(tilt), frequency=FREQUENCY, incidence=(-1, 0, 0), max_bounces=2, num_rays=1 << 16)
    if np.cos(2 * tilt) ** 2 > 1e-6:
        assert 10 * np.log10(found / truth) == pytest.approx(0.0, abs=EDGES_DB)
    else:
        assert found < 1e-4 * 8 * np.pi * SIDE ** 4 / WAVELENGTH ** 2
        assert ep.rcs(dihedral(tilt), frequency=FREQUENCY, incidence=(-1, 0, 0), max_bounces=2, num_rays=1 << 14,
                      model="scalar") > 0.5 * 8 * np.pi * SIDE ** 4 / WAVELENGTH ** 2  # blind to it


FLOOR = ep.Mesh([(-20, -30, 0), (60, -30, 0), (60, 30, 0), (-20, 30, 0)], [[0, 1, 2], [0, 2, 3]])
ROLLED = (np.cos(np.pi / 4), np.sin(np.pi / 4), 0.0, 0.0)  # a quarter of a turn about the boresight


@pytest.mark.parametrize("distance, height", [(20.0, 0.52), (30.0, 0.5)])
@pytest.mark.parametrize("antenna, sign, model", [({}, 1.0, "jones"), ({"orientation": ROLLED}, -1.0, "scalar"),
                                                  ({"polarization": (0, 1, 0)}, -1.0, "scalar")])
def test_a_metal_floor_mirrors_upright_waves_with_the_other_sign_than_level_ones(distance, height, antenna, sign, model):
    """A small rough patch as high as the radar is seen by (1 + sign e^{-jk(d' - d)} d / d')^2 of its field."""
    radar = build_radar(transmitters=[ep.Antenna(**antenna)], receivers=[ep.Antenna(**antenna)], position=(0, 0, height))
    scene = ep.Scene()
    scene.add(FLOOR, name="floor", material=ep.Material.metal(mirror=True))
    scene.add(shapes.plate(0.005, 0.005), name="patch", material=ep.Material(reflectivity=1.0, scattering=1.0),
              position=(distance, 0, height), yaw=np.pi)
    paths = ep.trace(scene, radar, num_rays=2000)
    assert paths.frame.polarization == model
    whole, direct = (ep.received_power(paths.select(one)).power for one in ("T .* 'patch' .* R", "T 'patch' R"))
    image = np.hypot(distance, 2.0 * height)
    expected = abs(1.0 + sign * distance / image * np.exp(-2j * np.pi / WAVELENGTH * (image - distance))) ** 4
    if expected > 1.0:
        assert 10 * np.log10(whole / direct / expected) == pytest.approx(0.0, abs=0.2)
    else:
        assert whole < 0.2 * direct  # in a null, which the patch fills a little


def test_metal_walls_beside_upright_antennas_need_no_field_vectors():
    scene = scene_of(LAMBERT)
    scene.add(shapes.wall(20.0, 20.0), name="wall", material=ep.Material.metal(mirror=True), position=(10, 5, -10))
    assert model_of(scene) == "scalar"
    slanted = ep.Antenna(polarization=np.array((0.0, 1.0, 1.0)) / np.sqrt(2.0))
    assert model_of(scene, build_radar(transmitters=[slanted], receivers=[slanted])) == "jones"
    (effect,) = [one for one in ep.effects(scene, build_radar(transmitters=[slanted], receivers=[slanted]))
                 if one.name == "polarised fields"]
    assert effect.modelled and effect.reason == "flagged mirrors of metal whose normals lie along the polarisation: wall"
    lying = ep.KeyframeMotion(times=[0.0, 1.0], translations=np.zeros((2, 3)), rotations=[[np.sqrt(0.5), np.sqrt(0.5), 0, 0]] * 2)
    assert model_of(scene, build_radar(motion=lying)) == "jones"  # on its side, with upright fields of its own along the normal
