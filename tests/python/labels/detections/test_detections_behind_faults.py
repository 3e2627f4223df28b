"""Detections in what a faulty receiver gives: what is noise against the signal of the echoes behind the same receiver."""
from __future__ import annotations

import warnings

import numpy as np
import pytest

import echopath as ep
from echopath.receiver.echo_gains import EchoGains
from echopath.signals.beside import leakage_map
from echopath.transmit import signal_shape
from support.radars import build_radar
from support.scenes.small_spheres import TARGETS, nearest

FAULTS = {
    "receivers": dict(receiver_gain_db=[6.0] * 8), "a receiver": dict(receiver_gain_db=[15.0] + [0.0] * 7),
    "transmitters": dict(transmitter_gain_db=[5.0]), "drift": dict(gain_drift_db=[300.0] * 8),
    "weak receivers": dict(receiver_gain_db=[-9.0] * 8), "filters": dict(high_pass=[2e6, 2e6], low_pass=6e6)}
FALSE_ALARMS = 0.01
BORDERLINE = 0.02  # of detections, whose echoes hold nearly half of their power


@pytest.mark.parametrize("fault, start_time", [*((fault, 0.0) for fault in FAULTS), ("drift", 0.02), ("filters", 0.02)])
def test_noise_is_what_echoes_behind_the_receiver_hold_less_than_half_of(spheres, fault, start_time):
    radar, paths, _ = spheres
    radar = radar.replace(receiver=ep.Receiver(**FAULTS[fault]))
    paths = ep.trace(paths.scene, radar, num_rays=6000, max_bounces=1, start_time=start_time)
    parts = ep.decompose(paths, radar, {name: f"T '{name}' R" for name in TARGETS})
    spectrum = ep.range_doppler(ep.receive(sum(parts.values()), radar, seed=1, start_time=start_time).cube, radar)
    received = ep.receive_parts(parts, radar, seed=1, start_time=start_time)
    echoes = ep.range_doppler(sum(received[name] for name in TARGETS), radar)
    for source in [{"parts": parts}, {}]:
        found = ep.detect(spectrum, radar, false_alarm_rate=FALSE_ALARMS, paths=paths, **source)
        share, power = (np.mean(np.abs(one.values) ** 2, axis=(0, 1))[tuple(found.cells.T)] for one in (echoes, spectrum))
        wrong = found.is_noise != (share < 0.5 * power)
        assert found.is_noise.sum() > 20 and wrong.mean() <= BORDERLINE, np.count_nonzero(wrong)
        assert [found.object[nearest(found, name)] for name in TARGETS] == list(TARGETS)


def test_images_of_echoes_are_noise_and_the_echoes_are_not(spheres):
    """Of a branch Q that is 9 dB too strong an echo keeps 5.6 dB more than it had, and its image has the rest."""
    radar, paths, _ = spheres
    radar = radar.replace(receiver=ep.Receiver(iq_gain_db=9.0))
    paths = ep.trace(paths.scene, radar, num_rays=6000, max_bounces=1)
    spectrum = ep.range_doppler(ep.receive(ep.synthesize(paths, radar), radar, seed=1).cube, radar)
    found = ep.detect(spectrum, radar, paths=paths)
    assert sorted(found.object) == ["", "", "", *sorted(TARGETS)] and np.array_equal(found.is_noise, found.object == "")
    far = [-TARGETS[name][0] % radar.waveform.max_range for name in TARGETS]
    assert sorted(found.range[found.is_noise]) == pytest.approx(sorted(far), abs=radar.waveform.range_resolution)


def test_labels_tell_noise_behind_the_receiver_too(spheres):
    radar, paths, _ = spheres
    radar = radar.replace(receiver=ep.Receiver(receiver_gain_db=[6.0] * 8))
    cube = ep.synthesize(paths, radar)
    labels = ep.annotate(paths, ep.decompose(paths, radar, {"near": "T 'near' R"}), radar)
    found = ep.detect(ep.range_doppler(ep.receive(cube, radar, seed=1).cube, radar), radar, labels=labels)
    assert not found.is_noise.any() and set(found.object) == set(TARGETS)


