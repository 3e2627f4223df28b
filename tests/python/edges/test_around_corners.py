"""Diffraction into shadows: edges against Sommerfeld's half plane, and what hidden objects are said to send."""
import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from scipy.special import fresnel, jv

import echopath as ep
from echopath import _core
from echopath.scene.node import SceneNode

FREQUENCY = 77e9
WAVENUMBER = 2.0 * np.pi * FREQUENCY / 299792458.0
OF_SOMMERFELD_DB = 1e-4  # the transition function's
OF_ROUNDING = 1e-6  # of the field nothing hides
BEFORE, BEHIND = 10.0, 8.0  # m, of the edge


def sommerfeld(source, at, is_electric, sine_to_edge=1.0):
    """The field about a half plane, over the wave that comes: angles from its face; the wave's field along the edge is electric
    or magnetic (Born and Wolf, 11.5), at the distance parameter of spherical waves. A wave that slants has the wave number across
    the edge, and longer ways (11.6)."""
    distance = BEFORE * BEHIND / (BEFORE + BEHIND) * sine_to_edge

    def part(angle):
        across = np.cos(0.5 * angle)
        x = -np.sqrt(2.0 * WAVENUMBER * distance) * across
        sine, cosine = fresnel(np.sqrt(2.0 / np.pi) * x)
        rest = 0.5 * np.sqrt(np.pi) * np.exp(-0.25j * np.pi) - np.sqrt(0.5 * np.pi) * (cosine - 1j * sine)
        return np.exp(0.25j * np.pi) / np.sqrt(np.pi) * rest * np.exp(2j * WAVENUMBER * distance * across ** 2)

    return abs(part(at - source) + (-1.0 if is_electric else 1.0) * part(at + source))


def ways_to(scene, points, antenna, polarization=(0.0, 0.0, 1.0)):
    return _core.legs_around_edges(scene, time=0.0, frequency=FREQUENCY, antenna=antenna, polarization=polarization,
                                   points=points)


@pytest.mark.parametrize("polarization, is_electric", [((0.0, 0.0, 1.0), True), ((0.0, 1.0, 0.0), False)])
def test_the_shadow_of_a_half_plane_is_sommerfelds(polarization, is_electric):
    """From its boundary, where half of the field arrives, to 60 degrees into it."""
    screen = np.array([(0.0, -900.0, -900.0), (0.0, 0.0, -900.0), (0.0, 0.0, 900.0), (0.0, -900.0, 900.0)])
    scene = ep.Scene()
    scene.add(ep.Mesh(screen, np.array([(0, 1, 2), (0, 2, 3)])), name="screen", material=ep.Material.metal())
    source = np.radians(70.0)  # from the face, which goes on to -y
    antenna = BEFORE * np.array([-np.sin(source), -np.cos(source), 0.0])
    angles = source + np.pi + np.radians([0.02, 0.2, 1.0, 5.0, 20.0, 60.0])
    points = BEHIND * np.stack([-np.sin(angles), -np.cos(angles), 0.0 * angles], axis=-1)
    found = ways_to(scene, points, antenna, polarization)
    free = np.linalg.norm(points - antenna, axis=1) / (BEFORE + BEHIND)  # the wave about the edge spreads over its own length
    wanted = free * [sommerfeld(source, at, is_electric) for at in angles]
    assert 20.0 * np.log10(found["share"]) == pytest.approx(20.0 * np.log10(wanted), abs=OF_SOMMERFELD_DB)
    assert found["share"][0] == pytest.approx(0.5, abs=0.03)
    assert found["length"] == pytest.approx(BEFORE + BEHIND, rel=1e-9)


