"""A scene with the strongest rays: perspective, from above and from the side."""
from __future__ import annotations

import dataclasses
import itertools
from typing import TYPE_CHECKING

import numpy as np

from .. import _core
from ..arguments.checks import LARGEST_COUNT, an, array, count as whole
from ..arguments.objects import Objects, named_globs
from ..base.text.mesh_names import object_of
from ..paths.subset import first_group, strongest, strongest_of_each, subset
from ..scene.lifetimes import scene_in_frame
from .clip import clip_triangles, outline
from .names import Room
from .style import BOUNCE_COLOURS, new_figure, short_name

if TYPE_CHECKING:
    from ..base.classes.foreign_types import Figure

BODY_COLOUR = np.array([0.35, 0.38, 0.44])
MIRROR_COLOUR = (0.55, 0.65, 0.80)
LIGHT = np.array([-0.55, -0.45, 0.70])  # towards the lamp
CUT = 1e-6                              # m: what lies as near to the border of the picture was cut there
MARGIN, SHARE_OF_MARGIN = 0.6, 0.25      # m around the rays, and most of the longest side of what is smaller
DOTS = 3000                             # along the longest side of a picture: what is smaller than one cannot be told apart
DOT_COVERS = 2.0                        # of its size: triangles of that leave no gaps between dots
FLOOR = 0.02                            # of the height of what is drawn: level grounds end no farther above its lowest point
WIDE_GROUND, LYING = 0.5, 0.7           # of the longest side of the picture, and mean cosine of the slope, of grounds that rise
ELEVATION, AZIMUTH = 22.0, -118.0       # degrees, of the eye
WIDE = 2.2                              # width of the view in perspective over its height
FILLED, MOST_ZOOM = 0.72, 1.75          # share of the height that a scene fills; the rest is for the labels of the axes
NEARER = 0.35                           # how much larger the perspective draws the near end of a scene that is all depth
RADAR_LABEL = "radar"
MIDDLE = 0.1                            # of the longer side of an object, to either side of its middle: what has its name above
MOST_NAMES = 20                         # objects, and mirrors, that bear their names in a picture; more would hide each other
FEW_NAMES = 12                          # as many all find room
MOST_RAISED = 3                         # lines that one of more stands above its object at most: farther up it is of none
MIRROR_LINES = 3                        # where the name of a mirror may stand, one above the other
NAME_LOOK = {"fontsize": 7, "color": "0.25"}
MIRROR_NAME_LOOK = {"fontsize": 7, "color": "#33507a"}
RADAR_ASIDE = -10.0, 0.0                # points, in perspective, from the radar to its name
TITLE_PAD = 6.0                         # points between axes and title
LETTER, LINE, POINTS_PER_INCH = 0.6, 1.2, 72.0  # width of a letter and height of a line over the size of the font
DASHES = (0, (4, 3))
CUT_LABEL, MIRROR_LABEL = "cut here, it goes on beyond the picture", "surface that mirrors"
EDGE_ON = 1e-3                          # area over the square of the length, below which a polygon is drawn as a line
NAME_PLACE = 0.93                       # along x of a mirror, where its name stands
TICK_SPACE = 0.06                       # of the longest axis that perspective draws: room that a number on an axis needs
SHORTEST_AXIS = 0.03                    # likewise: shorter axes bear no numbers, which flat views tell
FLAT_TICKS = 30.0, 13.0                 # points, that numbers need across and up, on axes of flat views of the size FLAT_SIZE
FLAT_SIZE = 310.0, 160.0                # points, about
LABEL_SPACE, OWN_PAD = 34.0, 21.0       # points from an axis of a cube to its label, of which Matplotlib adds the second itself
NUMBER_SPACE, OWN_NUMBER_PAD = 11.5, 8.0  # likewise to its numbers
THIN = 0.16                             # of the longest side: beside thinner ones labels and numbers stay as far from an axis


