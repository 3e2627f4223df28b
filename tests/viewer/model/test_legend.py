"""Rows of the legend of objects."""
from types import SimpleNamespace

import numpy as np

from echopath_viewer.model import colours


class CountedName(str):
    """A name that counts how often one is compared with another."""

    comparisons = 0
    __hash__ = str.__hash__

    def __eq__(self, other):
        CountedName.comparisons += 1
        return str.__eq__(self, other)


def test_a_legend_of_many_objects_is_made_at_once(monkeypatch):
    object_of = colours.object_of
    monkeypatch.setattr(colours, "object_of", lambda name: CountedName(object_of(name)))
    houses = 4000
    names = [f"house_{mesh // 2}/{mesh % 2}" for mesh in range(2 * houses)]
    meshes = np.concatenate([np.arange(2 * houses), [10, 11, 11, 7000, -1]])
    palette = np.repeat(np.arange(houses) % 256, 2)[:, None].astype(np.uint8) * np.ones(3, np.uint8)
    legend = colours._legend_of_objects(SimpleNamespace(mesh_id=meshes), palette, names)
    assert 0 < CountedName.comparisons < 50 * len(names)  # counted anew for each house there were 4000 for each name
    rows = dict(legend.rows)
    assert len(rows) == colours.MAX_LEGEND_ROWS and legend.num_more == houses - len(rows)
    assert rows["house_5"] == (5, 5, 5) and rows["house_3500"] == (172, 172, 172) and rows["house_0"] == (0, 0, 0)
    assert list(rows)[-1] == "house_3500"  # in the order of the meshes
