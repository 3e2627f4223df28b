"""What a receiver makes of each part of a signal: the parts add up to what it gives, and each has its own faults."""
import numpy as np
import pytest

import echopath as ep
from support.radars import build_radar

RATE, COUNT, CHIRPS = 20e6, 128, 16
SUM = 1e-12  # of the largest sample: rounding of a sum of parts
LINEAR = dict(phase_noise=ep.PhaseNoise(offsets=[1e4, 1e6], levels=[-70.0, -90.0]), frequency_error=(0.0, 1e9),
              coupling_db=[[0.0, -20.0], [-25.0, 0.0]], coupling_delay=1e-11, receiver_gain_db=[0.5, -0.5],
              phase_drift=[0.1, 0.2], transmitter_gain_db=[-3.0, 0.0], transmitter_phase=[0.4, -0.7], high_pass=[2e5],
              low_pass=8e6, iq_gain_db=0.5, iq_phase=0.05)
ALL = LINEAR | dict(leakage_db=[[-60.0, -65.0], [-62.0, -60.0]], leakage_delay=1e-9, compression_dbm=-60.0,
                    dc_offset=(1e-6, 2e-6), adc={"bits": 10, "automatic_gain": True, "clock_jitter": 1e-11})
ARRAY = {"num_samples": COUNT, "num_chirps": CHIRPS, "transmitters": [(0, 0, 0), (0, 0.004, 0)],
         "receivers": [(0, 0, 0), (0, 0.002, 0)], "transmit_power": 1.0}


def tone(cell, power):
    chirp = np.sqrt(power) * np.exp(2j * np.pi * cell * np.arange(COUNT) / COUNT)
    return np.broadcast_to(chirp, (2, 2, CHIRPS, COUNT)).copy()


def in_samples(cube, real):
    return np.sqrt(2.0) * cube.real + 0j if real else cube


@pytest.mark.parametrize("real", [False, True])
@pytest.mark.parametrize("faults", [None, LINEAR, ALL], ids=["none", "linear", "all"])
def test_parts_add_up_to_what_the_receiver_gives(faults, real):
    radar = build_radar(**ARRAY, real=real, receiver=None if faults is None else ep.Receiver(**faults))
    parts = {name: in_samples(tone(cell, power), real) for name, cell, power in (("near", 5, 1e-9), ("far", 40, 1e-12))}
    other = in_samples(tone(21, 1e-10), real)
    whole = ep.receive(sum(parts.values()), radar, seed=3, start_time=0.1, interference=other).cube
    found = ep.receive_parts(parts, radar, seed=3, start_time=0.1, interference=other)
    assert list(found)[:3] == ["near", "far", "interference"] and "noise" in found
    assert ({"leakage", "offset", "converter"} <= set(found)) == (faults is ALL)
    np.testing.assert_allclose(sum(found.values()), whole, atol=SUM * np.abs(whole).max())


def test_a_part_has_the_faults_that_it_has_alone_but_for_the_compression_of_the_whole():
    radar = build_radar(**ARRAY, receiver=ep.Receiver(**LINEAR))
    parts = {"near": tone(5, 1e-9), "far": tone(40, 1e-12)}
    found = ep.receive_parts(parts, radar, seed=None)
    alone = ep.receive(parts["far"], radar, seed=None).cube
    np.testing.assert_allclose(found["far"], alone, atol=1e-4 * np.abs(alone).max())  # pasts by the model of the whole
    squeezed = radar.replace(receiver=ep.Receiver(compression_dbm=-60.0))
    power = 1e-3 * 10 ** (-60 / 10)  # where the gain is 1 dB lower
    found = ep.receive_parts({"near": tone(5, power), "far": tone(40, 1e-20)}, squeezed, seed=None)
    assert 10 * np.log10(np.mean(np.abs(found["far"]) ** 2) / 1e-20) == pytest.approx(-1.0, abs=0.01)


def test_rounding_is_a_part_of_its_own():
    """Tones that fill 8 bits: -6.02 n - 1.76 dB below full scale."""
    adc = ep.Adc(bits=8, full_scale_dbm=0.0, gain_db=0.0)
    radar = build_radar(**ARRAY, receiver=ep.Receiver(adc=adc))
    tones = tone((33.317 + 0.713 * np.arange(CHIRPS))[:, None], 0.97e-3)
    found = ep.receive_parts({"echo": tones}, radar, seed=None)
    assert 10 * np.log10(np.mean(np.abs(found["converter"]) ** 2) / 1e-3) == pytest.approx(-6.02 * 8 - 1.76, abs=0.2)


@pytest.mark.parametrize("code", [{}, dict(multiplexing="bpm"), dict(multiplexing="ddm", empty_slots=2)],
                         ids=["tdm", "bpm", "ddm"])
