"""Raw data of TI sensors, read back by a tool of theirs (OpenRadar 1.0.1, unchanged), and scene files that take sensors."""
import subprocess
import sys
import warnings

import numpy as np
import pytest

import echopath as ep
from echopath.sensor_files import raw_bytes
from echopath.transmit import signal_shape
from support.scenes.sensor_text import CONFIGURATION, COUNT, INTERVAL


def frame_of(sensor, azimuth=0.0, distance=2.0, speed=0.0, **keywords):
    out = np.array([np.cos(azimuth), np.sin(azimuth), 0.0])
    scene = ep.Scene()
    scene.add(ep.actors.trihedral(0.1), name="corner", material=ep.Material.metal(), position=tuple(distance * out),
              yaw=azimuth, motion=ep.LinearMotion(velocity=tuple(speed * out)))
    return ep.simulate(scene, sensor, num_rays=20_000, **keywords)


def read_by_openradar(path, num_slots=64):
    import mmwave.dsp as dsp
    from mmwave.dataloader import DCA1000

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


@pytest.mark.parametrize("mask, num_rx", [(7, 3), (15, 4)])
def test_four_lanes_are_those_that_ti_reads(written, tmp_path, mask, num_rx):
    """Eight words a sample: rows 1 to 4 are the real parts of the receivers, 5 to 8 their imaginary ones (SWRA581, xWR14xx)."""
    radar = ep.load_radar(written(channelCfg=f"channelCfg {mask} 5 0"), "IWR1443")
    assert radar.receiver.adc.lanes == 4
    frame = frame_of(radar)
    frame.save_raw(tmp_path / "one.bin")
    rows = np.fromfile(tmp_path / "one.bin", "<i2").astype(float).reshape(-1, 8).T
    samples = (rows[:4] + 1j * rows[4:]).reshape(4, 32, 2, COUNT)
    codes = frame.received.codes.astype(float)
    np.testing.assert_array_equal(np.moveaxis(samples[:num_rx], 2, 0), np.moveaxis(codes[..., 0] + 1j * codes[..., 1], 1, 1))
    assert not samples[num_rx:].any() and codes.any()


@pytest.mark.filterwarnings("ignore")
def test_files_of_sensors_are_read_as_openradar_reads_them(written, tmp_path):
    """Words without a pattern; of two frames, the second one."""
    organize = pytest.importorskip("mmwave.dataloader").DCA1000.organize
    words = np.random.default_rng(1).integers(-2 ** 15, 2 ** 15, 2 * 64 * 4 * COUNT * 2).astype("<i2")
    words.tofile(tmp_path / "two.bin")
    _, second = ep.load_raw(tmp_path / "two.bin", ep.load_radar(written()))
    expected = organize(words[words.size // 2:].astype(float), 64, 4, COUNT).reshape(32, 2, 4, COUNT)  # [chirp, tx, rx, sample]
    assert second.codes.shape == (2, 4, 32, COUNT, 2) and second.codes.dtype == np.int16
    np.testing.assert_array_equal(second.codes @ [1, 1j], np.moveaxis(expected, 0, 2))


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("changes, board", [
    ({}, None), ({"adcCfg": "adcCfg 0 0"}, None), ({"channelCfg": "channelCfg 7 5 0"}, "IWR1443"),
    ({"channelCfg": "channelCfg 7 5 0", "adcCfg": "adcCfg 2 0"}, "IWR1443"),
    ({"chirpCfg": "chirpCfg 0 1 0 0 0 0 0 5\nbpmCfg -1 1 0 1"}, None)])
@pytest.mark.parametrize("q_first", [False, True])
def test_what_is_written_is_read(written, tmp_path, changes, board, q_first):
    """Two lanes, real samples of 12 bits, four lanes, real ones in these, and transmitters that send at once."""
    radar = ep.load_radar(written(**changes), board)
    radar = radar.replace(receiver=radar.receiver.replace(adc=radar.receiver.adc.replace(q_first=q_first)))
    received = ep.receive(1e-3 * np.random.default_rng(1).normal(size=signal_shape(radar)), radar, seed=1)
    (tmp_path / "one.bin").write_bytes(raw_bytes(received, radar))
    read, = ep.load_raw(tmp_path / "one.bin", radar)
    np.testing.assert_array_equal(read.codes, received.codes)
    np.testing.assert_array_equal(read.cube, received.cube)
    assert read.gain_db == received.gain_db and len(np.unique(read.codes)) > 100


def test_twelve_bits_have_their_sign_also_where_the_word_has_not(written, tmp_path):
    """0x801 is -2047 of 12 bits, as TI's readers count it."""
    np.full(64 * 4 * COUNT * 2, 0x801, "<i2").tofile(tmp_path / "one.bin")
    read, = ep.load_raw(tmp_path / "one.bin", ep.load_radar(written(adcCfg="adcCfg 0 1")))
    assert np.all(read.codes == -2047)


def test_levels_without_a_gain_are_told(written, tmp_path):
    """Code 1 is a step of 2^-15 of the full scale in each branch, divided by the gain."""
    np.full(64 * 4 * COUNT * 2, 1, "<i2").tofile(tmp_path / "one.bin")
    ideal = ep.load_radar(written(), ideal=True)
    with pytest.warns(RuntimeWarning, match=r"radar.receiver.adc: has no gain of its own.* as if it were 30 dB"):
        unknown, = ep.load_raw(tmp_path / "one.bin", ideal)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        known, = ep.load_raw(tmp_path / "one.bin", ideal.replace(receiver=ep.Receiver(adc=ep.Adc(bits=16, gain_db=50.0))))
    np.testing.assert_allclose(known.cube, unknown.cube / 10, rtol=1e-12)


def test_files_that_hold_no_whole_number_of_frames_are_told(written, tmp_path):
    radar, path, size = ep.load_radar(written()), tmp_path / "some.bin", 64 * 4 * COUNT * 4
    path.write_bytes(bytes(size - 1))
    with pytest.raises(ep.FileError, match=r"some.bin: must hold 131,072 bytes, a frame of that radar, got 131,071"):
        ep.load_raw(path, radar)
    path.write_bytes(bytes(2 * size + 3))
    with pytest.warns(RuntimeWarning, match=r"ends within a frame: 3 of 131,072 bytes are left after 2 frames"):
        assert len(list(ep.load_raw(path, radar))) == 2
    with pytest.raises(ep.FileError, match=r"none.bin: cannot be read \(No such file"):
        ep.load_raw(tmp_path / "none.bin", radar)


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

    sequence[0].paths.save(tmp_path / "record.h5")
    with pytest.raises(ValueError, match="^frames: must be frames with their signals, got Frame"):
        ep.save_raw(ep.load_frame(tmp_path / "record.h5"), tmp_path / "none.bin")

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


@pytest.mark.usefixtures("blank_pictures")
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
    assert (tmp_path / "two.bin").stat().st_size == 2 * size and f"{2 * size:,} bytes of raw data" in capsys.readouterr().out
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
