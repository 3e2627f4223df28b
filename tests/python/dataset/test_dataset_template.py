"""Templates of datasets: what they draw, and that their faults are told before the first frame."""
from pathlib import Path

import numpy as np
import pytest

from echopath import dataset
from support.files.small_dataset import HEAD, SCENE, written


@pytest.fixture
def path(tmp_path) -> Path:
    return written(tmp_path)


def names_of(drawn) -> list[str]:
    return [one["name"] for one in drawn.table["objects"]]


def test_draws_have_their_distributions(path):
    template = dataset.Template(path)
    drawn = [template.draw(number) for number in range(600)]
    counts = np.bincount([sum(name.startswith("plate_") for name in names_of(one)) for one in drawn], minlength=4)
    assert counts[0] == 0 and all(abs(count - 200) < 4 * 12 for count in counts[1:])  # 4 standard deviations
    assert abs(sum("wall" in names_of(one) for one in drawn) - 300) < 4 * 12.3
    plates = [one.values for one in drawn]
    heights = np.array([values["objects.plate_1.parameters.height"] for values in plates])
    assert abs(heights.mean() - 0.2) < 4 * 0.2 / np.sqrt(12 * 600) and 0.1 <= heights.min() and heights.max() <= 0.3
    metal = np.mean([values["objects.plate_1.material"] == "metal" for values in plates])
    assert abs(metal - 0.25) < 4 * np.sqrt(0.25 * 0.75 / 600)
    speeds = np.array([one.table["objects"][0]["speed"] for one in drawn])
    moving = speeds[speeds > 0.0]
    assert abs(len(moving) - 300) < 4 * 12.3
    assert abs(np.median(moving) / np.sqrt(0.1 * 4.0) - 1.0) < 0.5  # of a log-uniform variable
    sides = np.array([one.table["objects"][0]["position"][1] for one in drawn])
    assert np.abs(sides).max() <= 1.5 and abs(sides.std() - 0.4) < 0.05


def test_splits_have_their_shares_of_any_scenes_in_a_row(tmp_path):
    shares = {"train": 0.7, "val": 0.2, "test": 0.1}
    split = "split = {train = 0.7, val = 0.2, test = 0.1}"
    for seed in range(3):
        head = HEAD.replace("split = {train = 0.5, test = 0.5}", split).replace("seed = 3", f"seed = {seed}")
        template = dataset.Template(written(tmp_path, head + SCENE))
        names = np.array([template.split_of(number) for number in range(1300)])
        for name, share in shares.items():
            sums = np.concatenate([[0], np.cumsum(names == name)])
            for count in range(1, 1001):
                found = sums[count:] - sums[:-count]
                assert np.abs(found - share * count).max() < 4.0 and (count < 20 or found.min() > 0)


def test_objects_stand_apart_as_they_ask(path):
    for number in range(100):
        placed = [one["position"][:2] for one in dataset.Template(path).draw(number).table["objects"] if "plate" in one["name"]]
        for index, one in enumerate(placed):
            assert all(np.hypot(*np.subtract(one, other)) >= 1.0 for other in placed[:index])