@pytest.mark.parametrize("labels", [False, True])
def test_leakage_in_the_first_cell_behind_a_high_pass_is_no_noise(labels):
    """It beats at 0.4 bins, in the cell of frequency 0, where the filter lets nothing through."""
    receiver = ep.Receiver(leakage_db=[[-40.0]], leakage_delay=0.4 / 4e9, high_pass=[50e3])  # of a bandwidth of 4 GHz
    radar = build_radar(start_frequency=78e9, bandwidth=4e9, num_samples=1024, sampling_rate=4e6, num_chirps=32,
                        chirp_interval=0.3e-3, transmit_power=1e-3, receiver=receiver)
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.1), name="ball", material="metal", smooth=True, position=(5, 0, 0))
    found = ep.simulate(scene, radar, num_rays=2000, guard=False, detections=True, labels=labels).detections
    first = found.range < radar.waveform.range_resolution
    assert first.any() and np.all(found.snr_db[first] > 40.0) and set(found.part[first]) == {"leakage"}


@pytest.mark.parametrize("real", [False, True])
@pytest.mark.parametrize("labels", [False, True])
def test_an_echo_between_two_cells_behind_high_passes_is_no_noise(real, labels):
    """It beats at 1.4 bins, where two filters far below their corners pass 3.8 times the power that they pass at one bin."""
    radar = build_radar(start_frequency=76.5e9, bandwidth=300e6, num_samples=64, sampling_rate=6.4e6, num_chirps=24,
                        chirp_interval=20e-6, transmit_power=0.02, real=real, receiver=ep.Receiver(high_pass=[0.8e6, 0.8e6]))
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.1), name="ball", material="metal", smooth=True,
              position=(1.4 * radar.waveform.range_resolution + 0.1, 0, 0))
    frame = ep.simulate(scene, radar, num_rays=500, guard=False, detections=True, labels=labels, noise_seed=1)
    near = frame.detections.range < 2.0 * radar.waveform.range_resolution
    assert near.any() and np.all(frame.detections.snr_db[near] > 20.0)
    assert set(frame.detections.object[near]) == {"ball"} and set(frame.detections.cells[near, 1]) == {1}


@pytest.mark.parametrize("faults", [dict(high_pass=[200e3]), dict(receiver_phase=[1.5])], ids=["filter", "chain"])
def test_real_samples_of_leakage_are_told_in_the_phase_that_the_receiver_gives_them(faults):
    """Of 0.6 periods in a chirp, the first cell has a level for each phase: that of the tone behind the receiver, by its closed
    form, is 10 dB above the one without faults."""
    delay, corner = 2e-9, faults.get("high_pass", [0.0])[0]
    radar = build_radar(start_frequency=76.5e9, bandwidth=300e6, num_samples=64, sampling_rate=6.4e6, num_chirps=24,
                        chirp_interval=20e-6, transmit_power=0.02, real=True,
                        receiver=ep.Receiver(leakage_db=[[-50.0]], leakage_delay=delay, **faults))
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.1), name="ball", material="metal", smooth=True, position=(14, 2, 0))
    frame = ep.simulate(scene, radar, num_rays=500, guard=False, detections=True, noise_seed=1)
    slope, time = 300e6 / 10e-6, np.arange(64) / 6.4e6
    beat = slope * delay
    turn = 1j * beat / (1j * beat + corner) * np.exp(1j * faults.get("receiver_phase", [0.0])[0])
    phase = 2.0 * np.pi * (76.5e9 * delay + beat * time - 0.5 * slope * delay ** 2) + np.angle(turn)
    window = 0.5 - 0.5 * np.cos(2.0 * np.pi * np.arange(64) / 64)
    amplitude = 2.0 * np.sqrt(0.02 * 1e-5) * np.sum(window * np.cos(phase)) / window.sum()  # of the lower half, times sqrt(2)
    assert np.abs(frame.beside_spectra["leakage"].values[0, 0, 12, 0]) == pytest.approx(abs(amplitude), rel=1e-6)
    first = frame.detections.range < radar.waveform.range_resolution
    assert first.any() and set(frame.detections.part[first]) == {"leakage"}


