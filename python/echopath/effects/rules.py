"""What a rule is: one effect, the fields and settings that ask for it, and how to tell from a case."""
from __future__ import annotations

import dataclasses
from collections.abc import Callable
from functools import cached_property

from .. import _core
from ..names import first_names
from ..polarization import COHERENT_SHARE, antennas_of, chosen_model, coherent_share


@dataclasses.dataclass(frozen=True)
class Effect:
    """One effect. name; modelled: whether it is; reason: what in the scene or the settings asks for it, or why not."""

    name: str
    modelled: bool
    reason: str


@dataclasses.dataclass(frozen=True)
class Settings:
    """How the case is traced and made a signal; names and values as in `trace`, `synthesize` and `simulate`."""

    max_bounces: int
    footprint: str
    polarization: str
    sampler: str
    batches: int
    target_error_db: float | None
    scatterers: str
    replay: str
    evaluate: str
    retrace: str
    noise_seed: int | None


class Case:
    """A scene, a radar and settings, and the meshes that several rules ask for; statistics: of the trace that was made,
    None: none yet."""

    def __init__(self, scene, radar, settings: Settings, statistics=None):
        self.scene, self.radar, self.settings, self.statistics = scene, radar, settings, statistics
        self.wavelength = _core.speed_of_light / radar.waveform.start_frequency
        self.meshes, self.nodes = list(scene.meshes), scene.nodes

    @cached_property
    def model(self) -> str:
        """Of the polarisation: "scalar" or "jones"."""
        return chosen_model(self.settings.polarization, self.scene, self.wavelength, antennas_of(self.radar),
                            argument="polarization")

    @cached_property
    def mirrors(self) -> list:
        return [mesh for mesh in self.meshes if mesh.material.mirror]

    @cached_property
    def objects(self) -> list:
        return [mesh for mesh in self.meshes if not mesh.material.mirror]

    @cached_property
    def coherent(self) -> list:
        """Radiate by physical optics: mirrors do not."""
        return [mesh for mesh in self.objects if self.share(mesh) >= COHERENT_SHARE]

    @cached_property
    def diffuse(self) -> list:
        return [mesh for mesh in self.meshes if self.share(mesh) < 1.0]

    @cached_property
    def smooth(self) -> list:
        return [mesh for mesh in self.meshes if self.nodes[mesh.node].smooth]

    @cached_property
    def moving(self) -> list:
        return [mesh for mesh in self.meshes if self.scene.is_moving(mesh.id)]

    def share(self, mesh) -> float:
        """Of the reflected power that keeps its phase."""
        return coherent_share(mesh.material, self.wavelength)


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
                      "window_centre", "centre_frequency", "wavelength", "range_resolution", "max_range"),
    "Radar": ("waveform", "transmit_power", "frame_duration", "position", "yaw", "pitch"),
    "Node": ("name", "parent", "placement", "mesh", "material", "material_name", "visible"),
    "trace": ("scene", "radar", "num_rays", "seed", "start_time", "max_rays", "settings", "progress"),
    "synthesize": ("paths", "radar", "tolerance", "method", "phase_tolerance", "keyframes", "settings", "progress", "probe"),
}


def rule(name: str, *answers_for: str):
    """Makes a function (Case -> (modelled, reason)) the rule of an effect."""
    def register(decide):
        RULES.append(Rule(name, answers_for, decide))
        return decide

    return register


def meshes_or(meshes, otherwise: str):
    """(some there?, their count and first names, or `otherwise`)."""
    return bool(meshes), named(meshes) if meshes else otherwise


def named(meshes) -> str:
    """Count of meshes and the first of their names."""
    return f"{len(meshes)} mesh{'es' * (len(meshes) > 1)}: {first_names(mesh.name for mesh in meshes)}"
