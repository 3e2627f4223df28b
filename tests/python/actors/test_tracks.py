"""Tracks against motions that are known: crossing points keep their tracks, and their errors are as large as they claim."""
import csv
import dataclasses
import pickle
import warnings

import numpy as np
import pytest
from scipy import special, stats

import echopath as ep
from echopath.tracks.assignment import assigned
from echopath.tracks.kalman import begun
from echopath.tracks.points import Points, carrier_of, points_of
from echopath.tracks.track import _outline_distances, _Tracker
from support.radars import build_radar

STEP, FRAMES = 0.1, 40
TIMES = STEP * np.arange(FRAMES)


def truth_of(positions, names):
    """Truth of boxes of 1 m at positions [F, N, 2] in m."""
    frames, count = positions.shape[:2]
    rows, empty = frames * count, np.zeros
    flat = np.concatenate([positions.reshape(rows, 2), empty((rows, 1))], axis=1)
    columns = {field: empty(rows) for field in ep.Truth.__dataclass_fields__}
    vectors = ("velocity", "angular_velocity", "origin", "velocity_in_radar", "direction_in_radar")
    return ep.Truth(**columns | {name: empty((rows, 3)) for name in vectors} | {
        "position": flat, "position_in_radar": flat, "size": np.ones((rows, 3)), "rotation": np.tile(np.eye(3), (rows, 1, 1)),
        "rotation_in_radar": np.tile(np.eye(3), (rows, 1, 1)),
        "frame": np.repeat(np.arange(frames, dtype=np.int32), count), "time": np.repeat(TIMES[:frames], count),
        "name": np.array(names * frames)})


def noisy(points, generator, range_std, azimuth_std):
    """Points [N, 2] with errors along and across the line of sight."""
    distance = np.hypot(*points.T) + generator.normal(0, range_std, len(points))
    azimuth = np.arctan2(points[:, 1], points[:, 0]) + generator.normal(0, azimuth_std, len(points))
    return np.stack([distance * np.cos(azimuth), distance * np.sin(azimuth)], axis=1)


def crossing():
    """[F, 2, 2] m: two points that cross at 20 m, at right angles and at the same time."""
    there = TIMES - 2.0
    return np.stack([np.stack([20 + 4 * there, 4 * there], axis=1), np.stack([20 + 4 * there, -4 * there], axis=1)], axis=1)


# --- identity ---

@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("merge_distance", [0.0, 1.0])
def test_crossing_points_keep_their_tracks(seed, merge_distance):
    generator, positions = np.random.default_rng(seed), crossing()
    found = [generator.permutation(noisy(points, generator, 0.1, 0.005)) for points in positions]
    tracks = ep.track(found, TIMES, truth=truth_of(positions, ["up", "down"]), range_std=0.1, azimuth_std=0.005,
                      acceleration_std=0.5, merge_distance=merge_distance)
    assert tracks.num_tracks == 2 and tracks.num_switches == 0
    for number in (0, 1):
        one = tracks.of_track(number)
        assert len(one) == FRAMES and one.object[0] == one.object[-1] != ""
        assert one.state[-1, 2:] == pytest.approx([4.0, 4.0 if one.object[0] == "up" else -4.0], abs=0.5)


def test_who_leaves_an_object_and_comes_back_does_not_take_it_from_who_has_followed_it_since():
    """One track begins on a post, goes 4 m aside and comes back to 1.6 m beside it, where another one has been meanwhile."""
    post, away = np.array([10.0, 0.0]), np.interp(np.arange(FRAMES), [5, 15, 18, 24], [0.0, 4.0, 4.0, 1.6])
    found = [[post + [0.0, aside]] + ([post] if frame >= 12 else []) for frame, aside in enumerate(away)]
    tracks = ep.track(found, TIMES, truth=truth_of(np.tile(post, (FRAMES, 1, 1)), ["post"]), merge_distance=0.1,
                      acceleration_std=20.0)
    assert tracks.num_tracks == 2 and tracks.num_switches == 1
    first, second = (tracks.of_track(number) for number in (0, 1))
    assert first.object[0] == "post" and set(second.object) == {"post"} and set(first.object[12:]) == {""}


