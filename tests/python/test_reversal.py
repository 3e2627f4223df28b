"""Paths in both directions: what one order cannot carry comes as the reversal of the other."""
import numpy as np

import echopath as ep

RECIPROCITY = 1e-6  # relative, of the power of a path when the antennas change places


def make_radar(transmitter, receiver):
    waveform = ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=64, sampling_rate=20e6, num_chirps=1,
                                chirp_interval=30e-6)
    return ep.Radar(waveform, transmitters=[ep.Antenna(transmitter)], receivers=[ep.Antenna(receiver)])


def corner_scene():
    """A metal plate that is a mirror for what is near, beside a rough ball."""
    scene = ep.Scene()
    scene.add(ep.Mesh([[1, 1, -1], [7, 1, -1], [7, 1, 1], [1, 1, 1]], [[0, 1, 2], [0, 2, 3]]), name="plate",
              material=ep.Material.metal())
    scene.add(ep.actors.sphere(0.3), name="ball", material=ep.Material(reflectivity=0.5, scattering=1.0), position=(6, 0, 0))
    return scene


def sequences(paths):
    names = np.array([mesh.name for mesh in paths.scene.meshes])
    return [tuple(names[paths.mesh_id[o:o + n]]) for o, n in zip(paths.offsets, paths.num_bounces)]


def test_a_diffuse_end_brings_its_reversal():
    paths = ep.trace(corner_scene(), make_radar((0, 0, 0), (0, 0, 0)), num_rays=20000, max_bounces=2)
    by_order = {}
    for sequence, flag, power in zip(sequences(paths), paths.flags, np.abs(paths.amplitude)**2):
        by_order.setdefault((sequence, int(flag)), []).append(power)
    forward = sum(by_order[("plate", "ball"), 0])
    assert forward > 0
    # Between co-located antennas the two directions carry the same.
    assert abs(sum(by_order[("ball", "plate"), 1]) / forward - 1) < RECIPROCITY


def test_exchanged_antennas_exchange_the_paths():
    """The amplitude of a reversal is that of the forward path with the antennas exchanged, and lengths agree."""
    here, there = (0.0, 0.0, 0.0), (0.0, 0.2, 0.1)
    paths = ep.trace(corner_scene(), make_radar(here, there), num_rays=20000, max_bounces=2)
    lengths = paths.lengths([0.0])[0]
    swapped = paths.lengths([0.0], there, here)[0]
    points = paths.points(0.0)
    for path in np.flatnonzero(paths.flags == 1)[:50]:
        hits = points[paths.offsets[path]:paths.offsets[path] + paths.num_bounces[path]]
        for start, end, length in ((here, there, lengths[path]), (there, here, swapped[path])):
            chain = np.vstack([start, hits, end])
            assert abs(np.linalg.norm(np.diff(chain, axis=0), axis=1).sum() - length) < 1e-12


def test_a_small_plate_is_no_mirror():
    scene = ep.Scene()
    scene.add(ep.actors.plate(0.05, 0.05), name="plate", material="metal", position=(5, 0, 0), yaw=-0.4189)
    scene.add(ep.actors.sphere(0.3), name="ball", material=ep.Material(reflectivity=0.5, scattering=1.0), position=(3, 2.2, 0))
    paths = ep.trace(scene, make_radar((0, 0, 0), (0, 0, 0)), num_rays=50000, max_bounces=2)
    assert paths.frame.statistics.num_small_mirrors > 0
    assert ("plate", "ball") not in sequences(paths)
