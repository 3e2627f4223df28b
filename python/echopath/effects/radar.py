"""Effects of antennas, waveform and receiver."""
from __future__ import annotations

import math

import numpy as np

from .. import _core
from ..base.radar.antennas import antennas_of, are_crossed
from ..base.text.counts import counted
from ..tracing.polarization import FIELD_VECTORS, need_of_field_vectors
from .rules import Case, rule

TOLD_TURN = math.radians(2.0)  # of the radar within a frame, from which on it is told
TURN_STEPS = 65
TOLD_LEVELS_DB = 0.5  # by which the square of the wavelength falls over the band, from which on it is told


@rule("antenna patterns", "Antenna.pattern", "Antenna.orientation", "Antenna.yaw", "Antenna.pitch", "AntennaPattern.kind",
      "AntennaPattern.peak_gain", "AntennaPattern.exponent")
def _patterns(case: Case):
    shaped = sorted({antenna.pattern.kind for antenna in antennas_of(case.radar)} - {"isotropic"})
    if not shaped:
        return False, "all antennas are isotropic"
    turned = _turned_within_frame(case)
    if turned < TOLD_TURN:
        return True, ", ".join(shaped)
    return True, (f"{', '.join(shaped)}; beams turn by {np.degrees(turned):.3g} degrees within the frame: rays, mean powers, "
                  "labels and truth are those of its middle")


def _turned_within_frame(case: Case) -> float:
    """Angle in rad by which the radar turns from the first chirp to the last, back and forth counted both ways."""
    if case.radar.motion is None:
        return 0.0
    half = 0.5 * case.radar.frame_duration
    axes = [case.radar.world_from_radar(time)[:3, :3] for time in np.linspace(case.time - half, case.time + half, TURN_STEPS)]
    turns = np.einsum("nij,nij->n", axes[:-1], axes[1:])  # 1 + 2 cos of the angle of each step
    return float(np.sum(np.arccos(np.clip(0.5 * (turns - 1.0), -1.0, 1.0))))


@rule("gain tables", "AntennaPattern.table_gain")
def _tables(case: Case):
    count = sum(antenna.pattern.kind == "table" for antenna in antennas_of(case.radar))
    return count > 0, f"of {counted(count, 'antenna')}" if count else "no pattern is a table"


@rule("antenna phases", "AntennaPattern.table_phase")
def _phases(case: Case):
    phased = any(antenna.pattern.table_phase is not None for antenna in antennas_of(case.radar))
    return phased, "phase of a table" if phased else "no pattern has a phase"


@rule("array from one set of rays", "Antenna.position", "Radar.receivers")
def _array(case: Case):
    counts = len(case.radar.transmitters), len(case.radar.receivers)
    if max(counts) == 1:
        return False, "one transmitter, one receiver"
    return True, f"{counts[0]} x {counts[1]} channels; each path is replayed for each"


@rule("transmitters take turns (TDM)", "Radar.transmitters", "Radar.multiplexing")
def _turns(case: Case):
    count = len(case.radar.transmitters)
    if case.radar.multiplexing != "tdm":
        return False, "they send at once"
    return count > 1, counted(count, "transmitter")


@rule("transmitters send at once by a code", "Radar.empty_slots", "Radar.code_phases")
def _codes(case: Case):
    kind = case.radar.multiplexing
    if kind != "tdm":
        return True, kind
    return False, "they take turns" if len(case.radar.transmitters) > 1 else "one transmitter"


@rule("chirps that differ within a frame", "ChirpSequence.extra_idle", "ChirpSequence.frequency_steps",
      "ChirpSequence.bandwidth_steps")
def _steps(case: Case):
    names = [name for name in ("extra_idle", "frequency_steps", "bandwidth_steps") if getattr(case.radar.waveform, name)]
    return bool(names), ", ".join(names) or "all chirps are alike"


@rule("levels that follow the wavelength over the band", "ChirpSequence.bandwidth")
def _levels(case: Case):
    lowest, highest = case.radar.waveform.band
    fall = 20.0 * math.log10(highest / lowest)
    if fall < TOLD_LEVELS_DB:
        return True, f"the square of the wavelength falls by {fall:.2g} dB from its lowest to its highest frequency"
    return False, ("rough surfaces and planes by images send as at the start of the first chirp all over the band, over which "
                   f"antennas lose {fall:.1f} dB; physical optics follows the wavelength")


@rule("faults of the receiver", "Radar.receiver")
def _receiver(case: Case):
    if case.radar.receiver is None:
        return False, "no Receiver is given: it is ideal but for its noise"
    return True, ", ".join(case.radar.receiver.plain()) or "all are off"


@rule("polarised fields", "trace.polarization", "Antenna.polarization")
def _polarization(case: Case):
    need = need_of_field_vectors(case.scene, case.wavelength, case.radar, case.time)
    if case.model == FIELD_VECTORS:
        return True, need or 'polarization = "jones"'
    reason = "each hit takes the TE or TM coefficient nearer to the polarization"
    if are_crossed(antennas_of(case.radar)):
        reason += '; antennas of other polarisation count as co-polarised: polarization = "jones" tells them apart'
    elif need:
        reason += f'; polarization = "jones" would follow the fields of {need}'
    return False, reason


@rule("depolarisation by roughness", "Material.cross_polarization")
def _depolarisation(case: Case):
    if case.model != FIELD_VECTORS:
        return False, "traced with one coefficient a hit"
    turning = case.of_material(lambda material: case.share(material) < 1.0 and material.cross_polarization > 0.0)
    return case.meshes_or(turning, "no rough material has a cross_polarization")


@rule("residual video phase", "ChirpSequence.bandwidth")
def _video_phase(case: Case):
    return True, "always: it costs nothing"


@rule("anti-alias filter", "ChirpSequence.sampling_rate")
def _filter(case: Case):
    waveform = case.radar.waveform
    reason = f"always: echoes beyond {waveform.max_range:.4g} m are cut off"
    next_chirp = 0.5 * _core.speed_of_light * waveform.chirp_interval   # m, whose echoes come when it begins
    if next_chirp < waveform.max_range:
        reason += f"; those from beyond {next_chirp:.4g} m, which meet the next chirp, stay in their own"
    return True, reason


@rule("real samples", "ChirpSequence.real")
def _real(case: Case):
    return case.radar.waveform.real, "real = true" if case.radar.waveform.real else "complex samples"


@rule("thermal noise", "Radar.noise_figure_db")
def _noise(case: Case):
    seed = case.settings.noise_seed
    if seed is None:
        return False, "not part of paths and parts; add_noise or noise_seed add it to the whole"
    return True, f"noise figure {case.radar.noise_figure_db:g} dB, on the whole; noise_seed = {seed}"
