"""Methods `plot` of results: they draw in the axes that they are given, return them, and show what the result says."""
import dataclasses
import itertools

import matplotlib
import matplotlib.text
import numpy as np
import pytest
from matplotlib.pyplot import close

import echopath as ep
from support.radars import build_radar

matplotlib.use("Agg")
RANGE, AZIMUTH = 9.0, 0.35  # m, rad, of a plate


@pytest.fixture
def ax():
    from matplotlib import pyplot

    figure, axes = pyplot.subplots()
    yield axes
    pyplot.close(figure)


@pytest.fixture(scope="module")
def frame():
    half_wave = 0.00195
    radar = build_radar([ep.Antenna()], [ep.Antenna((0, k * half_wave, 0)) for k in range(8)], num_samples=128,
                        sampling_rate=10e6, num_chirps=32, transmit_power=1.0)
    scene = ep.Scene()
    place = RANGE * np.array([np.cos(AZIMUTH), np.sin(AZIMUTH), 0.0])
    scene.add(ep.actors.plate(0.3, 0.3), name="plate", material=ep.Material(reflectivity=0.9, scattering=1.0), position=place,
              yaw=AZIMUTH + np.pi)
    return ep.simulate(scene, radar, num_rays=2000, labels=True, detections=True, parts={"plate": "T 'plate' R"})


def results(frame) -> dict:
    return {"RangeDoppler": frame.spectrum, "RangeAzimuth": frame.range_azimuth, "Frame": frame,
            "AngleSpectrum": ep.angle_fft(frame.spectrum, frame.radar), "Labels": frame.labels["parts"],
            "Detections": frame.detections, "Truth": frame.truth}


KINDS = ("RangeDoppler", "RangeAzimuth", "Frame", "AngleSpectrum", "Labels", "Detections", "Truth")


@pytest.mark.parametrize("kind", KINDS)
def test_axes_that_are_given_are_drawn_in_and_returned(frame, ax, kind):
    assert results(frame)[kind].plot(ax=ax, title="My title") is ax
    assert ax.has_data() and "My title" in ax.get_title() and ax.get_xlabel() and ax.get_ylabel()
    ax.figure.canvas.draw()


@pytest.mark.parametrize("kind", KINDS)
def test_without_axes_new_ones_are_made(frame, kind):
    from matplotlib import pyplot

    before = len(pyplot.get_fignums())
    ax = results(frame)[kind].plot()
    assert len(pyplot.get_fignums()) == before + 1 and ax.get_title()
    pyplot.close(ax.figure)


@pytest.mark.parametrize("kind", KINDS)
def test_what_are_no_axes_is_refused_by_name(frame, kind):
    with pytest.raises(TypeError, match="ax: must be Matplotlib axes or None, got str"):
        results(frame)[kind].plot(ax="here")


@pytest.mark.parametrize("overlay", ["Detections", "Truth", "Tracks"])
def test_what_is_drawn_over_axes_with_a_title_leaves_it(frame, ax, overlay):
    drawn = (results(frame) | {"Tracks": ep.track([[(9.0, 1.0)]] * 5, 0.1 * np.arange(5))})[overlay]
    assert drawn.plot(ax=ax).get_title() and drawn.plot(ax=ax, title="Ours").get_title() == "Ours"
    ax.set_title("Mine")
    assert drawn.plot(ax=ax).get_title() == "Mine"


def test_axes_with_a_picture_of_other_axes_are_refused(frame):
    """Boxes in metres to the left and ahead would stand anywhere between ranges and velocities."""
    every = results(frame) | {"Tracks": ep.track([[(9.0, 1.0)]] * 5, 0.1 * np.arange(5)), "RangeTime": ep.range_time(frame)}
    planes = [{"RangeDoppler", "Frame", "Labels", "Detections"}, {"RangeAzimuth", "Truth", "Tracks"}, {"AngleSpectrum"},
              {"RangeTime"}]
    for below, first in every.items():
        ax = first.plot()
        for over, second in every.items():
            if any({below, over} <= plane for plane in planes):
                second.plot(ax=ax)
                continue
            count = len(ax.get_children())
            with pytest.raises(ValueError, match="^ax: must be empty or have '.*' across and '.*' up, got axes with '"):
                second.plot(ax=ax)
            assert len(ax.get_children()) == count
        close(ax.figure)


def test_axes_with_something_else_in_them_are_taken(frame, ax):
    ax.plot([0.0, 1.0], [0.0, 1.0])
    ax.set(xlabel="east in m", ylabel="north in m")
    assert frame.truth.plot(ax=ax) is ax


