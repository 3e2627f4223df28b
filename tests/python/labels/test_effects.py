"""The report of modelled effects: each is there exactly when the scene or the radar asks for it."""
import inspect
import warnings

import h5py
import numpy as np
import pytest

import echopath as ep
from echopath.cli import report
from echopath.effects import rules
from echopath.tracing.lost_rays import warn_of_unaimed, warn_of_unfollowed_frusta

SPECULAR, ROUGH = "metal", ep.Material(reflectivity=0.27, scattering=1.0)
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


def test_a_transmitter_alone_does_not_take_turns():
    turns = found()["transmitters send at once by a code"], found()["transmitters take turns (TDM)"]
    assert [(effect.modelled, effect.reason) for effect in turns] == [(False, "one transmitter"), (False, "1 transmitter")]


def deforming():
    vertices = np.array([[0, 0, 0], [0, 1, 0], [0, 0, 1.0]])
    scene = ep.Scene()
    scene.add(ep.Mesh(vertices, [[0, 1, 2]]), name="plate", material=SPECULAR,
              motion=ep.VertexSequence(times=[-1.0, 1.0], vertices=[vertices, 1.1 * vertices]))
    return scene


STAGGERED = ep.ChirpSequence(num_chirps=2, extra_idle=(0.0, 1e-6))
WIDE = ep.ChirpSequence(start_frequency=3e9, bandwidth=2.9e9, frequency_steps=(0.0, 0.1e9), num_chirps=2)
LOW = ep.ChirpSequence(start_frequency=24e9, bandwidth=150e6, num_chirps=2)
MOVING = ep.LinearMotion(velocity=(1, 0, 0))
LOBED = ep.Material(reflectivity=0.5, scattering=1.0, lobe_exponent=4)
TURNING = ep.Material(reflectivity=0.5, scattering=1.0, cross_polarization=0.2)


SPECULAR_BALL = ep.Scene()
SPECULAR_BALL.add(ep.actors.sphere(0.1), name="ball", material=SPECULAR, position=(5, 0, 0), smooth=True)
MIRROR = ep.Material.metal(mirror=True)


def rod_of(radius):
    scene = ep.Scene()
    scene.add(ep.actors.pole(radius=radius, height=1.0), name="rod", position=(5, 0, 0))
    return scene


def rainy():
    scene = make_scene()
    scene.weather = ep.Weather(rain_mm_per_hour=10)
    return scene


def beside_mirror():
    scene = make_scene(ROUGH)
    scene.add(ep.actors.wall(9, 3), name="wall", material=MIRROR, position=(3, 2, 0))
    return scene