def test_what_is_left_out_takes_along_what_it_carries(tmp_path):
    """A lamp on the wall, a bulb in it, and a sign on the second plate; a carrier that nobody names is a fault."""
    carried = "".join(f"""[[objects]]
name = "{name}"
actor = "plate"
parameters = {{width = 0.1, height = {{uniform = [0.1, 0.2]}}}}
material = "metal"
parent = {parent}
""" for name, parent in (("lamp", '"wall"'), ("bulb", '"wall/lamp"'), ("sign", '{choice = ["plate_2", "plate_2"]}')))
    template = dataset.Template(written(tmp_path, HEAD + SCENE.replace("[trace]", carried + "[trace]")))
    drawn = [template.draw(number) for number in range(40)]
    for carrier, names in (("wall", ("lamp", "bulb")), ("plate_2", ("sign",))):
        is_there = [carrier in names_of(one) for one in drawn]
        assert 0 < sum(is_there) < len(drawn)
        for name in names:
            assert [name in names_of(one) for one in drawn] == is_there
            assert [f"objects.{name}.parameters.height" in one.values for one in drawn] == is_there
    with_lamp = next(one.number for one in drawn if "lamp" in names_of(one))
    assert "wall/lamp/bulb" in template.scene_file(with_lamp).scene
    carried = carried.replace('"wall"', '"wal"')
    misspelt = dataset.Template(written(tmp_path, HEAD + SCENE.replace("[trace]", carried + "[trace]")))
    with pytest.raises(ValueError, match="objects.lamp: parent: must be the full name of a node .*, got 'wal'"):
        misspelt.scene_file(with_lamp)
    fixed = (HEAD + SCENE.replace("[trace]", carried + "[trace]")).replace("count = {integer = [1, 3]}", "count = 2")
    with pytest.raises(ValueError, match="objects.sign: parent: must be the full name of a node .*, got 'plate_3'"):
        dataset.Template(written(tmp_path, fixed.replace('"wal', '"plate_1').replace('"plate_2"', '"plate_3"'))).scene_file(0)


def test_what_other_objects_carry_by_one_name_is_drawn_by_itself(tmp_path):
    """Two lids of one name had one dotted path: the same draws, of which one was kept, and the faults of both on one line."""
    carried = "".join(f"""[[objects]]
name = "lid"
count = 2
parent = "{carrier}"
actor = "plate"
parameters = {{width = 0.1, height = {height}}}
material = "{material}"
""" for carrier, height, material in (("first", "{uniform = [0.0, 1.0]}", "metal"), ("second", "{uniform = [0.0, 1.0]}", "tin"),
                                      ("third", '{same_as = "objects.second/lid_2.parameters.height"}', "metal")))
    carriers = "".join(f'[[objects]]\nname = "{name}"\ngroup = true\n' for name in ("first", "second", "third"))
    text = HEAD + SCENE.replace("[trace]", carriers + carried + "[trace]")
    template, path = dataset.Template(written(tmp_path, text.replace('"tin"', '"metal"'))), written(tmp_path, text)
    heights = []
    for number in range(20):
        drawn = template.draw(number)
        lids = {f"{one['parent']}/{one['name']}": one["parameters"]["height"] for one in drawn.table["objects"]
                if one["name"].startswith("lid")}
        assert drawn.values["objects.lid_1.parameters.height"] == lids["first/lid_1"]
        assert drawn.values["objects.second/lid_1.parameters.height"] == lids["second/lid_1"]
        assert lids["third/lid_1"] == lids["third/lid_2"] == lids["second/lid_2"]
        heights.append((lids["first/lid_1"], lids["second/lid_1"]))
    assert abs(np.corrcoef(np.transpose(heights))[0, 1]) < 0.7  # of 20 pairs that are drawn by themselves: once in 1700
    line = text[:text.index('"tin"')].count("\n") + 1
    with pytest.raises(ValueError, match=rf"line {line}: scene 0: objects.second/lid_1.material: unknown material 'tin'"):
        dataset.Template(path).scene_file(0)


@pytest.mark.parametrize("first, second, places", [
    ('name = "lid"\ncount = 2\nparent = "first"', 'name = "lid_1"\nparent = "second"', ["lid_1", "second/lid_1"]),
    ('name = "lid_1"\nparent = "first"', 'name = "lid"\ncount = 2\nparent = "second"', ["lid_1", "second/lid_1"]),
    ('name = "lid"\ncount = 2', 'name = "lid_1"\nparent = "second"', ["lid_1", "second/lid_1"]),
    ('name = "lid"\nparent = "first"', 'name = "lid"\nparent = {choice = ["second", "second"]}', ["lid", "objects[{}]/lid"])])
