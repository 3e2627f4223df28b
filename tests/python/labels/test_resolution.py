"""Intervals of received powers hold the true value, and what the rays do not know is named, at most with what would help."""
import csv
import dataclasses
import re
import time
from types import SimpleNamespace

import h5py
import numpy as np
import pytest
from scipy import special

import echopath as ep
from echopath.actors import shapes
from echopath.bench.crowd import coverage as crowd_coverage, echoes as crowd_echoes, scenes as crowd_scenes
from echopath.bench.physics import targets
from echopath.bench.physics.closed_forms import WAVELENGTH
from echopath.cli import main, report
from echopath.frame_file import LeftOut
from echopath.paths.resolution import Unmet, _times_the_rays
from echopath.paths.visibility import visibility_in_trace
from support.radars import build_radar
from support.scenes.coarse_bodies import coarse_bodies

SEEDS = 60
CHANCE = 1e-3              # of a test of coverage to fail although the coverage is as wanted
WANTED = (0.90, 0.98)      # coverage of the true value
IMAGE_ROUNDING = 1e-6  # weights of paths are in single precision
IMAGE_DB = 1e-6             # of an exact echo: rounding
TRANSMIT_POWER = 0.01      # W


def power_of(rcs: float, distance: float) -> float:
    return rcs * TRANSMIT_POWER * WAVELENGTH ** 2 / ((4 * np.pi) ** 3 * distance ** 4)


def plates():
    """(scene, distance in m, truth in W): metal plates in the lobe and beside it, and a Lambert plate, by closed forms."""
    cases = [*((targets.plate(angle), 2e3) for angle in (0.0, 3.0, 5.0, 8.0)), (targets.lambert_plate(), 20.0)]
    return [(target.scene, power_of(target.truth, distance)) for target, distance in cases]


@pytest.mark.parametrize("batches", [1, 4])
def test_intervals_hold_the_truth_as_often_as_they_say(batches):
    held = [one.low <= truth <= one.high
            for scene, truth in plates() for seed in range(SEEDS)
            for one in [ep.received_power(ep.trace(scene, targets.radar(), num_rays=2048, max_bounces=1, seed=seed,
                                                   batches=batches))]]
    assert special.bdtr(sum(held), len(held), WANTED[0]) > CHANCE
    assert special.bdtrc(sum(held) - 1, len(held), WANTED[1]) > CHANCE or batches == 1  # a lattice errs less than it shows


def test_a_sidelobe_that_coarse_cells_filter_away_is_not_resolved():
    target = targets.plate(20.3)
    truth = power_of(target.truth, 2e3)
    for batches in (1, 4):
        coarse, fine = (ep.received_power(ep.trace(target.scene, targets.radar(), num_rays=rays, max_bounces=1, batches=batches))
                        for rays in (256, 1 << 18))
        assert coarse.power < 0.5 * truth and not coarse.resolved and coarse.low <= truth <= coarse.high
        assert fine.resolved and fine.low <= truth <= fine.high


def test_a_large_plane_that_nobody_marked_is_imaged_and_resolved():
    scene, radar = crowd_scenes.city_ground()
    paths = ep.trace(scene, radar, num_rays=100_000, max_bounces=1)
    truth = crowd_scenes.ground_path_power(radar.transmit_power)
    ground = ep.received_power(paths.select("T 'ground' R"))
    assert ground.power == pytest.approx(truth, rel=IMAGE_ROUNDING) and ground.resolved
    assert not [one for one in ep.unresolved(paths) if "mirror=True" in one.advice]


@pytest.mark.parametrize("batches", [1, 8])
def test_the_echo_of_a_flagged_mirror_is_exact(batches):
    """It is an image, which no ray has to find: counted as one hit of a lattice it claimed -9 to +5 dB."""
    scene = ep.Scene()
    wall = ep.materials["concrete"].replace(mirror=True)
    scene.add(ep.actors.wall(30, 4), name="wall", material=wall, position=(12, 3, 0))
    radar = build_radar([(0, 0, 1)], [(0, 0.01, 1)])
    power = ep.received_power(ep.trace(scene, radar, num_rays=20_000, batches=batches).select("T S'wall' R"))
    assert power.num_coherent_paths == 1 and power.interval_db < IMAGE_DB


