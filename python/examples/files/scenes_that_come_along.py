"""
Scenes that come along
======================

The package brings nine scenes in ``data/scenes``, which ``echopath run FILE --out DIR`` simulates. Each is drawn from above at
the time 0: objects by colour and name, grounds and ceilings in grey, and the radar where it stands and looks.
"""
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.patheffects import withStroke

import echopath as ep
from echopath.base.storage.data_folder import data_folder

files = sorted((file for file in data_folder("scenes").iterdir() if file.name.endswith(".toml")), key=lambda file: file.name)
FLAT = 0.05  # m: what is less high than this lies flat


def draw(axes, scene, radar):
    """Objects from low to high with a dot and their name, and the radar."""
    found = {}
    for mesh in scene.meshes:
        found.setdefault(mesh.name.split("/")[0], []).append(mesh)
    for index, (name, meshes) in enumerate(found.items()):
        corners = [scene.world_vertices(mesh.id, 0.0)[np.asarray(mesh.triangles)] for mesh in meshes]
        corners = np.concatenate(corners)
        lies = np.ptp(corners[..., 2]) < FLAT
        color = "0.9" if lies else plt.get_cmap("tab10")(index % 10)
        axes.add_collection(PolyCollection(corners[:, :, :2], facecolors=color, edgecolors=color, linewidths=0.6,
                                           zorder=1 if lies else 2), autolim=False)
        axes.update_datalim(corners[:, :, :2].reshape(-1, 2))
        if not lies:
            middle = 0.5 * (corners.min(axis=(0, 1)) + corners.max(axis=(0, 1)))
            axes.plot(*middle[:2], ".", color=color, markersize=4, zorder=3)
            axes.annotate(name, middle[:2], (0, 4), textcoords="offset points", fontsize=6.5, ha="center", zorder=4,
                          path_effects=[withStroke(linewidth=2, foreground="white")])
    axes.plot(*radar.position[:2], "k^", markersize=6, zorder=4)


# %%
# A scene file holds objects, radar and settings; ``ep.load_scene`` reads it.
figure, panels = plt.subplots(3, 3, figsize=(11, 9.5), layout="constrained")
for axes, file in zip(panels.flat, files):
    loaded = ep.load_scene(file)
    draw(axes, loaded.scene, loaded.radar)
    axes.margins(0.2)
    axes.autoscale()
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_title(file.name.removesuffix(".toml"), pad=12)
    axes.set(xlabel="x in m", ylabel="y in m")
    begin, reach = loaded.radar.position[:2], 0.12 * np.ptp(axes.get_xlim())
    ahead = np.array([np.cos(loaded.radar.yaw), np.sin(loaded.radar.yaw)])
    axes.annotate("", begin + reach * ahead, begin, arrowprops={"arrowstyle": "->"}, zorder=4)
figure.suptitle("The nine scenes from above; triangle: the radar, arrow: where it looks")
plt.show()