def test_copies_and_drawn_carriers_have_draws_of_their_own_too(tmp_path, first, second, places):
    carriers = "".join(f'[[objects]]\nname = "{name}"\ngroup = true\n' for name in ("first", "second"))
    lids = "".join(f"""[[objects]]
{own}
actor = "plate"
parameters = {{width = 0.1, height = {{uniform = [0.0, 1.0]}}}}
material = "metal"
""" for own in (first, second))
    text = HEAD + SCENE.replace("[trace]", carriers + lids + "[trace]")
    last = text.count("[[objects]]") - 1
    drawn = dataset.Template(written(tmp_path, text)).draw(0)
    keys = [f"objects.{place}.parameters.height" if "[" not in place else f"{place.format(last)}.parameters.height"
            for place in places]
    assert drawn.values[keys[0]] != drawn.values[keys[1]]
    heights = {one["parameters"]["height"] for one in drawn.table["objects"] if one["name"].startswith("lid")}
    assert {drawn.values[key] for key in keys} <= heights


def require_apart(template, num_scenes: int) -> None:
    """All but the wall have middles 1 m apart or more at time 0, and in some scene not much more."""
    near = 0
    for number in range(num_scenes):
        scene = template.scene_file(number).scene
        middles = [scene.world_vertices(mesh.id, 0.0).mean(axis=0)[:2] for mesh in scene.meshes if mesh.name != "wall"]
        apart = [np.hypot(*(one - other)) for index, one in enumerate(middles) for other in middles[:index]]
        assert min(apart) >= 1.0 - 1e-9
        near += min(apart) < 1.2
    assert near > 0  # they are as close as they may


def test_objects_stand_apart_whatever_carries_them(tmp_path):
    """Plates in a lane that a group turns and shifts, and plates of the scene where that lane leads: places in the world."""
    lane = """[[objects]]
name = "lane"
group = true
position = [3.0, -4.0, 0.0]
yaw_deg = 90.0
[[objects]]
name = "carried"
parent = "lane"
count = 3
apart = 0.5
actor = "plate"
parameters = {width = 0.2, height = 0.2}
material = "metal"
position = [{uniform = [0.0, 8.0]}, {uniform = [-0.5, 0.5]}, 1.0]
"""
    template = dataset.Template(written(tmp_path, HEAD + SCENE.replace("[trace]", lane + "[trace]")))
    require_apart(template, num_scenes=20)


def test_objects_stand_apart_where_their_ways_begin(tmp_path):
    """Plates whose trajectory or motion begins 5 m beside their position, and what one of these carries: places at time 0."""
    ways = """[[objects]]
name = "driving"
count = 3
apart = 0.5
trajectory = {points = [[-5.0, 0.0], [20.0, 0.0]], speed = 4.0}
BODY
[[objects]]
name = "keyed"
count = 2
apart = 0.5
motion = {kind = "keyframes", times = [-1.0, 1.0], translations = [[-5.0, -1.0, 0.0], [-5.0, 1.0, 0.0]]}
BODY
[[objects]]
name = "cart"
group = true
position = [4.0, -4.0, 0.0]
trajectory = {points = [[0.0, 0.0], [0.0, 9.0]], turn_radius = 1.0, speed = 4.0}
[[objects]]
name = "carried"
parent = "cart"
count = 2
apart = 0.5
BODY
""".replace("BODY", """actor = "plate"
parameters = {width = 0.2, height = 0.2}
material = "metal"
position = [{uniform = [5.0, 9.0]}, {uniform = [-1.5, 1.5]}, 1.0]""")
    template = dataset.Template(written(tmp_path, HEAD + SCENE.replace("[trace]", ways + "[trace]")))
    require_apart(template, num_scenes=10)


