"""Curved surfaces whose triangles are too large for physical optics."""
from __future__ import annotations

import dataclasses
import math

import numpy as np

from .. import _core
from ..base.classes.made_once import MadeOnce
from ..base.numerics.triangles import areas_of
from ..base.process.callers import warn_user
from ..base.text.lengths import length_text
from ..scene.scales import linear_maps
from ..scene.seams import is_soup, without_seams
from .polarization import COHERENT_SHARE

# Level error of a metal sphere of flat facets over edge / sqrt(radius wavelength), in dB (icospheres against pi a^2).
EDGE_RATIOS = (0.19, 0.38, 0.76, 1.52)
ERRORS_DB = (0.01, 0.30, 1.8, 5.0)
MAX_RATIO = 0.4          # edge / sqrt(radius wavelength) that errs by 0.3 dB
SMOOTH_GAIN = 4.0        # how much coarser a smooth mesh may be
EVEN = 1e-6              # share by which the scales of an object along its axes may differ and count as one
_NAMED = 3               # meshes of which a warning tells


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
    meet in edges of more than 40 degrees or in single bends. The core tells how (scene/smooth/tessellation.h).
    """
    return _tessellation_of(_core.Mesh(vertices, triangles))


def _tessellation_of(mesh) -> Tessellation | None:
    found = _core.tessellation(mesh)
    return None if found is None else Tessellation(*found)


def warn_of_coarse_meshes(scene, frequency: float) -> None:
    """Warns (TessellationWarning), once for all, of curved meshes whose coherent echo at `frequency` [Hz] would err by more
    than 0.3 dB; tells of the worst ones what edge would do."""
    found = coarse_meshes(scene, frequency)
    if not found:
        return
    different: dict[str, str] = {}  # of copies of a mesh, as of cars of one model, one is named
    for one in sorted(found, key=lambda one: -one.ratio):
        different.setdefault(one.fault, f"mesh '{one.name}': {one.fault}")
    worst = list(different.values())[:_NAMED]
    text = "; ".join(worst)
    if len(found) > len(worst):
        text = f"{len(found)} meshes are too coarse for their coherent echo, the worst: " + text
    warn_user(text, TessellationWarning)


@dataclasses.dataclass(frozen=True)
class CoarseMesh:
    """A mesh whose coherent echo would err by more than 0.3 dB.

    mesh_id: index into scene.meshes, name: its name; ratio: edge / sqrt(radius wavelength), a smooth mesh counts as four times
    finer; fault: what is wrong with it
    """

    mesh_id: int
    name: str
    ratio: float
    fault: str


def coarse_meshes(scene, frequency: float) -> list[CoarseMesh]:
    """Meshes of a scene whose coherent echo at `frequency` [Hz] would err by more than 0.3 dB."""
    wavelength = _core.speed_of_light / frequency
    asked = _core.coherent_meshes(scene, wavelength, COHERENT_SHARE, without_planes=True)
    if not asked:
        return []
    nodes, meshes, found, moved = scene.nodes, scene.meshes, [], MadeOnce()
    world_from_node = linear_maps(nodes)[[meshes[mesh_id].node for mesh_id in asked]]
    stretches = np.linalg.svd(world_from_node, compute_uv=False)
    are_even = stretches[:, 0] - stretches[:, 2] <= EVEN * stretches[:, 0]
    scales = np.where(are_even, stretches.mean(axis=1), 1.0).tolist()
    for mesh_id, linear, is_even, scale in zip(asked, world_from_node, are_even.tolist(), scales):
        mesh = meshes[mesh_id]
        measured = _measured(mesh.mesh, None if is_even else linear)
        if measured is None:
            continue
        measured = _scaled(measured, _scale_of_skin(mesh, nodes, moved) * scale)
        smooth = nodes[mesh.node].smooth
        ratio = measured.ratio(wavelength) / (SMOOTH_GAIN if smooth else 1.0)
        if ratio > MAX_RATIO:
            found.append(CoarseMesh(mesh_id, mesh.name, ratio, _fault(measured, wavelength, smooth)))
    return found


_known = _core.MeshTable()  # {linear map as bytes, b"" for none: tessellation} of meshes, each as long as its mesh lives


def _measured(mesh, linear: np.ndarray | None = None) -> Tessellation | None:
    """The tessellation of a mesh, measured once; linear: [3, 3] that stretches it unevenly, None: none."""
    known = _known.get(mesh, None)
    if known is None:
        _known.set(mesh, known := {})
    key = b"" if linear is None else linear.tobytes()
    if key not in known:
        stretched = mesh if linear is None else _core.Mesh(mesh.vertices @ linear.T, mesh.triangles)
        known[key] = _tessellation_of(without_seams(stretched) if is_soup(stretched) else stretched)
    return known[key]


_scales_of_skins = _core.MeshTable()  # of the meshes that have one


def _scale_of_skin(scene_mesh, nodes, moved: MadeOnce) -> float:
    """By how much a Skin makes a mesh larger, as in files of figures in cm; 1 without one.

    moved: keeps the vertices [V, 3] of the skins that were asked before
    """
    mesh, skin = scene_mesh.mesh, nodes[scene_mesh.node].deformation
    if not isinstance(skin, _core.Skin):
        return 1.0
    scale = _scales_of_skins.get(mesh, None)
    if scale is None:
        vertices = moved.of(skin, lambda skin: skin.at(float(np.clip(0.0, *skin.span))))
        corners = vertices[mesh.original_vertex][mesh.triangles]
        scale = math.sqrt(areas_of(corners).sum() / mesh.area)
        _scales_of_skins.set(mesh, scale)
    return scale


def _scaled(measured: Tessellation, scale: float) -> Tessellation:
    """That of a mesh whose lengths are so many times as large."""
    return Tessellation(scale * measured.edge, scale * measured.radius, scale**2 * measured.curved_area, scale**2 * measured.area)


def _fault(measured: Tessellation, wavelength: float, smooth: bool) -> str:
    """What is wrong with a mesh that is too coarse."""
    coarser = SMOOTH_GAIN if smooth else 1.0
    ratio = measured.ratio(wavelength) / coarser
    advice = f"edges of {length_text(_rounded_down(coarser * measured.good_edge(wavelength)))} would do"
    if not smooth and ratio <= SMOOTH_GAIN * MAX_RATIO:
        advice += ", or smooth=True"
    error = f"about {facet_error_db(ratio):.1f} dB" if ratio <= EDGE_RATIOS[-1] else f"{ERRORS_DB[-1]:.0f} dB or more"
    return (f"edges of {length_text(measured.edge)} on a surface curved with a radius of {length_text(measured.radius)} err by "
            f"{error} in its coherent echo; {advice}")


def _rounded_down(value: float) -> float:
    """To two digits: what would do is never said to be what is there."""
    digit = 10.0 ** (math.floor(math.log10(value)) - 1)
    return math.floor(value / digit) * digit
