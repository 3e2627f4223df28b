"""The whole chain in plain NumPy, slow, from the equations: currents on a fine grid of points instead of rays.

Every surface is cut into small cells. Each cell radiates what reaches it over every leg from the transmitter (directly, over
a flagged plane by its image, or over an unflagged one as the wall of a corner) along every leg to the receiver (directly or
over a flagged plane): by physical optics where the surface is smooth, by Lambert's law where it is rough. What stands in the
way is found by trying all triangles. Time factor e^{+jwt}; lengths in m, amplitudes in sqrt(W), fields without their phase.

    a    = j sqrt(Pt Gt Gr)/(4 pi) Gamma s g_in g_out cos_in dS / (L_in L_out)          physical optics, obliquity cos_in
    |a|^2 = Pt Gt/(4 pi) |g_in g_out|^2 |Gamma|^2 S^2/pi cos_in cos_out dS lambda^2 Gr/(4 pi) / (L_in L_out)^2     diffuse
    a    = Gamma s lambda sqrt(Pt Gt Gr)/(4 pi L)                                        over a flagged plane alone
    s(T + t) = sum of conj(a) exp j 2 pi (f0 tau + mu t tau - mu tau^2/2),  tau = L(T + t)/c

One rough point has one random phase for all its pairs of legs: mean powers are sums over points of |sum over pairs|^2.
"""
import dataclasses
import functools

import numpy as np

from .slow_lengths import surface

C = 299792458.0
CLEAR = 1e-6  # m: both ends of a segment that are not looked at


@dataclasses.dataclass
class Cells:
    """Cells of surfaces: points [M, 3], normals [M, 3], areas [M] in m^2, mesh [M], triangle [M] among all."""

    points: np.ndarray
    normals: np.ndarray
    areas: np.ndarray
    mesh: np.ndarray
    triangle: np.ndarray


@dataclasses.dataclass
class Leg:
    """Ways from an antenna to cells: lengths [M], toward (unit, cell -> antenna's image) [M, 3], gain [M] (complex, 0 where
    blocked), leaving (unit, at the antenna) [M, 3]; is_tm [M]: over an unflagged dielectric in TM; plane: mesh, or -1."""

    length: np.ndarray
    toward: np.ndarray
    gain: np.ndarray
    leaving: np.ndarray
    is_tm: np.ndarray
    plane: int


