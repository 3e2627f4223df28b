"""Smoothing of sampled positions, by no more than asked for.

The smoothed positions z make |y - z|^2 + w |z''|^2 least (E. T. Whittaker, "On a new method of graduation", Proc. Edinburgh
Math. Soc. 41 (1923) 63-75), z'' being second divided differences in time; the weight w is the one that moves the positions by
the root mean square that is asked for. With the differences D, y - z is D^T m, where (D D^T + 1/w) m = D y: that system, unlike
the one of z itself, can be solved where times lie far and near, too.
"""
import numpy as np

ROUNDS = 40                # of the search for the weight


def smoothed(times, positions, distance: float):
    """Positions [N, D] in m at times [N] in s, moved by `distance` m in the root mean square at most."""
    if distance <= 0.0 or len(times) < 3:
        return positions
    shares = np.stack([np.ones(len(times)), (times - times[0]) / (times[-1] - times[0])], axis=-1)
    line = shares @ np.linalg.lstsq(shares, positions, rcond=None)[0]      # is smooth, and only costs digits
    return line + _smoothed(times, positions - line, distance)


def _smoothed(times, positions, distance: float):
    step = np.mean(np.diff(times))
    low, high = -6.0, 10.0            # powers of ten of the weight, in steps
    found = positions
    if _shift(_solved(times, positions, step, 10.0**high), positions) <= distance:
        return _solved(times, positions, step, 10.0**high)
    for _ in range(ROUNDS):
        middle = 0.5 * (low + high)
        tried = _solved(times, positions, step, 10.0**middle)
        if _shift(tried, positions) <= distance:
            low, found = middle, tried
        else:
            high = middle
    return found


def _shift(tried, positions):
    return np.sqrt(np.mean(np.sum((tried - positions) ** 2, axis=1)))


def _solved(times, positions, step, weight):
    """The least of |y - z|^2 + weight |z''|^2."""
    h = np.diff(times) / step
    rows = np.stack([1.0 / h[:-1], -1.0 / h[:-1] - 1.0 / h[1:], 1.0 / h[1:]]) * (2.0 / (h[:-1] + h[1:]))
    count = rows.shape[1]
    bends = sum(rows[i][:, None] * positions[i:i + count] for i in range(3))
    multipliers = _by_cholesky(_normal(rows, weight), bends)
    moved = np.zeros(positions.shape)
    for i in range(3):
        moved[i:i + count] += rows[i][:, None] * multipliers
    return positions - moved


def _normal(rows, weight):
    """The diagonal and the two above it [3, N-2] of D D^T + 1 / weight, with second differences D of `rows` [3, N-2]."""
    bands = np.zeros(rows.shape)
    bands[0] = np.sum(rows**2, axis=0) + 1.0 / weight
    bands[1, :-1] = rows[1, :-1] * rows[0, 1:] + rows[2, :-1] * rows[1, 1:]
    bands[2, :-2] = rows[2, :-2] * rows[0, 2:]
    return bands


def _by_cholesky(bands, right):
    """The solution [N, D] of a symmetric system of two diagonals beside the main one [3, N]."""
    d, e, f = (band.tolist() for band in bands)
    z = [list(row) for row in np.asarray(right, float)]
    columns, count = range(len(z[0])), len(d)
    lower, lowest = [0.0] * count, [0.0] * count     # of the factor L D L^T, beside its diagonal
    for k in range(count):
        if k >= 2:
            lowest[k] = f[k - 2] / d[k - 2]
        if k >= 1:
            lower[k] = (e[k - 1] - (lowest[k] * d[k - 2] * lower[k - 1] if k >= 2 else 0.0)) / d[k - 1]
            d[k] -= lower[k] ** 2 * d[k - 1] + (lowest[k] ** 2 * d[k - 2] if k >= 2 else 0.0)
        for c in columns:
            z[k][c] -= (lower[k] * z[k - 1][c] if k >= 1 else 0.0) + (lowest[k] * z[k - 2][c] if k >= 2 else 0.0)
    for k in range(count - 1, -1, -1):
        for c in columns:
            z[k][c] /= d[k]
    for k in range(count - 1, -1, -1):
        for c in columns:
            if k + 1 < count:
                z[k][c] -= lower[k + 1] * z[k + 1][c]
            if k + 2 < count:
                z[k][c] -= lowest[k + 2] * z[k + 2][c]
    return np.array(z)
