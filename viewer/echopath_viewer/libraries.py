"""What Qt needs of the system."""
from __future__ import annotations

LIBRARIES = ("libgl1 libegl1 libdbus-1-3 libfontconfig1 libglib2.0-0 libxkbcommon-x11-0 libxcb-cursor0 libxcb-icccm4 "
             "libxcb-keysyms1 libxcb-shape0")  # Debian's packages of what Qt's window is linked with


def missing_library(error: Exception) -> OSError:
    """What to raise where the system lacks a library of Qt, which the error names."""
    return OSError(f"the viewer's window needs a library of the system: {error} (Debian: apt install {LIBRARIES})")
