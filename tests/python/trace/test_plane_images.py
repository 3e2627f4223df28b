"""Images on planes that nobody marked: one path in place of what rays would add up, and none where the plane is too small."""
import warnings

import numpy as np
import pytest

import echopath as ep
from echopath.bench.worlds import city as worlds

NO_STRATUM = 65535
WEIGHT_TOLERANCE = 1e-6      # relative: single precision
DELAY_TOLERANCE = 1e-12      # s
LEVEL_TOLERANCE_DB = 0.01
CONCRETE = ep.Material(permittivity=5.2 - 0.3j)


def radar(transmitter=(0, 0, 1.5), receiver=(0, 0.2, 1.5), frequency=77e9):
    waveform = ep.ChirpSequence(start_frequency=frequency, num_chirps=1)
    return ep.Radar(waveform, transmitters=[ep.Antenna(transmitter)], receivers=[ep.Antenna(receiver)])


def box(size, center):
    """Six sides, one mesh."""
    corners = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]) * size + center
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return ep.Mesh(corners, [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])


RADAR = radar()


def traced(mesh, at=RADAR, *, material=CONCRETE, num_rays=30_000, max_bounces=2, **more):
    scene = ep.Scene()
    scene.add(mesh, name="building", material=material)
    return ep.trace(scene, at, num_rays=num_rays, max_bounces=max_bounces, **more)


def images(paths):
    return np.flatnonzero(np.asarray(paths.stratum) == NO_STRATUM)


def test_a_building_has_the_echo_of_its_wall_s_image():
    paths = traced(box((8.0, 10.0, 9.0), (14.1, 0.3, 4.6)), polarization="scalar")
    (one,) = images(paths)
    length = np.hypot(2 * 10.1, 0.2)
    assert paths.lengths([paths.frame.trace_time], 0, 0)[0][one] == pytest.approx(length, abs=1e-9)
    index = np.sqrt(5.2 - 0.3j)
    reflection = abs((index - 1) / (index + 1))  # the angle of incidence is 0.6 degrees
    expected = ep.speed_of_light / 77e9 * np.sqrt(paths.radar.transmit_power) * reflection / (4 * np.pi * length)
    assert abs(paths.amplitude[one]) == pytest.approx(expected, rel=1e-4)
    assert not np.any((np.asarray(paths.diffuse) == 0) & (np.asarray(paths.stratum) != NO_STRATUM))


def test_marking_the_building_changes_nothing_between_the_antennas():
    shape = box((8.0, 10.0, 9.0), (14.1, 0.3, 4.6))
    found, marked = (traced(shape, material=CONCRETE.replace(mirror=mirror), polarization="jones") for mirror in (False, True))
    assert found.amplitude[images(found)] == pytest.approx(marked.amplitude[images(marked)], rel=WEIGHT_TOLERANCE)


def test_a_box_below_its_zone_has_no_image():
    paths = traced(box((0.2, 0.2, 0.2), (10.1, 0.0, 1.5)))
    assert len(images(paths)) == 0 and paths.num_paths > 100


def test_a_wall_seen_askew_has_no_image_and_keeps_its_echoes():
    away = traced(box((8.0, 4.0, 9.0), (14.1, 6.0, 4.6)))  # its point of reflection lies beside it
    assert len(images(away)) == 0 and np.any(np.asarray(away.diffuse) == 0)


@pytest.mark.parametrize("depth", [0.03, 0.1])
def test_a_corner_counts_once(depth):
    """Two walls at right angles: the image in their common edge, whichever order it has."""
    scene = ep.Scene()
    corner = ep.Mesh([[12, -6, -4], [18, 0, -4], [12, 6, -4], [12, -6, 4], [18, 0, 4], [12, 6, 4]],
                     [[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4]])
    scene.add(corner, name="corner", material="metal")
    paths = ep.trace(scene, radar((0, depth, 0), (0, -0.5 * depth, 0)), num_rays=60_000, max_bounces=2, polarization="scalar")
    lengths = np.asarray(paths.lengths([paths.frame.trace_time], 0, 0))[0]
    double = (np.asarray(paths.num_bounces) == 2) & (np.asarray(paths.diffuse) == 0)
    wavenumber = 2 * np.pi * 77e9 / ep.speed_of_light
    field = np.sum(np.asarray(paths.amplitude)[double] * np.exp(-1j * wavenumber * lengths[double]))
    unfolded = np.hypot(36.0, 0.5 * depth)
    expected = ep.speed_of_light / 77e9 * np.sqrt(paths.radar.transmit_power) / (4 * np.pi * unfolded)
    assert 20 * np.log10(abs(field) / expected) == pytest.approx(0.0, abs=0.1)


