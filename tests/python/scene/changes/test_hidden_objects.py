"""Objects that are hidden take part in nothing, and are kept."""
from __future__ import annotations

import pytest

import echopath as ep
from support.street import NUM_RAYS, assert_same_bits, box_mesh, built, radar, street_table, traced


def test_what_is_hidden_leaves_the_record_of_a_scene_without_it(table):
    """Arrays, mesh IDs and strata; but for the indices of nodes, which count what is hidden."""
    hidden, without = built(table), built(table)
    hidden["bus"].visible = False
    without.remove("bus")
    one, other = traced(hidden), traced(without)
    assert_same_bits(one, other)
    assert [mesh.name for mesh in hidden.meshes] == [mesh.name for mesh in without.meshes]
    assert hidden.num_triangles == without.num_triangles
    strata = [[(stratum.name, stratum.num_rays) for stratum in paths.frame.strata] for paths in (one, other)]
    assert strata[0] == strata[1]
    assert [(effect.modelled, effect.reason) for effect in one.effects] == [(e.modelled, e.reason) for e in other.effects]


def test_what_is_hidden_takes_part_in_nothing():
    scene = ep.Scene()
    scene.add(box_mesh(1, 1, 1), name="near", position=(8, 0, 0), material="metal")
    scene.add(box_mesh(1, 2, 2), name="far", position=(12, 0, 0), material="metal")
    scene.add(box_mesh(1, 1, 1), name="copy", position=(8, 0, 0), material="metal")
    assert scene.coplanar_overlaps()
    scene["copy"].visible = False
    assert not scene.coplanar_overlaps()
    scene["near"].visible = False
    seen = ep.visibility(scene, radar())
    assert [one.name for one in seen] == ["far"]
    assert seen[0].transmitter.visible_share == 1.0
    frame = ep.simulate(scene, radar(), num_rays=NUM_RAYS, labels=True, guard=False)
    assert [one.name for one in next(iter(frame.labels.values())).objects] == ["far"]
    with pytest.raises(IndexError):
        scene.world_vertices(1)


def test_motions_of_what_is_hidden_need_not_cover_the_frame():
    scene = ep.Scene()
    scene.add(box_mesh(1, 1, 1), name="box", position=(8, 0, 0), material="metal")
    late = ep.KeyframeMotion(times=[5.0, 6.0], translations=[(0, 0, 0), (1, 0, 0)])
    scene.add(box_mesh(1, 1, 1), name="late", position=(8, 3, 0), material="metal", motion=late, visible=False)
    assert ep.trace(scene, radar(), num_rays=NUM_RAYS).num_paths > 0
    scene["late"].visible = True
    with pytest.raises(ValueError, match="late"):
        ep.trace(scene, radar(), num_rays=NUM_RAYS)


def test_selections_and_objects_may_name_what_is_hidden(table):
    scene = built(table)
    scene["bus"].visible = False
    paths = traced(scene)
    assert paths.select("T .* 'bus' .* R").num_paths == 0
    assert paths.select("T .* 'bus/body' .* R").num_paths == 0
    assert paths.select("T [^ 'bus']* R").num_paths == paths.num_paths
    found = ep.families(paths, ["bus", "box1"])
    assert found.objects == ("box1",)
    assert ep.families(paths, ["bus"]).objects == ()
    with pytest.raises(ValueError, match="bux"):
        paths.select("T 'bux' R")
    with pytest.raises(ValueError, match="bux"):
        ep.families(paths, ["bux"])


def test_frame_files_keep_what_is_hidden(table, tmp_path):
    scene = built(table)
    scene["bus"].visible = False
    scene["box3"].visible = False
    paths = traced(scene)
    paths.save(tmp_path / "frame.h5")
    read = ep.Paths.load(tmp_path / "frame.h5")
    assert_same_bits(read, paths)
    again = ep.Scene(read.scene)
    assert not again["bus"].visible and not again["box3"].visible and again["box4"].visible
    again["bus"].visible = again["box3"].visible = True
    assert_same_bits(traced(again), traced(built(street_table())))


def test_hidden_parts_stay_hidden_when_their_group_is_shown(table):
    scene = built(table)
    scene["bus/wheel"].visible = False
    scene["bus"].visible = False
    assert scene["bus/body"].visible  # its own flag
    scene["bus"].visible = True
    assert [mesh.name for mesh in scene["bus"].meshes] == ["bus/body", "bus/mirror"]
