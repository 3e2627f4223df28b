"""The certificate of a replay: phase errors against searches of the true point, and a warning for each way to fail."""
from importlib.resources import as_file

import numpy as np
import pytest

import echopath as ep
from echopath.base.storage.data_folder import data_folder
from support import shapes
from support.radars import build_radar
from support.slides import ROUGH, TRANSMITTER, Ball, Plane, excess_by_search, frozen, mirrors_over
from support.validity_scenes import BALL, radar_of, scene_of

WAVENUMBER = 2 * np.pi * shapes.FREQUENCY / ep.speed_of_light   # rad/m
MIRROR = np.array([10.0, 3.0, 0.0])                             # middle of transmitter and target, 3 m aside
NOTE_TOLERANCE = 0.012       # relative: the formulas of the note are second order in the slide and have two or three digits
EXCESS_TOLERANCE = 0.01      # relative, up to 1 rad: e = g H^-1 g / 2 is second order in the slide
SUMS = 1e-6             # relative: sums in single precision
FEW = 0.02              # of the paths: horizons of the ball itself


def phase_error(paths):
    return float(ep.validity(paths, arrays=True).phase_error[0])


WALL = (0.0, -1.0, 0.0)


@pytest.mark.parametrize("slide, expected", [(0.05, 0.032), (0.1, 0.128), (0.3, 1.149), (0.6, 4.59)])
def test_a_point_on_a_wall_has_the_phase_error_of_the_note(slide, expected):
    mirror = Plane(MIRROR, WALL)
    along = mirror.axes @ [slide, 0.0, 0.0]
    assert phase_error(frozen([mirror], [along])) == pytest.approx(expected, rel=NOTE_TOLERANCE, abs=0)


@pytest.mark.parametrize("radius, slide, expected", [(0.1, 0.005, 0.116), (0.1, 0.02, 1.85), (2.0, 0.02, 0.098),
                                                     (2.0, 0.05, 0.61)])
def test_a_point_on_a_column_has_the_phase_error_of_the_note(radius, slide, expected):
    mirror = Ball(MIRROR, WALL, radius)
    along = mirror.axes @ [slide, 0.0, 0.0]
    next_order = (slide / radius) ** 2  # of the note's formula
    assert phase_error(frozen([mirror], [along])) == pytest.approx(expected, rel=max(NOTE_TOLERANCE, next_order))


DIRECTIONS = {"in": (1.0, 0.0), "across": (0.0, 1.0), "oblique": (0.6, -0.8)}


@pytest.mark.parametrize("direction", DIRECTIONS)
@pytest.mark.parametrize("radius", [np.inf, 0.5, 3.0, -60.0, -2.0])
def test_phase_error_of_one_slide_is_that_of_a_search(radius, direction):
    """Plane, convex, weakly and strongly hollow (the length is largest at the true point); seen at an angle."""
    at, top = np.array([16.0, 1.0, 2.5]), np.array([9.0, 3.0, 0.5])
    mirror, = mirrors_over([top], at, [radius])
    incidence = mirror.axes @ (at - TRANSMITTER)
    turn = np.array([[incidence[0], -incidence[1]], [incidence[1], incidence[0]]]) / np.linalg.norm(incidence)
    probe = 0.01 * turn @ DIRECTIONS[direction]
    slides = [probe * np.sqrt(0.5 / abs(WAVENUMBER * excess_by_search([mirror], [probe], at)))]  # to about half a radian
    expected = WAVENUMBER * abs(excess_by_search([mirror], slides, at))
    assert 0.4 < expected < 0.6
    assert phase_error(frozen([mirror], slides, at)) == pytest.approx(expected, rel=EXCESS_TOLERANCE, abs=0)


