"""Antennas and surfaces where they should not be."""
from __future__ import annotations

import numpy as np

import echopath as ep

from ...actors import shapes
from ..physics import closed_forms as exact
from ..physics.read_outs import field, rcs_of
from .case import Cases
from .scenes import (
    METAL,
    POWER,
    ROUGH,
    broadside_rcs,
    decibels,
    make_radar,
    plate_at,
    scene_of,
    traced,
    traced_quietly,
)

cases = Cases("Places")


def not_finite(paths) -> int:
    """Amplitudes, weights, lengths and samples that are no numbers."""
    arrays = [paths.amplitude, paths.weight, paths.lengths([paths.frame.trace_time]), ep.synthesize(paths, paths.radar)]
    return int(sum(np.sum(~np.isfinite(np.asarray(values))) for values in arrays))


@cases("radar inside a closed mesh", "every ray meets the wall, and the power is that of an integrating sphere", bound=0.05,
       unit="dB",
       broken="rays aimed at what is around the radar: NaN directions, which Embree refuses")
def inside_closed() -> float:
    radius, reflectivity = 3.0, 0.3
    scene = scene_of(("sphere", shapes.sphere(radius, subdivisions=40),
                      ep.Material(reflectivity=reflectivity, scattering=1.0)))
    radar = make_radar((0.0, 0.0, 0.0))
    paths = traced(scene, radar, 30_000, max_bounces=12)
    one_bounce = np.asarray(paths.num_bounces) == 1
    assert one_bounce.sum() == 30_000 and not_finite(paths) == 0
    # First bounce: rho lambda^2 / (4 pi^2 R^2) of an isotropic source at the centre.
    expected = POWER * exact.WAVELENGTH ** 2 * reflectivity / (4 * np.pi ** 2 * radius ** 2)
    return abs(decibels(float(np.sum(np.abs(paths.amplitude[one_bounce]) ** 2)) / expected))


@cases("radar inside metal", "it sees nothing of the world outside", bound=0.0, unit="paths",
       broken="surfaces of one side: 16 260 paths of ten times the rays")
def inside_metal() -> float:
    scene = scene_of(("shell", shapes.sphere(0.5), METAL), plate_at(10.0, 1.0))
    paths = traced(scene, make_radar(), 3_000)
    assert not_finite(paths) == 0
    return float(np.sum(np.asarray(paths.mesh_id) == 1))


@cases("radar exactly on a surface",
       "neither before nor behind it: all that meets it is dropped, and counted where it is aimed at (paths left)",
       bound=0.0, unit="paths",
       broken="contributions beside the antennas kept: 3847 rays")
def on_surface() -> float:
    paths = traced_quietly(scene_of(("bumper", shapes.plate(1.0, 1.0), ROUGH), plate_at(20.0)), make_radar(), 2 ** 15)
    assert not_finite(paths) == 0 and paths.frame.statistics.num_near_antenna > 0
    return float(paths.num_paths)


@cases("radar a hair off a surface", "contributions within 1 mm of an antenna are dropped and counted, all else is finite",
       bound=0.0,
       unit="values not finite",
       broken="contributions beside the antennas kept: none is counted as dropped")
def beside_surface() -> float:
    bad = 0
    for gap in (1e-9, 1e-6, 5e-4, 1e-3):
        paths = traced_quietly(scene_of(("bumper", shapes.plate(1.0, 1.0), ROUGH, {"position": (gap, 0.0, 0.0)}),
                                        plate_at(20.0)), make_radar(), 20_000)
        bad += not_finite(paths)
        assert gap > 4e-4 or paths.frame.statistics.num_near_antenna > 0
    return float(bad)


@cases("radar under the ground", "it sees the ground from below and nothing above it", bound=0.0, unit="paths",
       broken="surfaces of one side: 16 027 paths")
