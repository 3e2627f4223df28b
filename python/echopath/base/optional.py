"""Libraries that only some calls need."""
from __future__ import annotations

import importlib


def needed_module(name: str, user: str):
    """The module of a library that is not always installed; user: what needs it, for the message.

    Raises ModuleNotFoundError that says what to install.
    """
    try:
        return importlib.import_module(name)
    except ModuleNotFoundError as error:
        if (error.name or "").partition(".")[0] != name.partition(".")[0]:
            raise
        library = name.partition(".")[0]
        text = f"{user} needs {library}, which is not installed: pip install {library}"
        raise ModuleNotFoundError(text, name=library) from None
