"""Ghost families against a slow classification from the text of the dataset's labels; and signals taken apart by them."""
import pickle
import random

import numpy as np
import pytest

import echopath as ep
from echopath import _core
from support.hand_made import hand_made_paths, make_street, random_expression, random_routes
from support.radars import build_radar
from support.references.slow_matcher import glob_takes

ADDITIVITY = 1e-12    # relative to the largest sample: parts add up in another order than the whole
OBJECTS = {"walker": "pedestrian", "floor": "street/floor"}
SURFACE = {"street/wall_left": "street/wall_left", "street/wall_right": "street/wall_right"}


@pytest.fixture(scope="module")
def street():
    return make_street()


def slow_family(route, objects):
    """(object, ghost type, order, via, class code) of one route, in plain words."""
    def owner_of(mesh):
        return next((name for name, glob in objects.items() if glob_takes(glob, mesh)), None)

    stops = []  # what the path touches, one entry per bounce
    for mesh, _ in route:
        at = owner_of(mesh)
        if not (stops and at is not None and stops[-1] == at):
            stops.append(at or SURFACE[mesh])
    owners = [name for name in objects if name in stops]
    if not owners:
        return "", 0, 0, (), 0
    owner = owners[0]
    via = tuple(dict.fromkeys(stop for stop in stops if stop != owner))
    if len(stops) == 1:
        return owner, 0, 1, via, 111
    ghost_type = 1 if stops[-1] == owner else 2
    digits = {(1, 2): "112", (2, 2): "122", (2, 3): "124"}  # type 1 or 2; orders 2 and 3 are the bits 2 and 4
    return owner, ghost_type, len(stops), via, int(digits.get((ghost_type, len(stops)), "100"))


def as_tuple(family):
    return family.object, family.ghost_type, family.order, family.via, family.class_code


def test_families_agree_with_a_slow_classification(street):
    routes = random_routes(5000, 5, seed=1)
    found = ep.families(hand_made_paths(street, routes), OBJECTS)
    wanted = [slow_family(route, OBJECTS) for route in routes]
    assert [as_tuple(found.families[index]) for index in found.family_of_path] == wanted
    assert found.object_of_path.tolist() == [list(OBJECTS).index(name) if name else -1 for name, *_ in wanted]
    assert found.ghost_type.tolist() == [ghost_type for _, ghost_type, *_ in wanted]
    assert found.order.tolist() == [order for _, _, order, *_ in wanted]
    assert found.class_code.tolist() == [code for *_, code in wanted]
    assert {as_tuple(family) for family in found} == set(wanted) | {("", 0, 0, (), 0)}
    assert set(found.class_code) == {0, 100, 111, 112, 122, 124}


def test_families_are_the_parts_of_path_expressions(street):
    paths = hand_made_paths(street, random_routes(3000, 4, seed=2))
    found = ep.families(paths, OBJECTS)
    walls = "[^ 'pedestrian']"
    for text, types in (("T 'pedestrian'+ R", {0}), (f"T .* {walls} .* 'pedestrian' R", {1}),
                        (f"T .* 'pedestrian' .* {walls} R", {2})):
        assert set(found.ghost_type[ep.Selection(text).matches(paths)]) == types
    type_two = ep.Family("walker", 2, 2, ("street/wall_left",))
    by_hand = ep.Selection("T 'pedestrian'+ 'street/wall_left' R").matches(paths)
    assert np.array_equal(found.paths_of(type_two), np.flatnonzero(by_hand)) and by_hand.any()
    assert len(found.paths_of(ep.Family("walker", 2, 9, ()))) == 0


def test_family_is_a_value(street):
    found = ep.families(hand_made_paths(street, random_routes(500, 3, seed=3)), ["pedestrian"])
    for family in found:
        again = pickle.loads(pickle.dumps(family))
        assert again == family and hash(again) == hash(family) and str(again) == str(family)
    assert len({*found}) == len(found) and found.families[0] != found.families[1]
    assert repr(found) == f"Families({len(found)} of 1 object, paths=500)"
    assert repr(found.families[0]) == "<Family pedestrian>" and str(found.families[-1]) == "background"
    assert found.families[1].is_ghost and not found.families[0].is_ghost and not found.families[-1].is_ghost


