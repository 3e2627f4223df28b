"""Pictures: what is cut off, what is cropped, and what shares a scale."""
from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

import echopath as ep
from echopath import plots
from echopath.cli import run
from echopath.plots import (
    colour_limits,
    plot_overview,
    plot_partition,
    plot_range_azimuth,
    plot_range_doppler,
    power_dbm,
    save_png,
)
from echopath.plots.clip import clip_triangles, outline
from support.radars import build_radar

AREA_TOLERANCE = 1e-12
PLACE = 0.005  # m, of corners of cells about the brightest one; 8e-4 found


def area(polygon) -> float:
    fan = np.cross(polygon[1:-1] - polygon[0], polygon[2:] - polygon[0])
    return 0.5 * float(np.linalg.norm(fan, axis=1).sum())


def test_the_pieces_of_triangles_in_all_cells_of_a_grid_have_their_area():
    triangles = np.random.default_rng(1).uniform(0.0, 3.0, (40, 3, 3))
    cells = [np.array([i, j, k], float) for i in range(3) for j in range(3) for k in range(3)]
    pieces = [area(polygon) for low in cells for polygon in clip_triangles(triangles, low, low + 1.0)]
    assert sum(pieces) == pytest.approx(sum(map(area, triangles)), rel=AREA_TOLERANCE, abs=0)


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
    return SimpleNamespace(values=values, velocity=np.arange(-32, 32) * 0.1, range=np.arange(128) * 0.15,
                           window="hann", zero_pad=1)


@pytest.mark.parametrize("draw, argument", [
    (ep.plots.draw_range_doppler, "spectrum"), (ep.plots.draw_labels, "labels"), (ep.plots.draw_spectrogram_labels, "labels")])
def test_tables_of_what_is_drawn_are_refused_by_name(draw, argument, spectrum):
    """What a frame has by the names of its partitions, in the place of one of these."""
    with pytest.raises(TypeError, match=f"^{argument}: must be "):
        draw({"parts": spectrum})
    with pytest.raises(TypeError, match=f"^{argument}: must be "):
        draw(SimpleNamespace(values=spectrum.values, whole=spectrum.values, dominant=spectrum.values, part_names=["other"]))


@pytest.mark.parametrize("draw, argument", [
    (lambda table, spectrum: plots.plot_partition({"wall": table}), "spectra"),
    (lambda table, spectrum: plots.plot_partition({"wall": 5.0}), "spectra"),
    (lambda table, spectrum: plots.plot_partition({"wall": SimpleNamespace(velocity=spectrum.velocity, power=1.0)}), "spectra"),
    (lambda table, spectrum: plots.plot_partition(table, whole=table), "whole"),
    (lambda table, spectrum: plots.plot_overview(table, table), "whole"),
    (lambda table, spectrum: plots.plot_overview(spectrum, {"wall": None}), "spectra"),
    (lambda table, spectrum: plots.plot_overview(spectrum, table, powers={"parts": table}), "powers"),
    (lambda table, spectrum: plots.plot_partition(table, powers=[1.0]), "powers"),
    (lambda table, spectrum: plots.plot_part_powers({"wall": table}), "powers"),
    (lambda table, spectrum: plots.plot_labels(SimpleNamespace(part_names=[], ghosts=[]), powers={"parts": table}), "powers"),
    (lambda table, spectrum: plots.plot_labels(SimpleNamespace(part_names=[], ghosts=[]), powers=[1.0]), "powers")])
def test_partitions_in_the_place_of_one_are_refused_by_name(draw, argument, spectrum):
    with pytest.raises(TypeError, match=f"^{argument}: must be "):
        draw({"wall": spectrum}, spectrum)


def test_no_map_from_above_is_refused():
    with pytest.raises(ValueError, match="^maps: must be "):
        plots.plot_range_azimuth({})


def test_a_map_shows_power_in_dbm(spectrum):
    assert power_dbm(spectrum)[20, 40] == pytest.approx(-70.0)  # 1e-10 W


