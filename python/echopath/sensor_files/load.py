"""From a mmWave configuration to the radar that it sets up."""
from __future__ import annotations

import dataclasses
import os
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from .. import _core
from ..arguments.checks import ArrayLike, array, checked, count as count_rule, flag, optional, refused, text
from ..base.classes.made_by import made_by
from ..base.process.callers import warn_user
from ..receiver import Adc, Receiver
from .boards import Board, board_names, board_of_platform, read_board
from .cfg import Command, Lines, read_lines
from .frames import FramePlan, plans_of
from .slots import SlotTable
from .transmitters import chain_settings

if TYPE_CHECKING:
    from ..sequence.sequence import Sequence

# Hz, corners of the two high-pass filters by their codes (mmWave SDK, profileCfg).
HIGH_PASS_1, HIGH_PASS_2 = (175e3, 235e3, 350e3, 700e3), (350e3, 700e3, 1.4e6, 2.8e6)
BITS = (12, 14, 16)
_RF_GAIN_BITS = 0x3F  # of the gain; what is above tells how it is shared


@made_by("ep.load_sensor")
@dataclasses.dataclass(frozen=True)
class SensorConfig:
    """What a mmWave configuration sets up.

    radars: Radar of each sub-frame in their order, one of a plain frame; start_times: s, of each after the frame's start
    interval: s, from frame to frame; num_frames: 0: without end
    board: name of the board whose antennas they have; ignored: names of the commands that say nothing of the signal, or
        nothing that is known
    """

    radars: tuple[_core.Radar, ...]
    start_times: tuple[float, ...]
    interval: float
    num_frames: int
    board: str
    ignored: tuple[str, ...]

    def replace(self, **changes: object) -> SensorConfig:
        """A copy whose radars have other values. changes: keywords of Radar, such as position in m, for all of them.

        Raises TypeError or ValueError naming the keyword.
        """
        return dataclasses.replace(self, radars=tuple(radar.replace(**changes) for radar in self.radars))

    def sequences(self, scene: _core.Scene, *, frames: int | None = None, start_time: float = 0.0,
                  times: ArrayLike | None = None, settings: Mapping[str, object] | None = None) -> tuple[Sequence, ...]:
        """A Sequence of each sub-frame, one of a plain frame: frame after frame at the sensor's interval, or when a recording's
        began.

        scene: of the frames; frames: their number; start_time: s, of the first
        times: [K] s, in the place of both: the start of each frame, as of `Sequence`
        settings: {keyword of Sequence: value}, the same for all, None: as it is
        `ep.save_raw(itertools.chain.from_iterable(zip(*sequences)), path)` writes them as the sensor sends them. Raises what
        Sequence raises.
        """
        from ..sequence.sequence import Sequence

        def timing(begin: float) -> dict:
            even = {"frames": frames, "start_time": start_time}
            if times is None:
                return even | {"interval": self.interval, "start_time": start_time + begin}
            return even | {"times": array("[K]", finite=True)("times", times) + begin}

        return tuple(Sequence(scene, radar, **timing(begin), **(settings or {}))
                     for radar, begin in zip(self.radars, self.start_times))


@checked(board=optional(text), ideal=flag)
def load_sensor(path: str | os.PathLike[str], board: str | None = None, *, ideal: bool = False) -> SensorConfig:
    """Reads the configuration of a TI mmWave sensor (.cfg): all of its sub-frames.

    The commands profileCfg, chirpCfg, frameCfg, advFrameCfg, subFrameCfg, channelCfg, adcCfg, bpmCfg and dfeDataOutputMode
    count, and of adcbufCfg and lvdsStreamCfg which of I and Q comes first where the sensor streams its samples itself; `ignored`
    names the others. Transmitters that take turns make "tdm", two by bpmCfg "bpm". start_frequency is that of
    the first sample. Chirps that differ in start frequency, slope or idle time become steps of the waveform; back-off and phase
    shifters of the profiles become gains and phases of the transmitters; those that change from chirp to chirp are refused.
    path: of the file
    board: "IWR1443", "AWR1843", "IWR6843ISK", "IWR6843AOP" or "AWR2243_cascade"; None: as the file's line "Platform" says
    ideal: without the filters and the converter that the file describes
    Returns a SensorConfig. Raises ep.FileError naming the line, ValueError for boards. Warns (RuntimeWarning) of chirps beyond
    the band of the board.
    """
    lines = read_lines(Path(path))
    plans = plans_of(lines)
    chosen = _board(lines, board)
    radars = tuple(_radar(lines, chosen, plan, ideal) for plan in plans)
    return SensorConfig(radars, tuple(plan.start_time for plan in plans), plans[0].interval, plans[0].num_frames, chosen.name,
                        lines.others)