@dataclasses.dataclass
class _Drawing:
    """What the views show: polygons [N, 3] with colours [4], those of grounds, mesh by mesh, as (height, first, last), edges
    [2, 3] that end a mirror and that the picture cuts it at, rays [S, 2, 3] by number of bounces; names, mirror_names: {object:
    (lowest, highest) corner [3] of its box in the picture}."""

    bodies: list
    body_colours: list
    grounds: list
    mirrors: list
    mirror_edges: list
    mirror_cuts: list
    segments: dict
    radar: np.ndarray
    low: np.ndarray
    high: np.ndarray
    names: dict  # from the one with the strongest echo on
    mirror_names: dict
    margin: float  # m, around what is drawn


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
    drawing = _collect(scene, subset(paths, chosen), time, names, _loudest(asked, of_path, power))
    with new_figure(10.5, 8.0) as figure:
        grid = figure.add_gridspec(2, 2, height_ratios=(1.75, 1.0))
        perspective = figure.add_subplot(grid[0, :], projection="3d", computed_zorder=False)
        _draw_perspective(perspective, drawing)
        flat = [(figure.add_subplot(grid[1, 0]), (0, 1), "From above"), (figure.add_subplot(grid[1, 1]), (0, 2), "From the side")]
        for axes, plane, its_title in flat:
            _draw_flat(axes, drawing, plane, its_title)
        figure.suptitle(title, fontsize=11)
        _add_legend(figure, drawing)
        figure.get_layout_engine().execute(figure)  # where names find room follows from how large the views are
        _draw_names_in_perspective(perspective, drawing)
        for axes, plane, its_title in flat:
            axes.set_title(its_title, pad=TITLE_PAD + _draw_flat_names(axes, drawing, plane))
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


def _collect(scene, shown, time: float, names, named: list) -> _Drawing:
    """names: of the objects of meshes, None of others; named: those of them that the picture may bear"""
    transmitter, receiver = np.asarray(shown.frame.transmitter), np.asarray(shown.frame.receiver)
    points = np.asarray(shown.points(time)).reshape(-1, 3)
    segments = {int(count): _segments(shown, points, count, transmitter, receiver)
                for count in np.unique(shown.num_bounces)}
    corners = np.concatenate([points, transmitter[None], receiver[None], _object_vertices(scene, time)])
    corners = np.concatenate([corners, _small_mirrors(scene, time, corners.min(axis=0), corners.max(axis=0))])
    margin = min(MARGIN, max(SHARE_OF_MARGIN * np.ptp(corners, axis=0).max(), CUT))
    low, high = corners.min(axis=0) - margin, corners.max(axis=0) + margin
    middle = 0.5 * (transmitter + receiver)
    drawing = _Drawing([], [], [], [], [], [], segments, middle, low, high, _places_of(scene, names, named, time), {}, margin)
    for mesh_id, mesh in enumerate(scene.meshes):
        vertices = np.asarray(scene.world_vertices(mesh_id, time))
        _add_mesh(drawing, vertices[np.asarray(mesh.mesh.triangles)], mesh)
    return drawing


def _segments(paths, points, count: int, transmitter, receiver):
    """Straight pieces [S, 2, 3] of all paths of `count` bounces, from the transmitter by the hits to the receiver."""
    offsets = paths.offsets[paths.num_bounces == count]
    corners = np.empty((len(offsets), count + 2, 3))
    corners[:, 0], corners[:, -1] = transmitter, receiver
    corners[:, 1:-1] = points[offsets[:, None] + np.arange(count)]
    return np.stack([corners[:, :-1], corners[:, 1:]], axis=2).reshape(-1, 2, 3)


def _object_vertices(scene, time: float):
    """World vertices [N, 3] of the meshes that are no mirrors: what the picture must hold, small or not."""
    vertices = [np.asarray(scene.world_vertices(mesh_id, time)) for mesh_id, mesh in enumerate(scene.meshes)
                if not mesh.material.mirror]
    return np.concatenate([np.zeros((0, 3)), *vertices])


def _small_mirrors(scene, time: float, low, high):
    """Corners [N, 3] of the boxes of mirrors that reach into the box of the rest, from low to high, and are no longer than it:
    vehicles and signs whose faces mirror are shown whole, walls and roads as far as the rest goes."""
    found = [np.zeros((0, 3))]
    for mesh_id, mesh in enumerate(scene.meshes):
        if not mesh.material.mirror:
            continue
        vertices = np.asarray(scene.world_vertices(mesh_id, time))
        ends = np.stack([vertices.min(axis=0), vertices.max(axis=0)])
        if np.ptp(ends, axis=0).max() <= (high - low).max() and (ends[0] <= high).all() and (ends[1] >= low).all():
            found.append(ends)
    return np.concatenate(found)


