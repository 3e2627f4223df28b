"""Pictures: what is cut off, what is cropped, and that the same figure gives the same file."""
from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from echopath.plots import colour_limits, plot_overview, plot_partition, plot_range_doppler, power_dbm, save_png
from echopath.plots.clip import clip_triangles, outline

AREA_TOLERANCE = 1e-12


def area(polygon) -> float:
    fan = np.cross(polygon[1:-1] - polygon[0], polygon[2:] - polygon[0])
    return 0.5 * float(np.linalg.norm(fan, axis=1).sum())


def test_the_pieces_of_triangles_in_all_cells_of_a_grid_have_their_area():
    triangles = np.random.default_rng(1).uniform(0.0, 3.0, (40, 3, 3))
    cells = [np.array([i, j, k], float) for i in range(3) for j in range(3) for k in range(3)]
    pieces = [area(polygon) for low in cells for polygon in clip_triangles(triangles, low, low + 1.0)]
    assert sum(pieces) == pytest.approx(sum(map(area, triangles)), rel=AREA_TOLERANCE)


def test_clipped_polygons_stay_inside_the_box():
    triangles = np.random.default_rng(2).uniform(-2.0, 3.0, (40, 3, 3))
    for polygon in clip_triangles(triangles, np.zeros(3), np.ones(3)):
        assert polygon.min() >= -AREA_TOLERANCE and polygon.max() <= 1.0 + AREA_TOLERANCE


def test_the_outline_of_two_triangles_leaves_out_their_common_edge():
    square = [np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0.0]]), np.array([[0, 0, 0], [1, 1, 0], [0, 1, 0.0]])]
    lengths = [float(np.linalg.norm(edge[1] - edge[0])) for edge in outline(square)]
    assert lengths == [1.0] * 4


@pytest.fixture
def spectrum():
    rng = np.random.default_rng(3)
    values = 1e-8 * (rng.normal(size=(1, 1, 64, 128)) + 1j * rng.normal(size=(1, 1, 64, 128)))
    values[0, 0, 20, 40] = 1e-5
    return SimpleNamespace(values=values, velocity=np.arange(-32, 32) * 0.1, range=np.arange(128) * 0.15)


def test_a_map_shows_power_in_dbm(spectrum):
    assert power_dbm(spectrum)[20, 40] == pytest.approx(-70.0)  # 1e-10 W


def test_a_map_is_cropped_to_its_signal_and_keeps_it(spectrum):
    axes = plot_range_doppler(spectrum).axes[0]
    left, right = axes.get_xlim()
    bottom, top = axes.get_ylim()
    assert left < 6.0 < right and right - left < 7.0
    assert bottom < -1.2 < top and top - bottom < 4.0


def test_all_parts_share_one_colour_scale(spectrum):
    weak = SimpleNamespace(values=1e-3 * spectrum.values, velocity=spectrum.velocity, range=spectrum.range)
    figure = plot_partition({"strong": spectrum, "weak": weak}, whole=spectrum)
    scales = {axes.get_images()[0].get_clim() for axes in figure.axes if axes.get_images()}
    assert scales == {colour_limits(spectrum)}


def with_clutter(spectrum):
    """The same with an echo at rest, far behind the one that moves."""
    values = spectrum.values.copy()
    values[0, 0, 32, 110] = 1e-5  # 16.5 m, 0 m/s
    return SimpleNamespace(values=values, velocity=spectrum.velocity, range=spectrum.range)


def test_parts_are_cropped_to_what_moves_and_the_whole_is_not(spectrum):
    whole = with_clutter(spectrum)
    figure = plot_overview(whole, {"all of it": whole})
    upper, lower = [axes for axes in figure.axes if axes.get_images()]
    assert upper.get_xlim()[0] < 6.0 and upper.get_xlim()[1] > 16.5
    assert lower.get_xlim()[0] < 6.0 < lower.get_xlim()[1] < 8.0
    assert upper.get_images()[0].get_clim() == lower.get_images()[0].get_clim()


def test_parts_that_are_all_at_rest_are_shown_whole(spectrum):
    values = with_clutter(spectrum).values
    values[0, 0, 20, 40] = 0.0
    still = SimpleNamespace(values=values, velocity=spectrum.velocity, range=spectrum.range)
    axes = plot_partition({"wall": still}).axes[0]
    assert axes.get_xlim()[0] < 16.5 < axes.get_xlim()[1]


def test_the_colour_scale_begins_above_the_noise_and_ends_above_the_peak(spectrum):
    vmin, vmax = colour_limits(spectrum)
    assert np.median(power_dbm(spectrum)) < vmin < -70.0 <= vmax


def test_the_same_figure_gives_the_same_file(spectrum, tmp_path):
    for name in ("one.png", "two.png"):
        save_png(plot_range_doppler(spectrum), tmp_path / name)
    assert (tmp_path / "one.png").read_bytes() == (tmp_path / "two.png").read_bytes()
