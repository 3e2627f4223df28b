"""Configurations and raw data of TI sensors, read back by a tool of theirs (OpenRadar 1.0.1, unchanged)."""
import subprocess
import sys
from itertools import chain

import numpy as np
import pytest

import echopath as ep

C = ep.speed_of_light
CONFIGURATION = """% Platform : xWR68xx
dfeDataOutputMode 1
channelCfg 15 5 0
adcCfg 2 1
adcbufCfg -1 0 1 1 1
profileCfg 0 60 7 6 40 0 0 70 1 128 5000 0 0 30
chirpCfg 0 0 0 0 0 0 0 1
chirpCfg 1 1 0 0 0 0 0 4
frameCfg 0 1 32 0 50 1 0
guiMonitor -1 1 1 0 0 0 1
sensorStart
"""
ADVANCED = CONFIGURATION.replace("dfeDataOutputMode 1", "dfeDataOutputMode 3").replace(
    "profileCfg 0", "profileCfg 1 60.5 7 6 50 0 0 40 1 64 4000 0 0 30\nprofileCfg 0").replace(
    "frameCfg 0 1 32 0 50 1 0", "chirpCfg 2 2 1 0 0 0 0 1\nadvFrameCfg 2 0 0 1 0\nsubFrameCfg 0 -1 0 2 16 20 0 1 1 20\n"
    "subFrameCfg 1 -1 2 1 64 30 0 1 1 30")
RATE, COUNT, SLOPE, INTERVAL = 5e6, 128, 70e12, 47e-6
START = 60e9 + SLOPE * 6e-6


@pytest.fixture
def written(tmp_path):
    """write(text) -> path of a configuration; write(old=new) replaces in the one above."""
    def write(text=None, **lines):
        text = CONFIGURATION if text is None else text
        for command, line in lines.items():
            text = "\n".join(line if one.split()[:1] == [command] else one for one in text.splitlines()) + "\n"
        path = tmp_path / "sensor.cfg"
        path.write_text(text)
        return path
    return write


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


def test_chirps_that_differ_become_steps(written):
    text = CONFIGURATION.replace("chirpCfg 1 1 0 0 0 0 0 4", "chirpCfg 1 1 0 1e6 0 2 0 4")
    waveform = ep.load_radar(written(text)).waveform
    assert waveform.frequency_steps == pytest.approx((0.0, 1e6))
    assert waveform.extra_idle == pytest.approx((2e-6, 0.0)) and waveform.chirp_interval == pytest.approx(INTERVAL)


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
    (dict(frameCfg="sensorStop"), "sensor.cfg: has no frameCfg"),
    (dict(dfeDataOutputMode="dfeDataOutputMode 2"), "sensor.cfg:2: dfeDataOutputMode: mode: must be 1"),
])
def test_bad_lines_are_errors_with_their_numbers(written, lines, told):
    with pytest.raises(ep.FileError, match=told):
        ep.load_radar(written(**lines))


def test_boards_that_nobody_names_are_asked_for(written):
    with pytest.raises(ValueError, match="^board: must be given, one of .*: the file says nothing"):
        ep.load_radar(written(CONFIGURATION.replace("% Platform : xWR68xx\n", "")))
    with pytest.raises(ValueError, match="^board: must be one of AWR1843"):
        ep.load_radar(written(), "AWR")


def corner():
    scene = ep.Scene()
    scene.add(ep.actors.trihedral(0.1), name="corner", material=ep.Material.metal(), position=(2, 0, 0))
    return scene


def frame_of(sensor, azimuth=0.0, distance=2.0, speed=0.0, **keywords):
    out = np.array([np.cos(azimuth), np.sin(azimuth), 0.0])
    scene = ep.Scene()
    scene.add(ep.actors.trihedral(0.1), name="corner", material=ep.Material.metal(), position=tuple(distance * out),
              yaw=azimuth, motion=ep.LinearMotion(velocity=tuple(speed * out)))
    return ep.simulate(scene, sensor, num_rays=20_000, **keywords)


def read_by_openradar(path, num_slots=64):
    from mmwave.dataloader import DCA1000
    import mmwave.dsp as dsp

    raw = np.fromfile(path, np.int16)
    adc = DCA1000.organize(raw.astype(np.float64), num_slots, 4, COUNT)
    return dsp.doppler_processing(dsp.range_processing(adc), num_tx_antennas=2)


