"""Small facets of the walls of a cavity and of its mouth, with normals that point into it."""
from __future__ import annotations

import dataclasses
import functools

import numpy as np

from .. import _core
from ..base.numerics.triangles import areas_of
from .cavity import Cavity

SIDE = 0.25              # wavelengths, of a square as large as a facet of a wall
SIDE_IN_MOUTH = 0.12
PIECES_OF_SIDE = 0.4     # of that side, longest side of the pieces of which facets are made
NORMALS_OF_ONE = 2.0     # normals of a facet's pieces are alike to one part in this
OFFSET = 0.3719          # of that part: normals along the axes do not lie between two groups
ROUNDS = 12
POINTS_AT_ONCE = 4096
MOST_FACETS = 8000       # of the walls: 4 GB
MOST_TRIANGLES = 5000    # of walls and mouth as they are given: each is looked at from each
LIFT = 1e-4              # of the root of a triangle's area, from which it is seen which of its sides is inside
TRIANGLES_AT_ONCE = 64
# No directions of a body's symmetry; a hole shows in one of them at least.
_TO_FAR = np.array([[0.5773, 0.4159, 0.7027], [-0.6131, 0.7219, -0.3208], [0.2417, -0.8719, 0.4259], [-0.4871, -0.3823, -0.7852]])


@dataclasses.dataclass(frozen=True)
class Facets:
    """Parts of a surface: centres [N, 3] in m, unit normals [N, 3] into the cavity, areas [N] in m^2.

    side: m, of a square as large as one; pieces: [P, 3] in m, centres of the smaller parts of which they are made, facet by
    facet; areas_of_pieces: [P] in m^2; first_piece: [N + 1], where those of a facet begin
    """

    centres: np.ndarray
    normals: np.ndarray
    areas: np.ndarray
    side: float
    pieces: np.ndarray
    areas_of_pieces: np.ndarray
    first_piece: np.ndarray

    def __len__(self) -> int:
        return len(self.areas)


def facets_of(scene: _core.Scene, cavity: Cavity, wavelength: float) -> tuple[Facets, Facets]:
    """Those of the walls, and of the mouth, at time 0.

    wavelength: m. Raises KeyError for names that the scene does not have; ValueError for walls that are no perfect
    conductors, that do not close the cavity but for its mouth, or that are too large or too fine.
    """
    walls = np.concatenate([_corners_of(scene, mesh) for mesh in cavity.meshes_in(scene)])
    mouth = cavity.triangles_of_mouth
    if len(walls) + len(mouth) > MOST_TRIANGLES:
        raise ValueError(f"cavities: walls must have at most {MOST_TRIANGLES} triangles, got {len(walls)}")
    for name, corners, side in (("walls", walls, SIDE), ("mouth", mouth, SIDE_IN_MOUTH)):
        least = int(areas_of(corners).sum() / (side * wavelength) ** 2)
        if least > MOST_FACETS:
            raise ValueError(f"cavities: {name} must have at most {MOST_FACETS} facets of {side} wavelengths, got {least}")
    return _both_parted(*(np.asarray(one, float).tobytes() for one in (walls, mouth)), wavelength)


@functools.lru_cache(maxsize=4)
def _both_parted(walls: bytes, mouth: bytes, wavelength: float) -> tuple[Facets, Facets]:
    """Kept for the calls that follow: other directions, or other bodies beside the cavity. walls, mouth: triangles [T, 3, 3]"""
    walls, mouth = (np.frombuffer(one).reshape(-1, 3, 3) for one in (walls, mouth))
    normals = inward_normals(np.concatenate([walls, mouth]))
    return (_parted(walls, normals[:len(walls)], SIDE * wavelength),
            _parted(mouth, normals[len(walls):], SIDE_IN_MOUTH * wavelength))


def _corners_of(scene, mesh) -> np.ndarray:
    """[T, 3, 3] in m, at time 0; without those that have no area."""
    if not mesh.material.conductor:
        raise ValueError(f"cavities: walls must be perfect conductors, mesh {mesh.name!r}")
    corners = np.asarray(scene.world_vertices(mesh.id, 0.0))[np.asarray(mesh.triangles)]
    return corners[areas_of(corners) > 0.0]


def inward_normals(triangles) -> np.ndarray:
    """Unit normals [T, 3] into the hollow that triangles [T, 3, 3] close, whatever their windings are.

    Rays from the side that is inside meet an odd number of them. Raises ValueError where that is not one side of each.
    """
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    middle, lift = triangles.mean(axis=1), LIFT * np.sqrt(areas_of(triangles))[:, None] * normals
    ahead, behind = (np.array([_is_inside(middle + side * lift, triangles, far) for far in _TO_FAR]) for side in (1.0, -1.0))
    wrong = np.any((ahead == behind) | (ahead != ahead[0]), axis=0)
    if wrong.any():
        raise ValueError("cavities: walls and mouth must close the cavity, triangles that are open to one side "
                         f"{int(wrong.sum())} of {len(triangles)}")
    return np.where(ahead[0][:, None], normals, -normals)


