"""The echoes of rain: volume clutter as a record of paths over drops, many in each range cell."""
from __future__ import annotations

import math
from itertools import product

import numpy as np

from .. import _core
from ..arguments.effects import RAIN_ECHOES, Choices, is_on
from ..base.numerics.rotations import matrices
from ..base.radar.antennas import one_of_each_look
from ..paths.absent import NO_BATCH, NO_STRATUM
from ..paths.subset import HIT
from ..transmit import signal_shape
from ..weather.drops import DIAMETERS, fall_speeds, reflectivities
from ..weather.weather import Weather, attenuation_of, weather_of
from .if_signal import synthesize

NUM_DROPS = 16384     # each stands for the rain in a part of the volume
NEAREST = 0.5         # m, of the drops
FARTHEST = 1e4        # m, likewise
SIDE = 1e-3           # m, of the triangles on which the drops stand
NUM_CELLS = 256       # of azimuth and of the sine of elevation, in which the sphere is before narrow beams divide them
LARGEST_SHARE = 1e-3  # of what is heard, above which a cell is divided: some thousand directions are in any beam
MOST_DIVISIONS = 12   # after which cells are a thousandth of a degree wide
_STREAM = 0x7261696E  # tells these random numbers from others of the same seed


def has_rain_echoes(scene, effects: Choices) -> bool:
    """Whether a scene's weather and `effects` ask for echoes of rain. Raises ValueError where only the latter do."""
    weather = weather_of(scene)
    has_rain = weather is not None and weather.rain_mm_per_hour > 0
    return is_on(effects, RAIN_ECHOES, has_rain, "Scene.weather with rain_mm_per_hour")


def rain_cube(scene, radar: _core.Radar, *, start_time: float, seed: int, effects: Choices = (), polarization: str = "scalar"):
    """The signal of the rain in a frame alone, complex, in the shape of `synthesize` in sqrt(W), of a scene that has rain.

    start_time: s, of the frame; seed: of the drops, which differ from frame to frame, as those of showers do (their echoes
    lose their phase within a millisecond); effects: as in `trace`; polarization: "scalar" or "jones", the model of the frame
    """
    paths = rain_paths(scene, radar, start_time=start_time, seed=seed, effects=effects, polarization=polarization)
    if paths is None:
        return np.zeros(signal_shape(radar), complex)
    return synthesize(paths, radar)


def rain_paths(scene, radar: _core.Radar, *, start_time: float, seed: int, effects: Choices = (), polarization: str = "scalar"):
    """Paths over drops that nothing of the scene hides, None where there are none, or where no antennas see the same; arguments
    as of `rain_cube`."""
    weather = scene.weather
    random = np.random.default_rng([_STREAM, seed, np.float64(start_time).view(np.uint64)])
    middle = radar.middle_of_frame(start_time)
    transmitter, receiver = (_mean_position(radar, antennas, middle) for antennas in (radar.transmitters, radar.receivers))
    directions, gains, solid = _directions(radar, random)
    if not gains.any():
        return None
    points, volumes = _places(radar, transmitter, directions @ radar.world_from_radar(middle)[:3, :3].T, gains, solid, random)
    seen = np.ones(len(points), bool)
    for antenna in (transmitter, receiver):
        seen &= _core.are_clear(scene, time=middle, origin=antenna, points=points)
    if not seen.any():
        return None
    points, volumes = points[seen], volumes[seen]
    speeds, sizes = _drops(weather, radar, len(points), random)
    record = _Record(radar, start_time, middle, transmitter, receiver, attenuation_of(scene, radar, effects), polarization)
    return record.of(points, _velocities(weather, speeds, random), sizes * volumes, random)


