"""What each path gives to a cell of a range-Doppler map: the step from detections back to paths."""
from __future__ import annotations

from functools import cached_property

import numpy as np

from .. import _core
from ..base.process.progress import with_progress
from ..base.radar.antennas import look_of
from ..base.radar.chirps import chirps_duration
from ..paths.cells import OUTSIDE, cells_of, chirp_times
from ..paths.subset import subset
from ..spectra.windows import of_range, of_velocity, samples_of
from ..transmit.signals import synthesize_slots
from .channels import Channels, by_channel
from .courses import courses_of
from .histories import Histories, length_and_field
from .response import MAX_SWEEP, Envelope, Response, responses_of, segments_of

BYTES_PER_FIELD = 12   # place and field of a path in a channel
BYTES_TOGETHER = 48    # of these, while fields in a cell are made of them
HELD = 0.9999          # of the power of single paths, by the paths that are named
MAX_CHANNELS = 8       # whose fields are made: an echo fades in one antenna, hardly ever in eight
MAX_MEMORY = 2 ** 28   # bytes, of the fields of all paths
LEFT_OUT = 1e-6        # of the power of single paths in a cell: those that together hold less
STRONGEST = 0.99       # of the bounds of the powers in a cell: those that tell how much power there is at least
FADED = 1e-20          # of the power of the strongest path: how the phases of weaker ones turn is rounding
FLASHING = 0.25        # of its largest field, by which an echo changes that is followed
FAINT = 1e-2           # of the largest field of a cell of range: what is less is taken as it is in mid-frame though it flashes
SAME_BIN = 0.25        # bins of range, up to which all channels have a path in the same place