class Reference:
    """One scene and one radar; spacing: of the cells in m; channel: (transmitter, receiver) whose echoes are meant."""

    def __init__(self, scene, radar, *, spacing, trace_time, corners=False, channel=(0, 0)):
        self.channel, self.is_mean = channel, False
        self.scene, self.radar, self.trace_time, self.corners = scene, radar, trace_time, corners
        self.materials = [mesh.material for mesh in scene.meshes]
        self.wavelength = C / radar.waveform.start_frequency
        self.spacing = spacing
        self.sees_shadows = True
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
        return cos * point + sin * np.cross(axis, point) + (1 - cos) * (axis @ point) * axis + motion.velocity * time

    def triangles(self, time):
        """[F, 3, 3] of all meshes and the mesh of each [F]."""
        all_corners, owner = [], []
        for mesh in self.scene.meshes:
            vertices, triangles, *_ = surface(self.scene, mesh, time, self.trace_time)
            all_corners.append(vertices[triangles])
            owner += [mesh.id] * len(triangles)
        return np.concatenate(all_corners), np.array(owner)

    def cells(self, time):
        """Cells of the meshes that are no mirrors, at `time` the same material points."""
        corners, owner = self.triangles(time)
        parts = []
        for index, triangle in enumerate(corners):
            if self.materials[owner[index]].mirror:
                continue
            weights = _grid(int(self.pieces[index]))
            normal = np.cross(triangle[1] - triangle[0], triangle[2] - triangle[0])
            area = 0.5 * np.linalg.norm(normal)
            count = len(weights)
            parts.append((weights @ triangle, np.tile(normal / (2 * area), (count, 1)), np.full(count, area / count),
                          np.full(count, owner[index]), np.full(count, index)))
        return Cells(*(np.concatenate(column) for column in zip(*parts)))

    def legs(self, cells, antenna, time, *, to_receiver):
        """All legs between an antenna and the cells: direct, over flagged planes, and, on the transmitter's side, over walls
        of corners."""
        corners, owner = self.triangles(time)
        found = [self._direct(cells, antenna, corners)]
        for mesh, material in enumerate(self.materials):
            if material.mirror or (self.corners and not to_receiver):
                found.append(self._over(cells, antenna, corners, owner, mesh))
        return found

    def _direct(self, cells, antenna, corners):
        line = antenna - cells.points
        length = np.linalg.norm(line, axis=1)
        toward = line / length[:, None]
        free = ~self.blocked(cells.points, np.broadcast_to(antenna, cells.points.shape), corners, cells.triangle)
        return Leg(length, toward, free.astype(complex), -toward, np.zeros(len(length), bool), -1)

    def _over(self, cells, antenna, corners, owner, mesh):
        mine = np.flatnonzero(owner == mesh)
        anchor = corners[mine[0], 0]
        normal = np.cross(corners[mine[0], 1] - anchor, corners[mine[0], 2] - anchor)
        normal /= np.linalg.norm(normal)
        image = antenna - 2 * ((antenna - anchor) @ normal) * normal
        line = image - cells.points
        length = np.linalg.norm(line, axis=1)
        toward = line / length[:, None]
        height, slope = (cells.points - anchor) @ normal, -(toward @ normal)
        with np.errstate(divide="ignore", invalid="ignore"):
            share = height / slope
        same_side = (height * ((antenna - anchor) @ normal) > 0) & (share > 0) & (share < length) & (cells.mesh != mesh)
        share = np.where(same_side, share, 0.0)
        point = cells.points + share[:, None] * toward
        on_plane = np.zeros(len(point), bool)
        for index in mine:
            on_plane |= inside(point, corners[index])
        ok = same_side & on_plane
        ok &= ~self.blocked(cells.points, point, corners, cells.triangle, leave_out=mine)
        ok &= ~self.blocked(np.broadcast_to(antenna, point.shape), point, corners, np.full(len(point), -1), leave_out=mine)
        leaving = _unit(point - antenna)
        cosine = np.abs(leaving @ normal)
        coefficient, is_tm = self.coefficient(mesh, cosine, leaving, normal)
        if self.materials[mesh].mirror and not self.is_metal(mesh):
            coefficient = coefficient * np.where(is_tm, self._tm_sign(leaving, normal), 1.0)
        gain = np.where(ok, coefficient * self.shares(mesh, cosine)[0], 0.0)
        return Leg(length, toward, gain, leaving, is_tm & (not self.materials[mesh].mirror), mesh)

    def _tm_sign(self, direction, normal):
        """Sign [M] of the field's components along p_i and p_r of a plane."""
        polarization = np.asarray(self.radar.transmitters[0].polarization, float)
        axis, behind = np.cross(direction, normal), direction - 2 * (direction @ normal)[:, None] * normal
        return np.where((np.cross(axis, direction) @ polarization) * (np.cross(axis, behind) @ polarization) < 0, -1.0, 1.0)

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
        axis = np.cross(direction, normal)
        polarization = np.asarray(self.radar.transmitters[0].polarization, float)
        across = polarization - (direction @ polarization)[:, None] * direction
        size = np.linalg.norm(across, axis=1) * np.linalg.norm(axis, axis=1)
        is_te = np.abs(np.einsum("ij,ij->i", across, axis)) >= np.sqrt(0.5) * size - 1e-15
        return np.where(is_te, te, tm), ~is_te

    def is_metal(self, mesh):
        """Whether a mesh reflects as a conductor does."""
        return self.materials[mesh].permittivity is None

    def sign(self, leg, metal, is_tm):
        """Sign [M] of what comes back. Along p_i and p_r a TM field turns by k_out.k_in = -1 on the whole way, and metal has
        +1 there; the scalar model gives metal -1 at each bounce."""
        wall = leg.plane >= 0 and not self.materials[leg.plane].mirror
        bounces = metal.astype(int) + int(wall and self.is_metal(leg.plane))
        return np.where(is_tm | leg.is_tm, -(-1.0) ** bounces, 1.0)

    def shares(self, mesh, cosine):
        """(s, S): field shares of the coherent and the diffuse part [M]."""
        material = self.materials[mesh]
        if material.scattering is not None:
            return np.full(len(cosine), np.sqrt(1 - material.scattering ** 2)), np.full(len(cosine), material.scattering)
        coherent = np.exp(-2 * (2 * np.pi / self.wavelength * material.roughness_height * cosine) ** 2)
        return coherent, np.sqrt(1 - coherent ** 2)

    # --- echoes ---

    def pairs(self, time):
        """Cells and, for each pair of legs, (lengths [M], coherent amplitudes [M], diffuse ones without phase [M])."""
        cells = self.cells(time)
        out = []
        antennas = np.sqrt(self.radar.transmit_power) / (4 * np.pi)
        receive = self.legs(cells, self.antenna(1, time), time, to_receiver=True)
        for one in self.legs(cells, self.antenna(0, time), time, to_receiver=False):
            cos_in = np.einsum("ij,ij->i", cells.normals, one.toward)
            side = np.where(cos_in < 0, -1.0, 1.0)
            cos_in = np.abs(cos_in)
            gamma, coherent, diffuse, sign = self._responses(cells, one, cos_in)
            for two in receive:
                cos_out = side * np.einsum("ij,ij->i", cells.normals, two.toward)
                ways = one.gain * two.gain * (cos_out > 0) / (one.length * two.length)
                ways = ways * np.sqrt(self.gain(0, one.leaving) * self.gain(1, two.leaving))
                if one.plane >= 0 and not self.materials[one.plane].mirror and two.plane >= 0:
                    continue  # a corner's wall and a mirror: not in these scenes
                field = 1j * antennas * sign * gamma * coherent * cos_in * cells.areas * ways
                power = np.sqrt(np.maximum(cos_in * cos_out, 0.0) * cells.areas / np.pi) * diffuse * np.abs(gamma)
                out.append((one.length + two.length, field, antennas * self.wavelength * power * ways))
        return cells, out

    def _responses(self, cells, leg, cos_in):
        gamma, coherent, diffuse, is_tm, metal = (np.zeros(len(cos_in), kind)
                                                  for kind in (complex, float, float, bool, bool))
        for mesh in np.unique(cells.mesh):
            at = cells.mesh == mesh
            gamma[at], is_tm[at] = self.coefficient(mesh, cos_in[at], -leg.toward[at], cells.normals[at])
            metal[at] = self.is_metal(mesh)
            coherent[at], diffuse[at] = self.shares(mesh, cos_in[at])
        return gamma, coherent, diffuse, self.sign(leg, metal, is_tm)

    def gain(self, side, leaving):
        """Power gain of the transmitter (side 0) or receiver toward unit directions [M, 3]; boresight +x."""
        antenna = (self.radar.transmitters if side == 0 else self.radar.receivers)[0]
        pattern = antenna.pattern
        if pattern.kind == "isotropic":
            return np.full(len(leaving), pattern.peak_gain)
        return pattern.peak_gain * np.maximum(leaving[:, 0], 0.0) ** pattern.exponent

    def coherent_field(self, time):
        """Sum of all coherent echoes with their phases, sqrt(W); planes by themselves included."""
        every = [*self.planes_alone(time), *((length, field) for length, field, _ in self.pairs(time)[1])]
        return sum(np.sum(field * self._turned(length)) for length, field in every)

    def planes_alone(self, time):
        """(length [1], amplitude [1]) of the echo of each flagged plane by its image."""
        corners, owner = self.triangles(time)
        at = Cells(self.antenna(1, time)[None], np.ones((1, 3)), np.ones(1), np.array([-1]), np.array([-1]))
        out = []
        for mesh in np.flatnonzero([material.mirror for material in self.materials]):
            leg = self._over(at, self.antenna(0, time), corners, owner, mesh)
            gains = np.sqrt(self.radar.transmit_power * self.gain(0, leg.leaving) * self.gain(1, leg.toward))
            out.append((leg.length, self._reflected(leg, time) * self.wavelength * gains / (4 * np.pi * leg.length)))
        return out

    def _reflected(self, leg, time):
        """What reaches the receiver of a field of one that leaves over a plane, [1]."""
        return leg.gain

    def diffuse_power(self, time):
        """Mean over the random phases, W."""
        _, pairs = self.pairs(time)
        return float(np.sum(np.abs(sum(field * self._turned(length) for length, _, field in pairs)) ** 2))

    def _turned(self, length):
        return np.exp(-2j * np.pi * np.mod(length / self.wavelength, 1.0))

    def cube(self):
        """Coherent IF samples [chirp, sample]: delays at every sample, amplitudes at the middle of each chirp, shadows at
        the trace time, of the mean antennas. Transmitters take turns."""
        waveform = self.radar.waveform
        t = np.arange(waveform.num_samples) / waveform.sampling_rate
        self.is_mean = True
        seen = [field != 0 for _, field, _ in self.pairs(self.trace_time)[1]]
        self.is_mean = self.sees_shadows = False
        out = np.zeros((waveform.num_chirps, waveform.num_samples), complex)
        for j in range(waveform.num_chirps):
            begin = (j * len(self.radar.transmitters) + self.channel[0]) * waveform.chirp_interval
            fields = [field * mask for (_, field, _), mask in zip(self.pairs(begin + t.mean())[1], seen)]
            for n, offset in enumerate(t):
                echoes = [*zip(self._lengths(begin + offset), fields), *self.planes_alone(begin + offset)]
                out[j, n] = sum(self._sample(length, field, offset) for length, field in echoes)
        self.sees_shadows = True
        return out

    def _lengths(self, time):
        """Lengths of all pairs of legs [M] at `time`, whatever is in the way."""
        cells = self.cells(time)
        one = [self._length(cells, self.antenna(0, time), leg, time) for leg in self._planes(False)]
        two = [self._length(cells, self.antenna(1, time), leg, time) for leg in self._planes(True)]
        return [a + b for a in one for b in two]

    def _planes(self, to_receiver):
        return [-1, *(mesh for mesh, material in enumerate(self.materials)
                      if material.mirror or (self.corners and not to_receiver))]

    def _length(self, cells, antenna, mesh, time):
        if mesh >= 0:
            corners, owner = self.triangles(time)
            a, b, c = corners[np.flatnonzero(owner == mesh)[0]]
            normal = _unit(np.cross(b - a, c - a))
            antenna = antenna - 2 * ((antenna - a) @ normal) * normal
        return np.linalg.norm(antenna - cells.points, axis=1)

    def _sample(self, length, field, t):
        waveform, tau = self.radar.waveform, length / C
        turns = np.mod(waveform.start_frequency * tau, 1.0) + waveform.slope * t * tau - 0.5 * waveform.slope * tau ** 2
        return np.sum(np.conj(field) * np.exp(2j * np.pi * turns))


