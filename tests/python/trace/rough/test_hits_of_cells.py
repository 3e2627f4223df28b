"""Rays where cells of the map need hits: the clutter of a ground far away from a radar that drives, beside the radar equation."""
import numpy as np
import pytest

import echopath as ep
from support.shapes import lambert

HEIGHT, REFLECTIVITY, SEEDS = 0.6, 0.1, 4  # m, of power
WIDE = ep.GaussianBeam(azimuth=np.radians(100.0), elevation=np.radians(20.0))
CHIRPS = ep.ChirpSequence(start_frequency=77e9, bandwidth=300e6, num_samples=256, sampling_rate=10e6, num_chirps=128,
                          chirp_interval=4e-5)


def radar():
    def at(y):
        return ep.Antenna((0.0, y, HEIGHT), pattern=WIDE)

    return ep.Radar(CHIRPS, transmitters=[at(0.0)], receivers=[at(0.00195 * k) for k in range(4)], transmit_power=0.02,
                    motion=ep.LinearMotion(velocity=(12.0, 0.0, 0.0)))


def street():
    scene = ep.Scene()
    scene.add(ep.actors.ground(160.0), name="ground", material=lambert(REFLECTIVITY), position=(80.0, 0.0, 0.0))
    for k, place in enumerate(((20, 3), (30, -3), (45, 6))):
        scene.add(ep.actors.car(), name=f"car_{k}", position=(*place, 0))
    scene.add(ep.actors.pedestrian(speed=1.3), name="walker", position=(12, -3, 0))
    return scene


def power_of_ring(near, far):
    """W, of a Lambert ground between two ranges."""
    ranges, azimuth = np.linspace(near, far, 40), np.radians(np.linspace(-89.5, 89.5, 720))
    around = np.stack([np.cos(azimuth), np.sin(azimuth), np.full_like(azimuth, -HEIGHT / near)], axis=-1)
    gain = np.abs(WIDE.field(around / np.linalg.norm(around, axis=1)[:, None])) ** 2
    wavelength = ep.speed_of_light / CHIRPS.centre_frequency
    per_area = 0.02 * REFLECTIVITY / np.pi * (HEIGHT / ranges) ** 2 * (wavelength / (4.0 * np.pi)) ** 2 / ranges ** 4
    return np.trapezoid(per_area * ranges, ranges) * np.sum(gain ** 2) * (azimuth[1] - azimuth[0])


@pytest.fixture(scope="module")
def found():
    """[(ranges in m, powers in W) of the hits of the ground] of each seed."""
    hits = []
    for seed in range(SEEDS):
        paths = ep.trace(street(), radar(), num_rays=100_000, max_bounces=1, seed=seed).select("T 'ground' R")
        hits.append((paths.lengths([paths.frame.trace_time])[0] / 2.0, paths.power))
    return hits


def test_no_hit_far_away_stands_out_of_the_noise_where_the_ground_does_not(found):
    """A ring of the ground as wide as a cell of range sends less than the noise of a cell from 45 m on, and of eight seeds
    single hits sent 1.1 times that at most. They stood for whole rings, and sent 5 to 9 times that, while the rays of the field
    of view were a fiftieth of all."""
    assert power_of_ring(45.0, 45.0 + CHIRPS.range_resolution) < ep.noise_power(radar())
    for ranges, power in found:
        far = (ranges > 45.0) & (ranges < 80.0)
        assert far.sum() > 30
        assert power[far].max() < 2.0 * ep.noise_power(radar())


@pytest.mark.parametrize("near, far", [(10, 20), (20, 30), (30, 45)])
def test_the_ground_has_its_level_ring_by_ring(found, near, far):
    levels = [power[(ranges > near) & (ranges < far)].sum() for ranges, power in found]
    assert 10.0 * np.log10(np.mean(levels) / power_of_ring(near, far)) == pytest.approx(0.0, abs=0.5)
