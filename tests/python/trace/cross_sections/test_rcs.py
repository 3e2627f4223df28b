"""Radar cross sections against physical optics, Lambert's law and the Mie series."""
import math

import numpy as np
import pytest
from scipy import special

import echopath as ep
from support.rcs_targets import (
    PLATE_ANGLE_TOLERANCE_DB,
    RADIUS,
    RIGHT_ANGLE_HALF,
    SMOOTH_TOLERANCE_DB,
    dihedral,
    in_plane,
    plate_scene,
    smooth_sphere,
)
from support.shapes import FREQUENCY, METAL, decibel, lambert, rectangle, scene_of

MIE_TOLERANCE = 1e-6             # of sigma / (pi a^2): the digits of the table
PLATE_TOLERANCE_DB = 0.1         # the promise for plates at broadside
MIE_BY_RAYS_TOLERANCE_DB = 0.5   # creeping waves, which physical optics has not, at ka = 20
PO_SPHERE_TOLERANCE = 0.01       # relative
DIHEDRAL_TOLERANCE_DB, TRIHEDRAL_TOLERANCE_DB = 0.15, 0.2
LAMBERT_TOLERANCE = 0.002        # relative: mean powers add, so that only the quadrature over the plate is left
WEIGHT_RULE_TOLERANCE_DB = 0.2   # mean of 32 seeds of a coin per ray
POLARIZATION_NULL_DB = -30.0     # the promise for what a symmetry forbids, below the full level

# ka: sigma / (pi a^2), metal sphere
MIE_TABLE = {0.1: .000898, 0.5: .529576, 1: 3.637567, 1.0289: 3.654939, 2: 1.008143, 3: .520765, 5: 1.168837,
             10: .929230, 20: .966357, 50: .995918, 100: .999025, 161.379: 1.000118}
PO_SPHERE_TABLE = {1: .79878, 5: 1.14559, 10: .91167, 50: 1.01015}
PLATE_TABLE_DBSM = {.05: 7.144, .1: 19.185, .2: 31.227}       # by side in m
TILTED_PLATE_DBSM = {0: 19.185, .5: 16.096, 1: .277, 2: -.183, 3: -.980, 5: -3.833, 10: -21.996, 20: -16.400}  # by deg
DIHEDRAL_TOTAL_DBSM, DIHEDRAL_DOUBLE_DBSM, TRIHEDRAL_TOTAL_DBSM = 22.162, 22.196, 14.294

every_polarization = pytest.mark.parametrize("polarization", [(0, 0, 1), "vv", "hh"])  # scalar model, field vectors

SERIES = 1e-12                 # relative: rounding of a series of some hundred terms
RAYLEIGH = 1e-5                # of 1: further terms are of order ka^2; 7e-7 found
RECORD = 1e-6                  # relative: the rounding of a record's floats
CROSS = 1e-15                  # of the co-polar section: rounding of fields, squared
BALLS_TOLERANCE_DB = 0.15      # what the limits tell to a tenth of a decibel, as default rays find it
RODS_TOLERANCE_DB = 0.65       # what the limits tell to a decibel or half of one, and footprints of a thousand rays


def frequency_of(ka, radius=RADIUS):
    return ka * ep.speed_of_light / (2 * math.pi * radius)


# --- The Mie series ---

@pytest.mark.parametrize("ka", MIE_TABLE)
def test_mie_rcs_is_that_of_the_table(ka):
    assert abs(ep.mie_rcs(RADIUS, frequency_of(ka)) / (math.pi * RADIUS**2) - MIE_TABLE[ka]) < MIE_TOLERANCE


def test_mie_rcs_agrees_with_library_bessel_functions():
    for ka in (0.03, 0.7, 7.3, 63.0, 411.0):
        n = np.arange(1, int(ka + 4.05 * ka ** (1 / 3) + 12) + 1)
        j, y = special.spherical_jn(n, ka), special.spherical_yn(n, ka)
        dj, dy = special.spherical_jn(n, ka, True), special.spherical_yn(n, ka, True)
        b = j / (j - 1j * y)
        a = (j + ka * dj) / (j + ka * dj - 1j * (y + ka * dy))
        expected = abs(np.sum((-1.0) ** n * (2 * n + 1) * (a - b))) ** 2 / ka**2
        assert ep.mie_rcs(RADIUS, frequency_of(ka)) / (math.pi * RADIUS**2) == pytest.approx(expected, rel=SERIES, abs=0)