def _places_of(scene, names, named: list, time: float) -> dict:
    """(lowest, highest) corner [3] of the middle of each object that is named, {name: corners}. names: of the objects of meshes,
    or None"""
    objects = {name: [] for name in named}
    for mesh_id, name in enumerate(names):
        if name in objects:
            objects[name].append(np.asarray(scene.world_vertices(mesh_id, time)))
    return {name: _middle_of(np.concatenate(parts)) for name, parts in objects.items()}


def _middle_of(points) -> tuple:
    """(lowest, highest) corner [3] of the points [N, 3] of an object in the middle of its longer side: what is bent, as a rail
    along a curve, is not where its box is."""
    low, high = points.min(axis=0), points.max(axis=0)
    longer = int(np.argmax((high - low)[:2]))
    away = np.abs(points[:, longer] - 0.5 * (low + high)[longer])
    some = points[away <= max(away.min(), MIDDLE * (high - low)[longer])]
    return np.append(some[:, :2].min(axis=0), low[2]), np.append(some[:, :2].max(axis=0), high[2])


def _add_mesh(drawing: _Drawing, triangles, mesh) -> None:
    dot = (drawing.high - drawing.low).max() / DOTS
    shown = triangles if mesh.material.mirror else _as_dots(triangles, drawing.low, dot)
    polygons = clip_triangles(shown, drawing.low, drawing.high)
    if mesh.material.mirror:
        drawing.mirrors += polygons
        for edge in outline(polygons):
            (drawing.mirror_cuts if _is_cut(edge, drawing.low, drawing.high) else drawing.mirror_edges).append(edge)
        if polygons:
            _add_mirror_name(drawing.mirror_names, object_of(mesh.name), np.concatenate(polygons))
        return
    if polygons:
        if _is_ground(drawing, triangles):
            drawing.grounds.append((triangles[..., 2].max(), len(drawing.bodies), len(drawing.bodies) + len(polygons)))
        drawing.bodies += polygons
        drawing.body_colours += _shaded(np.array([polygon[:3] for polygon in polygons]))


def _as_dots(triangles, low, dot: float) -> np.ndarray:
    """Triangles [N, 3, 3], of those smaller than a dot in m one for each dot, which covers it: a person far away has thousands.
    low: [3] where dots begin"""
    size = np.ptp(triangles, axis=1).max(axis=1)
    small = np.flatnonzero(size < dot)
    middle = triangles[small].mean(axis=1)
    place = np.floor((middle - low) / dot).astype(np.int64)
    _, first = np.unique((place[:, 0] * 2**20 + place[:, 1]) * 2**20 + place[:, 2], return_index=True)
    kept, middle = small[first], middle[first, None]
    larger = DOT_COVERS * dot / np.maximum(size[kept], np.finfo(float).tiny)
    return np.concatenate([triangles[size >= dot], middle + (triangles[kept] - middle) * larger[:, None, None]])


def _is_ground(drawing: _Drawing, triangles) -> bool:
    """Whether triangles [N, 3, 3] lie at the lowest point of the picture: level ones, or those of a wide slope or hills."""
    sides, lowest = drawing.high - drawing.low, drawing.low[2] + drawing.margin
    if triangles[..., 2].max() <= lowest + FLOOR * sides[2]:
        return True
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    is_lying = np.abs(normals[:, 2]).sum() >= LYING * np.linalg.norm(normals, axis=1).sum()
    is_wide = np.ptp(triangles[..., :2], axis=(0, 1)).max() >= WIDE_GROUND * sides.max()
    return bool(is_lying and is_wide and triangles[..., 2].min() <= lowest + FLOOR * sides[2])


def _add_mirror_name(names: dict, name: str, corners) -> None:
    """Adds the name of a mirror with the box about its corners [N, 3], or widens the box."""
    low, high = names.get(name, (corners.min(axis=0), corners.max(axis=0)))
    names[name] = np.minimum(low, corners.min(axis=0)), np.maximum(high, corners.max(axis=0))


