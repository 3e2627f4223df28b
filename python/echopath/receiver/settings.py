"""What a receiver may be: frozen values, the one home of the names, units and defaults of its faults."""
from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from ..arguments.checks import ArrayLike, Rule, array, count, flag, optional, real, refused
from ..arguments.settings import Settings, settings_class
from .fields import NumberPair, Numbers, NumberTable, Row, Table, kept

LARGEST_DB = 1000.0  # of gains, of which several and their squares are finite numbers
LARGEST_OFFSET = 10.0 ** (LARGEST_DB / 20.0)  # sqrt(W), likewise
LONGEST_DELAY = 1.0  # s, of leakage, coupling and jitter: phases of radars are still told to a thousandth of a turn after it
FASTEST_TURN = 1e9  # rad/s, of a drift: a tone beyond the band of any converter
LARGEST_ERROR = 1e30  # Hz, Hz/s, ...: beyond any chirp, and phases of it are finite numbers
HIGHEST_LEVEL = 20.0  # dBc/Hz, of a phase that turns about at random: masks of radars are far below it


def _row(unit: str = "", largest: float = math.inf) -> Rule:
    """Finite numbers [N] of a unit as a tuple, none beyond +-largest."""
    rule = array("[N]", finite=True)

    def check(argument: str, value) -> Row:
        row = tuple(float(one) for one in rule(argument, value))
        _check_size(argument, row, unit, largest)
        return row

    return check


_OFFSETS = array("[]", "[N]", "[N, M]", "[N, M, K]", "[N, M, K, L]", finite=True)


def _check_size(argument: str, numbers: Row, unit: str, largest: float) -> None:
    if max(map(abs, numbers), default=0.0) > largest:
        raise refused(ValueError, argument, f"from {-largest:g} to {largest:g} {unit}", numbers)


def _decibels(unit: str, low: float = -LARGEST_DB) -> Rule:
    """A number of which powers are finite."""
    return real(low, LARGEST_DB, unit)


def _table(shape: str) -> Rule:
    """Numbers in dB of a shape with two axes, or none at all, as tuples: kept so that the value can be hashed."""
    rule = array(shape, finite=True)

    def check(argument: str, value) -> Table:
        if isinstance(value, (tuple, list)) and not value:
            return ()
        table = tuple(tuple(float(one) for one in row) for row in rule(argument, value))
        for row in table:
            _check_size(argument, row, "dB", LARGEST_DB)
        return table

    return check


def _lanes(argument: str, value) -> int:
    try:
        lanes = count(2, 4)(argument, value)
    except (TypeError, ValueError) as error:
        raise refused(type(error), argument, "2 or 4", value) from None
    if lanes == 3:
        raise refused(ValueError, argument, "2 or 4", value)
    return lanes


def _pair(argument: str, value) -> tuple[float, float]:
    first, second = array("[2]", finite=True)(argument, value)
    _check_size(argument, (first, second), "sqrt(W)", LARGEST_OFFSET)
    return float(first), float(second)


def _value(kind: type) -> Rule:
    """An object of a class of settings, or a dict of its keywords."""
    def check(argument: str, value):
        if isinstance(value, kind):
            return value
        if not isinstance(value, Mapping):
            raise refused(TypeError, argument, f"{kind.__name__}, a dict of its keywords or None", value)
        try:
            return kind(**value)
        except (TypeError, ValueError) as error:
            told = str(error)
            called = f"{kind.__name__}: "
            raise type(error)(f"{argument}: {told.removeprefix(called)}" if told.startswith(called)
                              else f"{argument}.{told}") from None

    return check