@pytest.mark.parametrize("ka", [1e-3, 2e-8, 5e-9, 1e-70])
@pytest.mark.parametrize("bistatic_deg", [0, 40, 90, 150, 180])
def test_a_tiny_sphere_is_an_electric_and_a_magnetic_dipole(bistatic_deg, ka):
    angle = math.radians(bistatic_deg)
    scale = 4 * math.pi * RADIUS**2 * ka**4
    frequency = frequency_of(ka)
    across = ep.mie_rcs(RADIUS, frequency, angle, plane="H") / scale
    within = ep.mie_rcs(RADIUS, frequency, angle, plane="E") / scale
    assert across == pytest.approx((1 + 0.5 * math.cos(angle)) ** 2, abs=RAYLEIGH)
    assert within == pytest.approx((math.cos(angle) + 0.5) ** 2, abs=RAYLEIGH)


@pytest.mark.parametrize("radius", [1e-110, 1e-150, 1e-200, 5e-324])
def test_a_sphere_of_no_size_scatters_nothing(radius):
    assert ep.mie_rcs(radius, 77e9) == 0.0


def test_a_large_sphere_scatters_forward_like_its_shadow():
    ka = 2000.0
    shadow = 4 * math.pi * (math.pi * RADIUS**2) ** 2 / (ep.speed_of_light / frequency_of(ka)) ** 2
    # + edge terms of ka^(-2/3)
    assert ep.mie_rcs(RADIUS, frequency_of(ka), math.pi) == pytest.approx(shadow, rel=0.02, abs=0)


@pytest.mark.parametrize("keywords", [dict(radius=0.0), dict(radius=-1.0), dict(frequency=0.0),
                                      dict(frequency=math.nan), dict(radius=1e9), dict(bistatic_angle=4.0),
                                      dict(plane="V")])
def test_mie_rcs_refuses_what_has_no_meaning(keywords):
    with pytest.raises(ValueError, match=next(iter(keywords))):
        ep.mie_rcs(**{"radius": 0.1, "frequency": 77e9, **keywords})


# --- Targets with closed forms ---

@every_polarization
@pytest.mark.parametrize("side", PLATE_TABLE_DBSM)
def test_plate_at_broadside(side, polarization):
    found = ep.rcs(plate_scene(side), frequency=FREQUENCY, incidence=(1, 0, 0), num_rays=1 << 12, polarization=polarization)
    assert abs(decibel(found) - PLATE_TABLE_DBSM[side]) < PLATE_TOLERANCE_DB


@every_polarization
def test_plate_over_angle(polarization):
    found = ep.rcs(plate_scene(), frequency=FREQUENCY, incidence=in_plane(list(TILTED_PLATE_DBSM)), num_rays=1 << 17,
                   polarization=polarization)
    assert decibel(found) == pytest.approx(list(TILTED_PLATE_DBSM.values()), abs=PLATE_ANGLE_TOLERANCE_DB)


@pytest.mark.parametrize("incidence_deg, observation_deg", [(60, -30), (30, -60), (0, 40), (70, -70)])
def test_bistatic_plate_has_the_obliquity_of_its_polarization(incidence_deg, observation_deg):
    # Currents 2 n x H: across the plane of incidence they radiate by the cosine of incidence, in it by that of observation.
    side, wavelength = 0.005, ep.speed_of_light / FREQUENCY
    incidence, observation = in_plane([incidence_deg, observation_deg])
    vv, hh = ep.rcs(plate_scene(side), frequency=FREQUENCY, incidence=incidence, observation=observation, num_rays=1 << 13,
                    polarization=["vv", "hh"])
    turns = side / wavelength * (math.sin(math.radians(incidence_deg)) + math.sin(math.radians(observation_deg)))
    full = 4 * math.pi * side**4 / wavelength**2 * np.sinc(turns) ** 2
    assert abs(decibel(vv / full) - 20 * math.log10(math.cos(math.radians(incidence_deg)))) < PLATE_TOLERANCE_DB
    assert abs(decibel(hh / full) - 20 * math.log10(math.cos(math.radians(observation_deg)))) < PLATE_TOLERANCE_DB


def test_plate_turned_by_both_angles_of_a_bistatic_pair_mirrors_at_full_strength():
    # Specular direction: 4 pi A^2 cos^2 / lambda^2, whatever the tilt.
    incidence, observation = in_plane([35, -35])
    found = ep.rcs(plate_scene(), frequency=FREQUENCY, incidence=incidence, observation=observation, num_rays=1 << 12)
    expected = PLATE_TABLE_DBSM[.1] + 20 * math.log10(math.cos(math.radians(35)))
    assert abs(decibel(found) - expected) < PLATE_TOLERANCE_DB


