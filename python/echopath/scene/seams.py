"""Seams of curved surfaces: places where their triangles touch without corners in common, or are wound the other way."""
from __future__ import annotations

import numpy as np

from .. import _core

SAME_PLACE = 1e-6                        # of the extent
SHORTEST_SHARE = 0.01                    # of the shortest side, which corners of one place are nearer than
SEAM_COSINE = np.cos(np.radians(20.0))   # of facets that go on over a seam; those that turn by more meet in an edge that is meant
MOST_WORK = 5e7                          # triangles of the whole times parts, each of which has its normals made by itself

# What is known of a mesh while it lives: the one without seams, None where it has none; of the first one of a list the others,
# and what was found of all.
_known, _known_lists = _core.MeshTable(), _core.MeshTable()


def without_seams(mesh: _core.Mesh) -> _core.Mesh:
    """The mesh, with one corner at a place where its facets go on, as a curved surface needs for one normal there.

    Triangles keep their number and order. Grids that close upon themselves, triangles with three corners of their own, those
    wound either way and those that are there twice are what it joins. Where facets turn by more than 20 degrees the surface stays
    cut, as files with normals cut it, unless no two triangles of the mesh have a corner in common.
    """
    if mesh.is_closed or mesh.whole is not None:
        return mesh
    joined = _known.get(mesh, mesh)
    if joined is mesh:
        joined = _joined(mesh)
        _known.set(mesh, joined)
    return mesh if joined is None else joined


def without_seams_between(meshes: list) -> list:
    """The meshes without seams; those whose surfaces go on in one another are parts of one, in whose frame all of them are."""
    if len(meshes) < 2:
        return [without_seams(mesh) for mesh in meshes]
    others, found = _known_lists.get(meshes[0], ((), []))
    if len(others) != len(meshes) - 1 or any(one is not two for one, two in zip(others, meshes[1:], strict=True)):
        found = [None if new is mesh else new for new, mesh in zip(_joined_between(meshes), meshes, strict=True)]
        _known_lists.set(meshes[0], (tuple(meshes[1:]), found))
    return [mesh if new is None else new for new, mesh in zip(found, meshes, strict=True)]


