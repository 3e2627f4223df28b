"""A city street to drive along: houses with windows, trees, lamps and kerbs; 20 cars, some of them parked, and 20 people."""
from __future__ import annotations

import numpy as np

import echopath as ep

from ...actors import shapes
from ...actors.surfaces import joined, parallelogram
from ..physics.closed_forms import FREQUENCY, WAVELENGTH

LENGTH, QUICK_LENGTH = 200.0, 60.0       # m, of the street along +x
ROAD_EDGE, HOUSE_FRONT = 6.0, 10.0       # m from the middle of the road
KERB_HEIGHT, HOUSE_LENGTH, HOUSE_HEIGHT = 0.12, 18.0, 16.0   # m
WINDOWS = (10, 5)                        # of the front of a house, along and up
WINDOW_DEPTH = 0.15                      # m behind the front
OWN_LANE, OTHER_LANE, PARKED = -1.75, 1.75, 4.9   # m, to the left of the middle
PAVEMENT = 7.5                           # m
TREE_PITCH, LAMP_PITCH = 40.0, 16.5      # m from one to the next
KINDS = ("small", "compact", "saloon", "estate", "suv")
RADAR_SPEED = 10.0                       # m/s


def radar() -> ep.Radar:
    """77 GHz on a car that drives along the street: three transmitters in turn, four receivers, 128 chirps of 256 samples."""
    waveform = ep.ChirpSequence(start_frequency=FREQUENCY, bandwidth=5e8, num_samples=256, sampling_rate=10e6,
                                num_chirps=128, chirp_interval=3e-5)
    pattern = ep.CosinePower(2.0)
    return ep.Radar(waveform, motion=ep.LinearMotion(velocity=(RADAR_SPEED, 0.0, 0.0)),
                    transmitters=[ep.Antenna((0.0, OWN_LANE + 2.0 * WAVELENGTH * k, 0.7), pattern=pattern) for k in range(3)],
                    receivers=[ep.Antenna((0.0, OWN_LANE + 0.5 * WAVELENGTH * k, 0.75), pattern=pattern) for k in range(4)])


def city_street(seconds: float, *, num_cars: int = 20, num_people: int = 20, length: float = LENGTH) -> ep.Scene:
    """The street from x = 0 on with its cars and people, who move for so many seconds."""
    scene = ep.Scene()
    _add_ground(scene, length)
    _add_houses(scene, length)
    _add_furniture(scene, length)
    draw = np.random.default_rng(7)
    for k in range(num_cars):
        _add_car(scene, k, 12.0 + (length - 80.0 if length > 120.0 else length - 20.0) * k / num_cars, draw)
    for k in range(num_people):
        side, place = (1.0 if k % 2 else -1.0), 8.0 + (length - 60.0 if length > 120.0 else length - 20.0) * k / num_people
        person = ep.actors.pedestrian(height=draw.uniform(1.55, 1.9), speed=draw.uniform(0.8, 1.6), phase=draw.uniform(),
                                      start_time=-0.1, duration=seconds + 0.2)
        scene.add(person, name=f"person_{k}", position=(place, side * (PAVEMENT + draw.uniform(-0.6, 1.2)), KERB_HEIGHT),
                  yaw=draw.choice([0.0, np.pi]))
    return scene


def _add_ground(scene, length: float) -> None:
    """The road, a mirror of grazing waves, and pavements behind kerbs."""
    asphalt = ep.materials["asphalt"]
    scene.add(shapes.ground((length + 40.0, 2.0 * ROAD_EDGE)), name="road", material=asphalt.replace(mirror=True),
              position=(0.5 * length, 0.0, 0.0))
    for name, side in (("pavement_left", 1.0), ("pavement_right", -1.0)):
        along, across = np.array([length + 40.0, 0.0, 0.0]), np.array([0.0, side * (HOUSE_FRONT - ROAD_EDGE), 0.0])
        kerb, corner = np.array([0.0, 0.0, KERB_HEIGHT]), np.array([-20.0, side * ROAD_EDGE, 0.0])
        scene.add(ep.Mesh(*joined(parallelogram(corner, along, kerb, 4.0), parallelogram(corner + kerb, along, across, 4.0))),
                  name=name, material="concrete")


