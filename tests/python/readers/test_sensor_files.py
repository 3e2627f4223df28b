"""Configurations of TI sensors as radars: each number of the file, several radars of one sensor, and what is refused."""
import warnings
from itertools import chain

import numpy as np
import pytest

import echopath as ep
from support.scenes.sensor_text import CONFIGURATION, COUNT, INTERVAL, RATE, SLOPE, START

C = ep.speed_of_light
ADVANCED = CONFIGURATION.replace("dfeDataOutputMode 1", "dfeDataOutputMode 3").replace(
    "profileCfg 0", "profileCfg 1 60.5 7 6 50 0 0 40 1 64 4000 0 0 30\nprofileCfg 0").replace(
    "frameCfg 0 1 32 0 50 1 0", "chirpCfg 2 2 1 0 0 0 0 1\nadvFrameCfg 2 0 0 1 0\nsubFrameCfg 0 -1 0 2 16 20 0 1 1 20\n"
    "subFrameCfg 1 -1 2 1 64 30 0 1 1 30")


def test_a_configuration_sets_up_its_radar(written):
    radar = ep.load_radar(written())
    waveform = radar.waveform
    assert waveform.start_frequency == pytest.approx(START, rel=1e-15)
    assert waveform.slope == pytest.approx(SLOPE, rel=1e-15)
    assert (waveform.num_samples, waveform.sampling_rate, waveform.num_chirps) == (COUNT, RATE, 32)
    assert waveform.chirp_interval == pytest.approx(INTERVAL, rel=1e-12)
    assert not waveform.real and radar.multiplexing == "tdm"
    half = 0.5 * C / 62e9
    np.testing.assert_allclose([one.position for one in radar.transmitters], [(0, 0, 0), (0, 4 * half, 0)])
    np.testing.assert_allclose([one.position for one in radar.receivers], [(0, i * half, 0) for i in range(4)])
    assert radar.receiver == ep.Receiver(high_pass=[175e3, 350e3], adc=ep.Adc(bits=16, gain_db=30.0))
    assert ep.load_radar(written(), ideal=True).receiver is None


def test_what_says_nothing_of_the_signal_is_named_and_left_alone(written):
    sensor = ep.load_sensor(written())
    assert sensor.ignored == ("guiMonitor", "sensorStart")
    assert (sensor.interval, sensor.num_frames, sensor.board, sensor.start_times) == (0.05, 0, "IWR6843ISK", (0.0,))


@pytest.mark.filterwarnings("ignore:board. .* sends from")
@pytest.mark.parametrize("board, tx, rx", [("IWR1443", 3, 4), ("AWR1843", 3, 4), ("IWR6843ISK", 3, 4), ("IWR6843AOP", 3, 4),
                                           ("AWR2243_cascade", 12, 16)])
def test_boards_have_their_antennas(written, board, tx, rx):
    masks = f"channelCfg {2 ** rx - 1} {2 ** tx - 1} 0"
    radar = ep.load_radar(written(channelCfg=masks), board)
    assert len(radar.receivers) == rx and len(radar.transmitters) == 2


def virtual_places(board, tx, rx, written):
    text = CONFIGURATION.replace("channelCfg 15 5 0", f"channelCfg {2 ** rx - 1} {2 ** tx - 1} 0")
    lines = [line for line in text.splitlines() if not line.startswith(("chirpCfg", "frameCfg"))]
    lines += [f"chirpCfg {i} {i} 0 0 0 0 0 {1 << i}" for i in range(tx)] + [f"frameCfg 0 {tx - 1} 4 0 100 1 0"]
    radar = ep.load_radar(written("\n".join(lines)), board)
    places = np.array([[t.position + r.position for r in radar.receivers] for t in radar.transmitters])
    return places / (0.5 * C / {"AWR2243_cascade": 76.8e9, "AWR1843": 79e9, "IWR1443": 79e9}.get(board, 62e9))


