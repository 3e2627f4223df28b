"""How cells are to be labelled, checked, and by what."""
from __future__ import annotations

import dataclasses
from collections.abc import Mapping

import numpy as np

from .. import _core
from ..arguments.checks import refused
from ..arguments.keywords import refuse_unknown
from ..arguments.settings import LabelSettings, SignalSettings
from ..paths.families import families as find_families
from ..paths.resolution import mean_powers
from ..paths.subset import part_of_path
from ..signals.parts import ONLY_PARTITION
from ..signals.same_radar import difference
from .part_cells import floor_over, masks_of
from .planes import make_plane
from .standard_errors import require_batches


@dataclasses.dataclass(frozen=True)
class Request:
    """How the cells of a radar's map are to be labelled, checked; made by `make_request`. Fields as in `annotate`.

    noise_margin_db: dB, minus infinity: no cell is in the noise
    """

    radar: object
    objects: object
    plane: object
    noise_margin_db: float
    dynamic_range_db: float
    errors: bool

    @property
    def dynamic_range(self) -> float:
        """Ratio of powers, 0: no limit."""
        return 10.0 ** (-self.dynamic_range_db / 10.0)

    @property
    def noise_floor(self) -> float:
        """Power in W that cells above the noise exceed."""
        return floor_over(self.plane.noise_power, self.noise_margin_db)

    def masks(self, powers):
        """(above_noise, mask), bool [V, R] of ViewPowers."""
        return masks_of(powers.whole, self.noise_floor, self.dynamic_range, powers.strongest)


def as_label_settings(labels: bool | LabelSettings | Mapping | None) -> LabelSettings | None:
    """How to label by what a caller gave as `labels`: True, or keywords of LabelSettings; None: not at all."""
    if labels is None or labels is False:
        return None
    if labels is True or isinstance(labels, LabelSettings):
        return LabelSettings() if labels is True else labels
    if not isinstance(labels, Mapping):
        raise refused(TypeError, "labels", "True, False, LabelSettings or a dict of their keywords", labels)
    refuse_unknown("labels", labels, LabelSettings.RULES)
    return LabelSettings(**labels)


def make_request(radar, num_batches: int, settings: LabelSettings, *, window=SignalSettings.window,
                 zero_pad=SignalSettings.zero_pad, angles=None) -> Request:
    """Checks what can be checked before the long work. num_batches: of the trace; the others as in `annotate`.

    Raises ValueError.
    """
    if settings.errors:
        require_batches(num_batches)
    made = make_plane(settings.plane, radar, window, zero_pad, angles)
    if settings.errors:
        made.require_errors()
    dynamic_range_db = np.inf if settings.dynamic_range_db is None else settings.dynamic_range_db
    return Request(radar, settings.objects, made, settings.margin_db, dynamic_range_db, settings.errors)


@dataclasses.dataclass(frozen=True)
class Labelling:
    """What cells are labelled by, beside the powers of the parts; made by `labelling_of`.

    selections: {partition: {name: selection}}; settings: signal settings of `decompose`
    seen: the paths, with the radar of the request in place of that which traced them: what powers by themselves are received by
    families: Families of the paths; mean: MeanPowers of these and of the parts of selections
    """

    request: Request
    paths: _core.Paths
    seen: _core.Paths
    families: object
    selections: dict
    settings: dict
    mean: object


def labelling_of(request: Request, paths, selections: dict, settings: dict) -> Labelling:
    """What the cells of these paths are labelled by; arguments: fields of Labelling, paths those that were traced."""
    families, seen = find_families(paths, request.objects), _seen_by(request.radar, paths)
    return Labelling(request, paths, seen, families, selections, settings, _powers_received(seen, families, selections))


def _seen_by(radar, paths):
    """The paths with a radar in place of that which traced them."""
    if not difference(radar, paths.radar, paths.frame.start_time):
        return paths
    return _core.Paths.from_arrays(**paths.__getstate__() | {"radar": radar})


def _powers_received(paths, families, selections: dict):
    """MeanPowers of the families and of the parts of partitions {partition: {name: selection}}; without any, of all paths."""
    groups = {partition: (part_of_path(paths, chosen), len(chosen) + 1)
              for partition, chosen in (selections or {ONLY_PARTITION: {}}).items()}
    return mean_powers(paths, families, groups)