def test_what_passes_a_rail_is_none_of_its_posts():
    """A rail of 12 m shows as three posts; what passes it 1.8 m aside stays unseen."""
    posts = np.array([[10.0, 0.0], [15.0, 0.0], [20.0, 0.0]])
    positions = np.stack([np.tile([15.0, 0.0], (FRAMES, 1)), np.stack([5.0 + 5.0 * TIMES, np.full(FRAMES, 2.4)], axis=1)], axis=1)
    truth = truth_of(positions, ["rail", "passing"])
    truth.size[truth.name == "rail"] = 12.0, 0.2, 0.8
    tracks = ep.track([posts] * FRAMES, TIMES, truth=truth)
    assert tracks.num_tracks == 3 and set(tracks.object) == {"rail", ""}
    beside = ep.track([points[1:] for points in positions], TIMES, truth=truth)
    assert set(beside.object) == {"passing"}


def test_objects_are_as_far_as_their_outlines_are():
    """From a box of 4 m by 2 m that is turned by 30 degrees: a corner, both kinds of sides, within."""
    own = np.array([[5.0, 5.0], [3.5, 0.3], [-0.7, -2.25], [1.9, 0.9]])
    turn = np.array([[np.cos(np.pi / 6), -np.sin(np.pi / 6)], [np.sin(np.pi / 6), np.cos(np.pi / 6)]])
    found = _outline_distances(own @ turn.T + [7.0, -3.0], np.array([[7.0, -3.0, 1.0]]), np.array([np.pi / 6]),
                               np.array([[4.0, 2.0, 1.5]]))
    assert found[:, 0] == pytest.approx([5.0, 1.5, 1.25, 0.0], abs=1e-9)


@pytest.mark.parametrize("yaw, name", [(0.5 * np.pi, "bus"), (0.0, "")])
def test_tracks_in_the_axes_of_the_radar_take_boxes_as_these_have_them(yaw, name):
    """A bus of 12 m across the line of sight, and one along it, by a point 5 m beside its middle; in the world they look
    elsewhere."""
    truth = truth_of(np.tile([20.0, 0.0], (3, 1, 1)), ["bus"])
    truth = dataclasses.replace(truth, size=np.tile([12.0, 2.5, 3.0], (3, 1)), yaw_in_radar=np.full(3, yaw),
                                yaw=np.full(3, yaw + 0.5 * np.pi))
    found = ep.track([[[20.0, 5.0]]] * 3, TIMES[:3], truth=truth)
    assert found.num_tracks == 1 and set(found.object) == {name}


def test_the_truth_of_other_times_is_refused():
    positions = crossing()
    truth = truth_of(positions, ["up", "down"])
    with pytest.raises(ValueError, match=r"^truth: must be of the times of the detections, got .* s for frame \d+ of .* s$"):
        ep.track(list(positions), TIMES + 5.0, truth=truth, merge_distance=0.0)
    with pytest.raises(ValueError, match=r"^truth: must be of the times .*, got 3.9 s for frame 39 of 4.9 s$"):
        ep.track(list(positions), np.append(TIMES[:-1], TIMES[-1] + 1.0), truth=truth, merge_distance=0.0)
    early = TIMES - 0.4 * np.diff(TIMES).min()  # starts of the frames, whose middles the truth has
    assert set(ep.track(list(positions), early, truth=truth, merge_distance=0.0).object) == {"up", "down"}