def far_patch():
    """A Lambert patch of 2 cm beside a wide board, which takes nearly all rays of their common aim."""
    scene = ep.Scene()
    rough = ep.Material(reflectivity=0.5, scattering=1.0)
    scene.add(None, name="pair", position=(60, 0, 0))
    scene.add(ep.actors.plate(0.02, 0.02), name="patch", material=rough, parent="pair")
    scene.add(ep.actors.plate(3, 3), name="board", material=rough, parent="pair", position=(0, 4, 0))
    return scene


def test_a_wall_whose_point_of_reflection_lies_abeam_is_resolved():
    """It is imaged, and the antenna, which looks ahead, sends nothing there."""
    scene = crowd_scenes.alone("wall_left", mirrors=False)
    wall = ep.received_power(ep.trace(scene, crowd_scenes.radar(), num_rays=20_000, max_bounces=1).select("T 'wall_left' R"))
    assert wall.resolved and wall.coherent < 0.01 * wall.power


def test_facets_that_cells_do_not_resolve_may_hide_all():
    """A sphere of facets, each flat and much smaller than a launch cell: what one of them says holds for no other."""
    scene = ep.Scene()
    scene.add(shapes.sphere(1.0, edge=0.02), name="ball", material=ep.Material.metal(), position=(30.0, 0.0, 0.0))
    for batches in (1, 4):
        ball = ep.received_power(ep.trace(scene, targets.radar(), num_rays=1024, max_bounces=1, batches=batches))
        assert ball.between_rays == pytest.approx(batches * ball.unfiltered, rel=1e-12) and not ball.resolved
        assert ball.low <= power_of(np.pi, 30.0) <= ball.high


@pytest.mark.parametrize("seed", [1003, 1016, 1029])
def test_a_wave_of_two_bounces_that_wide_cells_fade_lies_in_its_interval(seed):
    """A ball, then a flank, by geometrical optics: of 4096 rays the filter leaves a hundredth of the power, which is known no
    more; interval ends that grow like the root of what lies between rays were up to 9 dB below the truth."""
    echo = next(one for one in crowd_echoes.all_echoes() if one.kind == "two bounces, ball then flank")
    with coarse_bodies():
        scene, truth = echo.draw(seed)
    found, _ = crowd_coverage.power_of(echo, scene, num_rays=4096, seed=seed, batches=8)
    assert found.low <= truth <= found.high < 1e3 * truth and not found.resolved


def test_a_plane_of_many_triangles_is_a_plane():
    """Cut into triangles much smaller than a launch cell, of which each says what the whole does."""
    side = np.linspace(-1.5, 1.5, 61)
    y, z = (axis.ravel() for axis in np.meshgrid(side, side))
    turn, tilt = np.cos(0.3), np.sin(0.3)  # away from the radar: nothing of it mirrors
    vertices = np.column_stack([30.0 + tilt * y, turn * y, z])
    corner = (61 * np.arange(60)[:, None] + np.arange(60)).ravel()
    fine = ep.Mesh(vertices, np.vstack([np.column_stack([corner, corner + 1, corner + 62]),
                                        np.column_stack([corner, corner + 62, corner + 61])]))
    coarse = ep.Mesh(vertices[[0, 60, 3720, 3660]], [[0, 1, 2], [0, 2, 3]])
    found = []
    for mesh in (fine, coarse):
        scene = ep.Scene()
        scene.add(mesh, name="plane", material=ep.Material.metal())
        found.append(ep.received_power(ep.trace(scene, targets.radar(), num_rays=2048, max_bounces=1)))
    assert found[0].between_rays == pytest.approx(found[1].between_rays, rel=0.1)
    assert found[0].between_rays < 1e-3 * found[0].unfiltered


