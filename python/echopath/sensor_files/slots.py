"""The chirps of one loop of a frame: their profiles, their differences, and who sends in them."""
from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .. import _core
from .cfg import Command, Lines
from .frames import FramePlan


class TransmitCode(NamedTuple):
    """Who sends when.

    kind: multiplexing; order: indices of the transmitters in their order; slots_of_chirp: slots that make one chirp
    phases: code_phases of "cdm", None of others
    """

    kind: str
    order: tuple
    slots_of_chirp: int
    phases: np.ndarray | None = None

    @property
    def transmitters(self) -> list[int]:
        """Indices, ascending."""
        return sorted(self.order)


class SlotTable:
    """The slots of one loop of a frame.

    lines, plan: of the configuration. Raises ep.FileError naming the line.
    """

    def __init__(self, lines: Lines, plan: FramePlan):
        self._plan, self._bpm = plan, _bpm_of(lines, plan)
        self.chirps = [_chirp_of(lines, plan, plan.first + i) for i in range(plan.num_chirps)]
        self._profiles = [_profile_of(lines, chirp, plan) for chirp in self.chirps]
        self.profile = self._profiles[0]
        for name in ("num_samples", "rate_ksps"):
            for profile in self._profiles:
                if profile[name] != self.profile[name]:
                    raise profile.error(f"{name}: must be {self.profile[name]} as that of line {self.profile.line}, with which "
                                        f"it shares a frame, got {profile[name]}")

    def profiles_of(self, transmitter: int) -> list[Command]:
        """Those of the chirps in which a transmitter, by its index, sends."""
        return [profile for profile, chirp in zip(self._profiles, self.chirps) if chirp["transmitters"] >> transmitter & 1]

    def error(self, text: str) -> Exception:
        """What to raise about the frame."""
        return self._plan.command.error(text)

    def waveform(self, num_chirps: int, real: bool) -> _core.ChirpSequence:
        """The chirps of the frame, with steps where they differ."""
        rate, count = 1e3 * self.profile["rate_ksps"], self.profile["num_samples"]
        slopes = [1e12 * p["slope_mhz_us"] + 1e9 * c["slope_khz_us"] for p, c in zip(self._profiles, self.chirps)]
        starts = [1e9 * p["start_ghz"] + c["start_hz"] + slope * 1e-6 * (p["adc_start_us"] + c["adc_start_us"])
                  for p, c, slope in zip(self._profiles, self.chirps, slopes)]
        idle = [p["idle_us"] + c["idle_us"] for p, c in zip(self._profiles, self.chirps)]
        # From one first sample to the next: the rest of this ramp, the next idle time, the next delay of the converter.
        begin = [p["adc_start_us"] + c["adc_start_us"] for p, c in zip(self._profiles, self.chirps)]
        order = np.roll(np.arange(len(idle)), -1)
        intervals = 1e-6 * np.array([p["ramp_end_us"] - begin[i] + idle[order[i]] + begin[order[i]]
                                     for i, p in enumerate(self._profiles)])
        try:
            return _core.ChirpSequence(start_frequency=starts[0], bandwidth=slopes[0] * count / rate, num_samples=count,
                                       sampling_rate=rate, num_chirps=num_chirps, chirp_interval=float(np.min(intervals)),
                                       real=real, extra_idle=_steps(intervals - np.min(intervals)),
                                       frequency_steps=_steps(np.array(starts) - starts[0]),
                                       bandwidth_steps=_steps((np.array(slopes) - slopes[0]) * count / rate))
        except ValueError as error:
            raise self.profile.error(str(error)) from None

    def transmit_code(self, enabled: list[int]) -> TransmitCode:
        """Who sends in which slot; enabled: indices of the transmitters that are powered."""
        masks = [_mask(chirp, enabled) for chirp in self.chirps]
        if self._bpm is not None:
            return self._signs(masks)
        if all(len(mask) == 1 for mask in masks):
            order = tuple(mask[0] for mask in masks)
            if len(set(order)) == len(order):
                return TransmitCode("tdm", order, len(order))
            if len(set(order)) == 1:
                return TransmitCode("tdm", order[:1], 1)
            raise self.error("its chirps must use one transmitter, or each of some once, in a loop")
        if len(set(masks)) == 1:
            return TransmitCode("cdm", masks[0], 1, np.zeros((len(masks[0]), 1)))
        raise self.error("its chirps must use one transmitter each, or all the same ones")

    def _signs(self, masks) -> TransmitCode:
        if len(masks) != 2 or any(mask != masks[0] or len(mask) != 2 for mask in masks):
            raise self._bpm.error("needs two chirps of the same two transmitters")
        return TransmitCode("bpm", masks[0], 2)


def _steps(values: np.ndarray) -> tuple:
    """Steps of a waveform, () where they vanish but for rounding."""
    return () if np.all(np.abs(values) <= 1e-9 * max(1e-6, float(np.max(np.abs(values))))) else tuple(values.tolist())


def _mask(chirp: Command, enabled: list[int]) -> tuple:
    mask = tuple(bit for bit in range(16) if chirp["transmitters"] >> bit & 1)
    missing = [bit + 1 for bit in mask if bit not in enabled]
    if not mask:
        raise chirp.error("transmitters: must name at least one, got 0")
    if missing:
        raise chirp.error(f"transmitters: {missing[0]} is not enabled by channelCfg")
    return mask


def _chirp_of(lines: Lines, plan: FramePlan, index: int) -> Command:
    for chirp in reversed(lines.of("chirpCfg")):
        if chirp["first"] <= index <= chirp["last"]:
            return chirp
    raise plan.command.error(f"chirp {index}: has no chirpCfg")


def _profile_of(lines: Lines, chirp: Command, plan: FramePlan) -> Command:
    number = chirp["profile"] if plan.forced_profile < 0 else plan.forced_profile
    for profile in reversed(lines.of("profileCfg")):
        if profile["profile"] == number:
            _check_profile(profile, chirp)
            return profile
    raise chirp.error(f"profile: must be that of a profileCfg, got {number}")


def _check_profile(profile: Command, chirp: Command) -> None:
    for name in ("start_ghz", "ramp_end_us", "num_samples", "rate_ksps"):
        if not profile[name] > 0:
            raise profile.error(f"{name}: must be positive, got {profile[name]:g}")
    if profile["slope_mhz_us"] == 0:
        raise profile.error("slope_mhz_us: must not be 0, negative where chirps fall, got 0")
    for name in ("idle_us", "adc_start_us", "gain_db"):
        if profile[name] < 0:
            raise profile.error(f"{name}: must be at least 0, got {profile[name]:g}")
    sampled = profile["adc_start_us"] + chirp["adc_start_us"] + 1e3 * profile["num_samples"] / profile["rate_ksps"]
    if sampled > profile["ramp_end_us"] * (1.0 + 1e-9):
        raise profile.error(f"ramp_end_us: must be at least {sampled:.6g}, where the last sample is taken, got "
                            f"{profile['ramp_end_us']:g}")


def _bpm_of(lines: Lines, plan: FramePlan) -> Command | None:
    found = [command for command in lines.of("bpmCfg") if command["enabled"] and command["subframe"] in (-1, plan.subframe)]
    return found[-1] if found else None
