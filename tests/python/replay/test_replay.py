"""Replay, synthesis and decomposition of traced scenes against closed forms."""
import numpy as np
import pytest

import echopath as ep
from echopath.bench.crowd.scenes import rounded_car
from support.radars import FREQUENCY, build_radar, chirp_times

WAVE_NUMBER = 2 * np.pi * FREQUENCY / ep.speed_of_light
DELAY_PHASE_TOLERANCE = 2e-5   # rad: the phase tolerance of the replay, 1e-5 rad, on both ways
ADDITIVITY = 1e-12
INTERPOLATION_ERROR = 1e-4      # of amplitudes, the tolerance of the replay; phases are to 1e-5 rad
PLACE = 1e-3                   # m, deg: published with as many digits
PENDULUM = 0.01                # relative, of published figures
# m, m/s: from the middle of the nearest cells, of 0.15 m and 0.25 m/s, and a body's depth
RANGE_ERROR, SPEED_ERROR = 0.15, 0.1
SIGNAL_PHASE = 1e-5            # rad: the phase tolerance of the replay
ROUNDING = 1e-12               # m, of lengths of some metres


def make_radar(num_chirps=64, transmitters=((0, 0, 1),), receivers=((0, 0.01, 1),), **settings):
    return build_radar(transmitters, receivers, num_samples=512, num_chirps=num_chirps, **settings)


def small_triangle(size=0.01):
    return ep.Mesh([[0, -size, -size], [0, size, -size], [0, 0, size]], [[0, 1, 2]])


ROUGH = ep.Material(reflectivity=0.5, scattering=1.0)


def wall_mesh():
    return ep.Mesh([[-20, 3, -10], [60, 3, -10], [60, 3, 12], [-20, 3, 12]], [[0, 1, 2], [0, 2, 3]])


def mirror(**keywords):
    return ep.Material(permittivity=5 - 0.3j, mirror=True, **keywords)


def walking_scene():
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.3), name="ball", material=ROUGH, position=(12, 0.5, 1),
              motion=ep.LinearMotion(velocity=(-2, 0.3, 0)))
    scene.add(wall_mesh(), name="wall", material=mirror(scattering=0.3))
    return scene


def test_wall_ghosts_have_their_lengths():
    """Target 20 m away, wall 3 m aside: direct 20 m, one-way ghost 20.440307 m, two-way ghost 20.880613 m."""
    scene = ep.Scene()
    scene.add(small_triangle(1e-4), name="target", material=ROUGH, position=(20, 0, 0))
    scene.add(wall_mesh(), name="wall", material=mirror())
    radar = make_radar(num_chirps=1, transmitters=[(0, 0, 0)], receivers=[(0, 0, 0)])
    paths = ep.trace(scene, radar, num_rays=2000)
    ranges = paths.lengths([paths.frame.trace_time])[0] / 2
    names = [mesh.name for mesh in scene.meshes]
    found = {}
    for path in range(paths.num_paths):
        hits = paths.hits[paths.offsets[path]:paths.offsets[path] + paths.num_bounces[path]]
        found.setdefault(tuple(names[i] for i in hits["mesh_id"]), []).append(ranges[path])
    for sequence, expected in {("target",): 20.0, ("wall", "target"): 20.440307, ("target", "wall"): 20.440307,
                               ("wall", "target", "wall"): 20.880613}.items():
        assert np.abs(np.array(found[sequence]) - expected).max() < PLACE, sequence


def test_the_two_way_ghost_comes_from_its_image():
    """20 m away, wall 3 m aside: bearing atan(2 w / R) = 16.699 deg, wall hit at x = 10 m."""
    scene = ep.Scene()
    scene.add(small_triangle(1e-4), name="target", material=ROUGH, position=(20, 0, 0))
    scene.add(wall_mesh(), name="wall", material=mirror())
    radar = make_radar(num_chirps=1, transmitters=[(0, 0, 0)], receivers=[(0, 0, 0)])
    ghost = ep.trace(scene, radar, num_rays=2000).select("T 'wall' 'target' 'wall' R")
    time, step = ghost.frame.trace_time, 1e-3
    left, right = (ghost.lengths([time], receiver=(0, y, 0))[0] for y in (step, -step))
    bearing = np.degrees(np.arcsin((right - left) / (2 * step)))
    assert ghost.num_paths > 0 and np.abs(bearing - 16.699).max() < PLACE
    assert np.abs(ghost.points(time)[ghost.offsets][:, 0] - 10.0).max() < PLACE


