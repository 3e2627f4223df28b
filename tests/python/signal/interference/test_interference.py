"""Other FMCW radars in the receivers of a radar."""
import numpy as np
import pytest

import echopath as ep
from support.radars import build_radar
from support.signals.other_radars import COUNT, RATE, SLOPE, TONE, C, other, victim

LEVEL, SHARE = 0.2, 0.01  # dB and relative: promised


def friis(power, distance, frequency):
    return power * (C / frequency / (4 * np.pi * distance)) ** 2


def test_a_crossing_has_the_level_and_the_length_of_its_slopes():
    sender = other()
    cube = ep.interference(victim(), sender)
    power = np.abs(cube[0, 0, 0]) ** 2
    level = friis(0.05, 20.0, sender.waveform.start_frequency)
    length = RATE / (0.1 * SLOPE)  # s
    assert np.sum(power) / RATE == pytest.approx(level * length, rel=SHARE)
    inside = power > 0.25 * level
    middle = np.flatnonzero(inside)[20:-20]
    assert 10 * np.log10(power[middle].mean() / level) == pytest.approx(0.0, abs=LEVEL)
    # From the crossing on: the difference of frequencies is in the band while it is from 0 to the sampling rate.
    assert np.flatnonzero(inside)[0] / RATE == pytest.approx(12.8e-6, abs=2.0 / RATE)
    assert inside.sum() / RATE == pytest.approx(length, abs=2.0 / RATE)


def test_a_faster_slope_crosses_from_the_other_side():
    power = np.abs(ep.interference(victim(), other(slope_ratio=1.1))[0, 0, 0]) ** 2
    last = np.flatnonzero(power > 0.25 * power.max())[-1] / RATE
    assert last == pytest.approx(12.8e-6, abs=2.0 / RATE)


def test_another_radar_sends_with_the_errors_of_its_transmitters():
    """A back-off of 20 dB is a tenth of the field, and a phase that of a code of this one phase."""
    places = {"transmitters": ((0, 0, 0), (0, 0.01, 0)), "num_chirps": 4}
    coded = other(**places, multiplexing="cdm", code_phases=[[0.4], [-1.3]])
    plain = other(**places, multiplexing="cdm", code_phases=[[0.0], [0.0]])
    faulty = plain.replace(receiver=ep.Receiver(transmitter_gain_db=[-20.0] * 2, transmitter_phase=[0.4, -1.3],
                                                receiver_gain_db=[40.0]))
    wanted = 0.1 * ep.interference(victim(), coded)
    np.testing.assert_allclose(ep.interference(victim(), faulty), wanted, atol=1e-12 * np.abs(wanted).max())
    assert not np.allclose(wanted, 0.1 * ep.interference(victim(), plain), atol=0.1 * np.abs(wanted).max())
    wrong = faulty.replace(receiver=ep.Receiver(transmitter_gain_db=[-20.0]))
    told = r"receiver\.transmitter_gain_db: must be of the shape \(2,\) for this radar"
    with pytest.raises(ValueError, match=f"^other: {told}"):
        ep.interference(victim(), wrong)
    with pytest.raises(ValueError, match=rf"^interferers\[0\]\.radar: {told}"):
        ep.simulate(ep.Scene(interferers=[ep.Interferer(radar=wrong)]), victim(), num_rays=100)


def test_codes_of_another_radar_turn_its_signal_as_they_turn_its_own_echoes():
    """By e^{j phase} of the slot that is heard in each chirp, as synthesize has it of a radar's own codes."""
    phases, settings = np.array([0.0, 0.4, 2.0, -1.1]), {"num_chirps": 4, "multiplexing": "cdm"}
    receiver = victim(num_chirps=4)
    plain = ep.interference(receiver, other(**settings, code_phases=[[0.0]]))
    coded = ep.interference(receiver, other(**settings, code_phases=[phases.tolist()]))
    heard = np.abs(plain[0, 0]) > 0.5 * np.abs(plain).max()
    assert heard.any(axis=1).all()
    for chirp, phase in enumerate(phases):
        ratio = coded[0, 0, chirp, heard[chirp]] / plain[0, 0, chirp, heard[chirp]]
        np.testing.assert_allclose(ratio, np.exp(1j * phase), atol=1e-9)


