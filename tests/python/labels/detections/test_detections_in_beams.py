"""What made a detection in beams: told by the powers in the beam that found it."""
from __future__ import annotations

import numpy as np
import pytest

import echopath as ep
from echopath import _core
from echopath.detections.uneven_fields import echo_fields
from echopath.receiver.echo_gains import EchoGains
from support.radars import build_radar

WAVELENGTH = ep.speed_of_light / 77e9
DISTANCE = 20.0
TARGET = np.radians(8.0)
OTHERS = np.radians([*range(-50, 1, 5), *range(18, 49, 5)])  # the first null beside a beam is 7 degrees away from it
OBJECTS = {"clutter": "clutter*", "target": "target"}
ROUNDING = 1e-9
MODEL = 0.06  # of powers: of limbs by the changes of their lengths over the frame, a quarter of a dB


def radar(num_transmitters=1, **waveform):
    sequence = ep.ChirpSequence(**{"start_frequency": 76.9e9, "bandwidth": 200e6, "num_samples": 64, "sampling_rate": 10e6,
                                   "num_chirps": 16} | waveform)
    return ep.Radar(sequence, transmitters=[ep.Antenna((0.0, 0.0, 0.5 * WAVELENGTH * k)) for k in range(num_transmitters)],
                    receivers=[ep.Antenna((0.0, 0.5 * WAVELENGTH * k, 0.0)) for k in range(16)], transmit_power=1.0)


def arc(speed=0.0):
    """Many spheres in all directions, as far away as one whose echo has four times the power of each."""
    scene = ep.Scene()
    for name, radius, azimuth in [("target", 0.2, TARGET), *((f"clutter {k}", 0.1, one) for k, one in enumerate(OTHERS))]:
        toward = np.array((np.cos(azimuth), np.sin(azimuth), 0.0))
        scene.add(ep.actors.sphere(radius), name=name, material="metal", position=(DISTANCE + radius) * toward, smooth=True,
                  motion=ep.LinearMotion(velocity=speed * toward) if speed else None)
    return scene


def of_target(found):
    """Index of the detection toward the target."""
    return int(np.argmin(np.abs(found.azimuth - TARGET)))


@pytest.mark.parametrize("retrace", ["never", "always"])
@pytest.mark.parametrize("speed", [0.0, 3.0])
def test_an_echo_is_told_from_stronger_ones_of_other_directions(retrace, speed):
    """17 echoes of a fourth of its power have four times as much in all channels together."""
    frame = ep.simulate(arc(speed), radar(3), num_rays=5000, max_bounces=1, noise_seed=1, retrace=retrace, keyframes=2,
                        parts={name: f"T '{mesh}' R" for name, mesh in OBJECTS.items()})
    found = ep.detect_frame(frame, beams=True, objects=OBJECTS)
    assert found.azimuth[of_target(found)] == pytest.approx(TARGET, abs=0.01)
    assert found.object[of_target(found)] == found.part[of_target(found)] == "target"
    assert found.share[of_target(found)] > 0.9 and not found.is_noise.any()
    in_all = ep.detect_frame(frame, objects=OBJECTS)
    (same_cell,) = np.flatnonzero((in_all.cells == found.cells[of_target(found)]).all(axis=1))
    assert in_all.object[same_cell] == in_all.part[same_cell] == "clutter"


def test_labels_tell_the_part_and_paths_the_object_in_the_beam():
    """Labels have the powers of all channels: noise is told by the paths in the beam, whose power the map has there."""
    sender = radar(3)
    paths = ep.trace(arc(), sender, num_rays=5000, max_bounces=1)
    parts = ep.decompose(paths, sender, {name: f"T '{mesh}' R" for name, mesh in OBJECTS.items()})
    spectrum = ep.range_doppler(ep.add_noise(sum(parts.values()), sender, seed=1), sender)
    labels = ep.annotate(paths, parts, sender, objects=OBJECTS)
    asked = {"beams": True, "false_alarm_rate": 1e-3, "paths": paths, "objects": OBJECTS}
    found, by_paths = ep.detect(spectrum, sender, labels=labels, **asked), ep.detect(spectrum, sender, **asked)
    assert (found.object[of_target(found)], found.part[of_target(found)]) == ("target", "clutter")
    assert np.array_equal(found.is_noise, by_paths.is_noise) and np.array_equal(found.object, by_paths.object)
    assert found.is_noise.any()


