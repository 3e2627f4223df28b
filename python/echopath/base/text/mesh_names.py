"""Full names of meshes, "street/car/wheel"."""
from __future__ import annotations


def object_of(name: str) -> str:
    """The object, directly in the scene, that a mesh of this full name belongs to."""
    return name.partition("/")[0]