def under_ground() -> float:
    scene = scene_of(("ground", shapes.ground(400.0), ep.Material(permittivity=5 - 0.3j, mirror=True, scattering=0.3)),
                     ("plate", shapes.plate(1.0, 1.0), METAL, {"position": (10.0, 0.0, 1.0)}))
    paths = traced(scene, make_radar((0.0, 0.0, -0.5)), 30_000)
    assert paths.num_paths > 0 and not_finite(paths) == 0
    return float(np.sum(np.asarray(paths.mesh_id) == 1))


@cases("receiver behind a screen", "paths of a rough plate, in full view of the transmitter, that reach it through metal",
       bound=0.0, unit="paths",
       broken="no shadow rays: 5269 paths")
def behind_a_screen() -> float:
    screen = ("screen", shapes.plate(2.0, 2.0), METAL, {"position": (1.0, 3.0, 0.0)})
    paths = traced(scene_of(("plate", shapes.plate(1.0, 1.0), ROUGH, {"position": (10.0, 3.0, 0.0)}), screen),
                   make_radar(baseline=3.0), 20_000, max_bounces=1)
    assert paths.frame.statistics.num_hits > 1000
    return float(np.sum(np.asarray(paths.mesh_id)[paths.offsets] == 0))


def mirror_straight_at(placement: str) -> list[float]:
    """By how many dB the level over a flagged metal plane 5 m away, met exactly along its normal, is off its image's: scalar,
    with vectors."""
    plane = {"ahead": ("wall", shapes.plate(4.0, 4.0), {"position": (5.0, 0.0, 0.0)}),
             "above": ("ceiling", shapes.ground(4.0, z=5.0), {})}[placement]
    scene = scene_of((plane[0], plane[1], ep.Material.metal(mirror=True), plane[2]))
    image = np.sqrt(POWER) * exact.WAVELENGTH / (4 * np.pi * 10.0)
    made = [traced(scene, make_radar(), 100, max_bounces=1, polarization=model) for model in ("scalar", "jones")]
    return [abs(decibels(abs(np.sum(paths.amplitude) / image) ** 2)) for paths in made]


@cases("antenna on the normal of a hit",
       "incidence along the normal, to the last bit, has no plane of incidence: level of a mirror's image and of a plate in "
       "both polarisation models", bound=0.05, unit="dB",
       broken="no plane chosen where none is given: NaN")
def on_the_normal() -> float:
    levels = mirror_straight_at("ahead")
    for model in ("scalar", "jones"):
        paths = traced(scene_of(plate_at(200.0)), make_radar(), 2 ** 14, max_bounces=1, polarization=model)
        levels.append(abs(decibels(rcs_of(paths, 200.0) / broadside_rcs(0.1, 200.0))))
    return float(np.max(levels))  # NaN where one is


@cases("a wall straight aside", "a dielectric mirror, met within a degree of its normal with the field across or along the "
       "plane of incidence: scalar field beside that of vectors", bound=1e-3, unit="of the field",
       broken="Fresnel's TM coefficient with its own sign: 2")
def wall_aside() -> float:
    mirror, worst = ep.Material(permittivity=5 - 0.3j, mirror=True), 0.0
    wall = ("wall", shapes.plate(4.0, 4.0), mirror, {"position": (5.0, 0.0, 0.0)})
    for aside in ((0.0, 0.1, 0.0), (0.0, 0.0, 0.1), (0.0, 0.05, -0.05)):
        receivers = [ep.Antenna(aside)]
        radar = ep.Radar(make_radar().waveform, transmitters=[ep.Antenna()], receivers=receivers, transmit_power=POWER)
        scalar, vectors = (np.sum(traced(scene_of(wall), radar, 100, polarization=model).amplitude)
                           for model in ("scalar", "jones"))
        worst = max(worst, float(abs(scalar / vectors - 1.0)))
    return worst


@cases("antenna along its polarisation", "a mirror straight above an upright field, where neither horizontal nor "
       "vertical has a meaning and no pattern has a null: the level of its image in both polarisation models", bound=1e-6,
       unit="dB", broken="nothing received along the polarisation: infinite; no axis chosen where none is given: NaN")
