"""Labels of cells, objects and ghosts against closed forms of where echoes appear, and against NumPy."""
import sys
import threading

import numpy as np
import pytest

import echopath as ep
from echopath import _core
from echopath.labels import objects, powers

MIRROR = ep.Material.metal(mirror=True)
ROUGH = ep.Material(reflectivity=0.9, scattering=1.0)
RADAR = np.array([0.0, 0.0, 1.0])
WALL_Y = 5.0
# Main lobe of a Blackman-Harris window is 4 cells to each side; an extended body adds some.
LOBE = 6.0
CHUNKED = 1e-5  # relative, of the strongest cell: rms tolerance of the signals 1e-7 of the sum of all amplitudes
ROUNDING = 1e-9


def make_radar(num_rx=1, height=1.0, num_samples=256, num_chirps=64, pattern=None, **changes):
    waveform = ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=num_samples, sampling_rate=10e6,
                                num_chirps=num_chirps, chirp_interval=60e-6)
    antennas = [ep.Antenna((0, 0.0019 * i, height), pattern=pattern) for i in range(num_rx)]
    return ep.Radar(waveform, transmitters=antennas[:1], receivers=antennas, **{"transmit_power": 10.0} | changes)


def add_plate(scene, name, position, velocity=(0, 0, 0), material=ROUGH, size=0.2):
    """A plate that faces the radar."""
    scene.add(ep.actors.plate(size, size), name=name, material=material, position=position,
              yaw=np.arctan2(-position[1], -position[0]), motion=ep.LinearMotion(velocity=velocity))


def add_wall(scene):
    wall = ep.Mesh([[-20, WALL_Y, -10], [60, WALL_Y, -10], [60, WALL_Y, 12], [-20, WALL_Y, 12]], [[0, 1, 2], [0, 2, 3]])
    scene.add(wall, name="wall", material=MIRROR)


def way(position, velocity, over_wall: bool):
    """(distance, radial speed) of a point, or of its image in the wall."""
    position, velocity = np.array(position, float), np.array(velocity, float)
    if over_wall:
        position[1], velocity[1] = 2 * WALL_Y - position[1], -velocity[1]
    line = position - RADAR
    return np.linalg.norm(line), velocity @ line / np.linalg.norm(line)


def echoes_of(name, position, velocity):
    """{part: (range m, velocity m/s)} of the direct echo and the one-way and two-way ghosts."""
    (near, slow), (far, fast) = way(position, velocity, False), way(position, velocity, True)
    return {name: (near, slow), f"{name} one way": ((near + far) / 2, (slow + fast) / 2), f"{name} two way": (far, fast)}


TARGETS = {"a": ((7.0, -2.0, 1.0), (-4.0, 0.0, 0.0)), "b": ((18.0, -3.0, 1.0), (6.0, 2.0, 0.0))}


@pytest.fixture(scope="module")
def plates_and_wall():
    """(paths, selections, {part: (range, velocity)} by closed form)."""
    scene, parts, truth = ep.Scene(), {}, {"wall": (WALL_Y, 0.0)}
    add_wall(scene)
    for name, (position, velocity) in TARGETS.items():
        add_plate(scene, name, position, velocity)
        truth |= echoes_of(name, position, velocity)
        parts |= {name: f"T '{name}' R", f"{name} one way": f"T ('{name}' 'wall' | 'wall' '{name}') R",
                  f"{name} two way": f"T 'wall' '{name}' 'wall' R"}
    # The rays see the scene in the middle of the frame: the positions above are those at that time.
    radar = make_radar()
    paths = ep.trace(scene, radar, num_rays=20_000, start_time=-0.5 * radar.frame_duration)
    return paths, parts | {"wall": "T 'wall' R"}, truth


@pytest.fixture(scope="module")
def labels(plates_and_wall):
    paths, parts, _ = plates_and_wall
    return ep.annotate(paths, parts, window="blackman_harris", zero_pad=2, dynamic_range_db=80.0)