# Of each effect: what asks for it (scene, radar, settings), a word of the reason, and what does not.
CASES = {
    "materials over frequency": (dict(scene=make_scene("concrete")), "at 77 GHz",
                                 dict(scene=make_scene("concrete"), radar=make_radar().replace(waveform=LOW))),
    "coherent physical optics": (dict(scene=make_scene()), "1 mesh: plate", dict(scene=make_scene(ROUGH))),
    "footprint filter": (dict(footprint="first_order"), "first order", dict(footprint="none")),
    "smooth surfaces": (dict(scene=make_scene(smooth=True)), "plate", {}),
    "tubes behind curved bounces": (dict(scene=SPECULAR_BALL), "ball", dict(scene=SPECULAR_BALL, max_bounces=1)),
    "caustics": (dict(scene=SPECULAR_BALL), "quarter turns", {}),
    "shadow's edge of curved surfaces": (dict(scene=SPECULAR_BALL), "125 and 155 degrees",
                                         dict(scene=SPECULAR_BALL, footprint="none")),
    "bodies wide against the wavelength": (dict(scene=rod_of(0.0014)), "two thirds of a wavelength (2.6 mm)",
                                           dict(scene=rod_of(0.0012))),
    "check of the tessellation": ({}, "0.3 dB", dict(scene=make_scene(ROUGH))),
    "perfect conductors": ({}, "plate", dict(scene=make_scene(ROUGH))),
    "Fresnel coefficients": (dict(scene=make_scene("concrete")), "plate", {}),
    "constant reflectivity": (dict(scene=make_scene(ep.Material(reflectivity=0.5))), "plate", {}),
    "diffuse lobe, random phase": (dict(scene=make_scene(ROUGH)), "plate", {}),
    "loss by roughness height": (dict(scene=make_scene(ep.Material(permittivity=4.0, roughness_height=3e-4))), "plate", {}),
    "mirrors by images": (dict(scene=make_scene(MIRROR)), "plate", {}),
    "large planes by images": ({}, "a trace tells which", dict(scene=make_scene(ROUGH))),
    "legs over images": (dict(scene=beside_mirror()), "two mirrors", dict(scene=make_scene(MIRROR))),
    "multiple bounces": (dict(max_bounces=2), "= 2", dict(max_bounces=1)),
    "Russian roulette behind bounce 3": (dict(max_bounces=4), "= 4", dict(max_bounces=3)),
    "edges and orders of mirrors": ({}, "Fresnel zone", dict(scene=make_scene(ROUGH))),
    "both orders of diffuse chains": (dict(scene=make_scene(ROUGH)), "share their phases", {}),
    "motion over chirps": (dict(radar=make_radar(motion=MOVING)), "the radar moves", {}),
    "velocities that fold": (dict(scene=make_scene(motion=ep.LinearMotion(velocity=(100, 0, 0)))), "'plate' at +99.02 m/s", {}),
    "motion within chirps": (dict(scene=make_scene(motion=MOVING), evaluate="samples"), "at every sample", {}),
    "points of reflection that move": (dict(replay="fermat"), "Newton", {}),
    "records renewed at keyframes": (dict(retrace="invalid"), "shadows", {}),
    "deforming meshes": (dict(scene=deforming()), "plate", {}),
    "paths at rest evaluated once": ({}, "1 of 1", dict(scene=make_scene(motion=MOVING))),
    "antenna patterns": (dict(radar=make_radar(pattern=ep.CosinePower(2.0))), "cosine_power", {}),
    "gain tables": (dict(radar=make_radar(pattern=PHASED)), "1 antenna", {}),
    "antenna phases": (dict(radar=make_radar(pattern=PHASED)), "phase", {}),
    "array from one set of rays": (dict(radar=make_radar(2)), "2 x 1", {}),
    "transmitters take turns (TDM)": (dict(radar=make_radar(2)), "2 transmitters", {}),
    "transmitters send at once by a code": (dict(radar=make_radar(2).replace(multiplexing="bpm")), "bpm", {}),
    "chirps that differ within a frame": (dict(radar=make_radar().replace(waveform=STAGGERED)), "extra_idle", {}),
    "faults of the receiver": (dict(radar=make_radar().replace(receiver=ep.Receiver(iq_gain_db=1.0))), "iq_gain_db", {}),
    "polarised fields": ({}, "no flagged mirrors: plate", dict(polarization="scalar")),
    "depolarisation by roughness": (dict(scene=make_scene(TURNING)), "plate",
                                    dict(scene=make_scene(TURNING), polarization="scalar")),
    "residual video phase": ({}, "always", None),
    "anti-alias filter": ({}, "76.75 m", None),
    "real samples": (dict(radar=make_radar(real=True)), "real", {}),
    "thermal noise": (dict(noise_seed=3), "noise figure 12 dB", {}),
    "speckle that goes on from frame to frame": (dict(scene=make_scene(ROUGH), scatterers="surface"), "surface",
                                                 dict(scene=make_scene(ROUGH))),
    "directive lobes and backscatter": (dict(scene=make_scene(LOBED)), "plate", dict(scene=make_scene(ROUGH))),
    "attenuation by weather": (dict(scene=rainy()), "rain 5.8", {}),
    "echoes of rain": (dict(scene=rainy()), "nothing hides it", dict(scene=rainy(), effects={"echoes of rain": False})),
    "interference": (dict(scene=ep.Scene(make_scene(), interferers=[ep.Interferer(radar=make_radar())])), "another radar", {}),
    "levels that follow the wavelength over the band": ({}, "0.11 dB", dict(radar=make_radar().replace(waveform=WIDE))),
    "transmission through sheets": (dict(scene=make_scene(ep.materials["glass_pane"])), "-6.3 dB", {}),
    "edge diffraction": (dict(edges=True), "looked for", {}),
    "few faint paths for many": (dict(scene=make_scene(ROUGH), faint_power="auto"), "one in 4", dict(scene=make_scene(ROUGH))),
    "even spread of the rays": (dict(sampler="r2"), "r2", dict(sampler="random")),
    "rays aimed at objects": ({}, "a cone", dict(scene=make_scene(MIRROR))),
    "standard errors": (dict(batches=8), "batches = 8", {}),
    "rays until an error is met": (dict(target_error_db=0.1), "0.1", {}),
}


