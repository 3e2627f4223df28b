"""Corners by iterated physical optics: the currents on each face light the other faces, again and again.

Jacobi's iteration of the magnetic-field equation (Obelleiro, Rodriguez, Burkholder, "An iterative physical optics approach for
analyzing the electromagnetic scattering by large open-ended cavities", IEEE TAP 43, 1995). It knows diffraction from face to
face, which geometrical optics does not. Time factor e^{+jwt}, lengths in wavelengths.
"""
import numpy as np

K = 2 * np.pi
ROWS = 500  # points of a face at a time


def trihedral(edge, cell):
    """Faces of a corner of three right triangles along the axes: (points [N, 3], areas [N], unit normal), by cells that wide."""
    count = int(np.ceil(edge / cell))
    side = edge / count
    i, j = (index.ravel() for index in np.meshgrid(*2 * [np.arange(count)], indexing="ij"))
    i, j = i[i + j < count], j[i + j < count]
    whole = i + j < count - 1
    shift, areas = np.where(whole, 1 / 2, 1 / 3), side ** 2 * np.where(whole, 1, 1 / 2)  # the hypotenuse cuts cells in halves
    faces = []
    for axis in range(3):
        points = np.zeros((len(i), 3))
        points[:, axis - 2], points[:, axis - 1] = (i + shift) * side, (j + shift) * side
        faces.append((points, areas, np.eye(3)[axis]))
    return faces


def rcs(faces, incidence, polarization, orders=3):
    """Monostatic section in square wavelengths, after that many passes from face to face."""
    toward = np.asarray(incidence, float) / np.linalg.norm(incidence)
    across = np.asarray(polarization, float) - np.dot(polarization, toward) * toward
    across = across / np.linalg.norm(across)
    magnetic = np.cross(-toward, across)
    currents = [2 * np.cross(normal, magnetic) * np.exp(1j * K * points @ toward)[:, None] for points, _, normal in faces]
    total = [current.copy() for current in currents]
    for _ in range(orders):
        currents = [2 * np.cross(face[2], sum(magnetic_field(face[0], other, current) for other, current
                                              in zip(faces, currents) if other is not face)) for face in faces]
        total = [old + new for old, new in zip(total, currents)]
    far = sum((current @ across * areas) @ np.exp(1j * K * points @ toward)
              for current, (points, areas, _) in zip(total, faces))
    return K ** 2 / (4 * np.pi) * abs(far) ** 2


def magnetic_field(points, face, current):
    """[N, 3] that the current on a face makes: the integral of J x R (jk + 1/R) e^{-jkR} / (4 pi R^2)."""
    field = np.empty(points.shape, complex)
    for begin in range(0, len(points), ROWS):
        way = points[begin:begin + ROWS, None] - face[0][None]
        distance = np.linalg.norm(way, axis=2)
        kernel = (1j * K + 1 / distance) * np.exp(-1j * K * distance) / (4 * np.pi * distance ** 2) * face[1]
        x, y, z = (way[..., axis] * kernel for axis in range(3))
        jx, jy, jz = current.T
        field[begin:begin + ROWS] = np.stack([z @ jy - y @ jz, x @ jz - z @ jx, y @ jx - x @ jy], axis=1)
    return field