def test_a_track_goes_on_through_gaps_and_ends_behind_long_ones():
    points = np.stack([10 + 2 * TIMES, 0 * TIMES], axis=1)[:, None]
    found = [points[number] if number not in (10, 11, 12) else [] for number in range(FRAMES)]
    through = ep.track(found, TIMES, range_std=0.05, azimuth_std=0.005, max_misses=3)
    assert through.num_tracks == 1 and len(through) == FRAMES
    assert np.flatnonzero(~through.is_detected).tolist() == [10, 11, 12]
    assert through.state[:, 0] == pytest.approx(points[:, 0, 0], abs=0.1)
    apart = ep.track(found, TIMES, range_std=0.05, azimuth_std=0.005, max_misses=2)
    assert apart.num_tracks == 2 and [len(apart.of_track(number)) for number in (0, 1)] == [10, 27]


@pytest.mark.parametrize("hits, count", [(3, 1), (2, 0)])
def test_a_track_counts_from_so_many_detections_on(hits, count):
    found = [[[10.0, 0.0]] if frame < hits else np.zeros((0, 2)) for frame in range(6)]
    assert ep.track(found, TIMES[:6], min_hits=3).num_tracks == count


def test_detections_whose_errors_are_large_make_tracks_too():
    """8 m along and 15 m across the line of sight: likelihoods are small numbers then, and go together all the same."""
    found = [[[30.0 + time, 0.0]] for time in TIMES]
    assert ep.track(found, TIMES, range_std=8.0, azimuth_std=0.5).num_tracks == 1


def test_what_is_too_fast_for_any_track_is_told():
    """At 80 m/s nothing was found without a word; a chi-square gate of 99 % is 3 standard errors wide in the plane."""
    times = 0.1 * np.arange(10)
    found = {speed: [[[10.0 + speed * time, 1.0]] for time in times] for speed in (25.0, 80.0)}
    with pytest.warns(RuntimeWarning, match="three times speed_std = 10 m/s in the axes of the radar begins none"):
        assert ep.track(found[80.0], times).num_tracks == 0
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert ep.track(found[25.0], times).num_tracks == ep.track(found[80.0], times, speed_std=40.0).num_tracks == 1
        assert ep.track(found[80.0][:2], times[:2]).num_tracks == 0  # too few for any


def test_false_alarms_make_no_tracks():
    generator = np.random.default_rng(7)
    found = [np.concatenate([[[10 + 2 * time, 0.0]], generator.uniform([30, -30], [90, 30], (1, 2))]) for time in TIMES]
    tracks = ep.track(found, TIMES, range_std=0.05, azimuth_std=0.002, max_misses=1, speed_std=5.0)
    assert tracks.num_tracks == 1
    assert len(ep.track([[]] * 3, [0.0, 1.0, 2.0])) == 0


def test_detections_near_each_other_are_one():
    found = [np.array([[10.0 + t, -0.4], [10.0 + t, 0.4], [10.0 + t, 1.2], [10.0 + t, 5.0]]) for t in TIMES]
    tracks = ep.track(found, TIMES, merge_distance=1.0)
    assert tracks.num_tracks == 2
    assert sorted(tracks.of_track(number).state[-1, 1] for number in (0, 1)) == pytest.approx([0.4, 5.0], abs=1e-6)


# --- errors ---

def test_errors_are_as_large_as_the_covariance_says():
    """NEES of many runs of the very model; bounds: 99.9 % of chi-square / N (Bar-Shalom 2001, section 5.4)."""
    generator, runs, errors = np.random.default_rng(3), 50, []
    settings = {"range_std": 0.15, "azimuth_std": 0.01, "acceleration_std": 20.0, "speed_std": 6.0}
    for _ in range(runs):
        state, states, found = np.array([30.0, -5.0, *generator.normal(0, 6.0, 2)]), [], []
        for _ in range(15):
            states.append(state)
            found.append(noisy(state[None, :2], generator, 0.15, 0.01))
            push = generator.normal(0, 20.0, 2)
            state = np.concatenate([state[:2] + STEP * state[2:] + 0.5 * STEP**2 * push, state[2:] + STEP * push])
        tracks = ep.track(found, TIMES[:15], gate_probability=1 - 1e-9, **settings)
        assert tracks.num_tracks == 1
        error = tracks.state - states
        errors.append(np.einsum("ni,nij,nj->n", error, np.linalg.inv(tracks.covariance), error))
    low, high = special.chdtri(4 * runs, [0.9995, 0.0005]) / runs
    mean = np.mean(errors, axis=0)
    assert np.all(mean[1:] > low) and np.all(mean[1:] < high)


