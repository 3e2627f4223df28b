"""Radar cross sections against physical optics, Lambert's law and the Mie series."""
import math
import warnings

import numpy as np
import pytest

import echopath as ep
from support.shapes import FREQUENCY, METAL, decibel, lambert, plate, rectangle, scene_of, sphere

MIE_TOLERANCE = 1e-6             # of sigma / (pi a^2): the digits of the table
PLATE_TOLERANCE_DB = 0.1         # the promise for plates at broadside
PLATE_ANGLE_TOLERANCE_DB = 0.3
MIE_BY_RAYS_TOLERANCE_DB = 0.5   # creeping waves, which physical optics has not, at ka = 20
SMOOTH_TOLERANCE_DB = 0.1
PO_SPHERE_TOLERANCE = 0.01       # relative
DIHEDRAL_TOLERANCE_DB, TRIHEDRAL_TOLERANCE_DB = 0.15, 0.2
LAMBERT_TOLERANCE = 0.002        # relative: mean powers add, so that only the quadrature over the plate is left
WEIGHT_RULE_TOLERANCE_DB = 0.2   # mean of 32 seeds of a coin per ray
POLARIZATION_NULL_DB = -30.0     # the promise for what a symmetry forbids, below the full level
NUM_SEEDS = 60
ERROR_OF_ERRORS = 0.3            # relative: 60 values know their spread to 9 %, three times that

# ka: sigma / (pi a^2), metal sphere
MIE_TABLE = {0.1: .000898, 0.5: .529576, 1: 3.637567, 1.0289: 3.654939, 2: 1.008143, 3: .520765, 5: 1.168837,
             10: .929230, 20: .966357, 50: .995918, 100: .999025, 161.379: 1.000118}
PO_SPHERE_TABLE = {1: .79878, 5: 1.14559, 10: .91167, 50: 1.01015}
PLATE_TABLE_DBSM = {.05: 7.144, .1: 19.185, .2: 31.227}       # by side in m
TILTED_PLATE_DBSM = {0: 19.185, .5: 16.096, 1: .277, 2: -.183, 3: -.980, 5: -3.833, 10: -21.996, 20: -16.400}  # by deg
DIHEDRAL_TOTAL_DBSM, DIHEDRAL_DOUBLE_DBSM, TRIHEDRAL_TOTAL_DBSM = 22.162, 22.196, 14.294

every_polarization = pytest.mark.parametrize("polarization", [(0, 0, 1), "vv", "hh"])  # scalar model, field vectors

RADIUS = 0.1  # m
RIGHT_ANGLE_HALF = math.sqrt(0.5)
SERIES = 1e-12                 # relative: rounding of a series of some hundred terms
RAYLEIGH = 1e-5                # of 1: further terms are of order ka^2; 7e-7 found
RECORD = 1e-6                  # relative: the rounding of a record's floats
CROSS = 1e-15                  # of the co-polar section: rounding of fields, squared
HIT_DB = 1e-4                  # dB: rounding moves hits by nanometres; 7e-6 found


def frequency_of(ka, radius=RADIUS):
    return ka * ep.speed_of_light / (2 * math.pi * radius)


def smooth_sphere(radius=RADIUS, centre=(0, 0, 0)):
    return scene_of(ball=(sphere(centre, radius, 5), METAL, True))


def plate_scene(side=0.1, material=METAL):
    return scene_of(plate=(plate((0, 0, 0), (1, 0, 0), side), material))


def dihedral(material=METAL, side=0.1):
    along = RIGHT_ANGLE_HALF * side
    corner = (0, 0, -side / 2)
    return scene_of(left=(rectangle(corner, (along, along, 0), (0, 0, side)), material),
                    right=(rectangle(corner, (along, -along, 0), (0, 0, side)), material))


def in_plane(angles_deg):
    angles = np.radians(angles_deg)
    return np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)


# --- The Mie series ---

@pytest.mark.parametrize("ka", MIE_TABLE)
def test_mie_rcs_is_that_of_the_table(ka):
    assert abs(ep.mie_rcs(RADIUS, frequency_of(ka)) / (math.pi * RADIUS**2) - MIE_TABLE[ka]) < MIE_TOLERANCE


