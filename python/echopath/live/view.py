"""What a live scene shows at one moment."""
from __future__ import annotations

import dataclasses
from collections.abc import Mapping

import numpy as np

from .. import _core
from ..base.classes.made_by import made_by
from ..base.text.counts import counted
from ..signals.parts import Parts


@made_by("ep.Live")
@dataclasses.dataclass(frozen=True, eq=False)
class LiveView:
    """The signal and map of a live scene after a change; made by `Live`.

    number: of the changes that it shows: 0 for the scene as it was given, one more for each change since
    cube: complex128 [tx, rx, chirp, sample], the noise-free IF signal in sqrt(W), read-only; of transmitters that send at once
        that of each alone, as of `decompose`
    map: RangeDoppler of it, with values [tx, rx, velocity, range]
    num_rays: of its record, about as many as were asked for; num_rays_shot: how many of these were shot for this view, the
        others kept
    num_paths_changed: paths whose signal was taken away or added
    is_preview: whether it has fewer rays than asked for, and a better one follows
    stages: {"trace", "signal", "map"}: what each took, in s
    parts: Parts, the cubes of the parts that `Live` was given and of "other", which add up to `cube`; None without parts
    """

    number: int
    cube: np.ndarray
    map: _core.RangeDoppler
    num_rays: int
    num_rays_shot: int
    num_paths_changed: int
    is_preview: bool
    stages: Mapping[str, float]
    parts: Parts | None = None

    @property
    def seconds(self) -> float:
        """What the view took, in s."""
        return sum(self.stages.values())

    def __repr__(self) -> str:
        kind = "preview" if self.is_preview else "view"
        return (f"LiveView({kind} of change {self.number}: {self.num_rays_shot:,} of {counted(self.num_rays, 'ray')} shot, "
                f"{counted(self.num_paths_changed, 'path')} changed, {1e3 * self.seconds:.0f} ms)")
