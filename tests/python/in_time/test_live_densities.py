"""Live scenes in which an object that comes changes how dense the rays on others are."""
import numpy as np

import echopath as ep

ROUNDING = 1e-12  # of the largest sample: signals are added and taken away


def sphere(radius: float, around: int = 24, up: int = 12) -> ep.Mesh:
    polar, azimuth = np.pi * np.arange(1, up) / up, 2 * np.pi * np.arange(around) / around
    ring = [radius * np.array([np.sin(p) * np.cos(a), np.sin(p) * np.sin(a), np.cos(p)]) for p in polar for a in azimuth]
    vertices = [[0, 0, radius], *ring, [0, 0, -radius]]
    triangles = []
    for j in range(around):
        k, last = (j + 1) % around, 1 + (up - 2) * around
        triangles += [[0, 1 + j, 1 + k], [last + j, len(vertices) - 1, last + k]]
        for first in range(1, last, around):
            triangles += [[first + j, first + around + j, first + k], [first + k, first + around + j, first + around + k]]
    return ep.Mesh(np.array(vertices), np.array(triangles))


def test_echoes_over_two_smooth_bodies_follow_the_density_of_rays():
    """Which of both orders of two bounces counts hangs on the densities: echoes may come from rays that had none before."""
    waveform = ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=64, num_chirps=4, chirp_interval=1e-4)
    radar = ep.Radar(waveform, transmitters=[ep.Antenna((0, 0, 0))], receivers=[ep.Antenna((0, 0.05, 0))])
    scene = ep.Scene()
    scene.add(sphere(0.9), name="A", material="metal", smooth=True, position=(6.0, -1.3, 0.0))
    scene.add(sphere(0.4), name="B", material="metal", smooth=True, position=(6.2, 1.3, 0.0))
    plate = ep.Mesh([[0, 0, 0], [0.5, 0, 0], [0.5, 0, 0.5], [0, 0, 0.5]], [[0, 1, 2], [0, 2, 3]])
    live = ep.Live(scene, radar, num_rays=4000)
    live.update()
    for k in range(4):
        live.scene.add(plate, name=f"d{k}", material="metal", position=(-20 + 3 * k, 40, 0))
        view, fresh = live.update(), ep.Live(live.scene, radar, num_rays=4000).update()
        assert np.abs(view.cube - fresh.cube).max() < ROUNDING * np.abs(fresh.cube).max(), k