def along_polarization() -> float:
    return float(np.max(mirror_straight_at("above")))


@cases("antenna in the plane of a plate", "seen edge-on, in any attitude, or by 1 mm in 5 m beside that, it returns nothing",
       bound=0.0, unit="sqrt(W)",
       broken="grazing hits kept: 1.2e-10")
def in_the_plane() -> float:
    random, worst = np.random.default_rng(4), 0.0
    for material, beside in ((METAL, 0.0), (ROUGH, 0.0), (METAL, 1e-3), (ROUGH, 1e-3)):
        for _ in range(5):
            placement = np.eye(4)
            placement[:3, :3] = np.linalg.qr(random.normal(size=(3, 3)))[0]
            placement[:3, 3] = placement[:3, :3] @ [beside, 5.0, 0.0]  # shapes.plate lies across its x axis
            scene = scene_of(("plate", shapes.plate(1.0, 1.0), material, {"transform": placement}))
            paths = traced(scene, make_radar(), 5000)
            worst = max(worst, float(np.abs(paths.amplitude).max(initial=0.0)))
    return worst


def bistatic_field(side: float, distance: float, baseline: float) -> float:
    """Physical optics of a square plate at `distance` m, broadside to the transmitter, at a receiver `baseline` m aside."""
    nodes, weights = np.polynomial.legendre.leggauss(32)
    y, w = 0.5 * side * nodes[:, None], 0.25 * side ** 2 * weights[:, None] * weights[None, :]
    z = 0.5 * side * nodes[None, :]
    out, back = np.sqrt(distance ** 2 + y ** 2 + z ** 2), np.sqrt(distance ** 2 + (y - baseline) ** 2 + z ** 2)
    phase = exact.WAVENUMBER * ((out - distance) + (back - np.hypot(distance, baseline)))
    return np.sqrt(POWER) / (4 * np.pi) * abs(np.sum(w * (distance / out) * np.exp(-1j * phase) / (out * back)))


@cases("antennas 1 mm apart and far apart", "physical optics of a small plate at a receiver 0 to 1 km aside", bound=0.1,
       unit="dB",
       broken="spreading to the transmitter instead of the receiver: 34 dB")
def baselines() -> float:
    worst = 0.0
    for baseline in (0.0, 1e-12, 1e-3, 1.0, 1e3):
        paths = traced(scene_of(plate_at(20.0, 3e-3)), make_radar(baseline=baseline), 2 ** 13, max_bounces=1)
        worst = max(worst, abs(decibels((abs(np.sum(field(paths))) / bistatic_field(3e-3, 20.0, baseline)) ** 2)))
    return worst


@cases("a null of a plate", "depth below broadside with 2^16 rays of a Fibonacci set, first order or no filter (as many "
       "random rays leave 48 dB)", bound=60.0, unit="dB", at_least=True,
       broken="lengths in single precision: 58 dB")
def plate_null() -> float:
    angle = np.arcsin(exact.WAVELENGTH / 0.2)  # of the first null
    scene, depths = scene_of(("plate", shapes.plate(0.1, 0.1), METAL)), []
    for footprint in ("first_order", "none"):
        levels = [ep.rcs(scene, frequency=exact.FREQUENCY, incidence=(-np.cos(turn), np.sin(turn), 0.0), num_rays=2 ** 16,
                         footprint=footprint, sampler="fibonacci", max_bounces=1) for turn in (0.0, angle)]
        depths.append(decibels(levels[0] / levels[1]))
    return min(depths)


@cases("a null of the default method", "depth below broadside with 2^16 rays of the lattice (as many random rays leave 48 "
       "dB)",
       bound=60.0, unit="dB", at_least=True,
       broken="lengths in single precision: 59.4 dB")
