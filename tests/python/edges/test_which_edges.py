"""Which bodies have edges, and when they are looked for."""
import math

import numpy as np
import pytest

import echopath as ep
from support.scenes.edge_scenes import box, fields, on_edges, radar_at, scene_of, sheet, trace
from support.shapes import sphere

SAME = 1e-6           # single precision of weights and barycentric coordinates


def faces_of(mesh: ep.Mesh) -> list[ep.Mesh]:
    """A mesh for each pair of triangles."""
    vertices, triangles = np.asarray(mesh.vertices), np.asarray(mesh.triangles)
    return [ep.Mesh(vertices[pair].reshape(-1, 3), np.arange(6).reshape(2, 3)) for pair in triangles.reshape(-1, 2, 3)]


def parts_scene(mesh, motions=None, **keywords) -> ep.Scene:
    scene = ep.Scene()
    for k, face in enumerate(faces_of(mesh)):
        motion = {"motion": motions[k]} if motions and motions[k] else {}
        scene.add(face, name=f"face_{k}", material=ep.Material.metal(), **motion, **keywords)
    return scene


def test_a_box_of_six_meshes_is_one_box():
    whole, parts = (fields(on_edges(trace(scene, radar_at(), polarization="jones"))) for scene in (
        scene_of(box((0.4, 0.5, 0.6)), yaw=0.4), parts_scene(box((0.4, 0.5, 0.6)), yaw=0.4)))
    assert len(whole) == len(parts)
    assert parts.sum() == pytest.approx(whole.sum(), rel=SAME)


def test_parts_of_one_mesh_have_its_edges_whatever_is_added_between_them():
    whole = box((0.4, 0.5, 0.6))
    is_first = np.arange(len(whole.triangles)) < 5  # which parts two triangles of a face, too
    scene = ep.Scene()
    for name, mesh, aside in (("a", whole.part(is_first), 0.0), ("other", sheet(), 40.0), ("b", whole.part(~is_first), 0.0)):
        scene.add(mesh, name=name, material=ep.Material.metal(), position=(0.0, aside, 0.0))
    expected = fields(on_edges(trace(scene_of(whole), radar_at(), max_bounces=1)))
    found = fields(on_edges(trace(scene, radar_at(), max_bounces=1)).select("~ T .* 'other' .* R"))
    assert len(found) == len(expected)
    assert found.sum() == pytest.approx(expected.sum(), rel=SAME)


def test_a_sheet_cut_in_two_has_no_rim_where_it_is_cut():
    cut = [ep.Mesh(np.array(corners) @ np.diag([1.0, 0.5, 0.5]), np.array([(0, 1, 3), (0, 3, 2)])) for corners in (
        [(0, y, z) for y in (-1, 0) for z in (-1, 1)], [(0, y, z) for y in (0, 1) for z in (-1, 1)])]
    scene = ep.Scene()
    for name, half in zip("ab", cut):
        scene.add(half, name=name, material=ep.Material.metal())
    points = on_edges(trace(scene, radar_at(), max_bounces=1))
    middle = np.abs(points.points(0.0)[np.asarray(points.offsets)][:, 1])
    assert len(middle) > 0 and not np.any((middle < 1e-6) & (middle == middle.min()))


def test_meshes_that_move_apart_have_rims_of_their_own():
    motions = [ep.LinearMotion(velocity=(0.0, 0.0, 1.0)), *[None] * 5]
    one, apart = (on_edges(trace(parts_scene(box((0.4, 0.5, 0.6)), motions), radar_at(), max_bounces=1)).num_paths
                  for motions in (None, motions))
    assert apart > one


@pytest.mark.parametrize("material, has_edges", [
    (ep.Material.metal(), True), (ep.Material(reflectivity=0.25), True), (ep.Material(permittivity=4.0 - 0.2j), False)])
def test_edges_of_conductors_make_echoes(material, has_edges):
    paths = trace(scene_of(sheet(), material=material), radar_at())
    assert (on_edges(paths).num_paths > 0) == has_edges