def cells_from(labels, radar, distance, velocity):
    """How many cells of an unpadded map each cell is from a point, along velocity [V] and range [R]; velocities fold."""
    wave = radar.waveform
    coupling = wave.centre_frequency * velocity / wave.slope
    step, span = wave.velocity_resolution(), 2 * wave.max_velocity()
    slow = (labels.velocity - velocity + span / 2) % span - span / 2
    return np.abs(slow) / step, np.abs(labels.range - distance - coupling) / wave.range_resolution


def test_every_labelled_cell_has_the_part_that_closed_forms_put_there(labels, plates_and_wall):
    paths, _, truth = plates_and_wall
    near = []
    for name in labels.part_names:
        slow, far = cells_from(labels, paths.radar, *truth.get(name, (1e9, 0.0)))
        near.append((slow < LOBE)[:, None] & (far < LOBE)[None, :])
    near = np.array(near)
    assert near.sum(axis=0).max() == 1  # the scene was chosen so
    at = np.flatnonzero(labels.mask)
    expected = np.where(near.any(axis=0), near.argmax(axis=0), -2).ravel()[at]
    assert labels.noise_margin_db == 10.0 and len(at) > 500
    assert np.array_equal(labels.dominant.ravel()[at], expected)
    assert set(np.unique(expected)) == set(range(len(truth)))  # each of the seven is seen


def test_objects_and_ghosts_peak_where_closed_forms_put_them(labels, plates_and_wall):
    paths, _, truth = plates_and_wall
    wave = paths.radar.waveform

    def is_at(peak, name):
        distance, velocity = truth[name]
        distance += wave.centre_frequency * velocity / wave.slope
        is_near = abs(peak.range - distance) < wave.range_resolution
        return is_near and abs(peak.velocity - velocity) < wave.velocity_resolution()

    assert [label.name for label in labels.objects] == ["a", "b"] and all(label.status == "seen" for label in labels.objects)
    for label in labels.objects:
        assert is_at(label.peak, label.name) and label.visible_share == 1.0 and label.occluders == {}
        assert label.box.range_min <= label.peak.range <= label.box.range_max
    seen = {(ghost.object, ghost.order): ghost for ghost in labels.ghosts if ghost.cells}
    assert set(seen) == {("a", 2), ("a", 3), ("b", 2), ("b", 3)}
    for (name, order), ghost in seen.items():
        assert is_at(ghost.peak, f"{name} {'one' if order == 2 else 'two'} way") and ghost.via == ("wall",)
    assert {(ghost.order, ghost.ghost_type, ghost.class_code) for ghost in seen.values() if ghost.order == 3} == {(3, 2, 124)}


def test_maps_of_objects_and_ghosts_hold_the_cells_that_labels_count(labels):
    for index, label in enumerate(labels.objects):
        assert np.count_nonzero(labels.object_map == index) == label.cells > 0
    for index, ghost in enumerate(labels.ghosts):
        assert np.count_nonzero(labels.ghost_map == index) == ghost.cells
    assert not np.any((labels.object_map >= 0) & (labels.ghost_map >= 0))
    assert not np.any(((labels.object_map >= 0) | (labels.ghost_map >= 0)) & ~labels.mask)


def test_shares_sum_to_one_and_the_dominant_part_has_the_largest(labels):
    lit = labels.power.sum(axis=0) > 0
    assert np.abs(labels.share.sum(axis=0)[lit] - 1).max() < ROUNDING
    assert np.array_equal(labels.dominant[labels.mask], labels.share.argmax(axis=0)[labels.mask])
    assert np.all(labels.dominant[~labels.mask] == -1)
    assert labels.part_names[-1] == "other" and labels.shape == labels.whole.shape == labels.mask.shape


def test_masks_are_those_of_the_noise_and_of_the_dynamic_range(plates_and_wall):
    paths, parts, _ = plates_and_wall
    found = ep.annotate(paths, parts, noise_margin_db=20.0, dynamic_range_db=35.0)
    assert np.array_equal(found.above_noise, found.whole > 100 * found.noise_power)
    assert np.array_equal(found.mask, found.above_noise & (found.whole >= found.whole.max() * 10**-3.5))
    every = ep.annotate(paths, parts, noise=False, dynamic_range_db=None)
    assert np.array_equal(every.mask, every.whole > 0)


