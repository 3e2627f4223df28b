"""Images on planes that nobody marked: one path in place of what rays would add up, and none where the plane is too small."""
import warnings

import numpy as np
import pytest
from scipy import special

import echopath as ep
from echopath.bench.worlds import city as worlds

NO_STRATUM = 65535
WEIGHT_TOLERANCE = 1e-6      # relative: single precision
DELAY_TOLERANCE = 1e-12      # s
LEVEL_TOLERANCE_DB = 0.01
FAR, FADES = 40.0, 8.0       # half zones, where an edge is none, and from where it fades
STEP = 0.02                  # half zones between places of a sum
RAISED = ((0, 0, 10), (0, 0.05, 10))
CONCRETE = ep.Material(permittivity=5.2 - 0.3j)


def radar(transmitter=(0, 0, 1.5), receiver=(0, 0.2, 1.5), frequency=77e9):
    waveform = ep.ChirpSequence(start_frequency=frequency, num_chirps=1)
    return ep.Radar(waveform, transmitters=[ep.Antenna(transmitter)], receivers=[ep.Antenna(receiver)])


def box(size, center):
    """Six sides, one mesh."""
    corners = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]) * size + center
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return ep.Mesh(corners, [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])


RADAR = radar()


def traced(mesh, at=RADAR, *, material=CONCRETE, num_rays=30_000, max_bounces=2, **more):
    scene = ep.Scene()
    scene.add(mesh, name="building", material=material)
    return ep.trace(scene, at, num_rays=num_rays, max_bounces=max_bounces, **more)


def images(paths):
    return np.flatnonzero(np.asarray(paths.stratum) == NO_STRATUM)


def test_a_building_has_the_echo_of_its_wall_s_image():
    paths = traced(box((8.0, 10.0, 9.0), (14.1, 0.3, 1.6)), polarization="scalar")  # its edges are 31 half zones away and more
    (one,) = images(paths)
    length = np.hypot(2 * 10.1, 0.2)
    assert paths.lengths([paths.frame.trace_time], 0, 0)[0][one] == pytest.approx(length, abs=1e-9)
    index = np.sqrt(5.2 - 0.3j)
    reflection = abs((index - 1) / (index + 1))  # the angle of incidence is 0.6 degrees
    expected = ep.speed_of_light / 77e9 * np.sqrt(paths.radar.transmit_power) * reflection / (4 * np.pi * length)
    assert abs(paths.amplitude[one]) == pytest.approx(expected, rel=1e-4)
    assert not np.any((np.asarray(paths.diffuse) == 0) & (np.asarray(paths.stratum) != NO_STRATUM))


def beside_edges(within, *, turn=0.0, antennas=((0, 0, 10), (0, 0.05, 10)), across=FAR, material="metal"):
    """The field over that of an endless metal plane, of a plane z = 0 whose edge passes `within` half zones beside the point of
    reflection, turned by an angle in rad from the plane of incidence, and one across it by `across`; the number of images; and
    `within` by the length of the shortest way over the edge."""
    transmitter, receiver = np.array(antennas, float)
    point = (receiver[2] * transmitter + transmitter[2] * receiver) / (transmitter[2] + receiver[2]) * [1, 1, 0]
    before, behind = np.linalg.norm(point - transmitter), np.linalg.norm(point - receiver)
    half = np.sqrt(ep.speed_of_light / 77e9 * before * behind / (before + behind))
    slant = (point - transmitter) * [1, 1, 0]
    along = slant / np.linalg.norm(slant) if np.any(slant) else np.array([1.0, 0.0, 0.0])
    axes = half * np.array([along * before / transmitter[2], np.cross([0, 0, 1], along)])
    out = np.array([np.cos(turn), np.sin(turn)])
    aside = np.array([-out[1], out[0]])
    corners = [a * out + b * aside for a, b in ((within, -FAR), (within, across), (-FAR, across), (-FAR, -FAR))]
    scene = ep.Scene()
    scene.add(ep.Mesh(point + corners @ axes, [[0, 1, 2], [0, 2, 3]]), name="plane", material=material)
    paths = ep.trace(scene, radar(*antennas), num_rays=30_000, max_bounces=1, polarization="scalar")
    wavelength = ep.speed_of_light / 77e9
    endless = wavelength / (4 * np.pi * (before + behind))
    edge = point + (within * out + np.linspace(-FAR, FAR, 20_001)[:, np.newaxis] * aside) @ axes
    ways = np.linalg.norm(edge - transmitter, axis=1) + np.linalg.norm(edge - receiver, axis=1)
    detour = ways.min() - before - behind
    field = np.sqrt(ep.received_power(paths).power / paths.radar.transmit_power) / endless
    return field, len(images(paths)), np.copysign(np.sqrt(max(2.0 * detour / wavelength, 0.0)), within)