@pytest.mark.parametrize("name", CASES)
def test_an_effect_is_on_where_something_asks_for_it_and_off_where_nothing_does(name):
    asking, because, plain = CASES[name]
    effect = found(**asking)[name]
    assert effect.modelled and because in effect.reason
    if plain is not None:
        other = found(**plain)[name]
        assert not other.modelled and other.reason


@pytest.mark.parametrize("angle_deg, words", [(0.0, "cosine_power"), (8.0, "beams turn by 8 degrees within the frame")])
def test_a_beam_that_sweeps_within_the_frame_is_named(angle_deg, words):
    radar = make_radar(pattern=ep.CosinePower(2.0))
    turn = ep.LinearMotion(angular_velocity=(0.0, 0.0, np.radians(angle_deg) / radar.frame_duration))
    effect = found(radar=radar.replace(motion=turn))["antenna patterns"]
    assert effect.modelled and words in effect.reason and ("turn" in effect.reason) == (angle_deg > 0.0)


@pytest.mark.parametrize("interval, words", [(60e-6, "beyond 8994 m, which meet the next chirp"), (600e-6, "m are cut off")])
def test_echoes_that_come_after_the_next_chirp_has_begun_are_named(interval, words):
    """Half of 299 792 458 m/s times 60 us is 8994 m; 1024 samples over 2 MHz hear as far as 76.7 km, 600 us wait for 89.9 km."""
    waveform = ep.ChirpSequence(start_frequency=9.4e9, bandwidth=2e6, num_samples=1024, sampling_rate=20e6, num_chirps=2,
                                chirp_interval=interval)
    reason = found(radar=make_radar().replace(waveform=waveform))["anti-alias filter"].reason
    assert words in reason and ("meet" in reason) == ("meet" in words)


def test_a_record_does_not_deny_the_other_radars_of_its_scene():
    """Paths keep neither other radars nor their signals, the scene of a frame does: each speaks of what it knows."""
    scene = ep.Scene(make_scene(), interferers=[ep.Interferer(radar=make_radar().replace(position=(0, 3, 0)))])
    for surroundings, of_frame in ((scene, "dBm of other radars"), (make_scene(), "the scene has no other radars")):
        frame = ep.simulate(surroundings, make_radar(), num_rays=200, guard=False)
        reasons = [next(effect.reason for effect in told if effect.name == "interference")
                   for told in (frame.effects, frame.paths.effects)]
        assert of_frame in reasons[0]
        assert reasons[1] == "a record has none; simulate adds those of a scene"