@pytest.mark.parametrize("radii", [(np.inf, np.inf), (2.0, np.inf), (0.7, 1.5), (5.0, -40.0)])
def test_phase_error_of_two_slides_is_that_of_a_search(radii):
    """Both points move each other: the sum over the single slides would be wrong."""
    at, tops = np.array([17.0, 2.0, 1.0]), [np.array([7.0, 3.0, 0.5]), np.array([12.0, -2.0, 0.0])]
    mirrors = mirrors_over(tops, at, radii)
    slides = [0.02 * np.array([0.8, 0.6]), 0.015 * np.array([-0.3, 0.9])]
    expected = WAVENUMBER * abs(excess_by_search(mirrors, slides, at))
    assert 0.001 < expected < 1.0
    assert phase_error(frozen(mirrors, slides, at)) == pytest.approx(expected, rel=EXCESS_TOLERANCE, abs=0)


# --- a warning for each way in which one trace fails ---


def moving(velocity=(0, 0, 0), turning=(0, 0, 0)):
    return ep.LinearMotion(velocity=velocity, angular_velocity=turning)


def report_of(scene, radar, select=".+", num_rays=20000, **keywords):
    paths = ep.trace(scene, radar, num_rays=num_rays, **keywords)
    return ep.validity(paths.select(f"T {select} R"), radar)


def only_warning(report):
    assert len(report.warnings) == 1, str(report)
    assert not report.ok and "does not serve" in str(report)
    return report.warnings[0]


def test_one_trace_serves_what_stands_still():
    plate = shapes.plate((0, 0, 0), (-1, 0, 0), 2)
    scene = scene_of(ball=(BALL, ROUGH, (6, 0, 1), None), wall=(plate, shapes.METAL, (8, 0, 1), None))
    report = report_of(scene, radar_of())
    assert report.ok and "one trace serves this frame" in str(report)
    assert report.shares.power > 0 and report.keyframes == 1
    for share in ("slid", "left", "blocked", "turned", "new_surface"):
        assert getattr(report.shares, share) == 0, share


def test_one_trace_serves_the_street():
    with as_file(data_folder("scenes") / "street.toml") as path:
        street = ep.load_scene(path)
    paths = ep.trace(street.scene, street.radar, settings=street.trace, num_rays=8000, max_bounces=2)
    report = ep.validity(paths, street.radar)
    assert report.ok, str(report)
    assert 0 < report.objects["pedestrian"].blocked < 0.05  # the limbs of a walker do come in each other's way


def test_something_that_comes_in_the_way_is_a_warning():
    scene = scene_of(ball=(BALL, ROUGH, (10, 0, 1), None),
                     screen=(shapes.plate((0, 0, 0), (-1, 0, 0), 0.6), ROUGH, (5, 0.42, 1), moving(velocity=(0, -40, 0))))
    report = report_of(scene, radar_of(), "'ball'")
    assert report.occluded_share > 0.01 and any("in the way" in text for text in report.warnings)


def test_surface_behind_a_leaving_screen_is_a_warning():
    scene = scene_of(ball=(shapes.sphere((0, 0, 0), 1.0, 4), ROUGH, (10, 0, 1), None),
                     screen=(shapes.plate((0, 0, 0), (-1, 0, 0), 0.6), ROUGH, (5, 0, 1), moving(velocity=(0, -40, 0))))
    report = report_of(scene, radar_of())
    assert report.new_surface_share > 0.01 and any("hidden from the trace" in text for text in report.warnings)


def test_a_turning_side_that_comes_into_view_is_a_warning():
    """A box turns by +-14 degrees: at mid-frame the radar sees its front alone."""
    faces = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4],
             [1, 5, 7], [1, 7, 3]]
    box = ep.Mesh([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], faces)
    start = ep.KeyframeMotion(times=[0, 0.1], rotations=[[np.cos(a / 2), 0, 0, np.sin(a / 2)] for a in (-0.25, 0.25)])
    scene = scene_of(car=(box, ROUGH, (30, 0, 1), start))
    report = report_of(scene, radar_of(num_chirps=100, chirp_interval=1e-3))
    assert any("hidden from the trace" in text for text in report.warnings), str(report)


