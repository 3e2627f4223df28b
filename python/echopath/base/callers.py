"""Where in the stack the user's own code is."""
from __future__ import annotations

import os
import sys
import warnings

# As the code of the package names its files: unresolved, and apart from folders whose names only begin alike.
_PACKAGE = os.path.dirname(os.path.dirname(__file__)) + os.sep


def level_of_user() -> int:
    """The `stacklevel` with which the calling function warns at the line of the first caller outside the package."""
    frame, level = sys._getframe(1), 1
    while frame.f_back is not None and frame.f_code.co_filename.startswith(_PACKAGE):
        frame, level = frame.f_back, level + 1
    return level


def warn_user(text: str, category: type[Warning] = RuntimeWarning) -> None:
    """Warns at the line of the user."""
    warnings.warn(text, category, stacklevel=level_of_user())
