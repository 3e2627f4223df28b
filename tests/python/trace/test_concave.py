"""Echoes of dishes: concave smooth surfaces, and what they send through their foci, against integrals over the dish."""
import numpy as np
import pytest

import echopath as ep
from support.shapes import METAL, WAVELENGTH, fields, make_radar, plate, scene_of

CENTRE_TOLERANCE = 0.002   # relative, of the field: the mesh and its edges of 7 mm
FOCI_TOLERANCE = 0.02      # relative: geometrical optics between the bounces, 1/(k radius) and the corners of the plate
RIM_TOLERANCE_DB = 0.3     # 2^15 rays: 0.17 rms
WAVE_NUMBER = 2 * np.pi / WAVELENGTH
CENTRE = np.array((4.0, 0, 0))  # of the dish of radius 1 m about x = 5
HALF_ANGLE = np.radians(15)

both_models = pytest.mark.parametrize("model", ["scalar", "jones"])


def dish():
    across = np.sin(np.linspace(-HALF_ANGLE, HALF_ANGLE, 81))
    y, z = (axis.ravel() for axis in np.meshgrid(across, across))
    first = (np.arange(80)[:, None] * 81 + np.arange(80)).ravel()
    faces = np.concatenate([np.stack([first, first + 1, first + 82], 1), np.stack([first, first + 82, first + 81], 1)])
    return ep.Mesh(CENTRE + np.stack([np.sqrt(1 - y**2 - z**2), y, z], 1), faces)


@both_models
def test_a_dish_adds_up_at_its_centre(model):
    mesh = dish()
    paths = ep.trace(scene_of(dish=(mesh, METAL, True)), make_radar(CENTRE), num_rays=1 << 14, max_bounces=1,
                     polarization=model)
    # All of it is met along its normal, a metre away: -j A / (4 pi) and the phase of two metres.
    expected = -1j * mesh.area / (4 * np.pi) * np.exp(-2j * WAVE_NUMBER)
    assert abs(fields(paths).sum() / expected - 1) < CENTRE_TOLERANCE


def field_of_the_dish(transmitter, points, num=200):
    """Huygens waves of the dish at `points`, its rim faded out, which geometrical optics has not."""
    across = (np.arange(num) + 0.5) / num * 2 - 1
    fade = np.where(np.abs(across) < 0.4, 1.0, np.cos(np.pi / 1.2 * (np.abs(across) - 0.4)) ** 2)
    y, z = (axis.ravel() * np.sin(HALF_ANGLE) for axis in np.meshgrid(across, across))
    weight = np.outer(fade, fade).ravel() * (2 * np.sin(HALF_ANGLE) / num) ** 2
    depth = np.sqrt(1 - y**2 - z**2)
    normal = -np.stack([depth, y, z], 1)
    ways = CENTRE - normal - transmitter
    there = np.linalg.norm(ways, axis=1)
    strength = -1j / WAVELENGTH * weight / depth * -np.sum(ways * normal, axis=1) / there**2
    field = []
    for point in points:
        back = np.linalg.norm(CENTRE - normal - point, axis=1)
        field.append(np.sum(strength / back * np.exp(-1j * WAVE_NUMBER * (there + back))))
    return np.array(field)


