"""Directive lobes and backscatter of rough surfaces: levels against quadrature, and in replay at other times and antennas."""
import math
import re

import numpy as np
import pytest

import echopath as ep
from echopath.base.storage.data_folder import data_folder
from support.shapes import WAVELENGTH, make_radar, rectangle, scene_of, unit

BATCHES = 16
STANDARD_ERRORS = 3.0
RHO = 0.4
OF_SYNTHESIS = 1e-6  # of the largest sample: ten times the tolerance of both sums


def lobed(exponent=4, share=0.0, back=0):
    return ep.Material(reflectivity=RHO, scattering=1.0, lobe_exponent=exponent, backscatter_share=share,
                       backscatter_exponent=back)


def hemisphere(exponent, cosine):
    """Integral over the half space of ((1 + cos psi)/2)^exponent about a direction at this cosine from the normal."""
    z, weights = np.polynomial.legendre.leggauss(40)
    z, weights = 0.5 * (z + 1), 0.5 * weights
    turn = 2 * np.pi * (np.arange(80) + 0.5) / 80
    along = cosine * z[:, None] + math.sqrt(1 - cosine**2) * np.sqrt(1 - z[:, None]**2) * np.cos(turn)
    return 2 * np.pi * np.sum(weights[:, None] * ((1 + along) / 2)**exponent) / 80


def lobe(material, arrival, normal, departure):
    """1/sr [N] of waves along `arrival` [N, 3] that leave along `departure` [N, 3], over cosines of all departures."""
    cosine = -arrival @ normal
    mirrored = arrival + 2 * cosine[:, None] * normal
    share, back = material.backscatter_share, material.backscatter_exponent or material.lobe_exponent
    knots = np.linspace(cosine.min(), cosine.max(), 9)
    forward_whole, back_whole = (np.interp(cosine, knots, [hemisphere(e, c) for c in knots])
                                 for e in (material.lobe_exponent, back))
    forward = ((1 + np.sum(mirrored * departure, 1)) / 2)**material.lobe_exponent
    backward = ((1 - np.sum(arrival * departure, 1)) / 2)**back
    return ((1 - share) * forward + share * backward) / ((1 - share) * forward_whole + share * back_whole)


def mean_and_error(paths):
    """Mean power of the diffuse paths of all batches, and its standard error, in W."""
    powers = np.bincount(paths.batch, np.abs(paths.amplitude)**2, BATCHES) * BATCHES
    return powers.mean(), powers.std(ddof=1) / math.sqrt(BATCHES)


@pytest.mark.parametrize("material", [lobed(4), lobed(2, 0.3), lobed(8, 0.05, 20)], ids=["directive", "back", "narrow"])
@pytest.mark.parametrize("grazing_deg", [4, 10, 25, 50, 80])
def test_a_patch_of_ground_has_the_level_of_its_lobe(material, grazing_deg):
    grazing, distance = math.radians(grazing_deg), 20.0
    radar_at = np.array((-distance * math.cos(grazing), 0, distance * math.sin(grazing)))
    receiver_at = radar_at + (0, 3.0, 0)
    scene = scene_of(ground=(rectangle((-.5, -.5, 0), (1, 0, 0), (0, 1, 0)), material))
    paths = ep.trace(scene, make_radar(radar_at, receiver_at), num_rays=8000, max_bounces=1, batches=BATCHES,
                     polarization="scalar")
    found, error = mean_and_error(paths)
    x, y = (0.05 * (np.arange(20) + .5) - .5 for _ in range(2))
    points = np.stack([*(value.ravel() for value in np.meshgrid(x, y)), np.zeros(400)], 1)
    (arrival, r1), (departure, r2) = unit(points - radar_at), unit(receiver_at - points)
    normal = np.array((0, 0, 1.0))
    sigma0 = 4 * np.pi * RHO * -arrival @ normal * lobe(material, arrival, normal, departure)
    truth = paths.radar.transmit_power * WAVELENGTH**2 / (4 * np.pi)**3 * np.sum(sigma0 / (r1 * r2)**2) / 400
    assert abs(found - truth) < STANDARD_ERRORS * error + 2e-3 * truth
    assert error < 0.03 * truth


# Two plates of 1 m in a corner with a gap of .1 m, as in test_diffuse_chains.
PLATES = (((0, .1, -.5), (0, 1, 0), (0, 0, 1)), ((.1, 0, -.5), (1, 0, 0), (0, 0, 1)))
NORMALS = np.array(((1.0, 0, 0), (0, 1.0, 0)))


