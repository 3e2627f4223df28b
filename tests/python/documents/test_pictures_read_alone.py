"""Pictures that stand alone: axes named, numbers as print has them, nothing beyond the edge."""
from __future__ import annotations

import re
import warnings
from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.text import Text

import echopath as ep
from echopath import plots
from echopath.paths.subset import first_group, strongest_of_each
from echopath.plots import style
from echopath.plots.scene_view.drawing import is_cut
from echopath.signals.measures import for_pictures
from echopath.truth.places import true_places


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
    boxes = [text.get_window_extent(renderer) for text in (figure.axes[0].title, *texts)]
    assert not any(one.overlaps(other) for number, one in enumerate(boxes) for other in boxes[:number])
    axes = figure.axes[0].get_window_extent(renderer)
    assert all(box.y1 <= axes.y1 for box in boxes[1:])
    assert not figure.axes[0].patches  # no bars: a level in dB has no zero to begin at


def test_intervals_of_part_powers_end_where_they_end():
    """Or at the edge of the picture, without a mark there: one of 28 dB had a mark 6 dB below its power."""
    powers = {"wide": power_of(-75.0, 28.0, False), "narrow": power_of(-76.0, 2.0, False)}
    axes = plots.plot_part_powers(powers).axes[0]
    ends = [line.get_xdata() for line in axes.get_lines() if line.get_marker() == "|"]
    expected = [[10.0 * np.log10(1e3 * end) for end in (power.low, power.high)] for power in powers.values()]
    assert np.allclose(ends, expected) and axes.get_xlim()[0] > expected[0][0]


def test_maps_of_parts_with_small_print_name_their_range():
    spectrum = SimpleNamespace(values=np.ones((1, 1, 8, 8), complex), range=np.arange(8.0), velocity=np.arange(-4.0, 4.0),
                           window="hann", zero_pad=1)
    figure = plots.plot_partition({"a": spectrum, "b": spectrum}, note="small print")
    assert [axes.get_xlabel() for axes in figure.axes[:2]] == ["Range in m"] * 2


def test_mirrors_have_no_edge_where_the_picture_cuts_them():
    low, high = np.zeros(3), np.full(3, 2.0)
    on_border = np.array([[2.0, 0.3, 0.1], [2.0, 1.1, 0.1]])
    assert is_cut(on_border, low, high) and not is_cut(on_border - [0.5, 0.0, 0.0], low, high)
    assert not is_cut(np.array([[2.0, 0.3, 0.1], [1.0, 0.3, 0.1]]), low, high)  # which only ends there


def texts_of(figure) -> list:
    return [text for text in figure.findobj(Text) if text.get_visible() and text.get_text().strip()]


def assert_whole(figure) -> None:
    """All texts lie within the figure, and numbers have minus signs."""
    figure.canvas.draw()
    renderer, frame = figure.canvas.get_renderer(), figure.bbox
    ticks = {id(text) for axes in figure.axes for axis in axes._axis_map.values() for text in axis.get_ticklabels(which="both")}
    for text in texts_of(figure):
        # Ticks beyond the limits of axes are not drawn; texts in perspective have a place when they are.
        if id(text) not in ticks and not hasattr(text, "get_position_3d"):
            box = text.get_window_extent(renderer)
            assert frame.x0 <= box.x0 and box.x1 <= frame.x1, text.get_text()
        assert not re.search(r"(?<!\w)-(?=\d|\))", text.get_text()), text.get_text()


def flat_map():
    return SimpleNamespace(values=np.ones((1, 1, 8, 8), complex), range=np.arange(8.0), velocity=np.arange(-4.0, 4.0),
                           window="hann", zero_pad=1)


@pytest.mark.parametrize("num_parts", [1, 2, 3, 5])
def test_long_titles_stay_within_figures_of_any_number_of_parts(num_parts):
    title = "What the radar receives, taken apart by route, without noise; " + "mean power of all ranges together " * 2
    spectra = {f"part {number}": flat_map() for number in range(num_parts)}
    assert_whole(plots.plot_partition(spectra, title=title))
    assert_whole(plots.plot_overview(flat_map(), spectra, title=title, parts_title=title))