@pytest.mark.parametrize("turned", [False, True])
def test_a_way_that_slants_may_begin_and_end_beside_the_edge(turned):
    """It meets the edge between the feet of both ends, of which one lies 5 m beyond its end. The other edge from there leads
    away so steeply that it has no way."""
    screen = np.array([(0.0, -900.0, -2700.0), (0.0, 0.0, 0.0), (0.0, 0.0, 900.0), (0.0, -900.0, 900.0)])
    scene = ep.Scene()
    scene.add(ep.Mesh(screen, np.array([(0, 1, 2), (0, 2, 3)])), name="screen", material=ep.Material.metal())
    source, at, rise = np.radians(70.0), np.radians(270.0), 15.0
    low, high = (np.array([-np.sin(angle), -np.cos(angle), 0.0]) * distance
                 for angle, distance in ((source, BEFORE), (at, BEHIND)))
    high[2] += rise
    antenna, point = (np.array((0.0, 0.0, -5.0)) + one for one in ((high, low) if turned else (low, high)))
    across = BEFORE + BEHIND
    length = np.hypot(across, rise)
    found = ways_to(scene, [point], antenna)
    assert found["point"][0] == pytest.approx((0.0, 0.0, -5.0 + rise * BEFORE / across), abs=1e-9)
    assert found["length"][0] == pytest.approx(length, rel=1e-12)
    wanted = np.linalg.norm(point - antenna) / length * sommerfeld(source, at, True, across / length)
    assert 20.0 * np.log10(found["share"][0]) == pytest.approx(20.0 * np.log10(wanted), abs=OF_SOMMERFELD_DB)


def half_hidden_box(turn, shift):
    """Ways to points on the faces of a box that a screen hides the half of, in a world that is turned and shifted."""
    turned = np.eye(4)
    turned[:3, :3], turned[:3, 3] = turn, shift
    scene = ep.Scene()
    placed = {"screen": (Rotation.identity(), (3.0, 0.2, 0.0)), "box": (Rotation.from_rotvec((0.4, -0.7, 0.5)), (7.0, -0.9, 0.1))}
    for name, (own, place) in placed.items():
        pose = np.eye(4)
        pose[:3, :3], pose[:3, 3] = own.as_matrix(), place
        size = (0.2, 1.0, 1.6) if name == "screen" else (0.6, 0.8, 0.5)
        scene.add(ep.actors.box(size), name=name, material="metal", transform=turned @ pose)
    corners = scene.world_vertices(1, 0.0)[scene.meshes[1].triangles]
    weights = np.random.default_rng(1).dirichlet((1.0, 1.0, 1.0), 40)
    points = np.concatenate([weights @ triangle for triangle in corners])
    return _core.legs_around_edges(scene, time=0.0, frequency=FREQUENCY, antenna=turned[:3, 3], polarization=turn[:, 2],
                                   points=points)


def test_ways_do_not_depend_on_where_the_world_is():
    """What comes along a box's own faces from its edges is no way: whether it is free would be the rounding's choice."""
    here = half_hidden_box(np.eye(3), np.zeros(3))
    assert np.count_nonzero((here["share"] > 0.0) & (here["share"] < 1.0)) > 50
    for seed in range(4):
        there = half_hidden_box(Rotation.random(random_state=seed).as_matrix(), np.array([20.0, -7.0, 3.0]) * seed)
        assert there["share"] == pytest.approx(here["share"], abs=OF_ROUNDING)
        assert np.array_equal(there["mesh_id"], here["mesh_id"])


def board(half_width, low=-300.0, high=300.0):
    corners = np.array([(BEFORE, y, z) for y, z in ((-1, low), (1, low), (1, high), (-1, high))]) * (1.0, half_width, 1.0)
    return ep.Mesh(corners, np.array([(0, 1, 2), (0, 2, 3)]))


def behind_the_board(*boards):
    scene = ep.Scene()
    for k, one in enumerate(boards):
        scene.add(one, name=f"board {k}", material="metal")
    aside = np.linspace(-0.2, 0.2, 41)
    return aside, ways_to(scene, np.stack([np.full(41, BEFORE + BEHIND), aside, np.zeros(41)], axis=-1), np.zeros(3))["share"]


