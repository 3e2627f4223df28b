"""Sheets: materials of layers that waves pass, against Airy's formula and against closed forms of whole scenes."""
import copy
import pickle

import numpy as np
import pytest

import echopath as ep
from echopath.scene.sheets import passed_field
from support.behind_sheets import (
    CHIRPS,
    FORMULA,
    FREQUENCY,
    GLASS,
    INSTANT,
    LEVEL,
    LEVEL_E,
    PHASE,
    RAYS,
    SAME_RAYS,
    SLANTED,
    THICKNESS,
    UPRIGHT,
    airy,
    echo_of_ball,
    field,
    make_radar,
    make_scene,
    over_free,
    power_db,
    square,
)

# --- coefficients ---

def test_a_slab_is_that_of_airy_at_all_angles():
    angles = np.linspace(0.0, np.pi / 2, 901)[:-1]
    found = ep.sheet_coefficients(GLASS, frequency=FREQUENCY, incidence=angles)
    (r_te, t_te), (r_tm, t_tm) = airy(angles)
    for one, other in ((found.te_reflection, r_te), (found.tm_reflection, r_tm), (found.te_transmission, t_te),
                       (found.tm_transmission, t_tm)):
        assert np.max(np.abs(one - other)) < FORMULA


def test_at_brewsters_angle_a_slab_without_losses_passes_what_is_tm_whole():
    """And of what is TE what Airy's sum leaves; both by their shares of the power, and on a way by where the field points."""
    slab, angle = ep.Material(layers=[ep.Layer(0.3e-3, 4.0)]), np.arctan(2.0)
    found = ep.sheet_coefficients(slab, frequency=FREQUENCY, incidence=angle)
    phase = 2.0 * np.pi * FREQUENCY / ep.speed_of_light * 0.3e-3 * np.sqrt(4.0 - 0.8)
    face = 0.6 ** 2  # of TE: (1 - 4) / (1 + 4), at this angle
    of_te = (1.0 - face) ** 2 / abs(1.0 - face * np.exp(-2j * phase)) ** 2
    for te_share in (0.0, 0.3, 1.0):
        assert found.passed_power(te_share) == pytest.approx([te_share * of_te + 1.0 - te_share], rel=1e-9)
    scene = ep.Scene()
    scene.add(ep.actors.plate(2.0, 2.0), name="slab", material=slab, yaw=angle)
    for polarization, passed in (((0, 0, 1), of_te), ((0, 1, 0), 1.0), ((0, 3, 4), 0.36 + 0.64 * of_te)):
        left = passed_field(scene, time=0.0, begin=np.array([-1.0, 0.1, 0.0]), end=np.array([1.0, 0.1, 0.0]), frequency=FREQUENCY,
                            polarization=np.array(polarization, float) / np.linalg.norm(polarization))
        assert left ** 2 == pytest.approx(passed, rel=1e-9)


@pytest.mark.parametrize("name", ["glass_pane", "painted_bumper", "plasterboard_wall", "wooden_door", "garment", "curtain",
                                  "foliage"])
def test_sheets_of_the_library_lose_power_and_make_none(name):
    angles = np.linspace(0.0, 1.5, 200)
    material = ep.materials[name]
    found = ep.sheet_coefficients(material, frequency=FREQUENCY, incidence=angles)
    behind = ep.sheet_coefficients(material, frequency=FREQUENCY, incidence=angles, from_behind=True)
    for reflected, passed in ((found.te_reflection, found.te_transmission), (found.tm_reflection, found.tm_transmission)):
        assert np.all(np.abs(reflected) ** 2 + np.abs(passed) ** 2 < 1.0)
    assert found.te_transmission == pytest.approx(behind.te_transmission, abs=FORMULA)  # reciprocity


def test_sheets_name_what_they_do_not_take():
    for wrong in (dict(layers=[]), dict(layers=[ep.Layer(0.001, 2.0)], conductor=True),
                  dict(layers=[ep.Layer(0.001, 2.0)], mirror=True)):
        with pytest.raises(ValueError, match="material|mirror"):
            ep.Material(**wrong)
    with pytest.raises(ValueError, match="thickness"):
        ep.Layer(0.0, 2.0)
    with pytest.raises(ValueError, match="permittivity"):
        ep.Layer(0.001, 2.0 + 0.1j)
    with pytest.raises(ValueError, match="layers"):
        ep.sheet_coefficients(ep.materials["metal"], frequency=FREQUENCY, incidence=0.0)