def test_other_keys_and_more_scenes_change_no_draw(path, tmp_path):
    before = dataset.Template(path).draw(4)
    post = 'name = "post"\nactor = "plate"\nparameters = {width = 1, height = 1}\nposition = [{uniform = [1, 2]}, 9, 0]\n'
    more = SCENE.replace('[[objects]]\nname = "plate"', f'[[objects]]\n{post}[[objects]]\nname = "plate"')
    after = dataset.Template(written(tmp_path, HEAD.replace("scenes = 6", "scenes = 60") + more)).draw(4)
    assert {name: after.values[name] for name in before.values} == before.values
    assert after.table["trace"]["seed"] == before.table["trace"]["seed"] != dataset.Template(path).draw(5).table["trace"]["seed"]
    other = dataset.Template(written(tmp_path, HEAD.replace("seed = 3", "seed = 4") + SCENE)).draw(4)
    assert other.values != before.values


@pytest.mark.parametrize("before, after, told", [
    ("scenes = 6", "scenes = 0", "dataset.scenes: must be at least 1, got 0"),
    ("scenes = 6", "scenes = 6\nframe = 2", "dataset.frame: unknown key; did you mean 'frames'?"),
    ("interval = 0.05\n", "", "dataset.interval: is missing, in s"),
    ("test = 0.5", "test = 0.6", "dataset.split: must be name = share, whose sum is 1"),
    ("[labels]", "[labels]\n[sequence]\nframes = 2\ninterval = 1.0", "sequence: must not stand in a template"),
    ("{uniform = [0.1, 0.3]}", "{uniform = [0.3, 0.1]}",
     "scene 0: objects.plate_1.parameters.height.uniform: must be [lowest, highest], got [0.3, 0.1]"),
    ("weights = [1, 3]", "weights = [1]", "objects.plate_1.material.weights: must be 2 numbers of at least 0"),
    ('name = "plate"', 'name = "choice_plate"\nyaw = {choice = [0.0, 1.0], weights = [1]}',
     "objects.choice_plate_1.yaw.weights: must be 2 numbers of at least 0"),
    ("{integer = [1, 3]}", "{integer = [1.5, 3]}", "objects.plate.count.integer: must be [lowest, highest], whole numbers"),
    ("{integer = [1, 3]}", "-1", "objects.plate.count: must be a whole number from 0 to 10000, got -1"),
    ("{integer = [1, 3]}", "1000000000", "objects.plate.count: must be a whole number from 0 to 10000, got 1000000000"),
    ("{integer = [1, 3]}", "inf", "objects.plate.count: must be a whole number from 0 to 10000, got inf"),
    ("{integer = [1, 3]}", "{integer = [1, 9223372036854775808]}", "count.integer: must be [lowest, highest], whole"),
    ("{uniform = [0.1, 0.3]}", f"{{uniform = [0, 1{400 * '0'}]}}", "height.uniform: must be [lowest, highest], got [0, 1"),
    ("{uniform = [0.1, 0.3]}", "{uniform = [-1.7e308, 1.7e308]}", "height.uniform: must be [lowest, highest], got [-1.7"),
    ("{uniform = [0.1, 0.3]}", "{log_uniform = [1e-300, 1e300]}", "height.log_uniform: must be [lowest, highest], both"),
    ("weights = [1, 3]", "weights = [1e308, 1e308]", "objects.plate_1.material.weights: must be 2 numbers of at least 0"),
    ("within = [-1.5, 1.5]", "within = 1.5", "within: must be [lowest, highest], got 1.5"),
    ("[dataset]", "noise = 3\n[dataset]", "scene 0: noise: must be a table, got 3"),
    ('[[objects]]\nname = "wall"', '[[objects]]\n[[objects]]\nname = "wall"', "objects[1].name: is missing"),
    ("chance = 0.5", "chance = 2.0", "objects.wall.chance: must be a number from 0 to 1, got 2.0"),
    ("apart = 0.5", "apart = 9.0", "apart: must leave a free place within 1000 tries, got 9.0"),
    ("within = [-1.5, 1.5]", "within = [90, 91]", "must be a distribution with a good share of its values within [90, 91]"),
    ('"metal", "concrete"', '"metal", "cheese"', "unknown material 'cheese'"),
    ('actor = "wall"', 'actor = "wal"', "did you mean 'wall'"),
    ("height = 2.0", "heigth = 2.0", "heigth"),
    ("apart = 0.5", "appart = 0.5", "objects.plate.appart: unknown key; did you mean 'apart'?"),
    ("chance = 0.5", "path = 'wall.obj'", "an object names its file by mesh"),
    ("chance = 0.5", "parrent = 0.5", "objects.wall.parrent: unknown key; did you mean 'parent'?"),
    ("speed = {choice = [0.0, {log_uniform = [0.1, 4.0]}]}",
     'motion = {kind = "keyframes", times = [0.0, 0.01], translations = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]}',
     "scene 0: frames: must all lie within the motions"),
])
def test_faults_of_a_template_are_told_before_the_first_frame(tmp_path, before, after, told):
    text = HEAD + SCENE
    assert before in text
    path = written(tmp_path, text.replace(before, after))
    with pytest.raises(ValueError) as caught:
        list(dataset.make(path, tmp_path / "out"))
    assert told in str(caught.value) and str(path) in str(caught.value)
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("line, key", [("uniform = [0, 1]", "uniform"), ('same_as = "radar"', "same_as")])
def test_a_template_that_is_a_distribution_itself_is_refused(tmp_path, line, key):
    path = written(tmp_path, f"{line}\n[dataset]\nscenes = 1\n")
    with pytest.raises(ValueError) as caught:
        dataset.Template(path)
    assert str(caught.value) == f"{path}: line 1: {key}: must stand below a key, whose value it draws, got it at the top"


