"""Scattering of thin, perfectly conducting strips in two dimensions: method of moments for the electric-field equation.

Harrington, "Field Computation by Moment Methods" (1968), chapter 3, with Galerkin's testing: pulses carry the current along
the strips' axis (TM, E along z), rooftops that across it (TE, H along z). Time factor e^{+jwt}.
"""
import numpy as np

NEAR = 2            # segments apart, up to which the logarithm of the kernel is integrated by a graded rule
NUM_FAR, NUM_NEAR = 2, 12  # Gauss points


def hankel(x):
    """H_0^(2) at x > 0, to 1e-7: Abramowitz and Stegun (1964), 9.4.1 to 9.4.3."""
    x = np.asarray(x, float)
    square, inverse = (np.minimum(x, 3) / 3) ** 2, 3 / np.maximum(x, 3)
    regular = np.polyval([.00021, -.0039444, .0444479, -.3163866, 1.2656208, -2.2499997, 1], square)
    second = np.polyval([-.00024846, .00427916, -.04261214, .25300117, -.74350384, .60559366, .36746691], square)
    second = second + 2 / np.pi * np.log(np.minimum(x, 3) / 2) * regular
    size = np.polyval([.00014476, -.00072805, .00137237, -.00009512, -.0055274, -.00000077, .79788456], inverse)
    angle = x + np.polyval([.00013558, -.00029333, -.00054125, .00262573, -.00003954, -.04166397, -.78539816], inverse)
    return np.where(x < 3, regular - 1j * second, size / np.sqrt(x) * np.exp(-1j * angle))