# --- what stands behind ---

@pytest.mark.parametrize("model", ["scalar", "jones"])
@pytest.mark.parametrize("polarization", [UPRIGHT, LEVEL_E, SLANTED])
def test_the_field_behind_a_pane_is_that_of_two_passages(model, polarization):
    radar, share = make_radar(polarization=polarization), polarization[2] ** 2
    free = echo_of_ball(make_scene(None), radar, polarization=model)
    for yaw in (0.0, 0.6, 1.1):
        te, tm = over_free(yaw)
        expected = (share * te + (1 - share) * tm) ** 2 if model == "scalar" else share * te**2 + (1 - share) * tm**2
        behind = echo_of_ball(make_scene(yaw=yaw), radar, polarization=model)
        ratio = field(behind) / field(free) / expected
        assert abs(abs(ratio) - 1) < RAYS and abs(np.angle(ratio)) < PHASE, yaw


def test_a_person_behind_a_pane_keeps_level_and_name():
    scenes = {}
    for pane in (None, GLASS):
        scene = ep.Scene()
        scene.add(ep.actors.pedestrian(speed=1.4), name="walker", position=(8, 0, 0), yaw=np.pi)
        if pane is not None:
            scene.add(square(), name="pane", material=pane, position=(4, 0, 1))
        scenes[pane] = ep.trace(scene, make_radar(), num_rays=30000)
    change = power_db(scenes[GLASS].select("T 'walker' R")) - power_db(scenes[None].select("T 'walker' R"))
    assert change == pytest.approx(40.0 * np.log10(abs(over_free(0.0)[0])), abs=LEVEL)
    walker = ep.families(scenes[GLASS])
    assert {family.object for family in walker if family.order == 1} >= {"walker"}


@pytest.mark.parametrize("gap", [0.02, 0.3])
def test_cross_sections_behind_sheets_are_those_of_two_passages(gap):
    """The antennas of a cross section are hundreds of kilometres away, where lengths are known to some centimetres only."""
    turn, foam = 0.5, ep.Material(layers=[ep.Layer(0.005, 1.1 - 0.04j)])
    once = ep.sheet_coefficients(foam, frequency=FREQUENCY, incidence=turn)
    free, behind = ep.Scene(), ep.Scene()
    for scene in (free, behind):
        scene.add(ep.actors.sphere(0.1, subdivisions=16), name="ball", material="metal", smooth=True)
        scene.add(ep.actors.dihedral(0.06), name="corner", material="metal", position=(0.2, 0.2, 0))
    for name, distance in (("near", 0.1 + gap), ("far", 0.1 + 2 * gap)):
        behind.add(ep.actors.plate(2.0, 2.0), name=name, material=foam, position=(-distance / np.cos(turn), 0, 0), yaw=turn)
    found, expected = (ep.rcs(scene, frequency=FREQUENCY, incidence=(-1, 0, 0), polarization=["vv", "hh"], num_rays=2**14)
                       for scene in (behind, free))
    passed = np.abs([once.te_transmission, once.tm_transmission]) ** 8
    assert 10 * np.log10(found / expected) == pytest.approx(10 * np.log10(passed.ravel()), abs=LEVEL)


def test_every_antenna_of_an_array_passes_at_its_own_angle():
    radar, yaw = make_radar(num=3), 0.9
    free, behind = echo_of_ball(make_scene(None), radar), echo_of_ball(make_scene(yaw=yaw), radar)
    normal = np.array([np.cos(yaw), np.sin(yaw), 0.0])
    passed = {}
    for end, antennas in (("tx", radar.transmitters), ("rx", radar.receivers)):
        lines = [np.array((8, 0, 1)) - antenna.position for antenna in antennas]
        passed[end] = [over_free(np.arccos(line @ normal / np.linalg.norm(line)))[0] for line in lines]
    for tx in range(3):
        for rx in range(3):
            ratio = field(behind, tx=tx, rx=rx) / field(free, tx=tx, rx=rx) / (passed["tx"][tx] * passed["rx"][rx])
            assert abs(ratio - 1) < RAYS, (tx, rx)


