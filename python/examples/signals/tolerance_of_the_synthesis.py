"""
How exact the synthesis is
==========================

The sum over all paths at all samples is done by a non-uniform Fourier transform to the tolerance asked for. Here its error
against the direct sum, for a walker who moves. Recurrence is exact to rounding, whatever is asked.
"""
import matplotlib.pyplot as plt
import numpy as np

import echopath as ep

scene = ep.Scene()
scene.add(ep.actors.pedestrian(), name="walker", position=(6, 0, 0), yaw=np.pi)
chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=256, sampling_rate=20e6, num_chirps=8,
                          chirp_interval=60e-6)
radar = ep.Radar(chirps, transmitters=[ep.Antenna((0, 0, 1))], receivers=[ep.Antenna((0, 0.01, 1))])
paths = ep.trace(scene, radar, num_rays=3000)
truth = ep.synthesize(paths, radar, method="direct", evaluate="chirps")
amplitudes = np.abs(paths.amplitude).sum()

# %%
# Errors are relative to the sum of all amplitudes, as the tolerance is.
tolerances = 10.0 ** -np.arange(2, 13)
figure, axes = plt.subplots(figsize=(7, 4.5), layout="constrained")
for method in ("nufft", "recurrence"):
    signals = [ep.synthesize(paths, radar, method=method, evaluate="chirps", tolerance=tolerance) for tolerance in tolerances]
    errors = [np.sqrt(np.mean(np.abs(signal - truth) ** 2)) / amplitudes for signal in signals]
    axes.loglog(tolerances, errors, "o-", label=method)
axes.loglog(tolerances, tolerances, "k:", label="what was asked for")
axes.invert_xaxis()
axes.set(xlabel="Tolerance", ylabel="Error, relative rms", title=f"{paths.num_paths} paths, 8 chirps of 256 samples")
axes.legend()
axes.grid(alpha=0.3)
plt.show()
