"""Polarised echoes over mirrors and off rough surfaces, against images and boundary conditions worked out here."""
import numpy as np
import pytest

import echopath as ep
from support.shapes import METAL, WAVELENGTH, fields, make_radar, plate, rectangle, scene_of, sphere

MATRIX_TOLERANCE = 2e-6          # of the field: weights and matrices are kept in single precision
PLATE_TOLERANCE = 0.002          # of the field: directions vary by as much over a plate of five wavelengths
PATCH_TOLERANCE = 1e-4           # of the field: likewise over a patch of 0.1 mm
BALL_TOLERANCE = 0.01            # of the field: what an even mesh and 2^14 rays leave, 0.1 dB
REVERSAL_TOLERANCE = 0.02        # of the field: what 2^16 rays leave of an echo over two surfaces
RIGHT_ANGLE_TOLERANCE = 2e-5  # relative: seen .006 rad off the axis, two crossed antennas are 1.8e-5 rad off a right angle
SPLIT_TOLERANCE = 0.02           # of the power: three standard errors of the mean over the axes of 2e4 hits
V, H = np.array((0.0, 0, 1)), np.array((0.0, 1, 0))

TRANSMITTER, RECEIVER = np.array((0.2, -0.4, 0.5)), np.array((-0.1, 0.6, 1.1))
SENT, RECEIVED = np.array((0.2, 0.9, 0.4)), np.array((-0.3, 0.1, 0.95))
LEAN = np.array((-0.25, -0.9, -0.3)) / np.linalg.norm((-0.25, -0.9, -0.3))  # normal of a wall that leans over
WALL_POINT = np.array((3.0, 2.5, 0.0))
TARGET = np.array((4.0, 0.3, 0.4))  # sees both antennas, directly and in the wall
WEIGHTS = 1e-6               # relative: single precision of weights and of Jones matrices


# --- Fields by hand: E at a point, times its distance from the image of the antenna ---

def unit(vector):
    return vector / np.linalg.norm(vector)


def across(vector, direction):
    return unit(vector - (vector @ direction) * direction)


def mirrored(vector, normal):
    return vector - 2 * (vector @ normal) * normal


def image(point, wall_point, normal):
    return point - 2 * ((point - wall_point) @ normal) * normal


def field_off_metal(field, direction, normal):
    """An image dipole: tangential moments turn over, those along the normal do not."""
    return 2 * (normal @ field) * normal - field


def field_off(permittivity):
    """Continuity of the tangential E and H at the surface of a half space, solved for reflected and transmitted wave."""
    def reflected(field, direction, normal):
        normal = normal if direction @ normal < 0 else -normal
        tangential = direction - (direction @ normal) * normal
        depth = np.sqrt(permittivity - tangential @ tangential + 0j)
        above, below, none = mirrored(direction, normal), tangential - depth * normal, np.zeros(3)
        wedge = crossing(normal)
        rows = np.vstack([np.hstack([above, none]), np.hstack([none, below]), np.hstack([wedge, -wedge]),
                          np.hstack([wedge @ crossing(above), -wedge @ crossing(below)])])
        known = np.concatenate([[0, 0], -wedge @ field, -wedge @ np.cross(direction, field)])
        return np.linalg.lstsq(rows, known, rcond=None)[0][:3]
    return reflected


def crossing(vector):
    """[3, 3], the matrix of vector x."""
    return np.cross(np.eye(3), vector)


def leaning_wall(material):
    first = unit(np.cross(LEAN, V))
    second = np.cross(LEAN, first)
    return rectangle(WALL_POINT - 20 * (first + second), 40 * first, 40 * second), material


def radar_between(transmitter, receiver, sent, received):
    plain = make_radar(transmitter, receiver)
    return ep.Radar(plain.waveform, transmitters=[ep.Antenna(transmitter, polarization=unit(sent))],
                    receivers=[ep.Antenna(receiver, polarization=unit(received))], transmit_power=1.0)


def traced(scene, radar, **settings):
    return ep.trace(scene, radar, polarization="jones", **{"num_rays": 1 << 12, **settings})


