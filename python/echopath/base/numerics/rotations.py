"""Rotations: matrices about the axes, unit quaternions (w, x, y, z), and the ways between both."""
from __future__ import annotations

import numpy as np


def about_x(angle) -> np.ndarray:
    """[T, 3, 3] about +x by angles [T] in rad."""
    c, s, zero, one = _entries(angle)
    return _matrix([[one, zero, zero], [zero, c, -s], [zero, s, c]])


def about_y(angle) -> np.ndarray:
    """[T, 3, 3] about +y by angles [T] in rad."""
    c, s, zero, one = _entries(angle)
    return _matrix([[c, zero, s], [zero, one, zero], [-s, zero, c]])


def about_z(angle) -> np.ndarray:
    """[T, 3, 3] about +z by angles [T] in rad."""
    c, s, zero, one = _entries(angle)
    return _matrix([[c, -s, zero], [s, c, zero], [zero, zero, one]])


def quaternions(rotations) -> np.ndarray:
    """Unit quaternions [T, 4] (w, x, y, z) of rotations [T, 3, 3], without jumps of sign from one to the next."""
    r = np.asarray(rotations, dtype=float)
    # The columns below are those of 4 q q^T, written in the entries of the matrix (after Bar-Itzhack 2000): each is the
    # quaternion times one of its components, and the one with the largest component is the best conditioned.
    xx, yy, zz = r[:, 0, 0], r[:, 1, 1], r[:, 2, 2]
    wx, wy, wz = r[:, 2, 1] - r[:, 1, 2], r[:, 0, 2] - r[:, 2, 0], r[:, 1, 0] - r[:, 0, 1]
    xy, xz, yz = r[:, 0, 1] + r[:, 1, 0], r[:, 0, 2] + r[:, 2, 0], r[:, 1, 2] + r[:, 2, 1]
    columns = np.stack([np.stack([1 + xx + yy + zz, wx, wy, wz], -1), np.stack([wx, 1 + xx - yy - zz, xy, xz], -1),
                        np.stack([wy, xy, 1 - xx + yy - zz, yz], -1), np.stack([wz, xz, yz, 1 - xx - yy + zz], -1)], -1)
    longest = np.argmax(np.einsum("tii->ti", columns), axis=1)
    q = columns[np.arange(len(r)), :, longest]
    q = q / np.linalg.norm(q, axis=1)[:, None]
    flips = np.where(np.concatenate([q[:1, 0], np.sum(q[1:] * q[:-1], axis=1)]) < 0.0, -1.0, 1.0)
    return q * np.cumprod(flips)[:, None]


def matrices(q) -> np.ndarray:
    """Rotations [..., 3, 3] of unit quaternions [..., 4]."""
    w, x, y, z = np.moveaxis(np.asarray(q, dtype=float), -1, 0)
    return _matrix([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                    [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                    [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def product(p, q) -> np.ndarray:
    """Quaternions p q, [..., 4], of p and q [..., 4]: the turn q, then p."""
    w, x, y, z = np.moveaxis(p, -1, 0)
    a, b, c, d = np.moveaxis(q, -1, 0)
    return np.stack([w * a - x * b - y * c - z * d, w * b + x * a + y * d - z * c,
                     w * c - x * d + y * a + z * b, w * d + x * c - y * b + z * a], axis=-1)


def angular_velocity(rotation, rate) -> np.ndarray:
    """[3] rad/s, in the axes to which a rotation [3, 3] leads, from its rate [3, 3] per s."""
    turning = rate @ rotation.T
    return 0.5 * np.array([turning[2, 1] - turning[1, 2], turning[0, 2] - turning[2, 0], turning[1, 0] - turning[0, 1]])


def _entries(angle):
    angle = np.asarray(angle, dtype=float)
    return np.cos(angle), np.sin(angle), np.zeros_like(angle), np.ones_like(angle)


def _matrix(rows):
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def nearest_rotations(turns: np.ndarray) -> np.ndarray:
    """The rotation nearest to each of matrices [T, 3, 3] (Higham 1986)."""
    left, _, right = np.linalg.svd(turns)
    flips = np.ones((len(turns), 3))
    flips[:, 2] = np.sign(np.linalg.det(left @ right))
    return left * flips[:, None, :] @ right
