"""The targets of the benchmark: scene, closed form and what to read off the paths."""
from __future__ import annotations

import dataclasses
from collections.abc import Callable

import numpy as np

import echopath as ep

from ...actors import shapes
from . import closed_forms as exact
from .read_outs import field, rcs_of, rcs_of_power

CAR = (2.2, 0.9, 0.7)            # m, semi-axes of the ellipsoid
CAR_EDGE = 0.052                 # m
ELEVATION, AZIMUTH = 3.0, 15.0   # deg, from the ellipsoid to the radar
UPRIGHT, LEVEL = (0.0, 0.0, 1.0), (0.0, 1.0, 0.0)  # polarisations; on a metal ground the reflection is +1 and -1
GENERIC_TURN = (0.3, 0.5, 0.7)   # rad: no axis of the mesh looks at the radar


@dataclasses.dataclass
class Target:
    """One target.

    name: short; title: for people; scene, truth: expected value [m^2, or ratio of powers]
    value: callable (paths) -> the same from paths; max_bounces: of the trace
    compares_footprints: whether the footprint acts on it; polarization: [3] of the antennas
    """

    name: str
    title: str
    scene: ep.Scene
    truth: float
    value: Callable
    max_bounces: int = 1
    compares_footprints: bool = True
    polarization: tuple = UPRIGHT


def radar(polarization: tuple = UPRIGHT) -> ep.Radar:
    """Isotropic antennas at the origin; one chirp."""
    waveform = ep.ChirpSequence(start_frequency=exact.FREQUENCY, bandwidth=1e9, num_samples=512, sampling_rate=20e6,
                                num_chirps=1, chirp_interval=30e-6)
    antenna = ep.Antenna(polarization=polarization)
    return ep.Radar(waveform, transmitters=[antenna], receivers=[antenna])


def all_targets() -> list[Target]:
    return [*_spheres(), _ellipsoid(), *map(plate, (0.0, 5.0, 20.3)), _dihedral(), _trihedral(), lambert_plate(),
            _two_ray(),
            _wall_ghost()]


def _spheres():
    small, large = np.pi * 0.1 ** 2, np.pi * 2.0 ** 2
    yield _in_far_field("sphere_161", "sphere, ka 161", shapes.sphere(0.1, subdivisions=32), 2e3, small, smooth=True)
    yield _in_far_field("sphere_161_facets", "sphere, ka 161, facets", shapes.sphere(0.1, subdivisions=64), 2e3, small)
    yield _in_far_field("sphere_3228", "sphere, ka 3228", shapes.sphere(2.0, subdivisions=64), 4e4, large, smooth=True)


def _ellipsoid():
    elevation, azimuth = np.radians([ELEVATION, AZIMUTH])
    return ellipsoid_seen_along(np.array([np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth),
                                          np.sin(elevation)]))


def ellipsoid_seen_along(to_radar, edge: float = CAR_EDGE) -> Target:
    """A smooth metal ellipsoid of a car's size, 40 km away; to_radar: unit, in its own axes; edge: of its triangles, m."""
    mesh = shapes.ellipsoid(CAR, edge=edge)
    return _in_far_field("ellipsoid", "ellipsoid of a car's size", mesh, 4e4, exact.ellipsoid_rcs(CAR, to_radar),
                         smooth=True, to_radar=to_radar)


def plate(angle_deg: float) -> Target:
    """A metal plate of 0.1 m turned by `angle_deg` about an edge."""
    angle = np.radians(angle_deg)
    turned = np.array([-np.cos(angle), np.sin(angle), 0.0])
    return _in_far_field(f"plate_{angle_deg:g}", f"plate 0.1 m, {angle_deg:g} deg", shapes.plate(0.1, 0.1), 2e3,
                         exact.plate_rcs(0.1, angle), to_radar=turned)


def _dihedral():
    return _in_far_field("dihedral", "dihedral 0.1 m, double bounce", shapes.dihedral(0.1), 2e3,
                         exact.dihedral_rcs(0.1), to_radar=(-1.0, 0.0, 0.0), bounces=2)


def _trihedral():
    return _in_far_field("trihedral", "trihedral 0.1 m, triple bounce", shapes.trihedral(0.1), 2e3,
                         exact.trihedral_rcs(0.1), to_radar=(-1.0, 0.0, 0.0), bounces=3)


def lambert_plate() -> Target:
    """A diffuse plate of 1 m at 20 m."""
    distance, reflectivity = 20.0, 0.3
    scene = ep.Scene()
    scene.add(shapes.plate(1.0, 1.0), name="plate", material=_lambert(reflectivity), position=(distance, 0.0, 0.0))
    truth = exact.lambert_plate_rcs(1.0, reflectivity, distance)
    return Target("lambert_plate", "Lambert plate 1 m, mean", scene, truth,
                  lambda paths: rcs_of_power(paths, np.sum(np.abs(paths.amplitude) ** 2), distance), compares_footprints=False)


