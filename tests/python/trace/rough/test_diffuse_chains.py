"""Several diffuse bounces in a row: levels of both orders and their interference, against quadrature over the surfaces."""
import itertools
import math

import numpy as np
import pytest

import echopath as ep
from support.shapes import WAVELENGTH, lambert, make_radar, rectangle, scene_of, sphere, unit

WAVE_NUMBER = 2 * math.pi / WAVELENGTH
STANDARD_ERRORS = 3.5          # of the errors that the batches tell, themselves known to 20 %
FAMILY_ERROR = 0.04            # relative standard error
BATCHES = 16
ENHANCEMENT_TOLERANCE = 1e-6   # single precision of the weights
FRINGE_TOLERANCE = 0.01
SMALL_TARGET_ERROR = 0.03      # relative standard error; rays from the large surface alone leave 42 %


def quadrature(corner, edge_a, edge_b, count):
    """Gauss-Legendre points [count^2, 3] of a rectangle, and their areas in m^2."""
    nodes, weights = np.polynomial.legendre.leggauss(count)
    u, v = (0.5 * (1 + x).ravel() for x in np.meshgrid(nodes, nodes, indexing="ij"))
    corner, a, b = (np.asarray(value, float) for value in (corner, edge_a, edge_b))
    area = np.linalg.norm(np.cross(a, b)) * np.outer(weights, weights).ravel() / 4
    return corner + u[:, None] * a + v[:, None] * b, area


def order_powers(paths, expressions):
    """Power of each selection and its standard error in W, interference of paths left out."""
    found = []
    for expression in expressions:
        some = paths.select(expression)
        powers = np.bincount(some.batch, np.abs(some.amplitude)**2, BATCHES) * BATCHES
        found.append((powers.mean(), powers.std(ddof=1) / math.sqrt(BATCHES)))
    return found


# Two Lambert plates of 1 m in a corner with a gap of .1 m between them, seen from 5 m.
CORNER = (((0, .1, -.5), (0, 1, 0), (0, 0, 1)), ((.1, 0, -.5), (1, 0, 0), (0, 0, 1)))
AZIMUTH = math.radians(30)
TRANSMITTER = np.array((5 * math.cos(AZIMUTH), 5 * math.sin(AZIMUTH), .3))
ACROSS = np.array((-math.sin(AZIMUTH), math.cos(AZIMUTH), 0))


def corner_paths(receiver, num_rays, max_bounces=2):
    scene = scene_of(**{name: (rectangle(*plate), lambert(.5)) for name, plate in zip("ab", CORNER)})
    return ep.trace(scene, make_radar(TRANSMITTER, receiver), num_rays=num_rays, max_bounces=max_bounces, batches=BATCHES,
                    polarization="scalar")


def enhancement(paths):
    """Mean power over the sum of the powers of all paths."""
    return ep.received_power(paths).diffuse / np.sum(np.abs(paths.amplitude)**2)


@pytest.mark.parametrize("num_bounces", [2, 3])
def test_between_antennas_at_one_place_both_orders_of_a_chain_add_as_fields(num_bounces):
    paths = corner_paths(TRANSMITTER, 40000, 3).select(f"T D{{{num_bounces}}} R")
    assert paths.num_paths > 1000
    assert enhancement(paths) == pytest.approx(2.0, abs=ENHANCEMENT_TOLERANCE)


def corner_enhancement(receiver):
    """1 + mean of the interference of both orders, by quadrature over both plates."""
    (a, area_a), (b, area_b) = (quadrature(*plate, 28) for plate in CORNER)
    inner = b[None] - a[:, None]
    _, length = unit(inner)
    exchange = area_a[:, None] * area_b * np.clip(inner[..., 0], 0, None) * np.clip(-inner[..., 1], 0, None) / length**4

    def leg(point, normal_axis, antenna):
        line = antenna - point
        distance = np.linalg.norm(line, axis=1)
        return line[:, normal_axis] / distance**3, distance

    (in_a, to_a), (in_b, to_b) = leg(a, 0, TRANSMITTER), leg(b, 1, TRANSMITTER)
    (out_a, from_a), (out_b, from_b) = leg(a, 0, receiver), leg(b, 1, receiver)
    first, second = exchange * np.outer(in_a, out_b), exchange * np.outer(out_a, in_b)
    turn = WAVE_NUMBER * ((to_a - from_a)[:, None] - (to_b - from_b)[None])
    return 1 + np.sum(2 * np.sqrt(first * second) * np.cos(turn)) / np.sum(first + second)