def _add_houses(scene, length: float) -> None:
    mesh = ep.Mesh(*house())
    for k in range(int(length / (HOUSE_LENGTH + 2.0))):
        for name, side in (("left", 1.0), ("right", -1.0)):
            middle = (k + 0.5) * (HOUSE_LENGTH + 2.0)
            scene.add(mesh, name=f"house_{name}_{k}", material="concrete", position=(middle, side * HOUSE_FRONT, 0.0),
                      yaw=0.0 if side > 0.0 else np.pi)


def house():
    """(vertices [V, 3] in m, triangles [F, 3]) of a house whose front lies along x and looks toward -y."""
    x, z = _cuts(-0.5 * HOUSE_LENGTH, HOUSE_LENGTH, WINDOWS[0]), _cuts(0.0, HOUSE_HEIGHT, WINDOWS[1])
    pieces = []
    for column in range(len(x) - 1):
        for row in range(len(z) - 1):
            corner = np.array([x[column], 0.0, z[row]])
            along, up = np.array([x[column + 1] - x[column], 0.0, 0.0]), np.array([0.0, 0.0, z[row + 1] - z[row]])
            pieces += _window(corner, along, up) if column % 2 and row % 2 else [parallelogram(corner, along, up)]
    deep, up, along = np.array([0.0, 10.0, 0.0]), np.array([0.0, 0.0, HOUSE_HEIGHT]), np.array([HOUSE_LENGTH, 0.0, 0.0])
    corner = np.array([-0.5 * HOUSE_LENGTH, 0.0, 0.0])
    return joined(*pieces, *(parallelogram(corner + where, first, second) for where, first, second in
                             ((0.0, deep, up), (along, deep, up), (deep, along, up), (up, along, deep))))


def _cuts(begin: float, size: float, windows: int):
    """Where walls and windows take turns, walls first and last."""
    return begin + size * np.arange(2 * windows + 2) / (2 * windows + 1)


def _window(corner, along, up) -> list:
    """A pane behind its four reveals."""
    deep = np.array([0.0, WINDOW_DEPTH, 0.0])
    return [parallelogram(corner + deep, along, up), parallelogram(corner, deep, up), parallelogram(corner + along, deep, up),
            parallelogram(corner, along, deep), parallelogram(corner + up, along, deep)]


def _add_furniture(scene, length: float) -> None:
    """Trees and lamps by the kerbs."""
    trees, lamp = [ep.actors.tree(height=6.0 + k, seed=k) for k in range(3)], ep.actors.pole(height=7.0)
    for k in range(int(length / TREE_PITCH)):
        for name, side in (("left", 1.0), ("right", -1.0)):
            scene.add(trees[k % 3], name=f"tree_{name}_{k}", position=(20.0 + TREE_PITCH * k, side * 6.6, KERB_HEIGHT))
    for k in range(int(length / LAMP_PITCH)):
        for name, side in (("left", 1.0), ("right", -1.0)):
            scene.add(lamp, name=f"lamp_{name}_{k}", position=(8.0 + LAMP_PITCH * k, side * 6.4, KERB_HEIGHT))


def _add_car(scene, index: int, place: float, draw) -> None:
    """Of five cars two come toward the radar, one drives ahead of it and two are parked."""
    lane, speed = ((OTHER_LANE, 12.0), (-PARKED, 0.0), (OWN_LANE, 11.0), (PARKED, 0.0), (OTHER_LANE, 12.0))[index % 5]
    toward = lane in (OTHER_LANE, PARKED)
    speed = speed + draw.uniform(-1.0, 1.0) if speed and lane == OTHER_LANE else speed
    scene.add(ep.actors.car(kind=KINDS[index % 3 if index % 2 else 4 - index % 3], speed=speed), name=f"car_{index}",
              position=(place, lane, 0.0), yaw=np.pi if toward else 0.0)