def test_beams_tell_real_samples_of_leakage_behind_chains_out_of_phase():
    """The only thing 50 dB above the noise."""
    radar = build_radar([(0, 0, 0)], [(0, 0.00193 * n, 0) for n in range(4)], bandwidth=300e6, sampling_rate=6.4e6, num_chirps=24,
                        chirp_interval=20e-6, real=True,
                        receiver=ep.Receiver(leakage_db=[[-50.0] * 4], leakage_delay=2e-9, receiver_phase=[0.0, 1.5, -2.0, 2.8]))
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.1), name="ball", material="metal", smooth=True, position=(14, 2, 0))
    found = ep.simulate(scene, radar, num_rays=300, guard=False, noise_seed=1, detections={"beams": True}).detections
    assert set(found.part[found.snr_db > 50.0]) == {"leakage"}


def test_images_far_from_leakage_behind_a_high_pass_are_noise_and_not_leakage():
    """What "ddm" leaves of the leakage at the ranges of the images is above them before the filter, and far below behind it."""
    half = 0.00193
    radar = build_radar([ep.Antenna((0, 4 * m * half, 0)) for m in range(3)], [ep.Antenna((0, n * half, 0)) for n in range(4)],
                        bandwidth=1e9, num_samples=256, sampling_rate=20e6, num_chirps=64, chirp_interval=20e-6,
                        transmit_power=0.1, multiplexing="ddm",
                        receiver=ep.Receiver(leakage_db=np.full((3, 4), -40.0), leakage_delay=0.3e-9, high_pass=[175e3, 350e3],
                                             iq_gain_db=3.0))
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.2), name="ball", material="metal", smooth=True, position=(4, 0, 0), speed=-4.0)
    frame = ep.simulate(scene, radar, num_rays=1000, guard=False, detections=True, parts={"ball": "T 'ball' R"})
    found, parts = frame.detections, frame.received_parts["parts"]
    leaked = ep.range_doppler(ep.demultiplex(parts["leakage"], radar), radar)
    share = np.mean(np.abs(leaked.values) ** 2, axis=(0, 1))[tuple(found.cells.T)] / found.power
    is_image = np.abs(found.range - (radar.waveform.max_range - 3.8)) < 1.0
    assert is_image.any() and np.all(share[is_image] < 0.01)
    assert not np.any(found.part[is_image] == "leakage") and found.is_noise[is_image].all()


@pytest.mark.parametrize("source", ["paths", "parts"])
@pytest.mark.parametrize("faults", [dict(receiver_phase=3.0 * np.cos(5.0 * np.arange(8))),
                                    dict(phase_drift=300.0 * np.cos(5.0 * np.arange(8))),
                                    dict(transmitter_phase=[0.0, 3.0])], ids=["receivers", "drift", "transmitters"])
def test_echoes_are_no_noise_in_beams_that_phases_of_the_chains_turn(spheres, faults, source):
    """Those that stand 20 dB and more above the noise, in the beams that find them behind the receiver."""
    radar, paths, _ = spheres
    if "transmitter_phase" in faults:
        radar = radar.replace(transmitters=[*radar.transmitters, ep.Antenna((0, 4.0 * radar.waveform.wavelength, 0))])
    radar = radar.replace(receiver=ep.Receiver(**faults))
    paths = ep.trace(paths.scene, radar, num_rays=6000, max_bounces=1, start_time=0.01)
    cube = ep.receive(ep.synthesize(paths), radar, seed=1, start_time=0.01).cube
    parts = {"parts": {"all": ep.synthesize(paths)}, "start_time": 0.01}
    found = ep.detect(ep.range_doppler(cube, radar), radar, beams=True, **({"paths": paths} if source == "paths" else parts))
    strong = found.snr_db > 20.0
    assert strong.sum() == len(TARGETS) and not found.is_noise[strong].any()