def test_waves_from_both_sides_of_a_board_add_up():
    """As Kirchhoff's field behind a screen of finite width (ITU-R P.526, 4.4.2): on its axis twice that of a side."""
    half_width = 0.25

    def knife_edge(height):
        sine, cosine = fresnel(height * np.sqrt(WAVENUMBER / np.pi * (BEFORE + BEHIND) / (BEFORE * BEHIND)))
        return (0.5 + 0.5j) * ((0.5 - cosine) - 1j * (0.5 - sine))

    aside, found = behind_the_board(board(half_width))
    line = aside * BEFORE / (BEFORE + BEHIND)
    sides = [knife_edge(half_width - side * line) for side in (-1.0, 1.0)]
    wanted = np.abs(sum(sides))
    assert wanted[20] == pytest.approx(2.0 * np.abs(sides[0][20])) and wanted.min() < 0.3 * wanted.max()
    assert found == pytest.approx(wanted, abs=0.04 * wanted.max())


def test_an_edge_counts_once_however_many_meshes_have_it():
    """Of two boards in one place, and of two halves that meet at the very height of the ways."""
    _, whole = behind_the_board(board(0.25))
    for parts in ((board(0.25), board(0.25)), (board(0.25, high=0.0), board(0.25, low=0.0))):
        assert behind_the_board(*parts)[1] == pytest.approx(whole, rel=1e-6)


def block(low, high):
    corners = np.array([(x, y, z) for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])])
    faces = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
    return ep.Mesh(corners, np.array([half for a, b, c, d in faces for half in ((a, b, c), (a, c, d))]))


@pytest.mark.parametrize("polarization, sign", [((0.0, 0.0, 1.0), -1.0), ((1.0, -1.0, 0.0), 1.0)])
def test_the_shadow_of_a_right_angle_is_that_of_the_exact_series(polarization, sign):
    """The eigenfunctions of a wedge for a plane wave (Balanis, Advanced Engineering Electromagnetics, 13.3), 100 wavelengths
    from the edge: from the boundary of the shadow to a degree from the dark face."""
    frequency, source, ratio = 1e9, np.radians(50.0), 1.5
    wavenumber = 2.0 * np.pi * frequency / 299792458.0
    distance, far = 200.0 * np.pi / wavenumber, 3e5
    scene = ep.Scene()
    scene.add(block((0.0, -4000.0, -4000.0), (4000.0, 0.0, 4000.0)), name="wedge", material=ep.Material.metal())
    degrees = np.array([230.1, 231.0, 234.0, 240.0, 250.0, 260.0, 269.0])
    around = np.radians(degrees)
    points = distance * np.stack([-np.sin(around), -np.cos(around), 0.0 * around], axis=-1)
    antenna = far * np.array([-np.sin(source), -np.cos(source), 0.0])
    found = _core.legs_around_edges(scene, time=0.0, frequency=frequency, antenna=antenna, polarization=polarization,
                                    points=points)
    assert np.all(found["mesh_id"] == 0)
    orders = np.arange(1300)
    terms = np.where(orders > 0, 2.0, 1.0) / ratio * np.exp(0.5j * np.pi * orders / ratio) * jv(orders / ratio, 200.0 * np.pi)
    angles = [np.cos(np.outer(around + side * source, orders / ratio)) for side in (-1.0, 1.0)]
    exact = np.abs((angles[0] + sign * angles[1]) @ terms)
    difference = 20.0 * np.log10(found["share"] / exact)
    in_transition = degrees < 250.0
    assert np.abs(difference[in_transition]).max() < 0.5 and np.abs(difference[~in_transition]).max() < 0.1


def building(scene):
    scene.add(block((8.0, -12.0, 0.0), (20.0, -1.0, 8.0)), name="building", material="concrete")


@pytest.fixture(scope="module")
def radar():
    chirps = ep.ChirpSequence(start_frequency=FREQUENCY, bandwidth=1e9, num_samples=64, sampling_rate=20e6, num_chirps=4,
                              chirp_interval=60e-6)
    return ep.Radar(chirps, transmitters=[ep.Antenna((0, 0, 1))], receivers=[ep.Antenna((0, 0.01, 1))])