def test_a_pendulum_swings_at_its_speed_and_period():
    """1 m, released at 30 deg: sqrt(2 g l (1 - cos)) = 1.62129 m/s, 838.25 Hz; period by elliptic integral, 2.0410 s."""
    gravity, step = 9.81, 5e-4
    angle, rate, angles = np.radians(30.0), 0.0, []
    for _ in range(5000):  # leapfrog
        angles.append(angle)
        rate -= 0.5 * step * gravity * np.sin(angle)
        angle += step * rate
        rate -= 0.5 * step * gravity * np.sin(angle)
    angles = np.array(angles[::20])
    keys = np.stack([np.sin(angles), 0 * angles, -np.cos(angles)], axis=1)
    motion = ep.KeyframeMotion(times=20 * step * np.arange(len(angles)), translations=keys)
    scene = ep.Scene()
    scene.add(small_triangle(1e-4), name="bob", material=ROUGH, motion=motion, position=(50, 0, 1))
    radar = make_radar(num_chirps=3, transmitters=[(0, 0, 0)], receivers=[(0, 0, 0)])
    path = ep.trace(scene, radar, num_rays=500, start_time=0.1).select("T 'bob' R")
    times = np.linspace(0.01, 2.4, 4000)
    speed = np.gradient(path.lengths(times)[:, 0] / 2, times)
    wavelength = ep.speed_of_light / radar.waveform.centre_frequency
    assert np.abs(speed).max() == pytest.approx(1.62129, rel=PENDULUM, abs=0)
    assert 2 * np.abs(speed).max() / wavelength == pytest.approx(838.25, rel=PENDULUM, abs=0)
    turns = times[:-1][np.diff(np.sign(speed)) != 0]  # at rest every half period
    assert 2 * np.diff(turns).mean() == pytest.approx(2.0410, rel=PENDULUM, abs=0)


def test_wall_ghosts_stand_in_the_map():
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.1), name="target", material=ROUGH, position=(20, 0, 0),
              motion=ep.LinearMotion(velocity=(-5, 0, 0)))
    scene.add(wall_mesh(), name="wall", material=ep.Material.metal(mirror=True))
    radar = make_radar(num_chirps=128, transmitters=[(0, 0, 0)], receivers=[(0, 0, 0)])
    paths = ep.trace(scene, radar, num_rays=20000)
    parts = ep.decompose(paths, radar, {"direct": "T 'target' R", "one way": "T ('target' 'wall' | 'wall' 'target') R",
                                        "two way": "T 'wall' 'target' 'wall' R"})
    waveform = radar.waveform
    # The peak of a receding target lies f_c v / slope farther (range-Doppler coupling).
    coupling = waveform.centre_frequency / waveform.slope
    for name, distance, speed in (("direct", 20.0, -5.0), ("one way", 20.4403, -4.8946), ("two way", 20.8806, -4.7891)):
        spectrum = ep.range_doppler(parts[name], radar, window="hann", zero_pad=4)
        row, column = np.unravel_index(np.abs(spectrum.values[0, 0]).argmax(), spectrum.values[0, 0].shape)
        # A 0.1 m ball is a speckled target: its peak lies within a cell of its near side.
        assert abs(spectrum.range[column] - (distance + coupling * speed)) < RANGE_ERROR, name
        assert abs(spectrum.velocity[row] - speed) < SPEED_ERROR, name


