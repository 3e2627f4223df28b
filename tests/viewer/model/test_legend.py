"""Rows of the legend of objects."""
import time
from types import SimpleNamespace

import numpy as np

from echopath_viewer.model import colours


def test_a_legend_of_many_objects_is_made_at_once():
    houses = 4000
    names = [f"house_{mesh // 2}/{mesh % 2}" for mesh in range(2 * houses)]
    meshes = np.concatenate([np.arange(2 * houses), [10, 11, 11, 7000, -1]])
    palette = np.repeat(np.arange(houses) % 256, 2)[:, None].astype(np.uint8) * np.ones(3, np.uint8)
    began = time.process_time()
    legend = colours._legend_of_objects(SimpleNamespace(mesh_id=meshes), palette, names)
    assert time.process_time() - began < 0.25  # s; counted anew for each house it was seconds
    rows = dict(legend.rows)
    assert len(rows) == colours.MAX_LEGEND_ROWS and legend.num_more == houses - len(rows)
    assert rows["house_5"] == (5, 5, 5) and rows["house_3500"] == (172, 172, 172) and rows["house_0"] == (0, 0, 0)
    assert list(rows)[-1] == "house_3500"  # in the order of the meshes
