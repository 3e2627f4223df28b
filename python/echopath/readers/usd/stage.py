"""Opens a USD stage, with what it warns of collected instead of printed."""
from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from ... import _core
from ...base.process.libraries import needed_module
from .trial import first_line, refuse_what_ends_usd, unreadable

LEFT_OUT = ("guide", "proxy")  # purposes that are not part of the scene
LONGEST, SHORTEST = 1e6, 1e-5  # s, from the first frame and between two samples


def pxr_module(name: str):
    """A module of usd-core. Raises ModuleNotFoundError that says what to install."""
    return needed_module(f"pxr.{name}", "reading USD files", library="usd-core", extra="usd")


@contextmanager
def opened(path: Path) -> Iterator[tuple[Any, list[str]]]:
    """(Usd.Stage, list of sentences that it warned of, filled as it is read). Raises FileError naming the file."""
    usd, tf, utils = (pxr_module(name) for name in ("Usd", "Tf", "UsdUtils"))
    refuse_what_ends_usd(path)
    delegate = utils.CoalescingDiagnosticDelegate()
    said: list[str] = []
    try:
        stage = usd.Stage.Open(str(path))
        if not stage:
            raise _core.FileError(f"{path}: is no USD stage")
        _check_rates(path, stage)
        yield stage, said
        said += dict.fromkeys(first_line(one.commentary) for one in delegate.TakeUncoalescedDiagnostics())
    except UnicodeError:  # of names and messages that USD passes on as they are
        raise unreadable(path, "it holds text that is not UTF-8") from None
    except tf.ErrorException as error:
        raise unreadable(path, first_line(_reason(error))) from None
    finally:
        delegate.TakeUncoalescedDiagnostics()


def _reason(error) -> str:
    try:
        return getattr(error.args[0], "commentary", "") if error.args else str(error)
    except UnicodeError:
        return "it holds text that is not UTF-8"


def _check_rates(path: Path, stage) -> None:
    """Raises FileError for a layer whose time stands still, on which USD itself computes without end."""
    for layer in stage.GetUsedLayers():
        for name in ("timeCodesPerSecond", "framesPerSecond"):
            rate = getattr(layer, name)
            if not (np.isfinite(rate) and rate != 0.0):
                raise _core.FileError(f"{path}: the layer '{layer.GetDisplayName()}' must have {name} other than 0, got {rate}")


class Timeline:
    """Times of a stage: codes of its samples, and seconds from its first frame. steps: whether samples hold until the next."""

    def __init__(self, stage):
        rate = stage.GetTimeCodesPerSecond()
        self._rate = rate if 1e-3 < rate < 1e9 else 24.0
        bounds = (stage.GetStartTimeCode(), stage.GetEndTimeCode()) if stage.HasAuthoredTimeCodeRange() else (0.0, 0.0)
        usable = all(abs(bound) < LONGEST * self._rate for bound in bounds)
        self.start, self.end = bounds if usable else (0.0, 0.0)
        self.steps = stage.GetInterpolationType() == pxr_module("Usd").InterpolationTypeHeld

    def usable(self, codes) -> list[float]:
        """Time codes in their order, without those that are no times; of two that are nearer than SHORTEST, between which the
        stage jumps, the earlier is by as much before the later."""
        usable: list[float] = []
        for code in sorted((code for code in codes if abs(code) < LONGEST * self._rate), reverse=True):
            if not usable or code < usable[-1]:
                usable.append(min(code, usable[-1] - SHORTEST * self._rate) if usable else code)
        return usable[::-1]

    def seconds(self, codes) -> np.ndarray:
        return (np.asarray(codes, float) - self.start) / self._rate


def matrix(value) -> np.ndarray:
    """A Gf.Matrix4d, which takes rows, as [4, 4] that takes columns."""
    return np.array(value, float).T


def changes_visibility(prim, usd_geom) -> bool:
    """Whether a prim is to be seen at some times only."""
    imageable = usd_geom.Imageable(prim)
    return bool(imageable) and imageable.GetVisibilityAttr().GetNumTimeSamples() > 1


def changes_points(instancer) -> bool:
    """Whether a point instancer has other prototypes, ids or masks at other times."""
    attributes = (instancer.GetProtoIndicesAttr(), instancer.GetIdsAttr(), instancer.GetInvisibleIdsAttr())
    return any(attribute.GetNumTimeSamples() > 1 for attribute in attributes)


def is_left_out(prim, time, usd_geom) -> str | None:
    """Why a prim with all below it takes no part, None where it does."""
    imageable = usd_geom.Imageable(prim)
    if not imageable:
        return None
    if imageable.GetVisibilityAttr().Get(time) == "invisible":
        return "an invisible prim is left out"
    purpose = imageable.GetPurposeAttr().Get()
    return f"a prim of the purpose '{purpose}' is left out" if purpose in LEFT_OUT else None
