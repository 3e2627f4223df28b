"""The guard of a run: spot checks against slow sums, silence where all is well, words where a protection is missing."""
import warnings

import numpy as np
import pytest

import echopath as ep
from echopath.guard import check_rays
from echopath.guard.check import Check
from support.radars import FREQUENCY, build_radar

pytestmark = pytest.mark.hard

EXACT = 1e-9         # of the sum of |a|: rates by differences of lengths 1e-7 s apart
SEEDS = 40
BATCHES = 8
SUMS = 1e-6          # relative: single precision of weights
FOLLOWED = 1e-5      # rad: what replay promises


def make_radar(chirps=8, samples=32, antennas=1, **settings):
    return build_radar([(0, 0.002 * i, 1) for i in range(antennas)], [(0, 0.01 + 0.002 * i, 1) for i in range(antennas)],
                       num_chirps=chirps, num_samples=samples, **settings)


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
    """What the probe drew, from lengths and amplitudes of all paths at the middle of the chirp."""
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
        assert probe.num_echoes.min() > 0 and probe.phase_error.max() < FOLLOWED


@pytest.mark.parametrize("settings", [{"method": "direct"}, {"method": "recurrence"},
                                      {"method": "nufft", "tolerance": 1e-12}, {"evaluate": "samples"},
                                      {"evaluate": "chirps"},
                                      {"replay": "fermat"},
                                      {"retrace": "invalid", "keyframes": 3}, {"retrace": "always", "keyframes": 2}],
                         ids=lambda settings: "-".join(map(str, settings.values())))
def test_every_way_to_a_signal_agrees(paths, settings):
    probe = ep.SignalProbe(seed=5)
    cube = ep.synthesize(paths, probe=probe, **settings)
    assert len(probe.chirp) == settings.get("keyframes", 1) and probe.chirp.max() < cube.shape[2]
    assert all(check.agrees for check in ep.check_signal(cube, probe, tolerance=settings.get("tolerance", 1e-7)))


@pytest.mark.parametrize("samples", [1, 2, 5, 8, 9, 33])
def test_probed_samples_are_as_many_as_there_are_and_evenly_spaced(paths, samples):
    radar = make_radar(samples=samples, bandwidth=1e9 * samples / 32)  # no echo beyond the anti-alias filter
    for seed in range(4):
        probe = ep.SignalProbe(seed=seed)
        ep.synthesize(paths, radar, probe=probe)
        drawn = probe.sample[0, :min(samples, 8)]
        assert drawn.min() >= 0 and drawn.max() < samples and len(np.unique(np.diff(drawn))) <= 1
        assert len(np.unique(drawn)) == len(drawn) and set(probe.sample[0]) == set(drawn)
        sums = probe.value / probe.amplitude_sum[:, None]
        assert np.abs(sums - slow_samples(paths, probe, radar)).max() < EXACT


def test_arrays_of_real_samples_agree(paths):
    radar = make_radar(antennas=3, real=True)
    for seed in range(4):
        probe = ep.SignalProbe(seed=seed)
        parts = ep.decompose(paths, radar, {"ball": "T 'ball' R", "block": "T 'block' R"}, probe=probe)
        assert len(probe.chirp) == 2
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


@pytest.mark.parametrize("batches", [None, BATCHES])
def test_silent_where_all_is_well(batches):
    scene, radar = make_scene(turn=20.0), make_radar()
    with warnings.catch_warnings():
        warnings.simplefilter("error", ep.GuardWarning)
        frames = [ep.simulate(scene, radar, num_rays=1000, seed=seed, batches=batches) for seed in range(SEEDS)]
    assert all(len(frame.checks) == (5 if batches is None else 7) for frame in frames)


def test_signals_that_are_not_those_of_the_probe_are_refused(paths):
    probe = ep.SignalProbe()
    cube = np.zeros((1, 1, 8, 32), complex)
    with pytest.raises(ValueError, match="^probe: must be one that synthesize or decompose has filled"):
        ep.check_signal(cube, probe)
    cube = ep.synthesize(paths, probe=probe)
    for other in (cube[:, :, :0], cube[:, :, :, :1], cube[:, :0]):
        with pytest.raises(ValueError, match="^cube: must be the one that the probe was filled with, of at least "):
            ep.check_signal(other, probe)


def disagreeing(cube, probe, **promises) -> list:
    return [check.name for check in ep.check_signal(cube, probe, **promises) if not check.agrees]


