"""Records renewed at other times of a frame, against what closed forms and fresh traces say."""
import numpy as np
import pytest

import echopath as ep
from support.radars import FREQUENCY, build_radar, chirp_times

WAVE_NUMBER = 2 * np.pi * FREQUENCY / ep.speed_of_light
ROUGH = ep.Material(reflectivity=0.5, scattering=1.0)
ON_FERMAT = 1e-3       # rad: the least that a renewal mends
SAME_POWER = 1e-9      # relative: sums in another order
ADDITIVITY = 1e-12     # of the whole
MONOTONE = 1e-3        # of the power before: speckle within a stretch may rise a little


def radar_of(num_chirps=64, chirp_interval=100e-6, num_samples=64):
    return build_radar(bandwidth=0.3e9, num_chirps=num_chirps, chirp_interval=chirp_interval, num_samples=num_samples)


def facing(half_width, half_height):
    """A plate across the x axis."""
    y, z = half_width, half_height
    return ep.Mesh([[0, -y, -z], [0, y, -z], [0, y, z], [0, -y, z]], [[0, 1, 2], [0, 2, 3]])


def hidden_target():
    """A small target at 20 m; a shutter at 10 m whose edge crosses the line of sight when t = 3.2 ms."""
    scene = ep.Scene()
    scene.add(facing(0.05, 0.05), name="target", material=ROUGH, position=(20, 0, 0))
    edge = 2.0 - 0.05 / 2  # the target's near side, seen from the radar
    scene.add(facing(2.0, 1.0), name="shutter", material=ep.Material(reflectivity=1e-6, scattering=1.0),
              position=(10, -edge - 100 * 3.2e-3, 0), motion=ep.LinearMotion(velocity=(0, 100, 0)))
    return scene


def power_of_chirps(cube):
    return (np.abs(cube[0, 0]) ** 2).sum(axis=1)


def test_what_comes_in_the_way_takes_its_echoes_out():
    radar = radar_of(num_chirps=64)
    scene = hidden_target()
    paths = ep.trace(scene, radar, num_rays=4000, max_bounces=1)
    target = paths.select("T 'target' R")
    assert target.num_paths > 100
    never = power_of_chirps(ep.synthesize(target, radar))
    renewed = power_of_chirps(ep.synthesize(target, radar, retrace="invalid", keyframes=16))
    # The shutter needs 0.5 ms over the target, whose shadow is half as wide at 10 m: 5 chirps, in stretches of 4.
    edge = 32
    assert np.allclose(renewed[:edge - 4], never[:edge - 4], rtol=SAME_POWER) and never.min() > 0
    assert np.all(renewed[edge + 12:] == 0)
    between = renewed[edge - 4:edge + 12].reshape(4, 4).mean(axis=1)
    assert np.all(np.diff(between) <= MONOTONE * never.max())


@pytest.mark.hard
def test_stretches_of_staggered_chirps_begin_at_their_slots():
    """What comes closer, and which nothing hides, has the phase of the times at which the chirps are: 2.8 rad a slot."""
    scene = ep.Scene()
    scene.add(facing(0.05, 0.05), name="target", material=ROUGH, position=(20, 0, 0), speed=-30.0)
    waveform = radar_of(num_chirps=23).waveform.replace(extra_idle=(0.0, 7e-5, 2e-5, 4e-5, 1e-5))
    radar = radar_of().replace(waveform=waveform, transmitters=[ep.Antenna(), ep.Antenna((0, 0.004, 0))])
    paths = ep.trace(scene, radar, num_rays=500, max_bounces=1)
    never = ep.synthesize(paths, radar, evaluate="chirps")
    for keyframes in (1, 4, 23):
        renewed = ep.synthesize(paths, radar, evaluate="chirps", retrace="invalid", keyframes=keyframes)
        assert np.abs(renewed - never).max() < 1e-5 * np.abs(never).max()


def test_a_scene_at_rest_keeps_its_bits():
    radar = radar_of(num_chirps=12)
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.3), name="ball", material=ROUGH, position=(12, 0.5, 1))
    paths = ep.trace(scene, radar, num_rays=3000)
    renewed = ep.renew(paths, time=radar.waveform.chirp_interval).paths
    assert renewed.num_paths == paths.num_paths and np.array_equal(renewed.hits, paths.hits)
    assert np.array_equal(ep.synthesize(paths, radar, retrace="invalid", keyframes=3), ep.synthesize(paths, radar))


