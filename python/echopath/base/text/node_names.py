"""Names of files made fit for a scene."""
from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable

MAX_NAME = 64  # letters of a node's own name; a scene keeps those of all nodes above it, too
_UNFIT = re.compile(r"[/*?'\"\x00-\x1f\x7f\ud800-\udfff]+")


def composed(text: str) -> str:
    """A name with each letter and its marks as one sign, as keyboards write it: files of macOS take them apart."""
    return unicodedata.normalize("NFC", text)


def fit_name(text: str, instead: str = "node") -> str:
    """A name that a scene takes: signs that it refuses become '_', long ones are cut; `instead` where nothing is left."""
    return _UNFIT.sub("_", composed(str(text))[:MAX_NAME]).strip() or instead


def fit_paths(names: Iterable[str]) -> list[str]:
    """Names of the groups of a file, each once, whose '/' part them into groups of groups, as a scene takes them.

    A group that has a mesh of its own beside groups has it below itself, under its own name: "car" beside "car/wheel" is
    "car/car".
    """
    paths = ["/".join(fit_name(part, "part") for part in name.split("/")) for name in names]
    above = {path[:end] for path in paths for end in range(len(path)) if path[end] == "/"}
    taken = dict.fromkeys(above, 1)
    return [unique(f"{path}/{path.rpartition('/')[2]}" if path in above else path, taken) for path in paths]


def unique(name: str, taken: dict[str, int]) -> str:
    """The name, with a number where it is taken; takes it."""
    free = name
    while free in taken:
        taken[name] += 1
        free = f"{name}_{taken[name]}"
    taken[free] = 1
    return free