def test_a_map_is_cropped_to_its_signal_and_keeps_it(spectrum):
    axes = plot_range_doppler(spectrum).axes[0]
    left, right = axes.get_xlim()
    bottom, top = axes.get_ylim()
    assert left < 6.0 < right and right - left < 7.0
    assert bottom < -1.2 < top and top - bottom < 4.0


def test_wide_cells_are_shown_whole_with_their_neighbours(spectrum):
    """The signal lies in one cell of 4 m/s and 6 m, much wider than the margins in m/s and m."""
    spectrum.velocity, spectrum.range = np.arange(-32, 32) * 4.0, np.arange(128) * 6.0
    axes = plot_range_doppler(spectrum).axes[0]
    assert axes.get_xlim() == pytest.approx((240.0 - 9.0, 240.0 + 9.0))  # its cell and one on either side
    assert axes.get_ylim() == pytest.approx((-48.0 - 6.0, -48.0 + 6.0))


def test_all_parts_share_one_colour_scale(spectrum):
    weak = with_values(spectrum, 1e-3 * spectrum.values)
    figure = plot_partition({"strong": spectrum, "weak": weak}, whole=spectrum)
    scales = {axes.get_images()[0].get_clim() for axes in figure.axes if axes.get_images()}
    assert scales == {colour_limits(spectrum)}


def test_levels_stand_with_their_errors_or_with_what_would_give_them(spectrum):
    power = SimpleNamespace(power=1e-10, low=0.99e-10, high=1.01e-10, interval_db=0.04, resolved=True)
    known = plot_overview(spectrum, {"arm": spectrum}, powers={"arm": power})
    assert "arm\n−70.00 dBm ± 0.04 dB" in [axes.get_title() for axes in known.axes]
    for figure in (plot_range_doppler(spectrum, note="no errors"), plot_partition({"arm": spectrum}, note="no errors")):
        assert "no errors" in [text.get_text() for text in figure.texts]


def with_values(spectrum, values):
    return SimpleNamespace(**vars(spectrum) | {"values": values})


def with_clutter(spectrum):
    """The same with an echo at rest, far behind the one that moves."""
    values = spectrum.values.copy()
    values[0, 0, 32, 110] = 1e-5  # 16.5 m, 0 m/s
    return with_values(spectrum, values)


def test_parts_are_cropped_to_what_moves_and_the_whole_is_not(spectrum):
    whole = with_clutter(spectrum)
    figure = plot_overview(whole, {"all of it": whole})
    upper, lower = [axes for axes in figure.axes if axes.get_images()]
    assert upper.get_xlim()[0] < 6.0 and upper.get_xlim()[1] > 16.5
    assert lower.get_xlim()[0] < 6.0 < lower.get_xlim()[1] < 8.0
    assert upper.get_images()[0].get_clim() == lower.get_images()[0].get_clim()


def test_parts_are_shown_whole_to_a_radar_that_moves(spectrum):
    """To it what stands has a velocity, too: none tells what moves."""
    part, whole = with_clutter(spectrum), with_clutter(spectrum)
    whole.values[0, 0, 20, 10] = 1e-5  # nearer than all of the part
    figure = plot_overview(whole, {"all of it": part}, radar_moves=True)
    lower = [axes for axes in figure.axes if axes.get_images()][1]
    assert 3.0 < lower.get_xlim()[0] < 6.0 and lower.get_xlim()[1] > 16.5
    assert figure.subfigs[1].get_supxlabel() == "Range in m, where the parts are"


def test_a_part_at_rest_beside_one_that_moves_is_shown_and_the_rest_is_not(spectrum):
    def at(cell: int, row: int):
        values = 1e-3 * spectrum.values
        values[0, 0, 20, 40] = 0.0
        values[0, 0, row, cell] = 1e-5
        return with_values(spectrum, values)

    walker, corner, clutter = at(40, 20), at(80, 32), at(120, 32)  # 6 m, 12 m at rest, 18 m at rest
    left, right = plot_partition({"walker": walker, "corner": corner, "other": clutter}).axes[0].get_xlim()
    assert left < 6.0 and 12.0 < right < 18.0