@pytest.mark.parametrize("objects, error, text", [
    ({"a": "pedestrain"}, ValueError, "nearest names: pedestrian"),
    ({"": "street"}, ValueError, "objects: must have non-empty names"),
    ({"a": "*", "b": "street"}, ValueError, "objects: must each have a mesh that none before it takes"),
    ("found", TypeError, "objects: must be a dict or a list of globs, as .* ep.find_objects gives it, got .found."),
    ("pedestrian", TypeError, "objects: must be a dict or a list"),
])
def test_bad_objects_are_named(street, objects, error, text):
    with pytest.raises(error, match=text):
        ep.families(hand_made_paths(street, random_routes(3, 3, seed=4)), objects)


def wall_and_target(velocity=0.0):
    """A rough target beside a mirror and a rough plate behind it."""
    scene = ep.Scene()
    rough = ep.Material(reflectivity=0.5, scattering=1.0)
    wall = ep.Mesh([[-20, 3, -10], [40, 3, -10], [40, 3, 12], [-20, 3, 12]], [[0, 1, 2], [0, 2, 3]])
    scene.add(wall, name="wall", material=ep.Material(reflectivity=0.6, scattering=0.2, mirror=True))
    motion = ep.LinearMotion(velocity=(velocity, 0, 0)) if velocity else None
    scene.add(ep.actors.sphere(0.4), name="ball", material=rough, position=(10, 0, 0), motion=motion)
    scene.add(ep.actors.plate(2.0, 2.0), name="plate", material=rough, position=(14, -2, 0))
    return scene


@pytest.fixture(scope="module")
def traced():
    radar = build_radar(receivers=[(0, 0.01, 0)], bandwidth=0.2e9, num_chirps=4)
    return ep.trace(wall_and_target(), radar, num_rays=3000, max_bounces=3, batches=4)


def assert_adds_up(parts, whole):
    assert np.abs(whole).max() > 0
    assert np.abs(sum(parts.values()) - whole).max() <= ADDITIVITY * np.abs(whole).max()


def test_default_objects_are_what_stands_free(traced):
    found = ep.families(traced)
    assert found.objects == ("ball", "plate")
    assert ep.Family("ball", 2, 3, ("wall",)) in found.families  # wall, ball, wall
    assert found.family_of_path.dtype == np.uint32 and len(found.family_of_path) == traced.num_paths


def test_views_of_selections_families_and_batches_each_add_up(traced):
    whole = ep.synthesize(traced)
    found = ep.families(traced)
    route = {"ball": "T 'ball' R", "wall": "T .* 'wall' .* R"}
    views = ep.decompose(traced, None, {"route": route, "ghosts": found, "batches": _core.Grouping.batches()})
    for view in views.values():
        assert_adds_up(view, whole)
    assert list(views["route"]) == ["ball", "wall", "other"] and views["route"].selections == route
    assert list(views["ghosts"]) == list(found) and views["ghosts"].selections is None
    assert list(views["batches"]) == [*((batch, kind) for batch in range(4) for kind in ("coherent", "diffuse")),
                                      (None, "coherent")]
    alone = ep.decompose(traced, parts=found)
    assert list(alone) == list(found)
    for family, cube in alone.items():
        assert np.abs(cube - views["ghosts"][family]).max() <= ADDITIVITY * np.abs(whole).max()


def test_family_cubes_are_those_of_their_paths(traced):
    cubes, found = ep.decompose(traced, parts=ep.families(traced)), ep.families(traced)
    real, one_way = ep.Family("ball", 0, 1, ()), ep.Family("ball", 2, 2, ("wall",))
    for family, text in ((real, "T 'ball'+ R"), (one_way, "T 'ball'+ 'wall' R")):
        alone = ep.decompose(traced, parts={"these": text})["these"]
        assert np.abs(cubes[family] - alone).max() <= ADDITIVITY * np.abs(alone).max()
        assert np.abs(alone).max() > 0 and len(found.paths_of(family)) > 0


def test_combinations_of_groupings_are_those_of_both(traced):
    route = {"ball": "T 'ball' R"}
    both = _core.Grouping.all_of([_core.Grouping.selections(list(route.items())), _core.Grouping.batches()])
    cubes = ep.decompose(traced, parts={"both": both, "route": route})
    ball = sum(cube for (name, _), cube in cubes["both"].items() if name == "ball")
    assert np.abs(ball - cubes["route"]["ball"]).max() <= ADDITIVITY * np.abs(ball).max()
    assert {name for name, _ in cubes["both"]} == {"ball", "other"}
    assert {batch for _, (batch, _) in cubes["both"]} == {0, 1, 2, 3, None}


