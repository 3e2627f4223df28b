"""Cities: what they cost, and whether all of its mirror paths are there.

The city is one of houses that stand askew on a grid, each house one mesh of five walls, and the ground. Its truth is a slow
search: images over every pair of walls that the antennas can light, shadows by a loop over all walls. Beside the seconds of
a trace stand those of its ray queries alone, and the error stands beside both. Levels are those of endless walls where walls
are marked, and elsewhere what Kirchhoff's integral over each wall of a path leaves of them.
"""
from __future__ import annotations

import dataclasses

import numpy as np

import echopath as ep

from ...paths.absent import NO_STRATUM
from ..pace import told_at_reference, verdict
from ..speed.tracer import bare_share
from ..timing import processor_time

FREQUENCY = 24e9                         # Hz: every wall is larger than its Fresnel zone
TRANSMITTER, RECEIVER = (9.3, 8.7, 3.1), (10.4, -10.2, 3.0)   # m
HOUSES, QUICK_HOUSES = 64, 9
RAYS, QUICK_RAYS = 1_000_000, 50_000
MESHES, QUICK_MESHES = 100_000, 2_000
MESH_RAYS = 100_000
BOUNCES = 3                              # of traces; the slow search goes to two
DELAY_LIMIT = 1e-12                      # s
LEVEL_LIMIT_DB, EDGE_LIMIT_DB = 0.01, 0.3   # of marked walls; of others, whose edges fade from 8 half zones on
MESHES_LIMIT = 0.3                       # s, of the first trace
NUM_ROWS, ENDLESS = 40_001, 40.0         # of the integral over a wall; m
AT_RIM = 1e-6                            # m: paths that pass a rim this near may be there or not


@dataclasses.dataclass(frozen=True)
class Wall:
    """A rectangle: corner [3] and edges [3] in m, at right angles."""

    corner: np.ndarray
    first: np.ndarray
    second: np.ndarray

    @property
    def normal(self) -> np.ndarray:
        """Unit vector."""
        across = np.cross(self.first, self.second)
        return across / np.linalg.norm(across)

    def height(self, point) -> float:
        """Distance in m from the plane, on the side of the normal."""
        return float(self.normal @ (point - self.corner))

    def image(self, point) -> np.ndarray:
        """The mirror image of a point."""
        return point - 2.0 * self.height(point) * self.normal

    def margin(self, point) -> float:
        """How far in m a point of the plane lies within the rectangle; negative outside."""
        parts = [np.dot(point - self.corner, edge) / np.linalg.norm(edge) for edge in (self.first, self.second)]
        sizes = [np.linalg.norm(edge) for edge in (self.first, self.second)]
        return min(min(part, size - part) for part, size in zip(parts, sizes))


