"""Crowded scenes: a street of some twenty objects, the ground of a city, a person among thousands of flat objects, a city of
mirrors.

In the street no object shadows another as the radar sees it, so that each, traced alone, is the truth for its direct echoes.
"""
from __future__ import annotations

import dataclasses
from functools import cache

import numpy as np

import echopath as ep

from ...actors import shapes, surfaces
from ..physics.closed_forms import FREQUENCY, WAVELENGTH

RADAR_HEIGHT = 0.7                 # m
BODY_EDGE, TUBE_EDGE = 0.05, 0.02  # m: what the tessellation rule asks for on radii of about 0.5 and 0.05 m
STREET_SIZE = (120.0, 40.0)        # m, of the ground about (50, 0)
WALL_HEIGHT = 6.0                  # m
BACKDROPS = ("ground", "wall_left", "wall_right")  # what the others stand before
GROUND_TX, GROUND_RX = np.array([0.0, 0.0, 10.0]), np.array([28.7, 0.0, 1.5])  # m, 30 m apart
CITY_PERMITTIVITY = 5.0 - 0.3j     # of concrete
PERSON_RANGE = 40.0                # m
CITY_COLUMNS, CITY_ROWS = 50, 24   # of flat objects, the rows on each side of the street
CITY_PITCH = 12.0                  # m


@dataclasses.dataclass(frozen=True)
class Placed:
    """One object of the street. name; place: (azimuth in deg, range in m) of its origin; yaw_deg: turn about z;
    parts: [(name, mesh, material, whether it is smooth)] or an actor."""

    name: str
    place: tuple
    yaw_deg: float
    parts: object

    @property
    def position(self) -> tuple:
        azimuth = np.radians(self.place[0])
        return (float(self.place[1] * np.cos(azimuth)), float(self.place[1] * np.sin(azimuth)), 0.0)

    def add_to(self, scene, material=None, parent=None) -> None:
        """material: instead of its own."""
        yaw = float(np.radians(self.yaw_deg))
        if not isinstance(self.parts, list):
            scene.add(self.parts, name=self.name, position=self.position, yaw=yaw, material=material, parent=parent)
            return
        node = scene.add(None, name=self.name, position=self.position, yaw=yaw, parent=parent)
        for name, mesh, own, smooth in self.parts:
            scene.add(mesh, name=name, parent=node, material=material or own, smooth=smooth)


def radar(transmitter=(0.0, 0.0, RADAR_HEIGHT), receiver=(0.0, 0.01, RADAR_HEIGHT), *, pattern=None):
    """77 GHz, 1 GHz of bandwidth, 256 chirps; pattern: None is that of the street, cos^4."""
    waveform = ep.ChirpSequence(start_frequency=FREQUENCY, bandwidth=1e9, num_samples=512, sampling_rate=20e6,
                                num_chirps=256, chirp_interval=1e-4)
    pattern = pattern or ep.CosinePower(4.0)
    return ep.Radar(waveform, transmitters=[ep.Antenna(tuple(transmitter), pattern=pattern)],
                    receivers=[ep.Antenna(tuple(receiver), pattern=pattern)])


# --- the street ---

def street(*, mirrors: bool):
    """The whole street. mirrors: ground and walls are flagged mirrors; else rough concrete that nobody marked."""
    scene = ep.Scene()
    for one in street_objects():
        one.add_to(scene)
    for name in BACKDROPS:
        _add_backdrop(scene, name, backdrop_material(mirrors=mirrors))
    return scene


def alone(name: str, *, mirrors: bool):
    """One object of the street by itself. Of the ground or a wall: behind the others, which shadow it and send nothing back."""
    scene = ep.Scene()
    if name not in BACKDROPS:
        next(one for one in street_objects() if one.name == name).add_to(scene)
        return scene
    _add_backdrop(scene, name, backdrop_material(mirrors=mirrors))
    black = ep.Material(reflectivity=0.0, scattering=1.0)
    screens = scene.add(None, name="screens")
    for one in street_objects():
        one.add_to(scene, material=black, parent=screens)
    for other in BACKDROPS:
        if other != name:
            _add_backdrop(scene, other, black, parent=screens)
    return scene


def street_names() -> list[str]:
    """All objects, the backdrops last."""
    return [one.name for one in street_objects()] + list(BACKDROPS)


def backdrop_material(*, mirrors: bool):
    concrete = ep.materials["concrete"]
    return concrete.replace(scattering=0.3, mirror=True) if mirrors else concrete.replace(roughness_height=4e-4)