# --- radial velocities ---

def found_at(points, velocities, centre=(0.0, 0.0, 0.0)):
    """Detections at points [N, 2] in m of the radar's axes with radial velocities [N] in m/s."""
    count = len(points)
    columns = {name: np.zeros(count) for name in ("elevation", "noise", "share")} | {
        name: np.zeros(count, np.int32) for name in ("ghost_type", "order", "class_code")} | {
        name: np.zeros(count, bool) for name in ("is_noise", "is_resolved")} | {
        name: np.full(count, "", dtype=str) for name in ("part", "object")}
    return ep.Detections(cells=np.zeros((count, 2), np.int64), velocity=np.asarray(velocities, float), power=np.ones(count),
                         range=np.hypot(*np.transpose(points)), azimuth=np.arctan2(*np.transpose(points)[::-1]), echoes=None,
                         centre=np.array(centre), **columns)


def radar_of(ambiguity: float, speed: float = 0.0):
    """Whose radial velocities are known up to so many m/s."""
    return build_radar(num_samples=16, num_chirps=4, chirp_interval=0.5 * ep.speed_of_light / 77.5e9 / ambiguity, speed=speed)


def meeting(seed: int):
    """[F, 2, 2] m and [F, 2] m/s: two walkers who meet head-on, and the radial velocities of what shows of them."""
    generator, there = np.random.default_rng(seed), TIMES - 2.0
    points = np.stack([np.stack([30 + 1.5 * there, np.full(FRAMES, 0.1)], axis=1),
                       np.stack([30 - 1.5 * there, np.full(FRAMES, -0.1)], axis=1)], axis=1)
    points += generator.normal(0.0, 0.5, points.shape)
    return points, np.array([1.5, -1.5]) + generator.normal(0.0, 0.3, points.shape[:2])


def swaps(found, radar) -> bool:
    """Whether the first track comes back to where it was in place of going on."""
    tracks = ep.track(found, TIMES, radar=radar, range_std=0.5, azimuth_std=0.05, velocity_std=0.3, speed_std=2.0,
                      acceleration_std=4.0, merge_distance=0.0, gate_probability=1.0 - 1e-9)
    assert tracks.num_tracks == 2
    one = tracks.of_track(0)
    return (one.state[0, 0] > 30.0) == (one.state[-1, 0] > 30.0)


@pytest.mark.parametrize("ambiguity, speed", [(60.0, 0.0), (4.0, 0.0), (8.0, 5.0)])
def test_walkers_who_meet_are_told_apart_by_their_radial_velocities(ambiguity, speed):
    """The radar may drive, and velocities beyond what it knows come folded: -6.5 m/s as 1.5 m/s."""
    for seed in range(8):
        positions, velocities = meeting(seed)
        own = positions - np.stack([speed * TIMES, 0.0 * TIMES], axis=1)[:, None]
        folded = (velocities - speed + 0.5 * ambiguity) % ambiguity - 0.5 * ambiguity
        assert not swaps([found_at(points, speeds) for points, speeds in zip(own, folded)], radar_of(ambiguity, speed))


def test_what_starts_off_at_the_place_of_something_that_stands_is_another():
    """Its speed of 15 m/s is 15 standard errors from that of the track, at the very place that the track expects."""
    found = [found_at([[20.0 + 1.5 * max(0, frame - 6), 0.0]], [15.0 if frame >= 6 else 0.0]) for frame in range(12)]
    tracks = ep.track(found, TIMES[:12], radar=radar_of(100.0), velocity_std=1.0)
    assert [tracks.of_track(number).frame[0] for number in range(tracks.num_tracks)] == [0, 6]


