"""Pictures: what is cut off, what is cropped, and what shares a scale."""
from __future__ import annotations

import itertools
from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.collections import PolyCollection
from matplotlib.transforms import Bbox
from mpl_toolkits.mplot3d.proj3d import proj_transform

import echopath as ep
from echopath import plots
from echopath.cli import run
from echopath.plots import (
    colour_limits,
    plot_overview,
    plot_partition,
    plot_range_azimuth,
    plot_range_doppler,
    plot_scene,
    power_dbm,
    save_png,
)
from echopath.plots.clip import clip_triangles, outline
from echopath.plots.scene_view import drawing
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


def test_a_picture_of_a_scene_names_its_objects():
    scene = ep.Scene()
    scene.add(ep.actors.ground(20.0), name="ground", material=ep.Material.metal(mirror=True))
    for k in range(3):
        scene.add(ep.actors.plate(0.3, 0.3), name=f"plate{k}", material="metal", position=(5.0 + k, k, 1.0))
    radar = build_radar([(0, 0, 1)], [(0, 0, 1)], num_samples=16, num_chirps=2, chirp_interval=1e-4)
    paths = ep.trace(scene, radar, num_rays=500)
    figure = plot_scene(scene, paths)
    for axes in figure.axes[:2]:  # in perspective, from above
        assert {text.get_text().strip() for text in axes.texts} >= {"plate0", "plate1", "plate2"}
    assert "ground" in {text.get_text().strip() for text in figure.axes[0].texts}


def on_a_field(length: float, width: float, height: float, box_size: float = 0.5):
    """A picture of a box that hovers above the farther end of a field, which is no mirror."""
    scene = ep.Scene()
    scene.add(ep.actors.ground((length, width)), name="field", material="grass", position=(0.5 * length, 0, 0))
    middle = 0.8 * length, 0.2 * width, height - 0.5 * box_size
    scene.add(ep.actors.box(box_size), name="box", material="metal", position=middle)
    radar = build_radar([(0, 0, 1)], [(0, 0, 1)], num_samples=16, num_chirps=2, chirp_interval=1e-4)
    return plot_scene(scene, ep.trace(scene, radar, num_rays=200), objects=["field", "box"])


def test_a_field_hides_neither_what_stands_on_its_farther_half_nor_rays():
    """As seen where the box and the way to it are on the page, which have other colours than the field."""
    figure = on_a_field(120.0, 20.0, 4.0, box_size=3.0)
    figure.canvas.draw()
    axes = figure.axes[0]
    picture = np.asarray(figure.canvas.buffer_rgba())[..., :3].astype(int)

    def colour(*place) -> np.ndarray:
        across, up = axes.transData.transform(proj_transform(*place, axes.get_proj())[:2])
        return picture[int(len(picture) - up), int(across)]

    field = colour(60.0, -5.0, 0.0)
    assert np.abs(colour(60.0, -7.0, 0.0) - field).max() == 0
    assert np.abs(colour(94.5, 4.0, 2.5) - field).max() > 10    # the side of the box that faces the radar
    assert np.abs(colour(47.25, 2.0, 1.75) - field).max() > 10  # half-way between the radar and that side


@pytest.mark.parametrize("view, dark_side", [(0, (-0.5, -0.7, -0.5)), (1, (0.6, 0.5, 0.6))])
def test_a_hill_hides_neither_what_stands_on_it_nor_rays(view, dark_side):
    """A road of 10 % whose middle lies above the ball at its foot, in perspective and from above, as seen on the page."""
    corners = [(x, y, max(0.0, 0.1 * (x - 30.0))) for x in (-20.0, 30.0, 110.0) for y in (-15.0, 15.0)]
    scene = ep.Scene()
    scene.add(ep.Mesh(corners, [(0, 2, 3), (0, 3, 1), (2, 4, 5), (2, 5, 3)]), name="hill", material="grass")
    scene.add(ep.actors.sphere(1.0), name="ball", material="grass", position=(36.0, 4.0, 1.6))
    radar = build_radar([(0, 0, 1)], [(0, 0, 1)], num_samples=16, num_chirps=2, chirp_interval=1e-4)
    figure = plot_scene(scene, ep.trace(scene, radar, num_rays=200), objects=["hill", "ball"])
    figure.canvas.draw()
    axes = figure.axes[view]
    picture = np.asarray(figure.canvas.buffer_rgba())[..., :3].astype(int)

    def colour(*place) -> np.ndarray:
        across, up = axes.transData.transform(place[:2] if view else proj_transform(*place, axes.get_proj())[:2])
        return picture[int(len(picture) - up), int(across)]

    slope, flat = colour(60.0, -10.0, 3.0), colour(10.0, -10.0, 0.0)
    assert np.abs(colour(*(36.0, 4.0, 1.6) + np.array(dark_side)) - slope).max() > 30
    assert np.abs(colour(17.5, 1.945, 1.29) - flat).max() > 10  # half-way between the radar and the side that faces it