@pytest.mark.parametrize("baseline", [.002, .004, .01])
def test_the_enhancement_fades_over_the_baseline(baseline):
    receiver = TRANSMITTER + baseline * ACROSS
    truth = corner_enhancement(receiver)
    assert truth < 1.97
    assert enhancement(corner_paths(receiver, 80000).select("T D D R")) == pytest.approx(truth, abs=FRINGE_TOLERANCE)


# A rough plate and one of a material that scatters by angle, beside a partly rough metal wall at y = 2.
PLATES = {"a": ((4.6, -.38, -.4), (.82, .36, 0), (0, 0, .8)), "b": ((5.85, .35, -.4), (.35, .9, 0), (0, 0, .8))}
MATERIALS = {"a": ep.Material(permittivity=4 - .2j, scattering=1.0),
             "b": ep.Material(permittivity=6 - .5j, roughness_height=6e-4)}
WALL_SHARE = .75               # of power that the wall reflects as a mirror
HERE, THERE = np.array((0., 0, 0)), np.array((0., -.3, .2))


def image(points):
    return points * (1, -1, 1) + (0, 4, 0)


def facet_reflection(permittivity):
    """|Gamma| of a facet that faces the wave, at normal incidence: what rough surfaces scatter with, in either mode."""
    index = np.sqrt(permittivity + 0j)
    return abs((1 - index) / (1 + index))


def reflected_diffusely(name, direction, normal):
    """Share of power |Gamma(0)|^2 S^2 of a wave that travels along `direction` [..., 3]."""
    material = MATERIALS[name]
    cosine = -direction @ normal
    share = 1 - np.exp(-(2 * WAVE_NUMBER * (material.roughness_height or 0) * cosine)**2) if name == "b" else 1.0
    return facet_reflection(material.permittivity)**2 * share


def chain_power(order, walls):
    """W between both antennas; `walls`: whether the first, the inner and the last leg run over the wall."""
    (first, area_1, n1), (last, area_2, n2) = (surface(name) for name in order)
    arrival, r1 = unit(first - (image(HERE) if walls[0] else HERE))
    departure, r2 = unit((image(THERE) if walls[2] else THERE) - last)
    leaving, r = unit((image(last) if walls[1] else last)[None] - first[:, None])
    arriving = leaving * (1, -1 if walls[1] else 1, 1)
    cosines = np.clip(leaving @ n1, 0, None) * np.clip(-arriving @ n2, 0, None)
    start = area_1 * np.clip(-arrival @ n1, 0, None) / r1**2 * reflected_diffusely(order[0], arrival, n1) / math.pi
    end = area_2 * np.clip(departure @ n2, 0, None) / r2**2 / math.pi
    between = cosines / r**2 * reflected_diffusely(order[1], arriving, n2)
    return WALL_SHARE**sum(walls) * (WAVELENGTH / (4 * math.pi))**2 * np.einsum("i,ij,j", start, between, end)


def surface(name):
    """Points, areas and the normal toward the antennas."""
    points, areas = quadrature(*PLATES[name], 12)
    normal, _ = unit(np.cross(PLATES[name][1], PLATES[name][2]))
    return points, areas, normal if normal @ (HERE - points[0]) > 0 else -normal


def families(is_flagged):
    """Orders of the plates and legs over the wall; few rays go over an unflagged one to a plate."""
    legs = [walls for walls in itertools.product((False, True), repeat=3) if is_flagged or not (walls[0] or walls[2])]
    return list(itertools.product(("ab", "ba"), legs))


@pytest.mark.parametrize("is_flagged", [True, False])
def test_chains_over_a_wall_have_the_levels_of_their_legs(is_flagged):
    metal = ep.Material(reflectivity=1.0, scattering=math.sqrt(1 - WALL_SHARE), mirror=is_flagged)
    scene = scene_of(wall=(rectangle((1.5, 2, -1.5), (5.2, 0, 0), (0, 0, 3)), metal),
                     **{name: (rectangle(*plate), MATERIALS[name]) for name, plate in PLATES.items()})
    paths = ep.trace(scene, make_radar(HERE, THERE), num_rays=400000, max_bounces=5, batches=BATCHES,
                     polarization="scalar")
    wall = lambda there: "S'wall'" if there else ""
    expressions = [f"T {wall(walls[0])} D'{order[0]}' {wall(walls[1])} D'{order[1]}' {wall(walls[2])} R"
                   for order, walls in families(is_flagged)]
    for family, (power, error) in zip(families(is_flagged), order_powers(paths, expressions)):
        truth = chain_power(*family)
        assert error < FAMILY_ERROR * truth, family
        assert power == pytest.approx(truth, abs=STANDARD_ERRORS * error), family