@functools.lru_cache
def _grid(pieces):
    """Barycentric middles [pieces^2, 3] of equal small triangles."""
    weights = []
    for i in range(pieces):
        for j in range(pieces - i):
            weights.append(((i + 1 / 3) / pieces, (j + 1 / 3) / pieces))
            if i + j < pieces - 1:
                weights.append(((i + 2 / 3) / pieces, (j + 2 / 3) / pieces))
    uv = np.array(weights)
    return np.column_stack([1 - uv.sum(axis=1), uv])


def _unit(vectors):
    vectors = np.asarray(vectors, float)
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def inside(points, triangle, margin=1e-12):
    """Whether points [M, 3] of a triangle's plane lie in it."""
    a, b, c = triangle
    normal = np.cross(b - a, c - a)
    scale = normal @ normal
    u = np.cross(points - a, c - a) @ normal / scale
    v = np.cross(b - a, points - a) @ normal / scale
    return (u >= -margin) & (v >= -margin) & (u + v <= 1 + margin)


def blocked(starts, ends, corners, own, leave_out=()):
    """Whether a triangle [F, 3, 3] meets the open segments between points [M, 3]; own: triangle [M] that does not count."""
    line = ends - starts
    length = np.linalg.norm(line, axis=1)
    found = np.zeros(len(starts), bool)
    for index, (a, b, c) in enumerate(corners):
        if index in leave_out:
            continue
        normal = np.cross(b - a, c - a)
        slope = line @ normal
        with np.errstate(divide="ignore", invalid="ignore"):
            share = np.where(slope != 0, ((a - starts) @ normal) / slope, -1.0)
        between = (share * length > CLEAR) & ((1 - share) * length > CLEAR) & (own != index)
        if between.any():
            point = starts[between] + share[between, None] * line[between]
            found[np.flatnonzero(between)[inside(point, corners[index])]] = True
    return found