@pytest.mark.parametrize("size", [(120.0, 20.0, 6.0), (20.0, 20.0, 6.0), (20.0, 60.0, 6.0), (5.0, 2.0, 1.5)])
def test_names_of_axes_stand_beside_their_numbers_and_titles_above_names(size):
    """As measured on the page once it is drawn: of long scenes the name of x stood on a number, that of a field in a title."""
    figure = on_a_field(*size)
    figure.draw_without_rendering()
    perspective, from_above = figure.axes[:2]
    for axis in (perspective.xaxis, perspective.yaxis, perspective.zaxis):
        numbers = [tick.label1.get_window_extent() for tick in axis.get_major_ticks() if tick.label1.get_text()]
        assert numbers and not axis.label.get_window_extent().count_overlaps(numbers)
    names = [text.get_window_extent() for text in from_above.texts]
    assert not from_above.title.get_window_extent().count_overlaps(names)


@pytest.mark.parametrize("size", [(600.0, 4.0, 2.0), (3.0, 300.0, 2.0), (0.3, 0.04, 0.03)])
def test_numbers_and_names_of_the_axes_of_thin_scenes_stand_apart(size):
    """As measured on the page once it is drawn: all numbers and names of each view beside each other."""
    figure = on_a_field(*size, box_size=0.4 * size[2])
    figure.draw_without_rendering()
    for axes in figure.axes:
        shown = []
        for axis in (getattr(axes, name) for name in ("xaxis", "yaxis", "zaxis") if hasattr(axes, name)):
            low, high = sorted(axis.get_view_interval())
            shown += [tick.label1 for tick in axis.get_major_ticks() if low <= tick.get_loc() <= high and tick.label1.get_text()]
            shown += [axis.label] if axis.label.get_visible() else []
        assert len(shown) > 3
        boxes = [text.get_window_extent() for text in shown]
        for number, one in enumerate(boxes):
            assert not one.count_overlaps(boxes[number + 1:]), [text.get_text() for text in shown]


def test_a_scene_of_a_hand_fills_its_picture():
    """The radar stands 1 m above a field of 0.3 m in `on_a_field`; here nothing is farther than 0.3 m."""
    scene = ep.Scene()
    scene.add(ep.actors.plate(0.02, 0.02), name="plate", material="metal", position=(0.3, 0.0, 0.0))
    radar = build_radar([(0, 0, 0)], [(0, 0, 0)], num_samples=16, num_chirps=2, chirp_interval=1e-4)
    left, right = plot_scene(scene, ep.trace(scene, radar, num_rays=500)).axes[1].get_xlim()
    assert left < 0.0 and right > 0.3 and right - left < 0.6


def test_a_slope_hides_neither_what_stands_on_it_nor_rays():
    """As `test_a_field_hides_...`, of a field that rises by 12 m."""
    scene, rise = ep.Scene(), 0.2
    corners = np.array([[0.0, -10.0, 0.0], [60.0, -10.0, 12.0], [60.0, 10.0, 12.0], [0.0, 10.0, 0.0]])
    scene.add(ep.Mesh(corners, np.array([[0, 1, 2], [0, 2, 3]])), name="slope", material="grass")
    scene.add(ep.actors.box(2.0), name="box", material="metal", position=(48.0, 4.0, 48.0 * rise + 1.0))
    radar = build_radar([(0, 0, 2)], [(0, 0, 2)], num_samples=16, num_chirps=2, chirp_interval=1e-4)
    figure = plot_scene(scene, ep.trace(scene, radar, num_rays=500))
    figure.canvas.draw()
    axes, picture = figure.axes[0], np.asarray(figure.canvas.buffer_rgba())[..., :3].astype(int)

    def colours(*place) -> np.ndarray:
        across, up = axes.transData.transform(proj_transform(*place, axes.get_proj())[:2])
        return picture[int(len(picture) - up) - 4:int(len(picture) - up) + 5, int(across)]

    field = colours(30.0, -5.0, 30.0 * rise)[4]
    assert np.abs(colours(47.0, 4.0, 48.0 * rise + 1.0) - field).max() > 10  # the side of the box that faces the radar
    assert np.abs(colours(23.5, 2.0, 24.0 * rise + 1.5) - field).max() > 10  # half-way between the radar and that side