def test_without_radial_velocities_walkers_who_meet_are_taken_for_each_other():
    """Else the test before would tell nothing."""
    assert sum(swaps(list(meeting(seed)[0]), None) for seed in range(12)) >= 2


def test_a_speed_that_the_ambiguity_hides_is_taken_from_the_places():
    """15 m/s with an ambiguity of 6 m/s: no fold may be taken for the speed before the places tell it."""
    points = np.stack([10.0 + 15.0 * TIMES, 0.0 * TIMES], axis=1)[:, None]
    found = [found_at(one, [(15.0 + 3.0) % 6.0 - 3.0]) for one in points]
    tracks = ep.track(found, TIMES, radar=radar_of(6.0), range_std=0.1, azimuth_std=0.01, velocity_std=0.2)
    assert tracks.num_tracks == 1 and len(tracks) == FRAMES
    assert tracks.state[-1, 2:] == pytest.approx([15.0, 0.0], abs=0.05)


def seen_points(ambiguity, speed_std=0.5):
    """Two points, the second a little beside where the first leads, with speeds along their lines of sight."""
    sights = np.array([[0.8, 0.6], [0.6, 0.8]])
    covariances = np.array([[[0.04, 0.01], [0.01, 0.09]], [[0.05, -0.02], [-0.02, 0.08]]])
    return Points(np.array([[16.0, 12.0], [16.6, 12.9]]), covariances, np.array([3.0, 4.0]), sights, speed_std, ambiguity)


def test_a_track_begins_with_the_speed_along_its_line_of_sight():
    """Of a prior of 10 m/s and a measurement of 0.5 m/s the mean weighted by their inverse squares; across nothing is known."""
    found = seen_points(np.inf)
    filters = begun(found.some([0]), 10.0)
    along, across = found.sights[0], np.array([-0.6, 0.8])
    assert filters.states[0] == pytest.approx([16.0, 12.0, *(3.0 * 10.0**2 / (10.0**2 + 0.5**2) * along)])
    variances = [way @ filters.covariances[0, 2:, 2:] @ way for way in (along, across)]
    assert variances == pytest.approx([1.0 / (10.0**-2 + 0.5**-2), 10.0**2])


@pytest.mark.parametrize("ambiguity, tells", [(np.inf, True), (12.0, True), (3.0, False)])
def test_costs_are_likelihoods_of_places_and_speeds_together(ambiguity, tells):
    """Gaussians of SciPy: of place and speed where the filter knows that to a quarter of the ambiguity, else of the place alone
    and evenly over the ambiguity of the speed."""
    found = seen_points(ambiguity)
    filters = begun(seen_points(np.inf).some([0]), 2.0).predicted(0.2, 2.0)
    state, covariance = filters.states[0], filters.covariances[0]
    costs = filters.some([0, 0]).fit(found).cost
    for point, speed, sight, noise, cost in zip(found.points, found.speeds, found.sights, found.covariances, costs):
        seen = np.zeros((3, 4))
        seen[:2, :2], seen[2, 2:] = np.eye(2), sight
        spread = seen @ covariance @ seen.T
        spread[:2, :2] += noise
        spread[2, 2] += 0.5**2
        assert (4.0 * np.sqrt(spread[2, 2]) < ambiguity) == tells
        count, values = 3 if tells else 2, np.array([*point, speed])
        density = stats.multivariate_normal((seen @ state)[:count], spread[:count, :count]).pdf(values[:count])
        expected = -2.0 * np.log(density if tells else density / ambiguity)
        assert cost + 3.0 * np.log(2.0 * np.pi) == pytest.approx(expected)