def test_what_is_weaker_than_the_noise_of_each_channel_is_told():
    """It holds less than half of the power that all channels have in its cell, and all that they have more than noise."""
    array = radar().replace(receivers=[ep.Antenna((0.0, 0.5 * WAVELENGTH * k, 0.0)) for k in range(64)])
    echo = ep.point_targets(array, [(DISTANCE, 0.0, 0.0)], 1.0)
    strongest = np.max(np.mean(np.abs(ep.range_doppler(echo, array).values) ** 2, axis=(0, 1)))
    weak = echo * np.sqrt(0.7 * ep.noise_power(array) / strongest)
    noisy, parts = ep.range_doppler(ep.add_noise(weak, array, seed=3), array), {"echo": ep.range_doppler(weak, array)}
    for beams in (False, True):
        found = ep.detect(noisy, array, parts=parts, beams=beams, false_alarm_rate=1e-2)
        is_near = np.hypot(found.range - DISTANCE, found.velocity) < array.waveform.range_resolution
        (i,) = np.flatnonzero(is_near)
        assert not found.is_noise[i] and found.part[i] == "echo"
        assert found.is_noise[~is_near].all() and not is_near.all()


def test_parts_have_the_power_of_the_sum_of_channels_toward_the_beam():
    """Of transmitters at one place: the phase that motion adds between their turns is that of the cell's velocity."""
    sender = radar(2)
    sender = sender.replace(transmitters=[ep.Antenna(), ep.Antenna()])
    paths = ep.trace(arc(2.0), sender, num_rays=20_000, max_bounces=1)
    parts = ep.decompose(paths, sender, {"target": "T 'target' R", "clutter": "T 'clutter*' R"})
    spectrum = ep.range_doppler(sum(parts.values()), sender)
    with pytest.warns(RuntimeWarning, match="holds no noise"):
        found = ep.detect(spectrum, sender, beams=True, parts=parts)
    i = of_target(found)
    velocity, distance = found.cells[i]
    later = np.arange(2)[:, None] * sender.waveform.chirp_interval
    turned = np.exp(4j * np.pi * spectrum.velocity[velocity] / WAVELENGTH * later)
    cosines = np.arange(-16, 16) / 16.0  # of beams half a beam apart
    steering = np.exp(1j * np.pi * np.outer(cosines, np.arange(16))) / 32.0
    power = {}
    for name, cube in parts.items():
        values = ep.range_doppler(cube, sender).values[:, :, velocity, distance] * np.conj(turned)
        power[name] = np.abs(steering @ values.sum(axis=0)) ** 2
    whole = ep.range_doppler(sum(parts.values()), sender).values[:, :, velocity, distance] * np.conj(turned)
    beam = np.argmax(np.abs(steering @ whole.sum(axis=0)))
    assert found.share[i] == pytest.approx(power["target"][beam] / sum(one[beam] for one in power.values()), rel=1e-3)


@pytest.mark.parametrize("waveform", [{}, {"frequency_steps": [0.0, 2e6, 5e6]}, {"extra_idle": [0.0, 3e-6]}], ids=[
    "even", "steps", "idle times"])
def test_fields_of_paths_in_a_beam_add_up_to_those_of_the_signal(waveform):
    """Through chains of different gains; the radar passes walking people before a wall."""
    sender = radar(3, num_chirps=64, **waveform).replace(receiver=ep.Receiver(receiver_gain_db=np.linspace(-6.0, 6.0, 16)),
                                          motion=ep.LinearMotion(velocity=(4.0, 1.0, 0.0)))
    scene = ep.Scene()
    for k, place in enumerate([(9.0, 1.0, -1.0), (6.0, -3.0, -1.0), (4.0, 2.0, -1.0)]):
        scene.add(ep.actors.pedestrian(phase=0.3 * k), name=f"person {k}", position=place)
    scene.add(ep.actors.wall(6.0, 3.0), name="wall", material="concrete", position=(12.0, 0.0, 0.0))
    paths = ep.trace(scene, sender, num_rays=5000, max_bounces=2)
    cube = ep.synthesize(paths, sender)
    spectrum, noisy = (ep.range_doppler(one, sender) for one in (cube, ep.add_noise(cube, sender, seed=1)))
    peaks = _core.find_peaks(noisy, sender, ep.cfar(noisy, sender, beams=True, false_alarm_rate=1e-3))
    is_echo = peaks["power"] > 30.0 * peaks["noise"]
    cells, weights = peaks["cells"][is_echo], peaks["beam_weights"][is_echo]
    gains = EchoGains(sender, peaks["range"][is_echo])
    made = list(echo_fields(paths, spectrum).each(cells, gains, weights))
    values = spectrum.values[:, :, cells[:, 0], cells[:, 1]]
    behind = values * 10.0 ** (np.linspace(-6.0, 6.0, 16)[:, None] / 20.0)
    for some, powers in ((values, [np.abs(field.sum()) ** 2 for _, field, _ in made]), (behind, [whole for *_, whole in made])):
        expected = np.abs(np.einsum("ntr,trn->n", weights, some)) ** 2
        np.testing.assert_allclose(powers, expected, rtol=MODEL)
    assert len(cells) > 5


