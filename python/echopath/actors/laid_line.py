"""The line that a gait goes along, laid along a trajectory.

A gait goes straight ahead on a line. That line is laid along the path: a place x on it lies at the distance s(x) along the path,
and the foot that stands at x is put where the path is at s(x). Steps are as long as the gait has them at the speed that it is
made for, shorter before and behind a stop, and a little stretched so that a whole number of them lies between two stops.
"""
import numpy as np

from ..trajectories.profile import Profile, hermite_coefficients

STEP = 2.0**-8          # s, of the table of ways
SLOWEST = 0.2           # of the speed that the gait is made for: slower steps are not much shorter
LONGEST = 1.15          # of half a cycle: steps between two stops that were longer become one more
END_WAY = 0.01          # m, over which the length of a step is taken at the ends


class LaidLine:
    """`line`: Profile of the place on the gait's line in m over time in s.

    track: trajectories.track.Track; speed: m/s that the gait is made for; half: m, of half a cycle of it; at_stop: m on the line,
    where all feet are down, as they are `half` m farther on and so on
    """

    def __init__(self, track, speed: float, half: float, at_stop: float):
        self.track = track
        profile = track.profile
        count = int((profile.end - profile.begin) / STEP) + 2
        times = np.unique(np.concatenate([np.linspace(profile.begin, profile.end, count), profile.times]))
        distances, speeds, _ = profile.at(times)
        stretch = ((1.0 + SLOWEST**2) / ((speeds / speed) ** 2 + SLOWEST**2)) ** 0.25
        steps = np.diff(times)
        way = np.concatenate([[0.0], np.cumsum(0.5 * (stretch[:-1] + stretch[1:]) * np.diff(distances))])
        stops = np.searchsorted(times, profile.stops()[0])
        wanted = np.diff(way[stops]) / half
        counts = np.maximum(np.round(wanted), 1.0)
        counts += wanted > LONGEST * counts
        line = np.interp(way, way[stops], at_stop + half * np.concatenate([[0.0], np.cumsum(counts)]))
        slopes = np.gradient(line, times) * (speeds > 0.0)
        moves = np.diff(distances) > 1e-12
        self._places, self._distances = np.stack([line, distances])[:, np.concatenate([[True], moves])]
        self.line = Profile(times, hermite_coefficients(steps, line, slopes))

    def distances(self, line):
        """Distances [...] along the path of places on the line; beyond its ends with steps as long as they are there."""
        places, distances = self._places, self._distances
        near = int(np.searchsorted(distances, min(distances[0] + END_WAY, distances[-1])))
        far = int(np.searchsorted(distances, max(distances[-1] - END_WAY, distances[0]), side="right")) - 1
        first = _slope(distances[near] - distances[0], places[near] - places[0])
        last = _slope(distances[-1] - distances[far], places[-1] - places[far])
        inside = np.clip(line, places[0], places[-1])
        return np.interp(inside, places, distances) + np.where(line < inside, first, last) * (line - inside)

    def footprints(self, line):
        """(points [T, 3] in m, yaws [T] in rad) of the path under places [T] on the line."""
        distances = self.distances(line)
        return self.track.path.points(distances), self.track.path.bearings(distances)[0]


def _slope(distance: float, place: float) -> float:
    """Of the distance over the place; 1 where nothing moves all the time."""
    return distance / place if place > 0.0 else 1.0


def usual_speed(track) -> float:
    """m/s: the mean over the way, so that waiting does not count."""
    profile = track.profile
    begins, steps = profile.times[:-1, None], np.diff(profile.times)[:, None]
    nodes, weights = np.polynomial.legendre.leggauss(3)     # exact, as the square of a speed is of the fourth power of the time
    speeds = profile.at((begins + 0.5 * steps * (1.0 + nodes)).ravel())[1].reshape(-1, 3)
    return float(np.sum(steps * weights * speeds**2) / max(np.sum(steps * weights * speeds), 1e-12))
