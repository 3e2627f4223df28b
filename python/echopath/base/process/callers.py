"""Where in the stack the user's own code is."""
from __future__ import annotations

import ast
import functools
import os
import sys
import warnings
from collections.abc import Callable

# As the code of the package names its files: unresolved, and apart from folders whose names only begin alike.
_PACKAGE = os.path.dirname(os.path.dirname(os.path.dirname(__file__))) + os.sep


def level_of_user(*beside: str) -> int:
    """The `stacklevel` with which the calling function warns at the line of the first caller outside the package.

    beside: folders of packages that belong to this one, whose lines are not the user's either
    """
    frame, level = sys._getframe(1), 1
    of_package = (_PACKAGE, *(os.path.join(folder, "") for folder in beside))
    while frame.f_back is not None and frame.f_code.co_filename.startswith(of_package):
        frame, level = frame.f_back, level + 1
    return level


def warn_user(text: str, category: type[Warning] = RuntimeWarning, *beside: str) -> None:
    """Warns at the line of the user. beside: as of `level_of_user`"""
    warnings.warn(text, category, stacklevel=level_of_user(*beside))


def at_line_of_user(work: Callable[[], object]) -> Callable[[], object]:
    """The same work for a thread: its warnings, those of the core too, name the line of the user that asks for it here.

    A thread's own stack ends in files of Python. This work is called by code that goes by the file and the line of the user,
    and shares what tells which warnings that module has seen: each is said as often as without the thread.
    """
    frame = sys._getframe(level_of_user() - 1)
    call = ast.increment_lineno(ast.parse("work()"), (frame.f_lineno or 1) - 1)
    of_user = frame.f_globals
    names = {"__name__": of_user.get("__name__", "<string>"),
             "__warningregistry__": of_user.setdefault("__warningregistry__", {}), "work": work}
    return functools.partial(exec, compile(call, frame.f_code.co_filename, "exec"), names)