def test_axes_are_saved_as_their_figure_is_and_again_with_the_same_bytes(frame, tmp_path):
    """The layout that Matplotlib makes goes on from the one before."""
    ax = frame.plot()
    files = [tmp_path / name for name in ("axes.png", "again.png", "figure.png")]
    for drawn, file in zip((ax, ax, frame.plot().figure), files):
        ep.plots.save_png(drawn, file)
    assert len({file.read_bytes() for file in files}) == 1
    with pytest.raises(TypeError, match="figure: must be a figure of matplotlib, or axes in it, got Frame"):
        ep.plots.save_png(frame, tmp_path / "frame.png")


@pytest.mark.parametrize("scene, paths, argument", [("radar", "paths", "scene"), ("scene", "radar", "paths")])
def test_the_picture_of_a_scene_refuses_by_name_what_is_none(frame, scene, paths, argument):
    with pytest.raises(TypeError, match=f"^{argument}: must be a"):
        ep.plots.plot_scene(getattr(frame, scene), getattr(frame, paths))


@pytest.mark.parametrize("draw, argument, got", [
    (lambda frame: ep.plots.plot_partition(frame.part_spectra), "spectra", "{'parts'"),
    (lambda frame: ep.plots.plot_partition({}), "spectra", "{}"),
    (lambda frame: ep.plots.plot_overview(frame.spectrum, frame.part_spectra), "spectra", "{'parts'"),
    (lambda frame: ep.plots.plot_labels(frame.labels), "labels", "{'parts'"),
    (lambda frame: ep.plots.plot_ghosts(frame), "labels", "Frame"),
    (lambda frame: ep.plots.plot_range_azimuth(None), "maps", "None"),
    (lambda frame: ep.plots.plot_range_azimuth(frame.spectrum), "maps", "RangeDoppler"),
    (lambda frame: ep.plots.draw_range_azimuth(frame.spectrum), "map", "RangeDoppler"),
    (lambda frame: ep.plots.plot_range_doppler(frame.cube), "spectrum", "an array"),
    (lambda frame: ep.plots.draw_range_doppler(frame), "spectrum", "Frame"),
    (lambda frame: ep.plots.power_dbm(frame.cube), "spectrum", "an array"),
    (lambda frame: ep.plots.colour_limits(None), "spectrum", "None"),
    (lambda frame: ep.plots.plot_part_powers(frame.mean_part_powers), "powers", "{"),
    (lambda frame: ep.plots.draw_detections(frame), "detections", "Frame"),
    (lambda frame: ep.plots.draw_tracks(frame), "tracks", "Frame"),
    (lambda frame: ep.plots.draw_truth(frame.detections), "truth", "Detections"),
    (lambda frame: ep.plots.draw_pattern(frame.radar.transmitters[0]), "pattern", "Antenna"),
    (lambda frame: ep.plots.draw_array(frame.scene), "radar", "Scene"),
    (lambda frame: ep.plots.draw_frame(frame.spectrum), "frame", "RangeDoppler"),
    (lambda frame: ep.plots.draw_time_map(frame), "map", "Frame"),
    (lambda frame: ep.plots.draw_angle_spectrum(frame.spectrum), "spectrum", "RangeDoppler"),
    (lambda frame: ep.plots.draw_spectrogram_labels(frame), "labels", "Frame"),
    (lambda frame: ep.plots.plot_scene(frame.scene, frame.paths, num_rays=0), "num_rays", "0"),
    (lambda frame: ep.plots.plot_scene(frame.scene, frame.paths, power=[1.0]), "power", "an array")])
def test_pictures_refuse_by_name_what_a_frame_holds_elsewhere(frame, draw, argument, got):
    with pytest.raises((TypeError, ValueError), match=f"^{argument}: must be .*, got {got}"):
        draw(frame)


def test_one_frame_over_time_has_the_time_of_its_middle_alone(frame, ax):
    """0.5 s to either side of it were shown before, of a frame of milliseconds."""
    ep.range_time(frame).plot(ax=ax)
    middle = 0.5 * frame.radar.waveform.num_chirps * frame.radar.waveform.chirp_interval
    assert ax.get_xticks() == pytest.approx([middle], rel=0.05)