class EchoFields:
    """The field that each path gives to each cell of a map of its radar, by its state in the middle of the frame.

    Model: delays and amplitudes of C channels, spread evenly over all: at most 8, and as many as 256 MiB hold, one at least,
    but in beams all; the velocity of `path_cells` and its change over the frame for the first antennas; of echoes whose phase
    is no parabola over the frame, as of blades and wheels, or that flash, the field of the first antennas in each chirp. Cells
    are asked for together (`evaluate`). Those paths of a cell are left out that together hold less than a millionth of its
    power, as far as the windows bound what each may give.
    paths: of `trace`, P of them; spectrum: RangeDoppler of the radar that traced them, values in sqrt(W)
    """

    def __init__(self, paths, spectrum):
        self._paths, self._spectrum = paths, spectrum
        self._echoes_of_cell = {}  # {(velocity, range): (echoes with those of the channels, places [N] of its own in them)}

    def __reduce__(self):
        return type(self), (self._paths, self._spectrum)  # all else follows from these

    @cached_property
    def _all(self) -> Channels:
        return Channels(self._paths.radar)

    @cached_property
    def _few(self) -> Channels:
        room = MAX_MEMORY // (BYTES_PER_FIELD * max(self._paths.num_paths, 1))
        return Channels(self._paths.radar, int(np.clip(room, 1, MAX_CHANNELS)))

    def measured(self, cells) -> np.ndarray:
        """Power [N] in W of the map in cells [N, 2], mean over the channels: what the sums of the fields compare with."""
        tx, rx = self._few.indices.T[:, :, None]
        return np.mean(np.abs(self._spectrum.values[tx, rx, *cells.T]) ** 2, axis=0)

    def each(self, cells, gains, beams=None, progress=None):
        """Yields of each of cells [N, 2] the indices [K] of the paths that hold it, their fields [C, K] in sqrt(W), and power in
        W of all behind the receiver; those in channels, or, with beams, [1, K] in the beam of the cell.

        gains: EchoGains at the ranges of the cells; beams: weights [N, tx, rx] of `find_peaks`; progress: as in `detect`
        """
        if beams is None:
            self.evaluate(cells, progress)
            for cell, gain in zip(cells, self._few.gains_of(gains, len(cells))):
                index, field = self.fields(cell)
                yield index, field, np.mean(np.abs(gain * field.sum(axis=1)) ** 2)
            return
        beside = by_channel(beams)
        weights = np.stack([beside, beside * self._all.gains_of(gains, len(cells))], axis=1)
        keys = [_key(cell) for cell in cells]
        self._follow(keys)
        held = [self._holding(cell) for cell in with_progress(keys, len(keys), progress, "paths of cells")]
        fields, whole = [np.zeros(len(some), complex) for some in held], np.zeros(len(held), complex)
        for i, row, (alone, behind) in self._in_beams(keys, held, weights):
            fields[i][row], whole[i] = alone, whole[i] + behind.sum()
        for some, field, power in zip(held, fields, np.abs(whole) ** 2):
            yield self._echoes["index"][some], field[None], power

    def _in_beams(self, cells, held, weights):
        """Yields (index of a cell, slice of the places [K] of the echoes that hold it, sums [B, N] in sqrt(W) of their fields in
        all channels with its weights [B, C]) of all cells. Each echo is made once, as many together as MAX_MEMORY holds."""
        room = max(MAX_MEMORY // (BYTES_TOGETHER * len(self._all.indices)), 1)
        together = _all_of(held, len(self._power))
        for begin in range(0, len(together), room):
            keep = together[begin:begin + room]
            echoes = self._in_channels({name: values[keep] for name, values in self._echoes.items()}, self._all)
            for i, some in enumerate(held):
                row = slice(*np.searchsorted(some, (keep[0], keep[-1] + 1)))
                if row.start < row.stop:
                    yield i, row, self._weighted(echoes, np.searchsorted(keep, some[row]), cells[i], self._all, weights[i])

    def peak_of(self, keep) -> float:
        """Power in W of the strongest cell of the map of the paths where `keep` [P] is true, mean over all channels."""
        radar, spectrum = self._paths.radar, self._spectrum
        cube = synthesize_slots(subset(self._paths, keep), radar)
        values = _core.range_doppler(cube, radar, spectrum.window, spectrum.zero_pad)
        return float(_core.mean_power(values).max(initial=0.0))

    def evaluate(self, cells, progress=None) -> None:
        """Evaluates the paths of cells [N, 2] together, which takes little more than one does; progress: as in `detect`."""
        asked = [_key(cell) for cell in cells if _key(cell) not in self._echoes_of_cell]
        if asked:
            self._follow(asked)
            held = [self._holding(cell) for cell in with_progress(asked, len(asked), progress, "paths of cells")]
            keep = _all_of(held, len(self._power))
            echoes = self._in_channels({name: values[keep] for name, values in self._echoes.items()}, self._few)
            self._echoes_of_cell |= {cell: (echoes, np.searchsorted(keep, some)) for cell, some in zip(asked, held)}

    def fields(self, cell) -> tuple:
        """(indices i64 [N], fields complex [C, N] in sqrt(W)) of the paths that hold a cell (velocity, range)."""
        self.evaluate([cell])
        echoes, held = self._echoes_of_cell[_key(cell)]
        return echoes["index"][held], self._fields(echoes, held, cell, self._few)

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

    def _fields(self, echoes: dict, some, cell, channels: Channels) -> np.ndarray:
        """The fields of some echoes in a cell, complex [C, N] in sqrt(W)."""
        return (self._gains(echoes, some, cell, channels) * echoes["field"][:, some]).astype(complex)

    def _gains(self, echoes: dict, some, cell, channels: Channels) -> np.ndarray:
        """What a cell has of the fields of some echoes in the channels, complex64 [C, N]."""
        gain, shift = self._gain(echoes, some, cell), echoes["shift"][:, some]
        gains = np.empty(shift.shape, np.complex64)
        for rows in channels.neighbours:
            low, high = shift[rows].min(axis=0), shift[rows].max(axis=0)
            at_low = gain(low)
            rise = gain(high) - at_low if len(rows) > 1 else 0.0
            gains[rows] = at_low + (shift[rows] - low) / np.maximum(high - low, np.finfo(np.float32).tiny) * rise
        return gains

    def _weighted(self, echoes: dict, some, cell, channels: Channels, weights) -> np.ndarray:
        """Sums of the fields of some echoes in a cell over the channels with weights [B, C], complex [B, N]: as by `_fields`, of
        which arrays of all channels would take most of the time. Gains are straight lines between neighbours."""
        gain, sums = self._gain(echoes, some, cell), np.zeros((len(weights), len(some)), complex)
        for rows in channels.neighbours:
            shift, field = (echoes[name][np.ix_(rows, some)] for name in ("shift", "field"))
            low, high = shift.min(axis=0), shift.max(axis=0)
            at_low = gain(low)
            sums += at_low * (weights[:, rows] @ field)
            if len(rows) > 1:
                rise = (gain(high) - at_low) / np.maximum(high - low, np.finfo(np.float32).tiny)
                sums += rise * (weights[:, rows] @ ((shift - low) * field))
        return sums

    def _gain(self, echoes: dict, some, cell):
        """Function of a shift in range, in bins: what a cell has of the fields of some echoes so far away, complex64 [N]."""
        segments = echoes["segments"][some]
        places = {number: np.flatnonzero(segments == number) for number in self._velocity_responses}
        parts = [(place, self._gain_in(number, echoes, some[place], cell)) for number, place in places.items()]

        def gain(shift):
            gains, shifts = np.empty(len(some), np.complex64), np.broadcast_to(shift, len(some))
            for place, of_part in parts:
                gains[place] = of_part(shifts[place])
            return gains
        return gain

    def _gain_in(self, segments: int, echoes: dict, some, cell):
        """As `_gain`, of echoes that go on by so many segments in the frame."""
        (velocity, distance), pad, response = _key(cell), self._spectrum.zero_pad, self._velocity_responses[segments]
        along = np.empty((len(response.nodes), len(some)), np.complex64)
        onward = np.empty(along.shape)
        rows = self._histories.rows(echoes["index"][some])
        followed, others = np.flatnonzero(rows >= 0), np.flatnonzero(rows < 0)
        along[:, followed], onward[:, followed] = self._along_histories(rows[followed], velocity, response)
        apart, sweep, travel = (echoes[name][some[others]] for name in ("velocity", "sweep", "travel"))
        along[:, others], onward[:, others] = response((velocity - apart) / pad, sweep), np.outer(response.centres, travel)
        place = (distance - echoes["range"][some]) / pad - onward
        return lambda shift: np.sum(along * self._range_response(place - shift), axis=0)

    def _along_histories(self, rows, velocity: int, response: Response) -> tuple:
        """What a cell of velocity has of echoes that are followed from chirp to chirp, and bins of range by which they are
        farther away than in the middle of the frame, at the nodes of the response, [nodes, N] each."""
        tone = self._chirp_weights * np.exp(-2j * np.pi * self._cell_turns(velocity))
        along = self._histories.sums(rows, (response.shares * tone).astype(np.complex64))
        farther = self._histories.farther(rows, np.rint(response.nodes).astype(int))
        return along, 0.5 * farther.T / self._paths.radar.waveform.range_resolution

    def _cell_turns(self, velocity: int) -> np.ndarray:
        """Turns [C] of the tone of a cell of velocity in each chirp, from the middle of the frame on."""
        count = self._paths.radar.waveform.num_chirps
        bins = (velocity - len(self._spectrum.velocity) // 2) / self._spectrum.zero_pad
        return bins * (np.arange(count) - 0.5 * (count - 1)) / count

    @cached_property
    def _chirp_weights(self) -> np.ndarray:
        """Weights [C] of the chirps in a cell, sum 1."""
        samples = samples_of(of_velocity(self._spectrum.window), self._paths.radar.waveform.num_chirps)
        return samples / samples.sum()

    @cached_property
    def _histories(self) -> Histories:
        radar = self._paths.radar
        times = [radar.chirp_time(0, chirp) for chirp in range(radar.waveform.num_chirps)]
        return Histories(self._paths, self._paths.frame.start_time + np.array(times))

    def _follow(self, cells) -> None:
        """Follows the echoes that may hold cells [(velocity, range)] and whose phase is no parabola, the strongest first."""
        ranges = {distance for _, distance in cells}
        near = _all_of([self._unsteady_near(distance) for distance in ranges], len(self._power))
        strength = self._echoes["strongest"][near]
        self._histories.follow(self._echoes["index"][near[np.argsort(-strength, kind="stable")]])
        rows = self._histories.rows(self._echoes["index"][near])
        followed, rows = near[rows >= 0], rows[rows >= 0]
        self._power[followed] = np.maximum(self._power[followed], self._histories.largest(rows) ** 2)

    def _unsteady_near(self, distance: int) -> np.ndarray:
        """Places in the echoes of those whose phase is no parabola, within reach of a cell of range, ascending."""
        return self._unsteady[self._away(self._echoes["range"][self._unsteady], distance) <= self._far + 1.0]

    def _away(self, ranges, distance: int) -> np.ndarray:
        """Cells from some ranges [N], in cells, to a cell; of complex samples the axis is a circle, around which sidelobes go."""
        away = np.abs(ranges - distance)
        return away if self._paths.radar.waveform.real else np.minimum(away, len(self._spectrum.range) - away)

    @cached_property
    def _unsteady(self) -> np.ndarray:
        """Places in the echoes of those that may be followed, ascending."""
        return np.flatnonzero(self._echoes["unsteady"])

    @cached_property
    def _far(self) -> float:
        """Cells of range beyond which an echo gives nothing."""
        reach = self._range_envelope.reach() + 0.5 * self._largest("travel") + self._all.largest_shift
        return reach * self._spectrum.zero_pad

    @cached_property
    def _echoes(self) -> dict:
        """Of the paths within the map, in the order of their nearest cells: place in cells, length, index, and field in the
        first channel."""
        paths, spectrum = self._paths, self._spectrum
        waveform, pad = paths.radar.waveform, spectrum.zero_pad
        cells = cells_of(paths, spectrum)
        inside = np.flatnonzero(cells.range_index != OUTSIDE)
        number = cells.velocity_index[inside].astype(np.int64) * len(spectrum.range) + cells.range_index[inside]
        order = np.argsort(number, kind="stable")
        index = inside[order]
        doppler = (cells.range[index] - 0.5 * cells.length[index]) * waveform.slope / waveform.centre_frequency
        bin_width = 2.0 * waveform.max_velocity(paths.radar.num_slots) / waveform.num_chirps
        courses = courses_of(paths).take(index)
        power = np.abs(courses.field) ** 2
        told = power > FADED * power.max(initial=0.0)
        sweep = np.where(told, courses.speed_change / bin_width, 0.0)
        range_step = waveform.range_resolution / pad
        travel = np.where(told, cells.velocity[index] * chirps_duration(paths.radar) / (range_step * pad), 0.0)
        is_strong = courses.strongest > FAINT * _largest_beside(cells.range_index[index], courses.strongest)
        flashes = (courses.swing > FLASHING) & is_strong
        unsteady = ~courses.is_parabola | (np.abs(sweep) > MAX_SWEEP) | flashes
        travel = np.where(unsteady, np.copysign(courses.away / waveform.range_resolution, travel), travel)
        return {"number": number[order], "index": index, "range": cells.range[index] / range_step,
                "velocity": doppler / bin_width * pad + len(spectrum.velocity) // 2, "sweep": sweep, "first": courses.field,
                "strongest": courses.strongest, "length": cells.length[index], "unsteady": unsteady,
                "travel": travel, "segments": segments_of(travel)}

    @cached_property
    def _power(self) -> np.ndarray:
        """Power [P] of each echo in W, in the first channel where it tells that of all, else in the strongest."""
        if self._channels_are_alike:
            return np.abs(self._echoes["first"]) ** 2
        power = np.zeros(self._paths.num_paths)
        for tx, rows in self._few.of_transmitters.items():  # sizes alone: phases of all echoes would take most of the time
            middle, receivers = chirp_times(self._paths, tx)[1], self._few.indices[rows, 1].tolist()
            amplitude = self._paths._echoes_at_receivers(middle, tx, receivers)[1]
            np.maximum(power, np.max(np.abs(amplitude) ** 2, axis=0), out=power)
        return power[self._echoes["index"]]

    def _holding(self, cell) -> np.ndarray:
        """Places in the echoes of those that hold a cell but for LEFT_OUT of its power, [N] ascending.

        How much power there is at least is told by the echoes of the largest bounds.
        """
        near = self._candidates(self._echoes["number"], *cell)
        bounds = self._bounds(near, cell)
        strongest = near[_without_weakest(bounds, (1.0 - STRONGEST) * bounds.sum())]
        power = np.abs(self._gain(self._echoes, strongest, cell)(0.0)) ** 2 * self._power[strongest]
        return near[_without_weakest(bounds, LEFT_OUT * power.sum())]

    def _bounds(self, some, cell) -> np.ndarray:
        """The largest power in W that some echoes may give to a cell in a channel, [N]."""
        (velocity, distance), pad = cell, self._spectrum.zero_pad
        echoes = {name: self._echoes[name][some] for name in ("velocity", "range", "sweep", "travel", "unsteady")}
        travel, sweep = np.abs(echoes["travel"]), np.minimum(np.abs(echoes["sweep"]), MAX_SWEEP)
        along = self._velocity_envelope.bound((velocity - echoes["velocity"]) / pad, travel + sweep)
        along = np.where(echoes["unsteady"], 1.0, along)
        across = self._range_envelope.bound((distance - echoes["range"]) / pad, travel + 2.0 * self._all.largest_shift)
        return self._power[some] * (along * across) ** 2

    def _in_channels(self, echoes: dict, channels: Channels) -> dict:
        """Some echoes with "shift", bins of range by which each channel has them farther away than the first antennas, and
        "field", [C, N]."""
        ascending = np.sort(echoes["index"])
        paths, column = subset(self._paths, ascending), np.searchsorted(ascending, echoes["index"])
        shift = np.empty((len(channels.indices), len(column)), np.float32)
        field = np.empty(shift.shape, np.complex64)
        for tx, rows in channels.of_transmitters.items():
            length, start = _lengths_and_fields(paths, tx, channels.indices[rows, 1].tolist())
            shift[rows] = 0.5 * (length[:, column] - echoes["length"]) / self._paths.radar.waveform.range_resolution
            field[rows] = start[:, column]
            self._scale_followed(field, rows, echoes, length[:, column])
        return echoes | {"shift": shift, "field": field}

    def _scale_followed(self, field, channels, echoes: dict, length) -> None:
        """Makes the fields [C, N] of echoes that are followed what their histories are to be multiplied by in some channels,
        where they have a length [channels, N]: the largest field, and what differs from the first antennas."""
        rows = self._histories.rows(echoes["index"])
        some = np.flatnonzero(rows >= 0)
        waveform, first, largest = self._paths.radar.waveform, echoes["first"][some], self._histories.largest(rows[some])
        visible = np.abs(first) > np.sqrt(FADED) * largest
        first_phase = _core.middle_phases(echoes["length"][some], waveform)
        by_way = _core.middle_phases(length[:, some], waveform) * np.conj(first_phase)
        beside_first = np.divide(field[np.ix_(channels, some)], first, out=by_way, where=visible)
        field[np.ix_(channels, some)] = largest * beside_first

    @cached_property
    def _channels_are_alike(self) -> bool:
        """Whether a path that gives little in the first channel gives little in the others: antennas look the same way."""
        radar = self._paths.radar
        looks = [[look_of(one) for one in antennas] for antennas in (radar.transmitters, radar.receivers)]
        return self._all.largest_shift < SAME_BIN and all(look == some[0] for some in looks for look in some)

    @cached_property
    def _velocity_responses(self) -> dict:
        """{segments: Response} of the echoes that go on by so many."""
        window, num_chirps = of_velocity(self._spectrum.window), self._paths.radar.waveform.num_chirps
        reach = self._velocity_envelope.reach(self._largest("sweep"))
        return responses_of(window, num_chirps, self._echoes["segments"], self._echoes["sweep"], reach)

    @cached_property
    def _velocity_envelope(self) -> Envelope:
        return Envelope(of_velocity(self._spectrum.window), self._paths.radar.waveform.num_chirps)

    @cached_property
    def _range_envelope(self) -> Envelope:
        return Envelope(of_range(self._spectrum.window), self._paths.radar.waveform.num_samples)

    @cached_property
    def _range_response(self) -> Response:
        return Response(of_range(self._spectrum.window), self._paths.radar.waveform.num_samples)

    def _largest(self, name: str) -> float:
        return float(np.abs(self._echoes[name]).max(initial=0.0))

    def _candidates(self, number, velocity: int, distance: int):
        """Places in echoes, in the order of the `number` of their nearest cells, of those within reach of a cell."""
        num_velocities, num_ranges = len(self._spectrum.velocity), len(self._spectrum.range)
        slow = min(int(self._velocity_envelope.reach(self._largest("sweep")) * self._spectrum.zero_pad), num_velocities // 2)
        rows = np.unique(np.arange(velocity - slow, velocity + slow + 1) % num_velocities) * num_ranges
        first, last = (np.add.outer(rows, ends).ravel() for ends in zip(*self._spans_about(distance)))
        near = [np.arange(*pair) for pair in zip(np.searchsorted(number, first), np.searchsorted(number, last, side="right"))]
        return _all_of([*near, self._unsteady_near(distance)], len(number)) if len(self._unsteady) else np.concatenate(near)

    def _spans_about(self, distance: int) -> list:
        """[(first, last)] of the cells of range within reach of one, ascending: two where they go over an end of the axis."""
        far, count = int(self._far), len(self._spectrum.range)
        first, last = distance - far, distance + far
        if self._paths.radar.waveform.real:
            return [(max(first, 0), min(last, count - 1))]
        if last - first >= count - 1:
            return [(0, count - 1)]
        return [(first, last)] if 0 <= first and last < count else [(0, last % count), (first % count, count - 1)]


def _key(cell) -> tuple:
    """(velocity, range) of a cell as numbers of Python."""
    return int(cell[0]), int(cell[1])


def _all_of(lists, count: int) -> np.ndarray:
    """The places, of `count`, that are in any of some lists, each once and ascending. A sort takes far longer than marks."""
    marked = np.zeros(count, bool)
    for places in lists:
        marked[places] = True
    return np.flatnonzero(marked)


def _without_weakest(power, least: float) -> np.ndarray:
    """bool [N], all of some powers [N] in W but the weakest that together have no more than `least` W."""
    is_weak = power <= least
    faintest = power <= least / max(len(power), 1)  # all of them may go: sorting those between takes most of the time
    ascending = np.sort(power[is_weak & ~faintest])
    go = np.searchsorted(power[faintest].sum() + np.cumsum(ascending), least, side="right")
    return ~is_weak if go == len(ascending) else power >= ascending[go]


def _largest_beside(cells, field) -> np.ndarray:
    """The largest [N] of the fields in the same of some cells [N]."""
    largest = np.zeros(int(cells.max(initial=0)) + 1)
    np.maximum.at(largest, cells, field)
    return largest[cells]


def _lengths_and_fields(paths, tx: int, receivers: list) -> tuple:
    """Length [R, P] in m and signal, complex [R, P] in sqrt(W), of each path in the middle of the frame and of the chirp."""
    return length_and_field(paths, chirp_times(paths, tx)[1], tx, receivers)
