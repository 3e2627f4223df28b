"""Actors: bodies to put into a scene, from plates to walking people."""
from .actor import Actor, Part
from .human.pedestrian import pedestrian
from .human.persons import child, runner, standing_person
from .shapes import box, capsule, dihedral, ellipsoid, ground, plate, sphere, trihedral, wall
from .street.furniture import guard_rail, pole, traffic_sign
from .street.tree import tree
from .vehicles.cars import car
from .vehicles.vans import van

__all__ = ["Actor", "Part", "box", "capsule", "car", "child", "dihedral", "ellipsoid", "ground", "guard_rail", "pedestrian", "plate",
           "pole", "runner", "sphere", "standing_person", "traffic_sign", "tree", "trihedral", "van", "wall"]