@pytest.mark.parametrize("window, real", [("hann", False), (("chebyshev", 70), True)])
def test_noise_of_a_cell_is_the_mean_of_noise_alone(window, real):
    wave = ep.ChirpSequence(num_samples=256, num_chirps=128, real=real)
    radar = ep.Radar(wave, transmitters=[ep.Antenna()], receivers=[ep.Antenna()] * 4)
    noise = ep.add_noise(np.zeros((1, 4, 128, 256)), radar, seed=5)
    measured = np.mean(np.abs(ep.range_doppler(noise, radar, window=window).values[..., 1:]) ** 2)
    assert _core.cell_noise_power(radar, window) / measured == pytest.approx(1.0, abs=0.02)  # 6e4 cells, neighbours alike


def test_powers_are_those_of_numpy(plates_and_wall):
    paths, parts, _ = plates_and_wall
    radar = make_radar(num_rx=3)
    made = ep.decompose(paths, radar, parts)
    found = ep.annotate(paths, made)
    spectra = {name: ep.range_doppler(cube, radar).values for name, cube in made.items()}
    for name, power in zip(found.part_names, found.power):
        assert np.allclose(power, np.mean(np.abs(spectra[name]) ** 2, axis=(0, 1)), rtol=ROUNDING, atol=0.0)
    whole = np.mean(np.abs(sum(spectra.values())) ** 2, axis=(0, 1))
    assert np.abs(found.whole - whole).max() < ROUNDING * whole.max()


def test_receivers_one_at_a_time_give_the_labels_of_all_at_once(plates_and_wall, monkeypatch):
    paths, parts, _ = plates_and_wall
    radar = make_radar(num_rx=3)
    together = ep.annotate(paths, ep.decompose(paths, radar, parts))
    monkeypatch.setattr(powers, "CUBES_IN_MEMORY", 1)
    apart = ep.annotate(paths, parts, radar)
    assert len(powers.receiver_sets(radar, 1)) == 3
    assert np.abs(apart.power - together.power).max() < CHUNKED * together.whole.max()
    assert np.mean(apart.dominant == together.dominant) > 0.999


def person_behind_car(with_wall: bool):
    """A person 2 m behind a car that hides it, seen from bumper height."""
    scene = ep.Scene()
    if with_wall:
        add_wall(scene)
    scene.add(ep.actors.box((1.5, 1.8, 3.0)), name="car", material=ep.Material.metal(), position=(6, -0.5, 1))
    scene.add(ep.actors.box((0.3, 0.5, 1.2)), name="person", material=ROUGH, position=(9, -0.75, 1))
    return scene


def test_a_person_behind_a_car_is_occluded_by_it_and_has_no_cells():
    paths = ep.trace(person_behind_car(with_wall=False), make_radar(), num_rays=20_000)
    found = ep.annotate(paths, {"person": ep.hits("person")})
    car, person = found.objects
    assert (person.status, person.cells, person.peak, person.box) == ("occluded", 0, None, None)
    assert person.visible_share == 0.0 and person.occluders == {"car": 1.0}
    assert car.status == "seen" and car.visible_share == 1.0 and person.is_occluded and not car.is_occluded
    assert not np.any(found.object_map == 1) and not np.any(found.ghost_map >= 0)


def test_only_cells_that_multipath_lights_are_ghosts_of_a_hidden_person():
    paths = ep.trace(person_behind_car(with_wall=True), make_radar(), num_rays=40_000)
    found = ep.annotate(paths, {"person": ep.hits("person")})
    (person,) = [label for label in found.objects if label.name == "person"]
    assert person.status == "ghosts only" and person.cells == 0 and person.occluders == {"car": 1.0} and person.is_occluded
    assert not np.any(found.object_map == found.objects.index(person))
    ghosts = [ghost for ghost in found.ghosts if ghost.object == "person" and ghost.cells]
    two_way = max(ghosts, key=lambda ghost: ghost.peak.power)
    assert two_way.via == ("wall",) and two_way.order == 3
    distance, _ = way((9 - 0.15, -0.75, 1), (0, 0, 0), over_wall=True)  # of the front, from the image of the radar
    assert two_way.peak.range == pytest.approx(distance, abs=0.4)       # the body is that deep


