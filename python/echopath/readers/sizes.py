"""How large a model is, and whether its unit seems to be another one."""
from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np

from .. import _core
from ..base.text.lengths import length_text

if TYPE_CHECKING:
    from .model import Model

# what a name tells: words of it, and how large such a thing is at its largest, m
_SIZES = {
    "a person": (("person", "people", "human", "pedestrian", "walker", "man", "woman", "boy", "girl", "child", "character",
                  "soldier"), 0.5, 2.6),
    "a bicycle": (("bike", "bicycle", "cyclist", "motorcycle", "motorbike", "scooter"), 0.8, 3.5),
    "an animal": (("animal", "dog", "cat", "fox", "wolf", "deer", "horse", "cow", "sheep", "goat", "pig", "boar"), 0.15, 4.0),
    "a vehicle": (("car", "vehicle", "sedan", "suv", "taxi", "van", "truck", "bus", "lorry", "jeep", "pickup",
                   "chassis"), 1.5, 25.0),
}
# words that make a place or a sign of such a thing, whose size tells nothing: a dog house, a bus stop, a car park
_PLACES = {"house", "home", "kennel", "stop", "station", "park", "lot", "garage", "port", "wash", "lane", "path", "way", "track",
           "crossing", "bridge", "sign", "rack", "stand", "shelter", "shed", "stable", "barn", "pen", "hole"}
_KNOWN = {word for known, _, _ in _SIZES.values() for word in known}
# words of what stands about such things in a scene, which is as large as it likes
_SURROUNDINGS = {"ground", "terrain", "road", "street", "pavement", "sidewalk", "house", "houses", "building", "buildings",
                 "town", "city", "village", "forest", "sky"}
_ENCLOSURES = {"wall", "walls", "floor", "ceiling"}  # the same, in a room, too
# words of a room, whatever else is named in it; what ends otherwise, as an office chair or a tower of offices, is none itself
_ROOMS = {"room", "bedroom", "bathroom", "livingroom", "classroom", "kitchen", "office", "apartment", "corridor"}
_ROOM = ("a room", 1.0, 200.0)
_UNITS = {"mm": 1e-3, "cm": 1e-2, "inches": 0.0254, "feet": 0.3048, "m": 1.0, "km": 1e3}  # m
SMALLEST, LARGEST = 0.02, 5e4  # m, of anything that a radar looks at
_FIGURE, _BODY = ("a figure with a skeleton", 0.05, 10.0), ("a single body", SMALLEST, 500.0)
_NAMED = 12                    # topmost nodes of a model whose names are looked at


def figure_doubt(model: Model, stem: str) -> str | None:
    """`unit_doubt` of what skeletons move in a model, as bodies of people and animals; None where they move nothing.

    stem: of the name of its file
    """
    size = np.ptp(_points_of_skins(model), axis=0) if has_skin(model) else np.zeros(3)
    return unit_doubt(float(size.max()), model.unit, names_of(model, stem), is_figure=True)


def has_skin(model: Model) -> bool:
    """Whether a skeleton moves any of its meshes."""
    return any(isinstance(node.deformation, _core.Skin) for node in model.nodes)


def names_of(model: Model, stem: str) -> list[str]:
    """What may say what a model is: its file's name without the suffix, `stem`, and those of its topmost nodes."""
    return [stem, *[node.name for node in model.nodes if node.parent < 0][:_NAMED]]


def _points_of_skins(model: Model) -> np.ndarray:
    """Vertices [N, 3] in m at time 0, or the nearest of their animation, as the model stands at rest."""
    placements, points = [], []
    for node in model.nodes:
        own = np.eye(4) if node.placement is None else node.placement
        placements.append(own if node.parent < 0 else placements[node.parent] @ own)
        if isinstance(node.deformation, _core.Skin):
            at = node.deformation.at(float(np.clip(0.0, *node.deformation.span)))
            points.append(at @ placements[-1][:3, :3].T + placements[-1][:3, 3])
    return np.concatenate(points)


def unit_doubt(extent: float, unit: float, names: list[str], is_figure: bool = False, is_body: bool = False) -> str | None:
    """What to say of a model of that greatest extent in m, None where nothing speaks against its unit.

    unit: m per unit of its file; names: of the file and of its topmost objects, which may say what it is
    is_figure: whether it has a skeleton; is_body: whether it is one mesh alone, and no terrain
    """
    usual = _FIGURE if is_figure else _BODY if is_body else ("a scene", SMALLEST, LARGEST)
    named = _expected(names)
    what, least, most = usual if named is None or (is_figure and named is _ROOM) else named  # figures are smaller than their room
    if extent == 0.0 or least <= extent <= most:
        return None
    fits = [f"unit={value:g} ({name})" for name, value in _UNITS.items() if least <= extent / unit * value <= most]
    advice = f"; with {' or '.join(fits)} it would be right" if fits else "; unit tells how long a unit of the file is, in m"
    return f"{what} of {length_text(extent)} is hardly right{advice}"


def _expected(names: list[str]) -> tuple[str, float, float] | None:
    """(what it is, least and greatest extent in m) by the names; None: these do not say."""
    in_order = [[word.lower() for word in re.findall(r"[A-Z]?[a-z]+|[A-Z]+", name)] for name in names]
    words_of_names = [set(words) for words in in_order]
    surroundings = set().union(*(words for words in words_of_names if not words & _KNOWN))
    if surroundings & _SURROUNDINGS:
        return None
    if surroundings & _ROOMS:
        return _ROOM if any(_ROOMS.intersection(words[-1:]) for words in in_order) else None
    if surroundings & _ENCLOSURES:
        return None
    for words in words_of_names:
        for what, (known, least, most) in _SIZES.items():
            if words & set(known) and not words & _PLACES:
                return what, least, most
    return None
