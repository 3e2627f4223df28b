"""Pictures that stand alone: axes named, numbers as print has them, nothing beyond the edge."""
from __future__ import annotations

from types import SimpleNamespace

import numpy as np

from echopath import plots
from echopath.plots.scene_view import _is_cut
from echopath.signals.measures import for_pictures


def power_of(level_dbm: float, half_db: float, resolved: bool):
    low, power, high = (1e-3 * 10.0 ** (0.1 * (level_dbm + off)) for off in (-half_db, 0.0, half_db))
    return SimpleNamespace(power=power, low=low, high=high, resolved=resolved, interval_db=half_db)


def test_numbers_in_pictures_have_minus_signs():
    assert for_pictures("-95.68 to -91.65 dBm +- 0.2 dB") == "−95.68 to −91.65 dBm ± 0.2 dB"
    assert for_pictures("wall-2, side-by-side") == "wall-2, side-by-side"


def test_the_numbers_of_part_powers_stay_within_the_figure():
    powers = {"direct": power_of(-95.0, 2.0, False), "floor": power_of(-81.3, 0.2, True), "none": power_of(-400.0, 0.0, True)}
    powers["none"].power = 0.0
    figure = plots.plot_part_powers(powers)
    figure.canvas.draw()
    renderer, frame = figure.canvas.get_renderer(), figure.bbox
    texts = [text for axes in figure.axes for text in axes.texts]
    assert len(texts) == 3
    for text in texts:
        box = text.get_window_extent(renderer)
        assert frame.x0 <= box.x0 and box.x1 <= frame.x1, text.get_text()
    assert not figure.axes[0].patches  # no bars: a level in dB has no zero to begin at


def test_maps_of_parts_with_small_print_name_their_range():
    spectrum = SimpleNamespace(values=np.ones((1, 1, 8, 8), complex), range=np.arange(8.0), velocity=np.arange(-4.0, 4.0))
    figure = plots.plot_partition({"a": spectrum, "b": spectrum}, note="small print")
    assert [axes.get_xlabel() for axes in figure.axes[:2]] == ["Range in m"] * 2


def test_mirrors_have_no_edge_where_the_picture_cuts_them():
    low, high = np.zeros(3), np.full(3, 2.0)
    on_border = np.array([[2.0, 0.3, 0.1], [2.0, 1.1, 0.1]])
    assert _is_cut(on_border, low, high) and not _is_cut(on_border - [0.5, 0.0, 0.0], low, high)
    assert not _is_cut(np.array([[2.0, 0.3, 0.1], [1.0, 0.3, 0.1]]), low, high)  # which only ends there
