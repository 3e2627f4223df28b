"""Datasets in the layouts of RadarScenes and ASAM OSI, read by their own tools as they are."""
import json
from types import SimpleNamespace

import numpy as np
import pytest

pytest.importorskip("radar_scenes", reason="radar_scenes, which bootstrap.sh installs, is not installed")
from radar_scenes.coordinate_transformation import transform_detections_sequence_to_car
from radar_scenes.labels import ClassificationLabel, Label
from radar_scenes.sequence import Sequence, get_training_sequences, get_validation_sequences
from scipy.spatial.transform import Rotation

from echopath import dataset
from echopath.dataset.exports import osi_ground_truth

RADIUS, EGO, SPEED = 0.5, 4.0, 3.0  # m of the sphere at rest, m/s of the radar, m/s of the walker's stand-in
PLACE = np.array([12.0, 3.0, 1.0])  # m, of the sphere
MIDDLE = 0.5 * (127 * 1e-4 + 255 / 12.5e6)  # s, between the first sample of a frame and its last
RANGE_CELL, VELOCITY_CELL = 0.15, 0.152  # m, m/s
TEMPLATE = f"""
[dataset]
scenes = 4
frames = 3
interval = 0.05
seed = 2
split = {{train = 0.5, val = 0.5}}
[dataset.classes]
"walker*" = "pedestrian"
[radar]
pattern = {{kind = "cosine_power", exponent = 4.0}}
noise_figure_db = 0.0
speed = {EGO}
position = [1.0, 0.0, 1.0]
[radar.waveform]
start_frequency = 77e9
bandwidth = 1e9
num_samples = 256
sampling_rate = 12.5e6
num_chirps = 128
chirp_interval = 1e-4
[[radar.transmitters]]
position = [0.0, 0.0, 0.0]
""" + "".join(f"[[radar.receivers]]\nposition = [0.0, {0.00195 * k:.5f}, 0.0]\n" for k in range(8)) + f"""
[[objects]]
name = "ball"
actor = "sphere"
parameters = {{radius = {RADIUS}}}
material = "metal"
smooth = true
position = {PLACE.tolist()}
[[objects]]
name = "walker"
actor = "sphere"
parameters = {{radius = 0.3}}
material = "metal"
smooth = true
position = [9.0, -2.5, 1.0]
yaw_deg = 0.0
speed = {SPEED}
[trace]
num_rays = 3000
[detections]
[labels]
[truth]
[spectrum]
window = "hann"
"""


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    folder = tmp_path_factory.mktemp("radar_scenes")
    (folder / "balls.toml").write_text(TEMPLATE)
    list(dataset.make(folder / "balls.toml", folder / "made"))
    dataset.write_radar_scenes(dataset.open(folder / "made"), folder / "out")
    return folder


def sequences_of(folder) -> list:
    return [Sequence.from_json(str(path)) for path in sorted((folder / "out" / "data").glob("sequence_*/scenes.json"))]