@settings_class
class PhaseNoise(Settings):
    """Phase noise of the oscillator that transmitters and mixers share, by a mask.

    offsets: [M] Hz from the carrier, ascending, above 0; levels: [M] dBc/Hz there, on one side of the carrier, at most 20:
        a mask that would rise further begins at an offset where it does not. Between them the level runs straight over the
        logarithm of the offset, beyond the ends it stays.
    Raises TypeError or ValueError naming the keyword. Values are frozen; two with equal values are equal.
    """

    offsets: Numbers = kept(())
    levels: Numbers = kept(())

    RULES: ClassVar[Mapping[str, Rule]] = {"offsets": _row(), "levels": _row()}

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.offsets or min(self.offsets) <= 0.0 or np.any(np.diff(self.offsets) <= 0.0):
            raise refused(ValueError, "offsets", "ascending Hz above 0, one at least", self.offsets)
        if len(self.levels) != len(self.offsets):
            raise refused(ValueError, "offsets", f"as many as levels, {len(self.levels)}", self.offsets)
        if max(self.levels) > HIGHEST_LEVEL:
            raise refused(ValueError, "levels", f"at most {HIGHEST_LEVEL:g} dBc/Hz", self.levels)

    def density(self, offset: ArrayLike) -> np.ndarray:
        """Power relative to the carrier's in 1 Hz.

        offset: Hz of either sign, a number or an array of at most four axes
        Returns an array of that shape, linear, in 1/Hz. Raises TypeError or ValueError for what are no finite numbers.
        """
        offset = _OFFSETS("offset", offset)
        log = np.log10(np.maximum(np.abs(offset), self.offsets[0]))
        return 10.0 ** (np.interp(log, np.log10(self.offsets), self.levels) / 10.0)


@settings_class
class Adc(Settings):
    """The converter of the receiver, and the amplifier before it.

    bits: 2 to 16, of each of the two branches, or of the one of real samples
    full_scale_dbm: dBm, power of the tone that just fills the converter, at its input
    gain_db: dB from the antenna to the converter; automatic_gain: chosen anew for each frame instead, so that its largest
        sample stays headroom_db (dB, 0 or more) below full scale, in steps of gain_step_db (dB, 0: any gain)
    clock_jitter: s, rms deviation of the sampling instants
    lanes: 2 or 4, of the sensor's serial port, which order the words of raw files; q_first: whether Q stands before I there
        (see `sensor_files/raw.py`)
    Raises TypeError or ValueError naming the keyword. Values are frozen; two with equal values are equal.
    """

    bits: int = 12
    full_scale_dbm: float = 10.0
    gain_db: float = 30.0
    automatic_gain: bool = False
    headroom_db: float = 6.0
    gain_step_db: float = 2.0
    clock_jitter: float = 0.0
    lanes: int = 2
    q_first: bool = False

    RULES: ClassVar[Mapping[str, Rule]] = {
        "bits": count(2, 16), "full_scale_dbm": _decibels("dBm"), "gain_db": _decibels("dB"), "automatic_gain": flag,
        "headroom_db": _decibels("dB", 0.0), "gain_step_db": _decibels("dB", 0.0),
        "clock_jitter": real(0.0, LONGEST_DELAY, "s"), "lanes": _lanes, "q_first": flag}


class GivenPhaseNoise:
    """A PhaseNoise, or a dict of its keywords, of which one is made, or None."""

    if TYPE_CHECKING:
        def __get__(self, instance: object, owner: type) -> PhaseNoise | None: return None
        def __set__(self, instance: object, value: PhaseNoise | Mapping[str, object] | None) -> None: ...


class GivenAdc:
    """An Adc, or a dict of its keywords, of which one is made, or None."""

    if TYPE_CHECKING:
        def __get__(self, instance: object, owner: type) -> Adc | None: return None
        def __set__(self, instance: object, value: Adc | Mapping[str, object] | None) -> None: ...


