"""Tracks of detections from frame to frame, beside the truth."""
from .record import Tracks
from .track import track

__all__ = ["Tracks", "track"]
