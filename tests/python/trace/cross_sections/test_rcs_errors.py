"""Standard errors of cross sections, what these must not depend on, and what is refused or warned of."""
import math
import warnings

import numpy as np
import pytest

import echopath as ep
from support.rcs_targets import (
    PLATE_ANGLE_TOLERANCE_DB,
    RADIUS,
    SMOOTH_TOLERANCE_DB,
    dihedral,
    in_plane,
    plate_scene,
    smooth_sphere,
)
from support.shapes import FREQUENCY, METAL, decibel, lambert, scene_of, sphere

NUM_SEEDS = 60
ERROR_OF_ERRORS = 0.3            # relative: 60 values know their spread to 9 %, three times that
HIT_DB = 1e-4                  # dB: rounding moves hits by nanometres; 7e-6 found


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


def test_rays_are_not_added_without_end_for_nulls():
    """A plate 16 wavelengths wide, where sinc(4) = 0: physical optics has nothing there, which rays never know to 0.3 dB."""
    frequency, width = 24e9, 0.2
    wavelength = ep.speed_of_light / frequency
    angle = np.arcsin(4 * wavelength / (2.0 * width))
    keywords = dict(frequency=frequency, incidence=(-np.cos(angle), np.sin(angle), 0.0), target_error_db=0.3, max_rays=1 << 22)
    scene = ep.Scene()
    scene.add(ep.actors.plate(width, 0.1), name="plate", material="metal")
    with pytest.warns(RuntimeWarning) as told:
        assert 0.0 <= ep.rcs(scene, **keywords) < 0.01 * wavelength ** 2
    assert len(told) == 1 and "rcs: 1 of 1 cross sections are nulls, below wavelength^2 / 100 = 1.56" in str(told[0].message)


def test_meshes_too_coarse_are_warned_of():
    coarse = scene_of(ball=(sphere((0, 0, 0), RADIUS, 2), METAL))
    with pytest.warns(ep.TessellationWarning, match="edges of 7.* mm would do"):
        ep.rcs(coarse, frequency=FREQUENCY, incidence=(1, 0, 0), num_rays=10)


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
    (dict(polarization=["vv", "left"]), "polarization"), (dict(polarization=["vv", (0, 0, 1)]), "polarization"),
    (dict(polarization=[[(0, 0, 1)] * 3]), "polarization"), (dict(sampler="sobol"), "sampler"),
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


@pytest.mark.parametrize("effort", [{}, {"return_error": True}, {"target_error_db": 0.5, "max_rays": 80_000},
                                    {"edges": True}])
@pytest.mark.parametrize("polarization", ["vh", ["vv", "vh"]])
def test_exact_nulls_are_not_warned_of(effort, polarization):
    """A plate that faces the radar turns no polarisation: rounding leaves 1e-28 m^2 of 80."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ep.rcs(plate_scene(0.1), frequency=FREQUENCY, incidence=(1, 0, 0), polarization=polarization, num_rays=20_000, **effort)


def test_nulls_of_a_dihedral_are_not_warned_of():
    """Two bounces turn no polarisation either: rounding leaves 4e-19 m^2 of 166."""
    scene = ep.Scene()
    scene.add(ep.actors.dihedral(0.1), name="dihedral", material="metal")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        section = ep.rcs(scene, frequency=77e9, incidence=(-1, 0, 0), polarization=["vv", "hh", "vh", "hv"], num_rays=200_000)
    peak = 8.0 * np.pi * 0.1**4 / (ep.speed_of_light / 77e9) ** 2
    assert 10.0 * np.log10(section[:2] / peak) == pytest.approx([0.0, 0.0], abs=0.1)
    assert np.all(section[2:] < 1e-15 * peak)


@pytest.mark.parametrize("rays", [500, 2000, 5000])
def test_errors_hold_what_footprints_take_away(rays):
    """Upright edges of a plate that is seen aslant: all cells along one are in phase."""
    with pytest.warns(RuntimeWarning, match="not known to 3 dB"):
        few, error = ep.rcs(plate_scene(1.0), num_rays=8 * rays, return_error=True, **PLATE_ASKEW)
    many = ep.rcs(plate_scene(1.0), **PLATE_ASKEW)
    assert 0.5 * many < abs(few - many) < 2 * error
