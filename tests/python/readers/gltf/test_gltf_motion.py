"""Animations of glTF files against the formulas of the specification: nodes, loops, faults."""
import numpy as np
import pytest

import echopath as ep
from support.files.gltf_files import BOX, BOX_SIDES, box_file, loaded, rig_file
from support.files.gltf_loaded import TO_SCENE, morph_file, rotated, scene_of, vertices_at

SINGLE = 2e-6
KEYS = np.array([0.5, 1.0, 2.0], np.float32)


def hermite(t, step, v0, b0, v1, a1):
    """glTF 2.0, appendix C.5, word for word."""
    return (2 * t**3 - 3 * t**2 + 1) * v0 + step * (t**3 - 2 * t**2 + t) * b0 + (-2 * t**3 + 3 * t**2) * v1 + \
        step * (t**3 - t**2) * a1


def slerp(t, q0, q1):
    """Appendix C.4."""
    d = np.dot(q0, q1)
    a, s = np.arccos(abs(d)), np.sign(d)
    return np.sin(a * (1 - t)) / np.sin(a) * q0 + s * np.sin(a * t) / np.sin(a) * q1


PLACES = np.array([[0, 0, 0], [1, 2, 3], [-1, 0, 5]], np.float32)
TANGENTS = np.array([[1, 0, 2], [0, 3, 0], [4, -1, 0], [2, 2, 2], [0, 0, 1], [1, 1, 1]], np.float32)


@pytest.mark.parametrize("interpolation,at_a_quarter", [
    ("STEP", PLACES[1]), ("LINEAR", 0.75 * PLACES[1] + 0.25 * PLACES[2]),
    ("CUBICSPLINE", hermite(0.25, 1.0, PLACES[1], TANGENTS[3], PLACES[2], TANGENTS[4]))])
def test_translations_follow_the_specification(tmp_path, interpolation, at_a_quarter):
    values = PLACES
    if interpolation == "CUBICSPLINE":
        values = np.stack([TANGENTS[0::2], PLACES, TANGENTS[1::2]], axis=1).reshape(9, 3)
    file = box_file(translation=[7, 7, 7])
    file.animation((0, "translation", KEYS, values, interpolation))
    scene = scene_of(loaded(tmp_path, file))
    for time, wanted in ((-3.0, PLACES[0]), (0.5, PLACES[0]), (1.25, at_a_quarter), (2.0, PLACES[2]), (99.0, PLACES[2])):
        assert np.abs(vertices_at(scene, time)["box"] - (BOX + wanted)[:, TO_SCENE]).max() < SINGLE


def pointed_at(file, pointer: str):
    """The file, its one channel moving what a pointer names (KHR_animation_pointer)."""
    file.json["extensionsRequired"] = file.json["extensionsUsed"] = ["KHR_animation_pointer"]
    file.json["animations"][0]["channels"][0]["target"] = {
        "path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": pointer}}}
    return file


@pytest.mark.parametrize("path, moved", [("translation", BOX + PLACES[1]), ("scale", BOX * PLACES[1])])
def test_a_pointer_to_a_node_moves_it_as_a_channel_of_the_node_does(tmp_path, path, moved):
    file = box_file()
    file.animation((0, path, KEYS, PLACES, "LINEAR"))
    model = loaded(tmp_path, pointed_at(file, f"/nodes/0/{path}"))
    assert model.duration == 2.0 and not any("animation" in note for note in model.notes)
    assert np.abs(vertices_at(scene_of(model), 1.0)["box"] - moved[:, TO_SCENE]).max() < SINGLE


def test_a_pointer_to_what_is_no_node_is_told(tmp_path):
    file = box_file()
    file.animation((0, "translation", KEYS, PLACES, "LINEAR"))
    for pointer in ("/materials/0/emissiveFactor", "/nodes/0/extensions/KHR_node_visibility/visible"):
        model = loaded(tmp_path, pointed_at(file, pointer))
        assert ("what animations move by KHR_animation_pointer stays at rest, but for nodes and weights of their meshes"
                in model.notes)
        assert (vertices_at(scene_of(model), 1.0)["box"] == BOX[:, TO_SCENE]).all()
    for number in ("1", "x", 5000 * "9"):
        with pytest.raises(ep.FileError, match=r"channels\[0\].*pointer: must be a whole number from 0 to 0, is"):
            loaded(tmp_path, pointed_at(file, f"/nodes/{number}/scale"))