def test_what_no_ray_has_met_is_not_known_to_be_nothing():
    paths = ep.trace(far_patch(), build_radar(), num_rays=64, max_bounces=1)
    assert ep.received_power(paths.select("T '*patch' R")).power == 0.0
    area, wavelength = 0.02 ** 2, ep.speed_of_light / 77e9
    truth = 4 * 0.5 * area * TRANSMIT_POWER * wavelength ** 2 / ((4 * np.pi) ** 3 * 60.0 ** 4)  # sigma = 4 rho A
    patch = next(one for one in ep.unresolved(paths, {"patch": "pair/patch", "board": "pair/board"}) if one.name == "patch")
    assert patch.interval.low <= truth <= patch.interval.high and not patch.interval.resolved
    assert "rays or more to meet it" in patch.advice


def test_what_may_be_there_does_not_hang_on_the_name_that_an_object_has_for_labels():
    """A metal plate below a node that surrounds the radar, too small for so few rays to meet it."""
    scene = ep.Scene()
    town = scene.add(None, name="town")
    scene.add(shapes.ground((200.0, 200.0), z=-1.0), name="ground", material=ep.Material(reflectivity=0.3, scattering=1.0),
              parent=town)
    scene.add(shapes.plate(0.01, 0.01), name="plate", material=ep.Material.metal(), parent=town, position=(40.0, 0.0, 0.0))
    paths = ep.trace(scene, targets.radar(), max_bounces=1, num_rays=2)
    by_name, by_label = (next(one for one in ep.unresolved(paths, objects) if one.name == name)
                         for name, objects in (("town/plate", ["town/plate"]), ("sign", {"sign": "town/plate"})))
    assert by_label.interval == by_name.interval
    assert by_label.interval.high > 0.0


def test_a_name_for_a_power_that_the_rays_know_is_not_given():
    paths = ep.trace(far_patch(), build_radar(), num_rays=1 << 15, max_bounces=1)
    assert ep.unresolved(paths) == []


def test_of_many_unresolved_echoes_the_first_are_printed():
    """A closed metal room in which a rough thing stands has ghosts over each wall, and over each pair of them."""
    corners = np.array([[x, y, z] for x in (0.0, 3.0) for y in (0.0, 2.0) for z in (0.0, 1.5)])
    scene = ep.Scene()
    for name, quad in (("floor", (0, 2, 6, 4)), ("roof", (1, 3, 7, 5)), ("left", (2, 3, 7, 6)), ("right", (0, 1, 5, 4)),
                       ("front", (4, 5, 7, 6)), ("back", (0, 1, 3, 2))):
        scene.add(ep.Mesh(corners[list(quad)], [(0, 1, 2), (0, 2, 3)]), name=name, material="metal")
    rough = ep.Material(permittivity=2 - 0.2j, scattering=0.6)
    scene.add(ep.actors.plate(0.3, 0.3), name="thing", material=rough, position=(2, 1, 0.7))
    radar = ep.Radar(ep.ChirpSequence(num_chirps=1), transmitters=[ep.Antenna((0.5, 0.9, 0.6))],
                     receivers=[ep.Antenna((0.5, 0.91, 0.6))])
    found = ep.unresolved(ep.trace(scene, radar, num_rays=2000, max_bounces=4))
    assert len(found) > 100
    assert repr(found).count("Unresolved(") == 12 and repr(found).endswith(f"and {len(found) - 12} more]")
    assert repr(found[:2]) == f"[{found[0]!r}, {found[1]!r}]"


# --- what carries it ---