def test_points_of_detections_have_the_errors_of_their_line_of_sight_and_the_speed_of_the_strongest():
    """In the world, for a radar that looks 0.7 rad to the left: two that are 0.5 m apart are one, in their mean by power."""
    radar = radar_of(50.0).replace(position=(1, 2, 0), yaw=0.7)
    found = found_at([[20.0, 5.0], [20.3, 5.4], [10.0, -9.0]], [1.0, 2.0, 3.0])
    found = dataclasses.replace(found, power=np.array([1.0, 3.0, 1.0]))
    points = points_of(found, carrier_of(radar, 0.0), 0.3, 0.01, 0.5, 1.0)
    axes = np.array([[np.cos(0.7), -np.sin(0.7)], [np.sin(0.7), np.cos(0.7)]])
    expected = [[1, 2] + axes @ own for own in ([20.225, 5.3], [10.0, -9.0])]
    assert points.points == pytest.approx(np.array(expected)) and points.speeds.tolist() == [2.0, 3.0]
    for covariance, point in zip(points.covariances, expected):
        way = point - [1, 2]
        along = way / np.linalg.norm(way)
        across = np.array([-along[1], along[0]])
        assert covariance == pytest.approx(0.3**2 * np.outer(along, along) + 0.01**2 * (way @ way) * np.outer(across, across))


@pytest.mark.parametrize("pitch", [-0.5 * np.pi, -0.6])
def test_a_radar_that_looks_down_knows_places_to_the_errors_of_its_elevations(pitch):
    """The covariance of drawn errors, along the line of sight and in both directions across it, carried into the world."""
    radar, generator = radar_of(50.0).replace(position=(1, 2, 3), yaw=0.4, pitch=pitch), np.random.default_rng(1)
    own = 2.5, 0.6, -0.9
    axes = np.linalg.svd(np.array([own]))[2]
    errors = generator.normal(size=(100_000, 3)) * [0.1, *np.full(2, 0.05 * np.linalg.norm(own))] @ axes
    expected = np.cov((errors @ radar.world_from_radar(0.0)[:3, :3].T)[:, :2].T)
    tracks = ep.track([[own]], [0.0], radar=radar, range_std=0.1, azimuth_std=0.05, min_hits=1)
    assert tracks.covariance[0, :2, :2] == pytest.approx(expected, rel=0.05, abs=2e-4)


def test_who_walks_below_a_radar_that_looks_down_is_one_track():
    """Along the world's x, which only elevations tell, at 1 m/s and 2 m below; the errors are those that are told."""
    radar, generator = radar_of(50.0).replace(position=(0, 0, 3), pitch=-0.5 * np.pi), np.random.default_rng(2)
    own = np.stack([np.full(FRAMES, 2.0), np.full(FRAMES, 0.3), TIMES - 2.0], axis=1) + generator.normal(0.0, 0.1, (FRAMES, 3))
    tracks = ep.track(own[:, None], TIMES, radar=radar, range_std=0.1, azimuth_std=0.04)
    assert tracks.num_tracks == 1 and tracks.is_detected.mean() > 0.9
    assert tracks.state[-1] == pytest.approx([TIMES[-1] - 2.0, 0.3, 1.0, 0.0], abs=0.4)


@pytest.mark.parametrize("probability", [0.5, 0.9, 0.99])
def test_gates_hold_the_share_of_chi_square_that_is_asked_for(probability):
    """Of squared distances of two coordinates, and of one speed: SciPy's quantiles."""
    tracker = _Tracker(2.0, 10.0, probability, 3, 3)
    assert tracker._gate == pytest.approx(stats.chi2.ppf(probability, 2))
    assert tracker._gate_of_speed == pytest.approx(stats.chi2.ppf(probability, 1))