def test_parts_and_labels_without_paths_are_told_when_the_frame_begins(spheres):
    """By then gains have drifted by 30 dB: echoes as they were at time 0 hold a thousandth of their power."""
    radar, paths, _ = spheres
    radar, late = radar.replace(receiver=ep.Receiver(gain_drift_db=[3.0] * 8)), 10.0
    parts = ep.decompose(paths, radar, {name: f"T '{name}' R" for name in TARGETS})
    spectrum = ep.range_doppler(ep.receive(sum(parts.values()), radar, seed=1, start_time=late).cube, radar)
    for source in ({"parts": parts}, {"labels": ep.annotate(paths, parts, radar)}):
        found = ep.detect(spectrum, radar, start_time=late, **source)
        assert not found.is_noise.any() and {*found.part} == {*TARGETS}
        assert ep.detect(spectrum, radar, **source).is_noise.all()


@pytest.mark.parametrize("fault", FAULTS)
def test_paths_serve_every_receiver_of_the_radar(spheres, fault):
    """They are those of a new trace with that receiver, and so are the detections; parts and labels, too."""
    radar, paths, _ = spheres
    other = radar.replace(receiver=ep.Receiver(**FAULTS[fault]), noise_figure_db=radar.noise_figure_db + 3.0)
    again = ep.trace(paths.scene, other, num_rays=6000, max_bounces=1)
    assert np.array_equal(again.amplitude, paths.amplitude)
    spectrum = ep.range_doppler(ep.receive(ep.synthesize(paths), other, seed=1).cube, other)
    parts = ep.decompose(paths, radar, {"near": "T 'near' R"})
    found, wanted = (ep.detect(spectrum, other, paths=record, parts=parts) for record in (paths, again))
    for name in ("cells", "range", "power", "object", "part", "share", "is_noise"):
        assert np.array_equal(getattr(found, name), getattr(wanted, name), equal_nan=name == "share"), name
    assert {*TARGETS} <= {*found.object}
    assert ep.annotate(paths, parts, other).objects == ep.annotate(again, parts, other).objects
    with pytest.raises(ValueError, match="paths: must be traced with the radar of the spectrum, of any receiver, got another tr"):
        ep.detect(spectrum, other, paths=ep.trace(paths.scene, other.replace(transmit_power=1.0), num_rays=100))


@pytest.mark.parametrize("receiver", [dict(low_pass=4e6), dict(high_pass=[3e6] * 3)])
def test_filters_do_not_count_as_missing_noise(spheres, receiver):
    radar, paths, _ = spheres
    radar = radar.replace(receiver=ep.Receiver(**receiver))
    cube = ep.synthesize(paths, radar)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ep.detect(ep.range_doppler(ep.receive(cube, radar, seed=1).cube, radar), radar)
    with pytest.warns(RuntimeWarning, match="holds no noise"):
        ep.detect(ep.range_doppler(ep.receive(cube, radar, seed=None).cube, radar), radar)


# --- gains of echoes ---

def gains_of(ranges=(1.0,), start_time=0.0, **faults):
    settings = {name: faults.pop(name) for name in ("real", "num_chirps") if name in faults}
    radar = build_radar(num_samples=64, receiver=ep.Receiver(**faults), **{"num_chirps": 2} | settings)
    return radar, EchoGains(radar, np.asarray(ranges), start_time)


@pytest.mark.parametrize("real", [False, True])
def test_echoes_pass_the_filters_at_their_beat_frequencies(real):
    """Butterworth's gain; the last sixteenth of the ranges of complex samples stands for frequencies below 0."""
    corner, poles = 4e6, 3
    radar, _ = gains_of(real=real)
    ranges = radar.waveform.range_resolution * np.arange(32 if real else 64)
    _, gains = gains_of(ranges, real=real, low_pass=corner, low_pass_poles=poles)
    beat = np.arange(len(ranges)) * radar.waveform.sampling_rate / 64
    beat[60:] -= radar.waveform.sampling_rate
    assert gains.of_filters == pytest.approx(1.0 / np.sqrt(1.0 + (beat / corner) ** (2 * poles)))
    assert gains.of("", 0, 0, np.arange(len(ranges))) == pytest.approx(gains.of_filters)