@pytest.fixture(scope="module")
def frame():
    """A smooth car-like body, far too few rays for it, and a rough board that they know well."""
    scene = ep.Scene()
    scene.add(ep.actors.plate(1, 1), name="board", material=ep.Material(reflectivity=0.5, scattering=1.0), position=(6, 1, 0))
    scene.add(ep.actors.plate(0.5, 0.5), name="sign", material=ep.Material.metal(), position=(9, -2, 0), yaw=0.1)
    return ep.simulate(scene, build_radar(num_chirps=8, transmit_power=1.0), num_rays=1500, max_bounces=1, labels=True,
                       detections={"false_alarm_rate": 1e-3}, guard=False,
                       parts={"board": "T 'board' R", "sign": "T 'sign' R"})


def test_labels_and_detections_say_what_is_resolved(frame):
    known = {label.name: label.received.resolved for label in frame.labels["parts"].objects}
    assert known == {"board": True, "sign": False}
    assert [one.resolved for one in frame.labels["parts"].part_received[:2]] == [True, False]
    found = frame.detections
    assert len(found) and np.array_equal(found.is_resolved, found.object == "board")
    assert [one.name for one in frame.unresolved] == ["sign"]
    assert "NOT resolved" in str(frame.labels["parts"])


def test_a_report_ends_with_what_is_not_resolved(frame):
    head, line = report.unresolved(frame.unresolved, frame.paths)
    assert head.startswith("NOT resolved to 0.3 dB") and line.split()[0] == "sign" and "rays" in line


def test_a_report_of_no_path_does_not_call_it_resolved(frame):
    scene = ep.Scene()
    scene.add(shapes.plate(0.01, 0.01), name="chip", material="metal", position=(5.0, 0.0, 0.0), yaw=np.pi)
    missed = ep.trace(scene, frame.radar, num_rays=1)
    aside = ep.Scene()
    aside.add(shapes.plate(1.0, 1.0), name="m", material=ep.Material.metal(mirror=True), position=(5.0, 0, 0), yaw=0.75 * np.pi)
    behind = ep.trace(aside, frame.radar, num_rays=10)
    for paths, says in ((missed, "NOT resolved"), (behind, "no path leads back")):
        assert paths.num_paths == 0 and report.unresolved(ep.unresolved(paths), paths)[0].startswith(says)
    assert report.unresolved([], behind, LeftOut(1e-20, 3, 1e-19))[0].startswith("resolved")


def test_objects_that_are_labelled_and_not_detected_are_named(frame):
    found = frame.detections
    without = dataclasses.replace(found, object=np.where(found.object == "board", "", found.object))
    assert not any("not detected" in line and "board" in line for line in report.detections(found, frame.labels))
    (told,) = [line for line in report.detections(without, frame.labels, "--cfar os") if "not detected" in line]
    assert "board" in told and "--cfar os may find" in told


def test_tables_tell_the_level_of_the_cell_beside_its_place(frame):
    row = next(line for line in report.labels(frame.labels) if line.startswith("  board ") and "m/s" in line)
    peak = next(label.peak for label in frame.labels["parts"].objects if label.name == "board")
    assert f"{peak.range:6.2f} m {peak.velocity:+6.2f} m/s" in row
    assert f"{10.0 * np.log10(peak.power * 1e3):.1f} dBm" in row.partition("m/s")[2]


def test_files_carry_what_is_resolved(frame, tmp_path):
    ep.save_frame(frame, tmp_path / "frame.h5")
    again = ep.load_frame(tmp_path / "frame.h5")
    labels, before = again.labels["parts"], frame.labels["parts"]
    assert [label.received for label in labels.objects] == [label.received for label in before.objects]
    assert labels.part_received == before.part_received
    assert np.array_equal(again.detections.is_resolved, frame.detections.is_resolved)
    assert [str(one) for one in again.unresolved] == [str(one) for one in frame.unresolved]
    frame.detections.to_csv(tmp_path / "detections.csv")
    with open(tmp_path / "detections.csv", encoding="utf-8") as stream:
        told = [row["is_resolved"] for row in csv.DictReader(stream)]
    assert told == [str(int(known)) for known in frame.detections.is_resolved]


@pytest.mark.parametrize("name", ["labels/0/objects/received", "labels/0/ghosts/received", "detections/is_resolved",
                                  "scene/visible"])
