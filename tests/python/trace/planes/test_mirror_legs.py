"""Legs over up to two flagged mirrors, and paths over mirrors alone, against image theory at 77 GHz."""
import itertools
import math

import numpy as np
import pytest

import echopath as ep
from support.shapes import (
    METAL,
    WAVELENGTH,
    decibel,
    fields,
    lambert,
    make_radar,
    plate,
    power_by_hit,
    rectangle,
    scene_of,
    sphere,
)

IMAGE_TOLERANCE_DB = 0.1     # promised; what is left is the quadrature over the target
PO_TOLERANCE_DB = 0.3        # physical optics with the footprint filter against its bare quadrature
SPHERE_TOLERANCE = 0.03       # of the field of a sphere: other rays, and an angle that differs over it
FIELD_TOLERANCE = 1e-6       # relative: single precision of the weight
CLUTTER_TOLERANCE = 0.01     # relative, Monte-Carlo error of 2e5 rays
HIDDEN_TOLERANCE = 0.08      # likewise, of 900 hits

MIRROR = ep.Material.metal(mirror=True)
ANTENNA = np.array((0.0, 0.0, 1.0))
# The antenna and its images in a metal corner, wall at y = 3 and ground at z = 0, by number of mirrors; the coefficient is
# -1 for each. Planes at right angles have one image for both orders.
IMAGES = [(0, ANTENNA), (1, ANTENNA * (1, 1, -1)), (1, ANTENNA + (0, 6, 0)), (2, ANTENNA * (1, 1, -1) + (0, 6, 0))]
LONGEST = 5                  # bounces of a path over two mirrors on both legs


def corner(**target):
    return scene_of(ground=(rectangle((-50, -50, 0), (200, 0, 0), (0, 53, 0)), MIRROR),
                    wall=(rectangle((-50, 3, 0), (200, 0, 0), (0, 0, 100)), MIRROR), **target)


def echo_over_direct(points, normal, max_bounces):
    """Mean power of points [N, 3] of rough surface over all pairs of legs of the corner, over the direct one."""
    leg, k = [], 2 * math.pi / WAVELENGTH
    for mirrors, image in IMAGES:
        line = image - points
        length = np.linalg.norm(line, axis=1)
        leg.append((mirrors, (-1) ** mirrors * np.sqrt(line @ normal / length) / length * np.exp(-1j * k * length)))
    pairs = [first * second for (m, first), (n, second) in itertools.product(leg, leg) if m + 1 + n <= max_bounces]
    return np.sum(np.abs(sum(pairs)) ** 2) / np.sum(np.abs(leg[0][1]) ** 4)


def patch_in_corner(centre, side, max_bounces, **more):
    """Traced and expected echo over the direct one, in dB. more: objects that change nothing"""
    scene = corner(patch=(plate(centre, (-1, 0, 0), side), lambert(.5)), **more)
    paths = ep.trace(scene, make_radar(ANTENNA), num_rays=6000, max_bounces=max_bounces,
                     polarization="scalar").select("T .* 'patch' .* R")
    mesh_id = next(mesh.id for mesh in paths.scene.meshes if mesh.name == "patch")
    found = power_by_hit(paths, mesh_id) / power_by_hit(paths.select("T 'patch' R"), mesh_id)
    steps = side * ((np.arange(40) + .5) / 40 - .5)
    points = np.array([(centre[0], centre[1] + y, centre[2] + z) for y in steps for z in steps])
    return decibel(found), decibel(echo_over_direct(points, np.array((-1.0, 0, 0)), max_bounces))


# The plane through the antenna and the edge parts the points by the order of their two mirrors; it cuts the third patch.
@pytest.mark.parametrize("centre", [(20, 0, .5), (30, 2.5, 1.5), (20, 1.5, .5), (60, -4, .3)])
@pytest.mark.parametrize("side", [.0005, .02])
def test_a_patch_in_a_corner_sees_four_antennas(centre, side):
    found, expected = patch_in_corner(centre, side, LONGEST)
    assert found == pytest.approx(expected, abs=IMAGE_TOLERANCE_DB)