def test_a_person_behind_a_corner_sends_less_the_deeper_in_its_shadow(radar):
    losses = []
    for y in (-2.6, -4.0):
        scene = ep.Scene()
        building(scene)
        scene.add(ep.actors.pedestrian(height=1.78), name="person", position=(30.0, y, 0.0))
        person = next(one for one in ep.around_corners(scene, radar, num_rays=2000) if one.name == "person")
        assert person.hidden_share > 0.9 and person.corner == "building"
        assert person.point[:2] == pytest.approx((20.0, -1.0), abs=1e-6)
        alone = ep.Scene()
        alone.add(ep.actors.pedestrian(height=1.78), name="person", position=(30.0, y, 0.0))
        level = ep.received_power(ep.trace(alone, radar, num_rays=2000, max_bounces=1)).power
        assert 10.0 * np.log10(level / person.power) == pytest.approx(person.loss_db, abs=1.0)
        losses.append(person.loss_db)
    assert 40.0 < losses[0] < losses[1] - 10.0


def test_nothing_is_told_of_who_is_seen(radar):
    scene = ep.Scene()
    building(scene)
    scene.add(ep.actors.pedestrian(height=1.78), name="person", position=(24.0, 3.0, 0.0))
    assert ep.around_corners(scene, radar, num_rays=500) == []
    told = next(effect for effect in ep.effects(scene, radar) if effect.name == "diffraction into shadows")
    assert not told.modelled and "around_corners" in told.reason


def hidden_block():
    """A rough block that drives away behind the corner."""
    scene = ep.Scene()
    building(scene)
    scene.add(block((-0.2, -0.2, 0.0), (0.2, 0.2, 1.5)), name="block", position=(30.0, -2.6, 0.3), yaw=0.4,
              material=ep.Material(conductor=True, scattering=0.7), motion=ep.LinearMotion(velocity=(2.0, 0, 0)))
    return scene


def test_the_signal_of_hidden_objects_has_their_power_range_and_speed(radar):
    chirps = radar.waveform.replace(num_samples=256, num_chirps=32)
    radar = radar.replace(waveform=chirps)
    scene = hidden_block()
    told = next(one for one in ep.around_corners(scene, radar, time=0.5 * radar.frame_duration) if one.name == "block")
    powers, place = [], np.zeros(2)
    for seed in range(12):
        cube = ep.synthesize_around_corners(scene, radar, seed=seed)
        powers.append(np.mean(np.abs(cube) ** 2))
        values = ep.range_doppler(cube, radar, window="hann")
        power = np.abs(values.values[0, 0]) ** 2
        row, column = np.unravel_index(np.argmax(power), power.shape)
        place += np.array([values.velocity[row], values.range[column]]) / 12
    assert 10.0 * np.log10(np.mean(powers) / told.power) == pytest.approx(0.0, abs=2.0)  # 12 speckles: 1.3 dB
    assert place[1] == pytest.approx(told.length, abs=0.3)
    assert place[0] == pytest.approx(2.0 * 10.0 / np.hypot(10.0, 1.6), abs=values.velocity[1] - values.velocity[0])


def test_a_timing_that_is_told_in_two_ways_gives_one_signal(radar):
    chirps = radar.waveform.replace(num_samples=256, num_chirps=8, chirp_interval=1e-4)
    halves = chirps.replace(chirp_interval=5e-5, extra_idle=(5e-5,))
    one, other = (ep.synthesize_around_corners(hidden_block(), radar.replace(waveform=waveform)) for waveform in (chirps, halves))
    assert one.any() and np.abs(other - one).max() <= 1e-9 * np.abs(one).max()


def test_chirps_do_not_depend_on_how_far_apart_others_are(radar):
    chirps = radar.waveform.replace(num_samples=256, num_chirps=8, chirp_interval=1e-4)
    uneven = chirps.replace(chirp_interval=5e-5, extra_idle=(9e-5, 1e-5))
    one, other = (ep.synthesize_around_corners(hidden_block(), radar.replace(waveform=waveform)) for waveform in (chirps, uneven))
    assert one.any() and np.abs(other - one)[:, :, ::2].max() <= 1e-4 * np.abs(one).max()  # parabolas of 0.71 and 0.75 ms


def test_what_is_absent_neither_sends_nor_hides(radar):
    """Its motion need not be known before it comes."""
    radar, comes = radar.replace(waveform=radar.waveform.replace(num_samples=256)), (1.0, 2.0)
    for name in ("building", "block"):
        scene = hidden_block()
        scene[name].motion = ep.KeyframeMotion(comes, translations=[(0.0, 0.0, 0.0)] * 2)
        scene[name].lifetime = comes
        assert not ep.synthesize_around_corners(scene, radar, num_rays=500).any()
        assert ep.synthesize_around_corners(scene, radar, start_time=1.5, num_rays=500).any()