@pytest.mark.parametrize("wall", [ep.Layer(0.2, 3.91 - 0.05j), ep.Layer(0.02, 6.3 - 0.05j)])
def test_the_range_behind_a_wall_is_that_of_its_transmission_over_the_whole_band(wall):
    """The bounces within a wall let its delay swing over a wide band: at the start alone a way there and back is 30 to 60 mm
    longer."""
    chirps = ep.ChirpSequence(start_frequency=3e9, bandwidth=2e9, num_samples=256, sampling_rate=2e6, num_chirps=1,
                              chirp_interval=1e-3)
    radar = make_radar().replace(waveform=chirps)
    free, behind = (ep.synthesize(echo_of_ball(make_scene(pane), radar), radar)[0, 0, 0]
                    for pane in (None, ep.Material(layers=[wall])))
    frequencies = chirps.start_frequency + chirps.slope * np.arange(chirps.num_samples) / chirps.sampling_rate
    air = np.exp(2j * np.pi * frequencies * wall.thickness / ep.speed_of_light)
    passed = airy(0.0, wall, frequencies)[0][1] * air
    expected = free * np.conj(passed) ** 2  # the beat of a later echo turns forward
    found, known = (peak_of(beat, chirps) for beat in (behind, expected))
    assert found == pytest.approx(known, abs=0.005)


@pytest.mark.parametrize("start, step", [(3e9, 0.25e9), (4.75e9, -0.25e9)])
def test_the_delay_of_a_wall_is_that_over_the_band_of_all_chirps_whether_they_step_up_or_down(start, step):
    wall = ep.Layer(0.2, 3.91 - 0.05j)
    chirps = ep.ChirpSequence(start_frequency=start, bandwidth=0.25e9, num_samples=64, num_chirps=8, chirp_interval=1e-3,
                              frequency_steps=step * np.arange(8))
    assert chirps.band == (3e9, 5e9)
    radar = make_radar().replace(waveform=chirps)
    free, behind = (np.min(echo_of_ball(make_scene(pane), radar).lengths([0.0]))
                    for pane in (None, ep.Material(layers=[wall])))
    band = np.linspace(3e9, 5e9, 500)
    phase = np.unwrap(np.angle(airy(0.0, wall, band)[0][1] * np.exp(2j * np.pi * band / ep.speed_of_light * wall.thickness)))
    delay = -(phase[-1] - phase[0]) / 2e9 * ep.speed_of_light / (2 * np.pi)
    assert behind - free == pytest.approx(2.0 * delay, abs=1e-4)