def sliding_scene(wall_end=60.0):
    """A rough target that moves past a metal wall at y = 3: the wall's bounce slides, being no flagged mirror."""
    scene = ep.Scene()
    wall = ep.Mesh([[-20, 3, -10], [wall_end, 3, -10], [wall_end, 3, 12], [-20, 3, 12]], [[0, 1, 2], [0, 2, 3]])
    scene.add(wall, name="wall", material=ep.Material.metal())
    scene.add(facing(0.5, 2.0), name="target", material=ROUGH, position=(19.5, 0, 0),
              motion=ep.LinearMotion(velocity=(60, 0, 0)))
    return scene


def ghosts_of(scene, radar):
    paths = ep.trace(scene, radar, num_rays=400000, max_bounces=2).select("T 'wall' 'target' R")
    assert paths.num_paths > 15
    return paths


def test_points_of_reflection_are_found_anew():
    """Target at 60 m/s, wall 3 m aside: frozen bounces err by more than a radian after 10 ms, renewed ones do not."""
    radar = radar_of(num_chirps=256, chirp_interval=80e-6)
    paths = ghosts_of(sliding_scene(), radar)
    end = chirp_times(radar)[-1]

    def error(record):
        """rad, of the longest frozen way at the end of the frame; truth by the image of the radar in the wall."""
        target = record.points(end)[record.offsets + 1]
        exact = np.linalg.norm(target - [0, 6, 0], axis=1) + np.linalg.norm(target, axis=1)
        return WAVE_NUMBER * np.abs(record.lengths([end])[0] - exact).max()

    assert error(paths) > 0.5
    renewed = ep.renew(paths, time=end)
    assert renewed.paths.num_paths == paths.num_paths == renewed.num_moved
    assert error(renewed.paths) < ON_FERMAT
    # The target's own hits, weights and phases are those of the trace.
    assert np.array_equal(renewed.paths.hits[renewed.paths.offsets + 1], paths.hits[paths.offsets + 1])
    assert np.array_equal(renewed.paths.weight, paths.weight)


def test_reflections_that_leave_their_surface_are_lost():
    """The wall ends where half of the bounces stand at the end of the frame: the others find no wall."""
    radar, wall_end = radar_of(num_chirps=256, chirp_interval=80e-6), 10.7
    paths = ghosts_of(sliding_scene(wall_end), radar)
    end = chirp_times(radar)[-1]
    target = paths.points(end)[paths.offsets + 1]
    bounce = target[:, 0] * 3.0 / (6.0 - target[:, 1])
    on_wall = bounce < wall_end
    assert 0 < on_wall.sum() < paths.num_paths
    renewed = ep.renew(paths, time=end)
    assert renewed.num_lost == np.count_nonzero(~on_wall)
    assert np.array_equal(renewed.paths.weight, paths.weight[on_wall])


def shortest_over(axes, first, second, towards):
    """[P] m, of the ways from points over an ellipsoid about the origin to points [P, 3]: by search near `towards` [P, 3]."""
    def length(directions):
        points = axes * directions / np.linalg.norm(directions, axis=-1, keepdims=True)
        return np.linalg.norm(points - first, axis=-1) + np.linalg.norm(second - points, axis=-1)
    best, step = towards / axes, 0.05
    moves = np.array([[x, y, z] for x in (-1, 0, 1) for y in (-1, 0, 1) for z in (-1, 0, 1)], float)
    for _ in range(60):
        tried = best + step * moves[:, None]
        choice = np.argmin([length(directions) for directions in tried], axis=0)
        best, step = tried[choice, np.arange(len(best))], step * np.where(np.any(choice != 13), 0.8, 0.6)
    return length(best)


def test_reflections_slide_over_smooth_bodies_whose_facets_are_coarse():
    """On an ellipsoid that flies over a metal floor each point of the floor finds its shortest way, none is lost."""
    axes, start, velocity, time = np.array([0.3, 0.2, 0.35]), np.array([6.0, -2.0, 0.0]), np.array([-60.0, -40.0, 6.0]), 3e-3
    scene = ep.Scene()
    scene.add(ep.actors.ellipsoid(axes, edge=0.04), name="body", material="metal", smooth=True, position=start,
              motion=ep.LinearMotion(velocity=velocity))
    scene.add(ep.actors.ground((40, 40)), name="floor", material="metal", position=(0, 0, -1.2))
    radar = radar_of(num_chirps=4, chirp_interval=1e-3)
    paths = ep.trace(scene, radar, num_rays=3000, max_bounces=2).select("T 'floor' 'body' R")
    renewed = ep.renew(paths, time=time)
    assert paths.num_paths > 500 and renewed.num_moved > 0.9 * paths.num_paths and renewed.num_lost == 0
    floor, body = (renewed.paths.points(time)[renewed.paths.offsets + k] - start - time * velocity for k in (0, 1))
    antenna = -start - time * velocity
    wanted = np.linalg.norm(floor - antenna, axis=1) + shortest_over(axes, floor, np.broadcast_to(antenna, floor.shape), body)
    frozen, slid = (WAVE_NUMBER * np.abs(record.lengths([time], 0, 0)[0] - wanted).max() for record in (paths, renewed.paths))
    assert frozen > 1.2 and slid < 0.3  # rad, of which 0.26 are those of the mesh