def _is_cut(edge, low, high) -> bool:
    """Whether an edge [2, 3] lies on the border of the picture: there the mirror goes on."""
    return any(np.isclose(edge, border, rtol=0.0, atol=CUT).all(axis=0).any() for border in (low, high))


def _of_equal_length(polygons) -> np.ndarray:
    """Polygons [N, K, D], which end with their last corner as often as the longest has more: Matplotlib takes an array at
    once, but a list one by one."""
    if not polygons:
        return np.empty((0, 3, 3))
    counts, starts = _counted(polygons)
    return np.concatenate(polygons)[starts[:, None] + np.minimum(np.arange(counts.max()), counts[:, None] - 1)]


def _is_edge_on(polygons) -> np.ndarray:
    """Whether polygons [N, K, 2] are seen as lines [N], which fill nothing, as an upright wall from above."""
    x, y = np.moveaxis(polygons - polygons[:, :1], 2, 0)
    area = 0.5 * np.abs((x * np.roll(y, -1, axis=1) - y * np.roll(x, -1, axis=1)).sum(axis=1))
    return area <= EDGE_ON * np.ptp(polygons, axis=1).max(axis=1) ** 2


def _counted(polygons) -> tuple:
    """Number of corners of each polygon [N], and the place of its first among those of all [N]."""
    counts = np.array([len(polygon) for polygon in polygons], int)
    return counts, np.cumsum(counts) - counts


def _middles(polygons, axis: int) -> np.ndarray:
    """Mean of the corners of each polygon along an axis [N]."""
    if not polygons:
        return np.empty(0)
    counts, starts = _counted(polygons)
    return np.add.reduceat(np.concatenate(polygons)[:, axis], starts) / counts


def _shaded(corners) -> list:
    """Colours [N, 4] of polygons under the lamp, both sides alike, from their first three corners [N, 3, 3]."""
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(normal, axis=1)
    brightness = np.abs(normal @ LIGHT) / (np.where(length > 0.0, length, 1.0) * np.linalg.norm(LIGHT))
    colour = np.clip(BODY_COLOUR * (0.55 + brightness[:, None]), 0.0, 1.0)
    return list(np.column_stack([colour, np.ones(len(colour))]))


def _colour(count: int) -> str:
    return BOUNCE_COLOURS[min(count, len(BOUNCE_COLOURS)) - 1]


def _ray_opacity(segments) -> float:
    return float(np.clip(40.0 / max(1, len(segments)), 0.12, 0.8))


def _draw_perspective(axes, drawing: _Drawing) -> None:
    from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection

    def add(kind, items, order: int, **look) -> None:
        if len(items):  # matplotlib fails on empty 3-D collections
            axes.add_collection3d(kind(items, zorder=order, clip_on=False, **look))

    def add_bodies(order: int, chosen) -> None:
        add(Poly3DCollection, _of_equal_length([drawing.bodies[k] for k in chosen]), order,
            facecolors=np.array([drawing.body_colours[k] for k in chosen]), edgecolors="none")

    add(Poly3DCollection, drawing.mirrors, 1, facecolors=(*MIRROR_COLOUR, 0.25), edgecolors="none")
    add(Line3DCollection, drawing.mirror_edges, 1, colors=(*MIRROR_COLOUR, 0.9), linewidths=0.7)
    add(Line3DCollection, drawing.mirror_cuts, 1, colors=(*MIRROR_COLOUR, 0.9), linewidths=0.7, linestyles=[DASHES])
    # Matplotlib sorts polygons by their middles, by which a wide ground would hide what stands on its farther half.
    for ground in _grounds(drawing):
        add_bodies(1, ground)
    for count, segments in reversed(drawing.segments.items()):
        add(Line3DCollection, segments, 2, colors=_colour(count), linewidths=0.6, alpha=_ray_opacity(segments))
    add_bodies(3, _above_ground(drawing))
    # Matplotlib lays figures out before it projects: it would take the coordinates in m for a place on the page.
    axes.plot(*drawing.radar[:, None], marker="s", color="black", markersize=5, zorder=4, clip_on=False, in_layout=False)
    axes.text(*drawing.radar, f"{RADAR_LABEL}   ", zorder=5, horizontalalignment="right")
    _frame_box(axes, drawing)


