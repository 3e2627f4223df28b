"""What a scene file says."""
from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypedDict

import numpy as np

from .._core import Selection
from ..arguments.objects import Objects
from ..arguments.settings import LabelSettings, SignalSettings, TraceSettings
from ..base.classes.made_by import made_by
from ..signals.parts import Selections, as_partitions

if TYPE_CHECKING:
    from .. import _core
    from ..scene.scene import Scene
    from .tables.run_tables import AngleTable, DetectionsTable, SequenceTable, TruthTable


class SimulateKeywords(TypedDict):
    """Keywords of `ep.simulate` and `ep.Sequence` that a scene file gives; angles in rad."""

    trace: TraceSettings
    signal: SignalSettings
    parts: Selections
    angles: dict[str, object]
    labels: LabelSettings | None
    detections: dict[str, object] | None
    truth: dict[str, object] | None
    guard: bool


@made_by("ep.load_scene")
@dataclasses.dataclass(frozen=True, repr=False)
class SceneFile:
    """What a scene file says.

    path: of the file; title: one line; scene, radar: ready to trace, radar None of a foreign scene, which has none; parts:
    {name: expression} (one partition), {name: {name: expression}} (several) or {}; trace: TraceSettings, signal:
    SignalSettings, labels: LabelSettings or None: none are asked for; angle, detections, truth: tables of the file, as keywords
    by `angle_settings()`, `detection_settings()` and `truth_settings()`; guard: of `ep.simulate`; sequence: table of the file
    (frames, interval in s, keep), None: one frame.
    """

    path: Path
    title: str
    scene: Scene
    radar: _core.Radar | Any  # None of a foreign scene
    trace: TraceSettings
    signal: SignalSettings
    angle: AngleTable
    parts: Selections
    labels: LabelSettings | None = None
    detections: DetectionsTable | None = None
    guard: bool = True
    sequence: SequenceTable | None = None
    truth: TruthTable | None = None

    def __repr__(self) -> str:
        asked = ("labels", "detections", "truth", "sequence")
        return ", ".join([f"SceneFile({self.path.name!r}", repr(self.scene), *(["no radar"] if self.radar is None else []),
                          *(["parts"] if self.parts else []), *(one for one in asked if getattr(self, one) is not None)]) + ")"

    def angle_settings(self) -> dict[str, object]:
        """Keywords of `ep.range_azimuth`, angles in rad; those without a value are left out."""
        settings = self.angle.model_dump(exclude={"azimuth_deg", "elevation_deg"}, exclude_none=True)
        settings["elevation"] = np.radians(self.angle.elevation_deg).tolist()
        if self.angle.azimuth_deg is not None:
            first, last, step = self.angle.azimuth_deg
            settings["azimuth"] = np.radians(first + step * np.arange(math.floor((last - first) / step + 1e-9) + 1)).tolist()
        return settings

    def detection_settings(self) -> dict[str, object] | None:
        """`detections` of `ep.simulate`: keywords of `ep.detect_frame`, None: no detections."""
        if self.detections is None:
            return None
        return self.detections.model_dump() | {"objects": self.label_objects()}

    def label_objects(self) -> Objects:
        """The objects that the labels of the file name, as in `families`; None: it names none."""
        return None if self.labels is None else self.labels.objects

    def truth_settings(self) -> dict[str, object] | None:
        """`truth` of `ep.simulate`: keywords of `ep.truth`, None: not asked for."""
        return None if self.truth is None else self.truth.model_dump(exclude_none=True)

    def keywords(self) -> SimulateKeywords:
        """Keywords of `ep.simulate` and `ep.Sequence`."""
        return SimulateKeywords(trace=self.trace, signal=self.signal, parts=self.partitions(), angles=self.angle_settings(),
                                labels=self.labels, detections=self.detection_settings(), truth=self.truth_settings(),
                                guard=self.guard)

    def partitions(self) -> dict[str, Mapping[str, Selection | str]]:
        """`parts` as {partition: {name: expression}}."""
        return as_partitions(self.parts)