def test_cells_are_followed_in_turns_where_memory_is_short(monkeypatch):
    sender = radar(3)
    paths = ep.trace(arc(), sender, num_rays=5000, max_bounces=1)
    spectrum = ep.range_doppler(ep.synthesize(paths, sender), sender)
    peaks = _core.find_peaks(spectrum, sender, ep.cfar(spectrum, sender, beams=True, false_alarm_rate=0.01))
    asked = peaks["cells"], EchoGains(sender, peaks["range"]), peaks["beam_weights"]
    at_once = list(echo_fields(paths, spectrum).each(*asked))
    monkeypatch.setattr("echopath.detections.echo_fields.MAX_MEMORY", 1)
    in_turns = list(echo_fields(paths, spectrum).each(*asked))
    assert len(at_once) == len(in_turns) == len(peaks["cells"]) > 1
    for (index, field, whole), (other_index, other_field, other_whole) in zip(at_once, in_turns):
        np.testing.assert_array_equal(index, other_index)
        np.testing.assert_allclose([whole, *field[0]], [other_whole, *other_field[0]], rtol=ROUNDING)


@pytest.mark.parametrize("beams", [False, True])
def test_families_of_renewed_frames_are_made_for_some_receivers_at_a_time(beams, monkeypatch):
    """As many as memory holds the signals of, in chains of different gains."""
    faults = ep.Receiver(receiver_gain_db=np.linspace(-6.0, 6.0, 16))
    frame = ep.simulate(arc(3.0), radar(3).replace(receiver=faults), num_rays=2000, max_bounces=1, noise_seed=1, retrace="always",
                        keyframes=2)
    at_once = ep.detect_frame(frame, beams=beams, false_alarm_rate=0.01)
    made = []

    def decompose(paths, of, *args, **keywords):
        made.append(len(of.receivers))
        return ep.decompose(paths, of, *args, **keywords)

    monkeypatch.setattr("echopath.labels.powers.CUBES_IN_MEMORY", 1 << 25)
    monkeypatch.setattr("echopath.frame.detections.decompose", decompose)
    assert ep.detect_frame(frame, beams=beams, false_alarm_rate=0.01) == at_once
    assert len(made) == 2 and sum(made) == 16 and at_once.is_noise.any() and not at_once.is_noise.all()


@pytest.mark.filterwarnings("ignore:scene. has no mesh")
@pytest.mark.parametrize("beams", [False, True])
@pytest.mark.parametrize("retrace", ["never", "always"])
def test_nothing_found_is_a_well_shaped_result(beams, retrace):
    frame = ep.simulate(ep.Scene(), radar(3), num_rays=100, noise_seed=1, retrace=retrace, detections={"beams": beams})
    assert len(frame.detections) == 0 and frame.detections.object.shape == (0,)


