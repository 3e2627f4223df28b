"""Mean received powers of paths."""
from __future__ import annotations

from .. import _core
from ..arguments.checks import LARGEST_COUNT, ArrayLike, Progress, array, checked, count, row_of_channel


@checked()
def received_power(paths: _core.Paths, *, tx: int = 0, rx: int = 0, progress: Progress = None) -> _core.ReceivedPower:
    """Mean received power of paths with its interval, for the whole of a trace or any selection of it.

    paths: of a trace, with batches for standard errors
    tx, rx: indices of the antennas
    progress: callable (stage, fraction), True for bars, or None
    Returns a ReceivedPower, in W. Raises TypeError or ValueError naming the argument, IndexError for antennas that are not
    there, KeyboardInterrupt on Ctrl-C.
    """
    row_of_channel(paths, tx, rx)
    return _core.received_power(paths, tx=tx, rx=rx, progress=progress)


@checked(group_of_path=array("[P]", kind="whole"), num_groups=count(1, LARGEST_COUNT))
def received_powers(paths: _core.Paths, group_of_path: ArrayLike, num_groups: int, *, tx: int = 0, rx: int = 0,
                    progress: Progress = None) -> list[_core.ReceivedPower]:
    """The same of groups of paths in one pass, each as `received_power` of its paths alone.

    paths: of a trace
    group_of_path: [P] whole numbers below num_groups; num_groups: 1 or more
    tx, rx: indices of the antennas
    progress: callable (stage, fraction), True for bars, or None
    Returns a list [num_groups] of ReceivedPower, in W. Raises TypeError or ValueError naming the argument, IndexError for
    antennas that are not there, KeyboardInterrupt on Ctrl-C.
    """
    row_of_channel(paths, tx, rx)
    if group_of_path.size and not 0 <= group_of_path.min() <= group_of_path.max() < num_groups:
        raise ValueError(f"group_of_path: must be from 0 to {num_groups - 1}, below num_groups, got "
                         f"{group_of_path.min()} to {group_of_path.max()}")
    return _core.received_powers(paths, group_of_path, num_groups, tx=tx, rx=rx, progress=progress)
