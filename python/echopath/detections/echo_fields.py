"""What each path gives to a cell of a range-Doppler map: the step from detections back to paths."""
from __future__ import annotations

from functools import cached_property

import numpy as np

from .. import _core
from ..base.antennas import look_of
from ..paths.cells import OUTSIDE, chirp_times, path_cells, turning_of
from ..paths.subset import subset
from ..spectra.windows import of_range, of_velocity, samples_of
from ..transmit.signals import synthesize_slots

FLOOR_DB = 60.0        # below its peak, a window's response is followed so far
STEPS_PER_BIN = 16     # of the table of responses, linear between them: 0.5 % of the peak
SWEEP_STEP = 0.25      # bins, nearest: a phase of 0.1 rad at the ends of the frame; within segments, of each of them
MAX_SWEEP = 32.0       # bins
SEGMENTS_PER_BIN = 4   # of the frame, for echoes that go on to other bins of range during it
MAX_SEGMENTS = 32
BYTES_PER_FIELD = 12   # place and field of a path in a channel
HELD = 0.9999          # of the power of single paths, by the paths that are named
MAX_CHANNELS = 8       # whose fields are made: an echo fades in one antenna, hardly ever in eight
MAX_MEMORY = 2 ** 28   # bytes, of the fields of all paths
LEFT_OUT = 1e-6        # of the power of single paths in a cell: those that together hold less
FADED = 1e-20          # of the power of the strongest path: how the phases of weaker ones turn is rounding
SAME_BIN = 0.25        # bins of range, up to which all channels have a path in the same place


class Response:
    """Response of a windowed transform of n samples to a tone y bins away whose frequency rises by `sweep` bins, 1 at 0.

    In parts, one for each segment of the samples. reach: bins, within which it is known
    Model: p^2 = 2 c p - c^2 + (p - c)^2 about the centre c of a segment: it sees a tone c sweep bins nearer, whose sweep
    bends it by the square of the segment's length less. So S segments need steps S^2 as wide for the same error.
    Memory: the table has 8 bytes for each segment, sweep (257 / S^2 at most) and sixteenth of a bin: 33 kB a sample at most.
    """

    def __init__(self, window, n: int, largest_sweep: float = 0.0, segments: int = 1):
        samples = samples_of(window, n)
        self._n = n
        self._step = SWEEP_STEP * segments ** 2
        self._largest = min(largest_sweep, MAX_SWEEP)
        self._middle = int(np.ceil(self._largest / self._step - 0.5))
        self.reach = min(_reach(samples) + 0.5 * self._largest, 0.5 * n)
        self._half = int((min(self.reach + 0.5 * self._largest, 0.5 * n) + 1.0) * STEPS_PER_BIN)
        place = (np.arange(n) - 0.5 * (n - 1)) / n
        parts = np.array_split(np.arange(n), segments)
        self.centres = np.array([place[part].mean() for part in parts])  # [segments], -1/2 to 1/2
        self._table = np.stack([self._transform(samples / samples.sum(), place - centre, part)
                                for centre, part in zip(self.centres, parts)])

    @property
    def table_bytes(self) -> int:
        return self._table.nbytes

    def __call__(self, y, sweep=0.0):
        """y: bins [N], folded into the axis, or [rows, N] for one segment; sweep: bins [N] or one.

        Returns complex [segments or rows, N].
        """
        sweep, centre = np.clip(sweep, -self._largest, self._largest), self.centres[:, None]
        y = y - centre * sweep
        turns = np.rint(y / self._n)
        sign = 1.0 - 2.0 * np.mod(turns * (self._n - 1), 2)  # phases are those of the samples' middle
        row = np.clip(np.rint(sweep / self._step).astype(int) + self._middle, 0, 2 * self._middle)
        step = (y - turns * self._n) * STEPS_PER_BIN + self._half
        low = np.clip(step.astype(int), 0, 2 * self._half - 1)
        part = np.clip(step - low, 0.0, 1.0)
        segment = np.arange(len(self.centres))[:, None]
        between = (1.0 - part) * self._table[segment, row, low] + part * self._table[segment, row, low + 1]
        return sign * np.exp(-1j * np.pi * sweep * centre ** 2) * between

    def _transform(self, samples, place, part):
        """Of the samples of a segment, places counted from its centre, at the steps of the table, [sweeps, steps]."""
        sweeps = self._step * np.arange(-self._middle, self._middle + 1)
        rows = np.zeros((len(sweeps), self._n), complex)
        rows[:, part] = samples[part] * np.exp(1j * np.pi * np.outer(sweeps, place[part] ** 2))
        steps = np.arange(-self._half, self._half + 1)
        values = np.fft.fft(rows, self._n * STEPS_PER_BIN)[:, steps % (self._n * STEPS_PER_BIN)]
        return (values * np.exp(1j * np.pi * steps / STEPS_PER_BIN * (self._n - 1) / self._n)).astype(np.complex64)