# A rough ball above a rough floor, which is large: few rays from there meet the ball.
BALL, BALL_RADIUS, ANTENNA = np.array((8., 0, 1.5)), .2, np.array((0., 0, 2))
FLOOR = ((4, -4, 0), (8, 0, 0), (0, 8, 0))


def floor_and_ball_power():
    """W of either order between antennas at one place, by quadrature."""
    floor, floor_area = quadrature(*FLOOR, 40)
    count = 2000
    height = 1 - (2 * np.arange(count) + 1) / count
    turn, ring = np.arange(count) * math.pi * (3 - math.sqrt(5)), np.sqrt(1 - height**2)
    normals = np.column_stack((ring * np.cos(turn), ring * np.sin(turn), height))
    ball, ball_area = BALL + BALL_RADIUS * normals, 4 * math.pi * BALL_RADIUS**2 / count
    to_floor, distance = unit(floor[:, None] - ball)
    exchange = np.clip(np.sum(to_floor * normals, axis=-1), 0, None) * np.clip(-to_floor[..., 2], 0, None) / distance**2
    from_floor, floor_leg = unit(ANTENNA - floor)
    from_ball, ball_leg = unit(ANTENNA - ball)
    at_floor = floor_area * from_floor[:, 2] / floor_leg**2
    at_ball = ball_area * np.clip(np.sum(from_ball * normals, axis=-1), 0, None) / ball_leg**2
    return (WAVELENGTH / (4 * math.pi))**2 * (.5 / math.pi)**2 * np.einsum("i,ij,j", at_floor, exchange, at_ball)


def test_the_order_that_starts_on_a_large_surface_is_known_as_well_as_the_other():
    scene = scene_of(ball=(sphere(BALL, BALL_RADIUS, 4), lambert(.5)), floor=(rectangle(*FLOOR), lambert(.5)))
    paths = ep.trace(scene, make_radar(ANTENNA), num_rays=40000, max_bounces=2, batches=BATCHES)
    truth = floor_and_ball_power()
    for power, error in order_powers(paths, ["T 'floor' 'ball' R", "T 'ball' 'floor' R"]):
        assert error < SMALL_TARGET_ERROR * truth
        assert power == pytest.approx(truth, abs=STANDARD_ERRORS * error)


def scattered(field, direction, out, permittivity):
    """A field behind a diffuse hit: |Gamma(0)|, turned as by the facet that mirrors `direction` into `out`."""
    field = facet_reflection(permittivity) * field
    facet, _ = unit(out - direction)
    return 2 * (facet @ field) * facet - field


def test_polarised_chains_take_the_coefficients_of_their_order():
    permittivities = (3 - .1j, 8 - 2j)
    materials = [ep.Material(permittivity=value, scattering=1.0) for value in permittivities]
    scene = scene_of(**{name: (rectangle(*plate), material) for name, plate, material in zip("ab", CORNER, materials)})
    receiver = TRANSMITTER + (-.2, .3, .1)
    radar = make_radar(TRANSMITTER, receiver, polarization=unit(np.array((.3, -.2, .9)))[0])
    settings = {"num_rays": 3000, "max_bounces": 2}
    polarised, scalar = (ep.trace(scene, radar, polarization=model, **settings).select("T D D R")
                         for model in ("jones", "scalar"))
    assert np.array_equal(polarised.hits[polarised.offsets], scalar.hits[scalar.offsets]) and np.any(polarised.flags & 1)
    geometry = np.abs(scalar.amplitude / scalar.weight * polarised.weight)
    points, polarization = polarised.points(0.0), radar.transmitters[0].polarization
    for path, start in enumerate(polarised.offsets[:200]):
        route = np.vstack((TRANSMITTER, points[start:start + 2], receiver))
        directions, _ = unit(np.diff(route, axis=0))
        field, _ = unit(polarization - (polarization @ directions[0]) * directions[0])
        for k, mesh in enumerate(polarised.mesh_id[start:start + 2]):
            field = scattered(field, directions[k], directions[k + 1], permittivities[mesh])
        end, _ = unit(polarization - (polarization @ directions[2]) * directions[2])
        assert abs(polarised.amplitude[path]) / geometry[path] == pytest.approx(abs(end @ field), abs=ENHANCEMENT_TOLERANCE)
