"""Foreign files by their suffix."""
from __future__ import annotations

import importlib
import os
from collections.abc import Mapping
from pathlib import Path

from ..checks import anything, checked, flag, optional, real, refused, text
from ..meshes import UNIT
from .model import Model

# suffix -> module of this package with `read(path, options) -> Model`; imported when the first such file is read
READERS: dict[str, str] = {}


@checked(unit=optional(UNIT), up=optional(text), materials=anything, animation=optional(text), loop=flag,
         offset=real(unit="s"))
def load_model(path: str | os.PathLike[str], *, unit: float | None = None, up: str | None = None,
               materials: Mapping[str, object] | None = None, animation: str | None = None, loop: bool = False,
               offset: float = 0.0) -> Model:
    """Reads a foreign scene or object."""
    path = Path(path)
    module = READERS.get(path.suffix.lower())
    if module is None:
        raise refused(ValueError, "path", f"a file of the kinds {', '.join(READERS)}", str(path))
    return importlib.import_module(f".{module}", __package__).read(path)