@pytest.mark.filterwarnings("ignore:board. .* sends from")  # the chirps are those of the 6843
def test_virtual_elements_are_those_that_ti_publishes(written):
    """antGeometry0 (to the right) and antGeometry1 (up) of configurations for the 6843; 86 azimuths of the cascade (JAJU737A)."""
    isk = virtual_places("IWR6843ISK", 3, 4, written).reshape(12, 3)
    np.testing.assert_allclose(-isk[:, 1], [0, -1, -2, -3, -2, -3, -4, -5, -4, -5, -6, -7], atol=1e-9)
    np.testing.assert_allclose(isk[:, 2] - 1, [-1, -1, -1, -1, 0, 0, 0, 0, -1, -1, -1, -1], atol=1e-9)
    aop = virtual_places("IWR6843AOP", 3, 4, written).reshape(12, 3)
    np.testing.assert_allclose(-aop[:, 1], [-1, -1, 0, 0, -3, -3, -2, -2, -1, -1, 0, 0], atol=1e-9)
    np.testing.assert_allclose(aop[:, 2], [-1, 0, -1, 0, -3, -2, -3, -2, -3, -2, -3, -2], atol=1e-9)
    for board in ("AWR1843", "IWR1443"):  # gAntDef_default of the mmWave SDK counts downward
        sent, heard = np.array([(0, 1), (2, 0), (4, 1)]), np.array([(0, 0), (1, 0), (2, 0), (3, 0)])
        places = virtual_places(board, 3, 4, written)
        np.testing.assert_allclose(places[..., 1], sent[:, None, 0] + heard[None, :, 0], atol=1e-9)
        np.testing.assert_allclose(places[..., 2] - 1, -(sent[:, None, 1] + heard[None, :, 1]), atol=1e-9)
    cascade = virtual_places("AWR2243_cascade", 12, 16, written).reshape(-1, 3)
    level = np.round(cascade[np.abs(cascade[:, 2]) < 0.5, 1]).astype(int)
    assert len(set(level)) == 86


def test_sub_frames_are_radars_that_begin_one_after_the_other(written):
    text = ADVANCED
    sensor = ep.load_sensor(written(text))
    assert sensor.start_times == (0.0, pytest.approx(0.02)) and sensor.interval == pytest.approx(0.05)
    first, second = sensor.radars
    assert (first.waveform.num_chirps, len(first.transmitters)) == (16, 2)
    assert (second.waveform.num_chirps, len(second.transmitters), second.waveform.num_samples) == (64, 1, 64)
    assert ep.load_radar(written(text), subframe=1) == second
    with pytest.raises(ValueError, match="^subframe: must be below 2"):
        ep.load_radar(written(text), subframe=2)
    one = ep.load_sensor(written(text.replace("advFrameCfg 2", "advFrameCfg 1")))  # the line of the second one is left over
    assert one.radars == (first,) and one.interval == pytest.approx(0.02)


def test_chirps_that_differ_become_steps(written):
    text = CONFIGURATION.replace("chirpCfg 1 1 0 0 0 0 0 4", "chirpCfg 1 1 0 1e6 0 2 0 4")
    waveform = ep.load_radar(written(text)).waveform
    assert waveform.frequency_steps == pytest.approx((0.0, 1e6))
    assert waveform.extra_idle == pytest.approx((2e-6, 0.0)) and waveform.chirp_interval == pytest.approx(INTERVAL)


def test_slopes_and_converters_of_chirps_add_to_those_of_their_profile(written):
    """The second chirp rises by 70.2 MHz/us and is sampled 7.5 us after its start, 50.5 us after the first and 45.5 us before."""
    text = CONFIGURATION.replace("chirpCfg 1 1 0 0 0 0 0 4", "chirpCfg 1 1 0 1e6 200 2 1.5 4")
    waveform = ep.load_radar(written(text)).waveform
    assert waveform.slope == pytest.approx(SLOPE) and waveform.start_frequency == pytest.approx(START)
    assert waveform.frequency_steps == pytest.approx((0.0, 1e6 + 70.2e12 * 7.5e-6 - 70e12 * 6e-6), rel=1e-6)
    assert waveform.bandwidth_steps == pytest.approx((0.0, 0.2e12 * COUNT / RATE), rel=1e-6)
    assert waveform.chirp_interval == pytest.approx(45.5e-6) and waveform.extra_idle == pytest.approx((5e-6, 0.0))


