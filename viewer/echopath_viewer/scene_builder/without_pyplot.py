"""Imports pyvista without the parts of matplotlib that it asks for and that no picture of ours needs: 0.2 s of a start."""
from __future__ import annotations

import importlib
import sys
import types

CHECKER = "mypy"  # which pyvista imports wherever it is installed, for those who check types
PLACES = ("matplotlib.pyplot", "matplotlib.backends.backend_agg")  # of what pyvista's charts alone use


class _Later(types.ModuleType):
    """Stands for a module while pyvista is imported: what is taken of it then is imported when it is called, what is taken
    later at once."""

    is_early = True

    def __getattr__(self, name: str):
        if name.startswith("__"):
            raise AttributeError(name)
        if not _Later.is_early:
            return getattr(importlib.import_module(self.__name__), name)
        return lambda *arguments, **keywords: getattr(importlib.import_module(self.__name__), name)(*arguments, **keywords)


def import_pyvista() -> None:
    """Imports all of pyvista that draws; as it is where it wants more of those modules than to call what is in them."""
    if "pyvista.plotting" in sys.modules or not sys.modules.keys().isdisjoint(PLACES):
        return
    places = dict.fromkeys({CHECKER} - sys.modules.keys()) | {place: _Later(place) for place in PLACES}
    sys.modules.update(places)
    try:
        importlib.import_module("pyvista.plotting")
    except (TypeError, AttributeError):
        return  # whoever imports it next gets it with all that it asks for
    finally:
        _Later.is_early = False
        for place in places:
            del sys.modules[place]