# --- Mirrors alone ---

@pytest.mark.parametrize("permittivity", [None, 4 - .2j, 1.7, 30 - 20j])
@pytest.mark.parametrize("sent, received", [(SENT, RECEIVED), (V, V), (V, H), (H, V)])
def test_a_dipole_before_a_leaning_wall(permittivity, sent, received):
    material = METAL.replace(mirror=True) if permittivity is None else ep.Material(permittivity=permittivity, mirror=True)
    reflect = field_off_metal if permittivity is None else field_off(permittivity)
    radar = radar_between(TRANSMITTER, RECEIVER, sent, received)
    paths = traced(scene_of(wall=leaning_wall(material)), radar, num_rays=16)
    assert paths.num_paths == 1
    line = RECEIVER - image(TRANSMITTER, WALL_POINT, LEAN)
    arrival = unit(line)
    departure = mirrored(arrival, LEAN)
    field = reflect(across(sent, departure), departure, LEAN)
    expected = WAVELENGTH / (4 * np.pi * np.linalg.norm(line)) * (across(received, arrival) @ field)
    scale = WAVELENGTH / (4 * np.pi * np.linalg.norm(line))
    assert abs(paths.amplitude[0] - expected) < MATRIX_TOLERANCE * scale


def test_a_dipole_before_two_walls():
    floor = rectangle((-50, -50, -2), (100, 0, 0), (0, 100, 0))
    earth = ep.Material(permittivity=5 - .3j, mirror=True)
    scene = scene_of(floor=(floor, earth), wall=leaning_wall(ep.Material(permittivity=2.5 - .1j, mirror=True)))
    paths = traced(scene, radar_between(TRANSMITTER, RECEIVER, SENT, RECEIVED), num_rays=16)
    path = paths.select("T 'floor' 'wall' R")
    assert path.num_paths == 1
    line = RECEIVER - image(image(TRANSMITTER, np.array((0, 0, -2.0)), V), WALL_POINT, LEAN)
    arrival = unit(line)
    between = mirrored(arrival, LEAN)
    departure = mirrored(between, V)
    field = field_off(2.5 - .1j)(field_off(5 - .3j)(across(SENT, departure), departure, V), between, LEAN)
    scale = WAVELENGTH / (4 * np.pi * np.linalg.norm(line))
    assert abs(path.amplitude[0] - scale * (across(RECEIVED, arrival) @ field)) < MATRIX_TOLERANCE * scale


# --- Arrays that look straight down: the world's horizontal and vertical directions turn about z ---

BELOW = np.array((0.0, 0.0, -2.5))
AROUND = np.array(((0.02, 0.0, 0.0), (-0.01, 0.017, 0.0), (-0.01, -0.017, 0.01)))  # m, three antennas about the origin


def array_of(antennas, polarizations):
    plain = make_radar((0.0, 0.0, 0.0))
    made = [ep.Antenna(place, polarization=unit(own)) for place, own in zip(antennas, polarizations)]
    return ep.Radar(plain.waveform, transmitters=made, receivers=made[::-1], transmit_power=1.0)


@pytest.mark.parametrize("is_flagged", [False, True])
@pytest.mark.parametrize("aside", [0.0, 1e-3, 0.02, 0.3])
def test_each_channel_of_an_array_sees_its_own_image_in_a_floor_below(aside, is_flagged):
    normal = unit(np.array((0.5 * aside, -0.7 * aside, 2.5)))
    first = unit(np.cross(normal, H))
    second = np.cross(normal, first)
    floor = rectangle(BELOW - 4 * (first + second), 8 * first, 8 * second)
    sent = np.array(((1.0, 0.2, 0.1), (0.3, 1.0, 0.0), (1.0, -0.4, 0.3)))
    radar = array_of(AROUND, sent)
    paths = traced(scene_of(floor=(floor, METAL.replace(mirror=is_flagged))), radar)
    assert paths.num_paths == 1
    for tx, transmitter in enumerate(radar.transmitters):
        for rx, receiver in enumerate(radar.receivers):
            line = receiver.position - image(transmitter.position, BELOW, normal)
            arrival = unit(line)
            departure = mirrored(arrival, normal)
            field = field_off_metal(across(transmitter.polarization, departure), departure, normal)
            scale = WAVELENGTH / (4 * np.pi * np.linalg.norm(line))
            expected = scale * (across(receiver.polarization, arrival) @ field)
            found = paths.amplitudes([paths.frame.trace_time], tx, rx)[0, 0]
            assert abs(found - expected) < MATRIX_TOLERANCE * scale


