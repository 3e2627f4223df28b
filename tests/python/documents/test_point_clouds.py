"""Clutter removal, MUSIC, and detections as point clouds."""
import numpy as np
import pytest

import echopath as ep
from support.radars import build_radar

C = ep.speed_of_light
HALF = 0.5 * C / 77.5e9


def moving(cycles, num_chirps=64):
    """A cube whose phase turns by so many cycles a chirp, beside something that stands still."""
    turn = np.exp(2j * np.pi * cycles * np.arange(num_chirps))
    return (turn + 100.0)[None, None, :, None] * np.ones((1, 1, 1, 4))


def test_the_mean_takes_away_what_stands_still_and_nothing_else():
    cube = ep.remove_clutter(moving(5 / 64))
    np.testing.assert_allclose(cube[0, 0, :, 0], np.exp(2j * np.pi * 5 / 64 * np.arange(64)), atol=1e-12)


@pytest.mark.parametrize("order", [1, 2, 3])
@pytest.mark.parametrize("cycles", [0.02, 0.25, 0.5])
def test_cancellers_have_the_response_of_their_pulses(order, cycles):
    cube = ep.remove_clutter(moving(cycles), method="mti", order=order)[0, 0, :, 0]
    assert not cube[:order].any()
    np.testing.assert_allclose(np.abs(cube[order:]), abs(2 * np.sin(np.pi * cycles)) ** order, rtol=1e-9)


def test_a_canceller_needs_its_pulses():
    with pytest.raises(ValueError, match="^order: must be below 2"):
        ep.remove_clutter(np.zeros((1, 1, 2, 4)), method="mti", order=2)


@pytest.mark.parametrize("method", ["mean", "mti"])
@pytest.mark.parametrize("num_chirps", [0, 1])
def test_a_single_chirp_does_not_tell_what_stands_still(method, num_chirps):
    with pytest.raises(ValueError, match=f"^cube: must hold 2 chirps or more.* got {num_chirps}$"):
        ep.remove_clutter(np.ones((1, 1, num_chirps, 4)), method=method)


def array_map(azimuths, seed=1):
    """Plane waves of independent phases in each cell, on 8 elements, with little noise."""
    radar = build_radar(receivers=[(0, n * HALF, 0) for n in range(8)], num_chirps=16, num_samples=32)
    generator = np.random.default_rng(seed)
    places = np.arange(8) * HALF
    cube = 1e-6 * (generator.standard_normal((8, 16, 32)) + 1j * generator.standard_normal((8, 16, 32)))
    for azimuth in azimuths:
        wave = np.exp(-2j * np.pi * places * np.sin(azimuth) / radar.waveform.wavelength)
        cube += 1e-3 * wave[:, None, None] * np.exp(2j * np.pi * generator.random((1, 16, 32)))
    return radar, ep.range_doppler(cube[None], radar, window="rect")


def test_music_parts_waves_closer_than_a_beam():
    """8 elements half a wavelength apart have a beam of 13 degrees; the waves are 6 degrees apart."""
    wanted = np.radians([-2.0, 4.0])
    radar, spectrum = array_map(wanted)
    azimuth = np.radians(np.arange(-20.0, 20.0, 0.1))
    found = ep.music(spectrum, radar, azimuth, cells=[(8, 10)], num_sources=2)[0]
    peaks = np.flatnonzero((found[1:-1] > found[:-2]) & (found[1:-1] > found[2:])) + 1
    strongest = np.sort(azimuth[peaks[np.argsort(found[peaks])[-2:]]])
    assert np.degrees(strongest) == pytest.approx(np.degrees(wanted), abs=0.3)
    assert found.min() >= 1.0 - 1e-9
    at_ends = [ep.music(spectrum, radar, azimuth, cells=np.array([(0, 1), (15, 31)], kind)) for kind in (np.int64, np.uint8,
                                                                                                      np.uint64)]
    assert np.array_equal(at_ends[1], at_ends[0]) and np.array_equal(at_ends[2], at_ends[0])
    with pytest.raises(IndexError, match="^cells: must lie within"):
        ep.music(spectrum, radar, azimuth, cells=[(16, 0)])
    with pytest.raises(ValueError, match="^num_sources: must be fewer than the 8 channels"):
        ep.music(spectrum, radar, azimuth, cells=[(1, 0)], num_sources=8)