def behind_an_edge(within):
    """The field so many half zones inside the shadow of a half plane, over that without it: Born and Wolf, 8.7."""
    sine, cosine = special.fresnel(np.sqrt(2.0) * within)
    return abs(0.5 + cosine - 1j * (0.5 + sine)) / np.sqrt(2.0)


@pytest.mark.parametrize("turn", [0.0, 0.4, 2.0])
@pytest.mark.parametrize("antennas", [((0, 0, 10), (0, 0.05, 10)), ((-6, 0, 4), (5, 1, 3))])
def test_the_edge_of_a_plane_takes_its_part_of_the_field_whether_images_or_rays_carry_it(antennas, turn):
    """Geometrical optics would be 5.8 dB too strong on the plane, and nothing beside it."""
    for within in (-0.3, -0.05, 0.02, 0.1, 0.3, 0.6, 0.9, 1.2, 1.6, 3.0, 6.0):
        field, by_images, by_detour = beside_edges(within, turn=turn, antennas=antennas)
        assert by_images == (within > 0.0)
        tolerance_db = 0.2 if within > 0.0 else 0.5  # rays sample the plane
        assert 20.0 * np.log10(field / behind_an_edge(by_detour)) == pytest.approx(0.0, abs=tolerance_db)


def test_the_corner_of_a_plane_leaves_a_quarter_and_far_edges_leave_all():
    assert beside_edges(1e-3, across=1e-3)[0] == pytest.approx(0.25, abs=0.01)
    assert beside_edges(FAR / 2, across=FAR / 2)[0] == pytest.approx(1.0, abs=WEIGHT_TOLERANCE)


@pytest.mark.parametrize("turn", [0.0, 0.4])
def test_beside_a_corner_each_edge_takes_its_part(turn):
    """The quadratic phase of a right-angled corner is the product of those of its edges."""
    for one in (0.1, 0.5, 1.3, 2.5):
        for other in (0.3, 1.0, 1.6):
            field, *_ = beside_edges(one, across=other, turn=turn)
            truth = behind_an_edge(one) * behind_an_edge(other)
            assert 20.0 * np.log10(field / truth) == pytest.approx(0.0, abs=0.5)


def head_on(size, distance):
    """The echo in W of a metal plate, which faces the radar, by Kirchhoff's integral: Gauss-Legendre over the plate."""
    wavelength = ep.speed_of_light / 77e9
    places, weights = np.polynomial.legendre.leggauss(250)
    squares = (places * size / 2.0) ** 2
    lengths = np.sqrt(distance**2 + squares[:, np.newaxis] + squares)
    integral = np.outer(weights, weights) * distance / lengths**3 * np.exp(-4j * np.pi / wavelength * lengths)
    return RADAR.transmit_power * abs(integral.sum() * size**2 / 4.0 / (4.0 * np.pi)) ** 2


@pytest.mark.parametrize(("size", "distance"), [(0.3, at) for at in (40, 12, 10, 8, 6, 5, 3, 2, 1)] + [(0.5, 12), (0.5, 9)])
def test_a_plate_near_by_has_the_lobes_of_its_near_field(size, distance):
    """From 0.5 to 3.4 half zones from the middle to the edges, all four of which add up. An endless plane would have -3.9 to
    +5.1 dB beside it."""
    scene = ep.Scene()
    scene.add(ep.actors.plate(size, size), name="plate", material="metal", position=(distance, 0, 0))
    paths = ep.trace(scene, radar((0, 0, 0), (0, 0, 0)), num_rays=20_000)
    assert 10.0 * np.log10(ep.received_power(paths).power / head_on(size, distance)) == pytest.approx(0.0, abs=0.15)


