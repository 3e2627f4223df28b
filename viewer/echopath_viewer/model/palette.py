"""Colours of objects and of their meshes, and of tracks."""
from __future__ import annotations

import colorsys

import numpy as np

from echopath.base.text.mesh_names import object_of
from echopath.plots.style import CURVE_COLOURS

# Paul Tol's "muted" and "light" colours without the greys: told apart with most colour vision.
_PALETTE = ("#cc6677", "#44aa99", "#aa4499", "#999933", "#88ccee", "#117733", "#ddcc77", "#882255", "#332288",
            "#77aadd", "#ee8866", "#eedd88", "#ffaabb", "#99ddff", "#bbcc33", "#aaaa00")
_MIRROR_PALETTE = ("#8ca6cc", "#9cb8a5", "#c4b08c", "#b3a0c4")  # pale: large planes lie behind everything
_SHADE_SPAN = 0.26             # of lightness, between the darkest and the lightest mesh of an object
_LIGHTEST, _DARKEST = 0.86, 0.12
_ROUND_TURN = 0.037            # of the circle of hues, each time that the palette is used up


def objects_of(scene) -> tuple:
    """(names, object of each mesh [M]): the objects of a scene are the children of its root, in order."""
    tops = [object_of(mesh.name) for mesh in scene.meshes]
    names = tuple(dict.fromkeys(tops))
    number = {name: index for index, name in enumerate(names)}
    return names, np.array([number[top] for top in tops], np.int32)


def mesh_palette(scene):
    """A colour for each mesh, u8 [M, 3]: one for each object, its meshes being shades of it, no two alike.

    Objects that are all mirrors, the large planes, have pale ones.
    """
    names, object_of_mesh = objects_of(scene)
    is_mirror = np.array([mesh.material.mirror for mesh in scene.meshes], bool)
    colours, counters = np.zeros((len(is_mirror), 3), np.uint8), {True: 0, False: 0}
    for number in range(len(names)):
        meshes = np.flatnonzero(object_of_mesh == number)
        is_plane = bool(is_mirror[meshes].all())
        base = _base_colour(_MIRROR_PALETTE if is_plane else _PALETTE, counters[is_plane])
        counters[is_plane] += 1
        colours[meshes] = _shades(base, len(meshes))
    return _all_different(colours)


def track_colour(number: int) -> str:
    """That of a track by its number, "#rrggbb": the same in the strip and in the scene."""
    return CURVE_COLOURS[number % len(CURVE_COLOURS)]


def rgb_of(text: str) -> tuple:
    """(r, g, b) of "#rrggbb"."""
    return tuple(int(text[at:at + 2], 16) for at in (1, 3, 5))


def _base_colour(palette: tuple, number: int) -> tuple:
    """(hue, lightness, saturation): of the palette, turned a little for each time that it is used up."""
    hue, lightness, saturation = colorsys.rgb_to_hls(*(value / 255.0 for value in rgb_of(palette[number % len(palette)])))
    turn = number // len(palette)
    lightness = np.clip(lightness + 0.06 * (-1) ** turn * min(turn, 3), _DARKEST, _LIGHTEST)
    return (hue + _ROUND_TURN * turn) % 1.0, lightness, saturation


def _shades(base: tuple, count: int):
    """u8 [count, 3]: one colour, darker and lighter; alone it stays as it is."""
    hue, lightness, saturation = base
    steps = np.linspace(-0.5, 0.5, count) * _SHADE_SPAN if count > 1 else np.zeros(1)
    middle = np.clip(lightness, _DARKEST + 0.5 * _SHADE_SPAN, _LIGHTEST - 0.5 * _SHADE_SPAN) if count > 1 else lightness
    return np.array([[round(255.0 * part) for part in colorsys.hls_to_rgb(hue, middle + step, saturation)] for step in steps],
                    np.uint8)


def _all_different(colours):
    """Moves a colour that is there already by the least step that makes it another one."""
    taken = set()
    for row in colours:
        while tuple(row) in taken:
            at = int(np.argmin(row))
            row[at] += 1
        taken.add(tuple(row))
    return colours
