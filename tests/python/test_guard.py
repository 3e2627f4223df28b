"""The guard of a run: spot checks against slow sums, silence where all is well, words where a protection is missing."""
import warnings

import numpy as np
import pytest

import echopath as ep

FREQUENCY = 77e9
EXACT = 1e-9         # of the sum of |a|: rates by differences of lengths 1e-7 s apart
SEEDS = 40


def make_radar(chirps=8, samples=32, antennas=1, real=False, chirp_interval=60e-6):
    waveform = ep.ChirpSequence(start_frequency=FREQUENCY, bandwidth=1e9, num_samples=samples, sampling_rate=20e6,
                                num_chirps=chirps, chirp_interval=chirp_interval, real=real)
    return ep.Radar(waveform, transmitters=[ep.Antenna((0, 0.002 * i, 1)) for i in range(antennas)],
                    receivers=[ep.Antenna((0, 0.01 + 0.002 * i, 1)) for i in range(antennas)])


def make_scene(turn=0.0):
    """A metal ball at rest, and a rough block that flies by and turns."""
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.1), name="ball", material=ep.Material.metal(), position=(3, 0.4, 1), smooth=True)
    rough = ep.Material(reflectivity=0.5, scattering=0.8)
    scene.add(ep.actors.box((0.6, 0.05, 0.02)), name="block", material=rough, position=(4, 0, 1),
              motion=ep.LinearMotion(velocity=(-20, 5, 0), angular_velocity=(0, 0, turn)))
    return scene


@pytest.fixture(scope="module")
def paths():
    return ep.trace(make_scene(turn=20.0), make_radar(), num_rays=3000, seed=4)


def slow_samples(paths, probe, radar):
    """What the probe drew, from lengths and amplitudes of all paths at the middle of the chirp: the model of PHYSICS 2.1."""
    waveform, start = radar.waveform, paths.frame.start_time
    slope, step = waveform.slope, 1e-7  # s
    centre = (waveform.num_samples - 1) / (2 * waveform.sampling_rate)
    out = []
    for tx, rx, chirp, samples in zip(probe.tx, probe.rx, probe.chirp, probe.sample):
        time = start + (chirp * len(radar.transmitters) + tx) * waveform.chirp_interval + centre
        before, lengths, after = (paths.lengths([time + shift], int(tx), int(rx))[0] for shift in (-step, 0.0, step))
        amplitude = paths.amplitudes([time], int(tx), int(rx))[0]
        delay, rate = lengths / ep.speed_of_light, (after - before) / (2 * step * ep.speed_of_light)
        beat = slope * delay + (FREQUENCY + slope * centre - slope * delay) * rate
        start_phase = (FREQUENCY + slope * centre) * delay - slope * delay**2 / 2
        cycles = start_phase + beat * (samples[:, None] / waveform.sampling_rate - centre)
        out.append(np.exp(2j * np.pi * cycles) @ np.conj(amplitude) / np.abs(amplitude).sum())
    return np.array(out)


def test_probed_samples_are_slow_sums_of_all_paths(paths):
    for seed in range(3):
        probe = ep.SignalProbe(seed=seed)
        ep.synthesize(paths, probe=probe)
        sums = probe.value / probe.amplitude_sum[:, None]
        assert np.abs(sums - slow_samples(paths, probe, paths.radar)).max() < EXACT
        assert probe.num_echoes.min() > 0 and probe.phase_error.max() < 1e-5


@pytest.mark.parametrize("settings", [{"method": "direct"}, {"method": "recurrence"},
                                      {"method": "nufft", "tolerance": 1e-12}, {"evaluate": "samples"}, {"evaluate": "chirps"}, {"replay": "fermat"},
                                      {"retrace": "invalid", "keyframes": 3}, {"retrace": "always", "keyframes": 2}],
                         ids=lambda settings: "-".join(map(str, settings.values())))
def test_every_way_to_a_signal_agrees(paths, settings):
    probe = ep.SignalProbe(seed=5)
    cube = ep.synthesize(paths, probe=probe, **settings)
    assert len(probe.chirp) == 2 * settings.get("keyframes", 1) and probe.chirp.max() < cube.shape[2]
    assert all(check.agrees for check in ep.check_signal(cube, probe, tolerance=settings.get("tolerance", 1e-7)))