# ka: dB that limits.md tells of a rod beside its exact series, with the field along it and across it
RODS_DB = {0.25: (-9, 5), 0.5: (-4, 0), 1.0: (-1, 0), 1.5: (0, 3), 2.6: (0, 1.5), 3.4: (-0.6, 0), 5.0: (0, 0.8), 8.0: (0, 0)}


def rod(radius, length, around=48):
    angle = 2 * math.pi / around * np.arange(around)
    ring = np.stack([radius * np.cos(angle), radius * np.sin(angle), np.full(around, -0.5 * length)], axis=1)
    here, there = np.arange(around), np.roll(np.arange(around), -1)
    triangles = np.concatenate([np.stack([here, there, here + around], 1), np.stack([there, there + around, here + around], 1)])
    return ep.Mesh(np.concatenate([ring, ring + (0, 0, length)]), triangles)


@pytest.mark.parametrize("ka", RODS_DB)
def test_rods_stray_from_their_exact_series_as_the_limits_say(ka):
    """A long metal cylinder has 4 L^2 / pi times the square of a sum of Bessel functions (Harrington 1961, 5-9)."""
    length, n = 20 * ep.speed_of_light / FREQUENCY, np.arange(-30, 31)
    along = special.jv(n, ka) / special.hankel2(n, ka)
    across = special.jvp(n, ka) / special.h2vp(n, ka)
    exact = [4 * length**2 / math.pi * abs(np.sum((-1.0) ** n * terms)) ** 2 for terms in (along, across)]
    scene = ep.Scene()
    scene.add(rod(ka * ep.speed_of_light / (2 * math.pi * FREQUENCY), length), name="rod", material="metal", smooth=True)
    found = [ep.rcs(scene, frequency=FREQUENCY, incidence=(1, 0, 0), num_rays=1 << 16, polarization=field)
             for field in ((0, 0, 1), (0, 1, 0))]
    assert decibel(np.divide(found, exact)) == pytest.approx(RODS_DB[ka], abs=RODS_TOLERANCE_DB)


# ka: dB that limits.md tells of a ball; 4.7 and 10.74 are a golf ball at 10.5 and 24 GHz
BALLS_DB = {2.9: 3.5, 4.7: -1.3, 5.4: 2.3, 7.2: -1.7, 9.0: 1.3, 10.74: -1.0, 12.6: 0.8}


@pytest.mark.parametrize("ka", BALLS_DB)
def test_balls_stray_from_the_mie_series_as_the_limits_say(ka):
    radius = ka * ep.speed_of_light / (2 * math.pi * FREQUENCY)
    scene = ep.Scene()
    scene.add(ep.actors.sphere(radius), name="ball", material="metal", smooth=True)
    found = ep.rcs(scene, frequency=FREQUENCY, incidence=(1, 0, 0))
    assert decibel(found / ep.mie_rcs(radius, FREQUENCY)) == pytest.approx(BALLS_DB[ka], abs=BALLS_TOLERANCE_DB)


@every_polarization
@pytest.mark.parametrize("ka", [20, 50, 100, 161.379])
def test_smooth_sphere_against_mie(ka, polarization):
    found = ep.rcs(smooth_sphere(), frequency=frequency_of(ka), incidence=(1, .2, .3), num_rays=1 << 14,
                   polarization=polarization)
    tolerance = MIE_BY_RAYS_TOLERANCE_DB if ka < 50 else SMOOTH_TOLERANCE_DB
    assert abs(decibel(found / ep.mie_rcs(RADIUS, frequency_of(ka)))) < tolerance


@pytest.mark.parametrize("bistatic_deg", [20, 45, 90])
def test_bistatic_smooth_sphere_against_mie(bistatic_deg):
    angle = math.radians(bistatic_deg)
    found = ep.rcs(smooth_sphere(), frequency=FREQUENCY, incidence=(1, 0, 0), num_rays=1 << 14,
                   observation=(math.cos(angle), math.sin(angle), 0))
    assert abs(decibel(found / ep.mie_rcs(RADIUS, FREQUENCY, angle))) < SMOOTH_TOLERANCE_DB


# The footprint filter takes away the wave that physical optics sends from the shadow's edge: 1 % at ka = 50 for any number
# of rays in reach, while at smaller ka 2^18 rays resolve the edge.
@pytest.mark.parametrize("ka, footprint, num_rays", [
    (1, "none", 1 << 16), (5, "none", 1 << 16), (10, "none", 1 << 16), (50, "none", 1 << 17),
    (1, "second_order", 1 << 16), (5, "second_order", 1 << 17), (10, "second_order", 1 << 18)])