@pytest.mark.parametrize("within", [0.0, 1e-6, 1e-4, 1e-3])
def test_a_point_at_the_very_edge_has_half_of_the_field_once(within):
    """Half zones of 14 cm: up to 0.1 micrometre, where either side of the edge has its share of the path."""
    assert beside_edges(within)[0] == pytest.approx(0.5, abs=0.02)


def test_the_seam_of_two_meshes_in_one_plane_is_no_edge():
    """The point of reflection lies on it, to rounding or to the micrometre."""
    for aside in (0.0, 1e-6, 1e-3):
        scene = ep.Scene()
        for name, side in (("left", 1.0), ("right", -1.0)):
            corners = np.array([[-6, 0, 0], [6, 0, 0], [6, 6 * side, 0], [-6, 6 * side, 0]])[::int(side)] + [0.0, aside, 0.0]
            scene.add(ep.Mesh(corners, [[0, 1, 2], [0, 2, 3]]), name=name, material="metal")
        paths = ep.trace(scene, radar((0, 0, 10), (0.05, 0, 10)), num_rays=30_000, max_bounces=1, polarization="scalar")
        assert np.abs(paths.weight[images(paths)]) == pytest.approx([1.0], rel=WEIGHT_TOLERANCE)


def disk_head_on(radius, distance):
    """The echo in W of a metal disk, which faces the radar, by Kirchhoff's integral: Gauss-Legendre over the lengths to it."""
    wavelength = ep.speed_of_light / 77e9
    nodes, weights = np.polynomial.legendre.leggauss(200)
    half = 0.5 * (np.hypot(distance, radius) - distance)
    lengths = distance + half * (nodes + 1.0)
    integral = np.sum(half * weights * distance / lengths**2 * np.exp(-4j * np.pi / wavelength * lengths))
    return RADAR.transmit_power * abs(0.5 * integral) ** 2


@pytest.mark.parametrize("distance", [11.0, 8.0, 6.5, 5.0, 4.2, 3.0])
def test_the_interval_of_a_disk_near_by_holds_its_echo(distance):
    """From 0.9 to 1.7 half zones from the middle to the rim, where the echo goes from four times that of an endless plane down to
    a 46th of it: the interval is one of that plane's field, so that it is wide where little is left."""
    angles = np.arange(96) * 2.0 * np.pi / 96
    rim = 0.15 * np.stack([0.0 * angles, np.cos(angles), np.sin(angles)], axis=1) + [distance, 0.0, 0.0]
    scene = ep.Scene()
    scene.add(ep.Mesh(rim, [[0, k + 1, k] for k in range(1, 95)]), name="disk", material="metal")
    found = ep.received_power(ep.trace(scene, radar((0, 0, 0), (0, 0, 0)), num_rays=30_000, polarization="scalar"))
    truth = disk_head_on(0.15, distance)
    assert found.low <= truth <= found.high
    endless = RADAR.transmit_power * (ep.speed_of_light / 77e9 / (8.0 * np.pi * distance)) ** 2
    assert np.sqrt(found.high / endless) - np.sqrt(found.power / endless) == pytest.approx(0.03, abs=0.012)


def test_an_echo_beside_an_edge_has_an_interval_and_that_away_from_edges_has_none():
    for within, widest in ((3.0, 0.5), (20.0, 1e-6)):
        scene = ep.Scene()
        corners = np.array([[within * 0.14, -6, 0], [within * 0.14, 6, 0], [-6, 6, 0], [-6, -6, 0]])
        scene.add(ep.Mesh(corners, [[0, 1, 2], [0, 2, 3]]), name="plane", material="metal")
        paths = ep.trace(scene, radar((0, 0, 10), (0, 0.05, 10)), num_rays=30_000, max_bounces=1, polarization="scalar")
        found = ep.received_power(paths)
        width = 10.0 * np.log10(found.high / found.low)
        assert 0.5 * widest <= width <= 2.0 * widest or width == widest == 0.0 or within == 20.0 and width <= widest


