"""Edges of planes that nobody marked count as the beams of the antennas light them: beside Kirchhoff's integral with the gain
toward each place."""
import numpy as np
import pytest

import echopath as ep

FREQUENCY = 78e9
WAVELENGTH = ep.speed_of_light / FREQUENCY
HEIGHT = 1.9              # m, of a level gauge over what it looks down to
RIGHT = 0.045             # of the field of an endless plane: 0.03 by edges, the rest by the width of the beam itself
ONE_EDGE = 0.006          # likewise, where one straight edge is near
ROUND_RIM = 0.07          # likewise: to so much the share of edges of disks is right
LEVEL_TOLERANCE_DB = 0.02
LEVEL_GAUGE = 1137.0      # exponent: 4 degrees between the half power points
FOUND_AGAIN = 6e-3        # of the field: by other rays, which know edges to single precision, and as a record keeps it


def toward(direction):
    """A quaternion that turns +x to a direction."""
    half = np.array([1.0, 0.0, 0.0]) + direction / np.linalg.norm(direction)
    axis = np.cross([1.0, 0.0, 0.0], half / np.linalg.norm(half))
    return np.array([np.sqrt(1.0 - axis @ axis), *axis])


def gauge(transmitter, receiver, aims, exponent):
    """A radar of two antennas, each with its beam at a point."""
    antennas = [ep.Antenna(place, orientation=toward(np.subtract(aim, place)), pattern=ep.CosinePower(exponent))
                for place, aim in ((transmitter, aims[0]), (receiver, aims[1]))]
    waveform = ep.ChirpSequence(start_frequency=FREQUENCY, bandwidth=4e9, num_samples=64, num_chirps=1)
    return ep.Radar(waveform, transmitters=antennas[:1], receivers=antennas[1:])


def traced(meshes, radar, max_bounces=1):
    scene = ep.Scene()
    for index, mesh in enumerate(meshes):
        scene.add(mesh, name=f"plane {index}", material="metal")
    return ep.trace(scene, radar, num_rays=30_000, max_bounces=max_bounces, polarization="scalar")


def endless_power(radar, length):
    """The echo in W over endless metal planes, of antennas whose beams are aimed at it."""
    peak = 2.0 * (radar.transmitters[0].pattern.exponent + 1.0)
    return radar.transmit_power * (peak * WAVELENGTH / (4.0 * np.pi * length)) ** 2


def disk(radius, center=(0.0, 0.0, 0.0)):
    angles = np.arange(96) * 2.0 * np.pi / 96
    rim = radius * np.stack([np.cos(angles), np.sin(angles), 0.0 * angles], axis=1) + center
    return ep.Mesh(rim, [[0, k, k + 1] for k in range(1, 95)])


def disk_head_on(radius, exponent):
    """|field| of a disk below both antennas, over that of an endless one without a beam: Gauss-Legendre over its radius."""
    nodes, weights = np.polynomial.legendre.leggauss(200)
    places, weights = 0.5 * radius * (nodes + 1.0), 0.5 * radius * weights
    lengths = np.hypot(places, HEIGHT)
    gains = (HEIGHT / lengths) ** exponent  # both ways, of fields
    wave = np.exp(-4j * np.pi / WAVELENGTH * (lengths - HEIGHT))
    return 2.0 * HEIGHT / WAVELENGTH * abs(np.sum(weights * 2.0 * np.pi * places * gains * HEIGHT / lengths**3 * wave))


@pytest.mark.parametrize("exponent", [100.0, 400.0, LEVEL_GAUGE])
@pytest.mark.parametrize("radius", [0.14, 0.2, 0.32, 0.34])
def test_a_liquid_below_a_narrow_beam_has_the_echo_that_its_rim_leaves(radius, exponent):
    """The rim is 2.3 to 5.6 half zones from the middle, where it alone would leave nothing up to four times the power."""
    above = (0.0, 0.0, HEIGHT)
    radar = gauge(above, above, ((0, 0, 0), (0, 0, 0)), exponent)
    paths = traced([disk(radius)], radar)
    found = np.sqrt(ep.received_power(paths).power / endless_power(radar, 2.0 * HEIGHT))
    lit = (HEIGHT / np.hypot(radius, HEIGHT)) ** exponent
    assert found == pytest.approx(disk_head_on(radius, exponent), abs=RIGHT + ROUND_RIM * lit)
    assert ep.validity(paths).largest_edge_change * found < FOUND_AGAIN