def test_mie_rcs_agrees_with_library_bessel_functions():
    special = pytest.importorskip("scipy.special")
    for ka in (0.03, 0.7, 7.3, 63.0, 411.0):
        n = np.arange(1, int(ka + 4.05 * ka ** (1 / 3) + 12) + 1)
        j, y = special.spherical_jn(n, ka), special.spherical_yn(n, ka)
        dj, dy = special.spherical_jn(n, ka, True), special.spherical_yn(n, ka, True)
        b = j / (j - 1j * y)
        a = (j + ka * dj) / (j + ka * dj - 1j * (y + ka * dy))
        expected = abs(np.sum((-1.0) ** n * (2 * n + 1) * (a - b))) ** 2 / ka**2
        assert ep.mie_rcs(RADIUS, frequency_of(ka)) / (math.pi * RADIUS**2) == pytest.approx(expected, rel=SERIES, abs=0)


@pytest.mark.parametrize("bistatic_deg", [0, 40, 90, 150, 180])
def test_a_tiny_sphere_is_an_electric_and_a_magnetic_dipole(bistatic_deg):
    ka, angle = 1e-3, math.radians(bistatic_deg)
    scale = 4 * math.pi * RADIUS**2 * ka**4
    frequency = frequency_of(ka)
    across = ep.mie_rcs(RADIUS, frequency, angle, plane="H") / scale
    within = ep.mie_rcs(RADIUS, frequency, angle, plane="E") / scale
    assert across == pytest.approx((1 + 0.5 * math.cos(angle)) ** 2, abs=RAYLEIGH)
    assert within == pytest.approx((math.cos(angle) + 0.5) ** 2, abs=RAYLEIGH)


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
@pytest.mark.parametrize("ka, footprint", [(1, "none"), (5, "none"), (10, "none"), (50, "none"), (1, "second_order"),
                                           (5, "second_order"), (10, "second_order")])
@every_polarization
def test_sphere_by_physical_optics(ka, footprint, polarization):
    found = ep.rcs(smooth_sphere(), frequency=frequency_of(ka), incidence=(1, .2, .3), num_rays=1 << 18, max_bounces=1,
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
                    seed=seed, components=True, polarization=polarization) for seed in range(32)]
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


def test_flat_metal_returns_the_polarization_as_it_came():
    direction = (1, 0.01, 0.02)
    vv, hh, vh = ep.rcs(plate_scene(), frequency=FREQUENCY, incidence=direction, num_rays=1 << 13,
                        polarization=["vv", "hh", "vh"])
    scalar = ep.rcs(plate_scene(), frequency=FREQUENCY, incidence=direction, num_rays=1 << 13)
    assert vv == pytest.approx(scalar, rel=RECORD, abs=0) and hh == pytest.approx(scalar, rel=RECORD, abs=0)
    assert vh < CROSS * vv


# --- Standard errors ---

def rough_plate():
    return plate_scene(1.0, lambert(0.3))


def _over_seeds(scene, num_rays):
    """Cross sections and errors [seeds, 2] of few rays drawn at random."""
    return np.array([ep.rcs(scene, frequency=FREQUENCY, incidence=(1, 0.4, 0.3), num_rays=num_rays, seed=seed,
                            sampler="random", return_error=True) for seed in range(NUM_SEEDS)])


def test_standard_error_is_the_spread_over_seeds():
    rows = _over_seeds(rough_plate(), 512)
    spread, claimed = rows[:, 0].std(ddof=1), np.sqrt(np.mean(rows[:, 1] ** 2))
    assert claimed == pytest.approx(spread, rel=ERROR_OF_ERRORS, abs=0)


@pytest.mark.filterwarnings("ignore:rcs. .* not known to 3 dB")  # few they are
def test_errors_of_coherent_echoes_hold_the_spread_and_the_truth():
    """Of a smooth sphere, pi a^2: what footprints may leave out stands beside the spread over seeds."""
    rows, truth = _over_seeds(smooth_sphere(), 256), math.pi * RADIUS ** 2
    assert np.all(rows[:, 1] > (1 - ERROR_OF_ERRORS) * rows[:, 0].std(ddof=1))
    assert np.mean(np.abs(rows[:, 0] - truth) < 1.96 * rows[:, 1]) >= 0.9