def test_frames_of_one_chirp_tell_no_speeds():
    """The map of a chirp has 0 m/s alone, where an echo comes nearer by 10 m/s."""
    radar = radar_of(50.0)
    radar = radar.replace(waveform=radar.waveform.replace(num_chirps=1))
    found = [found_at([[60.0 - 10.0 * time, 0.0]], [0.0]) for time in TIMES]
    tracks = ep.track(found, TIMES, radar=radar)
    assert tracks.num_tracks == 1 and len(tracks) == FRAMES
    assert tracks.state[-1, 2:] == pytest.approx([-10.0, 0.0], abs=0.1)


def test_what_stands_stands_for_antennas_ahead_of_the_axle_that_turns():
    """Antennas that go around at 0.5 rad/s, 4 m from the axis, move at 2 m/s sideways: the closed form of a circle."""
    turning, centre, post = 0.5, np.array([4.0, 0.0]), np.array([20.0, 15.0])
    radar = radar_of(100.0).replace(transmitters=[ep.Antenna((4, 0, 0))], receivers=[ep.Antenna((4, 0, 0))], speed=None,
                                    motion=ep.LinearMotion(angular_velocity=(0.0, 0.0, turning)))
    angles = turning * TIMES
    ahead, left = (np.stack([np.cos(angle), np.sin(angle)], axis=1) for angle in (angles, angles + 0.5 * np.pi))
    way = post - centre[0] * ahead
    speeds = -np.sum(way * left, axis=1) / np.linalg.norm(way, axis=1) * turning * centre[0]
    own = np.stack([np.sum(way * ahead, axis=1), np.sum(way * left, axis=1)], axis=1)
    found = [found_at([point], [speed], (*centre, 0.0)) for point, speed in zip(own, speeds)]
    tracks = ep.track(found, TIMES, radar=radar, velocity_std=0.05)
    assert tracks.num_tracks == 1
    assert np.abs(tracks.state[:, 2:]).max() < 0.05
    np.testing.assert_allclose(tracks.state[:, :2] - post, 0.0, atol=0.05)


# --- assignment ---

def test_pairs_beyond_the_limit_are_left_alone():
    cost = np.array([[1.0, 9.0], [2.0, np.inf]])
    assert assigned(cost, 5.0) == [(0, 0)] and assigned(cost, 10.0) == [(0, 1), (1, 0)]
    assert assigned(np.zeros((0, 3)), 1.0) == [] == assigned(np.zeros((3, 0)), 1.0)


def test_gated_pairs_are_assigned_at_the_least_sum():
    """Against all ways to leave rows alone or give them a column, one after the other."""
    def least(cost, limit, row=0, taken=frozenset()):
        if row == len(cost):
            return 0.0
        free = [(price, column) for column, price in enumerate(cost[row]) if column not in taken and price <= limit]
        return min([limit + least(cost, limit, row + 1, taken)]
                   + [price + least(cost, limit, row + 1, taken | {column}) for price, column in free])

    generator = np.random.default_rng(2)
    for rows, columns in [(1, 4), (4, 1), (5, 5), (6, 4), (4, 6)] * 20:
        cost = np.where(generator.random((rows, columns)) < 0.3, generator.uniform(-3.0, 6.0, (rows, columns)), np.inf)
        pairs = assigned(cost, 4.0)
        taken = [row for row, _ in pairs], [column for _, column in pairs]
        assert all(len(set(places)) == len(places) for places in taken)
        assert cost[taken].sum() + 4.0 * (rows - len(pairs)) == pytest.approx(least(cost, 4.0), abs=1e-9)


# --- of a simulated scene ---

@pytest.fixture(scope="module")
def frames():
    """Two balls that pass each other, before an array that drives towards them."""
    scene = ep.Scene()
    for name, place, speed in (("left", (16, 4, 0), -6.0), ("right", (18, -4, 0), 5.0)):
        scene.add(ep.actors.sphere(0.3), name=name, material="metal", position=place, smooth=True,
                  motion=ep.LinearMotion(velocity=(0, speed, 0)))
    wavelength = ep.speed_of_light / 77e9
    radar = build_radar(receivers=tuple((0, 0.5 * wavelength * n, 0) for n in range(12)), num_samples=128, num_chirps=32,
                        bandwidth=0.5e9, transmit_power=10.0, speed=5.0)
    return [ep.simulate(scene, radar, num_rays=800, start_time=0.1 * number, guard=False, detections=True)
            for number in range(13)]


