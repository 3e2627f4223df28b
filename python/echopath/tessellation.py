"""Curved surfaces whose triangles are too large for physical optics."""
from __future__ import annotations

import dataclasses
import warnings

import numpy as np

from . import _core
from .polarization import COHERENT_SHARE, coherent_share

# Level error of a metal sphere of flat facets over edge / sqrt(radius wavelength), in dB (icospheres against pi a^2).
EDGE_RATIOS = (0.19, 0.38, 0.76, 1.52)
ERRORS_DB = (0.01, 0.30, 1.8, 5.0)
MAX_RATIO = 0.4          # edge / sqrt(radius wavelength) that errs by 0.3 dB
SMOOTH_GAIN = 4.0        # how much coarser a smooth mesh may be
FLAT_ANGLE = 1e-3        # rad: neighbours that turn by less are one plane
CREASE_ANGLE = 0.7       # rad (40 degrees): neighbours that turn by more meet in an edge that is meant
CURVED_SHARE = 0.05      # of a mesh's area, below it the mesh counts as flat
ONE_SIDED = 0.6          # |sum of turns| / sum: a facet that turns on one side only lies at a bend between planes


class TessellationWarning(UserWarning):
    """The triangles of a curved surface are too large for its coherent echo."""


@dataclasses.dataclass(frozen=True)
class Tessellation:
    """How a mesh approximates a curved surface.

    edge: m, of an equilateral triangle that strays as far from the surface (for strips their width)
    radius: m, of curvature, where the triangle strays; both medians over the curved area
    curved_area, area: m^2, of the curved facets and of all
    """

    edge: float
    radius: float
    curved_area: float
    area: float

    def ratio(self, wavelength: float) -> float:
        """edge / sqrt(radius wavelength), what the error depends on."""
        return self.edge / np.sqrt(self.radius * wavelength)

    def good_edge(self, wavelength: float) -> float:
        """Edge in m that errs by 0.3 dB."""
        return MAX_RATIO * np.sqrt(self.radius * wavelength)


def facet_error_db(ratio: float) -> float:
    """Level error in dB (absolute) of flat facets with edge / sqrt(radius wavelength) = ratio; at most that of 1.52."""
    return float(np.exp(np.interp(np.log(ratio), np.log(EDGE_RATIOS), np.log(ERRORS_DB))))


def tessellation(vertices, triangles) -> Tessellation | None:
    """Measures the curvature that a mesh's facets stand for, from the turns between neighbours.

    vertices [V, 3] in m, triangles [F, 3]. Returns None for meshes without curved surfaces: planes, and planes that
    meet in edges of more than 40 degrees or in single bends.

    Each edge contributes its turn across it to the curvature tensor of both facets (Cohen-Steiner and Morvan 2003); the
    mean depth of the surface over a facet is that tensor times the facet's second moments.
    """
    corners = np.asarray(vertices, np.float64)[np.asarray(triangles, np.int64)]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    double_area = np.linalg.norm(normals, axis=1)
    normals /= double_area[:, None]
    first, second, turn, length, across = _turns(np.asarray(triangles, np.int64), corners, normals)
    soft = (turn > FLAT_ANGLE) & (turn < CREASE_ANGLE)
    curved = _turns_on_both_sides(len(corners), first, second, soft, turn <= FLAT_ANGLE, length[:, None] * across)
    area = 0.5 * double_area
    if area[curved].sum() < CURVED_SHARE * area.sum():
        return None
    depth, curvature = _depths(corners, area, first[soft], second[soft], (turn * length)[soft], across[soft])
    return _summary(depth[curved], curvature[curved], area[curved], float(area.sum()))


def _turns(triangles, corners, normals):
    """Edges with two facets: both facets, angle in rad, length in m and the direction across, out of the first one."""
    count = len(triangles)
    one, two = triangles[:, [1, 2, 0]].T.ravel(), triangles[:, [2, 0, 1]].T.ravel()
    edges = np.minimum(one, two) * (triangles.max() + 1) + np.maximum(one, two)
    order = np.argsort(edges, kind="stable")
    same = np.flatnonzero(edges[order[1:]] == edges[order[:-1]])
    one, two = order[same], order[same + 1]
    first, second, opposite = one % count, two % count, one // count
    begin, end = corners[first, (opposite + 1) % 3], corners[first, (opposite + 2) % 3]
    along = end - begin
    length = np.linalg.norm(along, axis=1)
    across = np.cross(along, normals[first]) / length[:, None]
    sine = np.linalg.norm(np.cross(normals[first], normals[second]), axis=1)
    turn = np.arctan2(sine, np.einsum("ij,ij->i", normals[first], normals[second]))
    return first, second, turn, length, across