def test_a_surface_that_reflects_less_has_weaker_edges():
    full, half = (fields(on_edges(trace(scene_of(sheet(), material=material), radar_at()))).sum()
                  for material in (ep.Material.metal(), ep.Material(reflectivity=0.25)))
    assert half == pytest.approx(0.5 * full, rel=1e-5)


def test_round_bodies_have_none():
    assert on_edges(trace(scene_of(sphere((0.0, 0.0, 0.0), 0.2, 3)), radar_at())).num_paths == 0


def test_without_the_keyword_nothing_is_looked_for():
    paths = trace(scene_of(sheet()), radar_at(), edges=False)
    assert not paths.frame.edges and not np.any(np.asarray(paths.flags) & 4)
    assert on_edges(paths).num_paths == 0


def test_effects_say_with_what_power():
    off, on = ({effect.name: effect for effect in trace(scene_of(sheet()), radar_at(), edges=edges).effects}
               for edges in (False, True))
    assert not off["edge diffraction"].modelled and "not looked for: the strongest would carry" in off["edge diffraction"].reason
    assert on["edge diffraction"].modelled and "dBm" in on["edge diffraction"].reason


def test_auto_looks_for_edges_where_they_stand_out_of_the_noise():
    near, far = (radar_at((x, 0.5, 0.0)) for x in (8.0, 8e4))
    for radar, is_on in ((near, True), (far, False)):
        paths = trace(scene_of(sheet(), yaw=0.5), radar, edges="auto")
        assert paths.frame.edges == is_on
        effect, = (one for one in ep.effects(scene_of(sheet(), yaw=0.5), radar, edges="auto") if one.name == "edge diffraction")
        assert effect.modelled == is_on and "edges = 'auto': the strongest would carry" in effect.reason
        recorded, = (one for one in paths.effects if one.name == "edge diffraction")  # which knows no more than what was done
        assert recorded.modelled == is_on and recorded.reason.startswith("looked for: " if is_on else "not looked for: ")
    off = trace(scene_of(sheet()), far, edges=False)
    assert np.array_equal(off.weight, trace(scene_of(sheet()), far, edges="auto").weight)


def test_auto_does_not_depend_on_the_order_of_the_antennas():
    """Of an upright plate, whose upright edges send nothing to a level antenna that is asked first."""
    for order in ((0, 1), (1, 0)):
        radar = radar_at((8.0, 0.5, 0.0))
        both = [radar.receivers[0], radar.receivers[0].replace(polarization=(0.0, 1.0, 0.0))]
        paths = trace(scene_of(sheet(), yaw=0.5), radar.replace(receivers=[both[index] for index in order]), edges="auto")
        assert paths.frame.edges


def test_the_estimate_is_near_the_strongest_edge():
    """Of a plate seen across two of its edges, whose echo is about that of both."""
    radar = radar_at((6.0, 6.0, 0.0))
    reason = next(one.reason for one in ep.effects(scene_of(sheet()), radar) if one.name == "edge diffraction")
    power = ep.received_power(on_edges(trace(scene_of(sheet()), radar))).power
    assert float(reason.split("carry ")[1].split(" dBm")[0]) == pytest.approx(10.0 * math.log10(power / 1e-3), abs=4.0)


def test_effects_name_those_without_edges():
    scene = scene_of(sheet())
    scene.add(sheet(), name="board", material=ep.Material(permittivity=4.0 - 0.2j), position=(1.0, 0.0, 0.0))
    reason = next(one.reason for one in ep.effects(scene, radar_at(), edges=True) if one.name == "edge diffraction")
    assert "left out: those of 1 mesh: board, of dielectrics" in reason


def test_frames_take_the_keyword():
    frame = ep.simulate(scene_of(sheet(), yaw=0.5), radar_at(num_chirps=4), num_rays=500, edges=True, guard=False)
    assert on_edges(frame.paths).num_paths > 0
    with pytest.raises(ValueError, match="edges: must be True, False or 'auto'"):
        ep.simulate(scene_of(sheet()), radar_at(), edges="yes")
