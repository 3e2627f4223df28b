"""What the targets of the benchmark must return. 77 GHz; radar cross sections in m^2."""
from __future__ import annotations

import numpy as np

FREQUENCY = 77e9
WAVELENGTH = 299_792_458.0 / FREQUENCY
WAVENUMBER = 2.0 * np.pi / WAVELENGTH


def ellipsoid_rcs(semi_axes, direction) -> float:
    """Geometrical optics of a metal ellipsoid seen along the unit `direction`: pi / Gaussian curvature there."""
    axes, normal = np.asarray(semi_axes, float), np.asarray(direction, float)
    return np.pi * float(np.prod(axes ** 2) / np.sum((axes * normal) ** 2) ** 2)


def plate_rcs(side: float, angle: float) -> float:
    """Physical optics of a square metal plate turned by `angle` [rad] about an edge (Ulaby, Moore, Fung 1982)."""
    lobe = np.sinc(2.0 * side * np.sin(angle) / WAVELENGTH)
    return 4.0 * np.pi * side ** 4 / WAVELENGTH ** 2 * (np.cos(angle) * lobe) ** 2


def dihedral_rcs(side: float) -> float:
    """Double bounce of two squares at a right angle, seen along the bisector (Knott 2004)."""
    return 8.0 * np.pi * side ** 4 / WAVELENGTH ** 2


def trihedral_rcs(side: float) -> float:
    """Triple bounce of three right-angled triangles, seen along the axis (Knott 2004)."""
    return 4.0 * np.pi * side ** 4 / (3.0 * WAVELENGTH ** 2)


def lambert_plate_rcs(side: float, reflectivity: float, distance: float) -> float:
    """Mean of a square Lambert plate at broadside, 4 rho A at great distance: an integral at a finite one."""
    nodes, weights = np.polynomial.legendre.leggauss(32)
    offset = 0.5 * side * nodes
    r_squared = distance ** 2 + offset[:, None] ** 2 + offset[None, :] ** 2
    shares = 0.25 * side ** 2 * weights[:, None] * weights[None, :]
    return 4.0 * reflectivity * float(np.sum(shares * distance ** 6 / r_squared ** 3))


def image_field(antenna, patch, normal, image) -> tuple[complex, complex]:
    """Field at a small Lambert patch, direct and over a metal mirror, each times the other antenna-side constants.

    antenna, patch, normal: [3]; image: [3] of the antenna in the mirror. A leg of length L at the angle a to the
    normal brings g sqrt(cos a) exp(-j k L) / L, g = -1 over the mirror. Echo amplitude: square of the sum.
    """
    def leg(start, gain):
        line = np.asarray(start, float) - patch
        length = np.linalg.norm(line)
        return gain * np.sqrt(line @ normal / length) / length * np.exp(-1j * WAVENUMBER * length)

    return leg(antenna, 1.0), leg(image, -1.0)
