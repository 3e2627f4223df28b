"""Targets of the Austin RCS Benchmark Suite, made from its descriptions: metal bodies about the origin, nose along +x."""
from __future__ import annotations

import dataclasses
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np

import echopath as ep

INCH, BOX_LENGTH = 0.0254, 0.4             # m
ARC = np.radians(2.5)                      # between the bends of round walls
DUCT_HALF_WIDTH, DUCT_HALF_HEIGHT = 0.1375, 0.105  # of the cobra duct, over the length of its box
DUCT_RADIUS, DUCT_DEPTH = 0.375, 0.75      # of the round duct, likewise
HUB_RADIUS, BLADE_RADIUS, BLADE_HALF = 0.1875, 0.35, np.radians(2.5)
FAN_FROM, FAN_TO, FAN_STEM = 0.25 + 0.00381, 0.25 + 0.25381, 0.18228  # from the rear of the box, over its length
ALMOND_LENGTH = 9.936 * INCH               # m
PRIME_LENGTH = 9.1875 * INCH               # m


@dataclasses.dataclass(frozen=True)
class Target:
    """A body of metal, and the name of its measurements.

    theta_deg: of the radar, from +z; smooth: of its mesh; cavity: whose inside is computed by waves, or None; its walls are
    meshes `part_1` and on
    """

    name: str
    measured_as: str
    make: Callable[[], list[ep.Mesh]]
    theta_deg: float = 90.0
    smooth: bool = False
    cavity: ep.Cavity | None = None


def mesh_of(polygons) -> ep.Mesh:
    """A mesh of convex polygons, each [N, 3] in m."""
    corners = np.concatenate([np.asarray(polygon, float) for polygon in polygons])
    firsts = np.cumsum([0, *(len(polygon) for polygon in polygons[:-1])])
    fans = [(first, first + i, first + i + 1) for first, polygon in zip(firsts, polygons) for i in range(1, len(polygon) - 1)]
    vertices, index = np.unique(np.round(corners, 9), axis=0, return_inverse=True)
    return ep.Mesh(vertices, index.reshape(-1)[np.array(fans)])


def wall(first, second) -> list[np.ndarray]:
    """Quadrangles between two lines of as many points [N, 3]."""
    return [np.array([first[i], first[i + 1], second[i + 1], second[i]]) for i in range(len(first) - 1)]


def slab(size) -> list[ep.Mesh]:
    """A box; size [3] in m."""
    corners = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * np.asarray(size) / 2.0
    faces = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
    return [mesh_of([corners[list(face)] for face in faces])]


def sheet(width) -> list[ep.Mesh]:
    """A plate without thickness across x, 7/4 of its width (m) along y."""
    return [mesh_of([[(0.0, y * width * 7.0 / 8.0, z * width / 2.0) for y, z in ((-1, -1), (-1, 1), (1, 1), (1, -1))]])]


def lying_sheet(width) -> list[ep.Mesh]:
    """The same across z, its width (m) along y."""
    return [mesh_of([[(x * width * 7.0 / 8.0, y * width / 2.0, 0.0) for x, y in ((-1, -1), (-1, 1), (1, 1), (1, -1))]])]


def hull(width, height, nose, slant, is_open: bool) -> list[np.ndarray]:
    """The walls of a camera box over its length: a hexagonal prism; a nose that is open has none."""
    high, low = height / 2.0, nose / 2.0
    outline = np.array([(0.0, -high), (1.0 - slant, -high), (1.0, -low), (1.0, low), (1.0 - slant, high), (0.0, high)])
    left, right = ([np.array([x, y, z]) for x, z in outline] for y in (-width / 2.0, width / 2.0))
    shut = [i for i in range(6) if not (is_open and i == 2)]
    sides = [np.array([left[i], left[(i + 1) % 6], right[(i + 1) % 6], right[i]]) for i in shut]
    return [np.array(left), np.array(right), *sides]


def box_mesh(*parts) -> list[ep.Mesh]:
    """A mesh for each part, polygons that are over the box's length, x from its rear. Round walls are parts of their own."""
    return [mesh_of([(np.asarray(polygon) - (0.5, 0.0, 0.0)) * BOX_LENGTH for polygon in part]) for part in parts]


