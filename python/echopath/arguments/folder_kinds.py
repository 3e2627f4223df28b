"""What a folder of ours holds, for the messages of those who ask it for something else."""
from __future__ import annotations

import os

# {a file that is in it: what the folder holds}, those first that others may lie in.
_HOLDS = {"dataset.toml": "a dataset, which echopath.dataset.open reads",
          "sequence.h5": "frames in time, which ep.load_sequence reads",
          "frame.h5": "the frame of a run, frame.h5, which ep.load_frame reads"}


def folder_hint(folder: str | os.PathLike[str]) -> str:
    """"; the folder holds ..." of a folder that we have written, "" of any other place."""
    return next((f"; the folder holds {kind}" for head, kind in _HOLDS.items() if os.path.isfile(os.path.join(folder, head))), "")