@pytest.mark.parametrize("command", ["profileCfg 0 60 7 6 40 0 0 65 1 128 5000 0 0 30", "chirpCfg 0 1 0 0 -5000 0 0 1"])
def test_of_two_lines_for_one_profile_or_chirp_the_later_counts(written, command):
    assert ep.load_radar(written(CONFIGURATION + command + "\n")).waveform.slope == pytest.approx(65e12)


def test_slopes_of_chirps_that_fall_are_negative(written):
    """The first sample is 6 us into the ramp, which has fallen by then."""
    waveform = ep.load_radar(written(profileCfg="profileCfg 0 63.5 7 6 40 0 0 -70 1 128 5000 0 0 30")).waveform
    assert waveform.slope == pytest.approx(-70e12) and waveform.bandwidth == pytest.approx(-70e12 * 128 / 5e6)
    assert waveform.start_frequency == pytest.approx(63.5e9 - 6e-6 * 70e12)
    with pytest.raises(ep.FileError, match="profileCfg: slope_mhz_us: must not be 0"):
        ep.load_radar(written(profileCfg="profileCfg 0 63.5 7 6 40 0 0 0 1 128 5000 0 0 30"))


def test_a_chirp_is_sampled_within_its_ramp(written):
    """The last sample of the second chirp would be taken 41.6 us after its start, whose ramp ends after 40 us."""
    text = CONFIGURATION.replace("chirpCfg 1 1 0 0 0 0 0 4", "chirpCfg 1 1 0 0 0 0 10 4")
    with pytest.raises(ep.FileError, match="ramp_end_us: must be at least 41.6, where the last sample is taken, got 40"):
        ep.load_radar(written(text))


def test_signs_of_two_transmitters_are_bpm(written):
    text = CONFIGURATION.replace(" 0 0 0 0 1\n", " 0 0 0 0 5\n").replace(" 0 0 0 0 4\n", " 0 0 0 0 5\n") + "bpmCfg -1 1 0 1\n"
    radar = ep.load_radar(written(text))
    assert (radar.multiplexing, radar.num_slots, radar.waveform.num_chirps) == ("bpm", 2, 32)


def test_back_off_and_phase_shifters_are_gains_and_phases_of_the_transmitters(written):
    """A byte for each transmitter: 10 dB is 0x0A; a quarter turn is 16 of 64 steps, in the upper six bits."""
    path = written(profileCfg=f"profileCfg 0 60 7 6 40 {0x0A0003} {0x400000} 70 1 128 5000 0 0 30")
    for receiver in (ep.load_radar(path).receiver, ep.load_radar(path, ideal=True).receiver):
        assert receiver.transmitter_gain_db == (-3.0, -10.0)  # of TX1 and TX3
        assert receiver.transmitter_phase == pytest.approx((0.0, np.pi / 2))
    radar = ep.load_radar(path, ideal=True)
    plain, shifted = (ep.simulate(*args, num_rays=500, noise_seed=None).noisy_cube for args in (
        (corner(), radar.replace(receiver=None)), (corner(), radar)))
    np.testing.assert_allclose(shifted[0], plain[0] * 10 ** (-3 / 20), rtol=1e-12)
    np.testing.assert_allclose(shifted[1], plain[1] * 1j * 10 ** (-10 / 20), rtol=1e-9)


@pytest.mark.filterwarnings("ignore:board. .* sends from")
def test_the_bytes_of_a_profile_are_those_of_each_device_of_a_cascade(written):
    others = ("profileCfg", "channelCfg", "chirpCfg", "frameCfg")
    lines = [line for line in CONFIGURATION.splitlines() if not line.startswith(others)]
    lines += [f"profileCfg 0 60 7 6 40 {0x0A0003} 0 70 1 128 5000 0 0 30", "channelCfg 15 4095 0", "frameCfg 0 11 4 0 100 1 0"]
    lines += [f"chirpCfg {i} {i} 0 0 0 0 0 {1 << i}" for i in range(12)]
    radar = ep.load_radar(written("\n".join(lines)), "AWR2243_cascade")
    assert radar.receiver.transmitter_gain_db == 4 * (-3.0, 0.0, -10.0)


