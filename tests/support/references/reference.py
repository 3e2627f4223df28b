"""The whole chain in plain NumPy, slow, from the equations: currents on a fine grid of points instead of rays.

Every surface is cut into small cells. Each cell radiates what reaches it over every leg from the transmitter (directly, over
one or two flagged planes by their images, or over an unflagged one as the wall of a corner) along every leg to the receiver
(directly or over flagged planes): by physical optics where the surface is smooth, by Lambert's law where it is rough. Cells
of meshes with interpolated normals lie on the curved surface that those stand for (p' of `reference_cells`). What stands in
the way is found by trying all triangles. Time factor e^{+jwt}; lengths in m, amplitudes in sqrt(W), fields without their
phase.

    a    = j sqrt(Pt Gt Gr)/(4 pi) Gamma s g_in g_out cos_in dS / (L_in L_out)          physical optics, obliquity cos_in,
           on curved surfaces times 4 cos_in cos_out/(cos_in + cos_out)^2: no edge wave where the shadow begins
    |a|^2 = Pt Gt/(4 pi) |g_in g_out|^2 |Gamma(0)|^2 S^2/pi cos_in cos_out dS lambda^2 Gr/(4 pi) / (L_in L_out)^2  diffuse
    a    = Gamma s lambda sqrt(Pt Gt Gr)/(4 pi L)                                        over flagged planes alone
    s(T + t) = sum of conj(a) exp j 2 pi (f0 tau + mu t tau - mu tau^2/2),  tau = L(T + t)/c

One rough point has one random phase for all its pairs of legs: mean powers are sums over points of |sum over pairs|^2.
"""
import functools

import numpy as np

from .reference_cells import Cells, lengths_of
from .reference_legs import LEG_MIRRORS, C, ReferenceLegs


def taper(cells, cos_in, cos_out):
    """What fades out toward the shadow of curved surfaces [M]."""
    return np.where(cells.bent, 4 * cos_in * cos_out / np.maximum(cos_in + cos_out, 1e-12) ** 2, 1.0)


class Reference(ReferenceLegs):
    """Echoes and IF samples of one scene and one radar; retro: only those that return from cells over the planes by which
    they came, one at least."""

    retro = False

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
            for two in (leg for leg in receive if self.is_path(one.planes, leg.planes)):
                cos_out = side * np.einsum("ij,ij->i", cells.normals, two.toward)
                ways = one.gain * two.gain * (cos_out > 0) / (one.length * two.length)
                ways = ways * np.sqrt(self.gain(0, one.leaving) * self.gain(1, two.leaving))
                field = 1j * antennas * sign * gamma * coherent * cos_in * taper(cells, cos_in, cos_out) * cells.areas * ways
                power = np.sqrt(np.maximum(cos_in * cos_out, 0.0) * cells.areas / np.pi) * diffuse
                out.append((one.length + two.length, field, antennas * self.wavelength * power * ways))
        return cells, out

    def is_path(self, there, back):
        """Whether a path over these planes before and behind a cell is meant; none over a corner's wall and mirrors."""
        walls = any(not self.materials[mesh].mirror for mesh in there)
        meant = not self.retro or (there == back != ())
        return meant and len(there) + 1 + len(back) <= self.max_bounces and not (walls and back)

    def _responses(self, cells, leg, cos_in):
        gamma, coherent, diffuse, is_tm, metal = (np.zeros(len(cos_in), kind)
                                                  for kind in (complex, float, float, bool, bool))
        for mesh in np.unique(cells.mesh):
            at = cells.mesh == mesh
            gamma[at], is_tm[at] = self.coefficient(mesh, cos_in[at], -leg.toward[at], cells.normals[at])
            metal[at] = self.is_metal(mesh)
            coherent[at], diffuse[at] = self.shares(mesh, cos_in[at])
            diffuse[at] *= self.facet_reflection(mesh)
        return gamma, coherent, diffuse, self.sign(leg, metal, is_tm)

    def gain(self, side, leaving):
        """Power gain of the transmitter (side 0) or receiver toward unit directions [M, 3]; boresight +x."""
        antenna = (self.radar.transmitters if side == 0 else self.radar.receivers)[0]
        pattern = antenna.pattern
        if pattern.kind == "isotropic":
            return np.full(len(leaving), pattern.peak_gain)
        return pattern.peak_gain * np.maximum(leaving[:, 0], 0.0) ** pattern.exponent

    @functools.cached_property
    def at_trace_time(self):
        """Echoes between the mean antennas as (length [M], coherent amplitude [M]): from cells, and over planes alone."""
        self.is_mean = True
        found = [pair[:2] for pair in self.pairs(self.trace_time)[1]], self.planes_alone(self.trace_time)
        self.is_mean = False
        return found

    def coherent_field(self):
        """Sum of all coherent echoes at the trace time with their phases, sqrt(W); planes by themselves included."""
        return sum(np.sum(field * self._turned(length)) for echoes in self.at_trace_time for length, field in echoes)

    def planes_alone(self, time):
        """(length [1], amplitude [1]) of the echo over each sequence of flagged planes by its images."""
        receiver = self.antenna(1, time)[None]
        at = Cells(receiver, np.ones((1, 3)), np.ones(1), np.array([-1]), np.array([-1]), receiver,
                   np.zeros(1, bool))
        out = []
        for meshes in self.sequences(self.max_bounces)[1:] if not self.retro else ():
            leg = self.leg(at, self.antenna(0, time), time, meshes)
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

    def cube(self, step, channel=(0, 0)):
        """Coherent IF samples [chirp, sample], the first of every `step` of a chirp: delays at every sample, amplitudes at the
        middle of each chirp, shadows at the trace time, of the mean antennas. Transmitters take turns."""
        waveform = self.radar.waveform
        t = np.arange(waveform.num_samples) / waveform.sampling_rate
        kept = t[::step]
        seen, seen_alone = ([field != 0 for _, field in echoes] for echoes in self.at_trace_time)
        self.channel, self.sees_shadows = channel, False
        out = np.zeros((waveform.num_chirps, len(kept)), complex)
        for j in range(waveform.num_chirps):
            begin = (j * len(self.radar.transmitters) + self.channel[0]) * waveform.chirp_interval
            fields = [field * mask for (_, field, _), mask in zip(self.pairs(begin + t.mean())[1], seen)]
            for n, offset in enumerate(kept):
                alone = [(length, field * mask)
                         for (length, field), mask in zip(self.planes_alone(begin + offset), seen_alone)]
                echoes = [*zip(self._lengths(begin + offset), fields), *alone]
                out[j, n] = sum(self._sample(length, field, offset) for length, field in echoes)
        self.sees_shadows = True
        return out

    def _lengths(self, time):
        """Lengths of all pairs of legs [M] at `time`, whatever is in the way."""
        cells = self.cells(time)
        one, two = ({row: self._length(cells, self.antenna(side, time), row, time)
                     for row in self.sequences(LEG_MIRRORS, walls=self.corners and side == 0)} for side in (0, 1))
        return [one[a] + two[b] for a in one for b in two if self.is_path(a, b)]

    def _length(self, cells, antenna, meshes, time):
        for mesh in meshes:
            antenna = self.plane(mesh, time).image(antenna)
        return lengths_of(antenna - cells.points)

    def _sample(self, length, field, t):
        waveform, tau = self.radar.waveform, length / C
        turns = np.mod(waveform.start_frequency * tau, 1.0) + waveform.slope * t * tau - 0.5 * waveform.slope * tau ** 2
        return np.sum(np.conj(field) * np.exp(2j * np.pi * turns))