def test_rotating_scatterer_has_the_exact_phase():
    """A vertex sequence that rotates a small facet: the phase history is that of the point on the circle."""
    rate, radius = 2 * np.pi * 10, 0.3
    times = np.linspace(-0.002, 0.012, 141)
    facet = np.array([[0, -1e-4, -1e-4], [0, 1e-4, -1e-4], [0, 0, 1e-4]])
    centres = radius * np.stack([np.cos(rate * times), np.sin(rate * times), 0 * times], axis=1)
    scene = ep.Scene()
    scene.add(ep.Mesh(facet, [[0, 1, 2]]), name="tip", material=ROUGH, position=(10, 0, 1),
              motion=ep.VertexSequence(times=times, vertices=centres[:, None, :] + facet))
    radar = make_radar(num_chirps=128)
    paths = ep.trace(scene, radar, num_rays=400, max_bounces=1)
    assert paths.num_paths > 50
    at = chirp_times(radar)
    lengths = paths.lengths(at)
    u, v = paths.u[paths.offsets].astype(float), paths.v[paths.offsets].astype(float)
    on_facet = (1 - u - v)[:, None] * facet[0] + u[:, None] * facet[1] + v[:, None] * facet[2]
    circle = radius * np.stack([np.cos(rate * at), np.sin(rate * at), 0 * at], axis=1) + np.array([10, 0, 1])
    points = circle[:, None, :] + on_facet
    exact = np.linalg.norm(points - [0, 0, 1], axis=2) + np.linalg.norm(points - [0, 0.01, 1], axis=2)
    assert np.abs(WAVE_NUMBER * (lengths - exact)).max() < DELAY_PHASE_TOLERANCE

    # And so has the signal: the first sample's phase follows the delay.
    one = paths.select(np.arange(paths.num_paths) == 0)
    cube = ep.synthesize(one, radar, method="direct")[0, 0]
    delay = exact[:, 0] / ep.speed_of_light
    rate_of_delay = np.gradient(delay, at, edge_order=2)
    waveform = radar.waveform
    slope, middle = waveform.slope, 0.5 * (waveform.num_samples - 1) / waveform.sampling_rate
    beat = slope * delay + (FREQUENCY + slope * middle - slope * delay) * rate_of_delay
    phase = 2 * np.pi * (FREQUENCY * delay + slope * middle * delay - 0.5 * slope * delay**2 - beat * middle)
    expected = np.exp(1j * (phase - phase[0]))
    measured = cube[:, 0] / cube[0, 0]
    assert np.abs(np.angle(measured / np.abs(measured) / expected)).max() < SIGNAL_PHASE


def test_interpolated_replay_is_the_exact_one():
    radar = make_radar()
    paths = ep.trace(walking_scene(), radar, num_rays=3000)
    exact = ep.synthesize(paths, radar, evaluate="chirps", method="direct")
    error = np.linalg.norm(ep.synthesize(paths, radar, method="direct") - exact) / np.linalg.norm(exact)
    assert error < INTERPOLATION_ERROR


def test_amplitudes_follow_as_closely_as_phases_are_asked_for():
    """Of a smooth body, the facets of which turn their lobes past the radar: phases alone would leave 5e-7."""
    scene = ep.Scene()
    scene.add(rounded_car(), name="car", material=ep.Material.metal(), smooth=True, position=(6, 2, 0),
              motion=ep.LinearMotion(velocity=(-10, 0, 0)))
    radar = make_radar(num_chirps=128, chirp_interval=9e-5)
    paths = ep.trace(scene, radar, num_rays=500)
    exact = ep.synthesize(paths, radar, evaluate="chirps", method="direct")
    close = ep.synthesize(paths, radar, phase_tolerance=1e-7, method="direct")
    assert np.abs(close - exact).max() < 1e-8 * np.abs(exact).max()


def test_rough_and_smooth_bodies_that_cross_a_narrow_beam_together_have_the_echo_of_each_chirp():
    """No polynomial of few nodes follows the beam's edge: smooth bodies turn their phases beside, rough ones do not."""
    beam = ep.Antenna(pattern=ep.CosinePower(2000.0))
    radar = build_radar([beam], [ep.Antenna()], num_samples=32, num_chirps=32)
    scene, across = ep.Scene(), ep.LinearMotion(velocity=(0, 30, 0))
    scene.add(ep.actors.sphere(0.3), name="ball", material="metal", position=(0.9, -0.03, 0), smooth=True, motion=across)
    scene.add(ep.actors.plate(0.1, 0.1), name="rag", material=ep.Material(reflectivity=0.5, scattering=1.0),
              position=(0.5, -0.02, 0.05), motion=across)
    paths = ep.trace(scene, radar, num_rays=3000, max_bounces=1)
    assert all(paths.select(f"T '{name}' R").num_paths > 100 for name in ("ball", "rag"))
    found, expected = ep.synthesize(paths), ep.synthesize(paths, evaluate="chirps")
    assert np.abs(found - expected).max() < INTERPOLATION_ERROR * np.abs(expected).max()


def stopping_scene() -> tuple[ep.Scene, float]:
    """A car and a cloth that come to rest within 10 ms before a wall, and when, in s: within a frame of `make_radar`."""
    waveform = make_radar().waveform
    stop = 0.41 * waveform.num_chirps * waveform.chirp_interval
    times, ways = [stop - 1.0, stop - 0.01, stop, stop + 5.0, stop + 6.0], [-10.0, -0.1, 0.0, 0.0, 0.0]
    keys = {"times": times, "interpolation": "monotone"}
    scene = walking_scene()
    cloth = ep.actors.plate(0.5, 0.8, edge=0.2)
    vertices = np.array(cloth.vertices)
    moved = [vertices + 0.5 * way * (1.0 + 0.1 * vertices[:, 1:2]) * [1.0, 0.0, 0.0] for way in ways]
    scene.add(ep.actors.car(), name="stopping car", position=(9, -2, 0),
              motion=ep.KeyframeMotion(translations=[[way, 0, 0] for way in ways], **keys))
    scene.add(cloth, name="cloth", material=ROUGH, position=(6, 2, 1), motion=ep.VertexSequence(vertices=moved, **keys))
    return scene, stop


