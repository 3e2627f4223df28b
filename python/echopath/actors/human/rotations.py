"""Rotation matrices [T, 3, 3] about the axes, and their unit quaternions."""
import numpy as np


def about_x(angle):
    c, s, zero, one = _entries(angle)
    return _matrix([[one, zero, zero], [zero, c, -s], [zero, s, c]])


def about_y(angle):
    c, s, zero, one = _entries(angle)
    return _matrix([[c, zero, s], [zero, one, zero], [-s, zero, c]])


def about_z(angle):
    c, s, zero, one = _entries(angle)
    return _matrix([[c, -s, zero], [s, c, zero], [zero, zero, one]])


def quaternions(rotations):
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
    flips = np.concatenate([[1.0 if q[0, 0] >= 0 else -1.0], np.sign(np.sum(q[1:] * q[:-1], axis=1))])
    return q * np.cumprod(flips)[:, None]


def _entries(angle):
    angle = np.asarray(angle, dtype=float)
    return np.cos(angle), np.sin(angle), np.zeros_like(angle), np.ones_like(angle)


def _matrix(rows):
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)