def turning_waves(velocity, *, order=(0, 1, 2, 3)):
    """Two waves of one range whose velocities differ by 0.7 cells, at transmitters that take turns; the speed of a cell."""
    radar = build_radar(transmitters=[(0, 4 * m * HALF, 0) for m in range(3)], receivers=[(0, n * HALF, 0) for n in order],
                        num_chirps=16, num_samples=32)
    waveform = radar.waveform
    slots = np.arange(3)[:, None] + 3 * np.arange(16)
    cube = 1e-8 * np.random.default_rng(1).standard_normal((3, 4, 16, 32)).astype(complex)
    for azimuth, faster in ((np.radians(5.0), 0.0), (np.radians(11.0), 0.7 * waveform.velocity_resolution(3))):
        speed = (velocity + faster) * waveform.chirp_interval
        phase = 2 * speed * slots[:, None, :] - HALF * np.sin(azimuth) * (4 * np.arange(3)[:, None, None]
                                                                         + np.array(order)[:, None])
        beat = np.exp(2j * np.pi * 10 * np.arange(32) / 32)
        cube += 1e-3 * np.exp(2j * np.pi * phase / waveform.wavelength)[..., None] * beat
    return radar, ep.range_doppler(cube, radar)


def music_of_strongest(radar, spectrum, **keywords):
    cell = np.unravel_index(np.abs(spectrum.values[0, 0]).argmax(), spectrum.values.shape[2:])
    return ep.music(spectrum, radar, np.radians(np.arange(-20.0, 20.0, 0.1)), cells=[cell], num_sources=2, **keywords)[0]


def test_music_is_alike_wherever_an_echo_lies_on_the_axis_of_velocities():
    """Cells beside the end of the axis are those of its other end, of an echo with the phases of the cell's velocity."""
    limit = build_radar(transmitters=[(0, 0, 0)] * 3, num_chirps=16).waveform.max_velocity(3)
    middle, end = (music_of_strongest(*turning_waves(velocity)) for velocity in (0.0, -limit))
    strongest = np.argsort(middle)[-1]
    assert end[strongest] == pytest.approx(middle[strongest], rel=0.5) and abs(end.argmax() - middle.argmax()) <= 1
    peaks = np.flatnonzero((end[1:-1] > end[:-2]) & (end[1:-1] > end[2:])) + 1
    found = np.sort(np.arange(-20.0, 20.0, 0.1)[peaks[np.argsort(end[peaks])[-2:]]])
    assert found == pytest.approx([5.0, 11.0], abs=1.0)  # a beam is 10 degrees wide


def test_music_of_the_mirrored_array_too_parts_waves_of_one_phase_law():
    """As of an echo and its mirror image: alone they are one source, and with the mirrored array's covariance they are two."""
    wanted, azimuth = np.radians([-8.0, 7.0]), np.radians(np.arange(-25.0, 25.0, 0.1))
    radar, places = array_map([])[0], np.arange(8) * HALF
    waves = [np.exp(-2j * np.pi * places * np.sin(one) / radar.waveform.wavelength) for one in wanted]
    field = waves[0] + 0.8j * waves[1]
    law = np.random.default_rng(5).normal(size=(2, 16, 32))
    noise = 1e-4 * np.random.default_rng(6).normal(size=(2, 8, 16, 32))
    cube = field[:, None, None] * (law[0] + 1j * law[1]) + noise[0] + 1j * noise[1]
    found = ep.music(ep.range_doppler(cube[None], radar, window="rect"), radar, azimuth, cells=[(8, 10)], num_sources=2,
                     forward_backward=True)[0]
    peaks = np.flatnonzero((found[1:-1] > found[:-2]) & (found[1:-1] > found[2:])) + 1
    strongest = np.sort(azimuth[peaks[np.argsort(found[peaks])[-2:]]])
    assert np.degrees(strongest) == pytest.approx(np.degrees(wanted), abs=0.3)


