"""faint_power: some of the faint diffuse paths count for all of them."""
import functools

import numpy as np
import pytest
from scipy import special

import echopath as ep

NUM_SEEDS, RAYS = 10, 4000
FIVE_SIGMA = 5.0
COVERAGE, CHANCE = 0.90, 1e-3  # of an interval to hold the truth; of the test to fail although it does so often
LAMBERT = ep.Material(reflectivity=0.3, scattering=1.0)


def radar(num_receivers: int = 1, power: float = 0.01) -> ep.Radar:
    chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=128, sampling_rate=20e6, num_chirps=32,
                              chirp_interval=1e-4)
    return ep.Radar(chirps, transmitters=[ep.Antenna((0, 0, 1))],
                    receivers=[ep.Antenna((0, 0.002 * i, 1)) for i in range(num_receivers)], transmit_power=power)


@functools.cache
def street() -> ep.Scene:
    scene = ep.Scene()
    mirror = ep.materials["concrete"].replace(mirror=True)
    scene.add(ep.actors.pedestrian(height=1.78, speed=1.4), name="walker", position=(9, 0, 0), yaw=np.pi)
    for name, y in (("left", 4), ("right", -5)):
        scene.add(ep.actors.wall(40, 6), name=name, material=mirror, position=(15, y, 0))
    scene.add(ep.actors.ground(60), name="road", material=mirror, position=(20, 0, 0))
    return scene


def power_by_range(paths) -> np.ndarray:
    return (np.abs(ep.range_doppler(ep.synthesize(paths), paths.radar).values[0, 0]) ** 2).sum(axis=0)


def test_it_is_given_or_goes_by_the_noise_of_the_array_and_is_off_unless_asked_for():
    def of(one_radar, **keywords):
        return ep.trace(street(), one_radar, num_rays=100, **keywords).frame.faint_power

    assert of(radar()) == 0.0 and of(radar(), faint_power=1e-18) == 1e-18
    for count in (1, 4):
        assert of(radar(count), faint_power="auto") == pytest.approx(ep.noise_power(radar(), "rect") / 40.0 / count, rel=1e-12)


@pytest.mark.parametrize("wrong", [-1.0, "loud", float("nan"), None])
def test_what_is_no_power_is_refused(wrong):
    with pytest.raises((TypeError, ValueError), match="faint_power"):
        ep.trace(street(), radar(), faint_power=wrong)


def test_the_mean_map_is_that_of_all_paths():
    """Along range, of the direct echo and of ghosts down to the noise: within what the seeds of both differ by."""
    maps = {faint: np.array([power_by_range(ep.trace(street(), radar(), num_rays=RAYS, seed=seed, faint_power=faint))
                             for seed in range(NUM_SEEDS)]) for faint in (0.0, "auto")}
    means = {faint: one.mean(axis=0) for faint, one in maps.items()}
    error = np.sqrt(sum(one.var(axis=0, ddof=1) for one in maps.values()) / NUM_SEEDS)
    seen = means[0.0] > ep.noise_power(radar())
    assert seen.sum() > 20
    assert (np.abs(means["auto"] - means[0.0])[seen] < FIVE_SIGMA * error[seen]).all()
    assert np.mean(10.0 * np.log10(means["auto"] / means[0.0])[seen]) == pytest.approx(0.0, abs=0.25)  # two thirds of an error


def test_most_paths_are_left_out_and_their_power_is_kept():
    every, some = (ep.trace(street(), radar(), num_rays=RAYS, faint_power=faint) for faint in (0.0, "auto"))
    left_out = some.frame.statistics.num_faint_paths
    assert some.num_paths + left_out == every.num_paths and left_out > 0.5 * every.num_paths
    assert some.frame.statistics.num_paths == some.num_paths and some.num_hits < every.num_hits
    assert some.power.sum() == pytest.approx(every.power.sum(), rel=0.01)
    is_coherent = (some.diffuse == 0).sum(), (every.diffuse == 0).sum()
    assert is_coherent[0] == is_coherent[1]


def plate():
    """A Lambert plate 20 m away that faces the radar, and its power in W: sigma = 4 A R of the reflectivity R, in the mean over
    the phases."""
    scene = ep.Scene()
    scene.add(ep.actors.plate(0.2, 0.2), name="plate", material=LAMBERT, position=(20, 0, 1))
    wavelength = ep.speed_of_light / 77e9
    return scene, 0.01 * 4.0 * 0.04 * 0.3 * wavelength ** 2 / ((4.0 * np.pi) ** 3 * 20.0 ** 4)


