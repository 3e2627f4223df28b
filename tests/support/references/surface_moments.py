"""Scattering of thin or closed perfect conductors in three dimensions: method of moments for the electric-field equation.

Rao, Wilton and Glisson, "Electromagnetic scattering by surfaces of arbitrary shape" (IEEE Trans. AP-30, 1982): currents that
flow over the inner edges of a triangle mesh. Integrals over a source triangle are sums over the middles of its ninths; the
field is tested at the middle of a triangle, which none of these meets. Lengths in wavelengths, time factor e^{+jwt}.
"""
import numpy as np
from scipy import linalg

WAVENUMBER = 2 * np.pi
IMPEDANCE = 376.730313668  # ohm
NINTHS = np.array([[7, 1, 1], [4, 4, 1], [1, 7, 1], [4, 1, 4], [1, 4, 4], [1, 1, 7],
                   [5, 2, 2], [2, 5, 2], [2, 2, 5]]) / 9.0  # middles of upright ones, then of the others
ROWS = 256                 # triangles that are tested at a time


class Currents:
    """vertices [V, 3] in wavelengths; triangles [T, 3]: no longer than a tenth, joined by shared vertices."""

    def __init__(self, vertices, triangles):
        self.vertices, self.triangles = np.asarray(vertices, float), np.asarray(triangles)
        corners = self.vertices[self.triangles]
        self.middle = corners.mean(axis=1)
        self.ninths = np.einsum("ik,tkx->tix", NINTHS, corners)
        self._find_edges()
        self._factors = linalg.lu_factor(self._matrix(), overwrite_a=True, check_finite=False)

    def _find_edges(self):
        """Of each edge between two triangles: these, the vertex of each that is not on it, and its length."""
        sides = np.concatenate([self.triangles[:, [k, (k + 1) % 3]] for k in range(3)])
        opposite = np.concatenate([self.triangles[:, (k + 2) % 3] for k in range(3)])
        owner = np.tile(np.arange(len(self.triangles)), 3)
        order = np.lexsort(np.sort(sides, axis=1).T)
        ends = np.sort(sides, axis=1)[order]
        first = np.flatnonzero((ends[1:] == ends[:-1]).all(axis=1))
        self.owner = np.stack([owner[order][first], owner[order][first + 1]], axis=1)
        self.free = self.vertices[np.stack([opposite[order][first], opposite[order][first + 1]], axis=1)]
        self.length = np.linalg.norm(np.diff(self.vertices[ends[first]], axis=1)[:, 0], axis=1)

    def _kernel(self, rows):
        """e^{-jkR}/R from every triangle to the middles of some: its mean, and its mean with the place on the source."""
        away = np.linalg.norm(self.middle[rows, None, None] - self.ninths[None], axis=-1)
        green = (np.exp(-1j * WAVENUMBER * away) / away).astype(np.complex64)
        return green.mean(axis=2), np.einsum("pti,tix->xpt", green, self.ninths.astype(np.float32), optimize=True) / 9

    def _matrix(self):
        """[E, E] over the impedance and 4 pi."""
        matrix = np.zeros((len(self.length),) * 2, np.complex64)
        for begin in range(0, len(self.triangles), ROWS):
            rows = np.arange(begin, min(begin + ROWS, len(self.triangles)))
            self._add_rows(matrix, rows, *self._kernel(rows))
        return matrix

    def _add_rows(self, matrix, rows, mean, placed):
        sign = (1, -1)
        flow = [sum(sign[s] * (placed[x][:, self.owner[:, s]] - self.free[:, s, x].astype(np.float32) * mean[:, self.owner[:, s]])
                    for s in range(2)) * (self.length.astype(np.float32) / 2) for x in range(3)]
        charge = (mean[:, self.owner[:, 0]] - mean[:, self.owner[:, 1]]) * self.length.astype(np.float32)
        for s in range(2):
            tested = np.flatnonzero((self.owner[:, s] >= rows[0]) & (self.owner[:, s] <= rows[-1]))
            at = self.owner[tested, s] - rows[0]
            arm = sign[s] * (self.middle[self.owner[tested, s]] - self.free[tested, s])
            half = sum((arm[:, x] / 2).astype(np.float32)[:, None] * flow[x][at] for x in range(3))
            part = np.complex64(1j * WAVENUMBER) * half + np.complex64(sign[s] / (1j * WAVENUMBER)) * charge[at]
            matrix[tested] += self.length[tested].astype(np.float32)[:, None] * part

    def _plane_wave(self, toward, polarization):
        """[E, N] integral of the current of each edge times a wave that goes to -toward, or comes back from there."""
        total = 0
        for s, sign in ((0, 1), (1, -1)):
            spots = self.ninths[self.owner[:, s]]
            arms = sign * (spots - self.free[:, s, None]) @ polarization.T
            total = total + (arms * np.exp(1j * WAVENUMBER * spots @ toward.T)).mean(axis=1)
        return total * (self.length / 2)[:, None]

    def cross_section(self, toward, polarization):
        """[N] backscatter in square wavelengths, co-polarised. toward, polarization [N, 3]: unit vectors, the first
        toward the radar."""
        toward, polarization = np.atleast_2d(toward).astype(float), np.atleast_2d(polarization).astype(float)
        wave = self._plane_wave(toward, polarization)
        driven = (wave * (4 * np.pi / IMPEDANCE)).astype(np.complex64)
        current = linalg.lu_solve(self._factors, driven, check_finite=False)
        field = WAVENUMBER * IMPEDANCE / (4 * np.pi) * (wave * current).sum(axis=0)
        return 4 * np.pi * np.abs(field) ** 2