def test_why_an_object_is_not_in_the_map():
    scene = ep.Scene()
    add_plate(scene, "near", (6, 0, 1))
    add_plate(scene, "beyond", (60, 12, 1))
    add_plate(scene, "behind", (-6, 0, 1))
    add_plate(scene, "faint", (30, 3, 1), size=0.002)
    add_plate(scene, "unlit", (12, -4, 1))
    scene.add(ep.actors.plate(1.0, 1.0), name="edge on", material=ROUGH, position=(8, 0, 1), yaw=np.pi / 2)  # in the plane y = 0
    radar = make_radar(pattern=ep.CosinePower(2.0), transmit_power=1e-3)
    assert radar.waveform.max_range < 60
    paths = ep.trace(scene, radar, num_rays=20_000)
    paths = paths.select(~ep.hits("unlit"))
    found = {label.name: label for label in ep.annotate(paths, {"near": "T 'near' R"}).objects}
    assert {name: label.status for name, label in found.items()} == {
        "near": "seen", "beyond": "outside the map", "behind": "outside the map", "faint": "hidden in noise",
        "unlit": "not seen", "edge on": "not seen"}
    assert found["near"].power > found["faint"].power > 0 and found["unlit"].power == 0
    assert all(label.cells == 0 and label.box is None for name, label in found.items() if name != "near")


def test_an_echo_under_a_stronger_one_is_masked():
    scene = ep.Scene()
    add_plate(scene, "large", (10, 0.3, 1), size=0.3)
    add_plate(scene, "small", (10, -0.3, 1), size=0.05)
    paths = ep.trace(scene, make_radar(), num_rays=20_000)
    large, small = ep.annotate(paths, {}).objects
    assert (large.status, small.status) == ("seen", "masked") and small.power < large.power


def test_a_box_goes_over_the_end_of_the_velocities():
    scene = ep.Scene()
    radar = make_radar()
    add_plate(scene, "fast", (10, 0, 1), velocity=(radar.waveform.max_velocity(), 0, 0))
    paths = ep.trace(scene, radar, num_rays=5000)
    (label,) = ep.annotate(paths, {}).objects
    assert label.box.velocity_min > 0 > label.box.velocity_max
    assert label.box.range_max - label.box.range_min < 3.0


def test_power_of_an_object_is_that_of_its_cube(plates_and_wall):
    paths, parts, _ = plates_and_wall
    made = ep.decompose(paths, None, parts)
    for label in ep.annotate(paths, made).objects:
        assert label.power / np.mean(np.abs(made[label.name]) ** 2) == pytest.approx(1.0, abs=1e-6)


def test_an_empty_scene_has_no_labels():
    paths = ep.trace(ep.Scene(), make_radar(), num_rays=100)
    found = ep.annotate(paths)
    assert found.part_names == ["other"] and not found.mask.any() and np.all(found.dominant == -1)
    assert found.objects == [] and found.ghosts == [] and np.all(found.share == 0) and np.all(found.object_map == -1)
    assert "0 labelled" in str(found)


def test_azimuths_tell_plates_at_one_range_apart():
    scene = ep.Scene()
    for name, degrees in (("left", 25.0), ("right", -20.0)):
        angle = np.radians(degrees)
        add_plate(scene, name, (10 * np.cos(angle), 10 * np.sin(angle), 1))
    radar = make_radar(num_rx=12)
    paths = ep.trace(scene, radar, num_rays=20_000)
    parts = {"left": "T 'left' R", "right": "T 'right' R"}
    found = ep.annotate(paths, parts, plane="range_azimuth", angles={"window": "hamming"}, dynamic_range_db=25.0)
    assert found.velocity is None and found.shape == (len(found.azimuth), len(found.range))
    rows = np.nonzero(found.mask)[0]
    expected = np.where(found.azimuth[rows] > np.radians(2.5), 0, 1)
    assert len(rows) > 20 and np.mean(found.dominant[found.mask] == expected) == 1.0
    left, right = found.objects
    assert np.degrees(left.peak.azimuth) == pytest.approx(25.0, abs=2.0) and left.box.azimuth_min > 0
    assert np.degrees(right.peak.azimuth) == pytest.approx(-20.0, abs=2.0)


