"""A rough patch behind an unflagged wall: each order of both has the share of the angle at which the wave comes to the patch."""
import numpy as np
import pytest

import echopath as ep

FREQUENCY, HEIGHT = 24e9, 0.6e-3
WALL = ep.Mesh([(7, -9, -5), (7, 9, -5), (7, 9, 9), (7, -9, 9)], [(0, 3, 2), (0, 2, 1)])
ORDERS = "T D'patch' 'wall' R", "T 'wall' D'patch' R"
STRAIGHT, OVER_WALL = 1.0 / np.hypot(5.0, 1.0), 1.0 / np.hypot(9.0, 1.0)  # cosines, of the transmitter and of its image at x = 14


def both_orders(polarization, receiver):
    scene = ep.Scene()
    scene.add(ep.actors.ground((0.1, 0.1)), name="patch", material=ep.Material(conductor=True, roughness_height=HEIGHT),
              position=(5, 0, -1))
    scene.add(WALL, name="wall", material="metal")
    radar = ep.Radar(ep.ChirpSequence(start_frequency=FREQUENCY, bandwidth=1e8, num_samples=16, num_chirps=2),
                     transmitters=[ep.Antenna((0, 0, 0))], receivers=[ep.Antenna(receiver)])
    paths = ep.trace(scene, radar, num_rays=100_000, polarization=polarization)
    return [paths.select(order) for order in ORDERS]


def scattered(cosine: float) -> float:
    """S^2 by Ament's factor."""
    return 1.0 - np.exp(-(4.0 * np.pi * FREQUENCY / ep.speed_of_light * HEIGHT * cosine) ** 2)


@pytest.mark.parametrize("polarization", ["scalar", "jones"])
def test_a_way_back_over_a_wall_has_the_roughness_of_its_own_angle(polarization):
    first, last = (ep.received_power(paths).power for paths in both_orders(polarization, (0, 0, 0)))
    assert first / last == pytest.approx(scattered(STRAIGHT) / scattered(OVER_WALL), rel=0.02)


@pytest.mark.parametrize("polarization", ["scalar", "jones"])
def test_the_wave_comes_from_the_transmitter_where_the_receiver_stands_elsewhere(polarization):
    """By the weights of both orders, which have no gains and no lengths."""
    first, last = (np.abs(paths.weight) ** 2 for paths in both_orders(polarization, (0, 1.0, 1.5)))
    assert len(first) == len(last) > 0
    assert first.mean() / last.mean() == pytest.approx(scattered(STRAIGHT) / scattered(OVER_WALL), rel=0.02)