@pytest.mark.parametrize("offset", [0.0, 8e-6])
def test_frames_of_one_chirp_send_as_one_frame_of_many_does(offset):
    """From 9 km away all that one frame sends is heard while the next one is sent, 30 us later."""
    receiver = victim(num_chirps=8, chirp_interval=35e-6)
    sent = {"slope_ratio": 0.2, "crossing": 5.3e-6, "distance": 30e-6 * C, "chirp_interval": 30e-6}
    one, many = (ep.interference(receiver, other(**sent, num_chirps=count), offset=offset) for count in (1, 16))
    assert np.count_nonzero(np.abs(many[0, 0]).max(axis=1) > 0.5 * np.abs(many).max()) > 3
    np.testing.assert_allclose(one, many, atol=1e-9 * np.abs(many).max())


def behind_a_running_filter(sender, *, finer=64, edge=256):
    """The signal of a sender in the receiver of `victim`, over its amplitude: mixed at many times the sampling rate, from long
    before the samples until long after them, and what an ideal filter leaves of it."""
    waveform, distance = sender.waveform, sender.position[0]
    place = np.arange(-edge * finer, (COUNT + edge) * finer)
    time = place / (finer * RATE)
    sent = time - distance / C
    cycles = 77e9 * time + 0.5 * SLOPE * time ** 2 - waveform.start_frequency * sent - 0.5 * waveform.slope * sent ** 2
    mixed = np.exp(2j * np.pi * np.mod(cycles, 1.0)) * ((sent >= 0.0) & (sent < waveform.chirp_duration))
    frequency = np.fft.fftfreq(len(place), 1.0 / (finer * RATE))
    passed = np.fft.ifft(np.fft.fft(mixed) * ((frequency >= 0.0) & (frequency < RATE)))
    return passed[::finer][edge:-edge]


@pytest.mark.parametrize("start, slope_ratio", [(76.9e9, 1.2), (76.8e9, 1.2), (77.3e9, 0.5), (77.45e9, 0.1)])
def test_outside_of_a_crossing_nothing_is_heard_but_the_ringing_of_the_filter(start, slope_ratio):
    """Neither where the mixed signal is followed no longer, nor at the other end of a chirp at whose end the crossing is."""
    sender = build_radar(num_samples=COUNT, start_frequency=start, bandwidth=slope_ratio * 1e9, position=(20, 0, 0), yaw=np.pi)
    found = ep.interference(victim(num_chirps=1), sender)[0, 0, 0]
    expected = np.sqrt(friis(0.01, 20.0, start)) * behind_a_running_filter(sender)
    begins = int(np.ceil(20.0 / C * RATE))  # a jump between two samples
    errors = np.delete(np.abs(found - expected), [begins - 1, begins, begins + 1]) / np.sqrt(friis(0.01, 20.0, start))
    assert np.abs(expected).max() > 0.9 * np.sqrt(friis(0.01, 20.0, start))
    assert np.max(errors) < 0.03


def test_one_branch_hears_both_sides_of_a_crossing():
    """Real samples do not tell a difference of frequency from its negative: half the sampling rate on either side. How much
    power the turn in the middle has depends on its phase."""
    sender, radar = other(), victim()
    cube = ep.interference(radar.replace(waveform=radar.waveform.replace(real=True)), sender)
    level = friis(0.05, 20.0, sender.waveform.start_frequency)
    length = RATE / (0.1 * SLOPE)  # s
    assert np.all(cube.imag == 0.0)
    assert np.sum(cube.real ** 2) / RATE == pytest.approx(level * length, rel=0.1)
    heard = np.flatnonzero(cube[0, 0, 0].real ** 2 > 0.25 * level)
    assert 0.5 * (heard[0] + heard[-1]) / RATE == pytest.approx(12.8e-6, abs=3.0 / RATE)
    assert (heard[-1] - heard[0]) / RATE == pytest.approx(length, abs=6.0 / RATE)


def test_parallel_chirps_are_a_tone_at_the_delay():
    """One way of 20 m and 0.1 us that the other begins late."""
    sender = build_radar(num_samples=COUNT, position=(20, 0, 0), yaw=np.pi)
    cube = ep.interference(victim(), sender, offset=0.1e-6)[0, 0, 0]
    steady = cube[40:]
    beat = np.polyfit(np.arange(len(steady)), np.unwrap(np.angle(steady)), 1)[0] * RATE / (2 * np.pi)
    assert beat == pytest.approx(SLOPE * (20.0 / C + 0.1e-6), rel=1e-3)
    assert 10 * np.log10(np.mean(np.abs(steady[20:-20]) ** 2) / friis(0.01, 20.0, 77e9)) == pytest.approx(0.0, abs=LEVEL)


