"""Values of a template that follow others: the same in each scene, whichever is drawn first; what leads nowhere is named."""
import numpy as np
import pytest

from echopath import dataset
from support.files.small_dataset import HEAD, SCENE, written

FOLLOWERS = """
[[objects]]
name = "early"
actor = "plate"
position = [{same_as = "trace.start_time", times = -1.5, plus = 4}, {same_as = "objects.late.position[1]"},
            {same_as = "objects.early.parameters.height"}]
material = {same_as = "objects.car_1.material"}
[objects.parameters]
width = {same_as = "objects.late.parameters.width", times = 2}
height = {same_as = "objects.car_2.parameters.height"}
[[objects]]
name = "late"
actor = "plate"
parameters = {choice = [{width = 0.3, height = 0.3}, {width = {uniform = [1, 2]}, height = 0.5}]}
position = [5.0, {uniform = [-9, 9]}, 0.0]
[[objects]]
name = "car"
count = {integer = [2, 4]}
actor = "plate"
parameters = {width = 0.2, height = {uniform = [0.1, 0.4]}}
material = {choice = ["metal", "brick"]}
position = [9.0, 1.0, 0.0]
[trace]
"""


def template_of(tmp_path, text: str):
    return dataset.Template(written(tmp_path, HEAD + SCENE.replace("[trace]\n", text + "start_time = {uniform = [10, 90]}\n", 1)))


def test_values_follow_others_in_every_scene(tmp_path):
    template = template_of(tmp_path, FOLLOWERS)
    seen = []
    for number in range(40):
        scene = template.draw(number)
        tables = {one["name"]: one for one in scene.table["objects"]}
        early, late = tables["early"], tables["late"]
        height = tables["car_2"]["parameters"]["height"]
        assert early["parameters"] == {"width": 2 * late["parameters"]["width"], "height": height}
        assert early["material"] == tables["car_1"]["material"]
        time = scene.table["trace"]["start_time"]
        assert early["position"] == [-1.5 * time + 4, late["position"][1], early["parameters"]["height"]] and 10 <= time <= 90
        assert scene.values["objects.early.position[0]"] == early["position"][0]
        seen.append((early["parameters"]["width"], time))
        template.check(number)
    assert len({width for width, _ in seen}) > 10 and np.ptp([time for _, time in seen]) > 50


def test_draws_that_are_followed_stay_what_they_are(tmp_path):
    free = FOLLOWERS.replace('{same_as = "objects.car_1.material"}', '"metal"')
    for number in range(5):
        followed, alone = (template_of(tmp_path, text).draw(number) for text in (FOLLOWERS, free))
        assert {key: one for key, one in followed.values.items() if key != "objects.early.material"} == alone.values


@pytest.mark.parametrize("before, after, told", [
    ('"objects.car_1.material"', '"objects.car.material"', r"material.same_as: must be the dotted path .*, got 'objects.car.mat"),
    ('"objects.car_1.material"', '"objects.nobody.material"', r"material.same_as: must be the dotted path of a key"),
    ('"objects.car_1.material"', '"trace.start_tim"', r"material.same_as: must be the dotted path of a key"),
    ('"objects.car_1.material"', '"title[0]"', r"material.same_as: must be the dotted path of a key"),
    ('"objects.car_1.material"', '"a..b"', r"material.same_as: must be the dotted path of a key"),
    ('"objects.car_1.material"', '""', r"material.same_as: must be the dotted path of a key"),
    ('"objects.car_1.material"', '"objects.plate_1.position[0]"', r"material.same_as: must be the dotted path of a key"),
    ('"objects.car_1.material"', '"objects.early.material"', r"must be .* that does not follow this one, got 'objects.early.m"),
    ('"objects.car_1.material"}', '"objects.car_1.material", plus = 1}', r"same_as: must be the dotted path of a number, beside "
     "plus, got that of '(metal|brick)'"),
    ('times = 2', 'times = "2"', r"width.times: must be a number, got '2'"),
    ('times = 2', 'offset = 2', r"width.offset: unknown key beside same_as, which takes plus, times"),
    ('{same_as = "objects.late.position[1]"}', '{same_as = 5}', r"position\[1\].same_as: must be the dotted path of a key"),
    ('{same_as = "objects.late.position[1]"}', '{same = "objects.late.position[1]"}', "distribution; did you mean 'same_as"),
    ('{same_as = "objects.late.position[1]"}', '{}', r"distributions are .*, same_as")])
def test_what_leads_nowhere_is_named(tmp_path, before, after, told):
    assert FOLLOWERS.count(before) == 1
    template = template_of(tmp_path, FOLLOWERS.replace(before, after))
    with pytest.raises(ValueError, match=rf"plates.toml: (line \d+: )?scene 0: .*{told}"):
        template.check(0)


def test_traffic_of_an_hour_follows_the_start_of_the_scene(tmp_path):
    """The radar rides on one of the cars, which has no body, and those alone are there who are on the way then."""
    rows = "".join(f'<timestep time="{time}">' + "".join(
        f'<vehicle id="v{number}" type="car" x="{10 * (time - begin)}" y="{4 * number}" angle="90"/>'
        for number, begin in enumerate((0, 10, 20, 30)) if begin <= time <= begin + 12) + "</timestep>" for time in range(45))
    (tmp_path / "fcd.xml").write_text(f"<fcd-export>{rows}</fcd-export>")
    traffic = """
[[traffic]]
file = "fcd.xml"
exclude = [{same_as = "radar.rides_on"}]
during = [{same_as = "trace.start_time"}, {same_as = "trace.start_time", plus = 0.2}]
[trace]
start_time = {uniform = [0.0, 40.0]}
"""
    ridden = '[radar]\nrides_on = {choice = ["v0", "v3"]}\n'
    scene = SCENE.replace("[trace]\n", traffic, 1).replace("[radar]\n", ridden, 1)
    template = dataset.Template(written(tmp_path, HEAD + scene))
    for number in range(12):
        file = template.scene_file(number)
        begin, ridden = file.trace.start_time, template.draw(number).table["radar"]["rides_on"]
        there = [f"v{one}" for one, first in enumerate((0, 10, 20, 30)) if first <= begin + 0.2 and begin <= first + 12]
        assert [name for name in file.scene if name.startswith("v") and "/" not in name] == [
            name for name in there if name != ridden]