@pytest.mark.parametrize("aside", [0.0, 0.005, 0.02, 0.1])
def test_a_ball_below_an_array_echoes_as_one_ahead(aside):
    """The echo of a large metal ball is co-polarised, whatever the polarisation, and as strong as its cross section."""
    radius, centre = 0.1, BELOW + np.array((0.6 * aside, 0.8 * aside, 0.0))
    radar = array_of(AROUND, np.tile((1.0, 0.3, 0.0), (3, 1)))
    paths = traced(scene_of(ball=(sphere(centre, radius, 4), METAL, True)), radar, num_rays=1 << 14)
    for tx, transmitter in enumerate(radar.transmitters):
        for rx, receiver in enumerate(radar.receivers):
            product = np.prod([np.linalg.norm(place - centre) - 0.5 * radius
                               for place in (transmitter.position, receiver.position)])
            expected = WAVELENGTH * 0.5 * radius / (4 * np.pi * product)
            cycles = paths.lengths([paths.frame.trace_time], tx, rx)[0] / WAVELENGTH
            echo = paths.amplitudes([paths.frame.trace_time], tx, rx)[0] @ np.exp(-2j * np.pi * cycles)
            assert abs(abs(echo) / expected - 1.0) < BALL_TOLERANCE


@pytest.mark.parametrize("order", ["wall ball", "ball wall"])
@pytest.mark.parametrize("steep", [0.0, 0.01, 0.2])
def test_an_echo_over_an_unmarked_plane_does_not_depend_on_where_up_is(order, steep):
    """One order of the bounces is the reversal of what rays bring in the other, between antennas that stand apart."""
    towards_ball = unit(np.array((5.0, -1.0, 0.2)))
    level = echo_over_plane(order, np.eye(3))
    assert abs(level) > 1e-7
    for axis in (unit(np.cross(towards_ball, V)), unit(np.cross(towards_ball, H))):
        turn = turned_to(towards_ball, unit(V + steep * axis))
        assert abs(echo_over_plane(order, turn) / level - 1.0) < REVERSAL_TOLERANCE


def turned_to(first, second):
    """[3, 3], the least rotation from one unit vector to another."""
    axis = crossing(np.cross(first, second))
    return np.eye(3) + axis + axis @ axis / (1 + first @ second)


def echo_over_plane(order, turn):
    """The field over wall and ball of a scene that is turned as a whole, sqrt(W)."""
    wall = rectangle(turn @ (-2.0, 2, -4), turn @ (12.0, 0, 0), turn @ (0, 0, 8.0)), METAL
    ball = sphere(turn @ (5.0, -1, 0.2), 0.3, 4), METAL, True
    radar = radar_between(turn @ (0.0, 0, 0), turn @ (0.1, 0.3, -0.2), turn @ (0.3, -0.4, 1), turn @ (0, 0.8, 0.6))
    paths = traced(scene_of(wall=wall, ball=ball), radar, num_rays=1 << 16)
    first, last = order.split()
    return fields(paths.select(f"T '{first}' '{last}' R")).sum()


# --- A target beside a mirror ---

ROUTES = {"T 'target' R": (False, False), "T 'wall' 'target' R": (True, False), "T 'target' 'wall' R": (False, True),
          "T 'wall' 'target' 'wall' R": (True, True)}  # over the wall on the way out, on the way back