@pytest.mark.parametrize("zero_pad, window", [(1, "hann"), (2, "rect"), (1, ("rect", "hann"))])
def test_the_main_lobe_of_what_stands_does_not_move(spectrum, zero_pad, window):
    """Cells of 0.6 m/s: the null of Hann's window is 1.2 m/s away, that of a rectangle of half as many chirps too."""
    values = with_clutter(spectrum).values
    values[0, 0, 31, 110] = values[0, 0, 33, 110] = 0.5e-5
    coarse = SimpleNamespace(values=values, velocity=6.0 * spectrum.velocity, range=spectrum.range, window=window,
                             zero_pad=zero_pad)
    left, right = plot_partition({"all of it": coarse}).axes[0].get_xlim()
    assert left < 6.0 < right < 8.0


def test_parts_that_are_all_at_rest_are_shown_whole(spectrum):
    values = with_clutter(spectrum).values
    values[0, 0, 20, 40] = 0.0
    axes = plot_partition({"wall": with_values(spectrum, values)}).axes[0]
    assert axes.get_xlim()[0] < 16.5 < axes.get_xlim()[1]


def test_the_colour_scale_begins_above_the_noise_and_ends_above_the_peak(spectrum):
    vmin, vmax = colour_limits(spectrum)
    assert np.median(power_dbm(spectrum)) < vmin < -70.0 <= vmax


def test_leakage_sets_no_scale(spectrum):
    """50 dB above the echo, in cells of its own: the scale is that of the same map without it."""
    leakage, values = np.zeros_like(spectrum.values), spectrum.values.copy()
    leakage[0, 0, 31:34, :3] = 3e-3
    whole, leaked = (with_values(spectrum, some) for some in (values + leakage, leakage))
    assert colour_limits(whole, leaked) == colour_limits(spectrum) != colour_limits(whole)
    assert colour_limits(leaked, leaked) == colour_limits(leaked)  # where there is nothing else


@pytest.fixture(scope="module")
def leaking():
    """(frame of a corner and a mover that the radar's array sees, the same with the leakage of its transmitter): each channel of
    the leakage is 3 dBm."""
    scene, aside = ep.Scene(), np.array([np.cos(0.3), np.sin(0.3), 0.0])
    scene.add(ep.actors.trihedral(0.1), name="corner", material="metal", position=(15.0, 0.0, 0.0))
    scene.add(ep.actors.trihedral(0.1), name="mover", material="metal", position=12.0 * aside, yaw=0.3,
              motion=ep.LinearMotion(-3.0 * aside))
    radar = build_radar(receivers=[(0, 1.9e-3 * k, 0) for k in range(4)], bandwidth=0.5e9, num_samples=128, num_chirps=32,
                        transmit_power=0.02)
    receiver = ep.Receiver(leakage_db=[[-10.0] * 4], leakage_delay=0.3e-9)
    parts = {"mover": "T 'mover' R"}
    return [ep.simulate(scene, one, num_rays=500, guard=False, parts=parts) for one in (radar, radar.replace(receiver=receiver))]


def scale_of(axes) -> tuple[float, float]:
    return (axes.get_images() or axes.collections)[0].get_clim()


def test_frames_with_leakage_are_drawn_as_those_without(leaking):
    clean, leaked = leaking
    assert np.ptp(power_dbm(leaked.spectrum)) > 110.0  # dB: what a scale of 70 dB cannot hold
    assert scale_of(leaked.plot()) == scale_of(clean.plot()) == colour_limits(clean.spectrum)