@pytest.mark.filterwarnings("ignore")
def test_openradar_finds_range_and_velocity_within_half_a_cell(written, tmp_path):
    pytest.importorskip("mmwave")
    sensor = ep.load_radar(written())
    frame_of(sensor, speed=0.8).save_raw(tmp_path / "frame.bin")
    assert (tmp_path / "frame.bin").stat().st_size == 64 * 4 * COUNT * 4
    power, _ = read_by_openradar(tmp_path / "frame.bin")
    power = power[:COUNT // 2]
    place, doppler = np.unravel_index(power.argmax(), power.shape)
    cell, speed_cell = sensor.waveform.range_resolution, sensor.waveform.velocity_resolution(2)
    assert place * cell == pytest.approx(2.0 + 0.8 * 32 * INTERVAL, abs=0.5 * cell)  # in the middle of the frame
    assert (doppler if doppler < 16 else doppler - 32) * speed_cell == pytest.approx(0.8, abs=0.5 * speed_cell)


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("azimuth_deg", [-25.0, 0.0, 12.0])
def test_openradar_finds_the_azimuth_of_a_corner_within_a_degree(written, tmp_path, azimuth_deg):
    """x of the board is to the right; 8 elements half a wavelength of 62 GHz apart."""
    pytest.importorskip("mmwave")
    sensor = ep.load_radar(written())
    frame_of(sensor, azimuth=np.radians(azimuth_deg), distance=4.0).save_raw(tmp_path / "frame.bin")
    power, snapshot = read_by_openradar(tmp_path / "frame.bin")
    place = power[:COUNT // 2, 0].argmax()
    angle_fft = np.abs(np.fft.fft(snapshot[place, :, 0], 1024))
    peak = np.fft.fftfreq(1024)[angle_fft.argmax()]
    scale = sensor.waveform.centre_frequency / 62e9  # elements are half a wavelength apart at 62 GHz
    assert np.degrees(np.arcsin(-2.0 * peak / scale)) == pytest.approx(azimuth_deg, abs=1.0)


def test_words_are_real_real_imaginary_imaginary_slot_by_slot(written, tmp_path):
    frame = frame_of(ep.load_radar(written()))
    codes = frame.received.codes
    assert frame.save_raw(tmp_path / "one.bin") == codes.nbytes
    words = np.fromfile(tmp_path / "one.bin", "<i2").reshape(32, 2, 4, COUNT // 2, 4)
    for tx in range(2):
        expected = np.moveaxis(codes[tx], 0, 1)  # [chirp, rx, sample, branch]
        np.testing.assert_array_equal(words[:, tx, ..., :2].reshape(32, 4, COUNT), expected[..., 0])
        np.testing.assert_array_equal(words[:, tx, ..., 2:].reshape(32, 4, COUNT), expected[..., 1])


def test_four_lanes_are_those_that_ti_reads(written, tmp_path):
    """Eight words a sample: rows 1 to 4 are the real parts of the receivers, 5 to 8 their imaginary ones (SWRA581, xWR14xx)."""
    radar = ep.load_radar(written(channelCfg="channelCfg 7 5 0"), "IWR1443")
    assert radar.receiver.adc.lanes == 4
    frame = frame_of(radar)
    frame.save_raw(tmp_path / "one.bin")
    rows = np.fromfile(tmp_path / "one.bin", "<i2").astype(float).reshape(-1, 8).T
    samples = (rows[:4] + 1j * rows[4:]).reshape(4, 32, 2, COUNT)
    codes = frame.received.codes.astype(float)
    np.testing.assert_array_equal(np.moveaxis(samples[:3], 2, 0), np.moveaxis(codes[..., 0] + 1j * codes[..., 1], 1, 1))
    assert not samples[3].any()


def test_sensors_that_stream_by_themselves_may_have_q_first(written, tmp_path):
    """SampleSwap 1 of adcbufCfg: the lower word is Q (RadarML/xwr reads QQII); it counts where lvdsStreamCfg streams samples."""
    one, other = (ep.load_radar(written(CONFIGURATION + line)) for line in ("", "lvdsStreamCfg -1 0 1 0\n"))
    assert not one.receiver.adc.q_first and other.receiver.adc.q_first
    assert not ep.load_radar(written(CONFIGURATION + "lvdsStreamCfg -1 0 0 0\n")).receiver.adc.q_first
    assert not ep.load_radar(written(CONFIGURATION + "lvdsStreamCfg -1 0 1 0\n", adcbufCfg="adcbufCfg 0 0 1 1")
                             ).receiver.adc.q_first
    for name, sensor in (("i.bin", one), ("q.bin", other)):
        frame_of(sensor).save_raw(tmp_path / name)
    first, second = (np.fromfile(tmp_path / name, "<i2").reshape(-1, 2, 2) for name in ("i.bin", "q.bin"))
    np.testing.assert_array_equal(first, second[:, ::-1])


def test_frames_follow_each_other_and_a_file_that_fails_is_not_written(written, tmp_path):
    sensor = ep.load_radar(written())
    scene = ep.Scene()
    scene.add(ep.actors.plate(0.2, 0.2), name="plate", material="metal", position=(3, 0, 0),
              motion=ep.LinearMotion(velocity=(1, 0, 0)))
    sequence = ep.Sequence(scene, sensor, frames=2, interval=0.05, num_rays=1000)
    size = ep.save_raw(sequence, tmp_path / "two.bin")
    whole = (tmp_path / "two.bin").read_bytes()
    assert size == len(whole) == 2 * 64 * 4 * COUNT * 4 and whole[:size // 2] != whole[size // 2:]
    assert sequence[1].save_raw(tmp_path / "second.bin") == size // 2
    assert (tmp_path / "second.bin").read_bytes() == whole[size // 2:]

    def failing():
        yield sequence[0]
        raise RuntimeError("no second frame")

    with pytest.raises(RuntimeError, match="no second frame"):
        ep.save_raw(failing(), tmp_path / "half.bin")
    assert sorted(one.name for one in tmp_path.glob("*.bin")) == ["second.bin", "two.bin"]
    assert not list(tmp_path.glob(".half*"))


def run_alone(code, folder):
    """The end of a process of its own, which writes frames of a radar into the folder."""
    return subprocess.run([sys.executable, "-c", SETUP + code], cwd=folder, capture_output=True, text=True, timeout=60)


SETUP = """
import os, resource, signal
import echopath as ep
radar = ep.Radar(ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=64, sampling_rate=10e6, num_chirps=16,
                                  chirp_interval=20e-6), transmitters=[ep.Antenna()], receivers=[ep.Antenna()])
frame = ep.simulate(ep.Scene(), radar, num_rays=100)
"""
KILLED = """
def frames():
    yield frame
    os.kill(os.getpid(), signal.SIGKILL)
ep.save_raw(frames(), "two.bin")
"""
FULL = """
resource.setrlimit(resource.RLIMIT_FSIZE, (5000, 5000))
try:
    ep.save_raw([frame, frame], "two.bin")
except ep.FileError as error:
    print(error)
"""


def test_processes_that_die_and_disks_that_are_full_leave_no_truncated_file(tmp_path):
    """One frame has 4096 bytes: the second does not fit, or never comes."""
    assert run_alone(KILLED, tmp_path).returncode == -9
    assert not list(tmp_path.glob("*.bin")) and not list(tmp_path.glob(".*.bin"))
    told = run_alone(FULL, tmp_path)
    assert "two.bin: cannot be written (File too large)" in told.stdout, told.stderr
    assert not list(tmp_path.glob("*.bin")) and len(list(tmp_path.glob(".*"))) == 1  # what the killed one left


SCENE = """[radar]
sensor = "sensor.cfg"
position = [0, 0, 1]
yaw_deg = 90

[trace]
num_rays = 1000

[[objects]]
name = "plate"
actor = "plate"
parameters = {width = 0.3, height = 0.3}
material = "metal"
position = [0, 4, 1]
yaw_deg = 90
"""


def test_scene_files_take_sensors_and_runs_write_raw_data(written, tmp_path, capsys):
    written()
    (tmp_path / "scene.toml").write_text(SCENE)
    radar = ep.load_scene(tmp_path / "scene.toml").radar
    assert radar == ep.load_radar(tmp_path / "sensor.cfg").replace(position=(0, 0, 1), yaw=np.pi / 2)
    (tmp_path / "measured.toml").write_text(SCENE.replace("yaw_deg = 90\n\n[trace]",
                                                          "transmit_power = 0.02\nnoise_figure_db = 11.0\n\n[trace]"))
    measured = ep.load_scene(tmp_path / "measured.toml").radar
    assert measured == radar.replace(yaw=0.0, transmit_power=0.02, noise_figure_db=11.0)
    from echopath.cli import main

    arguments = ["run", str(tmp_path / "scene.toml"), "--out", str(tmp_path / "out"), "--raw", str(tmp_path / "two.bin")]
    assert not main([*arguments, "--frames", "2", "--interval", "0.05"])
    size = 64 * 4 * COUNT * 4
    assert (tmp_path / "two.bin").stat().st_size == 2 * size and f"{2 * size} bytes of raw data" in capsys.readouterr().out
    assert main([*arguments, "--frames", "2", "--interval", "0.05", "--keep", "maps"])
    assert "--raw: needs the signals of all frames" in capsys.readouterr().err


@pytest.mark.parametrize("line, told", [
    ('board = "IWR6843"', "radar: board: must be one of"), ("empty_slots = 2", "empty_slots: must not stand beside"),
    ("receiver = {adc = {bits = 40}}", "radar.receiver.adc.bits: must be"), ("receiver = {adv = 3}", "unknown keyword 'adv'")])
def test_bad_sensors_of_scene_files_are_refused(written, tmp_path, line, told):
    written()
    (tmp_path / "scene.toml").write_text(SCENE.replace("yaw_deg = 90\n\n[trace]", f"{line}\n\n[trace]"))
    with pytest.raises(ValueError, match=told):
        ep.load_scene(tmp_path / "scene.toml")
