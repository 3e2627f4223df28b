"""Maps of range and azimuth: of targets whose place is known, and in frames."""
from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import echopath as ep
from support.signals.arrays import DEGREE, HALF, TARGET_RADIUS, at, mimo, scene_of_spheres, spectrum_of, three_by_four, waveform

DATA = Path(__file__).resolve().parents[3] / "data"
SAMPLED = 0.02        # relative: 2e4 independent cells of noise (0.7 %), or side lobes of a second target (1.2 %)
NEAR_BEAM = 0.6       # degrees: from the nearest point of the grid, 1 degree wide
WIDE_BEAM = 0.1       # degrees: the places are points of the grid


def test_a_map_shows_targets_at_their_range_azimuth_and_power():
    radar = three_by_four(chirps=waveform(num_chirps=16))
    centres = [at(5.0, 0.5, 0.0), at(8.0, -0.2, 0.0)]
    spectrum = spectrum_of(scene_of_spheres(*centres), radar)
    picture = ep.range_azimuth(spectrum, radar)
    power = np.mean(np.abs(spectrum.values[:, :, 8]) ** 2, axis=(0, 1))
    for distance, azimuth in ((5.0, 0.5), (8.0, -0.2)):
        near = np.abs(picture.range - distance + TARGET_RADIUS) < 0.3
        a, r = np.unravel_index(picture.power[:, near].argmax(), (len(picture.azimuth), near.sum()))
        assert picture.azimuth[a] == pytest.approx(azimuth, abs=NEAR_BEAM * DEGREE)
        assert picture.power[:, near][a, r] == pytest.approx(power[near][r], rel=SAMPLED, abs=0)


def test_the_scene_of_corners_shows_each_target_at_its_place():
    from echopath.cli.run import simulate_file

    scene_file = ep.load_scene(DATA / "scenes" / "corners.toml")
    frame = simulate_file(scene_file, num_rays=30_000)
    maps = {name: frame.range_azimuth_of(spectrum) for name, spectrum in frame.part_spectra["target"].items()}
    places = {"corner_right": (6, -35), "corner_left": (9, 10), "corner_far": (14, 30), "ball_approaching": (9.8, -15),
              "ball_beside": (9, 20)}
    for name, (distance, azimuth) in places.items():
        one = maps["corners" if name.startswith("corner") else "balls"]
        near = np.abs(one.range - distance) < 0.3
        a, _ = np.unravel_index(one.power[:, near].argmax(), (len(one.azimuth), near.sum()))
        assert one.azimuth[a] == pytest.approx(azimuth * DEGREE, abs=WIDE_BEAM * DEGREE), name
    assert frame.range_azimuth.power.shape == (301, 256)


def test_settings_of_a_map_are_checked_before_the_trace():
    radar = mimo([(0, 0)], [(np.cos(0.7 * i), np.sin(0.7 * i)) for i in range(9)])
    scene = scene_of_spheres([8.0, 0, 0])
    stages = []
    for angles, text in (({"window": "hann"}, "^window: "), ({"velocity": 99.0}, "^velocity: "),
                         ({"velocity_gate": (98.0, 99.0)}, "^velocity_gate: "), ({"progress": None}, "^angles: .*'progress'"),
                         ({"azimuth": 9}, "^azimuth: "), ({"windw": "hann"}, "'windw'")):
        with pytest.raises((ValueError, TypeError), match=text):
            ep.simulate(scene, radar, angles=angles, progress=lambda stage, fraction: stages.append(stage))
    assert "trace" not in stages
    padded = 0.5 * radar.waveform.velocity_resolution(1)  # a cell of padded maps alone
    gate = {"velocity_gate": (0.9 * padded, 1.1 * padded)}
    with pytest.raises(ValueError, match="^velocity_gate: "):
        ep.simulate(scene, radar, num_rays=100, angles=gate, guard=False)
    assert ep.simulate(scene, radar, num_rays=100, angles=gate, zero_pad=2, guard=False).range_azimuth is not None


