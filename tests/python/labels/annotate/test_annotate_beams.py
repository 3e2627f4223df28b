"""Labels of range-azimuth maps."""
import numpy as np
import pytest

import echopath as ep
from echopath import _core
from support.labelled import add_plate, make_radar
from support.radars import build_radar

GRID_DEGREES = 0.5  # half a step of the grid, whose points the plates stand on


def test_azimuths_tell_plates_at_one_range_apart():
    scene = ep.Scene()
    for name, degrees in (("left", 25.0), ("right", -20.0)):
        angle = np.radians(degrees)
        add_plate(scene, name, (10 * np.cos(angle), 10 * np.sin(angle), 1))
    radar = make_radar(num_rx=12)
    paths = ep.trace(scene, radar, num_rays=20_000)
    parts = {"left": "T 'left' R", "right": "T 'right' R"}
    found = ep.annotate(paths, parts, plane="range_azimuth", angles={"window": "hamming"}, dynamic_range_db=25.0)
    assert found.velocity is None and found.shape == (len(found.azimuth), len(found.range))
    rows = np.nonzero(found.mask)[0]
    expected = np.where(found.azimuth[rows] > np.radians(2.5), 0, 1)
    assert len(rows) > 20 and np.mean(found.dominant[found.mask] == expected) == 1.0
    left, right = found.objects
    assert np.degrees(left.peak.azimuth) == pytest.approx(25.0, abs=GRID_DEGREES) and left.box.azimuth_min > 0
    assert np.degrees(right.peak.azimuth) == pytest.approx(-20.0, abs=GRID_DEGREES)


def test_noise_of_beams_is_that_of_a_cell_over_the_number_of_elements():
    radar = make_radar(num_rx=8)
    scene = ep.Scene()
    add_plate(scene, "plate", (10, 0, 1))
    paths = ep.trace(scene, radar, num_rays=500)
    found = ep.annotate(paths, plane="range_azimuth", angles={"velocity": 0.0})
    cell = _core.cell_noise_power(radar, "hann")
    assert found.noise_power / cell * 8 == pytest.approx(1.0, abs=0.05)  # 256 ranges of 8 beams, neighbours alike


@pytest.mark.parametrize("code", [{"multiplexing": "ddm", "empty_slots": 1}, {"multiplexing": "bpm"}])
def test_noise_of_beams_is_what_undoing_a_code_leaves(code):
    """The strongest velocity of each cell, of noise of twenty frames that are taken apart."""
    half = 0.5 * ep.speed_of_light / 77e9
    radar = build_radar([(0, 4 * tx * half, 0) for tx in range(4)], [(0, rx * half, 0) for rx in range(4)], num_chirps=60, **code)
    scene = ep.Scene()
    add_plate(scene, "plate", (10, 0, 1))
    frames = [ep.demultiplex(ep.add_noise(np.zeros((1, 4, 60 * radar.num_slots, 64)), radar, seed=seed), radar)
              for seed in range(5, 25)]
    measured = np.mean([ep.range_azimuth(ep.range_doppler(frame, radar), radar, combine="peak").power for frame in frames])
    found = ep.annotate(ep.trace(scene, radar, num_rays=500), plane="range_azimuth")
    assert found.noise_power == pytest.approx(measured, rel=0.07)  # of one frame; 0.04 found


def test_capon_beams_are_refused():
    radar = make_radar(num_rx=4)
    paths = ep.trace(ep.Scene(), radar, num_rays=10)
    with pytest.raises(ValueError, match="angles: method must be 'bartlett'"):
        ep.annotate(paths, plane="range_azimuth", angles={"method": "capon"})