def test_the_colour_scale_of_a_map_is_the_one_asked_for(frame, ax):
    image = frame.spectrum.plot(ax=ax, vmin=-120.0, vmax=-90.0).get_images()[0]
    assert image.get_clim() == (-120.0, -90.0)
    row, column = np.unravel_index(image.get_array().argmax(), image.get_array().shape)
    assert frame.spectrum.range[column] == pytest.approx(RANGE, abs=0.2) and frame.spectrum.velocity[row] == 0.0


def test_the_curve_of_an_angle_spectrum_peaks_at_the_target_and_left_is_left(frame, ax):
    spectrum = ep.angle_fft(frame.spectrum, frame.radar)
    curve = spectrum.plot(range=RANGE, velocity=0.0, ax=ax).get_lines()[0]
    angle, level = curve.get_data()
    assert angle[level.argmax()] == pytest.approx(np.degrees(AZIMUTH), abs=4.0)  # a quarter of a beam
    assert ax.get_xlim()[0] > ax.get_xlim()[1] and f"{RANGE:.0f}" in ax.get_title()
    with pytest.raises(ValueError, match="range: must lie in 0 to .* m, got 1000"):
        spectrum.plot(range=1000.0, ax=ax)


def test_points_of_detections_lie_where_the_target_is(frame, ax):
    assert len(frame.detections)
    for view, expected in (("range_doppler", (RANGE, 0.0)),
                           ("above", (RANGE * np.sin(AZIMUTH), RANGE * np.cos(AZIMUTH)))):
        ax.clear()
        frame.detections.plot(view, ax=ax)
        found = [collection.get_offsets() for collection in ax.collections if collection.get_label().startswith("plate: ")]
        assert np.linalg.norm(np.concatenate(found) - expected, axis=1).min() < 0.3
    with pytest.raises(ValueError, match="view: must be 'range_doppler' or 'above', got 'side'"):
        frame.detections.plot("side")


@pytest.mark.parametrize("view", ["range_doppler", "above"])
def test_rings_of_ghosts_stand_out_of_a_map_of_their_own_colour(frame, ax, view):
    ghosts = dataclasses.replace(frame.detections, ghost_type=np.ones_like(frame.detections.ghost_type))
    ghosts.plot(view, ax=ax)
    (ring,) = [collection for collection in ax.collections if collection.get_label().startswith("plate: ")]
    ax.set_facecolor(ring.get_edgecolor()[0])
    ax.get_legend().remove()
    ax.grid(False)
    picture = painted(ax)
    row, column = pixels(ax, ring.get_offsets())[0]
    own = picture[row - 10:row + 10, column - 10:column + 10]
    assert np.ptp(own) > 0.15  # of 1 between black and white


@pytest.mark.parametrize("first", ["detections", "truth", "range_azimuth"])
@pytest.mark.parametrize("second", ["detections", "truth"])
def test_what_is_drawn_over_another_picture_from_above_leaves_left_on_the_left(frame, ax, first, second):
    def draw(name):
        getattr(frame, name).plot(*["above"] * (name == "detections"), ax=ax)

    draw(first)
    limits = ax.get_xlim(), ax.get_ylim()
    draw(second)
    assert ax.xaxis_inverted() and ax.get_aspect() == 1.0
    if first == "range_azimuth":  # a sector, which has its frame
        ax.figure.canvas.draw()
        assert (ax.get_xlim(), ax.get_ylim()) == limits


def test_left_stays_left_however_many_results_share_their_axes(frame):
    """Each second plot of detections in one pair of axes turned them over, maps from above below them included."""
    tracks = ep.track([[(9.0, 1.0)]] * 5, 0.1 * np.arange(5))
    spectrum = ep.angle_fft(frame.spectrum, frame.radar)
    for draws in ([frame.detections, frame.detections], [frame.truth, frame.detections], [tracks, frame.detections],
                  [frame.range_azimuth, frame.detections], [frame.detections, frame.truth, tracks], [spectrum, spectrum]):
        ax = None
        for result in draws:
            ax = result.plot("above", ax=ax) if result is frame.detections else result.plot(ax=ax)
            assert ax.get_xlim()[0] > ax.get_xlim()[1]
        close(ax.figure)


def test_tracks_leave_room_for_what_is_drawn_into_their_axes(frame):
    """Limits across that tracks had fixed left objects aside of them out of the picture."""
    tracks = ep.track([[(9.0, -6.0)]] * 5, 0.1 * np.arange(5))
    ax = frame.truth.plot(ax=tracks.plot())
    ax.figure.canvas.draw()
    plate, track = RANGE * np.array([np.sin(AZIMUTH), np.cos(AZIMUTH)]), (-6.0, 9.0)
    shown = ax.transAxes.inverted().transform(ax.transData.transform([plate, track]))
    assert np.all((shown > 0.0) & (shown < 1.0))
    close(ax.figure)