def rain_power(radar: _core.Radar, weather: Weather, attenuation: float) -> float:
    """Mean power in W that the rain in the radar's ranges sends back where nothing hides it, between the antennas that hear most
    of it: the radar equation of a volume; attenuation: Np/m."""
    directions, _, cells = _directions(radar, np.random.default_rng(_STREAM))
    sent, heard = ([_gains(antennas[index], directions) for index in one_of_each_look(antennas)]
                   for antennas in (radar.transmitters, radar.receivers))
    solid = max(np.sum(one * other * cells) for one, other in product(sent, heard))
    ranges = np.geomspace(NEAREST, min(radar.waveform.max_range, FARTHEST), 2000)
    wavelength = _core.speed_of_light / radar.waveform.start_frequency
    density = np.exp(-4.0 * attenuation * ranges) / ranges**2
    return (radar.transmit_power * wavelength**2 * weather.rain_reflectivity(radar) * solid / (4.0 * math.pi)**3
            * float(np.sum(0.5 * (density[1:] + density[:-1]) * np.diff(ranges))))


def _directions(radar, random):
    """Directions [N, 3] in the radar's axes, one in each cell of the sphere, their `_two_way_gains` [N] and the cells [N] in sr.

    Cells are divided where much is heard out of one, so that beams have many of them, however narrow they are.
    """
    size = np.tile([2.0 * math.pi / NUM_CELLS, 2.0 / NUM_CELLS], (NUM_CELLS**2, 1))  # azimuth in rad, sine of elevation
    low = np.indices((NUM_CELLS, NUM_CELLS)).reshape(2, -1).T * size[0] - (math.pi, 1.0)
    for _ in range(MOST_DIVISIONS):
        heard = _two_way_gains(radar, _in_cells(low, size, random)) * size.prod(axis=1)  # drawn anew: a peak may be missed once
        is_large = heard > LARGEST_SHARE * heard.sum()
        if not is_large.any():
            break
        quarters = np.tile(0.5 * size[is_large], (4, 1))
        corners = np.tile(low[is_large], (4, 1)) + quarters * np.repeat([[0, 0], [0, 1], [1, 0], [1, 1]], is_large.sum(), axis=0)
        low, size = np.concatenate([low[~is_large], corners]), np.concatenate([size[~is_large], quarters])
    directions = _in_cells(low, size, random)  # new ones: those that the division went by are no fair sample
    return directions, _two_way_gains(radar, directions), size.prod(axis=1)


def _in_cells(low, size, random):
    """A direction [N, 3] in each cell, from its azimuth in rad and sine of elevation `low` [N, 2] on, of a `size` [N, 2]."""
    azimuth, up = (low + size * random.random(low.shape)).T
    level = np.sqrt(np.maximum(0.0, 1.0 - up**2))
    return np.stack([level * np.cos(azimuth), level * np.sin(azimuth), up], axis=1)


def _places(radar, origin, directions, gains, solid, random):
    """Points [N, 3] in m with the volumes [N] in m^3 that they stand for: evenly over ranges, and over directions by gains."""
    farthest = min(radar.waveform.max_range, FARTHEST)
    heard = gains * solid
    drawn = random.choice(len(heard), NUM_DROPS, p=heard / heard.sum())
    per_direction = gains / heard.sum()  # 1/sr
    ranges = NEAREST + (farthest - NEAREST) * (np.arange(NUM_DROPS) + random.random(NUM_DROPS)) / NUM_DROPS
    volumes = ranges**2 * (farthest - NEAREST) / (NUM_DROPS * per_direction[drawn])
    return origin + ranges[:, None] * directions[drawn], volumes


def _two_way_gains(radar, directions):
    """Sum over pairs of antennas, of which those that look the same way count once, toward directions [N, 3] in radar axes."""
    sent, heard = (sum(_gains(antennas[index], directions) for index in one_of_each_look(antennas))
                   for antennas in (radar.transmitters, radar.receivers))
    return sent * heard


def _gains(antenna, directions):
    """Power gain of an antenna toward directions [N, 3] in the radar's axes."""
    return np.abs(antenna.pattern.field(directions @ matrices(antenna.orientation)))**2


def _mean_position(radar, antennas, time: float):
    mean = np.mean([antenna.position for antenna in antennas], axis=0)
    placed = radar.world_from_radar(time)
    return placed[:3, :3] @ mean + placed[:3, 3]