def test_files_that_lack_what_every_file_has_are_refused_by_name(frame, tmp_path, name):
    ep.save_frame(frame, tmp_path / "frame.h5")
    with h5py.File(tmp_path / "frame.h5", "r+") as file:
        del file[name]
    with pytest.raises(ep.FileError, match=f"/{name}: no such dataset"):
        ep.load_frame(tmp_path / "frame.h5")


def test_what_is_not_known_of_labels_comes_back_so(frame, tmp_path):
    """Objects whose echoes only later records have, and cubes without selections."""
    before = frame.labels["parts"]
    objects = [dataclasses.replace(before.objects[0], received=None), *before.objects[1:]]
    ep.save_labels({"parts": dataclasses.replace(before, objects=objects, part_received=None)}, tmp_path / "labels.h5")
    after = ep.load_labels(tmp_path / "labels.h5")["parts"]
    assert [label.received for label in after.objects] == [label.received for label in objects]
    assert after.part_received is None and after.seed == before.seed


def test_groups_of_the_wrong_size_are_refused(frame):
    with pytest.raises(ValueError, match="group_of_path: must have one group for each path"):
        ep.received_powers(frame.paths, np.zeros(3, np.uint32), 1)
    with pytest.raises(ValueError, match="group_of_path: must be from 0 to 0, below num_groups, got 1 to 1"):
        ep.received_powers(frame.paths, np.ones(frame.paths.num_paths, np.uint32), 1)


@pytest.mark.usefixtures("blank_pictures")
def test_the_label_command_says_what_is_not_resolved(frame, tmp_path, capsys):
    """In the rows of its tables and in its last lines, by the names of the objects that it was asked for."""
    ep.save_frame(frame, tmp_path / "frame.h5")
    ask = ["labels", str(tmp_path / "frame.h5"), "--out", str(tmp_path / "out")]
    sign = next(label for label in frame.labels["parts"].objects if label.name == "sign")
    interval = f"below {10.0 * np.log10(1e3 * sign.received.high):.1f} dBm"
    for extra, name in (([], "sign"), (["--object", "metal=sign", "--object", "rough=board"], "metal")):
        assert main(ask + extra) == 0
        lines = capsys.readouterr().out.splitlines()
        assert [line.split()[0] for line in lines if line.endswith(interval)] == [name]
        end = lines.index("NOT resolved to 0.3 dB (95 % interval)")
        assert [line.split()[0] for line in lines[end + 1:]] == [name]


def test_what_a_record_leaves_out_is_not_called_unmet(frame):
    board = next(one for one in ep.unresolved(frame.paths.select("T 'sign' R")) if one.name == "board")
    assert "left out" in board.advice and board.interval.power == 0.0


@pytest.mark.parametrize("body, distance, has_advice", [(ep.actors.pedestrian, 10.0, False), (ep.actors.cyclist, 10.0, False),
                                                        (ep.actors.dog, 8.0, True)])
def test_no_number_of_rays_is_advised_that_leaves_echoes_in_doubt(body, distance, has_advice):
    """Of a body and its ghosts over a wall: echoes that 64,000 rays do not resolve are not said to take less."""
    scene = ep.Scene()
    scene.add(ep.actors.wall(40, 6), name="wall", material=ep.materials["concrete"].replace(mirror=True), position=(15, 3, 0))
    scene.add(body(), name="body", position=(distance, 0, 0), yaw=2.0)
    few, many = ({one.title: one for one in ep.unresolved(ep.trace(scene, build_radar([(0, 0, 1)], [(0, 0.01, 1)]),
                                                                   num_rays=num_rays, max_bounces=3))}
                 for num_rays in (2000, 64_000))
    found = {title: re.match("([0-9,]+) rays or more", one.advice) for title, one in few.items()}
    advised = [title for title, words in found.items() if words and int(words[1].replace(",", "")) <= 64_000]
    assert few and not set(advised) & set(many) and bool(advised) == has_advice