def legs_of(over):
    """Directions at the target of waves from the transmitter and the receiver, and those in which they start."""
    antennas = zip((TRANSMITTER, RECEIVER), over)
    ends = [image(antenna, WALL_POINT, LEAN) if by_wall else antenna for antenna, by_wall in antennas]
    arrivals = [unit(TARGET - end) for end in ends]
    return ends, arrivals, [mirrored(k, LEAN) if by_wall else k for k, by_wall in zip(arrivals, over)]


def plate_echo(corner, first, second, over, reflect):
    ends, arrivals, starts = legs_of(over)
    # Both as fields of a launch: that of the receiver gives what it makes of a current.
    lit = [reflect(across(vector, start), start, LEAN) if by_wall else across(vector, start)
           for vector, start, by_wall in zip((SENT, RECEIVED), starts, over)]
    return plate_sum(corner, first, second, ends, arrivals, lit)


def plate_sum(corner, first, second, ends, arrivals, lit, num=300):
    """Physical optics, currents 2 n x H, of a metal plate: the midpoint sum over its points, sqrt(W)."""
    grid = (np.arange(num) + 0.5) / num
    points = (corner + grid[:, None, None] * first + grid[None, :, None] * second).reshape(-1, 3)
    lengths = [np.linalg.norm(points - end, axis=1) for end in ends]
    normal = unit(np.cross(first, second))
    normal = -np.sign(normal @ arrivals[0]) * normal
    current = np.cross(normal, np.cross(arrivals[0], lit[0]))
    wave = np.exp(-2j * np.pi / WAVELENGTH * (lengths[0] + lengths[1])) / (lengths[0] * lengths[1])
    area = np.linalg.norm(np.cross(first, second)) / num**2
    return -1j * area / (4 * np.pi) * wave.sum() * (current @ lit[1])


@pytest.mark.parametrize("permittivity", [None, 5 - .3j])
@pytest.mark.parametrize("route", ROUTES)
def test_a_turned_metal_plate_beside_a_leaning_wall(route, permittivity):
    material = METAL.replace(mirror=True) if permittivity is None else ep.Material(permittivity=permittivity, mirror=True)
    reflect = field_off_metal if permittivity is None else field_off(permittivity)
    _, arrivals, _ = legs_of(ROUTES[route])
    facing = unit(-arrivals[0] - arrivals[1])  # it mirrors this route to the receiver
    first = 0.02 * unit(np.cross(facing, (0.3, 0.2, 1.0)))
    second = 0.02 * np.cross(facing, unit(first))
    corner = TARGET - 0.5 * (first + second)
    scene = scene_of(target=(rectangle(corner, first, second), METAL), wall=leaning_wall(material))
    paths = traced(scene, radar_between(TRANSMITTER, RECEIVER, SENT, RECEIVED), num_rays=1 << 14, max_bounces=3)
    expected = plate_echo(corner, first, second, ROUTES[route], reflect)
    assert abs(fields(paths.select(route)).sum() / expected - 1) < PLATE_TOLERANCE


FLOOR, EARTH, BRICK = np.array((0.0, 0, -2)), 5 - .3j, 2.5 - .1j
PLANES = {"floor": (FLOOR, V, field_off(EARTH)), "wall": (WALL_POINT, LEAN, field_off(BRICK))}


def leg_over(antenna, moment, names):
    """The image of an antenna over planes in turn, its direction of travel at the target, and its field there."""
    end = antenna
    for name in names:
        end = image(end, *PLANES[name][:2])
    directions = [unit(TARGET - end)]
    for name in reversed(names):
        directions.insert(0, mirrored(directions[0], PLANES[name][1]))
    field = across(moment, directions[0])
    for name, direction in zip(names, directions):
        field = PLANES[name][2](field, direction, PLANES[name][1])
    return end, directions[-1], field


@pytest.mark.parametrize("there, back", [(("floor", "wall"), ()), ((), ("floor", "wall")), (("wall", "floor"), ("wall",)),
                                         (("floor", "wall"), ("wall", "floor"))])