def test_curves_of_two_cells_in_common_axes_both_show_their_peaks(frame, ax):
    """The limits were those of the curve that came last, above which a stronger one was cut off."""
    spectrum = ep.angle_fft(frame.spectrum, frame.radar)
    for distance in (RANGE, 2.0):
        spectrum.plot(range=distance, velocity=0.0, ax=ax)
    peaks = [line.get_ydata().max() for line in ax.get_lines()]
    assert peaks[0] > peaks[1] + 10.0 and ax.get_ylim()[0] < peaks[1] and peaks[0] < ax.get_ylim()[1]


def test_labels_show_parts_or_objects(frame, ax):
    labels = frame.labels["parts"]
    words = {}
    for what in ("parts", "objects"):
        ax.clear()
        labels.plot(what, ax=ax)
        words[what] = [text.get_text() for text in ax.get_legend().get_texts()]
    assert any(text.startswith("plate: ") for text in words["parts"])
    assert any(text.startswith("the object itself: ") for text in words["objects"])
    with pytest.raises(ValueError, match="what: must be 'parts' or 'objects', got 'cars'"):
        labels.plot("cars", ax=ax)


def test_labels_of_one_chirp_lie_over_a_map_that_is_seen(ax):
    """Its one row has no neighbour that tells how high it is. White is the strongest level, and all of it was white."""
    radar = build_radar([ep.Antenna()], [ep.Antenna()], num_samples=64, sampling_rate=10e6, num_chirps=1, transmit_power=1.0)
    scene = ep.Scene()
    scene.add(ep.actors.plate(0.3, 0.3), name="plate", material="metal", position=(RANGE, 0, 0), yaw=np.pi)
    labels = ep.annotate(ep.trace(scene, radar, num_rays=500), {"plate": "T . R"})
    labels.plot(ax=ax)
    ax.figure.canvas.draw()
    left, right = (int(end) for end in (ax.bbox.x0, ax.bbox.x1))
    row = np.asarray(ax.figure.canvas.buffer_rgba())[::-1][int(ax.bbox.y0 + 0.1 * ax.bbox.height), left + 3:right - 3, :3]
    assert row[:5].max() < 30 and row[-5:].max() < 30
    assert ax.get_yticks().tolist() == [0.0] == ep.plots.plot_ghosts(labels).subfigs[1].axes[1].get_xticks().tolist()


@pytest.mark.filterwarnings("ignore:no signal of:RuntimeWarning")
def test_a_single_cell_over_time_has_no_numbers_but_its_own(frame):
    """The velocity of one chirp, and the range of one sample: half a metre to either side of it is nobody's."""
    for count, show in (({"num_chirps": 1}, ep.spectrogram), ({"num_samples": 1}, ep.range_time)):
        radar = frame.radar.replace(waveform=frame.radar.waveform.replace(**count))
        drawn = show(ep.Sequence(frame.scene, radar, frames=2, interval=0.05, num_rays=100, guard=False)).plot()
        assert drawn.get_yticks().tolist() == [0.0] and drawn.get_ylim() == (-0.5, 0.5)


def test_labels_of_uneven_azimuths_fill_their_cells(frame, ax):
    """A cell reaches half-way to its neighbours, whatever the distance of the first two, as the map below it does."""
    azimuth = np.radians([-60.0, -58.0, 0.0, 20.0, 40.0, 60.0])
    labels = ep.annotate(frame.paths, {"plate": "T 'plate' R"}, plane="range_azimuth", angles={"azimuth": azimuth})
    labels.plot("objects", ax=ax)
    filled = np.concatenate([path.vertices for path in ax.collections[1].get_paths()])
    rows = np.flatnonzero((labels.object_map >= 0).any(axis=1))
    edges = np.array([-61.0, -59.0, -29.0, 10.0, 30.0, 50.0, 70.0])
    assert np.allclose([filled[:, 1].min(), filled[:, 1].max()], [edges[rows[0]], edges[rows[-1] + 1]])
    bars = ep.plots.plot_ghosts(labels).subfigs[1].axes[1].patches
    assert np.allclose([bars[0].get_x(), bars[0].get_x() + bars[0].get_width()], [edges[rows[0]], edges[rows[-1] + 1]])


