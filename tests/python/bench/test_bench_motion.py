"""`echopath bench worlds`, its street before a radar that moves."""
import numpy as np

import echopath as ep
from echopath.bench.worlds import crowd_scene, motion, moved
from echopath.paths.absent import NO_STRATUM

RAYS = 200


def image_lengths(paths):
    """Lengths in m of the paths over mirrors alone at the start and in the middle of the frame, ascending."""
    times = [paths.frame.start_time, paths.frame.trace_time]
    return np.sort(np.asarray(paths.lengths(times, 0, 0))[:, np.asarray(paths.stratum) == NO_STRATUM])


def test_street_that_moves_past_has_the_lengths_of_a_radar_that_drives():
    """Both are the same motion, seen from the radar."""
    forward, back = ep.LinearMotion(velocity=(motion.SPEED, 0.0, 0.0)), ep.LinearMotion(velocity=(-motion.SPEED, 0.0, 0.0))
    driving = ep.trace(motion.street(), crowd_scene.radar(forward), num_rays=RAYS)
    passing = ep.trace(motion.street(back), crowd_scene.radar(), num_rays=RAYS)
    lengths = image_lengths(driving)
    assert lengths.shape[1] > 3
    np.testing.assert_allclose(lengths, image_lengths(passing), rtol=1e-12)


def test_rows_name_what_misses_its_limit():
    row = {"name": "radar drives", "paths": 1, "ns": 2.0 * motion.LIMIT_NS, "over_reference": 1.0, "error": 0.0,
           "timed": True}
    lines = motion.describe([row, row | {"ns": 0.0}])
    assert lines[1].endswith("MISSED ns") and lines[2].endswith("holds")


def test_rows_of_moved_objects_stand_beside_embree_alone():
    rows = moved.rows(quick=True)
    assert all(row["first_s"] > 0.0 and row["again_s"] > 0.0 and row["bare_s"] > 0.0 for row in rows)
    assert [row["meshes"] for row in rows] == [moved.QUICK_HOUSES + 2, moved.QUICK_BOXES + 1, 1, 1]
    assert len(moved.describe(rows)) == len(rows) + 2
