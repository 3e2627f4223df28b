"""Sheets: materials of layers that waves pass, against Airy's formula and against closed forms of whole scenes."""
import pickle

import numpy as np
import pytest

import echopath as ep

FREQUENCY = 77e9
WAVENUMBER = 2.0 * np.pi * FREQUENCY / ep.speed_of_light
GLASS = ep.Material(layers=[ep.Layer(0.004, 6.3 - 0.3j)])
THICKNESS = 0.004
CHIRPS = ep.ChirpSequence(start_frequency=FREQUENCY, bandwidth=1e9, num_samples=128, sampling_rate=20e6, num_chirps=16,
                          chirp_interval=1e-3)
INSTANT = ep.ChirpSequence(start_frequency=FREQUENCY, bandwidth=1e9, num_samples=128, sampling_rate=20e6, num_chirps=1,
                           chirp_interval=1e-5)
FORMULA = 1e-9
LEVEL = 0.2    # dB
RAYS = 0.01    # of the field: a few thousand rays on a ball
PHASE = 0.02   # rad: likewise, and angles that differ over a ball
SAME_RAYS = 1e-3
UPRIGHT, LEVEL_E, SLANTED = (0, 0, 1), (0, 1, 0), tuple(np.array([0, 1, 1]) / np.sqrt(2.0))


def airy(angle, layer=GLASS.layers[0], frequency=FREQUENCY):
    """((r, t) of TE, (r, t) of TM) of one slab: geometric series over the bounces within (Airy 1833)."""
    cosine, k = np.cos(angle), 2.0 * np.pi * frequency / ep.speed_of_light
    inside = np.sqrt(layer.permittivity - np.sin(angle) ** 2)
    through = np.exp(-1j * k * layer.thickness * inside)
    both = []
    for face in ((cosine - inside) / (cosine + inside),
                 (layer.permittivity * cosine - inside) / (layer.permittivity * cosine + inside)):
        both.append((face * (1 - through**2) / (1 - face**2 * through**2), (1 - face**2) * through / (1 - face**2 * through**2)))
    return both


def over_free(angle):
    """(TE, TM) field behind the pane over that without it."""
    free = np.exp(1j * WAVENUMBER * THICKNESS * np.cos(angle))
    return tuple(passed * free for _, passed in airy(angle))


def make_radar(chirps=CHIRPS, polarization=UPRIGHT, num=1, motion=None):
    antennas = [[ep.Antenna((0, 0.1 * i + y, 1), polarization=polarization) for i in range(num)] for y in (0.0, 0.01)]
    return ep.Radar(chirps, transmitters=antennas[0], receivers=antennas[1], transmit_power=0.1, motion=motion)


def square(half=3.0):
    corners = half * np.array([[0, -1, -1], [0, 1, -1], [0, 1, 1], [0, -1, 1.0]])
    return ep.Mesh(corners, [[0, 1, 2], [0, 2, 3]])


def make_scene(pane=GLASS, yaw=0.0, motion=None, ball_motion=None, at=3.0):
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.1), name="ball", material="metal", position=(8, 0, 1), smooth=True, motion=ball_motion)
    if pane is not None:
        scene.add(square(), name="pane", material=pane, position=(at, 0, 1), yaw=yaw, motion=motion)
    return scene


def echo_of_ball(scene, radar, num_rays=4000, **settings):
    return ep.trace(scene, radar, num_rays=num_rays, max_bounces=1, **settings).select("T 'ball' R")


def field(paths, time=None, tx=0, rx=0):
    time = paths.frame.trace_time if time is None else time
    return np.sum(paths.amplitudes([time], tx, rx)[0] * np.exp(-1j * WAVENUMBER * paths.lengths([time], tx, rx)[0]))


def power_db(paths):
    return 10.0 * np.log10(ep.received_power(paths).power)


# --- coefficients ---

def test_a_slab_is_that_of_airy_at_all_angles():
    angles = np.linspace(0.0, np.pi / 2, 901)[:-1]
    found = ep.sheet_coefficients(GLASS, frequency=FREQUENCY, incidence=angles)
    (r_te, t_te), (r_tm, t_tm) = airy(angles)
    for one, other in ((found.te_reflection, r_te), (found.tm_reflection, r_tm), (found.te_transmission, t_te),
                       (found.tm_transmission, t_tm)):
        assert np.max(np.abs(one - other)) < FORMULA


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


def test_the_delay_of_a_pane_is_seen_in_the_range():
    free, behind = echo_of_ball(make_scene(None), make_radar()), echo_of_ball(make_scene(), make_radar())
    step = 1e6
    phase = np.unwrap([np.angle(airy(0.0, frequency=f)[0][1] * np.exp(2j * np.pi * f / ep.speed_of_light * THICKNESS))
                       for f in (FREQUENCY - step, FREQUENCY + step)])
    delay = -(phase[1] - phase[0]) / (2 * step) * ep.speed_of_light / (2 * np.pi)
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
        paths = ep.trace(scene, make_radar(), num_rays=60000, max_bounces=2)
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
        paths = ep.trace(scene, make_radar(), num_rays=60000, max_bounces=3, polarization="scalar")
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


# --- expressions, tables, files ---

