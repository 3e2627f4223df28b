"""Which row goes with which column at the least sum of costs."""
from __future__ import annotations

import numpy as np


def assigned(cost, limit: float) -> list[tuple[int, int]]:
    """Pairs (row, column) of the assignment whose sum of costs is least, where a row left alone costs `limit`.

    cost: [N, M]; pairs of a cost above the limit are never made
    """
    from scipy.optimize import linear_sum_assignment

    num_rows, num_columns = np.shape(cost)
    alone = np.full((num_rows, num_rows), limit)
    rows, columns = linear_sum_assignment(np.hstack([np.where(cost <= limit, cost, np.inf), alone]))
    return [(row, column) for row, column in zip(rows.tolist(), columns.tolist()) if column < num_columns]
