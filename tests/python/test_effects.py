"""The report of modelled effects: each is there exactly when the scene or the radar asks for it."""
import h5py
import numpy as np
import pytest

import echopath as ep
from echopath.cli import report

SPECULAR, ROUGH = "metal", "clothing"
PHASED = ep.GainTable(azimuth=[-1, 0, 1], elevation=[-1, 1], gain=np.ones((2, 3)), phase=np.zeros((2, 3)))


def make_radar(num_transmitters=1, motion=None, real=False, **antenna):
    transmitters = [ep.Antenna((0, 0.002 * i, 0), **antenna) for i in range(num_transmitters)]
    return ep.Radar(ep.ChirpSequence(num_chirps=2, real=real), transmitters=transmitters, receivers=[ep.Antenna()],
                    motion=motion)


def make_scene(material=SPECULAR, motion=None, smooth=False):
    scene = ep.Scene()
    scene.add(ep.actors.plate(1.0, 1.0), name="plate", material=material, motion=motion, position=(5, 0, 0),
              smooth=smooth)
    return scene


def found(scene=None, radar=None, **settings):
    return {effect.name: effect for effect in ep.effects(scene or make_scene(), radar or make_radar(), **settings)}


def deforming():
    vertices = np.array([[0, 0, 0], [0, 1, 0], [0, 0, 1.0]])
    scene = ep.Scene()
    scene.add(ep.Mesh(vertices, [[0, 1, 2]]), name="plate", material=SPECULAR,
              motion=ep.VertexSequence(times=[-1.0, 1.0], vertices=[vertices, 1.1 * vertices]))
    return scene


MOVING = ep.LinearMotion(velocity=(1, 0, 0))


@pytest.mark.parametrize("name, scene, radar, because", [
    ("coherent physical optics", make_scene(), None, "1 mesh: plate"),
    ("footprint filter", make_scene(), None, "second order"),
    ("smooth surfaces", make_scene(smooth=True), None, "plate"),
    ("diffuse lobe, random phase", make_scene(ROUGH), None, "plate"),
    ("loss by roughness height", make_scene(ep.Material(permittivity=4.0, roughness_height=3e-4)), None, "plate"),
    ("Fresnel coefficients", make_scene("concrete"), None, "plate"),
    ("mirrors by images", make_scene(ep.Material.metal(mirror=True)), None, "plate"),
    ("motion over chirps", make_scene(motion=MOVING), None, "plate"),
    ("motion over chirps", None, make_radar(motion=MOVING), "the radar moves"),
    ("motion within chirps", make_scene(motion=MOVING), None, "linear"),
    ("deforming meshes", deforming(), None, "plate"),
    ("antenna patterns", None, make_radar(pattern=ep.CosinePower(2.0)), "cosine_power"),
    ("antenna phases", None, make_radar(pattern=PHASED), "phase"),
    ("transmitters take turns (TDM)", None, make_radar(2), "2 transmitters"),
    ("real samples", None, make_radar(real=True), "real"),
])
def test_an_effect_is_on_where_something_asks_for_it(name, scene, radar, because):
    effect = found(scene, radar)[name]
    assert effect.modelled and because in effect.reason
    # And off where nothing does: the opposite kind of surface, at rest, one isotropic antenna.
    plain = found(make_scene(ROUGH if name in ("coherent physical optics", "footprint filter") else SPECULAR))[name]
    assert not plain.modelled and plain.reason


def test_settings_switch_effects_off():
    assert not found(footprint="none")["footprint filter"].modelled
    assert not found(max_bounces=3)["Russian roulette behind bounce 3"].modelled
    assert not found(max_bounces=1)["multiple bounces"].modelled
    assert found(max_bounces=2)["multiple bounces"].modelled


def test_polarised_fields_are_on_where_the_settings_ask_for_them():
    turning = make_scene(ep.Material(reflectivity=0.5, scattering=1.0, cross_polarization=0.2))
    assert found(turning, polarization="jones")["polarised fields"].modelled
    assert found(turning, polarization="jones")["depolarisation by roughness"].modelled
    assert not found(polarization="jones")["depolarisation by roughness"].modelled
    assert not found(turning)["polarised fields"].modelled and not found(turning)["depolarisation by roughness"].modelled


def test_a_scalar_trace_says_that_it_does_not_tell_antennas_apart():
    half = np.sqrt(0.5)
    crossed = ep.Antenna(polarization=(0, 1, 0))
    turned = ep.Antenna(orientation=(half, half, 0, 0), polarization=(0, 1, 0))  # +y of the antenna is +z of the radar
    for receiver, is_said in ((crossed, True), (turned, False), (ep.Antenna(polarization=(0, 0, -1)), False)):
        radar = ep.Radar(ep.ChirpSequence(num_chirps=2), transmitters=[ep.Antenna()], receivers=[receiver])
        assert ("count as co-polarised" in found(radar=radar)["polarised fields"].reason) == is_said


def test_what_is_never_modelled_is_said():
    never = [effect for effect in found().values() if effect.reason.startswith(("not modelled", "out of scope"))]
    assert len(never) >= 4 and not any(effect.modelled for effect in never)


def test_the_record_knows_its_effects_and_writes_them(tmp_path):
    paths = ep.trace(make_scene(), make_radar(), num_rays=100, max_bounces=1, footprint="first_order")
    assert paths.effects == ep.effects(make_scene(), make_radar(), max_bounces=1, footprint="first_order")
    paths.save(tmp_path / "paths.h5")
    assert ep.Paths.load(tmp_path / "paths.h5").effects == paths.effects
    with h5py.File(tmp_path / "paths.h5") as file:
        group = file["record/effects"]
        assert [name.decode() for name in group["name"]] == [effect.name for effect in paths.effects]
        assert group["modelled"][...].tolist() == [effect.modelled for effect in paths.effects]
        assert [reason.decode() for reason in group["reason"]] == [effect.reason for effect in paths.effects]


def test_the_printed_report_has_every_effect_once():
    effects = ep.effects(make_scene(), make_radar())
    text = " ".join(" ".join(report.effects(effects)).split())
    for effect in effects:
        assert text.count(effect.name) == 1, effect.name
        assert not effect.modelled or effect.reason in text
    assert all(len(line) <= 120 for line in report.effects(effects))