# Every ray that finds the patch stands for all legs, also for pairs longer than its own path may become.
@pytest.mark.parametrize("max_bounces", [1, 2, 3, 4, LONGEST])
def test_fewer_bounces_leave_out_pairs_and_change_no_other(max_bounces):
    found, expected = patch_in_corner((20, 1.0, .7), .002, max_bounces)
    assert found == pytest.approx(expected, abs=IMAGE_TOLERANCE_DB)


def test_mirrors_that_lie_on_others_have_no_images_of_their_own():
    puddle = rectangle((5, -3, 0), (10, 0, 0), (0, 5, 0))
    poster = rectangle((18, 3, .1), (-10, 0, 0), (0, 0, 1.4))
    found, expected = patch_in_corner((20, 1.0, .7), .002, LONGEST, puddle=(puddle, MIRROR), poster=(poster, MIRROR))
    assert found == pytest.approx(expected, abs=IMAGE_TOLERANCE_DB)


# Rays know no distances below 3e-6 m here; of mirrors in one plane the last one counts.
@pytest.mark.parametrize("height, slope, permittivity",
                         [(0.0, 0.0, 9.0), (2e-6, 0.0, 9.0), (-2e-6, 0.0, 4.0), (2e-6, -1e-6, 9.0)])
@pytest.mark.parametrize("is_upside_down", [False, True])
def test_of_mirrors_on_each_other_the_front_one_has_the_image(height, slope, permittivity, is_upside_down):
    """height in m, where the puddle lies in front of the road; slope: of it, so that the road's ends are farther off its plane"""
    road, puddle = (ep.Material(permittivity=value, mirror=True) for value in (4.0, 9.0))
    sides = [(3, 0, 3 * slope), (0, 4, 0)]
    scene = scene_of(road=(rectangle((-60, -60, 0), (65, 0, 0), (0, 65, 0)), road),
                     puddle=(rectangle((-2, -1, height), *(reversed(sides) if is_upside_down else sides)), puddle))
    field = fields(ep.trace(scene, make_radar((0, 0, 2), polarization=(0, 1, 0)), num_rays=10).select("T .* R")).sum()
    gamma = (math.sqrt(permittivity) - 1) / (math.sqrt(permittivity) + 1)
    assert abs(field) == pytest.approx(gamma * WAVELENGTH / (4 * math.pi * 4), rel=2 * abs(height) + FIELD_TOLERANCE)


def physical_optics(centre, radius, antennas):
    """a of a metal sphere between all pairs of `antennas`, (coefficient, position) each; 1 W, isotropic, sqrt(W)."""
    polar, turns = 2000, 480
    axis = (ANTENNA - centre) / np.linalg.norm(ANTENNA - centre)
    first = np.cross(axis, (0.0, 1.0, 0.0)) / np.linalg.norm(np.cross(axis, (0.0, 1.0, 0.0)))
    theta, turn = np.meshgrid((np.arange(polar) + .5) * math.pi / polar, (np.arange(turns) + .5) * 2 * math.pi / turns)
    normals = (np.cos(theta)[..., None] * axis + (np.sin(theta) * np.cos(turn))[..., None] * first
               + (np.sin(theta) * np.sin(turn))[..., None] * np.cross(axis, first)).reshape(-1, 3)
    areas = (radius**2 * np.sin(theta) * (math.pi / polar) * (2 * math.pi / turns)).ravel()
    there, back = 0, 0
    for coefficient, antenna in antennas:
        line = antenna - centre - radius * normals
        length = np.linalg.norm(line, axis=1)
        cosine = np.maximum(np.einsum("ni,ni->n", line, normals) / length, 0)
        wave = coefficient * np.exp(-2j * math.pi / WAVELENGTH * length) / length
        there, back = there + wave * cosine, back + wave * (cosine > 0)
    return -1j / (4 * math.pi) * np.sum(areas * there * back)


