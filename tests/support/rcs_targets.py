"""Targets with closed forms."""
import math

import numpy as np

from support.shapes import METAL, plate, rectangle, scene_of, sphere

PLATE_ANGLE_TOLERANCE_DB = 0.3
SMOOTH_TOLERANCE_DB = 0.1
RADIUS = 0.1  # m
RIGHT_ANGLE_HALF = math.sqrt(0.5)


def smooth_sphere(radius=RADIUS, centre=(0, 0, 0)):
    return scene_of(ball=(sphere(centre, radius, 5), METAL, True))


def plate_scene(side=0.1, material=METAL):
    return scene_of(plate=(plate((0, 0, 0), (1, 0, 0), side), material))


def dihedral(material=METAL, side=0.1):
    along = RIGHT_ANGLE_HALF * side
    corner = (0, 0, -side / 2)
    return scene_of(left=(rectangle(corner, (along, along, 0), (0, 0, side)), material),
                    right=(rectangle(corner, (along, -along, 0), (0, 0, side)), material))


def in_plane(angles_deg):
    angles = np.radians(angles_deg)
    return np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)