class EchoFields:
    """The field that each path gives to each cell of a map of its radar, by its state in the middle of the frame.

    Model: delays and amplitudes of C channels, spread evenly over all: at most 8, and as many as 256 MiB hold, one at least;
    the velocity of `path_cells` and its change over the frame for the first antennas. Cells are asked for together
    (`evaluate`): where one channel tells how strong paths are in all, the others are evaluated only for those that hold a cell
    but for a millionth.
    paths: of `trace`, P of them; spectrum: RangeDoppler of the radar that traced them, values in sqrt(W)
    """

    def __init__(self, paths, spectrum):
        self._paths, self._spectrum = paths, spectrum
        self._echoes_of_cell = {}  # {(velocity, range): echoes, as _strong_in gives them}

    @cached_property
    def channels(self) -> np.ndarray:
        """(transmitter, receiver) indices of the channels, [C, 2]; the first is that of the first antennas."""
        num_receivers = len(self._paths.radar.receivers)
        num_channels = len(self._paths.radar.transmitters) * num_receivers
        room = MAX_MEMORY // (BYTES_PER_FIELD * max(self._paths.num_paths, 1))
        count = int(np.clip(room, 1, min(MAX_CHANNELS, num_channels)))
        taken = np.linspace(0, num_channels - 1, count).astype(int)
        return np.stack(np.divmod(taken, num_receivers), axis=-1)

    def measured(self, cells) -> np.ndarray:
        """Power [N] in W of the map in cells [N, 2], mean over the channels: what the sums of the fields compare with."""
        (tx, rx), (velocity, distance) = self.channels.T[:, :, None], cells.T
        return np.mean(np.abs(self._spectrum.values[tx, rx, velocity, distance]) ** 2, axis=0)

    def peak_of(self, keep) -> float:
        """Power in W of the strongest cell of the map of the paths where `keep` [P] is true, mean over all channels."""
        radar, spectrum = self._paths.radar, self._spectrum
        cube = synthesize_slots(subset(self._paths, keep), radar)
        values = _core.range_doppler(cube, radar, spectrum.window, spectrum.zero_pad)
        return float(_core.mean_power(values).max(initial=0.0))

    def evaluate(self, cells) -> None:
        """Evaluates the paths of cells [N, 2] together, which takes little more than one does."""
        asked = [_key(cell) for cell in cells if _key(cell) not in self._echoes_of_cell]
        if asked:
            self._echoes_of_cell |= dict.fromkeys(asked, self._strong_in(asked))

    def fields(self, cell) -> tuple:
        """(indices i64 [N], fields complex [C, N] in sqrt(W)) of the paths that may give to a cell (velocity, range)."""
        self.evaluate([cell])
        echoes = self._echoes_of_cell[_key(cell)]
        near = self._candidates(echoes["number"], *_key(cell))
        return echoes["index"][near], self._gains(echoes, near, cell, echoes["shift"]) * echoes["field"][:, near]

    def paths(self, cell) -> tuple:
        """(indices i64 [N], shares [N]) of the strongest paths of a cell (velocity, range), largest first."""
        index, field = self.fields(cell)
        power = np.mean(np.abs(field) ** 2, axis=0)
        order = np.argsort(-power, kind="stable")
        held = np.cumsum(power[order])
        if not len(held) or held[-1] == 0.0:
            return np.zeros(0, np.int64), np.zeros(0)
        count = int(np.searchsorted(held, HELD * held[-1])) + 1
        return index[order[:count]], power[order[:count]] / held[-1]

    def _gains(self, echoes: dict, near, cell, shifts) -> np.ndarray:
        """What a cell has of the fields of some echoes, complex [C, N]; shifts: bins [C, P] of the channels."""
        (velocity, distance), pad = _key(cell), self._spectrum.zero_pad
        along = self._velocity_response((velocity - echoes["velocity"][near]) / pad, echoes["sweep"][near])
        onward = np.outer(self._velocity_response.centres, echoes["travel"][near])
        place = (distance - echoes["range"][near]) / pad - onward
        return np.array([np.sum(along * self._range_response(place - shift), axis=0) for shift in shifts[:, near]])

    @cached_property
    def _echoes(self) -> dict:
        """Of the paths within the map, in the order of their nearest cells: place in cells, length, index, and field in the
        first channel."""
        paths, spectrum = self._paths, self._spectrum
        waveform, pad = paths.radar.waveform, spectrum.zero_pad
        cells = path_cells(paths, spectrum)
        inside = np.flatnonzero(cells.range_index != OUTSIDE)
        number = cells.velocity_index[inside].astype(np.int64) * len(spectrum.range) + cells.range_index[inside]
        order = np.argsort(number, kind="stable")
        index = inside[order]
        doppler = (cells.range[index] - 0.5 * cells.length[index]) * waveform.slope / waveform.centre_frequency
        bin_width = 2.0 * waveform.max_velocity(paths.radar.num_slots) / waveform.num_chirps
        first = _lengths_and_fields(paths, 0, [0])[1][0, index]
        power = np.abs(first) ** 2
        sweep = np.where(power > FADED * power.max(initial=0.0), _speed_change(paths, cells.length)[index] / bin_width, 0.0)
        range_step = self._range_bin / pad
        return {"number": number[order], "index": index, "range": cells.range[index] / range_step,
                "velocity": doppler / bin_width * pad + len(spectrum.velocity) // 2,
                "sweep": sweep, "first": first, "length": cells.length[index],
                "travel": cells.velocity[index] * _duration(paths) / (range_step * pad)}

    def _strong_in(self, cells) -> dict:
        """Echoes that hold some cells, with "shift" and "field" of the channels, [C, P]."""
        echoes = self._echoes
        keep = np.zeros(len(echoes["index"]), bool)
        for cell in cells:
            near = self._candidates(echoes["number"], *cell)
            keep[near[self._holds(echoes, near, cell)] if self._channels_are_alike else near] = True
        chosen = {name: values[keep] for name, values in echoes.items()}
        return chosen | dict(zip(("shift", "field"), self._of_channels(chosen)))

    def _holds(self, echoes: dict, near, cell) -> np.ndarray:
        """bool [N], the echoes that hold nearly all of the power of a cell in the first channel."""
        gains = self._gains(echoes, near, cell, np.zeros((1, len(echoes["index"]))))[0]
        power = np.abs(gains * echoes["first"][near]) ** 2
        ascending = np.sort(power)
        held = np.cumsum(ascending)
        return power >= ascending[np.searchsorted(held, LEFT_OUT * held[-1])] if len(held) else np.zeros(0, bool)

    def _of_channels(self, echoes: dict) -> tuple:
        """Bins of range by which each channel has some echoes farther away than the first antennas, and fields, [C, N]."""
        ascending = np.sort(echoes["index"])
        paths, column = subset(self._paths, ascending), np.searchsorted(ascending, echoes["index"])
        shift = np.empty((len(self.channels), len(column)), np.float32)
        field = np.empty(shift.shape, np.complex64)
        for tx in np.unique(self.channels[:, 0]):
            rows = np.flatnonzero(self.channels[:, 0] == tx)
            length, start = _lengths_and_fields(paths, int(tx), self.channels[rows, 1].tolist())
            shift[rows] = 0.5 * (length[:, column] - echoes["length"]) / self._range_bin
            field[rows] = start[:, column]
        return shift, field

    @property
    def _range_bin(self) -> float:
        """Width of a bin of range, m."""
        waveform = self._paths.radar.waveform
        return _core.speed_of_light * waveform.sampling_rate / (2.0 * waveform.slope * waveform.num_samples)

    @cached_property
    def _largest_shift(self) -> float:
        """Bins of range by which the length of a path may differ between channels, at most."""
        tx, rx = (np.array([antenna.position for antenna in antennas])
                  for antennas in (self._paths.radar.transmitters, self._paths.radar.receivers))
        apart = [np.linalg.norm(places - places[0], axis=1).max() for places in (tx, rx)]
        return 0.5 * sum(apart) / self._range_bin

    @cached_property
    def _channels_are_alike(self) -> bool:
        """Whether a path that gives little in the first channel gives little in the others: antennas look the same way."""
        radar = self._paths.radar
        looks = [[look_of(one) for one in antennas] for antennas in (radar.transmitters, radar.receivers)]
        return self._largest_shift < SAME_BIN and all(look == some[0] for some in looks for look in some)

    @cached_property
    def _velocity_response(self) -> Response:
        num_chirps = self._paths.radar.waveform.num_chirps
        segments = int(np.clip(np.ceil(SEGMENTS_PER_BIN * self._largest("travel")), 1, min(MAX_SEGMENTS, num_chirps)))
        return Response(of_velocity(self._spectrum.window), num_chirps, self._largest("sweep"), segments)

    @cached_property
    def _range_response(self) -> Response:
        return Response(of_range(self._spectrum.window), self._paths.radar.waveform.num_samples)

    def _largest(self, name: str) -> float:
        return float(np.abs(self._echoes[name]).max(initial=0.0))

    def _candidates(self, number, velocity: int, distance: int):
        """Places in echoes, in the order of the `number` of their nearest cells, of those within reach of a cell."""
        num_velocities, num_ranges = len(self._spectrum.velocity), len(self._spectrum.range)
        pad = self._spectrum.zero_pad
        slow = min(int(self._velocity_response.reach * pad), num_velocities // 2)
        far = int((self._range_response.reach + 0.5 * self._largest("travel") + self._largest_shift) * pad)
        rows = np.unique(np.arange(velocity - slow, velocity + slow + 1) % num_velocities) * num_ranges
        first = np.searchsorted(number, rows + max(distance - far, 0))
        last = np.searchsorted(number, rows + min(distance + far, num_ranges - 1), side="right")
        return np.concatenate([np.arange(*pair) for pair in zip(first, last)])


def _key(cell) -> tuple:
    """(velocity, range) of a cell as numbers of Python."""
    return int(cell[0]), int(cell[1])


def _reach(samples) -> int:
    """Bins beyond which the response stays FLOOR_DB below its peak."""
    response = np.abs(np.fft.rfft(samples, 8 * len(samples))) / samples.sum()
    return int(np.ceil(np.flatnonzero(response > 10.0 ** (-FLOOR_DB / 20.0))[-1] / 8)) + 1


def _duration(paths) -> float:
    """Of all chirps of one transmitter and the slots between them, s."""
    radar = paths.radar
    return radar.waveform.num_chirps * radar.num_slots * radar.waveform.mean_interval


def _speed_change(paths, length):
    """By how much the velocity of each path of some length [P] in m rises over all chirps, m/s: with half the rate of the
    length, and with the phase of the amplitude."""
    first, _, last = chirp_times(paths)
    num_chirps = paths.radar.waveform.num_chirps
    if num_chirps < 3:
        return np.zeros(len(length))
    before, after = paths.lengths([first, last], 0, 0)
    of_length = 2.0 * (before + after - 2.0 * length) / (last - first)
    of_phase = 0.5 * paths.radar.waveform.wavelength * (turning_of(paths, last) - turning_of(paths, first))
    return (of_length + of_phase) * num_chirps / (num_chirps - 1)


def _lengths_and_fields(paths, tx: int, receivers: list) -> tuple:
    """Length [R, P] in m and signal, complex [R, P] in sqrt(W), of each path in the middle of the frame and of the chirp."""
    waveform, middle = paths.radar.waveform, chirp_times(paths, tx)[1]
    length, amplitude = paths._echoes_at_receivers(middle, tx, receivers)
    delay = length / _core.speed_of_light
    cycles = (waveform.start_frequency + waveform.slope * waveform.window_centre) * delay - 0.5 * waveform.slope * delay ** 2
    return length, np.conj(amplitude) * np.exp(2j * np.pi * np.mod(cycles, 1.0))