@pytest.mark.parametrize("before, after, told", [
    ("num_rays = 400", "num_rays = 0", "line {line}: scene 0: trace.num_rays: must be at least 1, got 0"),
    ('actor = "wall"', 'actor = "wal"', "line {line}: scene 0: objects.wall.actor: unknown actor 'wal'"),
    ('"metal", "concrete"', '"tin", "tin"', "line {line}: scene 0: objects.plate_1.material: unknown material 'tin'"),
    ("{uniform = [1.5, 4.0]}", "{uniform = [4.0, 1.5]}", "line {line}: scene 0: objects.plate_1.position[0].uniform: must be"),
    ("num_chirps = 8", "num_chirps = 0", "line {line}: scene 0: radar.waveform.num_chirps: must be at least 1, got 0"),
    ("interval = 0.05", "interval = 1e-6", "line {line}: scene 0: interval: must be at least"),
    ("frames = 2", "frames = 0", "line {line}: dataset.frames: must be at least 1, got 0")])
def test_faults_name_the_line_and_the_object_and_are_told_once(tmp_path, before, after, told):
    text = (HEAD + SCENE).replace(before, after)
    path = written(tmp_path, text)
    with pytest.raises(ValueError) as caught:
        list(dataset.make(path, tmp_path / "out"))
    line = text[:text.index(after)].count("\n") + 1
    said, = str(caught.value).splitlines()  # though a scene has up to three plates
    assert said.startswith(f"{path}: {told.format(line=line)}")


def test_a_template_none_of_whose_first_scenes_can_be_made_is_told_before_the_first_frame(path, tmp_path, monkeypatch):
    def failing(*_, **__):
        raise ValueError("weight: must be finite, got nan")

    monkeypatch.setattr("echopath.sequence.Sequence.save_frames", failing)
    with pytest.raises(ValueError) as caught:
        list(dataset.make(path, tmp_path / "out"))
    assert str(caught.value) == f"{path}: scene 0: weight: must be finite, got nan"
    assert not list((tmp_path / "out").rglob("record.json"))
