"""Meshes of nodes with what deforms them: morph targets, skins, and joints in place of nodes whose scale moves."""
from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ... import _core
from ...base.text.node_names import unique
from .accessors import FLOAT, Accessors
from .animations import Animation
from .document import Document
from .item import Item
from .motions import Motions
from .nodes import Nodes
from .primitives import Primitive, Primitives

JOINT_BYTES = 2000   # of a joint in memory, about
FLATTEST = 1e-12     # height by longest edge of a triangle, below which a Mesh leaves it out
MOST_POSES = 32      # times of an animation at which surfaces without area are looked at again


@dataclass(frozen=True)
class Surface:
    """A mesh with its deformation, or None; regions: the meshes by joint of a skin at rest, instead of one mesh."""

    mesh: object
    deformation: object
    primitive: Primitive
    regions: tuple = ()


@dataclass(frozen=True)
class Rig:
    """The joints of a skin. chain: nodes, parents first; place [J]: where each joint of the file stands in it
    bound: {node: joint_from_skin [4, 4] as the vertices were bound}
    """

    chain: list
    place: np.ndarray
    bound: dict


class Blend(NamedTuple):
    """Which joints move each vertex: joints [V, K], places in the chain of a Rig, and their weights [V, K]."""

    joints: np.ndarray
    weights: np.ndarray