def test_a_frame_is_of_the_chirps_that_it_names(written):
    """One of two, from another one than the first; or two of one transmitter, which are one after the other twice as many."""
    second = ep.load_radar(written(CONFIGURATION.replace("frameCfg 0 1", "frameCfg 1 1")))
    assert (len(second.transmitters), second.waveform.num_chirps) == (1, 32)
    assert second.transmitters[0].position[1] == pytest.approx(4 * 0.5 * C / 62e9)
    both = ep.load_radar(written(CONFIGURATION.replace("chirpCfg 1 1 0 0 0 0 0 4", "chirpCfg 1 1 0 0 0 0 0 1")))
    assert (len(both.transmitters), both.waveform.num_chirps) == (1, 64)


def test_a_sub_frame_has_time_for_its_chirps(written):
    """From its first sample to its last are 31 times 47 us and 127 times 0.2 us."""
    text = ADVANCED.replace("subFrameCfg 0 -1 0 2 16 20 0 1 1 20", "subFrameCfg 0 -1 0 2 16 1 0 1 1 1")
    with pytest.raises(ep.FileError, match="period_ms: must be at least 1.4824, the time of its chirps, got 1"):
        ep.load_radar(written(text))


def test_the_gain_is_in_the_lower_bits_of_its_number(written):
    """Bits 0 to 5; the two above them choose the gain before the mixer (mmWave radar interface control, profile)."""
    radar = ep.load_radar(written(profileCfg=f"profileCfg 0 60 7 6 40 0 0 70 1 128 5000 0 0 {0xC0 + 30}"))
    assert radar.receiver.adc.gain_db == 30.0


def of_two_profiles(name, values, mask):
    """A configuration whose two chirps have profiles that differ in one value alone; mask: of the transmitters of both."""
    columns = {"phase_shifter": "0 {}", "power_backoff": "{} 0"}[name]
    lines = [f"profileCfg {i} 60 7 6 40 {columns.format(value)} 70 1 128 5000 0 0 30" for i, value in enumerate(values)]
    lines += [f"chirpCfg {i} {i} {i} 0 0 0 0 {mask}" for i in range(2)]
    kept = [line for line in CONFIGURATION.splitlines() if not line.startswith(("profileCfg", "chirpCfg"))]
    return "\n".join(kept).replace("frameCfg", "\n".join([*lines, "frameCfg"])) + "\n"


@pytest.mark.parametrize("mask, name, first, second, harmless, told", [
    (5, "phase_shifter", 0x400000, 0xC00000, 0x408002, "transmitter 3, 64, as it must not change from chirp to chirp, got 192"),
    (5, "power_backoff", 0x000003, 0x000005, 0x000903, "transmitter 1, 3, .*, got 5"),
    (1, "phase_shifter", 0x000000, 0x000080, 0x408003, "transmitter 1, 0, .*, got 128"),
])
def test_phase_shifters_and_back_off_must_not_change_from_chirp_to_chirp(written, mask, name, first, second, harmless, told):
    """Harmless: bytes of transmitters that do not send, and the two bits below the steps of a phase."""
    rule = rf"sensor.cfg:7: profileCfg: {name}: must be that of line 6 for {told}"
    with pytest.raises(ep.FileError, match=rule):
        ep.load_radar(written(of_two_profiles(name, (first, second), mask)))
    ep.load_radar(written(of_two_profiles(name, (first, harmless), mask)))