def test_detected_balls_are_tracked_in_the_world(frames):
    truth, radar = ep.truth(frames), frames[0].radar
    times = truth.of_object("left").time
    tracks = ep.track([frame.detections for frame in frames], times, truth=truth, radar=radar, range_std=0.3, azimuth_std=0.02)
    following = {name: tracks.object == name for name in ("left", "right")}
    for name, speed in (("left", -6.0), ("right", 5.0)):
        rows = following[name]
        assert len(np.unique(tracks.track[rows])) == 1 and rows.sum() >= 11
        place = truth.of_object(name).position[tracks.frame[rows], :2]
        assert np.abs(tracks.state[rows, :2] - place).max() < 1.0
        assert tracks.state[rows][-1, 2:] == pytest.approx([0.0, speed], abs=1.0)
    assert tracks.num_switches == 0


# --- as values ---

def test_tracks_travel_and_are_drawn(tmp_path):
    import matplotlib

    matplotlib.use("agg")
    from matplotlib import pyplot

    positions = crossing()
    tracks = ep.track(list(positions), TIMES, truth=truth_of(positions, ["up", "down"]), merge_distance=0.0)
    assert pickle.loads(pickle.dumps(tracks)) == tracks and "2 tracks" in repr(tracks)
    tracks.to_csv(tmp_path / "tracks.csv")
    rows = list(csv.DictReader((tmp_path / "tracks.csv").open(encoding="utf-8")))
    assert len(rows) == 2 * FRAMES and float(rows[5]["x_m"]) == tracks.state[5, 0] and rows[0]["object"] in ("up", "down")
    ax = tracks.plot(title="Mine")
    assert ax.get_title() == "Mine" and len(ax.get_legend().get_texts()) == 2
    pyplot.close(ax.figure)
    with pytest.raises(KeyError, match="number: must be that of one of 2 tracks, got 7"):
        tracks.of_track(7)
    with pytest.raises(TypeError, match="^number: must be a whole number"):
        tracks.of_track(np.array([0, 1]))


def test_the_picture_says_what_its_crosses_are():
    from matplotlib import pyplot

    whole = list(crossing())
    gap = [points if frame != 5 else points[:1] for frame, points in enumerate(whole)]
    for positions, expected in ((whole, []), (gap, ["without a detection"])):
        ax = ep.track(positions, TIMES, merge_distance=0.0).plot()
        assert [text.get_text() for text in ax.get_legend().get_texts()][2:] == expected
        pyplot.close(ax.figure)


def test_tracks_become_a_table():
    pytest.importorskip("pandas")
    table = ep.track(list(crossing()), TIMES).to_dataframe()
    assert list(table.columns) == ["track", "frame", "time", "x", "y", "vx", "vy", "is_detected", "object"]
    assert table.attrs["units"]["vx"] == "m/s"


@pytest.mark.parametrize("arguments, told", [
    ({"times": [0.0]}, "times: must have one for each of the 2 frames of detections, got 1"),
    ({"times": [1.0, 1.0]}, "times: must ascend, with all points of one time in one frame, got 1 after 1"),
    ({"detections": [np.zeros((1, 4)), []]}, "detections: must be an array"), ({"range_std": 0.0}, "range_std: must be"),
    ({"truth": 3}, "truth: must be a Truth")])
def test_wrong_arguments_are_named(arguments, told):
    with pytest.raises((ValueError, TypeError), match=told):
        ep.track(**{"detections": [np.zeros((1, 2)), []], "times": [0.0, 1.0]} | arguments)
