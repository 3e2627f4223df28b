"""Paths over the same hits are synthesised as one echo: the signal is that of all of them, however they are sorted."""
import itertools

import numpy as np
import pytest

import echopath as ep
from support.scenes.edge_scenes import on_edges

FREQUENCY = 77e9
EXACT = 1e-8          # of the sum of |a|: rates by differences of lengths 1e-7 s apart; a metre of length is 1
INTERPOLATED = 5e-4   # likewise: amplitudes aim for 1e-4, of each path's largest
ADDITIVITY = 1e-13    # of the sum of |a|: other orders of adding up


def make_radar(antennas=1, chirps=24, receivers=None, apart=0.01):
    """apart: m, of transmitters"""
    waveform = ep.ChirpSequence(start_frequency=FREQUENCY, bandwidth=1e8, num_samples=16, sampling_rate=20e6,
                                num_chirps=chirps, chirp_interval=60e-6)
    return ep.Radar(waveform, transmitters=[ep.Antenna((0, apart * i, 1)) for i in range(antennas)],
                    receivers=[ep.Antenna((0, 0.05 + 0.002 * i, 1)) for i in range(receivers or antennas)])


@pytest.fixture(scope="module")
def scene():
    """Rough bodies that drive, turn and stand before a rough wall."""
    scene, rough = ep.Scene(), ep.Material(reflectivity=0.6, scattering=0.7)
    scene.add(ep.actors.box((1.0, 0.5, 0.5)), name="car", material=rough, position=(6, 0, 1),
              motion=ep.LinearMotion(velocity=(-20, 3, 0), angular_velocity=(0, 0, 1)))
    scene.add(ep.actors.box((0.6, 0.04, 0.04)), name="rotor", material=rough, position=(5, 0.6, 1.6),
              motion=ep.LinearMotion(angular_velocity=(0, 0, 800)))
    scene.add(ep.actors.box((0.5, 0.5, 0.5)), name="stone", material=rough, position=(5, -1, 0.5))
    scene.add(ep.actors.wall(20.0, 6.0), name="wall", position=(8, 3, 0),
              material=rough)
    return scene


@pytest.fixture(scope="module")
def paths(scene):
    return ep.trace(scene, make_radar(), num_rays=1500, max_bounces=2, seed=2)


def shares_hits(paths):
    """Of each path but the first, whether it stands over the hits of the one before."""
    return (np.diff(paths.offsets) == 0) & (np.diff(paths.num_bounces.astype(int)) == 0)


def slow_signal(paths, tx, rx):
    """IF samples [chirp, sample] of a channel from lengths and amplitudes at the middle of each chirp, as if nothing
    moved within one."""
    radar, step = paths.radar, 1e-7  # s
    waveform = radar.waveform
    slope, centre = waveform.slope, (waveform.num_samples - 1) / (2 * waveform.sampling_rate)
    chirps = []
    for chirp in range(waveform.num_chirps):
        time = paths.frame.start_time + (chirp * len(radar.transmitters) + tx) * waveform.chirp_interval + centre
        before, lengths, after = (paths.lengths([time + shift], tx, rx)[0] for shift in (-step, 0.0, step))
        amplitude = paths.amplitudes([time], tx, rx)[0]
        delay, rate = lengths / ep.speed_of_light, (after - before) / (2 * step * ep.speed_of_light)
        beat = slope * delay + (FREQUENCY + slope * centre - slope * delay) * rate
        start_phase = (FREQUENCY + slope * centre) * delay - slope * delay**2 / 2
        time_of = np.arange(waveform.num_samples)[:, None] / waveform.sampling_rate - centre
        chirps.append(np.exp(2j * np.pi * (start_phase + beat * time_of)) @ np.conj(amplitude))
    return np.array(chirps)


def amplitude_sum(paths):
    return np.abs(paths.amplitudes([paths.frame.trace_time])[0]).sum()


def test_many_hits_send_two_paths_back(paths):
    assert shares_hits(paths).mean() > 0.25  # where planes image themselves, rays send back one


@pytest.mark.parametrize("settings, tolerance", [({"evaluate": "chirps"}, EXACT), ({}, INTERPOLATED)],
                         ids=["chirps", "interpolated"])
@pytest.mark.parametrize("antennas", [1, 2])
def test_the_signal_is_the_slow_sum_over_all_paths(scene, settings, tolerance, antennas):
    paths = ep.trace(scene, make_radar(antennas), num_rays=1000, max_bounces=2, seed=3)
    cube = ep.synthesize(paths, tolerance=1e-11, **settings)
    last = antennas - 1
    difference = cube[last, last] - slow_signal(paths, last, last)
    assert np.abs(difference).max() < tolerance * amplitude_sum(paths)


@pytest.mark.parametrize("settings, tolerance", [({"evaluate": "chirps"}, EXACT), ({}, INTERPOLATED)],
                         ids=["chirps", "interpolated"])
def test_all_channels_of_a_large_array_have_the_slow_sum(scene, settings, tolerance):
    """Large arrays are replayed for a few transmitters at a time."""
    paths = ep.trace(scene, make_radar(40, chirps=2, receivers=4), num_rays=300, max_bounces=2, seed=3)
    cube, bound = ep.synthesize(paths, tolerance=1e-11, **settings), tolerance * amplitude_sum(paths)
    for tx, rx in itertools.product(range(40), (0, 3)):
        assert np.abs(cube[tx, rx] - slow_signal(paths, tx, rx)).max() < bound