def bent_plane(within, bend):
    """The field over that of an endless level metal plane, of one that goes down by `bend` rad from `within` half zones beside
    the point below `RAISED` on: that of the trace, of images and rays, and Kirchhoff's integral by a sum, faded as edges are."""
    half = np.sqrt(ep.speed_of_light / 77e9 * RAISED[0][2] / 2.0)
    foot, down = half * np.array([within, 0.0, 0.0]), half * np.array([np.cos(bend), 0.0, -np.sin(bend)])
    level, aside = half * np.array([1.0, 0.0, 0.0]), half * np.array([0.0, 1.0, 0.0])
    planes = [np.array([foot + a * away + b * aside for a, b in ((0, -FAR), (FAR, -FAR), (FAR, FAR), (0, FAR))])
              for away in (-level, down)]
    beside = np.arange(-2.0 * FADES, 2.0 * FADES, STEP) + STEP / 2.0  # half zones
    whole = 0.0
    for away, normal in ((-level, (0, 0, 1)), (down, (np.sin(bend), 0, np.cos(bend)))):
        places = foot + (np.arange(0.0, 2.0 * FADES + within, STEP) + STEP / 2.0)[:, np.newaxis] * away
        ways = [place - places for place in np.array(RAISED, float)]  # but for y, along which `beside` goes
        one, two = (np.sqrt(way[:, 0, np.newaxis] ** 2 + way[:, 2, np.newaxis] ** 2 + (place[1] - half * beside) ** 2)
                    for place, way in zip(RAISED, ways))
        above, over = (way @ np.array(normal)[:, np.newaxis] for way in ways)
        slant = (above / one + over / two) / 2.0
        kept = np.outer(faded(places[:, 0] / half), faded(beside))
        whole += np.sum(kept * slant / (one * two) * np.exp(-2j * np.pi * 77e9 / ep.speed_of_light * (one + two)))
    endless = 2.0 * RAISED[0][2]
    return over_endless(planes), abs(whole) * (STEP * half) ** 2 * 77e9 / ep.speed_of_light * endless


def faded(places):
    return 0.5 + 0.5 * np.cos(np.pi * np.clip(np.abs(places) / FADES - 1.0, 0.0, 1.0))


def over_endless(planes):
    """The field of metal rectangles, all paths together, over that of an endless plane below `RAISED`."""
    scene = ep.Scene()
    for index, corners in enumerate(planes):
        outside_up = corners if np.cross(corners[1] - corners[0], corners[3] - corners[0])[2] > 0.0 else corners[::-1]
        scene.add(ep.Mesh(outside_up, [[0, 1, 2], [0, 2, 3]]), name=f"plane {index}", material="metal")
    at = radar(*RAISED)
    paths = ep.trace(scene, at, num_rays=50_000, max_bounces=1, polarization="scalar")
    endless = ep.speed_of_light / 77e9 / (4.0 * np.pi * 2.0 * RAISED[0][2]) * np.sqrt(at.transmit_power)
    return abs(np.asarray(ep.synthesize(paths, at))[0, 0, 0, 0]) / endless


@pytest.mark.parametrize("bend", np.radians([0.5, 2.0, 20.0, -0.5, -5.0]))
@pytest.mark.parametrize("within", [0.4, 1.0, 2.0])
def test_a_plane_ends_where_it_bends_and_what_is_behind_has_its_own_echo(within, bend):
    """A field that went on over the bend was up to 2.3 dB off."""
    found, truth = bent_plane(within, bend)
    assert found == pytest.approx(truth, abs=0.06)


def test_a_plane_marked_as_a_mirror_has_no_edges():
    marked = ep.Material.metal(mirror=True)
    assert beside_edges(0.02, material=marked)[0] == pytest.approx(1.0, abs=WEIGHT_TOLERANCE)


def test_a_wall_that_rises_from_a_plane_is_no_edge_of_it():
    """The image in the wall takes the place of the plane beyond: a half zone of 14 cm, and the wall 2 cm from the point."""
    scene = ep.Scene()
    for name, corner, up in (("floor", (0.02, -4, 0), (-8, 0, 0)), ("wall", (0.02, -4, 0), (0, 0, 12))):
        corners = np.array([corner, np.add(corner, up), np.add(corner, up) + [0, 8, 0], np.add(corner, [0, 8, 0])])
        scene.add(ep.Mesh(corners, [[0, 1, 2], [0, 2, 3]]), name=name, material="metal")
    paths = ep.trace(scene, radar((0, 0, 10), (0, 0.05, 10)), num_rays=30_000, max_bounces=1, polarization="scalar")
    weights = np.abs(np.asarray(paths.weight)[images(paths)])
    assert weights == pytest.approx(np.ones(2), rel=WEIGHT_TOLERANCE)