def test_names_of_objects_at_one_place_do_not_cover_each_other(ax):
    from support.labelled import ROUGH, make_radar

    scene = ep.Scene()
    for index in range(5):
        scene.add(ep.actors.plate(0.2, 0.2), name=f"object_{index}", material=ROUGH, position=(8 + 0.6 * index, index - 2, 1),
                  yaw=np.pi)
    paths = ep.trace(scene, make_radar(), num_rays=4000)
    ax.figure.set_size_inches(9, 5)
    ep.annotate(paths, {"plates": "T . R"}).plot(ax=ax)
    ax.figure.canvas.draw()
    boxes = [matplotlib.text.Text.get_window_extent(text) for text in ax.texts if text.get_text().startswith("object_")]
    assert len(boxes) >= 4
    assert not any(a.overlaps(b) for i, a in enumerate(boxes) for b in boxes[i + 1:])


def test_the_title_of_a_frame_tells_of_noise_only_where_there_is_some(frame, ax):
    assert frame.plot(ax=ax).get_title() == "Everything that the radar receives, with its noise"
    without = dataclasses.replace(frame, noise_seed=None, detections=None)
    assert without.plot(ax=ax).get_title() == "Everything that the radar receives"
    assert without.plot(ax=ax, title="Mine").get_title() == "Mine"


def test_frames_and_detections_without_what_is_asked_for_say_so(frame, tmp_path):
    frame.paths.save(tmp_path / "paths.h5")
    with pytest.raises(ValueError, match="frame: must have signals to draw"):
        ep.load_frame(tmp_path / "paths.h5").plot()
    one = build_radar([ep.Antenna()], [ep.Antenna((0, 0.01, 0))], num_samples=64, num_chirps=16, sampling_rate=5e6)
    scene = ep.Scene()
    scene.add(ep.actors.plate(1.0, 1.0), name="plate", material="metal", position=(5, 0, 0), yaw=np.pi)
    blind = ep.simulate(scene, one, num_rays=500, detections=True).detections
    if len(blind) and not np.isfinite(blind.azimuth).any():
        with pytest.raises(ValueError, match="view: 'above' needs azimuths"):
            blind.plot("above")


def test_axes_of_a_frame_hold_every_detection_that_its_legend_counts(frame, ax):
    """At a false alarm in 1000 cells, noise is detected all over the map, far from the plate."""
    found = ep.detect_frame(frame, false_alarm_rate=1e-3)
    frame = dataclasses.replace(frame, detections=found)
    frame.plot(ax=ax)
    (near, far), (bottom, top) = ax.get_xlim(), ax.get_ylim()
    assert np.ptp(found.range) > 5.0
    assert np.all((found.range >= near) & (found.range <= far) & (found.velocity >= bottom) & (found.velocity <= top))
    left, right, lowest, highest = ax.get_images()[0].get_extent()
    assert left <= near and far <= right and lowest <= bottom and top <= highest


def test_labels_without_parts_say_how_objects_are_seen(frame, ax):
    assert frame.labels["parts"].plot(ax=ax).get_title() == "Which part made each cell"
    assert 'plot("objects")' in ep.annotate(frame.paths).plot(ax=ax).get_title()


def test_of_many_tracks_at_one_place_those_of_the_legend_have_their_numbers(ax):
    """Four find room there, of which one is the last track, as it alone follows an object."""
    count = 30
    tracks = ep.Tracks(track=np.arange(count, dtype=np.int32), frame=np.zeros(count, int), time=np.zeros(count),
                       state=np.tile([10.0, 1.0, 0.0, 0.0], (count, 1)), covariance=np.tile(np.eye(4), (count, 1, 1)),
                       is_detected=np.ones(count, bool), object=np.array([""] * (count - 1) + ["car"]))
    tracks.plot(ax=ax)
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["29: car"]
    assert {text.get_text() for text in ax.texts} > {"29"} and len(ax.texts) < count


def test_tracks_that_share_a_colour_differ_in_their_lines(ax):
    count = 15
    tracks = ep.Tracks(track=np.repeat(np.arange(count, dtype=np.int32), 2), frame=np.tile([0, 1], count),
                       time=np.tile([0.0, 1.0], count),
                       state=np.arange(8.0 * count).reshape(-1, 4), covariance=np.zeros((2 * count, 4, 4)),
                       is_detected=np.ones(2 * count, bool), object=np.full(2 * count, ""))
    tracks.plot(ax=ax)
    looks = [(line.get_color(), line.get_linestyle()) for line in ax.lines if line.get_marker() == "."]
    assert len(looks) == count == len(set(looks))