def test_arrays_of_real_samples_agree(paths):
    radar = make_radar(antennas=3, real=True)
    for seed in range(4):
        probe = ep.SignalProbe(seed=seed)
        parts = ep.decompose(paths, radar, {"ball": "T 'ball' R", "block": "T 'block' R"}, probe=probe)
        assert all(check.agrees for check in ep.check_signal(sum(parts.values()), probe))


def test_spot_checks_do_not_depend_on_the_number_of_threads(paths):
    probes = []
    for threads in (1, 3):
        ep.set_num_threads(threads)
        probes.append(ep.SignalProbe(seed=2))
        ep.synthesize(paths, probe=probes[-1])
    ep.set_num_threads(0)
    assert np.array_equal(probes[0].value, probes[1].value)
    assert np.array_equal(probes[0].phase_error, probes[1].phase_error)


def test_silent_where_all_is_well():
    scene, radar = make_scene(turn=20.0), make_radar()
    with warnings.catch_warnings():
        warnings.simplefilter("error", ep.GuardWarning)
        frames = [ep.simulate(scene, radar, num_rays=400, seed=seed) for seed in range(SEEDS)]
    assert all(len(frame.checks) >= 3 for frame in frames)


def disagreeing(cube, probe, **promises) -> list:
    return [check.name for check in ep.check_signal(cube, probe, **promises) if not check.agrees]


def test_tells_of_a_tolerance_that_is_not_kept(paths):
    probe = ep.SignalProbe()
    cube = ep.synthesize(paths, probe=probe, method="nufft", tolerance=1e-3)
    assert disagreeing(cube, probe, tolerance=1e-3) == []
    assert disagreeing(cube, probe, tolerance=1e-9) == ["samples against direct sums"]


def test_tells_of_polynomials_of_too_low_an_order():
    scene = ep.Scene()
    scene.add(ep.actors.box((0.6, 0.04, 0.01)), name="rotor", position=(8, 0, 2),
              motion=ep.LinearMotion(angular_velocity=(0, 0, 800)), material=ep.Material(reflectivity=0.6, scattering=0.8))
    paths = ep.trace(scene, make_radar(chirps=128, chirp_interval=20e-6), num_rays=3000)
    probe = ep.SignalProbe()
    cube = ep.synthesize(paths, probe=probe)
    assert disagreeing(cube, probe) == []
    cube = ep.synthesize(paths, probe=probe, phase_tolerance=100.0)
    assert disagreeing(cube, probe) == ["moving echoes against exact ones, phase"]


@pytest.mark.parametrize("lost", [1, 20])
def test_tells_of_lost_echoes(paths, lost):
    probe = ep.SignalProbe()
    whole = ep.synthesize(paths, probe=probe)
    weakest_first = np.argsort(paths.power)
    kept = np.ones(paths.num_paths, bool)
    kept[weakest_first[paths.num_paths // 2:][:lost]] = False  # of middling power
    assert disagreeing(ep.synthesize(paths.select(kept)), probe) == ["samples against direct sums"]
    assert disagreeing(whole, probe) == []


def test_run_warns_and_can_do_without(monkeypatch):
    def off_by_a_little(paths, radar, **settings):
        return ep._core.synthesize(paths, radar, **settings) * (1 + 1e-3)

    scene, radar = make_scene(), make_radar()
    monkeypatch.setattr(ep, "synthesize", off_by_a_little)
    with pytest.warns(ep.GuardWarning, match="samples against direct sums: .* TOO MUCH"):
        frame = ep.simulate(scene, radar, num_rays=400)
    assert [check.agrees for check in frame.checks][0] is False
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert ep.simulate(scene, radar, num_rays=400, guard=False).checks == []


def test_checks_come_back_from_the_file(tmp_path):
    frame = ep.simulate(make_scene(), make_radar(), num_rays=400)
    ep.save_frame(frame, tmp_path / "frame.h5")
    assert frame.checks and ep.load_frame(tmp_path / "frame.h5").checks == frame.checks


def test_nothing_to_compare_is_no_disagreement():
    frame = ep.simulate(ep.Scene(), make_radar(), num_rays=10)
    assert [check.error for check in frame.checks] == [0.0]
