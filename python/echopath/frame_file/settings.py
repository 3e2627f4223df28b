"""Settings in attributes of files, as JSON."""
from __future__ import annotations

import json
from typing import Any

import numpy as np

from .h5 import write_attribute


def write_setting(group, name: str, value: Any) -> None:
    """Writes what a caller gave, numbers and arrays of NumPy, too, as an attribute."""
    write_attribute(group, name, json.dumps(value, default=_plain))


def _plain(value) -> Any:
    """What JSON does not know: arrays and NumPy's numbers, selections."""
    return value.tolist() if isinstance(value, (np.ndarray, np.generic)) else str(value)
