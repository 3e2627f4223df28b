"""A first experiment as a user types it: mypy --strict is content with it, and it sees its ball (test_stubs.py)."""
import copy
import math
from typing import assert_type

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

brick: ep.Material = assert_type(ep.materials["brick"], ep.Material).replace(mirror=True)
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

scene = ep.Scene()
scene.add(ep.actors.sphere(0.3), name="ball", material="metal", smooth=True, position=(12, 0, 1), speed=-3.0)
scene.add(ep.actors.wall(6.0, 3.0), name="wall", material=concrete, position=(20, 0, 0), yaw=math.pi / 2)
paths = ep.trace(scene, radar, num_rays=20_000, seed=1)
parts = ep.decompose(paths, radar, {"ball": "T 'ball' R"})
cube = ep.add_noise(ep.synthesize(paths, radar), radar, seed=1)
spectrum = ep.range_doppler(cube, radar, window="hann")
power = np.mean(np.abs(spectrum.values) ** 2, axis=(0, 1))
moving = np.abs(spectrum.velocity) > 1.0
row, column = np.unravel_index(int(np.where(moving[:, None], power, 0.0).argmax()), power.shape)
seen_at: tuple[float, float] = float(spectrum.range[column]), float(spectrum.velocity[row])
found = ep.detect(spectrum, radar, paths=paths, parts=parts)


def show(frames: list[ep.Frame]) -> None:
    """Draws the frames, and their film beside it."""
    axes = frames[0].plot(vmin=-120.0)
    axes.set_title(f"{len(frames)} frames")
    film = ep.spectrogram(frames, window_length=32)
    film.plot(ax=axes).set_xlim(0.0, 0.5)
    level: float = float(film.to_xarray().max())
    ep.truth(frames).to_dataframe().to_csv("truth.csv")
    print(f"{10.0 * math.log10(level) + 30.0:.0f} dBm, {list(ep.truth(frames).to_xarray().data_vars)}")


if __name__ == "__main__":
    print(f"{seen_at[0]:.2f} m {seen_at[1]:+.2f} m/s, {len(found.range)} detections, {found.object[0]}")