def test_frames_have_them_for_their_parts(code):
    other = build_radar(num_samples=COUNT, position=(40, 3, 0))
    scene = ep.Scene(interferers=[ep.Interferer(radar=other, over="direct")], weather=ep.Weather(rain_mm_per_hour=20.0))
    for name, x in (("near", 4.0), ("far", 9.0)):
        scene.add(ep.actors.sphere(0.2), name=name, material=ep.Material.metal(), smooth=True, position=(x, 0, 0))
    radar = build_radar(**ARRAY, **code, receiver=ep.Receiver(**ALL))
    frame = ep.simulate(scene, radar, num_rays=500, max_bounces=1, parts={"near": "T 'near' R"})
    found, whole = frame.received_parts["parts"], frame.received.cube
    assert list(found) == ["near", "other", "rain", "interference", "leakage", "noise", "offset", "converter"]
    np.testing.assert_allclose(sum(found.values()), whole, atol=1e-6 * np.abs(whole).max())  # tolerance of synthesis, 1e-7
    assert list(ep.simulate(scene, radar, num_rays=100, noise_seed=None).received_parts["parts"])[:2] == ["other", "rain"]


@pytest.mark.filterwarnings("ignore:scene. has no mesh")
@pytest.mark.parametrize("code", [{}, dict(multiplexing="bpm"), dict(multiplexing="ddm", empty_slots=2)],
                         ids=["tdm", "bpm", "ddm"])
def test_rain_beside_the_echoes_has_no_errors_of_the_transmitters_as_these_have_none(code):
    """Labels hold it against ideal echoes, and detections count the errors of both, in beams with their phases."""
    scene = ep.Scene(weather=ep.Weather(rain_mm_per_hour=20.0))
    ideal, faulty = (build_radar(**ARRAY, **code, receiver=ep.Receiver(**faults))
                     for faults in ({}, dict(transmitter_gain_db=[-20.0, -20.0], transmitter_phase=[0.5, 0.5])))
    wanted, found = (ep.simulate(scene, radar, num_rays=100, noise_seed=None).beside_spectra["rain"].values
                     for radar in (ideal, faulty))
    np.testing.assert_allclose(found, wanted, atol=1e-9 * np.abs(wanted).max())


@pytest.mark.parametrize("code", [dict(multiplexing="bpm"), dict(multiplexing="ddm", empty_slots=2)], ids=["bpm", "ddm"])
def test_frames_whose_paths_are_traced_anew_have_them_too(code):
    scene = ep.Scene()
    scene.add(ep.actors.plate(0.5, 0.5), name="near", material=ep.Material.metal(), position=(4, 0, 0), yaw=np.pi,
              motion=ep.LinearMotion(velocity=(3.0, 0, 0)))
    scene.add(ep.actors.plate(0.5, 0.5), name="far", material=ep.Material.metal(), position=(9, 2, 0), yaw=np.pi)
    frame = ep.simulate(scene, build_radar(**ARRAY, **code), num_rays=500, max_bounces=1, parts={"near": "T 'near' R"},
                        retrace="always")
    found, whole = frame.received_parts["parts"], frame.received.cube
    assert list(found) == ["near", "other", "noise"] and found["near"].any() and found["other"].any()
    np.testing.assert_allclose(sum(found.values()), whole, atol=1e-6 * np.abs(whole).max())


@pytest.mark.parametrize("name", ["interference", "leakage", "offset", "converter", "noise", "rain"])
def test_names_of_what_no_path_makes_are_refused_before_the_trace(name, monkeypatch):
    def never(*arguments, **settings):
        raise AssertionError("traced")

    monkeypatch.setattr("echopath.frame.simulate.trace_scene", never)
    told = f"^parts: must not be named '{name}', as what no path makes is$"
    with pytest.raises(ValueError, match=told):
        ep.simulate(ep.Scene(), build_radar(**ARRAY), num_rays=100, parts={name: "T . R"})
    if name != "rain":  # which is a signal that comes to the receivers like others
        with pytest.raises(ValueError, match=told):
            ep.receive_parts({name: tone(5, 1e-9)}, build_radar(**ARRAY), seed=None)


def test_back_off_of_the_transmitters_leaves_other_radars_as_they_are():
    radar = build_radar(**ARRAY, receiver=ep.Receiver(transmitter_gain_db=[-20.0, -20.0]))
    cube, other = tone(5, 1e-9), tone(21, 1e-9)
    found = ep.receive_parts({"echo": cube}, radar, seed=None, interference=other)
    np.testing.assert_array_equal(found["interference"], other)
    np.testing.assert_allclose(found["echo"], 0.1 * cube, rtol=1e-12)


