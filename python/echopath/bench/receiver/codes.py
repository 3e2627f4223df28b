"""Codes of transmitters that send at once beside turns: the signal of a street at rest, and velocities beyond a share."""
from __future__ import annotations

import numpy as np

import echopath as ep

from ..suite import describe_judged, judged
from . import street

LIMITS = {"ddm against turns, street": 1e-9, "bpm against turns, street": 1e-9, "ddm velocity, worst of 25, m/s": 0.26,
          "ddm azimuth, worst of 25, rad": 0.02}


def rows(*, quick: bool) -> list[dict]:
    """Errors of each code, relative to the largest sample, and of a ball that moves at 25 speeds."""
    num_rays = street.QUICK_NUM_RAYS if quick else street.NUM_RAYS
    paths = street.at_rest(street.paths(num_rays))
    turns, found = ep.synthesize(paths), {}
    for kind in ("ddm", "bpm"):
        radar = street.radar(multiplexing=kind)
        apart = ep.demultiplex(ep.synthesize(paths, radar), radar)
        found[f"{kind} against turns, street"] = float(np.max(np.abs(apart - turns)) / np.max(np.abs(turns)))
    speed, azimuth = _of_balls(5 if quick else 25)
    return judged(found | {"ddm velocity, worst of 25, m/s": speed, "ddm azimuth, worst of 25, rad": azimuth}, LIMITS)


def describe(rows: list[dict]) -> list[str]:
    """Lines for people."""
    return describe_judged(rows, "codes")


def _of_balls(count: int) -> tuple[float, float]:
    """Worst errors of velocity in m/s and azimuth in rad, over all velocities that are unambiguous."""
    radar, errors = street.radar(multiplexing="ddm"), []
    radar = radar.replace(waveform=radar.waveform.replace(num_chirps=64, chirp_interval=60e-6))
    for speed in np.linspace(-15.5, 15.5, count):
        out = np.array([np.cos(0.2), np.sin(0.2), 0.0])
        scene = ep.Scene()
        scene.add(ep.actors.sphere(0.1), name="ball", material=ep.Material.metal(), smooth=True,
                  position=(*(12.0 * out[:2]), 0.7), motion=ep.LinearMotion(velocity=tuple(speed * out)))
        cube = ep.synthesize(ep.trace(scene, radar, num_rays=1000, max_bounces=1), radar)
        spectrum = ep.range_doppler(ep.demultiplex(ep.add_noise(cube, radar, seed=1), radar), radar)
        power = np.mean(np.abs(spectrum.values) ** 2, axis=(0, 1))
        cell = np.unravel_index(power.argmax(), power.shape)
        found = ep.estimate_angles(spectrum, radar, cells=[cell])
        errors.append((abs(spectrum.velocity[cell[0]] - speed), abs(found.azimuth[0] - 0.2)))
    return tuple(float(worst) for worst in np.max(errors, axis=0))
