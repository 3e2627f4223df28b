"""Lines of a mmWave configuration: commands with their numbers, and where each stands."""
from __future__ import annotations

import dataclasses
import re
from pathlib import Path

from .. import _core
from ..base.storage.files import bytes_of

# Names of the arguments of each command that is understood, in their order; more may follow.
ARGUMENTS = {
    "dfeDataOutputMode": ("mode",),
    "channelCfg": ("receivers", "transmitters", "cascading"),
    "adcCfg": ("bits", "format"),
    "adcbufCfg": ("subframe", "format", "swap", "interleave", "threshold"),
    "lvdsStreamCfg": ("subframe", "header", "data", "software"),
    "profileCfg": ("profile", "start_ghz", "idle_us", "adc_start_us", "ramp_end_us", "power_backoff", "phase_shifter",
                   "slope_mhz_us", "tx_start_us", "num_samples", "rate_ksps", "high_pass_1", "high_pass_2", "gain_db"),
    "chirpCfg": ("first", "last", "profile", "start_hz", "slope_khz_us", "idle_us", "adc_start_us", "transmitters"),
    "bpmCfg": ("subframe", "enabled", "first", "second"),
    "frameCfg": ("first", "last", "num_loops", "num_frames", "period_ms", "trigger", "delay_ms"),
    "advFrameCfg": ("num_subframes", "forced_profile", "num_frames", "trigger", "delay_us"),
    "subFrameCfg": ("subframe", "forced_profile", "first", "num_chirps", "num_loops", "burst_ms", "first_offset", "num_bursts",
                    "num_burst_loops", "period_ms"),
}
_WHOLE = {"mode", "receivers", "transmitters", "cascading", "bits", "format", "profile", "num_samples", "high_pass_1",
          "high_pass_2", "first", "last", "num_loops", "num_frames", "num_subframes", "subframe", "num_chirps", "num_bursts",
          "num_burst_loops", "second", "enabled", "forced_profile", "first_offset", "swap", "header", "data", "power_backoff",
          "phase_shifter"}
# Of newer firmware a period may be missing behind the loops, and some of the last ones may be left out.
_OPTIONAL = {"frameCfg": 5, "advFrameCfg": 3, "channelCfg": 2, "adcbufCfg": 4, "lvdsStreamCfg": 3}


@dataclasses.dataclass(frozen=True)
class Command:
    """A line. name: of the command; values: {argument: number}; line: its number; path: of the file"""

    name: str
    values: dict
    line: int
    path: Path

    def __getitem__(self, argument: str):
        return self.values[argument]

    def error(self, text: str) -> Exception:
        """What to raise about the line."""
        return _core.FileError(f"{self.path}:{self.line}: {self.name}: {text}")


@dataclasses.dataclass(frozen=True)
class Lines:
    """A configuration. commands: those that are understood; others: names of the others, each once; platform: "" or its name"""

    path: Path
    commands: tuple
    others: tuple
    platform: str

    def of(self, name: str) -> list[Command]:
        """All lines of a command."""
        return [command for command in self.commands if command.name == name]

    def one(self, name: str) -> Command:
        """The last line of a command. Raises ep.FileError where there is none."""
        found = self.of(name)
        if not found:
            kind = "" if self.commands else ", nor any other command of the configuration of a sensor (.cfg)"
            raise _core.FileError(f"{self.path}: has no {name}{kind}")
        return found[-1]


def read_lines(path: Path) -> Lines:
    """Reads a configuration. Raises ep.FileError naming the line where arguments are missing or no numbers."""
    text = bytes_of(path).decode("utf-8-sig", "replace")
    commands, others = [], []
    for number, line in enumerate(text.splitlines(), 1):
        words = re.split(r"[%#]", line, maxsplit=1)[0].split()
        if not words:
            continue
        if words[0] not in ARGUMENTS:
            others.append(words[0])
            continue
        commands.append(Command(words[0], _values(words, number, path), number, path))
    platform = re.search(r"Platform\s*[:=]\s*(\w+)", text)
    return Lines(path, tuple(commands), tuple(dict.fromkeys(others)), platform.group(1) if platform else "")


def _values(words: list[str], line: int, path: Path) -> dict:
    name, names = words[0], ARGUMENTS[words[0]]
    command = Command(name, {}, line, path)
    least = _OPTIONAL.get(name, len(names))
    if len(words) - 1 < least:
        raise command.error(f"must have {least} arguments ({', '.join(names)}), got {len(words) - 1}")
    if name == "adcbufCfg" and len(words) - 1 == least:  # of the first firmware: of all sub-frames
        words = [name, "-1", *words[1:]]
    values = {}
    for argument, word in zip(names, words[1:]):
        values[argument] = _number(argument, word, command)
    return values


def _number(argument: str, word: str, command: Command):
    try:
        value = float(word)
    except ValueError:
        raise command.error(f"{argument}: must be a number, got '{word}'") from None
    if not abs(value) < 1e15:
        raise command.error(f"{argument}: must be finite, got '{word}'")
    if argument not in _WHOLE:
        return value
    if value != int(value):
        raise command.error(f"{argument}: must be a whole number, got '{word}'")
    return int(value)