def test_materials_that_do_not_go_with_the_radar_are_named():
    scene, radar = make_scene("concrete"), make_radar().replace(waveform=LOW)
    stale = found(scene, radar)["materials over frequency"]
    assert not stale.modelled and "ep.adapt_materials" in stale.reason and "concrete" in stale.reason
    ep.adapt_materials(scene, radar)
    adapted = found(scene, radar)["materials over frequency"]
    assert adapted.modelled and "at 24.1 GHz" in adapted.reason
    unknown = found(make_scene("rubber"), radar)["materials over frequency"]
    assert not unknown.modelled and "nobody gives rubber at 24.1 GHz" in unknown.reason


def test_materials_of_another_radar_are_named():
    """Those of one at 24 GHz before one at 77 GHz, and of one plate of two that was given its material anew."""
    scene, low = make_scene("skin"), make_radar().replace(waveform=LOW)
    scene.add(ep.actors.plate(1.0, 1.0), name="first", material="skin", position=(9, 0, 0))
    ep.adapt_materials(scene, low)
    at_77 = found(scene)["materials over frequency"]
    assert not at_77.modelled and "gives skin the values at 77.5 GHz" in at_77.reason
    scene["plate"].material = "skin"
    assert not found(scene, low)["materials over frequency"].modelled and not found(scene)["materials over frequency"].modelled
    scene["plate"].visible = False
    assert found(scene, low)["materials over frequency"].modelled
    ep.adapt_materials(scene, make_radar())
    assert found(scene)["materials over frequency"].modelled


def test_materials_of_a_frequency_go_with_radars_right_beside_it():
    """Those of ep.materials.at and of models that were read for 24 GHz, before a radar from 24 to 24.15 GHz."""
    scene, low = make_scene(ep.materials.at(24e9)["snow"]), make_radar().replace(waveform=LOW)
    assert found(scene, low)["materials over frequency"].modelled
    assert not found(scene, low.replace(waveform=LOW.replace(start_frequency=26e9)))["materials over frequency"].modelled
    assert not found(scene)["materials over frequency"].modelled


def test_every_rule_has_a_case():
    assert set(CASES) == {rule.name for rule in rules.RULES}


def keywords_of(function) -> set:
    return set(inspect.signature(function).parameters)


def fields_of(kind) -> set:
    return {name for name, member in vars(kind).items() if isinstance(member, property)}


PUBLIC = {"Material": fields_of(ep.Material), "Antenna": fields_of(ep.Antenna),
          "AntennaPattern": fields_of(ep.AntennaPattern), "ChirpSequence": fields_of(ep.ChirpSequence),
          "Radar": fields_of(ep.Radar), "Node": fields_of(ep._core.Node), "trace": keywords_of(ep.trace),
          "synthesize": keywords_of(ep.synthesize)}


@pytest.mark.parametrize("owner", PUBLIC)
def test_every_field_and_setting_is_answered_for(owner):
    """A new one needs a rule that names it, or stands with the quantities that ask for no effect (effects/rules.py)."""
    answered = {field.split(".")[1] for rule in rules.RULES for field in rule.answers_for if field.split(".")[0] == owner}
    known = answered | set(rules.QUANTITIES[owner])
    assert PUBLIC[owner] - known == set() and known - PUBLIC[owner] == set()


def test_settings_of_a_trace_are_all_given_to_the_rules():
    given = set(inspect.signature(ep.effects).parameters)
    asked = {field.split(".")[1] for rule in rules.RULES for field in rule.answers_for
             if field.split(".")[0] in ("trace", "synthesize")}
    assert asked <= given


def test_the_signal_of_a_frame_has_effects_of_its_own():
    frame = ep.simulate(make_scene(motion=MOVING), make_radar(), num_rays=100, evaluate="samples", noise_seed=5)
    by_name = {effect.name: effect for effect in frame.effects}
    assert by_name["thermal noise"].reason.endswith("noise_seed = 5")
    assert "samples" in by_name["motion within chirps"].reason


