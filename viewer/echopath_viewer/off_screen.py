"""What draws pictures of the scene where there is no screen."""
from __future__ import annotations

import ctypes
import os
import sys
from pathlib import Path

# Libraries that draw without a screen, by the window of VTK that they serve; the first that are there are taken.
RENDERERS = {"vtkEGLRenderWindow": ("libGL.so.1", "libEGL.so.1"), "vtkOSOpenGLRenderWindow": ("libOSMesa.so.8",)}
ASKED = "VTK_DEFAULT_OPENGL_WINDOW"  # variable with the window that VTK shall take
OWN = Path(__file__).parent  # where wheels have libOSMesa.so.8


def needs_renderer(off_screen) -> bool:
    """Whether VTK would look for a screen that is not there: a picture without one on Linux."""
    return bool(off_screen) and sys.platform == "linux" and not os.environ.get("DISPLAY")


def renderer() -> str:
    """The window of VTK that draws without a screen here, the one that the user asks VTK for where there is one; "" where none
    does."""
    return next((window for window, libraries in _windows().items() if all(map(_is_there, libraries))), "")


def lacking() -> str:
    """What to install where no renderer is there."""
    needed = ", or ".join(" and ".join(libraries) for libraries in _windows().values())
    if asked := os.environ.get(ASKED):
        return f"{ASKED}={asked} needs {needed}, got none"
    return f"pictures without a screen need {needed}, got neither (Debian: libgl1 and libegl1)"


def _windows() -> dict:
    """Those that come into question; of one that is not known here VTK knows what it needs."""
    asked = os.environ.get(ASKED)
    return {asked: RENDERERS.get(asked, ())} if asked else RENDERERS


def _is_there(library: str) -> bool:
    """Whether a library of the machine, or the wheel's own of that name, loads. VTK, which asks by the name alone, then gets
    the one that is loaded."""
    return _loads(library) or ((OWN / library).exists() and _loads(str(OWN / library)))


def _loads(library: str) -> bool:
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True
