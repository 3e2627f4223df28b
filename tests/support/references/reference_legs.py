"""Ways between antennas and points of surfaces, for the slow reference: directly, over flagged planes by images, and over
unflagged planes as the walls of corners; what surfaces do to fields; what stands in the way."""
import dataclasses
import itertools

import numpy as np

from .reference_cells import blocked, cells_of, cross, inside, joined, lengths_of, unit
from .slow_lengths import surface

C = 299792458.0
LEG_MIRRORS = 2  # flagged planes between a point of a surface and an antenna


@dataclasses.dataclass
class Leg:
    """Ways from an antenna to cells: lengths [M], toward (unit, cell -> antenna's image) [M, 3], gain [M] (complex, 0 where
    blocked), leaving (unit, at the antenna) [M, 3]; is_tm [M]: over an unflagged dielectric in TM; planes: meshes in order
    of travel from the antenna."""

    length: np.ndarray
    toward: np.ndarray
    gain: np.ndarray
    leaving: np.ndarray
    is_tm: np.ndarray
    planes: tuple = ()


@dataclasses.dataclass
class Plane:
    """A mesh that mirrors: a point of it and its unit normal [3], its triangles among all."""

    mesh: int
    anchor: np.ndarray
    normal: np.ndarray
    triangles: np.ndarray

    def height(self, points):
        """Of points [..., 3] above it."""
        return (points - self.anchor) @ self.normal

    def image(self, point):
        """Of a point [3]."""
        return point - 2 * self.height(point) * self.normal