@both_models
def test_a_plate_behind_both_foci_of_a_dish(model):
    # The dish focuses .56 m before itself; the plate stands .8 m behind that. All planes of incidence are nearly horizontal,
    # so that V is TE. A field turns by a quarter at each of the two caustics.
    transmitter, receiver, target = np.array((0, .6, 0)), np.array((4.3, -2, 0)), np.array((3.6, -.168, 0))
    to_dish = np.array((5.0, 0, 0)) - target
    arrival, departure = -to_dish / np.linalg.norm(to_dish), receiver - target
    departure = departure / np.linalg.norm(departure)
    facing, side = departure - arrival, 0.02
    mesh = plate(target, facing, side)
    scene = scene_of(dish=(dish(), METAL, True), plate=(mesh, METAL))
    paths = ep.trace(scene, make_radar(transmitter, receiver), num_rays=1 << 17, max_bounces=2, polarization=model)
    found = fields(paths.select("T 'dish' 'plate' R")).sum()

    grid = (np.arange(12) + 0.5) / 12
    corner, edges = mesh.vertices[0], (mesh.vertices[1] - mesh.vertices[0], mesh.vertices[3] - mesh.vertices[0])
    points = (corner + grid[:, None, None] * edges[0] + grid[None, :, None] * edges[1]).reshape(-1, 3)
    away = np.linalg.norm(receiver - points, axis=1)
    cos_incidence = -arrival @ facing / np.linalg.norm(facing)
    wave = field_of_the_dish(transmitter, points) * np.exp(-1j * WAVE_NUMBER * away) / away
    expected = -1j / (4 * np.pi) * cos_incidence * side**2 * wave.mean()
    assert abs(found / expected - 1) < FOCI_TOLERANCE


# --- Before, between and behind the foci of bent mirrors ---

RADIUS, WIDTH, SOURCE = 1.0, 0.6, 3.0   # m: mirrors about the origin that face +x, and their distance from the transmitter
SLANT = np.radians(45)                  # of incidence, in the plane z = 0
CAUSTIC_TOLERANCE = 0.03                # of the field: 1e2 rays on the plate, geometrical optics between the bounces
# 3 dB: geometrical optics knows no diffraction; 2.9 dB found over both foci of a dish
FOCUS_FACTOR = 1.4
# (bent across, bent up): focus in the plane of incidence at .40 m, across it at .93 m.
SHAPES = {"dish": (1, 1), "trough": (1, 0), "gutter": (0, 1)}


def bent(shape, y, z):
    """Points of a mirror and their normals toward +x."""
    across, up = SHAPES[shape]
    depth = np.sqrt(RADIUS**2 - across * y**2 - up * z**2)
    return np.stack([RADIUS - depth, y, z], 1), np.stack([depth, -across * y, -up * z], 1) / RADIUS


def bent_mesh(shape, num=61):
    y, z = (axis.ravel() for axis in np.meshgrid(*2 * [np.linspace(-WIDTH / 2, WIDTH / 2, num)]))
    first = (np.arange(num - 1)[:, None] * num + np.arange(num - 1)).ravel()
    corners = (first, first + 1, first + num + 1), (first, first + num + 1, first + num)
    faces = np.concatenate([np.stack(triangle, 1) for triangle in corners])
    return ep.Mesh(bent(shape, y, z)[0], faces)


def echo_over_integral(shape, distance, side=.03):
    """Field mirror -> plate -> receiver, the plate `distance` behind the mirror and turned back to the transmitter: traced
    over that of Kirchhoff's integral over the mirror, its rim faded out, at 5 x 5 Gauss points of the plate."""
    source = SOURCE * np.array((np.cos(SLANT), np.sin(SLANT), 0))
    arrival = np.array((np.cos(SLANT), -np.sin(SLANT), 0))
    target = distance * arrival
    facing = (source - target) / np.linalg.norm(source - target) - arrival
    mesh = plate(target, facing, side)
    scene = scene_of(mirror=(bent_mesh(shape), METAL, True), plate=(mesh, METAL))
    paths = ep.trace(scene, make_radar(source), num_rays=1 << 17, max_bounces=2).select("T 'mirror' 'plate' R")
    found = fields(paths)[paths.flags & 1 == 0].sum()  # the others are reversals

    steps = (np.arange(240) + .5) / 240 * 2 - 1
    fade = np.where(np.abs(steps) < .7, 1, np.cos(np.pi / .6 * (np.abs(steps) - .7)) ** 2)
    y, z = (axis.ravel() * WIDTH / 2 for axis in np.meshgrid(steps, steps))
    points, normals = bent(shape, y, z)
    there = np.linalg.norm(source - points, axis=1)
    cosine = np.sum((source - points) * normals, axis=1) / there
    strength = np.outer(fade, fade).ravel() * (WIDTH / 240) ** 2 / normals[:, 0] * np.exp(-1j * WAVE_NUMBER * there) / there
    knots, weights = np.polynomial.legendre.leggauss(5)
    edges = mesh.vertices[1] - mesh.vertices[0], mesh.vertices[3] - mesh.vertices[0]
    expected = 0
    for a, b in np.ndindex(5, 5):
        point = target + knots[a] / 2 * edges[0] + knots[b] / 2 * edges[1]
        line = point - points
        back, away = np.linalg.norm(line, axis=1), np.linalg.norm(source - point)
        kirchhoff = .5 * (cosine + np.sum(line * normals, axis=1) / back) / back
        wave = -1j / WAVELENGTH * np.sum(strength * kirchhoff * np.exp(-1j * WAVE_NUMBER * back))
        expected += weights[a] * weights[b] / 4 * wave * np.exp(-1j * WAVE_NUMBER * away) / away
    return found / (-1j / (4 * np.pi) * -arrival @ facing / np.linalg.norm(facing) * side**2 * expected)


