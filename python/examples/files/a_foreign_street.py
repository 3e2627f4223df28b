"""
A street of another program
===========================

Radio ray tracers such as Sionna RT keep their streets in Mitsuba's XML: shapes, places and the names of materials. Here a
small one is written to a file and read back by one call. The map from above shows the houses by what they are made of.
"""
import tempfile
from pathlib import Path

import numpy as np

import echopath as ep

HOUSE = """<shape type="cube" id="{name}"><ref id="{bsdf}"/><transform name="to_world">
<scale value="{depth} {width} {height}"/><translate value="{x} {y} {height}"/></transform></shape>"""
random = np.random.default_rng(4)
houses = [HOUSE.format(name=f"house_{side}_{row}", bsdf=bsdf, depth=4, width=random.uniform(3, 4), height=random.uniform(3, 6),
                       x=14 + 9 * row, y=(11 if side == "left" else -11) + random.uniform(-2, 2))
          for row in range(5) for side, bsdf in (("left", "mat-itu_brick"), ("right", "mat-itu_metal"))]
bsdfs = '<bsdf type="diffuse" id="mat-itu_brick"/><bsdf type="diffuse" id="mat-itu_metal"/>'
path = Path(tempfile.mkdtemp()) / "street.xml"
path.write_text(f'<scene version="3.0.0">{bsdfs}{"".join(houses)}</scene>')

# %%
# The file names brick and metal as Recommendation ITU-R P.2040 does. Walls of houses are rough at 77 GHz, which no file says:
# `materials` gives them the share of the field that they scatter.
rough = {"itu_brick": ep.materials["brick"].replace(scattering=0.4), "itu_metal": ep.Material(conductor=True, scattering=0.4)}
street = ep.load_model(path, materials=rough)
print(street)
scene = ep.Scene()
scene.add(street, name="street")
chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=300e6, num_samples=256, sampling_rate=20e6, num_chirps=4,
                          chirp_interval=60e-6)
receivers = [ep.Antenna((0, 0.00195 * i, 1.5)) for i in range(16)]
radar = ep.Radar(chirps, transmitters=[ep.Antenna((0, 0, 1.5))], receivers=receivers, transmit_power=0.1)
frame = ep.simulate(scene, radar, num_rays=100_000, max_bounces=2, angles={"window": ("chebyshev", 30)}, guard=False)

# %%
# Fronts of metal on the right answer more strongly than those of brick on the left.
figure = ep.plots.plot_range_azimuth(frame.range_azimuth, title="Houses of another program: brick left, metal right")
ep.plots.show(figure)