def camera_box() -> list[ep.Mesh]:
    """Set IIIS-A: a closed box."""
    return box_mesh(hull(0.325, 0.8, 0.26, 0.27, False))


def frame(width, height, hole) -> list[np.ndarray]:
    """A nose at x = 1 about a hole, whose outline [N, 2] is closed, goes round the origin, and passes below the corners."""
    ratio = np.min(np.array([width, height]) / 2.0 / np.maximum(np.abs(hole), 1e-12), axis=1)
    at_nose = [np.column_stack([np.ones(len(hole)), points]) for points in (hole, hole * ratio[:, None])]
    return wall(*at_nose)


def round_outline(radius, corner=None) -> np.ndarray:
    """A closed circle [N, 2] in steps of ARC; corner: radians, what angles it has in each quadrant besides."""
    angles = np.arange(0.0, 2.0 * np.pi - 1e-9, ARC)
    if corner is not None:
        angles = np.concatenate([angles, [corner, np.pi - corner, np.pi + corner, 2.0 * np.pi - corner]])
    angles = np.append(np.unique(np.round(angles, 9)), 0.0)
    return radius * np.column_stack([np.cos(angles), np.sin(angles)])


def at(x, outline) -> np.ndarray:
    """An outline [N, 2] across x as points [N, 3]."""
    return np.column_stack([np.full(len(outline), x), outline])


def cobra_duct() -> list[ep.Mesh]:
    """Set IIIS-B: a box with a duct that bends twice by 35 degrees; the box, and the flat and both bent walls of the duct."""
    half, bend, width = DUCT_HALF_HEIGHT, np.radians(35.0), DUCT_HALF_WIDTH
    turn = np.linspace(0.0, bend, 1 + round(bend / ARC))
    middle, down = [np.array([1.0, 0.0])], [0.0]
    for angle in turn:  # 0.025 straight, then about a centre below
        middle.append(np.array([0.975 - 0.57 * np.sin(angle), -0.57 * (1.0 - np.cos(angle))]))
        down.append(angle)
    start = middle[-1] + 0.2 * np.array([-np.cos(bend), -np.sin(bend)])
    centre = start + 0.36 * np.array([-np.sin(bend), np.cos(bend)])
    for angle in bend - turn:  # back about a centre above
        middle.append(centre + 0.36 * np.array([np.sin(angle), -np.cos(angle)]))
        down.append(angle)
    middle.append(middle[-1] + np.array([-0.25, 0.0]))
    down.append(0.0)
    across = np.column_stack([-np.sin(down), np.cos(down)]) * half
    top, bottom = np.array(middle) + across, np.array(middle) - across
    sides = ((top, -width), (top, width), (bottom, width), (bottom, -width))
    corners = [[np.array([x, y, z]) for x, z in line] for line, y in sides]
    top_wall, right, bottom_wall, left = (wall(corners[k], corners[(k + 1) % 4]) for k in range(4))
    opening = np.array([(y, z) for y, z in ((-width, half), (width, half), (width, -half), (-width, -half), (-width, half))])
    nose = wall(at(1.0, opening), at(1.0, opening * (0.325 / 2.0 / width, 0.13 / half)))
    rest, rear = [*hull(0.325, 0.8, 0.26, 0.27, True), *nose], np.array([line[-1] for line in corners])
    return box_mesh(rest, [*right, *left, rear], top_wall, bottom_wall)