def test_a_surface_that_turns_edge_on_is_a_warning():
    turn = ep.KeyframeMotion(times=[0, 0.1], rotations=[[np.cos(a / 2), 0, 0, np.sin(a / 2)] for a in (1.2, 1.55)])
    scene = scene_of(plate=(shapes.plate((0, 0, 0), (-1, 0, 0), 1.0), ROUGH, (10, 0, 1), turn))
    assert "turn" in only_warning(report_of(scene, radar_of(num_chirps=100, chirp_interval=1e-3)))


def test_cosines_change_as_a_plate_turns():
    """A small plate far away turns from 0.5 to 0.9 rad: from 0.7 rad at mid-frame, the cosine changes by cos 0.7 - cos 0.9 at
    most."""
    turn = ep.KeyframeMotion(times=[0, 0.1], rotations=[[np.cos(a / 2), 0, 0, np.sin(a / 2)] for a in (0.5, 0.9)])
    scene = scene_of(plate=(shapes.plate((0, 0, 0), (-1, 0, 0), 0.1), ROUGH, (20, 0, 1), turn))
    radar = radar_of(num_chirps=100, chirp_interval=1e-3)
    report = ep.validity(ep.trace(scene, radar, num_rays=2000).select("T 'plate' R"), radar, arrays=True)
    changes = report.cosine_change
    assert report.largest_cosine_change == pytest.approx(np.cos(0.7) - np.cos(0.9), rel=0.03)  # instants within the frame
    assert len(changes) and changes.max() == pytest.approx(report.largest_cosine_change, rel=SUMS)


@pytest.mark.parametrize("angle, is_turned", [(0.74, True), (0.78, False), (1.37, False), (1.41, True)])
def test_a_surface_has_turned_where_its_cosine_is_twice_or_half_what_it_was(angle, is_turned):
    """A small plate far away, whose normal is 1.2 rad off the line of sight at the trace and then as far as `angle`."""
    radar = radar_of(num_chirps=1)
    mesh = shapes.plate((0, 0, 0), (-np.cos(1.2), -np.sin(1.2), 0), 0.1)
    scene = scene_of(plate=(mesh, ROUGH, (20, 0, 1), moving(turning=(0, 0, 100))))
    paths = ep.trace(scene, radar, num_rays=2000).select("T 'plate' R")
    report = ep.validity(paths, radar, times=[(angle - 1.2) / 100], arrays=True)
    assert paths.num_paths and np.all(report.turned == is_turned)


def test_a_point_of_reflection_that_leaves_its_mirror_is_a_warning():
    """The point moves along the mirror at half the target's speed and reaches its end."""
    mirror = shapes.rectangle((9, 3, -1), (2, 0, 0), (0, 0, 2))
    scene = scene_of(mirror=(mirror, shapes.METAL, (0, 0, 1), None),
                     ball=(BALL, ROUGH, (21.8, 0, 1), moving(velocity=(30, 0, 0))))
    report = report_of(scene, radar_of(num_chirps=100, chirp_interval=1e-3), "'mirror' 'ball'")
    assert report.left_share > 0.01 and any("leave the surface" in text for text in report.warnings)


@pytest.mark.filterwarnings("ignore::echopath.TessellationWarning")  # facets are meant
def test_a_point_of_reflection_that_crosses_a_crease_is_a_warning():
    """A column of flat facets: the point goes over their edges."""
    turn = np.linspace(0, 2 * np.pi, 37)[:-1]
    rim = 0.5 * np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1)
    vertices = np.concatenate([rim + [0, 0, -2], rim + [0, 0, 2]])
    k, after = np.arange(36), (np.arange(36) + 1) % 36
    faces = np.concatenate([np.stack([k, after, k + 36], axis=1), np.stack([after, after + 36, k + 36], axis=1)])
    scene = scene_of(column=(ep.Mesh(vertices, faces), shapes.METAL, (8, 2, 1), None),
                     screen=(shapes.plate((0, 0, 0), (-1, 0, 0), 3.0), ROUGH, (12, -2, 1), moving(velocity=(0, 30, 0))))
    report = report_of(scene, radar_of(num_chirps=100, chirp_interval=1e-3), "'column' 'screen'", num_rays=60000)
    assert any("leave the surface" in text for text in report.warnings), str(report)


