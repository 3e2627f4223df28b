"""Detections where chirps differ from slot to slot, against the signals of single paths and of families."""
from __future__ import annotations

import numpy as np
import pytest

import echopath as ep
from echopath.detections.uneven_fields import echo_fields
from echopath.paths.cells import cells_of
from support.radars import with_waveform
from support.scenes.small_spheres import TARGETS, radar_with, scene_of
from support.shapes import lambert

MODEL = 0.02  # of the peak; 0.005 found
HELD = 0.95   # of a cell's power, by the paths named
SLOTS = {
    "staggered": dict(extra_idle=(0.0, 20e-6, 7e-6)), "hopping": dict(frequency_steps=(0.0, 170e6, 60e6, 110e6, 20e6)),
    "wider": dict(bandwidth_steps=(0.0, 40e6)),
    "all": dict(extra_idle=(0.0, 9e-6), frequency_steps=(0.0, 8e7, 3e7), bandwidth_steps=(0.0, -3e7, 2e7, 1e7))}


@pytest.mark.parametrize("window, zero_pad", [("hann", 1), ("rect", 2)])
@pytest.mark.parametrize("slots", SLOTS.values(), ids=SLOTS)
def test_the_field_of_a_single_path_is_that_of_its_signal_at_all_velocities(slots, window, zero_pad):
    radar = with_waveform(radar_with(receivers=2, transmitters=2), **slots)
    paths = ep.trace(scene_of(TARGETS), radar, num_rays=600, max_bounces=1, start_time=0.01)
    spectrum = ep.range_doppler(ep.synthesize(paths, radar), radar, window, zero_pad)
    echoes, nearest_cell = echo_fields(paths, spectrum), cells_of(paths, spectrum)
    for chosen in (np.argmax(np.where(paths.mesh_id[paths.offsets] == number, np.abs(paths.amplitude), 0.0))
                   for number in range(len(TARGETS))):
        alone = ep.synthesize(paths.select(np.arange(paths.num_paths) == chosen), radar, method="direct")
        values = ep.range_doppler(alone, radar, window, zero_pad).values.reshape(4, *spectrum.values.shape[2:])
        far = nearest_cell.range_index[chosen]
        for cell in [(slow, far + beside) for slow in range(0, values.shape[1], 13) for beside in (0, 1)]:
            index, field = echoes.fields(cell)
            model = field[:, index == chosen].sum(axis=1)
            exact = values[:, *cell]
            turn = np.vdot(model, exact) / max(abs(np.vdot(model, exact)), 1e-300)  # of all fields of a cell: where samples begin
            np.testing.assert_allclose(turn * model, exact, rtol=0.0, atol=MODEL * np.abs(values).max())


# Place in m, velocity in m/s, changes of the waveform: 90 m/s^2 outward turn the phase by 1.4 cycles between the middle of the
# frame and its ends; slopes that differ by 1.3 % turn it by 14 degrees at 106 m.
LONG_WAYS = {"speeds up": ((10.0, 0.0, 0.0), (0.0, 30.0, 0.0), SLOTS["staggered"]),
             "far": ((106.0, 4.0, 0.0), (20.0, 0.0, 0.0), dict(bandwidth=1.5e8, bandwidth_steps=(0.0, 2e6)))}


@pytest.mark.parametrize("place, velocity, changes", LONG_WAYS.values(), ids=LONG_WAYS)
def test_the_field_of_what_speeds_up_or_is_far_is_that_of_its_signal(place, velocity, changes):
    radar = with_waveform(radar_with(receivers=1, transmitters=2, num_chirps=128, chirp_interval=60e-6), **changes)
    scene = ep.Scene()
    scene.add(ep.actors.plate(0.1, 0.1), name="plate", material=lambert(0.3), position=place,
              motion=ep.LinearMotion(velocity=velocity))
    paths = ep.trace(scene, radar, num_rays=300, max_bounces=1)
    spectrum = ep.range_doppler(ep.synthesize(paths, radar), radar)
    echoes, chosen = echo_fields(paths, spectrum), np.argmax(np.abs(paths.amplitude))
    alone = ep.synthesize(paths.select(np.arange(paths.num_paths) == chosen), radar, method="direct")
    values = ep.range_doppler(alone, radar).values.reshape(2, *spectrum.values.shape[2:])
    far = cells_of(paths, spectrum).range_index[chosen]
    cells = [(row, far + beside) for row in range(0, values.shape[1], 3) for beside in (0, 1, 2)]
    exact = np.array([values[:, *cell] for cell in cells])
    model = np.array([field[:, index == chosen].sum(axis=1) for index, field in map(echoes.fields, cells)])
    turns = np.sum(model.conj() * exact, axis=1, keepdims=True)  # of both fields of a cell: where samples begin
    np.testing.assert_allclose(model * turns / np.maximum(np.abs(turns), 1e-300), exact, rtol=0.0,
                               atol=MODEL * np.abs(values).max())


@pytest.mark.parametrize("slots", SLOTS.values(), ids=SLOTS)
def test_detections_have_the_strongest_family_of_their_cells_and_the_paths_behind_them(slots):
    scene = ep.Scene()
    scene.add(ep.actors.pedestrian(height=1.78, speed=1.5), name="walker", position=(8, 0, -1), yaw=np.pi)
    scene.add(ep.actors.plate(0.3, 0.3), name="plate", material=lambert(0.27), position=(14, -1, 0),
              motion=ep.LinearMotion(velocity=(30.0, 0, 0)))
    radar = with_waveform(radar_with(receivers=2, transmitters=2, num_chirps=128, chirp_interval=60e-6), **slots)
    paths = ep.trace(scene, radar, num_rays=1500, max_bounces=1)
    maps = {family.object: ep.range_doppler(cube, radar).values
            for family, cube in ep.decompose(paths, radar, ep.families(paths)).items()}
    spectrum = ep.range_doppler(ep.add_noise(ep.synthesize(paths, radar), radar, seed=2), radar)
    found = ep.detect(spectrum, radar, paths=paths)
    powers = np.array([np.mean(np.abs(values) ** 2, axis=(0, 1))[tuple(found.cells.T)] for values in maps.values()])
    echoes = np.mean(np.abs(sum(maps.values())) ** 2, axis=(0, 1))[tuple(found.cells.T)]
    measured = np.mean(np.abs(spectrum.values) ** 2, axis=(0, 1))[tuple(found.cells.T)]
    sure = np.abs(echoes / measured - 0.5) > 0.1
    assert np.array_equal(found.is_noise[sure], (echoes < 0.5 * measured)[sure]) and {"walker", "plate"} <= set(found.object)
    clear = sure & ~found.is_noise & (powers.max(axis=0) > 2.0 * np.sort(powers, axis=0)[-2])
    assert list(found.object[clear]) == [list(maps)[best] for best in powers[:, clear].argmax(axis=0)]
    for i in np.argsort(-found.snr_db)[:3]:
        index, _ = found.paths(i)
        alone = ep.synthesize(paths.select(np.isin(np.arange(paths.num_paths), index)), radar)
        held = np.mean(np.abs(ep.range_doppler(alone, radar).values[:, :, *found.cells[i]]) ** 2)
        assert held == pytest.approx(echoes[i], rel=1.0 - HELD, abs=0.0)