@pytest.mark.parametrize("steps", ["frequency_steps", "bandwidth_steps"])
def test_steps_are_refused_in_signals_around_corners(radar, steps):
    stepped = radar.replace(waveform=radar.waveform.replace(**{steps: (0.0, 1e6)}))
    with pytest.raises(ValueError, match=f"radar: must have chirps that are all alike, got {steps}"):
        ep.synthesize_around_corners(hidden_block(), stepped)


def test_what_is_seen_adds_no_signal_and_codes_are_refused(radar):
    scene = ep.Scene()
    scene.add(ep.actors.pedestrian(height=1.78), name="person", position=(24.0, 3.0, 0.0))
    assert not ep.synthesize_around_corners(scene, radar).any()
    both = radar.replace(transmitters=[ep.Antenna((0, 0, 1)), ep.Antenna((0, 0.1, 1))], multiplexing="bpm")
    with pytest.raises(ValueError, match="multiplexing"):
        ep.synthesize_around_corners(scene, both)


def test_the_corner_of_the_receiver_alone_is_told(radar):
    """The transmitter stands in sight of the block, the receiver behind the building."""
    radar = radar.replace(transmitters=[ep.Antenna((30, 8, 1))])
    told = next(one for one in ep.around_corners(hidden_block(), radar, num_rays=2000) if one.name == "block")
    assert told.corner == "building" and told.point[:2] == pytest.approx((20.0, -1.0), abs=1e-6)


def test_levels_that_rays_do_not_know_are_told_as_such(radar):
    scene = ep.Scene()
    building(scene)
    scene.add(block((-0.2, -0.2, 0.0), (0.2, 0.2, 1.5)), name="block", position=(30.0, -2.6, 0.3), yaw=0.4, material="metal")
    told = next(one for one in ep.around_corners(scene, radar, num_rays=2000) if one.name == "block")
    assert told.low <= told.power <= told.high and not told.resolved
    scene["block"].material = ep.Material(conductor=True, scattering=1.0)
    rough = next(one for one in ep.around_corners(scene, radar, num_rays=50000) if one.name == "block")
    assert 0.0 < rough.low <= rough.power <= rough.high and rough.resolved


def subdivided(mesh):
    """The same surface, each triangle in four."""
    corners = mesh.vertices[mesh.triangles]
    middles = 0.5 * (corners + np.roll(corners, -1, axis=1))
    (a, b, c), (ab, bc, ca) = corners.swapaxes(0, 1), middles.swapaxes(0, 1)
    parts = np.concatenate([np.stack(one, axis=1) for one in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])
    return ep.Mesh(parts.reshape(-1, 3), np.arange(3 * len(parts)).reshape(-1, 3))


def test_finer_meshes_send_the_same(radar):
    told = []
    for times in (0, 1, 3):
        mesh = block((-0.2, -0.2, 0.0), (0.2, 0.2, 1.5))
        for _ in range(times):
            mesh = subdivided(mesh)
        scene = ep.Scene()
        building(scene)
        scene.add(mesh, name="block", position=(30.0, -2.6, 0.3), yaw=0.4, material=ep.Material(conductor=True, scattering=0.7))
        told.append(next(one for one in ep.around_corners(scene, radar, num_rays=2000) if one.name == "block").loss_db)
    assert told == pytest.approx([told[0]] * 3, abs=1.5)  # some 100 points face the radar, 10 dB apart: 0.4 dB each