def test_a_turned_metal_plate_between_floor_and_wall(there, back):
    """`there` and `back`: planes on the way from the transmitter and on that from the receiver."""
    ends, arrivals, lit = zip(leg_over(TRANSMITTER, SENT, there), leg_over(RECEIVER, RECEIVED, back))
    facing = unit(-arrivals[0] - arrivals[1])  # it mirrors this route to the receiver
    first = 0.02 * unit(np.cross(facing, (0.3, 0.2, 1.0)))
    second = 0.02 * np.cross(facing, unit(first))
    corner = TARGET - 0.5 * (first + second)
    floor = rectangle((-50, -50, -2), (100, 0, 0), (0, 100, 0)), ep.Material(permittivity=EARTH, mirror=True)
    scene = scene_of(target=(rectangle(corner, first, second), METAL), floor=floor,
                     wall=leaning_wall(ep.Material(permittivity=BRICK, mirror=True)))
    paths = traced(scene, radar_between(TRANSMITTER, RECEIVER, SENT, RECEIVED), num_rays=1 << 17, max_bounces=5)
    route = " ".join(f"'{name}'" for name in (*there, "target", *reversed(back)))
    expected = plate_sum(corner, first, second, ends, arrivals, lit)
    assert abs(fields(paths.select(f"T {route} R")).sum() / expected - 1) < PLATE_TOLERANCE


def test_a_rough_patch_beside_a_leaning_wall():
    patch = plate(TARGET, (-1.0, 0.4, 0.2), 1e-4), ep.Material(reflectivity=.5, scattering=1.0)
    scene = scene_of(target=patch, wall=leaning_wall(METAL.replace(mirror=True)))
    radar = radar_between(TRANSMITTER, RECEIVER, SENT, RECEIVED)
    polarised, scalar = traced(scene, radar, max_bounces=3), ep.trace(scene, radar, num_rays=1 << 12, max_bounces=3,
                                                                          polarization="scalar")
    for route, over in ROUTES.items():
        _, arrivals, starts = legs_of(over)
        lit = [field_off_metal(across(vector, start), start, LEAN) if by_wall else across(vector, start)
               for vector, start, by_wall in zip((SENT, RECEIVED), starts, over)]
        facet = unit(-arrivals[0] - arrivals[1])
        expected = lit[1] @ field_off_metal(lit[0], arrivals[0], facet) * (-1) ** sum(over)  # scalar metal reflects with -1
        ratio = polarised.select(route).amplitude / scalar.select(route).amplitude
        assert len(ratio) > 100 and np.all(np.abs(ratio - expected) < PATCH_TOLERANCE), route


# --- Rough surfaces share power between the polarisations ---

def rough(share, **others):
    return ep.Material(reflectivity=.5, scattering=.8, cross_polarization=share, **others)


@pytest.mark.parametrize("share", [0.0, 0.1, 0.25, 0.5])
@pytest.mark.parametrize("slant_deg", [0, 30, 45])
def test_the_cross_polarised_receiver_gets_its_share(share, slant_deg):
    slant = np.radians(slant_deg)
    co, cross = np.array((0, np.sin(slant), np.cos(slant))), np.array((0, np.cos(slant), -np.sin(slant)))
    material = ep.Material(reflectivity=.5, scattering=1.0, cross_polarization=share)
    scene = scene_of(ball=(sphere((50, 0, 0), .3, 4), material))
    plain = make_radar((0, 0, 0))
    radar = ep.Radar(plain.waveform, transmitters=[ep.Antenna((0, 0, 0), polarization=co)],
                     receivers=[ep.Antenna((0, 0, 0), polarization=p) for p in (co, cross)], transmit_power=1.0)
    paths = traced(scene, radar, num_rays=1 << 14, max_bounces=1)
    total = ep.trace(scene, radar, num_rays=1 << 14, max_bounces=1, polarization="scalar").power
    time = [paths.frame.trace_time]
    powers = [np.abs(paths.amplitudes(time, 0, receiver)[0]) ** 2 for receiver in (0, 1)]
    np.testing.assert_allclose(powers[0] + powers[1], total, rtol=RIGHT_ANGLE_TOLERANCE, atol=0, equal_nan=False)
    assert powers[0].sum() / total.sum() == pytest.approx(1 - share, abs=SPLIT_TOLERANCE)
    assert powers[1].sum() / total.sum() == pytest.approx(share, abs=SPLIT_TOLERANCE)