def test_names_of_objects_behind_each_other_stand_apart():
    """As measured on the page once it is drawn."""
    scene = ep.Scene()
    for k in range(6):
        scene.add(ep.actors.plate(0.3, 0.3), name=f"motorcycle_{k}", material="metal", position=(5.0 + 0.1 * k, 0.05 * k, 1.0))
    radar = build_radar([(0, 0, 1)], [(0, 0, 1)], num_samples=16, num_chirps=2, chirp_interval=1e-4)
    figure = plot_scene(scene, ep.trace(scene, radar, num_rays=500))
    figure.draw_without_rendering()
    for axes in figure.axes[:2]:  # in perspective, from above
        names = [text for text in axes.texts if text.get_text().startswith("motorcycle")]
        boxes = [_box_of_first_line(text) for text in names]
        assert len(boxes) == 6
        assert not any(one.overlaps(other) for one, other in itertools.combinations(boxes, 2))


def test_of_a_street_full_of_objects_the_strongest_bear_names_that_stand_near_them():
    """As measured on the page once it is drawn: 30 plates in a row of 60 m, of which every third is 3 m wide."""
    scene = ep.Scene()
    for k in range(30):
        name, size = (f"large_{k}", 3.0) if k % 3 == 0 else (f"small_{k}", 0.2)
        scene.add(ep.actors.plate(size, size), name=name, position=(5.0 + 2.0 * k, 3.0, 1.0),
                  material=ep.Material(reflectivity=0.3, scattering=1.0))
    radar = build_radar([(0, 0, 1)], [(0, 0, 1)], num_samples=16, num_chirps=2, chirp_interval=1e-4)
    figure = plot_scene(scene, ep.trace(scene, radar, num_rays=5000))
    figure.draw_without_rendering()
    from_above = figure.axes[1]
    names = [text for text in from_above.texts if text.get_text() != "radar"]
    boxes = [text.get_window_extent() for text in names]
    assert 5 < len(boxes) <= 20 and sum(text.get_text().startswith("large") for text in names) >= 8
    assert not any(one.overlaps(other) for one, other in itertools.combinations(boxes, 2))
    line = boxes[0].height
    for text, box in zip(names, boxes):
        assert 0.0 <= box.y0 - from_above.transData.transform(text.xy)[1] < 5.0 * line
    assert max(box.y1 for box in boxes) <= from_above.title.get_window_extent().y0


def test_names_of_a_dozen_objects_at_one_place_stay_below_the_title():
    """As many as all find room: three of them left the page, and one stood on its title."""
    scene = ep.Scene()
    for k in range(12):
        scene.add(ep.actors.box(1.0), name=f"box_{k}", position=(10.0, 0.01 * k, 0.8), yaw=0.1 * k,
                  material=ep.Material(reflectivity=0.3, scattering=1.0))
    radar = build_radar([(0, 0, 1)], [(0, 0, 1)], num_samples=16, num_chirps=2, chirp_interval=1e-4)
    figure = plot_scene(scene, ep.trace(scene, radar, num_rays=2000))
    figure.draw_without_rendering()
    boxes = [_box_of_first_line(text) for text in figure.axes[0].texts if text.get_text().startswith("box")]
    assert len(boxes) == 12 and max(box.y1 for box in boxes) < figure._suptitle.get_window_extent().y0


