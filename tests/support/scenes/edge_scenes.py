"""Sheets and boxes with sharp edges before a radar."""
import math

import numpy as np

import echopath as ep

INCH = 0.0254
FREQUENCY = 10.24e9
WAVENUMBER = 2.0 * math.pi * FREQUENCY / 299792458.0
WIDTH, HEIGHT = 10.5 * INCH, 6.0 * INCH  # across and along the axis about which the plate turns


def sheet(width: float = WIDTH, height: float = HEIGHT) -> ep.Mesh:
    """A rectangle of two triangles in the yz-plane."""
    corners = [(0.0, y * width / 2.0, z * height / 2.0) for y in (-1, 1) for z in (-1, 1)]
    return ep.Mesh(np.array(corners), np.array([(0, 1, 3), (0, 3, 2)]))


def box(size) -> ep.Mesh:
    corners = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * np.asarray(size) / 2.0
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return ep.Mesh(corners, np.array([t for a, b, c, d in faces for t in ((a, b, c), (a, c, d))]))


def scene_of(mesh, **keywords) -> ep.Scene:
    scene = ep.Scene()
    scene.add(mesh, name="plate", **{"material": ep.Material.metal(), **keywords})
    return scene


def radar_at(position=(8.0, 0.5, 1.0), *, polarization=(0.0, 0.0, 1.0), receiver=None, num_chirps=1) -> ep.Radar:
    waveform = ep.ChirpSequence(start_frequency=FREQUENCY, bandwidth=100e6, num_samples=64, sampling_rate=1e6,
                                num_chirps=num_chirps, chirp_interval=200e-6)
    antenna = {"polarization": polarization}
    return ep.Radar(waveform, transmitters=[ep.Antenna(position, **antenna)],
                    receivers=[ep.Antenna(position if receiver is None else receiver, **antenna)])


def trace(scene, radar, **keywords):
    return ep.trace(scene, radar, **{"num_rays": 200, "edges": True, **keywords})


def fields(paths, time=None):
    """[P] amplitudes with the phases of their lengths."""
    time = paths.frame.trace_time if time is None else time
    return paths.amplitudes([time])[0] * np.exp(-1j * WAVENUMBER * paths.lengths([time])[0])


def on_edges(paths):
    return paths.select("T .* E .* R")