@pytest.mark.parametrize("error", [(-3e5,), (-3e5, 2e10), (0.0, 0.0, -4e15)])
def test_another_radar_sends_with_the_error_of_its_frequency(error):
    """Parallel chirps from 40.1 m: the phase of the mixed tone lacks 2 pi times the integral of the error over the way."""
    sender = TONE.replace(receiver=ep.Receiver(frequency_error=error))
    delay, time = np.hypot(40.0, 3.0) / C, np.arange(COUNT) / RATE
    sent = time - delay
    cycles = 77e9 * delay + SLOPE * delay * (time - 0.5 * delay)
    cycles -= sum(one * sent ** (power + 1) / (power + 1) for power, one in enumerate(error))
    expected = np.sqrt(friis(0.01, 40.0, 77e9)) * np.exp(2j * np.pi * np.mod(cycles, 1.0))
    found = ep.interference(victim(num_chirps=1), sender)[0, 0, 0]
    steady = slice(60, -60)
    assert np.max(np.abs(found - expected)[steady]) < 0.02 * np.abs(expected[0])


@pytest.mark.parametrize("early", [0.9e-6, 1.1e-6, 2.0e-6])
def test_far_radars_are_heard_until_the_end_of_their_chirps_has_come(early):
    """From 750 m a chirp that ended before the radar's began is heard for what its delay is longer, as a tone of 2 MHz."""
    delay, duration = 750.0 / C, COUNT / RATE
    sender = build_radar(num_samples=COUNT, position=(750, 0, 0), yaw=np.pi,
                         start_frequency=77e9 - SLOPE * (duration + early - delay) - 2e6)
    power = np.abs(ep.interference(victim(num_chirps=1), sender, offset=-duration - early)[0, 0, 0]) ** 2
    level = friis(0.01, 750.0, sender.waveform.start_frequency)
    assert np.sum(power) / RATE == pytest.approx(level * (delay - early), rel=0.05)
    assert np.flatnonzero(power > 0.25 * level)[-1] == pytest.approx((delay - early) * RATE, abs=1)


@pytest.mark.parametrize("start", [0.0, 3600.1, 61200.51])
def test_chirps_of_later_hours_have_one_phase_as_those_of_the_first(start):
    """Parallel chirps at the rate of the radar's own: rounding of hours, 7e-12 s, would be half a turn at 77 GHz."""
    cube = ep.interference(victim(num_chirps=16), TONE.replace(waveform=TONE.waveform.replace(num_chirps=7)), start_time=start,
                           offset=start % TONE.waveform.chirp_interval)
    steady = cube[0, 0, :, 100:400]
    assert np.abs(steady).min() > 0.0
    np.testing.assert_allclose(steady, np.broadcast_to(steady[0], steady.shape), atol=1e-5 * np.abs(steady).max())


@pytest.mark.parametrize("late, sent", [(-1e-3, []), (0.72e-3, range(4)), (2.2e-3, range(5, 16))])
def test_frames_with_pauses_are_each_as_the_first_one(late, sent):
    """late: s, by which the frame of this radar begins after one of the other: 16 chirps of 60 us each 2.5 ms; sent: those of
    the radar's chirps in which the other one sends."""
    sender = other(num_chirps=16, chirp_interval=60e-6)
    cubes = [ep.interference(victim(num_chirps=16, chirp_interval=60e-6), sender, start_time=place * 2.5e-3 + late,
                             interval=2.5e-3)[0, 0] for place in (0, 1, 40)]
    for cube in cubes[1:]:
        # Rounding of .1 s, 7e-18 s, is 3e-6 of a radian at 77 GHz.
        np.testing.assert_allclose(cube, cubes[0], atol=1e-5 * np.abs(cubes[0]).max())
    assert np.flatnonzero(cubes[0].any(axis=1)).tolist() == list(sent)


def test_frames_need_room_within_their_interval():
    sender = other(num_chirps=16)
    for call in (lambda interval: ep.interference(victim(), sender, interval=interval),
                 lambda interval: ep.Interferer(radar=sender, interval=interval)):
        call(sender.frame_duration)
        with pytest.raises(ValueError, match="interval: must be at least .* s, the duration of a frame, got 0.0001"):
            call(1e-4)


def test_patterns_and_motion_of_both_count():
    pattern = ep.CosinePower(2.0)
    receiver = victim(receivers=[ep.Antenna(yaw=0.5, pattern=pattern)])
    moving = other(transmitters=[ep.Antenna(pattern=pattern)]).replace(motion=ep.LinearMotion(velocity=(10.0, 0, 0)))
    still = other(distance=30.0, transmitters=[ep.Antenna(pattern=pattern)])
    now = ep.interference(receiver, moving, start_time=60e-6 * 16667)  # some slots later than 1 s: at 30 m
    level = friis(0.05, 30.0, moving.waveform.start_frequency) * 6.0 * 6.0 * np.cos(0.5) ** 2
    length = RATE / (0.1 * SLOPE)
    assert np.sum(np.abs(now) ** 2) / RATE == pytest.approx(level * length, rel=0.1)
    assert np.sum(np.abs(ep.interference(receiver, still)) ** 2) / RATE == pytest.approx(level * length, rel=0.1)