def test_noise_of_beams_is_that_of_a_cell_over_the_number_of_elements():
    radar = make_radar(num_rx=8)
    scene = ep.Scene()
    add_plate(scene, "plate", (10, 0, 1))
    paths = ep.trace(scene, radar, num_rays=500)
    found = ep.annotate(paths, plane="range_azimuth", angles={"velocity": 0.0})
    cell = _core.cell_noise_power(radar, "hann")
    assert found.noise_power / cell * 8 == pytest.approx(1.0, abs=0.05)  # 256 ranges of 8 beams, neighbours alike


def test_simulate_carries_the_labels_of_its_parts(plates_and_wall):
    paths, parts, _ = plates_and_wall
    settings = {"num_rays": 5000, "parts": parts, "tolerance": 1e-9}
    frame = ep.simulate(paths.scene, make_radar(), labels={"dynamic_range_db": 50.0}, **settings)
    (labels,) = frame.labels.values()
    alone = ep.annotate(frame.paths, parts, dynamic_range_db=50.0, tolerance=1e-9)
    assert np.array_equal(labels.dominant, alone.dominant) and labels.objects[0].cells == alone.objects[0].cells
    assert np.abs(labels.power - alone.power).max() < ROUNDING * alone.whole.max()
    assert ep.simulate(paths.scene, make_radar(), **settings).labels == {}
    bare = ep.simulate(paths.scene, make_radar(), num_rays=1000, labels=True)
    assert bare.parts == {} and bare.labels["parts"].part_names == ["other"]


def test_words_name_objects_and_ghosts(labels):
    text = str(labels)
    assert "object a: seen" in text and "ghost  a: type" in text and "part   wall:" in text
    assert "range_doppler" in repr(labels)


@pytest.mark.parametrize("keywords, message", [
    ({"plane": "elevation"}, "plane: must be 'range_doppler' or 'range_azimuth', got 'elevation'"),
    ({"plane": "range_azimuth"}, "plane: 'range_azimuth' needs antennas side by side"),
    ({"angles": {}}, "angles: are for the plane 'range_azimuth'"),
    ({"dynamic_range_db": -1}, "dynamic_range_db: must not be negative"),
    ({"noise_margin_db": np.nan}, "noise_margin_db: must be finite"),
    ({"errors": True}, r"errors: need independent batches of rays, trace\(batches=8\)"),
    ({"window": "han"}, "window"),
    ({"zero_pad": 0}, "zero_pad"),
    ({"objects": ["bicycle"]}, "bicycle"),
    ({"parts": {"one": {"a": "T . R"}}}, "parts: must be one partition"),
    ({"parts": {"one": np.zeros((1, 1, 2, 2))}}, "parts: cubes must have shape"),
    ({"parts": ep.parts.Parts({"other": np.zeros((1, 1, 64, 256))}, {}, make_radar(height=1.1)), "radar": make_radar()},
     "parts: must be of the radar, got those of another transmitters"),
])
def test_bad_settings_are_named(plates_and_wall, keywords, message):
    with pytest.raises(ValueError, match=message):
        ep.annotate(plates_and_wall[0], **{"parts": {}} | keywords)


def test_unknown_keywords_name_the_nearest(plates_and_wall):
    with pytest.raises(TypeError, match="annotate: unknown keyword 'tolerence', the nearest right one is 'tolerance'"):
        ep.annotate(plates_and_wall[0], tolerence=1e-6)
    with pytest.raises(TypeError, match="annotate_frame: unknown keyword 'object', the nearest right one is 'objects'"):
        ep.annotate_frame(None, object=["a"])
    with pytest.raises(TypeError, match="labels: unknown keyword 'noise_margin', the nearest right one is 'noise_margin_db'"):
        ep.simulate(ep.Scene(), make_radar(), labels={"noise_margin": 3})