def _grounds(drawing: _Drawing) -> list:
    """Indices of the polygons of each ground, from the lowest on: seen from above, none hides what stands on it."""
    return [range(first, last) for _, first, last in sorted(drawing.grounds)]


def _on_grounds(drawing: _Drawing) -> list:
    """Indices of the polygons of all grounds."""
    return list(itertools.chain.from_iterable(_grounds(drawing)))


def _above_ground(drawing: _Drawing) -> list:
    """Indices of the polygons of all other bodies."""
    on_ground = set(_on_grounds(drawing))
    return [k for k in range(len(drawing.bodies)) if k not in on_ground]


def _draw_names_in_perspective(axes, drawing: _Drawing) -> None:
    """Names right above objects, lines higher where others stand, and on mirrors that have room. axes: as large as drawn"""
    from mpl_toolkits.mplot3d.proj3d import proj_transform

    axes.apply_aspect()
    room, line_height = _Room(axes), LINE * NAME_LOOK["fontsize"]

    def seen(place):
        return proj_transform(*place, axes.get_proj())[:2]

    room.line_of(RADAR_LABEL, seen(drawing.radar), RADAR_ASIDE, 1.0)
    tops = {name: (*0.5 * (low + high)[:2], high[2]) for name, (low, high) in drawing.names.items()}
    for name, line in _lines_of(room, {name: seen(top) for name, top in tops.items()}, (0.0, line_height)).items():
        axes.text(*tops[name], short_name(name) + "\n" * (1 + line), zorder=5, horizontalalignment="center",
                  verticalalignment="baseline", path_effects=_halo(), **NAME_LOOK)
    for name, (low, high) in _named_mirrors(drawing).items():
        is_floor = high[2] - low[2] < CUT
        place = low[0] + NAME_PLACE * (high[0] - low[0]), low[1] if is_floor else 0.5 * (low + high)[1], high[2]
        line = room.line_of(name, seen(place), (0.0, 0.0), lines=range(MIRROR_LINES))
        if line is not None:
            axes.text(*place, short_name(name) + "\n" * line, zorder=5, horizontalalignment="center",
                      verticalalignment="baseline", path_effects=_halo(), **MIRROR_NAME_LOOK)


class _Room:
    """Where the names of a view stand, of which none is written over another."""

    def __init__(self, axes):
        self._axes, self._room = axes, Room(LINE * NAME_LOOK["fontsize"])  # in points of the page

    def points(self, place) -> np.ndarray:
        """A place [2] in the coordinates of the axes, in points of the page."""
        return self._axes.transData.transform(place) * POINTS_PER_INCH / self._axes.figure.dpi

    def line_of(self, name: str, place, offset, share: float = 0.5, lines=(0,)) -> int | None:
        """The first of `lines` by which a name may be raised, which then is taken; None where none is free.

        offset: [2] points from the place to the name; share: of its length that stands to the left of there
        """
        (across, height), length = self.points(place) + offset, LETTER * NAME_LOOK["fontsize"] * (len(short_name(name)) + 1)
        left, right, line = across - share * length, across + (1.0 - share) * length, LINE * NAME_LOOK["fontsize"]
        return next((k for k in lines if self._room.take(left, right, height + k * line)), None)


def _lines_of(room: _Room, places: dict, offset) -> dict:
    """{name: by how many lines it is raised}: all of few, from the lowest on; of many the first ones that find room.

    places: {name: place [2] of its object in the coordinates of the axes}; offset: as of `_Room.line_of`
    """
    is_few, raised = len(places) <= FEW_NAMES, {}
    for name in sorted(places, key=lambda name: room.points(places[name])[1]) if is_few else places:
        line = room.line_of(name, places[name], offset, lines=itertools.count() if is_few else range(MOST_RAISED + 1))
        if line is not None:
            raised[name] = line
        if len(raised) == MOST_NAMES:
            break
    return raised


def _halo() -> list:
    from matplotlib.patheffects import withStroke

    return [withStroke(linewidth=2.0, foreground="white")]