def test_tells_of_a_tolerance_that_is_not_kept(paths):
    probe = ep.SignalProbe()
    cube = ep.synthesize(paths, probe=probe, method="nufft", tolerance=1e-3)
    assert disagreeing(cube, probe, tolerance=1e-3) == []
    assert disagreeing(cube, probe, tolerance=1e-9) == ["samples against direct sums"]


def test_tells_of_polynomials_of_too_low_an_order():
    scene = ep.Scene()
    scene.add(ep.actors.box((0.6, 0.04, 0.01)), name="rotor", position=(4, 0, 2),
              motion=ep.LinearMotion(angular_velocity=(0, 0, 800)), material=ep.Material(reflectivity=0.6, scattering=0.8))
    paths = ep.trace(scene, make_radar(chirps=128, chirp_interval=20e-6), num_rays=3000)
    probe = ep.SignalProbe()
    cube = ep.synthesize(paths, probe=probe)
    assert disagreeing(cube, probe) == []
    cube = ep.synthesize(paths, probe=probe, phase_tolerance=100.0)
    assert disagreeing(cube, probe) == ["moving echoes, phase"]


@pytest.mark.parametrize("rate, turn, is_heard", [(30.0, 0.0, True), (100.0, 0.1, True), (30.0, 0.3, False)])
def test_silent_of_blades_that_flash_and_of_dark_ones(rate, turn, is_heard):
    """Metal blades that are broadside once in the frame, and one of which footprints leave less than a millionth of the noise."""
    radar = make_radar(chirps=128, chirp_interval=20e-6, bandwidth=150e6)
    scene = ep.Scene()
    scene.add(name="hub", position=(20, 0, 1), motion=ep.LinearMotion(angular_velocity=(0, 0, rate)))
    yaw = turn - rate * radar.middle_of_frame()
    scene.add(ep.actors.plate(2.0, 0.2), name="blade", parent="hub", material="metal", yaw=yaw)
    paths = ep.trace(scene, radar, num_rays=1000, max_bounces=1)
    sizes = np.abs(paths.amplitudes(np.linspace(0.0, radar.frame_duration, 257)))
    noise = ep.noise_power(radar) / (128 * 32)  # of a cell
    assert 0.0 < sizes.max() and (np.sum(sizes.max(axis=0)**2) > 1e-6 * noise) == is_heard
    is_strict = []
    for seed in range(SEEDS):
        probe = ep.SignalProbe(seed=seed)
        cube = ep.synthesize(paths, probe=probe)
        assert probe.num_echoes.sum() > 0 and disagreeing(cube, probe) == []
        is_strict += disagreeing(cube, probe, phase_tolerance=1e-9)
    assert ("moving echoes, size" in is_strict) == is_heard


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
    synthesize = ep._core.synthesize

    def off_by_a_little(paths, radar, **settings):
        return synthesize(paths, radar, **settings) * (1 + 1e-3)

    scene, radar = make_scene(), make_radar()
    monkeypatch.setattr(ep._core, "synthesize", off_by_a_little)
    with pytest.warns(ep.GuardWarning, match="samples against direct sums: .* TOO MUCH"):
        frame = ep.simulate(scene, radar, num_rays=400)
    assert [check.agrees for check in frame.checks][0] is False
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert ep.simulate(scene, radar, num_rays=400, guard=False).checks == []


def test_an_error_just_beyond_its_promise_is_not_written_like_it():
    check = Check("halves of the rays", 3.004, 3.0, "dB", 2)
    assert str(check) == "3.004 dB, promised 3: TOO MUCH (2 compared)"


def test_checks_come_back_from_the_file(tmp_path):
    frame = ep.simulate(make_scene(), make_radar(), num_rays=400)
    ep.save_frame(frame, tmp_path / "frame.h5")
    assert frame.checks and ep.load_frame(tmp_path / "frame.h5").checks == frame.checks


def test_nothing_to_compare_is_no_disagreement():
    frame = ep.simulate(ep.Scene(), make_radar(), num_rays=10)
    assert [check.error for check in frame.checks] == [0.0]


# --- rays and batches ---

def filled_probe(paths, seed=1):
    probe = ep.SignalProbe(seed=seed)
    ep.synthesize(paths, probe=probe)
    return probe


def alarms(paths, seed=1) -> set:
    return {check.name for check in check_rays(filled_probe(paths, seed), paths.frame) if not check.agrees}