QUARTERS = np.array([[0, 0, 0, 1], [0.5, 0.5, 0.5, 0.5], [0, -0.6, 0, -0.8]], np.float32)


@pytest.mark.parametrize("interpolation", ["STEP", "LINEAR", "CUBICSPLINE"])
def test_rotations_follow_the_specification(tmp_path, interpolation):
    tangents = np.random.default_rng(2).normal(size=(6, 4)).astype(np.float32)
    values = QUARTERS
    if interpolation == "CUBICSPLINE":
        values = np.stack([tangents[0::2], QUARTERS, tangents[1::2]], axis=1).reshape(9, 4)
    wanted = {"STEP": QUARTERS[1], "LINEAR": slerp(0.25, QUARTERS[1].astype(float), QUARTERS[2].astype(float)),
              "CUBICSPLINE": hermite(0.25, 1.0, QUARTERS[1], tangents[3], QUARTERS[2], tangents[4])}[interpolation]
    file = box_file(translation=[1, 2, 3], rotation=[0, 0, 0.6, 0.8], scale=[1, 2, 0.5])
    file.animation((0, "rotation", KEYS, values, interpolation))
    scene = scene_of(loaded(tmp_path, file))
    points = rotated(np.asarray(wanted, float), BOX * [1, 2, 0.5]) + [1, 2, 3]
    assert np.abs(vertices_at(scene, 1.25)["box"] - points[:, TO_SCENE]).max() < 3 * SINGLE


def test_rest_is_where_the_file_has_it_and_motion_is_relative_to_it(tmp_path):
    file = box_file(translation=[1, 2, 3])
    file.animation((0, "translation", KEYS, PLACES, "LINEAR"))
    at_rest = loaded(tmp_path, file, animation="")
    assert at_rest.nodes[0].motion is None and at_rest.animation is None and at_rest.animations == ("animation_0",)
    scene = scene_of(loaded(tmp_path, file))
    assert scene["m/box"].position == pytest.approx([3, 1, 2])
    scene["m/box"].motion = None
    assert np.array_equal(vertices_at(scene, 0.0)["box"], vertices_at(scene_of(at_rest), 0.0)["box"])


def test_a_single_key_turns_a_node_where_it_stands(tmp_path):
    """Which is no motion, but another place at rest than that of the file."""
    file = box_file(translation=[1, 2, 3])
    file.animation((0, "rotation", KEYS[:1], QUARTERS[1:2], "LINEAR"))
    model = loaded(tmp_path, file)
    assert model.nodes[0].motion is None
    wanted = rotated(QUARTERS[1], BOX) + [1, 2, 3]
    assert np.abs(vertices_at(scene_of(model), 1.0)["box"] - wanted[:, TO_SCENE]).max() < SINGLE


def test_an_animation_lasts_as_long_as_its_longest_channel_and_the_last_of_keys_at_one_time_counts(tmp_path):
    file = box_file()
    twice = np.array([0.5, 1.0, 1.0, 2.0], np.float32)
    file.animation((0, "scale", KEYS[:2], np.ones((2, 3), np.float32), "LINEAR"),
                   (0, "translation", twice, PLACES[[0, 0, 1, 2]], "LINEAR"))
    model = loaded(tmp_path, file)
    assert model.duration == 2.0 and "of keys at the same time the last one counts" in model.notes
    for time, wanted in ((1.0, PLACES[1]), (1.5, 0.5 * (PLACES[1] + PLACES[2])), (2.0, PLACES[2])):
        assert np.abs(vertices_at(scene_of(model), time)["box"] - (BOX + wanted)[:, TO_SCENE]).max() < SINGLE