def test_the_truth_is_drawn_where_the_boxes_are_from_the_radar_and_in_the_world(ax):
    """A radar at (3, 1) that looks along y; a box of 2 m by 1 m goes 4 m/s along x, 10 m ahead of it, and hides another."""
    radar = build_radar(num_samples=64, num_chirps=4).replace(position=(3.0, 1.0, 0.0), yaw=np.pi / 2)
    scene = ep.Scene()
    for name, y, speed in (("near", 11.0, 4.0), ("hidden", 14.0, 0.0)):
        scene.add(ep.actors.box((2.0, 1.0, 1.0)), name=name, position=(3.0, y, -0.5), material="metal", speed=speed)
    truth = ep.truth(ep.trace(scene, radar, num_rays=200))
    outlines = {"world": [[2.0, 10.5], [4.0, 11.5]], "radar": [[9.5, -1.0], [10.5, 1.0]]}  # x, y: least and largest
    ways = {"world": [7.0, 11.0], "radar": [10.0, -4.0]}
    for view, expected in outlines.items():
        ax.clear()
        truth.plot(view, ax=ax)
        faces = {style: [line[:, ::-1] for one, line in strokes(ax) if one == style and len(line) == 5] for style in ("-", "--")}
        face = faces["-"][0]
        assert np.allclose([face.min(axis=0), face.max(axis=0)], expected, atol=1e-3)
        assert len(faces["--"]) == 2  # the lower and the upper face of what nothing is seen of
        arrows = [text for text in ax.texts if text.arrow_patch is not None]
        assert [arrow.xy[::-1] for arrow in arrows] == [pytest.approx(ways[view], abs=1e-3)]
        assert {text.get_text() for text in ax.texts} - {""} == {"near", "hidden"} and ax.xaxis_inverted()
        assert "dashed" in ax.get_title() and "arrows" in ax.get_title()
    with pytest.raises(ValueError, match="view: must be 'radar' or 'world', got 'map'"):
        truth.plot("map")


def test_the_cuts_of_a_pattern_are_those_of_its_law(ax):
    """The gain of a lossless cos^4 is 10, of a narrow fan 16 ln 2 over the product of its widths, a half at half of each."""
    assert ep.plots.draw_pattern(ep.CosinePower(4.0), ax=ax) is ax and "10.0 dBi" in ax.get_title()
    for line in ax.lines:
        angle, gain = line.get_data()
        ahead = np.abs(angle) < 80.0
        assert gain[ahead] == pytest.approx(10.0 + 40.0 * np.log10(np.cos(np.radians(angle[ahead]))), abs=1e-6)
        assert gain[np.abs(angle) > 95.0].max() < ax.get_ylim()[0]
    ax.clear()
    ep.plots.draw_pattern(ep.GaussianBeam(azimuth=np.radians(20.0), elevation=np.radians(5.0)), ax=ax)
    peak = 10.0 * np.log10(16.0 * np.log(2.0) / np.prod(np.radians([20.0, 5.0])))
    for line, width in zip(ax.lines, (20.0, 5.0)):
        angle, gain = line.get_data()
        assert gain.max() == pytest.approx(peak, abs=0.05)
        assert np.interp(0.5 * width, angle, gain) - gain.max() == pytest.approx(10.0 * np.log10(0.5), abs=0.02)


def test_an_array_is_drawn_in_wavelengths_with_the_elements_that_it_makes(ax):
    """Three transmitters two wavelengths apart and four receivers half a one make a row of twelve, half a wavelength apart."""
    half = 0.5 * build_radar(num_samples=64, num_chirps=4).waveform.wavelength
    radar = build_radar([ep.Antenna((0.0, 4.0 * k * half, 1.0)) for k in range(3)],
                        [ep.Antenna((0.0, k * half, 1.0 - 4.0 * half)) for k in range(4)], num_samples=64, num_chirps=4)
    ep.plots.draw_array(radar, ax=ax, title="Mine")
    places = {one.get_label(): np.asarray(one.get_offsets()) for one in ax.collections}
    assert list(places) == ["transmitters: 3", "receivers: 4", "virtual elements: 12"] and ax.get_title() == "Mine"
    transmitters, receivers, virtual = places.values()
    assert np.sort(transmitters[:, 0]) == pytest.approx([-2.0, 0.0, 2.0]) and np.ptp(receivers[:, 0]) == pytest.approx(1.5)
    assert transmitters[0, 1] - receivers[0, 1] == pytest.approx(2.0)
    assert np.sort(virtual[:, 0]) == pytest.approx(0.5 * np.arange(12) - 2.75) and np.ptp(virtual[:, 1]) == pytest.approx(0.0)