@checked(board=optional(text), subframe=count_rule(), ideal=flag)
def load_radar(path: str | os.PathLike[str], board: str | None = None, *, subframe: int = 0,
               ideal: bool = False) -> _core.Radar:
    """The radar of the configuration of a TI mmWave sensor (.cfg), with the antennas of its board.

    path, board, ideal: as in `load_sensor`, which reads all sub-frames
    subframe: index of the sub-frame, 0 of a plain frame
    Returns a Radar at the origin that looks along +x, its antennas in m as the board has them; `replace` places it. Raises
    ep.FileError naming the line, ValueError for boards and sub-frames that are unknown. Warns (RuntimeWarning) of chirps beyond
    the band of the board.
    """
    radars = load_sensor(path, board, ideal=ideal).radars
    if subframe >= len(radars):
        raise refused(ValueError, "subframe", f"below {len(radars)}, the number of sub-frames", subframe)
    return radars[subframe]


def _board(lines: Lines, name: str | None) -> Board:
    if name is not None:
        return read_board(name)
    board = board_of_platform(lines.platform)
    if board is None:
        said = f"'{lines.platform}'" if lines.platform else "nothing"
        raise ValueError(f"board: must be given, one of {', '.join(board_names())}: the file says {said} of its platform")
    return board


def _radar(lines: Lines, board: Board, plan: FramePlan, ideal: bool) -> _core.Radar:
    slots = SlotTable(lines, plan)
    antennas = _antennas_of(lines, board)
    code = slots.transmit_code(_bits(lines.one("channelCfg")["transmitters"]))
    if code.transmitters[-1] >= len(board.transmitters):
        raise slots.error(f"transmitter {code.transmitters[-1] + 1}: {board.name} has {len(board.transmitters)}")
    waveform = slots.waveform(num_chirps=plan.num_loops * plan.num_chirps // code.slots_of_chirp, real=_is_real(lines))
    try:
        radar = _core.Radar(waveform, transmitters=[board.transmitters[i] for i in code.order], receivers=antennas,
                           transmit_power=board.transmit_power, noise_figure_db=board.noise_figure_db,
                           multiplexing=code.kind, code_phases=code.phases,
                           receiver=_receiver(lines, slots, plan, board, ideal, chain_settings(slots, code)))
    except ValueError as error:
        raise slots.error(str(error)) from None
    plan.check_duration(radar.frame_duration)
    _warn_of_other_band(board, waveform)
    return radar


def _warn_of_other_band(board: Board, waveform: _core.ChirpSequence) -> None:
    low, high = board.band
    ends = waveform.start_frequency, waveform.start_frequency + waveform.bandwidth
    if min(ends) < low or max(ends) > high:
        warn_user(f"board: {board.name} sends from {1e-9 * low:g} to {1e-9 * high:g} GHz, the chirps of the file go from "
                  f"{1e-9 * ends[0]:.2f} to {1e-9 * ends[1]:.2f} GHz: is it that of another board?")


def _antennas_of(lines: Lines, board: Board) -> list:
    command = lines.one("channelCfg")
    chosen = _bits(command["receivers"])
    if not chosen or chosen[-1] >= len(board.receivers):
        raise command.error(f"receivers: must be a mask of the {len(board.receivers)} of {board.name}, got "
                            f"{command['receivers']}")
    return [board.receivers[i] for i in chosen]


def _receiver(lines: Lines, slots: SlotTable, plan: FramePlan, board: Board, ideal: bool, of_transmitters: dict):
    profile, adc = slots.profile, lines.one("adcCfg")
    corners = []
    for name, known in (("high_pass_1", HIGH_PASS_1), ("high_pass_2", HIGH_PASS_2)):
        if not 0 <= profile[name] < len(known):
            raise profile.error(f"{name}: must be 0 to {len(known) - 1}, got {profile[name]}")
        corners.append(known[profile[name]])
    if not 0 <= adc["bits"] < len(BITS):
        raise adc.error(f"bits: must be 0, 1 or 2 for {BITS} bits, got {adc['bits']}")
    if ideal:
        return Receiver(**of_transmitters) if of_transmitters else None
    gain_db = float(int(profile["gain_db"]) & _RF_GAIN_BITS)
    return Receiver(high_pass=corners, adc=Adc(bits=BITS[adc["bits"]], gain_db=gain_db, lanes=board.lanes,
                                               q_first=_is_q_first(lines, plan.subframe)), **of_transmitters)


def _is_q_first(lines: Lines, subframe: int) -> bool:
    """Whether the sensor streams Q before I: by adcbufCfg, where lvdsStreamCfg has it stream its samples (data format 1)."""
    streams, buffers = (_of_subframe(lines, name, subframe) for name in ("lvdsStreamCfg", "adcbufCfg"))
    return streams is not None and streams["data"] == 1 and buffers is not None and buffers["swap"] == 1


def _of_subframe(lines: Lines, name: str, subframe: int) -> Command | None:
    found = [command for command in lines.of(name) if command["subframe"] in (-1, subframe)]
    return found[-1] if found else None


def _is_real(lines: Lines) -> bool:
    adc = lines.one("adcCfg")
    if adc["format"] not in (0, 1, 2, 3):
        raise adc.error(f"format: must be 0 (real), 1, 2 or 3 (complex), got {adc['format']}")
    return adc["format"] == 0


def _bits(mask: int) -> list[int]:
    return [bit for bit in range(max(mask, 0).bit_length()) if mask >> bit & 1]
