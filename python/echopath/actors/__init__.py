"""Actors: bodies to put into a scene, from plates to vehicles and walking people."""
from .actor import Actor, Part
from .animals.dog import dog
from .drone import drone
from .human.captured import captured_pedestrian
from .human.pedestrian import pedestrian
from .human.persons import child, runner, standing_person
from .shapes import box, capsule, dihedral, ellipsoid, ground, plate, sphere, trihedral, wall
from .street.furniture import guard_rail, pole, traffic_sign
from .street.tree import tree
from .vehicles.bicycle import bicycle
from .vehicles.cars import car
from .vehicles.cyclist import cyclist
from .vehicles.motorcycles import motorcycle
from .vehicles.parked import parked_row
from .vehicles.trucks import truck
from .vehicles.vans import van

__all__ = ["Actor", "Part", "bicycle", "box", "capsule", "captured_pedestrian", "car", "child", "cyclist", "dihedral", "dog",
           "drone", "ellipsoid", "ground", "guard_rail", "motorcycle", "parked_row", "pedestrian", "plate", "pole",
           "runner", "sphere", "standing_person", "traffic_sign", "tree", "trihedral", "truck", "van", "wall"]


def __dir__() -> list[str]:
    """What users need, as completion at a prompt shows it; the modules behind it are there, but do not show."""
    return __all__
