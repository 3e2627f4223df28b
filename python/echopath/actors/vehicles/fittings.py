"""Licence plates and mirrors."""
import numpy as np

from ... import _core
from ..actor import Part
from ..shapes import ellipsoid
from ..solids import block
from .outline import AT, BELT, lattice_points

PLATE = (0.52, 0.11)       # m, width and height of European plates
PLATE_THICKNESS = 0.004    # m
PLATE_HEIGHT = {"front": 0.45, "rear": 0.80}   # m, of their middle above the road
MIRROR = (0.08, 0.11, 0.075)                   # m, half length, width and height of the housing


def plates(cage):
    """Flat metal plates upright before bumper and tailgate."""
    parts = []
    for end, sign in (("front", 1.0), ("rear", -1.0)):
        near = (np.abs(cage.vertices[:, 1]) < PLATE[0] / 2 + 0.05) & (np.abs(cage.vertices[:, 2] - PLATE_HEIGHT[end]) < 0.15)
        x = sign * (np.max(sign * cage.vertices[near, 0]) + 0.006)
        low = np.array([x, -PLATE[0] / 2, PLATE_HEIGHT[end] - PLATE[1] / 2])
        high = low + np.array([sign * PLATE_THICKNESS, PLATE[0], PLATE[1]])
        parts.append(Part(f"plate/{end}", _core.Mesh(*block(np.minimum(low, high), np.maximum(low, high))), "metal"))
    return parts


def mirrors(outline):
    """Two housings beside the front doors' windows."""
    corner = lattice_points(outline)[AT["screen_low"], -1, BELT]
    mesh = ellipsoid(MIRROR, edge=0.027)
    return [Part(f"body/mirror_{side}", mesh, "plastic", None,
                 (float(corner[0]), float(sign * (corner[1] + MIRROR[1] - 0.02)), float(corner[2] + 0.05)), smooth=True)
            for side, sign in (("left", 1.0), ("right", -1.0))]