def default_null() -> float:
    angle, scene = np.arcsin(exact.WAVELENGTH / 0.2), scene_of(("plate", shapes.plate(0.1, 0.1), METAL))
    levels = [ep.rcs(scene, frequency=exact.FREQUENCY, incidence=(-np.cos(turn), np.sin(turn), 0.0), num_rays=2 ** 16,
                     max_bounces=1)
              for turn in (0.0, angle)]
    return decibels(levels[0] / levels[1])


def over_ground(distance: float, height: float, antenna_height: float, side: float) -> complex:
    """The four ways between an antenna and an upright plate over metal ground, summed over its height: re the direct one."""
    z = height + side * ((np.arange(64) + 0.5) / 64 - 0.5)
    lengths = [np.hypot(distance, z - antenna_height), np.hypot(distance, z + antenna_height)]
    direct, image = (np.exp(-1j * exact.WAVENUMBER * length) / length for length in lengths)
    return np.mean((direct - image) ** 2) / np.mean(direct ** 2)


@cases("a null of four ways over the ground", "a plate of 1 mm where two lengths differ by a wavelength, 20 m ahead over a "
       "metal mirror: its echo, 65 dB down, beside the sum over its height, to 1e-4 of each way's field, which has a lattice "
       "of its own",
       bound=1.5, unit="dB",
       broken="the pair over both images left out: 65 dB")
def ground_null() -> float:
    distance, antenna, side = 20.0, 0.5, 1e-3
    height = 0.5 * exact.WAVELENGTH * np.sqrt(1.0 + distance ** 2 / (antenna ** 2 - 0.25 * exact.WAVELENGTH ** 2))
    plate = ("plate", shapes.plate(side, side), METAL, {"position": (distance, 0.0, float(height))})
    mirror = ("ground", shapes.ground(100.0), ep.Material.metal(mirror=True))
    alone, above = (abs(np.sum(field(traced(scene_of(*objects), make_radar((0.0, 0.0, antenna)), 2 ** 18,
                                            polarization="scalar")
                                     .select("T .* 'plate' .* R")))) for objects in ((plate,), (plate, mirror)))
    return abs(decibels((above / alone) ** 2 / abs(over_ground(distance, height, antenna, side)) ** 2))


def corner_of(floor, wall, angle: float) -> ep.Scene:
    """A floor and a wall of 0.1 m that meet at a right angle 200 m ahead, seen `angle` rad above the floor."""
    up, along = np.array([-np.sin(angle), 0.0, np.cos(angle)]), np.array([-np.cos(angle), 0.0, -np.sin(angle)])
    corner, side = np.array([200.0, -0.05, 0.0]), np.array([0.0, 0.1, 0.0])
    sheets = [ep.Mesh([corner, corner + 0.1 * edge, corner + 0.1 * edge + side, corner + side], [[0, 1, 2], [0, 2, 3]])
              for edge in (along, up)]
    return scene_of(("floor", sheets[0], floor), ("wall", sheets[1], wall))


@cases("a corner of earth and metal",
       "both orders of the double bounce add up in the scalar model as they do with field vectors",
       bound=0.1, unit="dB",
       broken="the sign of the last bounce alone: 42 dB")
def mixed_corner() -> float:
    earth, worst = ep.Material(permittivity=4 - 0.2j), 0.0
    for angle in np.radians([20.0, 45.0, 60.0]):
        for wall in (METAL, earth):
            levels = [rcs_of(traced(corner_of(earth, wall, angle), make_radar(), 2 ** 14, max_bounces=2,
                                    polarization=model), 200.0)
                      for model in ("scalar", "jones")]
            worst = max(worst, abs(decibels(levels[0] / levels[1])))
    return worst


@cases("an empty scene", "no paths, zeros exactly, noise alone where it is asked for", bound=0.0, unit="sqrt(W)",
       broken="a sum that begins at 1e-20 instead of 0: 1e-20")
def empty_scene() -> float:
    frame = ep.simulate(ep.Scene(), make_radar(num_chirps=4), num_rays=1000, noise_seed=None)
    return float(max(np.abs(frame.cube).max(), np.abs(frame.spectrum.values).max(), frame.paths.num_paths))