@pytest.mark.parametrize("polarization", [(0, 0, 1), ["vv", "hh"]])  # scalar model, field vectors
def test_sphere_by_physical_optics(ka, footprint, num_rays, polarization):
    found = ep.rcs(smooth_sphere(), frequency=frequency_of(ka), incidence=(1, .2, .3), num_rays=num_rays, max_bounces=1,
                   footprint=footprint, polarization=polarization)
    assert found / (math.pi * RADIUS**2) == pytest.approx(PO_SPHERE_TABLE[ka], rel=PO_SPHERE_TOLERANCE, abs=0)


@every_polarization
def test_dihedral_with_all_orders(polarization):
    found = ep.rcs(dihedral(), frequency=FREQUENCY, incidence=(1, 0, 0), num_rays=1 << 16, polarization=polarization)
    assert abs(decibel(found) - DIHEDRAL_TOTAL_DBSM) < DIHEDRAL_TOLERANCE_DB


def test_trihedral_with_all_orders():
    # Of the scalar model: how double bounces interfere with the triple one depends on the polarisation, by .2 dB.
    edge = 0.1
    corner = ep.Mesh([[0, 0, 0], [edge, 0, 0], [0, edge, 0], [0, 0, edge]], [[0, 1, 2], [0, 2, 3], [0, 3, 1]])
    found = ep.rcs(scene_of(corner=(corner, METAL)), frequency=FREQUENCY, incidence=(1, 1, 1), num_rays=1 << 16,
                   model="scalar")
    assert abs(decibel(found) - TRIHEDRAL_TOTAL_DBSM) < TRIHEDRAL_TOLERANCE_DB


@every_polarization
def test_rough_plate_follows_lambert(polarization):
    scene = plate_scene(1.0, lambert(0.3))
    found = ep.rcs(scene, frequency=FREQUENCY, incidence=in_plane([0, 45, 60]), num_rays=1 << 12, components=True,
                   polarization=polarization)
    assert np.all(found["coherent"] == 0)
    assert found["diffuse"] == pytest.approx(4 * 0.3 * np.cos(np.radians([0, 45, 60])) ** 2, rel=LAMBERT_TOLERANCE, abs=0)


@every_polarization
def test_rough_dihedral_keeps_half_the_field(polarization):
    # Half of the power is diffuse at each face, so the field of the double bounce halves: -6.02 dB.
    half = ep.Material(reflectivity=1.0, scattering=math.sqrt(0.5))
    parts = [ep.rcs(dihedral(half), frequency=FREQUENCY, incidence=(1, 0, 0), num_rays=1 << 13, max_bounces=2,
                    seed=seed, components=True, polarization=polarization) for seed in range(16)]
    mean = np.mean([part["coherent"] for part in parts])
    assert abs(decibel(mean) - DIHEDRAL_DOUBLE_DBSM + 20 * math.log10(2)) < WEIGHT_RULE_TOLERANCE_DB
    assert all(part["diffuse"] > 0 for part in parts)


# --- Polarisations ---

def turned_dihedral(angle_deg, side=0.1):
    """Metal, seen along x, turned about that line; at 0 its edge is vertical."""
    angle, half = math.radians(angle_deg), RIGHT_ANGLE_HALF * side
    turn = np.array([[1, 0, 0], [0, math.cos(angle), -math.sin(angle)], [0, math.sin(angle), math.cos(angle)]])
    edge, left, right = turn @ [0, 0, side], turn @ [half, half, 0], turn @ [half, -half, 0]
    return scene_of(left=(rectangle(tuple(-edge / 2), tuple(left), tuple(edge)), METAL),
                    right=(rectangle(tuple(-edge / 2), tuple(right), tuple(edge)), METAL))


@pytest.mark.parametrize("angle_deg, co, cross", [(0, 22.196, None), (22.5, 19.185, 19.185), (45, None, 22.196)])
def test_turned_dihedral_turns_the_polarization(angle_deg, co, cross):
    # Double bounce (Knott 2004); single bounces, up to -20.3 dBsm together, move full levels by 0.04 dB.
    vv, hh, vh, hv = ep.rcs(turned_dihedral(angle_deg), frequency=FREQUENCY, incidence=(1, 0, 0), num_rays=1 << 15,
                            polarization=["vv", "hh", "vh", "hv"])
    for found, expected in ((vv, co), (hh, co), (vh, cross), (hv, cross)):
        if expected is None:
            assert decibel(found) < 22.196 + POLARIZATION_NULL_DB
        else:
            assert abs(decibel(found) - expected) < DIHEDRAL_TOLERANCE_DB
    assert cross is None or vh == pytest.approx(hv, rel=RECORD, abs=0)  # reciprocity