def test_units_are_those_of_places_and_not_of_scales(tmp_path):
    """Two metres a unit: of the box, of how a node moves and of a matrix, while twice as large is twice as large."""
    file = box_file()
    file.animation((0, "scale", KEYS, PLACES, "LINEAR"), (0, "translation", KEYS, PLACES, "LINEAR"))
    wanted = 2.0 * (BOX * PLACES[1] + PLACES[1])
    assert np.abs(vertices_at(scene_of(loaded(tmp_path, file, unit=2.0)), 1.0)["box"] - wanted[:, TO_SCENE]).max() < SINGLE
    placed = box_file(matrix=[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 3, 4, 5, 1])
    wanted = 2.0 * (BOX + [3, 4, 5])
    assert np.abs(vertices_at(scene_of(loaded(tmp_path, placed, unit=2.0)), 0.0)["box"] - wanted[:, TO_SCENE]).max() < SINGLE


def test_a_node_that_a_matrix_mirrors_moves_mirrored(tmp_path):
    """x to the other side and z twice as long, wherever it goes."""
    file = box_file(matrix=[-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 2, 0, 7, 7, 7, 1])
    file.animation((0, "translation", KEYS, PLACES, "LINEAR"))
    wanted = BOX * [-1, 1, 2] + PLACES[1]
    assert np.abs(vertices_at(scene_of(loaded(tmp_path, file)), 1.0)["box"] - wanted[:, TO_SCENE]).max() < SINGLE


def test_animations_go_by_name_with_loop_and_offset(tmp_path):
    file = box_file()
    file.animation((0, "translation", [0, 2], [[0, 0, 0], [4, 0, 0]], "LINEAR"), name="slide")
    file.animation((0, "translation", [0, 1], [[0, 0, 0], [0, 0, 5]], "LINEAR"), name="rise")
    middle = lambda time, **options: vertices_at(scene_of(loaded(tmp_path, file, **options)), time)["box"].mean(axis=0)
    assert middle(1.0) == pytest.approx([0, 2, 0])
    assert middle(0.5, animation="rise") == pytest.approx([2.5, 0, 0])
    assert middle(7.0) == pytest.approx([0, 4, 0])
    assert middle(7.0, loop=True) == pytest.approx([0, 2, 0])
    assert middle(7.0, loop=True, offset=0.5) == pytest.approx([0, 3, 0])
    assert middle(0.0, offset=1.5) == pytest.approx([0, 3, 0])
    model = loaded(tmp_path, file, animation="rise")
    assert (model.animations, model.animation, model.duration) == (("slide", "rise"), "rise", 1.0)
    with pytest.raises(ValueError, match="animation: must be 'slide' or 'rise', got 'walk'"):
        loaded(tmp_path, file, animation="walk")


@pytest.mark.parametrize("offset", [0.0, 0.35, -7.0])
def test_a_loop_begins_anew_with_its_first_key(tmp_path, offset):
    """As that of a timeline whose first frame is 1: what waits for that key would stand still in every run."""
    file = box_file()
    file.animation((0, "translation", KEYS, PLACES, "LINEAR"), (0, "rotation", KEYS[1:2], QUARTERS[:1], "LINEAR"))
    model = loaded(tmp_path, file, loop=True, offset=offset)
    scene, period = scene_of(model), KEYS[-1] - KEYS[0]
    assert model.duration == period
    for time in (0.0, 0.3, 0.6, 1.4, 1.6, 7.9, -3.2):
        place = [np.interp(KEYS[0] + (time + offset - KEYS[0]) % period, KEYS, axis) for axis in PLACES.T]
        assert np.abs(vertices_at(scene, time)["box"] - (BOX + place)[:, TO_SCENE]).max() < SINGLE, time


def test_a_scale_that_moves_scales_what_is_below_it(tmp_path):
    file = box_file()
    file.json["nodes"].append({"name": "carrier", "children": [0], "translation": [0, 1, 0]})
    file.json["scenes"][0]["nodes"] = [1]
    file.animation((1, "scale", [0, 1, 2], [[1, 1, 1], [2, 3, 4], [0, 0, 0]], "LINEAR"))
    scene = scene_of(loaded(tmp_path, file))
    assert [mesh.name for mesh in scene.meshes] == ["m/box"]
    for time, scale in ((0.0, [1, 1, 1]), (0.5, [1.5, 2, 2.5]), (2.0, [0, 0, 0])):
        assert np.abs(vertices_at(scene, time)["box"] - (BOX * scale + [0, 1, 0])[:, TO_SCENE]).max() < SINGLE