def peak_of(beat, chirps, zero_pad=64):
    """Range in m of the strongest place of a beat signal."""
    profile = np.abs(np.fft.fft(beat * np.hanning(beat.size), beat.size * zero_pad))[:beat.size * zero_pad // 2]
    return profile.argmax() / zero_pad * ep.speed_of_light / (2 * chirps.bandwidth)


def test_the_delay_of_a_pane_is_seen_in_the_range():
    free, behind = echo_of_ball(make_scene(None), make_radar()), echo_of_ball(make_scene(), make_radar())
    band = np.linspace(FREQUENCY, FREQUENCY + CHIRPS.bandwidth, 50)
    phase = np.unwrap(np.angle(airy(0.0, frequency=band)[0][1] * np.exp(2j * np.pi * band / ep.speed_of_light * THICKNESS)))
    delay = -(phase[-1] - phase[0]) / CHIRPS.bandwidth * ep.speed_of_light / (2 * np.pi)
    nearest = [np.min(paths.lengths([paths.frame.trace_time])) for paths in (free, behind)]
    assert nearest[1] - nearest[0] == pytest.approx(2.0 * delay, abs=1e-4)


# --- replay ---

@pytest.mark.parametrize("model", ["scalar", "jones"])
@pytest.mark.parametrize("polarization", [UPRIGHT, SLANTED])
def test_moving_panes_and_balls_replay_as_traced_anew(model, polarization):
    turning = ep.LinearMotion(angular_velocity=(0, 0, 20.0))
    scene = make_scene(yaw=0.5, motion=turning, ball_motion=ep.LinearMotion(velocity=(-5, 1, 0)))
    paths = echo_of_ball(scene, make_radar(polarization=polarization), polarization=model)
    least = 1.0
    for time in (0.0, 0.005, 0.015):
        anew = echo_of_ball(scene, make_radar(INSTANT, polarization), polarization=model, start_time=time)
        assert abs(field(paths, time) / field(anew, time) - 1) < (SAME_RAYS if polarization == UPRIGHT else 0.03), time
        least = min(least, abs(field(anew, time) / field(paths)))
    assert least < 0.99  # that it moves at all shows


def test_frames_of_moving_panes_follow_each_sample():
    scene = make_scene(yaw=0.5, motion=ep.LinearMotion(angular_velocity=(0, 0, 20.0)))
    paths = echo_of_ball(scene, make_radar(), num_rays=500)
    cube, exact = (ep.synthesize(paths, make_radar(), evaluate=how) for how in ("interpolated", "samples"))
    assert np.max(np.abs(cube - exact)) < SAME_RAYS * np.max(np.abs(exact))


def test_a_pane_that_moves_before_what_stands_is_not_still():
    scene = make_scene(yaw=0.5, motion=ep.LinearMotion(angular_velocity=(0, 0, 20.0)))
    paths = echo_of_ball(scene, make_radar(), num_rays=500)
    cube = ep.synthesize(paths, make_radar())[0, 0]
    assert np.max(np.abs(cube[0] - cube[-1])) > 0.01 * np.max(np.abs(cube[0]))


# --- what panes send back ---

def test_a_pane_mirrors_the_radar_by_its_reflection():
    scene = ep.Scene()
    scene.add(square(), name="pane", material="metal", position=(3, 0, 1))
    metal = power_db(ep.trace(scene, make_radar(), num_rays=4000).select("T 'pane' R"))
    scene["pane"].material = GLASS
    glass = power_db(ep.trace(scene, make_radar(), num_rays=4000).select("T 'pane' R"))
    assert glass - metal == pytest.approx(20.0 * np.log10(abs(airy(0.0)[0][0])), abs=LEVEL)


def test_a_pane_aside_makes_ghosts_by_its_reflection():
    levels = []
    for material in (ep.Material.metal(), GLASS):
        scene = make_scene(None)
        corners = np.array([[-2, 2, -3], [12, 2, -3], [12, 2, 4], [-2, 2, 4.0]])
        scene.add(ep.Mesh(corners, [[0, 1, 2], [0, 2, 3]]), name="pane", material=material)
        paths = ep.trace(scene, make_radar(), num_rays=30000, max_bounces=2)
        levels.append(power_db(paths.select("T ('ball' 'pane' | 'pane' 'ball') R")))
    expected = 20.0 * np.log10(abs(airy(np.arctan2(8, 4))[0][0]))
    assert levels[1] - levels[0] == pytest.approx(expected, abs=LEVEL)


def test_layers_reflect_from_the_side_that_is_met():
    stack = [ep.Layer(0.001, 9.0 - 2.0j), ep.Layer(0.01, 2.0 - 0.5j)]
    levels = []
    for yaw in (0.0, np.pi):  # normals along x, away from the radar, and toward it
        scene = ep.Scene()
        scene.add(square(), name="pane", material=ep.Material(layers=stack), position=(3, 0, 1), yaw=yaw)
        levels.append(power_db(ep.trace(scene, make_radar(), num_rays=4000).select("T 'pane' R")))
    shares = [abs(ep.sheet_coefficients(ep.Material(layers=stack), frequency=FREQUENCY, incidence=0.0,
                                        from_behind=behind).te_reflection[0]) ** 2 for behind in (True, False)]
    assert levels[0] - levels[1] == pytest.approx(10.0 * np.log10(shares[0] / shares[1]), abs=LEVEL)
    assert abs(levels[0] - levels[1]) > 1.0


def test_legs_over_mirrors_pass_as_images_do():
    def levels(pane):
        scene = make_scene(pane)
        corners = np.array([[-2, 2, -3], [12, 2, -3], [12, 2, 4], [-2, 2, 4.0]])
        scene.add(ep.Mesh(corners, [[0, 1, 2], [0, 2, 3]]), name="wall", material=ep.Material.metal(mirror=True))
        paths = ep.trace(scene, make_radar(), num_rays=30000, max_bounces=3, polarization="scalar")
        return [power_db(paths.select(text)) for text in
                ("T ('ball' 'wall' | 'wall' 'ball') R", "T 'wall' 'ball' 'wall' R")]
    straight, slanted = (20.0 * np.log10(abs(over_free(angle)[0])) for angle in (0.0, np.arctan2(4, 8)))
    changes = np.subtract(levels(GLASS), levels(None))
    assert changes == pytest.approx([straight + slanted, 2.0 * slanted], abs=LEVEL)


def test_panes_behind_panes_both_reflect_and_pass():
    scene = make_scene(at=3.0)
    scene.add(square(), name="second", material=GLASS, position=(5, 0, 1))
    paths = ep.trace(scene, make_radar(), num_rays=20000)
    free = echo_of_ball(make_scene(None), make_radar())
    twice = paths.select("T P'pane' P'second' 'ball' P'second' P'pane' R")
    assert power_db(twice) - power_db(free) == pytest.approx(80.0 * np.log10(abs(over_free(0.0)[0])), abs=LEVEL)
    assert paths.select("T P'pane' 'second' P'pane' R").num_paths > 0
    assert paths.select("T 'pane' R").num_paths > 0


@pytest.mark.filterwarnings("ignore::echopath.TessellationWarning")
@pytest.mark.parametrize("smooth", [False, True])
def test_rays_meet_each_facet_of_a_sheet_once_however_they_graze(smooth):
    """A straight line passes a convex body twice at most, and meets no facet of it again: where it grazes one, single precision
    has the hit some micrometres farther off than it is."""
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.4, edge=0.03), name="bulb", material="glass_pane", position=(3, 1.3, 0.2), smooth=smooth)
    paths = ep.trace(scene, make_radar(), num_rays=50_000, max_bounces=2)
    first = paths.hits[paths.offsets[paths.num_bounces == 1]]
    assert len(np.unique(first)) == len(first) > 90_000
    assert np.diff(paths.pass_offsets).max() <= 2 * 3
    assert paths.frame.statistics.num_stopped_passes == 0
    assert np.all(np.isfinite(paths.amplitude))