def test_music_mirrors_an_array_by_its_places():
    """Whatever the order of its channels."""
    in_order, mixed = (music_of_strongest(*turning_waves(0.0, order=order), forward_backward=True)
                       for order in ((0, 1, 2, 3), (1, 0, 2, 3)))
    assert abs(in_order.argmax() - mixed.argmax()) <= 1
    uneven = build_radar(receivers=[(0, n * HALF, 0) for n in (0, 1, 3)], num_chirps=4, num_samples=4)
    with pytest.raises(ValueError, match="^forward_backward: needs an array that is symmetric about its centre"):
        ep.music(ep.range_doppler(np.ones((1, 3, 4, 4)), uneven), uneven, [0.0], cells=[(0, 0)], forward_backward=True)


@pytest.fixture(scope="module")
def detections():
    radar = build_radar(receivers=[(0, n * HALF, 0) for n in range(8)], num_chirps=32, transmit_power=1.0)
    scene = ep.Scene()
    for name, place in (("left", (5.0, 1.0, 0)), ("right", (7.0, -2.0, 0))):
        scene.add(ep.actors.sphere(0.2), name=name, material=ep.Material.metal(), smooth=True, position=place)
    frame = ep.simulate(scene, radar, num_rays=2000, max_bounces=1, detections=True, guard=False)
    assert len(frame.detections) >= 2
    return frame.detections


def test_pcd_files_hold_the_points_as_their_head_says(detections, tmp_path):
    detections.to_pcd(tmp_path / "points.pcd")
    head, _, data = (tmp_path / "points.pcd").read_bytes().partition(b"DATA binary\n")
    lines = dict(line.split(" ", 1) for line in head.decode("ascii").splitlines() if not line.startswith("#"))
    fields = lines["FIELDS"].split()
    table = np.frombuffer(data, "<f4").reshape(int(lines["POINTS"]), len(fields))
    assert lines["WIDTH"] == lines["POINTS"] == str(len(detections)) and lines["VERSION"] == "0.7"
    np.testing.assert_allclose(table[:, :3], detections.points, rtol=1e-6)
    np.testing.assert_allclose(table[:, fields.index("velocity")], detections.velocity, rtol=1e-6)
    remarks = " ".join(line for line in head.decode("ascii").splitlines() if line.startswith("#"))
    assert all(word in remarks for word in ("receding positive", "left and up positive", "frame of the radar", *fields))
    assert set(lines["SIZE"].split()) == {"4"} and set(lines["TYPE"].split()) == {"F"}


def test_files_that_nothing_packs_are_refused(detections, tmp_path, monkeypatch):
    laspy = pytest.importorskip("laspy")
    monkeypatch.setattr(laspy.LazBackend, "detect_available", classmethod(lambda cls: ()))
    with pytest.raises(ep.FileError, match=r"points.laz: cannot be written .*; laspy\[lazrs\] packs .laz"):
        detections.to_las(tmp_path / "points.laz")
    assert not list(tmp_path.iterdir())


def test_las_files_are_read_by_their_library(detections, tmp_path):
    laspy = pytest.importorskip("laspy")
    assert detections.to_las(tmp_path / "points.las") == 0
    cloud = laspy.read(tmp_path / "points.las")
    np.testing.assert_allclose(np.asarray(cloud.xyz), detections.points, atol=1e-4)
    np.testing.assert_allclose(cloud["velocity"], detections.velocity)
    np.testing.assert_allclose(cloud.intensity / 100.0, detections.snr_db, atol=0.01)
    told = {one.name: one.description for one in cloud.point_format.extra_dimensions}
    assert told["velocity"] == "m/s, receding positive" and told["azimuth"] == "rad, left positive" and all(told.values())


def test_points_of_las_files_are_the_only_return_of_their_pulse(detections, tmp_path):
    """Returns count from 1 in LAS 1.4: 0 is invalid, and tools that take first or last returns find no points."""
    laspy = pytest.importorskip("laspy")
    detections.to_las(tmp_path / "points.las")
    cloud = laspy.read(tmp_path / "points.las")
    assert len(cloud) > 0 and np.all(cloud.return_number == 1) and np.all(cloud.number_of_returns == 1)
    assert cloud.header.number_of_points_by_return.tolist() == [len(cloud)] + 14 * [0]