@pytest.mark.parametrize("shape, distance", [("trough", .15), ("trough", .8), ("gutter", .5), ("gutter", 1.6),
                                             ("dish", .15), ("dish", .62), ("dish", 1.6)])
def test_each_caustic_turns_a_field_by_a_quarter(shape, distance):
    assert abs(echo_over_integral(shape, distance) - 1) < CAUSTIC_TOLERANCE


@pytest.mark.hard
@pytest.mark.parametrize("shape, distance", [("trough", .4), ("dish", .4), ("dish", .93)])
def test_the_echo_at_a_focus_is_rough_but_finite(shape, distance):
    assert 1 / FOCUS_FACTOR < abs(echo_over_integral(shape, distance)) < FOCUS_FACTOR


# --- The rim of a dish ---

def cap_rcs(radius, aperture):
    """Physical optics of a dish far off on its axis: the integral over its depth x, in which its area grows as
    (radius - x)."""
    depth, turn = radius - np.sqrt(radius**2 - aperture**2), 2j * WAVE_NUMBER

    def antiderivative(x):
        return np.exp(turn * x) * ((radius - x) / turn + 1 / turn**2)

    return 4 * np.pi / WAVELENGTH**2 * abs(2 * np.pi * (antiderivative(depth) - antiderivative(0))) ** 2


def round_dish(radius, aperture, rings=40, sides=240):
    """A cap about the origin that faces +x."""
    distance, turn = np.meshgrid(np.arange(1, rings + 1) / rings * aperture, np.arange(sides) * 2 * np.pi / sides,
                                 indexing="ij")
    y, z = np.append(0, distance * np.cos(turn)), np.append(0, distance * np.sin(turn))
    ring = 1 + np.arange(sides)
    following = np.roll(ring, -1)
    faces = [np.stack([np.zeros(sides, int), ring, following], 1)]
    for inner in range(0, (rings - 1) * sides, sides):
        outer = inner + sides
        faces += [np.stack([inner + ring, outer + ring, outer + following], 1),
                  np.stack([inner + ring, outer + following, inner + following], 1)]
    return ep.Mesh(np.stack([radius - np.sqrt(radius**2 - y**2 - z**2), y, z], 1), np.concatenate(faces))


def test_the_filter_for_edges_keeps_the_rim_of_a_dish():
    # Seen along its axis the whole rim is in phase, as strong as the middle.
    scene = scene_of(dish=(round_dish(1.0, .2), METAL, True))
    expected = 10 * np.log10(cap_rcs(1.0, .2))

    def error_db(footprint):
        found = [ep.rcs(scene, frequency=77e9, incidence=(1, 0, 0), num_rays=1 << 15, footprint=footprint, max_bounces=1,
                        seed=seed) for seed in range(4)]
        return np.abs(10 * np.log10(np.ravel(found)) - expected).max()

    assert error_db("edges") < RIM_TOLERANCE_DB
    assert error_db("second_order") > 1.0  # what it is for