def test_errors_have_the_shape_of_what_they_belong_to():
    directions = in_plane([0, 20])
    keywords = dict(frequency=FREQUENCY, incidence=directions, num_rays=4000)
    value, error = ep.rcs(rough_plate(), return_error=True, **keywords)
    assert value.shape == error.shape == (2,) and np.all(error > 0) and np.all(error < value)
    assert list(value) == list(ep.rcs(rough_plate(), batches=8, **keywords))
    parts, errors = ep.rcs(rough_plate(), return_error=True, components=True, **keywords)
    assert np.all(parts["coherent"] == 0) and np.all(errors["coherent"] == 0)
    assert list(parts["diffuse"]) == list(value) and list(errors["diffuse"]) == list(error)
    with pytest.raises(ValueError, match="batches: must be >= 2 for return_error, got 1"):
        ep.rcs(rough_plate(), return_error=True, batches=1, **keywords)


def test_a_cross_section_with_its_error_is_that_without():
    """Off broadside a plate needs fine footprints: each batch has the rays of a call without errors, unless told otherwise.

    Truth: 4 pi a^4 / lambda^2 cos^2 sinc^2 at a side lobe (physical optics of a square plate).
    """
    side, lobe, wavelength = 0.2, 50.5, ep.speed_of_light / FREQUENCY
    angle = np.arcsin(lobe * wavelength / (2.0 * side))
    truth = 4.0 * np.pi * side ** 4 / wavelength ** 2 * np.cos(angle) ** 2 * np.sinc(lobe) ** 2
    scene = ep.Scene()
    scene.add(ep.actors.plate(side, side), name="plate", material="metal")
    value, error = ep.rcs(scene, frequency=FREQUENCY, incidence=(-np.cos(angle), np.sin(angle), 0.0), return_error=True)
    assert abs(decibel(value / truth)) < PLATE_ANGLE_TOLERANCE_DB and error < 0.02 * value


def test_rays_double_until_the_error_is_met(recwarn):
    keywords = dict(frequency=FREQUENCY, incidence=in_plane([0, 30]), num_rays=64, sampler="random", return_error=True)
    value, error = ep.rcs(rough_plate(), target_error_db=0.1, **keywords)
    assert np.all(10 * np.log10(1 + error / value) < 0.1) and not list(recwarn)
    with pytest.warns(RuntimeWarning,
                      match="rcs: for 2 of 2 cross sections max_rays was reached .* target_error_db is 0.01"):
        ep.rcs(rough_plate(), target_error_db=0.01, max_rays=256, **keywords)
    edge_on = ep.rcs(plate_scene(), frequency=FREQUENCY, incidence=(0, 1, 0), target_error_db=0.1, return_error=True)
    assert edge_on == (0.0, 0.0)  # with no warning: nothing is there to be missed


def test_meshes_too_coarse_are_warned_of():
    coarse = scene_of(ball=(sphere((0, 0, 0), RADIUS, 2), METAL))
    with pytest.warns(ep.TessellationWarning, match="edges of 7.* mm would do"):
        ep.rcs(coarse, frequency=FREQUENCY, incidence=(1, 0, 0), num_rays=10)


# --- What the figure must not depend on ---

def test_place_and_length_of_directions_do_not_matter():
    near = ep.rcs(smooth_sphere(2.0), frequency=FREQUENCY, incidence=(1, .3, .2), num_rays=1 << 13)
    far = ep.rcs(smooth_sphere(2.0, (2e3, -1e3, 5.0)), frequency=FREQUENCY, incidence=(100, 30, 20), num_rays=1 << 13)
    assert abs(decibel(near / ep.mie_rcs(2.0, FREQUENCY))) < SMOOTH_TOLERANCE_DB
    assert abs(decibel(far / near)) < HIT_DB


