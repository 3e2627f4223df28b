"""The converter behind the receiver, receivers as values, and what is refused of them."""
import pickle
import warnings

import numpy as np
import pytest

import echopath as ep
from echopath.cli.info import _describe_radar
from echopath.receiver.converter import is_swamped, jittered, noise_of_branch, step_text
from support.signals.received_tones import COUNT, LEVEL, RATE, db, one_channel, received, tone


@pytest.mark.parametrize("bits", [8, 10, 14])
@pytest.mark.parametrize("real", [False, True])
def test_quantisation_noise_is_6_db_a_bit(bits, real):
    adc = ep.Adc(bits=bits, full_scale_dbm=0.0, gain_db=20.0)
    radar = one_channel(64, real=real, receiver=ep.Receiver(adc=adc))
    cell = 33.317 + np.arange(64)[:, None] * 0.713  # no two chirps alike
    largest = 1.0 - 1.5 / 2 ** (bits - 1)  # beyond which the upper end clips
    full = largest * np.sqrt(1e-5) * np.exp(2j * np.pi * cell * np.arange(COUNT) / COUNT)[None, None]
    full = np.sqrt(2.0) * full.real + 0j if real else full
    out = ep.receive(full, radar, seed=None)
    noise = np.mean(np.abs(out.cube - full) ** 2)
    assert db(noise / 1e-5) == pytest.approx(-6.0206 * bits - 1.7609, abs=LEVEL)
    assert out.codes.dtype == np.int16 and out.gain_db == 20.0
    assert np.abs(out.codes.astype(int)).max() <= 2 ** (bits - 1)


def test_the_converter_saturates_and_its_gain_adapts():
    adc = ep.Adc(bits=10, full_scale_dbm=0.0, gain_db=40.0)
    with pytest.warns(RuntimeWarning, match="^receiver.adc: at least 50 % of the codes are clipped .* lower gain_db by 40 dB"):
        out = received(tone(20, 1e-3), adc=adc)
    assert out.codes.min() == -512 and out.codes.max() == 511
    automatic = received(tone(20, 1e-3), adc=adc.replace(automatic_gain=True, headroom_db=3.0, gain_step_db=2.0))
    assert automatic.gain_db == -4.0
    assert np.abs(automatic.codes.astype(int)).max() == round(512 * 10 ** (-4.0 / 20))


@pytest.mark.parametrize("excess_db, told", [(0.0, None), (0.0005, None), (3.5, "at least 50 %"), (0.05, "at least 5 %")])
@pytest.mark.parametrize("real", [False, True])
def test_clipping_is_told_by_its_share(excess_db, told, real):
    """A tone of amplitude k over full scale is beyond it for 2 / pi acos(1 / k) of its time: .7 %, 53 % and 7 %."""
    radar = one_channel(64, real=real, receiver=ep.Receiver(adc=ep.Adc(bits=12, full_scale_dbm=0.0, gain_db=20.0)))
    cell = 33.317 + np.arange(64)[:, None] * 0.713
    cube = np.sqrt(1e-5 * 10.0 ** (excess_db / 10.0)) * np.exp(2j * np.pi * cell * np.arange(COUNT) / COUNT)[None, None]
    with warnings.catch_warnings(record=True) as record:
        warnings.simplefilter("always")
        out = ep.receive(np.sqrt(2.0) * cube.real + 0j if real else cube, radar, seed=None)
    assert out.codes.max() == 2047 and len(record) == (told is not None)
    if told:
        assert str(record[0].message) == (f"receiver.adc: {told} of the codes are clipped at full scale: lower gain_db by 5 dB, "
                                          "or let automatic_gain choose it")
        assert record[0].filename == __file__