@cache
def street_objects() -> tuple:
    """What stands before the backdrops, from left to right as the radar sees it."""
    metal = ep.Material.metal()
    painted = ep.Material(conductor=True, scattering=0.3)
    pole = [("tube", _standing_tube(0.05, 3.0), metal, True)]
    return (
        Placed("pole_12", (56.0, 12.0), 0.0, pole),
        Placed("car_smooth_15", (46.0, 15.0), 20.0, [("body", rounded_car(), metal, True)]),
        Placed("pole_20", (35.0, 20.0), 0.0, pole),
        Placed("car_lofted_25", (28.0, 25.0), 8.0, [("body", lofted_car(), metal, True)]),
        Placed("pedestrian_10", (19.0, 10.0), 180.0, ep.actors.pedestrian(height=1.78, speed=1.4, phase=0.3)),
        Placed("sign_30", (14.0, 30.0), 9.0, _sign(metal)),
        Placed("car_smooth_40", (9.0, 40.0), 3.0, [("body", rounded_car(), metal, True)]),
        Placed("pole_40", (5.2, 40.0), 0.0, pole),
        Placed("car_lofted_60", (3.0, 60.0), 185.0, [("body", lofted_car(), metal, True)]),
        Placed("pole_90", (0.8, 90.0), 0.0, pole),
        Placed("pedestrian_40", (-0.6, 40.0), 90.0, ep.actors.pedestrian(height=1.65, speed=1.2, phase=0.6)),
        Placed("car_facets_40", (-4.0, 40.0), 12.0, _faceted_car(painted)),
        Placed("pole_60", (-7.0, 60.0), 0.0, pole),
        Placed("sign_50", (-8.4, 50.0), -6.0, _sign(metal)),
        Placed("cyclist_18", (-13.0, 18.0), 150.0, _cyclist()),
        Placed("pedestrian_20", (-17.0, 20.0), 30.0, ep.actors.pedestrian(height=1.85, speed=1.6, phase=0.1)),
        Placed("guard_rail", (-28.0, 26.0), 0.0, _guard_rail()),
        Placed("car_facets_12", (-55.0, 12.0), -35.0, _faceted_car(painted)),
    )


def rounded_car():
    """A car's body as a superellipsoid: curved flanks, roof, front and rear; 4.4 x 1.8 x 1.2 m above the ground."""
    section = surfaces.table_section([(-2.2, 0.0, 0.85, 0.9, 0.6, 3.0), (2.2, 0.0, 0.85, 0.9, 0.6, 3.0)], 1.1, 1.1)
    return ep.Mesh(*surfaces.swept(section, -2.2, 2.2, BODY_EDGE, axes=(1, 2, 0)))


def lofted_car():
    """A car's body with bonnet, cabin and rear that run into each other without edges."""
    stations = [(-2.2, 0.0, 0.65, 0.85, 0.40, 2.6), (-1.6, 0.0, 0.68, 0.88, 0.43, 2.6), (-0.7, 0.0, 0.86, 0.88, 0.61, 2.6),
                (0.3, 0.0, 0.86, 0.88, 0.61, 2.6), (1.2, 0.0, 0.60, 0.88, 0.35, 2.6), (2.2, 0.0, 0.55, 0.80, 0.30, 2.6)]
    section = surfaces.table_section(stations, 0.4, 0.4)
    return ep.Mesh(*surfaces.swept(section, -2.2, 2.2, BODY_EDGE, axes=(1, 2, 0)))


def _faceted_car(material) -> list:
    """Body and cabin of flat faces."""
    return [("body", _shifted(shapes.box((4.4, 1.8, 0.6)), (0.0, 0.0, 0.55)), material, False),
            ("cabin", _shifted(shapes.box((2.2, 1.5, 0.5)), (-0.3, 0.0, 1.1)), material, False)]


def _sign(material) -> list:
    return [("post", _standing_tube(0.03, 2.2), material, True),
            ("plate", _shifted(shapes.plate(0.7, 0.7), (-0.05, 0.0, 2.55)), material, False)]


