"""Which part, object and ghost made each cell of a spectrogram, found while its frames go by."""
from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

import numpy as np

from ..arguments.checks import refused
from ..arguments.part_names import BESIDE, REST
from ..arguments.settings import LabelSettings
from ..frame.frame import Frame
from ..frame.maps import FrameMaps
from ..labels.part_cells import floor_over
from ..signals.beside import cubes_beside
from .bursts import Burst
from .parts_of_frame import PartsOfFrame
from .sliding import Stft
from .spectrogram_labels import SpectrogramLabels, labels_of

OBJECTS, FAMILIES = "objects", "families"  # views beside the partitions of frames
GHOSTS = "ghosts"                          # a part of the first
FAINT = 1e-2  # of the floor of the mask: ghosts that show no more, all of their paths in phase, have no part of their own


class Views:
    """The signals of all parts of all views of frames, transformed like the whole; parts may come and go with the frames."""

    def __init__(self, settings: LabelSettings, make_stft: Callable, part, channel):
        """make_stft: callable () that gives a new Stft; part, channel: as in `spectrogram`. Raises ValueError naming them."""
        if part is not None:
            raise refused(ValueError, "part", "None with labels, which tell of all parts", part)
        for name, only in (("plane", "range_doppler"), ("errors", False)):
            if getattr(settings, name) != only:
                raise refused(ValueError, f"labels.{name}", f"{only!r} for spectrograms", getattr(settings, name))
        self._settings, self._make_stft, self._channel = settings, make_stft, channel
        self._whole, self._views = make_stft(), {}
        self._echoes: Stft | None = None  # of paths alone, as soon as a frame has something else beside them
        self._frame, self._gone = None, []

    def seen(self, frames: Iterable) -> Iterator:
        """The frames, one after the other, each of which is remembered for `add`. Raises TypeError for cubes."""
        for frame in frames:
            if not isinstance(frame, Frame | FrameMaps):  # `bursts` refuses the latter
                raise refused(TypeError, "labels", "None for cubes, of whose echoes nobody knows what made them", self._settings)
            self._frame = frame
            yield frame

    def add(self, burst: Burst) -> None:
        """Takes the signals of the frame that a burst is of."""
        frame, self._frame = self._frame, None
        beside = {name: self._of_channel(cube) for name, cube in cubes_beside(frame).items()}
        whole = self._of_channel(frame.cube)
        if beside and self._echoes is None:
            self._echoes = self._whole.copy()
        if self._echoes is not None:
            self._echoes.add(burst._replace(cube=whole))
        self._whole.add(burst._replace(cube=whole + sum(beside.values())))
        nothing = np.zeros_like(whole)
        for view, cubes in self._cubes(frame).items():
            stfts = self._views.setdefault(view, {})
            cubes |= beside
            for name in [name for name in cubes if name not in stfts]:
                stfts[name] = self._make_stft()
                for before in self._gone:
                    stfts[name].add(before._replace(cube=nothing))
            for name, stft in stfts.items():
                stft.add(burst._replace(cube=cubes.get(name, nothing)))
        self._gone.append(burst._replace(cube=None))

    def labels(self) -> dict[str, SpectrogramLabels]:
        """{view: its labels}."""
        whole = self._whole.result(None)
        echoes = whole if self._echoes is None else self._echoes.result(None)
        strongest = float(np.max(echoes.power, initial=0.0))
        found = {}
        for view, stfts in self._views.items():
            last = [name for name in (GHOSTS, REST, *BESIDE) if name in stfts]  # those of later frames stand before them
            parts = {name: stfts[name].result(None) for name in (*(name for name in stfts if name not in last), *last)}
            found[view] = labels_of(parts, whole, self._settings.margin_db, self._settings.dynamic_range_db, strongest)
        return found

    def _cubes(self, frame: Frame) -> dict[str, dict]:
        """{view: {part: cube}} without what no path makes."""
        taken = [name for name in (OBJECTS, FAMILIES) if name in frame.parts]
        if taken:
            raise refused(ValueError, "labels", f"None for frames whose partitions are called '{OBJECTS}' or '{FAMILIES}'", taken)
        partitions = {view: {name: self._of_channel(cube) for name, cube in cubes.items()} for view, cubes in frame.parts.items()}
        found = PartsOfFrame(frame, self._settings.objects, FAINT * self._floor(), self._channel)
        if taken := [name for name in found.objects if name in (GHOSTS, REST, *BESIDE)]:
            raise refused(ValueError, "labels.objects", "{another name: glob} for objects whose names other parts have", taken)
        rest = {REST: found.rest}
        of_objects = found.objects | ({GHOSTS: sum([*found.ghosts.values(), found.faint])} if found.has_ghosts else {}) | rest
        return partitions | {OBJECTS: of_objects, FAMILIES: found.objects | found.ghosts | {REST: found.rest + found.faint}}

    def _floor(self) -> float:
        """W, of the mask: what is below is in the noise."""
        return floor_over(self._whole.noise_power, self._settings.margin_db)

    def _of_channel(self, cube):
        if self._channel is None:
            return cube
        tx, rx = self._channel
        return cube[tx:tx + 1, rx:rx + 1]