def test_maps_from_above_ring_the_true_places_and_have_minus_signs():
    azimuth, distance = np.radians(np.arange(-60.0, 61.0, 2.0)), np.arange(64) * 0.25
    power = np.full((len(azimuth), len(distance)), 1e-16)
    power[45, 40] = 1e-10  # 30 degrees, 10 m
    map = SimpleNamespace(azimuth=azimuth, range=distance, power=power)
    places = {"car": (10.0, np.radians(30.0)), "beside": (10.0, np.radians(28.0)), "behind": (500.0, 0.0)}
    figure = plots.plot_range_azimuth(map, places=places)
    assert_whole(figure)
    axes, = (one for one in figure.axes if one.get_ylim()[1] > 5.0 and one.get_lines())
    ring = next(line for line in axes.get_lines() if line.get_marker() == "o")
    assert np.allclose(np.transpose(ring.get_data())[0], [5.0, 10.0 * np.cos(np.radians(30.0))])  # sin 30 degrees = 1 / 2
    assert {"car", "beside"} <= {text.get_text() for text in axes.texts} and len(ring.get_xdata()) == 2
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["where the object truly is (its middle)"]


def test_of_many_true_places_the_nearest_bear_names():
    azimuth, distance = np.radians(np.arange(-60.0, 61.0, 2.0)), np.arange(128) * 0.5
    power = np.full((len(azimuth), len(distance)), 1e-16)
    power[25, 120] = 1e-10
    map = SimpleNamespace(azimuth=azimuth, range=distance, power=power)
    places = {f"car_{k}": (55.0 - 2.0 * k, np.radians(3.0 * k - 30.0)) for k in range(20)}
    axes = plots.plot_range_azimuth(map, places=places).figure.axes[0]
    ring = next(line for line in axes.get_lines() if line.get_marker() == "o")
    assert len(ring.get_xdata()) == 20
    assert {text.get_text() for text in axes.texts} & set(places) == {f"car_{k}" for k in range(8, 20)}


def test_names_of_many_true_places_stay_within_the_map():
    """As measured on the page: those of what stands at the foot of the map were written over its axis and below."""
    azimuth, distance = np.radians(np.arange(-60.0, 61.0, 2.0)), np.arange(128) * 0.5
    power = np.full((len(azimuth), len(distance)), 1e-16)
    power[25, 120] = 1e-10
    map = SimpleNamespace(azimuth=azimuth, range=distance, power=power)
    places = {f"car_{k}": (8.0 + 0.2 * k, np.radians(2.0 * k - 20.0)) for k in range(20)}
    figure = plots.plot_range_azimuth(map, places=places).figure
    figure.draw_without_rendering()
    axes = figure.axes[0]
    boxes = [Text.get_window_extent(text) for text in axes.texts if text.get_text() in places]  # without their lines
    assert len(boxes) > 3 and all(axes.bbox.y0 <= box.y0 and box.y1 <= axes.bbox.y1 for box in boxes)


def test_names_of_true_places_stand_nearer_to_their_rings_than_to_others():
    """On the page: that of the car stood right below the ring of the person beside it, and that of the person farther below."""
    azimuth, distance = np.radians(np.arange(-60.0, 61.0, 2.0)), np.arange(64) * 0.5
    power = np.full((len(azimuth), len(distance)), 1e-16)
    power[25, 62] = 1e-10
    map = SimpleNamespace(azimuth=azimuth, range=distance, power=power)
    places = {"car": (9.0, np.radians(-11.0)), "person": (8.5, np.radians(-20.0)), "van": (20.0, 0.0)}
    figure = plots.plot_range_azimuth(map, places=places)
    figure.canvas.draw()
    axes = figure.axes[0]
    rings = {name: axes.transData.transform((r * np.sin(angle), r * np.cos(angle))) for name, (r, angle) in places.items()}
    boxes = {text.get_text(): text for text in axes.texts if text.get_text() in places}
    for name, text in boxes.items():
        low, high = Text.get_window_extent(text).get_points()  # without the line to the ring
        apart = {other: np.linalg.norm(ring - np.clip(ring, low, high)) for other, ring in rings.items()}
        assert min(apart, key=apart.get) == name
    assert boxes.keys() == places.keys()