def plate_points(plate, count):
    corner, a, b = (np.array(value, float) for value in plate)
    u, v = np.meshgrid(*[(np.arange(count) + .5) / count] * 2)
    return corner + u.ravel()[:, None] * a + v.ravel()[:, None] * b


def two_bounces(materials, transmitter, receiver, order, count=24):
    """Power over both plates in this order, W for 1 W, by midpoints."""
    first, second = (plate_points(PLATES[i], count) for i in order)
    n1, n2 = NORMALS[list(order)]
    grid1, grid2 = np.repeat(first, len(second), 0), np.tile(second, (len(first), 1))
    (d0, r0), (d1, r1), (d2, r2) = unit(grid1 - transmitter), unit(grid2 - grid1), unit(receiver - grid2)
    material1, material2 = (materials[i] for i in order)
    density = (-d0 @ n1 / r0**2) * lobe(material1, d0, n1, d1) * np.clip(-d1 @ n2, 0, None) / r1**2 \
        * lobe(material2, d1, n2, d2) / r2**2 * (d1 @ n1 > 0) * (d1 @ n2 < 0)
    return RHO**2 * WAVELENGTH**2 / (16 * np.pi**2) * density.sum() / count**4


def test_chains_of_lobes_have_the_levels_of_both_orders():
    materials = (lobed(3), lobed(4, 0.4, 2))
    azimuth = math.radians(35)
    transmitter = np.array((5 * math.cos(azimuth), 5 * math.sin(azimuth), .3))
    receiver = transmitter + (-.4, .5, .2)
    scene = scene_of(a=(rectangle(*PLATES[0]), materials[0]), b=(rectangle(*PLATES[1]), materials[1]))
    paths = ep.trace(scene, make_radar(transmitter, receiver), num_rays=50000, max_bounces=2, batches=BATCHES,
                     polarization="scalar")
    for order, names in (((0, 1), "T 'a' 'b' R"), ((1, 0), "T 'b' 'a' R")):
        found, error = mean_and_error(paths.select(names))
        truth = paths.radar.transmit_power * two_bounces(materials, transmitter, receiver, order)
        assert error < 0.05 * truth
        assert abs(found - truth) < 3.5 * error + 5e-3 * truth


def test_each_channel_has_the_lobes_toward_its_own_antennas():
    """Of chains in both orders, between places far apart: as replayed for these two antennas alone."""
    materials = (lobed(6), lobed(8, 0.4, 3))
    scene = scene_of(a=(rectangle(*PLATES[0]), materials[0]), b=(rectangle(*PLATES[1]), materials[1]))
    places = np.array(((4.0, 3.0, 0.3), (2.5, 4.5, 0.0), (5.0, 1.5, -0.4), (3.5, 3.5, 1.0)))
    antennas = [ep.Antenna(place) for place in places]
    array = make_radar(places[0], places[1]).replace(transmitters=antennas[:2], receivers=antennas[2:])
    paths = ep.trace(scene, array, num_rays=500, max_bounces=2, polarization="scalar").select("T ('a' 'b' | 'b' 'a') R")
    assert np.count_nonzero(paths.flags & 1) > 20
    cube = ep.synthesize(paths, array)
    for tx in range(2):
        for rx in range(2):
            alone = array.replace(transmitters=[antennas[tx]], receivers=[antennas[2 + rx]])
            assert np.abs(ep.synthesize(paths, alone)[0, 0] - cube[tx, rx]).max() < OF_SYNTHESIS * np.abs(cube[tx, rx]).max()


def ratio_to_lambert(material, **settings):
    """|amplitudes|^2 [T, P] over those of Lambert's lobe from the same rays, on a plate that turns, with points and times."""
    times, found = np.linspace(0, 0.02, 5), []
    for one in (material, lobed(0)):
        scene = ep.Scene()
        scene.add(rectangle((-.5, -.5, 0), (1, 0, 0), (0, 1, 0)), name="plate", material=one, position=(6, 0, 0),
                  motion=ep.LinearMotion(angular_velocity=(0, -8.0, 0), velocity=(0, 3.0, 0)))
        radar = make_radar((0, 0, 4), (0, 1, 4.5))
        paths = ep.trace(scene, radar, num_rays=500, max_bounces=1, **settings)
        found.append(np.abs(paths.amplitudes(times, 0, 0))**2)
    return times, scene, paths, found[0] / found[1]


