"""Levels of ghosts and of diffuse multipath against image theory, physical optics and quadrature, at 77 GHz."""
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

IMAGE_TOLERANCE_DB = 0.1         # promised; image connections are exact, what is left is the quadrature over the target
WALL_TOLERANCE_DB = 0.05
FRINGE_TOLERANCE_DB = 0.1
FOUR_PATH_TOLERANCE_DB = 0.3     # physical optics with the footprint filter against its bare quadrature
ENERGY_TOLERANCE = 0.005         # relative
CORNER_TOLERANCE = 0.007         # relative: three standard errors of the mean of the seeds below
COEFFICIENT_TOLERANCE_DB = 0.1

MIRROR = ep.Material.metal(mirror=True)
EARTH = ep.Material(permittivity=4 - .2j, mirror=True)
V, H = (0, 0, 1), (0, 1, 0)
both_models = pytest.mark.parametrize("model", ["scalar", "jones"])
# Metal reflects with -1 as a whole (scalar) or across the plane of incidence: over ground that is H, at a wall V.
both_models_of_metal_ground = pytest.mark.parametrize("model, polarization", [("scalar", V), ("jones", H)])

DISTANCES = (20, 30, 50, 100)    # m
# Two-ray ground, antenna and target .5 m above it: all four paths over the direct one in dB, by distance.
POINT_OVER_METAL = (11.434, 7.487, 11.638, 7.699)
POINT_OVER_EARTH = {V: (9.540, 6.217, 10.857, 7.300), H: (10.947, 7.168, 11.437, 7.602)}
PATCH_OVER_METAL = (11.34, 7.54, 11.62, 7.70)            # Lambert patch of 1 cm
PATCH_OVER_EARTH_TE = (10.85, 7.22, 11.42, 7.61)
SPHERE_OVER_METAL = (11.406, 7.551, 11.633, 7.686)       # metal sphere of .1 m
PLATE_OVER_METAL = -3.046                                # metal plate of .1 m at 20 m
SPHERE_NULL = -18.6                                      # sphere at 100 m and .8 m: a null between the four

# Lambert sphere of .3 m at (10, 0, 1), wall at y = 3, re direct in dB: one order, the pair of both, the two-way ghost.
WALL_TABLE = {-1.0: (-1.967, 4.053, -2.700), -0.6: (-6.404, -.384, -11.574)}
PAIR_OVER_BASELINE = {.02: -2.110, .1: 1.061, 1.0: 1.458}
METAL_SPHERE_AT_WALL = {(10, 1): 7.345, (20, 3): 8.706}  # (range, distance of the wall) in m: all four over direct


def ground(material):
    return rectangle((-50, -50, 0), (250, 0, 0), (0, 100, 0)), material


def wall(y, material):
    return rectangle((-50, y, -50), (110, 0, 0), (0, 0, 100)), material


def patch_over(material, polarization, side, model):
    """All four paths over the direct one in dB, by distance, mean over the roughness."""
    levels = []
    for x in DISTANCES:
        scene = scene_of(patch=(plate((x, 0, .5), (-1, 0, 0), side), lambert(.5)), ground=ground(material))
        radar = make_radar((0, 0, .5), polarization=polarization)
        paths = ep.trace(scene, radar, num_rays=3000, max_bounces=3, polarization=model)
        four = paths.select("T 'ground'? 'patch' 'ground'? R")
        levels.append(decibel(power_by_hit(four, 0) / power_by_hit(paths.select("T 'patch' R"), 0)))
    return levels


def four_over_direct(mesh, mirror, height, num_rays, smooth, model, polarization=V):
    """Coherent sum of the paths over a flagged metal mirror and of the direct one, over the latter alone, in dB."""
    scene = scene_of(target=(mesh, METAL, smooth), mirror=mirror)
    radar = make_radar((0, 0, height), polarization=polarization)
    paths = ep.trace(scene, radar, num_rays=num_rays, max_bounces=3, polarization=model)
    four, direct = paths.select("T 'mirror'? 'target' 'mirror'? R"), paths.select("T 'target' R")
    return decibel(abs(fields(four).sum()) ** 2 / abs(fields(direct).sum()) ** 2)


@both_models_of_metal_ground
def test_a_point_over_ground_has_the_four_path_factor(model, polarization):
    # A patch of half a millimetre is a point to the fringes.
    assert patch_over(MIRROR, polarization, .0005, model) == pytest.approx(POINT_OVER_METAL, abs=IMAGE_TOLERANCE_DB)


def test_metal_ground_mirrors_upright_fields_upright():
    # 40 log10 |1 + d/g e^{-jk(g - d)}|, d and g the lengths of the direct and the mirrored way.
    direct, mirrored = np.array(DISTANCES, float), np.hypot(DISTANCES, 1.0)
    turns = np.exp(-2j * np.pi / WAVELENGTH * (mirrored - direct))
    expected = 40 * np.log10(np.abs(1 + direct / mirrored * turns))
    assert patch_over(MIRROR, V, .0005, "jones") == pytest.approx(expected, abs=IMAGE_TOLERANCE_DB)