@settings_class
class Receiver(Settings):
    """Faults of a receiver; what is not given is ideal. `echopath.receiver` has the order of the stages.

    phase_noise: PhaseNoise or a dict of its keywords; frequency_error: (c0, c1, ...), the frequency is off by c0 + c1 t +
        c2 t^2 + ... Hz, by 31 sampling rates at most, t in s from the first sample of a chirp
    leakage_db: [tx, rx] dB of the transmit power that leaks into each receiver, after leakage_delay (s)
    coupling_db: [rx, rx] dB from receiver (row) to receiver (column) after coupling_delay (s); the diagonal counts for nothing
    transmitter_gain_db, transmitter_phase: [tx] dB and rad, errors of the chains; receiver_gain_db, receiver_phase: [rx],
        likewise; gain_drift_db, phase_drift: [rx] dB/s and rad/s that the receivers' errors change by, from time 0 on: gains by
        at most 1000 dB until a frame ends
    compression_dbm: dBm at the antenna where the gain is 1 dB lower, of a gain that falls as 1 / sqrt(1 + power / saturation)
    high_pass: [N] Hz, corners of that many first-order filters; low_pass: Hz, corner (-3 dB) of a Butterworth filter of
        low_pass_poles poles, 1 to 10
    iq_gain_db, iq_phase: dB and rad by which the Q branch differs from the I branch; dc_offset: (I, Q) in sqrt(W)
    adc: Adc or a dict of its keywords
    An empty row or table is none, and so is None of the others. Raises TypeError or ValueError naming the keyword. Values are
    frozen; two with equal values are equal.
    """

    phase_noise: GivenPhaseNoise = kept(None)
    frequency_error: Numbers = kept(())
    leakage_db: NumberTable = kept(())
    leakage_delay: float = 0.0
    coupling_db: NumberTable = kept(())
    coupling_delay: float = 0.0
    transmitter_gain_db: Numbers = kept(())
    transmitter_phase: Numbers = kept(())
    receiver_gain_db: Numbers = kept(())
    receiver_phase: Numbers = kept(())
    gain_drift_db: Numbers = kept(())
    phase_drift: Numbers = kept(())
    compression_dbm: float | None = None
    high_pass: Numbers = kept(())
    low_pass: float | None = None
    low_pass_poles: int = 4
    iq_gain_db: float = 0.0
    iq_phase: float = 0.0
    dc_offset: NumberPair = kept((0.0, 0.0))
    adc: GivenAdc = kept(None)

    RULES: ClassVar[Mapping[str, Rule]] = {
        "phase_noise": optional(_value(PhaseNoise)), "frequency_error": _row("Hz, Hz/s, ...", LARGEST_ERROR),
        "leakage_db": _table("[tx, rx]"),
        "leakage_delay": real(0.0, LONGEST_DELAY, "s"), "coupling_db": _table("[rx, rx]"),
        "coupling_delay": real(0.0, LONGEST_DELAY, "s"), "transmitter_gain_db": _row("dB", LARGEST_DB),
        "transmitter_phase": _row(), "receiver_gain_db": _row("dB", LARGEST_DB), "receiver_phase": _row(),
        "gain_drift_db": _row(), "phase_drift": _row("rad/s", FASTEST_TURN), "compression_dbm": optional(_decibels("dBm")),
        "high_pass": _row(), "low_pass": optional(real(above=0.0, unit="Hz")), "low_pass_poles": count(1, 10),
        "iq_gain_db": _decibels("dB"), "iq_phase": real(-math.pi / 2, math.pi / 2, "rad"),
        "dc_offset": _pair, "adc": optional(_value(Adc))}

    def __post_init__(self) -> None:
        super().__post_init__()
        if any(corner <= 0.0 for corner in self.high_pass):
            raise refused(ValueError, "high_pass", "Hz above 0", self.high_pass)

    def __repr__(self) -> str:
        default = Receiver()
        told = (f"{name}={value!r}" for name, value in self.keywords().items() if value != getattr(default, name))
        return f"Receiver({', '.join(told)})"

    def plain(self) -> dict[str, Any]:
        """{keyword: value} of what is not the default, values of its values likewise: for files."""
        return _plain(self)


def _plain(value: Settings) -> dict:
    default = {name: field.default for name, field in value.__dataclass_fields__.items() if name in value.RULES}
    return {name: _plain(one) if isinstance(one, Settings) else one for name, one in value.keywords().items()
            if one != default[name]}


def receiver_text(radar) -> str:
    """Which faults the receiver of a radar has, in words."""
    if radar.receiver is None:
        return "ideal but for its noise"
    return "with " + (", ".join(radar.receiver.plain()) or "all faults off")


receiver_rule = _value(Receiver)
