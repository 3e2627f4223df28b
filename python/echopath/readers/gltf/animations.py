"""Animations: which curves move which node."""
from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ... import _core
from ...base.text.node_names import fit_name, unique
from ..options import ReadOptions
from ..sampled import Clock, chosen_animation
from .accessors import FLOAT, Accessors
from .document import Document
from .item import Item

POINTER = "KHR_animation_pointer"
PATHS = {"translation": "VEC3", "rotation": "VEC4", "scale": "VEC3", "weights": "SCALAR"}
INTERPOLATIONS = {"LINEAR": "linear", "STEP": "step", "CUBICSPLINE": "hermite"}
SIGNED_OR_UNSIGNED = (5120, 5121, 5122, 5123)


@dataclass(frozen=True)
class Animation:
    """One animation of a file, or rest.

    name: None at rest; curves: {(node, path): Curve}, values as the file has them: rotations (x, y, z, w)
    duration: s, of a run; period: s or None; offset: s, the time of the curves at time 0 of the scene. Those of a loop begin
        with its first key, others with time 0 of the file
    """

    name: str | None = None
    curves: dict = field(default_factory=dict)
    duration: float = 0.0
    period: float | None = None
    offset: float = 0.0


def animation_names(document: Document) -> tuple[str, ...]:
    """Of all animations, each another one."""
    taken: dict[str, int] = {}
    return tuple(unique(fit_name(item["name"].text(""), f"animation_{index}"), taken)
                 for index, item in enumerate(document.json["animations"].objects()))


def read_animation(document: Document, accessors: Accessors, names: tuple, options: ReadOptions) -> Animation:
    """The animation that the caller asks for. A loop goes from its first key to its last: what begins later than at 0 s, as with
    frame 1 of Blender, would else stand still for so long in every run. Raises ValueError for a name that is not there."""
    name = chosen_animation(options, names)
    if name is None:
        return Animation()
    curves = _Channels(document, accessors, document.json["animations"].objects()[names.index(name)]).curves()
    begin = min((float(curve.times[0]) for curve in curves.values()), default=0.0) if options.loop else 0.0
    end = max((float(curve.times[-1]) for curve in curves.values()), default=0.0)
    clock = Clock(options, begin, end)
    curves = {key: curve.replace(times=clock.times(curve.times)) for key, curve in curves.items()}
    return Animation(name, curves, end - begin, clock.period, clock.offset)


class _Channels:
    """The channels of one animation."""

    def __init__(self, document: Document, accessors: Accessors, item: Item):
        self._document, self._accessors, self._item = document, accessors, item
        self._samplers = item["samplers"].objects()
        self._nodes = document.json["nodes"].objects()

    def curves(self) -> dict:
        found: dict = {}
        for channel in self._item["channels"].objects():
            key = self._target(channel["target"])
            if key is None:
                continue
            if key in found:
                self._document.note(f"{channel.place} moves what an earlier channel moves, and is left out")
                continue
            found[key] = self._curve(self._samplers[channel["sampler"].index(len(self._samplers))], key[1])
        return found

    def _target(self, target: Item) -> tuple[int, str] | None:
        """(node, path) of what a channel moves, also where a pointer names it; None, noted, for anything else."""
        path, node = target["path"].text(), target["node"]
        if path == "pointer":
            pointer = target["extensions"][POINTER]["pointer"]
            place, _, path = pointer.text().rpartition("/")
            if not place.startswith("/nodes/") or path not in PATHS:
                self._document.note(f"what animations move by {POINTER} stays at rest, but for nodes and weights of their meshes")
                return None
            number = place.removeprefix("/nodes/")
            node = Item(int(number) if number.isdecimal() and len(number) < 10 else number, pointer.file, pointer.place)
        elif path not in PATHS or not node.is_given:
            self._document.note(f"channels of animations that move '{path}' of no node are left out"[:200])
            return None
        return node.index(len(self._nodes)), path

    def _curve(self, sampler: Item, path: str):
        word = sampler["interpolation"].text("LINEAR")
        if word not in INTERPOLATIONS:
            sampler["interpolation"].must_be("LINEAR, STEP or CUBICSPLINE")
        times = self._accessors.numbers(sampler["input"], "SCALAR", FLOAT)
        values = self._accessors.numbers(sampler["output"], PATHS[path], FLOAT + SIGNED_OR_UNSIGNED)
        rows = len(times) * (3 if word == "CUBICSPLINE" else 1)
        if len(values) % rows or (path != "weights" and len(values) != rows):
            sampler["output"].fail(f"must have {rows} entries for {len(times)} times, has {len(values)}")
        return self._made(sampler, times, values.reshape(rows, -1), INTERPOLATIONS[word])

    def _made(self, sampler: Item, times: np.ndarray, values: np.ndarray, interpolation: str):
        steps = np.diff(times)
        if (steps < 0.0).any():
            at = int(np.flatnonzero(steps < 0.0)[0])
            sampler["input"].fail(f"must ascend, falls from {times[at]:g} to {times[at + 1]:g} s")
        if times[-1] > 1e9 or times[0] < -1e9:
            sampler["input"].fail("must lie within 1e9 s")
        kept = np.append(steps > 0.0, True)
        if not kept.all():
            self._document.note("of keys at the same time the last one counts")
        tangents = {}
        if interpolation == "hermite":
            tangents = {"in_tangents": values[0::3][kept], "out_tangents": values[2::3][kept]}
            values = values[1::3]
        return _core.Curve(times[kept], values[kept], interpolation, **tangents)
