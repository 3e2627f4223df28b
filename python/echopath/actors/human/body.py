"""Shapes of the body parts: closed smooth surfaces about the joints.

Each part lies in the frame of its proximal joint at rest: x forward, y left, z up; limbs hang down along -z. Parts
reach past their joints with round ends, so that no gap opens when a joint bends. Left and right parts are alike.
"""
import functools

import numpy as np

from ..curves import monotone_cubic
from ..surfaces import swept, table_section
from .anthropometry import ANKLE_HEIGHT, CHEST_BREADTH, FOOT_BREADTH, FOREARM, HIP_BREADTH, HIP_HEIGHT, KNEE_HEIGHT, UPPER_ARM
from .foot import Sole

SHANK, THIGH = KNEE_HEIGHT - ANKLE_HEIGHT, HIP_HEIGHT - KNEE_HEIGHT

# Stations from the lower to the upper tip: z, centre x, centre y, half depth x, half breadth y, power of the section;
# then the lengths of the round ends below and above. All in body heights; clothed adult.
TABLES = {
    "pelvis": ([(-0.062, -0.002, 0, 0.050, 0.074, 2.2), (-0.030, -0.006, 0, 0.061, 0.090, 2.2),
                (0.005, -0.006, 0, 0.063, HIP_BREADTH / 2, 2.3), (0.040, -0.002, 0, 0.058, 0.090, 2.3),
                (0.085, 0.000, 0, 0.052, 0.080, 2.3)], 0.035, 0.025),
    "torso": ([(-0.030, 0.000, 0, 0.052, 0.080, 2.3), (0.030, 0.000, 0, 0.052, 0.078, 2.3),
               (0.080, 0.000, 0, 0.056, 0.081, 2.3), (0.150, -0.002, 0, 0.064, CHEST_BREADTH / 2 + 0.004, 2.3),
               (0.195, -0.006, 0, 0.062, 0.102, 2.2), (0.236, -0.005, 0, 0.048, 0.117, 2.0),
               (0.276, -0.006, 0, 0.036, 0.056, 2.0)], 0.025, 0.040),
    "neck": ([(-0.040, -0.006, 0, 0.034, 0.036, 2), (0.000, -0.004, 0, 0.033, 0.034, 2),
              (0.040, 0.000, 0, 0.032, 0.031, 2), (0.090, 0.004, 0, 0.032, 0.031, 2)], 0.020, 0.020),
    "head": ([(-0.024, 0.022, 0, 0.027, 0.024, 2), (-0.005, 0.015, 0, 0.040, 0.034, 2),
              (0.030, 0.006, 0, 0.053, 0.041, 2), (0.065, 0.001, 0, 0.056, 0.044, 2),
              (0.115, -0.004, 0, 0.054, 0.043, 2)], 0.018, 0.060),
    "upper": ([(-UPPER_ARM - 0.022, 0, 0, 0.022, 0.021, 2), (-UPPER_ARM, 0, 0, 0.023, 0.022, 2),
               (-0.09, 0, 0, 0.028, 0.026, 2), (-0.01, 0, 0, 0.031, 0.027, 2), (0.022, 0, 0, 0.030, 0.026, 2)],
              0.022, 0.032),
    "forearm": ([(-FOREARM - 0.013, 0.002, 0, 0.016, 0.014, 2), (-FOREARM, 0.002, 0, 0.017, 0.0145, 2),
                 (-0.045, 0, 0, 0.024, 0.023, 2), (0.0, 0, 0, 0.023, 0.022, 2), (0.022, 0, 0, 0.022, 0.021, 2)],
                0.013, 0.021),
    "hand": ([(-0.094, 0.002, 0, 0.017, 0.009, 2.3), (-0.060, 0.002, 0, 0.023, 0.012, 2.3),
              (-0.030, 0.002, 0, 0.024, 0.014, 2.3), (0.0, 0.001, 0, 0.016, 0.014, 2), (0.014, 0, 0, 0.016, 0.014, 2)],
             0.025, 0.014),
    "thigh": ([(-THIGH - 0.030, 0.002, 0, 0.031, 0.029, 2), (-THIGH, 0.002, 0, 0.033, 0.031, 2),
               (-0.170, 0.003, 0, 0.039, 0.037, 2), (-0.080, 0.002, 0, 0.047, 0.045, 2), (0.0, 0.0, 0, 0.050, 0.046, 2),
               (0.045, 0.0, 0, 0.046, 0.043, 2)], 0.030, 0.045),
    "shank": ([(-SHANK - 0.018, 0.0, 0, 0.020, 0.018, 2), (-SHANK, 0.0, 0, 0.021, 0.019, 2),
               (-0.165, -0.003, 0, 0.027, 0.025, 2), (-0.075, -0.006, 0, 0.035, 0.032, 2),
               (0.0, 0.001, 0, 0.031, 0.029, 2), (0.028, 0.001, 0, 0.030, 0.028, 2)], 0.018, 0.028),
}