@pytest.mark.parametrize("polarization", ["scalar", "jones"])
def test_replay_has_the_lobe_of_each_time(polarization):
    material = lobed(5, 0.3, 9)
    times, scene, paths, ratio = ratio_to_lambert(material, polarization=polarization)
    assert ratio.max() / ratio.min() > 1.2
    for time, row in zip(times, ratio):
        points = paths.points(time)
        a, b, c, *_ = scene.world_vertices(0, time)
        normal = np.cross(b - a, c - a)
        normal *= np.sign(normal[2]) / np.linalg.norm(normal)
        (arrival, _), (departure, _) = unit(points - (0, 0, 4)), unit((0, 1, 4.5) - points)
        expected = lobe(material, arrival, normal, departure) * np.pi / (departure @ normal)
        assert row == pytest.approx(expected, rel=2e-4)


def test_parts_of_lobes_sum_to_the_whole_and_files_keep_them(tmp_path):
    scene = scene_of(near=(rectangle((4, -1, -1), (0, 2, 0), (0, 0, 2)), lobed(4, 0.2)),
                     far=(rectangle((6, -2, -2), (0, 4, 0), (0, 0, 4)), lobed(2)))
    radar = make_radar((0, 0, 0), (0, .1, 0))
    paths = ep.trace(scene, radar, num_rays=2000, max_bounces=2)
    parts = ep.decompose(paths, radar, {"near": "T 'near' R"})
    whole = ep.synthesize(paths, radar)
    assert sum(parts.values()) == pytest.approx(whole, abs=1e-12 * np.abs(whole).max() * len(paths.offsets))
    paths.save(tmp_path / "paths.h5")
    again = ep.Paths.load(tmp_path / "paths.h5")
    assert np.array_equal(again.amplitude, paths.amplitude)
    assert list(again.scene.meshes)[0].material == lobed(4, 0.2)


GROUNDS = ("asphalt_road", "concrete_road", "gravel", "grass", "snow")


@pytest.mark.parametrize("name", GROUNDS)
def test_grounds_have_the_backscatter_that_they_were_fitted_to(name):
    rows = (data_folder("materials") / "backscatter" / f"{name}.csv").read_text(encoding="utf-8").splitlines()[2:]
    grazing_deg, measured_db = np.array([[float(value) for value in row.split(",")] for row in rows]).T
    found_db = 10 * np.log10(ep.materials[name].backscatter(np.radians(grazing_deg), frequency=77e9))
    assert np.sqrt(np.mean((found_db - measured_db)**2)) < 0.9
    assert np.abs(found_db - measured_db).max() < 1.7


@pytest.mark.parametrize(("name", "keywords", "largest_rms_db"), [
    ("asphalt_road", {}, 0.5), ("concrete_road", {}, 0.5),
    ("grass", {"roughness_height": 0.0628, "backscatter_share": 0.0018}, 1.3)])
def test_grounds_at_10_ghz_follow_their_regression_as_the_page_on_clutter_says(name, keywords, largest_rms_db):
    head = (data_folder("materials") / "backscatter" / f"{name}.csv").read_text(encoding="utf-8").splitlines()[0]
    level, slope = (float(re.search(f"{key} = (-?[0-9.]+)", head.split("at 77 GHz")[-1])[1]) for key in ("A1", "A2"))
    grazing_deg = np.arange(3.0, 31.0)
    ground = ep.materials[name].replace(**keywords)
    found_db = 10 * np.log10(ground.backscatter(np.radians(grazing_deg), frequency=10e9))
    assert np.sqrt(np.mean((found_db - level - slope * np.log10(grazing_deg / 20.0))**2)) < largest_rms_db


def test_the_backscatter_of_lamberts_lobe_is_its_closed_form():
    grazing = np.radians([5.0, 30.0, 90.0])
    assert lobed(0).backscatter(grazing, frequency=77e9) == pytest.approx(4 * RHO * np.sin(grazing)**2, rel=1e-12)


@pytest.mark.parametrize(("keywords", "name"), [
    ({"lobe_exponent": 101}, "lobe_exponent"), ({"backscatter_share": 0.5}, "backscatter_share"),
    ({"lobe_exponent": 4, "backscatter_share": 1.1}, "backscatter_share"),
    ({"lobe_exponent": 4, "backscatter_exponent": 3}, "backscatter_exponent")])
def test_lobes_that_are_none_are_refused(keywords, name):
    with pytest.raises(ValueError, match=f"^{name}: "):
        ep.Material(reflectivity=0.5, scattering=1.0, **keywords)