def _guard_rail() -> list:
    """A rounded beam of weathered metal, 20 m along x, and a post each 4 m behind it."""
    weathered = ep.Material(conductor=True, scattering=0.3)
    section = surfaces.table_section([(-10.0, 0.0, 0.6, 0.06, 0.155, 2.0), (10.0, 0.0, 0.6, 0.06, 0.155, 2.0)], 0.1, 0.1)
    beam = ep.Mesh(*surfaces.swept(section, -10.0, 10.0, 2.0 * TUBE_EDGE, axes=(1, 2, 0)))
    post = _standing_tube(0.05, 0.7)
    return [("beam", beam, weathered, True),
            *((f"post_{k}", _shifted(post, (4.0 * k - 8.0, -0.13, 0.0)), weathered, True) for k in range(5))]


def _cyclist() -> list:
    """Two wheels, five tubes, and a rider of an ellipsoid, a head and two legs; rides along x."""
    metal, clothes, skin = ep.Material.metal(), ep.materials["clothing"], ep.materials["skin"]
    corners = {"rear": (-0.5, 0.34), "pedals": (-0.05, 0.3), "saddle": (-0.2, 0.9), "head": (0.35, 0.85), "front": (0.55, 0.34)}
    tubes = (("rear", "pedals"), ("rear", "saddle"), ("pedals", "saddle"), ("pedals", "head"), ("head", "front"))
    parts = [(f"wheel_{end}", _shifted(_wheel(0.33, 0.015), (corners[end][0], 0.0, corners[end][1])), metal, True)
             for end in ("rear", "front")]
    parts += [(f"tube_{a}_{b}", _tube_between(corners[a], corners[b], 0.018), metal, True) for a, b in tubes]
    return parts + [("torso", _shifted(shapes.ellipsoid((0.16, 0.22, 0.32)), (0.0, 0.0, 1.25)), clothes, True),
                    ("head", _shifted(shapes.sphere(0.11), (0.12, 0.0, 1.68)), skin, True),
                    *((f"leg_{side}", _shifted(shapes.capsule(0.07, 0.7), (-0.1, 0.12 * sign, 0.62)), clothes, True)
                      for side, sign in (("left", 1), ("right", -1)))]


def _standing_tube(radius: float, length: float):
    return _shifted(shapes.capsule(radius, length, edge=min(TUBE_EDGE, 0.5 * radius)), (0.0, 0.0, 0.5 * length + 0.01))


def _tube_between(start, end, radius: float):
    """A capsule in the plane y = 0; start, end: (x, z) in m of its axis."""
    step = np.subtract(end, start)
    length = float(np.hypot(*step))
    (sine, cosine) = step / length
    turn = np.array([[cosine, 0.0, sine], [0.0, 1.0, 0.0], [-sine, 0.0, cosine]])
    tube = shapes.capsule(radius, length + 2.0 * radius, edge=0.5 * radius)
    middle = 0.5 * np.add(start, end)
    return ep.Mesh(tube.vertices @ turn.T + np.array([middle[0], 0.0, middle[1]]), tube.triangles)


def _wheel(radius: float, thickness: float):
    """A torus about the y axis; radius: of its middle line, thickness: of the tube's radius, in m."""
    around = surfaces.num_pieces(2.0 * np.pi * radius, 0.5 * TUBE_EDGE)
    about = surfaces.num_pieces(2.0 * np.pi * thickness, 0.5 * TUBE_EDGE)
    turn, angle = np.meshgrid(2.0 * np.pi * np.arange(around) / around, 2.0 * np.pi * np.arange(about) / about, indexing="ij")
    reach = radius + thickness * np.cos(angle)
    vertices = np.stack([reach * np.sin(turn), thickness * np.sin(angle), reach * np.cos(turn)], axis=-1).reshape(-1, 3)
    i, j = (index.ravel() for index in np.meshgrid(np.arange(around), np.arange(about), indexing="ij"))

    def corner(right: int, up: int):
        return (i + right) % around * about + (j + up) % about

    triangles = np.concatenate([np.stack([corner(0, 0), corner(0, 1), corner(1, 0)], axis=-1),
                                np.stack([corner(1, 0), corner(0, 1), corner(1, 1)], axis=-1)])
    if surfaces.signed_volume(vertices, triangles) < 0:
        triangles = triangles[:, ::-1]
    return ep.Mesh(vertices, triangles)


def _shifted(mesh, offset):
    return ep.Mesh(np.asarray(mesh.vertices) + np.asarray(offset), mesh.triangles)