def plate_by_integral(plate, radar, length):
    """|field| of a level rectangle (x and y from, to) at z = 0 over that of an endless one: Gauss-Legendre over it."""
    nodes, weights = np.polynomial.legendre.leggauss(1000)
    sides = [(0.5 * (end - begin) * nodes + 0.5 * (begin + end), 0.5 * (end - begin) * weights) for begin, end in plate]
    x, y = np.meshgrid(sides[0][0], sides[1][0], indexing="ij")
    field, way, slant = np.outer(sides[0][1], sides[1][1]).astype(complex), 0.0, 0.0
    for antenna in (radar.transmitters[0], radar.receivers[0]):
        w, *axis = antenna.orientation
        boresight = np.array([1.0, 0.0, 0.0])
        boresight = boresight + 2.0 * np.cross(axis, np.cross(axis, boresight) + w * boresight)
        there = np.stack([x, y, 0.0 * x], axis=-1) - antenna.position
        distance = np.linalg.norm(there, axis=-1)
        exponent = antenna.pattern.exponent
        field *= np.clip(there @ boresight / distance, 0.0, 1.0) ** (0.5 * exponent) / distance
        way, slant = way + distance, slant + antenna.position[2] / distance / 2.0
    return length / WAVELENGTH * abs(np.sum(field * slant * np.exp(-2j * np.pi / WAVELENGTH * way)))


@pytest.mark.parametrize("exponent", [30.0, 300.0])
@pytest.mark.parametrize("edge", [0.06, 0.12, 0.18])
def test_a_plate_that_is_met_aslant_has_edges_as_both_beams_light_them(edge, exponent):
    """The transmitter's beam meets the point of reflection, the receiver's beam a place to its one side."""
    transmitter, receiver = (-1.0, 0.0, 1.2), (1.0, 0.0, 1.2)
    radar = gauge(transmitter, receiver, ((0, 0, 0), (0.0, 0.1, 0)), exponent)
    plate = ((-1.5, 1.5), (-edge, 0.8))
    corners = [(x, y, 0.0) for x, y in ((-1.5, -edge), (1.5, -edge), (1.5, 0.8), (-1.5, 0.8))]
    length = 2.0 * np.hypot(1.0, 1.2)
    found = ep.received_power(traced([ep.Mesh(corners, [[0, 1, 2], [0, 2, 3]])], radar)).power
    aside = np.hypot(1.0, 1.2) / np.sqrt(1.0 + 1.2**2 + 0.1**2)  # cosine between the receiver's beam and the way to the point
    at_point = np.sqrt(endless_power(radar, length)) * aside ** (0.5 * exponent)
    truth = plate_by_integral(plate, radar, length)
    assert np.sqrt(found) / at_point == pytest.approx(truth / aside ** (0.5 * exponent), abs=ONE_EDGE)


