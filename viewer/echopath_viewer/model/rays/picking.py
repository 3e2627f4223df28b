"""Which ray lies under the cursor, in screen coordinates."""
from __future__ import annotations

import numpy as np

NEAREST_DEPTH = 1e-6  # of clip coordinates: what is behind the eye is cut off there


def nearest_segment(points, ends, clip_from_world, size, cursor, reach: float) -> int | None:
    """The segment whose picture passes nearest to the cursor.

    points: [V, 3] m; ends: [S, 2]; clip_from_world: [4, 4], perspective included; size: (width, height) in pixels
    cursor: (x, y) in pixels from the upper left; reach: pixels, beyond it nothing is picked
    Returns the row of the segment, the first of the equally near; None where none is near.
    """
    if not len(ends):
        return None
    clip = np.column_stack([points, np.ones(len(points))]) @ np.asarray(clip_from_world).T
    begin, end = _cut_before_eye(clip[ends[:, 0]], clip[ends[:, 1]])
    distance = _distance(_pixels(begin, size), _pixels(end, size), np.asarray(cursor, float))
    distance[(begin[:, 3] <= 0.0) | (end[:, 3] <= 0.0)] = np.inf
    nearest = int(np.argmin(distance))
    return nearest if distance[nearest] <= reach else None


def _cut_before_eye(begin, end):
    """Both ends [S, 4] moved along their segment to before the eye; segments behind it stay as they are."""
    w0, w1 = begin[:, 3], end[:, 3]
    span = np.where(w1 == w0, 1.0, w1 - w0)
    at = ((NEAREST_DEPTH - w0) / span)[:, None]
    crossing = begin + at * (end - begin)
    crosses = ((w0 < NEAREST_DEPTH) != (w1 < NEAREST_DEPTH))[:, None]
    return (np.where(crosses & (w0 < NEAREST_DEPTH)[:, None], crossing, begin),
            np.where(crosses & (w1 < NEAREST_DEPTH)[:, None], crossing, end))


def _pixels(clip, size):
    depth = np.where(clip[:, 3] > 0.0, clip[:, 3], 1.0)[:, None]
    x, y = (clip[:, :2] / depth).T
    return np.column_stack([(0.5 + 0.5 * x) * size[0], (0.5 - 0.5 * y) * size[1]])


def _distance(begin, end, cursor):
    along = end - begin
    length2 = np.einsum("ij,ij->i", along, along)
    share = np.einsum("ij,ij->i", cursor - begin, along) / np.where(length2 > 0.0, length2, 1.0)
    nearest = begin + np.clip(share, 0.0, 1.0)[:, None] * along
    return np.hypot(*(cursor - nearest).T)
