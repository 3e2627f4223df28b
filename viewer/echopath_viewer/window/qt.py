"""The one import of Qt."""
import os

os.environ.setdefault("QT_API", "pyside6")

from qtpy import QtCore, QtGui, QtWidgets  # noqa: E402
from qtpy.QtCore import Qt, Signal  # noqa: E402

__all__ = ["Qt", "QtCore", "QtGui", "QtWidgets", "Signal"]