def test_marking_the_building_changes_nothing_between_the_antennas():
    shape = box((8.0, 10.0, 9.0), (14.1, 0.3, 1.6))
    found, marked = (traced(shape, material=CONCRETE.replace(mirror=mirror), polarization="jones") for mirror in (False, True))
    assert found.amplitude[images(found)] == pytest.approx(marked.amplitude[images(marked)], rel=WEIGHT_TOLERANCE)


def test_a_box_below_its_zone_has_no_image():
    paths = traced(box((0.2, 0.2, 0.2), (10.1, 0.0, 1.5)))
    assert len(images(paths)) == 0 and paths.num_paths > 100


def test_a_wall_seen_askew_has_no_image_and_keeps_its_echoes():
    away = traced(box((8.0, 4.0, 9.0), (14.1, 6.0, 4.6)))  # its point of reflection lies beside it
    assert len(images(away)) == 0 and np.any(np.asarray(away.diffuse) == 0)


@pytest.mark.parametrize("depth", [0.03, 0.1])
def test_a_corner_counts_once(depth):
    """Two walls at right angles: the image in their common edge, whichever order it has."""
    scene = ep.Scene()
    corner = ep.Mesh([[12, -6, -4], [18, 0, -4], [12, 6, -4], [12, -6, 4], [18, 0, 4], [12, 6, 4]],
                     [[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4]])
    scene.add(corner, name="corner", material="metal")
    paths = ep.trace(scene, radar((0, depth, 0), (0, -0.5 * depth, 0)), num_rays=60_000, max_bounces=2, polarization="scalar")
    lengths = np.asarray(paths.lengths([paths.frame.trace_time], 0, 0))[0]
    double = (np.asarray(paths.num_bounces) == 2) & (np.asarray(paths.diffuse) == 0)
    wavenumber = 2 * np.pi * 77e9 / ep.speed_of_light
    field = np.sum(np.asarray(paths.amplitude)[double] * np.exp(-1j * wavenumber * lengths[double]))
    unfolded = np.hypot(36.0, 0.5 * depth)
    expected = ep.speed_of_light / 77e9 * np.sqrt(paths.radar.transmit_power) / (4 * np.pi * unfolded)
    assert 20 * np.log10(abs(field) / expected) == pytest.approx(0.0, abs=0.1)


GROUND = [(-40, -40, 0), (15, -40, 0), (15, 7, 0), (-40, 7, 0)]
WALLS = {"long": [(15, -13, 0), (15, 7, 0), (15, 7, 9), (15, -13, 9)], "short": [(5, 7, 0), (15, 7, 0), (15, 7, 9), (5, 7, 9)]}


def echo_of_corner(num_bounces, transmitter, receiver, *, one_mesh):
    """The field of what bounces so often where a ground and two walls of metal meet, at right angles, over that of the image in
    endless ones, and the number of images in it. Of fewer than three bounces it is over the ground and the long wall."""
    corner = np.array([15.0, 7.0 if num_bounces == 3 else 0.5 * (transmitter[1] + receiver[1]), 0.0])
    faces = {"ground": GROUND, **WALLS}
    scene = ep.Scene()
    if one_mesh:
        triangles = np.concatenate([[[4 * k, 4 * k + 1, 4 * k + 2], [4 * k, 4 * k + 2, 4 * k + 3]] for k in range(3)])
        scene.add(ep.Mesh(np.concatenate(list(faces.values())), triangles), name="corner", material="metal")
    else:
        for name, corners in faces.items():
            scene.add(ep.Mesh(corners, [[0, 1, 2], [0, 2, 3]]), name=name, material="metal")
    paths = ep.trace(scene, radar(transmitter, receiver), num_rays=25_000, max_bounces=num_bounces, polarization="scalar")
    image = np.array(receiver) * [-1, -1 if num_bounces == 3 else 1, -1] + [30.0, 14.0 if num_bounces == 3 else 0.0, 0.0]
    unfolded = np.linalg.norm(image - transmitter)
    lengths = np.asarray(paths.lengths([paths.frame.trace_time], 0, 0))[0]
    found = (np.asarray(paths.num_bounces) == num_bounces) & (np.abs(lengths - 2.0 * np.linalg.norm(corner - transmitter)) < 0.15)
    wavenumber = 2 * np.pi * 77e9 / ep.speed_of_light
    field = np.sum(np.asarray(paths.amplitude)[found] * np.exp(-1j * wavenumber * lengths[found]))
    by_images = np.count_nonzero(np.asarray(paths.stratum)[found] == NO_STRATUM)
    return abs(field) * 4 * np.pi * unfolded / (ep.speed_of_light / 77e9 * np.sqrt(paths.radar.transmit_power)), by_images


