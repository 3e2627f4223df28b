"""Arrays of antennas and targets that they find."""
from __future__ import annotations

import numpy as np

import echopath as ep
from support.references import slow_beams

C = ep.speed_of_light
WAVELENGTH = C / 77.5e9
HALF = 0.5 * WAVELENGTH
DEGREE = np.pi / 180.0
TARGET_RADIUS = 0.05         # m, of the spheres that stand for points


def waveform(num_chirps=32, num_samples=128, start_frequency=77e9):
    return ep.ChirpSequence(start_frequency=start_frequency, bandwidth=1e9, num_samples=num_samples, sampling_rate=20e6,
                            num_chirps=num_chirps, chirp_interval=30e-6)


def mimo(transmitters, receivers, height=0.0, motion=None, chirps=None):
    """Antennas at multiples (left, up) of half a wavelength."""
    def antennas(steps):
        return [ep.Antenna((0.0, left * HALF, height + up * HALF)) for left, up in steps]

    return ep.Radar(chirps or waveform(), transmitters=antennas(transmitters), receivers=antennas(receivers), motion=motion)


LINE = [(column, 0) for column in range(4)]


def three_by_four(**changes):
    return mimo([(0, 0), (4, 0), (8, 0)], LINE, **changes)


def scene_of_spheres(*centres, velocity=None):
    scene = ep.Scene()
    motion = ep.LinearMotion(velocity=velocity) if velocity is not None else None
    for index, centre in enumerate(centres):
        scene.add(ep.actors.sphere(TARGET_RADIUS), name=f"ball{index}", material="metal", position=tuple(centre),
                  smooth=True, motion=motion)
    return scene


def at(distance, azimuth, elevation):
    return distance * slow_beams.unit(np.array(azimuth), np.array(elevation))


def spectrum_of(scene, radar, num_rays=3000):
    return ep.range_doppler(ep.synthesize(ep.trace(scene, radar, num_rays=num_rays)), radar)
