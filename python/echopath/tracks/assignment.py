"""Which row goes with which column at the least sum of costs."""
from __future__ import annotations

import numpy as np


def assigned(cost, limit: float) -> list[tuple[int, int]]:
    """Pairs (row, column) of the assignment whose sum of costs is least, where a row left alone costs `limit`.

    cost: [N, M]; pairs of a cost above the limit are never made
    """
    if not np.size(cost):
        return []
    pairs = []
    for rows, columns in _linked(cost <= limit):
        pairs += [(int(rows[row]), int(columns[column])) for row, column in _assigned_among(cost[np.ix_(rows, columns)], limit)]
    return sorted(pairs)


def _linked(is_possible) -> list[tuple[np.ndarray, np.ndarray]]:
    """(rows, columns) of each set that chains of possible pairs [N, M] link: gates leave many small ones, and the work grows with
    the third power of their size."""
    of_row = np.arange(len(is_possible))
    while True:
        of_column = np.where(is_possible, of_row[:, None], len(of_row)).min(axis=0)
        lowest = np.minimum(of_row, np.where(is_possible, of_column, len(of_row)).min(axis=1))
        if np.array_equal(lowest, of_row):
            break
        of_row = lowest
    sets = np.unique(of_column[of_column < len(of_row)])
    return [(np.flatnonzero(of_row == one), np.flatnonzero(of_column == one)) for one in sets]


def _assigned_among(cost, limit: float) -> list[tuple[int, int]]:
    """`assigned` of a set."""
    num_rows, num_columns = cost.shape
    alone = np.full((num_rows, num_rows), limit)
    beyond = 4.0 * num_rows * (abs(limit) + 1.0) + np.abs(cost[cost <= limit]).sum()  # dearer than leaving every row alone
    column_of_row = hungarian(np.hstack([np.where(cost <= limit, cost, beyond), alone]))
    return [(row, int(column)) for row, column in enumerate(column_of_row)
            if column < num_columns and cost[row, column] <= limit]


def hungarian(cost):
    """The column of each row [N] of costs [N, M], N at most M, at the least sum.

    Source: shortest augmenting paths (Jonker and Volgenant 1987).
    """
    num_rows, num_columns = cost.shape
    of_row, of_column = np.zeros(num_rows), np.zeros(num_columns + 1)  # the last column starts each path
    row_of_column = np.full(num_columns + 1, -1)
    for row in range(num_rows):
        row_of_column[num_columns], column = row, num_columns
        distance, before = np.full(num_columns, np.inf), np.full(num_columns, num_columns)
        is_done = np.zeros(num_columns + 1, bool)
        while row_of_column[column] >= 0:
            is_done[column] = True
            here = row_of_column[column]
            reduced = cost[here] - of_row[here] - of_column[:-1]
            is_nearer = ~is_done[:-1] & (reduced < distance)
            distance[is_nearer], before[is_nearer] = reduced[is_nearer], column
            following = int(np.argmin(np.where(is_done[:-1], np.inf, distance)))
            step = distance[following]
            of_row[row_of_column[is_done]] += step
            of_column[is_done] -= step
            distance[~is_done[:-1]] -= step
            column = following
        while column != num_columns:
            row_of_column[column] = row_of_column[before[column]]
            column = before[column]
    found = np.empty(num_rows, int)
    taken = np.flatnonzero(row_of_column[:-1] >= 0)
    found[row_of_column[taken]] = taken
    return found