def test_names_of_mirrors_of_objects_and_of_the_radar_stand_apart():
    """As measured on the page once it is drawn: two rows of facades, with cars before them, one of them near the radar."""
    scene = ep.Scene()
    for k in range(16):
        scene.add(ep.actors.plate(4.0, 3.0), name=f"facade_{k}", position=(8.0 + 6.0 * k, 12.0 * (-1) ** k, 1.5), yaw=0.5 * np.pi,
                  material=ep.materials["concrete"].replace(mirror=True))
    for k in range(6):
        scene.add(ep.actors.box(1.0), name=f"car_{k}", position=(3.0 + 15.0 * k, 11.0 * ((k + 1) % 3 - 1), 0.5),
                  material=ep.Material(reflectivity=0.3, scattering=1.0))
    radar = build_radar([(0, 0, 1)], [(0, 0, 1)], num_samples=16, num_chirps=2, chirp_interval=1e-4)
    figure = plot_scene(scene, ep.trace(scene, radar, num_rays=1000))
    figure.draw_without_rendering()
    for axes in figure.axes[:2]:  # in perspective, from above
        texts = [text for text in axes.texts if text.get_text()]
        boxes = [_box_of_first_line(text) for text in texts]
        names = [text.get_text().split("_")[0] for text in texts]
        assert names.count("car") == 6 and names.count("facade") >= 2
        assert not any(one.overlaps(other) for one, other in itertools.combinations([*boxes, axes.title.get_window_extent()], 2))


def _box_of_first_line(text) -> Bbox:
    """On the page; texts in perspective are put where they are drawn."""
    if hasattr(text, "get_position_3d"):
        text.set_position(proj_transform(*text.get_position_3d(), text.axes.get_proj())[:2])
    box = text.get_window_extent()
    return Bbox.from_extents(box.x0, box.y1 - box.height / len(text.get_text().split("\n")), box.x1, box.y1)


def test_a_picture_of_a_town_names_the_objects_of_its_labels_and_shows_rays_to_each():
    scene = ep.Scene()
    town = scene.add(None, name="town")
    rough = ep.Material(reflectivity=0.3, scattering=1.0)
    for k, size in enumerate((2.0, 0.4)):
        scene.add(ep.actors.plate(size, size), name=f"plate{k}", material=rough, position=(6.0, 2.0 * k, 1.0), parent=town)
    scene.add(ep.actors.plate(0.3, 0.3), name="rest", material=rough, position=(5.0, -2.0, 1.0), parent=town)
    radar = build_radar([(0, 0, 1)], [(0, 0, 1)], num_samples=16, num_chirps=2, chirp_interval=1e-4)
    paths = ep.trace(scene, radar, num_rays=2000)
    figure = plot_scene(scene, paths, objects={"large": "town/plate0", "small": ["town/plate1"]})
    names = {text.get_text().strip() for text in figure.axes[1].texts}
    assert {"large", "small"} <= names and not names & {"town", "rest"}
    drawn = np.concatenate([segment for lines in figure.axes[1].collections if hasattr(lines, "get_segments")
                            for segment in lines.get_segments()])
    assert np.any(np.hypot(*(drawn - (6.0, 2.0)).T) < 0.3)  # at the small one, whose echo is the weakest


# m, as the triangle is wide and high
@pytest.mark.parametrize("size", [(20.0, 20.0), (0.3, 40.0), (40.0, 0.3)])
@pytest.mark.filterwarnings("error:constrained_layout")
def test_high_scenes_have_room_for_their_labels(size, tmp_path):
    scene = ep.Scene()
    corners = np.array([[0.0, 0.0, 0.0], [0.0, size[0], 0.0], [0.0, 0.0, size[1]]])
    scene.add(ep.Mesh(corners, np.array([[0, 2, 1]])), name="sail", material="metal", position=(3.0, 0.0, 0.0))
    radar = build_radar([(0, 0, 1)], [(0, 0, 1)], num_samples=16, num_chirps=2, chirp_interval=1e-4)
    figure = plot_scene(scene, ep.trace(scene, radar, num_rays=500))
    save_png(figure, tmp_path / "scene.png")
    boxes = [axes.get_tightbbox() for axes in figure.axes]
    assert boxes[0].y0 > max(box.y1 for box in boxes[1:])  # that in perspective stands above the others


@pytest.mark.filterwarnings("error:constrained_layout")
def test_a_radar_that_stands_far_from_the_origin_leaves_room_for_the_pictures(tmp_path):
    scene = ep.Scene()
    scene.add(ep.actors.plate(0.5, 0.5), name="plate", material="metal", position=(20.0, 500.0, 1.0))
    radar = build_radar([(0, 0, 0)], [(0, 0, 0)], num_samples=16, num_chirps=2, chirp_interval=1e-4, position=(-3.0, 500.0, 1.0))
    save_png(plot_scene(scene, ep.trace(scene, radar, num_rays=500)), tmp_path / "scene.png")


