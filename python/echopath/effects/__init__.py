"""Which effects a run models, which it leaves out, and why."""
from __future__ import annotations

from .. import _core
from ..arguments.checks import checked
from ..arguments.effects import Choices
from ..arguments.settings import (
    Edges,
    Evaluate,
    FaintPower,
    Footprint,
    Polarization,
    Replay,
    Retrace,
    Sampler,
    Scatterers,
    SignalSettings,
    TraceSettings,
)
from . import interference, materials, motion, radar, sampling, surfaces, weather  # each adds its rules, in this order
from .rules import RULES, Case, Effect, Settings

# What no scene and no setting can ask for.
OUT_OF_SCOPE = [
    Effect("creeping waves", False, "out of scope"),
    Effect("diffraction into shadows", False,
           "not modelled by traces: ep.around_corners tells its power, ep.synthesize_around_corners its signal"),
]


class Effects(list):
    """A list of Effect, which prints a line for each and which notebooks show as a table."""

    def __repr__(self) -> str:
        modelled = sum(effect.modelled for effect in self)
        width = max((len(effect.name) for effect in self), default=0)
        lines = [f"{'yes' if effect.modelled else 'no':3} {effect.name:{width}} {effect.reason}" for effect in self]
        return "\n".join([f"Effects: {modelled} of {len(self)} modelled", *lines])

    def _repr_html_(self) -> str:
        from ..presentation.notebook import effects_html

        return effects_html(self)


@checked(**TraceSettings.RULES, **SignalSettings.RULES)
def effects(scene: _core.Scene, radar: _core.Radar, *, max_bounces: int = TraceSettings.max_bounces,  # noqa: F811
            footprint: Footprint = TraceSettings.footprint, polarization: Polarization = TraceSettings.polarization,
            sampler: Sampler = TraceSettings.sampler, batches: int | None = TraceSettings.batches,
            target_error_db: float | None = TraceSettings.target_error_db,
            scatterers: Scatterers = TraceSettings.scatterers, edges: Edges = TraceSettings.edges,
            faint_power: FaintPower = TraceSettings.faint_power,
            replay: Replay = SignalSettings.replay, evaluate: Evaluate = SignalSettings.evaluate,
            retrace: Retrace = SignalSettings.retrace, noise_seed: int | None = None,
            effects: Choices = TraceSettings.effects) -> Effects:
    """Which effects a run of `scene` with `radar` models, and why.

    max_bounces, footprint, polarization, sampler, batches, target_error_db (dB), scatterers, edges, faint_power (W), effects:
    as in `trace`; replay, evaluate, retrace: as in `synthesize`; noise_seed: as in `simulate`. Returns a list [E] of Effect,
    modelled ones first. Effects that nothing can ask for stand last, under reasons that begin with "out of scope" or "not
    modelled". Raises TypeError or ValueError naming the argument.
    """
    settings = Settings(max_bounces=max_bounces, footprint=footprint, polarization=polarization, sampler=sampler,
                        batches=batches or 1, target_error_db=target_error_db, scatterers=scatterers, edges=edges,
                        faint_power=faint_power, replay=replay, evaluate=evaluate, retrace=retrace, noise_seed=noise_seed,
                        effects=effects)
    return _of_case(Case(scene, radar, settings))


def of_paths(paths, *, replay: Replay = SignalSettings.replay, evaluate: Evaluate = SignalSettings.evaluate,
             retrace: Retrace = SignalSettings.retrace, noise_seed: int | None = None, effects: Choices = (),
             surroundings=None, rain_cube=None, interference_cube=None) -> Effects:
    """The effects of a trace, from the scene, radar and settings that it recorded and what it left out; replay, evaluate,
    retrace, noise_seed, rain_cube, interference_cube: of later stages; surroundings: the scene whose weather and other radars
    they had."""
    frame = paths.frame
    settings = Settings(max_bounces=frame.max_bounces, footprint=frame.footprint, polarization=frame.polarization,
                        sampler=frame.sampler, batches=frame.num_batches, target_error_db=frame.target_error_db or None,
                        scatterers=frame.scatterers, edges=frame.edges, faint_power=frame.faint_power, replay=replay,
                        evaluate=evaluate, retrace=retrace, noise_seed=noise_seed, effects=effects)
    return _of_case(Case(paths.scene, paths.radar, settings, paths=paths, surroundings=surroundings, rain_cube=rain_cube,
                         interference_cube=interference_cube))


def _of_case(case: Case) -> Effects:
    found = [rule(case) for rule in RULES]
    return Effects([*sorted(found, key=lambda effect: not effect.modelled), *OUT_OF_SCOPE])