def _is_inside(points, triangles, far) -> np.ndarray:
    """Which points [P, 3] a closed surface of triangles [T, 3, 3] holds, by rays along a vector [3]."""
    first, second, third = (triangles[:, k] for k in range(3))
    along, beside = second - first, third - first
    across = np.cross(far, beside)
    with np.errstate(divide="ignore", invalid="ignore"):
        scale = 1.0 / np.einsum("tx,tx->t", along, across)
        met = []
        for some in np.split(points, range(TRIANGLES_AT_ONCE, len(points), TRIANGLES_AT_ONCE)):
            offset = some[:, None] - first
            u = np.einsum("ptx,tx->pt", offset, across) * scale
            turned = np.cross(offset, along)
            v, ahead = turned @ far * scale, np.einsum("ptx,tx->pt", turned, beside) * scale
            met.append(((u >= 0.0) & (v >= 0.0) & (u + v < 1.0) & (ahead > 0.0)).sum(axis=1))
    return np.concatenate(met) % 2 == 1


def _parted(triangles, normals, side) -> Facets:
    """Pieces of about a square of `side`, m: halves of triangles, those that look alike joined about evenly spread points."""
    triangles, normals = _halved(triangles, normals, PIECES_OF_SIDE * side)
    areas, centres = areas_of(triangles), triangles.mean(axis=1)
    alike = np.round(normals * NORMALS_OF_ONE + OFFSET).astype(int)
    _, group = np.unique(alike, axis=0, return_inverse=True)
    group, facet, count = group.reshape(-1), np.zeros(len(areas), int), 0
    for number in range(group.max() + 1):
        own = np.flatnonzero(group == number)
        facet[own] = count + _evenly_joined(centres[own], areas[own], max(1, round(areas[own].sum() / side ** 2)))
        count = facet[own].max() + 1
    order = np.argsort(facet, kind="stable")
    areas, centres, normals, facet = areas[order], centres[order], normals[order], facet[order]
    first = np.concatenate([[0], np.cumsum(np.bincount(facet))])
    joined = np.add.reduceat(areas, first[:-1])
    middle, normal = (np.add.reduceat(areas[:, None] * one, first[:-1]) / joined[:, None] for one in (centres, normals))
    return Facets(middle, normal / np.linalg.norm(normal, axis=1)[:, None], joined, side, centres, areas, first)


def _evenly_joined(points, areas, count) -> np.ndarray:
    """Numbers [P] of the at most `count` neighbourhoods of about the same size to which points [P, 3] belong (Lloyd 1982)."""
    chosen, apart = [0], np.full(len(points), np.inf)
    for _ in range(min(count, len(points)) - 1):  # the point that is farthest from those before
        apart = np.minimum(apart, ((points - points[chosen[-1]]) ** 2).sum(axis=1))
        chosen.append(int(apart.argmax()))
    middles = points[chosen]
    for _ in range(ROUNDS):
        nearest = _nearest(points, middles)
        weight = np.bincount(nearest, areas, len(middles))
        sums = np.column_stack([np.bincount(nearest, areas * points[:, k], len(middles)) for k in range(3)])
        middles = np.where(weight[:, None] > 0.0, sums / np.maximum(weight, 1e-300)[:, None], middles)
    return np.unique(nearest, return_inverse=True)[1].reshape(-1)


def _nearest(points, middles) -> np.ndarray:
    """Index [P] of the nearest of some middles [M, 3] to each point [P, 3]."""
    offset = middles.mean(axis=0)
    from_middle, squares = middles - offset, ((middles - offset) ** 2).sum(axis=1)
    return np.concatenate([(squares - 2.0 * (some - offset) @ from_middle.T).argmin(axis=1)
                           for some in np.split(points, range(POINTS_AT_ONCE, len(points), POINTS_AT_ONCE))])


def _halved(triangles, normals, longest) -> tuple[np.ndarray, np.ndarray]:
    """Halves triangles [T, 3, 3], and theirs [T, 3, 3], across their longest sides until none is longer than `longest`, m."""
    done = []
    while len(triangles):
        sides = np.linalg.norm(np.roll(triangles, -1, axis=1) - triangles, axis=2)
        is_small = sides.max(axis=1) <= longest
        done.append((triangles[is_small], normals[is_small]))
        rest, turn = triangles[~is_small], sides[~is_small].argmax(axis=1)
        a, b, c = (rest[np.arange(len(rest)), (turn + k) % 3] for k in range(3))
        middle = 0.5 * (a + b)
        triangles = np.concatenate([np.stack([a, middle, c], axis=1), np.stack([middle, b, c], axis=1)])
        normals = np.tile(normals[~is_small], (2, 1))
    return tuple(np.concatenate([one[k] for one in done]) for k in range(2))
