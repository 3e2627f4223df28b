"""Meshes that one file after the other holds, read once."""
from __future__ import annotations

from ..h5 import CHECK_SUM
from ..h5_items import integers_of


class KeptMeshes:
    """The meshes of the scene that was read last: a scene of the next file shares them where that has the same ones.

    They are the same where each array of theirs has the same check sum; arrays that were damaged after they were written are not
    noticed then, as they are not read. A `Mesh` cannot be changed, so those who share one need not know of each other. Several
    threads may read with one object.
    """

    def __init__(self):
        self._kept = None  # (attributes that tell the meshes apart, their values, the meshes)

    def of(self, group, read) -> list:
        """The meshes of a group "meshes"; read: callable () -> list of Mesh, which reads all of them."""
        if self._kept is not None:
            attributes, values, meshes = self._kept
            if values is not None and len(group) == len(meshes) and integers_of(group, attributes) == values:
                return meshes
        meshes = read()
        attributes = [attribute for index, mesh in enumerate(meshes) for attribute in _attributes_of(index, mesh)]
        self._kept = attributes, integers_of(group, attributes), meshes
        return meshes


def _attributes_of(index: int, mesh) -> list:
    """(item below the group, attribute) of all that makes a mesh."""
    if mesh.whole is not None:
        return [(f"{index}", "whole"), (f"{index}/whole_triangle", CHECK_SUM)]
    return [(f"{index}/{name}", CHECK_SUM) for name in ("vertices", "triangles", "original_triangle")]
