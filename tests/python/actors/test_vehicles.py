"""Cars, vans, trucks and two-wheelers: published sizes, closed skins, wheels that roll without slipping."""
import numpy as np
import pytest

import echopath as ep
from echopath.tracing.tessellation import coarse_meshes
from support.closed import boundary_edges, extent, joined_parts, scene_of, volume_of

FITTED = 0.01       # m: the middle panels alone reach the published length
FLAT = 0.008        # m: tyres are polygons, whose lowest point is a little above the road as they turn

# Length, width without mirrors, height, wheelbase in m, from the makers' data sheets named in vehicles/cars.py and vans.py.
PUBLISHED = {("car", "small"): (3.540, 1.641, 1.489, 2.420), ("car", "compact"): (4.255, 1.799, 1.452, 2.637),
             ("car", "saloon"): (4.686, 1.810, 1.442, 2.840), ("car", "estate"): (4.767, 1.832, 1.477, 2.786),
             ("car", "suv"): (4.486, 1.839, 1.643, 2.681), ("van", "small"): (4.904, 1.904, 1.990, 3.000),
             ("van", "large"): (5.910, 1.993, 2.435, 3.665)}


def made(name, kind, **options):
    return getattr(ep.actors, name)(kind=kind, **options)


@pytest.mark.parametrize("name, kind", PUBLISHED)
def test_bodies_have_their_published_size(name, kind):
    actor = made(name, kind)
    size, lowest = extent(actor, lambda part: "mirror" not in part and not part.startswith("plate"))
    np.testing.assert_allclose(size, PUBLISHED[name, kind][:3], atol=FITTED)
    assert 0.0 <= lowest < FLAT
    axles = {part.name: part.position[0] for part in actor.parts if part.name.startswith("wheel/")}
    assert axles["wheel/front_left/rim"] - axles["wheel/rear_left/rim"] == pytest.approx(PUBLISHED[name, kind][3])


@pytest.mark.parametrize("name, kind", PUBLISHED)
def test_the_skin_and_the_underside_close_without_gaps(name, kind):
    actor = made(name, kind)
    outer = ("body/", "glass/", "bumper/", "lamp/", "underside/")
    vertices, triangles = joined_parts(actor, lambda part: part.startswith(outer) and "mirror" not in part)
    assert boundary_edges(triangles) == []
    assert volume_of(vertices, triangles) > 0.4 * np.prod(PUBLISHED[name, kind][:3])


@pytest.mark.parametrize("make", [lambda: ep.actors.car(), lambda: ep.actors.van(kind="small"), ep.actors.truck,
                                  ep.actors.motorcycle, ep.actors.bicycle, lambda: ep.actors.parked_row(number=2)],
                         ids=["car", "van", "truck", "motorcycle", "bicycle", "parked_row"])
def test_no_faces_lie_on_each_other_and_curved_parts_are_fine_enough(make):
    scene = scene_of(make())
    assert scene.coplanar_overlaps() == []
    assert [text for _, text in coarse_meshes(scene, 77e9)] == []


@pytest.mark.parametrize("kind", ["small", "compact", "saloon", "estate", "suv"])
def test_all_cars_are_fine_enough_at_77_ghz(kind):
    assert coarse_meshes(scene_of(ep.actors.car(kind=kind)), 77e9) == []


WHOLE = {"cyclist": ep.actors.cyclist, "motorcycle": ep.actors.motorcycle, "dog": ep.actors.dog, "runner": ep.actors.runner,
         "bicycle": ep.actors.bicycle, "wheels": lambda: ep.actors.Actor(
             [part for part in ep.actors.car().parts if part.name.startswith(("wheel", "plate", "body/mirror"))])}


@pytest.mark.parametrize("name", WHOLE)
def test_each_part_of_these_is_closed_with_its_front_outside_and_fine_enough(name):
    actor = WHOLE[name]()
    for part in actor.parts:
        assert boundary_edges(part.mesh.triangles) == [], part.name
        assert volume_of(part.mesh.vertices, part.mesh.triangles) > 0.0, part.name
    scene = scene_of(actor)
    assert scene.coplanar_overlaps() == []
    assert [text for _, text in coarse_meshes(scene, 77e9)] == []


def test_the_truck_closes():
    for group, parts in (("cab/", None), ("trailer/", ("front", "side_left", "side_right", "roof", "doors", "floor"))):
        vertices, triangles = joined_parts(ep.actors.truck(), lambda name, group=group, parts=parts: name.startswith(group) and (
            parts is None or name.removeprefix(group) in parts))
        assert boundary_edges(triangles) == []
        assert volume_of(vertices, triangles) > 0.0