def test_thresholds_are_those_of_student():
    """|t| with one degree of freedom lies below x with the probability 2 atan(x) / pi, with two with x / sqrt(2 + x^2). Each of
    the three tests errs by chance once in 3000 runs, so each of four batches once in 12,000."""
    promises = {}
    for batches in (2, 4):
        paths = ep.trace(make_scene(), make_radar(), num_rays=3000, batches=batches, seed=2)
        promises[batches] = {check.name: check.promise for check in check_rays(filled_probe(paths), paths.frame)}
    rate = 1e-3 / 3
    assert promises[2]["halves of the rays"] == pytest.approx(1.0 / np.tan(0.5 * np.pi * rate), rel=1e-8)
    for name, below in (("halves of the batches", 1.0 - rate), ("one batch against the others", 1.0 - rate / 4)):
        assert promises[4][name] == pytest.approx(below * np.sqrt(2.0 / (1.0 - below**2)), rel=1e-8)


def test_shares_are_sums_over_their_own_paths():
    paths = ep.trace(make_scene(), make_radar(), num_rays=3000, batches=4, seed=2)
    probe = filled_probe(paths)
    time = paths.frame.start_time + int(probe.chirp[0]) * 60e-6 + 31 / 2 / 20e6
    power = np.abs(paths.amplitudes([time])[0]) ** 2
    half, is_rough = paths.flags >> 1 & 1, paths.diffuse != 0
    shares = [(paths.batch == batch) & (half == second) for batch in range(4) for second in (0, 1)]
    expected = [power[share & is_rough].sum() for share in shares]
    assert probe.share_power == pytest.approx([*expected, 0.0], rel=SUMS)
    assert probe.power_sum[0] == pytest.approx(power.sum(), rel=SUMS)
    assert probe.strongest[0] == pytest.approx(power.max(), rel=SUMS)
    rough = paths.select(is_rough)
    fields = probe.share_field.sum(axis=0) - (probe.value[0] - filled_probe(rough).value[0])
    assert np.abs(fields).max() < EXACT * probe.amplitude_sum[0]
    assert 0.45 < np.mean(half[is_rough]) < 0.55


def glint_scene():
    """A dim wall and a bright little plate close by, which belong to one object and share its rays by their solid angles."""
    scene = ep.Scene()
    scene.add(None, name="site")
    for name, width, position, level in (("wall", 10.0, (20, 0, 1), 0.1), ("glint", 0.02, (1, 0.05, 1.02), 1.0)):
        scene.add(ep.actors.plate(width, width), name=name, parent="site", position=position,
                  material=ep.Material(reflectivity=level, scattering=1.0))
    return scene


@pytest.mark.parametrize("batches", [None, BATCHES])
def test_tells_of_a_strong_glint_that_few_rays_have_found(batches):
    scene, radar, found, told = glint_scene(), make_radar(), 0, 0
    for seed in range(20):
        paths = ep.trace(scene, radar, num_rays=900, batches=batches, seed=seed)
        glints = np.count_nonzero(paths.mesh_id == 1)
        if 0 < glints <= 3:
            found += 1
            told += bool(alarms(paths, seed))
    assert found >= 10 and told >= 0.9 * found
    assert not alarms(ep.trace(scene, radar, num_rays=400_000, batches=batches))


def with_weights(paths, factor):
    names = ("hits", "offsets", "num_bounces", "diffuse", "stratum", "batch", "flags", "scene", "radar", "frame")
    columns = {name: getattr(paths, name) for name in names}
    return ep.Paths.from_arrays(weight=(paths.weight * factor).astype(np.complex64), **columns)


@pytest.mark.parametrize("name, is_wrong", [
    ("halves of the rays", lambda paths: paths.flags & 2 != 0),
    ("halves of the batches", lambda paths: paths.batch < BATCHES // 2),
    ("one batch against the others", lambda paths: paths.batch == 3)], ids=["rays", "batches", "one batch"])
def test_tells_of_wrong_weights_of_some_rays(name, is_wrong):
    scene = ep.Scene()
    scene.add(ep.actors.plate(3.0, 3.0), name="plate", position=(4, 0, 1),
              material=ep.Material(reflectivity=0.5, scattering=1.0))
    paths = ep.trace(scene, make_radar(), num_rays=4000, batches=BATCHES)
    assert alarms(paths) == set()
    assert name in alarms(with_weights(paths, np.where(is_wrong(paths), 1.2, 1.0)))


def test_tells_of_a_target_that_was_not_met():
    with pytest.warns(ep.GuardWarning, match="error against its target"):
        ep.simulate(make_scene(), make_radar(), target_error_db=1e-3, num_rays=1000, max_rays=2000)


def test_paths_of_another_number_of_batches_are_not_judged(paths):
    assert check_rays(ep.SignalProbe(), paths.frame) == []
