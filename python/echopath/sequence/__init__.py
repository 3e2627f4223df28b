"""Frames in time: simulated one by one, kept in a folder, read again."""
from .saving import SavedFrame
from .sequence import Sequence
from .stored import StoredSequence, load_sequence

__all__ = ["SavedFrame", "Sequence", "StoredSequence", "load_sequence"]