def test_a_wall_whose_middle_is_hidden_has_the_share_of_the_shadow(radar):
    """A screen at half the distance throws a shadow twice as wide and as high."""
    scene = ep.Scene()
    wall = np.array([(40.0, y, z) for y, z in ((-10, -4), (10, -4), (10, 6), (-10, 6))])
    screen = np.array([(20.0, y, z) for y, z in ((-2, -1), (2, -1), (2, 3), (-2, 3))])
    for name, corners in (("wall", wall), ("screen", screen)):
        scene.add(ep.Mesh(corners, np.array([(0, 1, 2), (0, 2, 3)])), name=name, material="metal")
    (told,) = ep.around_corners(scene, radar, num_rays=500)
    assert told.name == "wall" and told.hidden_share == pytest.approx(4.0 * 16.0 / 200.0, abs=0.03)
    scene.remove("screen")
    level = ep.received_power(ep.trace(scene, radar, num_rays=500, max_bounces=1, edges=True)).power
    assert told.loss_db == pytest.approx(10.0 * np.log10(told.hidden_share * level / told.power), abs=0.5)


def test_the_level_of_a_tilted_plate_is_that_of_its_own_edges(radar):
    """First order of edge theory for waves along the upright edges (Ross 1966), seven times the level of the face alone here."""
    side, tilt, place = 0.05, 0.8, np.array((30.0, -2.6, 1.0))
    scene = ep.Scene()
    building(scene)
    scene.add(ep.actors.plate(side, side), name="plate", material="metal", position=place,
              yaw=tilt - np.arctan2(2.6, 30.0))
    told = next(one for one in ep.around_corners(scene, radar, num_rays=20_000) if one.name == "plate")
    assert told.hidden_share == 1.0 and told.resolved
    wavelength = 299792458.0 / radar.waveform.centre_frequency
    turn = 2.0 * np.pi / wavelength * side * np.sin(tilt)
    section = side ** 2 / np.pi * (np.cos(turn) ** 2 + (np.sin(turn) / np.sin(tilt)) ** 2)
    level = radar.transmit_power * wavelength ** 2 * section / ((4.0 * np.pi) ** 3 * np.hypot(*place[:2]) ** 4)
    assert 10.0 * np.log10(told.power / level) + told.loss_db == pytest.approx(0.0, abs=0.5)  # edges of 7 wavelengths


def test_channels_differ_by_the_lengths_of_their_ways():
    """A speck that drives away behind the corner, seen by two transmitters in turn and two receivers: about the upright edge the
    ways are straight when its two sides are laid flat."""
    chirps = ep.ChirpSequence(start_frequency=FREQUENCY, bandwidth=0.2e9, num_samples=64, sampling_rate=20e6, num_chirps=4,
                              chirp_interval=60e-6)
    antennas = [[np.array((0.0, y, 1.0)) for y in ys] for ys in ((0.0, 0.03), (0.1, 0.15))]
    radar = ep.Radar(chirps, transmitters=[ep.Antenna(at) for at in antennas[0]],
                     receivers=[ep.Antenna(at) for at in antennas[1]])
    scene = ep.Scene()
    building(scene)
    speed = 5.0
    scene.add(block((-1e-3,) * 3, (1e-3,) * 3), name="speck", position=(30.0, -1.6, 1.2),
              motion=ep.LinearMotion(velocity=(speed, 0, 0)), material=ep.Material(conductor=True, scattering=1.0))
    cube = ep.synthesize_around_corners(scene, radar, num_rays=500)
    corner = np.array((20.0, -1.0))

    def length(antenna, time):
        at = np.array((30.0 + speed * time, -1.6, 1.2))
        flat = np.linalg.norm(corner - antenna[:2]) + np.linalg.norm(at[:2] - corner)
        return np.hypot(flat, at[2] - antenna[2])

    ways = np.array([[length(out, i * 60e-6) + length(back, i * 60e-6) for back in antennas[1]]
                     for i, out in enumerate(antennas[0])])
    slope = chirps.bandwidth / (chirps.num_samples / chirps.sampling_rate)
    middle = FREQUENCY + 0.5 * slope * chirps.num_samples / chirps.sampling_rate
    found = (cube * cube[0, 0].conj()).sum(axis=(2, 3))
    turned = found * np.exp(-2j * np.pi * middle * (ways - ways[0, 0]) / 299792458.0)
    assert np.abs(found).min() > 0.0
    assert np.angle(turned) == pytest.approx(np.zeros((2, 2)), abs=0.1)