@pytest.mark.parametrize("one_mesh", [False, True])
@pytest.mark.parametrize("num_bounces", [2, 3])
def test_an_antenna_sees_itself_in_a_corner(num_bounces, one_mesh):
    """The bounces are at one point of the edge, where both orders have half of the path: rays alone were up to 4 dB off."""
    for place in ((4.554, -4.493, 0.561), (9.75, 2.882, 1.667), (1.0, -3.0, 1.5)):
        field, by_images = echo_of_corner(num_bounces, place, place, one_mesh=one_mesh)
        assert by_images == 2 and field == pytest.approx(1.0, abs=1e-3)


@pytest.mark.parametrize("place, beside", [
    ((4.1, 1.5, 1.3), (-0.06, -0.03, 0.001)),    # the short wall is no longer than the antenna is away from the long one
    ((4.2, -3.0, 2.0), (-0.05, -0.025, 0.007)),  # next to no ray has the order of the path
    ((2.0, 3.5, 1.9), (0.07, -0.06, 0.04))])
def test_antennas_beside_each_other_see_one_image_in_a_corner_of_three_planes(place, beside):
    field, by_images = echo_of_corner(3, place, tuple(np.add(place, beside)), one_mesh=False)
    assert by_images == 1 and field == pytest.approx(1.0, abs=1e-3)


def echo_of_road_and_wall(ends, begins):
    """The mean field over 1 GHz of both orders of a road up to x = `ends` and a wall at x = 15 m from z = `begins` on, over that
    of the image in their corner, and how many paths have the order that the image has not. Half zones are of 15 cm."""
    scene = ep.Scene()
    scene.add(ep.Mesh([(-40, -40, 0), (ends, -40, 0), (ends, 40, 0), (-40, 40, 0)], [[0, 1, 2], [0, 2, 3]]), name="road",
              material="metal")
    scene.add(ep.Mesh([(15, -30, begins), (15, 30, begins), (15, 30, 9), (15, -30, 9)], [[0, 1, 2], [0, 2, 3]]), name="wall",
              material="metal")
    antennas = np.array([[3.0, 1.0, 1.2], [3.0, 1.1, 1.27]])
    paths = ep.trace(scene, radar(*antennas), num_rays=50_000, max_bounces=2, polarization="scalar").select("T . . R")
    lengths = np.asarray(paths.lengths([paths.frame.trace_time], 0, 0))[0]
    wavelength = ep.speed_of_light / 77e9
    wavenumbers = 2.0 * np.pi * (77e9 + np.linspace(0.0, 1e9, 41)) / ep.speed_of_light
    fields = np.exp(-1j * np.outer(wavenumbers, lengths)) @ np.asarray(paths.amplitude)
    unfolded = np.linalg.norm(antennas[0] - antennas[1] * [-1, 1, -1] - [30, 0, 0])
    endless = wavelength * np.sqrt(paths.radar.transmit_power) / (4 * np.pi * unfolded)
    others = min(paths.select(f"T '{one}' '{two}' R").num_paths for one, two in (("road", "wall"), ("wall", "road")))
    return 20.0 * np.log10(np.sqrt(np.mean(np.abs(fields) ** 2)) / endless), others


@pytest.mark.parametrize("ends, begins", [(15.0, 0.0), (15.0, 0.001), (14.999, 0.0)])
def test_a_crack_of_a_millimetre_between_a_road_and_a_wall_takes_nothing(ends, begins):
    """Half of the field had been lost to it."""
    level, others = echo_of_road_and_wall(ends, begins)
    assert level == pytest.approx(0.0, abs=LEVEL_TOLERANCE_DB) and others == 0