def test_leakage_passes_the_filters_at_its_beat_frequency_wherever_it_shows():
    """Its sidelobes, too, beside what the receiver makes of it and two filters of the first order."""
    corners, delay = (175e3, 350e3), 0.3e-9
    radar, _ = gains_of()
    ranges = radar.waveform.range_resolution * np.arange(64)
    radar, gains = gains_of(ranges, leakage_db=[[-20.0]], leakage_delay=delay, high_pass=corners)
    of_leakage = np.abs(gains.of("leakage", 0, 0, np.arange(64)))
    beat = delay * radar.waveform.bandwidth * radar.waveform.sampling_rate / 64
    assert of_leakage == pytest.approx(np.prod([beat / np.hypot(beat, corner) for corner in corners]))
    received = ep.range_doppler(ep.receive(np.zeros(signal_shape(radar), complex), radar, seed=None).cube, radar, window="hann")
    alone = np.abs(leakage_map(radar, "hann", 1).values)
    assert np.abs(received.values) == pytest.approx(of_leakage * alone, rel=1e-3, abs=1e-4 * alone.max() * of_leakage[0])


@pytest.mark.parametrize("part", ["", "leakage", "interference", "residue"])
def test_each_channel_and_cell_has_a_gain_of_its_own(part):
    radar = build_radar([ep.Antenna()] * 2, [ep.Antenna()] * 3, num_samples=64, receiver=ep.Receiver(high_pass=[1e6]))
    gains = EchoGains(radar, radar.waveform.range_resolution * np.arange(64))
    tx, rx, cells = np.arange(2)[:, None, None], np.arange(3)[:, None], np.arange(1, 5)
    values = gains.of(part, tx, rx, cells)
    assert values.shape == (2, 3, 4)
    assert values[1, 2] == pytest.approx([gains.of(part, 1, 2, cell) for cell in cells])


def test_branches_leave_what_they_have_of_echoes_and_real_samples_have_one():
    """(1 + g e^{jp}) / 2 of an echo stays where it is."""
    for real, kept in ((False, abs(0.5 + 0.5 * 10**0.1 * np.exp(0.3j))), (True, 1.0)):
        assert gains_of(real=real, iq_gain_db=2.0, iq_phase=0.3)[1].of("", 0, 0, 0) == pytest.approx(kept)


def test_gains_that_drift_count_by_their_mean_square():
    """Two chirps at 0.5 s and one interval later, at 40 dB/s."""
    radar, gains = gains_of(start_time=0.5, gain_drift_db=[40.0])
    times = 0.5 + np.array([0.0, radar.waveform.chirp_interval])
    assert gains.of("", 0, 0, 0) == pytest.approx(np.sqrt(np.mean(10.0 ** (40.0 * times / 10.0))), rel=1e-12)


def test_leakage_has_the_errors_of_the_transmitters_already_and_echoes_get_them():
    """Behind transmitters of -6 dB and receivers of 3 dB, as the receiver gives both."""
    radar, gains = gains_of(leakage_db=[[-20.0]], transmitter_gain_db=[-6.0], receiver_gain_db=[3.0])
    nothing = np.zeros(signal_shape(radar), complex)
    leaked = ep.receive(nothing, radar, seed=None).cube
    echo = ep.receive(nothing + 1.0, radar, seed=None).cube - leaked
    alone = np.abs(leakage_map(radar, "hann", 1).values)
    assert np.abs(ep.range_doppler(leaked, radar, window="hann").values) == pytest.approx(gains.of("leakage", 0, 0, 0) * alone)
    assert np.abs(echo) == pytest.approx(gains.of("", 0, 0, 0))
