"""The slow reference with field vectors: coherent echoes of smooth surfaces, directly or over flagged planes.

    E_r = Gamma_TE (E.s) s + Gamma_TM (E.p_i) p_r,  s = k_i x n/|k_i x n|,  p_i = s x k_i,  p_r = s x k_r
    radiated along o: -1/2 o x [n x (E_i + E_r) - o x (n x (k_i x E_i + k_r x E_r))],  in the place of Gamma cos_in
An antenna launches and receives along the unit part of its polarisation that lies across the direction.
"""
import numpy as np

from .reference import Reference, taper
from .reference_cells import cross, lengths_of, unit


class PolarizedReference(Reference):
    """As Reference, for trace(polarization="jones"); no rough surfaces."""

    def pairs(self, time):
        cells = self.cells(time)
        legs = self.legs(cells, self.antenna(1, time), time, to_receiver=True)
        receive = [(leg, self._seen_from_cells(leg, time)) for leg in legs]
        out = []
        for one in self.legs(cells, self.antenna(0, time), time, to_receiver=False):
            incident = self._launched(one, time)
            facing = np.einsum("ij,ij->i", cells.normals, one.toward)
            normals = cells.normals * np.where(facing < 0, -1.0, 1.0)[:, None]
            for two, received in ((leg, seen) for leg, seen in receive if self.is_path(one.planes, leg.planes)):
                cos_out = np.einsum("ij,ij->i", normals, two.toward)
                seen = (cos_out > 0) * taper(cells, np.abs(facing), cos_out)
                field = self._radiated(incident, -one.toward, normals, two.toward, cells.mesh)
                ways = (one.gain != 0) * (two.gain != 0) * seen * cells.areas / (one.length * two.length)
                ways = ways * np.sqrt(self.gain(0, one.leaving) * self.gain(1, two.leaving))
                sent = 1j * np.sqrt(self.radar.transmit_power) / (4 * np.pi)
                amplitude = sent * ways * np.einsum("ij,ij->i", field, received)
                out.append((one.length + two.length, amplitude, np.zeros(len(seen))))
        return cells, out

    def _reflected(self, leg, time):
        arriving = np.einsum("ij,ij->i", self._launched(leg, time), self._axis(1, -leg.toward))
        return (leg.gain != 0) * arriving

    def modes(self, mesh, cosine):
        """Gamma_TE and Gamma_TM along p_i and p_r, complex [M]."""
        material = self.materials[mesh]
        if self.is_metal(mesh):
            size = np.full(len(cosine), np.sqrt(material.reflectivity or 1.0), complex)
            return -size, size
        root = np.sqrt(material.permittivity - (1 - cosine ** 2) + 0j)
        root = np.where(root.imag > 0, -root, root)
        epsilon = material.permittivity
        return (cosine - root) / (cosine + root), (epsilon * cosine - root) / (epsilon * cosine + root)

    def _axis(self, side, direction):
        """Unit polarisation [M, 3] of the transmitter (side 0) or receiver across directions of travel [M, 3]."""
        antenna = (self.radar.transmitters if side == 0 else self.radar.receivers)[0]
        polarization = np.asarray(antenna.polarization, float)
        return unit(polarization - (direction @ polarization)[:, None] * direction)

    def _launched(self, leg, time):
        """Fields [M, 3] at the cells of a unit launch over a leg from the transmitter."""
        return self._sent_over(leg, self._axis(0, leg.leaving), time)

    def _seen_from_cells(self, leg, time):
        """Along which field [M, 3] the receiver sees: by reciprocity what its own axis becomes on the way to the cells."""
        return self._sent_over(leg, self._axis(1, leg.leaving), time)

    def _sent_over(self, leg, field, time):
        direction = leg.leaving
        for mesh in leg.planes:
            normal = np.broadcast_to(self.plane(mesh, time).normal, direction.shape)
            cosine = np.abs(np.einsum("ij,ij->i", direction, normal))
            field, direction = reflect(field, direction, normal, self.modes(mesh, cosine))
            field = field * self.shares(mesh, cosine)[0][:, None]
        return field

    def _radiated(self, incident, direction, normals, out, meshes):
        """Fields [M, 3] that the cells radiate along `out` [M, 3], without spreading."""
        cosine = np.abs(np.einsum("ij,ij->i", direction, normals))
        te, tm = np.zeros(len(cosine), complex), np.zeros(len(cosine), complex)
        for mesh in np.unique(meshes):
            at = meshes == mesh
            te[at], tm[at] = (mode * self.shares(mesh, cosine[at])[0] for mode in self.modes(mesh, cosine[at]))
        reflected, behind = reflect(incident, direction, normals, (te, tm))
        electric = cross(normals, incident + reflected)
        magnetic = cross(normals, cross(direction, incident) + cross(behind, reflected))
        return -0.5 * cross(out, electric - cross(out, magnetic))


def reflect(field, direction, normals, modes):
    """Reflected field and direction [M, 3] at planes of normals [M, 3]; modes: (TE, TM) [M]."""
    across = cross(direction, normals)
    sine = lengths_of(across)
    anywhere = cross(direction, [0.3, 0.5, 0.8])  # at normal incidence any plane will do
    te = unit(np.where((sine > 1e-9)[:, None], across, anywhere))
    behind = direction - 2 * np.einsum("ij,ij->i", direction, normals)[:, None] * normals
    along_te = modes[0] * np.einsum("ij,ij->i", te, field)
    along_tm = modes[1] * np.einsum("ij,ij->i", cross(te, direction), field)
    return along_te[:, None] * te + along_tm[:, None] * cross(te, behind), behind