def near_mirror():
    return scene_of(bumper=(shapes.plate((0, 0, 0), (-1, 1, 0), 1.0), shapes.METAL, (0.8, 0, 1), None),
                    ball=(BALL, ROUGH, (0.8, 12, 1), None))


def test_a_near_mirror_and_a_wide_array_are_a_warning():
    """A mirror 0.8 m away: an aperture of 4 mm is harmless, 20 cm are not."""
    wide, narrow = (radar_of(transmitters=[(0, -a, 1), (0, a, 1)]) for a in (0.1, 0.002))
    report = report_of(near_mirror(), wide, "'bumper' 'ball'")
    assert "too wide for one trace" in only_warning(report)
    assert report.motion_phase_error < 0.01 < 0.3 < report.largest_phase_error and report.keyframes == 1
    assert report_of(near_mirror(), narrow, "'bumper' 'ball'").ok


def test_a_long_frame_at_speed_along_a_wall_is_a_warning():
    """30 m/s past a wall 3 m aside: 60 ms are too long for one trace, 4 ms are not. As many parts as it asks for will do."""
    wall = shapes.rectangle((-10, 3, -3), (80, 0, 0), (0, 0, 8))
    scene = scene_of(wall=(wall, shapes.METAL, (0, 0, 0), None), ball=(BALL, ROUGH, (20, 0, 1), None))
    def report(chirps, start_time=0.0):
        radar = radar_of(num_chirps=chirps, chirp_interval=60e-6, motion=moving(velocity=(30, 0, 0)))
        paths = ep.trace(scene, radar, num_rays=20000, start_time=start_time)
        return ep.validity(paths.select("T 'wall' 'ball' R"), radar)
    long = report(1000)
    assert "points of reflection slide" in only_warning(long) and long.keyframes > 1
    assert report(1000 // long.keyframes).largest_phase_error < 0.3
    assert report(64).ok


# --- the report ---

def test_phase_error_share_and_mean_are_those_of_the_arrays():
    wall = shapes.rectangle((-10, 3, -3), (80, 0, 0), (0, 0, 8))
    scene = scene_of(wall=(wall, shapes.METAL, (0, 0, 0), None), ball=(BALL, ROUGH, (20, 0, 1), None))
    radar = radar_of(num_chirps=1000, chirp_interval=60e-6, motion=moving(velocity=(30, 0, 0)))
    paths = ep.trace(scene, radar, num_rays=20000).select("T 'wall' 'ball' R")
    report = ep.validity(paths, radar, arrays=True)
    power, phase = report.power, report.phase_error.astype(float)
    assert report.shares.power == pytest.approx(power.sum())
    assert report.phase_error_share == pytest.approx(power[phase > 0.3].sum() / power.sum())
    assert report.rms_phase_error == pytest.approx(np.sqrt(np.sum(power * phase**2) / power.sum()), rel=SUMS, abs=0)
    assert report.largest_phase_error == pytest.approx(phase.max(), rel=SUMS, abs=0)


def test_arrays_name_the_leg_that_is_blocked():
    """A screen comes between ball and radar: it blocks one leg of the ghosts over the wall, by their order which."""
    wall = shapes.rectangle((0, 4, -2), (14, 0, 0), (0, 0, 6))
    scene = scene_of(wall=(wall, shapes.METAL.replace(mirror=True), (0, 0, 0), None), ball=(BALL, ROUGH, (10, 0, 1), None),
                     screen=(shapes.plate((0, 0, 0), (-1, 0, 0), 1.5), ROUGH, (4, -1.5, 1), moving(velocity=(0, 400, 0))))
    paths = ep.trace(scene, radar_of(num_chirps=1), num_rays=20000)
    end = paths.frame.trace_time + 1.5 / 400  # the screen stands right between
    for select, blocked, receiver in (("'wall' 'ball'", 0, 1), ("'ball' 'wall'", 1, 0), ("'ball'", 1, 1),
                                      ("'wall' 'ball' 'wall'", 0, 0)):
        some = paths.select(f"T {select} R")
        report = ep.validity(some, times=[end], arrays=True)
        assert some.num_paths > 20, select
        assert np.all(report.blocked == blocked) and np.all(report.receiver_blocked == receiver), select
        assert not report.left.any(), select


@pytest.mark.parametrize("before_mirror, findings", [
    (True, {"'wall' 'ball'": (1, 0), "'ball' 'wall'": (0, 1), "'wall' 'ball' 'wall'": (1, 1)}),
    (False, {"'wall' 'ball'": (2, 0), "'ball' 'wall'": (2, 0), "'wall' 'ball' 'wall'": (2 + 4, 0)})])
def test_arrays_name_the_leg_to_or_from_a_mirror_that_is_blocked(before_mirror, findings):
    """A screen comes down between the radar and the wall, or between the wall and the ball, beside the straight way."""
    wall = shapes.rectangle((0, 4, -2), (14, 0, 0), (0, 0, 6))
    at = np.array((2.5 if before_mirror else 7.5, 2.0, 1.0))
    scene = scene_of(wall=(wall, shapes.METAL.replace(mirror=True), (0, 0, 0), None), ball=(BALL, ROUGH, (10, 0, 1), None),
                     screen=(shapes.plate((0, 0, 0), (-1, 0, 0), 1.5), ROUGH, at + (0, 0, 3), moving(velocity=(0, 0, -400))))
    paths = ep.trace(scene, radar_of(num_chirps=1), num_rays=20000)
    end = paths.frame.trace_time + 3 / 400  # the screen stands right in the way
    for select, (blocked, receiver) in {"'ball'": (0, 0), **findings}.items():
        some = paths.select(f"T {select} R")
        report = ep.validity(some, times=[end], arrays=True)
        assert some.num_paths > 20, select
        assert np.all(report.blocked == blocked) and np.all(report.receiver_blocked == receiver), select
        assert not report.left.any(), select


@pytest.mark.parametrize("ends", ["transmitters", "receivers"])
def test_one_antenna_elsewhere_than_that_of_the_trace_is_looked_from(ends):
    """A screen stands between the ball and a place beside the radar, from where the record is to be replayed."""
    scene = scene_of(ball=(BALL, ROUGH, (10, 0, 1), None),
                     screen=(shapes.plate((0, 0, 0), (-1, 0, 0), 1.5), ROUGH, (4, 1.8, 1), None))
    radar = radar_of(num_chirps=1)
    paths = ep.trace(scene, radar, num_rays=20000).select("T 'ball' R")
    beside = ep.validity(paths, radar.replace(**{ends: [ep.Antenna((0, 3, 1))]}), arrays=True)
    assert np.all((beside.blocked if ends == "transmitters" else beside.receiver_blocked) == 1)
    assert not np.any(beside.receiver_blocked if ends == "transmitters" else beside.blocked)
    assert ep.validity(paths, radar).ok


def test_what_is_found_of_a_path_does_not_depend_on_those_beside_it():
    """Legs are shared by the paths over all pairs of mirror chains to a hit: here, paths of different hits are asked, and a
    single one."""
    rough, tall = ep.Material(reflectivity=0.5, scattering=0.6), shapes.rectangle((0, 4, -2), (14, 0, 0), (0, 0, 6))
    floor = shapes.rectangle((0, -4, 0), (14, 0, 0), (0, 8, 0))
    scene = scene_of(wall=(tall, rough.replace(mirror=True), (0, 0, 0), None),
                     floor=(floor, rough.replace(mirror=True), (0, 0, 0), None),
                     ball=(BALL, rough, (10, 0, 1), moving(velocity=(0, 30, 0))),
                     block=(ep.actors.box((1, 1, 1)), rough, (9, 1.6, 1), None),
                     screen=(shapes.plate((0, 0, 0), (-1, 0, 0), 1.5), ROUGH, (4, -1.5, 1), moving(velocity=(0, 400, 0))))
    apart = ep.Radar(radar_of(num_chirps=1).waveform, transmitters=[ep.Antenna((0, 0, 1))],
                     receivers=[ep.Antenna((0, -2, 1))])
    paths = ep.trace(scene, apart, num_rays=3000)
    times = [paths.frame.trace_time + lateness for lateness in (0.5 / 400, 1.5 / 400)]
    kinds = ("blocked", "receiver_blocked", "left")
    together = ep.validity(paths, times=times, arrays=True)
    findings = np.stack([*(getattr(together, kind) for kind in kinds), paths.num_bounces, paths.diffuse == 0,
                         paths.flags & 1])
    last_of_kind = sorted({tuple(column): path for path, column in enumerate(findings.T)}.values())
    points = points_of_paths(paths)
    distinct = sorted({points[path]: path for path in reversed(last_of_kind)}.values())
    assert len(last_of_kind) > 40 and len(distinct) > 20
    for chosen in (distinct, last_of_kind[len(last_of_kind) // 2:][:1]):
        some = ep.validity(paths.select(np.isin(np.arange(paths.num_paths), chosen)), times=times, arrays=True)
        for kind in kinds:
            assert np.array_equal(getattr(some, kind), getattr(together, kind)[chosen]), (kind, chosen)


def points_of_paths(paths) -> list[frozenset]:
    """The material points of each path, whichever way it goes over the mirrors: (mesh, triangle, u, v) off the mirrors."""
    mirrors = [mesh.id for mesh in paths.scene.meshes if mesh.material.mirror]
    points = [tuple(row) for row in paths.hits.tolist()]
    return [frozenset(point for point in points[first:first + count] if point[0] not in mirrors)
            for first, count in zip(paths.offsets.tolist(), paths.num_bounces.tolist())]


def test_arrays_name_the_mirror_that_a_point_has_left():
    wall = shapes.rectangle((4, 4, -2), (3, 0, 0), (0, 0, 6))
    scene = scene_of(wall=(wall, shapes.METAL.replace(mirror=True), (0, 0, 0), None),
                     ball=(BALL, ROUGH, (10, 0, 1), moving(velocity=(1000, 0, 0))))
    paths = ep.trace(scene, radar_of(num_chirps=1), num_rays=20000)
    for select, left in (("'wall' 'ball'", 1), ("'ball' 'wall'", 2), ("'wall' 'ball' 'wall'", 5), ("'ball'", 0)):
        report = ep.validity(paths.select(f"T {select} R"), times=[paths.frame.trace_time + 0.01], arrays=True)
        hidden = (report.blocked != 0) | (report.receiver_blocked != 0)  # a few, by the ball's own horizon
        assert report.num_paths > 20 and np.mean(hidden) < FEW and np.all(report.left[~hidden] == left), select


def corner_of(angle):
    """Two flagged walls of 4 m that meet at an upright edge 5 m ahead at an angle in rad, and stand square to the ground."""
    mirror, still = shapes.METAL.replace(mirror=True), (0, 0, 0)
    half = 0.5 * angle
    walls = {name: (shapes.rectangle((5, 0, -2), (-4 * np.cos(half), sign * 4 * np.sin(half), 0), (0, 0, 4)), mirror, still, None)
             for name, sign in (("left", 1), ("right", -1))}
    return scene_of(**walls)


def test_in_a_square_corner_waves_take_both_walls_in_either_order():
    """Transmitters stand to either side of the receiver, so that the wave to one of them meets the other wall first. The image
    over both walls is one: each channel, traced by itself, has the signal that it has in the array."""
    array = build_radar([(0, -0.01, 0), (0, 0.013, 0)], [(0, 0, 0)], num_samples=256)
    paths = ep.trace(corner_of(0.5 * np.pi), array, num_rays=2000).select("T ('left' 'right' | 'right' 'left') R")
    cube = ep.synthesize(paths, array)
    for number in (0, 1):
        alone = array.replace(transmitters=array.transmitters[number:number + 1])
        of_channel = ep.trace(corner_of(0.5 * np.pi), alone, num_rays=2000).select("T ('left' 'right' | 'right' 'left') R")
        np.testing.assert_allclose(cube[number, :, 0], ep.synthesize(of_channel, alone)[0, :, 0], rtol=0,
                                   atol=SUMS * abs(cube).max())
    report = ep.validity(paths)
    assert report.ok and report.left_share == 0.0


def test_in_a_corner_that_is_not_square_the_other_order_is_another_image():
    array = build_radar([(0, -0.6, 0), (0, 2.2, 0)], [(0, 0, 0)])
    for angle, left in ((0.5 * np.pi, 0.0), (1.6, 1.0)):
        paths = ep.trace(corner_of(angle), array, num_rays=2000).select("T 'left' 'right' R")
        assert ep.validity(paths).left_share == pytest.approx(left, abs=SUMS), angle


def test_over_two_square_corners_either_bounce_may_come_first():
    """From wall to wall of a metal room at rest, over floor and roof: past the middle of the room the wave meets the other of
    both planes at each corner first, with the image, length and field of the other order."""
    low, high = np.array([-3.0, -0.7, 0.0]), np.array([5.0, 0.7, 1.15])
    room = {}
    for name, axis, at in (("floor", 2, low), ("roof", 2, high), ("right", 1, low), ("left", 1, high)):
        one, other = (k for k in range(3) if k != axis)
        corners = np.tile(np.where(np.arange(3) == axis, at, low), (4, 1))
        corners[1:3, one], corners[2:, other] = high[one], high[other]
        room[name] = corners
    scene = ep.Scene()
    for name, corners in room.items():
        scene.add(ep.Mesh(corners, [(0, 1, 2), (0, 2, 3)]), name=name, material=shapes.METAL)
    radar = build_radar([(0.9, 0.0, 1.1), (0.9, 0.03, 1.1)], [(0.92, -0.03, 1.1), (0.92, 0.02, 1.1)], num_samples=64)
    order = ["floor", "right", "roof", "floor", "left"]
    either = "T ('floor' 'right' | 'right' 'floor') 'roof' ('floor' 'left' | 'left' 'floor') R"
    paths = ep.trace(scene, radar, num_rays=50_000, max_bounces=5).select(either)
    assert paths.num_paths == 1
    wavelength = ep.speed_of_light / radar.waveform.start_frequency
    for tx, rx in np.ndindex(2, 2):
        image = np.array(radar.transmitters[tx].position, float)
        for name in order:
            axis = 2 if name in ("floor", "roof") else 1
            image[axis] = 2.0 * room[name][0, axis] - image[axis]
        length = np.linalg.norm(image - radar.receivers[rx].position)
        assert paths.lengths([0.0], tx, rx)[0, 0] == pytest.approx(length, abs=1e-9)
        field = wavelength * np.sqrt(radar.transmit_power) / (4.0 * np.pi * length)
        assert abs(paths.amplitudes([0.0], tx, rx)[0, 0]) == pytest.approx(field, rel=1e-3)
    report = ep.validity(paths)
    assert report.ok and report.left_share == 0.0


def test_a_check_at_no_time_is_refused():
    mirror = Plane(MIRROR, WALL)
    with pytest.raises(ValueError, match="^times: must be at least one time, or None"):
        ep.validity(frozen([mirror], [mirror.axes @ [0.1, 0.0, 0.0]]), times=[])
