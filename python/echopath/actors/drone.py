"""A quadcopter with turning rotors."""
from __future__ import annotations

import numpy as np

from .. import _core
from ..arguments.checks import checked, count, real
from . import solids
from .actor import Actor, Part
from .limits import size_rule
from .shapes import ellipsoid
from .surfaces import joined

# A plastic shell around battery, circuit boards and motor wires, effective.
SHELL = _core.Material(reflectivity=0.3, scattering=0.5)
# Thin plastic blades, effective: at level incidence their echo is that of edges, which are not modelled; as rough bodies they
# send back a share in all directions.
BLADE = _core.Material(reflectivity=0.3, scattering=0.9)
ROTORS = (("front_left", 1, 1, 1), ("front_right", 1, -1, -1), ("rear_left", -1, 1, -1), ("rear_right", -1, -1, 1))


@checked(size=size_rule, rotor_rpm=real(unit="1/min"), num_blades=count(2, 6), speed=real(unit="m/s"))
def drone(*, size: float = 0.35, rotor_rpm: float = 5500.0, num_blades: int = 2, speed: float = 0.0) -> Actor:
    """A quadcopter about the origin that flies along +x, its rotors turning.

    By default as large as a DJI Phantom (0.35 m from motor to motor across). Neighbouring rotors turn against each other.
    Parts: body, arms, motors, legs, camera, rotor_front_left, rotor_front_right, rotor_rear_left, rotor_rear_right.
    size: m, distance of motors across. rotor_rpm: turns a minute. num_blades: of each rotor. speed: m/s.
    Returns an Actor. Raises TypeError or ValueError naming the argument.
    """
    arm = 0.5 * size
    places = {name: arm / np.sqrt(2.0) * np.array([ahead, left, 0.0]) for name, ahead, left, _ in ROTORS}
    still = None if speed == 0.0 else _core.LinearMotion(velocity=(speed, 0.0, 0.0))
    parts = [Part("body", ellipsoid((0.36 * arm, 0.30 * arm, 0.20 * arm), edge=0.1 * arm), SHELL, still, smooth=True),
             Part("arms", _arms(places.values(), arm), SHELL, still, smooth=True),
             Part("motors", _motors(places.values(), arm), "metal", still, smooth=True),
             Part("legs", _legs(arm), "plastic", still, smooth=True),
             Part("camera", ellipsoid(0.10 * arm, edge=0.035 * arm), SHELL, still, (0.22 * arm, 0.0, -0.28 * arm), smooth=True)]
    blades = _core.Mesh(*joined(*[_blade(0.67 * arm, 2.0 * np.pi * n / num_blades) for n in range(num_blades)]))
    for n, (name, _, _, sense) in enumerate(ROTORS):
        turn = sense * rotor_rpm * 2.0 * np.pi / 60.0
        motion = _core.LinearMotion(velocity=(speed, 0.0, 0.0), angular_velocity=(0.0, 0.0, turn))
        mesh = _core.Mesh(_turned(blades.vertices, 0.7 * n) * [1.0, sense, 1.0],
                          blades.triangles if sense > 0 else np.asarray(blades.triangles)[:, ::-1])
        parts.append(Part(f"rotor_{name}", mesh, BLADE, motion, tuple(places[name] + [0.0, 0.0, 0.20 * arm]),
                          smooth=True))
    return Actor(parts)


def _arms(places, arm):
    return _core.Mesh(*joined(*[solids.tube(0.2 * place, place, 0.07 * arm, 0.05 * arm, segments=12) for place in places]))


def _motors(places, arm):
    return _core.Mesh(*joined(*[solids.tube(place - [0, 0, 0.06 * arm], place + [0, 0, 0.16 * arm], 0.075 * arm, segments=14)
                                for place in places]))


def _legs(arm):
    """Two skids on struts."""
    bars = []
    for sign in (1.0, -1.0):
        low = np.array([0.0, 0.42 * arm * sign, -0.75 * arm])
        bars.append(solids.tube(low - [0.4 * arm, 0, 0], low + [0.4 * arm, 0, 0], 0.025 * arm, segments=8))
        bars += [solids.tube((x, 0.15 * arm * sign, -0.1 * arm), low + [1.4 * x, 0, 0], 0.03 * arm, segments=8)
                 for x in (-0.15 * arm, 0.15 * arm)]
    return _core.Mesh(*joined(*bars))


def _blade(radius, angle):
    """A blade along x from the hub, twisted and tapered; it turns left-hand edge first."""
    stations = [(0.06, 0.10, 26.0), (0.3, 0.17, 20.0), (0.65, 0.13, 13.0), (1.0, 0.06, 8.0)]   # radius, chord, pitch in deg
    rings = []
    for share, chord, pitch in stations:
        c, s = np.cos(np.radians(pitch)), np.sin(np.radians(pitch))
        across = 0.5 * chord * radius * np.array([0.0, c, s])
        up = 0.008 * radius * np.array([0.0, -s, c])
        middle = np.array([share * radius, 0.0, 0.0])
        rings.append([middle - across - up, middle - across + up, middle + across - up, middle + across + up])
    pieces = [solids.hexahedron(np.array(rings[n] + rings[n + 1])) for n in range(3)]
    vertices, triangles = _without_inner_walls(*joined(*pieces))
    return _turned(vertices, angle), triangles


def _without_inner_walls(vertices, triangles):
    """Leaves out pairs of triangles that close neighbouring pieces against each other."""
    _, index, number = np.unique(np.sort(triangles, axis=1), axis=0, return_inverse=True, return_counts=True)
    return vertices, triangles[number[index.reshape(-1)] == 1]


def _turned(vertices, angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.asarray(vertices) @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
