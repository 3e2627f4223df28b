"""Antennas where they should not be, and materials at the ends of their ranges."""
from __future__ import annotations

import numpy as np

import echopath as ep

from ...actors import shapes
from .. import closed_forms as exact
from .case import Cases
from .scenes import (METAL, POWER, ROUGH, broadside_rcs, decibels, make_radar, plate_at, rcs_of, scene_of, traced,
                     traced_quietly)

cases = Cases("Places and materials")


def not_finite(paths) -> int:
    """Amplitudes, weights, lengths and samples that are no numbers."""
    arrays = [paths.amplitude, paths.weight, paths.lengths([paths.frame.trace_time]), ep.synthesize(paths, paths.radar)]
    return int(sum(np.sum(~np.isfinite(np.asarray(values))) for values in arrays))


@cases("radar inside a closed mesh", "every ray meets the wall, and the power is that of an integrating sphere", bound=0.05,
       unit="dB")
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


@cases("radar inside metal", "it sees nothing of the world outside", bound=0.0, unit="paths")
def inside_metal() -> float:
    scene = scene_of(("shell", shapes.sphere(0.5), METAL), plate_at(10.0, 1.0))
    paths = traced(scene, make_radar(), 30_000)
    assert not_finite(paths) == 0
    return float(np.sum(np.asarray(paths.mesh_id) == 1))


@cases("radar exactly on a surface",
       "neither before nor behind it: all that meets it is dropped and counted (rays not accounted for)",
       bound=0.0, unit="rays")
def on_surface() -> float:
    paths = traced_quietly(scene_of(("bumper", shapes.plate(1.0, 1.0), ROUGH), plate_at(20.0)), make_radar(), 2 ** 15)
    counts = paths.frame.statistics
    assert not_finite(paths) == 0
    return float(counts.num_rays - counts.num_false_hits - counts.num_near_antenna - counts.num_grazing)


@cases("radar a hair off a surface", "contributions within 1 mm of an antenna are dropped and counted, all else is finite",
       bound=0.0,
       unit="values not finite")
def beside_surface() -> float:
    bad = 0
    for gap in (1e-9, 1e-6, 5e-4, 1e-3):
        paths = traced_quietly(scene_of(("bumper", shapes.plate(1.0, 1.0), ROUGH, {"position": (gap, 0.0, 0.0)}),
                                        plate_at(20.0)), make_radar(), 20_000)
        bad += not_finite(paths)
        assert gap > 4e-4 or paths.frame.statistics.num_near_antenna > 0
    return float(bad)


@cases("radar under the ground", "it sees the ground from below and nothing above it", bound=0.0, unit="paths")
def under_ground() -> float:
    scene = scene_of(("ground", shapes.ground(400.0), ep.Material(permittivity=5 - 0.3j, mirror=True, scattering=0.3)),
                     ("plate", shapes.plate(1.0, 1.0), METAL, {"position": (10.0, 0.0, 1.0)}))
    paths = traced(scene, make_radar((0.0, 0.0, -0.5)), 30_000)
    assert paths.num_paths > 0 and not_finite(paths) == 0
    return float(np.sum(np.asarray(paths.mesh_id) == 1))


@cases("receiver behind a screen", "paths of a rough plate, in full view of the transmitter, that reach it through metal",
       bound=0.0, unit="paths")
def behind_a_screen() -> float:
    screen = ("screen", shapes.plate(2.0, 2.0), METAL, {"position": (1.0, 3.0, 0.0)})
    paths = traced(scene_of(("plate", shapes.plate(1.0, 1.0), ROUGH, {"position": (10.0, 3.0, 0.0)}), screen),
                   make_radar(baseline=3.0), 20_000, max_bounces=1)
    assert paths.frame.statistics.num_hits > 1000
    return float(np.sum(np.asarray(paths.mesh_id)[paths.offsets] == 0))


@cases("antenna on the normal of a hit",
       "incidence along the normal has no plane of incidence: level in both polarisation models",
       bound=0.05, unit="dB")