def test_chirps_that_never_meet_leave_nothing():
    assert not ep.interference(victim(), build_radar(num_samples=COUNT, start_frequency=79e9, position=(20, 0, 0))).any()


def test_a_mirror_brings_the_radar_from_its_image():
    """A wall 4 m aside: what comes over it is as direct from 8 m aside, with the sign of a conductor."""
    receiver, sender = victim(num_chirps=1), other(num_chirps=1)
    scene = ep.Scene()
    scene.add(ep.actors.plate(40.0, 40.0), name="wall", material=ep.Material.metal(mirror=True), position=(10, 4, 0),
              yaw=-np.pi / 2)
    paths = ep.trace(scene, ep.interference_radar(receiver, sender), num_rays=2000, max_bounces=1)
    over = ep.interference(receiver, sender, paths)
    image = sender.replace(position=(20, 8, 0))
    direct = ep.interference(receiver, image)
    powers = [np.sum(np.abs(cube) ** 2) for cube in (over, direct)]
    assert 10 * np.log10(powers[0] / powers[1]) == pytest.approx(0.0, abs=LEVEL)
    middle = np.abs(direct[0, 0, 0]) > 0.9 * np.abs(direct).max()
    assert np.corrcoef(over[0, 0, 0][middle], direct[0, 0, 0][middle])[0, 1].real == pytest.approx(-1.0, abs=0.05)


def test_labels_name_it_as_a_part():
    radar = victim(num_chirps=32, transmit_power=1.0)
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.2), name="ball", material=ep.Material.metal(), smooth=True, position=(8, 0, 0))
    paths = ep.trace(scene, radar, num_rays=1000, max_bounces=1)
    parts = dict(ep.decompose(paths, radar, {"ball": "T 'ball' R"}))
    parts["interference"] = ep.interference(radar, build_radar(num_samples=COUNT, position=(40, 3, 0), num_chirps=32))
    noisy = ep.receive(sum(parts.values()), radar, seed=1).cube
    found = ep.detect(ep.range_doppler(noisy, radar), radar, parts=parts)
    assert {"ball", "interference"} <= set(found.part)
    strongest = found.power.argmax()
    assert found.part[strongest] == "interference" and found.range[strongest] == pytest.approx(20.0, abs=0.3)


def test_rough_walls_send_what_all_of_their_paths_do():
    """Parallel chirps: each path is a tone at the beat of its delay, here of all paths one by one; a thousandth is left out."""
    scene = ep.Scene()
    scene.add(ep.actors.plate(4.0, 4.0), name="rough", material=ep.Material(reflectivity=1.0, scattering=1.0),
              position=(10, 6, 0), yaw=-np.pi / 2)
    receiver = victim(num_chirps=1)
    paths = ep.trace(scene, ep.interference_radar(receiver, TONE), num_rays=1000, max_bounces=1)
    powers = np.sort(paths.power)[::-1]
    assert powers[:64].sum() < 0.6 * powers.sum()  # so many are not enough
    middle = 0.5 * COUNT / RATE
    delay, amplitude = paths.lengths([middle], 0, 0)[0] / C, paths.amplitudes([middle], 0, 0)[0]
    time = np.arange(COUNT) / RATE
    cycles = 77e9 * delay + SLOPE * np.outer(time, delay) - 0.5 * SLOPE * delay ** 2
    slow = (np.exp(2j * np.pi * np.mod(cycles, 1.0)) @ np.conj(amplitude))[64:]
    found = ep.interference(receiver, TONE, paths)[0, 0, 0, 64:]
    assert np.mean(np.abs(found - slow) ** 2) < 0.01 * np.mean(np.abs(slow) ** 2)


def test_chirps_that_hop_meet_as_their_steps_say():
    """Every other chirp of the other radar lies 2 GHz higher, outside the band: half of the crossings are left."""
    hopping = ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=COUNT, sampling_rate=RATE, num_chirps=32,
                               chirp_interval=60e-6, frequency_steps=(0.0, 2e9))
    cube = ep.interference(victim(num_chirps=32), TONE.replace(waveform=hopping))
    heard = np.abs(cube[0, 0]).max(axis=1) > 0
    np.testing.assert_array_equal(heard, np.arange(32) % 2 == 0)