def test_frames_of_one_channel_have_no_map_of_azimuth():
    frame = ep.simulate(scene_of_spheres([8.0, 0, 0]), mimo([(0, 0)], [(0, 0)]), num_rays=100)
    assert frame.range_azimuth is None


def test_frames_of_arrays_longer_than_a_map_have_none_unless_azimuths_are_given():
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.3), name="sphere", position=(10, 0, 0), material="concrete")
    radar = mimo([(0, 0)], [(0, 0), (1, 0), (359_000, 0)])  # 700 m
    assert ep.simulate(scene, radar, num_rays=500, guard=False).range_azimuth is None
    frame = ep.simulate(scene, radar, num_rays=500, guard=False, angles={"azimuth": [-0.1, 0.0, 0.1]})
    assert frame.range_azimuth.power.shape[0] == 3
    with pytest.raises(ValueError, match="^plane: 'range_azimuth' needs antennas side by side, and angles with an azimuth"):
        ep.annotate(frame.paths, plane="range_azimuth")


def test_frames_of_arrays_too_high_for_all_elevations_have_their_map_of_azimuth():
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.3), name="sphere", position=(10, 0, 0), material="concrete")
    radar = mimo([(0, 0)], [(0, 0), (1, 0), (0, 1), (0, 359_000)])  # 700 m
    frame = ep.simulate(scene, radar, num_rays=500, guard=False)
    assert frame.range_azimuth.azimuth == pytest.approx(np.radians(np.arange(-90.0, 91.0)), rel=0, abs=1e-7)
    with pytest.raises(ValueError, match="^elevation: must be given"):
        ep.virtual_array(radar).default_angles()


def test_a_map_of_azimuth_by_one_antenna_is_warned_of():
    radar = mimo([(0, 0)], [(0, 0)])
    spectrum = ep.range_doppler(np.zeros((1, 1, radar.waveform.num_chirps, radar.waveform.num_samples)), radar)
    with pytest.warns(RuntimeWarning, match="range_azimuth: the antennas of this radar tell no azimuths apart"):
        ep.range_azimuth(spectrum, radar)


def test_the_picture_of_a_radar_that_looks_back_holds_all_that_it_sees():
    """Of 210 degrees to the left, where detections count -150."""
    from matplotlib import pyplot

    from echopath import plots
    look = 180 * DEGREE
    radar = ep.Radar(waveform(num_chirps=16), transmitters=[ep.Antenna((0, 0, 0), yaw=look)],
                     receivers=[ep.Antenna((0, n * HALF, 0), yaw=look) for n in range(4)])
    spectrum = spectrum_of(scene_of_spheres(at(8.0, -150 * DEGREE, 0.0)), radar, num_rays=500)
    figure = plots.plot_range_azimuth(ep.range_azimuth(spectrum, radar), places={"ball": (8.0, -150 * DEGREE)})
    assert "ball" in [text.get_text() for text in figure.axes[0].texts]
    (left, right), (back, front) = figure.axes[0].get_xlim(), figure.axes[0].get_ylim()
    across, ahead = 8.0 * np.sin(-150 * DEGREE), 8.0 * np.cos(-150 * DEGREE)
    assert right < across < left and back < ahead < front
    pyplot.close(figure)


def test_the_legend_of_a_narrow_sector_leaves_its_label_readable():
    from echopath import plots
    radar = three_by_four()
    seen = ep.range_azimuth(spectrum_of(scene_of_spheres(at(8.0, 60 * DEGREE, 0.0)), radar, num_rays=500), radar,
                            np.linspace(30 * DEGREE, 180 * DEGREE, 31))
    figure = plots.plot_range_azimuth(seen, places={"ball": (8.0, 60 * DEGREE)})
    figure.draw_without_rendering()
    label, (legend,) = figure.axes[0].xaxis.label, figure.legends
    assert label.get_text() and not label.get_window_extent().overlaps(legend.get_window_extent())
