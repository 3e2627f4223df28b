"""What the rays of a dataset do not resolve: a file beside the frames of each scene, of its first frame."""
from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterable
from pathlib import Path
from typing import Any, NamedTuple

from ..arguments.names import first_names
from ..base.storage.files import write_texts
from ..base.text.counts import counted
from ..frame.unresolved import unresolved_of_frame
from ..paths.resolution import RESOLVED_DB

NAME = "unresolved.json"


class UnresolvedEchoes(NamedTuple):
    """num_rays: of the first frame of a scene; echoes: names of what they do not resolve there, each once: objects, "ghosts of"
    objects, the surroundings."""

    num_rays: int
    echoes: tuple[str, ...]


def write_unresolved(folder: Path, frame: Any, labels: dict[str, Any] | None) -> None:
    """Writes what the rays of a frame do not resolve. labels: keywords of its labels, whose objects are meant, None: none"""
    found = unresolved_of_frame(frame, (labels or {}).get("objects"))
    echoes = dict.fromkeys(f"ghosts of {one.name}" if one.via else one.name for one in found)
    told = {"num_rays": int(frame.paths.frame.statistics.num_rays), "echoes": list(echoes)}
    write_texts(folder, {NAME: json.dumps(told, indent=1) + "\n"})


def unresolved_in(content: bytes) -> UnresolvedEchoes | None:
    """What the content of such a file says; None: nothing that can be read."""
    try:
        told = json.loads(content)
        return UnresolvedEchoes(int(told["num_rays"]), tuple(map(str, told["echoes"])))
    except (ValueError, KeyError, TypeError, OverflowError, RecursionError):
        return None


def summary(scenes: Iterable[UnresolvedEchoes]) -> list[str]:
    """One line about all scenes of a run; none where nobody knows anything of them."""
    known = list(scenes)
    if not known:
        return []
    rays = sorted({one.num_rays for one in known})
    of_rays = f"{rays[0]:,} rays" if len(rays) == 1 else f"{rays[0]:,} to {rays[-1]:,} rays"
    doubtful = [one for one in known if one.echoes]
    frames = f"the first frames of {counted(len(known), 'scene')}" if len(known) > 1 else "the first frame of 1 scene"
    if not doubtful:
        return [f"{frames}: {of_rays} resolve every object and ghost above the noise to {RESOLVED_DB:g} dB"]
    often = Counter(name for one in doubtful for name in one.echoes).most_common()
    names = first_names([f"{name} ({count})" for name, count in often])
    return [f"{len(doubtful)} of {frames} {'have' if len(doubtful) > 1 else 'has'} echoes above the noise that {of_rays} do not "
            f"resolve to {RESOLVED_DB:g} dB: {names}; more num_rays of [trace] do"]
