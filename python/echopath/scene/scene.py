"""Scenes: a tree of named nodes with meshes, materials and motions."""
from __future__ import annotations

import inspect
import os
from collections.abc import Sequence
from contextlib import AbstractContextManager, nullcontext
from copy import deepcopy

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from ..actors import Actor
from ..arguments.checks import an, anything, checked, flag, optional, real, refused, text, vector
from ..base.classes.known_attributes import known_attributes
from ..base.materials import known_material, materials
from ..base.numerics.placements import ORIGIN, motion_ahead, placement
from ..readers.model import Model
from ..weather import Weather
from ..weather.weather import weather_text
from .interferers import Interferer, interferers_of, interferers_rule, interferers_text
from .node import SceneNode, lifetime_of, split_motion
from .seams import without_seams, without_seams_between

Content = _core.Mesh | Actor | Model | Sequence[tuple[str, _core.Mesh]] | None
_WEATHER = optional(an(Weather))
# Attributes that are no derived class's own: those of this one, and what its traces remember (tracing/traces.py).
_HELD = ("_weather", "_interferers", "_was_traced", "_geometry")


@known_attributes
class Scene(_core.Scene):
    """A tree of named objects: `scene["street/car"]` is one of them, to be read, moved and changed (SceneNode).

    Iteration gives the full names of all objects, parents first; `name in scene` and `len(scene)` go by them. KeyError names
    the nearest name.
    nodes: list of Node, parents first; meshes: list of SceneMesh by mesh ID (.id, .name, .triangles [F, 3], .material)
    world_vertices(mesh_id, time): [V, 3] in m; num_triangles; breakpoints [N] in s, of one run of what is looped
    Mesh IDs count without gaps the meshes that take part now, so they change when objects are removed or hidden; names do
    not. Paths keep the scene that they were traced in, with its mesh IDs.
    scene: another Scene to copy, such as `paths.scene`; None: empty
    weather: the Weather in which it is; None: that of the scene that is copied, or empty space
    interferers: list of Interferer, other radars that send into the receivers; None: those of the scene that is copied, or none
    Raises TypeError for anything else.
    """

    def __init__(self, scene: _core.Scene | None = None, *, weather: Weather | None = None,
                 interferers: Sequence[Interferer] | None = None):
        self.weather = getattr(scene, "weather", None) if weather is None else weather
        self.interferers = interferers_of(scene) if interferers is None else interferers
        if scene is None:
            super().__init__()
        elif isinstance(scene, _core.Scene):
            super().__init__(scene)
        else:
            raise refused(TypeError, "scene", "a Scene to copy or None", scene)

    @property
    def weather(self) -> Weather | None:
        """The Weather of the scene: its air weakens echoes, and its rain has echoes of its own. None: empty space."""
        return self._weather

    @weather.setter
    def weather(self, weather: Weather | None) -> None:
        self._weather = _WEATHER("weather", weather)

    @property
    def interferers(self) -> tuple[Interferer, ...]:
        """Other radars, whose signals the maps of `simulate` and `Sequence` have, labelled "interference": a tuple."""
        return self._interferers

    @interferers.setter
    def interferers(self, interferers: Sequence[Interferer]) -> None:
        self._interferers = interferers_rule("interferers", interferers)

    def __repr__(self) -> str:
        told = [super().__repr__().removesuffix(")")]
        told += [] if self.weather is None else [f"weather: {weather_text(self.weather)}"]
        told += [interferers_text(self.interferers)] if self.interferers else []
        return ", ".join(told) + ")"

    def _own(self) -> dict[str, object]:
        """The attributes that a class derived from this one has given itself."""
        return {name: value for name, value in vars(self).items() if name not in _HELD}

    def _copied(self, own: dict[str, object]) -> Scene:
        copied = type(self).__new__(type(self))  # the constructor of a derived class may want something else than a scene
        Scene.__init__(copied, self)
        vars(copied).update(own)
        return copied

    def __copy__(self) -> Scene:
        return self._copied(self._own())

    def __deepcopy__(self, memo: dict[int, object]) -> Scene:
        """Shares meshes, motions and materials, which cannot change."""
        memo[id(self)] = copied = self._copied({})
        vars(copied).update(deepcopy(self._own(), memo))
        return copied

    def __getstate__(self):
        return super().__getstate__(), self.weather, self.interferers, self._own()

    def __setstate__(self, state) -> None:
        nodes, weather, interferers, own = state
        super().__setstate__(nodes)
        self.weather, self.interferers = weather, interferers
        vars(self).update(own)

    @checked(self=anything, mesh_or_actor=anything, name=text, material=anything, motion=anything,
             speed=optional(real(unit="m/s")), position=vector, yaw=real(unit="rad"), transform=anything,
             parent=optional(text), smooth=flag, visible=flag)
    def add(self, mesh_or_actor: Content = None, *, name: str, material: _core.Material | str | None = None,
            motion: _core.Motion | _core.Deformation | None = None, speed: float | None = None,
            position: ArrayLike = ORIGIN, yaw: float = 0.0, transform: ArrayLike | None = None, parent: str | None = None,
            smooth: bool = False, visible: bool = True) -> str:
        """Adds an object and returns its full name, "street/pedestrian".

        mesh_or_actor: a Mesh; an Actor or a list of (name, Mesh), which becomes a node with a child for each part
            (a '/' in a part's name makes a group, a node at rest, in between); a Model (load_model), which becomes a node
            with the tree of the file below it; None: an empty node to hang others on
        name: without '/', '*', '?' and quotes, unique among its siblings
        material: a Material or a name in `materials`; each mesh needs one, an actor's parts bring theirs (one given
            here replaces them)
        motion: LinearMotion, KeyframeMotion, CurveMotion, or for a mesh a VertexSequence, MorphTargets or a Skin; None: at
            rest. A mesh with a Skin becomes a node with a child for each joint that dominates any of its triangles, named
            after the joint (Skin.parts); one that is itself part of a mesh (Mesh.part) is not taken apart. The velocities,
            translations and turns of a motion are in the axes of the parent (of the world, for an object without one) and
            about the object's own origin, whatever its yaw: velocity (15, 0, 0) goes along the parent's +x. A Trajectory is a
            motion, too, which may bring a lifetime (`SceneNode.lifetime`); an actor that was made with one brings it. Only the
            parts of an object have its axes for their parent's, so a pedestrian of `actors` walks where its yaw points
        speed: m/s, instead of motion: straight ahead, along the object's own +x as yaw or transform turn it; what parts of
            an actor do by themselves, such as walking, adds to it
        position [3] in m, yaw in rad about z (left positive): placement at rest (time 0 of `speed`) relative to the parent
        transform: [4, 4] instead of position and yaw
        parent: full name of a node; None: the root
        smooth: True for meshes that stand for curved surfaces: normals, positions and curvature are interpolated, except
            across creases of more than 30 degrees; parts of actors may bring it themselves. Triangles of a mesh that touch
            without corners in common, of one mesh or of several of a list, are joined where they turn by less than 20 degrees
        visible: False: it takes no part in anything until `scene[name].visible` is set
        Raises ValueError or TypeError naming the argument; then nothing has been added. Warns (RuntimeWarning) of a yaw
        beyond a turn, which looks like degrees.
        """
        _core.warn_of_turns(yaw)
        place = placement(position, yaw, transform)
        _refuse_two_motions(mesh_or_actor, motion, speed)
        if speed is not None:
            if motion is not None:
                raise refused(ValueError, "speed", "given without motion", speed)
            motion = motion_ahead(place, speed)
        with self._edit():
            batch = _Batch(self, self._parent_index(parent), smooth, visible)
            batch.add_object(mesh_or_actor, name, material, motion, place)
            self._add_nodes(batch.nodes)
        return f"{parent}/{name}" if parent else name

    def to_pyvista(self, time: float = 0.0):
        """The meshes at `time` in s as a pyvista.MultiBlock by their full names, in the order of their IDs; points in m.

        What has a lifetime that does not hold that time (`SceneNode.lifetime`) is left out, and IDs count what is there.
        Field data of a block: mesh_id; of its material material (name, "" without one), conductor and mirror (0 or 1),
        permittivity (real, imaginary), conductivity (S/m), reflectivity, roughness_height (m), scattering and
        cross_polarization, those that it has. Needs pyvista, raises ModuleNotFoundError without it.
        """
        from echopath_viewer import blocks_of

        return blocks_of(self, time)

    def _repr_html_(self) -> str:
        from ..presentation.notebook import scene_html

        return scene_html(self)

    def remove(self, name: str) -> None:
        """Removes an object with all that is below it.

        name: full name. Mesh IDs behind it move up; to take something out for a while, hide it instead
        (`scene[name].visible = False`). Raises KeyError naming the nearest names.
        """
        with self._edit():
            self._remove(self._index_of(name))

    def copy(self) -> Scene:
        """A copy, in which changes do not touch this one; meshes, motions and materials, which cannot change, are shared."""
        return Scene(self)

    def __getitem__(self, name: str) -> SceneNode:
        self._index_of(name)
        return SceneNode(self, name)

    def _ipython_key_completions_(self) -> list[str]:
        """What the tab key offers behind `scene["`."""
        return list(self)

    def _edit(self) -> AbstractContextManager:
        """What an edit is made within, from what it reads of the scene on: that of a live scene keeps other threads away."""
        return nullcontext()

    def _parent_index(self, parent: str | None) -> int:
        try:
            return -1 if parent is None else self._index_of(parent)
        except KeyError as error:
            raise ValueError(error.args[0].replace("name:", "parent:", 1)) from None


