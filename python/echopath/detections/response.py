"""The response of a windowed transform to tones."""
from __future__ import annotations

import numpy as np

from ..spectra.windows import samples_of

FLOOR_DB = 60.0        # below its peak, a window's response is followed so far
STEPS_PER_BIN = 16     # of the table of responses, linear between them: 0.5 % of the peak
SWEEP_STEP = 0.25      # bins, nearest: a phase of 0.1 rad at the ends of the frame; with segments, of each part
MAX_SWEEP = 32.0       # bins
SEGMENTS_PER_BIN = 8   # of range that an echo goes on by in the frame, straight lines between: 60 dB below the peak
MIN_SEGMENTS, MAX_SEGMENTS = 5, 64  # of echoes that do not stay
STAYING = 1e-3         # bins, up to which an echo stays in its bin of range


class Envelope:
    """How large the response of a windowed transform of n samples to single tones may be."""

    def __init__(self, window, n: int):
        self._n, self._levels = n, _envelope(samples_of(window, n))

    def reach(self, sweep: float = 0.0) -> float:
        """Bins from a tone beyond which the response stays FLOOR_DB below its peak; sweep: bins, the largest, of the tone."""
        within = np.flatnonzero(self._levels > 10.0 ** (-FLOOR_DB / 20.0))[-1]
        return min(int(np.ceil(within / STEPS_PER_BIN)) + 1 + 0.5 * min(sweep, MAX_SWEEP), 0.5 * self._n)

    def bound(self, y, spread):
        """The largest that the response may be, [N], for a tone y [N] bins away that passes over `spread` [N] bins.

        Model: that of the tone's nearest bin, and no less than FLOOR_DB below the peak. Single tones may exceed it where
        they move, twice at most for windows without flat sidelobes; the power of many does not.
        """
        far = np.abs(y - np.rint(y / self._n) * self._n) - 0.5 * spread
        step = np.clip((far * STEPS_PER_BIN).astype(int), 0, len(self._levels) - 1)
        return np.maximum(self._levels.take(step), 10.0 ** (-FLOOR_DB / 20.0))


class Response:
    """Response of a windowed transform of n samples to a tone y bins away whose frequency rises by `sweep` bins, 1 at 0.

    In parts, one for each node between S segments of the samples, S + 1 (one without segments), whose weights fall linearly to
    the next nodes: what is known at the nodes is a line between them. reach: bins, within which it is known; None: as far as
    sweeps up to the largest take it
    Model: p^2 = 2 c p - c^2 + (p - c)^2 about a node c: it sees a tone c sweep bins nearer, whose sweep bends it by the square of
    the length of its part less. So S segments need steps (S / 2)^2 as wide for the same error.
    Memory: the table has 8 bytes for each node, sweep (257 / (S / 2)^2) and sixteenth of a bin: 33 kB a sample at most without
    segments or with 5 and more, 58 kB with the few that frames of 3 to 5 chirps have.
    """

    def __init__(self, window, n: int, largest_sweep: float = 0.0, segments: int = 1, reach: float | None = None):
        samples = samples_of(window, n)
        self._n = n
        self._step = SWEEP_STEP * (1.0 if segments == 1 else 0.5 * segments) ** 2
        self._largest = min(largest_sweep, MAX_SWEEP)
        self._middle = int(np.ceil(self._largest / self._step - 0.5))
        reach = Envelope(window, n).reach(self._largest) if reach is None else reach
        self._half = int((min(reach + 0.5 * self._largest, 0.5 * n) + 1.0) * STEPS_PER_BIN)
        place = (np.arange(n) - 0.5 * (n - 1)) / n
        self.nodes = np.array([0.5 * (n - 1)]) if segments == 1 else np.linspace(0.0, n - 1.0, segments + 1)  # in samples
        self.centres = (self.nodes - 0.5 * (n - 1)) / n  # [nodes], -1/2 to 1/2
        self.shares = np.stack([np.interp(np.arange(n), self.nodes, node) for node in np.eye(len(self.nodes))])  # [nodes, n]
        self._table = np.stack([self._transform(share * samples / samples.sum(), place - centre)
                                for centre, share in zip(self.centres, self.shares)])

    def __call__(self, y, sweep=0.0):
        """y: bins [N], folded into the axis, or [rows, N] for one node; sweep: bins [N] or one.

        Returns complex64 [nodes or rows, N].
        """
        sweep, centre = np.clip(sweep, -self._largest, self._largest), self.centres[:, None]
        y = y - centre * sweep
        turns = np.rint(y / self._n)
        sign = 1 - 2 * (turns.astype(int) * (self._n - 1) & 1)  # phases are those of the samples' middle
        row = np.clip(np.rint(sweep / self._step).astype(int) + self._middle, 0, 2 * self._middle)
        step = (y - turns * self._n) * STEPS_PER_BIN + self._half
        low = np.clip(step.astype(int), 0, 2 * self._half - 1)
        part = (sign * np.clip(step - low, 0.0, 1.0)).astype(np.float32)
        _, num_rows, num_steps = self._table.shape
        place = (np.arange(len(centre))[:, None] * num_rows + row) * num_steps + low
        first, second = self._table.take(place), self._table.take(place + 1)
        between = sign.astype(np.float32) * first + part * (second - first)
        bend = (np.pi * sweep * centre ** 2).astype(np.float32)
        return (np.cos(bend) - 1j * np.sin(bend)) * between

    def _transform(self, samples, place):
        """Of the samples of a node, places counted from it, at the steps of the table, [sweeps, steps]."""
        sweeps = self._step * np.arange(-self._middle, self._middle + 1)
        rows = samples * np.exp(1j * np.pi * np.outer(sweeps, place ** 2))
        steps = np.arange(-self._half, self._half + 1)
        values = np.fft.fft(rows, self._n * STEPS_PER_BIN)[:, steps % (self._n * STEPS_PER_BIN)]
        turned = values * np.exp(1j * np.pi * steps / STEPS_PER_BIN * (self._n - 1) / self._n)
        return turned.astype(np.complex64, order="C")  # a look-up would copy the whole of a table in another order


def segments_of(travel) -> np.ndarray:
    """Numbers of segments, [N], of echoes that go on by so many bins of range in the frame: one of those that stay, else what
    the fastest one needs, halved as often as leaves enough."""
    wanted = np.clip(np.ceil(SEGMENTS_PER_BIN * np.abs(travel)), MIN_SEGMENTS, MAX_SEGMENTS)
    most = wanted.max(initial=MIN_SEGMENTS)
    enough = np.ceil(most / 2.0 ** np.floor(np.log2(most / wanted)))
    return np.where(np.abs(travel) > STAYING, enough, 1.0).astype(int)


def responses_of(window, n: int, segments, sweep, reach: float) -> dict:
    """{segments: Response} of echoes that have so many (`segments_of`), [N], with a sweep in bins, [N]."""
    return {number: Response(window, n, np.abs(sweep[segments == number]).max(), min(number, max(n - 1, 1)), reach)
            for number in np.unique(segments).tolist()}


def _envelope(samples) -> np.ndarray:
    """The largest response to a tone that is so many steps of the table away or farther, up to half the axis."""
    response = np.abs(np.fft.rfft(samples, STEPS_PER_BIN * len(samples))) / samples.sum()
    return np.maximum.accumulate(response[::-1])[::-1]