def test_ghosts_of_one_mirror_are_told_apart():
    scene = ep.Scene()
    scene.add(ep.actors.wall(30.0, 6.0), name="wall", material=ep.materials["concrete"].replace(mirror=True), position=(10, 4, 0))
    scene.add(ep.actors.sphere(0.3), name="body", smooth=True, material=ep.Material.metal(), position=(9, 0, 1))
    titles = [one.title for one in ep.unresolved(ep.trace(scene, build_radar(), num_rays=300, max_bounces=3))]
    assert "body via wall, type 1/2" in titles and "body via wall, type 2/2" in titles
    assert len(titles) == len(set(titles))


@pytest.mark.parametrize("angle_deg", [20.0, 52.0])
@pytest.mark.parametrize("num_rays, batches", [(3000, 1), (40_000, 4)])
def test_without_a_footprint_nothing_is_claimed_of_coherent_echoes(angle_deg, num_rays, batches):
    """A square plate seen askew sends back 4 pi (A cos / lambda)^2 sinc^2, far below the sum of its few rays."""
    angle, side, distance = np.radians(angle_deg), 1.0, 2000.0
    scene = ep.Scene()
    scene.add(ep.actors.plate(side, side), name="plate", material="metal", position=(distance, 0, 0), yaw=angle)
    radar = build_radar([(0, 0, 0)], [(0, 0, 0)])
    wavelength = ep.speed_of_light / radar.waveform.start_frequency
    section = 4 * np.pi * (side ** 2 * np.cos(angle) / wavelength * np.sinc(2 * side * np.sin(angle) / wavelength)) ** 2
    paths = ep.trace(scene, radar, num_rays=num_rays, footprint="none", batches=batches)
    found = ep.received_power(paths)
    assert "footprint" in ep.unresolved(paths)[0].advice
    assert found.low <= power_of(section, distance) <= found.high and not found.resolved


def test_rough_echoes_need_no_footprint():
    scene = ep.Scene()
    scene.add(ep.actors.plate(1, 1), name="rough", material=ep.Material(reflectivity=0.5, scattering=1.0), position=(9, 0, 0))
    assert ep.received_power(ep.trace(scene, build_radar(), num_rays=50_000, footprint="none")).resolved


@pytest.mark.parametrize("power, low, high, text", [
    (6e-30, 0.0, 2e-13, "below -97.0 dBm"), (0.0, 0.0, 2e-13, "no power yet, below -97.0 dBm"), (0.0, 0.0, 0.0, "nothing"),
    (1e-13, 0.0, 2e-13, "-100.0 dBm, below -97.0 dBm"), (1e-13, 5e-14, 2e-13, "-100.0 dBm, -103.0 to -97.0 dBm"),
    (1e-13, 1e-13, 1e-13, "-100.00 dBm")])
def test_intervals_in_words(power, low, high, text):
    """10 lg of W / mW, by hand."""
    assert str(ep.Interval(power, low, high)) == text


def test_labels_of_a_selection_say_nothing_of_what_it_leaves_out(frame):
    labels = ep.annotate(frame.paths.select("T 'sign' R"))
    board = next(label for label in labels.objects if label.name == "board")
    assert board.received is None and "NOT resolved" not in next(
        line for line in str(labels).splitlines() if line.startswith("object board"))


def test_an_echo_whose_power_is_next_to_nothing_is_named_as_others_are():
    """Wide cells fade the echo of a plate askew by any factor: to the smallest number that there is, before it is gone."""
    def paths_at(angle_deg):
        scene = ep.Scene()
        scene.add(ep.actors.plate(1, 1), name="plate", material="metal", position=(9, 0, 0), yaw=np.radians(angle_deg))
        return ep.trace(scene, build_radar([(0, 0, 0)], [(0, 0, 0)]), num_rays=30)

    low, high = 20.0, 30.0
    for _ in range(50):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if ep.received_power(paths_at(middle)).power > 0.0 else (low, middle)
    paths = paths_at(low)
    assert 0.0 < ep.received_power(paths).power < 3e-323
    assert [one.name for one in ep.unresolved(paths)] == ["plate"]


