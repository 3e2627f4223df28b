"""Replay with points of reflection that move: one Newton step against searches, images and closed forms."""
import numpy as np
import pytest

import echopath as ep
from support import shapes
from support.radars import build_radar
from support.slides import TRANSMITTER, Plane, bisector, excess_by_search, frozen, mirrors_over, stationary_length

WAVENUMBER = 2 * np.pi * shapes.FREQUENCY / ep.speed_of_light   # rad/m
STEP_LIMIT = 1e-3         # rad: what one Newton step may leave where the frozen point errs by less than 1 rad
FORMULA_TOLERANCE = 0.01  # relative: closed forms of the error are of second order in the displacement
DIRECTIONS = {"in": (1.0, 0.0), "across": (0.0, 1.0), "oblique": (0.6, -0.8)}
TWO_DIGITS = 0.02         # relative: of figures printed with two digits
CERTIFICATE = 1e-3        # relative: the certificate takes the error from second derivatives; 5e-5 found
AMPLITUDE_LIMIT = 1e-5    # relative: second order in what the step leaves; 2.5e-6 found
SIGNAL_LIMIT = 1e-4       # relative: what one step leaves of the phase in the mean over the frame; 3e-5 found


def residual(mirrors, slides, at, **keywords):
    """Errors of the phase over frozen points and one Newton step farther, rad."""
    paths = frozen(mirrors, slides, at, **keywords)
    true = stationary_length(mirrors, at) + np.linalg.norm(at - TRANSMITTER)
    return [WAVENUMBER * (paths.lengths([0.0], replay=replay)[0, 0] - true) for replay in ("material", "fermat")]


@pytest.mark.parametrize("direction", DIRECTIONS)
@pytest.mark.parametrize("radius", [np.inf, 0.1, 0.5, 3.0, -60.0, -2.0])
def test_one_step_over_one_mirror_finds_the_point_of_reflection(radius, direction):
    at, top = np.array([16.0, 1.0, 2.5]), np.array([9.0, 3.0, 0.5])
    mirror, = mirrors_over([top], at, [radius])
    probe = 0.005 * np.array(DIRECTIONS[direction])
    slides = [probe * np.sqrt(0.9 / abs(WAVENUMBER * excess_by_search([mirror], [probe], at)))]
    before, after = residual([mirror], slides, at)
    assert 0.8 < abs(before) < 1.0 and abs(after) < STEP_LIMIT


@pytest.mark.parametrize("radii", [(np.inf, np.inf), (2.0, np.inf), (0.7, 1.5), (5.0, -40.0), (0.1, 0.1)])
def test_one_step_over_two_mirrors_finds_both_points(radii):
    """Each moves the other: single steps would leave a good part of the error."""
    at, tops = np.array([17.0, 2.0, 1.0]), [np.array([7.0, 3.0, 0.5]), np.array([12.0, -2.0, 0.0])]
    mirrors = mirrors_over(tops, at, radii)
    probe = 0.005 * np.array([[0.8, 0.6], [-0.3, 0.9]])
    before, after = residual(mirrors, probe * np.sqrt(0.9 / abs(WAVENUMBER * excess_by_search(mirrors, probe, at))), at)
    assert 0.8 < abs(before) < 1.0 and abs(after) < STEP_LIMIT


@pytest.mark.parametrize("before, behind, shift, expected", [(10, 10, 0.02, 0.016), (10, 10, 0.1, 0.40), (1, 10, 0.02, 0.29),
                                                             (1, 10, 0.1, 7.3)])