@pytest.mark.parametrize("bistatic_deg", [0, 45, 90])
@pytest.mark.parametrize("name, plane", [("vv", "H"), ("hh", "E")])
def test_bistatic_sphere_in_both_planes_against_mie(bistatic_deg, name, plane):
    angle = math.radians(bistatic_deg)
    co, cross = ep.rcs(smooth_sphere(), frequency=FREQUENCY, incidence=(1, 0, 0), num_rays=1 << 14,
                       observation=(math.cos(angle), math.sin(angle), 0),
                       polarization=[name, name[0] + "hv"[name[0] == "h"]])
    assert abs(decibel(co / ep.mie_rcs(RADIUS, FREQUENCY, angle, plane=plane))) < SMOOTH_TOLERANCE_DB
    assert cross < 10 ** (POLARIZATION_NULL_DB / 10) * co


def test_vectors_and_lists_are_the_named_polarizations():
    keywords = dict(frequency=FREQUENCY, incidence=in_plane([0, 10]), num_rays=3000, max_bounces=2)
    target = turned_dihedral(30)
    names = ["vh", "hh", "vv"]
    table = ep.rcs(target, polarization=names, **keywords)
    assert table.shape == (2, 3)
    for column, name in zip(table.T, names):
        assert list(column) == list(ep.rcs(target, polarization=name, **keywords))
    bistatic = keywords | {"incidence": (1, 0, 0), "observation": (1, 0.4, 0.2)}
    vh, hv = ep.rcs(target, polarization=["vh", "hv"], **bistatic)
    assert abs(decibel(vh / hv)) > 0.1  # so that the next lines tell them apart
    across = np.cross((0, 0, 1), (1, 0.4, 0.2))
    # Parts across the line of sight count, of any length and sign.
    assert ep.rcs(target, polarization=[(0.2, 0, 3), across], **bistatic) == pytest.approx(vh, rel=RECORD, abs=0)
    assert ep.rcs(target, polarization=[(0, -1, 0), (7, 2.8, 2.4)], **bistatic) == pytest.approx(hv, rel=RECORD, abs=0)
    up = ep.rcs(target, polarization="vh", frequency=FREQUENCY, incidence=(0, 0, 1), num_rays=100)
    assert isinstance(up, float)  # no direction is without a vertical and a horizontal


def test_a_list_holds_pairs_of_vectors_and_names():
    keywords = dict(frequency=FREQUENCY, incidence=in_plane([0, 10]), num_rays=1000, max_bounces=2)
    target = turned_dihedral(30)
    up, aside, slanted = (0.0, 0.0, 1.0), (0.3, 1.0, 0.0), (0.1, 0.6, 0.8)
    pairs = [(up, aside), (slanted, up), (up, up)]
    table = ep.rcs(target, polarization=pairs, **keywords)
    assert table.shape == (2, 3)
    for column, pair in zip(table.T, pairs):
        assert list(column) == list(ep.rcs(target, polarization=pair, **keywords))
    assert table.tolist() == ep.rcs(target, polarization=np.array(pairs), **keywords).tolist()
    mixed = ep.rcs(target, polarization=["hv", pairs[1]], **keywords)
    assert list(mixed[:, 0]) == list(ep.rcs(target, polarization="hv", **keywords))
    assert list(mixed[:, 1]) == list(table[:, 1])


def test_flat_metal_returns_the_polarization_as_it_came():
    direction = (1, 0.01, 0.02)
    vv, hh, vh = ep.rcs(plate_scene(), frequency=FREQUENCY, incidence=direction, num_rays=1 << 13,
                        polarization=["vv", "hh", "vh"])
    scalar = ep.rcs(plate_scene(), frequency=FREQUENCY, incidence=direction, num_rays=1 << 13)
    assert vv == pytest.approx(scalar, rel=RECORD, abs=0) and hh == pytest.approx(scalar, rel=RECORD, abs=0)
    assert vh < CROSS * vv


@pytest.mark.parametrize("incidence, observation", [((-1, 0, 0), np.zeros((0, 3))), (np.zeros((0, 3)), (-1, 0, 0)),
                                                    (np.zeros((0, 3)), None), (np.zeros((0, 3)), np.zeros((0, 3)))])
def test_no_directions_have_no_cross_sections(incidence, observation):
    found = ep.rcs(plate_scene(0.1), frequency=FREQUENCY, incidence=incidence, observation=observation, num_rays=100)
    assert found.shape == (0,)
