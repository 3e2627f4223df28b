"""The frames of a Sequence as a time line: simulated in a thread, kept in files of a folder that goes away with it."""
from __future__ import annotations

import tempfile
import threading
from pathlib import Path

import echopath as ep

from .time_line import TimeLine, written_frames


class _Stopped(Exception):
    """Nobody wants further frames."""


class SimulatedFrames(TimeLine):
    """Grows by a frame as soon as its file is written, so that memory does not grow with the number of frames."""

    def __init__(self, sequence):
        """sequence: ep.Sequence; its first frame is there when this returns. Raises what simulating it raises."""
        self._folder = tempfile.TemporaryDirectory(prefix="echopath-frames-", ignore_cleanup_errors=True)
        self._is_wanted = True
        self._frames = sequence.save_frames(self._folder.name, progress=self._hear)
        try:
            next(self._frames)
        except BaseException:
            self._folder.cleanup()
            raise
        stored = ep.load_sequence(Path(self._folder.name))
        super().__init__(repr(sequence), lambda: written_frames(stored), len(sequence))
        self._thread = threading.Thread(target=self._write_all, daemon=True)
        self._thread.start()

    def _hear(self, _stage: str, _fraction: float) -> None:
        if not self._is_wanted:
            raise _Stopped

    def _write_all(self) -> None:
        try:
            for _ in self._frames:
                pass
        except _Stopped:
            return
        except (ValueError, OSError, RuntimeError, MemoryError) as error:
            self.failure = str(error)

    def close(self) -> None:
        """Ends the simulation and takes the folder away."""
        self._is_wanted = False
        self._thread.join()
        self._folder.cleanup()