def wedge_on_a_floor(half_deg):
    """Two metal walls of 6 x 8 m that meet on the z axis, open toward +x by twice the angle, and a floor at z = -0.3 m."""
    scene = ep.Scene()
    ends = [6.0 * np.array([np.cos(angle), np.sin(angle), 0.0]) for angle in np.radians([half_deg, -half_deg])]
    for index, end in enumerate(ends):
        low, up = np.array([0.0, 0.0, -4.0]), np.array([0.0, 0.0, 8.0])
        scene.add(ep.Mesh([low, low + end, low + end + up, low + up], [[0, 1, 2], [0, 2, 3]]), name=f"wall_{index}",
                  material="metal")
    scene.add(ep.Mesh(np.array([[0, 0, 0], *ends]) - [0, 0, 0.3], [[0, 1, 2]]), name="floor", material="metal")
    return scene


def test_a_corner_of_five_bounces_counts_once():
    """Four bounces between the walls and one on the floor, whichever order they have."""
    antennas = radar((4.5, 0.03, 0.05), (4.5, -0.012, 0.03))
    paths = ep.trace(wedge_on_a_floor(22.5), antennas, num_rays=30_000, max_bounces=5, polarization="scalar")
    lengths = np.asarray(paths.lengths([paths.frame.trace_time], 0, 0))[0]
    five = (np.asarray(paths.num_bounces) == 5) & (np.asarray(paths.diffuse) == 0)
    wavenumber = 2 * np.pi * 77e9 / ep.speed_of_light
    field = np.sum(np.asarray(paths.amplitude)[five] * np.exp(-1j * wavenumber * lengths[five]))
    # Four bounces in a wedge of 45 degrees turn the receiver by 180 degrees about its edge, the floor mirrors it.
    unfolded = np.linalg.norm(np.array([4.5, 0.03, 0.05]) - [-4.5, 0.012, -0.63])
    expected = ep.speed_of_light / 77e9 * np.sqrt(paths.radar.transmit_power) / (4 * np.pi * unfolded)
    assert 20 * np.log10(abs(field) / expected) == pytest.approx(0.0, abs=0.05)


def test_a_path_by_image_is_replayed_and_saved(tmp_path):
    paths = traced(box((8.0, 10.0, 9.0), (14.1, 0.3, 4.6)))
    cube = ep.synthesize(paths, paths.radar)
    frame = tmp_path / "paths.h5"
    paths.save(frame)
    assert np.array_equal(ep.synthesize(ep.Paths.load(frame), paths.radar), cube)
    assert ep.received_power(paths).power > 0
    ep.validity(paths, paths.radar)


def test_one_warning_tells_of_many_coarse_meshes():
    scene = ep.Scene()
    for index in range(5):
        scene.add(ep.actors.sphere(0.1 + 0.01 * index, subdivisions=4), name=f"ball_{index}", material="metal",
                  position=(5, index, 0))
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        ep.trace(scene, radar(), num_rays=10, max_bounces=1)
    (text,) = [str(one.message) for one in caught if issubclass(one.category, ep.TessellationWarning)]
    assert text.startswith("5 meshes") and "ball_4" in text


def test_the_benchmark_of_worlds_finds_all_paths():
    rows = worlds.rows(quick=True)
    unmarked, marked, many = rows
    for row in (unmarked, marked):
        assert row["paths"] > 0 and row["delay_error_s"] < DELAY_TOLERANCE and row["level_error_db"] < LEVEL_TOLERANCE_DB
        assert row["missing"] == row["beside"] == 0
    assert many["meshes"] == worlds.QUICK_MESHES
    assert len(worlds.describe(rows)) == 3