def test_what_stops_at_a_key_within_a_frame_is_replayed_as_chirp_by_chirp_and_rests_in_the_next_one():
    scene, stop = stopping_scene()
    radar = make_radar()
    paths = ep.trace(scene, radar, num_rays=4000)
    exact = ep.synthesize(paths, radar, evaluate="chirps", method="direct")
    found = ep.synthesize(paths, radar, method="direct")
    assert np.linalg.norm(found - exact) < INTERPOLATION_ERROR * np.linalg.norm(exact)
    for name in ("stopping car/*", "cloth"):
        own = paths.select(f"T '{name}' R")
        assert own.num_paths > 10
        before, at, after = (own.lengths(np.array([time]), 0, 0)[0] for time in (0.0, stop, 2.0 * stop))
        assert np.abs(before - at).max() > 1e-6 and np.abs(after - at).max() < 1e-12


def rotor_scene(rate, radius):
    """A small facet on a circle about (10, 0, 1), `rate` in rad/s."""
    size = 1e-4
    facet = ep.Mesh([[radius, -size, -size], [radius, size, -size], [radius, 0, size]], [[0, 1, 2]])
    scene = ep.Scene()
    scene.add(facet, name="tip", material=ROUGH, position=(10, 0, 1), motion=ep.LinearMotion(angular_velocity=(0, 0, rate)))
    return scene


@pytest.mark.hard
def test_fast_rotor_has_the_delay_of_every_sample():
    """Blade tip of 0.3 m at 800 rad/s: the signal of one path is the phase model at every sample, its delay that of the
    circle."""
    rate, radius = 800.0, 0.3
    radar = make_radar(num_chirps=16)
    paths = ep.trace(rotor_scene(rate, radius), radar, num_rays=200, max_bounces=1)
    one = paths.select(np.arange(paths.num_paths) == 0)
    local = one.points(0.0)[0] - [10, 0, 1]  # at rest: angle 0
    waveform = radar.waveform
    at = np.arange(waveform.num_samples) / waveform.sampling_rate + (np.arange(16) * waveform.chirp_interval)[:, None]
    c, s = np.cos(rate * at), np.sin(rate * at)
    points = np.stack([c * local[0] - s * local[1], s * local[0] + c * local[1], 0 * at + local[2]], axis=-1) + [10, 0, 1]
    length = sum(np.linalg.norm(points - antenna, axis=-1) for antenna in ([0, 0, 1], [0, 0.01, 1]))
    delay = length / ep.speed_of_light
    cycles = FREQUENCY * delay + waveform.slope * (at - at[:, :1]) * delay - 0.5 * waveform.slope * delay**2
    expected = np.exp(2j * np.pi * cycles)

    def phase_error(evaluate):
        cube = ep.synthesize(one, radar, evaluate=evaluate, tolerance=1e-10)[0, 0]
        assert np.abs(cube).min() > 0
        ratio = cube / expected
        return np.abs(np.angle(ratio / ratio[0, 0])).max()

    assert phase_error("samples") < 2 * DELAY_PHASE_TOLERANCE  # the first sample is the reference: its error counts too
    assert phase_error("interpolated") > 0.04


@pytest.mark.hard
def test_static_scene_has_identical_chirps():
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.3), name="ball", material=ROUGH, position=(12, 0.5, 1))
    scene.add(wall_mesh(), name="wall", material=mirror(scattering=0.3))
    radar = make_radar()
    cube = ep.synthesize(ep.trace(scene, radar, num_rays=5000), radar)
    assert np.abs(cube).max() > 0
    assert np.array_equal(cube, np.broadcast_to(cube[:, :, :1], cube.shape))


