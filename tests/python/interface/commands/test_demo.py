"""The street demo: its files, its figures, and the physics that its pictures must show."""
from __future__ import annotations

import math
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import echopath as ep
from echopath.cli.demo import run_demo
from echopath.signals.measures import residual
from echopath.spectra.moving import velocity_extent

NUM_RAYS = 2_500
SUM_TOLERANCE = 1e-12
BODY_RADIUS = 0.6    # m, from the torso to what reflects: its front, an arm, a foot in front
WALKING_SPEED = 1.4  # m/s
TURN_SPEED = 0.2     # m/s, of the front of a turning torso against its centre
WALL = 3.0           # m, distance of the side walls from the middle


@pytest.fixture(scope="module")
def demo(tmp_path_factory):
    out = tmp_path_factory.mktemp("demo")
    lines = []
    with pytest.MonkeyPatch.context() as patch:  # pictures are made but not drawn
        patch.setattr(ep.plots, "save_png", lambda figure, path, **_: Path(path).write_bytes(b""))
        frame = run_demo(out, num_rays=NUM_RAYS, say=lines.append)
    return out, frame, lines


def torso(frame, time=None):
    """Centre of the torso [3] in m at a time in s, None: that of the trace."""
    mesh = next(mesh for mesh in frame.scene.meshes if mesh.name == "pedestrian/torso")
    time = frame.paths.frame.trace_time if time is None else time
    return frame.scene.world_vertices(mesh.id, time).mean(axis=0)


def image_distance(point, side: float) -> float:
    """Distance from the radar to the mirror image of a point in the wall y = side, in m."""
    radar = np.array([0.0, 0.005, 1.0])
    return math.dist(radar, (point[0], 2.0 * side - point[1], point[2]))


def moving_peak(spectrum):
    """(range in m, velocity in m/s) of the strongest cell that moves faster than 0.3 m/s."""
    power = np.abs(spectrum.values[0, 0]) ** 2 * (np.abs(spectrum.velocity) > 0.3)[:, None]
    velocity, distance = np.unravel_index(power.argmax(), power.shape)
    return spectrum.range[distance], spectrum.velocity[velocity]


def test_all_files_are_written(demo):
    out, _, _ = demo
    pictures = ["body.png", "labels_body.png", "labels_route.png", "map.png", "objects_and_ghosts.png", "overview.png",
                "route.png", "scene.png"]
    assert sorted(path.name for path in out.iterdir()) == sorted(["frame.h5", "label_maps", *pictures])
    maps = [f"{name}{suffix}" for name in ("ghosts", "objects", "parts_body", "parts_route") for suffix in (".json", ".png")]
    assert sorted(path.name for path in (out / "label_maps").iterdir()) == maps


def test_the_map_shows_the_person_and_its_ghosts_over_both_walls(demo):
    """By way of a wall an echo comes later than the straight one, both ways later than one way: by the image in the wall."""
    _, frame, _ = demo
    labels = frame.labels["route"]
    person, = labels.objects
    assert person.name == "pedestrian" and person.status == "seen" and person.visible_share == pytest.approx(1.0)
    straight = image_distance(torso(frame), 0.0)
    for wall, side in (("wall_left", 3.0), ("wall_right", -3.0)):
        extra = image_distance(torso(frame), side) - straight
        one_way = f"T S'{wall}' 'pedestrian*' R | T 'pedestrian*' S'{wall}' R"
        for order, later, ways in ((2, 0.5 * extra, one_way), (3, extra, f"T S'{wall}' 'pedestrian*' S'{wall}' R")):
            spectrum = ep.range_doppler(ep.synthesize(frame.paths.select(ways), frame.radar), frame.radar)
            assert moving_peak(spectrum)[0] - person.peak.range == pytest.approx(later, abs=BODY_RADIUS)
            for ghost in labels.ghosts:  # both walls' lie in the same cells, so that chance says which have one of their own
                if ghost.via == (wall,) and ghost.order == order and ghost.peak:
                    assert ghost.peak.range - person.peak.range == pytest.approx(later, abs=BODY_RADIUS)
    assert {ghost.via for ghost in labels.ghosts if ghost.peak} >= {("wall_left",), ("wall_right",)}