def test_a_scalar_trace_says_that_it_does_not_tell_antennas_apart():
    half = np.sqrt(0.5)
    crossed = ep.Antenna(polarization=(0, 1, 0))
    turned = ep.Antenna(orientation=(half, half, 0, 0), polarization=(0, 1, 0))  # +y of the antenna is +z of the radar
    for receiver, is_said in ((crossed, True), (turned, False), (ep.Antenna(polarization=(0, 0, -1)), False)):
        radar = ep.Radar(ep.ChirpSequence(num_chirps=2), transmitters=[ep.Antenna()], receivers=[receiver])
        assert ("count as co-polarised" in found(radar=radar, polarization="scalar")["polarised fields"].reason) == is_said


def test_what_is_never_modelled_is_said():
    never = [effect for effect in found().values() if effect.reason.startswith(("not modelled", "out of scope"))]
    assert never and not any(effect.modelled for effect in never)


def told_by_both(effects) -> list:
    """All but the planes that image themselves, of which only a trace can tell, and rain and other radars, of which none can."""
    return [effect for effect in effects if effect.name not in ("large planes by images", "echoes of rain", "interference")]


def test_the_record_knows_its_effects_and_writes_them(tmp_path):
    paths = ep.trace(make_scene(), make_radar(), num_rays=100, max_bounces=1, footprint="first_order")
    asked = ep.effects(make_scene(), make_radar(), max_bounces=1, footprint="first_order")
    assert told_by_both(paths.effects) == told_by_both(asked)
    paths.save(tmp_path / "paths.h5")
    assert ep.Paths.load(tmp_path / "paths.h5").effects == paths.effects
    with h5py.File(tmp_path / "paths.h5") as file:
        group = file["record/effects"]
        assert [name.decode() for name in group["name"]] == [effect.name for effect in paths.effects]
        assert group["modelled"][...].tolist() == [effect.modelled for effect in paths.effects]
        assert [reason.decode() for reason in group["reason"]] == [effect.reason for effect in paths.effects]


def test_the_printed_report_has_every_effect_with_its_reason():
    effects = ep.effects(make_scene(), make_radar())
    lines = report.effects(effects)
    text = " ".join(" ".join(lines).split())
    for effect in effects:
        assert sum(line.startswith(f"  {effect.name} ") for line in lines) == 1, effect.name
        assert effect.reason in text
    of_each = str(effects).splitlines()[1:]
    assert [line.split()[0] == "yes" for line in of_each] == [effect.modelled for effect in effects]
    assert all(effect.name in line and line.endswith(effect.reason) for effect, line in zip(effects, of_each, strict=True))
    assert lines.index("effects not modelled") > 10
    assert all(len(line) <= 120 for line in lines)


def test_sequences_of_mirrors_that_were_not_followed_are_said_and_warned_of():
    scene = make_scene(ep.Material.metal(mirror=True))
    paths = ep.trace(scene, make_radar(), num_rays=10)
    assert "followed" not in {effect.name: effect for effect in paths.effects}["mirrors by images"].reason
    statistics = ep.TraceStatistics(num_unfollowed_frusta=12_345)
    case = rules.Case(scene, make_radar(), None, statistics)
    effect = next(rule(case) for rule in rules.RULES if rule.name == "mirrors by images")
    assert effect.modelled and "12,345 sequences of mirrors were not followed further" in effect.reason
    with pytest.warns(RuntimeWarning, match="at least 10,000 sequences"):
        warn_of_unfollowed_frusta(statistics)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warn_of_unfollowed_frusta(ep.TraceStatistics())


def test_objects_that_no_rays_aim_at_are_said():
    statistics = ep.TraceStatistics(num_unaimed=12)
    settings = rules.Settings(**dict.fromkeys(rules.Settings.__dataclass_fields__) | {"max_bounces": 4})
    effect = next(rule(rules.Case(make_scene(), make_radar(), settings, statistics)) for rule in rules.RULES
                  if rule.name == "rays aimed at objects")
    assert effect.modelled and "12 objects and images have no rays of their own" in effect.reason
    with pytest.warns(RuntimeWarning, match="at least 10 objects and images"):
        warn_of_unaimed(statistics)


