"""Kinds of files, as dialogs offer them."""
from __future__ import annotations

from echopath.frame_file.opening import SUFFIXES

FRAMES, VIEWS = f"Frames ({' '.join(f'*{suffix}' for suffix in SUFFIXES)})", "Views (*.json)"