def _named_mirrors(drawing: _Drawing) -> dict:
    """Those of the largest."""
    largest = sorted(drawing.mirror_names.items(), key=lambda one: -np.linalg.norm(np.subtract(*one[1])))
    return dict(largest[:MOST_NAMES])


def _zoom(sides) -> float:
    """How large a box of those sides [3] may be drawn: flat ones larger than high ones, whose labels would leave the axes.

    Matplotlib draws all boxes of one diagonal alike at zoom 1, so that each fits from everywhere.
    """
    elevation, azimuth = np.radians((ELEVATION, AZIMUTH))
    across = np.array([-np.sin(azimuth), np.cos(azimuth), 0.0])
    upward = np.array([-np.sin(elevation) * np.cos(azimuth), -np.sin(elevation) * np.sin(azimuth), np.cos(elevation)])
    diagonal, width, height = np.linalg.norm(sides), np.abs(across) @ sides, np.abs(upward) @ sides
    depth = np.abs(np.cross(across, upward)) @ sides
    filled = FILLED / (1.0 + NEARER * depth / diagonal)
    return float(min(MOST_ZOOM, filled * diagonal / height, filled * WIDE * diagonal / width))


def _set_ticks(axis, count: int) -> None:
    """Gives an axis so many round numbers at the most, and no more than eight."""
    from matplotlib.ticker import MaxNLocator

    axis.set_major_locator(MaxNLocator(nbins=min(max(count, 1), 8), steps=(1, 2, 5, 10), min_n_ticks=1 if count < 2 else 2))


def _frame_box(axes, drawing: _Drawing) -> None:
    axes.set_xlim(drawing.low[0], drawing.high[0])
    axes.set_ylim(drawing.low[1], drawing.high[1])
    axes.set_zlim(drawing.low[2], drawing.high[2])
    sides = drawing.high - drawing.low
    zoom = _zoom(sides)
    axes.set_box_aspect(sides, zoom=zoom)
    axes.view_init(elev=ELEVATION, azim=AZIMUTH)
    axes.set_xlabel("x in m")
    axes.set_ylabel("y in m")
    axes.set_zlabel("z in m")
    shares, drawn = sides / sides.max(), sides / np.linalg.norm(sides) * zoom / MOST_ZOOM
    for k, (axis, length) in enumerate(zip((axes.xaxis, axes.yaxis, axes.zaxis), drawn)):
        beside = np.delete(shares, k).max()  # pads count along the other two sides
        axis.labelpad = LABEL_SPACE * max(1.0 / np.sqrt(max(beside, THIN)), np.sqrt(THIN) / beside) - OWN_PAD
        axis.set_tick_params(pad=NUMBER_SPACE * max(1.0, THIN / beside) - OWN_NUMBER_PAD)
        _set_ticks(axis, int(length / TICK_SPACE))
        if length < SHORTEST_AXIS:
            axis.set_ticks([])
            axis.label.set_visible(False)
        axis.pane.set_visible(False)
        axis._axinfo["grid"].update(color=(0.85, 0.85, 0.85), linewidth=0.4)