@pytest.mark.parametrize("below_db, above_db, resolved", [(0.29, 0.29, True), (0.35, 0.0, False), (0.0, 0.35, False)])
def test_a_power_is_resolved_that_is_known_to_three_tenths_of_a_decibel_on_either_side(below_db, above_db, resolved):
    interval = ep.Interval(2e-9, 2e-9 * 10.0 ** (-0.1 * below_db), 2e-9 * 10.0 ** (0.1 * above_db))
    assert interval.resolved is resolved


def test_two_thousand_objects_that_no_ray_met_are_told_in_a_fraction_of_a_second():
    """Each is looked up, and the lists of the scene, which take milliseconds here, are not made for it."""
    scene, plate = ep.Scene(), ep.actors.plate(1.0, 1.0)
    for k in range(2000):
        scene.add(plate, name=f"plate_{k}", material="metal", position=(500.0, 2.0 * (k % 40) - 40.0, 2.0 * (k // 40)), yaw=np.pi)
    paths = ep.trace(scene, build_radar(), num_rays=50_000, max_bounces=1).select("T 'plate_0' R")
    begin = time.process_time()
    unmet = [one for one in ep.unresolved(paths) if one.interval.power == 0.0]
    assert time.process_time() - begin < 1.5
    assert len(unmet) > 1800


@pytest.mark.parametrize("material, falls", [(ep.Material(reflectivity=0.5, scattering=1.0), 4.0), (ep.Material.metal(), 16.0)])
def test_what_rays_may_have_missed_is_three_cells_of_theirs_large(material, falls):
    """Four times the rays leave a quarter of the area, to which rough echoes go, and those of a mirror as its square."""
    scene = ep.Scene()
    scene.add(ep.actors.plate(3.0, 3.0), name="plate", material=material, position=(20, 0, 0), yaw=np.pi)
    radar = build_radar()
    highs = []
    for num_rays in (4000, 16000):
        paths = ep.trace(scene, radar, num_rays=num_rays, max_bounces=1)
        highs.append(Unmet(paths).interval(visibility_in_trace(paths, radar)[0]).high)
    assert highs[0] / highs[1] == pytest.approx(falls, rel=0.05)


def test_no_more_can_have_been_missed_than_a_mirror_without_end_sends():
    """By Friis over twice the distance, and the 36 m^2 that a rough plate of the size would have at most."""
    scene, distance = ep.Scene(), 20.0
    scene.add(ep.actors.plate(3.0, 3.0), name="plate", material=ep.Material.metal(), position=(distance, 0, 0), yaw=np.pi)
    radar = build_radar()
    paths = ep.trace(scene, radar, num_rays=100, max_bounces=1)
    high = Unmet(paths).interval(visibility_in_trace(paths, radar)[0]).high
    wavelength = ep.speed_of_light / radar.waveform.start_frequency
    of_mirror = radar.transmit_power * (wavelength / (4.0 * np.pi * 2.0 * distance)) ** 2
    assert of_mirror < high < of_mirror * (1.0 + 37.0 / (np.pi * distance ** 2))


@pytest.mark.parametrize("bias, chance, times", [(0.0, 0.5, 100.0), (10.0, 0.5, 200.0), (30.0, 0.25, 925.0), (0.5, 0.01, 2.0)])
def test_rays_that_resolve_a_power_mend_bias_and_chance_as_the_root_of_their_number(bias, chance, times):
    """Both over what a resolved power may have, 10^0.03 - 1 of it; twice the standard error counts."""
    wanted = 2e-9 * (10.0 ** 0.03 - 1.0)
    power = SimpleNamespace(power=2e-9, low=1e-9, bias_of_rays=bias * wanted, chance=10.0 * chance * wanted)
    assert _times_the_rays(power) == pytest.approx(times)
