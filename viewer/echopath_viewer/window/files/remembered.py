"""What the window remembers from one time to the next: files, sizes."""
from __future__ import annotations

from pathlib import Path

from ..qt import QtCore

MOST_FILES = 8
LAYOUT_VERSION = 1  # grows when panels get other names


def settings() -> QtCore.QSettings:
    """In a file of the user's own, below the usual folder of settings."""
    return QtCore.QSettings(QtCore.QSettings.Format.IniFormat, QtCore.QSettings.Scope.UserScope, "echopath", "viewer")


def recent_files() -> list[str]:
    """Frame files that were opened, latest first, those that are still there."""
    names = settings().value("recent", []) or []
    return [name for name in ([names] if isinstance(names, str) else names) if Path(name).exists()]


def remember_file(path) -> None:
    """As the latest."""
    name = str(Path(path).resolve())
    settings().setValue("recent", [name, *(other for other in recent_files() if other != name)][:MOST_FILES])


def remember_layout(window) -> None:
    """Size of a window and where its panels are."""
    kept = settings()
    kept.setValue("geometry", window.saveGeometry())
    kept.setValue("panels", window.saveState(LAYOUT_VERSION))


def restore_layout(window) -> None:
    """As it was the last time, as far as that is known."""
    kept = settings()
    if kept.value("geometry") is not None:
        window.restoreGeometry(kept.value("geometry"))
    if kept.value("panels") is not None:
        window.restoreState(kept.value("panels"), LAYOUT_VERSION)