@pytest.mark.parametrize("rest", [[0, 0, 0], [1, 0, 1], [0, 2, 0]])
@pytest.mark.parametrize("options", [{}, {"loop": True, "offset": 0.25}])
def test_what_rests_scaled_to_nothing_has_all_faces_once_it_grows(tmp_path, rest, options):
    file = box_file(scale=rest)
    file.animation((0, "scale", [0, 1, 2], [rest, [1, 1, 1], [2, 3, 4]], "LINEAR"))
    scene = scene_of(loaded(tmp_path, file, **options))
    assert scene.num_triangles == len(BOX_SIDES)
    wanted = (BOX * [1.5, 2, 2.5])[:, TO_SCENE]
    assert np.abs(vertices_at(scene, 1.5 - options.get("offset", 0.0))["box"] - wanted).max() < SINGLE


@pytest.mark.parametrize("values, interpolation, size", [([[0, 0, 0], [2, 2, 2]], "LINEAR", 1.0),
                                                         ([[0, 0, 0], [0, 0, 0], [4, 4, 4],
                                                           [-4, -4, -4], [0, 0, 0], [0, 0, 0]], "CUBICSPLINE", 2.0)])
def test_what_has_an_area_between_two_keys_of_a_loop_alone_is_kept(tmp_path, values, interpolation, size):
    """Half-way between two keys, 2 s apart; that of the spline is an eighth of 2 s (4 + 4) / s."""
    file = box_file(scale=[0, 0, 0])
    file.animation((0, "scale", [0, 2], values, interpolation))
    scene = scene_of(loaded(tmp_path, file, loop=True))
    assert scene.num_triangles == len(BOX_SIDES)
    assert np.abs(vertices_at(scene, 1.0)["box"] - size * BOX[:, TO_SCENE]).max() < SINGLE


def test_a_motion_that_scales_is_refused_on_nodes():
    scale = ep.CurveMotion(scale=ep.Curve([0, 1], [[1, 1, 1], [2, 2, 2]]))
    with pytest.raises(ValueError, match="motion: must keep lengths: scales move joints of a Skin alone; node"):
        ep.Scene().add(ep.actors.plate(1, 1), name="plate", material="metal", motion=scale)


def test_faults_of_animations_are_told_with_their_places(tmp_path):
    def refused(said, *channel, **sampler):
        file = morph_file()
        file.animation(channel)
        file.json["animations"][0]["samplers"][0] |= sampler
        with pytest.raises(ep.FileError, match=said):
            loaded(tmp_path, file)

    refused(r"samplers\[0\]\.input: must ascend, falls from 1 to 0\.5 s", 0, "translation", [0, 1, 0.5], PLACES, "LINEAR")
    refused(r"samplers\[0\]\.output: must have 3 entries for 3 times, has 2", 0, "translation", KEYS, PLACES[:2], "LINEAR")
    refused(r"samplers\[0\]\.interpolation: must be LINEAR, STEP or", 0, "translation", KEYS, PLACES, "BEZIER")
    refused(r"targets: has 3 targets, of which the animation moves 2", 0, "weights", [0, 1], [0, 0, 1, 1], "LINEAR")
    refused(r"target\.node: must be a whole number from 0 to 0, is 3", 3, "translation", KEYS, PLACES, "LINEAR")
    refused(r"samplers\[0\]\.input: must be a whole", 0, "translation", KEYS, PLACES, "LINEAR", input=77)


RADAR = ep.Radar(ep.ChirpSequence(start_frequency=77e9, bandwidth=150e6, num_samples=32, sampling_rate=5e6, num_chirps=64,
                                  chirp_interval=1e-3), transmitters=[ep.Antenna((0, 0, 0))], receivers=[ep.Antenna((0, 0, 0))])


