"""What a caller of load_model asks of a reader."""
from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

# vertical axis of a file -> the axes of the file that become x (forward), y (left) and z (up): always a rotation, so that
# what faces +z in glTF, whose y is up, faces +x in a scene
AXES = {"z": (0, 1, 2), "y": (2, 0, 1), "x": (1, 2, 0)}


@dataclass(frozen=True)
class ReadOptions:
    """The arguments of load_model as a reader takes them, checked.

    unit: m per unit of the file, None: as the file or its format says; up: "x", "y" or "z", None likewise
    materials: name in the file -> Material or a name in ep.materials; what is not there goes by foreign_materials
    animation: its name; None: the first of the file; "": at rest
    loop: whether it begins anew at its end; offset: s, the time of the animation at time 0 of the scene
    smooth: whether all meshes stand for curved surfaces; None: as the file says
    frequency: Hz, at which materials have their values; None: that of ep.materials
    """

    unit: float | None = None
    up: str | None = None
    materials: Mapping[str, object] = field(default_factory=dict)
    animation: str | None = None
    loop: bool = False
    offset: float = 0.0
    smooth: bool | None = None
    frequency: float | None = None
