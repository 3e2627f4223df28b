"""A trihedral of four wavelengths with edges against the method of moments in three dimensions."""
import numpy as np
import pytest
from scipy.special import spherical_jn, spherical_yn

import echopath as ep
from support.references.surface_moments import Currents, about_the_axis, sphere, trihedral
from support.shapes import FREQUENCY, METAL, WAVELENGTH, decibel

SIDE = 4                # wavelengths, of the legs
MEAN_DB, AXIS_DB = 0.5, 0.55
# Sideways and upwards from the axis of symmetry, degrees, and the backscatter VV and HH in dB over a square wavelength:
# Currents(*trihedral(4, n)) of 32 and 44 cells along a leg (4 minutes), extrapolated to none of size with the square of it.
OF_MOMENTS = {
    (0, 0): (31.18, 31.18), (5, 0): (30.15, 30.32), (10, 0): (29.54, 30.17), (15, 0): (28.28, 28.30),
    (20, 0): (26.88, 26.97), (0, 5): (30.44, 30.55), (0, 10): (30.07, 28.72), (0, 15): (28.24, 27.12),
    (0, -5): (30.36, 29.52), (0, -10): (29.84, 30.42), (0, -15): (29.00, 30.25), (10, 10): (29.62, 29.02),
    (10, -10): (28.09, 28.21),
}


def backscatter_of_sphere(size):
    """Mie's series over the disc's area, for a perfect conductor; size: circumference in wavelengths."""
    order = np.arange(1, int(size + 20))

    def riccati(regular, singular):
        value = spherical_jn(order, size) * regular - 1j * spherical_yn(order, size) * singular
        slope = spherical_jn(order, size, derivative=True) * regular - 1j * spherical_yn(order, size, derivative=True) * singular
        return size * value, value + size * slope

    (inner, inner_slope), (outer, outer_slope) = riccati(1, 0), riccati(1, 1)
    terms = (-1.0) ** order * (2 * order + 1) * (inner_slope / outer_slope - inner / outer)
    return abs(terms.sum()) ** 2 / size ** 2


@pytest.mark.parametrize("size", [1.0, 3.0])
def test_the_method_of_moments_has_mies_sphere(size):
    found = Currents(*sphere(size / (2 * np.pi), 9)).cross_section([[0, 0, 1]], [[1, 0, 0]])
    expected = backscatter_of_sphere(size) * size ** 2 / (4 * np.pi)
    assert abs(decibel(found[0] / expected)) < 0.25  # its faces cut into the sphere


def test_a_trihedral_of_few_wavelengths_has_the_echo_of_the_method_of_moments_in_either_polarisation():
    toward, _, _ = about_the_axis(list(OF_MOMENTS))
    scene = ep.Scene()
    vertices, triangles = trihedral(SIDE, 1)
    scene.add(ep.Mesh(vertices * WAVELENGTH, triangles), name="corner", material=METAL)
    found = decibel(np.asarray(ep.rcs(scene, frequency=FREQUENCY, incidence=toward, polarization=["vv", "hh"],
                                      num_rays=1 << 14, edges=True)) / WAVELENGTH ** 2)
    error = np.abs(found - np.array(list(OF_MOMENTS.values())))
    assert error.mean(axis=0).max() < MEAN_DB and error[0].max() < AXIS_DB