def houses(count: int, seed: int = 5) -> list[list[Wall]]:
    """The ground, and the walls and the roof of each house."""
    draw = np.random.default_rng(seed)
    side = int(np.ceil(np.sqrt(count)))
    ground = Wall(np.array([-200.0, -200.0, 0.0]), np.array([400.0, 0.0, 0.0]), np.array([0.0, 400.0, 0.0]))
    city = [[ground]]
    for index in range(count):
        turn, length, width, high = draw.uniform((0.0, 8.0, 8.0, 6.0), (0.4, 11.0, 11.0, 12.0))
        middle = np.array([20.0 * (index % side - side // 2), 20.0 * (index // side - side // 2), 0.0])
        along = length * np.array([np.cos(turn), np.sin(turn), 0.0])
        across = width * np.array([-np.sin(turn), np.cos(turn), 0.0])
        up, corner = np.array([0.0, 0.0, high]), middle - 0.5 * along - 0.5 * across
        city.append([Wall(corner, along, up), Wall(corner + across, along, up), Wall(corner, across, up),
                     Wall(corner + along, across, up), Wall(corner + up, along, across)])
    return city


def scene_of(city: list[list[Wall]], *, mirror: bool) -> ep.Scene:
    """Each house a mesh of metal."""
    scene = ep.Scene()
    for index, walls in enumerate(city):
        vertices = np.concatenate([[wall.corner, wall.corner + wall.first, wall.corner + wall.first + wall.second,
                                    wall.corner + wall.second] for wall in walls])
        triangles = [[4 * k, 4 * k + i, 4 * k + i + 1] for k in range(len(walls)) for i in (1, 2)]
        scene.add(ep.Mesh(vertices, triangles), name=f"house_{index}" if index else "ground",
                  material=ep.Material.metal(mirror=mirror))
    return scene


def radar() -> ep.Radar:
    """One antenna each."""
    waveform = ep.ChirpSequence(start_frequency=FREQUENCY, bandwidth=1e8, num_samples=64, num_chirps=1)
    return ep.Radar(waveform, transmitters=[ep.Antenna(TRANSMITTER)], receivers=[ep.Antenna(RECEIVER)])


def slow_paths(walls: list[Wall]) -> np.ndarray:
    """Of all paths over one wall or two, by images over every sequence, in the order of their lengths, [P, 2]: the
    length in m and the field over that of endless walls."""
    transmitter, receiver = np.array(TRANSMITTER), np.array(RECEIVER)
    sequences = [(wall,) for wall in walls]
    sequences += [(one, two) for one in walls for two in walls if one is not two]
    paths = []
    for sequence in sequences:
        points = _points(sequence, transmitter, receiver)
        if points is not None and not _is_blocked(points, walls):
            legs = np.linalg.norm(np.diff(points, axis=0), axis=1)
            left = [_left_by_edges(wall, points[k:k + 2], legs[:k + 1].sum(), legs[k + 1:].sum(), walls)
                    for k, wall in enumerate(sequence)]
            paths.append((legs.sum(), abs(np.prod(left))))
    return np.array(sorted(paths)).reshape(-1, 2)


def _left_by_edges(wall: Wall, leg: np.ndarray, before: float, behind: float, walls: list[Wall]) -> complex:
    """The field that a rectangle sends, over that of an endless one: Kirchhoff's integral about the point where the leg ends,
    each row upward by the quadratic phase about its middle, in closed form. It has no edge where another wall stands before
    it, or at the ground."""
    point, direction = leg[1], (leg[1] - leg[0]) / np.linalg.norm(leg[1] - leg[0])
    across, up = (edge / np.linalg.norm(edge) for edge in (wall.first, wall.second))
    sizes = np.linalg.norm(wall.first), np.linalg.norm(wall.second)
    if min(sizes) > ENDLESS:
        return 1.0
    (left, right), (low, high) = (_ends(wall, point, axis, size, walls) for axis, size in zip((across, up), sizes))
    places, step = np.linspace(max(left, -ENDLESS), min(right, ENDLESS), NUM_ROWS, retstep=True)
    mirrored = direction - 2.0 * np.dot(direction, wall.normal) * wall.normal
    ways = [places[:, np.newaxis] * across - end for end in (-before * direction, behind * mirrored)]  # [rows, 3] each
    lengths = [np.linalg.norm(way, axis=1) for way in ways]
    slants = [way @ up / length for way, length in zip(ways, lengths)]
    wavenumber = 2.0 * np.pi * FREQUENCY / ep.speed_of_light
    slope, bend = sum(slants), sum((1.0 - slant**2) / length for slant, length in zip(slants, lengths))
    ends = np.sqrt(wavenumber * bend / np.pi) * (np.array([low, high])[:, np.newaxis] + slope / bend)
    rows = np.diff(_fresnel(ends), axis=0)[0] * np.sqrt(np.pi / (wavenumber * bend))
    rows = rows * np.exp(-1j * wavenumber * (sum(lengths) - before - behind - 0.5 * slope**2 / bend))
    rows *= np.where(np.isinf([left, right])[(places > 0).astype(int)], np.cos(0.5 * np.pi * places / ENDLESS) ** 2, 1.0)
    zone = ep.speed_of_light / FREQUENCY * before * behind / (before + behind) / abs(np.dot(direction, wall.normal))  # m^2
    return complex(step * (rows.sum() - 0.5 * (rows[0] + rows[-1])) / (-1j * zone))  # by trapezoids


def _ends(wall: Wall, point, axis, size: float, walls: list[Wall]) -> list[float]:
    """Where a wall ends before and behind a point along an axis, m from it; infinite where another one stands there."""
    begin, ends = np.dot(wall.corner - point, axis), []
    for end in (begin, begin + size):
        at = point + (1.0 - 1e-4) * end * axis
        goes_on = _is_blocked([point, at], walls) or at[2] < 1e-3
        ends.append(np.copysign(np.inf, end) if goes_on else end)
    return ends


def _fresnel(places: np.ndarray) -> np.ndarray:
    """Fresnel's integral C - jS to 2e-3: Abramowitz and Stegun 1964, 7.3.9, 7.3.10, 7.3.32 and 7.3.33."""
    far = np.minimum(np.abs(places), 1e6)
    f = (1.0 + 0.926 * far) / (2.0 + far * (1.792 + far * 3.104))
    g = 1.0 / (2.0 + far * (4.142 + far * (3.492 + far * 6.670)))
    return np.sign(places) * (0.5 - 0.5j + (1j * f - g) * np.exp(-0.5j * np.pi * far**2))


def _points(sequence, transmitter, receiver):
    images = [transmitter]
    for wall in sequence:
        images.append(wall.image(images[-1]))
    points = [receiver]
    for wall, image in zip(reversed(sequence), reversed(images)):
        before, behind = wall.height(points[0]), wall.height(image)
        if before * behind >= 0.0:
            return None
        point = points[0] + before / (before - behind) * (image - points[0])
        if wall.margin(point) < 0.0:
            return None
        points.insert(0, point)
    return np.array([transmitter, *points])


def _is_blocked(points, walls) -> bool:
    for begin, end in zip(points[:-1], points[1:]):
        for wall in walls:
            one, other = wall.height(begin), wall.height(end)
            if one * other < 0.0 and min(abs(one), abs(other)) > AT_RIM:
                if wall.margin(begin + one / (one - other) * (end - begin)) > 0.0:
                    return True
    return False


def image_paths(paths: ep.Paths, max_bounces: int):
    """(lengths in m, levels in dB over those of endless walls) of the image paths over at most so many walls, by length.
    Metal walls keep the level of the length."""
    own = (np.asarray(paths.stratum) == NO_STRATUM) & (np.asarray(paths.num_bounces) <= max_bounces)
    lengths = np.asarray(paths.lengths([paths.frame.trace_time], 0, 0))[0][own]
    wavelength = ep.speed_of_light / FREQUENCY
    expected = wavelength * np.sqrt(radar().transmit_power) / (4.0 * np.pi * lengths)
    order = np.argsort(lengths)
    return lengths[order], 20.0 * np.log10(np.abs(paths.amplitude[own]) / expected)[order]


def compare(found, truth) -> dict:
    """Paths of the truth that are missing, paths beside it, and the worst delay error in s of those that are there."""
    gaps = np.abs(np.subtract.outer(np.asarray(truth), np.asarray(found))) if len(found) and len(truth) else np.empty((0, 0))
    errors = gaps.min(axis=1) / ep.speed_of_light if gaps.size else np.empty(0)
    is_there = errors < DELAY_LIMIT
    return {"paths": len(truth), "missing": len(truth) - int(is_there.sum()), "beside": len(found) - int(is_there.sum()),
            "delay_error_s": float(errors[is_there].max()) if is_there.any() else 0.0}


def measure_city(*, mirror: bool, quick: bool) -> dict:
    """A city of houses whose walls are marked as mirrors, or nothing is."""
    city = houses(QUICK_HOUSES if quick else HOUSES)
    scene, rays = scene_of(city, mirror=mirror), 1000 if mirror else QUICK_RAYS if quick else RAYS
    seconds, paths = processor_time(lambda: ep.trace(scene, radar(), num_rays=rays, max_bounces=BOUNCES, polarization="scalar"))
    walls = [wall for house in city for wall in house]
    lengths, levels = image_paths(paths, 2)
    truth = slow_paths(walls)
    level_errors = levels if mirror or not len(truth) else levels - 20.0 * np.log10(truth[_nearest(lengths, truth[:, 0]), 1])
    bare = bare_share(scene, radar(), rays, 3) if not mirror else {"share": float("nan")}
    return {"name": "marked walls" if mirror else "unmarked walls", "walls": len(walls), "rays": rays, "seconds": seconds,
            "bare_share": bare["share"], **compare(lengths, truth[:, 0]),
            "level_error_db": float(np.abs(level_errors).max()) if len(level_errors) else 0.0}


def _nearest(places, others) -> np.ndarray:
    """Indices of the others that are nearest to each place."""
    return np.abs(np.subtract.outer(np.asarray(places), np.asarray(others))).argmin(axis=1)


def measure_meshes(*, quick: bool) -> dict:
    """Many plates, each a mesh of its own, and how the seconds grow from a tenth of them."""
    count = QUICK_MESHES if quick else MESHES
    seconds = {}
    for number in (count // 10, count):
        scene = _plates(number)
        seconds[number], _ = processor_time(lambda: ep.trace(scene, radar(), num_rays=MESH_RAYS, max_bounces=2))
    return {"name": "meshes", "meshes": count, "rays": MESH_RAYS, "seconds": seconds[count],
            "seconds_of_a_tenth": seconds[count // 10], "timed": True}


def _plates(count: int) -> ep.Scene:
    scene, metal = ep.Scene(), ep.Material.metal()
    mesh = ep.Mesh([[-0.5, -0.5, 0.0], [0.5, -0.5, 0.0], [0.5, 0.5, 0.0], [-0.5, 0.5, 0.0]], [[0, 1, 2], [0, 2, 3]])
    side = int(np.ceil(np.sqrt(count)))
    for index in range(count):
        scene.add(mesh, name=f"plate_{index}", material=metal, position=(3.0 * (index % side), 3.0 * (index // side), 0.0))
    return scene


def rows(*, quick: bool = False) -> list[dict]:
    """A row for each city and for many meshes: what was measured, with its error."""
    return [measure_city(mirror=False, quick=quick), measure_city(mirror=True, quick=quick), measure_meshes(quick=quick)]


def describe(rows: list[dict]) -> list[str]:
    """The rows in words."""
    lines = []
    for row in rows:
        if row["name"] == "meshes":
            lines.append(f"{row['meshes']} meshes, {row['rays']} rays: {row['seconds']:.2f} s of the processor, a tenth of the "
                         f"meshes {row['seconds_of_a_tenth']:.2f} s (limit {MESHES_LIMIT:g})  {_verdict(row)}")
            continue
        bare = "" if np.isnan(row["bare_share"]) else f", its queries alone {100.0 * row['bare_share']:.0f} % of the trace"
        lines.append(f"{row['name']}, {row['walls']}, {row['rays']} rays, {BOUNCES} bounces: {row['seconds']:.2f} s of the "
                     f"processor{bare}; {row['paths'] - row['missing']} of {row['paths']} paths over one or two walls, "
                     f"{row['beside']} beside them, delays to {row['delay_error_s']:.1e} s (limit {DELAY_LIMIT:g}), levels to "
                     f"{row['level_error_db']:.4f} dB (limit {_level_limit(row):g})  {_verdict(row)}")
    return lines


def _level_limit(row: dict) -> float:
    return LEVEL_LIMIT_DB if row["name"] == "marked walls" else EDGE_LIMIT_DB


def _verdict(row: dict) -> str:
    if row["name"] == "meshes":
        paces = row.get("paces")
        return verdict(row["seconds"], MESHES_LIMIT, paces) + told_at_reference(row["seconds"], paces)
    holds = (row["missing"] == 0 and row["beside"] == 0 and row["delay_error_s"] <= DELAY_LIMIT
             and row["level_error_db"] <= _level_limit(row))
    return "holds" if holds else "MISSED"