@pytest.mark.hard
def test_rows_are_the_single_results_and_bits_repeat():
    directions = in_plane([0, 10, 50])
    keywords = dict(frequency=FREQUENCY, num_rays=3000, max_bounces=2)
    rows = ep.rcs(dihedral(), incidence=directions, **keywords)
    assert rows.shape == (3,)
    assert list(rows) == [ep.rcs(dihedral(), incidence=direction, **keywords) for direction in directions]
    one_to_many = ep.rcs(dihedral(), incidence=directions[0], observation=directions, **keywords)
    assert one_to_many[0] == rows[0] and one_to_many.shape == (3,)
    threads = ep.num_threads()
    try:
        ep.set_num_threads(1)
        assert list(ep.rcs(dihedral(), incidence=directions, **keywords)) == list(rows)
    finally:
        ep.set_num_threads(threads)


@pytest.mark.hard
@pytest.mark.parametrize("beside", [0.0, 9e-4])  # rad; hits below 1e-3 are dropped
def test_a_target_seen_edge_on_returns_nothing(beside):
    for scene in (plate_scene(), plate_scene(material=ep.Material(reflectivity=0.5, scattering=1.0))):
        assert ep.rcs(scene, frequency=FREQUENCY, incidence=(beside, 1, 0), num_rays=20000) == 0.0


@pytest.mark.parametrize("keywords, name", [
    (dict(incidence=(0, 0, 0)), "incidence"), (dict(incidence=(0, 0, 1)), "polarization"),
    (dict(observation=(0, 0, 0)), "observation"),
    (dict(observation=[(1, 0, 0)] * 3, incidence=[(1, 0, 0)] * 2), "observation"),
    (dict(frequency=-1.0), "frequency"), (dict(num_rays=0), "num_rays"), (dict(max_bounces=65), "max_bounces"),
    (dict(footprint="third"), "footprint"), (dict(polarization=(0, 0, 0)), "polarization"),
    (dict(polarization="vertical"), "polarization"), (dict(polarization=[(0, 0, 1)] * 3), "polarization"),
    (dict(polarization=["vv", "left"]), "polarization"), (dict(sampler="sobol"), "sampler"),
    (dict(batches=65), "batches"), (dict(target_error_db=0.0), "target_error_db")])
def test_bad_input_is_named(keywords, name):
    with pytest.raises(ValueError, match=name):
        ep.rcs(plate_scene(), **{"frequency": FREQUENCY, "incidence": (1, 0, 0), **keywords})


def test_scenes_without_a_cross_section_are_refused():
    with pytest.raises(ValueError, match="scene"):
        ep.rcs(ep.Scene(), frequency=FREQUENCY, incidence=(1, 0, 0))
    with pytest.raises(ValueError, match="mirror"):
        ep.rcs(plate_scene(material=ep.Material.metal(mirror=True)), frequency=FREQUENCY, incidence=(1, 0, 0))
    with pytest.raises(TypeError, match="num_rays"):
        ep.rcs(plate_scene(), frequency=FREQUENCY, incidence=(1, 0, 0), num_ray=1)


PLATE_ASKEW = {"frequency": 10e9, "incidence": (-np.cos(np.radians(52)), -np.sin(np.radians(52)), 0.0)}


def test_few_rays_are_warned_of():
    """5000 rays are 30 wavelengths apart on a plate of 33: -34 dBsm where physical optics has -7."""
    with pytest.warns(RuntimeWarning, match=r"^rcs: 1 of 1 cross sections are not known to 3 dB from 5000 rays, .*num_rays"):
        ep.rcs(plate_scene(1.0), num_rays=5000, **PLATE_ASKEW)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ep.rcs(plate_scene(1.0), **PLATE_ASKEW)


@pytest.mark.parametrize("rays", [500, 2000, 5000])
def test_errors_hold_what_footprints_take_away(rays):
    """Upright edges of a plate that is seen aslant: all cells along one are in phase."""
    with pytest.warns(RuntimeWarning, match="not known to 3 dB"):
        few, error = ep.rcs(plate_scene(1.0), num_rays=8 * rays, return_error=True, **PLATE_ASKEW)
    many = ep.rcs(plate_scene(1.0), **PLATE_ASKEW)
    assert 0.5 * many < abs(few - many) < 2 * error
