"""The signal of some of the paths, each transmitter alone, made as that of the frame was."""
from __future__ import annotations

import dataclasses

import echopath as ep
from echopath.transmit import synthesize_slots

NO_WORDS = ("signal: this frame is traced anew within (retrace='{}'), so that its later paths are known by expressions "
            "alone; rays chosen by power, by cells or by signals without selections have no signal of their own")


@dataclasses.dataclass(frozen=True)
class Signals:
    """paths: of `trace`; spectrum_settings: of `range_doppler`; evaluate, retrace, keyframes, replay: of `synthesize`."""

    paths: object
    spectrum_settings: dict
    evaluate: str = "interpolated"
    retrace: str = "never"
    keyframes: int = 0
    replay: str = "material"

    @property
    def settings(self) -> dict:
        """Keywords of `synthesize` and `decompose`."""
        return {"evaluate": self.evaluate, "retrace": self.retrace, "keyframes": self.keyframes, "replay": self.replay}

    @property
    def is_sum_over_paths(self) -> bool:
        """Whether the paths of the record are all there are, in stretches that do not depend on which of them are taken."""
        return self.retrace == "never" or (self.retrace == "invalid" and self.keyframes > 0)

    def cube(self, mask, selection=None, progress=None):
        """The signal of some paths, without noise: complex [tx, rx, chirp, sample], sqrt(W).

        mask: bool [P]; selection: the same in words, None: there are none
        Raises ValueError where the frame is traced anew and there are no words.
        """
        if self.is_sum_over_paths:
            return self._separate(self.paths.select(mask), progress)
        if selection is None:
            raise ValueError(NO_WORDS.format(self.retrace))
        return ep.decompose(self.paths, None, {"shown": selection}, progress=progress, **self.settings)["shown"]

    def whole(self, progress=None):
        """The signal of all paths, without noise: complex [tx, rx, chirp, sample], sqrt(W)."""
        return self._separate(self.paths, progress)

    def _separate(self, paths, progress):
        """Of transmitters that send at once, too: maps and chirps are those of each alone."""
        return synthesize_slots(paths, self.paths.radar, progress=progress, **self.settings)

    def spectrum(self, mask, selection=None, progress=None):
        """The map of the same, RangeDoppler."""
        return self.map_of(self.cube(mask, selection, progress))

    @property
    def num_ranges(self) -> int:
        """Of the maps; of an odd number of real samples half a cell more than half of them."""
        waveform, zero_pad = self.paths.radar.waveform, self.spectrum_settings.get("zero_pad", 1)
        padded = waveform.num_samples * zero_pad
        return (padded + 1) // 2 if waveform.real else padded

    def map_of(self, cube):
        """The map of a cube, RangeDoppler."""
        return ep.range_doppler(cube, self.paths.radar, **self.spectrum_settings)


def both(first, second):
    """The selection of what two take; None where one of them has no words."""
    return None if first is None or second is None else first & second


def selections_of(group: dict) -> list:
    """The selection of each part of a partition {name: selection}, where the first that takes a path has it, and of the
    rest."""
    taken, found = None, []
    for selection in map(_selection, group.values()):
        found.append(selection if taken is None else selection & ~taken)
        taken = selection if taken is None else taken | selection
    return [*found, all_paths() if taken is None else ~taken]


def all_paths():
    """The selection of every path."""
    return ep.num_bounces >= 0


def _selection(words):
    return ep.Selection(words) if isinstance(words, str) else words