def cut_triangle(num_cells):
    """[F, 3, 2] places (i, j) of the corners of a triangle's parts, with i, j and their sum in 0 to num_cells."""
    upright = [[(i, j), (i + 1, j), (i, j + 1)] for i in range(num_cells) for j in range(num_cells - i)]
    others = [[(i + 1, j), (i + 1, j + 1), (i, j + 1)] for i in range(num_cells) for j in range(num_cells - i - 1)]
    return np.array(upright + others)


def joined(corners):
    """(vertices, triangles) of triangles [F, 3, 3] whose equal corners become one."""
    vertices, index = np.unique(np.round(corners.reshape(-1, 3), 9), axis=0, return_inverse=True)
    return vertices, index.reshape(-1, 3)


def trihedral(edge, num_cells):
    """(vertices, triangles) of three right-angled triangles whose legs are as long, in wavelengths, along the axes."""
    parts = cut_triangle(num_cells) * edge / num_cells
    faces = [np.insert(parts, axis, 0.0, axis=-1) for axis in range(3)]
    return joined(np.concatenate(faces))


def sphere(radius, num_cells):
    """(vertices, triangles) of an octahedron that is blown up to a sphere; radius in wavelengths."""
    parts = cut_triangle(num_cells) / num_cells
    face = np.concatenate([parts, 1 - parts.sum(axis=-1, keepdims=True)], axis=-1)
    signs = np.array(np.meshgrid((1, -1), (1, -1), (1, -1))).reshape(3, 8).T
    vertices, triangles = joined(np.concatenate([face * sign for sign in signs]))
    return radius * vertices / np.linalg.norm(vertices, axis=1)[:, None], triangles


def about_the_axis(angles_deg):
    """Unit vectors [N, 3] to a radar that stands off a trihedral's axis by (sideways, upwards), and their two polarisations."""
    axis, side = np.ones(3) / np.sqrt(3), np.array([1, -1, 0]) / np.sqrt(2)
    across, up = np.radians(np.asarray(angles_deg, float)).T[..., None]
    toward = np.cos(up) * (np.cos(across) * axis + np.sin(across) * side) + np.sin(up) * np.cross(axis, side)
    horizontal = np.cross([0, 0, 1], toward)
    horizontal /= np.linalg.norm(horizontal, axis=1)[:, None]
    return toward, np.cross(toward, horizontal), horizontal
