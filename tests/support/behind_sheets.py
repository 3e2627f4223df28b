"""A ball behind a pane of glass, and what a pane does by closed forms."""
import numpy as np

import echopath as ep

FREQUENCY = 77e9
WAVENUMBER = 2.0 * np.pi * FREQUENCY / ep.speed_of_light
GLASS = ep.Material(layers=[ep.Layer(0.004, 6.3 - 0.3j)])
THICKNESS = 0.004
CHIRPS = ep.ChirpSequence(start_frequency=FREQUENCY, bandwidth=1e9, num_samples=128, sampling_rate=20e6, num_chirps=16,
                          chirp_interval=1e-3)
INSTANT = ep.ChirpSequence(start_frequency=FREQUENCY, bandwidth=1e9, num_samples=128, sampling_rate=20e6, num_chirps=1,
                           chirp_interval=1e-5)
FORMULA = 1e-9
LEVEL = 0.2    # dB
RAYS = 0.01    # of the field: a few thousand rays on a ball
PHASE = 0.02   # rad: likewise, and angles that differ over a ball
SAME_RAYS = 1e-3
UPRIGHT, LEVEL_E, SLANTED = (0, 0, 1), (0, 1, 0), tuple(np.array([0, 1, 1]) / np.sqrt(2.0))


def airy(angle, layer=GLASS.layers[0], frequency=FREQUENCY):
    """((r, t) of TE, (r, t) of TM) of one slab: geometric series over the bounces within (Airy 1833)."""
    cosine, k = np.cos(angle), 2.0 * np.pi * frequency / ep.speed_of_light
    inside = np.sqrt(layer.permittivity - np.sin(angle) ** 2)
    through = np.exp(-1j * k * layer.thickness * inside)
    both = []
    for face in ((cosine - inside) / (cosine + inside),
                 (layer.permittivity * cosine - inside) / (layer.permittivity * cosine + inside)):
        both.append((face * (1 - through**2) / (1 - face**2 * through**2), (1 - face**2) * through / (1 - face**2 * through**2)))
    return both


def over_free(angle):
    """(TE, TM) field behind the pane over that without it."""
    free = np.exp(1j * WAVENUMBER * THICKNESS * np.cos(angle))
    return tuple(passed * free for _, passed in airy(angle))


def make_radar(chirps=CHIRPS, polarization=UPRIGHT, num=1, motion=None):
    antennas = [[ep.Antenna((0, 0.1 * i + y, 1), polarization=polarization) for i in range(num)] for y in (0.0, 0.01)]
    return ep.Radar(chirps, transmitters=antennas[0], receivers=antennas[1], transmit_power=0.1, motion=motion)


def square(half=3.0):
    corners = half * np.array([[0, -1, -1], [0, 1, -1], [0, 1, 1], [0, -1, 1.0]])
    return ep.Mesh(corners, [[0, 1, 2], [0, 2, 3]])


def make_scene(pane=GLASS, yaw=0.0, motion=None, ball_motion=None, at=3.0):
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.1), name="ball", material="metal", position=(8, 0, 1), smooth=True, motion=ball_motion)
    if pane is not None:
        scene.add(square(), name="pane", material=pane, position=(at, 0, 1), yaw=yaw, motion=motion)
    return scene


def echo_of_ball(scene, radar, num_rays=4000, **settings):
    return ep.trace(scene, radar, num_rays=num_rays, max_bounces=1, **settings).select("T 'ball' R")


def field(paths, time=None, tx=0, rx=0):
    time = paths.frame.trace_time if time is None else time
    return np.sum(paths.amplitudes([time], tx, rx)[0] * np.exp(-1j * WAVENUMBER * paths.lengths([time], tx, rx)[0]))


def power_db(paths):
    return 10.0 * np.log10(ep.received_power(paths).power)