@both_models
@pytest.mark.parametrize("polarization", [V, H])
def test_a_point_over_earth_has_the_four_path_factor_of_its_polarisation(polarization, model):
    found = patch_over(EARTH, polarization, .0005, model)
    assert found == pytest.approx(POINT_OVER_EARTH[polarization], abs=IMAGE_TOLERANCE_DB)


@both_models
def test_a_rough_patch_over_ground(model):
    assert patch_over(MIRROR, H, .01, model) == pytest.approx(PATCH_OVER_METAL, abs=IMAGE_TOLERANCE_DB)
    assert patch_over(EARTH, H, .01, model) == pytest.approx(PATCH_OVER_EARTH_TE, abs=IMAGE_TOLERANCE_DB)


@both_models_of_metal_ground
def test_a_metal_plate_over_ground(model, polarization):
    mesh = plate((20, 0, .5), (-1, 0, 0), .1)
    found = four_over_direct(mesh, ground(MIRROR), .5, 1 << 13, False, model, polarization)
    assert found == pytest.approx(PLATE_OVER_METAL, abs=IMAGE_TOLERANCE_DB)


@both_models_of_metal_ground
def test_a_metal_sphere_over_ground(model, polarization):
    found = [four_over_direct(sphere((x, 0, .5), .1, 5), ground(MIRROR), .5, 1 << 13, True, model, polarization)
             for x in DISTANCES]
    assert found == pytest.approx(SPHERE_OVER_METAL, abs=FOUR_PATH_TOLERANCE_DB)


@pytest.mark.hard
@both_models_of_metal_ground
def test_a_metal_sphere_in_a_null_of_the_ground(model, polarization):
    found = four_over_direct(sphere((100, 0, .8), .1, 5), ground(MIRROR), .5, 1 << 14, True, model, polarization)
    assert found == pytest.approx(SPHERE_NULL, abs=FOUR_PATH_TOLERANCE_DB)


@both_models
@pytest.mark.parametrize("distance, aside", METAL_SPHERE_AT_WALL)
def test_a_metal_sphere_at_a_wall(distance, aside, model):
    found = four_over_direct(sphere((distance, 0, 0), .1, 5), wall(aside, MIRROR), 0.0, 1 << 13, True, model)
    assert found == pytest.approx(METAL_SPHERE_AT_WALL[distance, aside], abs=FOUR_PATH_TOLERANCE_DB)


def rough_sphere_levels(wall_material, model, baseline=0.0):
    """Mirror -> target, target -> mirror, both as one, two-way ghost: re direct in dB."""
    scene = scene_of(target=(sphere((10, 0, 1), .3, 5), lambert(.5)), wall=wall(3, wall_material))
    radar = make_radar((0, 0, 1), (0, baseline, 1))
    paths = ep.trace(scene, radar, num_rays=1 << 13, max_bounces=3, polarization=model)
    routes = ("'wall' 'target'", "'target' 'wall'", "('wall' 'target' | 'target' 'wall')", "'wall' 'target' 'wall'")
    direct = power_by_hit(paths.select("T 'target' R"), 0)
    return [decibel(power_by_hit(paths.select(f"T {route} R"), 0) / direct) for route in routes]


@both_models
@pytest.mark.parametrize("gamma", WALL_TABLE)
def test_ghosts_of_a_rough_sphere_at_a_wall(gamma, model):
    material = MIRROR if gamma == -1 else ep.Material(reflectivity=gamma**2, mirror=True)
    one, pair, two_way = WALL_TABLE[gamma]
    assert rough_sphere_levels(material, model) == pytest.approx([one, one, pair, two_way], abs=WALL_TOLERANCE_DB)


def test_a_limit_of_bounces_keeps_the_orders_that_fit():
    scene = scene_of(target=(sphere((10, 0, 1), .3, 4), lambert(.5)), wall=wall(3, MIRROR))
    paths = ep.trace(scene, make_radar((0, 0, 1)), num_rays=1 << 13, max_bounces=2)
    there, back = (power_by_hit(paths.select(f"T {route} R"), 0) for route in ("'wall' 'target'", "'target' 'wall'"))
    assert back / there == pytest.approx(1.0, abs=1e-4)  # one hit in 1e4 sees only one of both by rounding


@both_models
@pytest.mark.parametrize("baseline", PAIR_OVER_BASELINE)
def test_the_pair_of_ghosts_fades_over_the_baseline(baseline, model):
    pair = rough_sphere_levels(MIRROR, model, baseline)[2]
    assert pair == pytest.approx(PAIR_OVER_BASELINE[baseline], abs=FRINGE_TOLERANCE_DB)


