"""A first experiment as a user types it; mypy --strict must be content with it (tests/python/test_stubs.py)."""
import copy
import math

import numpy as np

import echopath as ep

waveform = ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=512, sampling_rate=20e6, num_chirps=128,
                            chirp_interval=60e-6)
slow = waveform.replace(num_chirps=64)
resolution: float = slow.velocity_resolution(num_slots=2)
samples: int = waveform.num_samples

azimuth = np.radians(np.arange(-60.0, 61.0))
table = ep.GainTable(azimuth=azimuth, elevation=[-0.5, 0.5], gain=np.ones((2, len(azimuth))), normalize=True)
pattern: ep.AntennaPattern = ep.CosinePower(4.0) if resolution < 0.1 else table
field = pattern.field([[1.0, 0.0, 0.0]])
loss: float = float(np.abs(field[0])) - math.sqrt(ep.Isotropic(gain=1.0).peak_gain)

radar = ep.Radar(waveform, transmitters=[ep.Antenna((0.0, 0.0, 1.0), pattern=pattern)],
                 receivers=[ep.Antenna((0, 0.01 * k, 1)) for k in range(4)])
same: bool = radar.waveform == copy.deepcopy(waveform) and hash(slow) != hash(waveform)

concrete = ep.Material(permittivity=5.31 - 0.27j, roughness_height=1e-3)
wet = concrete.replace(permittivity=20 - 5j)
mesh = ep.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.array([[0, 1, 2]]))
area: float = mesh.part([0]).area + mesh.vertices.shape[0]

car = ep.LinearMotion(velocity=(15, 0, 0))
turn = ep.KeyframeMotion([0.0, 1.0], translations=[[0, 0, 0], [1, 0, 0]], interpolation="linear")
place = (car if same else turn).at(0.5)[:3, 3]
arm = ep.Skin(mesh.vertices, [ep.Joint("upper"), ep.Joint("lower", "upper", position=(0, 0, -0.3), motion=turn)],
              [[1.0, 0.0], [0.5, 0.5], [0.0, 1.0]])
names: list[str] = [name for name, _ in arm.parts(mesh)]