def test_gains_are_those_toward_the_corner(radar):
    """Of beams that look aside, the block behind the corner gets what leaves for the corner, not for the block."""
    scene, exponent, yaw = hidden_block(), 12, 0.7
    pattern = ep.CosinePower(exponent, peak_gain=1.0)
    beams = radar.replace(**{ends: [one.replace(pattern=pattern, yaw=yaw) for one in getattr(radar, ends)]
                             for ends in ("transmitters", "receivers")})
    plain, turned = (next(one for one in ep.around_corners(scene, each, num_rays=500) if one.name == "block")
                     for each in (radar, beams))
    ahead = (np.array((20.0, -1.0)) / np.hypot(20.0, 1.0)) @ (np.cos(yaw), np.sin(yaw))  # level but for a hundredth
    straight = (np.array((30.0, -2.6)) / np.hypot(30.0, 2.6)) @ (np.cos(yaw), np.sin(yaw))
    assert turned.power / plain.power == pytest.approx(ahead ** (2 * exponent), rel=0.02)
    gained = 20.0 * exponent * np.log10(ahead / straight)
    assert plain.loss_db - turned.loss_db == pytest.approx(gained, abs=0.2)
    one_way = radar.replace(receivers=beams.receivers)
    powers = [np.sum(np.abs(ep.synthesize_around_corners(scene, each.replace(
        waveform=radar.waveform.replace(num_samples=256)), num_rays=500)) ** 2) for each in (radar, beams, one_way)]
    assert powers[1] / powers[0] == pytest.approx(ahead ** (2 * exponent), rel=0.02)
    assert powers[2] / powers[0] == pytest.approx(ahead ** exponent, rel=0.02)


@pytest.mark.parametrize("driving", ["radar", "building"])
def test_a_corner_may_slide_by_during_the_frame(radar, driving):
    """By 0.4 m in each half of the frame: past the top of a wall, or with the building, at 30 m/s."""
    waveform = radar.waveform.replace(num_samples=256, num_chirps=16, chirp_interval=1.6e-3)
    velocity = ep.LinearMotion(velocity=(30.0, 0.0, 0.0))
    scene = ep.Scene()
    if driving == "radar":
        radar = radar.replace(waveform=waveform, motion=velocity)
        wall = np.array([(-50.0, 2.0, 0.0), (80.0, 2.0, 0.0), (80.0, 2.0, 1.6), (-50.0, 2.0, 1.6)])
        scene.add(ep.Mesh(wall, np.array([(0, 1, 2), (0, 2, 3)])), name="wall", material="metal")
        place = (10.0, 3.5, 0.0)
    else:
        radar = radar.replace(waveform=waveform)
        scene.add(block((8.0, -12.0, 0.0), (20.0, -1.0, 8.0)), name="building", material="concrete", motion=velocity)
        place = (30.0, -2.6, 0.3)
    scene.add(block((-0.2, -0.2, 0.0), (0.2, 0.2, 1.4)), name="block", position=place, yaw=0.4,
              material=ep.Material(conductor=True, scattering=1.0))
    told = next(one for one in ep.around_corners(scene, radar, time=0.5 * radar.frame_duration, num_rays=500)
                if one.name == "block")
    powers = [np.mean(np.abs(ep.synthesize_around_corners(scene, radar, seed=seed, num_rays=500)) ** 2) for seed in range(6)]
    assert 10.0 * np.log10(np.mean(powers) / told.power) == pytest.approx(0.0, abs=3.0)  # six speckles: 2 dB


def test_each_object_of_a_crowd_is_hidden_and_shown_once(radar, monkeypatch):
    """Not hidden again for every other object that is looked at alone: the changes are as many as the objects, twice."""
    scene, num_objects, changes = ep.Scene(), 12, []
    for k in range(num_objects):
        scene.add(ep.actors.plate(1.0, 1.0), name=f"plate_{k}", material="metal", position=(5.0 + k, 0.1 * k, 1.0), yaw=np.pi)
    change = SceneNode._change
    monkeypatch.setattr(SceneNode, "_change", lambda node, **fields: (changes.append(node), change(node, **fields))[1])
    assert len(ep.around_corners(scene, radar, num_rays=100)) > 0
    assert len(changes) <= 2 * num_objects
