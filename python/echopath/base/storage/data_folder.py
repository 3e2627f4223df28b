"""Where the data is that comes with echopath."""
from __future__ import annotations

from importlib import resources
from pathlib import Path


def data_folder(name: str):
    """A folder or file of the data that comes with echopath: of the installed package, or of the source tree beside it."""
    try:
        return resources.files("echopath.data") / name
    except ModuleNotFoundError:
        return Path(__file__).resolve().parents[4] / "data" / name