def _draw_flat(axes, drawing: _Drawing, plane: tuple, title: str) -> None:
    """The scene along an axis: mirrors below the rays, bodies above them."""
    from matplotlib.collections import LineCollection, PolyCollection

    columns = list(plane)
    depth = ({0, 1, 2} - set(plane)).pop()
    mirrors = [polygon[:, columns] for polygon in drawing.mirrors]
    axes.add_collection(PolyCollection(mirrors, facecolors=(*MIRROR_COLOUR, 0.15), edgecolors="none"), autolim=False)
    for edges, style in ((drawing.mirror_edges, "-"), (drawing.mirror_cuts, DASHES)):
        axes.add_collection(LineCollection([edge[:, columns] for edge in edges], colors=MIRROR_COLOUR, linewidths=0.8,
                                           linestyles=[style]), autolim=False)
    for count, segments in reversed(drawing.segments.items()):
        axes.add_collection(LineCollection(segments[:, :, columns], colors=_colour(count), linewidths=0.5,
                                           alpha=_ray_opacity(segments)), autolim=False)
    toward_viewer = 1.0 if depth == 2 else -1.0
    order = np.argsort(toward_viewer * _middles(drawing.bodies, depth), kind="stable")
    if depth == 2:  # the middle of a wide slope lies above what stands at its foot
        order = order[np.argsort(~np.isin(order, _on_grounds(drawing)), kind="stable")]
    bodies = _of_equal_length(drawing.bodies)[order][:, :, columns]
    axes.add_collection(PolyCollection(bodies, facecolors=np.reshape(drawing.body_colours, (-1, 4))[order], edgecolors="face",
                                       linewidths=np.where(_is_edge_on(bodies), 0.8, 0.0)), autolim=False)
    axes.plot(*drawing.radar[columns], marker="s", color="black", markersize=4)
    axes.set_xlim(drawing.low[plane[0]], drawing.high[plane[0]])
    axes.set_ylim(drawing.low[plane[1]], drawing.high[plane[1]])
    axes.set_aspect("equal")
    axes.apply_aspect()
    sides = (drawing.high - drawing.low)[columns]
    for axis, side, room in zip((axes.xaxis, axes.yaxis), sides * min(FLAT_SIZE / sides), FLAT_TICKS):
        _set_ticks(axis, int(side / room))
    axes.set_title(title, pad=TITLE_PAD)
    axes.set_xlabel("xyz"[plane[0]] + " in m")
    axes.set_ylabel("xyz"[plane[1]] + " in m")


def _draw_flat_names(axes, drawing: _Drawing, plane: tuple) -> float:
    """Names of the radar, of mirrors that are seen as lines and, from above, of objects; from the side these would stand on each
    other. Returns how many points of them may stand above the axes."""
    def write(name: str, place, offset: tuple, ha: str, **look) -> None:
        axes.annotate(short_name(name), place, xytext=offset, textcoords="offset points", ha=ha, path_effects=_halo(), **look)

    def below_top(place) -> float:
        return (axes.transAxes.transform((0.0, 1.0)) - axes.transData.transform(place))[1] * POINTS_PER_INCH / axes.figure.dpi

    axes.apply_aspect()
    room, line_height = _Room(axes), LINE * NAME_LOOK["fontsize"]
    top = drawing.high[plane[1]] - 2.0 * drawing.margin  # the title is right above
    above = 0.0
    radar, is_high = drawing.radar[list(plane)], drawing.radar[plane[1]] > top
    aside = (6, -9) if is_high else (0, 5)
    write(RADAR_LABEL, radar, aside, "left" if is_high else "center", **NAME_LOOK)
    room.line_of(RADAR_LABEL, radar, aside, 0.0 if is_high else 0.5)
    tops = {name: (0.5 * (low[0] + high[0]), high[1]) for name, (low, high) in drawing.names.items()} if plane == (0, 1) else {}
    for name, line in _lines_of(room, tops, (0, 3)).items():
        write(name, tops[name], (0, 3 + line * line_height), "center", **NAME_LOOK)
        above = max(above, 3 + (1 + line) * line_height - below_top(tops[name]))
    for name, (low, high) in _named_mirrors(drawing).items():
        place, is_line = (low[plane[0]], high[plane[1]]), high[plane[1]] - low[plane[1]] < CUT
        line = room.line_of(name, place, (4, 2), 0.0, range(MIRROR_LINES)) if is_line else None
        if line is not None:
            write(name, place, (4, 2 + line * line_height), "left", **MIRROR_NAME_LOOK)
            above = max(above, 2 + (1 + line) * line_height - below_top(place))
    return above


def _add_legend(figure, drawing: _Drawing) -> None:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    handles = [Line2D([], [], color=_colour(count), linewidth=1.5, label=f"{count} bounce" + ("s" if count > 1 else ""))
               for count in sorted(drawing.segments)]
    if drawing.mirrors:
        handles.append(Patch(facecolor=(*MIRROR_COLOUR, 0.4), edgecolor=MIRROR_COLOUR, label=MIRROR_LABEL))
    if drawing.mirror_cuts:
        handles.append(Line2D([], [], color=MIRROR_COLOUR, linewidth=1.0, linestyle=DASHES, label=CUT_LABEL))
    figure.legend(handles=handles, loc="outside lower center", ncols=max(1, len(handles)), frameon=False)
