"""What a rule is: one effect, the fields and settings that ask for it, and how to tell from a case."""
from __future__ import annotations

import dataclasses
from collections.abc import Callable
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..arguments.effects import Choices
from ..arguments.names import MOST_NAMES, first_names
from ..arguments.settings import Edges, FaintPower, Polarization
from ..base.classes.made_by import made_by
from ..base.text.counts import counted
from ..scene.interferers import interferers_of
from ..tracing.polarization import COHERENT_SHARE, chosen_model, coherent_share
from ..weather.weather import weather_of


@made_by("ep.effects")
@dataclasses.dataclass(frozen=True)
class Effect:
    """One effect. name; modelled: whether it is; reason: what in the scene or the settings asks for it, or why not."""

    name: str
    modelled: bool
    reason: str


@dataclasses.dataclass(frozen=True, kw_only=True)
class Settings:
    """How the case is traced and made a signal; names and values as in `trace`, `synthesize` and `simulate`."""

    max_bounces: int
    footprint: str
    polarization: Polarization
    sampler: str
    batches: int
    target_error_db: float | None
    scatterers: str
    edges: Edges
    faint_power: FaintPower
    replay: str
    evaluate: str
    retrace: str
    noise_seed: int | None
    effects: Choices = ()


class Case:
    """A scene, a radar and settings, and the IDs [N] of the meshes that several rules ask for, ascending.

    paths: the trace that was made, None: none yet; statistics: its own, unless given; surroundings: the scene whose weather
    and other radars count, unless `scene` has them; rain_cube, interference_cube: their signals, None: none or none yet
    """

    def __init__(self, scene, radar, settings: Settings, statistics=None, *, paths=None, surroundings=None, rain_cube=None,
                 interference_cube=None):
        around = scene if surroundings is None else surroundings
        self.weather, self.rain_cube = weather_of(around), rain_cube
        self.interferers, self.interference_cube = interferers_of(around), interference_cube
        self._is_of_record = paths is not None and surroundings is None
        self.scene, self.radar, self.settings, self.paths = scene, radar, settings, paths
        self.statistics = statistics or (None if paths is None else paths.frame.statistics)
        self.wavelength = _core.speed_of_light / radar.waveform.start_frequency
        self.materials, self._of_mesh, self._smooth, self._moving, self._deforming = _core.mesh_traits(scene)

    def why_none(self, what: str) -> str:
        """Why there is none of `what` that a scene has beside its meshes: a record keeps neither rain nor other radars."""
        return "a record has none; simulate adds those of a scene" if self._is_of_record else f"the scene has no {what}"

    @cached_property
    def model(self) -> str:
        """Of the polarisation: "scalar" or "jones"."""
        return chosen_model(self.settings.polarization, self.scene, self.wavelength, self.radar, self.time)

    @cached_property
    def time(self) -> float:
        """s, at which rays see the scene."""
        return self.radar.middle_of_frame() if self.paths is None else self.paths.frame.trace_time

    @property
    def num_meshes(self) -> int:
        return len(self._of_mesh)

    def of_material(self, takes: Callable) -> NDArray[np.intp]:
        """Meshes whose material `takes` is true of."""
        return np.flatnonzero(np.array([bool(takes(material)) for material in self.materials], bool)[self._of_mesh])

    @cached_property
    def named_materials(self) -> list[tuple[str, _core.Material]]:
        """(name under which it was given or "", material), each once."""
        found = set(zip((mesh.material_name for mesh in self.scene.meshes), self._of_mesh.tolist()))
        return [(name, self.materials[index]) for name, index in sorted(found)]

    @cached_property
    def mirrors(self) -> NDArray[np.intp]:
        return self.of_material(lambda material: material.mirror)

    @cached_property
    def objects(self) -> NDArray[np.intp]:
        return self.of_material(lambda material: not material.mirror)

    @cached_property
    def coherent(self) -> NDArray[np.intp]:
        """Radiate by physical optics: mirrors do not."""
        return self.of_material(lambda material: not material.mirror and self.share(material) >= COHERENT_SHARE)

    @cached_property
    def diffuse(self) -> NDArray[np.intp]:
        return self.of_material(lambda material: self.share(material) < 1.0)

    @cached_property
    def smooth(self) -> NDArray[np.intp]:
        return np.flatnonzero(self._smooth)

    @cached_property
    def curved(self) -> NDArray[np.intp]:
        """Smooth ones that radiate by physical optics."""
        return self.coherent[self._smooth[self.coherent]]

    @cached_property
    def moving(self) -> NDArray[np.intp]:
        return np.flatnonzero(self._moving)

    @cached_property
    def deforming(self) -> NDArray[np.intp]:
        return np.flatnonzero(self._deforming)

    def share(self, material) -> float:
        """Of the reflected power that keeps its phase."""
        return coherent_share(material, self.wavelength)

    def meshes_or(self, meshes, otherwise: str) -> tuple[bool, str]:
        """(some there?, their count and first names, or `otherwise`)."""
        return len(meshes) > 0, self.named(meshes) if len(meshes) else otherwise

    def named(self, meshes) -> str:
        """Count of meshes and the first of their names."""
        names = first_names(_core.mesh_names(self.scene, meshes[:MOST_NAMES]), len(meshes))
        return f"{counted(len(meshes), 'mesh')}: {names}"


@dataclasses.dataclass(frozen=True)
class Rule:
    """name of the effect; answers_for: "Class.field" and "function.keyword" that ask for it; decide: Case -> (modelled,
    reason)."""

    name: str
    answers_for: tuple
    decide: Callable

    def __call__(self, case: Case) -> Effect:
        modelled, reason = self.decide(case)
        return Effect(self.name, bool(modelled), reason)


RULES: list[Rule] = []

# Fields and keywords that ask for no effect: how much, how long, where, under which name.
QUANTITIES = {
    "Material": (),
    "Antenna": (),
    "AntennaPattern": ("efficiency", "azimuth", "elevation"),
    "ChirpSequence": ("start_frequency", "num_samples", "num_chirps", "chirp_interval", "slope", "chirp_duration",
                      "window_centre", "centre_frequency", "band", "wavelength", "range_resolution", "max_range",
                      "mean_interval", "falls"),
    "Radar": ("waveform", "transmit_power", "frame_duration", "num_slots", "position", "yaw", "pitch"),
    "Node": ("name", "parent", "placement", "mesh", "material", "material_name", "visible", "lifetime"),
    "trace": ("scene", "radar", "num_rays", "seed", "start_time", "max_rays", "settings", "progress"),
    "synthesize": ("paths", "radar", "tolerance", "method", "phase_tolerance", "keyframes", "settings", "progress", "probe"),
}


def rule(name: str, *answers_for: str):
    """Makes a function (Case -> (modelled, reason)) the rule of an effect."""
    def register(decide):
        RULES.append(Rule(name, answers_for, decide))
        return decide

    return register