@pytest.mark.parametrize("objects, message", [({"x": "bicycle"}, "objects: .*'bicycle'"),
                                              ({"x": "a", "y": "a"}, "objects: must each have a mesh")])
def test_bad_objects_of_labels_are_told_before_the_trace(plates_and_wall, monkeypatch, objects, message):
    monkeypatch.setattr(ep, "trace", None)
    with pytest.raises(ValueError, match=message):
        ep.simulate(plates_and_wall[0].scene, make_radar(), labels={"objects": objects})


def test_retraced_frames_label_what_comes_out_of_hiding():
    """A plate behind a screen that leaves: hidden in the middle of the frame, when it is traced, and bare at the end of
    it."""
    scene, radar = ep.Scene(), make_radar()
    add_plate(scene, "plate", (9, 0, 1))
    leaving = ep.LinearMotion(velocity=(0, 2.0 / radar.frame_duration, 0))  # half its width until the middle, 1 m by then
    scene.add(ep.actors.plate(1.5, 1.5), name="screen", material=ROUGH, position=(5, -0.8, 1), yaw=np.pi, motion=leaving)
    paths = ep.trace(scene, radar, num_rays=5000)
    once, renewed = ({label.name: label for label in ep.annotate(paths, {}, objects=["plate", "screen"], **settings).objects}
                     for settings in ({}, {"retrace": "always", "keyframes": 4}))
    assert (once["plate"].status, once["plate"].power) == ("occluded", 0.0)
    assert renewed["plate"].status == "seen" and renewed["plate"].visible_share == 0.0  # that is of the middle
    assert renewed["plate"].peak.range == pytest.approx(9.0, abs=radar.waveform.range_resolution)
    assert once["screen"].status == renewed["screen"].status == "seen"


class OneCell:
    """A map of one cell with the power of a cube of one sample."""

    def power(self, cube, radar):
        return np.abs(cube[0, 0]) ** 2


@pytest.mark.parametrize("there, back, wins", [(1.0, 1.0, 1), (1.0, -1.0, 0), (0.7, 0.7, 0), (1.0, 1.02, 2)])
def test_a_way_there_and_back_wins_cells_by_its_common_field(there, back, wins):
    """Against a direct echo of amplitude 1.5. Equal powers are of type 1, whatever rounding says."""
    families = [ep.Family("a", 0, 1, ()), *(ep.Family("a", kind, 2, ("wall",)) for kind in (1, 2)), ep.Family("", 0, 0, ())]
    fields = 1.5, there, back * (1 + 1e-9), 0.0
    cubes = {family: np.full((1, 1, 1, 1), field) for family, field in zip(families, fields)}
    found = powers.ViewPowers(OneCell())
    for _ in range(2):
        found.add(cubes, powers.CubeSet(None, 0.5, {}))
    cells = np.stack([found.cells[family] for family in families])
    assert objects._strongest_family(found, families, cells, np.ones((1, 1), bool)).item() == wins
    assert found.rivals["a", 2, frozenset({"wall"})] == pytest.approx((there + back) ** 2, abs=1e-8)


def test_pairs_of_ghosts_have_their_cells_together(labels):
    kinds = {(ghost.object, ghost.ghost_type): ghost.cells for ghost in labels.ghosts if ghost.order == 2}
    assert all(kinds[name, 1] > 0 and kinds[name, 2] == 0 for name in TARGETS)


def test_parts_by_families_are_labelled_too(plates_and_wall):
    paths, _, _ = plates_and_wall
    families = ep.families(paths)
    found = ep.annotate(paths, ep.decompose(paths, parts=families))
    assert found.part_names == [str(family) for family in families]
    assert all(np.count_nonzero(found.dominant == families.families.index(ep.Family(label.name, 0, 1, ()))) == label.cells > 0
               for label in found.objects)
    batched = ep.trace(paths.scene, paths.radar, num_rays=500, batches=2)
    with pytest.raises(ValueError, match="errors: need the selections of the parts"):
        ep.annotate(batched, ep.decompose(batched, parts=ep.families(batched)), errors=True)