# Lambert walls of a sphere light each other evenly: lambda^2 rho / (4 pi^2 R^2 (1 - rho)) between two points inside.
@pytest.mark.hard
@pytest.mark.parametrize("rho, max_bounces", [(.3, 20), (.7, 60)])
def test_an_integrating_sphere_conserves_energy(rho, max_bounces):
    radius = 3.0
    scene = scene_of(shell=(sphere((0, 0, 0), radius, 4), lambert(rho)))
    radar = make_radar((0, 0, 0), (.7, .4, -.3))
    traces = [ep.trace(scene, radar, num_rays=4000, max_bounces=max_bounces, seed=seed) for seed in (1, 2, 3)]
    powers = [np.sum(np.abs(paths.amplitude) ** 2) for paths in traces]
    expected = WAVELENGTH**2 * rho / (4 * math.pi**2 * radius**2 * (1 - rho))
    assert np.mean(powers) / expected == pytest.approx(1.0, abs=ENERGY_TOLERANCE)


# (azimuth of the radar in deg, gap in m): power in 1e-12 W of the orders A -> B and B -> A.
ROUGH_CORNER = {(45, 0): (1.6479, 1.4713), (45, .1): (1.4054, 1.2664),
                (30, 0): (1.5498, 1.3557), (30, .1): (1.3201, 1.1657)}


@pytest.mark.parametrize("azimuth_deg, gap", ROUGH_CORNER)
def test_two_rough_plates_in_a_corner(azimuth_deg, gap):
    scene = scene_of(a=(rectangle((0, gap, -.5), (0, 1, 0), (0, 0, 1)), lambert(.5)),
                     b=(rectangle((gap, 0, -.5), (1, 0, 0), (0, 0, 1)), lambert(.5)))
    azimuth = math.radians(azimuth_deg)
    transmitter = np.array((5 * math.cos(azimuth), 5 * math.sin(azimuth), .3))
    radar = make_radar(transmitter, transmitter + (-.2, .3, .1))
    sums = []
    for seed in range(3):
        paths = ep.trace(scene, radar, num_rays=80000, max_bounces=2, seed=seed)
        sums.append([np.sum(np.abs(paths.select(f"T {order} R").amplitude) ** 2) for order in ("'a' 'b'", "'b' 'a'")])
    assert np.mean(sums, axis=0) * 1e12 == pytest.approx(ROUGH_CORNER[azimuth_deg, gap], rel=CORNER_TOLERANCE, abs=0)


@pytest.mark.parametrize("polarization, expected", [(V, 8.400), (H, -5.396)])
def test_a_dielectric_dihedral_reflects_by_its_polarisation(polarization, expected):
    side, distance, half = .1, 2000.0, math.sqrt(.5) * .1
    material = ep.Material(permittivity=4 - .2j)
    scene = scene_of(left=(rectangle((0, 0, -side / 2), (half, half, 0), (0, 0, side)), material),
                     right=(rectangle((0, 0, -side / 2), (half, -half, 0), (0, 0, side)), material))
    paths = ep.trace(scene, make_radar((distance, 0, 0), polarization=polarization), num_rays=1 << 13, max_bounces=2)
    power = abs(fields(paths.select("T . . R")).sum()) ** 2
    found = decibel(power * (4 * math.pi) ** 3 * distance**4 / WAVELENGTH**2)
    assert found == pytest.approx(expected, abs=COEFFICIENT_TOLERANCE_DB)


@pytest.mark.hard
def test_the_deepest_diffuse_paths_have_finite_weights():
    scene = scene_of(shell=(sphere((0, 0, 0), 30.0, 2), lambert(1.0)))
    paths = ep.trace(scene, make_radar((0, 0, 0), (.7, .4, -.3)), num_rays=50, max_bounces=64)
    assert paths.num_bounces.max() > 10 and np.all(np.isfinite(paths.weight)) and np.all(np.isfinite(paths.amplitude))


@pytest.mark.parametrize("mirror", [True, False])
def test_ground_straight_below_antennas_in_one_place(mirror):
    """An antenna without a pattern sends along its polarisation, too; the image of a metal ground is at twice the height."""
    height = 0.6
    below = rectangle((-3, -3, -height), (6, 0, 0), (0, 6, 0)), ep.Material.metal(mirror=mirror)
    radar = make_radar((0, 0, 0), polarization=V)
    paths = ep.trace(scene_of(ground=below), radar, num_rays=20000, polarization="jones")
    image = radar.transmit_power * (WAVELENGTH / (4 * math.pi * 2 * height)) ** 2
    assert decibel(abs(fields(paths).sum()) ** 2 / image) == pytest.approx(0.0, abs=WALL_TOLERANCE_DB if mirror else 0.5)