def test_a_converter_that_swallows_all_is_told_of_and_the_gain_that_it_names_mends_it():
    """Noise of -174 + 73 + 10 dBm in 20 MHz, steps of 8 bits below 10 dBm at -32 dBm: 62 dB are missing, of a branch."""
    radar = one_channel(noise_figure_db=10.0)
    level_db = 10.0 * np.log10(1.380649e-23 * 290.0 * RATE / 1e-3) + 10.0
    missing = 5 * int(np.ceil((10.0 - 20.0 * np.log10(128.0) - level_db + 10.0 * np.log10(2.0)) / 5.0))
    swallowed, mended = (radar.replace(receiver=ep.Receiver(adc=ep.Adc(bits=8, gain_db=gain))) for gain in (0.0, missing))
    nothing = tone(20, 0.0)
    with pytest.warns(RuntimeWarning, match=f"all codes are alike: raise gain_db by {missing} dB") as told:
        assert not ep.receive(nothing, swallowed, seed=1).codes.any()
    assert len(told) == 1
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert np.ptp(ep.receive(nothing, mended, seed=1).codes) > 4
        assert not ep.receive(nothing, swallowed, seed=None).codes.any()  # of nothing, nothing is lost
    headroom = ep.Receiver(adc=ep.Adc(bits=2, automatic_gain=True, headroom_db=40.0))
    with pytest.warns(RuntimeWarning, match="all codes are alike: lower headroom_db by"):
        ep.receive(nothing, radar.replace(receiver=headroom), seed=1)


def test_jitter_makes_noise_by_the_square_of_the_frequency():
    cell, jitter = 200, 50e-12
    adc = ep.Adc(bits=16, full_scale_dbm=33.0, gain_db=0.0, clock_jitter=jitter)
    radar = one_channel(64, receiver=ep.Receiver(adc=adc), noise_figure_db=0.0)
    out = ep.receive(tone(cell, 1.0, 64), radar, seed=3).cube
    noise = np.mean(np.abs(out - tone(cell, 1.0, 64)) ** 2)
    assert db(noise) == pytest.approx(20 * np.log10(2 * np.pi * cell * RATE / COUNT * jitter), abs=LEVEL)


def test_receivers_are_sampled_at_one_instant_and_chirps_at_others():
    adc = ep.Adc(clock_jitter=50e-12)
    cube = np.repeat(np.repeat(tone(200, 1.0, 4), 2, axis=0), 3, axis=1)
    sent, other = jittered(cube, one_channel(4).waveform, adc, np.random.default_rng(1)) - cube
    np.testing.assert_array_equal(sent, np.broadcast_to(sent[:1], sent.shape))
    for one, another in ((sent, other), (sent[:, 0], sent[:, 1])):
        assert np.all(one != another)


def test_the_same_seed_gives_the_same_bits_and_frames_differ():
    faults = dict(phase_noise=dict(offsets=[1e4, 1e6], levels=[-80, -100]), adc=dict(bits=12, clock_jitter=1e-12))
    one, same = (received(tone(60, 1e-6), seed=4, **faults).cube for _ in range(2))
    np.testing.assert_array_equal(one, same)
    radar = one_channel(receiver=ep.Receiver(**faults))
    assert not np.array_equal(one, ep.receive(tone(60, 1e-6), radar, seed=4, start_time=0.1).cube)


def test_receivers_are_values_that_files_keep(tmp_path):
    receiver = ep.Receiver(phase_noise=ep.PhaseNoise(offsets=[1e3, 1e6], levels=[-80, -100]), leakage_db=[[-30.0]],
                           adc=ep.Adc(bits=14), dc_offset=(1e-6, 0.0), high_pass=[1e5])
    radar = one_channel(1, receiver=receiver)
    assert hash(receiver) == hash(ep.Receiver(**receiver.plain())) and ep.Receiver(**receiver.plain()) == receiver
    assert pickle.loads(pickle.dumps(radar)) == radar
    scene = ep.Scene()
    scene.add(ep.actors.plate(1, 1), name="plate", material="metal", position=(5, 0, 0))
    ep.trace(scene, radar, num_rays=500).save(tmp_path / "f.h5")
    assert ep.Paths.load(tmp_path / "f.h5").radar == radar


@pytest.mark.parametrize("keywords, told", [
    (dict(phase_noise=dict(offsets=[1e3, 1e2], levels=[0, 0])), "phase_noise.offsets: must be ascending"),
    (dict(phase_noise=dict(offsets=[1e3], levels=[0, 0])), "phase_noise.offsets: must be as many as levels, 2"),
    (dict(adc=dict(bits=17)), "adc.bits: must be"),
    (dict(high_pass=[-1.0]), "high_pass: must be Hz above 0"),
    (dict(iq_phase=2.0), "iq_phase: must be"),
])
def test_bad_receivers_are_refused_by_name(keywords, told):
    with pytest.raises(ValueError, match=f"^{told}"):
        ep.Receiver(**keywords)