def test_pictures_of_a_run_with_leakage_have_the_scale_of_the_scene(leaking, tmp_path, monkeypatch):
    scales = []
    for frame in leaking:
        figures = {}
        monkeypatch.setattr(plots, "save_png", lambda figure, path, **_: figures.update({path.name: figure}))
        list(run._write_pictures(frame, tmp_path, ["parts"]))
        scales.append({name: {scale_of(axes) for axes in figure.axes if axes.get_images() or axes.get_aspect() == 1.0}
                       for name, figure in figures.items() if name != "scene.png"})
    assert scales[0].keys() == {"map.png", "parts.png", "overview.png", "range_azimuth.png"}
    assert all(len(found) == 1 for found in scales[0].values()) and scales[0] == scales[1]


@pytest.fixture
def from_above():
    """Noise and one strong cell at 30 degrees to the left, 6 m away."""
    azimuth = np.radians(np.arange(-60.0, 61.0, 2.0))
    power = 1e-16 * np.random.default_rng(4).exponential(size=(len(azimuth), 128))
    power[45, 40] = 1e-10
    return SimpleNamespace(azimuth=azimuth, range=np.arange(128) * 0.15, power=power)


def brightest_corner(axes):
    """Mean of the corners (left, ahead) in m of the brightest cell of a picture from above."""
    mesh = axes.collections[0]
    row, column = np.unravel_index(mesh.get_array().argmax(), mesh.get_array().shape)
    return mesh.get_coordinates()[row:row + 2, column:column + 2].reshape(-1, 2).mean(axis=0)


def test_left_is_left_and_ahead_is_up_from_above(from_above):
    axes = plot_range_azimuth(from_above).axes[0]
    left, ahead = brightest_corner(axes)
    assert left == pytest.approx(6.0 * np.sin(np.radians(30.0)), abs=PLACE)
    assert ahead == pytest.approx(6.0 * np.cos(np.radians(30.0)), abs=PLACE)
    assert axes.get_xlim()[0] > left > axes.get_xlim()[1]  # larger to the left
    assert axes.get_ylim()[0] < ahead < axes.get_ylim()[1] < 9.0


def test_labels_of_a_map_from_above_stand_beside_its_axes(from_above):
    """Not at the edge of the figure, which a sector of another shape does not fill."""
    axes = plot_range_azimuth(from_above).axes[0]
    assert axes.get_xlabel().startswith("To the left in m") and axes.get_ylabel() == "Ahead in m"


def test_all_maps_from_above_share_one_scale_and_the_farthest_reach(from_above):
    power = 1e-3 * from_above.power
    power[10, 100] = 1e-12  # 15 m
    weak = SimpleNamespace(azimuth=from_above.azimuth, range=from_above.range, power=power)
    figure = plot_range_azimuth({"strong": from_above, "weak": weak})
    panels = [axes for axes in figure.axes if axes.get_title() in ("strong", "weak")]
    assert len({axes.collections[0].get_clim() for axes in panels}) == 1
    assert all(axes.get_ylim()[1] > 15.0 for axes in panels)


# m, as the triangle is wide and high


def test_a_map_from_above_of_noise_alone_is_shown_whole(from_above):
    noise = SimpleNamespace(azimuth=from_above.azimuth, range=from_above.range, power=np.minimum(from_above.power, 3e-16))
    figure = plot_range_azimuth(noise)
    assert figure.axes[0].get_ylim()[1] > from_above.range[-1]
    assert plot_range_azimuth(from_above).axes[0].get_ylim()[1] < from_above.range[-1]


def test_maps_from_above_of_nothing_and_of_one_cell_are_pictures_too(from_above, tmp_path):
    nothing = SimpleNamespace(azimuth=from_above.azimuth, range=from_above.range, power=0.0 * from_above.power)
    single = SimpleNamespace(azimuth=np.zeros(1), range=np.zeros(1), power=np.ones((1, 1)))
    for name, one in (("nothing", nothing), ("single", single)):
        save_png(plot_range_azimuth(one), tmp_path / f"{name}.png")
