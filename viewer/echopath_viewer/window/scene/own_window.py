"""The scene as a window of its own on the screen."""
from __future__ import annotations

from ..qt import Qt, QtCore, QtGui


def give_own_window(widget) -> None:
    """Has the screen hold a widget that draws with OpenGL as a window of its own inside the one around it.

    Else each change of any widget has the whole window composed with OpenGL, which takes software as long as a picture of the
    scene: a slider that is dragged would halve the rate of a live scene. Before the window is shown, and after its panels have
    their places.
    """
    if QtGui.QGuiApplication.platformName() == "xcb":
        # Panels beside it would get windows, too, and Qt would complain of each menu over them.
        QtCore.QCoreApplication.setAttribute(Qt.ApplicationAttribute.AA_DontCreateNativeWidgetSiblings)
        widget.setAttribute(Qt.WidgetAttribute.WA_DontCreateNativeAncestors)
        widget.setAttribute(Qt.WidgetAttribute.WA_NativeWindow)