def test_tables_of_other_antennas_are_refused():
    with pytest.raises(ValueError, match=r"^receiver.leakage_db: must be of the shape \(1, 1\)"):
        received(tone(3), leakage_db=[[1.0, 2.0]])


def test_steps_swamp_noise_that_is_less_than_what_rounding_adds():
    """The rms of what is spread evenly over a step of 0.2."""
    added = np.sqrt(np.mean(np.linspace(-0.1, 0.1, 100_001) ** 2))
    assert is_swamped(0.99 * added, 0.2) and not is_swamped(1.01 * added, 0.2) and not is_swamped(0.0, 0.2)


@pytest.mark.parametrize("real", [False, True])
def test_steps_that_swamp_the_noise_are_told_of_with_what_mends_them(real):
    """Noise of -174 + 73 + 10 dBm in 20 MHz, half of it in a branch, is .3 of a step of 14 bits below 10 dBm at a gain that
    leaves it there: next to nothing but -1, 0 and 1 is given. Steps of the noise itself are 10 dB smaller."""
    noise = 0.5 * 1.380649e-23 * 290.0 * RATE * 10.0
    full_scale = 1e-2 * (2.0 if real else 1.0)
    gain = db(full_scale / 4 ** 13 / noise) + 20.0 * np.log10(0.25)
    radar = one_channel(noise_figure_db=10.0, real=real, receiver=ep.Receiver(adc=ep.Adc(bits=14, gain_db=gain)))
    told = r"^receiver.adc: its steps of -81.9 dBm swamp the noise of -94.0 dBm in a branch, and 3 of 16,384 codes are used: "
    with pytest.warns(RuntimeWarning, match=f"{told}raise gain_db by 15 dB, or take more bits$"):
        codes = ep.receive(tone(20, 0.0), radar, seed=1).codes
    assert len(np.unique(codes)) == 3
    assert "the steps swamp the noise, which uses 3 codes of 16,384: raise gain_db by 15 dB" in step_text(radar)
    mended = radar.replace(receiver=ep.Receiver(adc=ep.Adc(bits=14, gain_db=gain + 15.0)))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ep.receive(tone(20, 0.0), mended, seed=1)
        ep.receive(tone(20, 1e-9), radar, seed=None)  # without noise there is none to be swamped
    assert "swamp" not in step_text(mended)


def test_behind_a_strong_echo_only_more_bits_bring_the_noise_back():
    """29.9 dB lie between steps and noise, and a bit is worth 6.02."""
    radar = one_channel(noise_figure_db=10.0, receiver=ep.Receiver(adc=ep.Adc(bits=8, automatic_gain=True)))
    told = r"steps of -64.1 dBm .* noise of -94.0 dBm .* \d+ of 256 codes are used: take 5 bits more, as more gain would clip"
    with pytest.warns(RuntimeWarning, match=told):
        ep.receive(tone(20, 1e-6), radar, seed=1)
    assert step_text(radar) == "8 bits, gain chosen for each frame"


@pytest.mark.parametrize("real", [False, True])
def test_filters_take_noise_before_it_is_converted(real):
    radar = one_channel(64, real=real, noise_figure_db=10.0, receiver=ep.Receiver(low_pass=3e6, high_pass=[1e6]))
    behind = ep.receive(tone(20, 0.0, 64), radar, seed=1).cube
    assert db(np.var(behind.real)) == pytest.approx(20.0 * np.log10(noise_of_branch(radar)), abs=0.1)


def test_info_tells_of_a_converter():
    radar = one_channel(noise_figure_db=10.0, receiver=ep.Receiver(adc=ep.Adc(bits=8, gain_db=40.0)))
    told = " ".join(line.strip() for line in _describe_radar(radar, 0.0))
    assert "converter" in told and "the steps swamp the noise, which uses" in told
    assert "converter" not in " ".join(_describe_radar(radar.replace(receiver=None), 0.0))