# Of what changes a scene: those of records are of the core, and print alike.
changed_scene = an(Scene, called="a Scene that can be changed (ep.Scene(scene) copies one of a record)")


class _Batch:
    """The nodes of one `add`, made before any of them is added."""

    def __init__(self, scene, parent: int, smooth: bool, visible: bool):
        self.nodes = []
        self._first = len(scene)
        self._parent = parent
        self._smooth = smooth
        self._visible = visible

    def add_object(self, content, name, material, motion, place) -> None:
        if self._smooth and not isinstance(motion, _core.Deformation):
            content = _joined(content)
        if content is None or isinstance(content, _core.Mesh):
            self._add_mesh(name, self._parent, place, motion, content, material)
            return
        if isinstance(content, Model):
            self._add_model(content, name, material, motion, place)
            return
        parts = _parts_of(content, material)
        if motion is None:
            motion = getattr(content, "motion", None)
        self._add(name, self._parent, place, motion, None, None)
        groups = {(): self._first}
        for part_name, mesh, part_material, part_motion, part_placement, part_smooth in parts:
            *path, own_name = str(part_name).split("/")
            self._add_mesh(own_name, self._group(groups, tuple(path)), part_placement, part_motion, mesh, part_material,
                           part_smooth)

    def _add_model(self, model: Model, name, material, motion, place) -> None:
        indices = {-1: self._add(name, self._parent, place, model.motion if motion is None else motion, None, None)}
        meshes = self._meshes_without_seams(model)
        for index, node in enumerate(model.nodes):
            own_material = material if material is not None and node.mesh is not None else node.material
            moved = node.motion if node.deformation is None else node.deformation
            indices[index] = self._add_mesh(node.name, indices[node.parent], node.placement, moved, meshes.get(index, node.mesh),
                                            own_material, node.smooth)

    def _meshes_without_seams(self, model: Model) -> dict:
        """The smooth meshes of a model by the index of their node.

        Those that keep their places to each other go on in one another.
        """
        of_place: dict[tuple, list[int]] = {}
        for index, node in enumerate(model.nodes):
            if node.mesh is None or node.deformation is not None or not (self._smooth or node.smooth):
                continue
            stands = node.placement is None and node.motion is None
            of_place.setdefault((node.parent, None if stands else index), []).append(index)
        found = {}
        for indices in of_place.values():
            found.update(zip(indices, without_seams_between([model.nodes[index].mesh for index in indices]), strict=True))
        return found

    def _add_mesh(self, name, parent: int, place, motion, mesh, material, smooth: bool = False) -> int:
        """A node with the mesh; below it the mesh's regions where a skin moves them. Returns its index."""
        if not isinstance(motion, _core.Skin) or mesh is None or mesh.whole is not None:
            return self._add(name, parent, place, motion, mesh, material, smooth)
        group = self._add(name, parent, place, None, None, None)
        for joint, part in motion.parts(mesh):
            self._add(joint, group, None, motion, part, material, smooth)
        return group

    def _group(self, groups: dict, path: tuple) -> int:
        """The node of a group, added with those above it where it is not there yet."""
        if path not in groups:
            groups[path] = self._add(path[-1], self._group(groups, path[:-1]), None, None, None, None)
        return groups[path]

    def _add(self, name, parent: int, place, motion, mesh, material, smooth: bool = False) -> int:
        material, material_name = _material(material, mesh, name)
        lifetime = lifetime_of(motion)
        motion, deformation = split_motion(motion, mesh, name)
        self.nodes.append(_core.Node(name=name, parent=parent, placement=place, motion=motion, mesh=mesh,
                                     deformation=deformation, material=material, material_name=material_name,
                                     smooth=(self._smooth or smooth) and mesh is not None,
                                     visible=self._visible or len(self.nodes) > 0, lifetime=lifetime))
        return self._first + len(self.nodes) - 1