def test_what_is_in_view_is_a_matter_of_the_radar_of_the_map():
    scene = ep.Scene()
    add_plate(scene, "ahead", (8, 0, 1))
    scene.add(ep.actors.box((4.0, 4.0, 0.2)), name="roof", material=ROUGH, position=(3, 0, 4))
    paths = ep.trace(scene, make_radar(), num_rays=2000)
    turned = ep.Antenna((0, 0, 1), orientation=(0, 0, 0, 1), pattern=ep.CosinePower(2.0))  # half a turn about z
    backward, stages = ep.Radar(make_radar().waveform, transmitters=[turned], receivers=[turned]), set()
    found = ep.annotate(paths, {}, backward, progress=lambda stage, fraction: stages.add(stage))
    assert found.objects[0].status == "outside the map" and "visibility" in stages
    within = [ep.Antenna((3, 0, 2))]  # the sphere about the roof
    under_the_roof = ep.Radar(make_radar().waveform, transmitters=within, receivers=within)
    assert [label.name for label in ep.annotate(paths, {}, under_the_roof).objects] == ["ahead", "roof"]


def test_no_keywords_are_all_defaults(plates_and_wall):
    paths, _, _ = plates_and_wall
    frame = ep.simulate(paths.scene, make_radar(), num_rays=1000, labels={}, detections={})
    assert list(frame.labels) == ["parts"] and len(frame.detections) > 0
    none = ep.simulate(paths.scene, make_radar(), num_rays=1000, labels=False, detections=False)
    assert none.labels == {} and none.detections is None


def test_detections_have_the_objects_of_the_labels(plates_and_wall):
    paths, _, _ = plates_and_wall
    frame = ep.simulate(paths.scene, make_radar(), num_rays=5000, labels={"objects": {"target": ["a", "b"]}}, detections=True)
    assert {"target"} <= set(frame.detections.object) <= {"target", ""}


@pytest.mark.parametrize("keywords, error, message", [
    ({"false_alarm": 1e-3}, TypeError, "detections: unknown keyword 'false_alarm', the nearest right one is 'false_alarm_rate'"),
    ({"false_alarm_rate": 2.0}, ValueError, "false_alarm_rate: must be in"),
    ({"objects": ["bicycle"]}, ValueError, "bicycle"),
])
def test_bad_keywords_of_detections_are_told_before_the_trace(plates_and_wall, monkeypatch, keywords, error, message):
    monkeypatch.setattr(ep, "trace", None)
    with pytest.raises(error, match=message):
        ep.simulate(plates_and_wall[0].scene, make_radar(), detections=keywords)


GIL_CALLS = {
    "power_shares": lambda power, mask: _core.power_shares(power),
    "cell_masks": lambda power, mask: _core.cell_masks(power[0], 0.5, 0.0),
    "strongest_part": lambda power, mask: _core.strongest_part(power, mask)}


TRIES = 100  # a busy machine may let the other thread wait for longer than one call


@pytest.mark.parametrize("name", GIL_CALLS)
def test_other_threads_run_beside_labels(name):
    power = np.ones((4, 2000, 1000))
    arrays = power, np.ones((2000, 1000), bool)
    go, ran, interval = threading.Lock(), threading.Event(), sys.getswitchinterval()
    go.acquire()
    other = threading.Thread(target=lambda: (go.acquire(), ran.set()))
    other.start()
    sys.setswitchinterval(1000.0)  # s: another thread runs only where this one lets it
    try:
        go.release()
        for _ in range(TRIES):
            GIL_CALLS[name](*arrays)
            if ran.is_set():
                break
        was_run = ran.is_set()
    finally:
        sys.setswitchinterval(interval)
        other.join()
    assert was_run


def test_capon_beams_are_refused():
    radar = make_radar(num_rx=4)
    paths = ep.trace(ep.Scene(), radar, num_rays=10)
    with pytest.raises(ValueError, match="angles: method must be 'bartlett'"):
        ep.annotate(paths, plane="range_azimuth", angles={"method": "capon"})