def small_radar(position=(0, 0, 0)):
    waveform = ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=16, sampling_rate=20e6, num_chirps=2,
                                chirp_interval=1e-4)
    return ep.Radar(waveform, transmitters=[ep.Antenna((0, 0, 1))], receivers=[ep.Antenna((0, 0, 1))], transmit_power=0.1,
                    position=position, yaw=np.pi / 2)


def test_true_places_are_seen_from_the_radar():
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.5), name="ball", material="metal", position=(4, 8, 1))
    places = true_places(scene, small_radar((4, 3, 0)), ["ball"], 0.0)  # 5 m along y, where the radar looks
    assert np.allclose(places["ball"], (5.0, 0.0), atol=1e-6)
    assert true_places(scene, small_radar((4, 3, 0)), {"it": ["ball"]}, 0.0) == {"it": places["ball"]}


def test_each_object_has_rays_and_surfaces_say_where_they_are_cut():
    scene = ep.Scene()
    scene.add(ep.actors.ground(60.0), name="ground", material=ep.Material.metal(mirror=True))
    scene.add(ep.actors.plate(2.0, 2.0), name="bright", material="metal", position=(0, 5, 1), yaw=-np.pi / 2)
    scene.add(ep.actors.sphere(0.1), name="faint", material="metal", smooth=True, position=(2, 8, 1))
    paths = ep.trace(scene, small_radar(), num_rays=4000)
    groups = first_group(paths, np.array([{"ground": -1, "bright": 0, "faint": 1}[mesh.name] for mesh in scene.meshes]))
    chosen = strongest_of_each(paths.power, groups, 2, 40)
    assert len(set(chosen)) == len(chosen) == 40 and (groups[chosen] >= 0).all()
    assert min(np.bincount(groups[chosen], minlength=2)) >= 10  # a quarter each, and the strongest
    figure = plots.plot_scene(scene, paths)
    assert_whole(figure)
    words = {text.get_text() for text in figure.legends[0].get_texts()}
    assert {"surface that mirrors", "cut here, it goes on beyond the picture"} <= words
    assert any("ground" in text.get_text() for text in figure.axes[0].texts)


def test_values_beyond_a_scale_stand_at_its_end_and_are_marked():
    from echopath.bench import scale_ends
    from echopath.plots.style import new_figure

    with new_figure(3.0, 3.0) as figure:
        axes = figure.subplots()
        held = scale_ends.within(axes, [1.0, 2.0, 3.0], [-5.0, 0.5, 7.0], (0.0, 1.0), "blue")
        assert np.array_equal(held, [0.0, 0.5, 1.0])
        marks = {line.get_marker(): tuple(np.ravel(line.get_data())) for line in axes.get_lines()}
        assert marks == {"v": (1.0, 0.0), "^": (3.0, 1.0)}
        scale_ends.within(axes, [1.0], [9.0], (0.0, 1.0), "blue", across=True)
        assert axes.get_lines()[-1].get_marker() == ">" and tuple(np.ravel(axes.get_lines()[-1].get_data())) == (1.0, 1.0)


@pytest.mark.parametrize("velocity", [-3.9, 0.0, 3.9])
def test_names_of_objects_stand_within_the_map(velocity):

    from echopath.plots.labels import _name_objects
    from echopath.plots.style import new_figure

    with new_figure(6.0, 3.0) as figure:
        axes = figure.subplots()
        axes.set(xlim=(0.0, 20.0), ylim=(-4.0, 4.0))
        objects = [SimpleNamespace(name=name, peak=(10.0, velocity)) for name in ("car", "person")]
        _name_objects(axes, SimpleNamespace(objects=objects, azimuth=None))
        figure.canvas.draw()
        frame, boxes = axes.get_window_extent(), [Text.get_window_extent(text) for text in axes.texts]  # without the lines
        assert all(frame.y0 <= box.y0 and box.y1 <= frame.y1 for box in boxes)
        assert not boxes[0].overlaps(boxes[1])


