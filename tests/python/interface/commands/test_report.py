"""What the command line says of a run."""
from __future__ import annotations

import numpy as np
import pytest

import echopath as ep
from echopath.cli import report

NUM_PLATES = 60


@pytest.fixture(scope="module")
def frame():
    """Of plates side by side, the last of which is the largest."""
    chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=64, sampling_rate=20e6, num_chirps=4,
                              chirp_interval=1e-5)
    radar = ep.Radar(chirps, transmitters=[ep.Antenna()], receivers=[ep.Antenna()])
    scene = ep.Scene()
    for index in range(NUM_PLATES):
        size = 0.5 if index == NUM_PLATES - 1 else 0.02
        scene.add(ep.actors.plate(size, size), name=f"plate_{index}", position=(5.0, 0.5 * (NUM_PLATES - 1 - index), 0.0),
                  material="metal")
    return ep.simulate(scene, radar, num_rays=2000, guard=False, labels=True, truth=True)


@pytest.mark.parametrize("table", ["labels", "kept_truth"])
def test_of_many_objects_the_strongest_are_listed(frame, table):
    lines = {"labels": report.labels, "kept_truth": report.truth}[table](getattr(frame, table))
    listed = [line.split()[0] for line in lines if line.startswith("  plate_")]
    assert len(listed) == report.MAX_LISTED and listed[-1] == f"plate_{NUM_PLATES - 1}"
    assert listed == sorted(listed, key=lambda name: int(name.removeprefix("plate_")))
    assert f"  and {NUM_PLATES - report.MAX_LISTED} more" in lines


def test_leakage_is_not_the_surroundings():
    """A ball 5 m away and leakage at 0 m are all that the map holds."""
    radar = ep.Radar(ep.ChirpSequence(num_samples=128, num_chirps=16), transmitters=[ep.Antenna()], receivers=[ep.Antenna()],
                     receiver=ep.Receiver(leakage_db=[[-60.0]]))
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.3, edge=0.02), name="ball", position=(5.0, 0.0, 0.0), material="metal", smooth=True)
    found = ep.simulate(scene, radar, num_rays=2000, guard=False, detections={"method": "os"}).detections
    counts = {words: int(count) for words, count in (one.rsplit(maxsplit=1) for one in report.detections(found, {})[1:])}
    assert {words.strip(): count > 0 for words, count in counts.items()} == {
        "the surroundings": False, "ball": True, "leakage": True, "noise alone": False}


def test_names_that_are_longer_than_their_column_stand_apart():
    assert report.line("n" * 50, "value") == f"  {'n' * 50}  value"


def balls(material, *distances):
    """Balls one behind the other, none of which hides another, and the radar that sees them."""
    chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=128, num_chirps=4)
    radar = ep.Radar(chirps, transmitters=[ep.Antenna()], receivers=[ep.Antenna()])
    scene = ep.Scene()
    for index, (distance, side) in enumerate(zip(distances, (-1.0, 1.0))):
        scene.add(ep.actors.sphere(0.1), name=f"ball_{index}", position=(distance, side, 0.0), material=material, smooth=True)
    return ep.simulate(scene, radar, num_rays=4000, guard=False)


def told_power(lines):
    return float(lines[1].replace("not resolved, ", "").split()[1])


def test_echoes_that_cancel_at_the_start_frequency_are_told_to_be_there_over_the_band():
    """Of two balls alike, the one farther by cells of range and a quarter wavelength, the echoes cancel at the start."""
    wavelength = ep.speed_of_light / 77e9
    near = np.hypot(4.0, 1.0)
    far = np.sqrt((near + 300.25 * wavelength) ** 2 - 1.0)
    frame = balls("metal", 4.0, far)
    of_signals, at_start = report.powers(frame, {}), report.mean_powers(frame)
    assert told_power(of_signals) > told_power(at_start) + 3.0
    assert "over the band" in of_signals[0] and "start frequency" in at_start[0]
    assert at_start[-1] == report.ONE_FREQUENCY and not any("random" in one for one in of_signals + at_start)


def test_random_phases_are_told_where_there_are_some():
    frame = balls(ep.Material(reflectivity=0.5, scattering=1.0), 4.0)
    assert "random phases" in report.powers(frame, {})[0] and "random phases" in report.mean_powers(frame)[0]
    assert report.ONE_FREQUENCY not in report.mean_powers(frame)