def on_the_normal() -> float:
    levels = []
    for model in ("scalar", "jones"):
        paths = traced(scene_of(plate_at(200.0)), make_radar(), 2 ** 14, max_bounces=1, polarization=model)
        assert not_finite(paths) == 0
        levels.append(abs(decibels(rcs_of(paths, 200.0) / broadside_rcs(0.1, 200.0))))
    return max(levels)


@cases("antenna along its polarisation", "a dipole-less direction: a plate above an upright field stays finite", bound=0.0,
       unit="values not finite")
def along_polarization() -> float:
    scene = scene_of(("above", shapes.ground(1.0, z=5.0), METAL), ("below", shapes.ground(1.0, z=-5.0), ROUGH))
    return float(sum(not_finite(traced(scene, make_radar(), 20_000, polarization=model)) for model in ("scalar", "jones")))


@cases("antenna in the plane of a plate", "seen edge-on it returns nothing", bound=0.0, unit="sqrt(W)")
def in_the_plane() -> float:
    scene = scene_of(("metal", shapes.ground(1.0), METAL, {"position": (5.0, 0.0, 0.0)}),
                     ("rough", shapes.ground(1.0), ROUGH, {"position": (-5.0, 0.0, 0.0)}))
    paths = traced(scene, make_radar(), 30_000)
    amplitude = np.abs(np.asarray(paths.amplitude))
    return float(amplitude.max()) if len(amplitude) else 0.0


@cases("antennas 1 mm apart and far apart", "amplitudes stay finite from a baseline of 0 to one of 1 km", bound=0.0,
       unit="values not finite")
def baselines() -> float:
    scene = scene_of(plate_at(20.0, 1.0), ("ground", shapes.ground(200.0, z=-1.0), ROUGH))
    return float(sum(not_finite(traced(scene, make_radar(baseline=baseline), 10_000))
                     for baseline in (0.0, 1e-12, 1e-3, 1e3)))


@cases("a null of a plate", "depth below broadside with 2^16 rays of a Fibonacci set, first order or no filter", bound=60.0,
       unit="dB", at_least=True)
def plate_null() -> float:
    angle = np.arcsin(exact.WAVELENGTH / 0.2)  # of the first null
    scene, depths = scene_of(("plate", shapes.plate(0.1, 0.1), METAL)), []
    for footprint in ("first_order", "none"):
        levels = [ep.rcs(scene, frequency=exact.FREQUENCY, incidence=(-np.cos(turn), np.sin(turn), 0.0), num_rays=2 ** 16,
                         footprint=footprint, sampler="fibonacci", max_bounces=1) for turn in (0.0, angle)]
        depths.append(decibels(levels[0] / levels[1]))
    return min(depths)


@cases("a null of the default method", "depth below broadside with 2^16 rays of the lattice", bound=40.0, unit="dB",
       at_least=True)
def default_null() -> float:
    angle, scene = np.arcsin(exact.WAVELENGTH / 0.2), scene_of(("plate", shapes.plate(0.1, 0.1), METAL))
    levels = [ep.rcs(scene, frequency=exact.FREQUENCY, incidence=(-np.cos(turn), np.sin(turn), 0.0), num_rays=2 ** 16,
                     max_bounces=1)
              for turn in (0.0, angle)]
    return decibels(levels[0] / levels[1])


def reflectivity_of(material) -> float:
    """Power reflectivity at normal incidence: the echo of a plate over that of metal."""
    levels = [rcs_of(traced(scene_of(("plate", shapes.plate(0.1, 0.1), one, {"position": (200.0, 0.0, 0.0)})), make_radar(),
                            4096,
                            max_bounces=1), 200.0) for one in (material, METAL)]
    return levels[0] / levels[1]


def fresnel_power(permittivity: complex) -> float:
    root = np.sqrt(np.complex128(permittivity))
    return abs((1 - root) / (1 + root)) ** 2


@cases("permittivities from 1e-9 to 1e18",
       "huge, tiny, lossless, negative: power reflectivity beside Fresnel's at normal incidence",
       bound=1e-3, unit="of full reflection")