def test_a_displaced_antenna_moves_the_point_of_reflection(before, behind, shift, expected):
    """Across the plane of incidence the frozen point errs by shift^2 r2/(2 r1 (r1 + r2)), for any incidence."""
    turn = np.array([np.cos(1.0), np.sin(1.0), 0.0])
    top = before * turn
    at = top + behind * turn * [1, -1, 1]
    mirror = Plane(top, (0.0, -1.0, 0.0))
    paths = frozen([mirror], [(0.0, 0.0)], at)
    displaced = np.array([0.0, 0.0, shift])
    true = stationary_length([mirror], at, displaced) + np.linalg.norm(at - TRANSMITTER)
    error = {replay: WAVENUMBER * (paths.lengths([0.0], transmitter=displaced, replay=replay)[0, 0] - true)
             for replay in ("material", "fermat")}
    formula = WAVENUMBER * shift**2 * behind / (2 * before * (before + behind))
    assert formula == pytest.approx(expected, rel=TWO_DIGITS, abs=0)
    assert error["material"] == pytest.approx(formula, rel=FORMULA_TOLERANCE, abs=0)
    assert abs(error["fermat"]) < STEP_LIMIT * max(1.0, formula**2)


def frame_radar(num_chirps=32, chirp_interval=1e-3, receivers=(TRANSMITTER,)):
    return build_radar([TRANSMITTER], receivers, num_samples=512, num_chirps=num_chirps, chirp_interval=chirp_interval)


def moving_target(mirror_flag, replay_slides=(0.0, 0.0)):
    """A path over a wall to a target that moves; the wall a mirror replayed by images or not. The target is at its place at
    mid-frame."""
    radar, velocity = frame_radar(), np.array([14.0, 4.0, 2.0])
    top, at = np.array([9.0, 3.0, 0.5]), np.array([16.0, 1.0, 2.5])
    wall = Plane(top, bisector(top, TRANSMITTER, at))
    start = at - velocity * 0.5 * radar.waveform.num_chirps * radar.waveform.chirp_interval
    motion, material = ep.LinearMotion(velocity=velocity), ep.Material.metal(mirror=mirror_flag)
    return frozen([wall], [replay_slides], start, radar=radar, motion=motion, material=material), radar


def test_a_wall_that_is_no_mirror_replays_like_its_image():
    """Lengths and amplitudes over a frame of a moving target: those of the exact image."""
    radar = frame_radar()
    times = np.linspace(0.0, radar.waveform.num_chirps * radar.waveform.chirp_interval, 9)
    image, wall = moving_target(True)[0], moving_target(False)[0]
    exact = image.lengths(times)[:, 0]
    frozen_error, stepped_error = (np.abs(WAVENUMBER * (wall.lengths(times, replay=replay)[:, 0] - exact))
                                   for replay in ("material", "fermat"))
    assert 0.5 < frozen_error.max() < 1.0 and stepped_error.max() < STEP_LIMIT
    amplitude = image.amplitudes(times)[:, 0]
    change = np.abs(amplitude / amplitude[4] - 1.0).max()
    def amplitude_error(replay):
        return np.abs(wall.amplitudes(times, replay=replay)[:, 0] / amplitude - 1.0).max()
    assert change > 0.02 and amplitude_error("fermat") < AMPLITUDE_LIMIT < amplitude_error("material")


@pytest.mark.parametrize("evaluate", ["interpolated", "chirps"])
def test_signals_over_moved_points_are_those_of_the_image(evaluate):
    (image, radar), (wall, _) = moving_target(True), moving_target(False)
    cube = ep.synthesize(image, radar, evaluate=evaluate)
    errors = {replay: np.linalg.norm(ep.synthesize(wall, radar, replay=replay, evaluate=evaluate) - cube)
              / np.linalg.norm(cube) for replay in ("material", "fermat")}
    assert errors["fermat"] < SIGNAL_LIMIT and errors["material"] > 0.1