def _drops(weather: Weather, radar, count: int, random):
    """Fall speeds [N] in m/s, drawn by what drops of a size scatter, and the reflectivity [N] in 1/m that each has: all of it,
    as each drop stands for all sizes."""
    by_size = reflectivities(radar.waveform.centre_frequency, weather.rain_mm_per_hour, weather.temperature)
    whole = by_size.sum()
    return fall_speeds(random.choice(DIAMETERS, count, p=by_size / whole)), np.full(count, whole)


def _velocities(weather: Weather, speeds, random):
    """[N, 3] m/s."""
    velocities = np.array(weather.wind) + weather.turbulence * random.normal(size=(len(speeds), 3))
    velocities[:, 2] -= speeds
    return velocities


class _Record:
    """Makes paths over drops, each a small triangle that faces the antennas and scatters all around."""

    def __init__(self, radar, start_time, middle, transmitter, receiver, attenuation, polarization):
        self._radar, self._middle, self._polarization = radar, middle, polarization
        self._between = 0.5 * (transmitter + receiver)
        self._frame = _core.TraceFrame(
            start_time=start_time, trace_time=middle, transmitter=transmitter, receiver=receiver, strata=[], seed=0,
            max_bounces=1, polarization=polarization, footprint="second_order", statistics=_core.TraceStatistics(),
            attenuation=attenuation)

    def of(self, points, velocities, cross_sections, random):
        """_core.Paths over drops at `points` [N, 3] in mid-frame that move at `velocities` [N, 3] in m/s."""
        count = len(points)
        phases = np.exp(2j * np.pi * random.random(count))
        hits = np.zeros(count, HIT)
        hits["triangle_id"], hits["u"], hits["v"] = np.arange(count), 1.0 / 3.0, 1.0 / 3.0
        columns = {"offsets": np.arange(count, dtype=np.int64), "num_bounces": np.ones(count, np.uint8),
                   "diffuse": np.ones(count, np.uint64),
                   "weight": (np.sqrt(0.25 * cross_sections) * phases).astype(np.complex64),
                   "stratum": np.full(count, NO_STRATUM, np.uint16), "batch": np.full(count, NO_BATCH, np.uint8),
                   "flags": np.zeros(count, np.uint32)}
        if self._polarization == "jones":  # spheres keep the polarisation
            columns["jones"] = np.tile(np.diag([-1, 1]).astype(np.complex64), (count, 1, 1))
        return _core.Paths.from_arrays(hits=hits, **columns, scene=self._scene(points, velocities), radar=self._radar,
                                       frame=self._frame)

    def _scene(self, points, velocities):
        corners = (points[:, None] + SIDE * self._corners(points)).reshape(-1, 3)
        steps = np.repeat(velocities, 3, axis=0) * (0.5 * self._radar.frame_duration + 1e-3)
        half = 0.5 * self._radar.frame_duration + 1e-3
        motion = _core.VertexSequence([self._middle - half, self._middle + half], [corners - steps, corners + steps], "linear")
        mesh = _core.Mesh(corners, np.arange(len(corners), dtype=np.uint32).reshape(-1, 3))
        scene = _core.Scene()
        scene._add_nodes([_core.Node(name="rain", mesh=mesh, deformation=motion,
                                     material=_core.Material(reflectivity=1.0, scattering=1.0))])
        return scene

    def _corners(self, points):
        """[N, 3, 3] of equal triangles about the origin, across the lines of sight."""
        sight = points - self._between
        sight /= np.linalg.norm(sight, axis=1)[:, None]
        helper = np.where(np.abs(sight[:, 2:]) < 0.9, [[0.0, 0.0, 1.0]], [[1.0, 0.0, 0.0]])
        first = np.cross(helper, sight)
        first /= np.linalg.norm(first, axis=1)[:, None]
        second = np.cross(sight, first)
        angles = 2.0 * np.pi * np.arange(3) / 3.0
        return np.cos(angles)[None, :, None] * first[:, None] + np.sin(angles)[None, :, None] * second[:, None]
