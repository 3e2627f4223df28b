"""Small frames that have every group and column of a frame file between them: what a case costs goes by their datasets."""
from __future__ import annotations

import numpy as np

import echopath as ep
from support.shapes import curved_scene, quad

TIMES = [-1.0, 0.0, 1.0, 2.0]


def _radar(**more):
    waveform = ep.ChirpSequence(start_frequency=77e9, bandwidth=150e6, num_samples=8, sampling_rate=5e6, num_chirps=4,
                                chirp_interval=50e-6)
    return ep.Radar(waveform, transmitters=[ep.Antenna((0, 0, 0))], receivers=[ep.Antenna((0, 0, 0))], **more)


def _array():
    """A radar of two receivers that have patterns."""
    table = ep.GainTable(azimuth=[-1.0, 0.0, 1.0], elevation=[-0.5, 0.5], gain=np.ones((2, 3)), phase=np.zeros((2, 3)))
    receivers = [ep.Antenna((0, 0.002 * i, 0), pattern=table if i else ep.CosinePower(2.0)) for i in range(2)]
    return ep.Radar(_radar().waveform, transmitters=[ep.Antenna((0, 0, 0))], receivers=receivers)


def _wall():
    return quad((-5, 3, -5), (20, 3, -5), (20, 3, 6), (-5, 3, 6))


def _arm():
    """A tube of two triangles, bent by a joint that turns."""
    vertices = np.array([[4, 0, 0], [4, 1, 0], [4, 0, 1], [4, 1, 1.0]])
    spin = ep.KeyframeMotion(times=TIMES, translations=[[0, 0, 0], [0.1, 0, 0], [0.1, 0.2, 0], [0, 0, 0.0]])
    rows = np.array([[0, 0, 0], [0.1, 0, 0.0]])
    reach = ep.CurveMotion(ep.Curve([0, 1], rows, "hermite", in_tangents=rows, out_tangents=rows), None,
                           ep.Curve([0, 1], 1 + rows), period=1.5, offset=0.5)
    swell = ep.MorphTargets(vertices, [0.1 * vertices], ep.Curve([0, 1], [[0], [1.0]]))
    joints = [ep.Joint("shoulder", motion=reach), ep.Joint("elbow", "shoulder", motion=spin)]
    skin = ep.Skin(vertices, joints, [[1, 0], [1, 0], [0, 1], [0, 1]], shape=swell)
    return ep.Mesh(vertices, [[0, 1, 2], [1, 3, 2]]), skin


def _rough_scene():
    """A wall and a plate that a carrier moves."""
    scene = ep.Scene()
    rough = ep.Material(permittivity=5 - 0.3j, scattering=0.3, cross_polarization=0.2, mirror=True)
    scene.add(_wall(), name="wall", material=rough)
    scene.add(None, name="carrier", position=(8, 1, 0), yaw=0.3,
              motion=ep.LinearMotion(velocity=(-1, 0, 0), angular_velocity=(0, 0, 0.5)))
    scene.add(quad((0, -1, -1), (0, 1, -1), (0, 1, 1), (0, -1, 1)), name="plate", material="metal", parent="carrier")
    return scene


def _bent_scene():
    """A sheet that moves vertex by vertex, and an arm with a skin."""
    scene = ep.Scene()
    sheet = quad((6, -1, -1), (6, 1, -1), (6, 1, 1), (6, -1, 1))
    frames = np.stack([sheet.vertices * [1, 1 + 0.1 * i, 1] for i in range(4)])
    scene.add(sheet, name="sheet", material="concrete",
              motion=ep.VertexSequence(times=TIMES, vertices=frames, interpolation="linear"))
    mesh, skin = _arm()
    scene.add(mesh, name="arm", material="metal", motion=skin)
    return scene


def _plate():
    scene = ep.Scene()
    scene.add(quad((5, -1, -1), (5, 1, -1), (5, 1, 1), (5, -1, 1)), name="plate", material="metal")
    return scene


def _disturbed_scene():
    """A plate in the rain, and another radar."""
    other = _radar(position=(12, 0, 0), yaw=np.pi, motion=ep.LinearMotion(velocity=(-1, 0, 0)))
    scene = _plate()
    scene.weather, scene.interferers = ep.Weather(rain_mm_per_hour=10.0), [ep.Interferer(radar=other, offset=1e-6)]
    return scene


def _layered_scene():
    """A plate behind a door of two layers."""
    scene = _plate()
    scene.add(quad((3, -1, -1), (3, 1, -1), (3, 1, 1), (3, -1, 1)), name="door",
              material=ep.Material(layers=[ep.Layer(0.01, 5 - 0.3j), ep.Layer(0.02, 1.0)]))
    return scene


def _coded_radar():
    waveform = ep.ChirpSequence(start_frequency=77e9, bandwidth=150e6, num_samples=8, sampling_rate=5e6, num_chirps=8,
                                chirp_interval=50e-6, extra_idle=[0.0, 1e-6])
    return ep.Radar(waveform, transmitters=[ep.Antenna((0, 0, 0)), ep.Antenna((0, 0.01, 0))], receivers=[ep.Antenna((0, 0, 0))],
                    multiplexing="bpm", receiver=ep.Receiver(leakage_db=[[-30.0], [-40.0]]))


def frames() -> list:
    """Frames of ep.simulate, which have all groups between them, and few paths and few groups each.

    One with parts, of what a carrier and the radar move; one of what is bent; one each with labels, with detections and truth,
    and with antennas of patterns and a chosen map of directions; one curved and polarised; one of weather and another radar; one
    of sheets, edges, a receiver and a code.
    """
    settings = {"num_rays": 40, "batches": 2, "seed": 7, "noise_seed": 3}
    parts = {"route": {"direct": "T . R", "wall": "T .* 'wall' .* R"}, "body": {"plate": "T .* 'carrier/*' .* R"}}
    moved = _radar(motion=ep.LinearMotion(velocity=(1, 0, 0)))
    return [ep.simulate(_rough_scene(), moved, parts=parts, window=("chebyshev", 60), **settings | {"num_rays": 200}),
            ep.simulate(_bent_scene(), _radar(), **settings | {"num_rays": 200}),
            ep.simulate(_plate(), _radar(), labels={"errors": True}, **settings),
            ep.simulate(_plate(), _radar(), truth=True, detections={"false_alarm_rate": 0.1}, **settings),
            ep.simulate(_plate(), _array(), angles={"azimuth": [-0.1, 0.0, 0.15]}, **settings),
            ep.simulate(curved_scene(), _radar(), num_rays=60, max_bounces=2, polarization="jones", noise_seed=None),
            ep.simulate(_disturbed_scene(), _radar(), **settings),
            ep.simulate(_layered_scene(), _coded_radar(), edges=True, **settings)]