def _two_ray():
    height, distance = 0.5, 50.0
    ground = shapes.ground((200.0, 50.0), z=-height)
    return _beside_mirror("two_ray", "two-ray ground, all four paths", ground, distance,
                          image=(0.0, 0.0, -2.0 * height), wanted="all", polarization=LEVEL)


def _wall_ghost():
    offset, distance = 3.0, 20.0
    wall = shapes.wall(80.0, 20.0)
    return _beside_mirror("wall_ghost", "wall ghosts, pair over direct", wall, distance, image=(0.0, 2.0 * offset, 0.0),
                          wanted="pair", position=(0.0, offset, -10.0))


def _beside_mirror(name, title, mirror, distance, *, image, wanted, position=(0.0, 0.0, 0.0), polarization=UPRIGHT):
    """A Lambert patch of 2 mm that faces the radar, and a metal mirror along the polarisation; value over that of the direct
    path."""
    scene = ep.Scene()
    scene.add(shapes.plate(0.002, 0.002), name="patch", material=_lambert(1.0), position=(distance, 0.0, 0.0))
    scene.add(mirror, name="mirror", material=ep.Material.metal(mirror=True), position=position)
    direct, over = exact.image_field(np.zeros(3), np.array([distance, 0.0, 0.0]), np.array([-1.0, 0.0, 0.0]), image)
    field = (direct + over) ** 2 if wanted == "all" else 2.0 * direct * over
    return Target(name, title, scene, abs(field) ** 2 / abs(direct) ** 4, lambda paths: _over_direct(paths, wanted),
                  max_bounces=3, compares_footprints=False, polarization=polarization)


def _over_direct(paths, wanted: str) -> float:
    """Power of the wanted family over that of direct paths; fields add at each hit of the patch, powers over hits."""
    count = np.asarray(paths.num_bounces)
    first = paths.mesh_id[paths.offsets] == 0  # the patch is met before the mirror
    on_patch = np.where(first, paths.offsets, paths.offsets + 1)
    diffuse = np.asarray(paths.diffuse) != 0
    on_patch = np.where(diffuse, on_patch, paths.offsets)
    place = paths.u[on_patch] + 1j * paths.v[on_patch] + 2.0 * paths.triangle_id[on_patch]
    _, hit = np.unique(place, return_inverse=True)
    fields = field(paths)
    families = {"direct": diffuse & (count == 1), "pair": diffuse & (count == 2), "all": diffuse}

    def power(keep):
        sums = np.zeros(len(place), complex)
        np.add.at(sums, hit[keep], fields[keep])
        return float(np.sum(np.abs(sums) ** 2))

    return power(families[wanted]) / max(power(families["direct"]), 1e-300)


def _in_far_field(name, title, mesh, distance, truth, *, smooth=False, to_radar=None, bounces=1):
    """A metal target about (distance, 0, 0); to_radar: direction to the radar in the target's own axes."""
    scene = ep.Scene()
    toward = np.array([-1.0, 0.0, 0.0])
    turn = _turn(GENERIC_TURN) if to_radar is None else _turn_onto(np.asarray(to_radar, float), toward)
    placement = np.eye(4)
    placement[:3, :3] = turn
    placement[0, 3] = distance
    scene.add(mesh, name="target", material=ep.Material.metal(), transform=placement, smooth=smooth)

    def value(paths):
        return rcs_of(paths, distance, np.asarray(paths.num_bounces) == bounces)

    return Target(name, title, scene, truth, value, max_bounces=bounces)


def _lambert(reflectivity: float) -> ep.Material:
    return ep.Material(reflectivity=reflectivity, scattering=1.0)


def _turn(angles):
    (a, b, c) = angles
    z = np.array([[np.cos(a), -np.sin(a), 0], [np.sin(a), np.cos(a), 0], [0, 0, 1]])
    y = np.array([[np.cos(b), 0, np.sin(b)], [0, 1, 0], [-np.sin(b), 0, np.cos(b)]])
    x = np.array([[1, 0, 0], [0, np.cos(c), -np.sin(c)], [0, np.sin(c), np.cos(c)]])
    return z @ y @ x


def _turn_onto(start, end):
    """Rotation that takes one unit vector onto another; they are not opposite to each other unless along x."""
    cross, cos = np.cross(start, end), float(start @ end)
    if cos < -1.0 + 1e-12:
        return np.diag([-1.0, -1.0, 1.0])
    skew = np.array([[0, -cross[2], cross[1]], [cross[2], 0, -cross[0]], [-cross[1], cross[0], 0]])
    return np.eye(3) + skew + skew @ skew / (1.0 + cos)