def effect_of_planes(scene):
    waveform, antenna = ep.ChirpSequence(start_frequency=24e9, num_chirps=2), ep.Antenna((3.0, 0.0, 0.0))
    radar = ep.Radar(waveform, transmitters=[antenna], receivers=[antenna])
    paths = ep.trace(scene, radar, num_rays=20_000, max_bounces=2, seed=1)
    return next(effect for effect in paths.effects if effect.name == "large planes by images")


def test_planes_that_image_themselves_are_counted_and_named():
    scene = ep.Scene()
    scene.add(ep.actors.plate(0.1, 0.1), name="small", material=SPECULAR, position=(8, 0, 0))
    assert effect_of_planes(scene) == rules.Effect("large planes by images", False,
                                                   "no plane that is not marked covers its Fresnel zone where it would mirror")
    square = np.array([[-20, -20, 0], [20, -20, 0], [20, 20, 0], [-20, 20, 0.0]])
    for name, corners in (("floor", square + [0, 0, -2]), ("wall", square[:, [0, 2, 1]] + [0, 5, 0])):
        scene.add(ep.Mesh(corners, [[0, 1, 2], [0, 2, 3]]), name=name, material=SPECULAR)
    effect = effect_of_planes(scene)
    assert effect.modelled and effect.reason == "2 planes of 2 meshes: floor, wall; their Fresnel zones are covered"


def test_of_a_town_the_first_names_stand_for_all():
    scene = ep.Scene()
    plate = ep.actors.plate(1.0, 1.0)
    for index in range(1000):
        scene.add(plate, name=f"house_{index}", material=SPECULAR, position=(5.0, 2.0 * index, 0.0))
    assert found(scene)["perfect conductors"].reason == "1,000 meshes: house_0, house_1, house_2 and 997 more"


def crowd_of_plates(count: int):
    scene = ep.Scene()
    for k in range(count):
        scene.add(ep.actors.plate(0.1, 0.1), name=f"plate_{k}", material=SPECULAR, position=(20.0, 0.5 * k - 10.0, 0.0))
    return scene


def test_objects_too_many_for_the_rays_are_said():
    with pytest.warns(RuntimeWarning, match="^at least 20 objects and images have no rays of their own"):
        paths = ep.trace(crowd_of_plates(40), make_radar(), num_rays=64, max_bounces=1)
    effect = next(effect for effect in paths.effects if effect.name == "rays aimed at objects")
    assert "40 objects and images have no rays of their own" in effect.reason
    with warnings.catch_warnings():
        warnings.simplefilter("error", RuntimeWarning)
        ep.trace(crowd_of_plates(4), make_radar(), num_rays=64, max_bounces=1)


def test_new_surface_looked_for_in_some_of_many_stretches_is_said():
    scene = ep.Scene()
    scene.add(ep.actors.plate(0.1, 0.1), name="plate", material=SPECULAR, position=(8, 0, 0),
              motion=ep.LinearMotion(velocity=(1.0, 0.0, 0.0)))
    radar = ep.Radar(ep.ChirpSequence(num_chirps=40), transmitters=[ep.Antenna((0, 0, 0))], receivers=[ep.Antenna((0, 0, 0))])
    paths = ep.trace(scene, radar, num_rays=256, max_bounces=1)
    with pytest.warns(RuntimeWarning, match="new surface is looked for in 32 of 40 stretches"):
        ep.synthesize(paths, radar, retrace="invalid", keyframes=40)
    frame = ep.simulate(scene, radar, num_rays=256, max_bounces=1, retrace="invalid", keyframes=2, guard=False)
    effect = next(effect for effect in frame.effects if effect.name == "records renewed at keyframes")
    assert effect.modelled and "in 32 of the stretches at most" in effect.reason