def _joined_between(meshes: list) -> list:
    found = [without_seams(mesh) for mesh in meshes]
    alone = [index for index, mesh in enumerate(meshes) if mesh.whole is None]
    if len(alone) < 2:
        return found
    of_mesh = np.repeat(np.arange(len(alone)), [len(meshes[index].triangles) for index in alone])
    across = of_mesh[_continuing_sides(_as_one([meshes[index] for index in alone]))[0] // 3]
    piece = _one_of_each(len(alone), across[across[:, 0] != across[:, 1]])
    for first in np.unique(piece[np.bincount(piece)[piece] > 1]):
        members = [alone[at] for at in np.flatnonzero(piece == first)]
        of_member = np.repeat(members, [len(meshes[index].triangles) for index in members])
        if len(members) * len(of_member) > MOST_WORK:
            continue
        whole = without_seams(_as_one([meshes[index] for index in members]))
        for index in members:
            found[index] = whole.part(of_member == index)
    return found


def _as_one(meshes: list) -> _core.Mesh:
    """All triangles of meshes as one mesh, each with its vertices."""
    first = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    return _core.Mesh(np.concatenate([mesh.vertices for mesh in meshes]),
                      np.concatenate([begin + np.asarray(mesh.triangles, np.int64) for begin, mesh in zip(first, meshes)]),
                      np.concatenate([mesh.original_triangle for mesh in meshes]))


def is_soup(mesh: _core.Mesh) -> bool:
    """Whether no two triangles of the mesh have a corner in common."""
    return len(mesh.vertices) == 3 * len(mesh.triangles)


def _joined(mesh: _core.Mesh) -> _core.Mesh | None:
    vertices, triangles = np.asarray(mesh.vertices), np.asarray(mesh.triangles, np.int64)
    sides, same_way, copy = _continuing_sides(mesh)
    turned = _turned_over(len(triangles), sides // 3, same_way)
    fits = (turned[sides[:, 0] // 3] != turned[sides[:, 1] // 3]) == same_way
    corner = _one_of_each(len(vertices), _common_corners(triangles, sides[fits], same_way[fits]))[triangles]
    if np.array_equal(corner, triangles) or _are_flattened(corner):
        return None
    corner[turned] = corner[turned][:, ::-1]
    if copy.any():  # they need vertices of their own
        return _core.Mesh(vertices, corner, mesh.original_triangle)
    input_vertices = np.zeros((mesh.num_input_vertices, 3))  # as many as a deformation has
    input_vertices[mesh.original_vertex] = vertices
    return _core.Mesh(input_vertices, np.asarray(mesh.original_vertex)[corner], mesh.original_triangle)


def _continuing_sides(mesh: _core.Mesh) -> tuple:
    """(pairs [N, 2] of sides over which the surface goes on, whether they run the same way [N], `_copies` [F])."""
    vertices, triangles = np.asarray(mesh.vertices), np.asarray(mesh.triangles, np.int64)
    place = _places(vertices, triangles)
    copy = _copies(triangles, place)
    sides = _touching_sides(place[triangles], copy)
    goes_on, same_way = _continuations(vertices, triangles, sides)
    goes_on |= is_soup(mesh)
    return sides[goes_on], same_way[goes_on], copy


def _are_flattened(triangles) -> bool:
    """Whether any triangle has two corners in one."""
    return bool((triangles == np.roll(triangles, -1, axis=1)).any())


def _touching_sides(place, copy) -> np.ndarray:
    """Pairs [N, 2] of sides that lie on each other, no others there; side 3 t + k leads from corner k of triangle t to the next.

    place: [F, 3] of the corners; copy: [F] surfaces that have nothing to do with each other
    """
    after = np.roll(place, -1, axis=1)
    edge = _numbers(np.repeat(copy, 3), np.minimum(place, after).reshape(-1), np.maximum(place, after).reshape(-1))
    order = np.argsort(edge, kind="stable")
    return order[np.bincount(edge)[edge[order]] == 2].reshape(-1, 2)


def _places(vertices, triangles) -> np.ndarray:
    """Numbers [V] of the vertices, equal for those at one place."""
    corners = vertices[triangles]
    shortest = np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=-1).min()
    within = min(SAME_PLACE * float(np.ptp(vertices, axis=0).max()), SHORTEST_SHARE * shortest)
    place, num_places = np.zeros(len(vertices), np.int64), 0
    while place.max() >= num_places:  # where many vertices leave no gap along an axis, the next ones part them
        num_places = place.max() + 1
        for along in vertices.T:
            order = np.lexsort((along, place))
            parts = (np.diff(along[order]) > within) | (np.diff(place[order]) > 0)
            place[order[1:]] = np.cumsum(parts)
            place[order[0]] = 0
    return place


def _copies(triangles, place) -> np.ndarray:
    """How many of the triangles before each one lie where it does [F]: those that are there twice are two surfaces."""
    where = _numbers(*np.sort(place[triangles], axis=1).T)
    order, count = np.argsort(where, kind="stable"), np.bincount(where)
    copy = np.empty(len(triangles), np.int64)
    copy[order] = np.arange(len(triangles)) - np.repeat(np.cumsum(count) - count, count)
    return copy


def _numbers(*columns) -> np.ndarray:
    """Numbers [N] from 0 of rows of columns [N] of integers from 0, equal for rows that are equal."""
    number = np.zeros(len(columns[0]), np.int64)
    for column in columns:
        number = np.unique(number * (column.max() + 1) + column, return_inverse=True)[1].reshape(-1)
    return number


def _continuations(vertices, triangles, sides) -> tuple:
    """(whether the surface goes on over a pair of sides [N], whether these run the same way [N])."""
    own = np.stack([triangles.reshape(-1), np.roll(triangles, -1, axis=1).reshape(-1)], axis=-1)[sides]  # [N, side, end]
    is_joined = (own[:, 0] == own[:, 1, ::-1]).all(axis=-1)
    (first, first_end), (second, second_end) = (vertices[own[:, side]].transpose(1, 0, 2) for side in (0, 1))
    same_way = ((first_end - first) * (second_end - second)).sum(axis=-1) > 0.0
    corners = vertices[triangles]
    areas = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals = areas / np.linalg.norm(areas, axis=-1, keepdims=True)
    cosines = (normals[sides[:, 0] // 3] * normals[sides[:, 1] // 3]).sum(axis=-1)
    return is_joined | (np.where(same_way, -cosines, cosines) > SEAM_COSINE), same_way


def _turned_over(num_triangles: int, pairs, same_way) -> np.ndarray:
    """Which triangles [F] are to be wound the other way, so that neighbours agree: the fewer ones of each piece."""
    turned = np.zeros(num_triangles, bool)
    if not same_way.any():
        return turned
    here, there = np.concatenate([pairs, pairs[:, ::-1]]).T
    differs = np.concatenate([same_way, same_way])
    seen = np.zeros(num_triangles, bool)
    order = np.argsort(here, kind="stable")
    here, there, differs = here[order], there[order], differs[order]
    begin = np.searchsorted(here, np.arange(num_triangles + 1))
    for seed in range(num_triangles):
        if seen[seed]:
            continue
        seen[seed], piece = True, [seed]
        for at in piece:
            for k in range(begin[at], begin[at + 1]):
                if not seen[there[k]]:
                    seen[there[k]], turned[there[k]] = True, turned[at] ^ differs[k]
                    piece.append(there[k])
        turned[piece] ^= 2 * np.count_nonzero(turned[piece]) > len(piece)
    return turned


def _common_corners(triangles, sides, same_way) -> np.ndarray:
    """Pairs [2 N, 2] of vertices that are to be one."""
    begin, end = triangles.reshape(-1)[sides], np.roll(triangles, -1, axis=1).reshape(-1)[sides]
    other = np.where(same_way, begin[:, 1], end[:, 1]), np.where(same_way, end[:, 1], begin[:, 1])
    return np.concatenate([np.stack([begin[:, 0], other[0]], axis=-1), np.stack([end[:, 0], other[1]], axis=-1)])


def _one_of_each(num_vertices: int, pairs) -> np.ndarray:
    """The first vertex [V] of those that pairs join."""
    first = np.arange(num_vertices)
    while len(pairs):
        one, other = first[pairs].T
        apart = one != other
        pairs, least, greatest = pairs[apart], np.minimum(one, other)[apart], np.maximum(one, other)[apart]
        np.minimum.at(first, greatest, least)
        while not np.array_equal(first, above := first[first]):
            first = above
    return first
