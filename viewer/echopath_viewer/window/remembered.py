"""What the window remembers from one time to the next: files, sizes."""
from __future__ import annotations

from pathlib import Path

from .qt import QtCore

MOST_FILES = 8


def settings() -> QtCore.QSettings:
    """In a file of the user's own, below the usual folder of settings."""
    return QtCore.QSettings(QtCore.QSettings.Format.IniFormat, QtCore.QSettings.Scope.UserScope, "echopath", "viewer")


def recent_files() -> list[str]:
    """Frame files that were opened, latest first, those that are still there."""
    names = settings().value("recent", []) or []
    return [name for name in ([names] if isinstance(names, str) else names) if Path(name).is_file()]


def remember_file(path) -> None:
    """As the latest."""
    name = str(Path(path).resolve())
    settings().setValue("recent", [name, *(other for other in recent_files() if other != name)][:MOST_FILES])


def remember_layout(window, splitters: dict) -> None:
    """Size of a window and {name: splitter} of it."""
    kept = settings()
    kept.setValue("geometry", window.saveGeometry())
    for name, splitter in splitters.items():
        kept.setValue(f"splitter/{name}", splitter.saveState())


def restore_layout(window, splitters: dict) -> None:
    """As it was remembered, where it was."""
    kept = settings()
    if kept.value("geometry") is not None:
        window.restoreGeometry(kept.value("geometry"))
    for name, splitter in splitters.items():
        if kept.value(f"splitter/{name}") is not None:
            splitter.restoreState(kept.value(f"splitter/{name}"))