def test_another_oscillator_has_the_whole_phase_noise():
    """Of an echo at 3 m the noise at 1.25 MHz is 14 dB lower by range correlation, of another radar it is that of the mask."""
    level, count = -100.0, 400
    radar = build_radar(num_samples=512, num_chirps=count, noise_figure_db=0.0,
                        receiver=ep.Receiver(phase_noise=ep.PhaseNoise(offsets=[1e3], levels=[level])))
    sent = np.ones((1, 1, count, 512)) * np.exp(2j * np.pi * 100 * np.arange(512) / 512)
    silent = np.zeros_like(sent)
    noise = ep.receive_parts({"echo": silent}, radar, seed=1, interference=sent)["interference"] - sent
    window = np.sin(np.pi * np.arange(512) / 512) ** 2
    density = np.mean(np.abs(np.fft.fft(noise * window)) ** 2, axis=(0, 1, 2)) / (RATE * np.sum(window ** 2))
    line = 100 + round(1.25e6 / (RATE / 512))
    assert 10 * np.log10(density[line - 4:line + 5].mean()) == pytest.approx(level, abs=0.2)


def test_leakage_and_coupling_follow_chirps_that_hop():
    """A step of 100 MHz turns a leakage of 1 ns by a tenth of a turn, and a coupling of 1 ns likewise."""
    steps = {"frequency_steps": (0.0, 1e8), "bandwidth_steps": (0.0, 2e8)}
    faults = {"leakage_db": np.full((2, 2), -20.0), "leakage_delay": 1e-9}
    radar = build_radar(**ARRAY, **steps, receiver=ep.Receiver(**faults))
    cube = ep.receive(np.zeros((2, 2, CHIRPS, COUNT)), radar, seed=None).cube
    time = np.arange(COUNT) / RATE
    for slot in range(4):
        start, slope = 77e9 + 1e8 * (slot % 2), (1e9 + 2e8 * (slot % 2)) * RATE / COUNT
        tone_of_slot = 0.1 * np.exp(2j * np.pi * (start * 1e-9 + slope * 1e-9 * (time - 0.5e-9)))
        np.testing.assert_allclose(cube[slot % 2, 0, slot // 2], tone_of_slot, atol=1e-9)
    coupled = ep.Receiver(coupling_db=[[0.0, -20.0], [0.0, 0.0]], coupling_delay=1e-9)
    heard = np.zeros((2, 2, CHIRPS, COUNT), complex)
    heard[:, 0] = 1.0
    cube = ep.receive(heard, build_radar(**ARRAY, **steps, receiver=coupled), seed=None).cube
    assert np.angle(cube[1, 1, 0, 0] / cube[0, 1, 0, 0]) == pytest.approx(0.2 * np.pi, abs=1e-6)


@pytest.mark.filterwarnings("ignore:scene. has no mesh")
@pytest.mark.parametrize("settings", [{}, {"real": True}, {"multiplexing": "bpm"}, {"frequency_steps": (0.0, 1e8)}],
                         ids=["tdm", "real", "bpm", "hops"])
def test_labels_have_the_leakage_that_an_ideal_oscillator_brings(settings):
    faults = {"leakage_db": np.full((2, 2), -20.0), "leakage_delay": 1e-9, "transmitter_phase": [0.0, 0.3]}
    radar = build_radar(**ARRAY, **settings, receiver=ep.Receiver(**faults))
    frame = ep.simulate(ep.Scene(), radar, num_rays=100, noise_seed=None)
    beside = frame.beside_spectra["leakage"]
    whole = ep.range_doppler(frame.noisy_cube, radar)
    np.testing.assert_allclose(beside.values, whole.values, atol=1e-9 * np.abs(whole.values).max())


def test_oscillators_know_the_slope_of_each_chirp():
    """A slope off by 0.1 % moves each beat by 0.1 % of its slope over the common one, as its delay says."""
    radar = build_radar(num_samples=512, num_chirps=4, bandwidth_steps=(0.0, 1e9),
                        receiver=ep.Receiver(frequency_error=(0.0, 1e-3 * 1e9 * RATE / 512)))
    cube = np.ones((1, 1, 4, 512)) * np.exp(2j * np.pi * 60 * np.arange(512) / 512)
    received = ep.receive(cube, radar, seed=None).cube[0, 0, :2, 64:-64]
    beats = np.array([np.polyfit(np.arange(received.shape[1]), np.unwrap(np.angle(one)), 1)[0] for one in received])
    moved = beats / (2 * np.pi) * 512 - 60
    np.testing.assert_allclose(moved, [0.06, 0.03], rtol=0.01)


@pytest.mark.parametrize("parts, told", [
    ({}, "parts: must be a dict of cubes"), ({"noise": 0}, "parts: must not be named 'noise'"),
    ({"echo": np.zeros((1, 2, 3, 4))}, r"parts.echo: must be of the shape"),
])
def test_bad_parts_are_refused_by_name(parts, told):
    with pytest.raises((TypeError, ValueError), match=told):
        ep.receive_parts(parts, build_radar(**ARRAY), seed=None)
