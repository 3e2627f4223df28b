"""What labels say of each object: what the map shows of it, or why it shows nothing."""
import numpy as np
import pytest

import echopath as ep
from support.labelled import MIRROR, ROUGH, add_plate, add_wall, make_radar, way

DEPTH = 0.4  # m: the body is that deep


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
    assert two_way.peak.range == pytest.approx(distance, abs=DEPTH)


@pytest.mark.parametrize("seed", [2, 4, 5])  # its speckle fades to where the map is masked with one seed in four
def test_an_object_in_sight_just_above_a_mirroring_road_is_seen_there(seed):
    """Its ways over the road are 2 h H / d = 3 cm longer at most, a tenth of a cell: one place, which is the object's."""
    scene, radar = ep.Scene(), make_radar(transmit_power=100.0)
    road = ep.Mesh([[-5, -20, 0], [60, -20, 0], [60, 20, 0], [-5, 20, 0]], [[0, 1, 2], [0, 2, 3]])
    scene.add(road, name="road", material=MIRROR)
    add_plate(scene, "lead", (20, 0, 0.3), velocity=(4, 0, 0), size=0.3)
    frame = ep.simulate(scene, radar, num_rays=20_000, seed=seed, labels={"objects": ["lead"]},
                        detections={"objects": ["lead"]}, guard=False)
    found, detections = frame.labels["parts"], frame.detections
    (lead,) = found.objects
    assert lead.status == "seen" and lead.peak.range == pytest.approx(20, abs=radar.waveform.range_resolution)
    here = int(np.argmin(np.abs(detections.range - 20.0) + np.abs(detections.velocity - 4.0)))
    assert found.object_map[tuple(detections.cells[here])] == 0
    assert (detections.object[here], detections.ghost_type[here], detections.order[here]) == ("lead", 0, 1)


def test_why_an_object_is_not_in_the_map():
    scene = ep.Scene()
    add_plate(scene, "near", (6, 0, 1))
    add_plate(scene, "beyond", (60, 12, 1))
    add_plate(scene, "behind", (-6, 0, 1))
    add_plate(scene, "faint", (30, 3, 1), size=0.002)
    add_plate(scene, "unlit", (12, -4, 1))
    # in the plane y = 0
    scene.add(ep.actors.plate(1.0, 1.0), name="edge on", material=ROUGH, position=(8, 0, 1), yaw=np.pi / 2)
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


@pytest.mark.parametrize("transmit_power, status", [(0.014, "not seen"), (0.05, "unresolved")])
def test_what_no_ray_has_met_is_called_unresolved_where_it_may_be_above_the_noise(transmit_power, status):
    """A plate of metal of 5 cm at 31 m may send sigma = 4 pi A^2 / lambda^2 where it faces the radar: -104 dBm with 1 W, 16 dB
    above a floor of -121 dBm, which a fortieth of that reaches."""
    scene, radar = ep.Scene(), make_radar(transmit_power=transmit_power)
    scene.add(ep.actors.plate(0.05, 0.05), name="far", material=ep.Material.metal(), position=(30, 9, 1), yaw=np.pi + 0.1)
    paths = ep.trace(scene, radar, num_rays=3)
    assert paths.num_paths == 0
    found = ep.annotate(paths, {})
    (far,) = found.objects
    wavelength, distance, area = 299_792_458.0 / radar.waveform.start_frequency, np.hypot(30, 9), 0.05 ** 2
    mirror = transmit_power * wavelength ** 2 * 4 * np.pi * area ** 2 / wavelength ** 2 / ((4 * np.pi) ** 3 * distance ** 4)
    assert far.received.high == pytest.approx(mirror, rel=0.15)  # its solid angle is that of its turned outline
    assert (10 * found.noise_power < mirror) == (status == "unresolved")  # cells stand 10 dB out of the noise
    assert far.status == status


@pytest.mark.parametrize("retrace", ["never", "always"])  # "never" makes no signal of what cannot be seen
@pytest.mark.parametrize("transmit_power, status", [(0.002, "hidden in noise"), (0.02, "unresolved")])
def test_what_the_rays_hardly_know_is_unresolved_where_its_interval_ends_above_the_noise(transmit_power, status, retrace):
    """Ten rays on metal of 0.5 m that looks 0.1 rad beside the radar: the map shows next to nothing of what there may be, which
    would spread over cells as that does."""
    scene = ep.Scene()
    scene.add(ep.actors.plate(0.5, 0.5), name="plate", material=ep.Material.metal(), position=(10, 0.3, 1), yaw=np.pi + 0.1)
    paths = ep.trace(scene, make_radar(transmit_power=transmit_power), num_rays=10)
    parts = ep.decompose(paths, parts={"plate": "T .* R"})
    found = ep.annotate(paths, parts, retrace=retrace, keyframes=1)
    (plate,) = found.objects
    shown = found.power[0].max() / np.mean(np.abs(parts["plate"]) ** 2)  # in the strongest cell, of 1 W received
    assert found.power[0].max() < 1e-4 * found.noise_floor
    assert (shown * plate.received.high > found.noise_floor) == (status == "unresolved")
    assert plate.status == status


@pytest.mark.parametrize("transmit_power, status", [(1.0, "masked"), (0.1, "hidden in noise")])
def test_an_echo_above_the_noise_under_a_stronger_one_is_masked(transmit_power, status):
    scene = ep.Scene()
    add_plate(scene, "large", (10, 0.3, 1), size=0.3)
    add_plate(scene, "small", (10, -0.3, 1), size=0.05)
    paths = ep.trace(scene, make_radar(transmit_power=transmit_power), num_rays=20_000)
    found = ep.annotate(paths, {"small": ep.hits("small")})
    large, small = found.objects
    assert (found.power[0].max() > found.noise_floor) == (status == "masked")
    assert (large.status, small.status) == ("seen", status) and small.power < large.power


def test_a_box_goes_over_the_end_of_the_velocities():
    scene = ep.Scene()
    radar = make_radar()
    add_plate(scene, "fast", (10, 0, 1), velocity=(radar.waveform.max_velocity(), 0, 0))
    paths = ep.trace(scene, radar, num_rays=5000)
    (label,) = ep.annotate(paths, {}).objects
    assert label.box.velocity_min > 0 > label.box.velocity_max
    assert label.box.range_max - label.box.range_min < 3.0


def test_an_empty_scene_has_no_labels():
    paths = ep.trace(ep.Scene(), make_radar(), num_rays=100)
    found = ep.annotate(paths)
    assert found.part_names == ["other"] and not found.mask.any() and np.all(found.dominant == -1)
    assert found.objects == [] and found.ghosts == [] and np.all(found.share == 0) and np.all(found.object_map == -1)
    assert "0 labelled" in str(found)


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
    # Hidden from the one trace, but not throughout the frame: "occluded" would be wrong.
    assert (once["plate"].status, once["plate"].power) == ("comes into view", 0.0)
    assert renewed["plate"].status == "seen" and renewed["plate"].visible_share == 0.0  # that is of the middle
    assert renewed["plate"].peak.range == pytest.approx(9.0, abs=radar.waveform.range_resolution)
    assert once["screen"].status == renewed["screen"].status == "seen"


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