def test_many_combinations_are_filled_view_by_view(traced):
    """More combinations than are worth their memory: the cubes stay the same to rounding."""
    levels = np.quantile(traced.power, np.linspace(0.95, 0.05, 40))
    many = {f"above {level} W": ep.power >= level for level in levels}
    found = ep.families(traced)
    views = {"many": many, "ghosts": found, "batches": _core.Grouping.batches()}
    level = np.searchsorted(levels[::-1], traced.power, side="right")
    assert len(set(zip(level, found.family_of_path, traced.batch))) > 500
    together = ep.decompose(traced, parts=views)
    for name, view in views.items():
        alone = ep.decompose(traced, parts={name: view})[name]
        scale = np.abs(sum(alone.values())).max()
        assert list(alone) == list(together[name])
        assert all(np.abs(alone[key] - cube).max() <= ADDITIVITY * scale for key, cube in together[name].items())


def test_random_partitions_add_up(traced):
    """200 random partitions of up to eight random expressions."""
    draw, globs = random.Random(5), ["wall", "ball", "plate", "*a*", "*"]
    whole = ep.synthesize(traced)
    for _ in range(200):
        parts = {f"part {k}": random_expression(draw, globs) for k in range(draw.randint(1, 8))}
        cubes = ep.decompose(traced, parts=parts)
        assert list(cubes) == [*parts, "other"]
        assert_adds_up(cubes, whole)


def test_families_of_all_records_of_a_frame_are_told(traced):
    """A ball comes out from behind a screen: only later records have its echoes."""
    scene = wall_and_target(velocity=0.0)
    scene.add(ep.actors.plate(0.2, 3.0), name="screen", material=ep.Material(reflectivity=0.1, scattering=1.0),
              position=(5, 0.0, 0.0), motion=ep.LinearMotion(velocity=(0, -3000, 0)))
    radar = traced.radar
    paths = ep.trace(scene, radar, num_rays=3000, max_bounces=2)
    keyframes = {"retrace": "always", "keyframes": 4}
    whole = ep.synthesize(paths, radar, **keyframes)
    views = ep.decompose(paths, radar, {"ghosts": ep.families(paths), "route": {"ball": "T 'ball'+ R"}}, **keyframes)
    assert_adds_up(views["ghosts"], whole)
    assert_adds_up(views["route"], whole)
    families = list(views["ghosts"])
    assert len(set(families)) == len(families) and str(families[-1]) == "background"
    assert set(ep.families(paths)) <= set(families)
    real = views["ghosts"][ep.Family("ball", 0, 1, ())]
    assert np.abs(real - views["route"]["ball"]).max() <= ADDITIVITY * np.abs(real).max()


@pytest.mark.parametrize("settings", [{}, {"retrace": "always", "keyframes": 2}])
def test_an_object_called_background_keeps_its_own_echoes(traced, settings):
    """And one that is called as a ghost of it: names are for people, parts add up whatever they are."""
    scene = ep.Scene()
    rough = ep.Material(reflectivity=0.5, scattering=1.0)
    wall = ep.Mesh([[-20, 3, -10], [40, 3, -10], [40, 3, 12], [-20, 3, 12]], [[0, 1, 2], [0, 2, 3]])
    scene.add(wall, name="wall", material=ep.Material(reflectivity=0.6, scattering=0.2, mirror=True))
    scene.add(ep.actors.sphere(0.4), name="background", material=rough, position=(10, 0, 0))
    scene.add(ep.actors.plate(2.0, 2.0), name="background: type 1, order 2 via wall", material=rough, position=(14, -2, 0))
    paths = ep.trace(scene, traced.radar, num_rays=2000, max_bounces=2)
    families = ep.families(paths)
    names = [str(family) for family in families]
    assert names.count("background") == 2 and names.count("background: type 1, order 2 via wall") == 2
    cubes = ep.decompose(paths, parts=families, **settings)
    assert list(cubes) == list(families) and cubes[families.families[-1]].any()
    assert_adds_up(cubes, ep.synthesize(paths, **settings))


def test_mixed_views_are_an_error(traced):
    with pytest.raises(ValueError, match=r"parts: must be all selections \(one .* or all tables .*, got \['a', 'ghosts'\]"):
        ep.decompose(traced, parts={"a": "T . R", "ghosts": ep.families(traced)})
    with pytest.raises(TypeError, match="parts: must be a dict of selections or of views, or Families, got "):
        ep.decompose(traced, parts=["T . R"])