def _add_backdrop(scene, name: str, material, parent=None) -> None:
    length, width = STREET_SIZE
    if name == "ground":
        scene.add(shapes.ground((length, width)), name=name, material=material, position=(50.0, 0.0, 0.0), parent=parent)
        return
    side = 1.0 if name == "wall_left" else -1.0
    scene.add(shapes.wall(length, WALL_HEIGHT), name=name, material=material, position=(50.0, 0.5 * side * width, 0.0),
              yaw=0.0 if side > 0 else np.pi, parent=parent)


# --- the ground of a city ---

def city_ground(*, mirror: bool = False):
    """(scene, radar) of a smooth concrete plane among buildings, 30 m from transmitter to receiver.

    mirror: whether the plane is marked as one, which makes its path exact.
    """
    scene = ep.Scene()
    concrete = ep.Material(permittivity=CITY_PERMITTIVITY)
    scene.add(shapes.ground(800.0), name="ground", material=concrete.replace(mirror=mirror))
    for k in range(12):
        place = (30.0 * (k % 6) - 60.0, 25.0 if k < 6 else -25.0, 6.0 + k % 3)
        scene.add(shapes.box((20.0, 16.0, 12.0 + 2.0 * (k % 3))), name=f"building_{k}", material=concrete, position=place)
    return scene, radar(GROUND_TX, GROUND_RX, pattern=ep.Isotropic())


def ground_path_power(transmit_power: float) -> float:
    """Power in W of the ground's path of `city_ground` by the image method, isotropic antennas, vertical polarisation."""
    step = GROUND_RX * np.array([1.0, 1.0, -1.0]) - GROUND_TX
    length = float(np.linalg.norm(step))
    cosine = abs(step[2]) / length
    root = np.sqrt(CITY_PERMITTIVITY - (1.0 - cosine ** 2))
    coefficient = (CITY_PERMITTIVITY * cosine - root) / (CITY_PERMITTIVITY * cosine + root)
    return transmit_power * (WAVELENGTH / (4.0 * np.pi * length)) ** 2 * abs(coefficient) ** 2


# --- a person among thousands of flat objects ---

def flat_city():
    """(scene, radar): a person 40 m down a street between 2400 buildings, each a child of the scene's root."""
    scene = ep.Scene()
    scene.add(ep.actors.pedestrian(height=1.78, speed=1.4, phase=0.3), name="person", position=(PERSON_RANGE, 0.0, 0.0),
              yaw=np.pi)
    concrete = ep.materials["concrete"].replace(roughness_height=1e-3)
    tower = shapes.box((9.0, 9.0, 10.0))
    for column in range(CITY_COLUMNS):
        for row in range(CITY_ROWS):
            for side in (1.0, -1.0):
                place = (CITY_PITCH * (column - 0.5 * CITY_COLUMNS), side * (10.0 + CITY_PITCH * row), 5.0)
                scene.add(tower, name=f"building_{column}_{row}_{'left' if side > 0 else 'right'}", material=concrete,
                          position=place)
    return scene, radar()


# --- a city of mirrors ---

def mirror_city(num_houses: int):
    """(scene, radar): houses that stand askew on a grid, each wall and roof a flagged mirror, and the ground: 5 num_houses + 1
    mirrors; transmitter and receiver in the streets, 40 m apart."""
    scene, draw = ep.Scene(), np.random.default_rng(5)
    mirror = ep.materials["concrete"].replace(mirror=True)
    side = int(np.ceil(np.sqrt(num_houses)))
    scene.add(shapes.ground(25.0 * side), name="ground", material=mirror)
    for house in range(num_houses):
        length, width, height = draw.uniform(8.0, 11.0), draw.uniform(8.0, 11.0), draw.uniform(6.0, 12.0)
        place = 20.0 * (np.array([house % side, house // side]) - side // 2) + draw.uniform(0.0, 3.0, 2)
        node = scene.add(None, name=f"house_{house}", position=(*place, 0.0), yaw=draw.uniform(0.0, 0.4))
        for k, (across, away) in enumerate(((length, width), (width, length), (length, width), (width, length))):
            turn = 0.5 * np.pi * k
            scene.add(shapes.wall(across, height), name=f"wall_{k}", material=mirror, parent=node, yaw=turn,
                      position=(0.5 * away * np.sin(turn), -0.5 * away * np.cos(turn), 0.0))
        scene.add(shapes.ground((length, width), z=height), name="roof", material=mirror, parent=node)
    return scene, radar((9.3, 8.7, 3.1), (11.2, -29.6, 2.3), pattern=ep.Isotropic())
