"""Libraries that are loaded late, where a call needs them: the package itself loads faster, and some are not always there."""
from __future__ import annotations

import importlib
from types import ModuleType

from .interrupts import interrupts_wait


def load_whole(name: str) -> ModuleType:
    """The module `name`; Ctrl-C waits until it has loaded.

    Modules of h5py, and others made by Cython, cannot be loaded again in a process where Ctrl-C ended their first loading.
    """
    with interrupts_wait():
        return importlib.import_module(name)


def needed_module(name: str, user: str, *, extra: str, library: str = "") -> ModuleType:
    """The module `name` of a library that is not always installed.

    user: what needs it, for the message; extra: that of echopath which brings it; library: its name where packages are installed
    from, if not that of the module. Raises ModuleNotFoundError that says what to install.
    """
    package = name.partition(".")[0]
    try:
        return load_whole(name)
    except ModuleNotFoundError as error:
        if (error.name or "").partition(".")[0] != package:
            raise
        text = f"{user} needs {library or package}, which is not installed: pip install 'echopath[{extra}]'"
        raise ModuleNotFoundError(text, name=library) from None