def test_parts_of_a_car_are_named_for_labels():
    names = [part.name for part in ep.actors.car(kind="saloon").parts]
    wanted = {"body/hood", "body/roof", "body/tailgate", "body/door_front_left", "body/door_rear_right", "body/fender_left",
              "glass/windscreen", "glass/rear_window", "glass/door_front_left", "lamp/head_left", "lamp/tail_right",
              "bumper/front", "bumper/rear", "plate/front", "plate/rear", "underside/floor", "underside/arches",
              "wheel/front_left/tyre", "wheel/rear_right/rim", "body/mirror_left"}
    assert wanted <= set(names) and len(names) == len(set(names))


ROLLERS = {"car": (lambda **o: ep.actors.car(**o), "wheel/front_left/tyre"),
           "truck": (lambda **o: ep.actors.truck(**o), "wheel/trailer_2_right/tyre"),
           "motorcycle": (lambda **o: ep.actors.motorcycle(rider=False, **o), "wheel/rear/tyre"),
           "bicycle": (lambda **o: ep.actors.bicycle(**o), "wheel_front/tyre")}


@pytest.mark.parametrize("name", ROLLERS)
def test_wheels_roll_the_lowest_point_rests_and_the_highest_is_twice_as_fast(name):
    make, tyre = ROLLERS[name]
    speed, step = 7.0, 1e-5
    scene = scene_of(make(speed=speed))
    (mesh,) = [mesh.id for mesh in scene.meshes if mesh.name == f"a/{tyre}"]
    before, after = (scene.world_vertices(mesh, t) for t in (-step, step))
    velocity = (after - before)[:, 0] / (2 * step)
    height = 0.5 * (before + after)[:, 2]
    radius = 0.5 * np.ptp(height)
    # A point of a rolling wheel goes ahead as fast as its height above the road over the radius says.
    np.testing.assert_allclose(velocity, speed * (height - height.min()) / radius, atol=0.06 * speed)
    assert velocity.min() == pytest.approx(0.0, abs=0.03 * speed)
    assert velocity.max() == pytest.approx(2.0 * speed, abs=0.03 * speed)


def test_a_car_that_is_carried_turns_its_wheels_on_the_spot():
    scene = scene_of(ep.actors.car(speed=5.0, drives=False))
    centers = {mesh.name: np.mean([scene.world_vertices(mesh.id, t).mean(axis=0) for t in (0.0, 1.0)], axis=0)
               - scene.world_vertices(mesh.id, 0.0).mean(axis=0) for mesh in scene.meshes}
    assert all(np.abs(moved[0]) < 0.05 for moved in centers.values())


def test_wheels_spread_the_doppler_from_rest_to_twice_the_speed():
    """A car drives away: echoes of its body have its speed, those of its tyres any between 0 and twice that."""
    speed = 6.0
    scene = scene_of(ep.actors.car(speed=speed), name="car")
    scene["car"].position = (8.0, 1.5, 0.0)
    radar = ep.Radar(ep.ChirpSequence(start_frequency=77e9, bandwidth=300e6, num_samples=64, sampling_rate=10e6,
                                      num_chirps=128, chirp_interval=60e-6),
                     transmitters=[ep.Antenna((0, 0, 0.5))], receivers=[ep.Antenna((0, 0.01, 0.5))])
    paths = ep.trace(scene, radar, num_rays=60_000, max_bounces=1, seed=3)
    step = 1e-4

    def speeds(expression):
        lengths = paths.select(expression).lengths([-step, step], radar.transmitters[0].position, radar.receivers[0].position)
        return (lengths[1] - lengths[0]) / (4 * step)

    tyres, body = speeds("T 'car/wheel/*/tyre' R"), speeds("T ['car/body' 'car/bumper'] R")
    assert len(tyres) > 100 and len(body) > 100
    assert tyres.min() > -0.1 and tyres.max() < 2.0 * speed + 0.1
    assert np.ptp(tyres) > 0.8 * speed             # they face the radar with treads from the road to the arch
    assert body.min() > 0.8 * speed and body.max() < 1.01 * speed   # but for the cosine of its aspect


def test_the_row_has_as_many_cars_side_by_side():
    row = ep.actors.parked_row(number=3, spacing=2.6, seed=2)
    middles = [extent(row, lambda name, n=n: name.startswith(f"car_{n}/body/roof"))[0] for n in (1, 2, 3)]
    assert all(size[1] < 1.8 for size in middles)
    assert {part.name.split("/")[0] for part in row.parts} == {"car_1", "car_2", "car_3"}
    size, _ = extent(row, lambda name: "mirror" not in name)
    assert 2 * 2.6 + 1.6 < size[1] < 2 * 2.6 + 2.2
    with pytest.raises(ValueError, match="spacing: must be a finite number from 2.3 to 10000 m, got 1.0"):
        ep.actors.parked_row(spacing=1.0)


def test_the_truck_keeps_to_the_largest_size_of_the_directive():
    size, lowest = extent(ep.actors.truck(), lambda name: not name.startswith("mirror"))
    np.testing.assert_allclose(size, (16.5, 2.55, 4.0), atol=0.08)
    assert 0.0 <= lowest < FLAT