def test_their_reader_finds_every_frame_and_both_splits(written):
    made = dataset.open(written / "made")
    assert [len(one) for one in sequences_of(written)] == [3] * 4
    names = str(written / "out" / "data" / "sequences.json")
    splits = {"train": get_training_sequences(names), "val": get_validation_sequences(names)}
    assert {split: len(found) for split, found in splits.items()} == {split: len(made.split(split)) // 3 for split in splits}
    for one in sequences_of(written):
        times = [scene.timestamp for scene in one.scenes()]
        assert times == one.timestamps == [scene.timestamp for scene in one.scenes(sensor_id=1)]
        assert np.diff(times).tolist() == [50_000, 50_000]


def test_points_are_where_the_targets_are(written):
    for scene in (scene for one in sequences_of(written) for scene in one.scenes()):
        time = scene.timestamp / 1e6
        assert scene.odometry_data["x_seq"] == pytest.approx(1.0 + EGO * time, abs=1e-5)
        assert scene.odometry_data["vx"] == pytest.approx(EGO, rel=1e-6) and abs(scene.odometry_data["yaw_rate"]) < 1e-6
        points = scene.radar_data[scene.radar_data["label_id"] == Label.STATIC.value]
        ball = points[np.argmax(points["rcs"])]
        way = PLACE[:2] - [1.0 + EGO * time, 0.0136 / 4]
        nearest = np.hypot(*way) - RADIUS  # the echo comes from the surface
        assert abs(ball["range_sc"] - nearest) < 0.5 * RANGE_CELL
        assert ball["azimuth_sc"] == pytest.approx(np.arctan2(way[1], way[0]), abs=0.03)
        assert np.hypot(ball["x_seq"] - PLACE[0], ball["y_seq"] - PLACE[1]) == pytest.approx(RADIUS, abs=0.4)
        x, y = transform_detections_sequence_to_car(points["x_seq"], points["y_seq"], scene.odometry_data)
        np.testing.assert_allclose(np.stack([x, y]), np.stack([points["x_cc"], points["y_cc"]]), atol=1e-5)


def test_velocities_and_cross_sections_are_those_of_the_targets(written):
    for scene in (scene for one in sequences_of(written) for scene in one.scenes()):
        points = scene.radar_data
        ball = points[np.argmax(np.where(points["label_id"] == Label.STATIC.value, points["rcs"], -99.0))]
        assert abs(ball["vr_compensated"]) < 0.5 * VELOCITY_CELL
        assert ball["vr"] == pytest.approx(-EGO * np.cos(ball["azimuth_sc"]), abs=0.5 * VELOCITY_CELL)
        assert ball["rcs"] == pytest.approx(10.0 * np.log10(np.pi * RADIUS**2), abs=1.5)  # cells of a Hann window lose up to 1.4
        walker = points[points["label_id"] == Label.PEDESTRIAN.value][0]
        assert walker["vr_compensated"] == pytest.approx(SPEED * np.cos(walker["azimuth_sc"]), abs=VELOCITY_CELL)
        assert walker["ghost_label"] == 1111 and ball["ghost_label"] in (0, 111)
        assert ClassificationLabel.label_to_clabel(int(walker["label_id"])) == ClassificationLabel.PEDESTRIAN


def test_what_stands_stands_for_radars_beyond_their_unambiguous_speed(tmp_path):
    """At 15 m/s a radar of +-9.7 m/s sees what stands ahead recede at 4.4 m/s."""
    speed, unambiguous = 15.0, 299792458.0 / 77e9 / 4e-4
    (tmp_path / "fast.toml").write_text(TEMPLATE.replace("scenes = 4", "scenes = 1").replace("frames = 3", "frames = 1").replace(
        f"speed = {EGO}\n", f"speed = {speed}\n", 1))
    list(dataset.make(tmp_path / "fast.toml", tmp_path / "made"))
    dataset.write_radar_scenes(dataset.open(tmp_path / "made"), tmp_path / "out")
    scene, = sequences_of(tmp_path)[0].scenes()
    points = scene.radar_data[scene.radar_data["label_id"] == Label.STATIC.value]
    ball = points[np.argmax(points["rcs"])]
    assert ball["vr"] == pytest.approx(2.0 * unambiguous - speed * np.cos(ball["azimuth_sc"]), abs=VELOCITY_CELL)
    assert abs(ball["vr_compensated"]) < VELOCITY_CELL


def test_folds_tell_who_comes_towards_a_fast_radar(tmp_path):
    """Three transmitters in turns see +-13 m/s: at 20 m/s, what comes with 15 m/s had been given away as 11 m/s the other way."""
    speed, oncoming = 20.0, 15.0
    antennas = "".join(f"[[radar.transmitters]]\nposition = [0.0, {-0.0156 * k:.4f}, 0.0]\n" for k in (1, 2))
    text = TEMPLATE.replace("scenes = 4", "scenes = 1").replace("frames = 3", "frames = 1").replace(
        f"speed = {EGO}\n", f"speed = {speed}\n", 1).replace("[[radar.receivers]]", antennas + "[[radar.receivers]]", 1)
    text = text.replace("chirp_interval = 1e-4", "chirp_interval = 2.5e-5").replace("[detections]\n", "[detections]\nfolds = 1\n")
    text = text.replace(f"yaw_deg = 0.0\nspeed = {SPEED}", f"yaw_deg = 180.0\nspeed = {oncoming}")
    (tmp_path / "oncoming.toml").write_text(text)
    list(dataset.make(tmp_path / "oncoming.toml", tmp_path / "made"))
    dataset.write_radar_scenes(dataset.open(tmp_path / "made"), tmp_path / "out")
    points = sequences_of(tmp_path)[0].radar_data
    walker = points[points["label_id"] == Label.PEDESTRIAN.value][0]
    assert walker["vr"] == pytest.approx(-(speed + oncoming) * np.cos(walker["azimuth_sc"]), abs=0.6)
    assert walker["vr_compensated"] == pytest.approx(-oncoming * np.cos(walker["azimuth_sc"]), abs=0.6)
    ball = points[np.argmax(np.where(points["label_id"] == Label.STATIC.value, points["rcs"], -99.0))]
    assert abs(ball["vr_compensated"]) < 0.6


def test_leakage_at_the_antennas_is_told_like_what_stands(tmp_path):
    """Noise puts leakage at 0 m in about every other frame, here at the place of the transmitter amid its receivers."""
    leakage = f"[radar.receiver]\nleakage_db = [{[-90.0] * 8}]\n"
    text = TEMPLATE.replace("frames = 3", "frames = 1").replace("num_rays = 3000", "num_rays = 100").replace(
        "[radar.waveform]", leakage + "[radar.waveform]")
    for k in range(8):
        text = text.replace(f"position = [0.0, {0.00195 * k:.5f}, 0.0]", f"position = [0.0, {0.00195 * (k - 3.5):.6f}, 0.0]")
    (tmp_path / "leaking.toml").write_text(text)
    list(dataset.make(tmp_path / "leaking.toml", tmp_path / "made"))
    dataset.write_radar_scenes(dataset.open(tmp_path / "made"), tmp_path / "out")
    points = np.concatenate([one.radar_data for one in sequences_of(tmp_path)])
    leaked = points[points["range_sc"] == 0.0]
    assert len(leaked) and not np.isfinite(leaked["rcs"]).any()
    assert leaked["vr_compensated"] == pytest.approx(EGO * np.cos(leaked["azimuth_sc"]), abs=1e-2)  # it goes along


def test_tracks_last_over_the_frames_of_a_scene_alone(written):
    tracks = [{point["track_id"] for point in one.radar_data if point["label_id"] == Label.PEDESTRIAN.value}
              for one in sequences_of(written)]
    assert all(len(found) == 1 for found in tracks) and len(set.union(*tracks)) == 4
    data = sequences_of(written)[0].radar_data
    assert len(set(data["uuid"])) == len(data)
    assert set(data["track_id"][data["label_id"] == Label.STATIC.value]) == {b""}


def test_odometry_tells_all_of_the_motion_of_a_radar_that_looks_aside(tmp_path):
    """Radial velocities of what stands follow from it, as those of a car do from its speed."""
    yaw = np.radians(20.0)
    (tmp_path / "aside.toml").write_text(TEMPLATE.replace("scenes = 4", "scenes = 1").replace("frames = 3", "frames = 1").replace(
        f"speed = {EGO}\n", f"motion = {{kind = 'linear', velocity = [{EGO}, 0.0, 0.0]}}\nyaw_deg = 20.0\n", 1))
    list(dataset.make(tmp_path / "aside.toml", tmp_path / "made"))
    dataset.write_radar_scenes(dataset.open(tmp_path / "made"), tmp_path / "out")
    scene, = sequences_of(tmp_path)[0].scenes()
    pose, points = scene.odometry_data, scene.radar_data
    assert [pose["vx"], pose["vy"], pose["yaw_seq"]] == pytest.approx([EGO * np.cos(yaw), -EGO * np.sin(yaw), yaw], abs=1e-6)
    own = -pose["vx"] * np.cos(points["azimuth_sc"]) - pose["vy"] * np.sin(points["azimuth_sc"])
    np.testing.assert_allclose(points["vr"] - own, points["vr_compensated"], atol=1e-4)


TURN, AHEAD, LEFT = 0.6, 2.3, 0.4  # rad/s of a radar that turns; m, of its antennas in its frame


def test_antennas_at_the_bumper_of_a_turning_car_are_told(tmp_path):
    """Whoever goes from the car to the sensor and from there by range and azimuth gets to the ball, in both layouts."""
    reader = pytest.importorskip("osi3trace.osi_trace")
    motion = f"motion = {{kind = 'linear', velocity = [{EGO}, 0.0, 0.0], angular_velocity = [0.0, 0.0, {TURN}]}}"
    text = TEMPLATE.replace("scenes = 4", "scenes = 1").replace(f"speed = {EGO}\n", f"{motion}\n", 1)
    for k in range(8):
        text = text.replace(f"position = [0.0, {0.00195 * k:.5f}, 0.0]", f"position = [{AHEAD}, {LEFT + 0.00195 * k:.5f}, 0.0]")
    text = text.replace("position = [0.0, 0.0, 0.0]", f"position = [{AHEAD}, {LEFT}, 0.0]")
    (tmp_path / "turning.toml").write_text(text)
    list(dataset.make(tmp_path / "turning.toml", tmp_path / "made"))
    made = dataset.open(tmp_path / "made")
    dataset.write_radar_scenes(made, tmp_path / "out")
    sensor = json.loads((tmp_path / "out" / "data" / "sensors.json").read_text())["radar_1"]
    assert [sensor["x"], sensor["y"]] == pytest.approx([AHEAD, LEFT + 0.0136 / 4], abs=1e-4)
    one, = sequences_of(tmp_path)
    for scene in one.scenes():
        points, pose = scene.radar_data[scene.radar_data["label_id"] == Label.STATIC.value], scene.odometry_data
        ball, time = points[np.argmax(points["rcs"])], scene.timestamp / 1e6
        yaw, mount = TURN * time, sensor["x"] + 1j * sensor["y"]
        place = 1.0 + EGO * time + mount * np.exp(1j * yaw)
        way = PLACE[0] + 1j * PLACE[1] - place
        assert ball["range_sc"] == pytest.approx(abs(way) - RADIUS, abs=0.5 * RANGE_CELL)
        assert ball["azimuth_sc"] == pytest.approx(np.angle(way) - yaw, abs=0.03)
        in_car = mount + ball["range_sc"] * np.exp(1j * ball["azimuth_sc"])
        assert [ball["x_cc"], ball["y_cc"]] == pytest.approx([in_car.real, in_car.imag], abs=1e-4)
        assert [pose["vx"], pose["yaw_rate"]] == pytest.approx([EGO * np.cos(yaw), TURN], abs=1e-5)
        assert abs(ball["vr_compensated"]) < 0.5 * VELOCITY_CELL
    dataset.write_osi(made, tmp_path / "osi")
    trace, = (tmp_path / "osi" / "traces").iterdir()
    for message in reader.OSITrace(str(trace), "SensorData"):
        (radar,), (view,) = message.feature_data.radar_sensor, message.sensor_view
        mount, (host, _) = radar.header.mounting_position, view.global_ground_truth.moving_object
        assert host.id.value == view.host_vehicle_id.value and mount == message.mounting_position == view.mounting_position
        assert [mount.position.x, mount.position.y] == pytest.approx([AHEAD, LEFT + 0.0136 / 4], abs=1e-4)
        assert mount.orientation.yaw == mount.orientation.pitch == mount.orientation.roll == 0.0
        assert [host.base.velocity.x, host.base.velocity.y] == pytest.approx([EGO, 0.0], abs=1e-5)
        assert host.base.orientation_rate.yaw == pytest.approx(TURN, abs=1e-5)
        ball, turn = max(radar.detection, key=lambda one: one.rcs), host.base.orientation.yaw
        own = mount.position.x + 1j * mount.position.y
        way = ball.position.distance * np.exp(1j * (ball.position.azimuth + turn))
        place = host.base.position.x + 1j * host.base.position.y + own * np.exp(1j * turn) + way
        assert abs(place - (PLACE[0] + 1j * PLACE[1])) == pytest.approx(RADIUS, abs=0.4)
        velocity = EGO + 1j * TURN * own * np.exp(1j * turn)  # of the antennas, towards the ball: approaching is positive
        nearing = (velocity * np.conj(way)).real / abs(way)
        assert nearing > 1.0 and ball.radial_velocity == pytest.approx(nearing, abs=0.5 * VELOCITY_CELL)


def test_angles_of_osi_turn_as_they_are_told():
    """Rates of yaw, pitch and roll of a body that turns about an inclined axis, against differences of its angles."""
    messages = pytest.importorskip("osi3.osi_object_pb2")
    axis, step = np.array([0.3, -0.5, 0.7]), 1e-5  # rad/s, s

    def told(time: float):
        host = messages.MovingObject()
        start = Rotation.from_euler("ZYX", [0.4, -0.6, 0.2])
        turned = lambda at: np.pad((Rotation.from_rotvec(axis * at) * start).as_matrix(), (0, 1))
        radar = SimpleNamespace(world_from_radar=turned, motion=None, frame_duration=1e-2)
        osi_ground_truth.set_host(host, radar, time)
        angles, rates = host.base.orientation, host.base.orientation_rate
        return (np.array([one.yaw, one.pitch, one.roll]) for one in (angles, rates))

    (before, _), (angles, rates), (after, _) = (told(at) for at in (-step, 0.0, step))
    np.testing.assert_allclose(angles, [0.4, -0.6, 0.2], atol=1e-12)
    np.testing.assert_allclose(rates, (after - before) / (2.0 * step), atol=1e-6)


def test_sensors_are_as_many_as_places_of_antennas(tmp_path):
    text = TEMPLATE.replace("position = [0.0, 0.0, 0.0]", "position = [{choice = [0.0, 1.0]}, 0.0, 0.0]", 1)
    (tmp_path / "drawn.toml").write_text(text.replace("frames = 3", "frames = 1"))
    list(dataset.make(tmp_path / "drawn.toml", tmp_path / "made"))
    dataset.write_radar_scenes(dataset.open(tmp_path / "made"), tmp_path / "out")
    sensors = json.loads((tmp_path / "out" / "data" / "sensors.json").read_text())
    assert sorted(one["x"] for one in sensors.values()) == [0.0, 0.5]  # half-way to the receivers
    for one in sequences_of(tmp_path):
        points = one.radar_data
        sensor = sensors[f"radar_{points['sensor_id'][0]}"]
        way = sensor["x"] + points["range_sc"] * np.cos(points["azimuth_sc"])
        assert len(points) and len(set(points["sensor_id"])) == 1
        np.testing.assert_allclose(points["x_cc"], way, atol=1e-5)


def test_clutter_is_static_or_left_out(tmp_path):
    """Thresholds just above the noise have it detected: what is left out is all of it, and nothing else."""
    (tmp_path / "noisy.toml").write_text(TEMPLATE.replace("scenes = 4", "scenes = 1").replace(
        "[detections]\n", "[detections]\nfalse_alarm_rate = 1e-3\n"))
    list(dataset.make(tmp_path / "noisy.toml", tmp_path / "made"))
    made = dataset.open(tmp_path / "made")
    for clutter in ("static", "omit"):
        dataset.write_radar_scenes(made, tmp_path / clutter, clutter=clutter)
    everything, echoes = (Sequence.from_json(str(tmp_path / clutter / "data" / "sequence_1" / "scenes.json"))
                          for clutter in ("static", "omit"))
    is_noise = np.concatenate([one.frame.detections.is_noise for one in made])
    assert 0 < is_noise.sum() < len(is_noise) == len(everything.radar_data)
    assert set(everything.radar_data["label_id"][is_noise]) == {Label.STATIC.value}
    np.testing.assert_array_equal(echoes.radar_data, everything.radar_data[~is_noise])
    kept = [len(scene.radar_data) for scene in echoes.scenes()]
    assert kept == [np.count_nonzero(~one.frame.detections.is_noise) for one in made]
    with pytest.raises(ValueError, match="^clutter: must be"):
        dataset.write_radar_scenes(made, tmp_path / "other", clutter="noise")


def test_a_dataset_without_detections_is_refused(written, tmp_path):
    (tmp_path / "plain.toml").write_text(TEMPLATE.replace("[detections]\n", "").replace("scenes = 4", "scenes = 1"))
    list(dataset.make(tmp_path / "plain.toml", tmp_path / "made"))
    with pytest.raises(ValueError, match=r"dataset: must be of a template with \[detections\]"):
        dataset.write_radar_scenes(dataset.open(tmp_path / "made"), tmp_path / "out")
    assert json.loads((written / "out" / "data" / "sensors.json").read_text())["radar_1"]["x"] == 0.0
    with pytest.raises(TypeError, match="dataset: must be a Dataset"):
        dataset.write_radar_scenes("made", tmp_path)


def test_traces_of_osi_are_read_by_its_own_tool(written):
    reader = pytest.importorskip("osi3trace.osi_trace")
    dataset.write_osi(dataset.open(written / "made"), written / "osi")
    paths = sorted((written / "osi" / "traces").glob("19700101T000000Z_sd_*_3_scene_*.osi"))
    assert len(paths) == 4
    for path in paths:
        messages = list(reader.OSITrace(str(path), "SensorData"))
        assert [one.timestamp.seconds + 1e-9 * one.timestamp.nanos for one in messages] == pytest.approx(
            [0.05 * place + MIDDLE for place in range(3)], abs=1e-9)
        for place, one in enumerate(messages):
            _check_message(place, one)
    with pytest.raises(ValueError, match="folder: must be one that has no folder 'traces' yet"):
        dataset.write_osi(dataset.open(written / "made"), written / "osi")


@pytest.mark.parametrize("pitch", [90.0, -90.0, 89.9])
def test_what_looks_straight_down_or_up_has_angles_of_its_axes(pitch):
    """Yaw and roll are then turns about one axis, of which a radar on a ceiling has rounding alone to tell them apart."""
    messages = pytest.importorskip("osi3.osi_object_pb2")
    pose, host = np.eye(4), messages.MovingObject()
    pose[:3, :3] = Rotation.from_euler("ZYX", [20.0, pitch, 50.0], degrees=True).as_matrix()
    osi_ground_truth.set_pose(host.base, pose)
    told = host.base.orientation
    turned = Rotation.from_euler("ZYX", [told.yaw, told.pitch, told.roll]).as_matrix()
    np.testing.assert_allclose(turned, pose[:3, :3], atol=1e-9)


def _check_message(place: int, message) -> None:
    """The balls are where they are, and echoes of the walker's stand-in name it."""
    radar, = message.feature_data.radar_sensor
    time = 0.05 * place + MIDDLE
    is_valid = [one.classification != 2 for one in radar.detection]  # CLASSIFICATION_INVALID
    assert radar.header.cycle_counter == place and radar.header.number_of_valid_detections == sum(is_valid) > 1
    mount = radar.header.mounting_position.position
    assert [mount.x, mount.y, mount.z] == pytest.approx([0.0, 0.0136 / 4, 0.0], abs=2e-5)
    ball = max((one for one in radar.detection if one.object_id.value == 2 ** 64 - 1), key=lambda one: one.rcs)
    way = PLACE[:2] - [1.0 + EGO * time, 0.0136 / 4]
    assert ball.position.distance == pytest.approx(np.hypot(*way) - RADIUS, abs=0.5 * RANGE_CELL)
    assert ball.position.azimuth == pytest.approx(np.arctan2(way[1], way[0]), abs=0.03)
    assert ball.radial_velocity == pytest.approx(EGO * np.cos(ball.position.azimuth), abs=0.5 * VELOCITY_CELL)
    assert ball.rcs == pytest.approx(10.0 * np.log10(np.pi * RADIUS**2), abs=1.5) and ball.snr > 10.0
    walker = [one for one in radar.detection if one.object_id.value == 1]  # the second object of the template
    assert walker and all(one.existence_probability == 1.0 for one in walker)
    assert {one.classification for one in walker} <= {1, 2}  # other, invalid: a ghost
    host, told = message.sensor_view[0].global_ground_truth.moving_object
    assert list(told.source_reference[0].identifier) == ["walker"] and told.id.value == 1
    assert host.id.value != 1 and told.type == told.TYPE_PEDESTRIAN
    for base, place, velocity in ((host.base, [1.0 + EGO * time, 0.0, 1.0], EGO),
                                  (told.base, [9.0 + SPEED * time, -2.5, 1.0], SPEED)):
        assert [base.position.x, base.position.y, base.position.z] == pytest.approx(place, abs=1e-5)
        assert [base.velocity.x, base.velocity.y, base.velocity.z] == pytest.approx([velocity, 0.0, 0.0], abs=1e-5)
        assert [base.orientation.yaw, base.orientation.pitch, base.orientation.roll] == pytest.approx([0.0] * 3, abs=1e-9)
    assert [told.base.dimension.length, told.base.dimension.height] == pytest.approx([0.6, 0.6], abs=0.01)