class ReferenceLegs:
    """One scene and one radar; spacing: of the cells in m; max_bounces: of a path, planes included. `channel`: (transmitter,
    receiver) whose echoes are meant."""

    def __init__(self, scene, radar, *, spacing, trace_time, corners=False, max_bounces=3):
        self.channel, self.is_mean = (0, 0), False
        self.scene, self.radar, self.trace_time, self.corners = scene, radar, trace_time, corners
        self.materials = [mesh.material for mesh in scene.meshes]
        self.wavelength = C / radar.waveform.start_frequency
        self.max_bounces = max_bounces
        self.sees_shadows = True
        self._posed = (None, None)  # the time of the last triangles, and these
        rest = self.triangles(trace_time)[0]
        longest = np.linalg.norm(rest - np.roll(rest, 1, axis=1), axis=2).max(axis=1)
        self.pieces = np.maximum(1, np.ceil(longest / spacing)).astype(int)

    # --- geometry ---

    def antenna(self, side, time):
        """World position [3] of the transmitter (side 0) or receiver of the channel; where `is_mean`, the mean of all."""
        antennas = (self.radar.transmitters, self.radar.receivers)[side]
        points = np.array([antenna.position for antenna in antennas])
        point, motion = points.mean(axis=0) if self.is_mean else points[self.channel[side]], self.radar.motion
        if motion is None:
            return point
        rate = np.linalg.norm(motion.angular_velocity)
        axis = motion.angular_velocity / rate if rate > 0 else np.array([0.0, 0.0, 1.0])
        cos, sin = np.cos(rate * time), np.sin(rate * time)  # Rodrigues
        return cos * point + sin * cross(axis, point) + (1 - cos) * (axis @ point) * axis + motion.velocity * time

    def triangles(self, time):
        """[F, 3, 3] of all meshes, the mesh of each [F], and of each the normals [3, 3] of its vertices, None where flat."""
        if self._posed[0] != time:
            self._posed = (time, self._pose(time))
        return self._posed[1]

    def _pose(self, time):
        all_corners, owner, bent = [], [], []
        for mesh in self.scene.meshes:
            vertices, triangles, normals, smooth = surface(self.scene, mesh, time, self.trace_time)
            all_corners.append(vertices[triangles])
            owner += [mesh.id] * len(triangles)
            bent += [None if normals is None or not smooth[k] else normals[row] for k, row in enumerate(triangles)]
        return np.concatenate(all_corners), np.array(owner), bent

    def cells(self, time):
        """Cells of the meshes that are no mirrors, at `time` the same material points."""
        corners, owner, bent = self.triangles(time)
        return joined([cells_of(triangle, bent[index], int(self.pieces[index]), owner[index], index)
                       for index, triangle in enumerate(corners) if not self.materials[owner[index]].mirror])

    def sequences(self, limit, *, walls=False):
        """Meshes in order of travel of all ways over up to `limit` flagged planes, and over one wall of a corner."""
        mirrors = [mesh for mesh, material in enumerate(self.materials) if material.mirror]
        over = [row for count in range(limit + 1) for row in itertools.product(mirrors, repeat=count)
                if all(one != two for one, two in zip(row, row[1:]))]
        return over + [(mesh,) for mesh in range(len(self.materials)) if walls and mesh not in mirrors]

    def plane(self, mesh, time):
        corners, owner, _ = self.triangles(time)
        mine = np.flatnonzero(owner == mesh)
        a, b, c = corners[mine[0]]
        return Plane(mesh, a, unit(cross(b - a, c - a)), mine)

    def legs(self, cells, antenna, time, *, to_receiver):
        """All legs between an antenna and the cells: direct, over flagged planes, and, on the transmitter's side, over walls
        of corners."""
        walls = self.corners and not to_receiver
        return [self.leg(cells, antenna, time, row) for row in self.sequences(LEG_MIRRORS, walls=walls)]

    def leg(self, cells, antenna, time, meshes):
        """The leg over planes in order of travel from the antenna, met backwards from the cells."""
        corners = self.triangles(time)[0]
        planes = [self.plane(mesh, time) for mesh in meshes]
        images = [antenna]
        for plane in planes:
            images.append(plane.image(images[-1]))
        toward = unit(images[-1] - cells.points)
        length = lengths_of(images[-1] - cells.points)
        ok = cells.mesh != (meshes[-1] if meshes else -2)
        here, start, own = cells.points, cells.facets, cells.triangle
        gain, is_tm, behind = np.ones(len(length), complex), np.zeros(len(length), bool), ()
        for plane, source, image in zip(reversed(planes), reversed(images[:-1]), reversed(images)):
            met, point = self._meeting(plane, here, source, image, corners)
            ok &= met
            ok &= ~self.blocked(start, point, corners, own, leave_out=(*behind, *plane.triangles))
            factor, is_tm = self._mirrored(plane, unit(point - source))
            gain, behind = gain * factor, plane.triangles
            here, start, own = point, point, np.full(len(point), -1)
        ok &= ~self.blocked(start, np.broadcast_to(antenna, here.shape), corners, own, leave_out=behind)
        return Leg(length, toward, np.where(ok, gain, 0.0), unit(here - antenna), is_tm, tuple(meshes))

    def _meeting(self, plane, here, source, image, corners):
        """Whether [M] and where [M, 3] lines from points [M, 3] to an image of a source before a plane meet it."""
        height, line = plane.height(here), image - here
        ok = height * plane.height(source) > 0
        share = np.where(ok, height / np.where(ok, height - plane.height(image), 1.0), 0.0)
        point = here + share[:, None] * line
        if not self.sees_shadows:
            return ok, point
        on_plane = np.zeros(len(point), bool)
        for index in plane.triangles:
            on_plane |= inside(point, corners[index])
        return ok & on_plane, point

    def _mirrored(self, plane, direction):
        """Gamma s [M] of a plane for a wave of unit direction [M, 3], and whether an unflagged dielectric is in TM [M]."""
        cosine = np.abs(direction @ plane.normal)
        coefficient, is_tm = self.coefficient(plane.mesh, cosine, direction, plane.normal)
        is_mirror = self.materials[plane.mesh].mirror
        if is_mirror and not self.is_metal(plane.mesh):
            coefficient = coefficient * np.where(is_tm, self._tm_sign(direction, plane.normal), 1.0)
        return coefficient * self.shares(plane.mesh, cosine)[0], is_tm & (not is_mirror)

    def _tm_sign(self, direction, normal):
        """Sign [M] of the field's components along p_i and p_r of a plane."""
        polarization = np.asarray(self.radar.transmitters[0].polarization, float)
        axis, behind = cross(direction, normal), direction - 2 * (direction @ normal)[:, None] * normal
        return np.where((cross(axis, direction) @ polarization) * (cross(axis, behind) @ polarization) < 0, -1.0, 1.0)

    def blocked(self, starts, ends, *arguments, **keywords):
        """`blocked`, which nothing is where shadows are not looked at."""
        if not self.sees_shadows:
            return np.zeros(len(starts), bool)
        return blocked(starts, ends, *arguments, **keywords)

    # --- surfaces ---

    def coefficient(self, mesh, cosine, direction, normal):
        """Gamma of the scalar model [M]: metal and given reflectivities -1 and -sqrt(rho), else Fresnel's TE or TM; and
        whether it is the latter [M]."""
        material = self.materials[mesh]
        if self.is_metal(mesh):
            return np.full(len(cosine), -np.sqrt(material.reflectivity or 1.0), complex), np.zeros(len(cosine), bool)
        epsilon = material.permittivity - 1j * material.conductivity / (
            2 * np.pi * self.radar.waveform.start_frequency * 8.8541878128e-12)
        root = np.sqrt(epsilon - (1 - cosine ** 2) + 0j)
        root = np.where(root.imag > 0, -root, root)
        te, tm = (cosine - root) / (cosine + root), (epsilon * cosine - root) / (epsilon * cosine + root)
        axis = cross(direction, normal)
        polarization = np.asarray(self.radar.transmitters[0].polarization, float)
        across = polarization - (direction @ polarization)[:, None] * direction
        size = lengths_of(across) * lengths_of(axis)
        is_te = np.abs(np.einsum("ij,ij->i", across, axis)) >= np.sqrt(0.5) * size - 1e-15
        return np.where(is_te, te, tm), ~is_te

    def facet_reflection(self, mesh):
        """|Gamma| at normal incidence: of the facets that scatter diffusely."""
        gamma, _ = self.coefficient(mesh, np.ones(1), np.array([[0.0, 0.0, -1.0]]), np.array([[0.0, 0.0, 1.0]]))
        return float(np.abs(gamma[0]))

    def is_metal(self, mesh):
        """Whether a mesh reflects as a conductor does."""
        return self.materials[mesh].permittivity is None

    def shares(self, mesh, cosine):
        """(s, S): field shares of the coherent and the diffuse part [M]."""
        material = self.materials[mesh]
        if material.scattering is not None:
            return np.full(len(cosine), np.sqrt(1 - material.scattering ** 2)), np.full(len(cosine), material.scattering)
        coherent = np.exp(-2 * (2 * np.pi / self.wavelength * material.roughness_height * cosine) ** 2)
        return coherent, np.sqrt(1 - coherent ** 2)

    def sign(self, leg, metal, is_tm):
        """Sign [M] of what comes back. Along p_i and p_r a TM field turns by k_out.k_in = -1 on the whole way, and metal has
        +1 there; the scalar model gives metal -1 at each bounce."""
        walls = [mesh for mesh in leg.planes if not self.materials[mesh].mirror]
        bounces = metal.astype(int) + sum(map(self.is_metal, walls))
        return np.where(is_tm | leg.is_tm, -(-1.0) ** bounces, 1.0)
