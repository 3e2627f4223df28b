"""Licence plates and mirrors."""
import numpy as np

from ... import _core
from ..actor import Part
from ..shapes import ellipsoid
from ..solids import block
from .outline import AT, BELT, lattice_points

PLATE = (0.52, 0.11)       # m, width and height of European plates
PLATE_THICKNESS = 0.004    # m
PLATE_LEAN = np.radians(6.0)
PLATE_HEIGHT = {"front": 0.45, "rear": 0.80}   # m, of their middle above the road
MIRROR = (0.08, 0.11, 0.075)                   # m, half length, width and height of the housing


def plates(cage):
    """Flat metal plates before bumper and tailgate, which lean back with them: upright ones would flash at level radars."""
    parts = []
    for end, sign in (("front", 1.0), ("rear", -1.0)):
        near = (np.abs(cage.vertices[:, 1]) < PLATE[0] / 2 + 0.05) & (np.abs(cage.vertices[:, 2] - PLATE_HEIGHT[end]) < 0.15)
        x = sign * (np.max(sign * cage.vertices[near, 0]) + 0.006)
        parts.append(leaning_plate(f"plate/{end}", x, PLATE_HEIGHT[end], sign, PLATE))
    return parts


def leaning_plate(name, x, z, sign, size):
    """A plate outside (sign 1 ahead, -1 behind) of x with its middle at the height z in m."""
    half = 0.5 * np.array([PLATE_THICKNESS, *size])
    vertices, triangles = block(-half, half)
    slope = np.tan(PLATE_LEAN)
    vertices = vertices + np.outer(vertices[:, 2], [-sign * slope, 0.0, 0.0])
    return Part(name, _core.Mesh(vertices + [x + sign * (half[0] + half[2] * slope), 0.0, z], triangles), "metal")


def mirrors(outline):
    """Two housings beside the front doors' windows."""
    corner = lattice_points(outline)[AT["screen_low"], -1, BELT]
    mesh = ellipsoid(MIRROR, edge=0.027)
    return [Part(f"body/mirror_{side}", mesh, "plastic", None,
                 (float(corner[0]), float(sign * (corner[1] + MIRROR[1] - 0.02)), float(corner[2] + 0.05)), smooth=True)
            for side, sign in (("left", 1.0), ("right", -1.0))]