def test_coefficients_of_sheets_travel_and_compare():
    one, other = (ep.sheet_coefficients(ep.materials["glass_pane"], frequency=frequency, incidence=[0.0, 0.3])
                  for frequency in (77e9, 78e9))
    assert pickle.loads(pickle.dumps(one)) == one == copy.deepcopy(one) != other


def test_coefficients_keep_their_angles():
    angles = np.array([0.0, 0.3])
    found = ep.sheet_coefficients(ep.materials["glass_pane"], frequency=77e9, incidence=angles)
    angles[:] = 1.0
    assert found.incidence.tolist() == [0.0, 0.3]


@pytest.mark.parametrize("bandwidth", [0.0, 2e9])
def test_the_delay_of_a_sheet_is_the_mean_over_the_band(bandwidth):
    """By the phase of Airy's formula, unwrapped in steps."""
    wall, start, incidence = ep.Layer(0.2, 3.91 - 0.05j), 3e9, 0.5
    found = ep.sheet_coefficients(ep.Material(layers=[wall]), frequency=start, incidence=incidence, bandwidth=bandwidth)
    width = bandwidth or 1e4
    band = np.linspace(start, start + width, 400)
    free = np.exp(2j * np.pi * band / ep.speed_of_light * wall.thickness * np.cos(incidence))
    for delay, (_, passed) in zip((found.te_delay[0], found.tm_delay[0]), airy(incidence, wall, band)):
        phase = np.unwrap(np.angle(passed * free))
        assert delay == pytest.approx((phase[0] - phase[-1]) * ep.speed_of_light / (2 * np.pi * width), abs=1e-5)
    with pytest.raises(ValueError, match="bandwidth"):
        ep.sheet_coefficients(ep.Material(layers=[wall]), frequency=start, incidence=0.0, bandwidth=-1.0)