def test_expressions_see_passes_only_where_they_name_them():
    paths = ep.trace(make_scene(), make_radar(), num_rays=4000, max_bounces=2)
    everything = paths.select("T 'ball' R")
    assert everything.num_paths > 0
    for text in ("T P'pane' 'ball' P'pane' R", "T P . P R", "T 'pane' 'ball' P R", "T P S P R & T 'ball' R"):
        assert paths.select(text).num_paths == everything.num_paths, text
    assert paths.select("T P'ball' .* R").num_paths == 0
    assert paths.select("T S'ball' R & T P . P R").num_paths == everything.num_paths
    assert (everything.num_bounces == 1).all() and paths.select(ep.passes("pane") & ep.hits("ball")).num_paths > 0
    parts = paths.partition({"seen": "T P'pane' 'ball' P'pane' R"})
    assert parts["seen"].num_paths + parts["other"].num_paths == paths.num_paths


def test_passes_lie_on_the_legs_and_on_the_pane():
    paths = echo_of_ball(make_scene(), make_radar(), num_rays=500)
    assert len(paths.pass_offsets) == paths.num_paths + 1 and paths.pass_offsets[-1] == len(paths.passes)
    assert np.array_equal(paths.passes["leg"], np.tile([0, 1], paths.num_paths))
    corners = paths.scene.world_vertices(1, paths.frame.trace_time)[paths.scene.meshes[1].triangles[paths.passes["triangle_id"]]]
    u, v = paths.passes["u"][:, None], paths.passes["v"][:, None]
    met = (1 - u - v) * corners[:, 0] + u * corners[:, 1] + v * corners[:, 2]
    ball = np.repeat(paths.points(paths.frame.trace_time)[paths.offsets], 2, axis=0)
    antenna = np.tile([paths.frame.transmitter, paths.frame.receiver], (paths.num_paths, 1))
    across = np.cross(met - antenna, ball - antenna) / np.linalg.norm(ball - antenna, axis=1, keepdims=True)
    assert np.max(np.linalg.norm(across, axis=1)) < 1e-3


def test_records_with_passes_travel(tmp_path):
    paths = ep.trace(make_scene(yaw=0.4), make_radar(), num_rays=2000)
    paths.save(tmp_path / "frame.h5")
    for other in (ep.Paths.load(tmp_path / "frame.h5"), pickle.loads(pickle.dumps(paths))):
        assert np.array_equal(other.passes, paths.passes) and np.array_equal(other.pass_offsets, paths.pass_offsets)
        assert np.array_equal(other.amplitude, paths.amplitude)
        assert other.scene.meshes[1].material == GLASS
    loud = paths.select(paths.power >= np.median(paths.power))
    assert loud.pass_offsets[-1] == len(loud.passes) < len(paths.passes)
    assert np.array_equal(loud.amplitude, paths.amplitude[paths.power >= np.median(paths.power)])
    assert set(paths.to_dataframe()["passes"]) >= {"pane > pane", ""}


def test_the_same_bits_for_any_number_of_threads():
    signals = []
    for count in (1, 2):
        before = ep.num_threads()
        ep.set_num_threads(count)
        try:
            signals.append(ep.synthesize(ep.trace(make_scene(yaw=0.4), make_radar(), num_rays=2000), make_radar()))
        finally:
            ep.set_num_threads(before)
    assert np.array_equal(signals[0], signals[1])


def test_scene_files_have_layers(tmp_path):
    (tmp_path / "scene.toml").write_text("""
[radar]
waveform = {start_frequency = 77e9, bandwidth = 1e9, num_samples = 64, sampling_rate = 2e7, num_chirps = 4, chirp_interval = 1e-4}
transmitters = [{position = [0, 0, 1]}]
receivers = [{position = [0, 0.01, 1]}]
[[objects]]
name = "pane"
actor = "plate"
parameters = {width = 2.0, height = 2.0}
position = [3, 0, 1]
material = {layers = [{thickness = 0.004, permittivity = [6.3, 0.3]}]}
""", encoding="utf-8")
    assert ep.load_scene(tmp_path / "scene.toml").scene.meshes[0].material == GLASS


# --- around it ---

def test_live_scenes_follow_a_pane():
    live = ep.Live(make_scene(), make_radar(), num_rays=3000)
    live.update()
    live.scene["pane"].yaw = 0.5
    view = live.update()
    fresh = ep.synthesize(ep.trace(make_scene(yaw=0.5), make_radar(), num_rays=3000), make_radar())
    assert np.max(np.abs(np.asarray(view.cube) - fresh)) < 1e-9 * np.max(np.abs(fresh))


def test_who_stands_behind_a_pane_is_visible_and_a_wall_hides_it():
    def share(material):
        return {seen.name: seen for seen in ep.visibility(make_scene(material), make_radar())}["ball"].visible_share
    assert share(GLASS) == pytest.approx(1.0) and share(ep.Material.metal()) == pytest.approx(0.0)


def test_one_trace_serves_a_frame_behind_a_pane_at_rest():
    scene = make_scene(ball_motion=ep.LinearMotion(velocity=(-1, 0, 0)))
    paths = ep.trace(scene, make_radar(), num_rays=4000)
    assert ep.validity(paths, make_radar()).shares.new_surface < 0.01


def test_effects_name_sheets_and_what_passes():
    effects = {effect.name: effect for effect in ep.trace(make_scene(), make_radar(), num_rays=2000).effects}
    effect = effects["transmission through sheets"]
    share = 20.0 * np.log10(abs(over_free(0.0)[0]))
    assert effect.modelled and "pane" in effect.reason and f"{share:.1f} dB" in effect.reason