def permittivities() -> float:
    values = (1e18 - 1e18j, 1e18, 1e-9, 1e-9 - 1e-12j, 4 - 1e-15j, 4.0, 4 - 4e9j, -4 - 0.1j, -4 - 1e-12j, 2.0)
    return max(abs(reflectivity_of(ep.Material(permittivity=value)) - fresnel_power(value)) for value in values)


@cases("permittivity 1", "what is like air does not reflect", bound=1e-20, unit="of metal")
def like_air() -> float:
    return reflectivity_of(ep.Material(permittivity=1.0))


@cases("a dielectric sphere", "both polarisations meet at its middle: level of pi a^2 times Fresnel's reflectivity",
       bound=0.1, unit="dB")
def dielectric_sphere() -> float:
    ball = ("ball", shapes.sphere(0.3, subdivisions=40), ep.Material(permittivity=4 - 0.2j),
            {"position": (200.0, 0.0, 0.0), "smooth": True})
    truth = np.pi * 0.3 ** 2 * fresnel_power(4 - 0.2j)
    return max(abs(decibels(rcs_of(traced(scene_of(ball), make_radar(), 2 ** 14, max_bounces=1, polarization=model),
                                   200.0) / truth))
               for model in ("scalar", "jones"))


def corner_of(floor, wall, angle: float) -> ep.Scene:
    """A floor and a wall of 0.1 m that meet at a right angle 200 m ahead, seen `angle` rad above the floor."""
    up, along = np.array([-np.sin(angle), 0.0, np.cos(angle)]), np.array([-np.cos(angle), 0.0, -np.sin(angle)])
    corner, side = np.array([200.0, -0.05, 0.0]), np.array([0.0, 0.1, 0.0])
    sheets = [ep.Mesh([corner, corner + 0.1 * edge, corner + 0.1 * edge + side, corner + side], [[0, 1, 2], [0, 2, 3]])
              for edge in (along, up)]
    return scene_of(("floor", sheets[0], floor), ("wall", sheets[1], wall))


@cases("a corner of earth and metal",
       "both orders of the double bounce add up in the scalar model as they do with field vectors",
       bound=0.1, unit="dB")
def mixed_corner() -> float:
    earth, worst = ep.Material(permittivity=4 - 0.2j), 0.0
    for angle in np.radians([20.0, 45.0, 60.0]):
        for wall in (METAL, earth):
            levels = [rcs_of(traced(corner_of(earth, wall, angle), make_radar(), 2 ** 14, max_bounces=2,
                                    polarization=model), 200.0)
                      for model in ("scalar", "jones")]
            worst = max(worst, abs(decibels(levels[0] / levels[1])))
    return worst


@cases("bad materials", "permittivity 0, NaN, of gain; scattering above 1: refused by name", bound=0.0, unit="accepted")
def bad_materials() -> float:
    wrong = [("permittivity", dict(permittivity=0.0)), ("permittivity", dict(permittivity=complex(np.nan, 0))),
             ("permittivity", dict(permittivity=4 + 1j)), ("permittivity", dict(permittivity=np.inf)),
             ("scattering", dict(reflectivity=0.5, scattering=1.0001)), ("reflectivity", dict(reflectivity=1.0 + 1e-9)),
             ("roughness_height", dict(reflectivity=0.5, roughness_height=-1e-9)),
             ("conductivity", dict(permittivity=4.0, conductivity=np.nan))]
    accepted = 0
    for name, keywords in wrong:
        try:
            ep.Material(**keywords)
            accepted += 1
        except ValueError as error:
            accepted += name not in str(error)
    return float(accepted)


@cases("an empty scene", "no paths, zeros exactly, noise alone where it is asked for", bound=0.0, unit="sqrt(W)")
def empty_scene() -> float:
    frame = ep.simulate(ep.Scene(), make_radar(num_chirps=4), num_rays=1000, noise_seed=None)
    return float(max(np.abs(frame.cube).max(), np.abs(frame.spectrum.values).max(), frame.paths.num_paths))