def test_sub_frames_are_sequences_and_one_file(written, tmp_path):
    """A plate that recedes at 4 m/s is where each sub-frame finds it; the file has them in turn, frame by frame."""
    sensor = ep.load_sensor(written(ADVANCED)).replace(position=(0, 0, 1))
    scene = ep.Scene()
    scene.add(ep.actors.plate(0.3, 0.3), name="plate", material="metal", position=(3, 0, 1), yaw=np.pi,
              motion=ep.LinearMotion(velocity=(4, 0, 0)))
    sequences = sensor.sequences(scene, frames=2, start_time=0.1, settings={"num_rays": 500})
    np.testing.assert_allclose([one.times for one in sequences], [[0.1, 0.15], [0.12, 0.17]])
    frames = list(chain.from_iterable(zip(*sequences)))
    for frame in frames:
        peak = frame.spectrum.range[np.abs(frame.spectrum.values).max(axis=(0, 1, 2)).argmax()]
        middle = frame.paths.frame.start_time + 0.5 * frame.radar.frame_duration
        shift = frame.radar.waveform.centre_frequency * 4.0 / frame.radar.waveform.slope
        assert peak == pytest.approx(3.0 + 4.0 * middle + shift, abs=frame.radar.waveform.range_resolution)
    size = ep.save_raw(frames, tmp_path / "two.bin")
    of_frame = 4 * 4 * (2 * 16 * 128 + 64 * 64)
    assert size == 2 * of_frame
    second = np.fromfile(tmp_path / "two.bin", np.uint8)[of_frame + 4 * 4 * 2 * 16 * 128:]
    assert frames[3].save_raw(tmp_path / "last.bin") == len(second)
    np.testing.assert_array_equal(second, np.fromfile(tmp_path / "last.bin", np.uint8))


def test_sub_frames_begin_when_those_of_a_recording_did(written):
    sensor, scene = ep.load_sensor(written(ADVANCED)), ep.Scene()
    scene.add(ep.actors.plate(0.3, 0.3), name="plate", material="metal", position=(3, 0, 0), yaw=np.pi)
    sequences = sensor.sequences(scene, times=[0.1, 0.17, 0.3])
    np.testing.assert_allclose([one.times for one in sequences], [[0.1, 0.17, 0.3], [0.12, 0.19, 0.32]])
    for wrong in ({"frames": 3}, {"start_time": 0.1}):
        with pytest.raises(ValueError, match=f"^{next(iter(wrong))}: must be .* with `times`"):
            sensor.sequences(scene, times=[0.1, 0.17], **wrong)
    with pytest.raises(ValueError, match="^times: "):
        sensor.sequences(scene, times=[0.1, np.nan])
    with pytest.raises(TypeError, match="^frames: must be how many there are"):
        sensor.sequences(scene)


@pytest.mark.parametrize("lines, told", [
    (dict(profileCfg="profileCfg 0 60 7 6 40 -1 0 70 1 128 5000 0 0 30"), "sensor.cfg:6: profileCfg: power_backoff: must not be"),
    (dict(profileCfg="profileCfg 0 60 7 6 40 0 0 70 1 128"), r"sensor.cfg:6: profileCfg: must have 14 arguments"),
    (dict(profileCfg="profileCfg 0 60 x 6 40 0 0 70 1 128 5000 0 0 30"), "sensor.cfg:6: profileCfg: idle_us: must be a number"),
    (dict(profileCfg="profileCfg 0 60 7 6 30 0 0 70 1 128 5000 0 0 30"), "sensor.cfg:6: profileCfg: ramp_end_us: must be at"),
    (dict(profileCfg="profileCfg 3 60 7 6 40 0 0 70 1 128 5000 0 0 30"), "sensor.cfg:7: chirpCfg: profile: must be that"),
    (dict(profileCfg="profileCfg 0 60 7 6 40 0 0 70 1 128 5000 7 0 30"), "sensor.cfg:6: profileCfg: high_pass_1: must be 0"),
    (dict(channelCfg="channelCfg 15 1 0"), "sensor.cfg:8: chirpCfg: transmitters: 3 is not enabled"),
    (dict(channelCfg="channelCfg 31 5 0"), "sensor.cfg:3: channelCfg: receivers: must be a mask of the 4"),
    (dict(adcCfg="adcCfg 5 1"), "sensor.cfg:4: adcCfg: bits: must be 0, 1 or 2"),
    (dict(adcbufCfg="adcbufCfg -1 0 x 1 1"), "sensor.cfg:5: adcbufCfg: swap: must be a number"),
    (dict(adcCfg="adcCfg 2.5 1"), "sensor.cfg:4: adcCfg: bits: must be a whole number"),
    (dict(frameCfg="frameCfg 0 2 32 0 50 1 0"), "sensor.cfg:9: frameCfg: chirp 2: has no chirpCfg"),
    (dict(frameCfg="frameCfg 0 99999999999999 1 0 50 1 0", chirpCfg="chirpCfg 0 99999999999999 0 0 0 0 0 1"),
     "sensor.cfg:9: frameCfg: last: must leave at most 512, got 100000000000000"),
    (dict(frameCfg="frameCfg 0 1 32 0 -50 1 0"), "sensor.cfg:9: frameCfg: period_ms: must be at least 0, got -50"),
    (dict(frameCfg="frameCfg 0 1 32 -3 50 1 0"), "sensor.cfg:9: frameCfg: num_frames: must be at least 0, got -3"),
    (dict(profileCfg="profileCfg 0 60 -1 6 40 0 0 70 1 128 5000 0 0 30"), "sensor.cfg:6: profileCfg: idle_us: must be at"),
    (dict(profileCfg="profileCfg 0 60 7 6 40 0 0 70 1 128 5000 0 0 -5"), "sensor.cfg:6: profileCfg: gain_db: must be at"),
    (dict(frameCfg="frameCfg 0 1 32 0 2 1 0"), r"sensor.cfg:9: frameCfg: period_ms: must be at least 2.98\d+, the time of its"),
    (dict(frameCfg="sensorStop"), "sensor.cfg: has no frameCfg"),
    (dict(dfeDataOutputMode="dfeDataOutputMode 2"), "sensor.cfg:2: dfeDataOutputMode: mode: must be 1"),
])
def test_bad_lines_are_errors_with_their_numbers(written, lines, told):
    with pytest.raises(ep.FileError, match=told):
        ep.load_radar(written(**lines))