def test_a_metal_sphere_in_a_corner_sees_four_antennas():
    centre, radius = np.array((20, 1.2, .8)), .1
    paths = ep.trace(corner(target=(sphere(centre, radius, 5), METAL, True)), make_radar(ANTENNA), num_rays=1 << 14,
                     max_bounces=LONGEST, polarization="scalar")
    found = fields(paths.select("T .* 'target' .* R")).sum()
    expected = physical_optics(centre, radius, [((-1) ** mirrors, image) for mirrors, image in IMAGES])
    assert decibel(abs(found / expected) ** 2) == pytest.approx(0, abs=PO_TOLERANCE_DB)


@pytest.mark.parametrize("aside, floor", [(0.0, "metal"), (3.0, "glass")])
def test_a_sphere_of_glass_over_a_floor_is_lit_by_the_image(aside, floor):
    """An upright field lies in the plane of incidence on the floor, and on the sphere where both antennas are one place; the
    signs of such waves that turn back on a target are its own, whatever mirror they came over."""
    target = dict(target=(sphere((20, 0, 1.5), .2, 5), ep.Material(permittivity=4.0), True))
    transmitter, receiver = np.array([(0, -aside, 1), (0, aside, 1)])
    material = MIRROR if floor == "metal" else ep.Material(permittivity=4.0, mirror=True)
    ground = rectangle((-50, -50, 0), (200, 0, 0), (0, 100, 0))

    def field(select, at, **more):
        scene = scene_of(**target, **more)
        paths = ep.trace(scene, make_radar(at, receiver), num_rays=1 << 14, max_bounces=2, polarization="scalar")
        return fields(paths.select(select)).sum()

    sine = 2.5 / math.sqrt(20**2 + aside**2 + 2.5**2)  # of the angle between floor and wave
    inside = math.sqrt(3.0 + sine**2)
    gamma = -1.0 if floor == "metal" else (4.0 * sine - inside) / (4.0 * sine + inside)
    over = field("T 'ground' S'target' R", transmitter, ground=(ground, material))
    image = field("T S'target' R", transmitter * (1, 1, -1))
    assert over / image == pytest.approx(gamma, abs=SPHERE_TOLERANCE)


def test_targets_behind_a_rough_mirror_leave_its_own_echo_as_it_is():
    # Rays at the ball's image cross a third of the floor.
    rough = ep.Material(reflectivity=.5, scattering=.8, mirror=True)
    scene = scene_of(floor=(rectangle((-3, -3, 0), (6, 0, 0), (0, 6, 0)), rough),
                     ball=(sphere((0, 0, 3.5), 1.0, 2), lambert(.5)))
    paths = ep.trace(scene, make_radar((-2, 0, 1)), num_rays=100_000, max_bounces=2)
    steps = (np.arange(600) + .5) / 100 - 3
    x, y = np.meshgrid(steps, steps)
    length = np.sqrt((x + 2) ** 2 + y**2 + 1)
    expected = np.sum(1e-4 / length**6) * .5 * .8**2 / math.pi * (WAVELENGTH / (4 * math.pi)) ** 2
    power = np.sum(np.abs(paths.select("T D'floor' R").amplitude) ** 2)
    assert power == pytest.approx(expected, rel=CLUTTER_TOLERANCE, abs=0)