@pytest.mark.filterwarnings("ignore:trace. max_rays:RuntimeWarning")
def test_the_error_of_a_trace_to_a_target_counts_the_lot():
    scene, truth = plate()
    found = [ep.trace(scene, radar(), num_rays=2000, max_rays=2000, target_error_db=0.2, seed=seed, max_bounces=1,
                      faint_power=truth / 100.0) for seed in range(40)]
    scatter = np.std([10.0 * np.log10(ep.received_power(paths).power) for paths in found])
    assert scatter > 0.2
    assert np.mean([paths.frame.error_db for paths in found]) > 1.5 * scatter  # half of a 95 % interval


def test_intervals_count_what_is_left_to_chance():
    scene, truth = plate()
    found = [ep.received_power(ep.trace(scene, radar(), num_rays=2048, seed=seed, max_bounces=1, faint_power=truth / 100.0))
             for seed in range(60)]
    held = sum(one.low <= truth <= one.high for one in found)
    assert special.bdtr(held, len(found), COVERAGE) > CHANCE
    assert np.std([one.power for one in found]) > 0.03 * truth  # chance is at work


def test_where_the_lot_leaves_nothing_the_interval_reaches_over_what_it_took():
    """Of 23 paths to the plate one in 16 is kept: (15/16)^23 = 0.23 of the seeds have none, though the faint power is below
    the truth."""
    scene, truth = plate()
    found = [ep.received_power(ep.trace(scene, radar(), num_rays=24, seed=seed, max_bounces=1, faint_power=0.8 * truth))
             for seed in range(60)]
    emptied = [one for one in found if one.num_diffuse_hits == 0]
    assert 3 < len(emptied) < 30
    assert all(one.power == one.low == 0.0 and one.high > truth for one in emptied)
    every = ep.trace(scene, radar(), num_rays=24, max_bounces=1)
    assert ep.received_powers(every, np.zeros(every.num_paths, int), 2)[1].high == 0.0  # no lot: as before


def test_a_radar_that_hears_more_than_that_of_the_trace_is_told_so(recwarn):
    paths = ep.trace(street(), radar(), num_rays=RAYS, faint_power="auto")
    for quiet in (radar(), radar(power=0.02), radar(3)):
        ep.synthesize(paths, quiet)
    ep.synthesize(ep.trace(street(), radar(), num_rays=RAYS), radar(power=0.1))
    assert not recwarn.list
    with pytest.warns(RuntimeWarning, match="^radar: hears echoes 10 dB further above the noise"):
        ep.synthesize(paths, radar(power=0.1))


def test_a_live_scene_keeps_the_paths_that_a_new_one_keeps():
    live = ep.Live(street(), radar(), num_rays=RAYS, faint_power="auto")
    live.update()
    for change in (lambda scene: scene.add(ep.actors.box((1, 1, 1)), name="box", material=LAMBERT, position=(6, 2, 0.5)),
                   lambda scene: scene.remove("right"), lambda scene: setattr(scene["box"], "position", (6.1, 2, 0.5))):
        live.change(change)
        view = live.update()
        fresh = ep.Live(live.scene, radar(), num_rays=RAYS, faint_power="auto")
        cube = fresh.update().cube
        assert live.paths().num_paths == fresh.paths().num_paths
        assert np.abs(view.cube - cube).max() < 1e-12 * np.abs(cube).max()
        assert live.paths().frame.statistics.num_faint_paths > 0


def test_more_power_makes_fewer_paths_faint_and_shoots_no_ray():
    live = ep.Live(street(), radar(), num_rays=RAYS, faint_power="auto")
    live.update()
    before = live.paths().num_paths
    live.radar = radar(power=1.0)
    assert live.update().num_rays_shot == 0
    assert live.paths().num_paths > before


@pytest.mark.parametrize("first", ["upright", "level"])
def test_paths_are_faint_where_no_antenna_has_them_strong(first):
    """One receiver stands across the polarisation that comes back; the other has each path with more than the faint power."""
    of = {"upright": ep.Antenna((0, 0, 1), polarization=(0, 0, 1)), "level": ep.Antenna((0, 0, 1), polarization=(0, 1, 0))}
    names = sorted(of, key=lambda name: name != first)
    both = ep.Radar(radar().waveform, transmitters=[of["upright"]], receivers=[of[name] for name in names])

    def traced(**keywords):
        return ep.trace(plate()[0], both, num_rays=500, max_bounces=1, polarization="jones", **keywords)

    every = traced()
    powers = np.abs([every.amplitudes([every.frame.trace_time], 0, names.index(name))[0] for name in ("upright", "level")])**2
    assert powers[1].max() < powers[0].min() / 64
    assert traced(faint_power=0.99 * powers[0].min()).num_paths == every.num_paths