class Strips:
    """Strips in the xy-plane, cut into segments, in wavelengths.

    points [N + 1, 2]: ends of N joined segments, at most a tenth of a wavelength long; is_closed: the last meets the first.
    """

    def __init__(self, points, is_closed=False):
        points = np.asarray(points, float)
        self.start, self.end = points[:-1], points[1:]
        self.is_closed = is_closed
        self.length = np.linalg.norm(self.end - self.start, axis=1)
        self.along = (self.end - self.start) / self.length[:, None]
        self._kernel = self._kernel_moments()

    def _kernel_moments(self):
        """[N, N, 2, 2] the integral of H_0 k^2 over two segments, times what falls from 1 to 0 or rises along each."""
        at, weights = _gauss(NUM_FAR)
        shapes = np.stack([1 - at, at])
        points = self.start[:, None] + at[None, :, None] * (self.end - self.start)[:, None]
        count, num = len(self.length), len(at)
        flat = points.reshape(-1, 2)
        far = np.hypot(flat[:, None, 0] - flat[None, :, 0], flat[:, None, 1] - flat[None, :, 1])
        np.maximum(far, 1e-12, out=far)
        kernel = hankel(2 * np.pi * far).reshape(count, num, count, num)
        moments = np.einsum("iajb,pa,qb,a,b->ijpq", kernel, shapes, shapes, weights, weights, optimize=True)
        scale = 4 * np.pi ** 2 * self.length[:, None] * self.length[None, :]
        moments *= scale[..., None, None]
        for offset in range(-NEAR, NEAR + 1):
            rows = np.arange(count)
            columns = rows + offset
            if self.is_closed:
                columns %= count
            inside = (columns >= 0) & (columns < count)
            rows, columns = rows[inside], columns[inside]
            moments[rows, columns] = self._near_moments(rows, columns)
        return moments

    def _near_moments(self, rows, columns):
        at, weights = _gauss(NUM_NEAR)
        moments = np.zeros((len(rows), 2, 2), complex)
        for place, weight in zip(at, weights):
            point = self.start[rows] + place * (self.end - self.start)[rows]
            nearest = np.clip(np.sum((point - self.start[columns]) * self.along[columns], axis=1) / self.length[columns], 0, 1)
            for low, high in ((nearest, np.zeros_like(nearest)), (nearest, np.ones_like(nearest))):
                # The power gathers points at the singular end.
                inner = low[:, None] + (high - low)[:, None] * at[None, :] ** 3
                steps = np.abs(high - low)[:, None] * 3 * at[None, :] ** 2 * weights[None, :]
                other = self.start[columns][:, None] + inner[..., None] * (self.end - self.start)[columns][:, None]
                distance = np.maximum(np.linalg.norm(point[:, None] - other, axis=2), 1e-15)
                values = hankel(2 * np.pi * distance) * steps * weight
                for p, first in enumerate((1 - place, place)):
                    for q, second in enumerate((1 - inner, inner)):
                        moments[:, p, q] += np.sum(first * second * values, axis=1)
        scale = 4 * np.pi ** 2 * self.length[rows] * self.length[columns]
        return moments * scale[:, None, None]

    def _wave(self, direction):
        """[N, 2] the integral of k e^{-jk direction.r} over each segment times its two shapes."""
        at, weights = _gauss(6)
        points = self.start[:, None] + at[None, :, None] * (self.end - self.start)[:, None]
        wave = np.exp(-2j * np.pi * (points @ np.asarray(direction, float)))
        return 2 * np.pi * self.length[:, None] * np.stack([wave @ (weights * (1 - at)), wave @ (weights * at)], axis=1)

    def echo_width(self, incidence_deg, polarization):
        """Monostatic echo width in wavelengths, for waves from the azimuths incidence_deg [A]; "tm" or "te"."""
        angles = np.radians(np.atleast_1d(incidence_deg))
        from_radar = -np.stack([np.cos(angles), np.sin(angles)], axis=1)
        solve = self._fields_tm if polarization == "tm" else self._fields_te
        return np.abs(solve(from_radar)) ** 2 / (2 * np.pi) * 4

    def _fields_tm(self, directions):
        """The far field in units of sqrt(2/(pi k r)) e^{-jkr + ...}."""
        matrix = self._kernel.sum(axis=(2, 3)) / 4
        right = np.stack([self._wave(direction).sum(axis=1) for direction in directions], axis=1)
        current = np.linalg.solve(matrix, right)
        return np.sum(right * current, axis=0) / 4

    def _fields_te(self, directions):
        joined = np.arange(len(self.length)) if self.is_closed else np.arange(1, len(self.length))
        before, after = joined - 1, joined  # segments that rise to and fall from a node
        along = self.along @ self.along.T
        matrix = np.zeros((len(joined), len(joined)), complex)
        for m, p, rise_m in ((before, 1, 1), (after, 0, -1)):
            for n, q, rise_n in ((before, 1, 1), (after, 0, -1)):
                pairs = np.ix_(m, n)
                slope = rise_m * rise_n / (4 * np.pi ** 2 * self.length[m][:, None] * self.length[n][None, :])
                kernel = self._kernel[pairs]
                matrix += along[pairs] * kernel[..., p, q] - slope * kernel.sum(axis=(2, 3))
        matrix /= 4
        right = []
        for direction in directions:
            field = np.array([-direction[1], direction[0]])
            tested = self._wave(direction) * (self.along @ field)[:, None]
            right.append(tested[before, 1] + tested[after, 0])
        right = np.stack(right, axis=1)
        return np.sum(right * np.linalg.solve(matrix, right), axis=0) / 4


def _gauss(count):
    """Points and weights on (0, 1)."""
    at, weights = np.polynomial.legendre.leggauss(count)
    return (at + 1) / 2, weights / 2


def polyline(corners, segment):
    """[N + 1, 2] points along straight lines through the corners, segments no longer than `segment`."""
    corners = np.asarray(corners, float)
    points = [corners[:1]]
    for begin, end in zip(corners[:-1], corners[1:]):
        count = int(np.ceil(np.linalg.norm(end - begin) / segment))
        points.append(begin + (end - begin) * (np.arange(1, count + 1) / count)[:, None])
    return np.concatenate(points)