@pytest.mark.parametrize("masks, signs, told", [
    ((1, 5), "", "frameCfg: its chirps must use one transmitter each, or all the same ones"),
    ((5, 4), "", "frameCfg: its chirps must use one transmitter each, or all the same ones"),
    ((1, 4, 1), "", "frameCfg: its chirps must use one transmitter, or each of some once, in a loop"),
    ((5, 1), "bpmCfg -1 1 0 1", "bpmCfg: needs two chirps of the same two transmitters"),
    ((1, 1), "bpmCfg -1 1 0 1", "bpmCfg: needs two chirps of the same two transmitters"),
    ((5, 5, 5), "bpmCfg -1 1 0 1", "bpmCfg: needs two chirps of the same two transmitters")])
def test_transmitters_that_follow_no_known_order_are_told(written, masks, signs, told):
    kept = [line for line in CONFIGURATION.splitlines() if not line.startswith(("chirpCfg", "frameCfg"))]
    chirps = [f"chirpCfg {index} {index} 0 0 0 0 0 {mask}" for index, mask in enumerate(masks)]
    with pytest.raises(ep.FileError, match=told):
        ep.load_radar(written("\n".join([*kept, *chirps, f"frameCfg 0 {len(masks) - 1} 32 0 50 1 0", signs]) + "\n"))


def test_what_is_no_configuration_is_told_before_a_board_is_asked_for(tmp_path):
    (tmp_path / "room.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    with pytest.raises(ep.FileError, match=r"room.obj: has no frameCfg, nor any other command of .* sensor \(.cfg\)$"):
        ep.load_radar(tmp_path / "room.obj")


def test_chirps_of_another_board_are_warned_of(written):
    """The data sheet of the AWR1843 names 76 to 81 GHz; the file sends from 60.42 to 62.21 GHz, within the 60 to 64 GHz of its
    IWR6843."""
    with pytest.warns(RuntimeWarning, match="^board: AWR1843 sends from 76 to 81 GHz, .* from 60.42 to 62.21 GHz: "):
        ep.load_radar(written(), "AWR1843")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ep.load_radar(written())


def test_boards_that_nobody_names_are_asked_for(written):
    with pytest.raises(ValueError, match="^board: must be given, one of .*: the file says nothing"):
        ep.load_radar(written(CONFIGURATION.replace("% Platform : xWR68xx\n", "")))
    with pytest.raises(ValueError, match="^board: must be one of AWR1843"):
        ep.load_radar(written(), "AWR")


def corner():
    scene = ep.Scene()
    scene.add(ep.actors.trihedral(0.1), name="corner", material=ep.Material.metal(), position=(2, 0, 0))
    return scene
