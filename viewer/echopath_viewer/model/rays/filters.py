"""Which paths are shown, by bounces, power, mesh and path expression."""
from __future__ import annotations

import dataclasses

import numpy as np

import echopath as ep

MAX_BOUNCES = 64


class FilterError(ValueError):
    """What is wrong with a filter; `field`: "mesh" or "expression", where it was typed."""

    def __init__(self, field: str, text: str):
        super().__init__(text)
        self.field = field


@dataclasses.dataclass(frozen=True)
class Filters:
    """All must hold for a path to be shown.

    min_bounces, max_bounces: number of hits, both included
    min_power_dbm: dB re 1 mW at the channel shown, None: any
    mesh: glob of meshes of which the path must hit one, "": any
    expression: path expression or text of a selection (`ep.Selection`), "": any
    """

    min_bounces: int = 0
    max_bounces: int = MAX_BOUNCES
    min_power_dbm: float | None = None
    mesh: str = ""
    expression: str = ""

    def mask(self, columns, matches):
        """Bool [P]; matches: callable (Selection) -> bool [P]. Raises FilterError for bad texts."""
        mask = (columns.num_bounces >= self.min_bounces) & (columns.num_bounces <= self.max_bounces)
        if self.min_power_dbm is not None:
            mask &= columns.is_at_least(self.min_power_dbm)
        for field, parse in (("mesh", _touching), ("expression", ep.Selection)):
            text = getattr(self, field).strip()
            if text:
                mask &= _checked(field, lambda text=text, parse=parse: matches(parse(text)))
        return mask

    def selection(self):
        """The same in words, a Selection; None for a filter by power, which has none. The texts are good ones."""
        if self.min_power_dbm is not None:
            return None
        selection = (ep.num_bounces >= self.min_bounces) & (ep.num_bounces <= self.max_bounces)
        for field, parse in (("mesh", _touching), ("expression", ep.Selection)):
            text = getattr(self, field).strip()
            if text:
                selection = selection & parse(text)
        return selection

    def describe(self) -> str:
        """In a few words; "" where nothing is filtered."""
        words = []
        if self.min_bounces > 0 or self.max_bounces < MAX_BOUNCES:
            words.append(f"{self.min_bounces} to {self.max_bounces} bounces")
        if self.min_power_dbm is not None:
            words.append(f"at least {self.min_power_dbm:g} dBm")
        if self.mesh.strip():
            words.append(f"over {self.mesh.strip()}")
        if self.expression.strip():
            words.append(self.expression.strip())
        return ", ".join(words)


def _touching(glob: str):
    if "'" in glob:
        raise ValueError(f"a mesh name has no quotes, got {glob}")
    return ep.hits(glob)


def _checked(field: str, work):
    try:
        return np.asarray(work(), bool)
    except ValueError as error:
        raise FilterError(field, str(error)) from None
