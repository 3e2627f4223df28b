"""The window: thin Qt around the model and the scene builder."""
from .app import view
from .main_window import MainWindow

__all__ = ["MainWindow", "view"]