@pytest.mark.parametrize("share", [0.0, 0.3])
def test_no_chain_of_rough_and_mirroring_bounces_gains_or_loses_power(share):
    scene = scene_of(a=(rectangle((0, .1, -.5), (0, 2, 0), (0, 0, 1)), rough(share)),
                     b=(rectangle((.1, 0, -.5), (2, 0, 0), (0, 0, 1)), rough(share)),
                     floor=(rectangle((-9, -9, -1), (18, 0, 0), (0, 18, 0)), rough(share, mirror=True)))
    radar = make_radar((3, 2, .3), (2, 3, .5))
    # Too few rays for a pilot: both models have the same.
    paths, scalar = traced(scene, radar, num_rays=16000), ep.trace(scene, radar, num_rays=16000, polarization="scalar")
    assert np.array_equal(paths.diffuse, scalar.diffuse) and np.any(paths.diffuse & (paths.diffuse - 1) != 0)
    launched_vertically = np.linalg.norm(paths.jones[:, :, 1], axis=1)
    diffuse = paths.diffuse != 0
    expected = np.abs(scalar.weight)[diffuse]
    np.testing.assert_allclose(np.abs(paths.weight * launched_vertically)[diffuse], expected, rtol=WEIGHTS, atol=0,
                               equal_nan=False)


def matrices_by_hit(paths, hit):
    """{the hit that stands at `hit` of each path: matrix of the path}."""
    at = paths.offsets + hit
    return dict(zip(zip(paths.triangle_id[at], paths.u[at], paths.v[at]), paths.jones))


@pytest.mark.parametrize("mirrors", [("wall",), ("floor", "wall"), ("wall", "floor")])
def test_both_orders_of_a_ghost_carry_the_same_in_exchanged_polarisations(mirrors):
    ball = ep.Material(reflectivity=.5, scattering=1.0, cross_polarization=.3)
    earth = ep.Material(permittivity=5 - .3j, mirror=True)
    floor = rectangle((-50, -50, -2), (100, 0, 0), (0, 100, 0)), earth
    scene = scene_of(ball=(sphere((6, 0, 0), .3, 3), ball), floor=floor, wall=leaning_wall(earth))
    paths = traced(scene, make_radar(TRANSMITTER), num_rays=16000, max_bounces=3)
    names = [f"'{name}'" for name in mirrors]
    there = matrices_by_hit(paths.select(f"T {' '.join(names)} 'ball' R"), len(names))
    back = matrices_by_hit(paths.select(f"T 'ball' {' '.join(reversed(names))} R"), 0)
    common = list(there.keys() & back.keys())
    assert len(common) > 1000
    opposite = np.array([[1, -1], [-1, 1]])  # the horizontal of the way back points the other way
    found = np.array([back[hit] for hit in common])
    expected = np.array([there[hit] for hit in common]).swapaxes(1, 2) * opposite
    np.testing.assert_allclose(found, expected, rtol=0, atol=MATRIX_TOLERANCE, equal_nan=False)


def test_the_split_stays_with_the_hit_while_it_moves():
    scene = ep.Scene()
    ball = ep.Material(reflectivity=.5, scattering=1.0, cross_polarization=.3)
    scene.add(sphere((50, 0, 0), .3, 3), name="ball", material=ball, motion=ep.LinearMotion(velocity=(30, 0, 0)))
    radar = radar_between((0, 0, 0), (0, 0, 0), V, H)
    first, last = traced(scene, radar, num_rays=2000, max_bounces=1).amplitudes([0.0, 1e-2])
    ratio = (last / first)[np.abs(first) > 0]
    assert len(ratio) > 100 and np.abs(ratio.imag).max() < 1e-4 and np.ptp(ratio.real) < 0.01  # cosines change a little