def test_always_traces_each_stretch_anew():
    radar, scene = radar_of(num_chirps=8), hidden_target()
    paths = ep.trace(scene, radar, num_rays=2000, seed=3)
    whole = ep.synthesize(paths, radar, retrace="always", keyframes=2)
    half = radar_of(num_chirps=4)
    for i in range(2):
        again = ep.trace(scene, half, num_rays=paths.frame.statistics.num_rays, seed=3, start_time=i * 4 * 100e-6)
        assert np.array_equal(whole[:, :, 4 * i:4 * i + 4], ep.synthesize(again, half))


def test_a_new_trace_of_the_whole_frame_leaves_the_same_faint_paths_out():
    radar, scene = radar_of(num_chirps=4), hidden_target()
    everything = ep.trace(scene, radar, num_rays=4000, seed=3)
    faint_power = 16 * np.median(np.abs(everything.amplitude) ** 2)
    paths = ep.trace(scene, radar, num_rays=4000, seed=3, faint_power=faint_power)
    assert everything.num_paths > paths.num_paths > 100 and paths.frame.statistics.num_faint_paths > 0
    assert np.array_equal(ep.synthesize(paths, radar, retrace="always", keyframes=1), ep.synthesize(paths, radar))


def test_a_frame_has_no_more_stretches_than_chirps():
    """Bounces that slide for 80 ms want more keyframes than two; each chirp is renewed by itself where that is fewer."""
    radar = radar_of(num_chirps=2, chirp_interval=40e-3)
    paths = ghosts_of(sliding_scene(), radar)
    assert ep.validity(paths, radar).keyframes > 2
    found = ep.synthesize(paths, radar, retrace="invalid")
    assert np.array_equal(found, ep.synthesize(paths, radar, retrace="invalid", keyframes=2))


def test_parts_of_renewed_frames_add_up():
    radar = radar_of(num_chirps=32)
    paths = ep.trace(hidden_target(), radar, num_rays=3000)
    settings = {"retrace": "invalid", "keyframes": 4, "method": "nufft"}
    parts = ep.decompose(paths, radar, {"target": "T 'target' R"}, **settings)
    whole = ep.synthesize(paths, radar, **settings)
    assert np.abs(sum(parts.values()) - whole).max() < ADDITIVITY * np.abs(whole).max()


@pytest.mark.hard
def test_bits_do_not_depend_on_threads():
    radar = radar_of(num_chirps=16)
    paths = ep.trace(sliding_scene(), radar, num_rays=20000, max_bounces=2)
    cubes = []
    for threads in (1, 3):
        ep.set_num_threads(threads)
        cubes.append(ep.synthesize(paths, radar, retrace="invalid", keyframes=2))
    ep.set_num_threads(0)
    assert np.array_equal(*cubes)


def test_a_new_trace_refuses_selections():
    radar = radar_of(num_chirps=4)
    paths = ep.trace(hidden_target(), radar, num_rays=2000)
    with pytest.raises(ValueError, match="retrace: 'always' takes all paths of a trace"):
        ep.synthesize(paths.select("T 'target' R"), radar, retrace="always", keyframes=2)


@pytest.mark.parametrize("keywords, text", [
    ({"retrace": "sometimes"}, "retrace: must be"),
    ({"retrace": "invalid", "keyframes": 17}, "keyframes: must lie in"),
    ({"retrace": "invalid", "keyframes": -1}, "keyframes: must be a whole number from 0 to 2147483647, got -1"),
])
def test_bad_settings_are_named(keywords, text):
    radar = radar_of(num_chirps=16)
    with pytest.raises(ValueError, match=text):
        ep.synthesize(ep.trace(ep.Scene(), radar, num_rays=10), radar, **keywords)


def test_traces_of_a_scene_have_the_bits_of_first_traces():
    """The geometry that a scene keeps from its second trace on answers as one made for the time."""
    radar, scene = radar_of(num_chirps=2), hidden_target()
    for turn in range(4):
        again, first = (ep.trace(of, radar, num_rays=2000, start_time=2e-3 * turn) for of in (scene, hidden_target()))
        assert first.num_paths > 500
        for name in ("offsets", "mesh_id", "triangle_id", "u", "v", "weight"):
            assert np.array_equal(getattr(again, name), getattr(first, name)), (turn, name)