@pytest.mark.hard
def test_parts_add_up_to_the_whole():
    radar = make_radar(receivers=[(0, 0.01, 1), (0, 0.02, 1)])
    paths = ep.trace(walking_scene(), radar, num_rays=5000)
    whole = ep.synthesize(paths, radar)
    views = ep.decompose(paths, radar, {"route": {"direct": "T 'ball' R", "wall": "T .* 'wall' .* R"},
                                        "count": {"one": ep.num_bounces == 1, "few": ep.num_bounces <= 2}})
    scale = np.abs(whole).max()
    for parts in views.values():
        assert all(part.any() for name, part in parts.items() if name != "other")
        assert np.abs(sum(parts.values()) - whole).max() < ADDITIVITY * scale


def test_partition_is_disjoint_and_complete():
    paths = ep.trace(walking_scene(), make_radar(), num_rays=2000)
    parts = paths.partition({"wall": ep.hits("wall"), "rest of the ball": ep.hits("ball")})
    assert sum(part.num_paths for part in parts.values()) == paths.num_paths
    assert paths.select("T .* 'wall' .* R").num_paths == parts["wall"].num_paths
    assert paths.select(~ep.hits("wall")).num_paths == paths.num_paths - parts["wall"].num_paths


@pytest.mark.hard
def test_the_chain_has_the_same_bits_for_any_number_of_threads():
    radar = make_radar(num_chirps=16)
    cubes = []
    try:
        for threads in (1, 2, 5):
            ep.set_num_threads(threads)
            cubes.append(ep.synthesize(ep.trace(walking_scene(), radar, num_rays=5000), radar))
    finally:
        ep.set_num_threads(0)
    assert np.array_equal(cubes[0], cubes[1]) and np.array_equal(cubes[0], cubes[2])


def test_antennas_are_served_by_one_trace():
    """Lengths of an array from one trace are those of the points, for each pair."""
    transmitters, receivers = [(0, 0, 1), (0, 0.05, 1)], [(0, 0.01, 1), (0, 0.02, 1.1), (0.1, 0, 1)]
    radar = make_radar(num_chirps=4, transmitters=transmitters, receivers=receivers)
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.3), name="ball", material=ROUGH, position=(6, 0.5, 1))
    paths = ep.trace(scene, radar, num_rays=500, max_bounces=1)
    points = paths.points(0.0)[paths.offsets]
    for tx, a in enumerate(transmitters):
        for rx, b in enumerate(receivers):
            expected = np.linalg.norm(points - a, axis=1) + np.linalg.norm(points - b, axis=1)
            assert np.abs(paths.lengths([0.0], tx, rx)[0] - expected).max() < ROUNDING
            assert np.abs(paths.lengths([0.0], a, b)[0] - expected).max() < ROUNDING
    assert ep.synthesize(paths, radar).shape == (2, 3, 4, 512)


def test_another_waveform_needs_no_trace():
    radar = make_radar(num_chirps=4)
    paths = ep.trace(walking_scene(), radar, num_rays=1000)
    other = ep.Radar(ep.ChirpSequence(start_frequency=FREQUENCY, bandwidth=0.5e9, num_samples=128, sampling_rate=10e6,
                                      num_chirps=2, chirp_interval=50e-6),
                     transmitters=radar.transmitters, receivers=radar.receivers)
    assert ep.synthesize(paths, other).shape == (1, 1, 2, 128)


@pytest.mark.parametrize("keywords, text", [
    ({"method": "fft"}, "method: must be"),
    ({"evaluate": "none"}, "evaluate: must be"),
    ({"tolerance": 0.0}, "tolerance"),
    ({"phase_tolerance": -1.0}, "phase_tolerance"),
])
def test_bad_settings_are_named(keywords, text):
    radar = make_radar(num_chirps=2)
    paths = ep.trace(ep.Scene(), radar, num_rays=10)
    with pytest.raises(ValueError, match=text):
        ep.synthesize(paths, radar, **keywords)


def test_mixed_views_are_refused():
    radar = make_radar(num_chirps=2)
    paths = ep.trace(ep.Scene(), radar, num_rays=10)
    with pytest.raises(ValueError, match="parts"):
        ep.decompose(paths, radar, {"a": "T . R", "b": {"c": "T . R"}})


@pytest.mark.parametrize("parts, name", [({"a": "T .+ R", "b": "T 'none' R"}, "parts.b"),
                                         ({"view": {"b": "T 'none' R"}}, "parts.view.b")])
def test_the_part_that_names_no_mesh_is_named(parts, name):
    radar = make_radar(num_chirps=2)
    paths = ep.trace(ep.Scene(), radar, num_rays=10)
    with pytest.raises(ValueError, match=f"^{name}: path expression: expected a glob that takes a mesh"):
        ep.decompose(paths, radar, parts)