# The foot from above: share of its length from the heel, height of its upper side above the floor, half breadth.
FOOT_TOP = [(0.00, 0.020, 0.016), (0.05, 0.040, 0.017), (0.16, 0.053, 0.0185), (0.30, 0.055, 0.0185),
            (0.45, 0.046, 0.020), (0.62, 0.034, 0.025), (0.75, 0.027, FOOT_BREADTH / 2), (0.88, 0.023, 0.0255),
            (1.00, 0.0163, 0.020)]
FOOT_CAPS = (0.016, 0.030)   # round ends of the breadth at heel and toes, in body heights
FOOT_POWER = 2.6             # of the sections: a flat sole under a round upper
# Longest side over the least half axis, of feet half breadth; beyond, normals turn by 30 degrees within a triangle.
ROUNDEST = 0.6


@functools.lru_cache(maxsize=32)
def surface(kind, body, edge):
    """Vertices [V, 3] and triangles [F, 3] of a kind of body part, e.g. "hand", with sides of about `edge` m or, where it is
    thin, as short as its roundness asks for. They are kept for the next person of that size, and cannot be written to."""
    vertices, triangles = _foot(body, edge) if kind == "foot" else _limb(kind, body, edge)
    for array in (vertices, triangles):
        array.flags.writeable = False
    return vertices, triangles


def _limb(kind, body, edge):
    stations, begin_cap, end_cap = TABLES[kind]
    table = np.array(stations, dtype=float)
    length, breadth, height = body.head if kind == "head" else (1.0, 1.0, 1.0)
    table[:, :5] *= body.of(np.array([height, length, breadth, length, breadth]))
    section = table_section(table, height * body.of(begin_cap), height * body.of(end_cap))
    return swept(section, table[0, 0], table[-1, 0], min(edge, ROUNDEST * table[:, 3:5].min()))


def _foot(body, edge):
    """Along x from heel to toes; its lower side in the middle is the profile of the sole that rolls over the floor."""
    sole = Sole.of(body)
    table = np.array(FOOT_TOP)
    length = sole.toe_end - sole.heel_end

    def section(x):
        share = (x - sole.heel_end) / length
        bottom = sole.profile(x)
        top = np.maximum(body.of(1.0) * monotone_cubic(table[:, 0], table[:, 1], share), bottom)
        breadth = body.of(1.0) * monotone_cubic(table[:, 0], table[:, 2], share)
        begin, end = (body.of(cap) for cap in FOOT_CAPS)
        lack = (np.maximum(1 - (x - sole.heel_end) / begin, 0) ** 2 + np.maximum(1 - (sole.toe_end - x) / end, 0) ** 2)
        breadth = breadth * np.sqrt(np.maximum(1.0 - lack, 0.0))
        return np.stack([0 * x, (top + bottom) / 2 - sole.ankle_height, breadth, (top - bottom) / 2,
                         np.full_like(x, FOOT_POWER)], axis=-1)

    finest = ROUNDEST * body.of(1.0) * table[:, 2].min()
    return swept(section, sole.heel_end, sole.toe_end, min(edge, finest), axes=(1, 2, 0))
