"""
Walls of different materials
============================

A wall mirrors a corner reflector beside it: one way by the wall, and both ways. How strong these ghosts are is a matter of
the wall's material, and of its roughness: half a millimetre is an eighth of the wavelength and takes 2 dB from each bounce.
Five walls, all else alike.
"""
import matplotlib.pyplot as plt
import numpy as np

import echopath as ep

walls = {"metal": ep.materials["metal"], "concrete": ep.materials["concrete"], "glass": ep.materials["glass"],
         "wood": ep.materials["wood"], "concrete, 0.5 mm rough": ep.materials["concrete"].replace(roughness_height=0.5e-3)}
chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=256, sampling_rate=20e6, num_chirps=8,
                          chirp_interval=30e-6)
radar = ep.Radar(chirps, transmitters=[ep.Antenna((0, 0, 1))], receivers=[ep.Antenna((0, 0.01, 1))])
ways = {"one way": "T ('ball' 'wall' | 'wall' 'ball') R", "both ways": "T 'wall' 'ball' 'wall' R"}


def levels(material):
    """Power in dB of the ghosts over the straight echo."""
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.2), name="ball", material=ep.Material(conductor=True, scattering=1.0), position=(12, 0, 1))
    scene.add(ep.actors.wall(30, 4), name="wall", material=material.replace(mirror=True), position=(10, 3, 0))
    paths = ep.trace(scene, radar, num_rays=20_000)
    straight = ep.received_power(paths.select("T 'ball' R")).power
    return [10 * np.log10(ep.received_power(paths.select(way)).power / straight) for way in ways.values()]


# %%
# The ball is rough, so that it sends the same power towards the wall as back to the radar.
found = np.array([levels(material) for material in walls.values()])
figure, axes = plt.subplots(figsize=(8, 4), layout="constrained")
place = np.arange(len(walls))
for way, levels_of_way, marker in zip(ways, found.T, "os"):
    axes.plot(levels_of_way, place, marker, markersize=9, label=f"ghost, {way} by the wall")
axes.axvline(0, color="0.5")
axes.set_yticks(place, list(walls))
axes.invert_yaxis()
axes.set(xlabel="Power over that of the straight echo in dB", xlim=(-25, 5), title="Ghosts of a rough ball 3 m beside a wall")
axes.legend(loc="upper left")
axes.grid(alpha=0.3, axis="both")
plt.show()