def cube_of(motion, start_time: float = 0.0) -> np.ndarray:
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.2), name="ball", material="metal", position=(5, 0, 0), motion=motion, smooth=True)
    return ep.synthesize(ep.trace(scene, RADAR, num_rays=4000, max_bounces=1, start_time=start_time), RADAR)[0, 0]


def still_at(x: float):
    return ep.CurveMotion(ep.Curve([0.0], [[x, 0, 0]]))


@pytest.mark.parametrize("options", [{}, {"period": 0.05}, {"period": 0.05, "offset": 0.0123}])
def test_a_step_within_a_frame_is_one_between_chirps(options):
    """A ball that jumps by a millimetre: each chirp is that of a ball that stands where this one is."""
    keys, places = np.array([0.0, 0.0204, 0.0417]), [0.0, 0.001, -0.0005]
    motion = ep.CurveMotion(ep.Curve(keys, [[x, 0, 0] for x in places], "step"), **options)
    cube = cube_of(motion, start_time=2.0)
    stands = {x: cube_of(still_at(x)) for x in places}
    for chirp, row in enumerate(cube):
        time = 2.0 + RADAR.waveform.chirp_interval * chirp
        x = motion.at(time)[0, 3]
        error = np.abs(row - stands[round(x, 6)][chirp]).max() / np.abs(row).max()
        window = RADAR.waveform.num_samples / RADAR.waveform.sampling_rate
        if motion.at(time + window)[0, 3] == x:
            assert error < 0.03  # of the speckle of facets: the rays of each trace meet other points


def test_a_looped_rig_goes_on_in_the_second_frame(tmp_path):
    scene = scene_of(loaded(tmp_path, rig_file(times=(0.0, 0.0625, 0.125)), loop=True))
    again = [np.concatenate(list(vertices_at(scene, time).values())) for time in (0.03, 0.155, 10.03)]
    assert np.abs(again[1] - again[0]).max() < 1e-12 and np.abs(again[2] - again[0]).max() < 1e-11
    radar = RADAR.replace(position=(-3, 0, 1))
    first, second = (ep.synthesize(ep.trace(scene, radar, num_rays=3000, max_bounces=1, start_time=start), radar)
                     for start in (0.02, 0.145))
    assert np.abs(first - second).max() < 1e-6 * np.abs(first).max()


def test_frames_keep_curves_skins_and_morph_targets(tmp_path):
    file = rig_file(interpolation="STEP")
    file.animation((2, "scale", [0, 1], [[1, 1, 1], [1, 2, 1]], "LINEAR"))
    scene = ep.Scene()
    scene.add(loaded(tmp_path, file, animation="animation_1", loop=True, offset=0.25), name="rig")
    morph = morph_file()
    values = np.stack([np.zeros((2, 3)), [[0, 0, 0], [1, 0, 0.5]], np.ones((2, 3))], axis=1)
    morph.animation((0, "weights", [0, 1], values.ravel(), "CUBICSPLINE"))
    scene.add(loaded(tmp_path, morph), name="morph", position=(3, 0, 0))
    shaped = ep.Skin(BOX, [ep.Joint("a")], np.ones((8, 1)), shape=scene["morph/box"].motion)
    scene.add(ep.Mesh(BOX, BOX_SIDES), name="shaped", material="metal", motion=shaped, position=(9, 0, 0))
    frame = ep.simulate(scene, RADAR.replace(position=(-5, 0, 0)), num_rays=300, max_bounces=1, guard=False)
    ep.save_frame(frame, tmp_path / "frame.h5")
    again = ep.load_frame(tmp_path / "frame.h5").paths.scene
    for mesh in scene.meshes:
        assert again.meshes[mesh.id].name == mesh.name
        for time in (0.0, 0.3, 1.7):
            assert np.array_equal(again.world_vertices(mesh.id, time), scene.world_vertices(mesh.id, time))


def test_keys_that_are_no_rotations_are_told(tmp_path):
    file = box_file()
    file.animation((0, "rotation", [0, 1], [[0, 0, 0, 0], [0, 0, 0, 1]], "LINEAR"), name="spin")
    with pytest.raises(ep.FileError, match=r"nodes\[0\]: cannot be animated by 'spin': rotation: must hold unit quaternions"):
        loaded(tmp_path, file)