@pytest.mark.parametrize("ends, begins, strip", [(15.0, 0.004, 0.004), (14.99, 0.0, 0.001)])
def test_beside_wider_cracks_both_orders_have_their_part(ends, begins, strip):
    """The image has one edge there, and rays of the other order bring what is beyond. Both orders lack the strip, in m as the
    antennas see it: without exp(-j pi x^2) over as much about x = 0 in half zones, whose integral is (1 - j) / sqrt(2)."""
    level, others = echo_of_road_and_wall(ends, begins)
    assert others > 0
    truth = 20.0 * np.log10(abs(1.0 - 2.0 * strip / 0.153 * np.exp(0.25j * np.pi)))
    assert level == pytest.approx(truth, abs=0.5)  # rays sample their part


def wedge_on_a_floor(half_deg):
    """Two metal walls of 6 x 8 m that meet on the z axis, open toward +x by twice the angle, and a floor at z = -0.3 m."""
    scene = ep.Scene()
    ends = [6.0 * np.array([np.cos(angle), np.sin(angle), 0.0]) for angle in np.radians([half_deg, -half_deg])]
    for index, end in enumerate(ends):
        low, up = np.array([0.0, 0.0, -4.0]), np.array([0.0, 0.0, 8.0])
        scene.add(ep.Mesh([low, low + end, low + end + up, low + up], [[0, 1, 2], [0, 2, 3]]), name=f"wall_{index}",
                  material="metal")
    scene.add(ep.Mesh(np.array([[0, 0, 0], *ends]) - [0, 0, 0.3], [[0, 1, 2]]), name="floor", material="metal")
    return scene


def test_a_corner_of_five_bounces_counts_once():
    """Four bounces between the walls and one on the floor, whichever order they have."""
    antennas = radar((4.5, 0.03, 0.05), (4.5, -0.012, 0.03))
    paths = ep.trace(wedge_on_a_floor(22.5), antennas, num_rays=30_000, max_bounces=5, polarization="scalar")
    lengths = np.asarray(paths.lengths([paths.frame.trace_time], 0, 0))[0]
    five = (np.asarray(paths.num_bounces) == 5) & (np.asarray(paths.diffuse) == 0)
    wavenumber = 2 * np.pi * 77e9 / ep.speed_of_light
    field = np.sum(np.asarray(paths.amplitude)[five] * np.exp(-1j * wavenumber * lengths[five]))
    # Four bounces in a wedge of 45 degrees turn the receiver by 180 degrees about its edge, the floor mirrors it.
    unfolded = np.linalg.norm(np.array([4.5, 0.03, 0.05]) - [-4.5, 0.012, -0.63])
    expected = ep.speed_of_light / 77e9 * np.sqrt(paths.radar.transmit_power) / (4 * np.pi * unfolded)
    assert 20 * np.log10(abs(field) / expected) == pytest.approx(0.0, abs=0.05)


def test_a_path_by_image_is_replayed_and_saved(tmp_path):
    paths = traced(box((8.0, 10.0, 9.0), (14.1, 0.3, 4.6)))
    cube = ep.synthesize(paths, paths.radar)
    frame = tmp_path / "paths.h5"
    paths.save(frame)
    assert np.array_equal(ep.synthesize(ep.Paths.load(frame), paths.radar), cube)
    assert ep.received_power(paths).power > 0
    ep.validity(paths, paths.radar)


def test_one_warning_tells_of_many_coarse_meshes():
    scene = ep.Scene()
    for index in range(5):
        scene.add(ep.actors.sphere(0.1 + 0.01 * index, subdivisions=4), name=f"ball_{index}", material="metal",
                  position=(5, index, 0))
        scene.add(ep.actors.sphere(0.2, subdivisions=4), name=f"copy_{index}", material="metal", position=(5, index, 2))
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        ep.trace(scene, radar(), num_rays=10, max_bounces=1)
    (text,) = [str(one.message) for one in caught if issubclass(one.category, ep.TessellationWarning)]
    assert text.startswith("10 meshes") and "ball_4" in text and text.count("copy_") == 1


def test_the_benchmark_of_worlds_finds_all_paths():
    rows = worlds.rows(quick=True)
    unmarked, marked, many = rows
    for row in (unmarked, marked):
        assert row["paths"] > 0 and row["delay_error_s"] < DELAY_TOLERANCE
        assert row["level_error_db"] < (LEVEL_TOLERANCE_DB if row is marked else 0.15)  # edges change levels by up to 0.9 dB
        assert row["missing"] == row["beside"] == 0
    assert many["meshes"] == worlds.QUICK_MESHES
    assert len(worlds.describe(rows)) == 3