class Surfaces:
    """Makes the surfaces of nodes."""

    def __init__(self, document: Document, accessors: Accessors, nodes: Nodes, motions: Motions, primitives: Primitives,
                 animation: Animation):
        self._document, self._accessors, self._nodes = document, accessors, nodes
        self._motions, self._primitives, self._animation = motions, primitives, animation
        self._skins = document.json["skins"].objects()
        self._resting = Motions(nodes, Animation())
        self._meshes: dict[int, object] = {}
        self._rigs: dict[int, Rig] = {}

    def is_skinned(self, node: int) -> bool:
        return self._nodes.item(node)["skin"].index(len(self._skins), None) is not None

    def of(self, node: int, chain: list[int]) -> list[Surface]:
        """Those of the node's primitives. chain: nodes, the lowest last, that move it as joints; without any it is rigid."""
        found = []
        for primitive in self._primitives.of_mesh(self._nodes.item(node)["mesh"].index(self._primitives.num_meshes)):
            try:
                made = self._surface(node, primitive, chain)
            except ValueError as error:  # what the core refuses: places beyond all bounds
                primitive.item.fail(str(error))
            if made is not None:
                found.append(made)
        return found

    def _surface(self, node: int, primitive: Primitive, chain: list[int]) -> Surface | None:
        vertices, shape = self._shape(node, primitive)
        if self.is_skinned(node) and primitive.joints is not None:
            return self._skinned(node, primitive, vertices, shape)
        if chain:
            return self._jointed(primitive, vertices, shape, chain)
        mesh = self._mesh(primitive, vertices if shape is None else self._opened(primitive, vertices, shape))
        return None if mesh is None else Surface(mesh, shape, primitive)

    def _opened(self, primitive: Primitive, vertices: np.ndarray, deformation) -> np.ndarray:
        """The vertices at rest, or those of a time of the animation at which the most triangles have an area.

        What grows out of a point or a line has no area at rest, and a Mesh made there would lose it for all times.
        """
        least = _num_flat(vertices, primitive.triangles)
        for time in self._times_of_poses() if least else ():
            pose = deformation.at(time)
            flat = _num_flat(pose, primitive.triangles)
            if flat < least:
                vertices, least = pose, flat
        return vertices

    def _times_of_poses(self) -> np.ndarray:
        """Times of the scene in s of keys of the animation and half-way between these, some of them where there are very many.

        The pose of the last key of a loop is never seen: at its time the loop begins anew.
        """
        keys = np.unique(np.concatenate([curve.times for curve in self._animation.curves.values()] or [np.zeros(0)]))
        times = np.sort(np.append(keys, 0.5 * (keys[1:] + keys[:-1])))
        chosen = np.linspace(0, len(times) - 1, min(len(times), MOST_POSES)).round().astype(int)
        return times[chosen] - self._animation.offset

    def _mesh(self, primitive: Primitive, vertices: np.ndarray):
        """The Mesh, shared by the nodes that have it as it stands in the file; None where it has no area."""
        is_own = vertices is not primitive.vertices
        if not is_own and id(primitive) in self._meshes:
            return self._meshes[id(primitive)]
        self._document.spend(100 * (len(vertices) + len(primitive.triangles)), primitive.item)
        try:
            mesh = _core.Mesh(vertices, primitive.triangles)
        except ValueError as error:
            if "no triangle" not in str(error) and "area" not in str(error):
                raise
            self._document.note(f"{primitive.item.place} has no area and is left out")
            mesh = None
        if not is_own:
            self._meshes[id(primitive)] = mesh
        return mesh

    # --- morph targets ---

    def _shape(self, node: int, primitive: Primitive) -> tuple:
        """(vertices [V, 3] with the shares at rest, MorphTargets or None)."""
        if not primitive.targets:
            return primitive.vertices, None
        curve = self._animation.curves.get((node, "weights"))
        if curve is None:
            shares = self._shares_at_rest(node, max(primitive.targets) + 1)
            moves = [shares[k] * target for k, target in primitive.targets.items() if shares[k]]
            return (primitive.vertices + sum(moves) if moves else primitive.vertices), None
        width = curve.values.shape[1]
        beyond = [k for k in primitive.targets if k >= width]
        if beyond:
            primitive.item["targets"].fail(f"has {beyond[-1] + 1} targets, of which the animation moves {width}")
        kept = [k for k in primitive.targets if self._is_used(curve, k)]
        if not kept:
            return primitive.vertices, None
        self._document.spend(48 * len(kept) * len(primitive.vertices), primitive.item)
        targets = np.stack([primitive.targets[k] for k in kept])
        shape = _core.MorphTargets(primitive.vertices, targets, _columns(curve, kept), period=self._animation.period,
                                   offset=self._animation.offset)
        return primitive.vertices, shape

    def _shares_at_rest(self, node: int, count: int) -> np.ndarray:
        item = self._nodes.item(node)
        own = item["weights"].numbers(None, None)
        if own is None:
            own = self._primitives.mesh(item["mesh"].value)["weights"].numbers(None, np.zeros(0))
        return np.concatenate([own, np.zeros(max(0, count - len(own)))])

    @staticmethod
    def _is_used(curve, column: int) -> bool:
        rows = (curve.values, curve.in_tangents, curve.out_tangents)
        return any(row is not None and row[:, column].any() for row in rows)

    # --- joints ---

    def _skinned(self, node: int, primitive: Primitive, vertices: np.ndarray, shape) -> Surface | None:
        """All joints of the skin and what is above them, from the root of the scene on."""
        index = self._nodes.item(node)["skin"].index(len(self._skins))
        if index not in self._rigs:
            self._rigs[index] = self._rig(self._skins[index])
        rig = self._rigs[index]
        used = primitive.joints[primitive.weights > 0.0]
        if len(used) and used.max() >= len(rig.place):
            primitive.item["attributes"].fail(
                f"must name joints 0 to {len(rig.place) - 1} of {self._skins[index].place}, names {used.max()}")
        joints = rig.place[np.minimum(primitive.joints, len(rig.place) - 1)]
        return self._made(primitive, vertices, shape, rig, Blend(joints, primitive.weights))

    def _rig(self, skin: Item) -> Rig:
        members = self._members(skin)
        inverse_binds = self._inverse_binds(skin, len(members))
        chain = self._all_above(members)
        place = {member: index for index, member in enumerate(chain)}
        return Rig(chain, np.array([place[member] for member in members]), dict(zip(members, inverse_binds, strict=True)))

    def _jointed(self, primitive: Primitive, vertices: np.ndarray, shape, chain: list[int]) -> Surface | None:
        joints = np.full((len(vertices), 1), len(chain) - 1)
        rig = Rig(chain, np.arange(len(chain)), {})
        made = self._made(primitive, vertices, shape, rig, Blend(joints, np.ones((len(vertices), 1))))
        if made is None or made.regions:
            return made
        everything = np.arange(len(made.mesh.triangles))
        return Surface(made.mesh.part(everything), made.deformation, primitive)

    def _made(self, primitive, vertices, shape, rig: Rig, blend: Blend) -> Surface | None:
        chain, bound, (joints, weights) = rig.chain, rig.bound, blend
        self._document.spend(JOINT_BYTES * len(chain) + 100 * weights.size, primitive.item)
        skin = _core.Skin(vertices, self._joints(self._motions, chain, bound), weights, joints, shape)
        if shape is None and not any(self._motions.moves(member) for member in chain):
            mesh = self._mesh(primitive, skin.at(0.0))
            return None if mesh is None else Surface(mesh, None, primitive, tuple(skin.parts(mesh)))
        at_rest = _core.Skin(vertices, self._joints(self._resting, chain, bound), weights, joints)
        mesh = self._mesh(primitive, self._opened(primitive, at_rest.at(0.0), skin))
        return None if mesh is None else Surface(mesh, skin, primitive)

    def _joints(self, motions: Motions, chain: list[int], bound: dict) -> list:
        taken: dict[str, int] = {}
        names = {member: unique(self._nodes.name[member], taken) for member in chain}
        made = []
        for member in chain:
            placement, motion = motions.of(member)
            above = self._nodes.parent[member]
            made.append(_core.Joint(names[member], names[above] if above >= 0 else None, transform=placement, motion=motion,
                                    inverse_bind=bound.get(member, np.eye(4))))
        return made

    def _members(self, skin: Item) -> list[int]:
        members: dict[int, None] = {}
        for reference in skin["joints"].entries():
            node = reference.index(len(self._nodes))
            if node not in self._nodes.parent:
                reference.fail(f"nodes[{node}] is not in the scene")
            if node in members:
                reference.fail(f"nodes[{node}] is a joint twice")
            members[node] = None
        if not members:
            skin["joints"].fail("must hold at least one joint")
        return list(members)

    def _all_above(self, members: list[int]) -> list[int]:
        wanted: set[int] = set()
        for node in members:
            while node >= 0 and node not in wanted:
                wanted.add(node)
                node = self._nodes.parent[node]
        return [node for node in self._nodes.order if node in wanted]

    def _inverse_binds(self, skin: Item, count: int) -> np.ndarray:
        reference = skin["inverseBindMatrices"]
        if not reference.is_given:
            return np.tile(np.eye(4), (count, 1, 1))
        matrices = self._accessors.numbers(reference, "MAT4", FLOAT)
        if len(matrices) < count:
            reference.fail(f"must have a matrix for each of {count} joints, has {len(matrices)}")
        return self._nodes.inverse_bind(matrices[:count], reference)


def _num_flat(vertices: np.ndarray, triangles: np.ndarray) -> int:
    """How many triangles a Mesh of these vertices leaves out."""
    corners = vertices[triangles]
    sides = corners[:, [1, 2, 2]] - corners[:, [0, 0, 1]]
    longest = (sides**2).sum(axis=2).max(axis=1)
    return int((np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1) <= FLATTEST * longest).sum())


def _columns(curve, columns: list[int]):
    changed = {"values": curve.values[:, columns]}
    if curve.interpolation == "hermite":
        changed |= {"in_tangents": curve.in_tangents[:, columns], "out_tangents": curve.out_tangents[:, columns]}
    return curve.replace(**changed)