@pytest.mark.parametrize("yaw", np.radians([90.0, -120.0, 180.0]))
def test_an_array_that_looks_aside_is_drawn_as_seen_from_behind(ax, yaw):
    """Antennas turned with their places about the radar's z, as those at the side of a car in its frame, keep their picture."""
    half = 0.5 * build_radar(num_samples=64, num_chirps=4).waveform.wavelength
    left = half * np.array([-np.sin(yaw), np.cos(yaw), 0.0])
    radar = build_radar([ep.Antenna(4.0 * k * left, yaw=yaw) for k in range(2)],
                        [ep.Antenna(k * left, yaw=yaw) for k in range(4)], num_samples=64, num_chirps=4)
    ep.plots.draw_array(radar, ax=ax)
    transmitters, receivers, virtual = (np.asarray(one.get_offsets()) for one in ax.collections)
    assert transmitters[:, 0] == pytest.approx([-1.0, 1.0]) and receivers[:, 0] == pytest.approx([-1.0, -0.5, 0.0, 0.5])
    assert np.sort(virtual[:, 0]) == pytest.approx(0.5 * np.arange(8) - 1.75) and np.ptp(virtual[:, 1]) == pytest.approx(0.0)


def test_the_truth_of_files_without_directions_in_the_radar_tells_of_no_arrows(frame, ax):
    old = dataclasses.replace(frame.truth, velocity=np.array([[4.0, 0.0, 0.0]]),
                              direction_in_radar=np.full_like(frame.truth.direction_in_radar, np.nan))
    for view, has_arrows in (("radar", False), ("world", True)):
        ax.clear()
        old.plot(view, ax=ax)
        assert ("arrows" in ax.get_title()) == has_arrows == any(text.arrow_patch is not None for text in ax.texts)


def test_the_boxes_of_the_truth_stand_out_of_a_dark_map(frame, ax):
    """Beside each stroke is white, as the darkest colours of a map are black."""
    ax.set_facecolor("black")
    frame.truth.plot(ax=ax)
    drawn = painted(ax)
    lines = [line for _, line in strokes(ax)]
    assert sum(len(line) == 5 for line in lines) == 2
    for line in lines:
        for row, column in pixels(ax, line):
            assert drawn[row - 3:row + 4, column - 3:column + 4].max() > 0.8


def test_pictures_of_the_truth_hold_no_more_artists_for_more_boxes_at_rest(frame, ax):
    """Artists take a millisecond each, so that 5000 boxes took 10 s."""
    one = frame.truth.to_records()
    many = np.repeat(one, 400)
    many["name"] = [b"%d" % number for number in range(400)]
    counts = []
    for records in (one, many):
        ax.clear()
        ep.Truth.from_records(records).plot(ax=ax)
        counts.append(len(ax.lines) + len(ax.patches) + len(ax.collections))
    assert counts[0] == counts[1] and sum(len(line) == 5 for _, line in strokes(ax)) == 800


def test_boxes_of_frames_in_a_row_do_not_cut_each_other_into_dashes(ax):
    """What is dashed says that the radar sees nothing of a box, while it sees this one in each frame, 0.4 m farther each."""
    scene, radar = ep.Scene(), build_radar(num_samples=64, num_chirps=4)
    scene.add(ep.actors.box((2.0, 1.0, 1.0)), name="box", position=(9.0, 0.5, 0.0), material="metal", speed=4.0)
    truth = ep.truth([ep.trace(scene, radar, num_rays=200, start_time=start) for start in (0.0, 0.1, 0.2)])
    ax.figure.set_dpi(300)
    truth.plot(ax=ax)
    drawn = painted(ax)
    along = np.linspace(8.1, 10.7, 200)  # m, from the rear of the first box to the front of the last
    assert np.all(truth.visible_share > 0.0)
    for side in (0.0, 1.0):
        assert all(drawn[row, column - 3:column + 4].min() < 0.6
                   for row, column in pixels(ax, np.stack([np.full_like(along, side), along], axis=1)))