@pytest.mark.parametrize("ranges", [(9.6, 10.0), (19.0, 19.4), (0.2, 0.6)])
def test_lines_to_names_of_neighbours_cross_no_name(ranges):
    """Whichever of two neighbours comes first in the scene."""
    from echopath.plots.labels import _name_objects
    from echopath.plots.style import new_figure

    for names in (("sphere", "dihedral"), ("dihedral", "sphere")):
        with new_figure(6.0, 3.0) as figure:
            axes = figure.subplots()
            axes.set(xlim=(0.0, 20.0), ylim=(-4.0, 4.0))
            where = dict(zip(("sphere", "dihedral"), ranges))
            objects = [SimpleNamespace(name=name, peak=(where[name], 0.0)) for name in names]
            _name_objects(axes, SimpleNamespace(objects=objects, azimuth=None))
            figure.canvas.draw()
            for text, other in (axes.texts, axes.texts[::-1]):
                box = Text.get_window_extent(other)
                ring, name = axes.transData.transform(text.xy), Text.get_window_extent(text)
                end = (name.x0 if name.x0 > ring[0] else name.x1, 0.5 * (name.y0 + name.y1))
                line = np.linspace(ring, end, 200)
                assert not any(box.contains(*point) for point in line), (names, text.get_text())


def test_long_names_keep_both_ends_and_stand_within_the_map():
    """As of foreign files, whose names often differ at their end alone; one of 50 letters had reached over the colour bar."""
    from echopath.plots.labels import _name_objects
    from echopath.plots.style import LONGEST_NAME, new_figure, short_name

    assert short_name("pedestrian") == "pedestrian"
    long = [f"Building_of_the_western_block, storey {number}" for number in (11, 12)]
    assert len({short_name(name) for name in long}) == 2
    assert all(short_name(name).startswith("Building_of") and short_name(name).endswith(name[-9:]) for name in long)
    with new_figure(6.0, 3.0) as figure:
        axes = figure.subplots()
        axes.set(xlim=(0.0, 20.0), ylim=(-4.0, 4.0))
        objects = [SimpleNamespace(name=name, peak=(distance, 0.0)) for name, distance in zip(long, (10.0, 11.0))]
        _name_objects(axes, SimpleNamespace(objects=objects, azimuth=None))
        figure.canvas.draw()
        frame, boxes = axes.get_window_extent(), [Text.get_window_extent(text) for text in axes.texts]
        assert all(len(text.get_text()) <= LONGEST_NAME for text in axes.texts)
        assert all(frame.x0 <= box.x0 and box.x1 <= frame.x1 for box in boxes)


def test_long_names_of_wide_letters_stand_within_the_map_too():
    """A letter of Chinese is as wide as high in fonts that have it; 28 Latin ones of 0.56 of that on the mean have room."""
    from echopath.plots.style import short_name

    names = [chr(0x4e00) * 27 + ending for ending in "\u5357\u5317"]
    assert len({short_name(name) for name in names}) == 2
    assert all(len(short_name(name)) < 28 * 0.56 for name in names)
    assert short_name("\u884c\u4eba") == "\u884c\u4eba"


def test_letters_that_the_first_font_has_not_come_from_the_next(monkeypatch):
    """Fonts with Chinese letters are not on every machine; mathematical ones come with Matplotlib."""
    from matplotlib import font_manager
    from matplotlib.ft2font import FT2Font

    further = "STIXNonUnicode"
    paths = [font_manager.findfont(font_manager.FontProperties(family=[name])) for name in (further, "sans-serif")]
    letters = [set(FT2Font(path).get_charmap()) for path in paths]
    letter = chr(min(letters[0] - letters[1]))
    for fonts, is_missing in (((), True), ((further,), False)):
        monkeypatch.setattr(style, "_FURTHER_FONTS", fonts)
        style._fonts.cache_clear()
        with style.new_figure(2.0, 1.0) as figure, warnings.catch_warnings(record=True) as heard:
            warnings.simplefilter("always")
            figure.suptitle(letter)
            figure.draw_without_rendering()
        assert any("missing from font" in str(one.message) for one in heard) == is_missing
    monkeypatch.undo()
    style._fonts.cache_clear()