@pytest.mark.parametrize("wall_height", [0.2, 0.25, 0.3])
def test_beams_over_two_planes_see_the_edges_of_both_behind_the_other(wall_height):
    """From a ground to a wall: the beams meet both points of reflection, and die out before any edge. The wall's upper edge is
    lit by way of the ground, to whose side the transmitter's beam never looks straight."""
    transmitter, receiver = np.array([-3.0, 0.0, 1.0]), np.array([-2.0, 0.0, 1.6])
    image = receiver * [-1.0, 1.0, 1.0]                # over the wall, x = 0
    below = transmitter * [1.0, 1.0, -1.0]             # over the ground, z = 0
    line = image - below
    on_wall, on_ground = (below + share * line for share in (-below[0] / line[0], -below[2] / line[2]))
    radar = gauge(transmitter, receiver, (on_ground, on_wall), 20_000.0)
    ground = [(x, y, 0.0) for x, y in ((-4.0, -1.0), (0.0, -1.0), (0.0, 1.0), (-4.0, 1.0))]
    wall = [(0.0, y, z) for y, z in ((-1.0, 0.0), (-1.0, on_wall[2] + wall_height), (1.0, on_wall[2] + wall_height), (1.0, 0.0))]
    paths = traced([ep.Mesh(corners, [[0, 1, 2], [0, 2, 3]]) for corners in (ground, wall)], radar, max_bounces=2)
    over_both = paths.select("T 'plane 0' 'plane 1' R")
    level = ep.received_power(over_both).power / endless_power(radar, np.linalg.norm(line))
    assert 10.0 * np.log10(level) == pytest.approx(0.0, abs=LEVEL_TOLERANCE_DB)


@pytest.mark.parametrize("beyond", [0.03, 0.08])
def test_an_edge_behind_two_bounces_is_lit_by_the_image_of_the_beam(beyond):
    """From one plane to another and back, over planes 50 degrees apart, whose reflections do not commute: the third bounce, a
    little before a rim, is that of one plane before the transmitter's image, whose beam passes the first point at its side."""
    slope = np.radians(50.0)
    radar = gauge((1.4, 0.0, 0.5), (2.5, 0.0, 0.9), ((0.95, 0.15, 0.0), (1.25, 0.05, 0.0)), 400.0)
    transmitter, receiver = (np.array(one.position) for one in (radar.transmitters[0], radar.receivers[0]))

    def image(point):
        """Over the level plane, then the other one: turned about the y-axis by twice their angle."""
        turn = np.array([[np.cos(2.0 * slope), 0.0, -np.sin(2.0 * slope)], [0.0, 1.0, 0.0],
                         [np.sin(2.0 * slope), 0.0, np.cos(2.0 * slope)]])
        return turn @ point

    source = image(transmitter)
    last = source + source[2] / (source[2] + receiver[2]) * (receiver * (1.0, 1.0, -1.0) - source)
    level = [(x, y, 0.0) for x, y in ((0.0, -1.0), (last[0] + beyond, -1.0), (last[0] + beyond, 1.0), (0.0, 1.0))]
    steep = [(s * np.cos(slope), y, s * np.sin(slope)) for s, y in ((0.0, -1.0), (3.0, -1.0), (3.0, 1.0), (0.0, 1.0))]
    planes = [ep.Mesh(corners, [[0, 1, 2], [0, 2, 3]]) for corners in (level, steep)]
    thrice = traced(planes, radar, max_bounces=3).select("T 'plane 0' 'plane 1' 'plane 0' R")
    once = traced(planes[:1], gauge(source, receiver, (image((0.95, 0.15, 0.0)), (1.25, 0.05, 0.0)), 400.0))
    assert ep.received_power(thrice).power == pytest.approx(ep.received_power(once).power, rel=FOUND_AGAIN)


def test_validity_tells_of_arrays_with_unlike_beams():
    """The first antennas speak for all: the wide beam has a rim that the narrow one does not light."""
    def of_exponents(*exponents):
        antennas = [ep.Antenna(pattern=ep.CosinePower(each), pitch=-np.pi / 2) for each in exponents]
        waveform = ep.ChirpSequence(start_frequency=FREQUENCY, bandwidth=4e9, num_samples=64, num_chirps=1)
        return ep.Radar(waveform, transmitters=antennas, receivers=antennas[:1], position=(0, 0, HEIGHT))

    alike, unlike = (ep.validity(traced([disk(0.2)], of_exponents(20.0, other))) for other in (20.0, LEVEL_GAUGE))
    assert alike.beside_edges_share == 0.0
    assert unlike.beside_edges_share > 0.9