def test_what_is_smaller_than_a_dot_of_the_picture_is_drawn_as_dots():
    """A ball of 20,480 triangles in a scene of 100 m, which covers some 20 dots across, and is seen whole."""
    scene = ep.Scene()
    rough = ep.Material(reflectivity=0.3, scattering=1.0)
    scene.add(ep.actors.sphere(0.5, subdivisions=32), name="ball", material=rough, position=(50.0, 0.0, 1.0))
    scene.add(ep.actors.plate(2.0, 2.0), name="plate", material="metal", position=(100.0, 10.0, 1.0))
    radar = build_radar([(0, 0, 1)], [(0, 0, 1)], num_samples=16, num_chirps=2, chirp_interval=1e-4)
    figure = plot_scene(scene, ep.trace(scene, radar, num_rays=500))
    figure.set_dpi(300)
    figure.canvas.draw()
    from_above = figure.axes[1]
    assert max(len(some.get_paths()) for some in from_above.collections if isinstance(some, PolyCollection)) < 4000
    page = np.asarray(figure.canvas.buffer_rgba())[..., :3]
    to_page = from_above.transData.transform
    (left, low), (right, high) = to_page((49.65, -0.35)), to_page((50.35, 0.35))  # a square within the ball
    column, row = slice(int(np.ceil(left)), int(right)), slice(-int(high), -int(np.ceil(low)))
    assert page[row, column].size > 0 and page[row, column].max() < 200


def test_a_ground_of_too_many_triangles_is_drawn_whole_of_fewer(monkeypatch):
    """20,000 triangles of 0.4 m, which are larger than dots, in a picture that may have 3000."""
    monkeypatch.setattr(drawing, "MOST_TRIANGLES", 3000)
    side = np.linspace(-20.0, 20.0, 101)
    x, y = np.meshgrid(side + 25.0, side, indexing="ij")
    corner = np.arange(101 * 101).reshape(101, 101)
    a, b, c, d = (part.ravel() for part in (corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]))
    ground = ep.Mesh(np.stack([x, y, 0.1 * np.sin(x)], axis=-1).reshape(-1, 3),
                     np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)]))
    scene = ep.Scene()
    scene.add(ground, name="ground", material=ep.Material(reflectivity=0.3, scattering=1.0))
    radar = build_radar([(0, 0, 1)], [(0, 0, 1)], num_samples=16, num_chirps=2, chirp_interval=1e-4)
    figure = plot_scene(scene, ep.trace(scene, radar, num_rays=500))
    figure.canvas.draw()
    from_above = figure.axes[1]
    assert max(len(some.get_paths()) for some in from_above.collections if isinstance(some, PolyCollection)) <= 3000
    page = np.asarray(figure.canvas.buffer_rgba())[..., :3]
    (left, low), (right, high) = from_above.transData.transform(((7.0, 2.0), (43.0, 18.0)))  # beside rays and names
    assert page[-int(high):-int(np.ceil(low)), int(np.ceil(left)):int(right)].min(axis=-1).max() < 200  # nothing is white


@pytest.mark.parametrize("num_poles", [45, 100])
def test_poles_on_a_ground_of_too_many_triangles_stay_where_and_as_high_as_they_are(monkeypatch, num_poles):
    """One pole in each metre of a row, of 32 triangles of 4 m by 1 cm: fewer in all than the share of their mesh, and more."""
    monkeypatch.setattr(drawing, "MOST_TRIANGLES", 3000)
    angle = 2.0 * np.pi * np.arange(16) / 16
    ring = 0.03 * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    foot = (ring + np.stack([1.0 + np.arange(num_poles), np.zeros(num_poles)], axis=-1)[:, None]).reshape(-1, 2)
    this = np.arange(len(foot))
    following, count = np.where(this % 16 == 15, this - 15, this + 1), len(foot)
    poles = ep.Mesh(np.concatenate([np.column_stack([foot, np.zeros(count)]), np.column_stack([foot, np.full(count, 4.0)])]),
                    np.concatenate([np.column_stack([this, following, following + count]),
                                    np.column_stack([this, following + count, this + count])]))
    scene, rough = ep.Scene(), ep.Material(reflectivity=0.3, scattering=1.0)
    scene.add(ep.actors.ground(110.0, edge=1.0), name="ground", position=(50, 0, 0), material=rough)
    scene.add(poles, name="poles", material=rough)
    radar = build_radar([(0, 0, 1)], [(0, 0, 1)], num_samples=16, num_chirps=2, chirp_interval=1e-4)
    figure = plot_scene(scene, ep.trace(scene, radar, num_rays=500))
    drawn = np.concatenate([path.vertices for some in figure.axes[2].collections if isinstance(some, PolyCollection)
                            for path in some.get_paths()])
    assert drawn[:, 1].max() == pytest.approx(4.0)
    assert set(1 + np.arange(num_poles)) <= set(drawn[drawn[:, 1] > 3.9, 0].round())


