"""The keys of a scene file: one class per table, units in the description of each field.

Strict: unknown keys, numbers given as text and non-finite numbers are errors. Lengths in m, times in s, angles in
degrees only where the key says so (`yaw_deg`).
"""
from __future__ import annotations

from typing import Annotated

from pydantic import Discriminator, Field, Tag

from ...signals.parts import are_tables
from .object_tables import ObjectTable
from .radar_tables import InterfererTable, RadarTable
from .run_tables import (
    AngleTable,
    DetectionsTable,
    LabelsTable,
    NoiseTable,
    ReplayTable,
    SequenceTable,
    SpectrumTable,
    TraceTable,
    TruthTable,
    WeatherTable,
)
from .table import Name, Table, by_check
from .traffic_tables import TrafficTable

PartsValue = Annotated[
    Annotated[dict[Name, str], Tag("<partition>")] | Annotated[str, Tag("<expression>")],
    Discriminator(lambda value: "<partition>" if isinstance(value, dict) else "<expression>")]


def _one_kind_of_parts(argument: str, value: dict) -> dict:
    are_tables(value, called=argument)
    return value


class SceneTable(Table):
    title: str = Field("", description="one line about the scene")
    guard: bool = Field(True, description="whether a run is held against slower ways at a few random places")
    adapt_materials: bool = Field(False, description="whether materials by name have their values at the radar's frequency")
    mark_mirrors: bool = Field(False, description="whether meshes of planes larger than their Fresnel zone become mirrors")
    radar: RadarTable
    objects: list[ObjectTable] = Field([], description="in the order of their mesh IDs")
    traffic: list[TrafficTable] = Field([], description="files of trajectories, whose objects come behind the others")
    weather: WeatherTable | None = Field(None, description="air, fog and rain; none: empty space")
    interferers: list[InterfererTable] = Field([], description="other radars that send into the receivers")
    trace: TraceTable = TraceTable()
    replay: ReplayTable = ReplayTable()
    spectrum: SpectrumTable = SpectrumTable()
    angle: AngleTable = AngleTable()
    noise: NoiseTable = NoiseTable()
    parts: Annotated[dict[Name, PartsValue], by_check(_one_kind_of_parts)] = Field(
        {}, description="name = path expression: one partition; tables of these: several")
    labels: LabelsTable | None = Field(None, description="labels of the map; none: they are not made")
    detections: DetectionsTable | None = Field(None, description="detections in the map; none: they are not made")
    truth: TruthTable | None = Field(None, description="place, motion and box of each object; none: not kept")
    sequence: SequenceTable | None = Field(None, description="frames in time; none: one frame")