def test_scenes_that_are_traced_once_keep_nothing():
    scene = hidden_target()
    for is_kept in (False, True):
        ep.trace(scene, radar_of(num_chirps=2), num_rays=100)
        assert ("_geometry" in vars(scene)) == is_kept


def test_a_trace_whose_planes_image_themselves_is_no_selection():
    """The paths that images replace are gone from its record, and from what the record counts."""
    scene, radar = ep.Scene(), radar_of(num_chirps=4)
    scene.add(facing(0.5, 0.5), name="plate", position=(5, 0, 0), material=ROUGH.replace(scattering=0.5),
              motion=ep.LinearMotion(velocity=(1, 0, 0)))
    paths = ep.trace(scene, radar, num_rays=500)
    assert paths.num_paths == paths.frame.statistics.num_paths > 0
    again = ep.synthesize(paths, radar, retrace="always", keyframes=2)
    assert np.sum(np.abs(again) ** 2) == pytest.approx(np.sum(np.abs(ep.synthesize(paths, radar)) ** 2), rel=0.1)


def water_behind_a_blade(crossing):
    """Water at 5 m, and a blade 2 m before it that hides the point of reflection at a time (s) of the frame."""
    scene = ep.Scene()
    scene.add(facing(2, 2), name="water", material=ep.Material(reflectivity=0.8), position=(5, 0, 0))
    scene.add(facing(0.02, 1), name="blade", material=ep.Material(reflectivity=1e-6, scattering=1.0),
              position=(3, -120 * crossing, 0), motion=ep.LinearMotion(velocity=(0, 120, 0)))
    return scene


@pytest.mark.parametrize("crossing, hidden", [(0.8e-3, slice(7, 9)), (1.35e-3, slice(13, 14))], ids=["at mid-frame", "late"])
def test_images_and_rays_over_a_plane_stand_in_for_each_other(crossing, hidden):
    """Rays meet the water beside the blade, where it hides the point of reflection; elsewhere the image is whole."""
    radar, scene = radar_of(num_chirps=16, num_samples=16), water_behind_a_blade(crossing)
    paths = ep.trace(scene, radar, num_rays=20_000)
    renewed = power_of_chirps(ep.synthesize(paths, radar, retrace="invalid", keyframes=16))
    always = power_of_chirps(ep.synthesize(paths, radar, retrace="always", keyframes=16))
    scene.remove("blade")
    whole = power_of_chirps(ep.synthesize(ep.trace(scene, radar, num_rays=100), radar))
    away = np.abs(np.arange(16) - hidden.start) > 5
    assert np.allclose(renewed[away], whole[away], rtol=1e-3)
    assert np.all(always[hidden] < 0.9 * whole[hidden])
    assert np.allclose(renewed[hidden], always[hidden], rtol=0.3)  # to 1 dB: both have few rays in the gaps


def share_of_endless(beside):
    """The field of a plate of 0.6 m at 5 m, whose middle is so many m beside the radar, over that of an endless plane: physical
    optics, summed up."""
    y, z = (0.6 * ((np.arange(n) + 0.5) / n - 0.5) for n in (600, 400))
    r = np.sqrt(5.0**2 + (beside + y[:, None]) ** 2 + z**2)
    return abs(np.sum(np.exp(-2j * WAVE_NUMBER * r) * 5.0 / r**3)) * 0.6**2 / r.size * WAVE_NUMBER * 5.0 / np.pi


def test_an_echo_whose_point_of_reflection_leaves_its_plate_fades_as_physical_optics_says():
    """It is at the rim in the fourth of eight chirps, and before that rays have what is left of the echo."""
    radar, whole = radar_of(num_chirps=8, num_samples=16), ep.Scene()
    whole.add(facing(2, 2), name="plane", material=ep.Material.metal(), position=(5, 0, 0))
    endless = power_of_chirps(ep.synthesize(ep.trace(whole, radar, num_rays=100), radar))
    scene, speed, first = ep.Scene(), 400.0, -0.42
    scene.add(facing(0.3, 0.3), name="plate", material=ep.Material.metal(), position=(5, first, 0),
              motion=ep.LinearMotion(velocity=(0, speed, 0)))
    paths = ep.trace(scene, radar, num_rays=10_000)
    assert paths.num_paths == 1     # the image
    renewed = power_of_chirps(ep.synthesize(paths, radar, retrace="invalid", keyframes=8))
    expected = [share_of_endless(first + speed * time) for time in chirp_times(radar)]
    assert np.allclose(np.sqrt(renewed / endless), expected, rtol=0, atol=0.02)     # the least is 0.13
