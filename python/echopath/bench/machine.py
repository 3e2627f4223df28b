"""Which machine a benchmark ran on."""
from __future__ import annotations

import platform
from pathlib import Path

import numpy as np

import echopath as ep

from ..base.storage.origin import FIXED_SEEDS


def machine() -> dict:
    """Processor, threads, versions and seeds, as the JSON of a benchmark has them."""
    return {"processor": _processor(), "threads": ep.num_threads(), "instruction_set": ep._core.instruction_set(),
            "system": platform.platform(), "python": platform.python_version(),
            "numpy": np.__version__, "echopath": ep.__version__,
            "seeds": FIXED_SEEDS}


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.machine()
