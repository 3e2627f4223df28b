"""A scene with the strongest rays: perspective, from above and from the side."""
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ... import _core
from ...arguments.checks import LARGEST_COUNT, an, array, count as whole
from ...arguments.objects import Objects, named_globs
from ...base.text.mesh_names import object_of
from ...paths.subset import first_group, strongest, strongest_of_each, subset
from ...scene.lifetimes import scene_in_frame
from ..style import new_figure
from .drawing import Drawing, collect
from .flat import draw_flat, name_flat
from .looks import DASHES, MIRROR_COLOUR, TITLE_PAD, colour_of
from .perspective import draw_perspective, name_in_perspective

if TYPE_CHECKING:
    from ...base.classes.foreign_types import Figure

CUT_LABEL, MIRROR_LABEL = "cut here, it goes on beyond the picture", "surface that mirrors"


def plot_scene(scene: _core.Scene, paths: _core.Paths, *, num_rays: int = 300, time: float | None = None,
               power: np.ndarray | None = None, objects: Objects = None,
               title: str = "The scene, and the strongest rays to each object") -> Figure:
    """A scene with its strongest rays.

    scene: whose objects are drawn, but for those with a lifetime that does not cover the frame of the paths
    paths: of `trace`; num_rays: drawn at most, half of them the strongest of each object, half the strongest of all that hit
        anything but mirrors (of all, where none does)
    time: of the picture in s, None: the time of the trace; power: of the paths [P] in W where it is known already
    objects: as in `families`, such as those of labels; None: the children of the scene's root
    Mirrors are drawn translucent, dashed where they go on beyond the picture. The objects with the strongest echoes bear their
    names, and so do the largest mirrors, up to 20 of each that find room.
    title: above them. Returns a matplotlib figure with three views in metres. Raises TypeError or ValueError naming the
    argument.
    """
    an(_core.Scene)("scene", scene)
    an(_core.Paths)("paths", paths)
    num_rays = whole(1, LARGEST_COUNT)("num_rays", num_rays)
    scene = scene_in_frame(scene, paths.radar, paths.frame.start_time)  # whose mesh IDs are those of the paths
    time = paths.frame.trace_time if time is None else time
    power = paths.power if power is None else array(f"[{len(paths)}]")("power", power)
    names = _names_of_meshes(scene, objects)
    numbers, of_path = _objects_of_paths(names, paths)
    chosen = strongest_of_each(power, of_path, len(numbers), num_rays) if (of_path >= 0).any() else strongest(power, num_rays)
    asked = numbers if objects is None else {name: numbers[name] for name, _ in named_globs(objects) if name in numbers}
    drawing = collect(scene, subset(paths, chosen), time, names, _loudest(asked, of_path, power))
    with new_figure(10.5, 8.0) as figure:
        grid = figure.add_gridspec(2, 2, height_ratios=(1.75, 1.0))
        perspective = figure.add_subplot(grid[0, :], projection="3d", computed_zorder=False)
        draw_perspective(perspective, drawing)
        flat = [(figure.add_subplot(grid[1, 0]), (0, 1), "From above"), (figure.add_subplot(grid[1, 1]), (0, 2), "From the side")]
        for axes, plane, its_title in flat:
            draw_flat(axes, drawing, plane, its_title)
        figure.suptitle(title, fontsize=11)
        _add_legend(figure, drawing)
        figure.get_layout_engine().execute(figure)  # where names find room follows from how large the views are
        name_in_perspective(perspective, drawing)
        for axes, plane, its_title in flat:
            axes.set_title(its_title, pad=TITLE_PAD + name_flat(axes, drawing, plane))
    return figure


def _names_of_meshes(scene, objects) -> list:
    """Name of the object of each mesh, None of mirrors; what is in none of `objects` belongs to the root's child above it."""
    meshes = scene.meshes
    names = [None if mesh.material.mirror else object_of(mesh.name) for mesh in meshes]
    if objects is not None:
        for name, mesh_ids in _core.meshes_of_objects(scene, named_globs(objects)).items():
            for mesh_id in mesh_ids:
                names[mesh_id] = name
    return names


def _objects_of_paths(names, paths) -> tuple:
    """({object: its number}, the number of the first object along each path [P], -1 for none); names: of the objects of meshes,
    None of mirrors"""
    numbers = {}
    of_mesh = np.array([-1 if name is None else numbers.setdefault(name, len(numbers)) for name in names], np.int64)
    return numbers, first_group(paths, of_mesh)


def _loudest(numbers: dict, of_path, power) -> list:
    """The names of {object: its number} by their echoes, the strongest first."""
    among = of_path >= 0
    echoes = np.bincount(of_path[among], power[among], minlength=1 + max(numbers.values(), default=0))
    return sorted(numbers, key=lambda name: -echoes[numbers[name]])


def _add_legend(figure, drawing: Drawing) -> None:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    handles = [Line2D([], [], color=colour_of(count), linewidth=1.5, label=f"{count} bounce" + ("s" if count > 1 else ""))
               for count in sorted(drawing.segments)]
    if drawing.mirrors:
        handles.append(Patch(facecolor=(*MIRROR_COLOUR, 0.4), edgecolor=MIRROR_COLOUR, label=MIRROR_LABEL))
    if drawing.mirror_cuts:
        handles.append(Line2D([], [], color=MIRROR_COLOUR, linewidth=1.0, linestyle=DASHES, label=CUT_LABEL))
    figure.legend(handles=handles, loc="outside lower center", ncols=max(1, len(handles)), frameon=False)