def test_the_report_tells_what_was_asked_for(demo):
    _, frame, lines = demo
    text = "\n".join(lines)
    for word in ("rays", "hits", "paths", "effects modelled", "mirrors by images", "effects not modelled", "trace",
                 "synthesis", "MiB", "received power, route", "received power, body", "arms", "legs",
                 "received power, legs by route", "|whole - sum of parts|", "frame.h5"):
        assert word in text
    assert f"{NUM_RAYS:,}" in text and f"{frame.paths.num_paths:,}" in text


def test_parts_add_up_to_a_whole_synthesised_on_its_own(demo):
    _, frame, _ = demo
    whole = ep.synthesize(frame.paths, frame.radar)
    assert np.abs(whole).max() > 0.0
    for cubes in frame.parts.values():
        assert residual(whole, cubes) < SUM_TOLERANCE


def test_the_direct_echo_is_at_the_person(demo):
    _, frame, _ = demo
    distance, _ = moving_peak(frame.part_spectra["route"]["direct"])
    assert distance == pytest.approx(math.dist(torso(frame), (0.0, 0.0, 1.0)), abs=BODY_RADIUS)


def test_the_echo_of_the_torso_has_its_radial_speed(demo):
    _, frame, _ = demo
    cube = ep.synthesize(frame.paths.select("T 'pedestrian/torso' R"), frame.radar)
    spectrum = ep.range_doppler(cube, frame.radar, window="hann")
    power = np.sum(np.abs(spectrum.values) ** 2, axis=(0, 1, 3))
    time = frame.paths.frame.trace_time
    distances = [math.dist(torso(frame, time + step), (0.0, 0.0, 1.0)) for step in (-0.01, 0.01)]
    speed = (distances[1] - distances[0]) / 0.02
    assert power @ spectrum.velocity / power.sum() == pytest.approx(speed, abs=TURN_SPEED)


def test_side_wall_ghosts_are_farther_than_the_person_by_image_theory(demo):
    _, frame, _ = demo
    direct, _ = moving_peak(frame.part_spectra["route"]["direct"])
    ghost, velocity = moving_peak(frame.part_spectra["route"]["side wall"])
    person = torso(frame)
    one_way = [0.5 * (math.dist(person, (0.0, 0.0, 1.0)) + image_distance(person, side)) for side in (-WALL, WALL)]
    assert min(one_way) - BODY_RADIUS < ghost < max(one_way) + BODY_RADIUS
    assert ghost > direct and velocity < 0.0


def test_limbs_are_faster_and_slower_than_the_walk(demo):
    _, frame, _ = demo
    for limb in ("arms", "legs"):
        lowest, highest = velocity_extent(frame.part_spectra["limbs"][limb])
        assert lowest < -1.3 * WALKING_SPEED and highest > -0.7 * WALKING_SPEED
    lowest, _ = velocity_extent(frame.part_spectra["limbs"]["legs"])
    assert lowest > -4.5 * WALKING_SPEED  # no foot is faster


def test_noise_is_on_the_whole_only(demo):
    _, frame, _ = demo
    far = frame.spectrum.range > 70.0  # behind everything
    noise = np.mean(np.abs(frame.spectrum.values[..., far]) ** 2)
    parts = [np.mean(np.abs(spectrum.values[..., far]) ** 2) for spectrum in frame.part_spectra["route"].values()]
    assert noise > 100.0 * sum(parts)


def test_velocity_extent_finds_the_lines_of_a_made_up_map():
    velocity = np.linspace(-5.0, 5.0, 101)
    values = np.zeros((1, 1, 101, 4), complex)
    values[0, 0, 50, 0] = 100.0   # stands still
    values[0, 0, 20, 1] = 1.0     # -3 m/s
    values[0, 0, 70, 2] = 0.04    # +2 m/s, 28 dB below
    values[0, 0, 90, 2] = 0.02    # +4 m/s, 34 dB below
    looks = {"velocity": velocity, "window": "hann", "zero_pad": 1}
    assert velocity_extent(SimpleNamespace(values=values, **looks)) == pytest.approx((-3.0, 2.0))
    still = SimpleNamespace(values=values * (np.abs(velocity) < 0.05)[:, None], **looks)
    assert velocity_extent(still) is None