def test_many_meshes_of_few_triangles_are_thinned_as_one_of_many_is(monkeypatch):
    monkeypatch.setattr(drawing, "MOST_TRIANGLES", 1000)
    scene, rough = ep.Scene(), ep.Material(reflectivity=0.3, scattering=1.0)
    for place in range(16):
        scene.add(ep.actors.sphere(1.0, subdivisions=4), name=f"ball {place}", position=(10 + 3 * place, 0, 0), material=rough)
    radar = build_radar([(0, 0, 1)], [(0, 0, 1)], num_samples=16, num_chirps=2, chirp_interval=1e-4)
    assert scene.num_triangles > 2000
    figure = plot_scene(scene, ep.trace(scene, radar, num_rays=500))
    assert sum(len(some.get_paths()) for some in figure.axes[1].collections if isinstance(some, PolyCollection)) <= 1000


def test_the_name_of_a_bent_object_stands_at_the_object():
    """In its box that of a rail along a curve would be as far beside it as the curve is deep, 8 m here."""
    scene = ep.Scene()
    scene.add(ep.actors.guard_rail(points=[(5.0, 0.0), (15.0, 1.0), (25.0, 8.0), (30.0, 16.0)]), name="rail")
    radar = build_radar([(0, 0, 1)], [(0, 0, 1)], num_samples=16, num_chirps=2, chirp_interval=1e-4)
    from_above = plot_scene(scene, ep.trace(scene, radar, num_rays=500)).axes[1]
    (name,) = (text for text in from_above.texts if text.get_text() == "rail")
    x, y = name.xy if hasattr(name, "xy") else name.get_position()
    assert 16.0 < x < 19.0 and 1.0 < y < 4.0


def test_a_body_of_mirrors_is_shown_whole_and_a_road_as_far_as_the_rest_goes():
    scene = ep.Scene()
    scene.add(ep.actors.ground(200.0), name="road", material=ep.Material.metal(mirror=True))
    scene.add(ep.actors.plate(0.3, 0.3), name="plate", material="metal", position=(5.0, 0.0, 1.0))
    scene.add(ep.actors.plate(2.0, 1.5), name="van", material=ep.Material.metal(mirror=True), position=(5.5, 0.1, 1.0),
              yaw=0.5 * np.pi)  # reaches from x = 4.5 to 6.5 m
    radar = build_radar([(0, 0, 1)], [(0, 0, 1)], num_samples=16, num_chirps=2, chirp_interval=1e-4)
    left, right = plot_scene(scene, ep.trace(scene, radar, num_rays=500)).axes[1].get_xlim()
    assert (left, right) == pytest.approx((-0.6, 6.5 + 0.6))


@pytest.mark.parametrize("view, yaw", [(1, 0.0), (1, 0.5), (2, 0.0)])
def test_what_is_seen_edge_on_is_shown_as_a_line(view, yaw):
    """An upright pane from above, along an axis and aslant, and from the side, halfway from its middle to its right edge."""
    scene = ep.Scene()
    scene.add(ep.actors.plate(4.0, 2.0), name="pane", material="glass_pane", position=(5.0, 0.0, 1.0), yaw=yaw)
    radar = build_radar([(0, 0, 1)], [(0, 0, 1)], num_samples=16, num_chirps=2, chirp_interval=1e-4)
    figure = plot_scene(scene, ep.trace(scene, radar, num_rays=100))
    figure.canvas.draw()
    place = (5.0 + np.sin(yaw), -np.cos(yaw)) if view == 1 else (5.0, 1.5)
    column, row = np.round(figure.axes[view].transData.transform(place)).astype(int)
    page = np.asarray(figure.canvas.buffer_rgba())[..., :3]
    assert page[-row - 2:-row + 1, column - 1:column + 2].min() < 150  # of 255: darker than the page and than pale rays


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