@pytest.mark.parametrize("beams", [False, True])
def test_noise_of_a_frame_is_what_its_signal_holds_less_than_half_of(beams):
    """Of what stands above the mean noise in all channels, or in the beam that found the cell: of 48 channels a few have others
    on this side or that."""
    scene, rate = ep.Scene(), 0.05
    for k, place in enumerate([(9.0, 1.0, -1.0), (6.0, -3.0, -1.0), (4.0, 2.0, -1.0)]):
        scene.add(ep.actors.pedestrian(phase=0.3 * k), name=f"person {k}", position=place)
    for seed, place in ((1, (14.0, 3.0, -1.0)), (2, (18.0, -4.0, -1.0))):
        scene.add(ep.actors.tree(seed=seed), name=f"tree {seed}", position=place)
    sender = radar(3, num_chirps=128).replace(transmit_power=0.03)
    frame = ep.simulate(scene, sender, num_rays=2000, max_bounces=1, noise_seed=1)
    found = ep.detect_frame(frame, beams=beams, false_alarm_rate=rate)
    clean, noisy = (one.values[:, :, *found.cells.T] for one in (ep.range_doppler(frame.cube, sender), frame.spectrum))
    if beams:
        cells = ep.cfar(frame.spectrum, sender, beams=True, false_alarm_rate=rate)
        weights = _core.find_peaks(frame.spectrum, sender, cells)["beam_weights"]
        clean, noisy = (np.einsum("ntr,trn->n", weights, one)[None, None] for one in (clean, noisy))
    echoes, power = (np.mean(np.abs(one) ** 2, axis=(0, 1)) for one in (clean, noisy))
    noise = ep.noise_power(sender) * (np.sum(np.abs(weights) ** 2, axis=(1, 2)) if beams else 1.0)
    assert np.array_equal(found.is_noise, echoes < 0.5 * (power - noise))
    assert 10 < found.is_noise.sum() < len(found) - 10


@pytest.mark.parametrize("num_tx, turns, phases", [(2, 1, (0.0, 3.0)), (3, -1, ()), (4, -1, ()), (4, 2, (0.0, 1.5, -2.0, 2.8))])
def test_signs_come_apart_mixed_of_what_is_too_fast_and_its_beams_tell_no_noise(num_tx, turns, phases):
    """An echo 40 dB above the noise, the only one there is, whose velocity is so many times the axis of the map beyond it."""
    half = 0.00193
    radar = build_radar([(0, 4 * m * half, 0) for m in range(num_tx)], [(0, n * half, 0) for n in range(4)], bandwidth=300e6,
                        sampling_rate=6.4e6, num_chirps=64, chirp_interval=20e-6, transmit_power=20.0, multiplexing="bpm",
                        receiver=ep.Receiver(transmitter_phase=phases))
    speed = (2.0 * turns - 0.4) * radar.waveform.max_velocity(radar.num_slots)
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.15), name="ball", material="metal", smooth=True, position=(11.2, 2, 0),
              motion=ep.LinearMotion(velocity=(speed, 0, 0)))
    frame = ep.simulate(scene, radar, num_rays=300, guard=False, noise_seed=1, detections={"beams": True})
    by_paths, by_parts = (ep.detect(frame.spectrum, radar, beams=True, **given)
                          for given in ({"paths": frame.paths}, {"parts": {"all": frame.cube}}))
    strongest = np.argmax(frame.detections.snr_db)
    assert frame.detections.snr_db[strongest] > 40.0
    assert [found.is_noise[strongest] for found in (frame.detections, by_paths, by_parts)] == [False] * 3
    assert frame.detections.object[strongest] == by_paths.object[strongest] == "ball"


def test_leakage_is_no_noise_in_beams_of_signs_whatever_the_mixes_of_echoes():
    """It stands 50 dB above the noise, in a beam that phases of the transmitters turn, where nothing else is."""
    half = 0.00193
    radar = build_radar([(0, 4 * m * half, 0) for m in range(2)], [(0, n * half, 0) for n in range(4)], bandwidth=300e6,
                        sampling_rate=6.4e6, num_chirps=32, chirp_interval=20e-6, transmit_power=0.01, multiplexing="bpm",
                        receiver=ep.Receiver(leakage_db=[[-75.0] * 4] * 2, leakage_delay=40e-9, transmitter_phase=[0.0, 2.6]))
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.01), name="ball", material="metal", smooth=True, position=(14, 2, 0))
    frame = ep.simulate(scene, radar, num_rays=100, guard=False, noise_seed=1, detections={"beams": True})
    beside = frame.beside_spectra
    silent = {"all": np.zeros(frame.cube.shape, complex)}
    for found in (frame.detections, ep.detect(frame.spectrum, radar, beams=True, paths=frame.paths, beside=beside),
                  ep.detect(frame.spectrum, radar, beams=True, parts=silent, beside=beside),
                  ep.detect(frame.spectrum, radar, beams=True, parts=silent | beside)):
        assert found.part[np.argmax(found.snr_db)] == "leakage" and found.snr_db.max() > 50.0