def mixed_scene():
    """All that replay has factors of its own for: a floor that images, a pane, lobes, smooth bodies and sharp edges."""
    scene, drives = ep.Scene(), ep.LinearMotion(velocity=(-3, 1, 0))
    lobed = ep.Material(reflectivity=0.6, scattering=0.7, lobe_exponent=4, backscatter_share=0.3)
    scene.add(ep.actors.ground(12.0), name="floor", material=ep.Material(permittivity=5, mirror=True), position=(5, 0, 0))
    scene.add(ep.actors.plate(1.0, 1.0), name="pane", material=ep.Material(layers=[ep.Layer(0.004, 6.3 - 0.3j)]),
              position=(2, 0.6, 1))
    scene.add(ep.actors.box((0.8, 0.5, 0.5)), name="car", material=lobed, position=(6, 0.8, 1), motion=drives)
    scene.add(ep.actors.box((0.3, 0.3, 0.3)), name="crate", material="metal", position=(5, -0.8, 1.2), yaw=0.3, motion=drives)
    scene.add(ep.actors.sphere(0.2), name="ball", material=ep.Material(permittivity=4), position=(4, 0, 1), smooth=True,
              motion=drives)
    return scene


@pytest.mark.parametrize("polarization", ["scalar", "jones"])
def test_channels_of_a_large_array_have_the_slow_sum_of_all_that_replay_knows(polarization):
    """Antennas stand apart and are tilted, each by another angle, so that no channel has the factors of its neighbour."""
    radar = make_radar(20, chirps=2, receivers=8, apart=0.05)
    tilted = [[ep.Antenna(one.position, polarization=(0, np.sin(0.1 * i), np.cos(0.1 * i))) for i, one in enumerate(side)]
              for side in (radar.transmitters, radar.receivers)]
    if polarization == "jones":
        radar = radar.replace(transmitters=tilted[0], receivers=tilted[1])
    paths = ep.trace(mixed_scene(), radar, num_rays=500, max_bounces=3, seed=3, polarization=polarization, edges=True)
    assert all(paths.select(f"T .* '{name}' .* R").num_paths for name in ("floor", "car", "crate", "ball"))
    assert on_edges(paths).num_paths and len(paths.passes)
    behind_pane_with_lobe = paths.select("T P D'car' P R")
    for some in (paths, behind_pane_with_lobe):
        cube, bound = ep.synthesize(some, tolerance=1e-11), INTERPOLATED * amplitude_sum(some)
        for tx, rx in itertools.product(range(0, 20, 3), (0, 5)):
            assert np.abs(cube[tx, rx] - slow_signal(some, tx, rx)).max() < bound


@pytest.mark.parametrize("method", ["nufft", "direct"])
def test_what_a_hit_sends_back_in_two_ways_adds_up(paths, method):
    kinds = {"specular": "T S* R", "rough at the end": "T .* D R"}
    whole = ep.synthesize(paths, tolerance=1e-10, method=method)
    alone = [ep.synthesize(paths.select(kind), tolerance=1e-10, method=method) for kind in kinds.values()]
    together = ep.decompose(paths, paths.radar, kinds, tolerance=1e-10, method=method)
    bound = ADDITIVITY * amplitude_sum(paths)
    for part, name in zip(alone, kinds):
        assert np.abs(part).max() > 1e-3 * np.abs(whole).max()
        assert np.abs(part - together[name]).max() < bound
    assert np.abs(sum(together.values()) - whole).max() < bound


def test_a_probe_sees_every_path_and_changes_nothing(paths):
    probe = ep.SignalProbe(seed=3)
    watched = ep.synthesize(paths, probe=probe, tolerance=1e-10)
    assert np.array_equal(watched, ep.synthesize(paths, tolerance=1e-10))
    time = paths.frame.start_time + probe.chirp[0] * 60e-6 + 7.5 / 20e6
    power = np.abs(paths.amplitudes([time])[0])**2
    assert probe.power_sum[0] == pytest.approx(power.sum(), rel=1e-4)


def test_a_probe_changes_no_bit_of_what_is_evaluated_in_every_chirp():
    """Hundreds of echoes of amplitudes that no polynomial follows, over one and over two hits."""
    scene, rough = ep.Scene(), ep.Material(reflectivity=0.6, scattering=0.7)
    scene.add(ep.actors.box((2.0, 1.0, 1.0)), name="rotor", material=rough, position=(5, 0, 1),
              motion=ep.LinearMotion(angular_velocity=(0, 0, 1500)))
    scene.add(ep.actors.wall(20.0, 6.0), name="wall", position=(8, 3, 0), material=rough)
    paths = ep.trace(scene, make_radar(), num_rays=3000, max_bounces=2, seed=2)
    assert shares_hits(paths).sum() > 1000
    assert np.array_equal(ep.synthesize(paths, probe=ep.SignalProbe(seed=3)), ep.synthesize(paths))


def test_bits_do_not_depend_on_the_number_of_threads(paths):
    cubes = []
    try:
        for threads in (1, 3):
            ep.set_num_threads(threads)
            cubes.append(ep.synthesize(paths))
    finally:
        ep.set_num_threads(0)
    assert np.array_equal(*cubes)
