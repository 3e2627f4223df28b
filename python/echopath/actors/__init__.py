"""Actors: bodies to put into a scene, from plates to walking people."""
from .actor import Actor, Part
from .human.pedestrian import pedestrian
from .shapes import box, capsule, dihedral, ellipsoid, ground, plate, sphere, trihedral, wall
from .vehicles.cars import car
from .vehicles.vans import van

__all__ = ["Actor", "Part", "box", "capsule", "car", "dihedral", "ellipsoid", "ground", "pedestrian", "plate", "sphere",
           "trihedral", "van", "wall"]
