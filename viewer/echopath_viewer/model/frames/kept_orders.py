"""Columns and orders of the paths of a large frame file, which are kept in it for the next view."""
from __future__ import annotations

import dataclasses

import numpy as np

from echopath.frame_file.kept import keep_arrays, kept_arrays

GROUP, VERSION = "viewer", 1  # of the file; VERSION grows when one of the arrays is made otherwise
KEPT_CHANNEL = (0, 0)         # whose columns are kept: that of the first picture
FEWEST_PATHS = 200_000        # that are worth it
COLUMNS = {"power": np.float64, "range": np.float32, "velocity": np.float32, "cell": np.int32}
ORDERS = {"cell_order": np.uint32, "group": (np.uint16, np.uint32), "group_order": np.uint32}
ARRAYS = COLUMNS | ORDERS | {"group_power": np.float64}


@dataclasses.dataclass(frozen=True)
class KeptOrders:
    """columns: {name: [P]} of Columns; cell_order: of CellIndex; groups: (group_of_path, order) of TouchGroups, each group
    strongest first; coherent_power: [G] W of RaySampler."""

    columns: dict
    cell_order: np.ndarray
    groups: tuple
    coherent_power: np.ndarray


def read_kept(path, view_input) -> KeptOrders | None:
    """What is kept in a frame file, None where that is nothing, or nothing that fits its paths."""
    num_paths = view_input.paths.num_paths
    if num_paths < FEWEST_PATHS:
        return None
    arrays = kept_arrays(path, view_input.file_state, GROUP, VERSION, ARRAYS)
    if arrays is None or not _fits(arrays, num_paths, view_input.parts.whole.spectrum.values[0, 0].size):
        return None
    return KeptOrders({name: arrays[name] for name in COLUMNS}, arrays["cell_order"], (arrays["group"], arrays["group_order"]),
                      arrays["group_power"])


def keep_orders(path, session) -> tuple | None:
    """Keeps the columns and orders of a session of a frame file in it; returns the state of the file that has them now.

    None: the file is as it was. What another channel is on display for, and what takes no time to make, is not kept, nor what
    belongs to a frame that the file has no more.
    """
    if session.file_state is None or session.paths.num_paths < FEWEST_PATHS or session.channel != KEPT_CHANNEL:
        return None
    columns, sampler, groups = session.columns, session.sampler, session.groups
    arrays = {name: getattr(columns, name) for name in COLUMNS}
    arrays |= {"cell_order": session.index.order, "group": groups.group_of_path, "group_order": groups.order,
               "group_power": sampler.coherent_power}
    return keep_arrays(path, session.file_state, GROUP, VERSION, arrays)


def _fits(arrays: dict, num_paths: int, num_cells: int) -> bool:
    """Whether all numbers point at what there is: those of a file are never trusted."""
    if any(len(arrays[name]) != num_paths for name in (*COLUMNS, *ORDERS)):
        return False
    orders_fit = all(arrays[name].max() < num_paths for name in ("cell_order", "group_order"))
    cell, num_groups = arrays["cell"], int(arrays["group"].max()) + 1
    return bool(orders_fit and -1 <= cell.min() <= cell.max() < num_cells and num_groups == len(arrays["group_power"]))