def _joined(content):
    """The content; a mesh, and those of a list, without seams."""
    if isinstance(content, _core.Mesh):
        return without_seams(content)
    if isinstance(content, (list, tuple)) and all(_is_named_mesh(item) for item in content):
        names = [name for name, _ in content]
        return list(zip(names, without_seams_between([mesh for _, mesh in content]), strict=True))
    return content


def _refuse_two_motions(content, motion, speed) -> None:
    """Raises ValueError for a motion beside that of an actor or a model which follows a trajectory."""
    if isinstance(content, (Actor, Model)) and content.motion is not None:
        for argument, value in (("motion", motion), ("speed", speed)):
            if value is not None:
                raise refused(ValueError, argument, "left out for an actor or model that follows a trajectory", value)


def _parts_of(content, material) -> list:
    """(name, mesh, material, motion, placement, smooth) of each part of an actor or of a list of named meshes."""
    if _has_parts(content):
        return [(part.name, part.mesh, part.material if material is None else material, part.motion,
                 placement(part.position, 0.0, None), getattr(part, "smooth", False)) for part in content.parts]
    if isinstance(content, (list, tuple)):
        if not all(_is_named_mesh(item) for item in content):
            hint = "; arrays make one by ep.Mesh(vertices, triangles)" if _are_arrays(content) else ""
            raise refused(TypeError, "mesh_or_actor", f"a list of pairs (name, Mesh){hint}", content)
        return [(name, mesh, material, None, None, False) for name, mesh in content]
    hint = "; ep.mesh_from makes one of it" if hasattr(content, "faces") or hasattr(content, "cells") else ""
    hint = f"; {content.__name__}() makes one" if inspect.isfunction(content) else hint
    hint = "; ep.load_mesh and ep.load_model read files" if isinstance(content, (str, os.PathLike)) else hint
    raise refused(TypeError, "mesh_or_actor", f"a Mesh, an Actor, a Model, a list of (name, Mesh) or None{hint}", content)


def _has_parts(content) -> bool:
    """Whether it is an Actor, or like one; the parts of a pathlib.Path are the names of its folders."""
    if isinstance(content, os.PathLike):
        return False
    parts = getattr(content, "parts", None)
    return isinstance(parts, (list, tuple)) and all(hasattr(part, "name") and hasattr(part, "mesh") for part in parts)


def _are_arrays(content) -> bool:
    """Whether a pair may be meant as the vertices [V, 3] and triangles [F, 3] of a mesh."""
    return len(content) == 2 and all(not isinstance(item, str) and np.ndim(item) == 2 for item in content)


def _is_named_mesh(item) -> bool:
    return isinstance(item, (list, tuple)) and len(item) == 2 and isinstance(item[0], str) and isinstance(item[1], _core.Mesh)


def _material(material, mesh, name: str):
    """(Material or None, its name or "")."""
    if mesh is None:
        if material is not None:
            raise refused(ValueError, "material", f"given with a mesh, which '{name}' has not", material)
        return None, ""
    if material is None:
        raise ValueError(f"material: the mesh '{name}' needs one, a Material or one of {', '.join(materials)}")
    return known_material(material)