def test_a_floor_below_a_shelf_is_seen_over_a_rough_mirror_alone():
    """Of the rays that meet the wall few go on, and stand for all: the echo is the integral over what the radar's image sees."""
    rough = ep.Material(reflectivity=.5, scattering=.8, mirror=True)
    scene = scene_of(floor=(rectangle((-30, -30, 0), (33, 0, 0), (0, 60, 0)), lambert(.5)),
                     shelf=(rectangle((-1, -3, .5), (3.2, 0, 0), (0, 6, 0)), lambert(.1)),
                     wall=(rectangle((3, -3, 0), (0, 6, 0), (0, 0, 3)), rough))
    paths = ep.trace(scene, make_radar((0, 0, 1)), num_rays=400_000, max_bounces=3).select("T S'wall' D'floor' S'wall' R")
    place = paths.points(paths.frame.trace_time)[paths.offsets + 1]
    is_hidden = (np.abs(place[:, 0]) < 1.5) & (np.abs(place[:, 1]) < 3)
    x, y = np.meshgrid((np.arange(300) + .5) / 100 - 1.5, (np.arange(600) + .5) / 100 - 3)
    length = np.sqrt((6 - x) ** 2 + y**2 + 1)
    expected = np.sum(1e-4 / length**6) * .5 / math.pi * (WAVELENGTH / (4 * math.pi)) ** 2 * (.5 * (1 - .8**2)) ** 2
    assert np.sum(np.abs(paths.amplitude[is_hidden]) ** 2) == pytest.approx(expected, rel=HIDDEN_TOLERANCE, abs=0)


@pytest.mark.hard
@pytest.mark.parametrize("images", [2, 3, 4, 6])
def test_a_wedge_shows_its_images(images):
    """Angle pi / n, seen from its bisector: two images over each number of bounces below n, one behind the edge over n."""
    distance, half = 10.0, math.pi / images / 2
    faces = {f"face{side}": (rectangle((distance, 0, -50), (-60 * math.cos(half), 60 * side * math.sin(half), 0),
                                       (0, 0, 100)), MIRROR) for side in (1, -1)}
    paths = ep.trace(scene_of(**faces), make_radar((0, 0, 0)), num_rays=10, max_bounces=9)
    lengths = paths.lengths([paths.frame.trace_time])[0]
    coefficients = paths.amplitude * 4 * math.pi * lengths / WAVELENGTH
    for bounces in range(1, 10):
        here = paths.num_bounces == bounces
        count = 2 if bounces < images else 1 if bounces == images else 0
        assert coefficients[here].sum() == pytest.approx(count * (-1) ** bounces, abs=FIELD_TOLERANCE)
        assert lengths[here] == pytest.approx(2 * distance * math.sin(bounces * half))


@pytest.mark.hard
def test_many_bounces_between_mirrors_start_with_the_short_paths():
    # Six mirrors and 14 bounces: 7e9 sequences, more than can be tried.
    walls = {"-x": ((-4, -3, -2), (0, 6, 0), (0, 0, 4)), "+x": ((4, -3, -2), (0, 6, 0), (0, 0, 4)),
             "-y": ((-4, -3, -2), (8, 0, 0), (0, 0, 4)), "+y": ((-4, 3, -2), (8, 0, 0), (0, 0, 4)),
             "-z": ((-4, -3, -2), (8, 0, 0), (0, 6, 0)), "+z": ((-4, -3, 2), (8, 0, 0), (0, 6, 0))}
    scene = scene_of(**{name: (rectangle(*edges), MIRROR) for name, edges in walls.items()})
    paths = ep.trace(scene, make_radar((.3, .2, .1), (.9, -.4, .35)), num_rays=10, max_bounces=14)
    lengths = paths.lengths([paths.frame.trace_time])[0]
    # All images of a box: (2 n L + x) and (2 n L - x) along each axis, |n| bounces and their neighbours.
    images = []
    for n in itertools.product(range(-3, 4), repeat=3):
        position = [2 * half * count + (-1) ** count * at for half, count, at in zip((4, 3, 2), n, (.3, .2, .1))]
        images.append((sum(map(abs, n)), math.dist(position, (.9, -.4, .35))))
    for bounces in (1, 2, 3):
        expected = sorted(length for count, length in images if count == bounces)
        found = paths.num_bounces == bounces
        shares = np.abs(paths.amplitude[found]) * 4 * math.pi * lengths[found] / WAVELENGTH
        assert np.unique(lengths[found].round(9)) == pytest.approx(np.unique(np.round(expected, 9)))
        assert shares.sum() == pytest.approx(len(expected), rel=FIELD_TOLERANCE, abs=0)