def _turns_on_both_sides(count, first, second, soft, flat, across):
    """Facets [F] that turn, alone or with a neighbour in their plane, on more than one side. across [E, 3] in m."""
    one, two, step = first[soft], second[soft], across[soft]
    outward = _summed(one, step, count) - _summed(two, step, count)
    length = np.linalg.norm(step, axis=1)[:, None]
    weight = _summed(one, length, count) + _summed(two, length, count)
    one, two = first[flat], second[flat]
    plane_outward = outward + _summed(one, outward[two], count) + _summed(two, outward[one], count)
    plane_weight = weight + _summed(one, weight[two], count) + _summed(two, weight[one], count)
    return (weight[:, 0] > 0) & (np.linalg.norm(plane_outward, axis=1) < ONE_SIDED * plane_weight[:, 0])


def _summed(index, rows, count: int):
    """Sums of rows [E, K] with the same index: [count, K]."""
    return np.stack([np.bincount(index, weights=column, minlength=count) for column in rows.T], axis=1)


def _depths(corners, area, first, second, turn_length, across):
    """Twice the mean depth of the surface over each facet in m, and the largest curvature in 1/m."""
    count = len(corners)
    term = (0.5 * turn_length[:, None, None] * across[:, :, None] * across[:, None, :]).reshape(-1, 9)
    tensor = (_summed(first, term, count) + _summed(second, term, count)).reshape(-1, 3, 3) / area[:, None, None]
    spread = corners - corners.mean(axis=1, keepdims=True)
    moments = np.einsum("fki,fkj->fij", spread, spread) / 12.0
    return np.einsum("fij,fij->f", tensor, moments), np.linalg.eigvalsh(tensor)[:, 2]


def _summary(depth, curvature, area, whole_area: float) -> Tessellation:
    squared_ratio = 12.0 * depth  # edge^2 / radius in m
    order = np.argsort(squared_ratio)
    middle = order[np.searchsorted(np.cumsum(area[order]), 0.5 * area.sum())]
    radius = 1.0 / _weighted_median(curvature, area)
    return Tessellation(edge=float(np.sqrt(squared_ratio[middle] * radius)), radius=float(radius),
                        curved_area=float(area.sum()), area=whole_area)


def _weighted_median(values, weights) -> float:
    order = np.argsort(values)
    return float(values[order[np.searchsorted(np.cumsum(weights[order]), 0.5 * weights.sum())]])


def warn_of_coarse_meshes(scene, frequency: float, stacklevel: int = 2) -> None:
    """Warns (TessellationWarning) of each curved mesh whose coherent echo at `frequency` [Hz] would err by more than
    0.3 dB, and names the edge that would do."""
    for _, text in coarse_meshes(scene, frequency):
        warnings.warn(text, TessellationWarning, stacklevel=stacklevel + 1)


def coarse_meshes(scene, frequency: float) -> list:
    """Meshes of a scene whose coherent echo at `frequency` [Hz] would err by more than 0.3 dB: (mesh, what is wrong)."""
    wavelength = _core.speed_of_light / frequency
    nodes, found = scene.nodes, []
    for mesh in scene.meshes:
        if mesh.material.mirror or coherent_share(mesh.material, wavelength) < COHERENT_SHARE:
            continue
        measured = _measured(mesh.mesh)
        text = measured and _complaint(mesh.name, measured, wavelength, nodes[mesh.node].smooth)
        if text:
            found.append((mesh, text))
    return found


_known = _core.MeshTable()  # tessellations, each as long as its mesh lives


def _measured(mesh) -> Tessellation | None:
    """The tessellation of a mesh, measured once."""
    measured = _known.get(mesh, _known)
    if measured is _known:
        measured = tessellation(mesh.vertices, mesh.triangles)
        _known.set(mesh, measured)
    return measured


def _complaint(name: str, measured: Tessellation, wavelength: float, smooth: bool) -> str:
    """What is wrong with a mesh, "" when nothing is."""
    coarser = SMOOTH_GAIN if smooth else 1.0
    ratio = measured.ratio(wavelength) / coarser
    if ratio <= MAX_RATIO:
        return ""
    advice = f"edges of {1e3 * coarser * measured.good_edge(wavelength):.2g} mm would do"
    if not smooth and ratio <= SMOOTH_GAIN * MAX_RATIO:
        advice += ", or smooth=True"
    error = f"about {facet_error_db(ratio):.1f} dB" if ratio <= EDGE_RATIOS[-1] else f"{ERRORS_DB[-1]:.0f} dB or more"
    return (f"mesh '{name}': edges of {1e3 * measured.edge:.2g} mm on a surface curved with a radius of "
            f"{measured.radius:.2g} m err by {error} in its coherent echo; {advice}")