def cavity_of_cobra_duct() -> ep.Cavity:
    """Its duct, which opens in the nose of the box."""
    corners = [(0.5, y * DUCT_HALF_WIDTH, z * DUCT_HALF_HEIGHT) for y, z in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    return ep.Cavity(("part_1", "part_2", "part_3"), np.array(corners) * BOX_LENGTH)


def round_duct_walls() -> list[list[np.ndarray]]:
    """The box of sets IIIS-C and D, and the wall of its round duct."""
    outline, rear = round_outline(DUCT_RADIUS, np.arctan2(0.78, 0.975)), 1.0 - DUCT_DEPTH
    rest = [*hull(0.975, 1.6, 0.78, 0.41, True), *frame(0.975, 0.78, outline), at(rear, outline[:-1])]
    return [rest, wall(at(1.0, outline), at(rear, outline))]


def cylindrical_duct() -> list[ep.Mesh]:
    """Set IIIS-C: a box with a round duct."""
    return box_mesh(*round_duct_walls())


def arc(radius, begin, end) -> np.ndarray:
    """Points [N, 2] of a circle in steps of at most ARC."""
    angles = np.linspace(begin, end, 1 + int(np.ceil((end - begin) / ARC - 1e-9)))
    return radius * np.column_stack([np.cos(angles), np.sin(angles)])


def fan_in_a_duct() -> list[ep.Mesh]:
    """Set IIIS-D: eight blades on a hub before the rear wall of the duct, on a stem that is square."""
    middles, eighth = np.arange(8) * np.pi / 4.0, np.pi / 4.0
    rims = [arc(BLADE_RADIUS, middle - BLADE_HALF, middle + BLADE_HALF) for middle in middles]
    hub = [arc(HUB_RADIUS, middle + BLADE_HALF, middle + eighth - BLADE_HALF) for middle in middles]
    outline = np.concatenate([*(points for pair in zip(rims, hub) for points in pair), rims[0][:1]])
    blades = [np.concatenate([[hub[k - 1][-1]], rims[k], [hub[k][0]]]) for k in range(8)]
    lids = [at(x, part) for x in (FAN_FROM, FAN_TO) for part in (np.concatenate(hub), *blades)]
    stem = FAN_STEM / 2.0 * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1), (-1, -1)])
    fan = [*lids, *wall(at(FAN_FROM, outline), at(FAN_TO, outline)), *wall(at(1.0 - DUCT_DEPTH, stem), at(FAN_FROM, stem))]
    return box_mesh(*round_duct_walls(), fan)


def almond() -> list[ep.Mesh]:
    """The almond of Woo, Wang, Schuh and Sanders 1993: half an ellipsoid, and a tip toward +x."""
    rear = -0.416667 * np.cos(np.linspace(0.0, np.pi / 2.0, 31))[:-1]
    front = 0.583333 * np.sin(np.linspace(0.0, np.pi / 2.0, 41))
    along = np.concatenate([rear, front])
    girth = np.where(along < 0.0, 0.193333 * np.sqrt(np.maximum(1.0 - (along / 0.416667) ** 2, 0.0)),
                     4.83345 * (np.sqrt(1.0 - (along / 2.08335) ** 2) - 0.96))
    girth[[0, -1]] = 0.0
    around = np.linspace(0.0, 2.0 * np.pi, 91)
    rings = [np.column_stack([np.full(around.size, x), g * np.cos(around), g / 3.0 * np.sin(around)]) * ALMOND_LENGTH
             for x, g in zip(along, girth)]
    return [mesh_of([quad for pair in zip(rings, rings[1:]) for quad in wall(*pair)])]


def prime_aircraft(suite) -> list[ep.Mesh]:
    """Set IV-A: the airplane without ducts, by the suite's own mesh of 10 404 triangles, which a checkout has zipped."""
    folder = Path(suite) / "Austin-RCS-Benchmarks" / "Problem IV-PRIME Aircrafts" / "INP_Meshes"
    with zipfile.ZipFile(folder / "Closed-Duct_PRIME_model_meshAA.zip") as packed:
        words = packed.read(packed.namelist()[0]).split()
    num_vertices, num_triangles = int(words[0]), int(words[1])
    vertices = np.array(words[2:2 + 3 * num_vertices], float).reshape(-1, 3)
    triangles = np.array(words[2 + 3 * num_vertices:], int).reshape(num_triangles, -1)[:, -3:] - 1
    middle, extent = 0.5 * (vertices.max(axis=0) + vertices.min(axis=0)), np.ptp(vertices[:, 0])
    return [ep.Mesh((vertices - middle) * PRIME_LENGTH / extent, triangles)]
