"""Images on planes that turn during the frame: what edges leave of their fields changes, beside Kirchhoff's integral."""
import numpy as np
import pytest

import echopath as ep
from support.radars import FREQUENCY, build_radar, chirp_times

WAVE_NUMBER = 2 * np.pi * FREQUENCY / ep.speed_of_light  # rad/m
SIDE = 0.3               # m, of a plate
DISTANCE = 5.0           # m, of it
LIMIT = 0.3              # of the field of an endless plane: by so much `validity` lets the share of edges change
RIGHT = 0.03             # likewise: to so much the share of edges of rectangles is right
SHARES_ROUND = 2e-3      # likewise: as a record keeps it
MANY = 64                # stretches, one for each chirp


def turning_plate(turn, pushed=0.0, mirror=False):
    """A metal plate before a radar, flagged where mirror is set: it turns by an angle in rad within the frame, and faces the
    radar in the middle of it, pushed aside by so many m."""
    radar = build_radar(bandwidth=0.3e9, num_chirps=MANY, chirp_interval=100e-6, num_samples=16)
    rate = turn / (MANY * 100e-6)
    half = SIDE / 2
    corners = np.array([[0, -half, -half], [0, half, -half], [0, half, half], [0, -half, half]]) + [0, pushed, 0]
    scene = ep.Scene()
    scene.add(ep.Mesh(corners, [[0, 1, 2], [0, 2, 3]]), name="plate", material=ep.Material.metal(mirror=mirror),
              position=(DISTANCE, 0, 0), yaw=-rate * radar.middle_of_frame(),
              motion=ep.LinearMotion(angular_velocity=(0, 0, rate)))
    return ep.trace(scene, radar, num_rays=5000, max_bounces=1, polarization="scalar"), rate


def shares_by_integral(paths, rate, pushed=0.0):
    """[chirps] |field| in the middle of each chirp over that of an endless plane: Kirchhoff's integral over the plate."""
    places, weights = np.polynomial.legendre.leggauss(100)
    y, z = np.meshgrid(SIDE / 2 * places + pushed, SIDE / 2 * places, indexing="ij")
    area = (SIDE / 2) ** 2 * np.outer(weights, weights)
    shares = []
    for time in chirp_times(paths.radar):
        turn = rate * (time - paths.frame.trace_time)
        points = np.stack([DISTANCE - np.sin(turn) * y, np.cos(turn) * y, z], axis=-1)
        way = np.linalg.norm(points, axis=-1)
        height = points @ [np.cos(turn), np.sin(turn), 0.0]
        field = np.sum(area * height / way**3 * np.exp(-2j * WAVE_NUMBER * way)) * FREQUENCY / ep.speed_of_light
        shares.append(2.0 * DISTANCE * np.cos(turn) * abs(field))
    return np.array(shares)


def shares_of(paths, **settings):
    """[chirps] the same by the replay."""
    levels = np.sqrt(np.mean(np.abs(ep.synthesize(paths, **settings)[0, 0]) ** 2, axis=1))
    endless = ep.speed_of_light / FREQUENCY * np.sqrt(paths.radar.transmit_power) / (4 * np.pi * 2 * DISTANCE)
    return levels / endless


CASES = [(0.05, 0.0), (0.03, 0.05), (0.02, -0.1)]


@pytest.mark.parametrize("turn, pushed", CASES)
def test_renewed_records_follow_what_edges_leave_of_a_plate_that_turns(turn, pushed):
    paths, rate = turning_plate(turn, pushed)
    truth = shares_by_integral(paths, rate, pushed)
    assert paths.num_paths == 1 and max(abs(shares_of(paths) - truth)) > LIMIT
    with pytest.warns(RuntimeWarning, match="new surface is looked for in 32 of 64"):
        followed = shares_of(paths, retrace="invalid", keyframes=MANY)
    assert np.max(abs(followed - truth)) < RIGHT


@pytest.mark.parametrize("turn, pushed", CASES)
def test_validity_tells_and_its_stretches_leave_no_more_than_its_limit(turn, pushed):
    paths, rate = turning_plate(turn, pushed)
    report = ep.validity(paths, arrays=True)
    assert report.beside_edges_share == pytest.approx(1.0) and not report.ok
    assert report.edge_change[0] == pytest.approx(report.largest_edge_change) and LIMIT < report.largest_edge_change < 2.0
    assert any("another share of 100 %" in text for text in report.warnings)
    assert report.objects["plate"].beside_edges == pytest.approx(1.0)
    truth = shares_by_integral(paths, rate, pushed)
    assert np.max(abs(shares_of(paths, retrace="invalid") - truth)) < LIMIT + RIGHT


def test_a_flagged_plate_is_endless_while_its_image_is_seen():
    paths, _ = turning_plate(0.05, mirror=True)
    assert shares_of(paths) == pytest.approx(1.0, abs=SHARES_ROUND)
    report = ep.validity(paths)
    assert report.beside_edges_share == report.largest_edge_change == 0.0 and report.ok


def test_the_power_of_a_plate_over_the_frame_is_certified():
    paths, rate = turning_plate(0.03, 0.05)
    times = chirp_times(paths.radar)[[3, 30, 50]]
    power = shares_by_integral(paths, rate, 0.05)[[3, 30, 50]] ** 2
    expected = 10.0 * np.log10(shares_of(paths)[MANY // 2] ** 2 / np.mean(power))
    assert ep.validity(paths, times=times).objects["plate"].error_db == pytest.approx(expected, abs=0.4)


def test_a_plate_that_hardly_turns_is_served_and_keeps_its_weight():
    paths, _ = turning_plate(1e-4)
    assert ep.validity(paths).ok
    for time in (0.0, paths.frame.trace_time):
        renewed = ep.renew(paths, time=time).paths
        assert np.array_equal(renewed.weight, paths.weight) and np.array_equal(renewed.flags, paths.flags)


def test_a_renewed_record_keeps_the_share_that_a_trace_at_its_time_would_have():
    paths, _ = turning_plate(0.05, 0.02)
    short = paths.radar.replace(waveform=paths.radar.waveform.replace(num_chirps=1))
    weights = set()
    for time in np.linspace(0.0, 2.0 * paths.frame.trace_time, 7):
        fresh = ep.trace(paths.scene, short, num_rays=5000, max_bounces=1, polarization="scalar",
                         start_time=time - short.middle_of_frame())
        assert fresh.num_paths == 1
        renewed = ep.renew(paths, time=time).paths
        assert abs(renewed.weight[0] - fresh.weight[0]) < SHARES_ROUND
        assert renewed.flags[0] & 128 == fresh.flags[0] & 128 != 0
        weights.add(complex(renewed.weight[0]))
    assert len(weights) == 7