def test_names_of_objects_side_by_side_are_not_written_over_each_other(ax):
    """Four poles 2 m apart across, in a picture of 60 m."""
    scene = ep.Scene()
    for k in range(4):
        scene.add(ep.actors.box((0.1, 0.1, 1.0)), name=f"pole_{k}", position=(30.0, 3.0 - 2.0 * k, 0.0), material="metal")
    scene.add(ep.actors.box((0.1, 0.1, 1.0)), name="far", position=(60.0, 0.0, 0.0), material="metal")
    ep.truth(ep.trace(scene, build_radar(num_samples=64, num_chirps=4), num_rays=200)).plot(ax=ax)
    assert_texts_are_apart(ax, 5)


def test_numbers_of_tracks_side_by_side_are_not_written_over_each_other(ax):
    """Tracks end 2 m apart across, in a picture of 60 m: "10" and "11" would read as "1011"."""
    count = 12
    state = np.zeros((count, 4))
    state[:, 0], state[-2:, :2] = 5.0 * np.arange(count), [[30.0, -20.0], [30.0, -22.0]]
    ep.Tracks(track=np.arange(count, dtype=np.int32), frame=np.zeros(count, int), time=np.zeros(count), state=state,
              covariance=np.zeros((count, 4, 4)), is_detected=np.ones(count, bool), object=np.full(count, "")).plot(ax=ax)
    assert_texts_are_apart(ax, count)


def assert_texts_are_apart(ax, count: int) -> None:
    ax.figure.canvas.draw()
    boxes = [text.get_window_extent() for text in ax.texts if text.get_text()]
    assert len(boxes) == count and not any(one.overlaps(other) for k, one in enumerate(boxes) for other in boxes[:k])


def painted(ax) -> np.ndarray:
    """The picture of axes in grey, 0 black to 1 white, [row, column]."""
    ax.figure.canvas.draw()
    return np.asarray(ax.figure.canvas.buffer_rgba())[..., :3].mean(axis=-1) / 255.0


def strokes(ax) -> list:
    """Pairs of the style, "-" or "--", and the points [N, 2] of the lines that are not white."""
    dark = [one for one in ax.collections if np.any(one.get_color()[0, :3] < 0.9)]
    return [("-" if one.get_linestyle()[0][1] is None else "--", line) for one in dark for line in one.get_segments()]


def pixels(ax, points) -> np.ndarray:
    """(row, column) of places [N, 2] of axes in their picture."""
    across, up = ax.transData.transform(points).T
    return np.stack([ax.figure.bbox.height - up, across], axis=1).astype(int)


def test_the_velocity_of_one_chirp_has_no_other_tick_than_its_own(ax):
    radar = build_radar(num_samples=16, num_chirps=1)
    ep.range_doppler(np.ones((1, 1, 1, 16), complex), radar).plot(ax=ax)
    ax.figure.canvas.draw()
    assert ax.get_yticks().tolist() == [0.0] and len(ax.get_xticks()) > 1


def test_figures_without_a_window_are_shown_by_pyplot(frame, monkeypatch):
    from matplotlib import pyplot as plt

    shown = []
    monkeypatch.setattr(plt, "show", lambda: shown.append([plt.figure(number) for number in plt.get_fignums()]))
    plt.close("all")
    figure = ep.plots.plot_scene(frame.scene, frame.paths)
    for given in (figure, figure.axes[0], figure):  # once shown, it has its window
        ep.plots.show(given)
    assert shown == [[figure]] * 3
    assert plt.gcf() is figure
    figure.canvas.draw()
    assert np.ptp(np.asarray(figure.canvas.buffer_rgba())) > 0
    plt.close("all")
    with pytest.raises(TypeError, match="figure: must be a figure of matplotlib, or axes in it, got"):
        ep.plots.show(frame)


@pytest.mark.parametrize("count, most_named", [(6, 6), (20, 4)])
def test_names_of_objects_that_stand_together_stand_apart_and_near(count, most_named):
    """As measured on the page: all of few, of many those that find room right beside what they name."""
    scene = ep.Scene()
    for k in range(count):
        scene.add(ep.actors.plate(0.3, 0.3), name=f"plate_{k}", material="metal", position=(5.0, 1e-4 * k, 0.0))
    ax = ep.truth(ep.trace(scene, build_radar(num_samples=64, num_chirps=4), num_rays=200)).plot()
    ax.figure.draw_without_rendering()
    names = [text for text in ax.texts if text.get_text().startswith("plate")]
    boxes = [text.get_window_extent() for text in names]
    assert 2 <= len(names) <= most_named and (count > 12 or len(names) == count)
    assert not any(one.overlaps(other) for one, other in itertools.combinations(boxes, 2))