def test_the_certificate_tells_what_a_step_leaves():
    paths, radar = moving_target(False)
    times = [0.5 * (radar.waveform.num_samples - 1) / radar.waveform.sampling_rate]
    exact = moving_target(True)[0].lengths(times)[0, 0]
    for replay in ("material", "fermat"):
        report = ep.validity(paths, radar, replay=replay, times=times, arrays=True)
        error = abs(WAVENUMBER * (paths.lengths(times, replay=replay)[0, 0] - exact))
        assert report.phase_error[0] == pytest.approx(error, rel=CERTIFICATE, abs=0) and report.replay == replay
    frozen_report, stepped_report = (ep.validity(paths, radar, replay=replay) for replay in ("material", "fermat"))
    assert 'replay="fermat" leaves' in frozen_report.warnings[0] and stepped_report.ok
    assert frozen_report.stepped_phase_error == stepped_report.largest_phase_error < STEP_LIMIT


def room(radius=0.5, smooth=True):
    rough = ep.Material(permittivity=5 - 0.3j, scattering=0.5)
    scene = ep.Scene()
    scene.add(shapes.rectangle((-2, 3, -2), (16, 0, 0), (0, 0, 6)), name="wall", material=rough)
    scene.add(ep.actors.sphere(radius), name="ball", material=rough, position=(7, 0.5, 1), smooth=smooth,
              motion=ep.LinearMotion(velocity=(-20, 5, 0)))
    return scene


@pytest.mark.filterwarnings("ignore::echopath.TessellationWarning")  # lengths are those of the facets
def test_reversed_paths_move_with_the_receiver():
    """Between antennas apart the way back over the wall is that of the other antenna: images put together here."""
    receiver = np.array([0.0, 0.0, 0.05])
    traced = ep.trace(room(radius=1.5, smooth=False), frame_radar(receivers=[receiver]), num_rays=60000)
    paths = traced.select("T 'ball' 'wall' R")
    paths = paths.select((np.asarray(paths.flags) & 1 == 1) & (paths.diffuse < 2))  # the wall reflects
    times = np.array([0.0, paths.frame.trace_time, 0.02])
    in_wall = receiver * [1, -1, 1] + [0, 6, 0]
    exact = []
    for time in times:
        on_ball = paths.points(time)[paths.offsets]
        exact.append(np.linalg.norm(on_ball - TRANSMITTER, axis=1) + np.linalg.norm(on_ball - in_wall, axis=1))
    error = {replay: np.abs(WAVENUMBER * (paths.lengths(times, replay=replay) - exact))
             for replay in ("material", "fermat")}
    small = error["material"] < 1.0
    assert paths.num_paths > 20 and small.sum() > 20 and error["material"][small].max() > 0.3
    assert error["fermat"][small].max() < STEP_LIMIT


def test_paths_without_such_points_keep_their_bits():
    paths = ep.trace(room(), frame_radar(num_chirps=8), num_rays=3000, max_bounces=1)
    times = [0.0, 0.004]
    assert np.array_equal(paths.lengths(times, replay="fermat"), paths.lengths(times))
    assert np.array_equal(paths.amplitudes(times, replay="fermat"), paths.amplitudes(times))


@pytest.mark.hard
def test_moved_points_have_the_same_bits_for_any_number_of_threads():
    radar = frame_radar(num_chirps=8, receivers=[TRANSMITTER, (0, 0.002, 0)])
    paths = ep.trace(room(), radar, num_rays=3000)
    cubes = []
    try:
        for threads in (1, 2, 5):
            ep.set_num_threads(threads)
            cubes.append(ep.synthesize(paths, radar, replay="fermat"))
    finally:
        ep.set_num_threads(0)
    assert np.array_equal(cubes[0], cubes[1]) and np.array_equal(cubes[0], cubes[2])
    assert not np.array_equal(cubes[0], ep.synthesize(paths, radar))


@pytest.mark.parametrize("call", [lambda p: ep.synthesize(p, replay="exact"), lambda p: p.lengths([0.0], replay="newton"),
                                  lambda p: p.amplitudes([0.0], replay=""), lambda p: ep.validity(p, replay="none")])
def test_unknown_replays_are_named(call):
    paths = ep.trace(room(), frame_radar(num_chirps=2), num_rays=100)
    with pytest.raises(ValueError, match="replay: must be 'material' or 'fermat'"):
        call(paths)
