"""A scene that is changed while its map is watched: scene -> kept record -> kept signal -> view, again after each change."""
from .live import Live
from .view import LiveView
from .watch import Watch

__all__ = ["Live", "LiveView", "Watch"]
